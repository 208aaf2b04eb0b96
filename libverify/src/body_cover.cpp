// Unions of convex bodies against triangles and solids: docs/algorithms/capsules-and-boxes.md.
#include <kaboum/verify/body_cover.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "body_bounds.h"
#include "cell_sample.h"
#include "membership.h"
#include "nearest.h"
#include "number.h"
#include "parallel.h"

namespace kaboum::verify {
namespace {

constexpr int kTriangleCuts = 50;  ///< weights remain multiples of 2^-52
constexpr int kBoxCuts = 40;
constexpr std::size_t kPartsOfOne = std::size_t{1} << 20U;  ///< of one triangle
constexpr std::size_t kTrianglesAtOnce = 4096;
constexpr int kTurns = 30;  ///< of a direction that is to rise away from bodies
constexpr double kSqrt3Up = 1.7320508076;

double largest_of(const Vec3& p) { return p.cwiseAbs().maxCoeff(); }

/// A body, and what is asked for often.
struct Body {
  const geom::ConvexBody* body;
  geom::Box3 box;      ///< holds it
  double largest = 0;  ///< coordinate, radius included
};

std::vector<Body> bodies_of(const geom::ConvexSet& set) {
  std::vector<Body> out;
  out.reserve(set.bodies.size());
  for (const geom::ConvexBody& body : set.bodies) {
    Body one{&body, geom::bounding_box(body), body.radius};
    one.largest = std::max({one.largest, largest_of(one.box.min), largest_of(one.box.max)});
    out.push_back(one);
  }
  return out;
}

/// A point of a core that is about the nearest to a point, with a bracket of the distance.
struct Near {
  Vec3 at;
  double lower, upper;
};

Near nearest_of_core(const Body& one, const Vec3& p) {
  const geom::Mesh& core = one.body->core;
  const std::vector<Vec3>& v = core.vertices;
  Near out{v[0], 0, std::numeric_limits<double>::infinity()};
  const double slack = rounding_of_distances(one.largest + largest_of(p));
  const auto take = [&](const Vec3& q) {
    if (const double away = (p - q).norm(); away < out.upper) {
      out.upper = away;
      out.at = q;
    }
  };
  if (core.triangles.empty()) {
    const Vec3 along = v.back() - v.front();
    const double square = along.squaredNorm();
    take(v.front() +
         (square > 0 ? std::clamp((p - v.front()).dot(along) / square, 0.0, 1.0) : 0.0) * along);
  } else {
    bool inside = true;
    for (const geom::Triangle& t : core.triangles)
      inside = inside && geom::orient3d(v[t[0]], v[t[1]], v[t[2]], p) != Sign::Positive;
    if (inside) return {p, 0, 0};
    for (const geom::Triangle& t : core.triangles)
      take(closest_point(p, v[t[0]], v[t[1]], v[t[2]]));
  }
  // In whatever direction: the plane through the lowest vertex separates.
  const Vec3 normal = (p - out.at) / out.upper;
  if (normal.allFinite()) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vec3& q : v) least = std::min(least, normal.dot(p - q));
    out.lower = std::max(0.0, least - slack);
  }
  out.upper += slack;
  return out;
}

// --- triangles -------------------------------------------------------------------------------

/// A point of a triangle, by weights that are multiples of 2^-52 and sum up to 1.
struct Corner {
  std::array<double, 3> weight;
  Vec3 at;  ///< rounded
};

using TriangleCorners = std::array<Vec3, 3>;

Corner corner_of(const TriangleCorners& t, const std::array<double, 3>& weight) {
  return {weight, weight[0] * t[0] + weight[1] * t[1] + weight[2] * t[2]};
}

Triple<Exact> exact_point(const TriangleCorners& t, const Corner& p) {
  Triple<Exact> out{Exact(0), Exact(0), Exact(0)};
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k)
      out[k] = out[k] + Exact(p.weight[i]) * Exact(t[i][static_cast<Eigen::Index>(k)]);
  return out;
}

/// @param error  of each coordinate of p.at
bool holds(const Body& one, const TriangleCorners& t, const Corner& p, double error) {
  for (int k = 0; k < 3; ++k)
    if (p.at[k] < one.box.min[k] - error || p.at[k] > one.box.max[k] + error) return false;
  const bool is_exact = p.weight[0] == 1 || p.weight[1] == 1 || p.weight[2] == 1;
  Triple<Approx> rounded = numbers<Approx>(p.at);
  if (!is_exact)
    for (Approx& x : rounded) x.error = error;
  if (const auto known = contains_as(*one.body, rounded)) return *known;
  return *contains_as(*one.body, exact_point(t, p));
}

