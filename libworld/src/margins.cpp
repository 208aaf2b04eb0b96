// Distances that things are kept from each other.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/world/margins.h>

#include <algorithm>
#include <cmath>

namespace kaboum::world {
namespace {

/// The robot that an item is a part of, or that carries it.
std::optional<std::size_t> robot_of(const WorldState& state, const Item& item) {
  if (item.robot != Item::kObject) return item.robot;
  const auto& attachment = state.attachments[item.index];
  return attachment ? std::optional(attachment->robot) : std::nullopt;
}

std::array<Item, 2> ordered(const Item& a, const Item& b) {
  return a < b ? std::array{a, b} : std::array{b, a};
}

std::vector<Item> things_named(const World& world, const std::string& name) {
  std::vector<Item> out;
  std::vector<std::string> names;
  const auto look = [&](const Item& item) {
    names.push_back(world.name_of(item));
    if (name == names.back() ||
        (item.robot != Item::kObject && name == world.robots[item.robot].name))
      out.push_back(item);
  };
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    names.push_back(world.robots[r].name);
    for (std::size_t s = 0; s < world.robots[r].shapes.size(); ++s) look({r, s});
  }
  for (std::size_t o = 0; o < world.objects.size(); ++o) look({Item::kObject, o});
  if (!out.empty()) return out;
  throw Error(ErrorCode::InvalidArgument, "«margin»: the scene has no object, robot or link '" +
                                              name + "'" + did_you_mean(name, names));
}

}  // namespace

double margin_between(const World& world, const WorldState& state, const Item& a, const Item& b) {
  const Margins& margins = world.margins;
  if (const auto pair = margins.between.find(ordered(a, b)); pair != margins.between.end())
    return pair->second;
  const auto first = robot_of(state, a), second = robot_of(state, b);
  if (first && first == second) return 0;
  const auto of_a = margins.of.find(a), of_b = margins.of.find(b), none = margins.of.end();
  if (of_a == none && of_b == none) return margins.all;
  return std::max(of_a == none ? 0 : of_a->second, of_b == none ? 0 : of_b->second);
}

double Margins::largest() const {
  double out = all;
  for (const auto& [item, margin] : of) out = std::max(out, margin);
  for (const auto& [pair, margin] : between) out = std::max(out, margin);
  return out;
}

const std::vector<Option<MarginRequest>>& margin_options() {
  static const std::vector<Option<MarginRequest>> options{option<MarginRequest>(
      {.name = "margin",
       .text = "Distance that things are kept from each other, in the scene's unit, besides what "
               "their sets add: of any two, of one thing from all others (arm=0.02, "
               "arm/tool=0.02, box=0.02), or of two things (arm/tool,box=0). A pair's goes before "
               "a thing's, and that before the one of all. Links of one robot, and what it "
               "carries, are kept apart only where a pair states it",
       .low = 0,
       .for_all = true,
       .otherwise = "0"},
      [](auto& r) -> auto& { return r.margins; })};
  return options;
}

Margins margins_of(const World& world, const MarginRequest& request) {
  Margins out;
  for (const auto& [name, margin] : request.margins) {
    if (!(margin >= 0) || !std::isfinite(margin))
      throw Error(ErrorCode::InvalidArgument, "«margin»: a distance must be 0 or above");
    if (name.empty()) {
      out.all = margin;
      continue;
    }
    const std::size_t comma = name.find(',');
    if (comma == std::string::npos) {
      for (const Item& item : things_named(world, name)) {
        // What is said of a link goes before what is said of its robot.
        const bool own = name == world.name_of(item);
        if (own || !request.margins.contains(world.name_of(item))) out.of[item] = margin;
      }
      continue;
    }
    for (const Item& a : things_named(world, name.substr(0, comma)))
      for (const Item& b : things_named(world, name.substr(comma + 1)))
        if (!(a == b)) out.between[ordered(a, b)] = margin;
  }
  return out;
}

}  // namespace kaboum::world
