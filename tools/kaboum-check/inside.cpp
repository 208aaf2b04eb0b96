// The option --inside of kaboum-check: whether items lie in regions.

#include "inside.h"

#include <kaboum/base/error.h>

#include <sstream>

namespace kaboum::tools {

std::vector<Inside> parse_inside(const world::World& world, const std::vector<std::string>& texts) {
  std::vector<Inside> out;
  for (const std::string& text : texts) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos)
      throw Error(ErrorCode::InvalidArgument,
                  "--inside: NAME=REGION is expected, not '" + text + "'");
    try {
      out.push_back(inclusion_question(world, text.substr(0, equals), text.substr(equals + 1)));
    } catch (const Error& error) {
      throw Error(error.code(), std::string("--inside: ") + error.what());
    }
  }
  return out;
}

collide::Inclusion decide_inside(const world::Checker& checker, const world::WorldState& state,
                                 const std::vector<Inside>& wanted, const std::string& before,
                                 const std::function<void(const std::string&)>& say, Json& report) {
  using collide::Inclusion;
  Inclusion all = Inclusion::Included;
  for (const Inside& one : wanted) {
    const Inclusion whole = find_inclusion(checker, state, one);
    std::string line = before + one.what;
    say(line.append(" in ").append(one.region_name).append(": ").append(world::name_of(whole)));
    report["inside"].push_back(
        {{"what", one.what}, {"region", one.region_name}, {"answer", world::name_of(whole)}});
    world::combine(all, whole);
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
    const world::MotionInclusion first = find_inclusion(checker, state, robot, path, one, options);
    const Inclusion whole = first.answer;
    std::ostringstream line;
    line << one.what << " in " << one.region_name << ": " << world::name_of(whole);
    Json entry = {
        {"what", one.what}, {"region", one.region_name}, {"answer", world::name_of(whole)}};
    if (whole == Inclusion::Included) {
      line << " at every instant";
    } else {
      line << " from waypoint " << first.segment + 1 << " + " << first.share
           << " of the way to the next on";
      entry["inside_until"] = {{"waypoint", first.segment + 1}, {"share", first.share}};
    }
    say(line.str());
    report["inside"].push_back(std::move(entry));
    world::combine(all, whole);
  }
  return all;
}

}  // namespace kaboum::tools
