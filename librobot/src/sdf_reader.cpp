// Reads SDF, the format of Gazebo and Drake, and writes it with other collision shapes:
// <http://sdformat.org/spec>.

#include <kaboum/base/error.h>
#include <kaboum/robot/sdf.h>
#include <tinyxml2.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <set>

#include "link_elements.h"
#include "model_words.h"
#include "xml.h"

namespace kaboum::robot {
namespace {

using tinyxml2::XMLElement;
using Elements = std::vector<XMLElement*>;

constexpr const char* kWorld = "world";
constexpr const char* kModel = "__model__";
constexpr int kFirstVersion = 4, kLastVersion = 12;  ///< 1.4 to 1.12

/// One model, and the elements of its shapes.
class Reader {
 public:
  Reader(XMLElement& root, const std::string& name) : root_(root), name_(name), file_(name) {}

  void read() {
    if (std::string_view(root_.Name()) != "sdf")
      fail_at(name_, root_.GetLineNum(),
              std::string("expected <sdf>, found <") + root_.Name() + ">");
    read_version();
    find_model();
    out_.robot.name = file_.text(*model_, "name");
    collect(*model_, "");
    name_joints();
    build();
    try {
      require_valid(out_.robot);
    } catch (const Error& error) {
      throw Error(error.code(), name_ + ": " + error.what());
    }
  }

  SdfRobot& result() { return out_; }
  [[nodiscard]] int minor() const { return minor_; }
  [[nodiscard]] XMLElement& link_element(std::size_t l) const { return *link_elements_[l]; }
  [[nodiscard]] bool has_element(std::size_t l) const { return link_elements_[l] != nullptr; }
  /// Of a link's shapes.
  [[nodiscard]] const Elements& shapes(std::size_t l, bool visual) const {
    return (visual ? visual_ : collision_)[l];
  }

 private:
  void read_version() {
    const std::string version = file_.text(root_, "version");
    if (!version.starts_with("1.")) file_.fail(root_, "version " + version + " is not known");
    const auto minor = finite_number(std::string_view(version).substr(2));
    if (!minor || *minor < kFirstVersion || *minor > kLastVersion || *minor != std::floor(*minor))
      file_.fail(root_, "version " + version + " is not known; 1.4 to 1.12 are");
    minor_ = static_cast<int>(*minor);
  }

  void find_model() {
    XMLElement* parent = root_.FirstChildElement("world");
    if (parent == nullptr) parent = &root_;
    model_ = parent->FirstChildElement("model");
    if (model_ == nullptr) file_.fail(root_, "no <model>");
    if (const XMLElement* more = model_->NextSiblingElement("model"); more != nullptr)
      file_.fail(*more, "a second model: give a file of one robot");
    refuse_includes(*parent);
  }

  void refuse_includes(const XMLElement& parent) const {
    if (const XMLElement* e = parent.FirstChildElement("include"); e != nullptr)
      file_.fail(*e,
                 "included models are not read: have `gz sdf -p` write them out as nested models, "
                 "which are");
  }

  /// Links, joints, frames and nested models, by their names from outside ("arm::hand::palm").
  /// @param scope  of the names inside: empty, or "arm::"
  void collect(XMLElement& model, const std::string& scope) {
    refuse_includes(model);
    std::set<std::string> joints;
    for (const char* tag : {"link", "joint", "frame", "model"})
      for (XMLElement* e = model.FirstChildElement(tag); e != nullptr;
           e = e->NextSiblingElement(tag)) {
        const std::string named = file_.text(*e, "name");
        if (named == kWorld || named == kModel) fail_twice(*e, named);
        const bool fresh = std::string_view(tag) == "joint"
                               ? joints.insert(named).second
                               : frames_.emplace(scope + named, e).second;
        if (!fresh) fail_twice(*e, scope + named);
        scopes_.emplace(e, scope);
        order_[tag].push_back(e);
        if (std::string_view(tag) == "model") collect(*e, scope + named + "::");
      }
  }

  /// Gives joints their names, after all else. Before 1.7 a joint may have the name of a link or a
  /// nested model, which is what others mean by it, as in libsdformat.
  void name_joints() {
    for (XMLElement* e : order_["joint"]) {
      const auto [other, fresh] = frames_.emplace(name_of(*e), e);
      if (fresh) continue;
      const std::string_view tag = other->second->Name();
      if (minor_ >= 7 || (tag != "link" && tag != "model")) fail_twice(*e, other->first);
    }
  }

