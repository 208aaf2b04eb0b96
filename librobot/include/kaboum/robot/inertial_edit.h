#pragma once

#include <kaboum/robot/dynamics.h>

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::robot {

/// A document of a robot with other masses.
struct InertialEdit {
  std::string text;
  std::vector<std::string> missing;  ///< links without an element of their own: copies, the world
};

/// The URDF, MJCF or SDF with these inertials in the place of the links' own; all else stays. It is
/// read again: every link has the inertial that it is to have, to the bit.
/// @param name  of the file, for messages
/// @param inertials  by the names of links, as the readers of robots call them: "arm::hand",
/// "body1"
/// @throws Error{InvalidInput} on other documents, and naming the line where MJCF's compiler would
///   take masses from geoms all the same, or scale them (inertiafromgeom="true", settotalmass).
///   Error{OutputFailed} where a link of the new text has another inertial than it is to have.
InertialEdit with_inertials(std::string_view text, const std::string& name,
                            const std::map<std::string, Inertial>& inertials);

}  // namespace kaboum::robot
