// A whole world in another library, to compare with.
#include "other_world.h"

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

std::vector<Item> OtherWorld::items_of(const Meshes& meshes) {
  std::vector<Item> items;
  for (const auto& [item, mesh] : meshes)
    if (items.empty() || items.back() != item) items.push_back(item);
  return items;
}

std::size_t OtherWorld::number_of(const Item& item) const {
  return static_cast<std::size_t>(std::ranges::find(items_, item) - items_.begin());
}

void OtherWorld::choose_pairs(const WorldState& state) {
  pairs_.clear();
  for (const auto& [a, b] : checker_.pairs(state, {}))
    pairs_.push_back({number_of(a), number_of(b)});
}

void OtherWorld::choose_pairs(const WorldState& state, std::size_t robot,
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

void OtherWorld::place(const WorldState& state, std::size_t only) {
  const world::World& world = checker_.world();
  std::vector<std::vector<geom::Transform>> links(world.robots.size());
  for (std::size_t r = 0; r < links.size(); ++r)
    if (only == kAll || only == r) links[r] = forward(world.robots[r].kinematics, state.q[r]);
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const auto& [robot, index] = items_[i];
    if (robot != Item::kObject) {
      if (links[robot].empty()) continue;
      const world::RobotModel& model = world.robots[robot];
      shapes_->put(i, model.base * links[robot][model.shapes[index].link]);
    } else if (const auto& held = state.attachments[index]) {
      if (links[held->robot].empty()) continue;
      shapes_->put(i, world.robots[held->robot].base * links[held->robot][held->link] * held->pose);
    } else if (only == kAll) {
      shapes_->put(i, state.poses[index]);
    }
  }
}

bool OtherWorld::collide(const WorldState& state, std::size_t only) {
  place(state, only);
  return std::ranges::any_of(pairs_, [&](const auto& p) { return shapes_->meet(p[0], p[1]); });
}

}  // namespace kaboum::search
