// Distances that things are kept from each other.

#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
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

[[noreturn]] void refuse(const std::string& what) {
  throw Error(ErrorCode::InvalidArgument, "«margin»: " + what);
}

std::vector<Item> things_named(const World& world, const std::string& name) {
  std::vector<Item> out;
  std::vector<std::string> names;
  std::string link;   // that a name without its robot stands for
  bool bare = false;  // a link without a shape
  const auto look = [&](const Item& item) {
    names.push_back(world.name_of(item));
    if (names.back().ends_with("/" + name)) link = names.back();
    if (name == names.back() ||
        (item.robot != Item::kObject && name == world.robots[item.robot].name))
      out.push_back(item);
  };
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    names.push_back(world.robots[r].name);
    for (std::size_t s = 0; s < world.robots[r].shapes.size(); ++s) look({r, s});
    for (const robot::Link& one : world.robots[r].kinematics.links)
      bare = bare || name == world.robots[r].name + "/" + one.name;
  }
  for (std::size_t o = 0; o < world.objects.size(); ++o) look({Item::kObject, o});
  if (!out.empty()) return out;
  if (bare) refuse("link '" + name + "' has no shape that could be kept apart");
  refuse("the scene has no object, robot or link '" + name + "'" +
         (link.empty() ? did_you_mean(name, names)
                       : "; a link is named with its robot: '" + link + "'"));
}

/// Without the blanks at its ends.
std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(' '), end = text.find_last_not_of(' ');
  return begin == std::string::npos ? "" : text.substr(begin, end - begin + 1);
}

/// Whether no check looks at a pair: an allowed contact, or links that a joint connects.
bool is_exempt(const World& world, const Item& a, const Item& b) {
  for (const auto& [x, y] : world.allowed)
    if (ordered(x, y) == ordered(a, b)) return true;
  if (a.robot == Item::kObject || a.robot != b.robot) return false;
  const RobotModel& robot = world.robots[a.robot];
  const std::uint32_t x = robot.shapes[a.index].link, y = robot.shapes[b.index].link;
  if (x == y) return true;
  return std::ranges::any_of(robot.allowed, [&](const AllowedPair& pair) {
    return pair.a == std::min(x, y) && pair.b == std::max(x, y) &&
           pair.reason != AllowedPair::Reason::Never;
  });
}

/// Margins of pairs that were stated with the same number of names of single things: the more, the
/// later they count.
using Pairs = std::map<std::array<Item, 2>, double>;

void state_pair(const World& world, const std::string& names, double margin,
                std::array<Pairs, 3>& stated) {
  const std::size_t comma = names.find(',');
  const std::array<std::string, 2> name{trimmed(names.substr(0, comma)),
                                        trimmed(names.substr(comma + 1))};
  const std::vector<Item> first = things_named(world, name[0]),
                          second = things_named(world, name[1]);
  const auto is_single = [&](std::size_t i, const std::vector<Item>& things) {
    return things.size() == 1 && world.name_of(things[0]) == name[i];
  };
  const std::size_t singles =
      (is_single(0, first) ? 1U : 0U) + (is_single(1, second) ? std::size_t{1} : 0U);
  if (first == second) refuse("'" + names + "' names one thing twice");
  if (singles == 2 && margin > 0 && is_exempt(world, first[0], second[0]))
    refuse("'" + names +
           "' is a pair that is never looked at: adjacent links, or an allowed contact");
  for (const Item& a : first)
    for (const Item& b : second) {
      if (a == b) continue;
      const auto [known, is_new] = stated.at(singles).insert({ordered(a, b), margin});
      if (!is_new && known->second != margin)
        refuse("'" + names + "' gives " + number_text(margin) + " to " + world.name_of(a) +
               " and " + world.name_of(b) + ", which another one gives " +
               number_text(known->second));
    }
}

}  // namespace

double margin_between(const World& world, const WorldState& state, const Item& a, const Item& b) {
  const Margins& margins = world.margins;
  if (const auto pair = margins.between.find(ordered(a, b)); pair != margins.between.end())
    return pair->second;
  const auto first = robot_of(state, a), second = robot_of(state, b);
  if (first && first == second) return 0;
  const auto of = [&](const Item& item) -> std::optional<double> {
    if (const auto own = margins.of.find(item); own != margins.of.end()) return own->second;
    const auto carrier = item.robot == Item::kObject ? robot_of(state, item) : std::nullopt;
    const auto its = carrier ? margins.of_robots.find(*carrier) : margins.of_robots.end();
    return its == margins.of_robots.end() ? std::nullopt : std::optional(its->second);
  };
  const auto of_a = of(a), of_b = of(b);
  if (!of_a && !of_b) return margins.all;
  return std::max(of_a.value_or(0), of_b.value_or(0));
}

double Margins::largest() const {
  double out = all;  // NaN where any of them is one
  const auto take = [&out](double margin) {
    if (out <= margin || std::isnan(margin)) out = std::isnan(out) ? out : margin;
  };
  for (const auto& [item, margin] : of) take(margin);
  for (const auto& [robot, margin] : of_robots) take(margin);
  for (const auto& [pair, margin] : between) take(margin);
  return out;
}

const std::vector<Option<MarginRequest>>& margin_options() {
  static const std::vector<Option<MarginRequest>> options{option<MarginRequest>(
      {.name = "margin",
       .text =
           "Distance that things are kept from each other, besides what "
           "their sets add: of any two, of one thing from all others (arm=0.02, "
           "arm/tool=20mm, box=0.02), or of two things (arm/tool,box=0). A pair's goes before "
           "a thing's, a link's before its robot's, and the one of all comes last. What a robot "
           "carries has its margin, but in pairs, which name it by itself. Links of one robot "
           "and what it carries are kept apart only where a pair states it",
       .low = 0,
       .absolute = true,
       .own_unit = "the scene's unit",
       .for_all = true,
       .otherwise = "0"},
      [](auto& r) -> auto& { return r.margins; })};
  return options;
}

std::string words_of(const MarginRequest& request) {
  std::string out;
  for (const auto& [name, margin] : request.margins)
    out += (out.empty() ? "" : "; ") + (name.empty() ? name : name + '=') + margin.text();
  return out;
}

Margins margins_of(const World& world, const MarginRequest& request) {
  Margins out;
  std::array<Pairs, 3> stated;
  for (const auto& [name, length] : request.margins) {
    const double margin = length.in(world.unit).value;
    if (length.percent || !(margin >= 0) || !std::isfinite(margin))
      refuse("a distance must be a length of 0 or above");
    if (name.empty()) {
      out.all = margin;
    } else if (name.find(',') != std::string::npos) {
      state_pair(world, name, margin, stated);
    } else {
      for (const Item& item : things_named(world, name)) {
        // What is said of a link goes before what is said of its robot.
        const bool own = name == world.name_of(item);
        if (own || !request.margins.contains(world.name_of(item))) out.of[item] = margin;
      }
      if (const auto robot = world.find_robot(name)) out.of_robots[*robot] = margin;
    }
  }
  for (const Pairs& pairs : stated)
    for (const auto& [pair, margin] : pairs) out.between[pair] = margin;
  return out;
}

}  // namespace kaboum::world
