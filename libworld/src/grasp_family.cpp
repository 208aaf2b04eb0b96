// Tools that fit grasps; members of grasps that leave something free: how they are drawn, and told
// from other poses.
//
// A member moves the tool, as the stated pose has it, by a turn about an axis of the object and
// then by slides: M = S T with T x = p + R (x - p). The object's pose in the tool's frame is then
// the stated one, times the inverse of M.

#include <kaboum/base/error.h>
#include <kaboum/kinematics/arm.h>
#include <kaboum/kinematics/sample.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/world/features.h>
#include <kaboum/world/grasp_family.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace kaboum::world {
namespace {

using kinematics::inverse;

constexpr double kWholeTurn = 2 * std::numbers::pi;
/// Steps of Roberts's sequence, by the number of dimensions: powers of the inverse of the root of
/// x^(d + 1) = x + 1.
constexpr std::array<std::array<double, 3>, 3> kSteps{
    {{0.6180339887498949, 0, 0},
     {0.7548776662466927, 0.5698402909980532, 0},
     {0.8191725133961645, 0.6710436067037893, 0.5497004779019703}}};

/// A motion of the tool in the object's frame.
Transform motion_of(const Grasp& grasp, const std::vector<double>& values) {
  Transform out;
  if (grasp.turn) {
    out.linear = robot::rotation_about(grasp.turn->axis, values.back());
    out.translation = grasp.turn->point - out.linear * grasp.turn->point;
  }
  for (std::size_t i = 0; i < grasp.slides.size(); ++i)
    out.translation += values[i] * grasp.slides[i].direction;
  return out;
}

/// The angle within the bounds that is nearest to one, whole turns apart.
double within(const FreeTurn& turn, double angle) {
  double beyond = std::fmod(angle - turn.from, kWholeTurn);
  if (beyond < 0) beyond += kWholeTurn;
  const double range = turn.to - turn.from;
  if (beyond <= range) return turn.from + beyond;
  return beyond - range <= kWholeTurn - beyond ? turn.to : turn.from;
}

std::size_t freedoms_of(const Grasp& grasp) { return grasp.slides.size() + (grasp.turn ? 1 : 0); }

}  // namespace

bool fits(const ToolFrame& tool, const Grasp& grasp) {
  const std::size_t slash = grasp.name.find('/');
  return slash == std::string::npos || grasp.name.substr(0, slash) == tool.name;
}

bool is_family(const Grasp& grasp) { return freedoms_of(grasp) > 0 || !grasp.constraints.empty(); }

Transform drawn_member(const Grasp& grasp, std::size_t index) {
  if (grasp.constraints.empty()) return member_of(grasp, draw_member(grasp, index));
  ensure(!grasp.members.empty(), "holds that meet the constraints of a grasp");
  return grasp.members[index % grasp.members.size()];
}

std::vector<Transform> draw_members(const std::vector<ToleratedConstraint>& constraints,
                                    const Vec3& center, double size) {
  using FrameKind = kinematics::FrameId::Kind;
  kinematics::ConstraintProblem problem;
  // So that its middle may be near the tool, wherever its frame is.
  const double far = size + center.norm();
  problem.objects.push_back({Vec3::Constant(-far), Vec3::Constant(far)});
  for (const ToleratedConstraint& c : constraints)
    problem.constraints.push_back({c.relation,
                                   {{FrameKind::World}, kinematics_feature(c.first.feature)},
                                   {{FrameKind::Object, 0}, kinematics_feature(c.second.feature)},
                                   c.value});
  kinematics::SampleOptions options;
  options.length = size;
  kinematics::ConstraintSampler sampler(std::move(problem), options);
  std::vector<Transform> out;
  while (out.size() < kMostMembers) {
    const auto sample = sampler.next();
    if (!sample) break;
    out.push_back(sample->at.objects.front());
  }
  return out;
}

Transform member_of(const Grasp& grasp, const std::vector<double>& values) {
  ensure(values.size() == freedoms_of(grasp), "as many values as are free");
  if (values.empty()) return grasp.pose;
  return grasp.pose * inverse(motion_of(grasp, values));
}

