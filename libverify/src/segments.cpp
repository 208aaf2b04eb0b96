// The lines in which other faces meet a face.
#include "segments.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <cmath>

#include "allowance.h"

namespace kaboum::verify {
namespace {

class Collector {
 public:
  Collector(const MeshPair& meshes, std::uint32_t face, std::size_t limit,
            std::span<const std::uint32_t> decided)
      : meshes_(meshes),
        index_(face),
        face_(meshes_.face(face)),
        limit_(limit),
        decided_(decided.begin(), decided.end()) {
    std::sort(decided_.begin(), decided_.end());
  }

  void add(const Contacts::Cut& cut) {
    constexpr std::uint64_t kSegment = 4000;  // about nanoseconds
    count_steps(kSegment);
    if (cut.coplanar) {
      add_coplanar(cut.by);
    } else {
      add_crossing(cut.by);
    }
    if (segments_.size() > limit_) {
      throw Error(ErrorCode::LimitReached, "a triangle is cut into more pieces than allowed");
    }
  }

  std::vector<Segment> take() {
    for (Segment& s : segments_) finish(s);
    return std::move(segments_);
  }

 private:
  [[nodiscard]] const Vec3& corner(int k) const { return meshes_.point(face_.v[k]); }

  /// Doubled areas in f's projection, positive for an upward turn of f.
  [[nodiscard]] Exact area(const Vec3& a, const Vec3& b, const Vec3& c) const {
    const Exact value = orient2d_value<Exact>(face_.axis, a, b, c);
    return face_.upward ? value : -value;
  }

  /// Barycentric coordinates of a vertex in the face's plane, times the face's doubled area.
  [[nodiscard]] Triple<Exact> barycentric(std::uint32_t vertex) const {
    for (int k = 0; k < 3; ++k) {
      if (face_.v[k] != vertex) continue;
      Triple<Exact> unit{Exact(0), Exact(0), Exact(0)};
      unit[k] = area(corner(0), corner(1), corner(2));
      return unit;
    }
    const Vec3& p = meshes_.point(vertex);
    return {area(corner(1), corner(2), p), area(corner(2), corner(0), p),
            area(corner(0), corner(1), p)};
  }

  [[nodiscard]] Exact height(std::uint32_t vertex) const {
    for (const std::uint32_t v : face_.v) {
      if (v == vertex) return {0};
    }
    return orient3d_value<Exact>(corner(0), corner(1), corner(2), meshes_.point(vertex));
  }

  /// The segment that is the intersection with a face in another plane.
  void add_crossing(std::uint32_t gi) {
    const Face& g = meshes_.face(gi);
    Segment s;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = face_.v[k];
      s.line[k] = v == g.v[0] || v == g.v[1] || v == g.v[2]
                      ? Exact(0)
                      : orient3d_value<Exact>(meshes_.point(g.v[0]), meshes_.point(g.v[1]),
                                              meshes_.point(g.v[2]), corner(k));
    }
    const Crossing f_ends = crossing(face_, sides_of(meshes_, face_, gi));
    const Crossing g_ends = crossing(g, sides_of(meshes_, g, index_));
    std::array<std::array<int, 2>, 2> order{};
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j)
        order[i][j] = to_int(order_of(meshes_, f_ends.ends[i], g_ends.ends[j]));
    }
    // The ends of the overlap: f's ends within g, and g's ends strictly within f.
    int found = 0;
    std::array<Triple<Exact>, 2> ends;
    for (int i = 0; i < 2; ++i) {
      if (order[i][0] * order[i][1] <= 0 && found < 2)
        ends[found++] = on_own_edge(s.line, f_ends.ends[i]);
    }
    for (int j = 0; j < 2; ++j) {
      if (order[0][j] * order[1][j] < 0 && found < 2) ends[found++] = on_other_edge(g_ends.ends[j]);
    }
    if (found != 2) {
      throw Error(ErrorCode::Internal, "a segment between two triangles without two ends");
    }
    s.p = std::move(ends[0]);
    s.q = std::move(ends[1]);
    segments_.push_back(std::move(s));
  }

  /// Where an edge of the face crosses the line.
  [[nodiscard]] Triple<Exact> on_own_edge(const Triple<Exact>& line,
                                          const Crossing::End& end) const {
    int i = 0, j = 0;
    for (int k = 0; k < 3; ++k) {
      if (face_.v[k] == end.from) i = k;
      if (face_.v[k] == end.to) j = k;
    }
    Triple<Exact> point{Exact(0), Exact(0), Exact(0)};
    point[i] = -line[j];  // `to` is below or on the plane, `from` above or on it
    point[j] = line[i];
    return point;
  }

  /// Where an edge of the other face crosses this face's plane.
  [[nodiscard]] Triple<Exact> on_other_edge(const Crossing::End& end) const {
    return combine(height(end.from), barycentric(end.to), -height(end.to), barycentric(end.from));
  }

  /// The edges of a face in the same plane, as far as they run through the interior.
  void add_coplanar(std::uint32_t gi) {
    const Face& g = meshes_.face(gi);
    for (int e = 0; e < 3; ++e) {
      const std::uint32_t a = std::min(g.v[e], g.v[(e + 1) % 3]),
                          b = std::max(g.v[e], g.v[(e + 1) % 3]);
      if (runs_outside(a, b) || between_settled(gi, a, b) || !edges_.emplace(a, b).second) continue;
      Segment s;
      s.p = barycentric(a);
      s.q = barycentric(b);
      if (!clip(s.p, s.q)) continue;
      const Vec3 &from = meshes_.point(a), &to = meshes_.point(b);
      for (int k = 0; k < 3; ++k) {
        s.line[k] = face_.v[k] == a || face_.v[k] == b ? Exact(0) : area(from, to, corner(k));
      }
      segments_.push_back(std::move(s));
    }
  }

  /// Whether both ends are beyond, or on, one edge of the face: clip would leave nothing.
  [[nodiscard]] bool runs_outside(std::uint32_t a, std::uint32_t b) const {
    const Sign in = face_.upward ? Sign::Positive : Sign::Negative;
    for (int k = 0; k < 3; ++k) {
      const int from = (k + 1) % 3, to = (k + 2) % 3;
      const auto is_in = [&](std::uint32_t v) {
        if (v == face_.v[k]) return true;
        if (v == face_.v[from] || v == face_.v[to]) return false;
        return orient2d(face_.axis, corner(from), corner(to), meshes_.point(v)) == in;
      };
      if (!is_in(a) && !is_in(b)) return true;
    }
    return false;
  }

  /// Whether the only faces of g's chain along its edge are decided ones.
  [[nodiscard]] bool between_settled(std::uint32_t gi, std::uint32_t a, std::uint32_t b) const {
    if (decided_.empty()) return false;
    int count = 0;
    for (const std::uint32_t h : meshes_.around_edge(a, b)) {
      const Face& face = meshes_.face(h);
      if (face.chain != meshes_.face(gi).chain) continue;
      if (face.place_of(a) < 0 || face.place_of(b) < 0) continue;
      if (!std::binary_search(decided_.begin(), decided_.end(), h)) return false;
      ++count;
    }
    return count == 2;
  }

  /// Cuts off what lies outside the face. @return false when nothing of the interior is left.
  static bool clip(Triple<Exact>& p, Triple<Exact>& q) {
    for (int k = 0; k < 3; ++k) {
      const Sign sp = sign_of(p[k]), sq = sign_of(q[k]);
      if (sp != Sign::Positive && sq != Sign::Positive) return false;
      if (sp == Sign::Negative) {
        p = combine(q[k], p, -p[k], q);
      } else if (sq == Sign::Negative) {
        q = combine(p[k], q, -q[k], p);
      }
    }
    return true;
  }

  static void finish(Segment& s) {
    s.approx_line = rounded(s.line);
    s.approx_p = rounded(s.p);
    s.approx_q = rounded(s.q);
    s.box = {0, 0, 1, 1};
    const Approx total_p = total_of(s.approx_p), total_q = total_of(s.approx_q);
    if (!usable(total_p) || !usable(total_q)) return;
    for (int k = 0; k < 2; ++k) {
      const Approx a = share(s.approx_p[k], total_p), b = share(s.approx_q[k], total_q);
      const double low = std::min(a.value - a.error, b.value - b.error);
      const double high = std::max(a.value + a.error, b.value + b.error);
      // A weight lies between 0 and 1; anything else, NaN included, is too inexact to be of use.
      if (!std::isfinite(a.value + a.error + b.value + b.error) || low < -1 || high > 2) continue;
      s.box[k] = low;
      s.box[2 + k] = high;
    }
  }

  const MeshPair& meshes_;
  std::uint32_t index_;
  const Face& face_;
  std::size_t limit_;
  std::vector<Segment> segments_;
  std::vector<std::uint32_t> decided_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges_;
};

}  // namespace

