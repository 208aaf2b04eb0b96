// How far what refutes a claim lies outside: branch and bound over parts of triangles, and for
// solids the search of pockets with limits that grow.
// docs/algorithms/exact-inclusion.md, "How far outside".
#include <kaboum/base/error.h>
#include <kaboum/verify/bracket.h>

#include <algorithm>
#include <cmath>
#include <queue>

#include "allowance.h"
#include "cell_sample.h"
#include "nearest.h"
#include "parallel.h"
#include "uncovered_region.h"

namespace kaboum::verify {
namespace {

constexpr std::size_t kAtOnce = 128;  // parts between looks at what was found
constexpr int kMaxCuts = 60;          // rounding_of_distances allows for 64
constexpr int kHalvings = 60;
constexpr int kLimits = 8;              // tried for a solid
constexpr double kSearchedShare = 0.6;  // of the work allowed, for finding what bounds a solid

/// A part of a triangle, and a bound of its distances.
struct Part {
  std::array<Vec3, 3> corner;
  std::uint32_t triangle;
  int cuts;
  double upper;
};

/// Bounds of the distance of a part, and where it is that far.
struct DistanceBounds {
  double lower = 0, upper = 0;
  Vec3 at = Vec3::Zero();
};

/// What distances to a mesh, or to its solid, are measured to: what lies in it for sure, for bounds
/// from above, and all that has a part in it, for bounds from below.
/// @throws Error{LimitReached}
Pieces target_of(const MeshPair& meshes, bool to_solid, double max_work) {
  if (!to_solid) return {{}, meshes.tree(kOutside), meshes.tree(kOutside)};
  InclusionOptions limits;
  limits.max_work = kSearchedShare * max_work;
  return pieces_with(meshes, kOutside, limits,
                     [](int inner, int outer) { return inner >= 1 || outer >= 1; });
}

class Farthest {
 public:
  Farthest(const MeshPair& meshes, const Pieces& target, bool to_solid)
      : meshes_(meshes),
        triangles_(meshes, target.parts),
        surface_(meshes, kOutside),
        surely_(triangles_, target.surely),
        perhaps_(triangles_, target.perhaps),
        to_solid_(to_solid),
        slack_(rounding_of_distances(meshes.largest_coordinate())) {}

  [[nodiscard]] Bracket search(std::vector<Part> parts, const BracketEffort& effort) const {
    Bracket best;
    const auto lower_first = [](const Part& a, const Part& b) { return a.upper < b.upper; };
    std::priority_queue<Part, std::vector<Part>, decltype(lower_first)> open(lower_first);
    Allowance allowance((1 - kSearchedShare) * effort.max_work);
    double decided = 0;  // the largest bound of parts that are not cut further
    std::size_t seen = 0;
    const auto good = [&](double upper) {
      return upper <= best.lower * (1 + effort.gap) + 4 * slack_;
    };
    // In blocks, since what the first ones reach makes much of the rest unnecessary.
    const auto look_at = [&](std::span<Part> some) {
      const double known = best.lower;
      std::vector<DistanceBounds> found(
          some.size(), DistanceBounds{0, std::numeric_limits<double>::infinity(), Vec3::Zero()});
      allowance.loop(some.size(), [&](std::size_t i) { found[i] = look(some[i], known); });
      for (std::size_t i = 0; i < some.size(); ++i) {
        some[i].upper = std::min(some[i].upper, found[i].upper);
        if (found[i].lower <= best.lower) continue;
        best.lower = found[i].lower;
        best.at = found[i].at;
        best.triangle = some[i].triangle;
      }
      for (const Part& part : some) {
        if (good(part.upper) || part.cuts >= kMaxCuts) {
          decided = std::max(decided, part.upper);
        } else {
          open.push(part);
        }
      }
    };
    for (std::size_t i = 0; i < parts.size(); i += kAtOnce)
      look_at({parts.data() + i, std::min(kAtOnce, parts.size() - i)});
    std::vector<Part> next;
    while (!open.empty() && !good(open.top().upper) && seen < effort.parts && !allowance.spent()) {
      next.clear();
      for (std::size_t i = 0; i < kAtOnce && !open.empty() && !good(open.top().upper); ++i) {
        halve(open.top(), next);
        open.pop();
      }
      seen += next.size();
      look_at(next);
    }
    best.upper = std::max({best.lower, decided, open.empty() ? 0 : open.top().upper});
    return best;
  }

