// Tasks of usual manipulation actions, and the domain that they are of.
#include "manipulation_task.h"

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/world/checker.h>
#include <kaboum/world/constraint_conflict.h>
#include <kaboum/world/features.h>
#include <kaboum/world/grasp_family.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <sstream>

namespace kaboum::execution {

const char* const kManipulationDomain = R"(domain manipulation
-- Usual actions of manipulation. Items are the objects of a scene: those that somebody can grasp are
-- movable. All actions end with the robots at home.
types: robot, item, movable : item, fixed : item, mate, conf handle, pose handle
constants: conf home; pose start
predicates: isFree(robot), isHolding(robot, movable), isHeld(movable), on(movable, item),
  isMounted(movable), isMated(movable, mate), isMate(mate, movable, item), isSeat(item, movable),
  canStand(movable), canSupport(item)
functions: conf(robot) : conf; pose(movable) : pose
externals: fetch(robot, movable, conf) : pose; put(robot, movable, item, conf) : pose;
  mate(robot, movable, item, mate, conf) : pose; join(robot, movable, item, conf) : pose;
  handOver(robot, movable, robot) : pose

action fetch(?r : robot, ?o : movable)
  preconds:
    K(isFree(?r)) & K(!isHeld(?o)) & K(!isMounted(?o)) & forallK(?x : movable) (K(!on(?x, ?o)) | K(isMounted(?x))) &
    let ?p = extern(fetch(?r, ?o, home))
  effects:
    add(Kf, !isFree(?r)), add(Kf, isHolding(?r, ?o)), add(Kf, isHeld(?o)),
    forall(?s : item) (add(Kf, !on(?o, ?s))), add(Kf, conf(?r) = home), add(Kf, pose(?o) = ?p)

action put(?r : robot, ?o : movable, ?s : item)
  preconds:
    K(isHolding(?r, ?o)) & K(canStand(?o)) & K(canSupport(?s)) & K(?o != ?s) &
    let ?p = extern(put(?r, ?o, ?s, home))
  effects:
    add(Kf, isFree(?r)), add(Kf, !isHolding(?r, ?o)), add(Kf, !isHeld(?o)), add(Kf, on(?o, ?s)),
    add(Kf, conf(?r) = home), add(Kf, pose(?o) = ?p)

action mate(?r : robot, ?o : movable, ?s : item, ?m : mate)
  preconds:
    K(isHolding(?r, ?o)) & K(isMate(?m, ?o, ?s)) & let ?p = extern(mate(?r, ?o, ?s, ?m, home))
  effects:
    add(Kf, isFree(?r)), add(Kf, !isHolding(?r, ?o)), add(Kf, !isHeld(?o)), add(Kf, isMounted(?o)),
    add(Kf, isMated(?o, ?m)), add(Kf, conf(?r) = home), add(Kf, pose(?o) = ?p)

action mount(?r : robot, ?o : movable, ?s : item)
  preconds:
    K(isHolding(?r, ?o)) & K(isSeat(?s, ?o)) & let ?p = extern(join(?r, ?o, ?s, home))
  effects:
    add(Kf, isFree(?r)), add(Kf, !isHolding(?r, ?o)), add(Kf, !isHeld(?o)), add(Kf, isMounted(?o)),
    add(Kf, on(?o, ?s)), add(Kf, conf(?r) = home), add(Kf, pose(?o) = ?p)

action handOver(?r : robot, ?o : movable, ?t : robot)
  preconds:
    K(?r != ?t) & K(isHolding(?r, ?o)) & K(isFree(?t)) & let ?p = extern(handOver(?r, ?o, ?t))
  effects:
    add(Kf, isFree(?r)), add(Kf, !isFree(?t)), add(Kf, !isHolding(?r, ?o)),
    add(Kf, isHolding(?t, ?o)), add(Kf, conf(?r) = home), add(Kf, conf(?t) = home),
    add(Kf, pose(?o) = ?p)
)";

