// Tells apart the kinds of XML that describe robots.

#include <kaboum/io/xml_kind.h>
#include <tinyxml2.h>

#include <algorithm>
#include <initializer_list>

namespace kaboum::io {
namespace {

bool has_child(const tinyxml2::XMLElement& element, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(),
                     [&](const char* name) { return element.FirstChildElement(name) != nullptr; });
}

}  // namespace

XmlKind xml_kind(std::string_view text) {
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());  // where it is damaged, what comes before is kept
  const tinyxml2::XMLElement* root = document.RootElement();
  if (root == nullptr) return XmlKind::None;
  const std::string name = root->Name();
  if (name == "rlkin" || name == "rlmdl") return XmlKind::RlRobot;
  if (name == "rlsg") return XmlKind::RlScene;
  if (name == "sdf" || name == "gazebo" || name == "world") return XmlKind::Sdf;
  if (name == "mujoco" || name == "mujocoinclude") return XmlKind::Mjcf;
  if (name != "robot") return XmlKind::Other;
  if (has_child(*root, {"link", "joint"})) return XmlKind::Urdf;
  if (has_child(*root, {"xacro:macro", "xacro:include", "xacro:property", "xacro:arg"}))
    return XmlKind::Xacro;
  return has_child(*root,
                   {"group", "group_state", "disable_collisions", "disable_default_collisions",
                    "virtual_joint", "end_effector", "passive_joint"})
             ? XmlKind::Srdf
             : XmlKind::Urdf;
}

std::string describe(XmlKind kind) {
  switch (kind) {
    case XmlKind::Sdf:
      return "a robot or a world (SDF, Gazebo)";
    case XmlKind::Mjcf:
      return "a robot or a scene (MJCF, MuJoCo)";
    case XmlKind::Srdf:
      return "SRDF (MoveIt): groups of joints and pairs that may collide, no shapes";
    case XmlKind::RlScene:
      return "a scene of the Robotics Library (rlsg)";
    case XmlKind::Other:
      return "XML of a kind that is not known";
    case XmlKind::Urdf:
    case XmlKind::Xacro:
    case XmlKind::RlRobot:
    case XmlKind::None:
      break;
  }
  return {};
}

std::string describe_other(std::string_view text) {
  tinyxml2::XMLDocument document;
  document.Parse(text.data(), text.size());
  if (const tinyxml2::XMLElement* root = document.RootElement(); root != nullptr)
    return "XML with the root <" + std::string(root->Name()).substr(0, 40) + ">";
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  const std::size_t first = text.find_first_not_of(" \t\r\n");
  if (first == std::string_view::npos) return "no XML: it is empty";
  text.remove_prefix(first);
  if (text.starts_with('<')) return "XML that is damaged before its first element";
  std::string begin;
  for (const char c : text.substr(0, 20)) begin += c >= ' ' && c <= '~' ? c : '?';
  return "no XML: it begins with '" + begin + "'";
}

}  // namespace kaboum::io
