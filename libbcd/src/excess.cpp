// A certified bracket of the largest distance from bodies to a solid, by branch and bound.
// docs/algorithms/convex-decomposition.md, "Excess", has the bounds and their proofs.

#include "excess.h"

#include <kaboum/base/parallel.h>
#include <kaboum/geom/convex_polytope.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <tuple>

#include "best_first.h"
#include "cell.h"

namespace kaboum::bcd {
namespace {

/// Rounding of midpoints and planes, as a share of the largest coordinate and the diagonal: far
/// above what a few halvings of doubles can lose.
constexpr double kDistanceSlack = 1e-13;
/// Splits of facets, before the inside is looked at: most bodies are farthest on a facet, and a
/// thousand tell where.
constexpr std::size_t kFacetParts = 200;
/// Planes that a cube is cut by: more cost more than eight smaller cubes.
constexpr std::size_t kMostCrossing = 12;
/// Triangles near a part whose shadows are looked at: beyond, the part is split.
constexpr std::size_t kMostNear = 24;
/// Work of bounding a part, and for each triangle that is looked at. [ns]
constexpr std::uint64_t kLook = 800, kTriangle = 60;

class Measure {
 public:
  Measure(const Mesh& body, const SolidField& solid, const ExcessOptions& options)
      : body_(body), solid_(solid), options_(options) {
    // Rounding of midpoints, far above what is possible.
    Box3 box = solid.box();
    for (const Vec3& p : body.vertices) box.extend(p);
    scale_ = box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff() + box.diagonal();
    slack_ = kDistanceSlack * scale_;
  }

  /// A first lower bound, from the facets' centres.
  double sample() {
    for (const Triangle& t : body_.triangles) {
      const Vec3 c = (body_.vertices[t[0]] + body_.vertices[t[1]] + body_.vertices[t[2]]) / 3;
      if (solid_.field(c) > result_.lower - 2 * solid_.spacing() && !solid_.contains(c))
        raise(solid_.surface().nearest(c).lower, c);
    }
    return result_.lower;
  }

  Excess run(double floor) {
    floor_ = floor;
    // Facets are part of the inside; most bodies are farthest there, which helps.
    facets();
    decided_ = 0;
    if (result_.lower <= options_.cutoff) inside();
    if (result_.lower > options_.cutoff) decide(kUnbounded);
    result_.upper = std::max({result_.lower, decided_, 0.0});
    if (result_.upper > 0) result_.upper += slack_;
    solid_.work().add(work_);
    return result_;
  }

 private:
  struct SubTriangle {
    std::array<Vec3, 3> corner;
    std::uint32_t hint;
    double upper = 0;
  };
  enum class Side : char { Unknown, Inside, Outside };
  struct Cube {
    Vec3 center;
    double half;
    std::uint32_t hint;
    double upper = 0;
    Side side = Side::Unknown;       ///< of the surface, where the centre is
    Side inherited = Side::Unknown;  ///< where the centres of its eighths are
    /// The part of the list of planes that has those of the body which may cross it.
    struct {
      std::uint32_t first = 0, last = 0;
    } planes{};
  };

  [[nodiscard]] double limit() const {
    return std::max({floor_, result_.lower * (1 + options_.relative_gap),
                     result_.lower + options_.absolute_gap});
  }
  /// Some points are at most this far.
  void decide(double upper) { decided_ = std::max(decided_, upper); }
  void raise(double lower, const Vec3& at) {
    if (lower <= result_.lower) return;
    result_.lower = lower;
    result_.at = at;
  }

  /// @param max_parts  that are split; beyond, the largest bound is what is known
  template <class Part, class Bound, class Split>
  void search(std::vector<Part> first, std::size_t max_parts, Bound&& bound, Split&& split) {
    std::size_t parts = 0;
    const auto decided = [&](const Part& part) {
      if (part.upper > limit()) return false;
      decide(part.upper);
      return true;
    };
    const auto enough = [&](const Part& part) {
      const bool ends = part.upper <= limit() || parts++ >= max_parts || work_ > options_.work ||
                        result_.lower > options_.cutoff;
      if (ends) decide(part.upper);  // no other is larger
      return ends;
    };
    best_first(std::move(first), bound, decided, enough, split);
  }