struct Part {
  std::array<Corner, 3> corner;
  int cuts = 0;
  std::vector<std::uint32_t> near;  ///< all bodies that meet it are among these
};

struct TriangleAnswer {
  Answer answer = Answer::Verified;
  std::size_t parts = 0;
  Vec3 at = Vec3::Zero();  ///< refuted: in no body, rounded
  bool is_corner = false;
};

class TriangleCover {
 public:
  TriangleCover(const TriangleCorners& triangle, const std::vector<Body>& bodies)
      : t_(triangle), bodies_(bodies) {
    double largest = 0;
    for (const Vec3& v : t_) largest = std::max(largest, largest_of(v));
    error_ = 8 * kUnit * largest + kTiny;
  }

  TriangleAnswer decide(std::vector<std::uint32_t> near) {
    Part all{{corner_of(t_, {1, 0, 0}), corner_of(t_, {0, 1, 0}), corner_of(t_, {0, 0, 1})},
             0,
             std::move(near)};
    for (const Corner& c : all.corner)
      if (!is_held(c, all.near)) return refuted(c, true);
    std::vector<Part> open{std::move(all)};
    while (!open.empty()) {
      Part part = std::move(open.back());
      open.pop_back();
      ++out_.parts;
      if (in_one_body(part)) continue;
      if (part.cuts >= kTriangleCuts || out_.parts >= kPartsOfOne) {
        out_.answer = Answer::Undecided;
        out_.at = part.corner[0].at;
        return out_;
      }
      if (const std::optional<Corner> outside = halve(part, open)) return refuted(*outside, false);
    }
    return out_;
  }

 private:
  TriangleAnswer refuted(const Corner& c, bool is_corner) {
    out_.answer = Answer::Refuted;
    out_.at = c.at;
    out_.is_corner = is_corner;
    return out_;
  }

  [[nodiscard]] bool is_held(const Corner& c, const std::vector<std::uint32_t>& near) const {
    return std::ranges::any_of(near,
                               [&](std::uint32_t b) { return holds(bodies_[b], t_, c, error_); });
  }

  [[nodiscard]] bool in_one_body(const Part& part) const {
    return std::ranges::any_of(part.near, [&](std::uint32_t b) {
      return std::ranges::all_of(part.corner,
                                 [&](const Corner& c) { return holds(bodies_[b], t_, c, error_); });
    });
  }

  /// Cuts the longest side at its middle. @return the middle, where it is in no body
  [[nodiscard]] std::optional<Corner> halve(const Part& part, std::vector<Part>& open) const {
    std::size_t longest = 0;
    double most = -1;
    for (std::size_t k = 0; k < 3; ++k) {
      const double length = (part.corner[(k + 1) % 3].at - part.corner[k].at).squaredNorm();
      if (!(length > most)) continue;
      most = length;
      longest = k;
    }
    const std::size_t next = (longest + 1) % 3;
    std::array<double, 3> weight;
    for (std::size_t i = 0; i < 3; ++i)
      weight[i] = 0.5 * (part.corner[longest].weight[i] + part.corner[next].weight[i]);
    const Corner middle = corner_of(t_, weight);
    if (!is_held(middle, part.near)) return middle;
    for (const std::size_t replaced : {longest, next}) {
      Part half;
      half.corner = part.corner;
      half.corner[replaced] = middle;
      half.cuts = part.cuts + 1;
      geom::Box3 box;
      for (const Corner& c : half.corner) box.extend(c.at);
      for (const std::uint32_t b : part.near)
        if (meets(bodies_[b].box, box)) half.near.push_back(b);
      open.push_back(std::move(half));
    }
    return std::nullopt;
  }

  [[nodiscard]] bool meets(const geom::Box3& body, const geom::Box3& box) const {
    for (int k = 0; k < 3; ++k)
      if (box.max[k] + error_ < body.min[k] || box.min[k] - error_ > body.max[k]) return false;
    return true;
  }