 private:
  [[nodiscard]] DistanceBounds look(const Part& part, double known) const {
    DistanceBounds found;
    const Vec3 centre = (part.corner[0] + part.corner[1] + part.corner[2]) / 3;
    double radius = 0;
    for (const Vec3& p : part.corner) radius = std::max(radius, (p - centre).norm());
    radius += slack_;
    if (to_solid_) {  // a ball that misses the surface
      const double clear = surface_.nearest(centre).distance;
      if (clear > 2 * radius && surface_.lower_bound(centre, clear) - slack_ > radius &&
          winding_at(meshes_, kOutside, centre).value_or(0) >= 1)
        return {};
    }
    const NearestTriangle::Hit hit = surely_.nearest(centre);
    found.upper = std::min(hit.distance + radius + slack_, to_one(part.corner, hit.face));
    if (to_solid_ && hit.face != NearestTriangle::kNone && hit.distance <= radius) {
      const std::vector<Vec3> outside = without_inside(part, hit.face);
      found.upper = std::min(found.upper, to_one(outside, hit.face));
      if (outside.empty()) return {};
    }
    look_round(centre, known, found);
    for (const Vec3& p : part.corner) {
      const NearestTriangle::Hit own = surely_.nearest(p);
      if (own.face != hit.face) found.upper = std::min(found.upper, to_one(part.corner, own.face));
      if (own.distance > std::max(known, found.lower)) look_round(p, known, found);
    }
    return found;
  }

  /// Corners of what is left of the part without what lies behind all faces near it, seen along the
  /// outward normal of `face`, if a point there is in the solid: no face is there, so all of it is.
  [[nodiscard]] std::vector<Vec3> without_inside(const Part& part, std::uint32_t face) const {
    std::vector<Vec3> all(part.corner.begin(), part.corner.end());
    const Vec3& a = triangles_.corner(face, 0);
    Vec3 normal = (triangles_.corner(face, 1) - a).cross(triangles_.corner(face, 2) - a);
    if (!(normal.norm() > 0)) return all;
    normal.normalize();
    Bounds box;
    for (int k = 0; k < 3; ++k) {
      box.low[k] = std::min({all[0][k], all[1][k], all[2][k]}) - 2 * slack_;
      box.high[k] = std::max({all[0][k], all[1][k], all[2][k]}) + 2 * slack_;
    }
    double height = std::numeric_limits<double>::infinity();
    meshes_.tree(kOutside).query([&](const Bounds& b) { return b.meets(box); },
                                 [&](std::uint32_t f) {
                                   for (int k = 0; k < 3; ++k)
                                     height =
                                         std::min(height, normal.dot(triangles_.corner(f, k) - a));
                                 });
    height -= 4 * slack_;
    std::array<double, 3> of;
    for (int k = 0; k < 3; ++k) of[k] = normal.dot(all[k] - a);
    const auto lowest =
        static_cast<std::size_t>(std::min_element(of.begin(), of.end()) - of.begin());
    if (!(of[lowest] < height) || winding_at(meshes_, kOutside, all[lowest]).value_or(0) < 1)
      return all;
    std::vector<Vec3> left;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::size_t j = (i + 1) % 3;
      if (of[i] >= height) left.push_back(all[i]);
      if ((of[i] >= height) == (of[j] >= height)) continue;
      const double t = (height - of[i]) / (of[j] - of[i]);
      left.emplace_back((1 - t) * all[i] + t * all[j]);
    }
    return left;
  }

  /// The distance to a triangle is convex: a bound for the hull of the points.
  [[nodiscard]] double to_one(std::span<const Vec3> points, std::uint32_t f) const {
    if (f == NearestTriangle::kNone) return std::numeric_limits<double>::infinity();
    double most = 0;
    for (const Vec3& p : points) {
      const Vec3 q = closest_point(p, triangles_.corner(f, 0), triangles_.corner(f, 1),
                                   triangles_.corner(f, 2));
      most = std::max(most, (q - p).norm());
    }
    return most + slack_;
  }

  /// A point on the surface that is in the solid is on a face that has a part in it.
  void look_round(const Vec3& p, double known, DistanceBounds& found) const {
    const double distance = perhaps_.distance(p);
    if (distance <= std::max(known, found.lower) || !std::isfinite(distance)) return;
    if (to_solid_ && winding_at(meshes_, kOutside, p).value_or(0) >= 1) return;
    const double lower = perhaps_.lower_bound(p, distance) - slack_;
    if (lower <= found.lower) return;
    found.lower = lower;
    found.at = p;
  }

  static void halve(const Part& part, std::vector<Part>& into) {
    int longest = 0;
    double length = -1;
    for (int k = 0; k < 3; ++k) {
      const double l = (part.corner[(k + 1) % 3] - part.corner[k]).squaredNorm();
      if (l <= length) continue;
      length = l;
      longest = k;
    }
    const Vec3 &a = part.corner[longest], &b = part.corner[(longest + 1) % 3],
               &c = part.corner[(longest + 2) % 3];
    const Vec3 middle = 0.5 * a + 0.5 * b;
    into.push_back({{a, middle, c}, part.triangle, part.cuts + 1, part.upper});
    into.push_back({{middle, b, c}, part.triangle, part.cuts + 1, part.upper});
  }

