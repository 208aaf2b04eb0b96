#include "pockets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nearest.h"
#include "parallel.h"
#include "spot.h"
#include "tetrahedra.h"

namespace kaboum::verify {
namespace {

constexpr int kClimbs = 200;
constexpr std::size_t kFewFaces = 1000;
constexpr int kTurns = 8;
constexpr std::size_t kMostFaces = 200, kMostParts = 300, kMostPrisms = 100;
// What a box takes, and trying to cut it, in parts.
constexpr std::size_t kBoxWork = 8, kThinWork = 32, kBodiesWork = 8;
constexpr double kSoon = 4;  // radii of boxes, in what distances are below the limit
constexpr double kNowhere = -std::numeric_limits<double>::infinity();

/// Halves boxes until each of them is settled.
class Search {
 public:
  Search(const Scene& scene, const std::vector<std::uint32_t>& offending, const Limit& limit)
      : scene_(scene),
        boundary_(tree_of(scene, offending)),
        limit_(limit),
        slack_(rounding_of_distances(scene.largest_coordinate())) {}

  /// Verified, refuted with a witness, or undecided.
  [[nodiscard]] Claim within_limit() const {
    Claim claim;
    std::vector<Bounds> cells{boundary_.nodes().front().box}, open;
    std::vector<Look> looks;
    std::size_t seen = 0, work = 0;
    for (; !cells.empty(); cells.swap(open)) {
      seen += cells.size();
      if (seen > limit_.max_cells || work > limit_.max_work) {
        claim.answer = Answer::Undecided;
        claim.reason =
            "not decided within the work allowed, " + std::to_string(seen - cells.size()) +
            " boxes looked at; the largest distance may be close to the limit, and a slightly "
            "larger one be decided";
        return claim;
      }
      looks.assign(cells.size(), {});
      verify::parallel_loop(std::size_t{0}, cells.size(),
                            [&](std::size_t i) { looks[i] = look_at(cells[i]); });
      const auto deepest =
          std::max_element(looks.begin(), looks.end(),
                           [](const Look& a, const Look& b) { return a.beyond < b.beyond; });
      if (climb(*deepest) > 0) {
        claim.answer = Answer::Refuted;
        claim.witness = Witness{scene_.point_outside(deepest->point),
                                scene_.length_outside(deepest->beyond), true};
        return claim;
      }
      open.clear();
      for (std::size_t i = 0; i < cells.size(); ++i) {
        work += looks[i].work;
        if (looks[i].settled) continue;
        if (size(cells[i]) <= slack_) {
          claim.answer = Answer::Undecided;
          claim.reason =
              "the largest distance is the limit, but for rounding, as far as can be told; a "
              "slightly larger one may be decided";
          return claim;
        }
        halve(cells[i], open);
      }
    }
    claim.answer = Answer::Verified;
    return claim;
  }

 private:
  struct Look {
    bool settled = false;
    Vec3 point = Vec3::Zero();
    /// `point` is in Z, and its distance exceeds the limit by at least this; −∞: not in Z.
    double beyond = kNowhere;
    std::size_t work = kBoxWork;
  };

