// Reads MJCF, MuJoCo's format, with the meanings and defaults of MuJoCo 4.0:
// <https://mujoco.readthedocs.io/en/stable/XMLreference.html>. tests/engines compares the two.

#include <kaboum/base/error.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

#include "link_elements.h"
#include "mjcf_classes.h"
#include "mjcf_model.h"
#include "model_words.h"
#include "xml.h"

namespace kaboum::robot {
namespace {

using tinyxml2::XMLElement;

constexpr std::size_t kMostLinks = 100'000;
constexpr const char* kWorld = "world";
/// Settings of <compiler>.
struct Compiler {
  bool degrees = true, automatic_limits = true, strips_paths = false;
  bool inertia_from_geoms = false, fits_boxes = false;
  std::string euler = "xyz", meshes, textures;
};

std::string stem_of(const std::string& file) {
  const std::size_t slash = file.find_last_of("/\\");
  const std::string name = slash == std::string::npos ? file : file.substr(slash + 1);
  return name.substr(0, name.rfind('.'));
}

class Reader {
 public:
  Reader(const XMLElement& root, const std::string& name, const MeshSource& meshes)
      : root_(root), name_(name), meshes_(meshes), classes_(name) {}

  MjcfModel read() {
    if (const char* model = root_.Attribute("model"); model != nullptr) out_.robot.name = model;
    for_each("compiler", [&](const XMLElement& e) { read_compiler(e); });
    for_each("default", [&](const XMLElement& e) { classes_.read(e); });
    for_each("asset", [&](const XMLElement& e) { read_assets(e); });
    for_each("contact", [&](const XMLElement& e) { read_pairs(e); });
    for_each("deformable", [&](const XMLElement& e) { read_deformables(e); });
    out_.mesh_folder = compiler_.meshes;
    out_.texture_folder = compiler_.textures;
    add_link(kWorld);
    for_each("worldbody", [&](const XMLElement& e) { read_body(e, 0, {}, "main", ""); });
    for (std::size_t l = 0; l < out_.robot.links.size(); ++l) show_what_collides(l);
    return std::move(out_);
  }

 private:
  template <class Action>
  void for_each(const char* tag, const Action& action) const {
    for (const auto* e = root_.FirstChildElement(tag); e != nullptr; e = e->NextSiblingElement(tag))
      action(*e);
  }

  [[noreturn]] void fail(const XMLElement& e, const std::string& what) const {
    const char* name = e.Attribute("name");
    fail_at(name_, e.GetLineNum(),
            std::string("<") + e.Name() +
                (name != nullptr ? " name=\"" + std::string(name) + "\"" : "") + ">: " + what);
  }

  // --- values -----------------------------------------------------------------------------------

  static const std::string* find(const Attributes& a, const char* key) {
    const auto found = a.find(key);
    return found == a.end() ? nullptr : &found->second;
  }

  /// @param least  number of numbers; the others are 0
  [[nodiscard]] std::vector<double> numbers(const XMLElement& e, const Attributes& a,
                                            const char* key, std::size_t least,
                                            std::size_t most) const {
    const std::string* text = find(a, key);
    if (text == nullptr) return {};
    auto out = finite_numbers(*text);
    if (!out || out->size() < least || out->size() > most)
      fail(e, std::string(key) + " is '" + text->substr(0, 60) + "', not " +
                  (least == most ? std::to_string(most)
                                 : std::to_string(least) + " to " + std::to_string(most)) +
                  (most == 1 ? " finite number" : " finite numbers"));
    return *std::move(out);
  }

  [[nodiscard]] double number(const XMLElement& e, const Attributes& a, const char* key,
                              double otherwise) const {
    const std::vector<double> x = numbers(e, a, key, 1, 1);
    return x.empty() ? otherwise : x[0];
  }

  [[nodiscard]] Vec3 vector(const XMLElement& e, const Attributes& a, const char* key,
                            const Vec3& otherwise = Vec3::Zero()) const {
    const std::vector<double> x = numbers(e, a, key, 3, 3);
    return x.empty() ? otherwise : Vec3(x[0], x[1], x[2]);
  }

  [[nodiscard]] double angle(double x) const {
    return compiler_.degrees ? x / 180.0 * std::numbers::pi : x;
  }

