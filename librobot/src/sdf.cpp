// Writes SDF 1.9, Gazebo's format: <http://sdformat.org/spec?ver=1.9>.

#include <kaboum/base/error.h>

#include <tinyxml2.h>
#include <map>

#include "model_words.h"

namespace kaboum::robot {
namespace {

using tinyxml2::XMLElement;

constexpr const char* kWorldFrame = "world";

XMLElement* add(XMLElement& parent, const char* tag, const std::string& text) {
  XMLElement* e = parent.InsertNewChildElement(tag);
  e->SetText(text.c_str());
  return e;
}

/// A pose in another frame than that of the element that it is in: nothing where it is none.
void add_pose(XMLElement& parent, const Transform& pose, const std::string& frame) {
  if (is_identity(pose) && frame.empty()) return;
  const auto [w, x, y, z] = quaternion(pose.linear);
  const Vec3& t = pose.translation;
  XMLElement* e = add(parent, "pose", digits({t.x(), t.y(), t.z(), x, y, z, w}));
  e->SetAttribute("rotation_format", "quat_xyzw");
  if (!frame.empty()) e->SetAttribute("relative_to", frame.c_str());
}

/// package://NAME/rest as model://NAME/rest, which Gazebo looks up, as for URDF.
std::string uri_of(const std::string& mesh) {
  constexpr std::string_view kPackage = "package://";
  return mesh.starts_with(kPackage) ? "model://" + mesh.substr(kPackage.size()) : mesh;
}

class SdfWriter {
 public:
  explicit SdfWriter(const Model& model)
      : model_(model), robot_(model.robot), names_({kWorldFrame}) {}

  ModelText write() {
    require_valid(robot_);
    XMLElement* root = document_.NewElement("sdf");
    document_.InsertFirstChild(root);
    root->SetAttribute("version", "1.9");
    XMLElement* model = root->InsertNewChildElement("model");
    model->SetAttribute("name", plain(robot_.name.empty() ? "robot" : robot_.name).c_str());
    name_all();
    for (std::size_t l = 0; l < robot_.links.size(); ++l)
      if (links_[l] != kWorldFrame) add_link(*model, l);
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) add_joint(*model, j);
    tinyxml2::XMLPrinter printer;
    document_.Print(&printer);
    return {printer.CStr(), std::move(notes_)};
  }

 private:
  /// Without what SDF keeps for itself: "::" separates names, "__NAME__" is built in.
  static std::string plain(std::string name) {
    for (std::size_t at = name.find("::"); at != std::string::npos; at = name.find("::")) {
      name.erase(at, 1);
      name[at] = '_';
    }
    if (name.size() >= 4 && name.starts_with("__") && name.ends_with("__")) name += "link";
    return name;
  }

  /// Links and joints of a model share one space of names.
  void name_all() {
    const auto named = [&](const char* kind, const std::string& wish) {
      std::string name = names_.give(plain(wish));
      if (name != wish)
        notes_.push_back(std::string(kind) + " '" + wish + "' is '" + name +
                         "' in SDF, which keeps such names for itself or has it already.");
      return name;
    };
    for (const Link& link : robot_.links) {
      const bool world = links_.empty() && link.name == kWorldFrame && link.collision.empty() &&
                         link.visual.empty();
      links_.push_back(world ? kWorldFrame : named("Link", link.name));
    }
    for (const Joint& joint : robot_.joints) joints_.push_back(named("Joint", joint.name));
  }

  void add_link(XMLElement& model, std::size_t l) {
    const Link& link = robot_.links[l];
    XMLElement* e = model.InsertNewChildElement("link");
    e->SetAttribute("name", links_[l].c_str());
    if (l > 0) add_pose(*e, {}, joints_[l - 1]);
    const auto found = model_.dynamics.links.find(link.name);
    if (found != model_.dynamics.links.end())
      if (const auto inertial = sound_inertial(link.name, found->second, notes_))
        add_inertial(*e, *inertial);
    add_shapes(*e, "collision", link.name, link.collision);
    add_shapes(*e, "visual", link.name, link.visual);
  }

  static void add_inertial(XMLElement& link, const Inertial& inertial) {
    XMLElement* e = link.InsertNewChildElement("inertial");
    add_pose(*e, inertial.origin, {});
    add(*e, "mass", digits(inertial.mass));
    XMLElement* i = e->InsertNewChildElement("inertia");
    const Mat3& m = inertial.inertia;
    for (const auto& [tag, value] :
         {std::pair{"ixx", m(0, 0)}, std::pair{"ixy", m(0, 1)}, std::pair{"ixz", m(0, 2)},
          std::pair{"iyy", m(1, 1)}, std::pair{"iyz", m(1, 2)}, std::pair{"izz", m(2, 2)}})
      add(*i, tag, digits(value));
  }