std::vector<double> draw_member(const Grasp& grasp, std::size_t index) {
  const std::size_t n = freedoms_of(grasp);
  std::vector<double> out;
  out.reserve(n);
  const auto draw = [&](double from, double to, double nearest) {
    if (index == 0) {
      out.push_back(nearest);
      return;
    }
    const double step = kSteps[n - 1][out.size()];
    const double share = std::fmod(0.5 + static_cast<double>(index) * step, 1.0);
    out.push_back(from + share * (to - from));
  };
  for (const FreeSlide& slide : grasp.slides)
    draw(slide.from, slide.to, std::clamp(0.0, slide.from, slide.to));
  if (grasp.turn) draw(grasp.turn->from, grasp.turn->to, within(*grasp.turn, 0));
  return out;
}

Transform nearest_member(const Grasp& grasp, const Transform& pose) {
  if (!is_family(grasp)) return grasp.pose;
  if (!grasp.constraints.empty())
    return std::ranges::all_of(grasp.constraints,
                               [&](const auto& c) { return is_met(c, {}, pose); })
               ? pose
               : grasp.pose;
  const Transform moved = inverse(pose) * grasp.pose;
  const Eigen::Matrix3d& r = moved.linear;
  double angle = 0;
  Vec3 slid = moved.translation;
  if (const auto& turn = grasp.turn) {
    // It maximises the trace of R(angle)^T r.
    const Vec3 twist(r(2, 1) - r(1, 2), r(0, 2) - r(2, 0), r(1, 0) - r(0, 1));
    angle = within(*turn,
                   std::atan2(turn->axis.dot(twist), r.trace() - turn->axis.dot(r * turn->axis)));
    slid -= turn->point - robot::rotation_about(turn->axis, angle) * turn->point;
  }
  std::vector<double> values;
  values.reserve(freedoms_of(grasp));
  if (!grasp.slides.empty()) {
    const auto count = static_cast<Eigen::Index>(grasp.slides.size());
    Eigen::Matrix<double, 3, Eigen::Dynamic, 0, 3, 3> directions(3, count);
    for (Eigen::Index i = 0; i < count; ++i)
      directions.col(i) = grasp.slides[static_cast<std::size_t>(i)].direction;
    const Eigen::VectorXd along = directions.colPivHouseholderQr().solve(slid);
    for (Eigen::Index i = 0; i < count; ++i) {
      const FreeSlide& slide = grasp.slides[static_cast<std::size_t>(i)];
      values.push_back(std::clamp(along[i], slide.from, slide.to));
    }
  }
  if (grasp.turn) values.push_back(angle);
  return member_of(grasp, values);
}

namespace {

/// Where a point of the tool is near a point of the object, or on a surface of it.
double farthest_by_constraints(const Grasp& grasp, const Vec3& point) {
  double out = std::numeric_limits<double>::infinity();
  for (const ToleratedConstraint& c : grasp.constraints) {
    const bool near = c.relation == kinematics::Relation::Coincident ||
                      c.relation == kinematics::Relation::Distance;
    const Feature &of_tool = c.first.feature, &other = c.second.feature;
    if (!near || of_tool.kind != Feature::Kind::Point) continue;
    if (other.kind != Feature::Kind::Point && other.kind != Feature::Kind::Surface) continue;
    out = std::min(out, of_tool.point.norm() + std::abs(c.value) + c.within + radius_of(other) +
                            (other.point - point).norm());
  }
  return out;
}

}  // namespace

double farthest_from(const Grasp& grasp, const Vec3& point) {
  if (!grasp.constraints.empty()) return farthest_by_constraints(grasp, point);
  const Vec3 origin = inverse(grasp.pose).translation;
  double out = (origin - point).norm();
  if (const auto& turn = grasp.turn) {
    // On opposite sides of the axis at most.
    const Vec3 a = origin - turn->point, b = point - turn->point;
    const double along = turn->axis.dot(a - b);
    const double across = turn->axis.cross(a).norm() + turn->axis.cross(b).norm();
    out = std::hypot(along, across);
  }
  for (const FreeSlide& slide : grasp.slides)
    out += std::max(std::abs(slide.from), std::abs(slide.to)) * slide.direction.norm();
  return out;
}

}  // namespace kaboum::world