  /// The rotation that an element states in one of five ways.
  [[nodiscard]] Mat3 rotation(const XMLElement& e, const Attributes& a) const {
    const auto unit = [&](const Vec3& v, const char* what) {
      const double length = v.stableNorm();
      if (!(length > 1e-14) || !std::isfinite(length))
        fail(e, std::string(what) + " has no direction");
      return (v / length).eval();
    };
    if (const auto x = numbers(e, a, "axisangle", 4, 4); !x.empty())
      return Eigen::AngleAxisd(angle(x[3]), unit({x[0], x[1], x[2]}, "axisangle"))
          .toRotationMatrix();
    if (const auto x = numbers(e, a, "xyaxes", 6, 6); !x.empty()) {
      Mat3 out;
      out.col(0) = unit({x[0], x[1], x[2]}, "xyaxes");
      const Vec3 y(x[3], x[4], x[5]);
      out.col(1) = unit(y - out.col(0) * out.col(0).dot(y), "xyaxes");
      out.col(2) = out.col(0).cross(out.col(1)).normalized();
      return out;
    }
    if (const auto x = numbers(e, a, "zaxis", 3, 3); !x.empty())
      return turned_to(unit({x[0], x[1], x[2]}, "zaxis"));
    if (const auto x = numbers(e, a, "euler", 3, 3); !x.empty())
      return from_euler({angle(x[0]), angle(x[1]), angle(x[2])});
    if (const auto x = numbers(e, a, "quat", 4, 4); !x.empty()) {
      Eigen::Quaterniond q(x[0], x[1], x[2], x[3]);
      const double length = q.coeffs().stableNorm();
      if (!(length > 1e-14) || !std::isfinite(length)) fail(e, "quat is no rotation");
      q.coeffs() /= length;
      return q.normalized().toRotationMatrix();
    }
    return Mat3::Identity();
  }

  [[nodiscard]] Mat3 from_euler(const Vec3& angles) const {
    return rotation_from_euler(angles, compiler_.euler);
  }

  /// Angles that from_euler makes a rotation of, in the compiler's unit.
  [[nodiscard]] Vec3 euler_of(const XMLElement& e, const Mat3& rotation) const {
    const std::string& order = compiler_.euler;
    const bool moving = std::ranges::all_of(order, [](char c) { return c >= 'x'; });
    const bool still = std::ranges::all_of(order, [](char c) { return c < 'x'; });
    if (!(moving || still) || order[0] == order[1] || order[1] == order[2])
      fail(e, "its class turns it, and eulerseq=\"" + order +
                  "\" states not every rotation; have MuJoCo save the model (mj_saveLastXML)");
    const auto axis = [&](std::size_t i) {
      return static_cast<Eigen::Index>(order[i] - (moving ? 'x' : 'X'));
    };
    Vec3 out = moving ? rotation.eulerAngles(axis(0), axis(1), axis(2))
                      : rotation.eulerAngles(axis(2), axis(1), axis(0)).reverse().eval();
    if (compiler_.degrees) out *= 180.0 / std::numbers::pi;
    if (!from_euler({angle(out.x()), angle(out.y()), angle(out.z())}).isApprox(rotation, 1e-12))
      fail(e, "its rotation cannot be stated as euler angles, as its class states one");
    return out;
  }

  /// The least rotation of z to a direction.
  static Mat3 turned_to(const Vec3& direction) {
    Vec3 axis = Vec3::UnitZ().cross(direction);
    const double sine = axis.norm();
    if (sine < 1e-10)
      axis = Vec3::UnitX();
    else
      axis /= sine;
    return Eigen::AngleAxisd(std::atan2(sine, direction.z()), axis).toRotationMatrix();
  }

  [[nodiscard]] Transform pose(const XMLElement& e, const Attributes& a) const {
    return {rotation(e, a), vector(e, a, "pos")};
  }
  [[nodiscard]] Transform pose(const XMLElement& e) const {
    Attributes own;
    lay_over(own, e);
    return pose(e, own);
  }

  // --- what is not of bodies --------------------------------------------------------------------

