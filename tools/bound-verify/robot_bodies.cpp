// `bound-verify robot ROBOT --bodies FILE`: whether capsules, boxes, cylinders and spheres hold a
// robot's links.
#include "robot_bodies.h"

#include <kaboum/base/counted.h>
#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/robot/exact_shapes.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/link_reach.h>
#include <kaboum/verify/motion_alike.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <optional>

#include "common/verdict.h"

namespace kaboum::tools {
namespace {

using geom::Vec3;
using robot::Geometry;
using verify::Answer;

/// Of lengths: bounds what the pose of a shape, whose rotation is computed from angles within
/// 40 · 2^-53, and a dozen operations err by.
constexpr double kPoseRounding = 0x1p-45;
/// Steps between the same frames in two formats differ by no more than this, in sizes of the robot.
constexpr double kSameFrame = 1e-9;
constexpr double kLeastCapsule = 0.5;  ///< of its cylinder's radius: thinner ones are of no use
/// Of a ball's radius: what is lost where a capsule that it ends stands for it.
constexpr double kSameEnd = 1e-10;

/// Bodies within the shapes of a link, and bodies round them.
struct Bounds {
  geom::ConvexSet inside, outside;
};

void add(geom::ConvexSet& set, geom::Mesh core, double radius) {
  set.bodies.push_back({"shape_" + std::to_string(set.bodies.size()), std::move(core), radius});
}

/// The box of a shape with sides that are longer by twice `more`.
std::optional<geom::Mesh> box_of(const Geometry& g, double more) {
  const Vec3 half = 0.5 * g.size + Vec3::Constant(more);
  if (!(half.minCoeff() > 0)) return std::nullopt;
  std::vector<Vec3> corners;
  corners.reserve(8);
  for (int i = 0; i < 8; ++i)
    corners.emplace_back(g.origin * Vec3((i & 1) != 0 ? half.x() : -half.x(),
                                         (i & 2) != 0 ? half.y() : -half.y(),
                                         (i & 4) != 0 ? half.z() : -half.z()));
  return geom::convex_hull(corners);
}

/// The largest radius of a ball about an end of a cylinder that lies in one of the spheres.
double ball_at(const Vec3& end, const std::vector<Geometry>& shapes) {
  double out = 0;
  for (const Geometry& g : shapes)
    if (g.shape == Geometry::Shape::Sphere)
      out = std::max(out, g.size.x() - (g.origin.translation - end).norm());
  return out;
}

/// A prism with 32 sides in a cylinder.
std::optional<geom::Mesh> prism_in(const Geometry& g, double error) {
  constexpr int kSides = 32;
  const double radius = g.size.x() - error, half = 0.5 * g.size.y() - error;
  if (!(radius > 0 && half > 0)) return std::nullopt;
  std::vector<Vec3> points;
  points.reserve(std::size_t{2} * kSides);
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::acos(-1.0) * i / kSides;
    for (const double z : {-half, half})
      points.emplace_back(g.origin * Vec3(radius * std::cos(angle), radius * std::sin(angle), z));
  }
  return geom::convex_hull(points);
}

void add_cylinder(const Geometry& g, double error, const std::vector<Geometry>& shapes,
                  Bounds& out) {
  const double half = 0.5 * g.size.y();
  const Vec3 low = g.origin * Vec3(0, 0, -half), high = g.origin * Vec3(0, 0, half);
  // What the balls at its ends and the cylinder hold.
  const double radius = std::min({g.size.x(), ball_at(low, shapes), ball_at(high, shapes)}) - error;
  const bool is_segment = low != high;
  if (is_segment && radius > kLeastCapsule * g.size.x())
    add(out.inside, {{low, high}, {}}, radius);
  else if (auto prism = prism_in(g, error))
    add(out.inside, *std::move(prism), 0);
  if (is_segment)
    add(out.outside, {{low, high}, {}}, g.size.x() + error);
  else if (g.size.x() + error > 0)
    add(out.outside, {{low}, {}}, g.size.x() + error);
}

/// A segment and a radius: one body.
void add_capsule(const Geometry& g, double error, Bounds& out) {
  const double half = 0.5 * g.size.y();
  const Vec3 low = g.origin * Vec3(0, 0, -half), high = g.origin * Vec3(0, 0, half);
  geom::Mesh core{{low, high}, {}};
  if (low == high) core.vertices.pop_back();
  if (g.size.x() - error > 0) add(out.inside, core, g.size.x() - error);
  add(out.outside, std::move(core), g.size.x() + error);
}

/// Without balls that reach out of a capsule by no more than `most`. Two bodies with the same
/// surface leave points undecided where that surface touches the edges of two others.
geom::ConvexSet without_ends(const geom::ConvexSet& set, double most) {
  const auto is_end = [&](const geom::ConvexBody& ball) {
    if (ball.core.vertices.size() != 1) return false;
    return std::ranges::any_of(set.bodies, [&](const geom::ConvexBody& other) {
      if (other.core.vertices.size() != 2) return false;
      const Vec3& c = ball.core.vertices[0];
      const double away =
          std::min((other.core.vertices[0] - c).norm(), (other.core.vertices[1] - c).norm());
      const double rounding = 1e-15 * (away + ball.radius);
      return away + ball.radius + rounding <= other.radius + most * ball.radius;
    });
  };
  geom::ConvexSet out;
  for (const geom::ConvexBody& body : set.bodies)
    if (!is_end(body)) out.bodies.push_back(body);
  return out;
}

/// @throws Error{InvalidInput} naming the line of a shape of another kind
Bounds bounds_of(const robot::Link& link, const std::string& file) {
  Bounds out;
  for (const Geometry& g : link.collision) {
    const double error = kPoseRounding * (g.origin.translation.norm() + 2 * g.size.norm());
    switch (g.shape) {
      case Geometry::Shape::Sphere:
        if (!(g.size.x() > 0)) break;
        add(out.inside, {{g.origin.translation}, {}}, g.size.x());
        add(out.outside, {{g.origin.translation}, {}}, g.size.x());
        break;
      case Geometry::Shape::Box:
        if (auto box = box_of(g, -error)) add(out.inside, *std::move(box), 0);
        if (auto box = box_of(g, error)) add(out.outside, *std::move(box), 0);
        break;
      case Geometry::Shape::Cylinder:
        add_cylinder(g, error, link.collision, out);
        break;
      case Geometry::Shape::Capsule:
        add_capsule(g, error, out);
        break;
      case Geometry::Shape::Ellipsoid:
      case Geometry::Shape::Mesh: {
        const bool is_mesh = g.shape == Geometry::Shape::Mesh;
        throw Error(ErrorCode::InvalidInput,
                    file + ":" + std::to_string(g.line) + ": link '" + link.name +
                        "': its collision shapes are to be spheres, boxes, cylinders and capsules; "
                        "this is " +
                        (is_mesh ? "a mesh: state the file as RESULT" : "an " + describe(g)));
      }
    }
  }
  return out;
}

struct LinkAnswer {
  std::string name, sentence;
  std::size_t shapes = 0, triangles = 0;
  Answer answer = Answer::Verified;
  Answer held = Answer::Undefined;  ///< `answer` without the distance
  verify::LinkReach reach = {};
  verify::Inclusion inclusion;
};

/// What bodies inside hold is verified, what bodies outside do not hold is refuted.
verify::Inclusion decide(const geom::Mesh& mesh, const Bounds& bounds) {
  const auto is_done = [](const verify::Claim& claim) {
    return claim.answer == Answer::Verified || claim.answer == Answer::Undefined;
  };
  const auto are_done = [&](const verify::Inclusion& one) {
    return is_done(one.surface) && is_done(one.solid);
  };
  // Fewer bodies inside hold no more; all of them may hold what needs a whole ball.
  const geom::ConvexSet fewer = without_ends(bounds.inside, kSameEnd);
  verify::Inclusion inside = verify::verify_cover(mesh, fewer).inclusion;
  if (!are_done(inside) && fewer.bodies.size() < bounds.inside.bodies.size()) {
    verify::Inclusion all = verify::verify_cover(mesh, bounds.inside).inclusion;
    if (are_done(all) || !is_done(inside.surface)) inside = std::move(all);
  }
  if (are_done(inside)) return inside;
  const verify::Inclusion outside =
      verify::verify_cover(mesh, without_ends(bounds.outside, 0)).inclusion;
  const auto between = [&](verify::Claim& claim, const verify::Claim& necessary) {
    if (is_done(claim)) return;
    if (necessary.answer == Answer::Refuted) {
      claim = necessary;
    } else {
      claim.answer = Answer::Undecided;
      claim.reason =
          "bodies within its shapes do not hold it, and bodies round them do: cylinders without "
          "balls "
          "stand for prisms, and poses are rounded";
    }
  };
  between(inside.surface, outside.surface);
  between(inside.solid, outside.solid);
  return inside;
}

/// True if a shape is the other one, or this with larger sizes: in the same place, bit by bit.
bool is_in(const Geometry& g, const Geometry& other) {
  return g.shape == other.shape && g.origin.linear == other.origin.linear &&
         g.origin.translation == other.origin.translation &&
         (g.size.array() <= other.size.array()).all();
}

/// True if a body about a point or a segment holds a sphere or a capsule, for certain.
bool is_in(const Geometry& g, const geom::ConvexBody& body) {
  const bool is_sphere = g.shape == Geometry::Shape::Sphere;
  if ((!is_sphere && g.shape != Geometry::Shape::Capsule) || body.core.vertices.size() > 2)
    return false;
  const Vec3 &a = body.core.vertices.front(), &b = body.core.vertices.back();
  if (is_sphere && a == b && a == g.origin.translation) return g.size.x() <= body.radius;
  const double half = is_sphere ? 0 : 0.5 * g.size.y();
  const double error = kPoseRounding * (g.origin.translation.norm() + 2 * g.size.norm() + a.norm() +
                                        b.norm() + body.radius);
  return std::ranges::all_of(std::array{-half, half}, [&](double z) {
    const Vec3 end = g.origin * Vec3(0, 0, z), along = b - a;
    const double length = along.squaredNorm(),
                 t = length > 0 ? std::clamp((end - a).dot(along) / length, 0.0, 1.0) : 0;
    return (a + t * along - end).norm() + g.size.x() + error <= body.radius;
  });
}

/// Cylinders, spheres, capsules and ellipsoids of the original: by one of the shapes that is the
/// same or larger, or by one body, or by a polytope round them.
std::string open_shape(const std::vector<Geometry>& round, const std::vector<Geometry>& shapes,
                       const Bounds& bounds) {
  for (const Geometry& g : round) {
    if (robot::is_point(g)) continue;
    if (std::ranges::any_of(shapes, [&](const Geometry& other) { return is_in(g, other); }) ||
        std::ranges::any_of(bounds.inside.bodies,
                            [&](const geom::ConvexBody& body) { return is_in(g, body); }))
      continue;
    const geom::Mesh polytope = *geom::convex_hull(robot::bounding_points(g));
    if (verify::verify_cover(polytope, bounds.inside).inclusion.solid.answer != Answer::Verified)
      return "whether the bodies hold its " + robot::describe(g) +
             " is not decided: they do not hold a polytope round it";
  }
  return {};
}

std::string text_of(const Vec3& p) {
  return "(" + number(p.x()) + ", " + number(p.y()) + ", " + number(p.z()) + ")";
}

std::string sentence_of(const LinkAnswer& link) {
  if (link.shapes == 0) return "uncovered: it has no shape in the file";
  const verify::Inclusion& in = link.inclusion;
  const std::string bodies = counted(link.shapes, "shape", "shapes");
  if (link.answer == Answer::Verified)
    return bodies + (link.shapes == 1 ? " holds " : " hold ") +
           (link.triangles == 0 ? "its shapes" : "every triangle") +
           (in.solid.answer == Answer::Verified ? " and the solid"
            : link.triangles > 0                ? "; its mesh is open"
                                                : "");
  if (in.surface.answer == Answer::Refuted && in.surface.witness)
    return std::to_string(in.surface.inner_triangles.size()) + " of its " +
           std::to_string(link.triangles) + " triangles stick out of its " + bodies +
           ", one of them by " + number(in.surface.witness->depth) + " at " +
           text_of(in.surface.witness->point);
  if (in.solid.answer == Answer::Refuted && in.solid.witness)
    return "every triangle is inside, but a void is left in the solid at " +
           text_of(in.solid.witness->point);
  return in.surface.answer != Answer::Verified ? in.surface.reason : in.solid.reason;
}

LinkAnswer judge(const std::string& name, const geom::Mesh& mesh,
                 const std::vector<Geometry>& round, const Bounds& bounds,
                 const std::vector<Geometry>& shapes) {
  LinkAnswer out;
  out.name = name;
  out.shapes = shapes.size();
  out.triangles = mesh.triangles.size();
  if (shapes.empty() || bounds.outside.bodies.empty()) {
    out.shapes = 0;
    out.answer = Answer::Refuted;
    out.sentence = sentence_of(out);
    return out;
  }
  const std::string open = open_shape(round, shapes, bounds);
  if (!open.empty()) out.answer = Answer::Undecided;
  if (!mesh.triangles.empty()) {
    out.inclusion = decide(mesh, bounds);
    out.answer = verify::worse(out.answer, out.inclusion.surface.answer);
    if (out.inclusion.solid.answer != Answer::Undefined)
      out.answer = verify::worse(out.answer, out.inclusion.solid.answer);
  }
  out.sentence = out.answer == Answer::Undecided && !open.empty() ? open : sentence_of(out);
  return out;
}

Json json_of_claim(const verify::Claim& claim) {
  Json json{{"answer", name_of(claim.answer)}, {"reason", claim.reason}};
  if (claim.witness) {
    const Vec3& p = claim.witness->point;
    json["witness"] = {{"point", {p.x(), p.y(), p.z()}}, {"depth", claim.witness->depth}};
  }
  return json;
}

/// @throws Error{InvalidInput} naming the first link with shapes that the robot does not have.
void require_known(const robot::RobotFile& bodies, const robot::RobotFile& robot) {
  std::vector<std::string> names;
  names.reserve(robot.robot.links.size());
  for (const robot::Link& link : robot.robot.links) names.push_back(link.name);
  for (const robot::Link& link : bodies.robot.links)
    if (!link.collision.empty() && !robot.robot.find_link(link.name))
      throw Error(ErrorCode::InvalidInput, bodies.path.string() + ": robot '" + robot.robot.name +
                                               "' has no link '" + link.name + "'" +
                                               did_you_mean(link.name, names));
}

/// Why links' frames are elsewhere in the file; empty: they are not.
std::string difference_in_frames(const robot::RobotFile& robot, const robot::RobotFile& bodies) {
  if (robot.format == bodies.format) return verify::difference_in_motion(robot.robot, bodies.robot);
  const auto found = verify::find_frame_elsewhere(robot.robot, bodies.robot, kSameFrame);
  if (!found) return {};
  return "the frame of link '" + robot.robot.links[found->link].name +
         "' is not where the robot has it: " + found->why;
}

}  // namespace