  [[noreturn]] void fail_twice(const XMLElement& e, const std::string& named) const {
    const auto other = frames_.find(named);
    std::string what = "the name '" + named + "' is there already";
    if (other != frames_.end())
      what += ": <" + std::string(other->second->Name()) + "> in line " +
              std::to_string(other->second->GetLineNum());
    file_.fail(e, what);
  }

  /// The name from outside of what an element names, or of an element itself.
  [[nodiscard]] std::string from_outside(const XMLElement& e, const std::string& name) const {
    if (name == kWorld) return name;
    const auto found = scopes_.find(&e);
    const std::string scope = found == scopes_.end() ? std::string() : found->second;
    if (name != kModel) return scope + name;
    return scope.empty() ? kModel : scope.substr(0, scope.size() - 2);  // the model's own frame
  }
  [[nodiscard]] std::string name_of(const XMLElement& e) const {
    return from_outside(e, file_.text(e, "name"));
  }

  // --- poses ------------------------------------------------------------------------------------

  [[nodiscard]] std::vector<double> numbers(const XMLElement& e, std::size_t least,
                                            std::size_t most) const {
    const auto out = finite_numbers(e.GetText() == nullptr ? "" : e.GetText());
    if (!out || out->size() < least || out->size() > most)
      file_.fail(e, "'" + trimmed(e.GetText()).substr(0, 60) + "' is not " + std::to_string(most) +
                        (most == 1 ? " finite number" : " finite numbers"));
    return *out;
  }

  [[nodiscard]] double number(const XMLElement& parent, const char* tag, double otherwise) const {
    const XMLElement* e = file_.only_child(parent, tag);
    return e == nullptr ? otherwise : numbers(*e, 1, 1)[0];
  }

  /// What <pose> says, whichever frame it is in.
  [[nodiscard]] Transform pose(const XMLElement& parent) const {
    const XMLElement* e = file_.only_child(parent, "pose");
    if (e == nullptr || trimmed(e->GetText()).empty()) return {};
    const char* format = e->Attribute("rotation_format");
    if (format != nullptr && std::string_view(format) == "quat_xyzw") {
      const std::vector<double> x = numbers(*e, 7, 7);
      const Eigen::Quaterniond q(x[6], x[3], x[4], x[5]);
      if (!(q.norm() > 0) || !std::isfinite(q.norm())) file_.fail(*e, "the rotation is none");
      return {q.normalized().toRotationMatrix(), {x[0], x[1], x[2]}};
    }
    const std::vector<double> x = numbers(*e, 6, 6);
    const char* degrees = e->Attribute("degrees");
    const bool in_degrees = degrees != nullptr && (std::string_view(degrees) == "true" ||
                                                   std::string_view(degrees) == "1");
    const double unit = in_degrees ? std::numbers::pi / 180 : 1;
    return {rotation_from_rpy(unit * x[3], unit * x[4], unit * x[5]), {x[0], x[1], x[2]}};
  }

  [[nodiscard]] std::string relative_to(const XMLElement& parent) const {
    const XMLElement* e = parent.FirstChildElement("pose");
    const char* frame = e != nullptr ? e->Attribute("relative_to") : nullptr;
    if (frame == nullptr && e != nullptr) frame = e->Attribute("frame");  // 1.5 and 1.6
    return frame == nullptr ? "" : frame;
  }

  /// The pose of a link, a joint or a frame in the model.
  Transform in_model(const std::string& frame, const XMLElement& asked) {
    if (frame == kModel) return {};
    if (const auto found = known_.find(frame); found != known_.end()) return found->second;
    const auto entry = frames_.find(frame);
    if (entry == frames_.end()) file_.fail(asked, "there is no frame '" + frame + "'");
    if (!being_found_.insert(frame).second)
      file_.fail(*entry->second, "its pose is relative to itself, by way of others");
    const XMLElement& e = *entry->second;
    const std::string_view tag = e.Name();
    std::string base = relative_to(e);
    if (tag == "joint" && base.empty()) {
      base = child_of(e);
    } else {
      const char* attached = e.Attribute("attached_to");
      if (tag == "frame" && base.empty() && attached != nullptr) base = attached;
      base = from_outside(e, base.empty() ? kModel : base);
    }
    const Transform before = base == kWorld ? Transform() : in_model(base, e);
    Transform here = before * pose(e);
    if (tag == "model") here = here * inverse(placed_by(e, frame));
    being_found_.erase(frame);
    return known_[frame] = here;
  }

