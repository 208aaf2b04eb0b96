#pragma once

#include <string>
#include <string_view>

namespace kaboum::tools {

/// What an XML document describes, told by its root element and that one's children.
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

/// What to do with a document of this kind where a mesh is to come; empty for None.
std::string route_to_mesh(XmlKind kind, const std::string& path);

/// What to do with it where a robot is to come; empty for robots, and for None.
std::string route_to_robot(XmlKind kind);

}  // namespace kaboum::tools