  [[nodiscard]] Look look_at(const Bounds& cell) const {
    // Off the middle, which meshes with round coordinates like to have their planes through.
    static const Vec3 kPlace(0.4877, 0.5131, 0.5023);
    const Vec3 low(cell.low.data()), high(cell.high.data());
    Look look;
    look.point = low + kPlace.cwiseProduct(high - low);
    const double radius = (high - look.point).cwiseMax(look.point - low).norm() + slack_;

    const NearestTriangle target(limit_.triangles, limit_.target);
    const NearestTriangle::Hit hit = target.nearest(look.point);
    look.settled =
        hit.distance + slack_ + radius <= limit_.distance || near(corners(cell), hit.face);
    if (!look.settled && limit_.bodies != nullptr) look.settled = limit_.bodies->one_holds(cell);
    if (!look.settled && limit_.to_outside) look.settled = near_outside(look.point, radius);
    if (look.settled) return look;

    const std::optional<bool> in = in_pocket(look.point);
    if (in.has_value() && !*in) {
      // The box lies outside Z as its point does without a triangle of Z's boundary, or of the
      // chain that the point is on the wrong side of.
      const auto clear = [&](const BoxTree& tree) {
        return NearestTriangle(scene_, tree).all_beyond(look.point, radius + slack_);
      };
      look.settled =
          clear(boundary_) ||
          (winding_at(scene_, kOutside, look.point).value_or(0) >= 1 &&
           clear(scene_.tree(kOutside))) ||
          (winding_at(scene_, kInside, look.point).value_or(1) < 1 && clear(scene_.tree(kInside)));
    } else if (in.has_value()) {
      look.beyond = beyond(look.point);
    }
    if (!look.settled && limit_.inside_only) {
      look.settled = no_maximum(look.point, radius, hit.distance);
    }
    // Where a few halvings will do, cutting costs more than they.
    const bool soon = radius <= kSoon * (limit_.distance - hit.distance);
    if (!look.settled && limit_.bodies != nullptr)
      look.settled = left_by_bodies(cell, hit.face, look.work);
    if (!look.settled && !soon) look.settled = thin(cell, look.point, hit.face, look.work);
    return look;
  }

  /// Whether some point outside the inner solid is within the limit of the whole ball: its centre,
  /// or a point beyond the face nearest to that.
  [[nodiscard]] bool near_outside(const Vec3& p, double radius) const {
    const auto outside = [&](const Vec3& x) {
      return winding_at(scene_, kInside, x).value_or(1) < 1;
    };
    if (radius > limit_.distance) return false;
    if (outside(p)) return true;
    const NearestTriangle::Hit hit = NearestTriangle(scene_, kInside).nearest(p);
    const double left = limit_.distance - radius - hit.distance;
    if (!(left > 4 * slack_) || !(hit.distance > 0)) return false;
    const Vec3 way = (closest(p, hit.face) - p) / hit.distance;
    const Vec3 beyond_it = p + (hit.distance + std::min(left / 2, hit.distance / 16)) * way;
    return (beyond_it - p).norm() + slack_ + radius <= limit_.distance && outside(beyond_it);
  }

  /// Whether no point of the ball can be a local maximum of the distance: at one, the nearest
  /// points lie in no open half-space. Those of all points of the ball are within distance +
  /// 2·radius of its centre; all faces that reach there must be beyond a plane that has the ball
  /// behind it.
  [[nodiscard]] bool no_maximum(const Vec3& p, double radius, double distance) const {
    if (distance <= radius) return false;
    const double reach = (distance + 2 * radius + 2 * slack_) * (1 + 0x1p-40);
    std::vector<std::uint32_t> faces;
    bool few = true;
    limit_.all.query(
        [&](const Bounds& box) {
          double square = 0;
          for (int k = 0; k < 3; ++k) {
            const double d = std::max({box.low[k] - p[k], p[k] - box.high[k], 0.0});
            square += d * d;
          }
          return few && square <= reach * reach;
        },
        [&](std::uint32_t f) {
          few = few && faces.size() < kFewFaces;
          faces.push_back(f);
        });
    if (!few || faces.empty()) return false;
    Vec3 towards = Vec3::Zero();
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t f : faces) {
      const Vec3 to = closest(p, f) - p;
      if (!(to.norm() < least)) continue;
      least = to.norm();
      towards = to;
    }
    // The face that is beyond the plane least pulls it to its side.
    for (int i = 0; i < kTurns && towards.norm() > 0; ++i) {
      const Vec3 u = towards.normalized();
      double lowest = std::numeric_limits<double>::infinity();
      std::uint32_t worst = faces.front();
      for (const std::uint32_t f : faces) {
        const double height = height_within(p, reach, u, f);
        if (!(height < lowest)) continue;
        lowest = height;
        worst = f;
      }
      if (lowest > radius + slack_) return true;
      towards = u + (closest(p, worst) - p).normalized();
    }
    return false;
  }