  void read_compiler(const XMLElement& e) {
    const auto take = [&](const char* key, const auto& use) {
      if (const char* value = e.Attribute(key); value != nullptr) use(std::string(value));
    };
    take("angle", [&](const std::string& v) {
      if (v != "radian" && v != "degree") fail(e, "angle is '" + v + "', not radian or degree");
      compiler_.degrees = v == "degree";
    });
    take("eulerseq", [&](const std::string& v) {
      if (v.size() != 3 || v.find_first_not_of("xyzXYZ") != std::string::npos)
        fail(e, "eulerseq is '" + v + "', not three of x, y, z, X, Y and Z");
      compiler_.euler = v;
    });
    take("coordinate", [&](const std::string& v) {
      if (v != "local") fail(e, "global coordinates, which MuJoCo does not read since 2.3.3");
    });
    take("autolimits", [&](const std::string& v) { compiler_.automatic_limits = v == "true"; });
    take("strippath", [&](const std::string& v) { compiler_.strips_paths = v == "true"; });
    take("inertiafromgeom",
         [&](const std::string& v) { compiler_.inertia_from_geoms = v == "true"; });
    take("fitaabb", [&](const std::string& v) { compiler_.fits_boxes = v == "true"; });
    take("assetdir", [&](const std::string& v) { compiler_.meshes = compiler_.textures = v; });
    take("meshdir", [&](const std::string& v) { compiler_.meshes = v; });
    take("texturedir", [&](const std::string& v) { compiler_.textures = v; });
  }

  void read_assets(const XMLElement& assets) {
    for (const auto* e = assets.FirstChildElement("mesh"); e != nullptr;
         e = e->NextSiblingElement("mesh")) {
      const Attributes a = classes_.of(*e, "main");
      MjcfMesh mesh;
      mesh.element = e;
      if (const std::string* file = find(a, "file")) mesh.file = *file;
      mesh.scale = vector(*e, a, "scale", Vec3::Ones());
      mesh.reference.translation = vector(*e, a, "refpos");
      if (const auto x = numbers(*e, a, "refquat", 4, 4); !x.empty())
        mesh.reference.linear =
            Eigen::Quaterniond(x[0], x[1], x[2], x[3]).normalized().toRotationMatrix();
      if (const std::string* inertia = find(a, "inertia"); inertia != nullptr)
        mesh.inertia = *inertia;
      const char* named = e->Attribute("name");
      const std::string name = named != nullptr ? named : stem_of(mesh.file);
      if (name.empty()) fail(*e, "a mesh without name and file");
      if (!out_.meshes.emplace(name, std::move(mesh)).second)
        fail(*e, "there is a mesh '" + name + "' already");
    }
  }

  void read_pairs(const XMLElement& contact) {
    for (const auto* e = contact.FirstChildElement("pair"); e != nullptr;
         e = e->NextSiblingElement("pair"))
      for (const char* key : {"geom1", "geom2"})
        if (const char* geom = e->Attribute(key); geom != nullptr) paired_.insert(geom);
  }

  void read_deformables(const XMLElement& section) {
    for (const auto* e = section.FirstChildElement(); e != nullptr; e = e->NextSiblingElement())
      if (std::string_view(e->Name()) == "flex")
        fail(*e, "flexible bodies have no shape that bodies could hold");
      else
        note(*e, "skins are drawn only, and left as they are");
  }

  void note(const XMLElement& e, const std::string& what) {
    out_.robot.notes.push_back(name_ + ":" + std::to_string(e.GetLineNum()) + ": " + what);
  }

  // --- bodies -----------------------------------------------------------------------------------

  std::uint32_t add_link(const std::string& name) {
    if (out_.robot.links.size() >= kMostLinks)
      throw Error(ErrorCode::InvalidInput,
                  name_ + ": more than " + std::to_string(kMostLinks) + " bodies and joints");
    out_.robot.links.emplace_back();
    out_.robot.links.back().name = links_.give(name);
    out_.collision.emplace_back();
    out_.visual.emplace_back();
    out_.bodies.push_back(nullptr);
    out_.weighed_by_geoms.push_back(true);
    return static_cast<std::uint32_t>(out_.robot.links.size() - 1);
  }

  /// A link below another one, and the joint that moves it.
  std::uint32_t add_below(std::uint32_t parent, const std::string& name, Joint joint) {
    joint.parent = parent;
    out_.robot.joints.push_back(std::move(joint));
    return add_link(name);
  }

