// The vector code, for one instruction set: included by lanes.cpp once for each, within a namespace
// and with that set's instructions. Nothing here is shared with other sets, and nothing of the
// standard library is called, so that no function of a header is compiled for a set that the
// processor may lack. KABOUM_LANES configurations are looked at at once; what is computed of one
// does not depend on the others, nor on how many there are.

using Floats [[gnu::vector_size(4 * KABOUM_LANES)]] = float;
using Ints [[gnu::vector_size(4 * KABOUM_LANES)]] = std::int32_t;
using Doubles [[gnu::vector_size(8 * KABOUM_LANES)]] = double;

struct Point {
  Floats x, y, z;
};

struct Frame {
  Floats r[9];  // row by row
  Floats t[3];
};

/// A bit for each lane whose mask is set.
inline unsigned bits_of(const Ints& mask) {
#if KABOUM_LANES == 16
  return _mm512_cmplt_epi32_mask(reinterpret_cast<__m512i>(mask), _mm512_setzero_si512());
#elif KABOUM_LANES == 8
  return static_cast<unsigned>(_mm256_movemask_ps(reinterpret_cast<__m256>(mask)));
#elif defined(KABOUM_AVX2)
  return static_cast<unsigned>(_mm_movemask_ps(reinterpret_cast<__m128>(mask)));
#else
  unsigned bits = 0;
  for (unsigned lane = 0; lane < KABOUM_LANES; ++lane) bits |= (mask[lane] != 0 ? 1U : 0U) << lane;
  return bits;
#endif
}

/// Factors of squared distances that hold the rounding of these and of their bounds.
constexpr float kAbove = 1 + 0x1p-18F, kBelow = 1 - 0x1p-18F;
/// Share of motions that holds the rounding of their sums, for up to 64 joints.
constexpr float kMoves = 0x1p-14F;
/// Share of motions that holds what middles and ways of stretches are rounded by.
constexpr float kResidue = 0x1p-12F;
/// Directions that are shorter say nothing of where straight ways are.
constexpr float kShortest = 0x1p-30F;

inline Floats magnitude(const Floats& x) {
  return reinterpret_cast<Floats>(reinterpret_cast<Ints>(x) & 0x7fffffff);
}

/// Square root, correctly rounded.
inline Floats root(const Floats& x) {
#if KABOUM_LANES == 16
  return reinterpret_cast<Floats>(_mm512_maskz_sqrt_ps(0xffff, reinterpret_cast<__m512>(x)));
#elif KABOUM_LANES == 8
  return reinterpret_cast<Floats>(_mm256_sqrt_ps(reinterpret_cast<__m256>(x)));
#elif defined(KABOUM_AVX2)
  return reinterpret_cast<Floats>(_mm_sqrt_ps(reinterpret_cast<__m128>(x)));
#else
  Floats out{};
  for (unsigned lane = 0; lane < KABOUM_LANES; ++lane) out[lane] = __builtin_sqrtf(x[lane]);
  return out;
#endif
}

/// Errs by less than kSineError (model.cpp). @pre angles of at most 1000 in magnitude
inline void sine_and_cosine(const Doubles& angle, Floats& sine, Floats& cosine) {
  // The nearest integer: what is added leaves no bits below 1.
  constexpr double kRound = 0x1.8p52;
  const Doubles quarters = (angle * 0x1.45f306dc9c883p-1 + kRound) - kRound;
  // A quarter turn in two parts; the product of the first one is exact.
  const Doubles rest = (angle - quarters * 0x1.921fb54p+0) - quarters * 0x1.10b4611a62633p-30;
  const Floats r = __builtin_convertvector(rest, Floats);
  const Ints quarter = __builtin_convertvector(quarters, Ints);
  const Floats z = r * r;
  // Taylor's polynomials: what is left out is below r^11 / 11! and r^12 / 12!.
  const Floats s =
      r + r * (z * (-1.0F / 6 + z * (1.0F / 120 + z * (-1.0F / 5040 + z * (1.0F / 362880)))));
  const Floats c =
      1.0F + z * (-0.5F +
                  z * (1.0F / 24 + z * (-1.0F / 720 + z * (1.0F / 40320 + z * (-1.0F / 3628800)))));
  const Ints odd = (quarter & 1) != 0;
  const Ints sine_sign = (quarter & 2) << 30, cosine_sign = ((quarter + 1) & 2) << 30;
  sine = reinterpret_cast<Floats>(reinterpret_cast<Ints>(odd ? c : s) ^ sine_sign);
  cosine = reinterpret_cast<Floats>(reinterpret_cast<Ints>(odd ? s : c) ^ cosine_sign);
}

/// Values of a variable. @param rows  of the first lane, as place_of has them
inline void read_values(const double* rows, std::size_t variable, Doubles& out) {
  __builtin_memcpy(&out, rows + variable * kBlock, sizeof out);
}

/// How points of a frame move in a stretch q + s·w of a straight motion, |s| ≤ 1. One at a distance
/// r from the frame's origin is never farther than shift + turn · r from where it is at s = 0. At
/// s = 0, one at p has the velocity drift + spin × p, up to blur.
struct Motion {
  Floats turn, shift;
  Point spin, drift;
  Floats blur;
};

/// Poses of all frames. @return the lanes whose values are beyond what errors are bounded for
inline unsigned place_frames(const View& m, const double* rows, Frame* frames) {
  Ints beyond{};
  for (std::size_t i = 0; i < m.variables; ++i) {
    Doubles q;
    read_values(rows, i, q);
    const auto within = (q >= m.low[i]) & (q <= m.high[i]);
    beyond |= __builtin_convertvector(~within, Ints);
  }
  for (int k = 0; k < 9; ++k) frames[0].r[k] = Floats{} + m.base[k];
  for (int k = 0; k < 3; ++k) frames[0].t[k] = Floats{};
  for (std::size_t j = 0; j < m.steps; ++j) {
    const Step& step = m.step[j];
    const Frame& p = frames[step.parent];
    Frame& out = frames[j + 1];
    const float* f = step.fixed;
    for (int row = 0; row < 3; ++row) {
      const Floats a = p.r[3 * row], b = p.r[3 * row + 1], c = p.r[3 * row + 2];
      for (int k = 0; k < 3; ++k) out.r[3 * row + k] = a * f[k] + b * f[3 + k] + c * f[6 + k];
      out.t[row] = a * f[9] + b * f[10] + c * f[11] + p.t[row];
    }
    Doubles q;
    read_values(rows, step.variable, q);
    const auto within = (q >= m.low[step.variable]) & (q <= m.high[step.variable]);
    q = within ? q : Doubles{} + m.low[step.variable];
    const Doubles x = q * step.multiplier + step.offset;
    if (step.turns) {
      Floats s, c;
      sine_and_cosine(x, s, c);
      for (int row = 0; row < 3; ++row) {
        const Floats a = out.r[3 * row], b = out.r[3 * row + 1];
        out.r[3 * row] = c * a + s * b;
        out.r[3 * row + 1] = c * b - s * a;
      }
    } else {
      const Floats d = __builtin_convertvector(x, Floats);
      for (int row = 0; row < 3; ++row) out.t[row] += out.r[3 * row + 2] * d;
    }
  }
  return bits_of(beyond);
}

