// Configurations that reach a pose: closed forms and their families, or a
// numeric search.

#include <kaboum/base/error.h>
#include <kaboum/kinematics/copies.h>
#include <kaboum/kinematics/inverse.h>
#include <kaboum/kinematics/redundant.h>

#include <algorithm>
#include <utility>

namespace kaboum::kinematics {
namespace {

using Row = InverseAnswer::Row;

/// What is asked, and what was found so far.
struct InverseSearch {
  const Arm& arm;
  const InverseRequest& request;
  std::vector<double> reference;
  InverseAnswer answer = {};

  void add_row(const std::vector<double>& q, Row row);
  void find_in_closed_form();
  void find_with_redundant(const RedundantArm& redundant);
  void find_numerically();
};

void InverseSearch::add_row(const std::vector<double>& q, Row row) {
  std::vector<std::vector<double>> choices;
  if (request.copies && !request.ignore_limits) {
    choices = copies(arm, q);
  } else if (auto nearest = nearest_copy(arm, q, reference)) {
    choices.push_back(std::move(*nearest));
  }
  if (choices.empty() && request.ignore_limits) {
    choices.push_back(q);
    row.within = false;
  }
  for (std::vector<double>& choice : choices) {
    row.q = std::move(choice);
    answer.rows.push_back(row);
  }
}

void InverseSearch::find_in_closed_form() {
  const auto joints = static_cast<long>(arm.axes.size());
  SolutionSetOptions options;
  std::copy(reference.begin(), reference.end(), options.solve.reference.begin());
  options.limits = !request.ignore_limits;
  options.representatives = request.representatives;
  std::vector<Transform> targets{request.target};
  if (request.free_heading) {
    targets = with_other_headings(*answer.form, request.target);
    if (has_any_heading(*answer.form, request.target))
      answer.incomplete = "the pose can be reached with many headings, or nearly so";
  }
  for (const Transform& target : targets) {
    SolutionSet set = solve_set(*answer.form, target, options);
    if (!set.complete && answer.incomplete.empty()) answer.incomplete = set.reason;
    answer.found += set.isolated.size();
    if (options.limits && set.isolated.empty() && set.families.empty()) {
      SolutionSetOptions any = options;
      any.limits = false;
      answer.outside = answer.outside || !solve_set(*answer.form, target, any).families.empty();
    }
    const auto add = [&](const Solution& s) {
      add_row({s.q.begin(), s.q.begin() + joints},
              {{}, {s.position_error, s.rotation_error}, s.singular, true, target, s.free});
    };
    for (const Solution& s : set.isolated) add(s);
    for (SolutionFamily& family : set.families) {
      for (const Solution& s : family.representatives) add(s);
      answer.families.push_back({std::move(family), target});
    }
  }
}

void InverseSearch::find_with_redundant(const RedundantArm& redundant) {
  answer.form = redundant.form;
  answer.redundant = redundant.count;
  RedundantOptions options;
  options.reference = reference;
  options.limits = !request.ignore_limits;
  options.values = request.representatives;
  const RedundantSolutions solutions = solve_redundant(redundant, request.target, options);
  if (!solutions.out_of_reach)
    answer.incomplete =
        "joints before the last six are redundant, of whose values a sequence is tried";
  answer.found = solutions.found.size();
  for (const RedundantSolution& s : solutions.found)
    add_row(s.q, {{}, s.error, s.singular, true, request.target, (1U << redundant.count) - 1});
}

void InverseSearch::find_numerically() {
  answer.incomplete = "a numeric search finds no proof";
  NumericOptions options;
  options.seed = request.seed;
  options.starts = static_cast<int>(request.starts);
  options.limits = !request.ignore_limits;
  options.first = request.reference;
  options.progress = request.progress;
  for (const NumericSolution& s : solve_numeric_all(arm, request.target, options)) {
    ++answer.found;
    add_row(s.q, {{}, s.error, kRegular, true, request.target});
  }
}

}  // namespace

InverseAnswer find_configurations(const Arm& arm, const InverseRequest& request) {
  if (!request.reference.empty() && request.reference.size() != arm.axes.size())
    throw Error(ErrorCode::InvalidArgument, "reference: a value for each of the " +
                                                std::to_string(arm.axes.size()) +
                                                " joints is expected");
  InverseSearch search{arm, request, request.reference};
  if (search.reference.empty()) search.reference.assign(arm.axes.size(), 0.0);
  if (!request.numeric) search.answer.form = recognise(arm);
  if (request.free_heading &&
      (!search.answer.form || search.answer.form->family != Family::FiveAxes))
    throw Error(ErrorCode::InvalidArgument,
                "a free heading is for arms with five axes and a closed form; "
                "this one is not");
  if (search.answer.form)
    search.find_in_closed_form();
  else if (const auto redundant = request.numeric ? std::nullopt : recognise_redundant(arm))
    search.find_with_redundant(*redundant);
  else
    search.find_numerically();
  return std::move(search.answer);
}

std::vector<std::string> singular_names(unsigned singular) {
  std::vector<std::string> names;
  if ((singular & kShoulder) != 0) names.emplace_back("shoulder");
  if ((singular & kElbow) != 0) names.emplace_back("elbow");
  if ((singular & kWrist) != 0) names.emplace_back("wrist");
  return names;
}

std::string only_tip(const robot::Robot& robot) {
  std::vector<std::string> tips;
  std::string words;
  for (std::uint32_t link = 0; link < robot.links.size(); ++link) {
    bool last = true;
    for (const robot::Joint& joint : robot.joints) last = last && joint.parent != link;
    if (!last) continue;
    words += (tips.empty() ? "'" : ", '") + robot.links[link].name + "'";
    tips.push_back(robot.links[link].name);
  }
  if (tips.size() != 1)
    throw Error(ErrorCode::InvalidArgument,
                "tip: name the link to be placed; the robot ends in " + words);
  return tips.front();
}

}  // namespace kaboum::kinematics