  /// Everything in a body, a frame or what is replicated.
  /// @param frame  its pose in the link
  void read_body(const XMLElement& section, std::uint32_t link, const Transform& frame,
                 const std::string& class_here, const std::string& suffix) {
    for (const auto* e = section.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view tag = e->Name();
      if (tag == "geom") {
        read_geom(*e, link, frame, class_here);
      } else if (tag == "body") {
        read_child(*e, link, frame, class_here, suffix);
      } else if (tag == "frame") {
        read_body(*e, link, frame * pose(*e), class_of(*e, class_here), suffix);
      } else if (tag == "replicate") {
        replicate(*e, link, frame, class_here, suffix);
      } else if (tag == "inertial") {
        read_inertial(*e, link, frame);
      } else if (tag == "composite" || tag == "flexcomp") {
        fail(*e, "flexible bodies have no shape that bodies could hold");
      } else if (tag == "attach") {
        fail(*e,
             "attached models are not read; have MuJoCo save the model as one (mj_saveLastXML)");
      } else if (tag != "joint" && tag != "freejoint" && tag != "site" && tag != "camera" &&
                 tag != "light" && tag != "plugin") {
        fail(*e, "no element of a body in MJCF");
      }
    }
  }

  [[nodiscard]] std::string class_of(const XMLElement& e, const std::string& class_here) const {
    const char* own = e.Attribute("childclass");
    if (own == nullptr) own = e.Attribute("class");
    if (own == nullptr) return class_here;
    classes_.require(own, e);
    return own;
  }

