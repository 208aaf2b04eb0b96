// Poses that an arm of five axes reaches, of those that differ by their heading only.
// Source: [gaschler2016] App. A.3, where the target of five axes is position, pitch and roll;
// docs/algorithms/inverse-kinematics.md.
#include <kaboum/kinematics/closed_form.h>

#include <algorithm>
#include <cmath>

#include "tolerances.h"

namespace kaboum::kinematics {
namespace {

/// So near, two turns are the same: the arm is stretched sideways as far as it goes.
constexpr double kSame = 1e-9;

Transform turned(const Transform& pose, double angle) {
  return {robot::rotation_about(Vec3::UnitZ(), angle) * pose.linear, pose.translation};
}

}  // namespace

bool has_any_heading(const ClosedForm& form, const Transform& target) {
  const Transform tool = form.base_inverse * target;
  const Vec3 axis = tool.linear * form.tool_inverse.linear.col(2);
  const Vec3& p = tool.translation;
  return std::hypot(axis.x(), axis.y()) < kNearlySingular ||
         std::hypot(p.x(), p.y()) < kNearlySingular * form.reach;
}

std::vector<Transform> with_other_headings(const ClosedForm& form, const Transform& target) {
  if (form.family != Family::FiveAxes) return {};
  const Transform tool = form.base_inverse * target;  // in the first frame: axis 1 is z
  const Vec3 axis = tool.linear * form.tool_inverse.linear.col(2);
  const Vec3 offset = tool.linear * form.tool_inverse.translation;  // from the tool to the wrist
  const Vec3& p = tool.translation;
  const double level = std::hypot(axis.x(), axis.y()), distance = std::hypot(p.x(), p.y());
  if (level < kNothing || distance < kNothing * form.reach) return {target};
  const double across = (axis.x() * offset.y() - axis.y() * offset.x()) / level;
  std::vector<double> turns;
  for (const double side : {1.0, -1.0}) {
    // The wrist is beside the plane of axes 1 and 5 by `lateral`: s0 x - c0 y - side across.
    const double ratio = (form.lateral + side * across) / distance;
    if (!(std::abs(ratio) <= 1 + kBorder)) continue;
    const double sine = std::min(1.0, std::max(-1.0, ratio));
    for (const double shoulder : {std::asin(sine), std::numbers::pi - std::asin(sine)}) {
      const double plane = std::atan2(p.y(), p.x()) + shoulder;
      const double turn = std::remainder(plane - std::atan2(side * axis.y(), side * axis.x()),
                                         2 * std::numbers::pi);
      if (std::none_of(turns.begin(), turns.end(), [&](double other) {
            return std::abs(std::remainder(turn - other, 2 * std::numbers::pi)) < kSame;
          }))
        turns.push_back(turn);
    }
  }
  std::vector<Transform> out;
  out.reserve(turns.size());
  for (const double turn : turns) out.push_back(inverse(form.base_inverse) * turned(tool, turn));
  return out;
}

}  // namespace kaboum::kinematics