  const MeshPair& meshes_;
  Triangles triangles_;
  NearestTriangle surface_, surely_, perhaps_;
  bool to_solid_;
  double slack_;
};

/// In the meshes' unit.
Bracket bracket_faces(const MeshPair& meshes, const std::vector<Face>& faces, bool to_solid,
                      const Pieces& target, const BracketEffort& effort) {
  std::vector<Part> parts;
  parts.reserve(faces.size());
  for (const Face& f : faces)
    parts.push_back({{meshes.point(f.v[0]), meshes.point(f.v[1]), meshes.point(f.v[2])},
                     f.source,
                     0,
                     std::numeric_limits<double>::infinity()});
  return Farthest(meshes, target, to_solid).search(std::move(parts), effort);
}

Bracket outside_of(const MeshPair& meshes, Bracket bracket) {
  bracket.lower = meshes.length_outside(bracket.lower);
  bracket.upper = meshes.length_outside(bracket.upper);
  bracket.at = meshes.point_outside(bracket.at);
  return bracket;
}

/// nullopt where no distance can be measured.
std::optional<Pieces> measurable(const MeshPair& meshes, bool to_solid,
                                 double max_work = std::numeric_limits<double>::infinity()) {
  if (!meshes.scaled() || meshes.tree(kOutside).empty()) return std::nullopt;
  try {
    return target_of(meshes, to_solid, max_work);
  } catch (const Error& error) {
    if (error.code() != ErrorCode::LimitReached) throw;
    return std::nullopt;
  }
}

}  // namespace

Bracket bracket_distance(const geom::Mesh& from, std::span<const std::uint32_t> triangles,
                         const geom::Mesh& to, bool to_solid, const BracketEffort& effort) {
  geom::Mesh part{from.vertices, {}};
  for (const std::uint32_t t : triangles) part.triangles.push_back(from.triangles[t]);
  const MeshPair meshes(part, to);
  const std::optional<Pieces> target = measurable(meshes, to_solid, effort.max_work);
  if (!target) return {};
  // Segments and points are measured as well.
  const std::vector<Face> faces = meshes.in_order_of_sources(kInside);
  Bracket result = outside_of(meshes, bracket_faces(meshes, faces, to_solid, *target, effort));
  if (!triangles.empty()) result.triangle = triangles[result.triangle];
  return result;
}

Bracket bracket_solid(const geom::Mesh& inner, const geom::Mesh& outer, const Claim& solid,
                      const BracketEffort& effort) {
  const MeshPair meshes(inner, outer);
  const std::optional<Pieces> target = measurable(meshes, true);
  if (!target || !solid.witness) return {};
  const std::vector<std::uint32_t> offending = offending_faces(meshes, solid);
  std::vector<Face> of_inner;
  for (const std::uint32_t f : offending)
    if (meshes.face(f).chain == kInside) of_inner.push_back(meshes.face(f));
  const double slack = rounding_of_distances(meshes.largest_coordinate());
  const Triangles triangles(meshes, target->parts);
  const NearestTriangle perhaps(triangles, target->perhaps);

  // The boundary of Z lies on these and on the outer solid's.
  Bracket result = bracket_faces(meshes, of_inner, true, *target, effort);
  const double on_boundary = result.upper, hoped = result.lower;
  const Vec3 wanted = result.at, witness = solid.witness->point * meshes.scale();
  result.lower = 0;
  result.at = witness;
  const auto take = [&](const Vec3& p) {
    if (winding_at(meshes, kInside, p).value_or(0) < 1 ||
        winding_at(meshes, kOutside, p).value_or(1) >= 1)
      return;
    const double distance = perhaps.distance(p);
    if (!std::isfinite(distance)) return;
    const double lower = perhaps.lower_bound(p, distance) - slack;
    if (lower <= result.lower) return;
    result.lower = lower;
    result.at = p;
  };
  take(witness);
  // The farthest point of the boundary, moved towards the witness.
  for (int k = 1; k <= kHalvings && hoped > result.lower * (1 + effort.gap); ++k)
    take(wanted + std::ldexp(1.0, -k) * (witness - wanted));
  result.upper = std::numeric_limits<double>::infinity();
  if (target->surely.empty()) return outside_of(meshes, result);

  // Inside Z it may be farther still, at places that are no nearer to its boundary.
  double limit = std::max(on_boundary, result.lower);
  for (int i = 0; i < kLimits && std::isfinite(limit); ++i) {
    limit = limit * (1 + effort.gap) + 4 * slack;
    const Claim within = search_uncovered(
        meshes, offending, {triangles, target->surely, target->perhaps, limit, effort.parts, true});
    if (within.answer == Answer::Verified) {
      result.upper = limit;
      break;
    }
    const bool refuted = within.answer == Answer::Refuted;
    if (refuted) take(within.witness->point * meshes.scale());
    limit = std::max((refuted ? 1 : 4) * limit, result.lower);
  }
  return outside_of(meshes, result);
}

}  // namespace kaboum::verify