  /// The pose in a nested model of the frame that its own pose is of.
  Transform placed_by(const XMLElement& model, const std::string& name) {
    const char* frame = model.Attribute("placement_frame");
    if (frame == nullptr || *frame == '\0' || std::string_view(frame) == kModel) return {};
    // All in it is found as if this model's frame were the robot's, which is forgotten again.
    const std::map<std::string, Transform> outside = known_;
    std::set<std::string> asked;
    asked.swap(being_found_);
    known_[name] = Transform();
    Transform out = in_model(name + "::" + frame, model);
    known_ = outside;
    being_found_ = asked;
    return out;
  }

  /// The frame of a joint, which may have the name of a link.
  Transform frame_of(const XMLElement& joint) {
    std::string base = relative_to(joint);
    base = base.empty() ? child_of(joint) : from_outside(joint, base);
    return (base == kWorld ? Transform() : in_model(base, joint)) * pose(joint);
  }

  /// The frame that a joint connects, by its name from outside.
  [[nodiscard]] std::string end_of(const XMLElement& joint, const char* tag) const {
    const XMLElement* e = file_.only_child(joint, tag);
    const std::string link = e == nullptr ? std::string() : trimmed(e->GetText());
    if (link.empty()) file_.fail(joint, std::string("no <") + tag + ">");
    return from_outside(joint, link);
  }
  [[nodiscard]] std::string child_of(const XMLElement& joint) const {
    return end_of(joint, "child");
  }

  /// The link that a frame is fixed to.
  [[nodiscard]] std::string link_of(std::string frame, const XMLElement& asked) const {
    for (std::size_t i = 0; i <= frames_.size(); ++i) {
      if (frame == kWorld || frame == kModel) return kWorld;
      const auto entry = frames_.find(frame);
      if (entry == frames_.end()) file_.fail(asked, "there is no link '" + frame + "'");
      const std::string_view tag = entry->second->Name();
      if (tag == "link") return frame;
      if (tag == "joint") {
        frame = child_of(*entry->second);
        continue;
      }
      if (tag == "model") {
        frame = canonical_link(*entry->second, frame);
        continue;
      }
      const char* attached = entry->second->Attribute("attached_to");
      frame = from_outside(*entry->second,
                           attached == nullptr || *attached == '\0' ? kModel : attached);
    }
    file_.fail(asked, "frame '" + frame + "' is attached to itself, by way of others");
  }

  /// The link that a nested model's frame is fixed to.
  [[nodiscard]] std::string canonical_link(const XMLElement& model, const std::string& name) const {
    if (const char* stated = model.Attribute("canonical_link");
        stated != nullptr && *stated != '\0')
      return name + "::" + stated;
    for (const char* tag : {"link", "model"})
      if (const XMLElement* first = model.FirstChildElement(tag); first != nullptr)
        return name + "::" + file_.text(*first, "name");
    file_.fail(model, "a model without links");
  }

  // --- the tree ---------------------------------------------------------------------------------

  void build() {
    std::map<std::string, XMLElement*> mover;                // of a link
    std::map<std::string, std::vector<XMLElement*>> movers;  // by parent
    for (XMLElement* e : order_["joint"]) {
      const std::string parent = link_of(end_of(*e, "parent"), *e),
                        child = link_of(child_of(*e), *e);
      if (child == kWorld) file_.fail(*e, "its child is the world");
      if (parent == child) file_.fail(*e, "it connects '" + child + "' with itself");
      if (!mover.emplace(child, e).second) {
        note(*e, "joint '" + name_of(*e) + "' closes a loop: link '" + child +
                     "' is moved by another one already, which is the one that counts");
        continue;
      }
      movers[parent].push_back(e);
    }
    add_link(kWorld, nullptr);
    std::vector<std::pair<std::uint32_t, std::string>> places;  // links whose joints are next
    const auto add_joints = [&](std::uint32_t link, const std::string& named) {  // links move
      for (XMLElement* e : movers[named]) add_moved(link, named, *e);
    };
    add_joints(0, kWorld);
    for (XMLElement* e : order_["link"]) {
      const std::string link = name_of(*e);
      if (mover.contains(link)) continue;
      Joint fixed;
      fixed.name = names_.give(link + ":fixed");
      fixed.origin = in_model(link, *e);
      read_link(add_below(0, link, fixed, e), *e);
    }
    for (std::size_t l = 1; l < out_.robot.links.size(); ++l)  // grows
      if (has_element(l))
        add_joints(static_cast<std::uint32_t>(l), std::string(out_.robot.links[l].name));
    if (std::ranges::count_if(link_elements_, [](const auto* e) { return e != nullptr; }) !=
        std::ssize(order_["link"]))
      throw Error(ErrorCode::InvalidInput, name_ + ": joints of some links lead in a circle");
    follow_mimics();
  }

