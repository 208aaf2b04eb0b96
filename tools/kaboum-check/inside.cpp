// The option --inside of kaboum-check: whether items lie in regions.

#include "inside.h"

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>

#include <algorithm>
#include <sstream>
#include <utility>

namespace kaboum::tools {

namespace {

/// A robot is inside with all that it has and carries: what has shapes but no set cannot be told.
void require_whole(const world::RobotModel& robot) {
  for (std::uint32_t l = 0; l < robot.kinematics.links.size(); ++l) {
    const robot::Link& link = robot.kinematics.links[l];
    if (link.collision.empty() && link.visual.empty()) continue;
    if (std::none_of(robot.shapes.begin(), robot.shapes.end(),
                     [&](const world::LinkShape& shape) { return shape.link == l; }))
      throw Error(ErrorCode::InvalidInput,
                  "--inside: of robot '" + robot.name + "' link '" + link.name +
                      "' has shapes but no set, so it is not known whether it is inside: name "
                      "the links that are to be inside one by one");
  }
}

std::vector<world::Item> items_named(const world::World& world, const std::string& name) {
  if (const auto object = world.find_object(name)) return {{world::Item::kObject, *object}};
  std::vector<world::Item> out;
  std::vector<std::string> names;
  for (const world::Object& object : world.objects) names.push_back(object.name);
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    names.push_back(world.robots[r].name);
    if (name == world.robots[r].name) {
      require_whole(world.robots[r]);
      for (std::size_t i = 0; i < world.objects.size(); ++i)
        if (world.attachments[i] && world.attachments[i]->robot == r)
          out.push_back({world::Item::kObject, i});
    }
    for (std::size_t s = 0; s < world.robots[r].shapes.size(); ++s) {
      names.push_back(world.name_of({r, s}));
      if (name == world.robots[r].name || name == names.back()) out.push_back({r, s});
    }
  }
  if (!out.empty()) return out;
  throw Error(ErrorCode::InvalidArgument, "--inside: the scene has no object, link or robot '" +
                                              name + "'" + did_you_mean(name, names));
}

const char* answer_of(collide::Inclusion answer) {
  using collide::Inclusion;
  return answer == Inclusion::Included      ? "inside"
         : answer == Inclusion::NotIncluded ? "not certainly inside"
                                            : "undecided";
}

/// Of several: not inside, else undecided, else inside.
void combine(collide::Inclusion& all, collide::Inclusion one) {
  using collide::Inclusion;
  if (all != Inclusion::NotIncluded && one != Inclusion::Included) all = one;
}

}  // namespace

std::vector<Inside> parse_inside(const world::World& world, const std::vector<std::string>& texts) {
  std::vector<Inside> out;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw Error(ErrorCode::InvalidArgument,
                  "--inside: NAME=REGION is expected, not '" + text + "'");
    Inside one{text.substr(0, equals), text.substr(equals + 1), {}, 0};
    one.items = items_named(world, one.name);
    std::vector<std::string> names;
    for (const world::Region& region : world.regions) names.push_back(region.name);
    const auto found = std::find(names.begin(), names.end(), one.region_name);
    if (found == names.end())
      throw Error(ErrorCode::InvalidArgument, "--inside: the scene has no region '" +
                                                  one.region_name + "'" +
                                                  did_you_mean(one.region_name, names));
    one.region = static_cast<std::size_t>(found - names.begin());
    out.push_back(std::move(one));
  }
  return out;
}

collide::Inclusion decide_inside(const world::Checker& checker, const world::WorldState& state,
                                 const std::vector<Inside>& wanted, const std::string& before,
                                 const std::function<void(const std::string&)>& say, Json& report) {
  using collide::Inclusion;
  Inclusion all = Inclusion::Included;
  for (const Inside& one : wanted) {
    Inclusion whole = Inclusion::Included;
    for (const world::Item& item : one.items)
      combine(whole, find_inclusion(checker, state, item, one.region));
    std::string line = before + one.name;
    say(line.append(" in ").append(one.region_name).append(": ").append(answer_of(whole)));
    report["inside"].push_back(
        {{"what", one.name}, {"region", one.region_name}, {"answer", answer_of(whole)}});
    combine(all, whole);
  }
  return all;
}

collide::Inclusion decide_inside(const world::Checker& checker, const world::WorldState& state,
                                 std::size_t robot, const robot::Path& path,
                                 const world::MotionOptions& options,
                                 const std::vector<Inside>& wanted,
                                 const std::function<void(const std::string&)>& say, Json& report) {
  using collide::Inclusion;
  Inclusion all = Inclusion::Included;
  for (const Inside& one : wanted) {
    Inclusion whole = Inclusion::Included;
    world::MotionInclusion first;
    for (const world::Item& item : one.items) {
      const world::MotionInclusion found =
          find_inclusion(checker, state, robot, path, item, one.region, options);
      combine(whole, found.answer);
      const bool earlier =
          std::pair(found.segment, found.share) < std::pair(first.segment, first.share);
      if (found.answer != Inclusion::Included && (first.answer == Inclusion::Included || earlier))
        first = found;
    }
    std::ostringstream line;
    line << one.name << " in " << one.region_name << ": " << answer_of(whole);
    Json entry = {{"what", one.name}, {"region", one.region_name}, {"answer", answer_of(whole)}};
    if (whole == Inclusion::Included) {
      line << " at every instant";
    } else {
      line << " from waypoint " << first.segment + 1 << " + " << first.share
           << " of the way to the next on";
      entry["inside_until"] = {{"waypoint", first.segment + 1}, {"share", first.share}};
    }
    say(line.str());
    report["inside"].push_back(std::move(entry));
    combine(all, whole);
  }
  return all;
}

}  // namespace kaboum::tools
