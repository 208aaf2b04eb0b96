// Robots from files of the Robotics Library.

#include <kaboum/base/error.h>
#include <kaboum/robot/robot.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "xml.h"

namespace kaboum::robot {
namespace {

using tinyxml2::XMLElement;

constexpr double kDegree = std::numbers::pi / 180;

/// A joint between two frames: moved by `motion`, then by a fixed transform.
struct Edge {
  Joint motion;
  Transform after;
  std::string from, to;
  Variable variable;
  int line = 0;
};

class Reader {
 public:
  explicit Reader(const std::string& name) : name_(name) {}

  Robot read(const tinyxml2::XMLDocument& xml) {
    const XMLElement& root = *xml.RootElement();
    const std::string kind = root.Name();
    if (kind != "rlkin" && kind != "rlmdl")
      fail_at(name_, root.GetLineNum(), "expected <rlkin> or <rlmdl>, found <" + kind + ">");
    const XMLElement* model = root.FirstChildElement();
    if (model == nullptr) fail_at(name_, root.GetLineNum(), "no kinematics in <" + kind + ">");
    for (const XMLElement* e = model->FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement())
      element(*e);
    return connect();
  }

 private:
  [[noreturn]] void fail(const XMLElement& e, const std::string& what) const {
    fail_at(name_, e.GetLineNum(), std::string("<") + e.Name() + ">: " + what);
  }

  /// Number in a child element; `otherwise` when there is none.
  double number(const XMLElement* e, const char* child, double otherwise) const {
    const XMLElement* c = e != nullptr ? e->FirstChildElement(child) : nullptr;
    if (c == nullptr) return otherwise;
    const std::string text = c->GetText() != nullptr ? c->GetText() : "";
    const auto value = finite_number(text);
    if (!value) fail(*c, "'" + text.substr(0, 40) + "' is not a finite number");
    return *value;
  }

  Vec3 vector(const XMLElement& e, const char* child, const Vec3& otherwise) const {
    const XMLElement* c = e.FirstChildElement(child);
    return {number(c, "x", otherwise.x()), number(c, "y", otherwise.y()),
            number(c, "z", otherwise.z())};
  }

  Transform transform(const XMLElement& e) const {
    const Vec3 angles = vector(e, "rotation", Vec3::Zero()) * kDegree;
    return {rotation_from_rpy(angles.x(), angles.y(), angles.z()),
            vector(e, "translation", Vec3::Zero())};
  }

  void element(const XMLElement& e) {
    const std::string kind = e.Name();
    const XMLElement* frame = e.FirstChildElement("frame");
    if (frame == nullptr) {
      if (kind == "world" || kind == "link" || kind == "body" || kind == "frame") {
        const char* id = e.Attribute("id");
        if (id == nullptr) fail(e, "no id");
        if (std::find(frames_.begin(), frames_.end(), id) != frames_.end())
          fail(e, std::string("'") + id + "' exists already");
        const Transform pose = transform(e);
        if (kind == "world" && (!pose.linear.isIdentity(0) || !pose.translation.isZero(0)))
          fail(e, "a world that is moved or turned is not supported; put a <fixed> after it");
        frames_.emplace_back(id);
      }
      return;
    }
    Edge edge;
    edge.line = e.GetLineNum();
    const char* id = e.Attribute("id");
    edge.motion.name = id != nullptr ? id : "";
    for (auto [child, place] : {std::pair{"a", &edge.from}, std::pair{"b", &edge.to}}) {
      const XMLElement* end = frame->FirstChildElement(child);
      const char* reference = end != nullptr ? end->Attribute("idref") : nullptr;
      if (reference == nullptr) fail(e, std::string("no <") + child + " idref=...> in <frame>");
      *place = reference;
    }
    if (kind == "transform" || kind == "fixed") {
      edge.motion.origin = transform(e);
    } else if (kind == "revolute" || kind == "prismatic") {
      joint(e, kind == "revolute", edge);
    } else {
      fail(e, "joints of this type are not supported");
    }
    edges_.push_back(std::move(edge));
  }

