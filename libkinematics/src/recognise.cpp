// Finds which closed form an arm has, from its axes alone: frames are put on the axes as the
// distal Denavit–Hartenberg convention does, and the resulting model is compared with the arm.
#include <kaboum/kinematics/closed_form.h>

#include <cmath>
#include <numbers>

namespace kaboum::kinematics {
namespace {

constexpr double kLoose = 1e-2;  // axes that are no closer to a family are not compared with it

/// The arm's axes, in the frames' directions: all that frames are made of.
struct Lines {
  std::vector<Vec3> direction, point;
};

bool parallel(const Vec3& a, const Vec3& b) { return a.cross(b).norm() < kLoose; }
bool perpendicular(const Vec3& a, const Vec3& b) { return std::abs(a.dot(b)) < kLoose; }

/// The part of v that is perpendicular to n.
Vec3 across(const Vec3& v, const Vec3& n) { return v - n.dot(v) * n; }

double angle_about(const Vec3& axis, const Vec3& from, const Vec3& to) {
  return std::atan2(axis.dot(from.cross(to)), from.dot(to));
}

/// The rotation with z as it is and x as near to the given one as it can be.
Mat3 frame_of(const Vec3& x, const Vec3& z) {
  Mat3 m;
  m.col(2) = z;
  m.col(0) = across(x, z).normalized();
  m.col(1) = m.col(2).cross(m.col(0));
  return m;
}

/// The arm that the closed form solves exactly.
Arm model_of(const ClosedForm& f, std::size_t n) {
  const double quarter = std::numbers::pi / 2;
  std::vector<robot::Dh> rows;
  if (f.family == Family::SphericalWrist)
    rows = {{0, 0, f.a1, -quarter}, {0, 0, f.a2, 0},    {0, f.lateral, f.a3, -quarter},
            {0, f.d4, 0, quarter},  {0, 0, 0, quarter}, {0, 0, 0, 0}};
  else
    rows = {{0, 0, f.a1, quarter},         {0, 0, f.a2, 0},        {0, 0, f.a3, 0},
            {0, f.lateral, f.a4, quarter}, {0, f.d5, 0, -quarter}, {0, 0, 0, 0}};
  rows.resize(n);
  if (f.family == Family::FiveAxes) rows[4] = {0, 0, 0, 0};
  for (std::size_t i = 0; i < n; ++i) rows[i].theta = f.offset[i];
  Arm arm = arm_of_distal(rows);
  const Transform base = inverse(f.base_inverse);
  for (std::size_t i = 0; i < n; ++i) {
    arm.axes[i].direction = f.sign[i] * (base.linear * arm.axes[i].direction);
    arm.axes[i].point = base * arm.axes[i].point;
  }
  arm.tool = base * arm.tool * inverse(f.tool_inverse);
  return arm;
}

/// Bounds how far the tools of two arms come apart in any configuration. Replacing one axis after
/// another, a turn about the line (h, p) and one by the same angle about (h', p') differ by at
/// most 2φ |x − p| + 2 |p − p'| in x, with φ the angle between h and h', since R' = QRQᵀ with
/// ‖Q − 1‖ ≤ φ; p' is taken as the point of its line that is nearest to p. x is at most `beyond`
/// from p: the distances from axis to axis, in the arm and with the shifts in the model.
PoseError largest_difference(const Arm& a, const Arm& b) {
  PoseError sum = difference(a.tool, b.tool);
  double beyond = (a.tool.translation - a.axes.back().point).norm() + sum.position;
  for (std::size_t i = a.axes.size(); i-- > 0;) {
    const Axis &s = a.axes[i], &t = b.axes[i];
    const double angle = 1.2 * (s.direction - t.direction).norm();  // of a chord, up to π/2
    const double shift = across(s.point - t.point, t.direction).norm();
    beyond += 2 * shift;
    sum.position += 2 * angle * beyond + 2 * shift;
    sum.rotation += 2 * std::numbers::sqrt2 * angle;
    if (i > 0) beyond += (s.point - a.axes[i - 1].point).norm();
  }
  return sum;
}

/// Frames 1 to 3, which all families have: x1, x2 and the lengths a1, a2.
struct Shoulder {
  Vec3 z1, x1, x2, o1, o2;
};

std::optional<Shoulder> shoulder_of(const Lines& l, double turn, double reach, ClosedForm& f) {
  if (!perpendicular(l.direction[0], l.direction[1]) || !parallel(l.direction[1], l.direction[2]))
    return std::nullopt;
  Shoulder s;
  const Vec3 &z0 = l.direction[0], &z1 = l.direction[1];
  s.z1 = z1;
  // alpha_1 = turn · π/2: the common normal of the first two axes.
  s.x1 = across(turn * z0.cross(z1), z0).normalized();
  f.a1 = (l.point[1] - l.point[0]).dot(s.x1);
  const Vec3 height = z0 * z0.dot(l.point[1] - l.point[0]);
  s.o1 = l.point[0] + height + f.a1 * s.x1;
  const Vec3 upper = across(l.point[2] - s.o1, z1);
  f.a2 = upper.norm();
  if (f.a2 < kLoose * reach) return std::nullopt;
  s.x2 = upper / f.a2;
  s.o2 = s.o1 + upper;
  f.base_inverse = inverse({frame_of(s.x1, z0), l.point[0] + height});
  f.offset[0] = 0;
  f.offset[1] = angle_about(z1, s.x1, s.x2);
  return s;
}

/// Directions of the axes, turned so that parallel ones agree.
Lines lines_of(const Arm& arm, std::size_t parallels, ClosedForm& f) {
  Lines l;
  for (std::size_t i = 0; i < arm.axes.size(); ++i) {
    const bool flip = i > 1 && i <= parallels && arm.axes[i].direction.dot(l.direction[1]) < 0;
    f.sign[i] = flip ? -1 : 1;
    l.direction.emplace_back(f.sign[i] * arm.axes[i].direction);
    l.point.push_back(arm.axes[i].point);
  }
  return l;
}

/// The point of axis i that is nearest to axis j.
Vec3 nearest_point(const Lines& l, std::size_t i, std::size_t j) {
  const Vec3 &a = l.direction[i], &b = l.direction[j], between = l.point[j] - l.point[i];
  const double c = a.dot(b);
  return l.point[i] + a * ((a.dot(between) - c * b.dot(between)) / (1 - c * c));
}

bool spherical_wrist(const Arm& arm, double reach, ClosedForm& f) {
  f.family = Family::SphericalWrist;
  const Lines l = lines_of(arm, 2, f);
  for (std::size_t i = 2; i < 5; ++i)
    if (!perpendicular(l.direction[i], l.direction[i + 1])) return false;
  const auto s = shoulder_of(l, -1, reach, f);
  if (!s) return false;
  const Vec3 wrist = (nearest_point(l, 3, 4) + nearest_point(l, 5, 4)) / 2;
  const Vec3 &z3 = l.direction[3], &z4 = l.direction[4], &z5 = l.direction[5];
  const Vec3 x3 = z3.cross(s->z1).normalized(), x4 = z3.cross(z4).normalized(),
             x5 = z4.cross(z5).normalized();
  const Vec3 o3 = nearest_point(l, 3, 2);
  f.lateral = (wrist - s->o2).dot(s->z1);
  f.a3 = (wrist - s->o2).dot(x3);
  f.d4 = (wrist - o3).dot(z3);
  f.forearm = std::hypot(f.a3, f.d4);
  f.bend = std::atan2(f.d4, f.a3);
  if (f.forearm < kLoose * reach) return false;
  f.offset[2] = angle_about(s->z1, s->x2, x3);
  f.offset[3] = angle_about(z3, x3, x4);
  f.offset[4] = angle_about(z4, x4, x5);
  f.tool_inverse = inverse(arm.tool) * Transform{frame_of(x5, z5), wrist};
  return true;
}

bool parallel_axes(const Arm& arm, double reach, ClosedForm& f) {
  const bool five = arm.axes.size() == 5;
  f.family = five ? Family::FiveAxes : Family::ParallelAxes;
  const Lines l = lines_of(arm, 3, f);
  if (!parallel(l.direction[2], l.direction[3]) || !perpendicular(l.direction[3], l.direction[4]))
    return false;
  if (!five && !perpendicular(l.direction[4], l.direction[5])) return false;
  const auto s = shoulder_of(l, 1, reach, f);
  if (!s) return false;
  const Vec3 &z3 = s->z1, &z4 = l.direction[4];
  const Vec3 forearm = across(l.point[3] - s->o2, z3);
  f.a3 = forearm.norm();
  if (f.a3 < kLoose * reach) return false;
  const Vec3 x3 = forearm / f.a3, o3 = s->o2 + forearm, x4 = z3.cross(z4).normalized();
  f.a4 = (l.point[4] - o3).dot(x4);
  f.lateral = (l.point[4] - o3).dot(z3);
  const Vec3 o4 = o3 + f.lateral * z3 + f.a4 * x4;
  f.offset[2] = angle_about(z3, s->x2, x3);
  f.offset[3] = angle_about(z3, x3, x4);
  if (five) {
    f.offset[4] = 0;
    f.tool_inverse = inverse(arm.tool) * Transform{frame_of(x4, z4), o4};
    return true;
  }
  const Vec3 &z5 = l.direction[5], x5 = z5.cross(z4).normalized(), o5 = nearest_point(l, 4, 5);
  f.d5 = (o5 - o4).dot(z4);
  f.offset[4] = angle_about(z4, x4, x5);
  f.tool_inverse = inverse(arm.tool) * Transform{frame_of(x5, z5), o5};
  return true;
}

}  // namespace

std::optional<ClosedForm> recognise(const Arm& arm, double bound) {
  const std::size_t n = arm.axes.size();
  if (n != 5 && n != 6) return std::nullopt;
  for (const Axis& axis : arm.axes)
    if (!axis.turns || axis.rate != 1) return std::nullopt;
  const double length = reach(arm);
  for (const auto family : {&spherical_wrist, &parallel_axes}) {
    ClosedForm f;
    if (n == 5 && family == &spherical_wrist) continue;
    if (!family(arm, length, f)) continue;
    f.lever = f.tool_inverse.translation.norm();
    f.model_error = largest_difference(arm, model_of(f, n));
    if (!(f.model_error.position <= bound * length && f.model_error.rotation <= bound)) continue;
    f.reach = length;
    f.arm = arm;
    return f;
  }
  return std::nullopt;
}

const char* name_of(Family family) {
  return family == Family::SphericalWrist ? "spherical wrist"
         : family == Family::ParallelAxes ? "three parallel axes"
                                          : "five axes";
}

}  // namespace kaboum::kinematics