  const TriangleCorners& t_;
  const std::vector<Body>& bodies_;
  double error_ = 0;
  TriangleAnswer out_;
};

/// Of all triangles; those after the limit was reached are Undefined.
std::vector<TriangleAnswer> decide_triangles(const geom::Mesh& mesh,
                                             const std::vector<Body>& bodies, std::size_t most) {
  std::vector<TriangleAnswer> out(mesh.triangles.size());
  for (TriangleAnswer& answer : out) answer.answer = Answer::Undefined;
  std::size_t parts = 0;
  for (std::size_t i = 0; i < out.size() && parts <= most; i += kTrianglesAtOnce) {
    const std::size_t end = std::min(out.size(), i + kTrianglesAtOnce);
    parallel_for(i, end, [&](std::size_t t) {
      const geom::Triangle& v = mesh.triangles[t];
      const TriangleCorners corners{mesh.vertices[v[0]], mesh.vertices[v[1]], mesh.vertices[v[2]]};
      geom::Box3 box;
      for (const Vec3& p : corners) box.extend(p);
      std::vector<std::uint32_t> near;
      for (std::uint32_t b = 0; b < bodies.size(); ++b) {
        const geom::Box3& own = bodies[b].box;
        if ((box.min.array() <= own.max.array()).all() &&
            (own.min.array() <= box.max.array()).all())
          near.push_back(b);
      }
      out[t] = TriangleCover(corners, bodies).decide(std::move(near));
    });
    for (std::size_t t = i; t < end; ++t) parts += out[t].parts;
  }
  return out;
}

// --- the inside ------------------------------------------------------------------------------

struct Cell {
  Vec3 center;
  double half;
  int cuts;
  std::vector<std::uint32_t> active;  ///< all bodies that are nearest somewhere in it
};

/// Search of a point of the solid in no body, all triangles being in bodies.
class VoidSearch {
 public:
  VoidSearch(const geom::Mesh& mesh, const MeshPair& meshes, const geom::ConvexSet& set,
             const std::vector<Body>& bodies)
      : meshes_(meshes),
        nearest_(meshes, kOutside),
        set_(set),
        bodies_(bodies),
        box_(geom::bounding_box(mesh)) {}