  std::uint32_t add_link(const std::string& link, XMLElement* element) {
    out_.robot.links.push_back({link, {}, {}});
    link_elements_.push_back(element);
    collision_.emplace_back();
    visual_.emplace_back();
    return static_cast<std::uint32_t>(out_.robot.links.size() - 1);
  }

  std::uint32_t add_below(std::uint32_t parent, const std::string& link, Joint joint,
                          XMLElement* element) {
    joint.parent = parent;
    out_.robot.joints.push_back(std::move(joint));
    return add_link(link, element);
  }

  static Transform inverse(const Transform& t) {
    return {t.linear.transpose(), -(t.linear.transpose() * t.translation)};
  }

  void add_moved(std::uint32_t parent, const std::string& parent_name, XMLElement& e) {
    const std::string child = link_of(child_of(e), e);
    const std::string named = name_of(e);
    const Transform above = parent_name == kWorld ? Transform() : in_model(parent_name, e);
    const Transform frame = frame_of(e), below = in_model(child, e);
    XMLElement& element = *frames_.at(child);
    Joint joint = read_joint(e, frame);
    joint.origin = inverse(above) * frame;
    const Transform rest = inverse(frame) * below;
    const bool same = rest.translation.norm() == 0 && rest.linear.isIdentity(1e-15);
    std::uint32_t link = parent;
    if (joint.type == JointType::Fixed) {
      joint.origin = inverse(above) * below;
      link = add_below(parent, child, joint, &element);
    } else if (same || frame_is_child(e, child)) {
      link = add_below(parent, child, joint, &element);
    } else {
      link = add_below(parent, names_.give(child + ":" + named), joint, nullptr);
      Joint fixed;
      fixed.name = names_.give(child + ":fixed");
      fixed.origin = rest;
      link = add_below(link, child, fixed, &element);
    }
    read_link(link, element);
  }

  /// Whether a joint's frame is that of its child, as it is by default.
  [[nodiscard]] bool frame_is_child(const XMLElement& joint, const std::string& child) const {
    const std::string base = relative_to(joint);
    return (base.empty() || from_outside(joint, base) == child) && is_identity(pose(joint)) &&
           child_of(joint) == child;
  }

  Joint read_joint(const XMLElement& e, const Transform& frame) {
    Joint out;
    out.name = names_.give(name_of(e));
    const std::string type = file_.text(e, "type");
    if (type == "fixed") return out;
    if (type != "revolute" && type != "continuous" && type != "prismatic") {
      unmodelled(e, "joint '" + out.name + "' is of type " + type);
      out.unmodelled = true;
      return out;
    }
    out.type = type == "prismatic" ? JointType::Prismatic : JointType::Revolute;
    const XMLElement* axis = file_.only_child(e, "axis");
    Vec3 direction = Vec3::UnitZ();
    Variable variable;
    variable.name = out.name;
    JointDynamics dynamics;
    if (axis != nullptr) {
      direction = read_axis(*axis, frame, e);
      read_limits(*axis, type == "continuous", variable, dynamics);
    }
    const double length = direction.stableNorm();
    if (!(length > 0) || !std::isfinite(length)) file_.fail(e, "the axis has no direction");
    out.axis = (direction / length).normalized();
    if (axis != nullptr)
      if (const XMLElement* mimic = axis->FirstChildElement("mimic"); mimic != nullptr) {
        const XMLElement* leader = mimic;
        mimics_.push_back({out_.robot.joints.size(), from_outside(e, file_.text(*leader, "joint")),
                           number(*mimic, "multiplier", 1), number(*mimic, "offset", 0),
                           number(*mimic, "reference", 0), mimic});
      }
    out.variable = static_cast<std::uint32_t>(out_.robot.variables.size());
    out_.robot.variables.push_back(variable);
    out_.dynamics.joints.emplace(out.name, dynamics);
    return out;
  }

  [[nodiscard]] Vec3 read_axis(const XMLElement& axis, const Transform& frame,
                               const XMLElement& joint) {
    const XMLElement* e = file_.only_child(axis, "xyz");
    if (e == nullptr) return Vec3::UnitZ();
    const std::vector<double> x = numbers(*e, 3, 3);
    Vec3 stated(x[0], x[1], x[2]);
    const char* in = e->Attribute("expressed_in");
    const XMLElement* old = axis.FirstChildElement("use_parent_model_frame");
    const bool in_model_frame =
        minor_ <= 4 ||
        (old != nullptr && (trimmed(old->GetText()) == "true" || trimmed(old->GetText()) == "1"));
    if (in != nullptr && *in != '\0')
      return frame.linear.transpose() *
             ((in == std::string_view(kWorld) ? Transform()
                                              : in_model(from_outside(joint, in), joint))
                  .linear *
              stated);
    if (!in_model_frame) return stated;
    return frame.linear.transpose() *
           (in_model(from_outside(joint, kModel), joint).linear * stated);
  }

