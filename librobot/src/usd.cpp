// Writes USD with UsdPhysics as text:
// <https://openusd.org/release/api/usd_physics_page_front.html>.

#include <kaboum/base/error.h>
#include <kaboum/geom/float32.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/usd.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <set>
#include <string_view>

#include "model_words.h"

namespace kaboum::robot {
namespace {

/// Lines of text, indented by how deep they are.
class Lines {
 public:
  void add(std::initializer_list<std::string_view> parts) {
    text_.append(4 * depth_, ' ');
    for (const std::string_view part : parts) text_ += part;
    text_ += '\n';
  }
  void open(std::initializer_list<std::string_view> parts) {
    add(parts);
    ++depth_;
  }
  void close(std::string_view bracket) {
    --depth_;
    add({bracket});
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  std::string text_;
  std::size_t depth_ = 0;
};

std::string tuple(std::initializer_list<double> numbers) {
  std::string out = "(";
  for (const double x : numbers) {
    if (out.size() > 1) out += ", ";
    out += digits(x);
  }
  out += ')';
  return out;
}

std::string tuple(const Vec3& v) { return tuple({v.x(), v.y(), v.z()}); }

/// The nearest float32, for what UsdPhysics keeps in such.
double rounded(double x) { return geom::to_float32(x); }

std::string rounded_tuple(const Vec3& v) {
  return tuple({rounded(v.x()), rounded(v.y()), rounded(v.z())});
}

std::string rounded_quaternion(const Mat3& rotation) {
  const auto [w, x, y, z] = quaternion(rotation);
  return tuple({rounded(w), rounded(x), rounded(y), rounded(z)});
}

std::string in_quotes(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') out += '\\';
    out += c == '\n' || c == '\r' ? ' ' : c;
  }
  out += '"';
  return out;
}

/// A name as an identifier of USD.
std::string identifier(const std::string& name) {
  std::string out;
  for (const char c : name) {
    const bool letter = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
    const bool digit = c >= '0' && c <= '9';
    if (digit && out.empty()) out += '_';
    out += letter || digit ? c : '_';
  }
  return out.empty() ? "_" : out;
}

/// The rotation that takes the x axis to a unit vector.
Mat3 from_x_axis(const Vec3& axis) {
  return Eigen::Quaterniond::FromTwoVectors(Vec3::UnitX(), axis).toRotationMatrix();
}

class UsdWriter {
 public:
  UsdWriter(const Model& model, const MeshOfFile& mesh_of)
      : model_(model), robot_(model.robot), mesh_of_(mesh_of) {}

  ModelText write() {
    require_valid(robot_);
    name_all();
    lines_.add({"#usda 1.0"});
    lines_.open({"("});
    lines_.add({"defaultPrim = \"", root_, "\""});
    lines_.add({"kilogramsPerUnit = 1"});
    lines_.add({"metersPerUnit = 1"});
    lines_.add({"upAxis = \"Z\""});
    lines_.close(")");
    lines_.add({""});
    begin_prim("Xform", root_, robot_.name, {"PhysicsArticulationRootAPI"}, true);
    const std::vector<Transform> poses =
        forward(robot_, std::vector<double>(robot_.variables.size(), 0));
    for (std::size_t l = 0; l < robot_.links.size(); ++l)
      if (!is_world(l)) add_link(l, poses[l]);
    begin_prim("Scope", "joints", "joints", {});
    if (!is_world(0)) add_root_joint();
    for (std::size_t j = 0; j < robot_.joints.size(); ++j) add_joint(j);
    lines_.close("}");
    lines_.close("}");
    return {lines_.take(), std::move(notes_)};
  }

 private:
  /// The world itself, to which joints may go without a body.
  [[nodiscard]] bool is_world(std::size_t link) const {
    return link == 0 && robot_.links[0].name == "world" && robot_.links[0].collision.empty();
  }

  static std::string unique(const std::string& wish, std::set<std::string>& taken) {
    std::string out = identifier(wish);
    for (int n = 2; !taken.insert(out).second; ++n) {
      out = identifier(wish);
      out += '_';
      out += std::to_string(n);
    }
    return out;
  }

  void name_all() {
    root_ = identifier(robot_.name.empty() ? "robot" : robot_.name);
    std::set<std::string> links{"joints"}, joints{"world"};
    for (const Link& link : robot_.links) links_.push_back(unique(link.name, links));
    for (const Joint& joint : robot_.joints) joints_.push_back(unique(joint.name, joints));
  }