std::optional<double> length_of_reach(const std::optional<Length>& epsilon) {
  if (!epsilon) return std::nullopt;
  if (epsilon->percent)
    throw Error(ErrorCode::InvalidArgument,
                "--epsilon: a percentage has no meaning for bodies that hold several meshes: state "
                "a length");
  return epsilon->in("m").value;
}

namespace {

Json json_of_reach(const verify::DistanceClaim& claim) {
  Json json{{"answer", name_of(claim.answer)}, {"reason", claim.reason}};
  if (claim.answer == verify::Answer::Refuted)
    json["witness"] = {{"point", {claim.at.x(), claim.at.y(), claim.at.z()}},
                       {"distance", claim.largest}};
  return json;
}

}  // namespace

void add_reach(const verify::LinkReach& reach, Json& claims) {
  if (reach.all) claims["distance"] = json_of_reach(*reach.all);
  for (const verify::LinkReach::InRegion& one : reach.regions) {
    Json json = json_of_reach(one.claim);
    json["name"] = one.name;
    json["bound"] = one.epsilon;
    json["reached"] = one.reached;
    claims["regions"].push_back(std::move(json));
  }
}

namespace {

Json json_of(const LinkAnswer& link) {
  Json out = {{"link", link.name},
              {"answer", name_of(link.answer)},
              {"sentence", link.sentence},
              {"shapes", link.shapes},
              {"triangles", link.triangles},
              {"claims",
               {{"surface", json_of_claim(link.inclusion.surface)},
                {"solid", json_of_claim(link.inclusion.solid)}}}};
  add_reach(link.reach, out["claims"]);
  return out;
}

/// Of a link of the file whose link in the robot has no shape.
Json json_of_bare(const robot::Link& link) {
  return {{"link", link.name},
          {"answer", name_of(Answer::Undecided)},
          {"sentence", verify::text_of_bare_link(link.name)},
          {"shapes", link.collision.size()},
          {"triangles", 0}};
}

/// What is known of all links.
struct AllLinks {
  Answer answer = Answer::Verified;
  std::size_t held = 0, within = 0, judged = 0, count = 0;
  std::vector<std::string> uncovered;  ///< links without a shape in the file
  std::vector<std::string> farther;    ///< regions in which bodies are farther than these allow
  Json links = Json::array();

