#include "collision_urdf.h"

#include <kaboum/base/error.h>
#include <kaboum/robot_folder/new_shapes.h>

#include <filesystem>
#include <iomanip>
#include <set>
#include <sstream>

namespace kaboum::robot_folder {
namespace {

namespace fs = std::filesystem;

constexpr int kDigits = 17;

/// Meshes that are drawn keep their files.
void move_references(tinyxml2::XMLElement& element, const fs::path& from, const fs::path& to) {
  for (tinyxml2::XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (const char* name = child->Attribute("filename");
        name != nullptr && std::string_view(child->Name()) == "mesh")
      child->SetAttribute("filename", moved_reference(std::string(name), from, to).c_str());
    move_references(*child, from, to);
  }
}

}  // namespace

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

bool has_capsules(const tinyxml2::XMLDocument& urdf) {
  const char* version = urdf.RootElement()->Attribute("version");
  return version != nullptr &&
         (version == std::string_view("1.1") || version == std::string_view("1.2"));
}

std::string decimal(double x) {
  std::ostringstream out;
  out << std::setprecision(kDigits) << x;
  return out.str();
}

std::string decimals(const geom::Vec3& p, const char* between) {
  return decimal(p.x()) + between + decimal(p.y()) + between + decimal(p.z());
}

std::string origin_of(const std::string& what, const robot::RobotFile& robot,
                      const std::string& parameters) {
  return what + " of the links of " + robot.path.filename().string() +
         ", in their frames. Each link's hold the link's shapes.\nbcd-decompose " +
         std::string(KABOUM_VERSION) + " " + parameters + "\nsha256 " + robot.sha256;
}

std::string comment_of_xml(const std::string& text) {
  std::string out = " ";
  for (const char c : text) {
    if (c == '-' && out.back() == '-') out += '\\';
    out += c;
  }
  return out + " ";
}

std::string text_of(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

tinyxml2::XMLElement* add_collision(tinyxml2::XMLElement& link, const geom::Vec3& xyz,
                                    const geom::Vec3& rpy) {
  tinyxml2::XMLElement* collision = link.InsertNewChildElement("collision");
  tinyxml2::XMLElement* origin = collision->InsertNewChildElement("origin");
  origin->SetAttribute("xyz", decimals(xyz).c_str());
  origin->SetAttribute("rpy", decimals(rpy).c_str());
  return collision->InsertNewChildElement("geometry");
}

std::string urdf_with(const robot::RobotFile& robot, const certify::CertifiedBodies& bodies,
                      const std::function<void(tinyxml2::XMLElement&, std::uint32_t)>& add,
                      const std::string& origin, const std::string& file) {
  tinyxml2::XMLDocument document;
  tinyxml2::XMLElement* root = nullptr;
  if (document.Parse(robot.text.data(), robot.text.size()) == tinyxml2::XML_SUCCESS)
    root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "robot")
    throw Error(ErrorCode::InvalidInput,
                robot.path.string() +
                    ": only a URDF can have such bodies as its shapes; spheres of other robots are "
                    "written as .yaml");
  move_references(*root, folder_of(robot.path), folder_of(file));
  std::set<std::uint32_t> held;
  for (const robot::LinkShape& shape : bodies.certificate().shapes) held.insert(shape.link);
  for (tinyxml2::XMLElement* link = root->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    const char* name = link->Attribute("name");
    const std::optional<std::uint32_t> index =
        name == nullptr ? std::nullopt : robot.robot.find_link(name);
    if (!index || !held.contains(*index)) continue;
    while (tinyxml2::XMLElement* old = link->FirstChildElement("collision")) link->DeleteChild(old);
    add(*link, *index);
  }
  root->InsertFirstChild(document.NewComment(comment_of_xml(origin).c_str()));
  return text_of(document);
}

}  // namespace kaboum::robot_folder
