// The deepest point of a solid that is in no body, by branch and bound over
// cubes. docs/algorithms/convex-decomposition.md, "From inside", has the
// bounds.

#include "depths.h"

#include <algorithm>

#include "cell.h"

namespace kaboum::bcd {
namespace {

/// A point will do that is this share of what is looked for.
constexpr double kEnough = 0.8;
/// The centre of a cube this small, as a share of its depth, is a seed.
constexpr double kSeedCube = 0.04;

}  // namespace

Depths::Depths(const Mesh& mesh, const geom::WindingNumber& winding, const Boundary& boundary)
    : bounds_(mesh, winding, boundary) {
  for (const bcd::Cube& cube : cubes_over(geom::bounding_box(mesh)))
    add(cube.center, cube.half, geom::DistanceQuery::kNone, bounds_.diagonal());
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

void Depths::add(const Vec3& center, double half, std::uint32_t hint, double known) {
  const double radius = half * kHalfDiagonal + bounds_.slack();
  const auto at = bounds_.nearest(center, hint);
  const bool in = bounds_.inside(center);
  // Outside, no surface within the radius: nothing of the solid here.
  if (!in && at.lower > radius) return;
  Cube cube{center, half, radius, in ? at.lower : 0, at.triangle, count_++};
  // From the center to a point outside the solid, just beyond the nearest
  // triangle where possible.
  if (in) cube.upper = bounds_.upper(center, at.triangle) + radius;
  cube.upper = std::min(cube.upper, known);
  cubes_.push(cube);
}

bool Depths::within(const Cube& cube, const std::vector<Inscribed>& bodies) const {
  const Vec3 half = Vec3::Constant(cube.half + bounds_.slack());
  for (const Inscribed& body : bodies) {
    if ((cube.center - half).cwiseMin(body.box.min) != body.box.min ||
        (cube.center + half).cwiseMax(body.box.max) != body.box.max)
      continue;
    bool all = true;
    for (const Plane& plane : body.planes) {
      if (plane.height(cube.center) + cube.half * plane.n.cwiseAbs().sum() <= -bounds_.slack())
        continue;
      all = false;
      break;
    }
    if (all) return true;
  }
  return false;
}

bool Depths::in_a_body(const Vec3& p, const std::vector<Inscribed>& bodies) const {
  return std::any_of(bodies.begin(), bodies.end(),
                     [&](const Inscribed& body) { return body.contains(p, -bounds_.slack()); });
}

}  // namespace kaboum::bcd
