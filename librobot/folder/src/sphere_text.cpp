// Spheres of robots in the formats of planners.
#include <kaboum/robot_folder/sphere_text.h>

#include <kaboum/geom/float32.h>

#include <filesystem>
#include <vector>

#include "collision_urdf.h"

namespace kaboum::robot_folder {
namespace {

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
    out += decimals(sphere.center, ", ");
    out += "]\n";
    out += indent;
    out += "    radius: ";
    out += decimal(sphere.radius);
    out += "\n";
  }
  return out;
}

std::string yaml_comment(const std::string& text) {
  std::string out = "# ";
  for (const char c : text) {
    out += c;
    if (c == '\n') out += "# ";
  }
  return out + "\n";
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
    one->SetAttribute("center", decimals(sphere.center, " ").c_str());
    one->SetAttribute("radius", decimal(sphere.radius).c_str());
  }
  return text_of(document);
}

std::string urdf_of(const robot::RobotFile& robot, const certify::CertifiedBodies& bodies,
                    const std::vector<LinkSphere>& spheres, const std::string& origin,
                    const std::string& file) {
  const auto add = [&](tinyxml2::XMLElement& link, std::uint32_t index) {
    for (const LinkSphere& sphere : spheres)
      if (sphere.link == index)
        add_collision(link, sphere.center, geom::Vec3::Zero())
            ->InsertNewChildElement("sphere")
            ->SetAttribute("radius", decimal(sphere.radius).c_str());
  };
  return urdf_with(robot, bodies, add, origin, file);
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
  const std::string origin = origin_of("Spheres", robot, parameters);
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
