// A page of grasps round the objects of a scene.

#include "grasp_page.h"

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
    page::Layer thing{of.object};
    thing.result = false;
    thing.bodies = true;
    add_set(object.outer, object.pose, thing.shapes);
    out.layers.push_back(std::move(thing));
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

}  // namespace kaboum::tools