  /// The triangle nearest to a part's centre; counted.
  geom::TriangleSearch::Nearest nearest(const Vec3& p, std::uint32_t hint) {
    const auto at = solid_.surface().nearest(p, hint);
    work_ += kLook + kTriangle * at.looked;
    return at;
  }

  void facets() {
    std::vector<SubTriangle> first;
    for (const Triangle& t : body_.triangles)
      first.push_back({{body_.vertices[t[0]], body_.vertices[t[1]], body_.vertices[t[2]]},
                       geom::DistanceQuery::kNone});
    const auto bound = [&](SubTriangle& p) {
      const auto& [a, b, c] = p.corner;
      const Vec3 center = (a + b + c) / 3;
      const double radius = std::sqrt(std::max(
          {(a - center).squaredNorm(), (b - center).squaredNorm(), (c - center).squaredNorm()}));
      const auto at = nearest(center, p.hint);
      p.hint = at.triangle;
      p.upper = at.upper + radius;
      if (p.upper > limit()) {
        double corners = 0;
        for (const Vec3& v : p.corner)
          corners = std::max(corners, solid_.surface().to_triangle(v, at.triangle).upper);
        p.upper = std::min(p.upper, corners);
      }
      if (p.upper > limit()) {
        if (solid_.contains(center)) {
          if (at.lower >= radius * kLengthUp) return false;
          p.upper = std::min(p.upper, radius - at.lower);
        } else {
          raise(at.lower, center);
        }
      }
      return true;
    };
    search(std::move(first), std::min(options_.max_parts, kFacetParts), bound,
           [](SubTriangle p, const auto& visit) {
             int k = 0;
             double longest = -1;
             for (int i = 0; i < 3; ++i) {
               const double l = (p.corner[(i + 1) % 3] - p.corner[i]).squaredNorm();
               if (l > longest) {
                 longest = l;
                 k = i;
               }
             }
             const Vec3 middle = 0.5 * p.corner[k] + 0.5 * p.corner[(k + 1) % 3];
             SubTriangle q = p;
             p.corner[(k + 1) % 3] = middle;
             q.corner[k] = middle;
             visit(std::move(p));
             visit(std::move(q));
           });
  }

  /// By how much rounding may have moved a plane where bodies and solid are. [length]
  [[nodiscard]] double slack_of(const geom::FacetPlane& plane) const {
    return slack_ + plane.error * scale_;
  }
  static Plane cut_along(const geom::FacetPlane& plane) { return {plane.normal, plane.offset}; }

  /// The distance to one triangle is convex: largest at a corner.
  [[nodiscard]] double farthest(const Cell& part, std::uint32_t triangle) const {
    double out = 0;
    for (const Vec3& v : part.corners)
      out = std::max(out, solid_.surface().to_triangle(v, triangle).upper);
    return out;
  }