namespace {

using world::Feature;

/// Units, as multiples of the scene's, metres and radians.
using Units = std::map<std::string, double, std::less<>>;
const Units kLengths = {{"mm", 1e-3}, {"cm", 1e-2}, {"m", 1}},
            kAngles = {{"rad", 1}, {"deg", std::numbers::pi / 180}};
/// Six would fix a pose.
constexpr std::size_t kMostRelations = 32;
constexpr const char* kBlanks = " \t\r";
/// Largest gap between bounding sets of things that stand on each other, beside ε. [length]
constexpr double kStandingGap = 5e-3;

std::vector<std::string> words_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> out;
  for (std::string word; in >> word;) out.push_back(word);
  return out;
}

/// Parts of a text between separators, without those that are empty, and without blanks around.
std::vector<std::string> parts_of(const std::string& text, char separator) {
  std::vector<std::string> out;
  std::istringstream in(text);
  for (std::string part; std::getline(in, part, separator);)
    if (const std::size_t begin = part.find_first_not_of(kBlanks); begin != std::string::npos)
      out.push_back(part.substr(begin, part.find_last_not_of(kBlanks) + 1 - begin));
  return out;
}

/// A number with a unit behind it or as the next word; `at` goes past what was read. Only 0 needs
/// no unit.
std::optional<double> number(const std::vector<std::string>& words, std::size_t& at,
                             const Units& units) {
  if (at >= words.size()) return std::nullopt;
  const std::string& word = words[at];
  double value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return std::nullopt;
  std::string unit(end, word.data() + word.size());
  std::size_t next = at + 1;
  if (unit.empty() && next < words.size() && units.contains(words[next])) unit = words[next++];
  const auto known = units.find(unit);
  if (known == units.end() && !(unit.empty() && value == 0)) return std::nullopt;
  at = next;
  return unit.empty() ? value : value * known->second;
}

bool is_name(const std::string& text) {
  const auto is_letter = [](char c) {
    return std::isalpha(static_cast<unsigned char>(c)) != 0 || c == '_';
  };
  return !text.empty() && is_letter(text[0]) && text.back() != '-' &&
         text.find("--") == std::string::npos && std::ranges::all_of(text, [&](char c) {
           return is_letter(c) || std::isdigit(static_cast<unsigned char>(c)) != 0 || c == '-' ||
                  c == '\'';
         });
}

bool has_point(const world::Object& object, const std::string& name) {
  return std::ranges::any_of(object.features, [&](const Feature& f) {
    return f.kind == Feature::Kind::Point && f.name == name;
  });
}

bool has_plane(const world::Object& object, const std::string& name) {
  return std::ranges::any_of(object.features, [&](const Feature& f) {
    return f.kind == Feature::Kind::Plane && f.name == name;
  });
}

bool may_grasp(const world::RobotModel& robot, const world::Object& object) {
  return std::ranges::any_of(object.grasps, [&](const world::Grasp& grasp) {
    return std::ranges::any_of(robot.tools,
                               [&](const world::ToolFrame& tool) { return fits(tool, grasp); });
  });
}

bool is_movable(const world::World& world, std::size_t object) {
  return world.attachments[object].has_value() ||
         std::ranges::any_of(world.robots, [&](const world::RobotModel& robot) {
           return may_grasp(robot, world.objects[object]);
         });
}

