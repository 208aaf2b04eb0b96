// The vector code, for one instruction set: included by closed_forms.cpp once for each, within a
// namespace and with that set's instructions. Nothing of a header is called.

using Floats [[gnu::vector_size(4 * KABOUM_LANES)]] = float;
using Ints [[gnu::vector_size(4 * KABOUM_LANES)]] = std::int32_t;

/// A bit for each lane whose mask is set.
inline unsigned bits_of(const Ints& mask) {
#if KABOUM_LANES == 8
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#elif defined(KABOUM_AVX2)
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  unsigned bits = 0;
  for (unsigned lane = 0; lane < KABOUM_LANES; ++lane) bits |= (mask[lane] != 0 ? 1U : 0U) << lane;
  return bits;
#endif
}
constexpr unsigned kAll = (1U << KABOUM_LANES) - 1;

inline Floats load(const float* from) {
  Floats out;
  __builtin_memcpy(&out, from, sizeof out);
  return out;
}
inline Floats size_of(const Floats& x) {
  return reinterpret_cast<Floats>(reinterpret_cast<Ints>(x) & 0x7fffffff);
}
inline Floats smaller(const Floats& a, const Floats& b) { return a < b ? a : b; }
inline Floats larger(const Floats& a, const Floats& b) { return a > b ? a : b; }
inline Floats within(const Floats& x, const Floats& low, const Floats& high) {
  return smaller(larger(x, low), high);
}
inline Floats dot(const Floats* a, const Floats* b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// Lengths that pairs are compared with.
struct Lengths {
  Floats far;   ///< beyond it what is computed is apart
  Floats near;  ///< within it they meet
};

struct Masks {
  Ints apart, meet;
};

/// Segments and boxes along the axes about the origin.
inline void segment_and_box(const Floats* p, const Floats* q, const Floats* half,
                            const Lengths& lengths, Masks& out) {
  const Floats zero{}, one = zero + 1.0F;
  Floats d[3];
  out.apart = out.meet = Ints{};
  for (int k = 0; k < 3; ++k) {
    d[k] = q[k] - p[k];
    const Floats away = larger(smaller(p[k], q[k]), -larger(p[k], q[k]));
    out.apart |= away - half[k] > lengths.far;
  }
  if (bits_of(out.apart) == kAll) return;
  // What is within the reach of the point nearest to the box's middle meets it. Where the first
  // lane that is left does, nobody asks of the others.
  const auto nearest = [&](const Floats& t, Floats* n) {
    for (int k = 0; k < 3; ++k) {
      const Floats at = p[k] + t * d[k];
      n[k] = at - within(at, -half[k], half[k]);
    }
    return dot(n, n);
  };
  const Ints is_near = lengths.near > 1e-15F;
  const Floats near = lengths.near * lengths.near;
  Floats n[3];
  out.meet = is_near &
             (nearest(within(-dot(p, d) / larger(dot(d, d), zero + 1e-37F), zero, one), n) <= near);
  const unsigned left = ~bits_of(out.apart) & kAll;
  if ((bits_of(out.meet) & left & (~left + 1)) != 0) return;
  // Half the derivative of the squared distance at a share t of the segment: piecewise linear, and
  // it never falls.
  const auto slope = [&](const Floats& t) {
    Floats sum{};
    for (int k = 0; k < 3; ++k) {
      const Floats at = p[k] + t * d[k];
      sum += (at - within(at, -half[k], half[k])) * d[k];
    }
    return sum;
  };
  Floats low = zero, high = one, at_low = slope(zero), at_high = slope(one);
  // Where it is not negative from the start on the first end is nearest, and so on.
  const Ints starts = at_low >= zero, ends = at_high <= zero;
  high = starts ? zero : high;
  low = ends ? one : low;
  for (int k = 0; k < 3; ++k) {
    const Floats share = one / d[k];
    for (int side = 0; side < 2; ++side) {
      const Floats t = ((side == 0 ? -half[k] : half[k]) - p[k]) * share;
      const Ints inside = (t > low) & (t < high);
      if (bits_of(inside) == 0) continue;
      const Floats there = slope(t);
      const Ints before = inside & (there < zero), after = inside & ~before;
      low = before ? t : low;
      at_low = before ? there : at_low;
      high = after ? t : high;
      at_high = after ? there : at_high;
    }
  }
  const Floats rise = at_high - at_low;
  const Ints is_rising = rise > zero;
  Floats t = low - at_low * (high - low) / (is_rising ? rise : one);
  t = within(is_rising ? t : low, zero, one);
  t = starts ? zero : (ends ? one : t);
  const Floats square = nearest(t, n);
  out.meet |= is_near & (square <= near);
  // The box's own extent along n, and the lower end of the segment.
  const Floats gap = smaller(dot(n, p), dot(n, q)) -
                     (size_of(n[0]) * half[0] + size_of(n[1]) * half[1] + size_of(n[2]) * half[2]);
  out.apart |= (gap > zero) & (gap * gap > lengths.far * lengths.far * square + 1e-35F);
}

/// Segments from p to q and one from a to b.
inline void segment_and_segment(const Floats* p, const Floats* q, const float* a, const float* b,
                                const Lengths& lengths, Masks& out) {
  const Floats zero{}, one = zero + 1.0F, least = zero + 1e-37F;
  Floats u[3], v[3], w[3];
  for (int k = 0; k < 3; ++k) {
    u[k] = q[k] - p[k];
    v[k] = zero + (b[k] - a[k]);
    w[k] = p[k] - a[k];
  }
  const Floats uu = dot(u, u), uv = dot(u, v), uw = dot(u, w), vv = dot(v, v), vw = dot(v, w);
  const Floats all = uu * vv - uv * uv;
  Floats s = within((uv * vw - uw * vv) / larger(all, least), zero, one);
  s = all > least ? s : zero;
  const Floats t = within((uv * s + vw) / larger(vv, least), zero, one);
  s = within((uv * t - uw) / larger(uu, least), zero, one);
  Floats n[3], square{}, on_p{}, on_q{}, on_a{}, on_b{};
  for (int k = 0; k < 3; ++k) {
    n[k] = w[k] + s * u[k] - t * v[k];
    square += n[k] * n[k];
    on_p += n[k] * p[k];
    on_q += n[k] * q[k];
    on_a += n[k] * a[k];
    on_b += n[k] * b[k];
  }
  out.meet = (lengths.near > 1e-15F) & (square <= lengths.near * lengths.near);
  const Floats gap = smaller(on_p, on_q) - larger(on_a, on_b);
  out.apart = (gap > zero) & (gap * gap > lengths.far * lengths.far * square + 1e-35F);
}

/// Boxes about `way` whose axes are the columns of `turn` and one along the axes about the origin.
/// @param size  of which the meeting of boxes whose edges are nearly parallel is sure
inline void box_and_box(const Floats* turn, const Floats* way, const Floats* half,
                        const float* other, const Lengths& lengths, const Floats& inside,
                        const Floats& size, Masks& out) {
  out.apart = out.meet = Ints{};
  Floats extent[9];  // |turn|
  for (int i = 0; i < 9; ++i) extent[i] = size_of(turn[i]);
  Floats most{};
  for (int i = 0; i < 3; ++i) {
    const Floats* row = extent + 3 * i;
    const Floats gap =
        size_of(way[i]) - (row[0] * half[0] + row[1] * half[1] + row[2] * half[2]) - other[i];
    most = i == 0 ? gap : larger(most, gap);
  }
  for (int j = 0; j < 3; ++j) {
    const Floats along = turn[j] * way[0] + turn[3 + j] * way[1] + turn[6 + j] * way[2];
    const Floats gap =
        size_of(along) -
        (extent[j] * other[0] + extent[3 + j] * other[1] + extent[6 + j] * other[2]) - half[j];
    most = larger(most, gap);
  }
  out.apart = most > lengths.far;
  if (bits_of(out.apart) == kAll) return;
  Ints meet = most <= -inside;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3, i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3, j2 = (j + 2) % 3;
      const Floats &first = extent[3 * i1 + j], &second = extent[3 * i2 + j];
      const Floats gap = size_of(way[i2] * turn[3 * i1 + j] - way[i1] * turn[3 * i2 + j]) -
                         (other[i1] * second + other[i2] * first + half[j1] * extent[3 * i + j2] +
                          half[j2] * extent[3 * i + j1]);
      out.apart |= gap > lengths.far;
      // Nearly parallel edges: their product is short, and the faces decide.
      meet &= (gap <= -inside) | (most <= -(inside + 1.5F * size * (first + second)));
    }
  }
  out.meet = meet;
}

