#pragma once

#include <kaboum/robot/model_text.h>
#include <kaboum/robot/primitive.h>

#include <array>
#include <initializer_list>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

// Numbers and names in files of robots. Internal to kaboum_robot.
namespace kaboum::robot {

/// As few digits as give the same number back.
std::string digits(double x);
/// With blanks between them.
std::string digits(std::initializer_list<double> numbers);
std::string digits(const Vec3& v);

/// A rotation as the quaternion (w, x, y, z), w not below 0.
std::array<double, 4> quaternion(const Mat3& rotation);

/// Whether a pose is no motion, to the bit.
bool is_identity(const Transform& pose);

/// Sizes of a box, cylinder or sphere that hold it and none of which is 0: what is flat is given
/// 0.5 % of its largest size. @pre it is no point.
Vec3 solid_size(const Geometry& geometry);

/// @param written     the robot as its edited text is read
/// @param original    whose links `primitives` counts
/// @throws Error{InvalidInput} naming a link whose collision shapes are others than its primitives
void require_primitives(const Robot& written, const Robot& original,
                        const std::map<std::size_t, std::vector<Primitive>>& primitives,
                        const std::string& name);

/// The inertial of a link as simulators take it: that of a body. Where one main moment is larger
/// than the sum of the others, all grow by what is missing.
/// @param notes  gets what is left out or changed
/// @return nothing where mass or inertia are not positive
std::optional<Inertial> sound_inertial(const std::string& link, const Inertial& inertial,
                                       std::vector<std::string>& notes);

/// The joint whose value a variable is; the others that it moves mimic that one.
const Joint& leader_of(const Robot& robot, const Joint& joint);

/// Names, none of them twice.
class UniqueNames {
 public:
  explicit UniqueNames(std::set<std::string> taken = {}) : taken_(std::move(taken)) {}
  /// The wish, or with the first of -2, -3 … that makes it new.
  std::string give(const std::string& wish);

 private:
  std::set<std::string> taken_;
};

}  // namespace kaboum::robot
