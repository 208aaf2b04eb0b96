// The options of a swept set: their table, and the requests that they come to.

#include <kaboum/base/length_unit.h>
#include <kaboum/certify/sweep_options.h>
#include <kaboum/robot/base_pose.h>
#include <kaboum/robot/path_options.h>
#include <kaboum/robot/shape_options.h>

#include <array>
#include <utility>

namespace kaboum::certify {
namespace {

using R = SweptSetOptions;

constexpr std::array<std::pair<const char*, sweep::StepRule>, 6> kRules{
    {{"baginski", sweep::StepRule::Baginski},
     {"uniform", sweep::StepRule::Uniform},
     {"subset", sweep::StepRule::Subset},
     {"second-order", sweep::StepRule::SecondOrder},
     {"adaptive", sweep::StepRule::Adaptive},
     {"balanced", sweep::StepRule::Balanced}}};

/// An option whose record has a length's digits as they were stated.
Option<R> with_its_digits(const Option<R>& option) {
  Option<R> out = option;
  out.value = [option](const R& r) {
    std::optional<std::string> value = option.value(r);
    const auto stated = r.as_stated.find(option.name);
    if (!value || stated == r.as_stated.end()) return value;
    R same = r;
    option.assign(same, stated->second);
    return option.value(same) == value ? stated->second : value;
  };
  out.assign = [option](R& r, const std::string& text) {
    option.assign(r, text);
    r.as_stated[option.name] = text;
  };
  return out;
}

/// An option of the links' bodies, as sets have it.
Option<R> of_bodies(const std::string& name, const std::string& text) {
  static const auto all = options_of_part<R>(
      set_options(), [](auto& r) -> auto& { return r.bodies; });
  for (Option<R> option : all)
    if (option.name == name) {
      option.text = text;
      return option;
    }
  return {};
}

void add_bodies(std::vector<Option<R>>& out) {
  Option<R> epsilon = of_bodies("epsilon",
                                "Largest distance of the links' convex bodies from their meshes, a "
                                "length (in metres, or as 5mm) or a percentage of each mesh's "
                                "diagonal");
  epsilon.name = "body-epsilon";
  epsilon.otherwise = "as {epsilon}";
  epsilon.always_recorded = true;
  out.push_back(with_its_digits(epsilon));
  out.push_back(of_bodies("max-vertices-per-body", "Most vertices of a link's body"));
  out.push_back(of_bodies("effort", "How long to search for the links' bodies"));
  const std::vector<std::pair<const char*, bool>> geometries{{"collision", false},
                                                             {"visual", true}};
  OptionDescription geometry = option_named(robot::shape_options(), "geometry");
  geometry.always_recorded = true;
  out.push_back(choice<R>(
      geometry, [](auto& r) -> auto& { return r.visual; }, geometries));
}

void add_motion(std::vector<Option<R>>& out) {
  out.push_back(option<R>(
      option_named(robot::shape_options(), "links"), [](auto& r) -> auto& { return r.links; }));
  out.push_back(option<R>(
      option_named(robot::path_options(), "joint"), [](auto& r) -> auto& { return r.joints; }));
  out.push_back(option<R>(
      option_named(robot::path_options(), "degrees"), [](auto& r) -> auto& { return r.degrees; }));
  out.push_back(option<R>(
      robot::base_pose_option(), [](auto& r) -> auto& { return r.base_pose; }));
}

/// What no record's line has.
void add_unrecorded(std::vector<Option<R>>& out) {
  out.push_back(option<R>(
      option_named(robot::path_options(), "ignore-limits"),
      [](auto& r) -> auto& { return r.ignore_limits; }));
  out.push_back(option<R>(
      option_named(robot::shape_options(), "package-path"),
      [](auto& r) -> auto& { return r.packages; }));
  const std::vector<std::pair<const char*, bool>> missing{{"error", false}, {"skip", true}};
  out.push_back(choice<R>(
      option_named(robot::held_shape_options(), "missing-meshes"),
      [](auto& r) -> auto& { return r.skip_missing; }, missing));
  std::vector<std::pair<std::string, std::string>> units;
  units.reserve(kLengthUnits.size());
  for (const std::string_view unit : kLengthUnits) units.emplace_back(unit, unit);
  out.push_back(choice<R>(
      {.name = "unit",
       .text = "Unit of length, noted in the container: m, dm, cm, mm, um, km, in or ft",
       .values = "NAME",
       .unrecorded = true},
      [](auto& r) -> auto& { return r.unit; }, units));
}

std::vector<Option<R>> table() {
  std::vector<Option<R>> out;
  out.push_back(with_its_digits(option<R>(
      {.name = "epsilon",
       .text = "Largest margin round the bodies, by which they are enlarged. How far they then "
               "reach beyond what is swept is part of the result, and limited by {max-reach}",
       .absolute = true,
       .always_recorded = true},
      [](auto& r) -> auto& { return r.epsilon; })));
  out.push_back(choice<R>(
      {.name = "bound",
       .text = "How steps are chosen: baginski (not proved), uniform (the thesis's), subset, "
               "second-order, adaptive (ends are poses), balanced (fewest)",
       .always_recorded = true},
      [](auto& r) -> auto& { return r.rule; }, kRules));
  add_bodies(out);
  out.push_back(with_its_digits(option<R>(
      {.name = "max-reach",
       .text = "Largest distance of a hull, its margin apart, from what it bounds; takes more "
               "bodies",
       .absolute = true,
       .otherwise = "no limit"},
      [](auto& r) -> auto& { return r.max_reach; })));
  out.push_back(option<R>(
      {.name = "simplify",
       .text = "Share of epsilon by which vertices may be left out: fewer of them, more bodies",
       .values = "SHARE",
       .low = 0,
       .high = 0.9},
      [](auto& r) -> auto& { return r.simplify; }));
  add_motion(out);
  out.push_back(of_bodies("drop-sheets",
                          "Drop back-to-back faces without volume, which are then not covered"));
  out.push_back(option<R>(
      {.name = "implicit-margin",
       .text = "Do not enlarge the bodies of a .glb by the margin, but state it in the file: fewer "
               "vertices, but whatever reads them has to add it"},
      [](auto& r) -> auto& { return r.implicit_margin; }));
  out.push_back(option<R>(
      {.name = "no-merge", .text = "One body at least between two waypoints"},
      [](auto& r) -> auto& { return r.no_merge; }));
  add_unrecorded(out);
  return out;
}

std::string record_of(const R& options) {
  R all = options;
  if (!all.bodies.request.epsilon) {
    all.bodies.request.epsilon = all.epsilon;
    if (const auto stated = all.as_stated.find("epsilon"); stated != all.as_stated.end())
      all.as_stated["body-epsilon"] = stated->second;
  }
  return kaboum::record_of(swept_set_options(), all);
}

}  // namespace

SweptSetOptions::SweptSetOptions() = default;

const std::vector<Option<SweptSetOptions>>& swept_set_options() {
  static const std::vector<Option<SweptSetOptions>> options = table();
  return options;
}

RobotRequest bodies_request_of(const SweptSetOptions& options) {
  RobotRequest out;
  out.shapes = {options.links, options.visual, options.packages, options.skip_missing};
  out.set = request_of(options.bodies);
  if (!out.set.epsilon) out.set.epsilon = options.epsilon;
  return out;
}

SweepRequest sweep_request_of(const SweptSetOptions& options) {
  SweepRequest out;
  out.search.epsilon = options.epsilon.in("m").value;
  out.search.rule = options.rule;
  out.search.merge = !options.no_merge;
  out.search.simplify = options.simplify;
  out.search.explicit_margin = !options.implicit_margin;
  if (options.max_reach) out.search.max_excess = options.max_reach->in("m").value;
  out.decide_motion = false;
  out.parameters = record_of(options);
  out.unit = options.unit;
  return out;
}

void place(robot::Robot& robot, const robot::Transform& base, SweptSetOptions& options) {
  options.base_pose.clear();
  if (base.linear.isIdentity(0) && base.translation.isZero(0)) return;
  robot = robot::placed(robot, base);
  options.base_pose = robot::base_pose_text(base);
}

}  // namespace kaboum::certify