/// Of lanes from one on.
inline void look_at(const Lanes& lanes, const Facing& body, std::size_t from, Masks& masks) {
  const auto row = [&](std::size_t i) { return load(lanes.row[i] + from); };
  const auto& m = body.relation.turn;
  const auto turned = [&](const Floats* v, Floats* w) {
    for (int k = 0; k < 3; ++k) w[k] = m[0][k] * v[0] + m[1][k] * v[1] + m[2][k] * v[2];
  };
  const Floats zero{};
  const Floats reach = row(Lanes::kRadius) + body.reach;
  const Floats size = row(Lanes::kSize) + body.size + reach;
  Lengths lengths{reach + (kUnit * size + body.outer), reach - (kUnit * size + body.inner)};
  if (lanes.are_round) {
    Floats p[3], q[3];
    for (std::size_t end = 0; end < 2; ++end) {
      Floats v[3];
      for (std::size_t k = 0; k < 3; ++k) v[k] = row(3 * end + k);
      Floats* w = end == 0 ? p : q;
      turned(v, w);
      for (int k = 0; k < 3; ++k) w[k] += body.relation.way[k];
    }
    if (body.is_round) {
      const float a[3] = {-body.half[0], -body.half[1], -body.half[2]};
      segment_and_segment(p, q, a, body.half, lengths, masks);
    } else {
      const Floats half[3] = {zero + body.half[0], zero + body.half[1], zero + body.half[2]};
      segment_and_box(p, q, half, lengths, masks);
    }
    return;
  }
  const Floats outer = row(Lanes::kOuter), inner = row(Lanes::kInner);
  lengths.far += outer;
  lengths.near -= inner;
  Floats axes[9], center[3], half[3];
  for (std::size_t k = 0; k < 9; ++k) axes[k] = row(Lanes::kAxes + k);
  for (std::size_t k = 0; k < 3; ++k) {
    center[k] = row(Lanes::kCenter + k);
    half[k] = row(Lanes::kHalf + k);
  }
  if (body.is_round) {
    Floats p[3], q[3];
    for (int k = 0; k < 3; ++k) {
      p[k] = body.first[k] - center[k];
      q[k] = body.second[k] - center[k];
    }
    Floats own_p[3], own_q[3];
    for (int k = 0; k < 3; ++k) {
      own_p[k] = dot(axes + 3 * k, p);
      own_q[k] = dot(axes + 3 * k, q);
    }
    segment_and_box(own_p, own_q, half, lengths, masks);
    return;
  }
  Floats turn[9], way[3];
  for (int k = 0; k < 3; ++k) {
    Floats column[3];
    turned(axes + 3 * k, column);
    for (int i = 0; i < 3; ++i) turn[3 * i + k] = column[i];
  }
  turned(center, way);
  for (int k = 0; k < 3; ++k) way[k] += body.relation.way[k];
  const Floats inside = kUnit * size + 2.0F * (body.inner + inner);
  box_and_box(turn, way, half, body.half, lengths, inside, size, masks);
}

Verdicts look(const Lanes& lanes, const Facing& body) {
  Verdicts out;
  for (std::size_t from = 0; from < Lanes::kCount; from += KABOUM_LANES) {
    if (from >= lanes.count) break;
    Masks masks;
    look_at(lanes, body, from, masks);
    out.apart |= bits_of(masks.apart) << from;
    out.meet |= bits_of(masks.meet) << from;
  }
  const unsigned used = (1U << lanes.count) - 1;
  out.apart &= used;
  out.meet &= used;
  return out;
}