  static void add_shapes(XMLElement& link, const char* tag, const std::string& name,
                         const std::vector<Geometry>& shapes) {
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      if (is_point(shapes[i])) continue;
      XMLElement* e = link.InsertNewChildElement(tag);
      e->SetAttribute("name", (plain(name) + "_" + tag + "_" + std::to_string(i)).c_str());
      add_pose(*e, shapes[i].origin, {});
      add_geometry(*e->InsertNewChildElement("geometry"), shapes[i]);
    }
  }

  static void add_geometry(XMLElement& geometry, const Geometry& g) {
    if (g.shape == Geometry::Shape::Mesh) {
      XMLElement* mesh = geometry.InsertNewChildElement("mesh");
      add(*mesh, "uri", uri_of(g.mesh));
      if (g.size != Vec3::Ones()) add(*mesh, "scale", digits(g.size));
      return;
    }
    const Vec3 size = solid_size(g);
    if (g.shape == Geometry::Shape::Box) {
      add(*geometry.InsertNewChildElement("box"), "size", digits(size));
      return;
    }
    if (g.shape == Geometry::Shape::Ellipsoid) {
      add(*geometry.InsertNewChildElement("ellipsoid"), "radii", digits(size));
      return;
    }
    const bool sphere = g.shape == Geometry::Shape::Sphere;
    XMLElement* e =
        geometry.InsertNewChildElement(sphere                                 ? "sphere"
                                       : g.shape == Geometry::Shape::Cylinder ? "cylinder"
                                                                              : "capsule");
    add(*e, "radius", digits(size.x()));
    if (!sphere) add(*e, "length", digits(size.y()));
  }

  void add_joint(XMLElement& model, std::size_t j) {
    const Joint& joint = robot_.joints[j];
    const Variable* variable =
        joint.type == JointType::Fixed ? nullptr : &robot_.variables[joint.variable];
    const bool mimics = variable != nullptr && &leader_of(robot_, joint) != &joint;
    const bool endless =
        joint.type == JointType::Revolute && !mimics && !variable->lower && !variable->upper;
    XMLElement* e = model.InsertNewChildElement("joint");
    e->SetAttribute("name", joints_[j].c_str());
    e->SetAttribute("type", variable == nullptr                  ? "fixed"
                            : joint.type == JointType::Prismatic ? "prismatic"
                            : endless                            ? "continuous"
                                                                 : "revolute");
    // In the world's frame there is the model's own.
    const std::string& parent = links_[joint.parent];
    add_pose(*e, joint.origin, parent == kWorldFrame ? "__model__" : parent);
    add(*e, "parent", parent);
    add(*e, "child", links_[j + 1]);
    if (variable == nullptr) return;
    XMLElement* axis = e->InsertNewChildElement("axis");
    add(*axis, "xyz", digits(joint.axis));
    add_limits(*axis, joint, *variable, mimics);
    if (mimics)
      notes_.push_back("Joint '" + joint.name + "' mimics '" + variable->name +
                       "', which SDF 1.9 cannot say: it moves by itself there.");
  }

  void add_limits(XMLElement& axis, const Joint& joint, const Variable& variable,
                  bool mimics) const {
    XMLElement* limit = axis.InsertNewChildElement("limit");
    const auto found = model_.dynamics.joints.find(joint.name);
    const JointDynamics own =
        found == model_.dynamics.joints.end() ? JointDynamics{} : found->second;
    const std::optional<double> lower = mimics ? own.lower : variable.lower,
                                upper = mimics ? own.upper : variable.upper;
    if (lower) add(*limit, "lower", digits(*lower));
    if (upper) add(*limit, "upper", digits(*upper));
    if (own.effort) add(*limit, "effort", digits(*own.effort));
    if (!mimics && variable.velocity) add(*limit, "velocity", digits(*variable.velocity));
    if (limit->NoChildren()) axis.DeleteChild(limit);
    if (own.damping == 0 && own.friction == 0) return;
    XMLElement* dynamics = axis.InsertNewChildElement("dynamics");
    add(*dynamics, "damping", digits(own.damping));
    add(*dynamics, "friction", digits(own.friction));
  }

  const Model& model_;
  const Robot& robot_;
  tinyxml2::XMLDocument document_;
  UniqueNames names_;
  std::vector<std::string> links_, joints_, notes_;  // names in SDF, by index
};

}  // namespace

ModelText to_sdf(const Model& model) { return SdfWriter(model).write(); }

}  // namespace kaboum::robot
