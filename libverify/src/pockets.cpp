#include "pockets.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "nearest.h"
#include "parallel.h"
#include "spot.h"

namespace kaboum::verify {
namespace {

constexpr int kClimbs = 200;
constexpr std::size_t kFewFaces = 1000;
constexpr int kTurns = 8;
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
    std::size_t seen = 0;
    for (; !cells.empty(); cells.swap(open)) {
      seen += cells.size();
      if (seen > limit_.max_cells) {
        claim.answer = Answer::Undecided;
        claim.reason =
            "too many boxes would have to be looked at; the distance may be close to the limit";
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
        if (!looks[i].settled) halve(cells[i], open);
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
  };

  [[nodiscard]] Look look_at(const Bounds& cell) const {
    // Off the middle, which meshes with round coordinates like to have their planes through.
    static const Vec3 kPlace(0.4877, 0.5131, 0.5023);
    const Vec3 low(cell.low.data()), high(cell.high.data());
    Look look;
    look.point = low + kPlace.cwiseProduct(high - low);
    const double radius = (high - look.point).cwiseMax(look.point - low).norm() + slack_;

    const NearestTriangle target(scene_, limit_.target);
    const NearestTriangle::Hit hit = target.nearest(look.point);
    look.settled =
        hit.distance + slack_ + radius <= limit_.distance || near(corners(cell), hit.face);
    if (look.settled) return look;

    const std::optional<bool> in = in_pocket(look.point);
    const NearestTriangle boundary(scene_, boundary_);
    if (in.has_value() && !*in) {
      // The box lies outside Z as its point does without a triangle of Z's boundary, or of the
      // chain that the point is on the wrong side of.
      const auto clear = [&](const BoxTree& tree) {
        const NearestTriangle faces(scene_, tree);
        const double distance = faces.nearest(look.point).distance;
        return distance > radius && faces.lower_bound(look.point, distance) - slack_ > radius;
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
    if (!look.settled) {
      const std::vector<Vec3> part = in_front(cell, look.point, boundary.nearest(look.point).face);
      if (!part.empty()) {
        Vec3 middle = Vec3::Zero();
        for (const Vec3& p : part) middle += p / static_cast<double>(part.size());
        look.settled = near(part, hit.face) || near(part, target.nearest(middle).face);
      }
    }
    if (!look.settled && limit_.bodies != nullptr) look.settled = left_by_bodies(cell, hit.face);
    return look;
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
    return closest_point(p, scene_.corner(f, 0), scene_.corner(f, 1), scene_.corner(f, 2));
  }

  /// A lower bound of u·(y − p) over the points y of a face within `reach` of p: the least at its
  /// corners or, with y − p = αn + s, s ⊥ n, α ≥ h ≥ 0 for any unit vector n, that of αu·n + u·s,
  /// |s|² ≤ reach² − α², which is least at α = h if u·n ≥ 0.
  [[nodiscard]] double height_within(const Vec3& p, double reach, const Vec3& u,
                                     std::uint32_t f) const {
    const std::array<Vec3, 3> v{scene_.corner(f, 0) - p, scene_.corner(f, 1) - p,
                                scene_.corner(f, 2) - p};
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
    const NearestTriangle all(scene_, limit_.all);
    return all.lower_bound(p, all.distance(p)) - slack_ - limit_.distance;
  }

  /// Moves the point within Z away from what is nearest, by less and less, while it gets deeper.
  double climb(Look& look) const {
    const NearestTriangle target(scene_, limit_.all);
    double step = std::max(limit_.distance, -look.beyond);
    for (int i = 0; i < kClimbs && look.beyond > kNowhere && step > slack_; ++i) {
      const std::uint32_t f = target.nearest(look.point).face;
      const Vec3 away = look.point - closest_point(look.point, scene_.corner(f, 0),
                                                   scene_.corner(f, 1), scene_.corner(f, 2));
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
      const Vec3 q =
          closest_point(p, scene_.corner(f, 0), scene_.corner(f, 1), scene_.corner(f, 2));
      return (q - p).norm() + slack_ <= limit_.distance;
    });
  }

  /// Corners of a part of the box that holds all of the box's part of Z: without what lies behind
  /// all of the boundary's triangles in the box, seen from the side of `face` where Z is, if that
  /// is not in Z. Empty when nothing can be left out so.
  /// @param p  of the box
  [[nodiscard]] std::vector<Vec3> in_front(const Bounds& box, const Vec3& p,
                                           std::uint32_t face) const {
    const Vec3& a = scene_.corner(face, 0);
    Vec3 normal = (scene_.corner(face, 1) - a).cross(scene_.corner(face, 2) - a).normalized();
    if (scene_.face(face).chain == kInside) normal = -normal;
    // Nothing of the boundary is below this height.
    double height = std::numeric_limits<double>::infinity();
    boundary_.query([&](const Bounds& b) { return b.meets(box); },
                    [&](std::uint32_t f) {
                      for (int k = 0; k < 3; ++k) {
                        height = std::min(height, normal.dot(scene_.corner(f, k) - a) - slack_);
                      }
                    });
    std::array<double, 8> of;
    unsigned lowest = 0;
    for (unsigned i = 0; i < 8; ++i) {
      of[i] = normal.dot(corner(box, i) - a);
      if (of[i] < of[lowest]) lowest = i;
    }
    const double above = normal.dot(p - a) - of[lowest], behind = height - slack_ - of[lowest];
    if (!(behind > 0) || !(above > 0)) return {};
    // A point behind, off the box's corner, where planes of round coordinates are wont to meet.
    const Vec3 q =
        corner(box, lowest) + 0.4877 * std::min(behind / above, 1.0) * (p - corner(box, lowest));
    if (in_pocket(q) != std::optional(false)) return {};
    height -= 2 * slack_;
    std::vector<Vec3> points;
    for (unsigned i = 0; i < 8; ++i) {
      if (of[i] >= height) points.push_back(corner(box, i));
      for (const unsigned bit : {1U, 2U, 4U}) {
        const unsigned j = i ^ bit;
        if (!(of[i] < height && of[j] >= height)) continue;
        const double t = (height - of[i]) / (of[j] - of[i]);
        points.emplace_back((1 - t) * corner(box, i) + t * corner(box, j));
      }
    }
    return points;
  }

  /// Whether all that the bodies leave of the box is within the limit.
  [[nodiscard]] bool left_by_bodies(const Bounds& cell, std::uint32_t face) const {
    std::vector<Uncovered::Tetrahedron> parts;
    if (!limit_.bodies->parts(cell, parts)) return false;
    const NearestTriangle target(scene_, limit_.target);
    return std::all_of(parts.begin(), parts.end(), [&](const Uncovered::Tetrahedron& part) {
      const std::vector<Vec3> points(part.begin(), part.end());
      if (near(points, face)) return true;
      const Vec3 middle = 0.25 * (part[0] + part[1] + part[2] + part[3]);
      const NearestTriangle::Hit hit = target.nearest(middle);
      double radius = 0;
      for (const Vec3& p : points) radius = std::max(radius, (p - middle).norm());
      return hit.distance + radius + 2 * slack_ <= limit_.distance || near(points, hit.face);
    });
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

BoxTree tree_of(const Scene& scene, const std::vector<std::uint32_t>& faces) {
  std::vector<Bounds> boxes;
  boxes.reserve(faces.size());
  for (const std::uint32_t f : faces) {
    Bounds box;
    for (int k = 0; k < 3; ++k) {
      box.low[k] = std::min({scene.corner(f, 0)[k], scene.corner(f, 1)[k], scene.corner(f, 2)[k]});
      box.high[k] = std::max({scene.corner(f, 0)[k], scene.corner(f, 1)[k], scene.corner(f, 2)[k]});
    }
    boxes.push_back(box);
  }
  return {std::move(boxes), faces};
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
