// The cells that triangles cut a face into, by one spot on either side of every piece of the lines
// in which they meet it. Every cell but an uncut face touches such a piece, so that neither a
// planar arrangement nor a sorting round points is needed.

#include <kaboum/geom/error.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "spot.h"

namespace kaboum::verify {
namespace {

/// A segment within the face: barycentric coordinates of its ends (non-negative up to a positive
/// factor) and of its line (linear function, zero on it).
struct Segment {
  Triple<Exact> line, p, q;
  Triple<Approx> approx_line, approx_p, approx_q;
  std::array<double, 4> box;  ///< of the first two coordinates, normalised: low, low, high, high
};

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
  return sign_of(dot(line, point));
}

constexpr std::size_t kTestsPerPiece = 200;  // of segments against each other, within the limit

class Cutter {
 public:
  Cutter(const Arrangement& arrangement, std::uint32_t face, std::size_t limit,
         std::span<const std::uint32_t> settled)
      : scene_(arrangement.scene()),
        index_(face),
        face_(scene_.face(face)),
        limit_(limit),
        settled_(settled.begin(), settled.end()) {
    std::sort(settled_.begin(), settled_.end());
  }

  void add(const Contacts::Cut& cut) {
    if (cut.coplanar) {
      add_coplanar(cut.by);
    } else {
      add_crossing(cut.by);
    }
    if (segments_.size() > limit_) fail();
  }

  void visit(const SpotVisitor& visitor) {
    for (Segment& s : segments_) finish(s);
    split();
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      if (!sample(i, visitor)) return;
    }
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(ErrorCode::LimitReached, "a triangle is cut into more pieces than allowed");
  }