  void take(const LinkAnswer& link) {
    answer = verify::worse(answer, link.answer);
    ++judged;
    held += link.held == Answer::Verified ? 1 : 0;
    within += link.reach.all && link.reach.all->answer == Answer::Verified ? 1 : 0;
    count += link.shapes;
    if (link.shapes == 0) uncovered.push_back(link.name);
    verify::add_farther(link.name, link.reach, farther);
    links.push_back(json_of(link));
  }

  [[nodiscard]] std::string sentence(std::optional<double> epsilon) const {
    std::string out = counted(count, "shape holds ", "shapes hold ") + std::to_string(held) +
                      " of " + counted(judged, "link", "links");
    if (epsilon)
      out +=
          "; of " + counted(within, "link", "links") + " none is farther than " + number(*epsilon);
    out += verify::text_of_farther(farther);
    if (!uncovered.empty()) out += "; uncovered, without a shape: " + robot::names_of(uncovered);
    return out;
  }
};

/// Judges the links that have shapes.
AllLinks judge_links(const VerifyRobotOptions& o, const robot::RobotFile& robot,
                     const robot::RobotFile& bodies,
                     const std::function<void(const std::string&)>& say,
                     const std::function<void(const std::string&)>& note) {
  const std::optional<double> epsilon = length_of_reach(o.how.epsilon);
  const robot::LinkBounds of_links = bounds_of(o, robot);
  AllLinks out;
  robot::MeshFiles files(robot.path, o.how.shapes.packages);
  for (const robot::Link& link : robot.robot.links) {
    if (!o.how.shapes.has(link)) continue;
    std::vector<Geometry> flat, round;
    for (const Geometry& g : o.how.shapes.shapes_of(link))
      if (!robot::is_point(g))
        (g.shape == Geometry::Shape::Mesh || g.shape == Geometry::Shape::Box ? flat : round)
            .push_back(g);
    const geom::Mesh mesh = robot::exact_shapes(flat, files);
    const auto index = bodies.robot.find_link(link.name);
    const robot::Link none{link.name, {}, {}};
    const robot::Link& own = index ? bodies.robot.links[*index] : none;
    if (mesh.triangles.empty() && round.empty()) {
      if (!o.how.shapes.shapes_of(link).empty()) note(verify::text_of_points(link.name));
      if (own.collision.empty() || !verify::asks_how_far(link.name, epsilon, of_links)) continue;
      out.answer = verify::worse(out.answer, Answer::Undecided);
      out.links.push_back(json_of_bare(own));
      say(verify::text_of_bare_link(link.name));
      continue;
    }
    const Bounds bounds = bounds_of(own, o.bodies);
    LinkAnswer now = judge(link.name, mesh, round, bounds, own.collision);
    now.held = now.answer;
    if (now.shapes > 0)  // none are not near either
      now.reach = verify::decide_link_reach(bounds.inside, bounds.outside, link.name,
                                            o.how.shapes.shapes_of(link), files, epsilon, of_links);
    now.answer = verify::worse(now.answer, now.reach.answer());
    now.sentence += now.reach.sentence();
    out.take(now);
    say("link '" + now.name + "': " + name_of(now.answer) + ": " + now.sentence);
  }
  if (out.judged == 0)
    throw Error(ErrorCode::InvalidInput,
                o.original + ": no link has a shape" +
                    (o.how.shapes.visual ? std::string() : "; try --geometry visual"));
  return out;
}

}  // namespace

