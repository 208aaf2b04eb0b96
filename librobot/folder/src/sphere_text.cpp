// Spheres of robots in the formats of planners.
#include <kaboum/robot_folder/sphere_text.h>

#include <kaboum/base/error.h>
#include <kaboum/geom/float32.h>
#include <kaboum/robot_folder/new_shapes.h>
#include <tinyxml2.h>

#include <filesystem>
#include <functional>
#include <iomanip>
#include <set>
#include <sstream>

namespace kaboum::robot_folder {
namespace {

constexpr int kDigits = 17;  ///< so that readers of float32 and of float64 read the same number

struct LinkSphere {
  std::uint32_t link;
  geom::Vec3 center;
  double radius;
};

std::vector<LinkSphere> spheres_of(const certify::CertifiedBodies& bodies) {
  std::vector<LinkSphere> out;
  out.reserve(bodies.artefact().size());
  for (const robot::LinkBody& body : bodies.artefact()) {
    const geom::Vec3 center = geom::to_float32(body.points.at(0));
    const double wanted = (body.margin + (body.points[0] - center).norm()) * (1 + 1e-12);
    double radius = geom::to_float32(wanted);
    if (radius < wanted) radius += geom::float32_spacing(radius);
    out.push_back({body.link, center, radius});
  }
  return out;
}

std::string text_of(double x) {
  std::ostringstream out;
  out << std::setprecision(kDigits) << x;
  return out.str();
}

std::string text_of(const geom::Vec3& p, const char* between) {
  return text_of(p.x()) + between + text_of(p.y()) + between + text_of(p.z());
}

/// A name as YAML has it between quotes.
std::string quoted(const std::string& name) {
  std::string out = "\"";
  for (const char c : name) {
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

/// The list of spheres by link.
std::string yaml_of(const robot::RobotFile& robot, const std::vector<LinkSphere>& spheres,
                    const std::string& indent) {
  std::string out;
  std::size_t last = robot.robot.links.size();
  for (const LinkSphere& sphere : spheres) {
    if (sphere.link != last) {
      last = sphere.link;
      out += indent + quoted(robot.robot.links[last].name) + ":\n";
    }
    out += indent;
    out += "  - center: [";
    out += text_of(sphere.center, ", ");
    out += "]\n";
    out += indent;
    out += "    radius: ";
    out += text_of(sphere.radius);
    out += "\n";
  }
  return out;
}

std::string origin_of(const robot::RobotFile& robot, const std::string& parameters) {
  return "Spheres of the links of " + robot.path.filename().string() +
         ", in their frames. Each link's hold the link's shapes.\n" + "bcd-decompose " +
         std::string(KABOUM_VERSION) + " " + parameters + "\nsha256 " + robot.sha256;
}

std::string yaml_comment(const std::string& text) {
  std::string out = "# ";
  for (const char c : text) {
    out += c;
    if (c == '\n') out += "# ";
  }
  return out + "\n";
}

/// Two hyphens end comments of XML.
std::string comment_of_xml(std::string text) {
  for (std::size_t i = 1; i < text.size(); ++i)
    if (text[i] == '-' && text[i - 1] == '-') text[i] = '_';
  return " " + text + " ";
}

std::string text_of(const tinyxml2::XMLDocument& document) {
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

std::string srdf_of(const robot::RobotFile& robot, const std::vector<LinkSphere>& spheres,
                    const std::string& origin) {
  tinyxml2::XMLDocument document;
  document.InsertEndChild(document.NewDeclaration());
  document.InsertEndChild(document.NewComment(comment_of_xml(origin).c_str()));
  tinyxml2::XMLElement* root = document.NewElement("robot");
  root->SetAttribute("name", robot.robot.name.c_str());
  document.InsertEndChild(root);
  tinyxml2::XMLElement* link = nullptr;
  std::size_t last = robot.robot.links.size();
  for (const LinkSphere& sphere : spheres) {
    if (sphere.link != last) {
      last = sphere.link;
      link = root->InsertNewChildElement("link_sphere_approximation");
      link->SetAttribute("link", robot.robot.links[last].name.c_str());
    }
    tinyxml2::XMLElement* one = link->InsertNewChildElement("sphere");
    one->SetAttribute("center", text_of(sphere.center, " ").c_str());
    one->SetAttribute("radius", text_of(sphere.radius).c_str());
  }
  return text_of(document);
}

/// Meshes that are drawn keep their files.
void move_references(tinyxml2::XMLElement& element, const std::filesystem::path& from,
                     const std::filesystem::path& to) {
  for (tinyxml2::XMLElement* child = element.FirstChildElement(); child != nullptr;
       child = child->NextSiblingElement()) {
    if (const char* name = child->Attribute("filename");
        name != nullptr && std::string_view(child->Name()) == "mesh")
      child->SetAttribute("filename", moved_reference(std::string(name), from, to).c_str());
    move_references(*child, from, to);
  }
}

void set_collision(tinyxml2::XMLElement& link, std::uint32_t index,
                   const std::vector<LinkSphere>& spheres) {
  while (tinyxml2::XMLElement* old = link.FirstChildElement("collision")) link.DeleteChild(old);
  for (const LinkSphere& sphere : spheres) {
    if (sphere.link != index) continue;
    tinyxml2::XMLElement* collision = link.InsertNewChildElement("collision");
    tinyxml2::XMLElement* origin = collision->InsertNewChildElement("origin");
    origin->SetAttribute("xyz", text_of(sphere.center, " ").c_str());
    origin->SetAttribute("rpy", "0 0 0");
    collision->InsertNewChildElement("geometry")
        ->InsertNewChildElement("sphere")
        ->SetAttribute("radius", text_of(sphere.radius).c_str());
  }
}

std::string urdf_of(const robot::RobotFile& robot, const certify::CertifiedBodies& bodies,
                    const std::vector<LinkSphere>& spheres, const std::string& origin,
                    const std::string& file) {
  tinyxml2::XMLDocument document;
  tinyxml2::XMLElement* root = nullptr;
  if (document.Parse(robot.text.data(), robot.text.size()) == tinyxml2::XML_SUCCESS)
    root = document.RootElement();
  if (root == nullptr || std::string_view(root->Name()) != "robot")
    throw Error(ErrorCode::InvalidInput,
                robot.path.string() + ": only a URDF can have spheres as its shapes; write .yaml");
  namespace fs = std::filesystem;
  const auto folder_of = [](const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
  };
  move_references(*root, folder_of(robot.path), folder_of(file));
  std::set<std::uint32_t> held;
  for (const robot::LinkShape& shape : bodies.certificate().shapes) held.insert(shape.link);
  for (tinyxml2::XMLElement* link = root->FirstChildElement("link"); link != nullptr;
       link = link->NextSiblingElement("link")) {
    const char* name = link->Attribute("name");
    const std::optional<std::uint32_t> index =
        name == nullptr ? std::nullopt : robot.robot.find_link(name);
    if (index && held.contains(*index)) set_collision(*link, *index, spheres);
  }
  root->InsertFirstChild(document.NewComment(comment_of_xml(origin).c_str()));
  return text_of(document);
}

}  // namespace

std::optional<SphereFormat> sphere_format_of(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".yaml" || extension == ".yml") return SphereFormat::Curobo;
  if (extension == ".xrdf") return SphereFormat::Xrdf;
  if (extension == ".srdf") return SphereFormat::Srdf;
  if (extension == ".urdf") return SphereFormat::Urdf;
  return std::nullopt;
}

std::string sphere_text(SphereFormat format, const robot::RobotFile& robot,
                        const certify::CertifiedBodies& bodies, const std::string& parameters,
                        const std::string& file) {
  const std::vector<LinkSphere> spheres = spheres_of(bodies);
  const std::string origin = origin_of(robot, parameters);
  switch (format) {
    case SphereFormat::Srdf:
      return srdf_of(robot, spheres, origin);
    case SphereFormat::Urdf:
      return urdf_of(robot, bodies, spheres, origin, file);
    case SphereFormat::Xrdf:
      return "format: xrdf\nformat_version: 1.0\n" + yaml_comment(origin) +
             "collision:\n  geometry: spheres\nself_collision:\n  geometry: "
             "spheres\ngeometry:\n  spheres:\n    spheres:\n" +
             yaml_of(robot, spheres, "      ");
    case SphereFormat::Curobo:
      break;
  }
  return yaml_comment(origin) + "collision_spheres:\n" + yaml_of(robot, spheres, "  ");
}

}  // namespace kaboum::robot_folder
