#pragma once

#include <kaboum/robot/robot.h>

#include <string>
#include <string_view>

namespace kaboum::robot {

/// A robot that stands somewhere: a link `world` (`world_` where there is one of that name) becomes
/// its root, a fixed joint with the base's pose leads from it to what was the root before. Links'
/// numbers grow by one.
/// @throws Error{InvalidInput} when the pose is no rotation.
Robot placed(const Robot& robot, const Transform& base);

/// A pose of numbers, separated by commas: X,Y,Z or X,Y,Z,ROLL,PITCH,YAW (radians), or X,Y,Z and a
/// quaternion QX,QY,QZ,QW of length 1 (to 1e-3, as files print them; it is normalised), or X,Y,Z
/// and the matrix of the rotation, row by row.
/// @throws Error{InvalidArgument} naming `option`.
Transform parse_pose(std::string_view text, const std::string& option);

/// The pose as twelve numbers, which parse_pose reads back to the bit.
std::string base_pose_text(const Transform& pose);

}  // namespace kaboum::robot
