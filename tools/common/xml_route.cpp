// What to do with XML where a mesh is to come.

#include "xml_route.h"

namespace kaboum::tools {

std::string route_to_mesh(io::XmlKind kind, const std::string& path) {
  switch (kind) {
    case io::XmlKind::Urdf:
      return "a robot (URDF), not a mesh: bcd-decompose " + path +
             " -o FOLDER decomposes all its links (the name has to end with .urdf or .xml); other "
             "tools take its meshes one by one";
    case io::XmlKind::Xacro:
      return "xacro, not a mesh; bcd-decompose and bmesh-decimate take it as a robot where it is "
             "called NAME.xacro; other tools after: xacro " +
             path + " > robot.urdf";
    case io::XmlKind::Srdf:
      return describe(kind) + "; give the URDF that it belongs to";
    case io::XmlKind::Sdf:
    case io::XmlKind::Mjcf:
      return describe(kind) + ", not a mesh: bcd-decompose and bmesh-decimate take robots called " +
             "NAME.sdf or NAME.xml; other tools take the meshes one by one";
    case io::XmlKind::RlRobot:
      return "a robot of the Robotics Library (rlkin or rlmdl), not a mesh: sweep-approx and "
             "bound-verify sweep take it; other tools take its meshes one by one, the files "
             "beside it that are named like its links (link0.wrl)";
    case io::XmlKind::RlScene:
      return describe(kind) + "; give the mesh that it names by href";
    case io::XmlKind::Other:
      return "neither a robot nor a mesh: meshes in XML are .dae, .x3d and .3mf";
    case io::XmlKind::None:
      break;
  }
  return {};
}

}  // namespace kaboum::tools
