// Where programs look for the meshes of a URDF.

#include "urdf_output.h"

namespace kaboum::tools {

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

}  // namespace kaboum::tools
