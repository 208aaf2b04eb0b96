#pragma once

#include <kaboum/robot/robot.h>

#include <span>

namespace kaboum::robot {

/// Poses of all links relative to the root, in the order of robot.links.
/// @param q  values of robot.variables. [rad or length]
/// @throws Error{InvalidArgument} when there are more or fewer values than variables.
std::vector<Transform> forward(const Robot& robot, std::span<const double> q);

/// Geometric Jacobian of a point fixed to a link, 6 × #variables: rows 0–2 its velocity, rows 3–5
/// the link's angular velocity, both in the root's frame.
/// @param point  in the link's frame.
/// @throws as forward; Error{InvalidArgument} when there is no such link.
Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian(const Robot& robot, std::span<const double> q,
                                                  std::uint32_t link, const Vec3& point);

/// The first variable outside its limits; nullopt when all are within.
std::optional<std::uint32_t> find_out_of_limits(const Robot& robot, std::span<const double> q);

}  // namespace kaboum::robot