  void begin_prim(const std::string& type, const std::string& name, const std::string& own_name,
                  std::initializer_list<std::string_view> schemas, bool component = false) {
    std::string list;
    for (const std::string_view schema : schemas) {
      list += list.empty() ? "\"" : ", \"";
      list += schema;
      list += '"';
    }
    const bool renamed = name != own_name && !own_name.empty();
    if (component || !list.empty() || renamed) {
      lines_.open({"def ", type, " \"", name, "\" ("});
      if (component) lines_.add({"kind = \"component\""});
      if (!list.empty()) lines_.add({"prepend apiSchemas = [", list, "]"});
      if (renamed) lines_.add({"displayName = ", in_quotes(own_name)});
      lines_.close(")");
    } else {
      lines_.add({"def ", type, " \"", name, "\""});
    }
    lines_.open({"{"});
  }

  void add_pose(const Transform& pose, const Vec3& scale) {
    const auto [w, x, y, z] = quaternion(pose.linear);
    lines_.add({"double3 xformOp:translate = ", tuple(pose.translation)});
    lines_.add({"quatd xformOp:orient = ", tuple({w, x, y, z})});
    lines_.add({"double3 xformOp:scale = ", tuple(scale)});
    lines_.add(
        {"uniform token[] xformOpOrder = [\"xformOp:translate\", \"xformOp:orient\", "
         "\"xformOp:scale\"]"});
  }

  void add_link(std::size_t l, const Transform& pose) {
    const Link& link = robot_.links[l];
    const auto found = model_.dynamics.links.find(link.name);
    const auto inertial = found == model_.dynamics.links.end()
                              ? std::nullopt
                              : sound_inertial(link.name, found->second, notes_);
    if (inertial)
      begin_prim("Xform", links_[l], link.name, {"PhysicsRigidBodyAPI", "PhysicsMassAPI"});
    else
      begin_prim("Xform", links_[l], link.name, {"PhysicsRigidBodyAPI"});
    if (inertial) add_inertial(*inertial);
    add_pose(pose, Vec3::Ones());
    std::size_t count = 0;
    for (const Geometry& g : link.collision)
      if (!is_point(g)) add_shape(link, g, "body_" + std::to_string(count++));
    lines_.close("}");
  }

  void add_inertial(const Inertial& inertial) {
    const Mat3 turned =
        inertial.origin.linear * inertial.inertia * inertial.origin.linear.transpose();
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(turned);
    Mat3 axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(2) = -axes.col(2);
    lines_.add({"float physics:mass = ", digits(rounded(inertial.mass))});
    lines_.add({"point3f physics:centerOfMass = ", rounded_tuple(inertial.origin.translation)});
    lines_.add({"float3 physics:diagonalInertia = ", rounded_tuple(solver.eigenvalues())});
    lines_.add({"quatf physics:principalAxes = ", rounded_quaternion(axes)});
  }

  void add_shape(const Link& link, const Geometry& g, const std::string& name) {
    using Shape = Geometry::Shape;
    if (g.shape == Shape::Mesh) {
      add_mesh(link, g, name);
      return;
    }
    const Vec3 size = solid_size(g);
    const char* type = g.shape == Shape::Box        ? "Cube"
                       : g.shape == Shape::Cylinder ? "Cylinder"
                       : g.shape == Shape::Capsule  ? "Capsule"
                                                    : "Sphere";
    begin_prim(type, name, name, {"PhysicsCollisionAPI"});
    Vec3 scale = Vec3::Ones();
    if (g.shape == Shape::Box) {
      lines_.add({"float3[] extent = [(-0.5, -0.5, -0.5), (0.5, 0.5, 0.5)]"});
      lines_.add({"double size = 1"});
      scale = size;
    } else if (g.shape == Shape::Ellipsoid) {
      lines_.add({"float3[] extent = [(-1, -1, -1), (1, 1, 1)]"});
      lines_.add({"double radius = 1"});
      scale = size;
    } else {
      const double r = size.x();
      const double half = g.shape == Shape::Sphere    ? r
                          : g.shape == Shape::Capsule ? size.y() / 2 + r
                                                      : size.y() / 2;
      if (g.shape != Shape::Sphere) {
        lines_.add({"uniform token axis = \"Z\""});
        lines_.add({"double height = ", digits(size.y())});
      }
      const Vec3 most{r, r, half};
      lines_.add({"float3[] extent = [", rounded_tuple(-most), ", ", rounded_tuple(most), "]"});
      lines_.add({"double radius = ", digits(r)});
    }
    add_pose(g.origin, scale);
    lines_.close("}");
  }

