// kaboum-ik: the configurations with which a robot's chain reaches a pose.
#include <kaboum/kinematics/closed_form.h>
#include <kaboum/kinematics/copies.h>
#include <kaboum/robot/robot_file.h>

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <charconv>
#include <cmath>
#include <iostream>

#include "cli.h"
#include "ik_answer.h"

namespace {

using namespace kaboum;  // the tool's own names are few
namespace ik = kinematics;

using tools::kDegree;
using Answer = tools::IkAnswer;

struct Options {
  std::string robot, base, tip, pose_of, reference;
  std::vector<double> pose;
  bool json = false, degrees = false, numeric = false, ignore_limits = false, copies = false,
       free_heading = false;
  int starts = 100;
  tools::CommonOptions common;
};

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

ik::Transform parse_pose(const std::vector<double>& p) {
  for (const double x : p)
    if (!std::isfinite(x)) usage("--pose: expected finite numbers");
  const Eigen::Quaterniond turn(p[6], p[3], p[4], p[5]);
  if (std::abs(turn.norm() - 1) > 1e-3)
    usage("--pose: the quaternion QX QY QZ QW has the length " + std::to_string(turn.norm()) +
          "; expected 1");
  return {turn.normalized().toRotationMatrix(), {p[0], p[1], p[2]}};
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
  ++answer.found;
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

Answer find(const Options& o, const robot::Robot& robot) {
  Answer answer;
  answer.arm = ik::arm_of(robot, o.base.empty() ? robot.links.front().name : o.base,
                          o.tip.empty() ? only_tip(robot) : o.tip);
  for (const std::uint32_t v : answer.arm.variables)
    answer.joints.push_back(robot.variables[v].name);
  answer.target =
      o.pose.empty()
          ? ik::forward(answer.arm, parse_joints(o.pose_of, "--pose-of", answer, o.degrees))
          : parse_pose(o.pose);
  const std::vector<double> reference =
      o.reference.empty() ? std::vector<double>(answer.joints.size(), 0.0)
                          : parse_joints(o.reference, "--reference", answer, o.degrees);
  if (!o.numeric) answer.form = ik::recognise(answer.arm);
  if (o.free_heading && (!answer.form || answer.form->family != ik::Family::FiveAxes))
    usage("--free-heading is for arms with five axes and a closed form; this one is not");
  if (answer.form) {
    ik::SolveOptions options;
    std::copy(reference.begin(), reference.end(), options.reference.begin());
    const std::vector<ik::Transform> targets =
        o.free_heading ? ik::with_other_headings(*answer.form, answer.target)
                       : std::vector<ik::Transform>{answer.target};
    for (const ik::Transform& target : targets)
      for (const ik::Solution& s : ik::solve(*answer.form, target, options))
        add_row(answer, o, {s.q.begin(), s.q.begin() + static_cast<long>(answer.joints.size())},
                reference, {{}, {s.position_error, s.rotation_error}, s.singular, true, target});
    return answer;
  }
  ik::NumericOptions options;
  options.seed = o.common.seed;
  options.starts = o.starts;
  options.limits = !o.ignore_limits;
  if (!o.reference.empty()) options.first = reference;
  for (const ik::NumericSolution& s : ik::solve_numeric_all(answer.arm, answer.target, options))
    add_row(answer, o, s.q, reference, {{}, s.error, ik::kRegular, true, answer.target});
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
  const robot::RobotFile robot = robot::read_robot(o.robot);
  const Answer answer = tools::naming(o.robot, [&] { return find(o, robot.robot); });
  tools::Json report = tools::answer_json(answer, o.degrees);
  if (o.json) {
    std::cout << report.dump(2) << '\n';
  } else if (!answer.rows.empty()) {
    tools::print_answer(answer, o.degrees);
  }
  report["robot"] = {{"file", o.robot}, {"sha256", robot.sha256}};
  tools::write_report(o.common, "kaboum-ik", report);
  std::string what = answer.form ? std::string(ik::name_of(answer.form->family)) + ", closed form: "
                                 : "numeric, " + std::to_string(o.starts) + " starts: ";
  what += std::to_string(answer.found) + (answer.found == 1 ? " solution" : " solutions");
  if (answer.form && !o.ignore_limits)
    what += ", " + std::to_string(answer.rows.size()) +
            (o.copies ? " configurations within the limits, whole turns counted"
                      : " within the limits");
  tools::log(o.common.quiet, what);
  if (!answer.rows.empty()) return tools::kDone;
  if (!answer.form) {
    std::cerr << "kaboum-ik: none found, which is no proof that there is none; try --starts "
              << 10 * o.starts << '\n';
    return tools::kLimit;
  }
  if (!is_complete(answer)) {
    std::cerr
        << "kaboum-ik: none found, which is no proof that there is none: the arm is only nearly of "
           "this family; try --numeric\n";
    return tools::kLimit;
  }
  std::cerr << "kaboum-ik: "
            << (answer.found == 0 ? unreached(answer, o.free_heading)
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
  Options o;
  app.add_option("ROBOT", o.robot, "URDF, or the Robotics Library's rlkin or rlmdl")
      ->required()
      ->type_name("FILE");
  app.add_option("--base", o.base, "Link that the pose is relative to [the root]")
      ->type_name("LINK");
  app.add_option("--tip", o.tip, "Link that is to have the pose [the last, if there is only one]")
      ->type_name("LINK");
  CLI::Option* pose =
      app.add_option("--pose", o.pose,
                     "Where the tip is to be: position, in the robot's unit of length, and unit "
                     "quaternion: X Y Z QX QY QZ QW")
          ->expected(7)
          ->type_name("NUMBER");
  CLI::Option* pose_of =
      app.add_option("--pose-of", o.pose_of,
                     "The pose of this configuration instead: a value per joint, with commas "
                     "between")
          ->type_name("Q1,Q2,…");
  pose->excludes(pose_of);
  app.add_option("--reference", o.reference,
                 "Of whole turns, the nearest to this configuration is printed; joints that are "
                 "free where axes are aligned keep its values; numeric search begins at it [0,0,…]")
      ->type_name("Q1,Q2,…");
  app.add_flag(
      "--copies", o.copies,
      "Print all that differ by whole turns within the limits, at most 4096 of a solution");
  app.add_flag("--ignore-limits", o.ignore_limits, "Print solutions outside the limits as well");
  app.add_flag(
      "--free-heading", o.free_heading,
      "Of five axes: keep the pose's position, pitch and roll, and turn its heading (about "
      "axis 1) so that it can be reached");
  app.add_flag("--degrees", o.degrees, "Angles are in degrees, those read and printed [radians]");
  app.add_flag("--numeric", o.numeric, "Search numerically although there is a closed form");
  app.add_option("--starts", o.starts, "Random configurations that numeric search begins at")
      ->check(tools::number_from(1, 1e6))
      ->capture_default_str()
      ->type_name("N");
  app.add_flag("--json", o.json, "Print JSON instead of a line of joint values per solution");
  tools::add_common_options(app, o.common);
  app.footer(
      "Exit codes: 0 done; 1 there is no solution, or none within the limits; 2 usage; 3 bad "
      "input; "
      "4 output failed; 6 internal error; 7 none found numerically, which proves nothing.");
  return tools::run(app, argc, argv, [&] {
    if (o.pose.empty() && o.pose_of.empty())
      throw Error(ErrorCode::InvalidArgument,
                  "where is the tip to be? Give --pose X Y Z QX QY QZ QW or --pose-of Q1,Q2,…");
    return run(o);
  });
}
