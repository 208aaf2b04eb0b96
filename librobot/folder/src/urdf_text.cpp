// Where programs look for the meshes of a URDF.

#include <kaboum/robot_folder/urdf_text.h>
#include <tinyxml2.h>

#include <string_view>

namespace kaboum::robot_folder {

namespace {

/// Whether a mesh for drawing is named by package:// or another scheme, which MuJoCo knows none of.
bool draws_by_uri(const tinyxml2::XMLElement& robot) {
  using tinyxml2::XMLElement;
  for (const XMLElement* link = robot.FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link"))
    for (const XMLElement* visual = link->FirstChildElement("visual"); visual != nullptr;
         visual = visual->NextSiblingElement("visual")) {
      const XMLElement* geometry = visual->FirstChildElement("geometry");
      const XMLElement* mesh = geometry != nullptr ? geometry->FirstChildElement("mesh") : nullptr;
      const char* name = mesh != nullptr ? mesh->Attribute("filename") : nullptr;
      if (name != nullptr && std::string_view(name).find("://") != std::string_view::npos)
        return true;
    }
  return false;
}

}  // namespace

std::string with_slash(const std::string& prefix) {
  return prefix.empty() || prefix.ends_with('/') ? prefix : prefix + '/';
}

// MuJoCo's defaults for URDF are to leave out all folders of names (strippath), and to look in
// meshdir. Meshes are told apart by their names without folder and extension in any case.
bool let_mujoco_find_meshes(tinyxml2::XMLElement& robot) {
  tinyxml2::XMLElement* mujoco = robot.FirstChildElement("mujoco");
  if (mujoco == nullptr) {
    mujoco = robot.GetDocument()->NewElement("mujoco");
    robot.InsertFirstChild(mujoco);
  }
  tinyxml2::XMLElement* compiler = mujoco->FirstChildElement("compiler");
  if (compiler == nullptr) {
    compiler = robot.GetDocument()->NewElement("compiler");
    mujoco->InsertFirstChild(compiler);
  }
  compiler->SetAttribute("strippath", "false");
  for (const char* folder : {"meshdir", "assetdir"}) compiler->DeleteAttribute(folder);
  const char* discard = compiler->Attribute("discardvisual");
  if (discard == nullptr || std::string_view(discard) != "false" || !draws_by_uri(robot))
    return false;
  compiler->SetAttribute("discardvisual", "true");
  return true;
}

}  // namespace kaboum::robot_folder