int verify_bodies(const VerifyRobotOptions& o, const CommonOptions& common) {
  const ThreadLimit threads(common.threads);
  require_apart({{"--report", common.report}}, {o.original, o.bodies, o.epsilon_map.value_or("")});
  const robot::RobotFile robot =
      robot::read_robot(o.original, robot::Motions::None, o.xacro_arguments, o.how.shapes.packages);
  robot::require_links(robot, o.how.shapes.links);
  const robot::RobotFile bodies = robot::read_robot(o.bodies, robot::Motions::None);
  require_known(bodies, robot);
  const std::optional<double> epsilon = length_of_reach(o.how.epsilon);
  const auto say = [&](const std::string& line) {
    if (!common.quiet) (common.report == "-" ? std::cerr : std::cout) << line << std::endl;
  };
  AllLinks all = judge_links(o, robot, bodies, say, [&](const std::string& line) {
    log(common.quiet, "note: " + o.original + ": " + line);
  });
  const robot::ShapeChoice& shapes = o.how.shapes;
  for (const std::string& note :
       robot::notes_on({{}, robot::bare_links(robot.robot, shapes.visual, shapes.links).other},
                       shapes.visual, ": nothing of this is judged"))
    log(common.quiet, "note: " + o.original + ": " + note);
  // Shapes in the links' frames hold the robot only where the file has these frames.
  const std::string motion = difference_in_frames(robot, bodies);
  if (!motion.empty()) all.answer = Answer::Refuted;
  say(line_on_joints(motion));
  if (!common.report.empty())
    write_report(common, "bound-verify",
                 {{"relation", "bodies"},
                  {"verdict", name_of(all.answer)},
                  {"geometry", shapes.visual ? "visual" : "collision"},
                  {"original", {{"file", o.original}, {"sha256", robot.sha256}}},
                  {"bodies", {{"file", o.bodies}, {"sha256", bodies.sha256}}},
                  {"count", all.count},
                  {"links_held", all.held},
                  {"uncovered", all.uncovered},
                  {"epsilon", epsilon ? Json(*epsilon) : Json()},
                  {"joints", json_of_joints(motion)},
                  {"links", std::move(all.links)}});
  say(name_of(all.answer) + (": " + all.sentence(epsilon)) +
      (motion.empty() ? "" : ", but the robots do not move alike"));
  return exit_code(all.answer);
}

}  // namespace kaboum::tools