  void add_mesh(const Link& link, const Geometry& g, const std::string& name) {
    const geom::Mesh* mesh = mesh_of_(g.mesh);
    if (mesh == nullptr) {
      notes_.push_back("Link '" + link.name + "' keeps " + g.mesh +
                       ", which is LEFT OUT of USD: it is no convex body.");
      return;
    }
    begin_prim("Mesh", name, name, {"PhysicsCollisionAPI", "PhysicsMeshCollisionAPI"});
    geom::Box3 box;
    std::string counts, indices, points;
    const auto add = [](std::string& list, const std::string& item) {
      if (!list.empty()) list += ", ";
      list += item;
    };
    for (const Vec3& p : mesh->vertices) {
      if (!geom::is_float32(p))
        throw Error(ErrorCode::OutputFailed,
                    "link '" + link.name + "': float32, which USD has, does not hold a vertex of " +
                        g.mesh);
      box.extend(p);
      add(points, tuple(p));
    }
    for (const geom::Triangle& t : mesh->triangles) {
      add(counts, "3");
      for (const std::uint32_t v : t) add(indices, std::to_string(v));
    }
    lines_.add({"float3[] extent = [", tuple(box.min), ", ", tuple(box.max), "]"});
    lines_.add({"int[] faceVertexCounts = [", counts, "]"});
    lines_.add({"int[] faceVertexIndices = [", indices, "]"});
    // A scale that mirrors leaves the order of corners as it is, which is left-handed then.
    lines_.add({"uniform token physics:approximation = \"convexHull\""});
    lines_.add({"point3f[] points = [", points, "]"});
    lines_.add({"uniform token subdivisionScheme = \"none\""});
    add_pose(g.origin, g.size);
    lines_.close("}");
  }

  [[nodiscard]] std::string path(std::size_t link) const {
    std::string out = "</";
    for (const std::string_view part : {std::string_view(root_), std::string_view("/"),
                                        std::string_view(links_[link]), std::string_view(">")})
      out += part;
    return out;
  }

  void add_root_joint() {
    begin_prim("PhysicsFixedJoint", "world", "world", {});
    lines_.add({"rel physics:body1 = ", path(0)});
    lines_.close("}");
  }

  void add_joint(std::size_t j) {
    const Joint& joint = robot_.joints[j];
    const Variable* variable =
        joint.type == JointType::Fixed ? nullptr : &robot_.variables[joint.variable];
    const char* type = joint.type == JointType::Revolute    ? "PhysicsRevoluteJoint"
                       : joint.type == JointType::Prismatic ? "PhysicsPrismaticJoint"
                                                            : "PhysicsFixedJoint";
    begin_prim(type, joints_[j], joint.name, {});
    const Mat3 turn = variable != nullptr ? from_x_axis(joint.axis) : Mat3::Identity();
    if (variable != nullptr) lines_.add({"uniform token physics:axis = \"X\""});
    if (!is_world(joint.parent)) lines_.add({"rel physics:body0 = ", path(joint.parent)});
    lines_.add({"rel physics:body1 = ", path(j + 1)});
    lines_.add({"point3f physics:localPos0 = ", rounded_tuple(joint.origin.translation)});
    lines_.add({"point3f physics:localPos1 = (0, 0, 0)"});
    lines_.add({"quatf physics:localRot0 = ", rounded_quaternion(joint.origin.linear * turn)});
    lines_.add({"quatf physics:localRot1 = ", rounded_quaternion(turn)});
    if (variable != nullptr) add_limits(joint, *variable);
    lines_.close("}");
  }

  void add_limits(const Joint& joint, const Variable& variable) {
    const Joint& leader = leader_of(robot_, joint);
    if (&leader != &joint)
      notes_.push_back("Joint '" + joint.name +
                       "' mimics another one, which UsdPhysics cannot say: it moves by itself.");
    // The values of the joint itself, in degrees where it turns.
    const double unit = joint.type == JointType::Revolute ? 180 / std::numbers::pi : 1;
    const auto own = [&](double q) { return (joint.multiplier * q + joint.offset) * unit; };
    if (!variable.lower || !variable.upper) return;
    const auto [lower, upper] = std::minmax({own(*variable.lower), own(*variable.upper)});
    lines_.add({"float physics:lowerLimit = ", digits(rounded(lower))});
    lines_.add({"float physics:upperLimit = ", digits(rounded(upper))});
  }

  const Model& model_;
  const Robot& robot_;
  const MeshOfFile& mesh_of_;
  Lines lines_;
  std::string root_;
  std::vector<std::string> links_, joints_, notes_;
};

}  // namespace

ModelText to_usd(const Model& model, const MeshOfFile& mesh_of) {
  return UsdWriter(model, mesh_of).write();
}

}  // namespace kaboum::robot
