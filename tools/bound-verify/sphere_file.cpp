// Spheres of robots as others write them: cuRobo's YAML, XRDF, SRDF and URDF.
#include "sphere_file.h"

#include <kaboum/base/error.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/robot/sphere_approximation.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <sstream>

#ifdef KABOUM_HAS_YAML
#include <yaml-cpp/yaml.h>
#endif

namespace kaboum::tools {
namespace {

[[noreturn]] void fail(const std::string& file, int line, const std::string& what) {
  throw Error(ErrorCode::InvalidInput,
              file + (line > 0 ? ":" + std::to_string(line) : "") + ": " + what);
}

void add_ball(LinkSpheres& link, const geom::Vec3& center, double radius, const std::string& file,
              int line) {
  if (!center.allFinite() || !std::isfinite(radius))
    fail(file, line, "link '" + link.link + "': a number is not finite");
  if (!(radius > 0))
    fail(
        file, line,
        "link '" + link.link + "': a sphere's radius must be above 0; leave out what is no sphere");
  geom::ConvexBody body;
  body.name = "sphere_" + std::to_string(link.balls.bodies.size());
  body.core.vertices = {center};
  body.radius = radius;
  link.balls.bodies.push_back(std::move(body));
}

SphereFile read_urdf(const std::string& file) {
  const robot::RobotFile robot = robot::read_robot(file);
  SphereFile out{{}, "spheres of a URDF", {}};
  for (const robot::Link& link : robot.robot.links) {
    if (link.collision.empty()) continue;
    LinkSpheres one{link.name, link.collision.front().line, {}};
    for (const robot::Geometry& g : link.collision) {
      if (g.shape != robot::Geometry::Shape::Sphere)
        fail(file, g.line,
             "link '" + link.name + "': its collision shapes are to be spheres; this is a " +
                 robot::describe(g));
      add_ball(one, g.origin.translation, g.size.x(), file, g.line);
    }
    out.links.push_back(std::move(one));
  }
  if (out.links.empty()) fail(file, 0, "no link has a sphere as a collision shape");
  return out;
}

SphereFile read_srdf(const std::string& file, const std::string& text) {
  SphereFile out{{}, "spheres of an SRDF", {}};
  for (const robot::SphereApproximation& link : robot::parse_sphere_approximations(text, file)) {
    LinkSpheres one{link.link, link.line, {}};
    for (const robot::LinkSphere& sphere : link.spheres) {
      // As MoveIt reads it: the link has no shape.
      if (sphere.radius == 0 && link.spheres.size() == 1) continue;
      add_ball(one, sphere.center, sphere.radius, file, sphere.line);
    }
    out.links.push_back(std::move(one));
  }
  if (out.links.empty())
    fail(file, 0,
         "no spheres; as SRDF has them:\n  <link_sphere_approximation link=\"arm\">\n    <sphere "
         "center=\"0 0 0.1\" radius=\"0.05\"/>\n  </link_sphere_approximation>");
  return out;
}

#ifdef KABOUM_HAS_YAML

int line_of(const YAML::Node& node) { return node.Mark().line + 1; }

double number_of(const YAML::Node& node, const std::string& file, const std::string& what) {
  if (node.IsScalar()) {
    double value = 0;
    if (YAML::convert<double>::decode(node, value)) return value;
  }
  fail(file, line_of(node), what + " must be a number");
}

/// Spheres in YAML: cuRobo's, or XRDF.
class YamlFile {
 public:
  explicit YamlFile(const std::string& file) : file_(file) {}

  SphereFile read(const std::string& text) {
    std::vector<YAML::Node> documents;
    try {
      documents.push_back(YAML::Load(text));
    } catch (const YAML::Exception& error) {
      fail(file_, error.mark.line + 1, error.msg + " (is the file cut?)");
    }
    const YAML::Node root = documents[0];
    if (!root.IsMap()) fail(file_, 0, kForm);
    if (const YAML::Node format = root["format"];
        format && format.IsScalar() && format.Scalar() == "xrdf")
      return read_xrdf(root);
    YAML::Node kinematics = root;
    if (const YAML::Node config = root["robot_cfg"]; config && config.IsMap())
      if (const YAML::Node inner = config["kinematics"]; inner && inner.IsMap())
        kinematics.reset(inner);
    const YAML::Node spheres = kinematics["collision_spheres"];
    if (!spheres) fail(file_, 0, kForm);
    if (spheres.IsScalar())
      fail(file_, line_of(spheres),
           "the spheres are in another file, '" + spheres.Scalar() + "': name that one");
    if (!spheres.IsMap()) fail(file_, line_of(spheres), kForm);
    read_buffer(kinematics["collision_sphere_buffer"], "collision_sphere_buffer");
    SphereFile out{{}, "cuRobo YAML", {}};
    read_links(spheres, out);
    if (out.links.empty()) fail(file_, line_of(spheres), kForm);
    if (buffered_) out.notes.emplace_back("collision_sphere_buffer is added to the radii");
    return out;
  }

 private:
  static constexpr const char* kXrdfForm =
      "no spheres; as XRDF has them:\n  geometry:\n    name:\n      spheres:\n        link_name:\n "
      "  "
      "       - center: [0, 0, 0.1]\n            radius: 0.05\n  collision:\n    geometry: name";
  static constexpr const char* kForm =
      "no spheres; as cuRobo has them:\n  collision_spheres:\n    link_name:\n      - center: [0, "
      "0, 0.1]\n        radius: 0.05";

