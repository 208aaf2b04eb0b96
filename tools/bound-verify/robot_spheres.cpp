// `bound-verify robot ROBOT --spheres FILE`: whether spheres hold the links of a robot.
#include "robot_spheres.h"

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/exact_shapes.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/verify/ball_cover.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <numbers>
#include <optional>
#include <sstream>

#include "common/verdict.h"
#include "sphere_file.h"

namespace kaboum::tools {
namespace {

using verify::Answer;

struct LinkJudged {
  std::string name;
  std::size_t spheres = 0, triangles = 0;
  Answer answer = Answer::Undefined;
  verify::Inclusion inclusion;
  verify::OutsideBalls outside;
  std::string open;                  ///< why it is not known that shapes without triangles are held
  std::optional<geom::Vec3> missed;  ///< a point of such a shape that no sphere holds
};

/// @throws Error{InvalidInput} naming the first link that the robot does not have.
void require_known(const SphereFile& spheres, const std::string& file,
                   const robot::RobotFile& robot) {
  std::vector<std::string> names;
  names.reserve(robot.robot.links.size());
  for (const robot::Link& link : robot.robot.links) names.push_back(link.name);
  for (const LinkSpheres& link : spheres.links)
    if (!robot.robot.find_link(link.link))
      throw Error(ErrorCode::InvalidInput,
                  file + (link.line > 0 ? ":" + std::to_string(link.line) : "") + ": robot '" +
                      robot.robot.name + "' has no link '" + link.link + "'" +
                      did_you_mean(link.link, names));
}

/// True if one ball holds the sphere, for certain.
bool is_held(const robot::Geometry& sphere, const geom::ConvexSet& balls) {
  const geom::Vec3& c = sphere.origin.translation;
  return std::ranges::any_of(balls.bodies, [&](const geom::ConvexBody& ball) {
    const geom::Vec3& at = ball.core.vertices[0];
    if (c == at) return sphere.size.x() <= ball.radius;
    const double largest = c.cwiseAbs().maxCoeff() + at.cwiseAbs().maxCoeff() + ball.radius;
    return (c - at).norm() + sphere.size.x() + 0x1p-48 * largest <= ball.radius;
  });
}

/// Shapes that have no triangles: of round shapes it is decided that balls hold them, by
/// one ball or by a polytope round them, or nothing.
/// @return why it is not known; empty: all are held
std::string open_shape(const std::vector<robot::Geometry>& shapes, const geom::ConvexSet& balls) {
  for (const robot::Geometry& g : shapes) {
    if (robot::is_point(g)) continue;
    if (g.shape == robot::Geometry::Shape::Sphere && is_held(g, balls)) continue;
    const geom::Mesh round = *geom::convex_hull(robot::bounding_points(g));
    if (verify::verify_ball_cover(round, balls).solid.answer == Answer::Verified) continue;
    return "whether the spheres hold its " + robot::describe(g) +
           " is not decided: no one of them does, nor all a polytope round it";
  }
  return {};
}

/// A point of a round shape that is in no ball for certain, of some that are spread over
/// it.
std::optional<geom::Vec3> missed_point(const robot::Geometry& g, const geom::ConvexSet& balls) {
  constexpr int kRound = 64, kAlong = 16, kAcross = 4;
  constexpr double kInwards = 1 - 1e-9;  // rounding leaves the points in the shape
  const bool cylinder = g.shape == robot::Geometry::Shape::Cylinder;
  const auto is_missed = [&](const geom::Vec3& p) {
    return std::ranges::none_of(balls.bodies, [&](const geom::ConvexBody& ball) {
      const geom::Vec3& c = ball.core.vertices[0];
      return (p - c).norm() <= ball.radius + 1e-9 * (p.norm() + c.norm() + ball.radius);
    });
  };
  for (int i = 0; i <= kAlong; ++i)
    for (int k = 0; k < kRound; ++k)
      for (int n = 1; n <= (cylinder ? kAcross : 1); ++n) {
        const double share = 2.0 * i / kAlong - 1, angle = 2 * std::numbers::pi * k / kRound;
        const double across = cylinder ? g.size.x() * n / kAcross
                                       : g.size.x() * std::sqrt(std::max(0.0, 1 - share * share));
        const double along = share * (cylinder ? g.size.y() / 2 : g.size.x());
        geom::Vec3 local(across * std::cos(angle), across * std::sin(angle), along);
        if (g.shape == robot::Geometry::Shape::Capsule)
          local.z() += std::copysign(g.size.y() / 2, share);
        if (g.shape == robot::Geometry::Shape::Ellipsoid && g.size.x() > 0)
          local = local.cwiseProduct(g.size / g.size.x());
        const geom::Vec3 p = g.origin * (kInwards * local);
        if (is_missed(p)) return p;
      }
  return std::nullopt;
}

LinkJudged judge(const std::string& name, const geom::Mesh& mesh,
                 const std::vector<robot::Geometry>& round, const geom::ConvexSet* balls) {
  LinkJudged out;
  out.name = name;
  out.triangles = mesh.triangles.size();
  if (balls == nullptr || balls->bodies.empty()) {
    out.answer = Answer::Refuted;
    out.inclusion.surface.answer = Answer::Refuted;
    out.inclusion.surface.reason = "the link has no spheres";
    out.outside = verify::measure_outside_balls(mesh, {});
    return out;
  }
  out.spheres = balls->bodies.size();
  out.answer = Answer::Verified;
  out.open = open_shape(round, *balls);
  if (!out.open.empty()) out.answer = Answer::Undecided;
  for (const robot::Geometry& g : round)
    if (!out.open.empty() && !out.missed && !robot::is_point(g))
      out.missed = missed_point(g, *balls);
  if (out.missed) out.answer = Answer::Refuted;
  if (mesh.triangles.empty()) return out;
  out.inclusion = verify::verify_ball_cover(mesh, *balls);
  out.answer = verify::worse(out.answer, out.inclusion.surface.answer);
  if (out.inclusion.solid.answer != Answer::Undefined)
    out.answer = verify::worse(out.answer, out.inclusion.solid.answer);
  if (out.inclusion.surface.answer != Answer::Verified)
    out.outside = verify::measure_outside_balls(mesh, *balls);
  return out;
}

std::string percent(double share) {
  std::ostringstream out;
  out << std::setprecision(3) << 100 * share;
  return out.str();
}

std::string sentence_of(const LinkJudged& link) {
  const verify::Inclusion& in = link.inclusion;
  if (in.surface.answer == Answer::Verified && in.solid.answer == Answer::Refuted) {
    const geom::Vec3& p = in.solid.witness->point;
    return "every triangle is inside, but a void is left in the solid at (" + number(p.x()) + ", " +
           number(p.y()) + ", " + number(p.z()) + ")";
  }
  if (link.answer == Answer::Verified && link.triangles == 0)
    return std::to_string(link.spheres) + " spheres hold its shapes";
  if (link.answer == Answer::Verified)
    return std::to_string(link.spheres) + " spheres hold every triangle" +
           (in.solid.answer == Answer::Verified ? " and the solid" : "; its mesh is open");
  if (link.answer == Answer::Undecided && !link.open.empty()) return link.open;
  if (link.missed && in.surface.answer != Answer::Refuted)
    return "its point (" + number(link.missed->x()) + ", " + number(link.missed->y()) + ", " +
           number(link.missed->z()) + "), of a shape without triangles, is in none of its " +
           std::to_string(link.spheres) + " spheres";
  if (in.surface.answer == Answer::Undecided || in.solid.answer == Answer::Undecided)
    if (in.surface.answer != Answer::Refuted)
      return (in.surface.answer == Answer::Undecided ? in.surface.reason : in.solid.reason) +
             "; radii that are larger by a millionth would most likely decide it";
  if (link.spheres == 0) return "it has no spheres";
  const verify::OutsideBalls& o = link.outside;
  std::ostringstream out;
  out << "between " << percent(o.share_lower) << " and " << percent(o.share_upper)
      << " % of the surface is outside its " << link.spheres << " spheres, by "
      << number(o.depth_lower) << " to " << number(o.depth_upper) << " at (" << number(o.at.x())
      << ", " << number(o.at.y()) << ", " << number(o.at.z()) << ")";
  return out.str();
}

Json claim_json(const verify::Claim& claim) {
  Json json{{"answer", name_of(claim.answer)}, {"reason", claim.reason}};
  if (claim.witness)
    json["witness"] = {
        {"point", {claim.witness->point.x(), claim.witness->point.y(), claim.witness->point.z()}}};
  return json;
}

Json link_json(const LinkJudged& link) {
  Json json{{"link", link.name},
            {"answer", name_of(link.answer)},
            {"sentence", sentence_of(link)},
            {"spheres", link.spheres},
            {"triangles", link.triangles},
            {"claims",
             {{"surface", claim_json(link.inclusion.surface)},
              {"solid", claim_json(link.inclusion.solid)}}}};
  const verify::OutsideBalls& o = link.outside;
  json["share_outside"] = {{"lower", o.share_lower}, {"upper", o.share_upper}};
  if (std::isfinite(o.depth_upper))
    json["depth"] = {
        {"lower", o.depth_lower}, {"upper", o.depth_upper}, {"at", {o.at.x(), o.at.y(), o.at.z()}}};
  return json;
}

}  // namespace

int verify_spheres(const VerifyRobotOptions& o, const CommonOptions& common) {
  const ThreadLimit threads(common.threads);
  require_apart({{"--report", common.report}}, {o.original, o.spheres});
  const robot::RobotFile robot = robot::read_robot(o.original);
  robot::require_links(robot, o.how.shapes.links);
  const SphereFile spheres = read_spheres(o.spheres);
  require_known(spheres, o.spheres, robot);
  std::ostream& out = common.report == "-" ? std::cerr : std::cout;
  Answer all = Answer::Verified;
  std::vector<LinkJudged> judged;
  Json links = Json::array();
  double area = 0, outside_lower = 0, outside_upper = 0, deepest = 0;
  for (const robot::Link& link : robot.robot.links) {
    if (!o.how.shapes.has(link)) continue;
    std::vector<robot::Geometry> flat, round;
    for (const robot::Geometry& g : o.how.shapes.shapes_of(link))
      (g.shape == robot::Geometry::Shape::Mesh || g.shape == robot::Geometry::Shape::Box ? flat
                                                                                         : round)
          .push_back(g);
    const geom::Mesh mesh = robot::exact_shapes(flat, robot, o.how.shapes.packages);
    if (mesh.triangles.empty() && round.empty()) continue;
    const geom::ConvexSet* balls = nullptr;
    for (const LinkSpheres& one : spheres.links)
      if (one.link == link.name) balls = &one.balls;
    judged.push_back(judge(link.name, mesh, round, balls));
    const LinkJudged& now = judged.back();
    all = verify::worse(all, now.answer);
    const double own = now.spheres > 0 && now.outside.area == 0
                           ? verify::measure_outside_balls(mesh, {}).area
                           : now.outside.area;
    area += own;
    outside_lower += own * now.outside.share_lower;
    outside_upper += own * now.outside.share_upper;
    if (std::isfinite(now.outside.depth_lower))
      deepest = std::max(deepest, now.outside.depth_lower);
    links.push_back(link_json(now));
    if (!common.quiet)
      out << "link '" << now.name << "': " << name_of(now.answer) << ": " << sentence_of(now)
          << std::endl;
  }
  if (judged.empty())
    throw Error(ErrorCode::InvalidInput,
                o.original + ": no link has a shape" +
                    (o.how.shapes.visual ? std::string() : "; try --geometry visual"));
  for (const std::string& note : spheres.notes)
    log(common.quiet, "note: " + o.spheres + ": " + note);
  std::size_t held = 0, count = 0, bare = 0;
  for (const LinkJudged& link : judged) {
    bare += link.spheres == 0 ? 1 : 0;
    held += link.answer == Answer::Verified ? 1 : 0;
    count += link.spheres;
  }
  const double lower = area > 0 ? outside_lower / area : 0,
               upper = area > 0 ? outside_upper / area : 0;
  if (!common.report.empty())
    write_report(common, "bound-verify",
                 {{"relation", "spheres"},
                  {"verdict", name_of(all)},
                  {"geometry", o.how.shapes.visual ? "visual" : "collision"},
                  {"original", {{"file", o.original}, {"sha256", robot.sha256}}},
                  {"spheres", {{"file", o.spheres}, {"format", spheres.format}}},
                  {"count", count},
                  {"links_held", held},
                  {"share_outside", {{"lower", lower}, {"upper", upper}}},
                  {"depth", deepest},
                  {"links", std::move(links)},
                  {"notes", spheres.notes}});
  if (!common.quiet)
    out << name_of(all) << ": " << count << " spheres hold " << held << " of " << judged.size()
        << " links; " << percent(lower) << " to " << percent(upper)
        << " % of the surface is outside its own link's spheres"
        << (deepest > 0 ? ", by " + number(deepest) + " at the most" : std::string())
        << (bare > 0
                ? "; " + std::to_string(bare) + (bare == 1 ? " link has none" : " links have none")
                : std::string())
        << std::endl;
  return exit_code(all);
}

}  // namespace kaboum::tools
