// A whole world in FCL, to compare with.
#include "fcl_world.h"

#include <fcl/narrowphase/collision.h>
#include <fcl_geometry.h>
#include <kaboum/robot/kinematics.h>

#include <algorithm>

namespace kaboum::search {
namespace {

using world::Item;
using world::WorldState;

bool moves_with(const WorldState& state, const Item& item, std::size_t robot) {
  if (item.robot != Item::kObject) return item.robot == robot;
  const auto& held = state.attachments[item.index];
  return held && held->robot == robot;
}

}  // namespace

FclWorld::FclWorld(const world::Checker& checker, const Meshes& meshes, bool convex)
    : checker_(checker) {
  for (const auto& [item, mesh] : meshes) {
    if (items_.empty() || items_.back() != item) {
      items_.push_back(item);
      objects_.emplace_back();
    }
    objects_.back().push_back(
        std::make_unique<fcl::CollisionObjectd>(collide::fcl_geometry(mesh, convex)));
  }
}

std::size_t FclWorld::number_of(const Item& item) const {
  return static_cast<std::size_t>(std::ranges::find(items_, item) - items_.begin());
}

void FclWorld::choose_pairs(const WorldState& state) {
  pairs_.clear();
  for (const auto& [a, b] : checker_.pairs(state, {}))
    pairs_.push_back({number_of(a), number_of(b)});
}

void FclWorld::choose_pairs(const WorldState& state, std::size_t robot,
                            const std::vector<Item>* things) {
  pairs_.clear();
  const auto is_looked_at = [&](const Item& item) {
    return things == nullptr || std::ranges::find(*things, item) != things->end();
  };
  for (const auto& [a, b] : checker_.pairs(state, {})) {
    const bool first = moves_with(state, a, robot), second = moves_with(state, b, robot);
    if (!first && !second) continue;
    if (first && second ? things != nullptr : !is_looked_at(first ? b : a)) continue;
    pairs_.push_back({number_of(a), number_of(b)});
  }
}

void FclWorld::put(std::size_t item, const geom::Transform& pose) {
  fcl::Transform3d t = fcl::Transform3d::Identity();
  t.linear() = pose.linear;
  t.translation() = pose.translation;
  for (const Object& object : objects_[item]) {
    object->setTransform(t);
    object->computeAABB();
  }
}

void FclWorld::place(const WorldState& state, std::size_t only) {
  const world::World& world = checker_.world();
  std::vector<std::vector<geom::Transform>> links(world.robots.size());
  for (std::size_t r = 0; r < links.size(); ++r)
    if (only == kAll || only == r) links[r] = forward(world.robots[r].kinematics, state.q[r]);
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const auto& [robot, index] = items_[i];
    if (robot != Item::kObject) {
      if (links[robot].empty()) continue;
      const world::RobotModel& model = world.robots[robot];
      put(i, model.base * links[robot][model.shapes[index].link]);
    } else if (const auto& held = state.attachments[index]) {
      if (links[held->robot].empty()) continue;
      put(i, world.robots[held->robot].base * links[held->robot][held->link] * held->pose);
    } else if (only == kAll) {
      put(i, state.poses[index]);
    }
  }
}

bool FclWorld::collide(const WorldState& state, std::size_t only) {
  place(state, only);
  const fcl::CollisionRequestd request;
  for (const auto& [a, b] : pairs_)
    for (const Object& x : objects_[a])
      for (const Object& y : objects_[b]) {
        if (!x->getAABB().overlap(y->getAABB())) continue;
        fcl::CollisionResultd result;
        if (fcl::collide(x.get(), y.get(), request, result) > 0) return true;
      }
  return false;
}

}  // namespace kaboum::search