  Claim decide(std::size_t most) {
    Claim claim;
    claim.answer = Answer::Verified;
    std::vector<Cell> open{root()};
    std::size_t seen = 0;
    std::optional<Vec3> left_open;
    while (!open.empty()) {
      Cell cell = std::move(open.back());
      open.pop_back();
      if (++seen > most || !std::isfinite(cell.half)) {
        left_open = cell.center;
        break;
      }
      if (is_apart(cell)) continue;
      std::vector<Near> near = keep_active(cell);
      if (cell.active.size() < 4 || in_one_body(cell, near) || is_rising(cell, near)) continue;
      if (std::ranges::none_of(cell.active, [&](std::uint32_t b) {
            return contains(*bodies_[b].body, cell.center);
          })) {
        const std::optional<int> winding =
            winding_at(meshes_, kOutside, cell.center * meshes_.scale());
        if (winding && *winding >= 1) return refuted(cell.center);
        if (winding && is_without_triangles(cell)) continue;
      }
      if (cell.cuts >= deepest_) {
        left_open = cell.center;
        continue;
      }
      for (int i = 0; i < 8; ++i) {
        const Vec3 to((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
        open.push_back(
            {cell.center + 0.5 * cell.half * to, 0.5 * cell.half, cell.cuts + 1, cell.active});
      }
    }
    if (left_open) {
      claim.answer = Answer::Undecided;
      claim.reason = "the bodies leave too little slack, or too many boxes are needed, inside";
      claim.witness = Witness{*left_open, 0, false};
    }
    return claim;
  }

 private:
  /// Corners and middles of all boxes are multiples of a power of two that doubles hold.
  Cell root() {
    const double extent = (box_.max - box_.min).maxCoeff();
    int exponent = 0;
    std::frexp(extent, &exponent);
    const double size = std::ldexp(1.0, exponent + 1), step = std::ldexp(size, -8);
    Vec3 low = box_.min;
    for (int k = 0; k < 3; ++k) low[k] = step * std::floor(low[k] / step);
    const double most = std::max(largest_of(box_.min), largest_of(box_.max)) + 2 * size;
    int largest = 0;
    std::frexp(most / size, &largest);
    deepest_ = std::max(0, std::min(kBoxCuts, 50 - largest));
    Cell out{low + Vec3::Constant(0.5 * size), 0.5 * size, 0, {}};
    for (std::uint32_t b = 0; b < bodies_.size(); ++b) out.active.push_back(b);
    return out;
  }

  [[nodiscard]] bool is_apart(const Cell& cell) const {
    for (int k = 0; k < 3; ++k)
      if (cell.center[k] + cell.half < box_.min[k] || cell.center[k] - cell.half > box_.max[k])
        return true;
    return false;
  }

  static double reach_of(const Cell& cell) { return kSqrt3Up * cell.half * kGrowth; }

  /// Leaves out bodies that are farther than another one from all points of the cell.
  /// @return of those that are kept, the nearest points of their cores to the middle
  [[nodiscard]] std::vector<Near> keep_active(Cell& cell) const {
    std::vector<Near> all;
    all.reserve(cell.active.size());
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t b : cell.active) {
      all.push_back(nearest_of_core(bodies_[b], cell.center));
      least = std::min(least, all.back().upper - bodies_[b].body->radius);
    }
    const double most =
        (least + 2 * reach_of(cell)) + 4 * kUnit * (std::abs(least) + 2 * reach_of(cell));
    std::vector<Near> near;
    std::vector<std::uint32_t> kept;
    for (std::size_t i = 0; i < all.size(); ++i) {
      const double radius = bodies_[cell.active[i]].body->radius;
      if (all[i].lower - radius > most + 4 * kUnit * (all[i].lower + radius)) continue;
      kept.push_back(cell.active[i]);
      near.push_back(all[i]);
    }
    cell.active = std::move(kept);
    return near;
  }

  [[nodiscard]] bool in_one_body(const Cell& cell, const std::vector<Near>& near) const {
    for (std::size_t i = 0; i < near.size(); ++i) {
      const geom::ConvexBody& body = *bodies_[cell.active[i]].body;
      // Else the farthest corner is not in it, or not all are.
      if (near[i].lower > body.radius) continue;
      if (near[i].upper + reach_of(cell) + 4 * kUnit * (near[i].upper + body.radius) <= body.radius)
        return true;
      bool all = true;
      for (int c = 0; c < 8 && all; ++c) {
        const Vec3 to((c & 1) != 0 ? 1 : -1, (c & 2) != 0 ? 1 : -1, (c & 4) != 0 ? 1 : -1);
        all = contains(body, cell.center + cell.half * to);
      }
      if (all) return true;
    }
    return false;
  }

  /// Directions in which a body's distance may grow at points of the cell outside of it, or what
  /// generates them.
  struct Away {
    std::vector<Vec3> generators;  ///< not scaled
    bool is_cone = false;          ///< of facets' normals; else one vector, known but for `error`
    double error = 0;
  };

  /// With p the nearest point of the core to x, the distance grows along x − p. That moves by no
  /// more than x; and it is in the cone of the normals of facets whose planes p is on.
  [[nodiscard]] Away away_of(const Cell& cell, std::uint32_t b, const Near& near) const {
    const Body& one = bodies_[b];
    const geom::Mesh& core = one.body->core;
    Away out;
    const double gap = std::max(0.0, near.upper - near.lower);
    // How far the nearest point may be from the one found: both are in a convex core.
    const double off = std::sqrt(gap * (2 * near.upper + gap)) * kGrowth +
                       rounding_of_distances(one.largest + largest_of(cell.center));
    const double reach = reach_of(cell);
    if (core.triangles.empty() || near.lower > 3 * reach) {
      out.generators = {cell.center - near.at};
      out.error = reach + off;
      return out;
    }
    out.is_cone = true;
    const std::vector<Vec3>& v = core.vertices;
    for (const geom::Triangle& t : core.triangles) {
      const Triple<Approx> a = numbers<Approx>(v[t[0]]);
      const Triple<Approx> n = membership::cross(membership::minus(numbers<Approx>(v[t[1]]), a),
                                                 membership::minus(numbers<Approx>(v[t[2]]), a));
      const Vec3 normal(n[0].value, n[1].value, n[2].value);
      const double length = (normal.norm() + n[0].error + n[1].error + n[2].error) * kGrowth;
      const Approx height = dot(n, membership::minus(a, numbers<Approx>(near.at)));
      // The plane is farther from all nearest points than they can be from each other.
      if (height.value - height.error > (reach + off) * length * kGrowth) continue;
      out.generators.push_back(normal);
    }
    return out;
  }

  /// Whether the direction leads away from the body, everywhere in the cell outside of it.
  [[nodiscard]] bool leads_away(const Vec3& direction, std::uint32_t b, const Away& away) const {
    if (!away.is_cone) {
      const Vec3& w = away.generators[0];
      const double rounding = 16 * kUnit * (direction.norm() * w.norm()) + kTiny;
      return direction.dot(w) - rounding > away.error * direction.norm() * kGrowth;
    }
    const geom::Mesh& core = bodies_[b].body->core;
    for (const Vec3& normal : away.generators) {
      // The exact normal of the facet with this rounded one.
      bool found = false;
      for (const geom::Triangle& t : core.triangles) {
        const std::vector<Vec3>& v = core.vertices;
        const Triple<Approx> a = numbers<Approx>(v[t[0]]);
        const Triple<Approx> n = membership::cross(membership::minus(numbers<Approx>(v[t[1]]), a),
                                                   membership::minus(numbers<Approx>(v[t[2]]), a));
        if (Vec3(n[0].value, n[1].value, n[2].value) != normal) continue;
        found = true;
        if (sign_of(dot(n, numbers<Approx>(direction))) != std::optional(Sign::Positive))
          return false;
      }
      if (!found) return false;
    }
    return true;
  }

  /// There is a direction that leads away from all bodies: none of them is nearest to a local
  /// maximum in the cell.
  [[nodiscard]] bool is_rising(const Cell& cell, const std::vector<Near>& near) const {
    std::vector<Away> all;
    std::vector<std::uint32_t> of;
    std::vector<Vec3> units;
    Vec3 direction = Vec3::Zero();
    for (std::size_t i = 0; i < near.size(); ++i) {
      Away one = away_of(cell, cell.active[i], near[i]);
      // It holds all of the cell, or is nowhere in it nearest with a distance above 0.
      if (one.is_cone && one.generators.empty()) return true;
      for (const Vec3& g : one.generators) {
        const double length = g.norm();
        if (!(length > 0) || !std::isfinite(length)) return false;
        if (!one.is_cone && !(length > one.error)) return false;
        units.push_back(g / length);
        direction += units.back();
      }
      all.push_back(std::move(one));
      of.push_back(cell.active[i]);
    }
    for (int turn = 0; turn < kTurns; ++turn) {
      const double length = direction.norm();
      if (!(length > 1e-9)) return false;
      direction /= length;
      double least = std::numeric_limits<double>::infinity();
      Vec3 worst = Vec3::Zero();
      for (const Vec3& u : units)
        if (const double height = direction.dot(u); height < least) {
          least = height;
          worst = u;
        }
      if (least > 0) {
        bool rises = true;
        for (std::size_t i = 0; i < all.size() && rises; ++i)
          rises = leads_away(direction, of[i], all[i]);
        if (rises) return true;
      }
      direction += 0.7 * worst;
    }
    return false;
  }

  [[nodiscard]] bool is_without_triangles(const Cell& cell) const {
    const Vec3 p = cell.center * meshes_.scale();
    const double largest = std::max(meshes_.largest_coordinate(), largest_of(p));
    return nearest_.all_beyond(
        p, reach_of(cell) * meshes_.scale() + 4 * rounding_of_distances(largest));
  }

  [[nodiscard]] Claim refuted(const Vec3& p) const {
    Claim claim;
    claim.answer = Answer::Refuted;
    claim.reason = "a point inside the solid is in no body";
    claim.witness = Witness{p, distance_to_bodies(set_, p), true};
    return claim;
  }

  const MeshPair& meshes_;
  NearestTriangle nearest_;
  const geom::ConvexSet& set_;
  const std::vector<Body>& bodies_;
  geom::Box3 box_;
  int deepest_ = 0;
};

Claim undecided(std::string why) {
  Claim claim;
  claim.answer = Answer::Undecided;
  claim.reason = std::move(why);
  return claim;
}

/// Beneath places of triangles that are in no body.
Claim solid_beneath(const geom::Mesh& mesh, const MeshPair& meshes, const std::vector<Body>& bodies,
                    const std::vector<TriangleAnswer>& found) {
  constexpr std::size_t kPlaces = 2000;
  std::size_t looked = 0;
  for (std::size_t t = 0; t < found.size() && looked < kPlaces; ++t) {
    if (found[t].answer != Answer::Refuted) continue;
    const geom::Triangle& v = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[v[0]], &b = mesh.vertices[v[1]], &c = mesh.vertices[v[2]];
    const Vec3 normal = (b - a).cross(c - a).normalized(), middle = (a + b + c) / 3;
    if (!normal.allFinite()) continue;
    ++looked;
    const double size = (middle - found[t].at).norm();
    for (const double share : {0.3, 0.01, 1e-4}) {
      const Vec3 p = found[t].at + share * (middle - found[t].at) - 0.5 * share * size * normal;
      if (!p.allFinite() ||
          std::ranges::any_of(bodies, [&](const Body& one) { return contains(*one.body, p); }))
        continue;
      const std::optional<int> winding = winding_at(meshes, kOutside, p * meshes.scale());
      if (!winding || *winding < 1) continue;
      Claim claim;
      claim.answer = Answer::Refuted;
      claim.reason = "a point inside the solid is in no body";
      claim.witness = Witness{p, share * size, true};
      claim.inner_triangles = {static_cast<std::uint32_t>(t)};
      return claim;
    }
  }
  return undecided("triangles stick out, and no point of the solid was found that does");
}

Claim surface_claim(const geom::ConvexSet& set, const std::vector<TriangleAnswer>& found,
                    Inclusion& out) {
  Claim claim;
  claim.answer = Answer::Verified;
  Vec3 open = Vec3::Zero();
  for (std::uint32_t t = 0; t < found.size(); ++t) {
    const TriangleAnswer& one = found[t];
    if (one.answer == Answer::Verified) continue;
    if (one.answer != Answer::Refuted) {
      if (out.left_out++ == 0) open = one.at;
      continue;
    }
    const double depth = distance_to_bodies(set, one.at);
    claim.inner_triangles.push_back(t);
    if (!claim.witness || depth > claim.witness->depth)
      claim.witness = Witness{one.at, depth, one.is_corner};
  }
  if (!claim.inner_triangles.empty()) {
    claim.answer = Answer::Refuted;
    claim.reason = "a point of a triangle is in no body";
  } else if (out.left_out > 0) {
    claim = undecided("of " + std::to_string(out.left_out) +
                      " triangles it was not decided whether the bodies hold them: there is too "
                      "little slack, or too many parts are needed");
    claim.witness = Witness{open, 0, false};
  }
  out.limited = out.left_out > 0;
  return claim;
}

}  // namespace

