// Convex bodies inside a solid: one is grown round the deepest point that is in none yet, until no
// point is deep. docs/algorithms/convex-decomposition.md, "From inside".

#include <kaboum/base/error.h>
#include <kaboum/bcd/fill.h>
#include <kaboum/geom/float32.h>

#include <algorithm>
#include <cmath>
#include <queue>
#include <string>

#include "cell.h"
#include "inscribe.h"
#include "options.h"

namespace kaboum::bcd {
namespace {

/// Branch and bound for the deepest point of the solid that is in no body. Bodies are added between
/// searches; what was bounded before stays bounded.
class Depths {
 public:
  Depths(const Mesh& mesh, const geom::WindingNumber& winding, const Boundary& boundary)
      : winding_(winding), query_(boundary.mesh), outside_(points_of(boundary)) {
    const Box3 box = geom::bounding_box(mesh);
    diagonal_ = box.diagonal();
    slack_ = 1e-12 *
             (diagonal_ + std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff()));
    for (const bcd::Cube& cube : cubes_over(box))
      add(cube.center, cube.half, geom::DistanceQuery::kNone, diagonal_);
  }

  struct Deepest {
    Vec3 point = Vec3::Zero();
    double depth = 0;  ///< no triangle is nearer to the point; 0: no point found
    double lower = 0;  ///< the point is in no body, and this deep
    double upper = 0;  ///< no point is deeper
  };

