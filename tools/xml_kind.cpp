// Tells apart the kinds of XML that describe robots, to name the way from one that is not read.

#include "xml_kind.h"

#include <tinyxml2.h>

#include <algorithm>
#include <initializer_list>

namespace kaboum::tools {
namespace {

bool has_child(const tinyxml2::XMLElement& element, std::initializer_list<const char*> names) {
  return std::any_of(names.begin(), names.end(),
                     [&](const char* name) { return element.FirstChildElement(name) != nullptr; });
}

constexpr const char* kSdf = "SDF (Gazebo), which is not read";
constexpr const char* kMjcf = "MJCF (MuJoCo), which is not read";
constexpr const char* kSrdf =
    "SRDF (MoveIt): groups of joints and pairs that may collide, no shapes";
constexpr const char* kScene = "a scene of the Robotics Library (rlsg)";

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

std::string route_to_mesh(XmlKind kind, const std::string& path) {
  const std::string meshes = "; give the meshes that it names, or the robot as URDF";
  switch (kind) {
    case XmlKind::Urdf:
      return "a robot (URDF), not a mesh: bcd-decompose " + path +
             " -o FOLDER decomposes all its links (the name has to end with .urdf); other tools "
             "take its meshes one by one";
    case XmlKind::Xacro:
      return "xacro is not read; run: xacro " + path + " > robot.urdf";
    case XmlKind::Srdf:
      return std::string(kSrdf) + "; give the URDF that it belongs to";
    case XmlKind::Sdf:
      return kSdf + meshes;
    case XmlKind::Mjcf:
      return kMjcf + meshes;
    case XmlKind::RlRobot:
      return "a robot of the Robotics Library (rlkin or rlmdl), not a mesh: sweep-approx and "
             "bound-verify --sweep take it; other tools take its meshes one by one, the files "
             "beside it that are named like its links (link0.wrl)";
    case XmlKind::RlScene:
      return std::string(kScene) + "; give the mesh that it names by href";
    case XmlKind::Other:
      return "XML of a kind that is not known; meshes in XML are .dae, .x3d and .3mf";
    case XmlKind::None:
      break;
  }
  return {};
}

std::string route_to_robot(XmlKind kind) {
  const std::string urdf = "; give the robot as URDF, or as rlkin or rlmdl (Robotics Library)";
  switch (kind) {
    case XmlKind::Srdf:
      return std::string(kSrdf) + "; give the URDF that it belongs to";
    case XmlKind::Sdf:
      return kSdf + urdf;
    case XmlKind::Mjcf:
      return kMjcf + urdf;
    case XmlKind::RlScene:
      return std::string(kScene) + "; give the rlkin or rlmdl that moves it";
    case XmlKind::Other:
      return "XML of a kind that is not known" + urdf;
    case XmlKind::Urdf:
    case XmlKind::Xacro:  // its parser names the line
    case XmlKind::RlRobot:
    case XmlKind::None:
      break;
  }
  return {};
}

}  // namespace kaboum::tools