  [[nodiscard]] Vec3 closest(const Vec3& p, std::uint32_t f) const {
    return closest_point(p, limit_.triangles.corner(f, 0), limit_.triangles.corner(f, 1),
                         limit_.triangles.corner(f, 2));
  }

  /// A lower bound of u·(y − p) over the points y of a face within `reach` of p: the least at its
  /// corners or, with y − p = αn + s, s ⊥ n, α ≥ h ≥ 0 for any unit vector n, that of αu·n + u·s,
  /// |s|² ≤ reach² − α², which is least at α = h if u·n ≥ 0.
  [[nodiscard]] double height_within(const Vec3& p, double reach, const Vec3& u,
                                     std::uint32_t f) const {
    const std::array<Vec3, 3> v{limit_.triangles.corner(f, 0) - p,
                                limit_.triangles.corner(f, 1) - p,
                                limit_.triangles.corner(f, 2) - p};
    const double corners = std::min({u.dot(v[0]), u.dot(v[1]), u.dot(v[2])});
    Vec3 n = (v[1] - v[0]).cross(v[2] - v[0]);
    if (!(n.norm() > 0)) return corners;
    n.normalize();
    if (n.dot(v[0]) < 0) n = -n;
    const double h = std::min({n.dot(v[0]), n.dot(v[1]), n.dot(v[2])}) - slack_;
    const double along = u.dot(n);
    if (!(h >= 0 && along >= 0 && h <= reach)) return corners;
    const double across = (u - along * n).norm() + 0x1p-48;
    return std::max(corners,
                    h * along - std::sqrt(reach * reach - h * h) * across * (1 + 0x1p-48) - slack_);
  }

  /// What a point's distance exceeds the limit by at least.
  [[nodiscard]] double beyond(const Vec3& p) const {
    const NearestTriangle all(limit_.triangles, limit_.all);
    return all.lower_bound(p, all.distance(p)) - slack_ - limit_.distance;
  }

  /// Moves the point within Z away from what is nearest, by less and less, while it gets deeper.
  double climb(Look& look) const {
    const NearestTriangle target(limit_.triangles, limit_.all);
    double step = std::max(limit_.distance, -look.beyond);
    for (int i = 0; i < kClimbs && look.beyond > kNowhere && step > slack_; ++i) {
      const std::uint32_t f = target.nearest(look.point).face;
      const Vec3 away =
          look.point - closest_point(look.point, limit_.triangles.corner(f, 0),
                                     limit_.triangles.corner(f, 1), limit_.triangles.corner(f, 2));
      if (!(away.norm() > 0)) break;
      const Vec3 next = look.point + step * away.normalized();
      const double reached = in_pocket(next).value_or(false) ? beyond(next) : kNowhere;
      if (reached > look.beyond) {
        look.point = next;
        look.beyond = reached;
      } else {
        step /= 2;
      }
    }
    return look.beyond;
  }

  /// Corner i of a box.
  static Vec3 corner(const Bounds& box, unsigned i) {
    return {(i & 1U) != 0 ? box.high[0] : box.low[0], (i & 2U) != 0 ? box.high[1] : box.low[1],
            (i & 4U) != 0 ? box.high[2] : box.low[2]};
  }

  static std::vector<Vec3> corners(const Bounds& box) {
    std::vector<Vec3> points;
    for (unsigned i = 0; i < 8; ++i) points.push_back(corner(box, i));
    return points;
  }

  /// Whether the points, and so their hull, are within the limit of one triangle.
  [[nodiscard]] bool near(const std::vector<Vec3>& points, std::uint32_t f) const {
    return std::all_of(points.begin(), points.end(), [&](const Vec3& p) {
      const Vec3 q = closest_point(p, limit_.triangles.corner(f, 0), limit_.triangles.corner(f, 1),
                                   limit_.triangles.corner(f, 2));
      return (q - p).norm() + slack_ <= limit_.distance;
    });
  }