  void read_limits(const XMLElement& axis, bool endless, Variable& variable,
                   JointDynamics& dynamics) {
    constexpr double kNone = 1e16;  // SDF's own default
    if (const XMLElement* limit = file_.only_child(axis, "limit"); limit != nullptr) {
      const auto bound = [&](const char* tag) -> std::optional<double> {
        const XMLElement* e = file_.only_child(*limit, tag);
        if (e == nullptr) return std::nullopt;
        const std::string text = trimmed(e->GetText());
        if (text.find("inf") != std::string::npos || text.find("Inf") != std::string::npos)
          return std::nullopt;
        return numbers(*e, 1, 1)[0];
      };
      if (const auto lower = bound("lower"); lower && *lower > -kNone && !endless)
        variable.lower = lower;
      if (const auto upper = bound("upper"); upper && *upper < kNone && !endless)
        variable.upper = upper;
      // What a motor can do says nothing of where links are: as readers take it, up to the first
      // sign that belongs to no number.
      const auto of_motor = [&](const char* tag) -> std::optional<double> {
        const XMLElement* e = file_.only_child(*limit, tag);
        const std::string text = e == nullptr ? "" : trimmed(e->GetText());
        const std::string number = text.substr(0, text.find_first_not_of("0123456789+-.eE"));
        const auto out = finite_number(number);
        if (!out || number == text) return bound(tag);
        note(*e, std::string("<").append(tag).append(">: ").append(number).append(
                     " is taken of '" + text + "', as readers of SDF do"));
        return out;
      };
      if (const auto velocity = of_motor("velocity"); velocity && *velocity > 0)
        variable.velocity = velocity;
      if (const auto effort = of_motor("effort"); effort && *effort > 0) dynamics.effort = effort;
    }
    if (const XMLElement* e = axis.FirstChildElement("dynamics"); e != nullptr) {
      dynamics.damping = std::max(0.0, number(*e, "damping", 0));
      dynamics.friction = std::max(0.0, number(*e, "friction", 0));
    }
    dynamics.lower = variable.lower;
    dynamics.upper = variable.upper;
  }

  /// A joint that follows another one: multiplier · (q − reference) + offset.
  struct Mimic {
    std::size_t joint;
    std::string leader;
    double multiplier, offset, reference;
    const XMLElement* element;
  };

  /// Joints that follow have the variable of the joint that moves by itself.
  void follow_mimics() {
    std::map<std::size_t, const Mimic*> by_joint;
    for (const Mimic& m : mimics_) by_joint.emplace(m.joint, &m);
    std::set<std::string> gone;  // variables
    for (const Mimic& m : mimics_) {
      Joint& joint = out_.robot.joints[m.joint];
      const Variable own = out_.robot.variables[joint.variable];
      joint.multiplier = 1;
      joint.offset = 0;
      std::set<std::size_t> seen{m.joint};
      std::size_t leader = m.joint;
      for (auto at = by_joint.find(leader); at != by_joint.end(); at = by_joint.find(leader)) {
        const Mimic& link = *at->second;
        leader = joint_called(link);
        if (!seen.insert(leader).second)
          file_.fail(*link.element, "joints mimic one another in a circle");
        joint.offset += joint.multiplier * (link.offset - link.multiplier * link.reference);
        joint.multiplier *= link.multiplier;
      }
      joint.variable = out_.robot.joints[leader].variable;
      joint.lower = own.lower;
      joint.upper = own.upper;
      if (own.velocity && joint.multiplier != 0) {
        std::optional<double>& most = out_.robot.variables[joint.variable].velocity;
        const double here = *own.velocity / std::abs(joint.multiplier);
        most = most ? std::min(*most, here) : here;
      }
      gone.insert(own.name);
    }
    leave_out(gone);
  }

  /// The joint that another one follows.
  [[nodiscard]] std::size_t joint_called(const Mimic& m) const {
    for (std::size_t j = 0; j < out_.robot.joints.size(); ++j)
      if (const Joint& joint = out_.robot.joints[j]; joint.name == m.leader) {
        if (joint.type == JointType::Fixed)
          file_.fail(*m.element, "it mimics '" + m.leader + "', which does not turn or slide");
        return j;
      }
    file_.fail(*m.element, "it mimics '" + m.leader + "', which does not exist");
  }

