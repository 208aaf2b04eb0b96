// The deepest point of a solid that is in no body, by branch and bound over
// cubes. docs/algorithms/convex-decomposition.md, "From inside", has the
// bounds.

#include "depths.h"

#include <algorithm>
#include <array>

#include "cell.h"

namespace kaboum::bcd {
namespace {

/// A point will do that is this share of what is looked for.
constexpr double kEnough = 0.8;
/// The centre of a cube this small, as a share of its depth, is a seed.
constexpr double kSeedCube = 0.04;
/// How far beyond the nearest triangle points are tried that are outside, as a share of the
/// diagonal; proposals only, their winding number decides.
constexpr std::array<double, 3> kBeyond{1e-7, 1e-9, 1e-5};
/// Rounding, as a share of the largest coordinate and the diagonal.
constexpr double kSlack = 1e-12;

/// Every point as a triangle.
Mesh points_of(const Boundary& boundary) {
  Mesh out;
  out.vertices = boundary.outside;
  for (std::uint32_t i = 0; i < out.vertices.size(); ++i) out.triangles.push_back({i, i, i});
  return out;
}

}  // namespace

Depths::Depths(const Mesh& mesh, const geom::WindingNumber& winding, const Boundary& boundary)
    : winding_(winding), query_(boundary.mesh), outside_(points_of(boundary)) {
  const Box3 box = geom::bounding_box(mesh);
  diagonal_ = box.diagonal();
  slack_ =
      kSlack * (diagonal_ + std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()));
  for (const bcd::Cube& cube : cubes_over(box))
    add(cube.center, cube.half, geom::DistanceQuery::kNone, diagonal_);
}

Depths::Deepest Depths::search(const std::vector<Inscribed>& bodies, double enough, double gap,
                               bool seeds, std::size_t most) {
  Deepest out;
  for (std::size_t work = 0; !cubes_.empty() && work < most; ++work, ++looked_) {
    const Cube cube = cubes_.top();
    if (cube.upper <= std::max(enough, out.lower * (1 + gap))) break;
    if (out.lower > 0 && out.lower >= kEnough * enough && enough > 0) break;
    cubes_.pop();
    if (within(cube, bodies)) continue;
    // Bodies that touch leave slits that no center meets: what two bodies cover
    // only together is covered once more.
    if (seeds && cube.half < kSeedCube * cube.depth && cube.depth > out.depth &&
        cube.depth >= kEnough * enough) {
      out.depth = cube.depth;
      out.point = cube.center;
      cubes_.push(cube);
      break;
    }
    if (cube.depth > out.lower && !in_a_body(cube.center, bodies)) {
      out.lower = out.depth = cube.depth;
      out.point = cube.center;
    }
    const double h = 0.5 * cube.half;
    for (int i = 0; i < 8; ++i)
      add(cube.center + Vec3((i & 1) != 0 ? h : -h, (i & 2) != 0 ? h : -h, (i & 4) != 0 ? h : -h),
          h, cube.nearest, cube.upper);
  }
  out.upper = std::max(out.lower, cubes_.empty() ? 0.0 : cubes_.top().upper);
  return out;
}

bool Depths::inside(const Vec3& p) const {
  const auto w = winding_(p);
  return !w || *w >= 1;
}

void Depths::add(const Vec3& center, double half, std::uint32_t hint, double known) {
  const double radius = half * kHalfDiagonal + slack_;
  const auto at = query_.nearest(center, hint);
  const bool in = inside(center);
  // Outside, no surface within the radius: nothing of the solid here.
  if (!in && at.lower > radius) return;
  Cube cube{center, half, radius, in ? at.lower : 0, at.triangle, count_++};
  // From the center to a point outside the solid, just beyond the nearest
  // triangle where possible.
  if (in) cube.upper = outside_near(center, at.triangle) + radius;
  cube.upper = std::min(cube.upper, known);
  cubes_.push(cube);
}

/// Distance to a point that is certainly outside the solid.
double Depths::outside_near(const Vec3& p, std::uint32_t triangle) const {
  const auto& [a, b, c] = query_.corners(triangle);
  const Vec3 y = geom::nearest_point(p, a, b, c);
  const Vec3 normal = (b - a).cross(c - a).normalized();
  const Vec3 ray = (y - p).normalized();
  for (const double share : kBeyond) {
    const double step = share * diagonal_;
    for (const Vec3& direction : {ray, normal, Vec3(-normal)}) {
      if (!direction.allFinite()) continue;
      const Vec3 z = y + step * direction;
      const auto w = winding_(z);
      if (w && *w <= 0) return (z - p).norm() * kLengthUp + slack_;
    }
  }
  return outside_.nearest(p).upper;
}

bool Depths::within(const Cube& cube, const std::vector<Inscribed>& bodies) const {
  const Vec3 half = Vec3::Constant(cube.half + slack_);
  for (const Inscribed& body : bodies) {
    if ((cube.center - half).cwiseMin(body.box.min) != body.box.min ||
        (cube.center + half).cwiseMax(body.box.max) != body.box.max)
      continue;
    bool all = true;
    for (const Plane& plane : body.planes) {
      if (plane.height(cube.center) + cube.half * plane.n.cwiseAbs().sum() <= -slack_) continue;
      all = false;
      break;
    }
    if (all) return true;
  }
  return false;
}

bool Depths::in_a_body(const Vec3& p, const std::vector<Inscribed>& bodies) const {
  return std::any_of(bodies.begin(), bodies.end(),
                     [&](const Inscribed& body) { return body.contains(p, -slack_); });
}

}  // namespace kaboum::bcd
