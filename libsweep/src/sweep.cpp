// Swept volumes: steps for each body, a hull for each step, one margin for all. Source:
// [gaschler2016] Eq. 4.22; docs/algorithms/swept-volumes.md.

#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/rounding.h>
#include <kaboum/sweep/sweep.h>

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <thread>

#include "simplify_hull.h"

namespace kaboum::sweep {
namespace {

using geom::kUp;

/// Circumscribed radius of the icosahedron that stands for a unit ball, see enlarge.
constexpr double kOvershoot = 1.2585;
/// Share of epsilon that bodies with an explicit margin are enlarged by at least: where hardly
/// anything moves, neighbours overlap enough for a check from outside to see no gap between them.
constexpr double kLeastOverlap = 0.125;

/// What is known of a body before its hulls are built.
struct Plan {
  std::vector<PathInterval> pieces;
  double spacing = 0;   // of float32 at the body's reach
  double rounding = 0;  // most that a vertex is moved by rounding
};

struct Output {
  geom::Mesh hull;
  double deviation = 0, left_out = 0, rounding = 0, excess = 0;
};

/// Largest distance of the body from the root's origin along the path.
double extent(const Robot& robot, const LinkBody& body, const Path& path) {
  double most = 0;
  for (std::size_t i = 0; i == 0 || i + 1 < path.size(); ++i) {
    const LinkMotion motion(robot, body.link, path[i], path[std::min(i + 1, path.size() - 1)]);
    most = std::max(most, MotionBounds(motion, body.points).extent());
  }
  return most;
}

std::vector<SharedBounds> shared_bounds(const Robot& robot, std::span<const LinkBody> bodies,
                                        const Path& path) {
  std::vector<SharedBounds> out;
  for (std::size_t i = 0; i == 0 || i + 1 < path.size(); ++i) {
    SharedBounds shared;
    for (const LinkBody& body : bodies) {
      const LinkMotion motion(robot, body.link, path[i], path[std::min(i + 1, path.size() - 1)]);
      const MotionBounds bounds(motion, body.points);
      shared.radius = std::max(shared.radius, bounds.radius());
      shared.turn = std::max(shared.turn, bounds.turn());
      shared.slide = std::max(shared.slide, bounds.slide());
    }
    out.push_back(shared);
  }
  return out;
}

/// Rounds points to float32 and gives the largest move, rounded up.
double round_points(std::vector<Vec3>& points) {
  double most = 0;
  for (Vec3& p : points) {
    const Vec3 q = geom::to_float32(p);
    most = std::max(most, (q - p).squaredNorm());
    p = q;
  }
  return std::sqrt(most) * kUp;
}

/// Hull of float32 points. Those too flat to have one get neighbours in float32.
/// @return how far the neighbours are away.
double build(geom::HullBuilder& builder, std::vector<Vec3>& points) {
  if (builder.build(points)) return 0;
  const Vec3 p = points.front();
  const double step = 2 * geom::float32_spacing(p.cwiseAbs().maxCoeff());
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 q = p;
    q[axis] = geom::to_float32(q[axis] + step);
    points.push_back(q);
  }
  ensure(builder.build(points), "a flat body cannot be thickened");
  return 2 * step;
}

Output make_hull(const LinkBody& body, const PathInterval& piece, const Plan& plan,
                 const SweepOptions& options, geom::HullBuilder& builder) {
  const double left_out = options.simplify * options.epsilon;
  std::vector<Vec3> points;
  points.reserve(2 * body.points.size());
  for (const Vec3& p : body.points) points.emplace_back(piece.start * p);
  for (const Vec3& p : body.points) points.emplace_back(piece.finish * p);
  Output out;
  out.deviation = (piece.deviation + body.margin) * kUp;
  out.excess = excess(piece, body.points);
  if (!options.explicit_margin) out.rounding = round_points(points);
  if ((options.explicit_margin || left_out > 0) && builder.build(points)) {
    points = builder.mesh().vertices;
    out.left_out = simplify_hull(points, left_out, builder);
  }
  if (options.explicit_margin) {
    const double radius = std::max((out.deviation + out.left_out + plan.rounding) * kUp,
                                   kLeastOverlap * options.epsilon);
    points = enlarge(points, radius);
    out.excess += kOvershoot * radius;
    out.rounding = round_points(points);
  }
  out.excess += out.rounding + build(builder, points);
  out.hull = builder.mesh();
  return out;
}

void require_usable(const Robot& robot, std::span<const LinkBody> bodies, const Path& path,
                    const SweepOptions& options) {
  if (!(options.epsilon > 0) || !std::isfinite(options.epsilon))
    throw Error(ErrorCode::InvalidArgument, "epsilon must be a positive length");
  if (!(options.simplify >= 0 && options.simplify <= 0.9))
    throw Error(ErrorCode::InvalidArgument, "the share of epsilon to simplify by must be 0 to 0.9");
  if (path.empty()) throw Error(ErrorCode::InvalidArgument, "the path has no waypoint");
  for (const auto& waypoint : path)
    if (waypoint.size() != robot.variables.size())
      throw Error(ErrorCode::InvalidArgument, "a waypoint has not one value per variable");
  for (const LinkBody& body : bodies) {
    if (body.link >= robot.links.size() || body.points.empty() || !(body.margin >= 0))
      throw Error(ErrorCode::InvalidArgument,
                  "body " + body.name + " has no points, no link or a negative margin");
    if (body.margin > 0.5 * (1 - options.simplify) * options.epsilon)
      throw Error(ErrorCode::InvalidArgument,
                  "body " + body.name + " has a margin of more than half of epsilon" +
                      (options.simplify > 0 ? ", less its share to simplify by" : ""));
  }
}

}  // namespace