  void joint(const XMLElement& e, bool revolute, Edge& edge) const {
    if (edge.motion.name.empty()) fail(e, "no id");
    const double unit = revolute ? kDegree : 1;
    edge.motion.type = revolute ? JointType::Revolute : JointType::Prismatic;
    const Vec3 axis = vector(e, "axis", Vec3::UnitZ());
    if (!(axis.norm() > 0)) fail(e, "the axis has no direction");
    edge.motion.axis = axis.normalized();
    edge.motion.offset = number(&e, "offset", 0) * unit;
    if (const XMLElement* dh = e.FirstChildElement("dh")) {
      const double theta = number(dh, "theta", 0) * kDegree, d = number(dh, "d", 0);
      edge.after = Transform{rotation_about(Vec3::UnitX(), number(dh, "alpha", 0) * kDegree),
                             {number(dh, "a", 0), 0, 0}};
      if (revolute) {
        edge.motion.offset += theta;
        edge.after.translation.z() += d;
      } else {
        edge.motion.offset += d;
        edge.motion.origin.linear = rotation_about(Vec3::UnitZ(), theta);
      }
    }
    edge.variable.name = edge.motion.name;
    if (e.FirstChildElement("min") != nullptr) edge.variable.lower = number(&e, "min", 0) * unit;
    if (e.FirstChildElement("max") != nullptr) edge.variable.upper = number(&e, "max", 0) * unit;
    // As in URDFs, 0 is written where nothing is known.
    const double speed = number(&e, "speed", 0) * unit;
    if (speed > 0) edge.variable.velocity = speed;
  }

  Robot connect() {
    std::set<std::string> moved;
    for (const Edge& edge : edges_) {
      for (const std::string& end : {edge.from, edge.to})
        if (std::find(frames_.begin(), frames_.end(), end) == frames_.end())
          fail_at(name_, edge.line, "there is no frame '" + end + "'");
      if (!moved.insert(edge.to).second)
        fail_at(name_, edge.line, "frame '" + edge.to + "' is moved by two joints");
    }
    std::vector<std::string> roots;
    for (const std::string& frame : frames_)
      if (!moved.contains(frame)) roots.push_back(frame);
    // Frames of tools need not be connected in both files: only those under the world count.
    if (roots.empty())
      throw Error(ErrorCode::InvalidInput, name_ + ": no frame that nothing moves");
    Robot robot;
    robot.name = name_;
    robot.links.push_back({roots.front(), {}, {}});
    struct Entry {
      std::string frame;
      std::uint32_t link;
    };
    std::vector<Entry> stack{{roots.front(), 0}};
    std::size_t used = 0;
    while (!stack.empty()) {
      const Entry entry = stack.back();
      stack.pop_back();
      std::vector<Entry> children;
      for (const Edge& edge : edges_) {
        if (edge.from != entry.frame) continue;
        ++used;
        children.push_back({edge.to, add(robot, edge, entry.link)});
      }
      stack.insert(stack.end(), children.rbegin(), children.rend());
    }
    if (used != edges_.size())
      throw Error(ErrorCode::InvalidInput,
                  name_ + ": some joints are not connected to '" + roots.front() + "'");
    try {
      require_valid(robot);
    } catch (const Error& error) {
      throw Error(error.code(), name_ + ": " + error.what());
    }
    return robot;
  }

  static std::uint32_t add(Robot& robot, const Edge& edge, std::uint32_t parent) {
    Joint joint = edge.motion;
    joint.parent = parent;
    if (joint.type == JointType::Fixed) {
      robot.links.push_back({edge.to, {}, {}});
      robot.joints.push_back(std::move(joint));
      return static_cast<std::uint32_t>(robot.links.size() - 1);
    }
    joint.variable = static_cast<std::uint32_t>(robot.variables.size());
    robot.variables.push_back(edge.variable);
    robot.links.push_back({edge.motion.name + " (moved)", {}, {}});
    robot.joints.push_back(std::move(joint));
    Joint rest;
    rest.name = edge.motion.name + " (rest)";
    rest.parent = static_cast<std::uint32_t>(robot.links.size() - 1);
    rest.origin = edge.after;
    robot.links.push_back({edge.to, {}, {}});
    robot.joints.push_back(std::move(rest));
    return static_cast<std::uint32_t>(robot.links.size() - 1);
  }

  const std::string& name_;
  std::vector<std::string> frames_;
  std::vector<Edge> edges_;
};

}  // namespace

Robot parse_rl(std::string_view text, const std::string& name) {
  tinyxml2::XMLDocument xml;
  parse_xml(xml, text, name);
  return Reader(name).read(xml);
}

}  // namespace kaboum::robot
