// Writes MJCF, MuJoCo's format: <https://mujoco.readthedocs.io/en/2.2.2/XMLreference.html>.

#include <kaboum/base/error.h>
#include <kaboum/robot/kinematics.h>

#include <tinyxml2.h>
#include <map>

#include "model_words.h"

namespace kaboum::robot {
namespace {

using tinyxml2::XMLElement;

constexpr double kLeastMass = 1e-9;  ///< of bodies that have none [kg, kg·m²]
constexpr const char* kWorldBody = "world";

/// The value of a variable that its limits allow only one.
std::optional<double> locked_at(const Robot& robot, const Joint& joint) {
  if (joint.type == JointType::Fixed) return std::nullopt;
  const Variable& v = robot.variables[joint.variable];
  if (v.lower && v.upper && *v.lower == *v.upper) return v.lower;
  return std::nullopt;
}

class MjcfWriter {
 public:
  explicit MjcfWriter(const Model& model)
      : model_(model), robot_(model.robot), names_({kWorldBody}) {}

  ModelText write() {
    require_valid(robot_);
    XMLElement* root = document_.NewElement("mujoco");
    document_.InsertFirstChild(root);
    root->SetAttribute("model", robot_.name.empty() ? "robot" : robot_.name.c_str());
    compiler_ = root->InsertNewChildElement("compiler");
    compiler_->SetAttribute("angle", "radian");
    assets_ = root->InsertNewChildElement("asset");
    XMLElement* world = root->InsertNewChildElement("worldbody");
    contact_ = root->InsertNewChildElement("contact");
    equality_ = root->InsertNewChildElement("equality");
    name_bodies();
    bodies_.resize(robot_.links.size());
    bodies_[0] = body_names_[0] == kWorldBody ? world : add_body(*world, 0, {});
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) add_link(j);
    for (std::size_t l = 0; l < robot_.links.size(); ++l) add_shapes(l);
    keep_neighbours_apart();
    set_compiler();
    for (XMLElement* e : {assets_, contact_, equality_})
      if (e->NoChildren()) document_.DeleteNode(e);
    tinyxml2::XMLPrinter printer;
    document_.Print(&printer);
    return {printer.CStr(), std::move(notes_)};
  }

 private:
  /// A root without inertia that is called world is MuJoCo's own.
  void name_bodies() {
    for (const Link& link : robot_.links) {
      const bool world = body_names_.empty() && link.name == kWorldBody;
      body_names_.push_back(world ? kWorldBody : names_.give(link.name));
      if (body_names_.back() != link.name)
        notes_.push_back("Link '" + link.name + "' is body '" + body_names_.back() +
                         "' in MJCF, where the world has its name.");
    }
  }

  XMLElement* add_body(XMLElement& parent, std::size_t link, const Transform& pose) {
    XMLElement* body = parent.InsertNewChildElement("body");
    body->SetAttribute("name", body_names_[link].c_str());
    set_pose(*body, pose);
    const auto found = model_.dynamics.links.find(robot_.links[link].name);
    const auto inertial = found == model_.dynamics.links.end()
                              ? std::nullopt
                              : sound_inertial(found->first, found->second, notes_);
    if (inertial)
      add_inertial(*body, *inertial);
    else
      without_mass_.insert(link);
    return body;
  }

  static void set_pose(XMLElement& element, const Transform& pose) {
    if (is_identity(pose)) return;
    element.SetAttribute("pos", digits(pose.translation).c_str());
    const auto [w, x, y, z] = quaternion(pose.linear);
    element.SetAttribute("quat", digits({w, x, y, z}).c_str());
  }

  static void add_inertial(XMLElement& body, const Inertial& inertial) {
    const Mat3 i = inertial.origin.linear * inertial.inertia * inertial.origin.linear.transpose();
    XMLElement* e = body.InsertNewChildElement("inertial");
    e->SetAttribute("pos", digits(inertial.origin.translation).c_str());
    e->SetAttribute("mass", digits(inertial.mass).c_str());
    e->SetAttribute("fullinertia",
                    digits({i(0, 0), i(1, 1), i(2, 2), i(0, 1), i(0, 2), i(1, 2)}).c_str());
  }

  void add_link(std::size_t j) {
    const Joint& joint = robot_.joints[j];
    Transform pose = joint.origin;
    const auto locked = locked_at(robot_, joint);
    if (locked) {
      const double value = joint.multiplier * *locked + joint.offset;
      if (joint.type == JointType::Revolute)
        pose.linear = (pose.linear * rotation_about(joint.axis, value)).eval();
      else
        pose.translation += pose.linear * (value * joint.axis);
      notes_.push_back("Joint '" + joint.name + "' can take one value only, and is fixed in MJCF.");
    }
    bodies_[j + 1] = add_body(*bodies_[joint.parent], j + 1, pose);
    if (joint.type != JointType::Fixed && !locked) add_joint(*bodies_[j + 1], joint);
  }