  void replicate(const XMLElement& e, std::uint32_t link, const Transform& frame,
                 const std::string& class_here, const std::string& suffix) {
    Attributes own;
    lay_over(own, e);
    const double count = number(e, own, "count", 0);
    if (!(count >= 1 && count <= 100'000) || count != std::floor(count))
      fail(e, "count must be a whole number from 1 to 100000");
    const Vec3 offset = vector(e, own, "offset"), turn = vector(e, own, "euler");
    const std::string* sep = find(own, "sep");
    const std::size_t digits_of_all = std::to_string(static_cast<int>(count) - 1).size();
    Vec3 place = Vec3::Zero();
    for (int i = 0; i < static_cast<int>(count); ++i) {
      const Mat3 linear =
          from_euler({angle(i * turn.x()), angle(i * turn.y()), angle(i * turn.z())});
      std::string number = std::to_string(i);
      number.insert(0, digits_of_all - number.size(), '0');
      if (sep != nullptr) number.insert(0, *sep);
      read_body(e, link, frame * Transform{linear, place}, class_of(e, class_here),
                suffix + number);
      place += linear * offset;
    }
  }

  /// A joint of a body, in the body's frame.
  struct BodyJoint {
    const XMLElement* element;
    Attributes attributes;
    Transform frame;
  };

  void collect_joints(const XMLElement& section, const Transform& frame,
                      const std::string& class_here, std::vector<BodyJoint>& out) const {
    for (const auto* e = section.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      const std::string_view tag = e->Name();
      if (tag == "joint") out.push_back({e, classes_.of(*e, class_here), frame});
      if (tag == "freejoint") out.push_back({e, {{"type", "free"}}, frame});
      if (tag == "frame") collect_joints(*e, frame * pose(*e), class_of(*e, class_here), out);
    }
  }

  void read_child(const XMLElement& e, std::uint32_t parent, const Transform& frame,
                  const std::string& class_here, const std::string& suffix) {
    const std::string class_inside = class_of(e, class_here);
    const char* named = e.Attribute("name");
    const std::string name =
        named != nullptr ? named + suffix : "body" + std::to_string(out_.robot.links.size());
    std::vector<BodyJoint> joints;
    collect_joints(e, {}, class_inside, joints);
    const char* mocap = e.Attribute("mocap");
    bool is_unmodelled = mocap != nullptr && std::string_view(mocap) == "true";
    if (is_unmodelled) unmodelled(e, "body '" + name + "' is moved from outside (mocap)");
    Transform ahead = frame * pose(e);  // from the link that comes next to the last one
    std::uint32_t link = parent;
    bool is_body = false;  // the last link has the body's frame
    for (std::size_t i = 0; i < joints.size(); ++i) {
      Joint joint;
      Vec3 anchor;
      if (!take_joint(joints[i], name, suffix, joint, anchor)) {
        is_unmodelled = true;
        continue;
      }
      joint.origin = ahead;
      joint.origin.translation += ahead.linear * anchor;
      is_body = i + 1 == joints.size() && anchor.isZero(0);
      link = add_below(link, is_body ? name : name + ":" + joint.name, joint);
      ahead = {Mat3::Identity(), -anchor};
    }
    if (!is_body) {
      Joint fixed;
      fixed.name = joint_names_.give(name + ":fixed");
      fixed.origin = ahead;
      fixed.unmodelled = is_unmodelled;
      link = add_below(link, name, fixed);
    }
    out_.bodies[link] = &e;
    read_body(e, link, {}, class_inside, suffix);
  }

  void unmodelled(const XMLElement& e, const std::string& what) {
    out_.robot.unmodelled.push_back(name_ + ":" + std::to_string(e.GetLineNum()) + ": " + what);
  }

  /// @return false: one that is fixed here, and is named as such
  bool take_joint(const BodyJoint& given, const std::string& body, const std::string& suffix,
                  Joint& joint, Vec3& anchor) {
    const XMLElement& e = *given.element;
    const Attributes& a = given.attributes;
    const std::string* kind = find(a, "type");
    const std::string type = kind == nullptr ? "hinge" : *kind;
    const char* named = e.Attribute("name");
    joint.name = joint_names_.give(named != nullptr ? named + suffix : body + ":" + type);
    if (type == "free" || type == "ball") {
      unmodelled(e, "joint '" + joint.name + "' is " +
                        (type == "free" ? "free: it moves in six ways" : "a ball joint"));
      return false;
    }
    if (type != "hinge" && type != "slide")
      fail(e, "a joint of type '" + type + "'; MJCF has hinge, slide, ball and free");
    joint.type = type == "hinge" ? JointType::Revolute : JointType::Prismatic;
    const Vec3 axis = given.frame.linear * vector(e, a, "axis", Vec3::UnitZ());
    const double length = axis.stableNorm();
    if (!(length > 1e-14) || !std::isfinite(length)) fail(e, "the axis has no direction");
    joint.axis = (axis / length).normalized();
    anchor = type == "hinge" ? given.frame * vector(e, a, "pos") : Vec3::Zero();
    const auto value = [&](double x) { return type == "hinge" ? angle(x) : x; };
    joint.offset = -value(number(e, a, "ref", 0));
    joint.variable = static_cast<std::uint32_t>(out_.robot.variables.size());
    Variable variable;
    variable.name = joint.name;
    const std::vector<double> range = numbers(e, a, "range", 2, 2);
    const std::string* limited = find(a, "limited");
    const bool is_limited =
        limited != nullptr && *limited != "auto"
            ? *limited == "true"
            : compiler_.automatic_limits && !range.empty() && range[0] < range[1];
    if (is_limited) {
      if (range.empty() || !(range[0] < range[1])) fail(e, "a limited joint without a range");
      variable.lower = value(range[0]);
      variable.upper = value(range[1]);
    }
    JointDynamics dynamics;
    dynamics.damping = std::max(
        0.0, numbers(e, a, "damping", 1, 3).empty() ? 0.0 : numbers(e, a, "damping", 1, 3)[0]);
    dynamics.friction = std::max(0.0, number(e, a, "frictionloss", 0));
    dynamics.lower = variable.lower;
    dynamics.upper = variable.upper;
    if (const auto force = numbers(e, a, "actuatorfrcrange", 2, 2); !force.empty())
      if (const double most = std::max(std::abs(force[0]), std::abs(force[1])); most > 0)
        dynamics.effort = most;
    out_.dynamics.joints.emplace(joint.name, dynamics);
    out_.robot.variables.push_back(std::move(variable));
    return true;
  }

  void read_inertial(const XMLElement& e, std::uint32_t link, const Transform& frame) {
    Attributes a;
    lay_over(a, e);
    Inertial out;
    out.origin = frame * pose(e, a);
    out.mass = number(e, a, "mass", 0);
    if (const auto x = numbers(e, a, "fullinertia", 6, 6); !x.empty())
      out.inertia << x[0], x[3], x[4], x[3], x[1], x[5], x[4], x[5], x[2];
    else
      out.inertia = vector(e, a, "diaginertia").asDiagonal();
    out_.dynamics.links.emplace(out_.robot.links[link].name, out);
    if (!compiler_.inertia_from_geoms) out_.weighed_by_geoms[link] = false;
  }

  // --- shapes -----------------------------------------------------------------------------------

  void read_geom(const XMLElement& e, std::uint32_t link, const Transform& frame,
                 const std::string& class_here) {
    const Attributes a = classes_.of(e, class_here);
    const std::string* kind = find(a, "type");
    const std::string type = kind == nullptr ? "sphere" : *kind;
    const int by_class = classes_.rotates(e, class_here), own = rotation_of(e);
    if (by_class > own && (own >= 0 || e.Attribute("quat") != nullptr))
      note(e, std::string("a geom's own rotation stands for the ") +
                  kOtherRotations[static_cast<std::size_t>(by_class)] +
                  " of its class, as in MuJoCo 4.0; in 2.2.2 that of the class counts");
    const bool collides =
        number(e, a, "contype", 1) != 0 || number(e, a, "conaffinity", 1) != 0 || paired(e);
    if (type == "plane" || type == "hfield") {
      out_.robot.links[link].unread.push_back(
          {!collides, type == "plane" ? "a plane" : "a height field"});
      note(e, type == "plane"
                  ? "a plane of the world, which is no link's shape, stays as it is"
                  : "a height field of the world, which is no link's shape, stays as it is");
      return;
    }
    Geometry g;
    g.line = e.GetLineNum();
    const std::string* mesh = find(a, "mesh");
    if (type == "sdf") fail(e, "a signed distance field, of which no triangles are known");
    if (type == "mesh")
      place_mesh(e, a, g);
    else if (mesh != nullptr)
      place_fitted(e, a, type, by_class >= 0, g);
    else
      place_primitive(e, a, type, g);
    g.origin = frame * g.origin;
    Link& to = out_.robot.links[link];
    (collides ? to.collision : to.visual).push_back(std::move(g));
    (collides ? out_.collision : out_.visual)[link].push_back(&e);
    out_.geoms.emplace(&e, a);
  }

  [[nodiscard]] bool paired(const XMLElement& e) const {
    const char* name = e.Attribute("name");
    return name != nullptr && paired_.contains(name);
  }

  /// The asset that a geom names.
  [[nodiscard]] const MjcfMesh& mesh_of(const XMLElement& e, const Attributes& a) const {
    const std::string* name = find(a, "mesh");
    if (name == nullptr) fail(e, "a geom of type mesh without a mesh");
    const auto found = out_.meshes.find(*name);
    if (found == out_.meshes.end()) fail(e, "there is no mesh '" + *name + "'");
    const MjcfMesh& mesh = found->second;
    if (mesh.file.empty())
      fail(*mesh.element,
           "a mesh without a file: its vertices are in the document, or made by MuJoCo");
    if ((mesh.scale.array() == 0).any()) fail(*mesh.element, "a mesh scaled by 0");
    return mesh;
  }

  [[nodiscard]] geom::Mesh read_mesh(const XMLElement& e, const std::string& file) const {
    try {
      return meshes_(file);
    } catch (const Error& error) {
      fail(e, std::string("the mesh that it is fitted to: ") + error.what());
    }
  }

  void place_fitted(const XMLElement& e, const Attributes& a, const std::string& type,
                    bool turned_by_class, Geometry& g) {
    const MjcfMesh& mesh = mesh_of(e, a);
    if (!meshes_)
      fail(e, "a " + type + " that MuJoCo fits to the mesh '" + a.at("mesh") +
                  "': its size is not stated");
    if (e.Attribute("mesh") == nullptr)
      fail(e, "a " + type + " that MuJoCo fits to the mesh of its class; name the mesh here");
    if (mesh.inertia == "convex")
      fail(e, "a " + type + " that MuJoCo fits to the hull of the mesh '" + a.at("mesh") +
                  "'; have MuJoCo save the model (mj_saveLastXML), which states its size");
    if (find(a, "fromto") != nullptr) fail(e, "both fromto and a mesh");
    g.shape = kind_of(e, type).first;
    MjcfFit fit =
        fit_to_mesh(g.shape, mesh, read_mesh(e, file_of(mesh.file)), compiler_.fits_boxes);
    fit.size *= number(e, a, "fitscale", 1);
    fit.pose = pose(e, a) * fit.pose;
    if (turned_by_class) fit.euler = euler_of(e, fit.pose.linear);
    g.origin = fit.pose;
    require_positive(e, type, {fit.size.x(), fit.size.y(), fit.size.z()});
    set_size(g, {fit.size.x(), fit.size.y(), fit.size.z()});
    out_.fitted[&e] = fit;
  }

  void place_mesh(const XMLElement& e, const Attributes& a, Geometry& g) const {
    const MjcfMesh& mesh = mesh_of(e, a);
    g.shape = Geometry::Shape::Mesh;
    g.mesh = file_of(mesh.file);
    g.size = mesh.scale;
    g.origin = pose(e, a);
    if (is_identity(mesh.reference)) return;
    const bool turned = !mesh.reference.linear.isIdentity(0);
    if (turned && (mesh.scale.array() != mesh.scale.x()).any())
      fail(*mesh.element, "a refquat beside different scales along the axes");
    const Mat3 back = mesh.reference.linear.transpose();
    const Vec3 shift = mesh.scale.cwiseProduct(back * mesh.reference.translation);
    g.origin = g.origin * Transform{back, -shift};
  }

  /// A mesh's file, relative to the model's folder.
  [[nodiscard]] std::string file_of(std::string file) const {
    std::ranges::replace(file, '\\', '/');
    if (compiler_.strips_paths) file = file.substr(file.find_last_of('/') + 1);
    if (compiler_.meshes.empty() || file.starts_with('/')) return file;
    return compiler_.meshes + (compiler_.meshes.ends_with('/') ? "" : "/") + file;
  }

  /// A primitive, and how many numbers its size has.
  using Kind = std::pair<Geometry::Shape, std::size_t>;

  [[nodiscard]] Kind kind_of(const XMLElement& e, const std::string& type) const {
    using Shape = Geometry::Shape;
    static const std::map<std::string, Kind> kinds{{"sphere", {Shape::Sphere, 1}},
                                                   {"capsule", {Shape::Capsule, 2}},
                                                   {"ellipsoid", {Shape::Ellipsoid, 3}},
                                                   {"cylinder", {Shape::Cylinder, 2}},
                                                   {"box", {Shape::Box, 3}}};
    const auto found = kinds.find(type);
    if (found == kinds.end()) fail(e, "a geom of type '" + type + "'");
    return found->second;
  }

  void require_positive(const XMLElement& e, const std::string& type,
                        const std::vector<double>& size) const {
    for (std::size_t i = 0; i < kind_of(e, type).second; ++i)
      if (!(size[i] > 0)) fail(e, "a " + type + " whose size is not positive");
  }

  void place_primitive(const XMLElement& e, const Attributes& a, const std::string& type,
                       Geometry& g) const {
    using Shape = Geometry::Shape;
    const auto [shape, sizes] = kind_of(e, type);
    g.shape = shape;
    std::vector<double> size = numbers(e, a, "size", 0, 3);
    size.resize(3, 0);
    const std::vector<double> ends = numbers(e, a, "fromto", 6, 6);
    if (ends.empty()) {
      g.origin = pose(e, a);
    } else {
      if (g.shape == Shape::Sphere) fail(e, "fromto is not for spheres");
      const Vec3 from(ends[0], ends[1], ends[2]), to(ends[3], ends[4], ends[5]);
      if (!vector(e, a, "pos").isZero(0)) fail(e, "both pos and fromto");
      const double length = (from - to).norm();
      if (!(length > 1e-14) || !std::isfinite(length))
        fail(e, "the points of fromto are too close");
      g.origin = {turned_to((from - to) / length), (from + to) / 2};
      size[1] = length / 2;
      if (sizes == 3) {
        size[2] = size[1];
        size[1] = size[0];
      }
    }
    require_positive(e, type, size);
    set_size(g, size);
  }

  /// From half lengths, as MJCF has them.
  static void set_size(Geometry& g, const std::vector<double>& half) {
    switch (g.shape) {
      case Geometry::Shape::Box:
        g.size = 2 * Vec3(half[0], half[1], half[2]);
        break;
      case Geometry::Shape::Cylinder:
      case Geometry::Shape::Capsule:
        g.size = {half[0], 2 * half[1], 2 * half[1]};
        break;
      case Geometry::Shape::Ellipsoid:
        g.size = {half[0], half[1], half[2]};
        break;
      case Geometry::Shape::Sphere:
      case Geometry::Shape::Mesh:
        g.size = Vec3::Constant(half[0]);
        break;
    }
  }

  /// MuJoCo draws what collides where nothing else is there to be drawn.
  void show_what_collides(std::size_t l) {
    Link& link = out_.robot.links[l];
    if (!link.visual.empty()) return;
    link.visual = link.collision;
    out_.visual[l] = out_.collision[l];
  }

  const XMLElement& root_;
  const std::string& name_;
  const MeshSource& meshes_;
  DefaultClasses classes_;
  Compiler compiler_;
  MjcfModel out_;
  UniqueNames links_, joint_names_;
  std::set<std::string> paired_;  // names of geoms
};

const XMLElement& root_of(const tinyxml2::XMLDocument& document, const std::string& name) {
  const XMLElement& root = *document.RootElement();
  if (std::string_view(root.Name()) != "mujoco")
    fail_at(name, root.GetLineNum(), std::string("expected <mujoco>, found <") + root.Name() + ">");
  return root;
}

}  // namespace

std::string state_fitted_sizes(std::string_view text, const std::string& name,
                               const MeshSource& meshes) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  const MjcfModel model = read_mjcf(document, name, meshes);
  if (model.fitted.empty()) return std::string(text);
  for (const auto& [element, fit] : model.fitted) {
    auto& e = *const_cast<XMLElement*>(element);  // of our document
    for (const char* key : kOtherRotations) e.DeleteAttribute(key);
    e.DeleteAttribute("quat");
    e.DeleteAttribute("mesh");
    e.DeleteAttribute("fitscale");
    e.SetAttribute("type", model.geoms.at(element).contains("type")
                               ? model.geoms.at(element).at("type").c_str()
                               : "sphere");
    e.SetAttribute("size", digits(fit.size).c_str());
    e.SetAttribute("pos", digits(fit.pose.translation).c_str());
    const std::array<double, 4> q = quaternion(fit.pose.linear);
    if (fit.euler)
      e.SetAttribute("euler", digits(*fit.euler).c_str());
    else
      e.SetAttribute("quat", digits({q[0], q[1], q[2], q[3]}).c_str());
  }
  tinyxml2::XMLPrinter printer;
  document.Print(&printer);
  return printer.CStr();
}

Mat3 rotation_from_euler(const Vec3& angles, const std::string& order) {
  Eigen::Quaterniond q = Eigen::Quaterniond::Identity();
  for (int i = 0; i < 3; ++i) {
    const char axis = order[static_cast<std::size_t>(i)];
    const bool moving = axis >= 'x';
    const Vec3 about = Vec3::Unit(axis - (moving ? 'x' : 'X'));
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angles[i], about));
    q = moving ? q * turn : turn * q;
  }
  return q.normalized().toRotationMatrix();
}

MjcfModel read_mjcf(const tinyxml2::XMLDocument& document, const std::string& name,
                    const MeshSource& meshes) {
  MjcfModel out = Reader(root_of(document, name), name, meshes).read();
  try {
    require_valid(out.robot);
  } catch (const Error& error) {
    throw Error(error.code(), name + ": " + error.what());
  }
  return out;
}

LinkElements mjcf_links(const tinyxml2::XMLDocument& document, const std::string& name) {
  MjcfModel model = read_mjcf(document, name);
  std::map<const XMLElement*, std::size_t> copies;
  for (const XMLElement* body : model.bodies) ++copies[body];
  LinkElements out;
  out.inertials = std::move(model.dynamics.links);
  for (std::size_t l = 0; l < model.bodies.size(); ++l)
    if (const XMLElement* body = model.bodies[l]; body != nullptr && copies[body] == 1)
      out.elements.emplace(model.robot.links[l].name, body);
  return out;
}

MjcfRobot parse_mjcf(std::string_view text, const std::string& name) {
  tinyxml2::XMLDocument document;
  parse_xml(document, text, name);
  return read_mjcf(document, name);
}

}  // namespace kaboum::robot
