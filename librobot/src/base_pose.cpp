// Robots that stand somewhere in the world.

#include <kaboum/base/error.h>
#include <kaboum/base/parse_numbers.h>
#include <kaboum/robot/base_pose.h>

#include <Eigen/Geometry>
#include <array>
#include <charconv>
#include <cmath>
#include <vector>

namespace kaboum::robot {
Robot placed(const Robot& robot, const Transform& base) {
  std::string world = "world";
  while (robot.find_link(world)) world += '_';
  Robot out;
  out.name = robot.name;
  out.variables = robot.variables;
  out.links.push_back({world, {}, {}});
  out.links.insert(out.links.end(), robot.links.begin(), robot.links.end());
  Joint stand;
  stand.name = "base pose";
  stand.origin = base;
  out.joints.push_back(stand);
  for (Joint joint : robot.joints) {
    ++joint.parent;
    out.joints.push_back(std::move(joint));
  }
  require_valid(out);
  return out;
}

Transform parse_pose(std::string_view text, const std::string& option) {
  const std::optional<std::vector<double>> numbers = parse_numbers(text);
  if (!numbers)
    throw Error(ErrorCode::InvalidArgument,
                option + ": expected numbers with commas between, as 0,0,0.8,0,0,1.57, not '" +
                    std::string(text) + "'");
  const std::vector<double>& x = *numbers;
  Transform out;
  if (x.size() != 3 && x.size() != 6 && x.size() != 7 && x.size() != 12)
    throw Error(ErrorCode::InvalidArgument,
                option + ": " + std::to_string(x.size()) +
                    " numbers; a pose is X,Y,Z, perhaps with ROLL,PITCH,YAW (radians), with "
                    "QX,QY,QZ,QW, or with nine of a matrix");
  out.translation = {x[0], x[1], x[2]};
  if (x.size() == 6) out.linear = rotation_from_rpy(x[3], x[4], x[5]);
  if (x.size() == 7) {
    const Eigen::Quaterniond turn(x[6], x[3], x[4], x[5]);
    if (!(std::abs(turn.norm() - 1) < 1e-3))
      throw Error(ErrorCode::InvalidArgument, option + ": the quaternion has the length " +
                                                  std::to_string(turn.norm()) + "; expected 1");
    out.linear = turn.normalized().toRotationMatrix();
  }
  if (x.size() == 12) {
    for (int i = 0; i < 9; ++i) out.linear(i / 3, i % 3) = x[3 + static_cast<std::size_t>(i)];
    const Mat3 defect = out.linear * out.linear.transpose() - Mat3::Identity();
    if (!(defect.cwiseAbs().maxCoeff() < 1e-12) || !(out.linear.determinant() > 0))
      throw Error(ErrorCode::InvalidArgument, option + ": the matrix is no rotation (to 1e-12)");
  }
  return out;
}

std::string base_pose_text(const Transform& pose) {
  std::string out;
  const auto append = [&](double value) {
    std::array<char, 32> text{};
    const std::to_chars_result end = std::to_chars(text.data(), text.data() + text.size(), value);
    if (!out.empty()) out += ',';
    out.append(text.data(), end.ptr);
  };
  for (int i = 0; i < 3; ++i) append(pose.translation[i]);
  for (int i = 0; i < 9; ++i) append(pose.linear(i / 3, i % 3));
  return out;
}

}  // namespace kaboum::robot