/// Pairs of an object and one that it stands on at first: it comes in contact with that one when it
/// sinks a little, allowed contacts too. Of those it touches as it is, none that is above it.
std::set<std::pair<std::size_t, std::size_t>> standing(const world::World& world) {
  world::World strict = world;
  std::erase_if(strict.allowed, [](const std::array<world::Item, 2>& pair) {
    return pair[0].robot == world::Item::kObject && pair[1].robot == world::Item::kObject;
  });
  const world::Checker checker(strict);
  world::Scratch scratch;
  world::Checker::Options options;
  options.resting = true;
  std::set<std::pair<std::size_t, std::size_t>> out;
  const world::WorldState start = initial_state(strict);
  const auto touched = [&](const world::WorldState& state, std::size_t object) {
    std::set<std::size_t> others;
    for (const world::Contact& contact : checker.find_contacts(state, scratch, options))
      for (std::size_t i = 0; i < 2; ++i)
        if (contact.items[i] == world::Item{world::Item::kObject, object} &&
            contact.items[1 - i].robot == world::Item::kObject)
          others.insert(contact.items[1 - i].index);
    return others;
  };
  const auto height = [&](std::size_t object) {
    return (start.poses[object] * world.objects[object].outer.ball().center).z();
  };
  double most = 0;
  for (const world::Object& object : world.objects) most = std::max(most, object.outer.epsilon());
  for (std::size_t o = 0; o < world.objects.size(); ++o) {
    if (!is_movable(world, o) || world.attachments[o]) continue;
    world::WorldState lower = start;
    lower.poses[o].translation.z() -= kStandingGap + world.objects[o].outer.epsilon() + most;
    const std::set<std::size_t> before = touched(start, o);
    for (const std::size_t below : touched(lower, o))
      if (!before.contains(below) || world.attachments[below] || height(below) <= height(o))
        out.emplace(o, below);
  }
  return out;
}

std::string call(const std::string& name, const std::vector<std::string>& arguments) {
  std::string out = name;
  for (std::size_t i = 0; i < arguments.size(); ++i)
    out.append(i == 0 ? "(" : ", ").append(arguments[i]);
  return out + ")";
}

}  // namespace

/// The text of a problem as it grows.
class ManipulationTask::ProblemText {
 public:
  /// @throws Error{InvalidInput} for a name that is none in KPL.
  void declare(const std::string& type, const std::string& name) {
    if (!is_name(name))
      throw Error(ErrorCode::InvalidInput,
                  "the scene's name '" + name +
                      "' cannot be said in a task: names are letters, digits, '_' and '-'");
    std::string& names = constants_[type];
    names.append(names.empty() ? "" : ", ").append(name);
  }
  void know(const std::string& fact) {
    if (facts_.insert(fact).second)
      known_.append(known_.empty() ? "K(" : ",\n  K(").append(fact).append(")");
  }
  void want(const std::string& fact) {
    goal_.append(goal_.empty() ? "K(" : " & K(").append(fact).append(")");
  }
  [[nodiscard]] std::string text() const {
    std::string all;
    for (const auto& [type, names] : constants_)
      all.append(all.empty() ? "" : "; ").append(type).append(" ").append(names);
    return "constants: " + all + "\ninit:\n  " + known_ + "\nclosed: all\ngoal: " + goal_ + "\n";
  }

 private:
  std::map<std::string, std::string> constants_;
  std::set<std::string> facts_;
  std::string known_, goal_;
};

/// Robots, objects, and where they are at first.
void ManipulationTask::say_what_there_is(const world::World& world, ProblemText& out) {
  for (std::size_t r = 0; r < world.robots.size(); ++r) {
    const std::string& name = world.robots[r].name;
    out.declare("robot", name);
    out.know(call("conf", {name}) + " = home");
    bool free = true;
    for (std::size_t o = 0; o < world.objects.size(); ++o) {
      if (!world.attachments[o] || world.attachments[o]->robot != r) continue;
      out.know(call("isHolding", {name, world.objects[o].name}));
      out.know(call("isHeld", {world.objects[o].name}));
      free = false;
    }
    if (free) out.know(call("isFree", {name}));
  }
  for (std::size_t o = 0; o < world.objects.size(); ++o) {
    const world::Object& object = world.objects[o];
    const bool movable = is_movable(world, o);
    out.declare(movable ? "movable" : "fixed", object.name);
    if (has_point(object, "top")) out.know(call("canSupport", {object.name}));
    if (!movable) continue;
    out.know(call("pose", {object.name}) + " = start");
    if (has_point(object, "bottom")) out.know(call("canStand", {object.name}));
  }
  for (const auto& [above, below] : standing(world))
    out.know(call("on", {world.objects[above].name, world.objects[below].name}));
}

