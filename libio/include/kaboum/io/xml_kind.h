#pragma once

#include <string>
#include <string_view>

namespace kaboum::io {

/// Kind of an XML document, told by its root element and that one's children.
enum class XmlKind {
  None,   ///< not XML, or damaged before its root
  Urdf,   ///< also one with xacro in it, which its parser names by line
  Xacro,  ///< a file of macros only
  Srdf,
  Sdf,
  Mjcf,
  RlRobot,  ///< the Robotics Library's rlkin or rlmdl
  RlScene,  ///< the Robotics Library's rlsg
  Other,
};
XmlKind xml_kind(std::string_view text);

/// "a robot or a world (SDF, Gazebo)"; empty for kinds that speak for themselves.
std::string describe(XmlKind kind);

/// Words for a file that is no robot and no scene: "XML with the root <svg>", "no XML: it begins
/// with 'solid cube'".
std::string describe_other(std::string_view text);

}  // namespace kaboum::io