  [[nodiscard]] const Vec3& corner(int k) const { return scene_.point(face_.v[k]); }

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
    const Vec3& p = scene_.point(vertex);
    return {area(corner(1), corner(2), p), area(corner(2), corner(0), p),
            area(corner(0), corner(1), p)};
  }

  [[nodiscard]] Exact height(std::uint32_t vertex) const {
    for (const std::uint32_t v : face_.v) {
      if (v == vertex) return {0};
    }
    return orient3d_value<Exact>(corner(0), corner(1), corner(2), scene_.point(vertex));
  }

  /// The segment that is the intersection with a face in another plane.
  void add_crossing(std::uint32_t gi) {
    const Face& g = scene_.face(gi);
    Segment s;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = face_.v[k];
      s.line[k] = v == g.v[0] || v == g.v[1] || v == g.v[2]
                      ? Exact(0)
                      : orient3d_value<Exact>(scene_.point(g.v[0]), scene_.point(g.v[1]),
                                              scene_.point(g.v[2]), corner(k));
    }
    const Crossing f_ends = crossing(face_, sides_of(scene_, face_, gi));
    const Crossing g_ends = crossing(g, sides_of(scene_, g, index_));
    std::array<std::array<int, 2>, 2> order{};
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j)
        order[i][j] = to_int(order_of(scene_, f_ends.ends[i], g_ends.ends[j]));
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
    const Face& g = scene_.face(gi);
    for (int e = 0; e < 3; ++e) {
      const std::uint32_t a = std::min(g.v[e], g.v[(e + 1) % 3]),
                          b = std::max(g.v[e], g.v[(e + 1) % 3]);
      if (!edges_.emplace(a, b).second || between_settled(gi, a, b)) continue;
      Segment s;
      s.p = barycentric(a);
      s.q = barycentric(b);
      if (!clip(s.p, s.q)) continue;
      const Vec3 &from = scene_.point(a), &to = scene_.point(b);
      for (int k = 0; k < 3; ++k) {
        s.line[k] = face_.v[k] == a || face_.v[k] == b ? Exact(0) : area(from, to, corner(k));
      }
      segments_.push_back(std::move(s));
    }
  }

  /// Whether the only faces of g's chain along its edge are settled ones.
  [[nodiscard]] bool between_settled(std::uint32_t gi, std::uint32_t a, std::uint32_t b) const {
    if (settled_.empty()) return false;
    int count = 0;
    for (const std::uint32_t h : scene_.around_edge(a, b)) {
      const Face& face = scene_.face(h);
      if (face.chain != scene_.face(gi).chain) continue;
      if (face.place_of(a) < 0 || face.place_of(b) < 0) continue;
      if (!std::binary_search(settled_.begin(), settled_.end(), h)) return false;
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
    const Approx total_p = sum(s.approx_p), total_q = sum(s.approx_q);
    if (!usable(total_p) || !usable(total_q)) return;
    for (int k = 0; k < 2; ++k) {
      const Approx a = ratio(s.approx_p[k], total_p), b = ratio(s.approx_q[k], total_q);
      const double low = std::min(a.value - a.error, b.value - b.error);
      const double high = std::max(a.value + a.error, b.value + b.error);
      // A weight lies between 0 and 1; anything else, NaN included, is too inexact to be of use.
      if (!std::isfinite(a.value + a.error + b.value + b.error) || low < -1 || high > 2) continue;
      s.box[k] = low;
      s.box[2 + k] = high;
    }
  }

  static Approx sum(const Triple<Approx>& x) { return x[0] + x[1] + x[2]; }
  /// Whether one can divide by it.
  static bool usable(const Approx& total) {
    return total.value > 1e-200 && total.value < 1e200 && total.error < 0.25 * total.value;
  }
  /// x / total for weights 0 ≤ x ≤ total; @pre usable(total)
  static Approx ratio(const Approx& x, const Approx& total) {
    return {x.value / total.value, (x.error + 2 * total.error) / (0.5 * total.value) + 4 * kUnit};
  }

  /// Finds where segments meet: each one's interior points that lie on another.
  void split() {
    splits_.resize(segments_.size());
    std::vector<std::uint32_t> order(segments_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
      const double a = segments_[i].box[0], b = segments_[j].box[0];
      return a != b ? a < b : i < j;
    });
    std::size_t pieces = segments_.size(), tests = 0;
    for (std::size_t x = 0; x < order.size(); ++x) {
      const Segment& s = segments_[order[x]];
      for (std::size_t y = x + 1; y < order.size(); ++y) {
        const Segment& t = segments_[order[y]];
        if (t.box[0] > s.box[2]) break;
        if (++tests > kTestsPerPiece * limit_) fail();
        if (t.box[1] > s.box[3] || s.box[1] > t.box[3]) continue;
        meet(order[x], order[y]);
      }
      pieces += splits_[order[x]].size();
      if (pieces > limit_) fail();
    }
  }

  void meet(std::uint32_t i, std::uint32_t j) {
    const Segment &s = segments_[i], &t = segments_[j];
    const Sign tp = sign_on(s.approx_line, s.line, t.approx_p, t.p);
    const Sign tq = sign_on(s.approx_line, s.line, t.approx_q, t.q);
    if (tp == tq && tp != Sign::Zero) return;
    const Sign sp = sign_on(t.approx_line, t.line, s.approx_p, s.p);
    const Sign sq = sign_on(t.approx_line, t.line, s.approx_q, s.q);
    if (sp == sq && sp != Sign::Zero) return;
    if (tp == Sign::Zero && tq == Sign::Zero) {  // on one line; ends outside are sorted out later
      splits_[i].push_back(t.p);
      splits_[i].push_back(t.q);
      splits_[j].push_back(s.p);
      splits_[j].push_back(s.q);
      return;
    }
    const bool within_s = sp != Sign::Zero && sq != Sign::Zero;
    const bool within_t = tp != Sign::Zero && tq != Sign::Zero;
    if (!within_s && !within_t) return;  // end to end
    const Triple<Exact> point = !within_s   ? (sp == Sign::Zero ? s.p : s.q)
                                : !within_t ? (tp == Sign::Zero ? t.p : t.q)
                                            : made_positive(cross(s.line, t.line));
    if (within_s) splits_[i].push_back(point);
    if (within_t) splits_[j].push_back(point);
  }

  /// Spots on both sides of every piece of segment i. @return false if the visitor has seen enough
  [[nodiscard]] bool sample(std::size_t i, const SpotVisitor& visitor) const {
    const Segment& s = segments_[i];
    int apex = 0;
    while (sign_of(s.line[apex]) == Sign::Zero) ++apex;
    const int u = (apex + 1) % 3, v = (apex + 2) % 3;
    // Orientation of two points of the line and the corner off it: their order.
    const auto turn = [&](const Triple<Exact>& a, const Triple<Exact>& b) {
      return sign_of(a[u] * b[v] - a[v] * b[u]);
    };
    const Sign forward = turn(s.p, s.q);
    if (forward == Sign::Zero) {
      throw Error(ErrorCode::Internal, "a segment of no length between two triangles");
    }
    std::vector<const Triple<Exact>*> points;
    for (const Triple<Exact>& x : splits_[i]) {
      if (turn(s.p, x) == forward && turn(x, s.q) == forward) points.push_back(&x);
    }
    std::sort(points.begin(), points.end(), [&](const Triple<Exact>* a, const Triple<Exact>* b) {
      return turn(*a, *b) == forward;
    });
    points.push_back(&s.q);
    const Triple<Exact>* last = &s.p;
    Spot spot;
    spot.face = index_;
    for (const Triple<Exact>* next : points) {
      if (turn(*last, *next) == Sign::Zero) continue;  // the same point twice
      spot.exact = between(*last, *next);
      spot.approx = rounded(spot.exact);
      spot.line = s.line;
      if (!visitor(spot)) return false;
      spot.line = Triple<Exact>{-s.line[0], -s.line[1], -s.line[2]};
      if (!visitor(spot)) return false;
      last = next;
    }
    return true;
  }

  /// A point between two, near the middle.
  static Triple<Exact> between(const Triple<Exact>& a, const Triple<Exact>& b) {
    const auto magnitude = [](const Triple<Exact>& x) {
      return verify::rounded(x[0] + x[1] + x[2]).value;
    };
    const double ratio = magnitude(b) / magnitude(a);
    double factor = 1;
    if (ratio > 1e-200 && ratio < 1e200) factor = std::exp2(std::round(std::log2(ratio)));
    return combine(Exact(factor), a, Exact(1), b);
  }

  const Scene& scene_;
  std::uint32_t index_;
  const Face& face_;
  std::size_t limit_;
  std::vector<Segment> segments_;
  std::vector<std::vector<Triple<Exact>>> splits_;
  std::vector<std::uint32_t> settled_;
  std::set<std::pair<std::uint32_t, std::uint32_t>> edges_;
};

}  // namespace

Spot middle_spot(std::uint32_t face) {
  const Approx one{1, 0};
  return {face, {Exact(1), Exact(1), Exact(1)}, {one, one, one}, {}};
}

Vec3 position(const Scene& scene, const Spot& spot) {
  const Triple<Approx>& w = spot.approx;
  const double total = w[0].value + w[1].value + w[2].value;
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < 3; ++k) p += w[k].value / total * scene.corner(spot.face, k);
  return p;
}

void visit_spots(const Arrangement& arrangement, std::uint32_t face, ChainMask mask,
                 std::size_t limit, std::span<const std::uint32_t> settled,
                 const SpotVisitor& visitor) {
  if (arrangement.whole(face, mask)) {
    visitor(middle_spot(face));
    return;
  }
  Cutter cutter(arrangement, face, limit, settled);
  const int chain = arrangement.scene().face(face).chain;
  for (int c = 0; c < 2; ++c) {
    if ((mask & mask_of(c)) == 0) continue;
    for (const Contacts::Cut& cut : arrangement.contacts(chain, c).cuts(face)) cutter.add(cut);
  }
  cutter.visit(visitor);
}

}  // namespace kaboum::verify