ManipulationTask::ManipulationTask(const std::string& text, std::string name)
    : text_(text), name_(std::move(name)) {
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    if (const std::size_t comment = line.find('#'); comment != std::string::npos)
      line.resize(comment);
    if (line.find_first_not_of(kBlanks) != std::string::npos) read_line(line, number);
  }
  if (goals_.empty()) fail(number, "nothing is to be done: it has no line 'put …' or 'hold …'");
}

void ManipulationTask::fail(std::size_t line, const std::string& what) const {
  throw Error(ErrorCode::InvalidInput, name_ + ":" + std::to_string(line) + ": " + what);
}

void ManipulationTask::read_line(const std::string& line, std::size_t number) {
  const std::vector<std::string> words = words_of(line);
  if (words[0] == "mate") {
    read_mate(line.substr(line.find("mate") + 4), number);
  } else if (words[0] == "put") {
    read_put(words, number);
  } else if (words[0] == "hold") {
    const bool with = words.size() == 4 && words[2] == "with";
    if (words.size() != 2 && !with) fail(number, "expected 'hold OBJECT [with ROBOT]'");
    goals_.push_back({Goal::Kind::Hold, number, words[1], with ? words[3] : "", ""});
  } else if (words[0] == "scene") {
    const std::size_t begin = line.find_first_not_of(kBlanks, line.find("scene") + 5);
    if (begin == std::string::npos) fail(number, "expected 'scene FILE'");
    if (!scene_.empty()) fail(number, "a second scene");
    scene_ = line.substr(begin, line.find_last_not_of(kBlanks) + 1 - begin);
  } else {
    fail(number, "expected 'scene', 'mate', 'put' or 'hold', not '" + words[0] + "'" +
                     did_you_mean(words[0], {"scene", "mate", "put", "hold"}));
  }
}

/// "NAME: FEATURE RELATION FEATURE [VALUE] [within VALUE [and ANGLE]]; …"
void ManipulationTask::read_mate(const std::string& rest, std::size_t number_of_line) {
  const std::size_t colon = rest.find(':');
  const std::vector<std::string> name = words_of(rest.substr(0, colon));
  if (colon == std::string::npos || name.size() != 1 || !is_name(name[0]))
    fail(number_of_line, "expected 'mate NAME: FEATURE RELATION FEATURE [VALUE]; …'");
  if (std::ranges::find(mates_, name[0], &Mate::name) != mates_.end())
    fail(number_of_line, "a second mate '" + name[0] + "'");
  Mate mate{number_of_line, name[0], {}};
  for (const std::string& part : parts_of(rest.substr(colon + 1), ';')) {
    std::vector<std::string> words = words_of(part);
    Relation relation;
    relation.preferred = !words.empty() && words[0] == "prefer";
    if (relation.preferred) words.erase(words.begin());
    if (words.size() < 3)
      fail(number_of_line, "expected 'FEATURE RELATION FEATURE [VALUE]', not '" + part + "'");
    relation.first = words[0];
    relation.second = words[2];
    std::vector<std::string> names;
    bool known = false;
    for (const auto kind : {kinematics::Relation::Coincident, kinematics::Relation::Parallel,
                            kinematics::Relation::Perpendicular, kinematics::Relation::Distance,
                            kinematics::Relation::Angle}) {
      names.emplace_back(name_of(kind));
      if (names.back() != words[1]) continue;
      relation.relation = kind;
      known = true;
    }
    if (!known)
      fail(number_of_line, "no relation '" + words[1] + "'" + did_you_mean(words[1], names) +
                               "; there are coincident, parallel, perpendicular, distance, angle");
    std::size_t at = 3;
    const Units& units = relation.relation == kinematics::Relation::Coincident ||
                                 relation.relation == kinematics::Relation::Distance
                             ? kLengths
                             : kAngles;
    relation.value = number(words, at, units);
    if (at < words.size() && words[at] == "within") {
      relation.within = number(words, ++at, units);
      if (at < words.size() && words[at] == "and")
        relation.within_angle = number(words, ++at, kAngles);
    }
    const bool valued = relation.relation == kinematics::Relation::Distance ||
                        relation.relation == kinematics::Relation::Angle;
    if (at != words.size() || valued != relation.value.has_value() ||
        (relation.within && !(*relation.within > 0)) ||
        (relation.within_angle && !(*relation.within_angle > 0)))
      fail(number_of_line,
           "'" + part +
               "': expected 'FEATURE RELATION FEATURE [VALUE] [within VALUE [and ANGLE]]'; "
               "distance and angle have a value; lengths are in mm, cm or m, angles in deg or rad, "
               "tolerances above 0");
    mate.relations.push_back(std::move(relation));
  }
  if (mate.relations.size() > kMostRelations)
    fail(number_of_line, "more than " + std::to_string(kMostRelations) + " relations in a mate");
  if (std::ranges::all_of(mate.relations, &Relation::preferred))
    fail(number_of_line, "the mate '" + mate.name + "' has no relation" +
                             (mate.relations.empty() ? "" : " but what is preferred"));
  mates_.push_back(std::move(mate));
}

