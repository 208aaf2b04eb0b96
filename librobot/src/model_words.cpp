// Numbers and names in files of robots.

#include "model_words.h"

#include <kaboum/base/error.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <charconv>

namespace kaboum::robot {

std::string digits(double x) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), x);
  return {text.data(), end};
}

std::string digits(std::initializer_list<double> numbers) {
  std::string out;
  for (const double x : numbers) {
    if (!out.empty()) out += ' ';
    out += digits(x);
  }
  return out;
}

std::string digits(const Vec3& v) { return digits({v.x(), v.y(), v.z()}); }

std::array<double, 4> quaternion(const Mat3& rotation) {
  Eigen::Quaterniond q(rotation);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return {q.w(), q.x(), q.y(), q.z()};
}

bool is_identity(const Transform& pose) {
  return pose.translation.isZero(0) && pose.linear.isIdentity(0);
}

std::array<Geometry, 3> parts_of_capsule(const Geometry& capsule) {
  std::array<Geometry, 3> out{capsule, capsule, capsule};
  out[0].shape = Geometry::Shape::Cylinder;
  for (const std::size_t i : {1U, 2U}) {
    Geometry& ball = out[i];
    ball.shape = Geometry::Shape::Sphere;
    ball.origin.translation +=
        (i == 1 ? -0.5 : 0.5) * capsule.size.y() * capsule.origin.linear.col(2);
    ball.origin.linear = Mat3::Identity();
    ball.size = Vec3::Constant(capsule.size.x());
  }
  return out;
}

std::vector<Primitive> without_capsules(const std::vector<Primitive>& primitives) {
  std::vector<Primitive> out;
  for (const Primitive& one : primitives) {
    if (one.geometry.shape != Geometry::Shape::Capsule) {
      out.push_back(one);
      continue;
    }
    for (const Geometry& part : parts_of_capsule(one.geometry))
      out.push_back({part, part.shape == Geometry::Shape::Sphere ? Vec3(Vec3::Zero()) : one.rpy});
  }
  return out;
}

void require_primitives(const Robot& written, const Robot& original,
                        const std::map<std::size_t, std::vector<Primitive>>& primitives,
                        const std::string& name) {
  constexpr double kRounding = 1e-12;  // of quaternions and poses
  const auto is_same = [](const Geometry& a, const Primitive& wanted) {
    const Geometry& b = wanted.geometry;
    using Shape = Geometry::Shape;
    const int sizes = b.shape == Shape::Sphere ? 1 : b.shape == Shape::Box ? 3 : 2;
    return a.shape == b.shape && a.size.head(sizes) == b.size.head(sizes) &&
           (a.origin.translation - b.origin.translation).norm() <=
               kRounding * (b.origin.translation.norm() + b.size.norm()) &&
           (b.shape == Shape::Sphere || (a.origin.linear - b.origin.linear).norm() <= kRounding);
  };
  for (const auto& [index, wanted] : primitives) {
    const std::string& link = original.links.at(index).name;
    const std::optional<std::uint32_t> found = written.find_link(link);
    if (!found || !std::ranges::equal(written.links[*found].collision, wanted, is_same))
      throw Error(ErrorCode::InvalidInput,
                  name + ": link '" + link +
                      "': its new shapes would not be where they are to be: a class or a frame of "
                      "the file says otherwise");
  }
}

std::optional<Inertial> sound_inertial(const std::string& link, const Inertial& inertial,
                                       std::vector<std::string>& notes) {
  constexpr double kLeast = 1e-14;               // MuJoCo's
  constexpr double kRoom = 1e-9, kWorth = 1e-6;  // of the largest moment
  const Eigen::SelfAdjointEigenSolver<Mat3> solver(inertial.inertia, Eigen::EigenvaluesOnly);
  const Vec3& main = solver.eigenvalues();  // rising
  if (!(inertial.mass > kLeast) || !(main.x() > kLeast)) {
    notes.push_back("The inertial of link '" + link +
                    "' is not positive, and left out: simulators refuse it.");
    return std::nullopt;
  }
  Inertial out = inertial;
  const double missing = main.z() * (1 + kRoom) - (main.x() + main.y());
  if (!(missing > 0)) return out;
  out.inertia.diagonal().array() += missing;
  if (missing > kWorth * main.z())
    notes.push_back("The inertia of link '" + link +
                    "' is that of no body (one moment is larger than the sum of the others), which "
                    "simulators refuse: all moments are larger by " +
                    digits(missing) + ".");
  return out;
}

const Joint& leader_of(const Robot& robot, const Joint& joint) {
  const std::string& name = robot.variables[joint.variable].name;
  for (const Joint& other : robot.joints)
    if (other.type != JointType::Fixed && other.variable == joint.variable && other.name == name)
      return other;
  return joint;
}

std::string UniqueNames::give(const std::string& wish) {
  std::string name = wish;
  for (int i = 2; !taken_.insert(name).second; ++i) name = wish + "-" + std::to_string(i);
  return name;
}

}  // namespace kaboum::robot
