// What kaboum-ik prints and reports.
#include "answer.h"

#include <kaboum/robot/path.h>

#include <Eigen/Geometry>
#include <array>
#include <charconv>
#include <cmath>
#include <iostream>
#include <limits>

namespace kaboum::tools {
namespace {

/// So rounded that what is read back is within the limits that q is within.
double in_degrees(double q, const kinematics::Axis& axis) {
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  double degrees = q / kDegree;
  while (q >= axis.lower && degrees * kDegree < axis.lower)
    degrees = std::nextafter(degrees, kInfinite);
  while (q <= axis.upper && degrees * kDegree > axis.upper)
    degrees = std::nextafter(degrees, -kInfinite);
  return degrees;
}

double shown(const IkAnswer& answer, bool degrees, std::size_t joint, double q) {
  const kinematics::Axis& axis = answer.arm.axes[joint];
  return degrees && axis.turns ? in_degrees(q, axis) : q;
}

/// The shortest text that reads back as the same number.
std::string text_of(double value) {
  std::array<char, 32> text{};
  const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), value);
  return {text.data(), end.ptr};
}

std::vector<std::string> free_names(const IkAnswer& answer, unsigned free) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < answer.joints.size(); ++i)
    if ((free >> i & 1U) != 0) names.push_back(answer.joints[i]);
  return names;
}

/// The joint that a family's range is of.
std::size_t joint_of(const kinematics::SolutionFamily& family, std::size_t range) {
  return family.free.size() == 1 ? family.free.front() : family.free[range];
}

std::pair<double, double> shown_range(const IkAnswer& answer, bool degrees,
                                      const kinematics::SolutionFamily& family, std::size_t range) {
  const std::size_t joint = joint_of(family, range);
  return {shown(answer, degrees, joint, family.ranges[range].lower),
          shown(answer, degrees, joint, family.ranges[range].upper)};
}

Json pose_json(const kinematics::Transform& pose) {
  const Eigen::Quaterniond turn(pose.linear);
  const kinematics::Vec3& p = pose.translation;
  return {p.x(), p.y(), p.z(), turn.x(), turn.y(), turn.z(), turn.w()};
}

}  // namespace

Json answer_json(const IkAnswer& answer, bool degrees) {
  Json j = {{"method", answer.form ? "closed form" : "numeric"},
            {"complete", answer.incomplete.empty()},
            {"joints", answer.joints},
            {"angles", degrees ? "degrees" : "radians"},
            {"pose", pose_json(answer.target)}};
  if (answer.form) {
    j["family"] = kinematics::name_of(answer.form->family);
    j["model_error"] = {{"position", answer.form->model_error.position},
                        {"rotation", answer.form->model_error.rotation}};
  }
  if (!answer.incomplete.empty()) j["incomplete"] = answer.incomplete;
  j["found"] = answer.found;
  j["solutions"] = Json::array();
  for (const IkAnswer::Row& row : answer.rows) {
    Json q = Json::array();
    for (std::size_t i = 0; i < row.q.size(); ++i) q.push_back(shown(answer, degrees, i, row.q[i]));
    j["solutions"].push_back({{"q", q},
                              {"pose", pose_json(row.pose)},
                              {"within_limits", row.within},
                              {"singular", kinematics::singular_names(row.singular)},
                              {"free", free_names(answer, row.free)},
                              {"position_error", row.error.position},
                              {"rotation_error", row.error.rotation}});
  }
  j["families"] = Json::array();
  for (const IkAnswer::Family& f : answer.families) {
    Json ranges = Json::array();
    for (std::size_t i = 0; i < f.family.ranges.size(); ++i) {
      const auto [lower, upper] = shown_range(answer, degrees, f.family, i);
      ranges.push_back(
          {{"joint", answer.joints[joint_of(f.family, i)]}, {"from", lower}, {"to", upper}});
    }
    unsigned free = 0;
    for (const std::size_t joint : f.family.free) free |= 1U << joint;
    Json representatives = Json::array();
    for (const kinematics::Solution& s : f.family.representatives) {
      Json q = Json::array();
      for (std::size_t i = 0; i < answer.joints.size(); ++i)
        q.push_back(shown(answer, degrees, i, s.q[i]));
      representatives.push_back(std::move(q));
    }
    j["families"].push_back({{"free", free_names(answer, free)},
                             {"ranges", ranges},
                             {"pose", pose_json(f.pose)},
                             {"singular", kinematics::singular_names(f.family.singular)},
                             {"representatives", representatives}});
  }
  return j;
}

std::string family_text(const IkAnswer& answer, const kinematics::SolutionFamily& family,
                        bool degrees) {
  std::string out;
  for (std::size_t i = 0; i < family.ranges.size(); ++i) {
    const auto [lower, upper] = shown_range(answer, degrees, family, i);
    const bool first = i == 0 || joint_of(family, i) != joint_of(family, i - 1);
    out += (i == 0  ? ""
            : first ? "; "
                    : ", ") +
           (first ? answer.joints[joint_of(family, i)] + " is free, from "
                  : std::string("and from ")) +
           text_of(lower) + " to " + text_of(upper);
  }
  return out;
}

void print_answer(const IkAnswer& answer, bool degrees) {
  std::string head;
  for (const std::string& joint : answer.joints) {
    if (!head.empty()) head += ',';
    head += robot::csv_field(joint);
  }
  std::cout << head << '\n';
  for (const IkAnswer::Row& row : answer.rows) {
    std::string line;
    for (std::size_t i = 0; i < row.q.size(); ++i) {
      if (i > 0) line += ',';
      line += text_of(shown(answer, degrees, i, row.q[i]));
    }
    for (const std::string& name : kinematics::singular_names(row.singular))
      line += "  # singular: " + name;
    for (const std::string& name : free_names(answer, row.free)) line += "  # free: " + name;
    if (!row.within) line += "  # outside the limits";
    std::cout << line << '\n';
  }
}

}  // namespace kaboum::tools