  /// Whether what is left of the box is within the limit: without what lies beyond all of Z's
  /// boundary, or of one chain, in the box, along the normals of the nearest faces, where that is
  /// not in Z; the rest cut along the prisms of the triangles that distances are measured to.
  [[nodiscard]] bool thin(const Bounds& box, const Vec3& p, std::uint32_t face,
                          std::size_t& work) const {
    work += kThinWork;
    const std::vector<Vec3> normals = directions(p, face);
    std::vector<Part> parts, next;
    for (const Tetrahedron& t : tetrahedra(box)) parts.push_back({t, 0});
    const std::array<const BoxTree*, 3> trees{&boundary_, &scene_.tree(kOutside),
                                              &scene_.tree(kInside)};
    std::array<std::vector<Vec3>, 3> points;
    bool thinner = false;
    for (std::size_t k = 0; k < trees.size(); ++k) {
      if (!points_in(box, *trees[k], points[k])) continue;
      for (const Vec3& normal : normals) {
        const std::optional<double> height = free_below(box, p, normal, points[k], k);
        if (!height) continue;
        thinner = true;
        next.clear();
        for (const Part& part : parts) keep_above(part, {normal, *height}, next);
        parts.swap(next);
        if (parts.empty()) return true;
        if (parts.size() > kMostParts) return false;
      }
    }
    return thinner && near_after_cuts(parts, face, work);
  }

  /// Normals of the nearest face of each kind, both ways.
  [[nodiscard]] std::vector<Vec3> directions(const Vec3& p, std::uint32_t face) const {
    std::vector<Vec3> out;
    const std::array<std::uint32_t, 3> faces{NearestTriangle(scene_, boundary_).nearest(p).face,
                                             face,
                                             NearestTriangle(scene_, kInside).nearest(p).face};
    for (const std::uint32_t f : faces) {
      if (f == NearestTriangle::kNone) continue;
      const Vec3& a = limit_.triangles.corner(f, 0);
      const Vec3 normal =
          (limit_.triangles.corner(f, 1) - a).cross(limit_.triangles.corner(f, 2) - a);
      const double length = normal.norm();
      if (!(length > 0)) continue;
      const Vec3 unit = normal / length;
      if (std::any_of(out.begin(), out.end(),
                      [&](const Vec3& n) { return std::abs(n.dot(unit)) > 1 - 0x1p-30; }))
        continue;
      out.push_back(unit);
      out.emplace_back(-unit);
    }
    return out;
  }

  /// Corners of what faces have in the box, a little enlarged. False when they are too many.
  [[nodiscard]] bool points_in(const Bounds& box, const BoxTree& tree,
                               std::vector<Vec3>& points) const {
    std::size_t count = 0;
    tree.query([&](const Bounds& b) { return count <= kMostFaces && b.meets(box); },
               [&](std::uint32_t f) {
                 if (++count > kMostFaces) return;
                 std::vector<Vec3> polygon{limit_.triangles.corner(f, 0),
                                           limit_.triangles.corner(f, 1),
                                           limit_.triangles.corner(f, 2)};
                 for (int axis = 0; axis < 3 && !polygon.empty(); ++axis) {
                   polygon = clip(polygon, axis, 1, box.high[axis] + 2 * slack_);
                   polygon = clip(polygon, axis, -1, -box.low[axis] + 2 * slack_);
                 }
                 points.insert(points.end(), polygon.begin(), polygon.end());
               });
    return count <= kMostFaces;
  }

  /// The part of a convex polygon where side · x[axis] ≤ most.
  static std::vector<Vec3> clip(const std::vector<Vec3>& polygon, int axis, int side, double most) {
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec3 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      const double x = side * a[axis] - most, y = side * b[axis] - most;
      if (x <= 0) out.push_back(a);
      if ((x <= 0) == (y <= 0)) continue;
      const double t = x / (x - y);
      out.emplace_back((1 - t) * a + t * b);
    }
    return out;
  }

