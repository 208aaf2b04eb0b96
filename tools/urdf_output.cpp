// Where programs look for the meshes of a URDF.

#include "urdf_output.h"

#include <tinyxml2.h>

namespace kaboum::tools {

std::string with_slash(const std::string& prefix) {
  return prefix.empty() || prefix.ends_with('/') ? prefix : prefix + '/';
}

std::string how_meshes_are_found(const std::filesystem::path& urdf, const std::string& folder,
                                 const std::string& prefix) {
  std::string text = urdf.string() + " names its meshes ";
  if (prefix.empty())
    text += "relative to itself (" + folder +
            "/...), for Gazebo, MuJoCo and Bullet; RViz and MoveIt need --mesh-prefix "
            "package://PACKAGE/FOLDER";
  else
    text += prefix + folder + "/...: that is where they must be found" +
            (prefix.find("://") == std::string::npos
                 ? std::string()
                 : "; MuJoCo needs names without --mesh-prefix, relative to the URDF");
  return text;
}

// MuJoCo's defaults for URDF are to leave out all folders of names (strippath), and to look in
// meshdir. Meshes are told apart by their names without folder and extension in any case.
void let_mujoco_find_meshes(tinyxml2::XMLElement& robot) {
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
}

}  // namespace kaboum::tools