  /// The spheres of a link by its name.
  void read_links(const YAML::Node& spheres, SphereFile& out) const {
    std::set<std::string> names;
    for (const auto& entry : spheres) {
      LinkSpheres link{entry.first.Scalar(), line_of(entry.first), {}};
      if (!names.insert(link.link).second)
        fail(file_, link.line, "link '" + link.link + "' is there already");
      read_link(entry.second, link);
      out.links.push_back(std::move(link));
    }
  }

  /// The group of spheres that `collision` names, with its buffer_distance; without `collision`
  /// the only group that there is.
  SphereFile read_xrdf(const YAML::Node& root) {
    const YAML::Node version = root["format_version"];
    const double stated = version ? number_of(version, file_, "format_version")
                                  : std::numeric_limits<double>::quiet_NaN();
    if (!(stated >= 1 && stated < 3))
      fail(file_, version ? line_of(version) : 0, "XRDF of format_version 1.0 or 2.0 is read");
    const YAML::Node groups = root["geometry"];
    if (!groups || !groups.IsMap() || groups.size() == 0)
      fail(file_, groups ? line_of(groups) : 0, kXrdfForm);
    YAML::Node group = groups.begin()->second;
    const YAML::Node collision = root["collision"];
    if (collision) {
      const YAML::Node name = collision.IsMap() ? collision["geometry"] : YAML::Node();
      if (!collision.IsMap() || !name || !name.IsScalar())
        fail(file_, line_of(collision), "'collision' must name its geometry");
      const YAML::Node named = groups[name.Scalar()];
      if (!named) fail(file_, line_of(name), "there is no geometry '" + name.Scalar() + "'");
      group.reset(named);
      read_buffer(collision["buffer_distance"], "buffer_distance");
    } else if (groups.size() > 1) {
      fail(file_, line_of(groups), "'collision' must say which geometry is meant");
    }
    if (!group.IsMap()) fail(file_, line_of(groups), kXrdfForm);
    for (const auto& entry : group)
      if (entry.first.Scalar() != "spheres")
        fail(file_, line_of(entry.first),
             "a geometry of spheres is read, no '" + entry.first.Scalar() + "'");
    const YAML::Node spheres = group["spheres"];
    if (!spheres || !spheres.IsMap()) fail(file_, line_of(group), kXrdfForm);
    SphereFile out{{}, "XRDF", {}};
    read_links(spheres, out);
    if (out.links.empty()) fail(file_, line_of(spheres), kXrdfForm);
    if (buffered_) out.notes.emplace_back("collision's buffer_distance is added to the radii");
    if (root["modifiers"])
      out.notes.emplace_back(
          "its modifiers of the URDF are not applied: links are those of the robot");
    return out;
  }

  void read_buffer(const YAML::Node& node, const std::string& name) {
    if (!node || node.IsNull()) return;
    buffered_ = true;
    if (!node.IsMap()) {
      buffer_ = number_of(node, file_, name);
      return;
    }
    for (const auto& entry : node)
      of_link_[entry.first.Scalar()] = number_of(entry.second, file_, name);
  }

  void read_link(const YAML::Node& list, LinkSpheres& link) const {
    if (!list.IsSequence())
      fail(file_, line_of(list), "link '" + link.link + "': a list of spheres is expected");
    const auto own = of_link_.find(link.link);
    const double buffer = own == of_link_.end() ? buffer_ : own->second;
    for (const YAML::Node& sphere : list) {
      const int line = line_of(sphere);
      const YAML::Node center = sphere.IsMap() ? sphere["center"] : YAML::Node(),
                       radius = sphere.IsMap() ? sphere["radius"] : YAML::Node();
      if (!sphere.IsMap() || !center || !radius || !center.IsSequence() || center.size() != 3)
        fail(file_, line,
             "link '" + link.link + "': a sphere needs a center of three numbers and a radius");
      geom::Vec3 at;
      for (std::size_t k = 0; k < 3; ++k)
        at[static_cast<int>(k)] = number_of(center[k], file_, "a center's coordinate");
      const double stated = number_of(radius, file_, "a radius");
      if (!(stated > 0)) add_ball(link, at, stated, file_, line);
      add_ball(link, at, stated + buffer, file_, line);
    }
  }

  const std::string& file_;
  double buffer_ = 0;
  std::map<std::string, double> of_link_;
  bool buffered_ = false;
};

#endif

}  // namespace

SphereFile read_spheres(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  if (extension == ".urdf" || extension == ".xacro") return read_urdf(file);
  std::ifstream stream(file, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) throw Error(ErrorCode::InvalidInput, file + ": cannot be read");
  if (extension == ".srdf") return read_srdf(file, text.str());
  if (extension != ".yml" && extension != ".yaml" && extension != ".xrdf")
    fail(file, 0, "spheres are read from .yml and .yaml (cuRobo, XRDF), .xrdf, .srdf and .urdf");
#ifdef KABOUM_HAS_YAML
  return YamlFile(file).read(text.str());
#else
  throw Error(ErrorCode::NotBuilt, "--spheres: this build has no yaml-cpp to read " + file);
#endif
}

}  // namespace kaboum::tools