  /// A height below which, along the normal, the box has none of the faces whose points these are,
  /// and is not in Z: the box's part there is convex, so that a point of it tells.
  /// @param kind  of the faces: 0, Z's boundary; 1, the outer chain's; 2, the inner one's
  [[nodiscard]] std::optional<double> free_below(const Bounds& box, const Vec3& p,
                                                 const Vec3& normal,
                                                 const std::vector<Vec3>& points,
                                                 std::size_t kind) const {
    double height = std::numeric_limits<double>::infinity();
    for (const Vec3& q : points) height = std::min(height, normal.dot(q - p));
    height -= 4 * slack_;
    Vec3 lowest;
    for (int k = 0; k < 3; ++k) lowest[k] = normal[k] > 0 ? box.low[k] : box.high[k];
    const double below = normal.dot(lowest - p);
    if (!(height > below && below < 0)) return std::nullopt;
    // A point there, off the box's corner, where planes of round coordinates are wont to meet.
    const double share = 0.4877 * std::min((height - below) / -below, 1.0);
    const Vec3 q = lowest + share * (p - lowest);
    const bool out = kind == 0   ? in_pocket(q) == std::optional(false)
                     : kind == 1 ? winding_at(scene_, kOutside, q).value_or(0) >= 1
                                 : winding_at(scene_, kInside, q).value_or(1) < 1;
    if (!out) return std::nullopt;
    return std::min(height, 0x1p100) + normal.dot(p) - 2 * slack_;
  }

  static void keep_above(const Part& part, const Plane& plane, std::vector<Part>& out) {
    int above = 0;
    for (const Vec3& x : part.corners) above += plane.normal.dot(x) > plane.height ? 1 : 0;
    if (above == 4) out.push_back(part);
    if (above == 0 || above == 4) return;
    std::vector<Part> dropped;
    cut(part, plane, out, dropped);
  }

  /// Whether all parts are within the limit. Where the corner farthest from the face is not,
  /// cutting will not help.
  [[nodiscard]] bool near_after_cuts(const std::vector<Part>& parts, std::uint32_t face,
                                     std::size_t& work) const {
    double most = -1;
    Vec3 farthest = Vec3::Zero();
    for (const Part& part : parts) {
      for (const Vec3& x : part.corners) {
        const double square = (x - closest(x, face)).squaredNorm();
        if (square <= most) continue;
        most = square;
        farthest = x;
      }
    }
    const NearestTriangle target(limit_.triangles, limit_.target);
    if (most > limit_.distance * limit_.distance &&
        target.nearest(farthest, face).distance > limit_.distance)
      return false;
    std::size_t prisms = 0;
    return std::all_of(parts.begin(), parts.end(),
                       [&](const Part& part) { return near_after_cuts(part, face, prisms, work); });
  }

  /// Whether the part is within the limit of one triangle, or its cuts along the sides of the prism
  /// over the nearest one are. @param prisms  that were cut along, in all; @param work  so far
  [[nodiscard]] bool near_after_cuts(const Part& part, std::uint32_t face, std::size_t& prisms,
                                     std::size_t& work) const {
    const NearestTriangle target(limit_.triangles, limit_.target);
    std::vector<Part> open{part}, pieces, next;
    while (!open.empty()) {
      const Part piece = open.back();
      open.pop_back();
      ++work;
      const std::vector<Vec3> points(piece.corners.begin(), piece.corners.end());
      if (near(points, face)) continue;
      const Vec3 middle = 0.25 * (points[0] + points[1] + points[2] + points[3]);
      const NearestTriangle::Hit hit = target.nearest(middle, face);
      const std::uint32_t f = hit.face;
      if (f == NearestTriangle::kNone || hit.distance > limit_.distance) return false;
      double radius = 0;
      for (const Vec3& x : points) radius = std::max(radius, (x - middle).norm());
      if (hit.distance + radius + 2 * slack_ <= limit_.distance || near(points, f)) continue;
      if (++prisms > kMostPrisms || piece.cuts > kMostCuts - 4) return false;
      pieces.assign(1, piece);
      const Vec3& a = limit_.triangles.corner(f, 0);
      const Vec3 normal =
          (limit_.triangles.corner(f, 1) - a).cross(limit_.triangles.corner(f, 2) - a);
      for (int k = 0; k < 3; ++k) {
        const Vec3 across =
            (limit_.triangles.corner(f, (k + 1) % 3) - limit_.triangles.corner(f, k)).cross(normal);
        const double length = across.norm();
        if (!(length > 0)) return false;
        const Plane side{across / length, across.dot(limit_.triangles.corner(f, k)) / length};
        next.clear();
        for (const Part& x : pieces) {
          const auto [low, high] = range(x, side);
          if (low >= -4 * slack_ || high <= 4 * slack_) {
            next.push_back(x);
          } else {
            cut(x, side, next, next);
          }
        }
        pieces.swap(next);
      }
      if (pieces.size() == 1) return false;
      open.insert(open.end(), pieces.begin(), pieces.end());
    }
    return true;
  }