  /// The same for the points outside the solid alone, where a point of the part is inside and few
  /// triangles meet it: each such point is in the shadow of one of them, seen from there
  /// (docs/algorithms/convex-decomposition.md, "Excess").
  double farthest_outside(const Cell& part) {
    if (part.corners.empty()) return kUnbounded;
    // A little off the middle, where planes along the axes often are.
    Vec3 center = Vec3::Zero();
    double sum = 0;
    for (std::size_t i = 0; i < part.corners.size(); ++i) {
      const double weight = 8 + static_cast<double>(i);
      center += weight * part.corners[i];
      sum += weight;
    }
    center /= sum;
    if (!solid_.contains_round(center)) return kUnbounded;
    Box3 box;
    for (const Vec3& p : part.corners) box.extend(p);
    near_.clear();
    if (!solid_.triangles_near(box, kMostNear, near_)) return kUnbounded;
    double out = 0;
    for (const std::uint32_t t : near_) {
      const Cell* shadow = &part;  // then one of shadows_
      const auto keep_beyond = [&](const Vec3& p, const Vec3& q, const Vec3& r) {
        const auto plane = geom::facet_plane(p, q, r);
        if (!plane) return;
        Cell& next = shadow == &shadows_[0] ? shadows_[1] : shadows_[0];
        if (clip(*shadow, cut_along(*plane), false, slack_of(*plane), next)) shadow = &next;
      };
      const auto& [a, b, c] = solid_.surface().corners(t);
      const Vec3 ab = b - a, ac = c - a, n = ab.cross(ac);
      const double height = n.dot(center - a);
      const double error = slack_ * (n.norm() + ab.norm() * ac.norm());
      if (height > error) continue;  // seen from outside
      keep_beyond(a, b, c);
      if (height < -error)
        for (const auto& [p, q] : {std::tie(a, b), std::tie(b, c), std::tie(c, a)})
          if (!shadow->corners.empty()) keep_beyond(center, p, q);
      out = std::max(out, farthest(*shadow, t));
      if (out > limit()) return kUnbounded;
    }
    return out;
  }

  /// From a cube's centre to a corner.
  static Vec3 corner_of(int i, double half) {
    return {(i & 1) != 0 ? half : -half, (i & 2) != 0 ? half : -half, (i & 4) != 0 ? half : -half};
  }

  void inside() {
    Box3 box;
    for (const Vec3& p : body_.vertices) box.extend(p);
    // A facet whose plane is not known keeps nothing out, which is safe.
    const geom::ConvexPolytope polytope(body_);
    // Planes that neither keep out all of a cube nor hold all of it, one list after the other: of
    // its eighths there are no others.
    std::vector<std::uint32_t> lists(polytope.planes().size());
    std::iota(lists.begin(), lists.end(), 0U);
    std::vector<std::uint32_t> crossing;
    std::vector<Cube> first;
    for (const bcd::Cube& cube : cubes_over(box)) {
      first.push_back({cube.center, cube.half, geom::DistanceQuery::kNone});
      first.back().planes = {0, static_cast<std::uint32_t>(lists.size())};
    }
    const auto bound = [&](Cube& cube) {
      crossing.clear();
      for (std::size_t k = cube.planes.first; k < cube.planes.last; ++k) {
        const geom::FacetPlane& plane = polytope.planes()[lists[k]];
        const double h = plane.height(cube.center), slack = slack_of(plane);
        const double extent = cube.half * plane.normal.cwiseAbs().sum();
        if (h - extent > slack) return false;
        if (h + extent > -slack) crossing.push_back(lists[k]);
      }
      const double radius = cube.half * kHalfDiagonal;
      const auto at = nearest(cube.center, cube.hint);
      cube.hint = at.triangle;
      cube.upper = at.upper + radius;
      if (cube.upper > limit()) {
        if (cube.side == Side::Unknown)
          cube.side = solid_.contains(cube.center) ? Side::Inside : Side::Outside;
        if (cube.side == Side::Inside) {
          if (at.lower >= radius * kLengthUp) return false;
          cube.upper = std::min(cube.upper, radius - at.lower);
        } else if (at.lower > result_.lower && polytope.contains(cube.center)) {
          raise(at.lower, cube.center);
        }
      }
      // Where no triangle is between here and there.
      cube.inherited = at.lower > 0.5 * radius * kLengthUp ? cube.side : Side::Unknown;
      if (cube.upper > limit() && crossing.empty()) {
        double corners = 0;
        for (int i = 0; i < 8; ++i)
          corners =
              std::max(corners, solid_.surface()
                                    .to_triangle(cube.center + corner_of(i, cube.half), at.triangle)
                                    .upper);
        cube.upper = std::min(cube.upper, corners);
      }
      if (cube.upper > limit() && !crossing.empty() && crossing.size() <= kMostCrossing) {
        const Vec3 h = Vec3::Constant(cube.half);
        parts_[0] = Cell::of({cube.center - h, cube.center + h});
        std::size_t now = 0;
        for (const std::uint32_t i : crossing) {
          const geom::FacetPlane& plane = polytope.planes()[i];
          if (clip(parts_[now], cut_along(plane), true, slack_of(plane), parts_[1 - now]))
            now = 1 - now;
        }
        const Cell& part = parts_[now];
        cube.upper = std::min(cube.upper, farthest(part, at.triangle));
        if (cube.side == Side::Inside) {
          double far = 0;
          for (const Vec3& v : part.corners) far = std::max(far, (v - cube.center).norm());
          cube.upper = std::min(cube.upper, std::max(0.0, far - at.lower));
        }
        if (cube.upper > limit()) cube.upper = std::min(cube.upper, farthest_outside(part));
      }
      if (cube.upper > limit() && crossing.size() < cube.planes.last - cube.planes.first) {
        cube.planes.first = static_cast<std::uint32_t>(lists.size());
        lists.insert(lists.end(), crossing.begin(), crossing.end());
        cube.planes.last = static_cast<std::uint32_t>(lists.size());
      }
      return true;
    };
    search(std::move(first), options_.max_parts, bound, [](const Cube& cube, const auto& visit) {
      const double h = 0.5 * cube.half;
      for (int i = 0; i < 8; ++i)
        visit(Cube{cube.center + corner_of(i, h), h, cube.hint, 0, cube.inherited, Side::Unknown,
                   cube.planes});
    });
  }

