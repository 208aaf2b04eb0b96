// Spheres of somebody's, changed until they hold their links.
#include <kaboum/certify/sphere_repair.h>

#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/robot/exact_shapes.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/sphere_verdict.h>

#include <algorithm>
#include <utility>

namespace kaboum::certify {
namespace {

using robot::Geometry;

constexpr int kRounds = 6;  ///< of points that the exact decision found

/// A link whose spheres are repaired.
struct RepairedBalls {
  std::uint32_t link;
  geom::SolidMesh solid;
  double epsilon;  ///< to the solid, of which the spheres may reach [length]
  double asked;    ///< to the shapes [length]
  bcd::BallOptions options;
  std::vector<bcd::Ball> given, balls;
  std::vector<bool> within;  ///< those given that reach no farther than epsilon
};

std::vector<bcd::Ball> balls_of(const geom::ConvexSet& set) {
  std::vector<bcd::Ball> out;
  out.reserve(set.bodies.size());
  for (const geom::ConvexBody& body : set.bodies)
    out.push_back({body.core.vertices[0], body.radius});
  return out;
}

geom::ConvexSet set_of(const std::vector<bcd::Ball>& balls) {
  geom::ConvexSet out;
  for (const bcd::Ball& ball : balls) {
    geom::ConvexBody body;
    body.core.vertices = {ball.center};
    body.radius = ball.radius;
    out.bodies.push_back(std::move(body));
  }
  return out;
}

bool is_held(const Geometry& sphere, const std::vector<bcd::Ball>& balls) {
  return std::ranges::any_of(balls, [&](const bcd::Ball& ball) {
    const double reach = (sphere.origin.translation - ball.center).norm() + sphere.size.x();
    return reach <= ball.radius * (1 + 1e-12);
  });
}

/// The shapes as they are held: a sphere that one ball holds stands for a smaller one, of which the
/// polytope is in it.
/// @param beyond  how far the polytopes reach beyond the shapes [length]
std::vector<Geometry> held_shapes(const std::vector<Geometry>& shapes,
                                  const std::vector<bcd::Ball>& balls, double& beyond) {
  std::vector<Geometry> out = shapes;
  beyond = 0;
  for (Geometry& g : out) {
    if (robot::is_point(g)) continue;
    const double excess = g.shape == Geometry::Shape::Mesh || g.shape == Geometry::Shape::Box
                              ? 0
                              : robot::bounding_excess(g);
    if (g.shape == Geometry::Shape::Sphere && is_held(g, balls))
      g.size *= (1 - 1e-9) * g.size.x() / (g.size.x() + excess);
    else
      beyond = std::max(beyond, excess);
  }
  return out;
}

/// Of each ball, whether it is within epsilon.
std::vector<bool> within_epsilon(const std::vector<bcd::Ball>& balls, const geom::Mesh& solid,
                                 double epsilon) {
  const auto fits = [&](const std::vector<bcd::Ball>& some) {
    return verify::verify_excess(set_of(some), solid, epsilon, true).answer ==
           verify::Answer::Verified;
  };
  if (balls.empty() || fits(balls)) return std::vector<bool>(balls.size(), true);
  std::vector<bool> out;
  out.reserve(balls.size());
  for (const bcd::Ball& ball : balls) out.push_back(fits({ball}));
  return out;
}

Error named(const Error& error, const robot::RobotFile& robot, const std::string& link) {
  return {error.code(), robot.path.string() + ": link '" + link + "': " + error.what()};
}

RepairedBalls begin(const robot::RobotFile& robot, std::uint32_t index,
                    const robot::SphereFile& given, const RepairRequest& request,
                    robot::MeshFiles& files, const RobotHooks& hooks,
                    std::vector<std::string>& notes) {
  const robot::Link& link = robot.robot.links[index];
  geom::PrepareOptions preparation;
  preparation.holes = geom::Holes::Fill;
  RepairedBalls out;
  out.link = index;
  for (const robot::LinkSpheres& one : given.links)
    if (one.link == link.name) out.given = balls_of(one.balls);
  double beyond = 0;
  const std::vector<Geometry> shapes =
      held_shapes(request.shapes.shapes_of(link), out.given, beyond);
  const geom::Mesh mesh = robot::exact_shapes(shapes, files);
  try {
    geom::Prepared prepared = geom::prepare(mesh, preparation);
    for (const std::string& note : prepared.report.notes)
      notes.push_back("link '" + link.name + "': " + note);
    out.solid = geom::close_holes(prepared.solid);
  } catch (const Error& error) {
    throw named(error, robot, link.name);
  }
  out.asked = request.epsilon.of(geom::bounding_box(mesh).diagonal());
  out.epsilon = out.asked - beyond;
  if (!(out.epsilon > 0))
    throw Error(ErrorCode::InvalidArgument,
                robot.path.string() + ": link '" + link.name +
                    "': its shapes are held by way of polytopes that are up to " +
                    number_text(beyond) + " farther: allow an epsilon above that");
  out.options.epsilon = out.epsilon;
  out.options.effort = request.effort;
  if (hooks.progress)
    out.options.progress = [&hooks, name = link.name](const bcd::Progress& p) {
      hooks.progress("link '" + name + "': " + p.stage);
    };
  try {
    out.within = within_epsilon(out.given, out.solid.mesh(), out.epsilon);
    out.balls = bcd::repair_balls(out.solid, out.given, out.within, out.options);
  } catch (const Error& error) {
    throw named(error, robot, link.name);
  }
  return out;
}

RepairedLink counted(const RepairedBalls& made, const robot::RobotFile& robot) {
  RepairedLink out;
  out.link = robot.robot.links[made.link].name;
  out.added = made.balls.size() - made.given.size();
  for (std::size_t i = 0; i < made.given.size(); ++i) {
    const bcd::Ball &was = made.given[i], &is = made.balls[i];
    ++(is.center != was.center  ? out.moved
       : is.radius > was.radius ? out.grown
       : is.radius < was.radius ? out.shrunk
                                : out.kept);
  }
  out.epsilon = made.asked;
  return out;
}

/// @throws Error{LimitReached} where a sphere reaches farther, as far as is known
void require_within(const RepairedBalls& made, const geom::ConvexSet& read,
                    const std::string& name) {
  const verify::DistanceClaim found =
      verify::verify_excess(read, made.solid.mesh(), made.epsilon, true);
  if (found.answer != verify::Answer::Verified)
    throw Error(ErrorCode::LimitReached, "link '" + name +
                                             "': it is not known that its spheres "
                                             "are within epsilon (" +
                                             found.reason + "); nothing is written");
}

const geom::ConvexSet& set_of(const robot::SphereFile& spheres, const std::string& link) {
  const auto at = std::ranges::find(spheres.links, link, &robot::LinkSpheres::link);
  if (at == spheres.links.end())
    throw Error(ErrorCode::Internal, "link '" + link + "' has no spheres in what is written");
  return at->balls;
}

}  // namespace

RepairedSpheres repair_spheres(const robot::RobotFile& robot, const std::string& file,
                               const std::string& text, const RepairRequest& request,
                               const RobotHooks& hooks) {
  const robot::SphereFile given = robot::parse_spheres(file, text);
  verify::require_spheres_of(robot, given, file);
  RepairedSpheres out;
  out.notes = given.notes;
  std::vector<RepairedBalls> links;
  robot::MeshFiles files(robot.path, request.shapes.packages);
  for (std::uint32_t i = 0; i < robot.robot.links.size(); ++i) {
    const robot::Link& link = robot.robot.links[i];
    if (request.shapes.has(link) &&
        std::ranges::any_of(request.shapes.shapes_of(link),
                            [](const Geometry& g) { return !robot::is_point(g); }))
      links.push_back(begin(robot, i, given, request, files, hooks, out.notes));
  }
  for (int round = 0;; ++round) {
    std::vector<robot::LinkSpheres> wanted;
    wanted.reserve(links.size());
    for (const RepairedBalls& made : links)
      wanted.push_back({robot.robot.links[made.link].name, 0, set_of(made.balls)});
    out.text = robot::edited_spheres(file, text, wanted);
    const robot::SphereFile read = robot::parse_spheres(file, out.text);
    if (hooks.progress) hooks.progress("verifying");
    const verify::SpheresVerdict verdict =
        verify::decide_spheres(robot, read, file, request.shapes);
    if (verdict.answer == verify::Answer::Verified) {
      for (const RepairedBalls& made : links) {
        const std::string& name = robot.robot.links[made.link].name;
        require_within(made, set_of(read, name), name);
        out.links.push_back(counted(made, robot));
      }
      out.spheres = verdict.spheres;
      return out;
    }
    bool is_new = false;
    for (RepairedBalls& made : links)
      for (const verify::LinkSpheresVerdict& link : verdict.links) {
        if (link.index != made.link || link.answer == verify::Answer::Verified) continue;
        for (const verify::Claim* claim : {&link.inclusion.surface, &link.inclusion.solid})
          if (claim->witness) {
            made.options.held.push_back(claim->witness->point);
            is_new = true;
          }
        made.balls = bcd::repair_balls(made.solid, made.given, made.within, made.options);
      }
    if (!is_new || round >= kRounds)
      throw Error(ErrorCode::LimitReached,
                  "no spheres were found that pass the exact check (" + verdict.sentence +
                      "); nothing is written. A larger «epsilon» may help");
  }
}

}  // namespace kaboum::certify
