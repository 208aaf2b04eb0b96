// A scene as data of pages.

#include "page_scene.h"

#include <kaboum/geom/body_polytopes.h>
#include <kaboum/io/packed_mesh.h>
#include <kaboum/robot/page_data.h>

#include <nlohmann/json.hpp>
#include <utility>

#include "motion_part.h"

namespace kaboum::execution {
namespace {

using Json = nlohmann::ordered_json;

Json mesh_json(const geom::Mesh& mesh) {
  const io::PackedMesh packed = io::pack_mesh(mesh);
  return {{"points", packed.points}, {"triangles", packed.triangles}};
}

Json pose_json(const geom::Transform& pose) {
  Json out = Json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.push_back(pose.linear(row, column));
  for (const double x : pose.translation) out.push_back(x);
  return out;
}

Json robot_json(const world::RobotModel& robot) {
  Json links = Json::array();
  for (const robot::Link& link : robot.kinematics.links) links.push_back(link.name);
  return {{"name", robot.name},
          {"base", pose_json(robot.base)},
          {"links", std::move(links)},
          {"joints", Json::parse(robot::joints_json(robot.kinematics))}};
}

Json shape_json(const world::World& world, const world::Item& item) {
  Json out = {{"name", world.name_of(item)}};
  if (item.robot == world::Item::kObject) {
    out["object"] = item.index;
  } else {
    out["robot"] = item.robot;
    out["link"] = world.robots[item.robot].shapes[item.index].link;
  }
  Json bodies = Json::array();
  const world::BoundingSet& set = world.outer(item);
  for (std::size_t i = 0; i < set.size(); ++i)
    bodies.push_back(mesh_json(geom::surface_of(set.body(i))));
  out["bodies"] = std::move(bodies);
  return out;
}

}  // namespace

Json state_json(const judge::CellState& state) {
  Json places = Json::array();
  for (const judge::CellState::Place& place : state.objects) {
    if (place.away)
      places.push_back({{"away", true}});
    else if (place.hold)
      places.push_back({{"robot", place.hold->robot},
                        {"link", place.hold->link},
                        {"pose", pose_json(place.hold->pose)}});
    else
      places.push_back({{"pose", pose_json(place.pose)}});
  }
  return {{"q", state.q}, {"places", std::move(places)}};
}

Json initial_state_json(const world::World& world) {
  const world::WorldState first = initial_state(world);
  judge::CellState state{first.q, {}};
  for (std::size_t o = 0; o < world.objects.size(); ++o) {
    state.objects.push_back({first.poses[o], std::nullopt, false});
    if (const auto& a = first.attachments[o]) state.objects.back().hold = judged(*a);
  }
  return state_json(state);
}

void add_scene(Json& data, const world::World& world, const std::vector<world::ExactMesh>& exact) {
  data["unit"] = world.unit;
  data["robots"] = Json::array();
  for (const world::RobotModel& robot : world.robots) data["robots"].push_back(robot_json(robot));
  auto& shapes = data["shapes"] = Json::array();
  const auto add = [&](const world::Item& item) {
    shapes.push_back(shape_json(world, item));
    for (const world::ExactMesh& mesh : exact)
      if (mesh.item == item) shapes.back()["exact"] = mesh_json(mesh.mesh);
  };
  for (std::size_t r = 0; r < world.robots.size(); ++r)
    for (std::size_t s = 0; s < world.robots[r].shapes.size(); ++s) add({r, s});
  for (std::size_t o = 0; o < world.objects.size(); ++o) add({world::Item::kObject, o});
}

}  // namespace kaboum::execution