  void add_joint(XMLElement& body, const Joint& joint) {
    XMLElement* e = body.InsertNewChildElement("joint");
    e->SetAttribute("name", joint.name.c_str());
    e->SetAttribute("type", joint.type == JointType::Revolute ? "hinge" : "slide");
    e->SetAttribute("axis", digits(joint.axis).c_str());
    const Joint& leader = leader_of(robot_, joint);
    const Variable& variable = robot_.variables[joint.variable];
    if (&leader == &joint && variable.lower && variable.upper) {
      e->SetAttribute("limited", "true");
      e->SetAttribute("range", digits({*variable.lower, *variable.upper}).c_str());
    }
    const auto found = model_.dynamics.joints.find(joint.name);
    if (found != model_.dynamics.joints.end()) {
      if (found->second.damping > 0)
        e->SetAttribute("damping", digits(found->second.damping).c_str());
      if (found->second.friction > 0)
        e->SetAttribute("frictionloss", digits(found->second.friction).c_str());
    }
    if (&leader == &joint) return;
    XMLElement* tie = equality_->InsertNewChildElement("joint");
    tie->SetAttribute("joint1", joint.name.c_str());
    tie->SetAttribute("joint2", leader.name.c_str());
    tie->SetAttribute("polycoef", digits({joint.offset, joint.multiplier, 0, 0, 0}).c_str());
  }

  void add_shapes(std::size_t l) {
    const Link& link = robot_.links[l];
    for (std::size_t i = 0; i < link.collision.size(); ++i) {
      const Geometry& g = link.collision[i];
      if (is_point(g)) continue;
      without_mass_.erase(l);
      XMLElement* e = bodies_[l]->InsertNewChildElement("geom");
      e->SetAttribute("name", geoms_.give(link.name + "_" + std::to_string(i)).c_str());
      set_pose(*e, g.origin);
      if (g.shape == Geometry::Shape::Mesh) {
        e->SetAttribute("type", "mesh");
        e->SetAttribute("mesh", mesh_of(g).c_str());
        continue;
      }
      const Vec3 size = solid_size(g);
      if (g.shape == Geometry::Shape::Box) {
        e->SetAttribute("type", "box");
        e->SetAttribute("size", digits((size / 2).eval()).c_str());
      } else if (g.shape == Geometry::Shape::Cylinder) {
        e->SetAttribute("type", "cylinder");
        e->SetAttribute("size", digits({size.x(), size.y() / 2}).c_str());
      } else if (g.shape == Geometry::Shape::Capsule) {
        e->SetAttribute("type", "capsule");
        e->SetAttribute("size", digits({size.x(), size.y() / 2}).c_str());
      } else if (g.shape == Geometry::Shape::Ellipsoid) {
        e->SetAttribute("type", "ellipsoid");
        e->SetAttribute("size", digits(size).c_str());
      } else {
        e->SetAttribute("type", "sphere");
        e->SetAttribute("size", digits({size.x()}).c_str());
      }
    }
  }

  /// The mesh of a file at a scale, once.
  std::string mesh_of(const Geometry& g) {
    const auto [at, fresh] = mesh_names_.try_emplace({g.mesh, digits(g.size)});
    if (!fresh) return at->second;
    const std::size_t slash = g.mesh.find_last_of('/');
    std::string stem = slash == std::string::npos ? g.mesh : g.mesh.substr(slash + 1);
    stem = stem.substr(0, stem.rfind('.'));
    at->second = meshes_.give(stem.empty() ? "mesh" : stem);
    XMLElement* e = assets_->InsertNewChildElement("mesh");
    e->SetAttribute("name", at->second.c_str());
    e->SetAttribute("file", g.mesh.c_str());
    if (g.size != Vec3::Ones()) e->SetAttribute("scale", digits(g.size).c_str());
    return at->second;
  }

  /// MuJoCo leaves out pairs that a joint joins, but for those of the part that stands still.
  void keep_neighbours_apart() {
    std::vector<std::size_t> part(robot_.links.size(), 0), parent(robot_.links.size(), 0);
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) {
      const Joint& joint = robot_.joints[j];
      const bool rigid = joint.type == JointType::Fixed || locked_at(robot_, joint);
      part[j + 1] = rigid ? part[joint.parent] : j + 1;
      parent[j + 1] = rigid ? parent[joint.parent] : part[joint.parent];
    }
    for (std::size_t still = 0; still < part.size(); ++still)
      for (std::size_t l = 0; l < part.size(); ++l) {
        if (part[still] != 0 || part[l] == 0 || parent[l] != 0) continue;
        if (robot_.links[still].collision.empty() || robot_.links[l].collision.empty()) continue;
        XMLElement* e = contact_->InsertNewChildElement("exclude");
        e->SetAttribute("body1", body_names_[still].c_str());
        e->SetAttribute("body2", body_names_[l].c_str());
      }
  }

  void set_compiler() {
    if (without_mass_.empty()) return;
    for (const char* bound : {"boundmass", "boundinertia"})
      compiler_->SetAttribute(bound, digits(kLeastMass).c_str());
  }

  const Model& model_;
  const Robot& robot_;
  tinyxml2::XMLDocument document_;
  XMLElement *compiler_ = nullptr, *assets_ = nullptr, *contact_ = nullptr, *equality_ = nullptr;
  UniqueNames names_, geoms_, meshes_;
  std::vector<std::string> body_names_, notes_;
  std::vector<XMLElement*> bodies_;
  std::map<std::pair<std::string, std::string>, std::string> mesh_names_;  // file, scale
  std::set<std::size_t> without_mass_;                                     // links
};

}  // namespace

ModelText to_mjcf(const Model& model) { return MjcfWriter(model).write(); }

}  // namespace kaboum::robot
