// A swept volume as a robot of one link.

#include "swept_urdf.h"

#include <kaboum/base/error.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/file_names.h>
#include <kaboum/robot_folder/urdf_text.h>
#include <tinyxml2.h>

#include "robots/urdf_output.h"

namespace kaboum::tools {

void write_swept_urdf(const std::filesystem::path& path, const geom::ConvexSet& set,
                      const std::string& prefix) {
  ensure(geom::margin_of(set) == 0.0, "a margin cannot be stated in URDF");
  std::filesystem::path folder = path;
  folder.replace_extension();
  const std::string name = folder.filename().string(), stem = io::plain_file_name(name);
  io::write_convex_set(folder, set, io::SetFormat::Directory, stem);
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  tinyxml2::XMLElement* robot = document.NewElement("robot");
  document.InsertEndChild(robot);
  robot->SetAttribute("name", name.c_str());
  robot_folder::let_mujoco_find_meshes(*robot);
  tinyxml2::XMLElement* link = robot->InsertNewChildElement("link");
  link->SetAttribute("name", "swept_volume");
  // Gazebo drops links without inertia. It has no other meaning: the link is static.
  tinyxml2::XMLElement* inertial = link->InsertNewChildElement("inertial");
  inertial->InsertNewChildElement("mass")->SetAttribute("value", 1);
  tinyxml2::XMLElement* inertia = inertial->InsertNewChildElement("inertia");
  for (const char* moment : {"ixx", "iyy", "izz"}) inertia->SetAttribute(moment, 1);
  for (const char* product : {"ixy", "ixz", "iyz"}) inertia->SetAttribute(product, 0);
  for (std::size_t i = 0; i < set.bodies.size(); ++i) {
    const std::string file = prefix + name + "/" + io::default_name(i, stem) + ".stl";
    for (const char* kind : {"visual", "collision"}) {
      tinyxml2::XMLElement* shape = link->InsertNewChildElement(kind);
      shape->SetAttribute("name", set.bodies[i].name.c_str());
      shape->InsertNewChildElement("geometry")
          ->InsertNewChildElement("mesh")
          ->SetAttribute("filename", file.c_str());
    }
  }
  robot->InsertNewChildElement("gazebo")->InsertNewChildElement("static")->SetText(true);
  tinyxml2::XMLPrinter out;
  document.Print(&out);
  io::write_file(path, std::string_view(out.CStr()));
}

}  // namespace kaboum::tools