Triple<Approx> rounded(const Triple<Exact>& x) {
  return {verify::rounded(x[0]), verify::rounded(x[1]), verify::rounded(x[2])};
}

Triple<Exact> cross(const Triple<Exact>& a, const Triple<Exact>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

Triple<Exact> combine(const Exact& x, const Triple<Exact>& a, const Exact& y,
                      const Triple<Exact>& b) {
  return {x * a[0] + y * b[0], x * a[1] + y * b[1], x * a[2] + y * b[2]};
}

Triple<Exact> made_positive(Triple<Exact> a) {
  if (sign_of(a[0] + a[1] + a[2]) == Sign::Negative) {
    for (Exact& x : a) x = -x;
  }
  return a;
}

Sign sign_on(const Triple<Approx>& approx_line, const Triple<Exact>& line,
             const Triple<Approx>& approx_point, const Triple<Exact>& point) {
  if (const auto sign = sign_of(dot(approx_line, approx_point))) return *sign;
  constexpr std::uint64_t kExact = 1000;  // about nanoseconds
  count_steps(kExact);
  return sign_of(dot(line, point));
}

double ratio_of(const Triple<Exact>& a, const Triple<Exact>& b) {
  const auto magnitude = [](const Triple<Exact>& x) {
    return verify::rounded(x[0] + x[1] + x[2]).value;
  };
  const double ratio = magnitude(b) / magnitude(a);
  return ratio > 1e-200 && ratio < 1e200 ? std::exp2(std::round(std::log2(ratio))) : 1;
}

Approx total_of(const Triple<Approx>& weights) { return weights[0] + weights[1] + weights[2]; }

bool usable(const Approx& total) {
  return total.value > 1e-200 && total.value < 1e200 && total.error < 0.25 * total.value;
}

Approx share(const Approx& weight, const Approx& total) {
  return {weight.value / total.value,
          (weight.error + 2 * total.error) / (0.5 * total.value) + 4 * kUnit};
}

std::vector<Segment> segments_of(const Arrangement& arrangement, std::uint32_t face,
                                 OperandMask mask, std::size_t limit,
                                 std::span<const std::uint32_t> decided) {
  Collector collector(arrangement.meshes(), face, limit, decided);
  const int chain = arrangement.meshes().face(face).chain;
  for (int c = 0; c < 2; ++c) {
    if ((mask & mask_of(c)) == 0) continue;
    for (const Contacts::Cut& cut : arrangement.contacts(chain, c).cuts(face)) collector.add(cut);
  }
  return collector.take();
}

}  // namespace kaboum::verify