inline Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Point sum(const Point& a, const Point& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Point difference(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Point scaled(const Point& a, const Floats& by) { return {a.x * by, a.y * by, a.z * by}; }
inline Floats dot(const Point& a, const Point& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

/// @param ways  w, as of Motion, for each variable
inline void bound_motions(const View& m, const double* ways, const Frame* frames, Motion* motions) {
  const Point none{Floats{}, Floats{}, Floats{}};
  motions[0] = {Floats{}, Floats{}, none, none, Floats{}};
  for (std::size_t j = 0; j < m.steps; ++j) {
    const Step& step = m.step[j];
    const Motion& p = motions[step.parent];
    Motion& out = motions[j + 1];
    Doubles way;
    read_values(ways, step.variable, way);
    const Floats w = __builtin_convertvector(way * step.multiplier, Floats);
    const Doubles size = way < 0 ? -way : way;
    const Floats x =
        __builtin_convertvector(size + m.more[step.variable], Floats) * step.factor * kAbove;
    const Frame& frame = frames[j + 1];
    const Point along{frame.r[2] * w, frame.r[5] * w, frame.r[8] * w};
    out.turn = p.turn;
    out.shift = p.shift + p.turn * step.length;
    out.spin = p.spin;
    if (step.turns) {
      out.turn += x;
      out.spin = sum(p.spin, along);
      out.drift = sum(p.drift, cross({frame.t[0], frame.t[1], frame.t[2]}, along));
      out.blur = p.blur + x * m.blur_of_turns;
    } else {
      out.shift += x + p.turn * step.slide;
      out.drift = sum(p.drift, along);
      out.blur = p.blur + x * m.blur_of_slides;
    }
  }
}

inline Point place(const Frame& frame, const Point& c) {
  const Floats* r = frame.r;
  return {r[0] * c.x + r[1] * c.y + r[2] * c.z + frame.t[0],
          r[3] * c.x + r[4] * c.y + r[5] * c.z + frame.t[1],
          r[6] * c.x + r[7] * c.y + r[8] * c.z + frame.t[2]};
}

inline Point place(const Frame& frame, const float* c) {
  const Floats* r = frame.r;
  return {r[0] * c[0] + r[1] * c[1] + r[2] * c[2] + frame.t[0],
          r[3] * c[0] + r[4] * c[1] + r[5] * c[2] + frame.t[1],
          r[6] * c[0] + r[7] * c[1] + r[8] * c[2] + frame.t[2]};
}

/// A direction of the world, in a frame.
inline Point turned_back(const Frame& frame, const Point& d) {
  const Floats* r = frame.r;
  return {r[0] * d.x + r[3] * d.y + r[6] * d.z, r[1] * d.x + r[4] * d.y + r[7] * d.z,
          r[2] * d.x + r[5] * d.y + r[8] * d.z};
}

/// The larger one; of equal ones, and where one is no number, the second.
inline Floats larger(const Floats& a, const Floats& b) {
#if KABOUM_LANES == 16
  return reinterpret_cast<Floats>(
      _mm512_maskz_max_ps(0xffff, reinterpret_cast<__m512>(a), reinterpret_cast<__m512>(b)));
#elif KABOUM_LANES == 8
  return reinterpret_cast<Floats>(
      _mm256_max_ps(reinterpret_cast<__m256>(a), reinterpret_cast<__m256>(b)));
#else
  return a > b ? a : b;
#endif
}

/// How far the farthest corner of a body is along a direction of its own frame, and its number.
inline Floats farthest(const View& m, const BodyModel& body, const Point& d, Ints& best) {
  const auto along = [&](std::uint32_t i) {
    const float* p = m.corner[i].at;
    return d.x * p[0] + d.y * p[1] + d.z * p[2];
  };
  const std::uint32_t begin = body.corners.begin, end = body.corners.end;
  // Every other corner by itself: none has to wait for the last one.
  Floats most = along(begin), other = most;
  best = Ints{} + static_cast<std::int32_t>(begin);
  Ints best_other = best, number = best;
  for (std::uint32_t i = begin; i + 1 < end; i += 2) {
    const Floats first = along(i), second = along(i + 1);
    best = first > most ? number : best;
    most = larger(first, most);
    best_other = second > other ? number + 1 : best_other;
    other = larger(second, other);
    number += 2;
  }
  const Floats last = along(end - 1);
  best = last > most ? Ints{} + static_cast<std::int32_t>(end - 1) : best;
  most = larger(last, most);
  best = other > most ? best_other : best;
  return larger(other, most);
}

/// The same without the number.
inline Floats extent(const View& m, const BodyModel& body, const Point& d) {
  const auto along = [&](std::uint32_t i) {
    const float* p = m.corner[i].at;
    return d.x * p[0] + d.y * p[1] + d.z * p[2];
  };
  const std::uint32_t begin = body.corners.begin, end = body.corners.end;
  Floats most = along(begin), other = most;
  for (std::uint32_t i = begin; i + 1 < end; i += 2) {
    most = larger(along(i), most);
    other = larger(along(i + 1), other);
  }
  return larger(larger(along(end - 1), most), other);
}

/// Corners by their numbers.
inline Point corners_at(const View& m, const Ints& numbers) {
  Point out;
  for (unsigned lane = 0; lane < KABOUM_LANES; ++lane) {
    const float* p = m.corner[numbers[lane]].at;
    out.x[lane] = p[0];
    out.y[lane] = p[1];
    out.z[lane] = p[2];
  }
  return out;
}

/// Lanes in which two points may be no farther apart than `reach`.
template <typename Reach>
inline unsigned may_meet(const Point& a, const Point& b, const Reach& reach) {
  const Floats x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  const Ints apart = x * x + y * y + z * z > reach * reach * kAbove;
  return bits_of(~apart);
}
template <typename Reach>
inline unsigned may_meet(const Point& a, const float* b, const Reach& reach) {
  const Floats x = a.x - b[0], y = a.y - b[1], z = a.z - b[2];
  const Ints apart = x * x + y * y + z * z > reach * reach * kAbove;
  return bits_of(~apart);
}

/// Lanes in which two points are certainly no farther apart than `reach`.
inline unsigned must_meet(const Point& a, const Point& b, float reach) {
  if (!(reach > 0)) return 0;
  const Floats x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
  const Ints near = x * x + y * y + z * z < reach * reach * kBelow;
  return bits_of(near);
}

/// Squared distance from a box along its own axes.
inline Floats distance_of_box(const Point& p, const float* axes, const float* center,
                              const float* half) {
  const Floats x = p.x - center[0], y = p.y - center[1], z = p.z - center[2];
  Floats sum{};
  for (int k = 0; k < 3; ++k) {
    const Floats along = axes[3 * k] * x + axes[3 * k + 1] * y + axes[3 * k + 2] * z;
    const Floats beyond = magnitude(along) - half[k];
    const Floats positive = beyond > 0 ? beyond : Floats{};
    sum += positive * positive;
  }
  return sum;
}

/// Lanes in which a ball may meet a box along the world's axes.
template <typename Reach>
inline unsigned may_meet(const Point& p, const Reach& radius, const ObstacleGroup& box) {
  const Ints apart = (magnitude(p.x - box.center[0]) > (radius + box.half[0]) * kAbove) |
                     (magnitude(p.y - box.center[1]) > (radius + box.half[1]) * kAbove) |
                     (magnitude(p.z - box.center[2]) > (radius + box.half[2]) * kAbove);
  return bits_of(~apart);
}

/// Lanes in which a ball may meet an obstacle.
template <typename Reach>
inline unsigned may_meet(const View& m, const Point& p, const Reach& radius, const Obstacle& o) {
  const Reach reach = radius + o.radius;
  const Ints apart = distance_of_box(p, o.axes, o.center, o.half) > reach * reach * kAbove;
  unsigned left = bits_of(~apart);
  for (std::uint32_t i = o.planes.begin; i < o.planes.end && left != 0; ++i) {
    const float* n = m.plane[i].normal;
    const Ints above = p.x * n[0] + p.y * n[1] + p.z * n[2] > m.plane[i].offset + radius;
    left &= bits_of(~above);
  }
  return left;
}

// The same of balls whose middles go straight from p - v to p + v.

inline Point velocity_of(const Motion& motion, const Point& p) {
  return sum(motion.drift, cross(motion.spin, p));
}

/// Lanes in which two points, the second at d + s·v from the first, |s| ≤ 1, may be no farther
/// apart than `reach`.
inline unsigned may_meet_on_way(const Point& d, const Point& v, const Floats& reach) {
  const Floats square = dot(v, v);
  Floats s = -dot(d, v) / square;  // where they are nearest to each other; any s would do
  s = s < 1 ? s : Floats{} + 1;
  s = s > -1 ? s : Floats{} - 1;
  const Point n = sum(d, scaled(v, square > 0 ? s : Floats{}));
  const Floats length = root(dot(n, n));
  const Floats least = dot(n, d) - magnitude(dot(n, v));
  const Ints apart = (length > kShortest) & (least > length * (reach + length * 0x1p-18F) * kAbove);
  return bits_of(~apart);
}

inline unsigned may_meet_on_way(const Point& p, const Point& v, const Floats& radius,
                                const ObstacleGroup& box) {
  const Ints apart =
      (magnitude(p.x - box.center[0]) > (radius + magnitude(v.x) + box.half[0]) * kAbove) |
      (magnitude(p.y - box.center[1]) > (radius + magnitude(v.y) + box.half[1]) * kAbove) |
      (magnitude(p.z - box.center[2]) > (radius + magnitude(v.z) + box.half[2]) * kAbove);
  return bits_of(~apart);
}

inline unsigned may_meet_on_way(const View& m, const Point& p, const Point& v, const Floats& radius,
                                const Obstacle& o) {
  const Floats x = p.x - o.center[0], y = p.y - o.center[1], z = p.z - o.center[2];
  Floats square{}, way{};
  for (int k = 0; k < 3; ++k) {
    const float* axis = o.axes + 3 * k;
    const Floats along = axis[0] * x + axis[1] * y + axis[2] * z;
    const Floats beyond = magnitude(along) - o.half[k];
    const Floats positive = beyond > 0 ? beyond : Floats{};
    square += positive * positive;
    const Floats moves = positive * (axis[0] * v.x + axis[1] * v.y + axis[2] * v.z);
    way += along > 0 ? moves : -moves;
  }
  const Floats length = root(square);
  const Ints apart =
      (length > kShortest) &
      (square - magnitude(way) > length * (radius + o.radius + length * 0x1p-18F) * kAbove);
  unsigned left = bits_of(~apart);
  for (std::uint32_t i = o.planes.begin; i < o.planes.end && left != 0; ++i) {
    const float* n = m.plane[i].normal;
    const Floats moves = magnitude(v.x * n[0] + v.y * n[1] + v.z * n[2]);
    const Ints above = p.x * n[0] + p.y * n[1] + p.z * n[2] - moves > m.plane[i].offset + radius;
    left &= bits_of(~above);
  }
  return left;
}

inline unsigned must_meet(const Point& p, float radius, const Obstacle& o) {
  const float reach = radius + o.inner_radius;
  if (!(reach > 0)) return 0;
  const Ints near =
      distance_of_box(p, o.axes, o.inner_center, o.inner_half) < reach * reach * kBelow;
  return bits_of(near);
}

/// Squared distance from a box along the axes.
inline Floats distance_of_box(const Point& p, const CloudNode& box) {
  const Floats at[3] = {p.x, p.y, p.z};
  Floats sum{};
  for (int k = 0; k < 3; ++k) {
    const Floats below = box.low[k] - at[k], above = at[k] - box.high[k];
    const Floats beyond = below > above ? below : above;
    const Floats positive = beyond > 0 ? beyond : Floats{};
    sum += positive * positive;
  }
  return sum;
}

/// Those of the lanes in which meet(point) is not 0 for a point of a cloud within reach.
template <typename Reach, typename Meet>
inline unsigned any_point(const View& m, const CloudModel& cloud, const Point& p,
                          const Reach& reach, unsigned lanes, const Meet& meet) {
  const Floats most = Floats{} + reach * reach * kAbove;
  unsigned found = 0;
  for (std::uint32_t i = cloud.nodes.begin; i < cloud.nodes.end && found != lanes;) {
    const CloudNode& node = m.cloud_node[i];
    const Ints apart = distance_of_box(p, node) > most;
    if ((lanes & ~found & bits_of(~apart)) == 0) {
      i = node.next;
      continue;
    }
    for (std::uint32_t k = node.points.begin; k < node.points.end && found != lanes; ++k)
      found |= lanes & ~found & meet(m.cloud_point[k].at);
    ++i;
  }
  return found;
}

/// The point of a segment that is nearest to the origin.
inline Point nearest_of_segment(const Point& a, const Point& b) {
  const Point way = difference(b, a);
  const Floats square = dot(way, way);
  Floats share = -dot(a, way) / square;
  share = square > 0 ? share : Floats{};
  share = share > 0 ? share : Floats{};
  share = share < 1 ? share : Floats{} + 1;
  return sum(a, scaled(way, share));
}

inline Point chosen(const Ints& mask, const Point& a, const Point& b) {
  return {mask ? a.x : b.x, mask ? a.y : b.y, mask ? a.z : b.z};
}

/// The point of a triangle that is nearest to the origin, about.
inline Point nearest_of_triangle(const Point& a, const Point& b, const Point& c) {
  const Point ab = difference(b, a), ac = difference(c, a);
  const Floats bb = dot(ab, ab), bc = dot(ab, ac), cc = dot(ac, ac), ub = -dot(a, ab),
               uc = -dot(a, ac);
  const Floats all = bb * cc - bc * bc, s = cc * ub - bc * uc, t = bb * uc - bc * ub;
  const Ints inside = (s > 0) & (t > 0) & (s + t < all) & (all > 0x1p-20F * (bb * cc));
  const Floats share = 1 / all;
  const Point plane = sum(a, sum(scaled(ab, s * share), scaled(ac, t * share)));
  Point out = nearest_of_segment(a, c);
  const Point other = nearest_of_segment(b, c);
  out = chosen(dot(other, other) < dot(out, out), other, out);
  return chosen(inside, plane, out);
}

/// Three points of a convex set ([gilbert1988]).
struct Simplex {
  Point p, q, r;

  /// Replaces one by another point of the set, where the nearest point to the origin is then
  /// nearest. @return that point
  /// @param first  it is the first one
  Point with(const Point& v, bool first) {
    if (first) {
      p = q = r = v;
      return v;
    }
    const Point qr = nearest_of_triangle(q, r, v), rp = nearest_of_triangle(r, p, v),
                pq = nearest_of_triangle(p, q, v);
    const Floats without_p = dot(qr, qr), without_q = dot(rp, rp), without_r = dot(pq, pq);
    const Ints drop_p = (without_p < without_q) & (without_p < without_r);
    const Ints drop_q = ~drop_p & (without_q < without_r);
    p = chosen(drop_p, v, p);
    q = chosen(drop_q, v, q);
    r = chosen(drop_p | drop_q, r, v);
    return chosen(drop_p, qr, chosen(drop_q, rp, pq));
  }
};

/// Lanes in which a ball round the origin is within the tetrahedron of a simplex and a point.
inline unsigned hold_ball(const Simplex& s, const Point& v, float radius) {
  const Point* corners[4] = {&s.p, &s.q, &s.r, &v};
  Floats most{};
  for (const Point* p : corners) {
    const Floats square = dot(*p, *p);
    most = square > most ? square : most;
  }
  // Products of edges round by less than 32u of the square of the farthest corner, most².
  const Floats length = root(most) * kAbove, rounding = (length + radius) * most * 0x1p-16F;
  constexpr int kFaces[4][3] = {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}};
  Ints before = Ints{} - 1, behind = before;
  for (const int* face : kFaces) {
    const Point& a = *corners[face[0]];
    const Point n = cross(difference(*corners[face[1]], a), difference(*corners[face[2]], a));
    const Floats height = dot(n, a);
    const Floats least = root(dot(n, n)) * (radius * kAbove) + rounding;
    before &= height > least;
    behind &= height < -least;
  }
  return bits_of(before | behind);
}

struct Still {};

/// Configurations that are looked at at once, and what is known of them; with Moving, stretches of
/// values round them: free is what is so in all of a stretch, in contact what is so at its
/// configuration.
template <bool Moving>
class Pack {
 public:
  /// @param pairs  of the first row, as View has them; or null
  /// @param suspects  likewise
  Pack(const View& m, const double* rows, const double* ways, unsigned count, std::uint32_t* pairs,
       Suspect* suspects)
      : m_(m), pairs_(pairs), suspects_(suspects) {
    frames_ = reinterpret_cast<Frame*>(m.memory);
    motions_ = reinterpret_cast<Motion*>(frames_ + m.steps + 1);
    whole_ = reinterpret_cast<Point*>(motions_ + m.steps + 1);
    clusters_ = whole_ + m.shapes;
    outer_ = clusters_ + m.clusters;
    inner_ = outer_ + m.outer_count;
    bodies_ = inner_ + m.inner_count;
    corners_ = bodies_ + m.body_count;
    all_ = count == 32 ? ~0U : (1U << count) - 1;
    open_ = place_frames(m, rows, frames_) & all_;
    if constexpr (Moving) bound_motions(m, ways, frames_, motions_);
    all_ &= ~open_;
    for (std::size_t s = 0; s < m.shapes; ++s) {
      whole_[s] = place(frames_[m.shape[s].frame], m.shape[s].whole.center);
      m.ready[s] = 0;
    }
    for (std::size_t c = 0; c < m.clusters; ++c)
      clusters_[c] = place(frames_[m.cluster[c].frame], m.cluster[c].whole.center);
    for (std::size_t i = 0; i < m.cluster_pairs; ++i) m.near[i] = kUnknown;
  }

  void decide() {
    if (m_.obstacles_first) look_at_obstacles();
    if (m_.look != Look::Contacts)
      for (std::size_t i = 0; i < m_.shape_pairs && !ends(); ++i) {
        number_ = static_cast<std::uint32_t>(i);
        look_at(m_.shape_pair[i]);
      }
    if (!m_.obstacles_first) look_at_obstacles();
    if (m_.look == Look::Contacts || (stops() && contact_ != 0)) open_ |= all_;
  }

  /// Lanes that are in contact for certain, and others of which nothing is known.
  [[nodiscard]] unsigned contact() const { return contact_; }
  [[nodiscard]] unsigned open() const { return open_ & ~contact_; }

 private:
  static constexpr int kSteps = 8;                ///< of the search for directions
  static constexpr std::uint32_t kUnknown = ~0U;  ///< not a set of lanes
  static constexpr int kFewSteps = 2;             ///< of that for whole links

  /// True if a contact ends the look.
  [[nodiscard]] bool stops() const { return m_.look == Look::One || m_.look == Look::Contacts; }
  [[nodiscard]] bool ends() const {
    if (m_.look == Look::Apart && open_ == all_) return true;
    return contact_ == all_ || (stops() && contact_ != 0);
  }

  void look_at_obstacles() {
    for (std::size_t i = 0; i < m_.obstacle_pairs && !ends(); ++i) {
      number_ = static_cast<std::uint32_t>(m_.shape_pairs + i);
      look_at(m_.obstacle_pair[i]);
    }
  }

  /// Lanes in which the clusters of a pair may meet.
  unsigned near_clusters(std::uint32_t number) {
    if (number == kNoCluster) return ~0U;
    std::uint32_t& out = m_.near[number];
    if (out != kUnknown) return out;
    const ClusterPair& pair = m_.cluster_pair[number];
    const Cluster& a = m_.cluster[pair.a];
    const float more = pair.margin + m_.slack;
    if (pair.with_group) {
      out = near_to(clusters_[pair.a], whole_motion(a.frame, 0), a.whole, more, m_.group[pair.b],
                    all_);
      return out;
    }
    const Cluster& b = m_.cluster[pair.b];
    out = near_to({clusters_[pair.a], a.whole, whole_motion(a.frame, pair.common)},
                  {clusters_[pair.b], b.whole, whole_motion(b.frame, pair.common)}, more, all_);
    return out;
  }

  void look_at(const ObstaclePair& pair) {
    const unsigned lanes = all_ & ~contact_ & near_clusters(pair.clusters);
    if (lanes == 0) return;
    const ShapeModel& shape = m_.shape[pair.shape];
    const Point& whole = whole_[pair.shape];
    const ObstacleGroup& group = m_.group[pair.group];
    const auto motion = whole_motion(shape.frame, 0);
    const float more = pair.margin + m_.slack;
    const unsigned near = near_to(whole, motion, shape.whole, more, group, lanes);
    if (near == 0) return;
    if (group.cloud.nodes.begin != group.cloud.nodes.end)
      return look_at(pair, shape, group.cloud, near);
    for (std::uint32_t i = group.obstacles.begin; i < group.obstacles.end; ++i) {
      const unsigned left = near & ~contact_;
      if (left == 0) return;
      look_at(pair, shape, m_.obstacle[i],
              near_to(whole, motion, shape.whole, more, m_.obstacle[i], left));
    }
  }

  void look_at(const ObstaclePair& pair, const ShapeModel& shape, const Obstacle& o,
               unsigned near) {
    if (near == 0) return;
    if (m_.look == Look::Contacts) return note(0, inside(pair, shape, o, near));
    const auto motion = whole_motion(shape.frame, 0);
    const float more = pair.margin + m_.slack;
    const auto still = whole_motion(0, 0);
    const PlacedBody other{m_.body[o.body], world_point(m_.body[o.body].ball.center), nullptr,
                           still};
    if (is_worth_a_hull(shape, shape)) {
      near = without_direction(
          {m_.body[shape.hull], whole_[pair.shape], &frames_[shape.frame], motion}, other, more,
          near, kFewSteps);
      if (near == 0) return;
    }
    place_outer(pair.shape);
    unsigned doubt = 0, meet = 0, facing = 0, suspect = 0;
    bool is_looked_into = false;
    for (std::uint32_t i = shape.bodies.begin; i < shape.bodies.end && (doubt | meet) != near;
         ++i) {
      const BodyModel& body = m_.body[i];
      const unsigned left = near_to(bodies_[i], motion, body.ball, more, o, near & ~doubt & ~meet);
      unsigned found = 0;
      for (std::uint32_t k = body.balls.begin; k < body.balls.end && found != left; ++k)
        found |= near_to(outer_[k], motion, m_.outer[k], more, o, left & ~found);
      if (found == 0) continue;
      if (!is_looked_into) {
        if (m_.look != Look::Apart) meet = inside(pair, shape, o, near);
        facing = not_beyond_face(pair, shape, motion, o, near & ~meet);
      }
      is_looked_into = true;
      found &= facing & ~meet;
      doubt |=
          without_direction({body, bodies_[i], &frames_[shape.frame], motion}, other, more, found);
      meet |= meeting_;
      suspect |= unparted_;
    }
    doubt &= ~meet;
    note(doubt, meet, suspect);
  }

  /// Lanes in which a shape certainly meets an obstacle.
  unsigned inside(const ObstaclePair& pair, const ShapeModel& shape, const Obstacle& o,
                  unsigned lanes) {
    place_inner(pair.shape);
    unsigned meet = 0;
    for (std::uint32_t k = shape.inner.begin; k < shape.inner.end && meet != lanes; ++k)
      meet |= lanes & must_meet(inner_[k], m_.inner[k].radius + pair.least_margin, o);
    return meet;
  }

  /// What is known of how things move; nothing where they do not.
  using Moves = std::conditional_t<Moving, Motion, Still>;

  /// A body and where it is.
  struct PlacedBody {
    const BodyModel& body;
    Point middle;
    const Frame* frame;  ///< null: the world
    const Moves& motion;
  };

  /// Lanes that are open already, or of which no direction is found along which two bodies are
  /// apart by more than `more`: those of nearer and nearer points of their difference
  /// ([gilbert1988]). Tells of `meeting_` and `unparted_`.
  [[nodiscard]] unsigned without_direction(const PlacedBody& a, const PlacedBody& b, float more,
                                           unsigned lanes, int steps = kSteps) {
    constexpr float kShort = 1 - 0x1p-9F, kProgress = 0.98F;
    unparted_ = meeting_ = 0;
    // What is open already is asked of the exact predicates, or is cut, in any case.
    const unsigned open = Moving && pairs_ != nullptr ? 0 : lanes & open_;
    lanes &= ~open;
    if (lanes == 0) return open;
    if (a.body.corners.begin == a.body.corners.end || b.body.corners.begin == b.body.corners.end)
      return lanes | open;
    const auto reach = offset_of(a.motion, a.body) + (offset_of(b.motion, b.body) + more);
    const float still = a.body.offset + (b.body.offset + more);
    // A lane is looked at while that leads on; what is found there does not depend on the others.
    unsigned going = lanes, unparted = lanes;
    Point d = difference(b.middle, a.middle);
    Simplex nearest;
    Floats last = Floats{} + __builtin_huge_valf();
    for (int step = 0;; ++step) {
      const Floats square = dot(d, d);
      // Of what is too short or too long for its square, or is no number, nothing is said.
      const Ints sound = (square > 0x1p-100F) & (square < 0x1p100F);
      d = scaled(d, kShort / root(square));
      const Point back = scaled(d, Floats{} - 1);
      Ints of_a, of_b;
      const Floats top =
          farthest(m_, a.body, a.frame == nullptr ? d : turned_back(*a.frame, d), of_a);
      const Floats bottom =
          farthest(m_, b.body, b.frame == nullptr ? back : turned_back(*b.frame, back), of_b);
      const Floats gap =
          dot(difference(origin_of(b.frame), origin_of(a.frame)), d) - (top + bottom);
      unsigned parted = going & bits_of((gap > reach) & sound);
      if constexpr (Moving) {
        unparted &= ~(going & bits_of((gap > still) & sound));
        parted |= apart_on_way(a, b, more, d, gap, going & bits_of(sound));
      }
      lanes &= ~parted;
      unparted_ = lanes & unparted;
      going &= lanes;
      if (going == 0 || step == steps) return lanes | open;
      Point p = corners_at(m_, of_a), q = corners_at(m_, of_b);
      if (a.frame != nullptr) p = place(*a.frame, p);
      if (b.frame != nullptr) q = place(*b.frame, q);
      const Point way_between = difference(q, p);
      const Simplex before = nearest;
      d = nearest.with(way_between, step == 0);
      // No gap is wider than the way between points of both; where this does not get shorter,
      // either it is the gap, or the bodies meet.
      const Floats way = dot(d, d);
      const unsigned on = bits_of((way > still * still) & (way < kProgress * last));
      if (step > 2 && (going & ~on) != 0)
        meeting_ |= going & ~on & hold_ball(before, way_between, a.body.error + b.body.error);
      going &= on;
      last = way;
      if (going == 0) return lanes | open;
    }
  }

  /// Those of some lanes in which two bodies are apart along a direction in all of a stretch.
  /// @param gap  at its middle
  [[nodiscard]] unsigned apart_on_way(const PlacedBody& a, const PlacedBody& b, float more,
                                      const Point& d, const Floats& gap, unsigned lanes) const {
    const Floats reach =
        bent_offset_of(a.motion, a.body) + (bent_offset_of(b.motion, b.body) + more);
    lanes &= bits_of(gap > reach);
    if (lanes == 0) return 0;
    const Point from = origin_of(a.frame), to = origin_of(b.frame);
    const Floats still = dot(difference(to, from), d);
    const Floats moves = dot(difference(velocity_of(b.motion, to), velocity_of(a.motion, from)), d);
    const Point turn_a = cross(d, a.motion.spin), turn_b = cross(d, b.motion.spin);
    for (const float s : {-1.0F, 1.0F}) {
      const Point e = sum(d, scaled(turn_a, Floats{} + s));
      const Point back = scaled(sum(d, scaled(turn_b, Floats{} + s)), Floats{} - 1);
      const Floats top = extent(m_, a.body, a.frame == nullptr ? e : turned_back(*a.frame, e));
      const Floats bottom =
          extent(m_, b.body, b.frame == nullptr ? back : turned_back(*b.frame, back));
      lanes &= bits_of(still + s * moves - (top + bottom) > reach);
      if (lanes == 0) return 0;
    }
    return lanes;
  }

  static Point origin_of(const Frame* frame) {
    if (frame == nullptr) return {Floats{}, Floats{}, Floats{}};
    return {frame->t[0], frame->t[1], frame->t[2]};
  }
  static Point world_point(const float* p) {
    return {Floats{} + p[0], Floats{} + p[1], Floats{} + p[2]};
  }

  /// Lanes in which no face of an obstacle's box, of those that the shape's ball is in front of,
  /// separates the shape from it.
  unsigned not_beyond_face(const ObstaclePair& pair, const ShapeModel& shape, const Moves& motion,
                           const Obstacle& o, unsigned doubt) {
    place_corners(pair.shape);
    FrameBall ball;
    ball.length = shape.reach;
    ball.radius = shape.corner_radius;
    const float more = pair.margin + m_.slack;
    const auto reach = radius_of(motion, ball, more) + o.radius;
    unsigned left = ~0U;
    for (int k = 0; k < 3; ++k) {
      const float* axis = o.axes + 3 * k;
      const Point& middle = whole_[pair.shape];
      const Ints outside =
          magnitude(axis[0] * (middle.x - o.center[0]) + axis[1] * (middle.y - o.center[1]) +
                    axis[2] * (middle.z - o.center[2])) > o.half[k];
      const unsigned lanes = bits_of(outside) & doubt & left;
      if (lanes == 0) continue;
      Floats least = Floats{} + __builtin_huge_valf(), most = -least;
      [[maybe_unused]] Floats least_on_way = least, most_on_way = most;
      for (std::uint32_t i = shape.corners.begin; i < shape.corners.end; ++i) {
        const Point& p = corners_[i];
        const Floats along = axis[0] * (p.x - o.center[0]) + axis[1] * (p.y - o.center[1]) +
                             axis[2] * (p.z - o.center[2]);
        least = along < least ? along : least;
        most = along > most ? along : most;
        if constexpr (Moving) {
          const Point v = velocity_of(motion, p);
          const Floats way = magnitude(axis[0] * v.x + axis[1] * v.y + axis[2] * v.z);
          least_on_way = along - way < least_on_way ? along - way : least_on_way;
          most_on_way = along + way > most_on_way ? along + way : most_on_way;
        }
      }
      const auto face = (o.half[k] + reach) * kAbove;
      Ints apart = (least > face) | (-most > face);
      if constexpr (Moving) {
        const Floats near = (o.half[k] + (bent_radius_of(motion, ball, more) + o.radius)) * kAbove;
        apart |= (least_on_way > near) | (-most_on_way > near);
      }
      left &= bits_of(~apart) | ~lanes;
    }
    return left;
  }

  void look_at(const ObstaclePair& pair, const ShapeModel& shape, const CloudModel& cloud,
               unsigned near) {
    if (near == 0) return;
    const auto motion = whole_motion(shape.frame, 0);
    const float margin = pair.margin + m_.slack;
    const auto may_touch = [&](const Point& p, const FrameBall& ball, unsigned lanes) {
      const auto reach = radius_of(motion, ball, margin) + cloud.radius;
      return any_point(m_, cloud, p, reach, lanes,
                       [&](const float* point) { return may_meet(p, point, reach); });
    };
    near = may_touch(whole_[pair.shape], shape.whole, near);
    if (near == 0) return;
    place_outer(pair.shape);
    unsigned doubt = 0;
    const Range outer = outer_of(shape);
    for (std::uint32_t k = outer.begin; k < outer.end && doubt != near; ++k)
      doubt |= may_touch(outer_[k], m_.outer[k], near & ~doubt);
    if (doubt == 0) return;
    if (m_.look == Look::Apart) return note(doubt, 0);
    place_inner(pair.shape);
    unsigned meet = 0;
    for (std::uint32_t k = shape.inner.begin; k < shape.inner.end && meet != doubt; ++k) {
      const float reach = m_.inner[k].radius + cloud.inner_radius + pair.least_margin;
      if (!(cloud.inner_radius > 0) || !(reach > 0)) continue;
      const Point& p = inner_[k];
      meet |= any_point(m_, cloud, p, reach, doubt & ~meet, [&](const float* point) {
        return must_meet(p, {Floats{} + point[0], Floats{} + point[1], Floats{} + point[2]}, reach);
      });
    }
    note(doubt, meet);
  }

  void look_at(const ShapePair& pair) {
    const unsigned lanes = all_ & ~contact_ & near_clusters(pair.clusters);
    if (lanes == 0) return;
    const ShapeModel &a = m_.shape[pair.a], &b = m_.shape[pair.b];
    const Point &whole_a = whole_[pair.a], &whole_b = whole_[pair.b];
    const auto motion_a = whole_motion(a.frame, pair.common),
               motion_b = whole_motion(b.frame, pair.common);
    const float more = pair.margin + m_.slack;
    unsigned near =
        near_to({whole_a, a.whole, motion_a}, {whole_b, b.whole, motion_b}, more, lanes);
    for (std::uint32_t i = pair.witnesses.begin; i < pair.witnesses.end && near != 0; ++i) {
      const Witness& w = m_.witness[i];
      near &= w.of_first ? not_separated(w, a, motion_a, b, motion_b)
                         : not_separated(w, b, motion_b, a, motion_a);
    }
    if (is_worth_a_hull(a, b))
      near = without_direction({m_.body[a.hull], whole_a, &frames_[a.frame], motion_a},
                               {m_.body[b.hull], whole_b, &frames_[b.frame], motion_b}, more, near,
                               kFewSteps);
    if (near == 0) return;
    place_outer(pair.a);
    place_outer(pair.b);
    unsigned doubt = 0, meet = 0, suspect = 0;
    bool is_looked_into = m_.look == Look::Apart;
    for (std::uint32_t i = a.bodies.begin; i < a.bodies.end && (doubt | meet) != near; ++i) {
      const BodyModel& body = m_.body[i];
      const unsigned left = near_to({bodies_[i], body.ball, motion_a}, {whole_b, b.whole, motion_b},
                                    more, near & ~doubt & ~meet);
      for (std::uint32_t k = b.bodies.begin; k < b.bodies.end; ++k) {
        unsigned found = balls_meet(i, motion_a, k, motion_b, more, left & ~doubt & ~meet);
        if (found == 0) continue;
        if (!is_looked_into) meet = inside(pair, near);
        is_looked_into = true;
        found &= ~meet;
        doubt |=
            without_direction({body, bodies_[i], &frames_[a.frame], motion_a},
                              {m_.body[k], bodies_[k], &frames_[b.frame], motion_b}, more, found);
        meet |= meeting_;
        suspect |= unparted_;
      }
    }
    note(doubt, meet, suspect);
  }

  /// True if two hulls are looked at before all pairs of bodies.
  [[nodiscard]] static bool is_worth_a_hull(const ShapeModel& a, const ShapeModel& b) {
    constexpr std::uint32_t kPairs = 3;
    return (a.bodies.end - a.bodies.begin) * (b.bodies.end - b.bodies.begin) > kPairs;
  }

  /// Lanes in which two links certainly meet.
  unsigned inside(const ShapePair& pair, unsigned lanes) {
    place_inner(pair.a);
    place_inner(pair.b);
    const Range a = m_.shape[pair.a].inner, b = m_.shape[pair.b].inner;
    unsigned meet = 0;
    for (std::uint32_t i = a.begin; i < a.end && meet != lanes; ++i)
      for (std::uint32_t k = b.begin; k < b.end && meet != lanes; ++k)
        meet |= lanes & must_meet(inner_[i], inner_[k],
                                  m_.inner[i].radius + m_.inner[k].radius + pair.least_margin);
    return meet;
  }

  /// Lanes in which balls of two bodies of links may meet.
  unsigned balls_meet(std::uint32_t i, const Moves& motion_a, std::uint32_t k,
                      const Moves& motion_b, float more, unsigned lanes) const {
    if (lanes == 0) return 0;
    const BodyModel &a = m_.body[i], &b = m_.body[k];
    const PlacedBall ball_b{bodies_[k], b.ball, motion_b};
    lanes = near_to({bodies_[i], a.ball, motion_a}, ball_b, more, lanes);
    unsigned out = 0;
    for (std::uint32_t x = a.balls.begin; x < a.balls.end && out != lanes; ++x) {
      const PlacedBall ball{outer_[x], m_.outer[x], motion_a};
      const unsigned left = near_to(ball, ball_b, more, lanes & ~out);
      for (std::uint32_t y = b.balls.begin; y < b.balls.end && (left & ~out) != 0; ++y)
        out |= near_to(ball, {outer_[y], m_.outer[y], motion_b}, more, left & ~out);
    }
    return out;
  }

  /// A ball and where it is.
  struct PlacedBall {
    const Point& at;
    const FrameBall& ball;
    const Moves& motion;
  };

  /// Those of some lanes in which two balls may come within `more` of each other.
  [[nodiscard]] unsigned near_to(const PlacedBall& a, const PlacedBall& b, float more,
                                 unsigned lanes) const {
    if (lanes == 0) return 0;
    lanes &=
        may_meet(a.at, b.at, radius_of(a.motion, a.ball, more) + radius_of(b.motion, b.ball, 0));
    if constexpr (Moving) {
      if (lanes != 0)
        lanes &= may_meet_on_way(
            difference(b.at, a.at),
            difference(velocity_of(b.motion, b.at), velocity_of(a.motion, a.at)),
            bent_radius_of(a.motion, a.ball, more) + bent_radius_of(b.motion, b.ball, 0));
    }
    return lanes;
  }
  /// Those in which a ball may come within `more` of an obstacle.
  [[nodiscard]] unsigned near_to(const Point& p, const Moves& motion, const FrameBall& ball,
                                 float more, const Obstacle& o, unsigned lanes) const {
    if (lanes == 0) return 0;
    lanes &= may_meet(m_, p, radius_of(motion, ball, more), o);
    if constexpr (Moving) {
      if (lanes != 0)
        lanes &=
            may_meet_on_way(m_, p, velocity_of(motion, p), bent_radius_of(motion, ball, more), o);
    }
    return lanes;
  }
  [[nodiscard]] unsigned near_to(const Point& p, const Moves& motion, const FrameBall& ball,
                                 float more, const ObstacleGroup& box, unsigned lanes) const {
    lanes &= may_meet(p, radius_of(motion, ball, more), box);
    if constexpr (Moving) {
      if (lanes != 0)
        lanes &=
            may_meet_on_way(p, velocity_of(motion, p), bent_radius_of(motion, ball, more), box);
    }
    return lanes;
  }

  /// Lanes in which a witness does not separate two shapes.
  [[nodiscard]] unsigned not_separated(const Witness& w, const ShapeModel& a, const Moves& motion_a,
                                       const ShapeModel& b, const Moves& motion_b) const {
    const Frame &at_a = frames_[a.frame], &at_b = frames_[b.frame];
    Floats n[3], local[3];
    for (int k = 0; k < 3; ++k)
      n[k] = at_a.r[3 * k] * w.normal[0] + at_a.r[3 * k + 1] * w.normal[1] +
             at_a.r[3 * k + 2] * w.normal[2];
    for (int k = 0; k < 3; ++k)
      local[k] = at_b.r[k] * n[0] + at_b.r[3 + k] * n[1] + at_b.r[6 + k] * n[2];
    const float* first = m_.corner[b.corners.begin].at;
    Floats least = local[0] * first[0] + local[1] * first[1] + local[2] * first[2];
    for (std::uint32_t i = b.corners.begin + 1; i < b.corners.end; ++i) {
      const float* p = m_.corner[i].at;
      const Floats along = local[0] * p[0] + local[1] * p[1] + local[2] * p[2];
      least = along < least ? along : least;
    }
    const Floats beyond = (at_b.t[0] - at_a.t[0]) * n[0] + (at_b.t[1] - at_a.t[1]) * n[1] +
                          (at_b.t[2] - at_a.t[2]) * n[2] + least;
    if constexpr (Moving) {
      const Floats moves =
          (motion_a.shift + motion_a.turn * a.reach + motion_b.shift + motion_b.turn * b.reach) *
          (1 + kMoves);
      return bits_of(~(beyond > moves + (w.offset + m_.slack)));
    } else {
      return bits_of(~(beyond > w.offset + m_.slack));
    }
  }

  /// @param suspect  lanes in which some bodies may not be apart even at the middles of stretches
  void note(unsigned doubt, unsigned meet, unsigned suspect = 0) {
    contact_ |= meet;
    open_ |= doubt & ~meet;
    if constexpr (Moving) {
      for (unsigned left = suspects_ == nullptr ? 0 : doubt & ~meet; left != 0; left &= left - 1) {
        Suspect& at = suspects_[__builtin_ctz(left)];
        const bool surely = ((suspect & left & -left) != 0);
        if (at.pair == Suspect::kNone || (surely && !at.unparted)) at = {number_, surely};
      }
    }
    if (pairs_ == nullptr) return;
    for (unsigned left = doubt & ~meet; left != 0; left &= left - 1) {
      std::uint32_t* row =
          pairs_ + static_cast<std::size_t>(__builtin_ctz(left)) * (OpenPairs::kMost + 1);
      std::uint32_t& number = row[0];
      if (number > OpenPairs::kMost || (number > 0 && row[number] == number_)) continue;
      if (++number <= OpenPairs::kMost) row[number] = number_;
    }
  }

  void place_outer(std::uint32_t s) {
    if ((m_.ready[s] & 1) != 0) return;
    m_.ready[s] |= 1;
    const ShapeModel& shape = m_.shape[s];
    for (std::uint32_t i = shape.bodies.begin; i < shape.bodies.end; ++i)
      bodies_[i] = place(frames_[shape.frame], m_.body[i].ball.center);
    const Range outer = outer_of(shape);
    for (std::uint32_t k = outer.begin; k < outer.end; ++k)
      outer_[k] = place(frames_[shape.frame], m_.outer[k].center);
  }
  /// Balls of all bodies.
  [[nodiscard]] Range outer_of(const ShapeModel& shape) const {
    if (shape.bodies.begin == shape.bodies.end) return {};
    return {m_.body[shape.bodies.begin].balls.begin, m_.body[shape.bodies.end - 1].balls.end};
  }
  void place_corners(std::uint32_t s) {
    if ((m_.ready[s] & 4) != 0) return;
    m_.ready[s] |= 4;
    const ShapeModel& shape = m_.shape[s];
    for (std::uint32_t k = shape.corners.begin; k < shape.corners.end; ++k)
      corners_[k] = place(frames_[shape.frame], m_.corner[k].at);
  }
  void place_inner(std::uint32_t s) {
    if ((m_.ready[s] & 2) != 0) return;
    m_.ready[s] |= 2;
    const ShapeModel& shape = m_.shape[s];
    for (std::uint32_t k = shape.inner.begin; k < shape.inner.end; ++k)
      inner_[k] = place(frames_[shape.frame], m_.inner[k].center);
  }

  /// Motion of a frame, as seen from one that it hangs from.
  [[nodiscard]] Motion motion_of(std::uint32_t frame, std::uint32_t from) const {
    const Point none{Floats{}, Floats{}, Floats{}};
    if (frame == from) return {Floats{}, Floats{}, none, none, Floats{}};
    const Motion &all = motions_[frame], &part = motions_[from];
    if (from == 0) return all;
    // Differences of sums that are rounded: what that takes is added.
    const float path = m_.step[frame - 1].path - m_.step[from - 1].path;
    const Floats turn = all.turn - part.turn, shift = all.shift - part.shift - part.turn * path;
    return {
        (turn > 0 ? turn : Floats{}) + all.turn * kMoves,
        (shift > 0 ? shift : Floats{}) + (all.shift + all.turn * m_.step[frame - 1].path) * kMoves,
        difference(all.spin, part.spin), difference(all.drift, part.drift), all.blur + part.blur};
  }
  [[nodiscard]] Moves whole_motion(std::uint32_t frame, std::uint32_t from) const {
    if constexpr (Moving)
      return motion_of(frame, from);
    else
      return {};
  }

  /// How far a point at so much from a frame's origin is from the straight way that it goes with
  /// its velocity at the middle, at most.
  [[nodiscard]] Floats bend_of(const Motion& motion, float length) const {
    return (motion.shift + motion.turn * length) * (motion.turn * m_.bend + kResidue) *
               (1 + kMoves) +
           motion.blur;
  }
  [[nodiscard]] Floats bent_offset_of(const Motion& motion, const BodyModel& body) const {
    return bend_of(motion, body.reach) + body.offset;
  }
  [[nodiscard]] Floats bent_radius_of(const Motion& motion, const FrameBall& ball,
                                      float more) const {
    return bend_of(motion, ball.length) + (ball.radius + more);
  }

  /// What is added to the extent of a body along any direction.
  [[nodiscard]] auto offset_of(const Moves& motion, const BodyModel& body) const {
    if constexpr (Moving)
      return (motion.shift + motion.turn * body.reach) * (1 + kMoves) + body.offset;
    else
      return body.offset;
  }

  /// Radius of a ball with a motion, and what is added to it.
  [[nodiscard]] auto radius_of(const Moves& motion, const FrameBall& ball, float more) const {
    if constexpr (Moving)
      return (motion.shift + motion.turn * ball.length) * (1 + kMoves) + (ball.radius + more);
    else
      return ball.radius + more;
  }

  const View& m_;
  std::uint32_t* pairs_;
  Suspect* suspects_;
  std::uint32_t number_ = 0;  ///< of the pair that is looked at
  Frame* frames_;
  Motion* motions_;
  Point *whole_, *clusters_, *outer_, *inner_, *corners_, *bodies_;
  unsigned all_ = 0, contact_ = 0, open_ = 0;
  unsigned meeting_ = 0;   ///< lanes in which the last search has found that bodies meet
  unsigned unparted_ = 0;  ///< lanes in which the last search has not parted bodies at all
};

/// @param ways  as of bound_motions; null: none
template <bool Moving>
void filter_all(const View& m, const double* rows, const double* ways, std::size_t count,
                Answer* answers) {
  for (std::size_t first = 0; first < count; first += KABOUM_LANES) {
    const std::size_t left = count - first;
    const unsigned here = left < KABOUM_LANES ? static_cast<unsigned>(left) : KABOUM_LANES;
    const std::size_t at = place_of(first, 0, m.variables);
    Pack<Moving> pack(m, rows + at, Moving ? ways + at : nullptr, here,
                      m.pairs == nullptr ? nullptr : m.pairs + first * (OpenPairs::kMost + 1),
                      m.suspects == nullptr ? nullptr : m.suspects + first);
    pack.decide();
    const unsigned contact = pack.contact(), open = pack.open();
    for (unsigned lane = 0; lane < here; ++lane)
      answers[first + lane] = ((contact >> lane) & 1) != 0 ? Answer::Contact
                              : ((open >> lane) & 1) != 0  ? Answer::Open
                                                           : Answer::Free;
    const bool stops = m.look == Look::One || m.look == Look::Contacts;
    if (!stops || contact == 0) continue;
    for (std::size_t i = first + here; i < count; ++i) answers[i] = Answer::Open;
    return;
  }
}
void filter_blocks(const View& m, const double* rows, const double* ways, std::size_t count,
                   Answer* answers) {
  if (ways != nullptr) return filter_all<true>(m, rows, ways, count, answers);
  filter_all<false>(m, rows, nullptr, count, answers);
}

void place_outer_balls(const View& m, const double* rows, std::size_t count, float* centers) {
  Frame* frames = reinterpret_cast<Frame*>(m.memory);
  for (std::size_t row = 0; row < count; ++row) {
    // Every lane reads within the blocks.
    const std::size_t first = row / KABOUM_LANES * KABOUM_LANES, lane = row - first;
    place_frames(m, rows + place_of(first, 0, m.variables), frames);
    for (std::size_t s = 0; s < m.shapes; ++s)
      for (std::uint32_t i = m.shape[s].bodies.begin; i < m.shape[s].bodies.end; ++i)
        for (std::uint32_t k = m.body[i].balls.begin; k < m.body[i].balls.end; ++k) {
          const Point p = place(frames[m.shape[s].frame], m.outer[k].center);
          float* out = centers + 3 * (row * m.outer_count + k);
          out[0] = p.x[lane];
          out[1] = p.y[lane];
          out[2] = p.z[lane];
        }
  }
}

void sines_of(const double* angles, std::size_t count, float* sines, float* cosines) {
  for (std::size_t first = 0; first < count; first += KABOUM_LANES) {
    Doubles angle{};
    const std::size_t left = count - first;
    for (std::size_t k = 0; k < KABOUM_LANES && k < left; ++k) angle[k] = angles[first + k];
    Floats s, c;
    sine_and_cosine(angle, s, c);
    for (std::size_t k = 0; k < KABOUM_LANES && k < left; ++k) {
      sines[first + k] = s[k];
      cosines[first + k] = c[k];
    }
  }
}
