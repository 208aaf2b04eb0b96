// Spheres of a robot's links against the links' shapes.
#include <kaboum/verify/sphere_verdict.h>

#include <kaboum/base/counted.h>
#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/robot/exact_shapes.h>
#include <kaboum/verify/motion_alike.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <numbers>
#include <sstream>

namespace kaboum::verify {
namespace {

using robot::Geometry;

constexpr double kFarAway = std::numeric_limits<double>::infinity();
/// Steps between the same frames in two files differ by no more than this, in sizes of the robot.
constexpr double kSameFrame = 1e-6;

std::string place_of(const std::string& file, int line) {
  return file + (line > 0 ? ":" + std::to_string(line) : "") + ": ";
}

/// @throws Error{InvalidInput} naming the first link that the robot does not have
void require_known(const robot::SphereFile& spheres, const std::string& file,
                   const robot::RobotFile& robot) {
  std::vector<std::string> names;
  names.reserve(robot.robot.links.size());
  for (const robot::Link& link : robot.robot.links) names.push_back(link.name);
  const auto is_known = [&](const robot::LinkSpheres& link) {
    return robot.robot.find_link(link.link).has_value();
  };
  const auto stranger = std::ranges::find_if_not(spheres.links, is_known);
  if (stranger == spheres.links.end()) return;
  const auto strangers = std::ranges::count_if(
      spheres.links, [&](const robot::LinkSpheres& link) { return !is_known(link); });
  std::string more = did_you_mean(stranger->link, names);
  if (2 * strangers > std::ssize(spheres.links))
    more += ", nor " + std::to_string(strangers - 1) + " other of its " +
            std::to_string(spheres.links.size()) + " links: are these another robot's spheres?";
  throw Error(ErrorCode::InvalidInput, place_of(file, stranger->line) + "robot '" +
                                           robot.robot.name + "' has no link '" + stranger->link +
                                           "'" + more);
}

/// @throws Error{InvalidInput} where the file's own robot has a frame elsewhere
void require_same_frames(const robot::SphereFile& spheres, const std::string& file,
                         const robot::Robot& robot) {
  if (!spheres.robot) return;
  const auto found = find_frame_elsewhere(robot, *spheres.robot, kSameFrame);
  if (!found) return;
  const std::string& name = robot.links[found->link].name;
  const auto own = std::ranges::find(spheres.links, name, &robot::LinkSpheres::link);
  throw Error(ErrorCode::InvalidInput, place_of(file, own == spheres.links.end() ? 0 : own->line) +
                                           "the frame of link '" + name +
                                           "' is not where the robot has it: " + found->why +
                                           "; spheres would be somewhere else");
}

/// True if one ball holds the sphere, for certain.
bool is_held(const Geometry& sphere, const geom::ConvexSet& balls) {
  const geom::Vec3& c = sphere.origin.translation;
  return std::ranges::any_of(balls.bodies, [&](const geom::ConvexBody& ball) {
    const geom::Vec3& at = ball.core.vertices[0];
    if (c == at) return sphere.size.x() <= ball.radius;
    const double largest = c.cwiseAbs().maxCoeff() + at.cwiseAbs().maxCoeff() + ball.radius;
    return (c - at).norm() + sphere.size.x() + 0x1p-48 * largest <= ball.radius;
  });
}

/// Shapes that have no triangles: of spheres and cylinders it is decided that balls hold them, by
/// one ball or by a polytope round them, or nothing.
/// @return why it is not known; empty: all are held
std::string open_shape(const std::vector<Geometry>& shapes, const geom::ConvexSet& balls) {
  for (const Geometry& g : shapes) {
    if (robot::is_point(g)) continue;
    if (g.shape == Geometry::Shape::Sphere && is_held(g, balls)) continue;
    const geom::Mesh round = *geom::convex_hull(robot::bounding_points(g));
    if (verify_ball_cover(round, balls).solid.answer == Answer::Verified) continue;
    return "whether the spheres hold its " + robot::describe(g) +
           " is not decided: no one of them does, nor all a polytope round it";
  }
  return {};
}

/// The deepest point of a round shape that is in no ball for certain, of some that are
/// spread over it.
std::optional<MissedPoint> missed_point(const Geometry& g, const geom::ConvexSet& balls) {
  constexpr int kRound = 64, kAlong = 16, kAcross = 4;
  constexpr double kInwards = 1 - 1e-9;  // rounding leaves the points in the shape
  const bool cylinder = g.shape == Geometry::Shape::Cylinder;
  MissedPoint out;
  for (int i = 0; i <= kAlong; ++i)
    for (int k = 0; k < kRound; ++k)
      for (int n = 1; n <= (cylinder ? kAcross : 1); ++n) {
        const double share = 2.0 * i / kAlong - 1, angle = 2 * std::numbers::pi * k / kRound;
        const double across = cylinder ? g.size.x() * n / kAcross
                                       : g.size.x() * std::sqrt(std::max(0.0, 1 - share * share));
        const double along = share * (cylinder ? g.size.y() / 2 : g.size.x());
        geom::Vec3 local(across * std::cos(angle), across * std::sin(angle), along);
        if (g.shape == Geometry::Shape::Capsule) local.z() += std::copysign(g.size.y() / 2, share);
        if (g.shape == Geometry::Shape::Ellipsoid && g.size.x() > 0)
          local = local.cwiseProduct(g.size / g.size.x());
        const geom::Vec3 p = g.origin * (kInwards * local);
        double depth = kFarAway;
        for (const geom::ConvexBody& ball : balls.bodies) {
          const geom::Vec3& c = ball.core.vertices[0];
          depth = std::min(
              depth, (p - c).norm() - ball.radius - 1e-9 * (p.norm() + c.norm() + ball.radius));
        }
        if (depth > out.depth) out = {p, depth};
      }
  return out.depth > 0 ? std::optional(out) : std::nullopt;
}

std::string percent(double share) {
  std::ostringstream out;
  out << std::setprecision(3) << 100 * share;
  return out.str();
}

std::string text_of(const geom::Vec3& p) {
  return "(" + number_text(p.x()) + ", " + number_text(p.y()) + ", " + number_text(p.z()) + ")";
}

std::string sentence_of(const LinkSpheresVerdict& link) {
  const Inclusion& in = link.inclusion;
  const std::string own = counted(link.spheres, "sphere", "spheres");
  if (in.surface.answer == Answer::Verified && in.solid.answer == Answer::Refuted)
    return "every triangle is inside, but a void is left in the solid at " +
           text_of(in.solid.witness->point);
  if (link.answer == Answer::Verified && link.triangles == 0)
    return counted(link.spheres, "sphere holds its shapes", "spheres hold its shapes");
  if (link.answer == Answer::Verified)
    return counted(link.spheres, "sphere holds every triangle", "spheres hold every triangle") +
           (in.solid.answer == Answer::Verified ? " and the solid" : "; its mesh is open");
  if (link.answer == Answer::Undecided && !link.open.empty()) return link.open;
  if (link.spheres == 0) return "uncovered: it has no spheres";
  if (link.missed && in.surface.answer != Answer::Refuted)
    return "its point " + text_of(link.missed->point) +
           ", of a shape without triangles, is in none of its " + own + ", by " +
           number_down(link.missed->depth);
  if (in.surface.answer != Answer::Refuted)
    return (in.surface.answer == Answer::Undecided ? in.surface.reason : in.solid.reason) +
           "; radii that are larger by a millionth would most likely decide it";
  const OutsideBalls& o = link.outside;
  return "between " + percent(o.share_lower) + " and " + percent(o.share_upper) +
         " % of the surface is outside its " + own + ", by " + number_text(o.depth_lower) + " to " +
         number_text(o.depth_upper) + " at " + text_of(o.at);
}

/// The deepest point known of a link that is not held.
std::optional<MissedPoint> deepest_of(const LinkSpheresVerdict& link,
                                      const std::optional<MissedPoint>& of_round) {
  std::optional<MissedPoint> out = of_round;
  const auto take = [&](const geom::Vec3& p, double depth) {
    if (!out || depth > out->depth) out = MissedPoint{p, depth};
  };
  if (link.inclusion.surface.answer == Answer::Refuted) {
    // Where the search in rounded numbers found none, the exact one's.
    if (link.outside.depth_lower > 0)
      take(link.outside.at, link.outside.depth_lower);
    else if (link.inclusion.surface.witness)
      take(link.inclusion.surface.witness->point, 0);
  }
  if (link.inclusion.solid.answer == Answer::Refuted && link.inclusion.solid.witness &&
      link.inclusion.surface.answer != Answer::Refuted)
    take(link.inclusion.solid.witness->point, link.inclusion.solid.witness->depth);
  return out;
}

/// @param round  the link's spheres and cylinders; all else are the triangles
void judge(const std::vector<Geometry>& round, LinkSpheresVerdict& out) {
  out.triangles = out.mesh.triangles.size();
  out.spheres = out.balls.bodies.size();
  std::optional<MissedPoint> missed;
  if (out.spheres == 0) {
    out.answer = out.inclusion.surface.answer = Answer::Refuted;
    out.inclusion.surface.reason = "the link has no spheres";
    out.outside = measure_outside_balls(out.mesh, {});
  } else {
    out.answer = Answer::Verified;
    out.open = open_shape(round, out.balls);
    if (!out.open.empty()) {
      out.answer = Answer::Undecided;
      for (const Geometry& g : round) {
        if (robot::is_point(g)) continue;
        if (const std::optional<MissedPoint> one = missed_point(g, out.balls);
            one && (!missed || one->depth > missed->depth))
          missed = one;
      }
    }
    if (missed) out.answer = Answer::Refuted;
    if (!out.mesh.triangles.empty()) {
      out.inclusion = verify_ball_cover(out.mesh, out.balls);
      out.answer = worse(out.answer, out.inclusion.surface.answer);
      if (out.inclusion.solid.answer != Answer::Undefined)
        out.answer = worse(out.answer, out.inclusion.solid.answer);
      if (out.inclusion.surface.answer != Answer::Verified)
        out.outside = measure_outside_balls(out.mesh, out.balls);
      else
        out.outside.area = measure_outside_balls(out.mesh, {}).area;
    }
  }
  if (out.answer == Answer::Refuted) out.missed = deepest_of(out, missed);
  out.held = out.answer;
  out.sentence = sentence_of(out);
}

/// Links of which no sphere comes near: most likely another robot's, or of another frame.
void note_far_spheres(SpheresVerdict& out) {
  std::vector<std::string> far;
  for (const LinkSpheresVerdict& link : out.links) {
    if (link.spheres == 0 || link.mesh.triangles.empty()) continue;
    const geom::Box3 box = geom::bounding_box(link.mesh);
    if (std::ranges::none_of(link.balls.bodies, [&](const geom::ConvexBody& ball) {
          const geom::Vec3& c = ball.core.vertices[0];
          return (c - c.cwiseMax(box.min).cwiseMin(box.max)).norm() <= ball.radius;
        }))
      far.push_back(link.link);
  }
  if (far.empty()) return;
  out.notes.push_back("no sphere of " + robot::names_of(far) +
                      " comes near the shapes: are the spheres in another frame, or another "
                      "robot's?");
}

void sum_up(SpheresVerdict& out) {
  double area = 0, lower = 0, upper = 0;
  std::vector<std::string> farther;
  for (const LinkSpheresVerdict& link : out.links) {
    add_farther(link.link, link.reach, farther);
    out.answer = worse(out.answer, link.answer);
    out.spheres += link.spheres;
    if (link.spheres == 0) out.uncovered.push_back(link.link);
    out.held += link.held == Answer::Verified ? 1 : 0;
    out.within += link.reach.all && link.reach.all->answer == Answer::Verified ? 1 : 0;
    area += link.outside.area;
    lower += link.outside.area * link.outside.share_lower;
    upper += link.outside.area * link.outside.share_upper;
    if (link.missed && std::isfinite(link.missed->depth))
      out.depth = std::max(out.depth, link.missed->depth);
  }
  out.share_lower = area > 0 ? lower / area : 0;
  out.share_upper = area > 0 ? upper / area : 0;
  out.sentence = counted(out.spheres, "sphere holds ", "spheres hold ") + std::to_string(out.held) +
                 " of " + counted(out.links.size(), "link", "links") + "; " +
                 percent(out.share_lower) + " to " + percent(out.share_upper) +
                 " % of the surface is outside its own link's spheres" +
                 (out.depth > 0 ? ", by " + number_text(out.depth) + " at the most" : "");
  if (out.epsilon)
    out.sentence += "; of " + counted(out.within, "link", "links") + " none is farther than " +
                    number_text(*out.epsilon);
  out.sentence += text_of_farther(farther);
  if (!out.uncovered.empty())
    out.sentence += "; uncovered, without a sphere: " + robot::names_of(out.uncovered);
}

}  // namespace

void require_spheres_of(const robot::RobotFile& robot, const robot::SphereFile& spheres,
                        const std::string& file) {
  require_known(spheres, file, robot);
  require_same_frames(spheres, file, robot.robot);
}

SpheresVerdict decide_spheres(const robot::RobotFile& robot, const robot::SphereFile& spheres,
                              const std::string& file, const robot::ShapeChoice& shapes,
                              const std::function<void(const LinkSpheresVerdict&)>& judged,
                              std::optional<double> epsilon, const robot::LinkBounds& bounds) {
  require_spheres_of(robot, spheres, file);
  SpheresVerdict out;
  out.epsilon = epsilon;
  robot::MeshFiles files(robot.path, shapes.packages);
  for (std::uint32_t index = 0; index < robot.robot.links.size(); ++index) {
    const robot::Link& link = robot.robot.links[index];
    if (!shapes.has(link)) continue;
    std::vector<Geometry> flat, round;
    for (const Geometry& g : shapes.shapes_of(link))
      if (!robot::is_point(g))
        (g.shape == Geometry::Shape::Mesh || g.shape == Geometry::Shape::Box ? flat : round)
            .push_back(g);
    LinkSpheresVerdict one;
    one.link = link.name;
    one.index = index;
    one.mesh = robot::exact_shapes(flat, files);
    for (const robot::LinkSpheres& given : spheres.links)
      if (given.link == link.name) one.balls = given.balls;
    if (one.mesh.triangles.empty() && round.empty()) {
      if (!shapes.shapes_of(link).empty()) out.notes.push_back(text_of_points(link.name));
      if (one.balls.bodies.empty() || !asks_how_far(link.name, epsilon, bounds)) continue;
      out.answer = worse(out.answer, Answer::Undecided);
      out.notes.push_back(text_of_bare_link(link.name));
      continue;
    }
    judge(round, one);
    if (one.spheres > 0)  // none are not near either
      one.reach = decide_link_reach(one.balls, one.balls, link.name, shapes.shapes_of(link), files,
                                    epsilon, bounds);
    one.answer = worse(one.answer, one.reach.answer());
    one.sentence += one.reach.sentence();
    out.links.push_back(std::move(one));
    if (judged) judged(out.links.back());
  }
  if (out.links.empty())
    throw Error(ErrorCode::InvalidInput,
                robot.path.string() + ": no link has a shape" +
                    (shapes.visual ? std::string() : "; try «geometry=visual»"));
  out.notes.insert(out.notes.begin(), spheres.notes.begin(), spheres.notes.end());
  if (!spheres.robot_name.empty() && spheres.robot_name != robot.robot.name)
    out.notes.push_back("the file says that it is of robot '" + spheres.robot_name +
                        "'; this one is '" + robot.robot.name + "'");
  for (const std::string& note :
       robot::notes_on({{}, robot::bare_links(robot.robot, shapes.visual, shapes.links).other},
                       shapes.visual, ": nothing of this is judged"))
    out.notes.push_back(note);
  note_far_spheres(out);
  sum_up(out);
  return out;
}

}  // namespace kaboum::verify
