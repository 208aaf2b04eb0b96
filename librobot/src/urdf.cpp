// Reads URDF 1.0, 1.1 and 1.2, the robot descriptions of ROS: <http://wiki.ros.org/urdf/XML>.
// Meanings and defaults are those of urdfdom 3.0, the reader of ROS, and of urdfdom 6.0 for what is
// new in 1.1 (capsules, quat_xyzw) and 1.2 (limits), which is laxer in places (two origins, two
// shapes in a geometry: it takes the first) and stricter in others (inertia and materials, which
// this reader does not look at). tests/engines compares the two.

#include <kaboum/base/error.h>
#include <kaboum/robot/robot.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "xml.h"

namespace kaboum::robot {
namespace {

using tinyxml2::XMLElement;

/// Rotations as quaternions, which URDF 1.0 does not have; its readers pass over them.
void refuse_quaternions(const XMLElement& element, const std::string& name) {
  if (element.Attribute("quat_xyzw") != nullptr)
    fail_at(
        name, element.GetLineNum(),
        "quat_xyzw is of URDF 1.1: state <robot version=\"1.1\">, or write the rotation as rpy");
  for (const auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    refuse_quaternions(*e, name);
}

/// What xacro would have expanded.
void refuse_xacro(const XMLElement& element, const std::string& name) {
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

/// Whether an element, or one below it, has a name of what makes links and shapes, whatever its
/// case.
bool holds_shapes(const XMLElement& element) {
  std::string tag = element.Name();
  std::transform(tag.begin(), tag.end(), tag.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  for (const char* kind : {"link", "joint", "collision", "visual", "geometry", "mesh", "include"})
    if (tag == kind || tag.ends_with(std::string(":") + kind)) return true;
  for (const auto* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
    if (holds_shapes(*e)) return true;
  return false;
}

/// Elements that readers pass over, and the shapes in them with it. Extensions for simulators
/// (<gazebo>, <transmission>, <sensor> ...) describe no shapes of the robot; those of
/// <self_collision_checking> stand for a link's collision shapes among links, those of
/// <self_filter> for what is taken out of sensors' points, and no reader of URDF takes them.
void refuse_unread(const XMLElement& parent, std::initializer_list<std::string_view> read,
                   const std::string& name) {
  for (const auto* e = parent.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    const std::string_view tag = e->Name();
    if (std::find(read.begin(), read.end(), tag) != read.end()) continue;
    if (tag == "gazebo" || tag == "transmission" || tag == "sensor" || tag == "ros2_control" ||
        tag == "self_collision_checking" || tag == "self_filter")
      continue;
    if (holds_shapes(*e))
      fail_at(name, e->GetLineNum(),
              std::string(parent.Name()).insert(0, "> in <").insert(0, tag).insert(0, "<") +
                  "> is no element of URDF, and readers leave out what is in it: links and shapes "
                  "would be lost");
  }
}

struct Mimicry {
  std::string leader;
  double multiplier, offset;
};

/// A joint as its element states it.
struct JointEntry {
  Joint joint;
  std::string parent, child;
  Variable variable;
  std::optional<Mimicry> mimicry;
  int line;
  bool unmodelled = false;  ///< planar or floating: fixed here
  bool unlimited = false;   ///< revolute or prismatic, without <limit>
};

/// Links and joints of a document, one element at a time.
class Elements {
 public:
  /// @param minor  of the version: 1.0, 1.1 or 1.2
  Elements(const std::string& name, int minor) : name_(name), file_(name), minor_(minor) {}

  void read(const XMLElement& root) {
    refuse_unread(root, {"link", "joint"}, name_);
    for (const auto* e = root.FirstChildElement("link"); e != nullptr;
         e = e->NextSiblingElement("link")) {
      const std::string link = file_.text(*e, "name");
      if (!links.emplace(link, read_link(*e, link)).second)
        fail_at(name_, e->GetLineNum(), "link '" + link + "' exists already");
    }
    for (const auto* e = root.FirstChildElement("joint"); e != nullptr;
         e = e->NextSiblingElement("joint")) {
      JointEntry entry = read_joint(*e);
      const std::string joint = entry.joint.name;
      if (!joints.emplace(joint, std::move(entry)).second)
        fail_at(name_, e->GetLineNum(), "joint '" + joint + "' exists already");
    }
  }

  std::map<std::string, Link> links;         ///< by name
  std::vector<std::string> notes;            ///< of what readers leave out
  std::map<std::string, JointEntry> joints;  ///< by name

 private:
  /// Roll, pitch and yaw become a quaternion, and that a matrix, as in urdfdom: the same bits.
  [[nodiscard]] Transform read_origin(const XMLElement& parent) const {
    const XMLElement* e = file_.only_child(parent, "origin");
    if (e == nullptr) return {};
    if (e->Attribute("quat_xyzw") != nullptr) return read_quaternion(*e);
    const Vec3 half = file_.vector(*e, "rpy", Vec3::Zero()) / 2;
    const Vec3 s = half.array().sin(), c = half.array().cos();
    Eigen::Quaterniond q(c[0] * c[1] * c[2] + s[0] * s[1] * s[2],   // w
                         s[0] * c[1] * c[2] - c[0] * s[1] * s[2],   // x
                         c[0] * s[1] * c[2] + s[0] * c[1] * s[2],   // y
                         c[0] * c[1] * s[2] - s[0] * s[1] * c[2]);  // z
    const double norm = std::sqrt(q.x() * q.x() + q.y() * q.y() + q.z() * q.z() + q.w() * q.w());
    q.coeffs() /= norm;
    return {q.toRotationMatrix(), file_.vector(*e, "xyz", Vec3::Zero())};
  }

  [[nodiscard]] Transform read_quaternion(const XMLElement& e) const {
    if (e.Attribute("rpy") != nullptr) file_.fail(e, "both rpy and quat_xyzw: give one of them");
    const std::vector<double> x = file_.numbers(e, "quat_xyzw", 4);
    Eigen::Quaterniond q(x[3], x[0], x[1], x[2]);
    const double norm = q.coeffs().stableNorm();
    if (!(norm > 0) || !std::isfinite(norm)) file_.fail(e, "quat_xyzw is no rotation");
    q.coeffs() /= norm;
    q.normalize();
    return {q.toRotationMatrix(), file_.vector(e, "xyz", Vec3::Zero())};
  }

  /// Of a mesh. One number scales all axes, as Drake has it; urdfdom passes over such a shape.
  [[nodiscard]] Vec3 scale_of(const XMLElement& mesh) const {
    const char* text = mesh.Attribute("scale");
    if (const auto x = finite_numbers(text != nullptr ? text : "1"); x && x->size() == 1)
      return Vec3::Constant(x->front());
    return file_.vector(mesh, "scale");
  }

  /// Drake's mark of a mesh that is convex, in or beside it.
  static bool is_mark(const XMLElement& e) {
    return std::string_view(e.Name()) == "drake:declare_convex" && e.NoChildren();
  }

  /// The next shape from an element of <geometry> on.
  static const XMLElement* shape_from(const XMLElement* e) {
    while (e != nullptr && is_mark(*e)) e = e->NextSiblingElement();
    return e;
  }

  /// What is wrong with a <collision> or <visual> whose <geometry> has two shapes: readers take the
  /// first. Empty: it has not.
  [[nodiscard]] std::string second_shape(const XMLElement& shape, const std::string& link) const {
    const XMLElement* geometry = shape.FirstChildElement("geometry");
    const XMLElement* first =
        geometry != nullptr ? shape_from(geometry->FirstChildElement()) : nullptr;
    const XMLElement* second = first != nullptr ? shape_from(first->NextSiblingElement()) : nullptr;
    if (second == nullptr) return {};
    return name_ + ":" + std::to_string(second->GetLineNum()) + ": link '" + link +
           "': a second shape in one <geometry>: give it a <" + shape.Name() + "> of its own";
  }

  [[nodiscard]] Geometry read_geometry(const XMLElement& shape, const std::string& link) const {
    const XMLElement* geometry = file_.only_child(shape, "geometry");
    const XMLElement* e = geometry != nullptr ? shape_from(geometry->FirstChildElement()) : nullptr;
    const std::string place = "link '" + link + "': ";
    if (e == nullptr)
      fail_at(name_, shape.GetLineNum(), place + "a <" + shape.Name() + "> without geometry");
    const XMLElement* inside = e->FirstChildElement();
    if (inside != nullptr && !is_mark(*inside))
      fail_at(name_, inside->GetLineNum(),
              place + "<" + inside->Name() + "> in <" + e->Name() +
                  "> means nothing: an <origin> belongs beside <geometry>");
    Geometry g;
    g.line = e->GetLineNum();
    g.origin = read_origin(shape);
    const std::string kind = e->Name();
    if (kind == "box") {
      g.shape = Geometry::Shape::Box;
      g.size = file_.vector(*e, "size");
    } else if (kind == "sphere") {
      g.shape = Geometry::Shape::Sphere;
      g.size = Vec3::Constant(file_.number(*e, "radius"));
    } else if (kind == "cylinder") {
      const double length = file_.number(*e, "length");
      g.shape = Geometry::Shape::Cylinder;
      g.size = {file_.number(*e, "radius"), length, length};
    } else if (kind == "capsule" && minor_ >= 1) {
      const double length = file_.number(*e, "length"), radius = file_.number(*e, "radius");
      g.shape = length == 0 ? Geometry::Shape::Sphere : Geometry::Shape::Capsule;
      g.size = {radius, length, length};
      if (length == 0) g.size = Vec3::Constant(radius);
    } else if (kind == "capsule") {
      file_.fail(*e, place + "capsules are of URDF 1.1: state <robot version=\"1.1\">");
    } else if (kind == "mesh") {
      g.shape = Geometry::Shape::Mesh;
      g.mesh = file_.text(*e, "filename");
      g.size = scale_of(*e);
      if ((g.size.array() == 0).any()) fail_at(name_, g.line, place + "a mesh scaled by 0");
      return g;
    } else {
      fail_at(name_, g.line,
              place + "a shape of kind <" + kind +
                  ">; supported are box, cylinder, sphere, capsule and mesh");
    }
    if ((g.size.array() < 0).any())
      fail_at(name_, g.line, place + "a " + describe(g) + " whose size is negative");
    return g;
  }

  [[nodiscard]] Link read_link(const XMLElement& element, const std::string& link) {
    refuse_unread(element, {"collision", "visual"}, name_);
    Link out;
    out.name = link;
    for (const auto& [tag, to] :
         {std::pair{"collision", &out.collision}, std::pair{"visual", &out.visual}})
      for (const auto* e = element.FirstChildElement(tag); e != nullptr;
           e = e->NextSiblingElement(tag)) {
        to->push_back(read_geometry(*e, link));
        const std::string wrong = second_shape(*e, link);
        if (wrong.empty()) continue;
        if (to == &out.collision) throw Error(ErrorCode::InvalidInput, wrong);
        out.unread.push_back({true, "a second shape in one <geometry>", wrong});
        notes.push_back(wrong + "; readers take the first, and it is not looked at here");
      }
    return out;
  }

  [[nodiscard]] JointEntry read_joint(const XMLElement& e) const {
    JointEntry out;
    out.line = e.GetLineNum();
    out.joint.name = out.variable.name = file_.text(e, "name");
    const auto fail = [&](const std::string& what) {
      fail_at(name_, out.line, "joint '" + out.joint.name + "': " + what);
    };
    for (const auto& [tag, to] :
         {std::pair{"parent", &out.parent}, std::pair{"child", &out.child}}) {
      const XMLElement* end = file_.only_child(e, tag);
      if (end == nullptr) fail(std::string("no <") + tag + " link=...>");
      *to = file_.text(*end, "link");
    }
    out.joint.origin = read_origin(e);
    const std::string type = file_.text(e, "type");
    if (type == "revolute" || type == "continuous") {
      out.joint.type = JointType::Revolute;
    } else if (type == "prismatic") {
      out.joint.type = JointType::Prismatic;
    } else if (type == "planar" || type == "floating") {
      out.unmodelled = true;
    } else if (type != "fixed") {
      fail("joints of type " + type + " are not supported");
    }
    if (out.joint.type == JointType::Fixed) return out;

    const XMLElement* axis = file_.only_child(e, "axis");
    const Vec3 direction = axis != nullptr ? file_.vector(*axis, "xyz") : Vec3::UnitX();
    const double length = direction.stableNorm();
    if (!(length > 0) || !std::isfinite(length)) fail("the axis has no direction");
    out.joint.axis = (direction / length).normalized();
    if (const XMLElement* limit = file_.only_child(e, "limit"); limit != nullptr) {
      const bool stated =
          limit->Attribute("lower") != nullptr && limit->Attribute("upper") != nullptr;
      const double lower = file_.number(*limit, "lower", 0),
                   upper = file_.number(*limit, "upper", 0);
      if (minor_ >= 2 && type != "continuous" && !stated)
        file_.fail(*limit, "joint '" + out.joint.name + "': URDF 1.2 wants both lower and upper");
      if (type != "continuous") {
        out.variable.lower = lower;
        out.variable.upper = upper;
      } else if (minor_ >= 2) {  // where they are stated
        if (limit->Attribute("lower") != nullptr) out.variable.lower = lower;
        if (limit->Attribute("upper") != nullptr) out.variable.upper = upper;
      }
      // 0 is written where nothing is known.
      const double velocity = file_.number(*limit, "velocity", 0);
      if (velocity > 0) out.variable.velocity = velocity;
    } else if (type != "continuous") {
      if (minor_ >= 2) fail("URDF 1.2 wants <limit lower=... upper=.../>");
      out.unlimited = true;
    }
    if (const XMLElement* mimic = file_.only_child(e, "mimic"); mimic != nullptr)
      out.mimicry = Mimicry{file_.text(*mimic, "joint"), file_.number(*mimic, "multiplier", 1),
                            file_.number(*mimic, "offset", 0)};
    return out;
  }

  const std::string& name_;
  XmlFile file_;
  int minor_;
};

/// The minor number of the version of URDF: 0, 1 or 2.
int minor_version(const XMLElement& root, const XmlFile& file) {
  if (root.Attribute("version") == nullptr) return 0;
  const double version = file.number(root, "version");
  for (const int minor : {0, 1, 2})
    if (version == (10 + minor) / 10.0) return minor;
  file.fail(root, "URDF " + file.text(root, "version") + " is not known; 1.0, 1.1 and 1.2 are");
}

/// Puts links and joints in order: from the root on, depth first.
class Assembly {
 public:
  Assembly(Elements elements, const std::string& name)
      : elements_(std::move(elements)), name_(name) {
    robot_.notes = std::move(elements_.notes);
    imply_world();
    for (const auto& named : elements_.joints) {
      const JointEntry& entry = named.second;
      const auto require = [&](const std::string& link, const char* role) {
        if (!elements_.links.contains(link))
          fail(entry, std::string("its ") + role + " link '" + link + "' does not exist");
      };
      require(entry.parent, "parent");
      require(entry.child, "child");
      const auto [other, fresh] = moved_by_.emplace(entry.child, &entry);
      if (!fresh) {
        // The later of the two in the file.
        const JointEntry& first = entry.line < other->second->line ? entry : *other->second;
        const JointEntry& second = entry.line < other->second->line ? *other->second : entry;
        fail(second,
             "link '" + entry.child + "' is moved by joint '" + first.joint.name + "' already");
      }
      children_[entry.parent].push_back(&entry);
    }
  }

  Robot build() {
    struct Step {
      const std::string* link;
      const JointEntry* joint;
      std::uint32_t parent;
    };
    const std::string& root = find_root();
    std::vector<Step> stack{{&root, nullptr, 0}};
    while (!stack.empty()) {
      const Step step = stack.back();
      stack.pop_back();
      const auto index = static_cast<std::uint32_t>(robot_.links.size());
      robot_.links.push_back(std::move(elements_.links.at(*step.link)));
      if (step.joint != nullptr) add_joint(*step.joint, step.parent);
      const std::vector<const JointEntry*>& joints = children_[*step.link];
      for (std::size_t i = joints.size(); i-- > 0;)
        stack.push_back({&joints[i]->child, joints[i], index});
    }
    if (robot_.links.size() != elements_.links.size())
      fail("some links are not connected to the root '" + root +
           "': their joints lead in a circle");
    for (std::size_t j = 0; j < order_.size(); ++j)
      if (order_[j]->mimicry) follow(j);
    return std::move(robot_);
  }

 private:
  /// A joint may fix a robot to a link `world` that the file does not have: Drake's own.
  void imply_world() {
    for (const auto& [name, entry] : elements_.joints) {
      if (entry.parent != "world" || elements_.links.contains("world")) continue;
      elements_.links["world"].name = "world";
      robot_.notes.push_back(name_ + ":" + std::to_string(entry.line) + ": joint '" + name +
                             "' begins at link 'world', which the file does not have; Drake has a "
                             "world of that name, other readers refuse the robot");
    }
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::InvalidInput, name_ + ": " + what);
  }
  [[noreturn]] void fail(const JointEntry& entry, const std::string& what) const {
    fail_at(name_, entry.line, "joint '" + entry.joint.name + "': " + what);
  }

  /// The one link that no joint moves.
  [[nodiscard]] const std::string& find_root() const {
    const std::string* root = nullptr;
    for (const auto& [link, unused] : elements_.links) {
      if (moved_by_.contains(link)) continue;
      if (root != nullptr)
        fail("two root links, '" + *root + "' and '" + link + "': connect them by a joint");
      root = &link;
    }
    if (root == nullptr)
      fail(elements_.links.empty() ? "a robot without links"
                                   : "no root link: the joints are connected in a loop");
    return *root;
  }

  void add_joint(const JointEntry& entry, std::uint32_t parent) {
    Joint joint = entry.joint;
    joint.parent = parent;
    if (joint.type != JointType::Fixed && !entry.mimicry) {
      joint.variable = static_cast<std::uint32_t>(robot_.variables.size());
      robot_.variables.push_back(entry.variable);
    }
    place_[joint.name] = robot_.joints.size();
    joint.unmodelled = entry.unmodelled;
    if (entry.unmodelled)
      robot_.unmodelled.push_back(name_ + ":" + std::to_string(entry.line) + ": joint '" +
                                  joint.name + "' is planar or floating");
    if (entry.unlimited)
      robot_.notes.push_back(name_ + ":" + std::to_string(entry.line) + ": joint '" + joint.name +
                             "' has no <limit>, which readers of ROS refuse; here it has none");
    robot_.joints.push_back(std::move(joint));
    order_.push_back(&entry);
  }

  /// From a mimicking joint to the one that moves by itself.
  void follow(std::size_t index) {
    Joint& joint = robot_.joints[index];
    std::set<std::size_t> seen{index};
    joint.multiplier = 1;
    for (const Mimicry* m = &*order_[index]->mimicry;;) {
      joint.offset += joint.multiplier * m->offset;
      joint.multiplier *= m->multiplier;
      const auto it = place_.find(m->leader);
      const std::string what = "it mimics '" + m->leader + "'";
      if (it == place_.end()) fail(*order_[index], what + ", which does not exist");
      if (!seen.insert(it->second).second)
        fail(*order_[index], what + ": joints mimic one another in a circle");
      if (robot_.joints[it->second].type == JointType::Fixed)
        fail(*order_[index], what + ", which is fixed");
      const JointEntry& other = *order_[it->second];
      if (!other.mimicry) {
        joint.variable = robot_.joints[it->second].variable;
        joint.lower = order_[index]->variable.lower;
        joint.upper = order_[index]->variable.upper;
        if (const auto own = order_[index]->variable.velocity; own && joint.multiplier != 0) {
          std::optional<double>& most = robot_.variables[joint.variable].velocity;
          const double here = *own / std::abs(joint.multiplier);
          most = most ? std::min(*most, here) : here;
        }
        return;
      }
      m = &*other.mimicry;
    }
  }

  Elements elements_;
  const std::string& name_;
  std::map<std::string, const JointEntry*> moved_by_;               // by link
  std::map<std::string, std::vector<const JointEntry*>> children_;  // by link, by name of the joint
  Robot robot_;
  std::vector<const JointEntry*> order_;      // of robot_.joints
  std::map<std::string, std::size_t> place_;  // in robot_.joints, by name
};

}  // namespace

Robot parse_urdf(std::string_view text, const std::string& name) {
  tinyxml2::XMLDocument xml;
  parse_xml(xml, text, name);
  const XMLElement& root = *xml.RootElement();
  if (std::string(root.Name()) != "robot")
    fail_at(name, root.GetLineNum(), std::string("expected <robot>, found <") + root.Name() + ">");
  if (const auto* more = root.NextSiblingElement(); more != nullptr)
    fail_at(name, more->GetLineNum(),
            std::string("<") + more->Name() + "> after </robot>: a file holds one robot");
  refuse_xacro(root, name);
  const XmlFile file(name);
  const std::string robot_name = file.text(root, "name");
  const int minor = minor_version(root, file);
  if (minor == 0) refuse_quaternions(root, name);
  Elements elements(name, minor);
  elements.read(root);
  Robot robot = Assembly(std::move(elements), name).build();
  robot.name = robot_name;
  try {
    require_valid(robot);
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what());
  }
  return robot;
}

}  // namespace kaboum::robot
