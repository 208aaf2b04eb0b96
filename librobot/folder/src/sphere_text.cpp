// Spheres of robots in the formats of planners.
#include <kaboum/robot_folder/sphere_text.h>

#include <kaboum/geom/float32.h>
#include <kaboum/robot/sphere_file.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <utility>
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

/// Names of the links that have spheres, in their order.
std::vector<std::string> links_of(const robot::RobotFile& robot,
                                  const std::vector<LinkSphere>& spheres) {
  std::vector<std::string> out;
  for (const LinkSphere& sphere : spheres) {
    const std::string& name = robot.robot.links[sphere.link].name;
    if (std::ranges::find(out, name) == out.end()) out.push_back(name);
  }
  return out;
}

/// The pairs of links that have spheres, each once, in the order of the links.
std::vector<UncheckedLinks> pairs_of(const std::vector<UncheckedLinks>& given,
                                     const std::vector<std::string>& links) {
  std::map<std::pair<std::ptrdiff_t, std::ptrdiff_t>, UncheckedLinks> out;
  for (const UncheckedLinks& pair : given) {
    const auto place = [&](const std::string& name) {
      return std::ranges::find(links, name) - links.begin();
    };
    const std::ptrdiff_t a = place(pair.a), b = place(pair.b);  // outlive what refers to them
    const auto [first, second] = std::minmax(a, b);
    if (second == std::ssize(links) || first == second) continue;
    out.try_emplace({first, second},
                    UncheckedLinks{links[static_cast<std::size_t>(first)],
                                   links[static_cast<std::size_t>(second)], pair.reason});
  }
  std::vector<UncheckedLinks> sorted;
  sorted.reserve(out.size());
  for (auto& [places, pair] : out) sorted.push_back(std::move(pair));
  return sorted;
}

/// Lists of links by link.
std::string yaml_of(const std::vector<UncheckedLinks>& pairs, const std::string& indent) {
  std::string out, last;
  for (const UncheckedLinks& pair : pairs) {
    out += pair.a != last || out.empty()
               ? (out.empty() ? "" : "]\n") + indent + quoted(pair.a) + ": ["
               : ", ";
    out += quoted(pair.b);
    last = pair.a;
  }
  return out.empty() ? out : out + "]\n";
}

/// A mapping that has 0 for each link.
std::string zeros_of(const std::vector<std::string>& links, const std::string& indent) {
  std::string out;
  for (const std::string& link : links) out += indent + quoted(link) + ": 0.0\n";
  return out;
}

/// A key and its mapping, which may be empty.
std::string mapping(const std::string& key, const std::string& entries) {
  return key + (entries.empty() ? ": {}\n" : ":\n" + entries);
}

std::string curobo_of(const robot::RobotFile& robot, const std::vector<LinkSphere>& spheres,
                      const std::vector<UncheckedLinks>& pairs) {
  const std::vector<std::string> links = links_of(robot, spheres);
  std::string names;
  for (const std::string& link : links) names += (names.empty() ? "" : ", ") + quoted(link);
  return "collision_link_names: [" + names + "]\ncollision_sphere_buffer: 0.0\n" +
         mapping("self_collision_buffer", zeros_of(links, "  ")) +
         mapping("self_collision_ignore", yaml_of(pairs, "  ")) +
         mapping("collision_spheres", yaml_of(robot, spheres, "  "));
}

std::string xrdf_of(const robot::RobotFile& robot, const std::vector<LinkSphere>& spheres,
                    const std::vector<UncheckedLinks>& pairs) {
  const std::string zeros =
      mapping("  buffer_distance", zeros_of(links_of(robot, spheres), "    "));
  return "collision:\n  geometry: spheres\n" + zeros + "self_collision:\n  geometry: spheres\n" +
         zeros + mapping("  ignore", yaml_of(pairs, "    ")) + "geometry:\n  spheres:\n" +
         mapping("    spheres", yaml_of(robot, spheres, "      "));
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
                    const std::vector<UncheckedLinks>& pairs, const std::string& origin) {
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
  for (const UncheckedLinks& pair : pairs) {
    tinyxml2::XMLElement* one = root->InsertNewChildElement("disable_collisions");
    one->SetAttribute("link1", pair.a.c_str());
    one->SetAttribute("link2", pair.b.c_str());
    if (!pair.reason.empty()) one->SetAttribute("reason", pair.reason.c_str());
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
                        const std::string& file, const std::vector<UncheckedLinks>& unchecked) {
  const std::vector<LinkSphere> spheres = spheres_of(bodies);
  const std::vector<UncheckedLinks> pairs = pairs_of(unchecked, links_of(robot, spheres));
  const std::string origin = origin_of("Spheres", robot, parameters);
  switch (format) {
    case SphereFormat::Srdf:
      return srdf_of(robot, spheres, pairs, origin);
    case SphereFormat::Urdf:
      return urdf_of(robot, bodies, spheres, origin, file);
    case SphereFormat::Xrdf:
      return "format: xrdf\nformat_version: 1.0\n" + yaml_comment(origin) +
             robot::sphere_count_comment(spheres.size()) + xrdf_of(robot, spheres, pairs);
    case SphereFormat::Curobo:
      break;
  }
  return yaml_comment(origin) + robot::sphere_count_comment(spheres.size()) +
         curobo_of(robot, spheres, pairs);
}

}  // namespace kaboum::robot_folder
