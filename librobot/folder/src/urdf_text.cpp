// Where programs look for the meshes of a URDF.

#include <kaboum/robot_folder/urdf_text.h>
#include <tinyxml2.h>

namespace kaboum::robot_folder {

std::string with_slash(const std::string& prefix) {
  return prefix.empty() || prefix.ends_with('/') ? prefix : prefix + '/';
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

}  // namespace kaboum::robot_folder