/// "put OBJECT… on OBJECT… [by MATE]": pairwise, or all on one.
void ManipulationTask::read_put(const std::vector<std::string>& words, std::size_t number) {
  const auto on = std::ranges::find(words, "on");
  const auto by = std::find(on, words.end(), "by");
  const std::vector<std::string> objects(words.begin() + 1, on);
  const std::vector<std::string> others(on == words.end() ? on : on + 1, by);
  const std::size_t left = static_cast<std::size_t>(words.end() - by);
  if (objects.empty() || others.empty() || (left != 0 && left != 2))
    fail(number, "expected 'put OBJECT… on OBJECT… [by MATE]'");
  if (others.size() != 1 && others.size() != objects.size())
    fail(number, std::to_string(objects.size()) + " objects are put on " +
                     std::to_string(others.size()) + ": as many are expected, or one");
  for (std::size_t i = 0; i < objects.size(); ++i)
    goals_.push_back({Goal::Kind::Put, number, objects[i], others[others.size() == 1 ? 0 : i],
                      left == 2 ? words.back() : ""});
}

std::string ManipulationTask::set_name(const Goal& goal) {
  return goal.mate + "_" + goal.object + "_" + goal.other;
}

std::size_t ManipulationTask::object_named(const world::World& world, const std::string& name,
                                           std::size_t line) const {
  if (const auto found = world.find_object(name)) return *found;
  std::vector<std::string> names;
  names.reserve(world.objects.size());
  for (const world::Object& object : world.objects) names.push_back(object.name);
  fail(line, "the scene has no object '" + name + "'" + did_you_mean(name, names));
}

