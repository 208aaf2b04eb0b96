#include <console_bridge/console.h>
#include <kaboum/geom/error.h>
#include <kaboum/sweep/robot.h>
#include <urdf_parser/urdf_parser.h>

#include <cmath>
#include <map>
#include <mutex>
#include <set>

#include "xml.h"

namespace kaboum::sweep {
namespace {

/// Keeps what urdfdom would print.
class Messages : public console_bridge::OutputHandler {
 public:
  void log(const std::string& text, console_bridge::LogLevel level, const char* /*file*/,
           int /*line*/) override {
    if (level >= console_bridge::CONSOLE_BRIDGE_LOG_ERROR && text_.size() < 500)
      text_ += (text_.empty() ? "" : "; ") + text;
  }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
};

/// Where the first link or joint begins whose name is in brackets in a text, as in urdfdom's
/// messages: "name:line: "; "name: " when none is.
std::string place_of(const std::string& text, const tinyxml2::XMLElement& root,
                     const std::string& name) {
  for (const auto* e = root.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    if (const char* id = e->Attribute("name");
        id != nullptr && text.find("[" + std::string(id) + "]") != std::string::npos)
      return name + ":" + std::to_string(e->GetLineNum()) + ": ";
  return name + ": ";
}

urdf::ModelInterfaceSharedPtr parse_by_urdfdom(std::string_view text,
                                               const tinyxml2::XMLElement& root,
                                               const std::string& name) {
  static std::mutex mutex;  // the output handler belongs to the process
  const std::lock_guard lock(mutex);
  Messages messages;
  console_bridge::OutputHandler* before = console_bridge::getOutputHandler();
  console_bridge::useOutputHandler(&messages);
  urdf::ModelInterfaceSharedPtr model;
  std::string thrown;
  try {
    model = urdf::parseURDF(std::string(text));
  } catch (const std::exception& error) {
    thrown = error.what();
  }
  console_bridge::useOutputHandler(before);
  if (model == nullptr || !thrown.empty() || !messages.text().empty()) {
    const std::string& what = thrown.empty() ? messages.text() : thrown;
    throw Error(ErrorCode::InvalidInput, place_of(what, root, name) + "not a valid URDF: " + what);
  }
  return model;
}

/// Rotations as quaternions, which urdfdom passes over.
void refuse_quaternions(const tinyxml2::XMLElement& element, const std::string& name) {
  if (element.Attribute("quat_xyzw") != nullptr)
    fail_at(name, element.GetLineNum(), "quat_xyzw is not supported: write the rotation as rpy");
  for (const auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    refuse_quaternions(*e, name);
}

/// What xacro would have expanded: urdfdom passes over its elements.
void refuse_xacro(const tinyxml2::XMLElement& element, const std::string& name) {
  const auto refuse = [&](const std::string& what) {
    fail_at(name, element.GetLineNum(),
            what + " is xacro that is not expanded; run: xacro " + name + " > robot.urdf");
  };
  const std::string tag = element.Name();
  if (tag.starts_with("xacro:")) refuse("<" + tag + ">");
  for (const auto* a = element.FirstAttribute(); a != nullptr; a = a->Next()) {
    const std::string value = a->Value();
    if (value.find("${") != std::string::npos || value.starts_with("$("))
      refuse(std::string(a->Name()) + "=\"" + value.substr(0, 60) + "\"");
  }
  for (const auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    refuse_xacro(*e, name);
}

/// What urdfdom tolerates or says nothing of.
void check_document(const tinyxml2::XMLDocument& xml, const std::string& name) {
  const tinyxml2::XMLElement& root = *xml.RootElement();
  if (std::string(root.Name()) != "robot")
    fail_at(name, root.GetLineNum(), std::string("expected <robot>, found <") + root.Name() + ">");
  refuse_xacro(root, name);
  refuse_quaternions(root, name);
  std::map<std::string, std::string> parent_joint;
  for (const auto* e = root.FirstChildElement("joint"); e != nullptr;
       e = e->NextSiblingElement("joint")) {
    const char* id = e->Attribute("name");
    const char* type = e->Attribute("type");
    const std::string joint = "joint '" + std::string(id != nullptr ? id : "") + "': ";
    if (type != nullptr && (std::string(type) == "planar" || std::string(type) == "floating"))
      fail_at(name, e->GetLineNum(), joint + "joints of type " + type + " are not supported");
    const auto* child = e->FirstChildElement("child");
    const char* link = child != nullptr ? child->Attribute("link") : nullptr;
    if (link == nullptr) continue;
    const auto [other, fresh] = parent_joint.emplace(link, id != nullptr ? id : "");
    if (!fresh)
      fail_at(name, e->GetLineNum(),
              joint + "link '" + link + "' is moved by joint '" + other->second + "' already");
  }
}

Vec3 vector_of(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

Transform transform_of(const urdf::Pose& pose) {
  const Eigen::Quaterniond q(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z);
  return {q.toRotationMatrix(), vector_of(pose.position)};
}

/// @param place  of the shape, for messages
Geometry geometry_of(const urdf::Pose& origin, const urdf::GeometrySharedPtr& shape, int line,
                     const std::string& place) {
  if (shape == nullptr) throw Error(ErrorCode::InvalidInput, place + "a shape without geometry");
  Geometry g;
  g.line = line;
  g.origin = transform_of(origin);
  switch (shape->type) {
    case urdf::Geometry::BOX:
      g.shape = Geometry::Shape::Box;
      g.size = vector_of(dynamic_cast<const urdf::Box&>(*shape).dim);
      break;
    case urdf::Geometry::SPHERE:
      g.shape = Geometry::Shape::Sphere;
      g.size = Vec3::Constant(dynamic_cast<const urdf::Sphere&>(*shape).radius);
      break;
    case urdf::Geometry::CYLINDER: {
      const auto& c = dynamic_cast<const urdf::Cylinder&>(*shape);
      g.shape = Geometry::Shape::Cylinder;
      g.size = {c.radius, c.length, c.length};
      break;
    }
    case urdf::Geometry::MESH: {
      const auto& m = dynamic_cast<const urdf::Mesh&>(*shape);
      g.shape = Geometry::Shape::Mesh;
      g.mesh = m.filename;
      g.size = vector_of(m.scale);
      if ((g.size.array() == 0).any())
        throw Error(ErrorCode::InvalidInput, place + "a mesh scaled by 0");
      return g;
    }
  }
  if ((g.size.array() < 0).any())
    throw Error(ErrorCode::InvalidInput, place + "a " + describe(g) + " whose size is negative");
  return g;
}

class Builder {
 public:
  Builder(const urdf::ModelInterface& model, const tinyxml2::XMLElement& root,
          const std::string& name)
      : model_(model), name_(name) {
    for (const auto* e = root.FirstChildElement("link"); e != nullptr;
         e = e->NextSiblingElement("link"))
      if (const char* id = e->Attribute("name"); id != nullptr) elements_.emplace(id, e);
  }

  Robot build() {
    robot_.name = model_.getName();
    if (model_.getRoot() == nullptr) fail("no root link");
    struct Entry {
      urdf::LinkConstSharedPtr link;
      urdf::JointConstSharedPtr joint;
      std::uint32_t parent;
    };
    std::vector<Entry> stack{{model_.getRoot(), nullptr, 0}};
    while (!stack.empty()) {
      const Entry entry = stack.back();
      stack.pop_back();
      const auto index = static_cast<std::uint32_t>(robot_.links.size());
      if (index >= model_.links_.size()) fail("the joints form a loop");
      add_link(*entry.link);
      if (entry.joint != nullptr) add_joint(*entry.joint, entry.parent);
      const auto& joints = entry.link->child_joints;
      for (std::size_t i = joints.size(); i-- > 0;) {
        const auto child = model_.getLink(joints[i]->child_link_name);
        if (child == nullptr) fail("joint '" + joints[i]->name + "' has no child link");
        stack.push_back({child, joints[i], index});
      }
    }
    if (robot_.links.size() != model_.links_.size())
      fail("some links are not connected to the root '" + robot_.links[0].name + "'");
    for (std::size_t j = 0; j < mimicry_.size(); ++j)
      if (mimicry_[j]) resolve(static_cast<std::uint32_t>(j));
    return std::move(robot_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::InvalidInput, name_ + ": " + what);
  }

  /// Of the <box>, <cylinder>, ... of a <collision> or <visual>; 0 when there is none.
  static int line_of_shape(const tinyxml2::XMLElement* element) {
    if (element == nullptr) return 0;
    const auto* geometry = element->FirstChildElement("geometry");
    const auto* shape = geometry != nullptr ? geometry->FirstChildElement() : nullptr;
    return (shape != nullptr ? shape : element)->GetLineNum();
  }

  void add_link(const urdf::Link& link) {
    Link out;
    out.name = link.name;
    const auto add = [&](const auto& shapes, const char* tag, std::vector<Geometry>& to) {
      const auto at = elements_.find(link.name);
      const tinyxml2::XMLElement* e =
          at != elements_.end() ? at->second->FirstChildElement(tag) : nullptr;
      for (const auto& shape : shapes) {
        const int line = line_of_shape(e);
        std::string place = name_;
        if (line > 0) place.append(":").append(std::to_string(line));
        place.append(": link '").append(link.name).append("': ");
        to.push_back(geometry_of(shape->origin, shape->geometry, line, place));
        if (e != nullptr) e = e->NextSiblingElement(tag);
      }
    };
    add(link.collision_array, "collision", out.collision);
    add(link.visual_array, "visual", out.visual);
    robot_.links.push_back(std::move(out));
  }

  void add_joint(const urdf::Joint& joint, std::uint32_t parent) {
    Joint out;
    out.name = joint.name;
    out.parent = parent;
    out.origin = transform_of(joint.parent_to_joint_origin_transform);
    by_name_[joint.name] = static_cast<std::uint32_t>(robot_.joints.size());
    mimicry_.emplace_back();
    switch (joint.type) {
      case urdf::Joint::FIXED:
        break;
      case urdf::Joint::REVOLUTE:
      case urdf::Joint::CONTINUOUS:
        out.type = JointType::Revolute;
        break;
      case urdf::Joint::PRISMATIC:
        out.type = JointType::Prismatic;
        break;
      default:
        fail("joint '" + joint.name + "': joints of this type are not supported");
    }
    if (out.type != JointType::Fixed) {
      const Vec3 axis = vector_of(joint.axis);
      const double length = axis.stableNorm();
      if (!(length > 0) || !std::isfinite(length))
        fail("joint '" + joint.name + "': the axis has no direction");
      out.axis = (axis / length).normalized();
      if (joint.mimic != nullptr) {
        mimicry_.back() = joint.mimic;
        out.multiplier = joint.mimic->multiplier;
        out.offset = joint.mimic->offset;
      } else {
        out.variable = static_cast<std::uint32_t>(robot_.variables.size());
        Variable variable{joint.name, {}, {}};
        if (joint.limits != nullptr && joint.type != urdf::Joint::CONTINUOUS) {
          variable.lower = joint.limits->lower;
          variable.upper = joint.limits->upper;
        }
        robot_.variables.push_back(std::move(variable));
      }
    }
    robot_.joints.push_back(std::move(out));
  }

  /// Follows a mimicking joint to the one that moves by itself.
  void resolve(std::uint32_t index) {
    Joint& joint = robot_.joints[index];
    std::set<std::uint32_t> seen{index};
    double multiplier = mimicry_[index]->multiplier, offset = mimicry_[index]->offset;
    std::string leader = mimicry_[index]->joint_name;
    for (;;) {
      const auto it = by_name_.find(leader);
      const std::string what = "joint '" + joint.name + "' mimics '" + leader + "'";
      if (it == by_name_.end()) fail(what + ", which does not exist");
      if (!seen.insert(it->second).second) fail(what + ": joints mimic one another in a circle");
      const Joint& other = robot_.joints[it->second];
      if (other.type == JointType::Fixed) fail(what + ", which is fixed");
      const auto& further = mimicry_[it->second];
      if (further == nullptr) {
        joint.variable = other.variable;
        joint.multiplier = multiplier;
        joint.offset = offset;
        return;
      }
      offset += multiplier * further->offset;
      multiplier *= further->multiplier;
      leader = further->joint_name;
    }
  }

  const urdf::ModelInterface& model_;
  const std::string& name_;
  std::map<std::string, const tinyxml2::XMLElement*> elements_;  // of the links
  Robot robot_;
  std::map<std::string, std::uint32_t> by_name_;
  std::vector<urdf::JointMimicSharedPtr> mimicry_;
};

}  // namespace

Robot parse_urdf(std::string_view text, const std::string& name) {
  // urdfdom's own XML reader recurses without limit and knows no lines: this one goes first.
  tinyxml2::XMLDocument xml;
  parse_xml(xml, text, name);
  check_document(xml, name);
  const urdf::ModelInterfaceSharedPtr model = parse_by_urdfdom(text, *xml.RootElement(), name);
  Robot robot = Builder(*model, *xml.RootElement(), name).build();
  try {
    require_valid(robot);
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what());
  }
  return robot;
}

}  // namespace kaboum::sweep