SweepResult swept_volume(const Robot& robot, std::span<const LinkBody> bodies, const Path& path,
                         const SweepOptions& options) {
  require_usable(robot, bodies, path, options);
  SweepResult result;
  result.certified = options.rule != StepRule::Baginski;
  StepOptions steps;
  steps.rule = options.rule;
  steps.merge = options.merge;
  steps.max_excess = options.max_excess;
  // Loops call it from all their threads.
  const auto tell = [&, caller = std::this_thread::get_id()](const std::string& stage) {
    if (options.progress && std::this_thread::get_id() == caller) options.progress(stage);
  };
  std::vector<Plan> plans(bodies.size());
  parallel_for(std::size_t{0}, bodies.size(), [&](std::size_t i) {
    // The ends of a balanced piece lie up to epsilon beyond the poses; explicit margins as well.
    plans[i].spacing = geom::float32_spacing(extent(robot, bodies[i], path) + 4 * options.epsilon);
    plans[i].rounding = std::numbers::sqrt3 / 2 * plans[i].spacing * kUp;
  });
  const double left_out = options.simplify * options.epsilon,
               for_motion = options.epsilon - left_out;
  double least_room = for_motion;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (plans[i].spacing > options.epsilon / 100) {
      result.stop = Stop::TooCoarse;
      return result;
    }
    least_room = std::min(least_room, for_motion - bodies[i].margin - plans[i].rounding);
  }
  if (options.rule == StepRule::Uniform || options.rule == StepRule::Baginski)
    steps.shared = shared_bounds(robot, bodies, path);
  parallel_for(std::size_t{0}, bodies.size(), [&](std::size_t i) {
    StepOptions own = steps;
    own.deviation =
        own.shared.empty() ? for_motion - bodies[i].margin - plans[i].rounding : least_room;
    own.deviation *= 1 - 1e-9;  // for the roundings up on the way to the margin
    own.progress = [&](std::size_t pieces) {
      if (options.progress) tell("steps of " + bodies[i].name + ": " + std::to_string(pieces));
    };
    plans[i].pieces = choose_steps(robot, bodies[i].link, bodies[i].points, path, own);
  });
  std::vector<std::size_t> first(bodies.size() + 1, 0);
  for (std::size_t i = 0; i < bodies.size(); ++i) first[i + 1] = first[i] + plans[i].pieces.size();
  for (std::size_t i = 0; i < bodies.size(); ++i)
    result.sources.insert(result.sources.end(), plans[i].pieces.size(), i);
  std::vector<Output> outputs(first.back());
  tbb::enumerable_thread_specific<geom::HullBuilder> builders;
  parallel_for(std::size_t{0}, outputs.size(), [&](std::size_t k) {
    const std::size_t i = result.sources[k];
    if (options.progress)
      tell("body " + std::to_string(k + 1) + " of " + std::to_string(outputs.size()));
    outputs[k] =
        make_hull(bodies[i], plans[i].pieces[k - first[i]], plans[i], options, builders.local());
  });
  result.of_link.assign(robot.links.size(), 0);
  double margin = 0, far = 0;
  for (std::size_t k = 0; k < outputs.size(); ++k) {
    const std::size_t i = result.sources[k];
    Output& out = outputs[k];
    ++result.of_link[bodies[i].link];
    result.deviation = std::max(result.deviation, out.deviation);
    result.rounding = std::max(result.rounding, out.rounding);
    result.left_out = std::max(result.left_out, out.left_out);
    margin = std::max(margin, (out.deviation + out.left_out + out.rounding) * kUp);
    far = std::max(far, out.excess);
    result.set.bodies.push_back(
        {bodies[i].name + " " + std::to_string(k - first[i]), std::move(out.hull)});
    result.pieces.push_back(plans[i].pieces[k - first[i]]);
  }
  if (!options.explicit_margin) {
    ensure(margin <= options.epsilon || !result.certified, "the margin exceeds epsilon");
    geom::set_margin(result.set, margin);
    result.excess = (far + margin) * kUp;
  } else {
    result.excess = far * kUp;
  }
  return result;
}

}  // namespace kaboum::sweep
