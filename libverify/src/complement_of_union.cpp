// What convex bodies leave of a box: cuts along their facets, lowered by the rounding of the
// normals. docs/algorithms/exact-inclusion.md, "Uncovered regions".
#include "complement_of_union.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "nearest.h"

namespace kaboum::verify {
namespace {

constexpr std::size_t kMostBodies = 8, kMostParts = 600;
constexpr double kAlike = 0.1;  // between normals of planes that are taken for one

}  // namespace

ComplementOfUnion::ComplementOfUnion(const MeshPair& meshes, const geom::ConvexSet& set) {
  std::vector<Bounds> boxes;
  std::vector<std::uint32_t> items;
  for (const geom::ConvexBody& body : set.bodies) {
    if (body.core.triangles.empty() || !MeshPair(geom::Mesh{}, body.core).closed(kOutside))
      continue;
    Body planes = body_of(body.core, meshes);
    if (planes.planes.empty()) continue;
    const geom::Box3 box = geom::bounding_box(body.core);
    Bounds bounds;
    for (int k = 0; k < 3; ++k) {
      bounds.low[k] = box.min[k] * meshes.scale();
      bounds.high[k] = box.max[k] * meshes.scale();
    }
    items.push_back(static_cast<std::uint32_t>(bodies_.size()));
    boxes.push_back(bounds);
    bodies_.push_back(std::move(planes));
  }
  if (!bodies_.empty()) tree_ = BoxTree(std::move(boxes), std::move(items));
}

// Normals from exact products: facets may be slivers, whose corners are in a line but for the last
// bits of float32.
ComplementOfUnion::Body ComplementOfUnion::body_of(const geom::Mesh& hull, const MeshPair& meshes) {
  const double largest = meshes.largest_coordinate();
  const double slack = rounding_of_distances(largest);
  Body body;
  for (const geom::Triangle& t : hull.triangles) {
    const Vec3 a = hull.vertices[t[0]] * meshes.scale(), b = hull.vertices[t[1]] * meshes.scale(),
               c = hull.vertices[t[2]] * meshes.scale();
    Triple<Exact> ab, ac;
    for (int k = 0; k < 3; ++k) {
      ab[k] = difference<Exact>(b[k], a[k]);
      ac[k] = difference<Exact>(c[k], a[k]);
    }
    Vec3 normal;
    double error = 0;
    bool area = false;
    for (int k = 0; k < 3; ++k) {
      const int u = (k + 1) % 3, v = (k + 2) % 3;
      const Exact exact = ab[u] * ac[v] - ab[v] * ac[u];
      const Approx x = rounded(exact);
      normal[k] = x.value;
      error += x.error;
      area = area || sign_of(exact) != Sign::Zero;
    }
    if (!area) continue;  // seen from nowhere
    const double norm = normal.norm();
    // What the rounding of the normal turns the plane by, times how far away from `a` points are.
    const double turned = (4 * error / norm + 64 * kUnit) * 4 * largest;
    const Vec3 unit = normal / norm;
    const double height = std::min({unit.dot(a), unit.dot(b), unit.dot(c)}) - turned - 2 * slack;
    if (!(norm > 0) || !std::isfinite(height)) return {};
    body.planes.push_back({unit, height});
  }
  return body;
}

std::optional<ComplementOfUnion::Crossing> ComplementOfUnion::crossing_planes(const Body& body,
                                                                              const Bounds& box) {
  const Vec3 low(box.low.data()), high(box.high.data());
  const Vec3 middle = 0.5 * (low + high), half = 0.5 * (high - low);
  Crossing result;
  struct FacetCrossing {
    const Plane* plane;
    double at;  ///< height of the box's middle above it
  };
  std::vector<FacetCrossing> met;
  for (const Plane& plane : body.planes) {
    const double at = plane.normal.dot(middle) - plane.height;
    const double extent = plane.normal.cwiseAbs().dot(half);
    result.depth = std::min(result.depth, -at);
    if (at >= extent) return std::nullopt;
    if (at > -extent) met.push_back({&plane, at});
  }
  // The lowest ones first: what is above them in all of the box takes nothing from them.
  std::stable_sort(met.begin(), met.end(),
                   [](const FacetCrossing& a, const FacetCrossing& b) { return a.at > b.at; });
  for (const FacetCrossing& m : met) {
    const Plane* const plane = m.plane;
    const auto alike = std::find_if(
        result.planes.begin(), result.planes.end(),
        [&](const Plane& p) { return (p.normal - plane->normal).squaredNorm() < kAlike * kAlike; });
    if (alike == result.planes.end()) {
      result.planes.push_back(*plane);
      continue;
    }
    // In the box n·x is at most n'·x plus the largest (n − n')·x.
    const Vec3 difference = plane->normal - alike->normal;
    alike->height = std::min(
        alike->height, plane->height - difference.dot(middle) - difference.cwiseAbs().dot(half));
  }
  return result;
}

bool ComplementOfUnion::subtract(const std::vector<Plane>& planes, const Part& part,
                                 std::vector<Part>& out) {
  std::vector<const Plane*> crossing;
  for (const Plane& plane : planes) {
    int outside = 0;
    for (const Vec3& p : part.corners) outside += plane.normal.dot(p) > plane.height ? 1 : 0;
    if (outside == 4) {
      out.push_back(part);
      return true;
    }
    if (outside > 0) crossing.push_back(&plane);
  }
  std::vector<Part> inside{part}, next;
  for (const Plane* plane : crossing) {
    next.clear();
    for (const Part& p : inside) {
      int outside = 0;
      for (const Vec3& x : p.corners) outside += plane->normal.dot(x) > plane->height ? 1 : 0;
      if (outside == 0) {
        next.push_back(p);
      } else if (outside == 4) {
        out.push_back(p);
      } else if (p.cuts >= kMostCuts) {
        return false;
      } else {
        cut(p, *plane, out, next);
      }
    }
    inside.swap(next);
    if (inside.size() + out.size() > kMostParts) return false;
  }
  return true;
}

bool ComplementOfUnion::one_holds(const Bounds& box) const {
  const Vec3 low(box.low.data()), high(box.high.data());
  const Vec3 middle = 0.5 * (low + high), half = 0.5 * (high - low);
  bool held = false;
  tree_.query([&](const Bounds& b) { return !held && b.meets(box); },
              [&](std::uint32_t body) {
                held = held || std::all_of(bodies_[body].planes.begin(), bodies_[body].planes.end(),
                                           [&](const Plane& plane) {
                                             return plane.normal.dot(middle) +
                                                        plane.normal.cwiseAbs().dot(half) <=
                                                    plane.height;
                                           });
              });
  return held;
}

bool ComplementOfUnion::parts(const Bounds& box, std::vector<Part>& out) const {
  out.clear();
  std::vector<Crossing> near;
  tree_.query([&](const Bounds& b) { return b.meets(box); },
              [&](std::uint32_t body) {
                if (auto crossing = crossing_planes(bodies_[body], box))
                  near.push_back(std::move(*crossing));
              });
  if (near.empty()) return false;
  // What covers most comes first.
  std::stable_sort(near.begin(), near.end(),
                   [](const Crossing& a, const Crossing& b) { return a.depth > b.depth; });
  if (near.size() > kMostBodies) near.resize(kMostBodies);
  std::vector<Part> left;
  for (const Tetrahedron& t : tetrahedra(box)) out.push_back({t, 0});
  for (const Crossing& body : near) {
    left.clear();
    for (const Part& part : out)
      if (!subtract(body.planes, part, left)) return false;
    out.swap(left);
    if (out.empty()) break;
  }
  return true;
}

}  // namespace kaboum::verify