  /// Takes variables out that no joint has any more.
  void leave_out(const std::set<std::string>& names) {
    std::vector<Variable>& variables = out_.robot.variables;
    std::vector<std::uint32_t> place(variables.size(), 0);
    std::uint32_t kept = 0;
    for (std::size_t v = 0; v < variables.size(); ++v) {
      place[v] = kept;
      if (!names.contains(variables[v].name)) ++kept;
    }
    std::erase_if(variables, [&](const Variable& v) { return names.contains(v.name); });
    for (Joint& joint : out_.robot.joints)
      if (joint.type != JointType::Fixed) joint.variable = place[joint.variable];
  }

  void note(const XMLElement& e, const std::string& what) {
    out_.robot.notes.push_back(name_ + ":" + std::to_string(e.GetLineNum()) + ": " + what);
  }
  void unmodelled(const XMLElement& e, const std::string& what) {
    out_.robot.unmodelled.push_back(name_ + ":" + std::to_string(e.GetLineNum()) + ": " + what);
  }

  // --- shapes -----------------------------------------------------------------------------------

  void read_link(std::uint32_t l, XMLElement& e) {
    Link& link = out_.robot.links[l];
    if (const XMLElement* inertial = file_.only_child(e, "inertial"); inertial != nullptr)
      out_.dynamics.links.emplace(link.name, read_inertial(*inertial));
    for (const bool visual : {false, true})
      for (XMLElement* shape = e.FirstChildElement(visual ? "visual" : "collision");
           shape != nullptr; shape = shape->NextSiblingElement(visual ? "visual" : "collision")) {
        Geometry g;
        if (!read_geometry(*shape, link, g)) continue;
        (visual ? link.visual : link.collision).push_back(std::move(g));
        (visual ? visual_ : collision_)[l].push_back(shape);
      }
  }

  [[nodiscard]] Inertial read_inertial(const XMLElement& e) const {
    Inertial out;
    out.origin = pose(e);
    out.mass = number(e, "mass", 1);
    out.inertia = Mat3::Identity();
    if (const XMLElement* i = file_.only_child(e, "inertia"); i != nullptr) {
      const double xy = number(*i, "ixy", 0), xz = number(*i, "ixz", 0), yz = number(*i, "iyz", 0);
      out.inertia << number(*i, "ixx", 1), xy, xz, xy, number(*i, "iyy", 1), yz, xz, yz,
          number(*i, "izz", 1);
    }
    return out;
  }

  /// @return false: nothing that is to be held
  bool read_geometry(const XMLElement& shape, Link& link, Geometry& g) {
    const XMLElement* geometry = file_.only_child(shape, "geometry");
    if (geometry == nullptr) file_.fail(shape, "no <geometry>");
    const XMLElement* e = geometry->FirstChildElement();
    if (e == nullptr) return false;
    std::string kind = e->Name();
    if (kind == "drake:capsule" || kind == "drake:ellipsoid") kind.erase(0, 6);
    g.line = e->GetLineNum();
    g.origin = pose(shape);
    if (std::string base = relative_to(shape); !base.empty()) {
      base = from_outside(*shape.Parent()->ToElement(), base);
      if (base != link.name)
        g.origin = inverse(in_model(link.name, shape)) * in_model(base, shape) * g.origin;
    }
    const auto child = [&](const char* tag, std::size_t count) {
      const XMLElement* value = file_.only_child(*e, tag);
      if (value == nullptr) value = file_.only_child(*e, (std::string("drake:") + tag).c_str());
      if (value == nullptr) file_.fail(*e, std::string("no <") + tag + ">");
      return numbers(*value, count, count);
    };
    using Shape = Geometry::Shape;
    if (kind == "empty") return false;
    if (kind == "plane") {
      link.unread.push_back({std::string_view(shape.Name()) == "visual", "a plane"});
      note(*e, "a plane of link '" + link.name + "' stays as it is: nothing bounded could hold it");
      return false;
    }
    if (kind == "box") {
      const auto x = child("size", 3);
      g.shape = Shape::Box;
      g.size = {x[0], x[1], x[2]};
    } else if (kind == "sphere") {
      g.shape = Shape::Sphere;
      g.size = Vec3::Constant(child("radius", 1)[0]);
    } else if (kind == "cylinder" || kind == "capsule") {
      const double radius = child("radius", 1)[0], length = child("length", 1)[0];
      g.shape = kind == "cylinder" ? Shape::Cylinder : Shape::Capsule;
      g.size = {radius, length, length};
    } else if (kind == "ellipsoid") {
      const auto x = child("radii", 3);
      g.shape = Shape::Ellipsoid;
      g.size = {x[0], x[1], x[2]};
    } else if (kind == "mesh") {
      read_mesh(*e, g);
      return true;
    } else {
      file_.fail(*e, "link '" + link.name +
                         "': a shape of this kind is not read; box, cylinder, sphere, capsule, "
                         "ellipsoid and mesh are");
    }
    if (!(g.size.array() >= 0).all())
      file_.fail(*e, "link '" + link.name + "': a " + describe(g) + " whose size is negative");
    return true;
  }