  /// A point in no body about as deep as any (to within the share `gap`, or any deeper than
  /// 0.8 · `enough`), unless none is deeper than `enough`. Gives up after `most` cubes; the bound
  /// is then wide.
  Deepest search(const std::vector<Inscribed>& bodies, double enough, double gap, bool seeds,
                 std::size_t most) {
    Deepest out;
    for (std::size_t work = 0; !cubes_.empty() && work < most; ++work, ++looked_) {
      const Cube cube = cubes_.top();
      if (cube.upper <= std::max(enough, out.lower * (1 + gap))) break;
      if (out.lower > 0 && out.lower >= 0.8 * enough && enough > 0) break;
      cubes_.pop();
      if (within(cube, bodies)) continue;
      // Bodies that touch leave slits that no center meets: what two bodies cover only together is
      // covered once more.
      if (seeds && cube.half < 0.04 * cube.depth && cube.depth > out.depth &&
          cube.depth >= 0.8 * enough) {
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

  /// Cubes looked at so far.
  [[nodiscard]] std::size_t looked() const { return looked_; }

 private:
  static Mesh points_of(const Boundary& boundary) {
    Mesh out;
    out.vertices = boundary.outside;
    for (std::uint32_t i = 0; i < out.vertices.size(); ++i) out.triangles.push_back({i, i, i});
    return out;
  }

  struct Cube {
    Vec3 center;
    double half;
    double upper;  // no point of the solid in the cube is deeper
    double depth;  // no triangle of the boundary is nearer to the center; 0 outside the solid
    std::uint32_t nearest;
    std::uint64_t number;
    bool operator<(const Cube& o) const {
      return upper != o.upper ? upper < o.upper : number > o.number;
    }
  };

  [[nodiscard]] bool inside(const Vec3& p) const {
    const auto w = winding_(p);
    return !w || *w >= 1;
  }

  void add(const Vec3& center, double half, std::uint32_t hint, double known) {
    const double radius = half * 1.7320508075688774 + slack_;
    const auto at = query_.nearest(center, hint);
    const bool in = inside(center);
    // Outside, no surface within the radius: nothing of the solid here.
    if (!in && at.lower > radius) return;
    Cube cube{center, half, radius, in ? at.lower : 0, at.triangle, count_++};
    // From the center to a point outside the solid, just beyond the nearest triangle where
    // possible.
    if (in) cube.upper = outside_near(center, at.triangle) + radius;
    cube.upper = std::min(cube.upper, known);
    cubes_.push(cube);
  }

  /// Distance to a point that is certainly outside the solid.
  [[nodiscard]] double outside_near(const Vec3& p, std::uint32_t triangle) const {
    const auto& [a, b, c] = query_.corners(triangle);
    const Vec3 y = geom::nearest_point(p, a, b, c);
    const Vec3 normal = (b - a).cross(c - a).normalized();
    const Vec3 ray = (y - p).normalized();
    for (const double step : {1e-7 * diagonal_, 1e-9 * diagonal_, 1e-5 * diagonal_}) {
      for (const Vec3& direction : {ray, normal, Vec3(-normal)}) {
        if (!direction.allFinite()) continue;
        const Vec3 z = y + step * direction;
        const auto w = winding_(z);
        if (w && *w <= 0) return (z - p).norm() * (1 + 1e-12) + slack_;
      }
    }
    return outside_.nearest(p).upper;
  }

  [[nodiscard]] bool within(const Cube& cube, const std::vector<Inscribed>& bodies) const {
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

  [[nodiscard]] bool in_a_body(const Vec3& p, const std::vector<Inscribed>& bodies) const {
    return std::any_of(bodies.begin(), bodies.end(),
                       [&](const Inscribed& body) { return body.contains(p, -slack_); });
  }

  const geom::WindingNumber& winding_;
  geom::DistanceQuery query_;
  geom::DistanceQuery outside_;  // points that are
  double diagonal_ = 0, slack_ = 0;
  std::priority_queue<Cube> cubes_;
  std::uint64_t count_ = 0;
  std::size_t looked_ = 0;
};

struct Tuning {
  int rounds;         ///< fits of an ellipsoid per body
  std::size_t cubes;  ///< most cubes per search
};

Tuning tuning(Effort effort) {
  switch (effort) {
    case Effort::Fast:
      return {1, 200'000};
    case Effort::Normal:
      return {4, 1'000'000};
    case Effort::Best:
      break;
  }
  return {12, 10'000'000};
}

}  // namespace

DecomposeResult fill(const geom::Prepared& input, const DecomposeOptions& options) {
  require_sound(options);
  if (options.method != Method::Planes)
    throw Error(ErrorCode::InvalidArgument, "bodies inside the solid have no choice of methods");
  if (options.min_thickness > 0)
    throw Error(ErrorCode::InvalidArgument, "bodies inside the solid cannot be thickened");
  if (options.max_total_vertices)
    throw Error(ErrorCode::InvalidArgument, "max_total_vertices is not for bodies inside");
  if (options.pre_step == PreStep::On)
    throw Error(ErrorCode::InvalidArgument, "bodies inside the solid have no pre-step");
  for (const std::uint32_t t : options.doubtful)
    if (t >= input.mesh.triangles.size())
      throw Error(ErrorCode::InvalidArgument, "doubtful triangle " + std::to_string(t) +
                                                  " is none of the mesh's " +
                                                  std::to_string(input.mesh.triangles.size()) +
                                                  "; name triangles of the mesh given");
  if (!input.closed)
    throw Error(ErrorCode::InvalidInput, "the mesh is open: bodies inside it mean nothing");
  DecomposeResult result;
  if (too_coarse(input.mesh, options)) {
    result.stop = Stop::TooCoarse;
    return result;
  }
  const double diagonal = geom::bounding_box(input.mesh).diagonal();
  const geom::WindingNumber winding(input.mesh);
  const double size = options.epsilon ? 0.08 * *options.epsilon : 0.01 * diagonal;
  const Boundary boundary = boundary_of(input.mesh, winding, size, options.doubtful);
  if (boundary.outside.empty()) throw Error(ErrorCode::InvalidInput, "the mesh has no solid");
  Depths depths(input.mesh, winding, boundary);
  const Tuning effort = tuning(options.effort);
  const double enough = options.epsilon.value_or(0);
  const std::size_t most = options.max_bodies.value_or(20000);
  std::vector<Inscribed> bodies;
  Depths::Deepest deepest;
  double begin = 0;
  // About what a cube takes that is looked at, and growing a body per triangle. [s]
  constexpr double kCube = 60e-6, kTriangle = 2e-6;
  const double allowed = work_allowed(options, input.mesh.triangles.size());
  const double per_body =
      kTriangle * effort.rounds * static_cast<double>(boundary.mesh.triangles.size());
  double work = 0;
  for (;;) {
    const bool last = bodies.size() >= most;
    const auto cubes = static_cast<std::size_t>(
        std::clamp((allowed - work) / kCube, 1000.0, static_cast<double>(effort.cubes)));
    const std::size_t before = depths.looked();
    deepest = depths.search(bodies, enough, last ? 0.02 : 0.3, !last, cubes);
    work += kCube * static_cast<double>(depths.looked() - before) + per_body;
    if (bodies.empty()) begin = deepest.upper;
    if (deepest.upper <= enough || last || deepest.depth <= 1e-6 * diagonal) break;
    if (options.progress) {
      const double share =
          options.max_bodies
              ? static_cast<double>(bodies.size()) / static_cast<double>(most)
              : std::log(begin / deepest.upper) / std::log(std::max(begin / enough, 1.01));
      options.progress({"filling", std::clamp(share, 0.0, 1.0)});
    }
    if (work >= allowed) {
      result.statistics.out_of_work = true;
      break;
    }
    std::optional<Inscribed> body = inscribe(boundary.mesh, deepest.point, deepest.depth,
                                             options.max_vertices, effort.rounds, options.safety);
    if (!body) break;
    bodies.push_back(*std::move(body));
  }
  result.reach_lower = deepest.lower;
  result.reach_upper = deepest.upper;
  if (options.epsilon && deepest.upper > *options.epsilon)
    result.stop = bodies.size() >= most           ? Stop::TooManyBodies
                  : result.statistics.out_of_work ? Stop::OutOfWork
                                                  : Stop::Stuck;
  result.statistics.leaves = bodies.size();
  for (Inscribed& body : bodies) {
    result.statistics.vertices += body.hull.vertices.size();
    result.statistics.largest = std::max(result.statistics.largest, body.hull.vertices.size());
    result.bodies.push_back({"", std::move(body.hull)});
  }
  return result;
}

}  // namespace kaboum::bcd
