// kaboum-ik: the configurations with which a robot's chain reaches a pose.
#include <kaboum/kinematics/copies.h>
#include <kaboum/kinematics/solution_set.h>
#include <kaboum/robot/base_pose.h>
#include <kaboum/robot/robot_file.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <iostream>

#include "ik_answer.h"
#include "ik_options.h"
#include "scene_file.h"

namespace {

using namespace kaboum;  // the tool's own names are few
namespace ik = kinematics;

using tools::kDegree;

/// Configurations of a family that are printed, about.
constexpr std::size_t kRepresentatives = 6;

using Answer = tools::IkAnswer;
using Options = tools::IkOptions;

[[noreturn]] void usage(const std::string& what) { throw Error(ErrorCode::InvalidArgument, what); }

/// "0.1,-2,3": a value per joint, in radians after that.
std::vector<double> parse_joints(const std::string& text, const char* option, const Answer& answer,
                                 bool degrees) {
  std::vector<double> q;
  const char *at = text.data(), *end = at + text.size();
  while (at <= end) {
    double value = 0;
    const auto [stop, error] = std::from_chars(at, end, value);
    if (error != std::errc() || !std::isfinite(value) || (stop != end && *stop != ','))
      usage(std::string(option) + ": expected numbers with commas between, as 0.5,-1.2,0, not '" +
            text + "'");
    q.push_back(value);
    at = stop + 1;
  }
  if (q.size() != answer.joints.size())
    usage(std::string(option) + ": " + std::to_string(q.size()) + " values for the " +
          std::to_string(answer.joints.size()) + " joints " + robot::names_of(answer.joints));
  for (std::size_t i = 0; i < q.size(); ++i)
    if (degrees && answer.arm.axes[i].turns) q[i] *= kDegree;
  return q;
}

/// The link that no joint starts from, where there is one only.
std::string only_tip(const robot::Robot& robot) {
  std::vector<std::string> tips;
  for (std::uint32_t link = 0; link < robot.links.size(); ++link) {
    bool last = true;
    for (const robot::Joint& joint : robot.joints) last = last && joint.parent != link;
    if (last) tips.push_back(robot.links[link].name);
  }
  if (tips.size() != 1)
    usage("--tip: name the link to be placed; the robot ends in " + robot::names_of(tips));
  return tips.front();
}

void add_row(Answer& answer, const Options& o, const std::vector<double>& q,
             const std::vector<double>& reference, Answer::Row row) {
  std::vector<std::vector<double>> choices;
  if (o.copies && !o.ignore_limits) {
    choices = ik::copies(answer.arm, q);
  } else if (auto nearest = ik::nearest_copy(answer.arm, q, reference)) {
    choices.push_back(std::move(*nearest));
  }
  if (choices.empty() && o.ignore_limits) {
    choices.push_back(q);
    row.within = false;
  }
  for (std::vector<double>& choice : choices) {
    row.q = std::move(choice);
    answer.rows.push_back(row);
  }
}

/// The robot that is asked about, and where its tip is.
struct Chain {
  std::string file, sha256;           ///< a URDF, or a scene
  robot::Robot robot;                 ///< of a scene without --base, standing in its world
  std::string tip;                    ///< a link
  std::optional<ik::Transform> tool;  ///< from the tool's frame to the tip's
};

Chain read_chain(const Options& o) {
  Chain out;
  if (o.scene.empty()) {
    robot::RobotFile read = robot::read_robot(o.robot);
    out = {o.robot, read.sha256, std::move(read.robot), o.tip, {}};
  } else {
    tools::SceneFile scene = tools::read_scene(o.scene);
    const world::RobotModel& model =
        scene.world.robots[tools::robot_named(scene.world, o.robot_name)];
    out = {o.scene, scene.sha256, model.kinematics, o.tip, {}};
    if (!o.tool.empty()) {
      const world::ToolFrame& tool = tools::tool_named(model, o.tool);
      out.tip = model.kinematics.links[tool.link].name;
      out.tool = tool.pose;
    }
    if (o.base.empty()) out.robot = robot::placed(model.kinematics, model.base);
  }
  if (out.tip.empty()) out.tip = tools::naming(out.file, [&] { return only_tip(out.robot); });
  return out;
}

void find_in_closed_form(Answer& answer, const Options& o, const std::vector<double>& reference) {
  const auto joints = static_cast<long>(answer.joints.size());
  ik::SolutionSetOptions options;
  std::copy(reference.begin(), reference.end(), options.solve.reference.begin());
  options.limits = !o.ignore_limits;
  options.representatives = kRepresentatives;
  std::vector<ik::Transform> targets{answer.target};
  if (o.free_heading) {
    targets = ik::with_other_headings(*answer.form, answer.target);
    if (ik::has_any_heading(*answer.form, answer.target))
      answer.incomplete = "the pose can be reached with many headings, or nearly so";
  }
  for (const ik::Transform& target : targets) {
    ik::SolutionSet set = ik::solve_set(*answer.form, target, options);
    if (!set.complete && answer.incomplete.empty()) answer.incomplete = set.reason;
    answer.found += set.isolated.size();
    if (options.limits && set.isolated.empty() && set.families.empty()) {
      ik::SolutionSetOptions any = options;
      any.limits = false;
      answer.outside = answer.outside || !ik::solve_set(*answer.form, target, any).families.empty();
    }
    const auto add = [&](const ik::Solution& s) {
      add_row(answer, o, {s.q.begin(), s.q.begin() + joints}, reference,
              {{}, {s.position_error, s.rotation_error}, s.singular, true, target, s.free});
    };
    for (const ik::Solution& s : set.isolated) add(s);
    for (ik::SolutionFamily& family : set.families) {
      for (const ik::Solution& s : family.representatives) add(s);
      answer.families.push_back({std::move(family), target});
    }
  }
}

Answer find(const Options& o, const Chain& chain) {
  const robot::Robot& robot = chain.robot;
  Answer answer;
  answer.arm = ik::arm_of(robot, o.base.empty() ? robot.links.front().name : o.base, chain.tip);
  if (chain.tool) answer.arm.tool = answer.arm.tool * *chain.tool;
  for (const std::uint32_t v : answer.arm.variables)
    answer.joints.push_back(robot.variables[v].name);
  answer.target =
      o.pose.empty()
          ? ik::forward(answer.arm, parse_joints(o.pose_of, "--pose-of", answer, o.degrees))
          : robot::parse_pose(o.pose, "--pose");
  const std::vector<double> reference =
      o.reference.empty() ? std::vector<double>(answer.joints.size(), 0.0)
                          : parse_joints(o.reference, "--reference", answer, o.degrees);
  if (!o.numeric) answer.form = ik::recognise(answer.arm);
  if (o.free_heading && (!answer.form || answer.form->family != ik::Family::FiveAxes))
    usage("--free-heading is for arms with five axes and a closed form; this one is not");
  if (answer.form) {
    find_in_closed_form(answer, o, reference);
    return answer;
  }
  answer.incomplete = "a numeric search finds no proof";
  ik::NumericOptions options;
  options.seed = o.common.seed;
  options.starts = o.starts;
  options.limits = !o.ignore_limits;
  if (!o.reference.empty()) options.first = reference;
  for (const ik::NumericSolution& s : ik::solve_numeric_all(answer.arm, answer.target, options)) {
    ++answer.found;
    add_row(answer, o, s.q, reference, {{}, s.error, ik::kRegular, true, answer.target});
  }
  return answer;
}

std::string unreached(const Answer& answer, bool free_heading) {
  const bool five = answer.form && answer.form->family == ik::Family::FiveAxes;
  return five && !free_heading
             ? "the pose is out of reach; five axes reach most poses with another "
               "heading only, see --free-heading"
             : "the pose is out of reach";
}

int run(const Options& o) {
  const Chain chain = read_chain(o);
  const Answer answer = tools::naming(chain.file, [&] { return find(o, chain); });
  tools::Json report = tools::answer_json(answer, o.degrees);
  if (o.json) {
    std::cout << report.dump(2, ' ', false, tools::Json::error_handler_t::replace) << '\n';
  } else if (!answer.rows.empty()) {
    tools::print_answer(answer, o.degrees);
  }
  report["robot"] = {{"file", chain.file}, {"sha256", chain.sha256}};
  tools::write_report(o.common, "kaboum-ik", report);
  std::string what = answer.form ? std::string(ik::name_of(answer.form->family)) + ", closed form: "
                                 : "numeric, " + std::to_string(o.starts) + " starts: ";
  what += std::to_string(answer.found) + (answer.found == 1 ? " solution" : " solutions");
  if (!answer.families.empty())
    what += answer.families.size() == 1
                ? " and a family with a free joint"
                : " and " + std::to_string(answer.families.size()) + " families with a free joint";
  if (answer.form && !o.ignore_limits)
    what += ", " + std::to_string(answer.rows.size()) +
            (o.copies ? " configurations within the limits, whole turns counted"
                      : " within the limits");
  tools::log(o.common.quiet, what);
  for (const Answer::Family& f : answer.families)
    tools::log(o.common.quiet, "a family: " + family_text(answer, f.family, o.degrees));
  if (answer.form && !answer.incomplete.empty() && !answer.rows.empty())
    tools::log(o.common.quiet, "there may be others: " + answer.incomplete);
  if (!answer.rows.empty()) return tools::kDone;
  if (!answer.form) {
    std::cerr << "kaboum-ik: none found, which is no proof that there is none; try --starts "
              << 10 * o.starts << '\n';
    return tools::kLimit;
  }
  if (!answer.incomplete.empty()) {
    std::cerr << "kaboum-ik: none found, which is no proof that there is none: "
              << answer.incomplete << "; try --numeric\n";
    return tools::kLimit;
  }
  std::cerr << "kaboum-ik: "
            << (answer.found == 0 && !answer.outside
                    ? unreached(answer, o.free_heading)
                    : "the pose is reached outside the joints' limits only; see "
                      "--ignore-limits")
            << '\n';
  return tools::kNo;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Prints the configurations with which a robot's chain reaches a pose: all of them, in closed "
      "form, for arms with a spherical wrist, with three parallel axes, or with five axes; else "
      "those found numerically.",
      "kaboum-ik");
  Options options;
  tools::describe(app, options);
  return tools::run(app, argc, argv, [&] {
    tools::require_valid(options);
    return run(options);
  });
}
