// Pages of grasps round the objects of a scene, and of places on them.

#include "derived_page.h"

#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/kinematics/arm.h>
#include <kaboum/page/preview.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/grasp_family.h>
#include <kaboum/world/scene.h>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <sstream>
#include <utility>
#include <vector>

namespace kaboum::tools {
namespace {

using geom::Transform;
using geom::Vec3;
using kinematics::inverse;

/// Members of a family at which the hand is drawn, and those of which the tool is.
constexpr std::size_t kHands = 4, kTools = 60;
/// Share of the object's size: length of the pointers that stand for tools.
constexpr double kPointer = 0.6;

/// Share of the object's size: radius of the mark of a point, and thickness of that of a surface.
constexpr double kMark = 0.02, kSheet = 0.004;

geom::Mesh moved(geom::Mesh mesh, const Transform& pose) {
  for (Vec3& v : mesh.vertices) v = pose * v;
  return mesh;
}

/// A set where it is, a shape for each body.
void add_set(const collide::BoundingSet& set, const Transform& pose,
             std::vector<page::Shape>& shapes) {
  for (std::size_t i = 0; i < set.size(); ++i)
    shapes.push_back({moved(geom::surface_of(set.body(i)), pose)});
}

/// What moves with a tool, in its frame, with the joints at home.
std::vector<page::Shape> hand_of(const world::RobotModel& robot, const world::ToolFrame& tool) {
  const std::vector<bool> moves = scene::links_of_hand(robot, tool);
  const std::vector<Transform> links = robot::forward(robot.kinematics, robot.home);
  const Transform from_root = inverse(links[tool.link] * tool.pose);
  std::vector<page::Shape> out;
  for (const world::LinkShape& shape : robot.shapes)
    if (moves[shape.link]) add_set(shape.outer, from_root * links[shape.link], out);
  return out;
}

/// A wedge whose edge is at the tool's origin, as wide along the axis of closing: it comes along
/// the tool's z axis.
geom::Mesh pointer(double length, scene::GraspRequest::Axis closing) {
  const double half = 0.08 * length, thin = 0.015 * length;
  const bool x = closing == scene::GraspRequest::Axis::X;
  const auto at = [&](double along, double across, double z) {
    return x ? Vec3(along, across, z) : Vec3(across, along, z);
  };
  const std::vector<Vec3> corners{at(-half, 0, 0),           at(half, 0, 0),
                                  at(-half, -thin, -length), at(half, -thin, -length),
                                  at(half, thin, -length),   at(-half, thin, -length)};
  return geom::convex_hull(corners).value_or(geom::Mesh());
}

/// A mark of a point, or a sheet on a surface.
geom::Mesh mark_of(const world::Feature& feature, double size) {
  std::vector<Vec3> corners;
  if (feature.kind == world::Feature::Kind::Point) {
    for (int axis = 0; axis < 3; ++axis)
      for (const double sense : {1.0, -1.0})
        corners.emplace_back(feature.point + sense * kMark * size * Vec3::Unit(axis));
  } else {
    for (const Vec3& corner : feature.outline)
      for (const double above : {0.0, kSheet * size})
        corners.emplace_back(corner + above * feature.direction);
  }
  return geom::convex_hull(corners).value_or(geom::Mesh());
}

/// A layer of an object's sets.
page::Layer layer_of(const world::Object& object, const Transform& pose) {
  page::Layer out{object.name};
  out.result = false;
  out.bodies = true;
  add_set(object.outer, pose, out.shapes);
  return out;
}

std::string number(double x) {
  std::ostringstream out;
  out.precision(3);
  out << x;
  return out.str();
}

/// What a grasp leaves free, in words.
std::string words_of(const world::Grasp& grasp, const std::string& unit) {
  std::string out;
  const auto add = [&](const std::string& words) { out += (out.empty() ? "" : ", ") + words; };
  if (const auto& turn = grasp.turn) {
    const double angle = turn->to - turn->from;
    add(angle > 2 * std::numbers::pi * (1 - 1e-9)
            ? "turns all round"
            : "turns by " + number(angle * 180 / std::numbers::pi) + " degrees");
  }
  for (const world::FreeSlide& slide : grasp.slides)
    add("slides by " + number(slide.to - slide.from) + " " + unit);
  if (out.empty()) out = "one pose";
  if (grasp.rank > 0) add("rank " + std::to_string(grasp.rank));
  return out;
}

}  // namespace

std::string page_of_grasps(const std::string& scene, const world::World& world,
                           const scene::AddedFeatures& added, const scene::GraspRequest& request) {
  const world::RobotModel& robot = world.robots[world::robot_named(world, request.robot)];
  const world::ToolFrame& tool = world::tool_named(robot, request.tool);
  const std::vector<page::Shape> hand = hand_of(robot, tool);
  page::Preview out{"Grasps of " + std::filesystem::path(scene).filename().string(), world.unit};
  out.facts.emplace_back("tool", robot.name + "/" + tool.name);
  out.facts.emplace_back("hand", "its bounding sets, with the joints at home, at " +
                                     std::to_string(kHands) +
                                     " members of a family; a wedge for "
                                     "each of " +
                                     std::to_string(kTools) + " members");
  out.facts.emplace_back("decided", "all members are free of contact of the object with the hand");
  bool first = true;
  for (const scene::AddedFeatures::OfObject& of : added.objects) {
    const auto index = world.find_object(of.object);
    if (!index) continue;
    const world::Object& object = world.objects[*index];
    out.layers.push_back(layer_of(object, object.pose));
    if (!of.shortfall.empty()) out.facts.emplace_back(of.object, of.shortfall);
    const geom::Mesh wedge = pointer(kPointer * object.outer.box().diagonal(), request.closing);
    for (const world::Grasp& grasp : object.grasps) {
      if (std::ranges::find(of.names, grasp.name) == of.names.end()) continue;
      out.facts.emplace_back(of.object + ": " + grasp.name, words_of(grasp, world.unit));
      page::Layer layer{of.object + ": " + grasp.name};
      layer.bodies = true;
      layer.view = first ? page::Layer::View::Shown : page::Layer::View::Hidden;
      first = false;
      const std::size_t members = world::is_family(grasp) ? kTools : 1;
      for (std::size_t i = 0; i < members; ++i) {
        const Transform at =
            object.pose * inverse(world::member_of(grasp, world::draw_member(grasp, i)));
        layer.shapes.push_back({moved(wedge, at)});
        if (i >= kHands) continue;
        for (const page::Shape& part : hand) layer.shapes.push_back({moved(part.mesh, at)});
      }
      out.layers.push_back(std::move(layer));
    }
  }
  return page::preview_page(out);
}

std::string page_of_places(const std::string& scene, const world::World& world,
                           const scene::AddedFeatures& added) {
  page::Preview out{"Places of " + std::filesystem::path(scene).filename().string(), world.unit};
  out.facts.emplace_back("points", "where an object stands (bottom), and where others are put");
  out.facts.emplace_back("surfaces",
                         "parts of faces that look up and that nothing covers, smaller all round");
  for (const scene::AddedFeatures::OfObject& of : added.objects) {
    const auto index = world.find_object(of.object);
    if (!index) continue;
    const world::Object& object = world.objects[*index];
    const Transform pose = scene::pose_at_first(world, *index);
    const double size = object.outer.box().diagonal();
    out.layers.push_back(layer_of(object, pose));
    if (!of.shortfall.empty()) out.facts.emplace_back(of.object, of.shortfall);
    for (const world::Feature& feature : object.features) {
      const auto is_it = [&](const std::string& name) { return name == feature.name; };
      const bool point = feature.kind == world::Feature::Kind::Point;
      if ((!point && feature.kind != world::Feature::Kind::Surface) ||
          (std::ranges::none_of(of.names, is_it) && std::ranges::none_of(of.kept, is_it)))
        continue;
      page::Layer layer{of.object + ": " + feature.name};
      layer.bodies = true;
      layer.shapes.push_back({moved(mark_of(feature, size), pose)});
      out.layers.push_back(std::move(layer));
      if (feature.outline.empty()) continue;
      double area = 0;
      for (std::size_t i = 1; i + 1 < feature.outline.size(); ++i)
        area +=
            0.5 * feature.direction.dot((feature.outline[i] - feature.outline[0])
                                            .cross(feature.outline[i + 1] - feature.outline[0]));
      out.facts.emplace_back(of.object + ": " + feature.name,
                             number(area) + " " + world.unit + "²");
    }
  }
  return page::preview_page(out);
}

}  // namespace kaboum::tools