  void read_mesh(const XMLElement& e, Geometry& g) const {
    const XMLElement* uri = file_.only_child(e, "uri");
    if (uri == nullptr || trimmed(uri->GetText()).empty()) file_.fail(e, "no <uri>");
    if (const XMLElement* part = e.FirstChildElement("submesh"); part != nullptr)
      file_.fail(*part, "a part of a mesh's file; write it as a file of its own");
    g.shape = Geometry::Shape::Mesh;
    g.mesh = trimmed(uri->GetText());
    g.size = Vec3::Ones();
    if (const XMLElement* scale = file_.only_child(e, "scale"); scale != nullptr) {
      const auto x = numbers(*scale, 3, 3);
      g.size = {x[0], x[1], x[2]};
    }
    if ((g.size.array() == 0).any()) file_.fail(e, "a mesh scaled by 0");
  }

  XMLElement& root_;
  const std::string& name_;
  XmlFile file_;
  int minor_ = 0;
  XMLElement* model_ = nullptr;
  SdfRobot out_;
  std::map<std::string, XMLElement*> frames_;        // links, joints, frames, models, from outside
  std::map<const XMLElement*, std::string> scopes_;  // of these: of the model that they are in
  std::map<std::string, Elements> order_;            // by tag, as in the file
  std::map<std::string, Transform> known_;
  std::set<std::string> being_found_;
  UniqueNames names_;  // of joints, and links without element
  std::vector<XMLElement*> link_elements_;
  std::vector<Elements> collision_, visual_;
  std::vector<Mimic> mimics_;
};

/// Renames the files that a document names.
void move_files(XMLElement& element, const std::function<std::string(const std::string&)>& moved) {
  for (XMLElement* e = element.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
    if (std::string_view(e->Name()) == "uri" && std::string_view(element.Name()) == "mesh")
      e->SetText(moved(trimmed(e->GetText())).c_str());
    else
      move_files(*e, moved);
  }
}

}  // namespace

SdfRobot parse_sdf(std::string_view text, const std::string& name) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  Reader reader(*document.RootElement(), name);
  reader.read();
  return std::move(reader.result());
}

LinkElements sdf_links(tinyxml2::XMLDocument& document, const std::string& name) {
  Reader reader(*document.RootElement(), name);
  reader.read();
  LinkElements out;
  out.inertials = std::move(reader.result().dynamics.links);
  const std::vector<Link>& links = reader.result().robot.links;
  for (std::size_t l = 0; l < links.size(); ++l)
    if (reader.has_element(l)) out.elements.emplace(links[l].name, &reader.link_element(l));
  return out;
}

namespace {

/// Collision elements of a link that stand for its shapes, and take their place.
class NewCollisions {
 public:
  NewCollisions(tinyxml2::XMLDocument& document, XMLElement& link)
      : document_(document), link_(link) {}

  /// One with what an element says besides, and its place and shape where `placed`.
  /// @param surface  with what it says of contacts
  XMLElement& add(const XMLElement& original, bool placed, bool surface) {
    XMLElement* e = document_.NewElement("collision");
    e->SetAttribute("name", (std::string(link_.Attribute("name")) + "_collision_" +
                             std::to_string(fresh_.size()))
                                .c_str());
    for (const auto* child = original.FirstChildElement(); child != nullptr;
         child = child->NextSiblingElement()) {
      const std::string_view tag = child->Name();
      const bool place = tag == "pose" || tag == "geometry";
      if (place ? placed : surface && tag != "plugin")
        e->InsertEndChild(child->DeepClone(&document_));
    }
    fresh_.push_back(e);
    return *e;
  }

