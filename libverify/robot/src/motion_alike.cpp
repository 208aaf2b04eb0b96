// Whether a robot with other shapes moves as the one it stands for.
#include <kaboum/verify/motion_alike.h>

#include <algorithm>

namespace kaboum::verify {
namespace {

bool same(const robot::Transform& a, const robot::Transform& b) {
  return a.linear == b.linear && a.translation == b.translation;
}

bool same_limits(const robot::Variable& a, const robot::Variable& b) {
  return a.lower == b.lower && a.upper == b.upper;
}

/// What of a joint is not as it was; null if all is.
const char* difference(const robot::Robot& original, std::size_t i, const robot::Robot& result,
                       std::size_t k) {
  const robot::Joint &a = original.joints[i], &b = result.joints[k];
  if (a.type != b.type) return "is of another type";
  if (original.links[a.parent].name != result.links[b.parent].name) return "has another parent";
  if (original.links[i + 1].name != result.links[k + 1].name) return "has another child";
  if (!same(a.origin, b.origin)) return "has another origin";
  if (a.type == robot::JointType::Fixed) return nullptr;
  if (a.axis != b.axis) return "has another axis";
  const robot::Variable &x = original.variables[a.variable], &y = result.variables[b.variable];
  if (a.multiplier != b.multiplier || a.offset != b.offset || x.name != y.name)
    return "mimics in another way";
  return same_limits(x, y) ? nullptr : "has other limits";
}

}  // namespace

bool same_frame(const robot::Geometry& a, const robot::Geometry& b) {
  return a.shape == b.shape && a.size == b.size && same(a.origin, b.origin);
}

std::string difference_in_motion(const robot::Robot& original, const robot::Robot& result) {
  if (original.links[0].name != result.links[0].name)
    return "the result's root is '" + result.links[0].name + "' instead of '" +
           original.links[0].name + "'";
  for (const robot::Link& link : original.links)
    if (!result.find_link(link.name)) return "the result has no link '" + link.name + "'";
  for (std::size_t i = 0; i < original.joints.size(); ++i) {
    const std::string& name = original.joints[i].name;
    const auto at = std::find_if(result.joints.begin(), result.joints.end(),
                                 [&](const robot::Joint& b) { return b.name == name; });
    if (at == result.joints.end()) return "the result has no joint '" + name + "'";
    const auto k = static_cast<std::size_t>(at - result.joints.begin());
    if (const char* what = difference(original, i, result, k))
      return "joint '" + name + "' " + what;
  }
  return {};
}

}  // namespace kaboum::verify