  static constexpr double kUnbounded = std::numeric_limits<double>::infinity();

  const Mesh& body_;
  const SolidField& solid_;
  const ExcessOptions& options_;
  std::vector<std::uint32_t> near_;
  std::array<Cell, 2> parts_, shadows_;  ///< room for what is cut, in turns
  double floor_ = 0;
  double scale_ = 0, slack_ = 0;
  double decided_ = 0;
  std::uint64_t work_ = 0;
  Excess result_;
};

}  // namespace

namespace {

/// Distances of bodies from the solid, where no region weighs them.
std::vector<Excess> measure_alike(const std::vector<Mesh>& bodies, const SolidField& solid,
                                  const ExcessOptions& options, double floor, double ceiling) {
  std::vector<Measure> measures;
  measures.reserve(bodies.size());
  for (const Mesh& body : bodies) measures.emplace_back(body, solid, options);
  std::vector<double> sampled(bodies.size());
  parallel_for(std::size_t{0}, bodies.size(),
               [&](std::size_t i) { sampled[i] = measures[i].sample(); });
  // Only the largest matters: the others are told from it, not measured.
  for (const double s : sampled)
    floor = std::max(floor, options.worth_measuring * std::min(s, ceiling));
  std::vector<Excess> out(bodies.size());
  parallel_for(std::size_t{0}, bodies.size(),
               [&](std::size_t i) { out[i] = measures[i].run(floor); });
  return out;
}

}  // namespace

std::vector<Excess> measure(const std::vector<Mesh>& bodies, const SolidField& solid,
                            const ExcessOptions& options, double floor, double ceiling) {
  std::map<double, std::vector<std::size_t>> of_weight;
  for (std::size_t i = 0; i < bodies.size(); ++i)
    of_weight[solid.weight(bodies[i].vertices)].push_back(i);
  std::vector<Excess> out(bodies.size());
  for (const auto& [weight, which] : of_weight) {
    if (which.size() == bodies.size() && weight == 1)
      return measure_alike(bodies, solid, options, floor, ceiling);
    std::vector<Mesh> some;
    some.reserve(which.size());
    for (const std::size_t i : which) some.push_back(bodies[i]);
    ExcessOptions how = options;
    how.absolute_gap /= weight;
    how.cutoff /= weight;
    const std::vector<Excess> found =
        measure_alike(some, solid, how, floor / weight, ceiling / weight);
    for (std::size_t k = 0; k < which.size(); ++k) {
      Excess& one = out[which[k]];
      one = found[k];
      one.weight = weight;
      one.lower *= weight;
      one.upper *= weight;
    }
  }
  return out;
}

}  // namespace kaboum::bcd