  void add(const XMLElement& original, const Primitive& one, bool surface) {
    XMLElement& e = add(original, false, surface);
    const Geometry& g = one.geometry;
    const Vec3& t = g.origin.translation;
    XMLElement* pose = document_.NewElement("pose");
    pose->SetText(digits({t.x(), t.y(), t.z(), one.rpy.x(), one.rpy.y(), one.rpy.z()}).c_str());
    XMLElement* geometry = document_.NewElement("geometry");
    e.InsertFirstChild(geometry);
    e.InsertFirstChild(pose);
    const auto shape = [&](const char* kind) -> XMLElement& {
      return *geometry->InsertNewChildElement(kind);
    };
    const auto state = [](XMLElement& in, const char* tag, const std::string& text) {
      in.InsertNewChildElement(tag)->SetText(text.c_str());
    };
    using Shape = Geometry::Shape;
    if (g.shape == Shape::Box) return state(shape("box"), "size", digits(g.size));
    XMLElement& round = shape(g.shape == Shape::Sphere     ? "sphere"
                              : g.shape == Shape::Cylinder ? "cylinder"
                                                           : "capsule");
    state(round, "radius", digits(g.size.x()));
    if (g.shape != Shape::Sphere) state(round, "length", digits(g.size.y()));
  }

  /// Has new ones meet all that any of the old ones meets: their bits are those of all.
  void collide_as_all(const Elements& old) const {
    for (const char* tag : {"collide_bitmask", "category_bitmask"}) {
      unsigned long bits = 0;
      for (const XMLElement* e : old) bits |= bits_of(*e, tag);
      for (XMLElement* e : fresh_)
        if (bits_of(*e, tag) != bits)
          child(child(child(*e, "surface"), "contact"), tag).SetText(std::to_string(bits).c_str());
    }
  }

  void put(const Elements& old) {
    for (XMLElement* e : old) link_.DeleteChild(e);
    for (XMLElement* e : fresh_) link_.InsertEndChild(e);
  }

 private:
  static XMLElement& child(XMLElement& of, const char* tag) {
    XMLElement* out = of.FirstChildElement(tag);
    return out != nullptr ? *out : *of.InsertNewChildElement(tag);
  }
  /// What a <collision> says of its contacts; by default all bits.
  static unsigned long bits_of(const XMLElement& collision, const char* tag) {
    constexpr unsigned long kAll = 0xFFFF;
    const XMLElement* e = collision.FirstChildElement("surface");
    if (e != nullptr) e = e->FirstChildElement("contact");
    if (e != nullptr) e = e->FirstChildElement(tag);
    const std::string text = e == nullptr ? std::string() : trimmed(e->GetText());
    if (text.empty()) return kAll;
    const bool hexadecimal = text.starts_with("0x") || text.starts_with("0X");
    return std::strtoul(text.c_str(), nullptr, hexadecimal ? 16 : 10);
  }

  tinyxml2::XMLDocument& document_;
  XMLElement& link_;
  std::vector<XMLElement*> fresh_;
};

}  // namespace

std::string sdf_with_shapes(std::string_view text, const std::string& name, const ShapeEdit& edit) {
  constexpr int kFirstWithCapsules = 8;
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  Reader reader(*document.RootElement(), name);
  reader.read();
  move_files(*document.RootElement(), edit.moved);
  for (std::size_t l = 0; l < edit.links.size(); ++l) {
    if (edit.links[l].empty() || !reader.has_element(l)) continue;
    const Elements& originals = reader.shapes(l, edit.visual);
    NewCollisions fresh(document, reader.link_element(l));
    const auto add = [&](const XMLElement& original, const std::string* file) {
      XMLElement& e = fresh.add(original, true, !edit.visual);
      if (file != nullptr)
        e.FirstChildElement("geometry")
            ->FirstChildElement("mesh")
            ->FirstChildElement("uri")
            ->SetText(file->c_str());
    };
    for (std::size_t i = 0; i < edit.links[l].size() && i < originals.size(); ++i) {
      if (!edit.links[l][i])
        add(*originals[i], nullptr);
      else
        for (const std::string& file : *edit.links[l][i]) add(*originals[i], &file);
    }
    fresh.put(reader.shapes(l, false));
  }
  std::map<std::size_t, std::vector<Primitive>> primitives = edit.primitives;
  for (auto& [l, shapes] : primitives) {
    const Elements& originals = reader.shapes(l, edit.visual);
    if (originals.empty() || !reader.has_element(l)) continue;
    if (reader.minor() < kFirstWithCapsules) shapes = without_capsules(shapes);
    NewCollisions fresh(document, reader.link_element(l));
    for (const Primitive& one : shapes) fresh.add(*originals.front(), one, !edit.visual);
    if (!edit.visual) fresh.collide_as_all(originals);
    fresh.put(reader.shapes(l, false));
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  if (!primitives.empty())
    require_primitives(parse_sdf(printer.CStr(), name).robot, reader.result().robot, primitives,
                       name);
  return printer.CStr();
}

}  // namespace kaboum::robot
