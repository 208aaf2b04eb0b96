// kaboum-ik: the configurations with which a robot's chain reaches a pose.
#include <kaboum/base/parse_numbers.h>
#include <kaboum/kinematics/inverse.h>
#include <kaboum/robot/base_pose.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/world/scene.h>

#include <CLI/CLI.hpp>
#include <cmath>
#include <iostream>

#include "answer.h"
#include "options.h"

namespace {

using namespace kaboum;  // the tool's own names are few
namespace ik = kinematics;

using tools::kDegree;

using Answer = tools::IkAnswer;
using Options = tools::IkOptions;

[[noreturn]] void usage(const std::string& what) { throw Error(ErrorCode::InvalidArgument, what); }

/// "0.1,-2,3": a value per joint, in radians after that.
std::vector<double> parse_joints(const std::string& text, const char* option, const Answer& answer,
                                 bool degrees) {
  const std::optional<std::vector<double>> given = parse_numbers(text);
  if (!given)
    usage(std::string(option) + ": expected numbers with commas between, as 0.5,-1.2,0, not '" +
          text + "'");
  std::vector<double> q = *given;
  if (q.size() != answer.joints.size())
    usage(std::string(option) + ": " + std::to_string(q.size()) + " values for the " +
          std::to_string(answer.joints.size()) + " joints " + robot::names_of(answer.joints));
  for (std::size_t i = 0; i < q.size(); ++i)
    if (degrees && answer.arm.axes[i].turns) q[i] *= kDegree;
  return q;
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
    robot::RobotFile read =
        robot::read_robot(o.robot, robot::Motions::All, o.xacro_arguments, o.packages);
    out = {o.robot, read.sha256, std::move(read.robot), o.tip, {}};
  } else {
    world::SceneFile scene = world::read_scene(o.scene);
    const world::RobotModel& model =
        scene.world.robots[world::robot_named(scene.world, o.robot_name)];
    out = {o.scene, scene.sha256, model.kinematics, o.tip, {}};
    if (!o.tool.empty() || (o.tip.empty() && model.tools.size() == 1)) {
      const world::ToolFrame& tool = world::tool_named(model, o.tool);
      out.tip = model.kinematics.links[tool.link].name;
      out.tool = tool.pose;
    }
    if (o.base.empty()) out.robot = robot::placed(model.kinematics, model.base);
  }
  if (out.tip.empty()) out.tip = tools::naming(out.file, [&] { return ik::only_tip(out.robot); });
  return out;
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
  ik::InverseRequest request = o.request;
  request.target = answer.target;
  if (!o.reference.empty())
    request.reference = parse_joints(o.reference, "--reference", answer, o.degrees);
  static_cast<ik::InverseAnswer&>(answer) = ik::find_configurations(answer.arm, request);
  return answer;
}

std::string unreached(const Answer& answer, bool free_heading, bool ignore_limits) {
  // What joints before the last six can do, they can within their limits.
  const bool limited = answer.redundant > 0 && !ignore_limits;
  const bool five = answer.form && answer.form->family == ik::Family::FiveAxes;
  return five && !free_heading
             ? "the pose is out of reach; five axes reach most poses with another "
               "heading only, see --free-heading"
             : std::string("the pose is out of reach") +
                   (limited ? " within the joints' limits; see --ignore-limits" : "");
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
                                 : "numeric, " + std::to_string(o.request.starts) + " starts: ";
  what += std::to_string(answer.found) + (answer.found == 1 ? " solution" : " solutions");
  if (!answer.families.empty())
    what += answer.families.size() == 1
                ? " and a family with a free joint"
                : " and " + std::to_string(answer.families.size()) + " families with a free joint";
  if (answer.form && !o.request.ignore_limits)
    what += ", " + std::to_string(answer.rows.size()) +
            (o.request.copies ? " configurations within the limits, whole turns counted"
                              : " within the limits");
  tools::log(o.common.quiet, what);
  for (const Answer::Family& f : answer.families)
    tools::log(o.common.quiet, "a family: " + family_text(answer, f.family, o.degrees));
  if (answer.form && !answer.incomplete.empty() && !answer.rows.empty())
    tools::log(o.common.quiet, "there may be others: " + answer.incomplete);
  if (!answer.rows.empty()) return tools::kDone;
  if (!answer.form) {
    std::cerr << "kaboum-ik: none found, which is no proof that there is none; try --starts "
              << 10 * o.request.starts << '\n';
    return tools::kLimit;
  }
  if (!answer.incomplete.empty()) {
    std::cerr << "kaboum-ik: none found, which is no proof that there is none: "
              << answer.incomplete << "; try --numeric\n";
    return tools::kLimit;
  }
  std::cerr << "kaboum-ik: "
            << (answer.found == 0 && !answer.outside
                    ? unreached(answer, o.request.free_heading, o.request.ignore_limits)
                    : "the pose is reached outside the joints' limits only; see "
                      "--ignore-limits")
            << '\n';
  return tools::kNo;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Prints the configurations with which a robot's chain reaches a pose: all of them, in closed "
      "form, for arms with a spherical wrist, with three parallel axes, or with five axes; some, "
      "where further joints come before six such axes (a rail); else those found numerically.",
      "kaboum-ik");
  Options options;
  tools::describe(app, options);
  return tools::run(app, argc, argv, [&] {
    tools::require_valid(options);
    return run(options);
  });
}
