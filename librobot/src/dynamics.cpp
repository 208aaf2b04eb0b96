// Masses and forces of a URDF: <http://wiki.ros.org/urdf/XML>. Meanings and defaults are those of
// urdfdom 3.0.

#include <kaboum/base/error.h>
#include <kaboum/robot/dynamics.h>

#include <Eigen/Geometry>
#include <cmath>

#include "link_elements.h"
#include "xml.h"

namespace kaboum::robot {
namespace {

using tinyxml2::XMLElement;

Transform read_pose(const XmlFile& file, const XMLElement& parent) {
  const XMLElement* e = file.only_child(parent, "origin");
  if (e == nullptr) return {};
  const Vec3 rpy = file.vector(*e, "rpy", Vec3::Zero());
  Transform out{rotation_from_rpy(rpy.x(), rpy.y(), rpy.z()), file.vector(*e, "xyz", Vec3::Zero())};
  if (e->Attribute("quat_xyzw") != nullptr) {
    const std::vector<double> x = file.numbers(*e, "quat_xyzw", 4);
    const Eigen::Quaterniond q(x[3], x[0], x[1], x[2]);
    if (!(q.norm() > 0) || !std::isfinite(q.norm())) file.fail(*e, "quat_xyzw is no rotation");
    out.linear = q.normalized().toRotationMatrix();
  }
  return out;
}

Inertial read_inertial(const XmlFile& file, const XMLElement& element) {
  Inertial out;
  out.origin = read_pose(file, element);
  const XMLElement* mass = file.only_child(element, "mass");
  if (mass == nullptr) file.fail(element, "no <mass value=...>");
  out.mass = file.number(*mass, "value");
  if (out.mass < 0) file.fail(*mass, "a mass below 0");
  const XMLElement* inertia = file.only_child(element, "inertia");
  if (inertia == nullptr) file.fail(element, "no <inertia ixx=... />");
  const auto entry = [&](const char* key) { return file.number(*inertia, key); };
  const double xy = entry("ixy"), xz = entry("ixz"), yz = entry("iyz");
  out.inertia << entry("ixx"), xy, xz, xy, entry("iyy"), yz, xz, yz, entry("izz");
  return out;
}

JointDynamics read_joint(const XmlFile& file, const XMLElement& element) {
  JointDynamics out;
  if (const XMLElement* limit = file.only_child(element, "limit"); limit != nullptr) {
    // 0 is written where nothing is known.
    const double effort = file.number(*limit, "effort", 0);
    if (effort > 0) out.effort = effort;
    out.lower = file.number(*limit, "lower", 0);
    out.upper = file.number(*limit, "upper", 0);
  }
  const char* type = element.Attribute("type");
  if (type != nullptr && std::string_view(type) == "continuous") out.lower = out.upper = {};
  if (const XMLElement* dynamics = file.only_child(element, "dynamics"); dynamics != nullptr) {
    out.damping = file.number(*dynamics, "damping", 0);
    out.friction = file.number(*dynamics, "friction", 0);
  }
  return out;
}

}  // namespace

LinkElements urdf_links(const tinyxml2::XMLDocument& document, const std::string& name) {
  const XmlFile file(name);
  LinkElements out;
  for (const auto* e = document.RootElement()->FirstChildElement("link"); e != nullptr;
       e = e->NextSiblingElement("link")) {
    const std::string link = file.text(*e, "name");
    if (!out.elements.emplace(link, e).second) file.fail(*e, "link '" + link + "' exists already");
    if (const XMLElement* inertial = file.only_child(*e, "inertial"); inertial != nullptr)
      out.inertials.emplace(link, read_inertial(file, *inertial));
  }
  return out;
}

Dynamics parse_dynamics(std::string_view text, const std::string& name) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  const XmlFile file(name);
  const XMLElement& root = *document.RootElement();
  Dynamics out;
  out.links = urdf_links(document, name).inertials;
  for (const auto* e = root.FirstChildElement("joint"); e != nullptr;
       e = e->NextSiblingElement("joint"))
    out.joints.emplace(file.text(*e, "name"), read_joint(file, *e));
  return out;
}

}  // namespace kaboum::robot