Inclusion verify_body_cover(const geom::Mesh& original, const geom::ConvexSet& set,
                            const InclusionOptions& options) {
  const MeshPair meshes(geom::Mesh{}, original);
  Inclusion out;
  out.inner_open_edges = meshes.unbalanced(mask_of(kOutside), false);
  out.inner_closed = out.inner_open_edges == 0;
  out.triangles_without_area = meshes.without_area(kOutside) + meshes.repeated(kOutside).size();
  if (original.triangles.empty()) {
    out.solid.reason = out.surface.reason = "the inner mesh has no triangles";
    return out;
  }
  const std::vector<Body> bodies = bodies_of(set);
  if (options.progress) options.progress("parts of triangles in bodies");
  const std::vector<TriangleAnswer> found = decide_triangles(original, bodies, options.max_cells);
  out.surface = surface_claim(set, found, out);
  if (!out.inner_closed) {
    out.solid.reason = "the meshes are not closed and have different borders";
  } else if (meshes.tree(kOutside).empty()) {
    out.solid.reason = "no triangle of the inner mesh has an area, so that it has no solid";
  } else if (options.surface_only) {
    out.solid.reason = "only the surface claim was asked for";
  } else if (out.surface.answer == Answer::Verified) {
    if (options.progress) options.progress("boxes inside the solid");
    out.solid = VoidSearch(original, meshes, set, bodies).decide(options.max_cells);
  } else if (out.surface.answer == Answer::Refuted) {
    out.solid = solid_beneath(original, meshes, bodies, found);
  } else {
    out.solid = undecided("it is not known whether the bodies hold all triangles");
  }
  return out;
}

}  // namespace kaboum::verify