  static std::pair<double, double> range(const Part& part, const Plane& plane) {
    std::pair<double, double> out{std::numeric_limits<double>::infinity(), kNowhere};
    for (const Vec3& x : part.corners) {
      const double h = plane.normal.dot(x) - plane.height;
      out = {std::min(out.first, h), std::max(out.second, h)};
    }
    return out;
  }

  /// Whether all that the bodies leave of the box is within the limit.
  [[nodiscard]] bool left_by_bodies(const Bounds& cell, std::uint32_t face,
                                    std::size_t& work) const {
    work += kBodiesWork;
    std::vector<Part> parts;
    if (!limit_.bodies->parts(cell, parts)) return false;
    return near_after_cuts(parts, face, work);
  }

  /// nullopt when the point may lie on a surface.
  [[nodiscard]] std::optional<bool> in_pocket(const Vec3& p) const {
    const std::optional<int> inner = winding_at(scene_, kInside, p);
    if (inner && *inner < 1) return false;
    const std::optional<int> outer = winding_at(scene_, kOutside, p);
    if (outer && *outer >= 1) return false;
    if (!inner || !outer) return std::nullopt;
    return true;
  }

  static double size(const Bounds& cell) {
    return (Vec3(cell.high.data()) - Vec3(cell.low.data())).norm();
  }

  static void halve(const Bounds& cell, std::vector<Bounds>& into) {
    int axis = 0;
    for (int k = 1; k < 3; ++k) {
      if (cell.high[k] - cell.low[k] > cell.high[axis] - cell.low[axis]) axis = k;
    }
    const double middle = 0.5 * cell.low[axis] + 0.5 * cell.high[axis];
    into.push_back(cell);
    into.back().high[axis] = middle;
    into.push_back(cell);
    into.back().low[axis] = middle;
  }

  const Scene& scene_;
  BoxTree boundary_;
  const Limit& limit_;
  double slack_;
};

}  // namespace

BoxTree tree_of(const Triangles& triangles, const std::vector<std::uint32_t>& chosen) {
  std::vector<Bounds> boxes;
  boxes.reserve(chosen.size());
  for (const std::uint32_t t : chosen) {
    const Vec3 &a = triangles.corner(t, 0), &b = triangles.corner(t, 1),
               &c = triangles.corner(t, 2);
    Bounds box;
    for (int k = 0; k < 3; ++k) {
      box.low[k] = std::min({a[k], b[k], c[k]});
      box.high[k] = std::max({a[k], b[k], c[k]});
    }
    boxes.push_back(box);
  }
  return {std::move(boxes), chosen};
}

std::vector<std::uint32_t> offending_faces(const Scene& scene, const Claim& claim) {
  // Faces are numbered without those of repeated corners; a claim names triangles of the meshes.
  std::vector<std::uint32_t> faces;
  for (const int chain : {kInside, kOutside}) {
    const std::vector<std::uint32_t>& named =
        chain == kInside ? claim.inner_triangles : claim.outer_triangles;
    for (std::uint32_t f = scene.begin(chain); f < scene.end(chain); ++f) {
      if (std::binary_search(named.begin(), named.end(), scene.face(f).source)) faces.push_back(f);
    }
  }
  return faces;
}

Claim search_pockets(const Scene& scene, const std::vector<std::uint32_t>& offending,
                     const Limit& limit) {
  return Search(scene, offending, limit).within_limit();
}

}  // namespace kaboum::verify