void ManipulationTask::add_mates(world::World& world) const {
  std::vector<std::string> names;
  names.reserve(mates_.size());
  for (const Mate& mate : mates_) names.push_back(mate.name);
  for (const Goal& goal : goals_) {
    if (goal.mate.empty()) continue;
    const auto mate = std::ranges::find(mates_, goal.mate, &Mate::name);
    if (mate == mates_.end())
      fail(goal.line, "there is no mate '" + goal.mate + "'" + did_you_mean(goal.mate, names));
    world::ConstraintSet set{set_name(goal), {}};
    if (std::ranges::find(world.constraints, set.name, &world::ConstraintSet::name) !=
        world.constraints.end())
      fail(goal.line, "this is asked for twice, or the scene has constraints '" + set.name + "'");
    object_named(world, goal.object, goal.line);
    object_named(world, goal.other, goal.line);
    for (const Relation& r : mate->relations) {
      const auto feature = [&](std::string object, const std::string& name) {
        try {
          object.append(name.starts_with('.') ? "" : "/").append(name);
          world::FixedFeature out = find_feature(world, object);
          out.feature.name = std::move(object);
          return out;
        } catch (const Error& error) {
          fail(mate->line, error.what());
        }
      };
      world::ToleratedConstraint c{r.relation, feature(goal.object, r.first),
                                   feature(goal.other, r.second)};
      if (r.value) c.value = *r.value;
      const bool length = r.relation == kinematics::Relation::Coincident ||
                          r.relation == kinematics::Relation::Distance;
      if (r.within) (length ? c.within : c.within_angle) = *r.within;
      if (r.within_angle) c.within_angle = *r.within_angle;
      try {
        require_valid(kinematics_constraint(c));
      } catch (const Error& error) {
        fail(mate->line, error.what());
      }
      (r.preferred ? set.preferred : set.constraints).push_back(std::move(c));
    }
    if (const auto found = find_contradiction(set.constraints))
      fail(mate->line, "the mate '" + mate->name + "': " + describe(set.constraints, *found));
    world.constraints.push_back(std::move(set));
  }
}

std::string ManipulationTask::problem(const world::World& world) const {
  ProblemText out;
  try {
    say_what_there_is(world, out);
  } catch (const Error& error) {
    fail(1, error.what());
  }
  for (const Goal& goal : goals_) say(goal, world, out);
  std::string comment = "-- " + name_ + "\n";
  std::istringstream lines(text_);
  for (std::string line; std::getline(lines, line);)
    comment.append("--   ").append(line).append("\n");
  return comment + out.text();
}

/// A goal, and what is known for it. @throws Error{InvalidInput} where it cannot be.
void ManipulationTask::say(const Goal& g, const world::World& world, ProblemText& out) const {
  const auto need = [&](bool has, const std::string& what) {
    if (!has) fail(g.line, what);
  };
  const std::size_t o = object_named(world, g.object, g.line);
  const world::Object& object = world.objects[o];
  need(is_movable(world, o), "no robot can grasp " + g.object +
                                 ": it has no grasps that fit a tool (kaboum-scene grasps)");
  if (g.kind == Goal::Kind::Hold) {
    need(g.other.empty() || world.find_robot(g.other).has_value(),
         "the scene has no robot '" + g.other + "'");
    out.want(g.other.empty() ? call("isHeld", {g.object}) : call("isHolding", {g.other, g.object}));
    return;
  }
  const world::Object& below = world.objects[object_named(world, g.other, g.line)];
  need(g.object != g.other, g.object + " is put on itself");
  if (!g.mate.empty()) {
    out.declare("mate", set_name(g));
    out.know(call("isMate", {set_name(g), g.object, g.other}));
    out.want(call("isMated", {g.object, set_name(g)}));
    return;
  }
  const bool seat = has_plane(object, "mount") &&
                    (has_plane(below, "seat") || has_plane(below, "seat/" + g.object));
  if (seat) {
    need(has_point(below, "entry/" + g.object) || has_point(below, "entry"),
         g.other + " has a seat, but no point 'entry' from which things slide onto it");
    out.know(call("isSeat", {g.other, g.object}));
  }
  need(seat || has_point(object, "bottom"),
       g.object + " has no point 'bottom' to stand on (kaboum-scene places)");
  need(seat || has_point(below, "top"),
       g.other + " has no point 'top' to put things on (kaboum-scene places)");
  out.want(call("on", {g.object, g.other}));
}

}  // namespace kaboum::execution
