#include "robots.h"

#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>

namespace kaboum::test {
namespace {

namespace fs = std::filesystem;

LinkBody box_body(std::uint32_t link, const Vec3& size, const Vec3& centre) {
  Geometry g;
  g.shape = Geometry::Shape::Box;
  g.size = size;
  g.origin.translation = centre;
  return {"body " + std::to_string(link), link, bounding_points(g), 0};
}

void add_joint(Robot& robot, JointType type, const Vec3& axis, const Transform& origin) {
  const auto n = static_cast<std::uint32_t>(robot.links.size());
  robot.links.push_back({"link " + std::to_string(n), {}, {}});
  Joint joint;
  joint.name = "joint " + std::to_string(n);
  joint.type = type;
  joint.parent = n - 1;
  joint.origin = origin;
  joint.axis = axis.normalized();
  joint.variable = static_cast<std::uint32_t>(robot.variables.size());
  robot.variables.push_back({joint.name, {}, {}});
  robot.joints.push_back(std::move(joint));
}

fs::path folder() {
  const char* meshes = std::getenv("KABOUM_MESHES");
  return meshes != nullptr ? fs::path(meshes) / "robots" : fs::path();
}

void add_mesh(TestRobot& out, std::uint32_t link, const fs::path& file, const Transform& origin,
              const Vec3& scale) {
  const io::ReadResult read = io::read_mesh(file);
  // A convex body as small as those of a decomposition: the extreme vertices in some directions.
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::set<std::size_t> extreme;
  for (int i = 0; i < 40; ++i) {
    const Vec3 d(normal(random), normal(random), normal(random));
    std::size_t best = 0;
    for (std::size_t v = 0; v < read.mesh.vertices.size(); ++v)
      if (d.dot(read.mesh.vertices[v]) > d.dot(read.mesh.vertices[best])) best = v;
    extreme.insert(best);
  }
  LinkBody body{out.robot.links[link].name, link, {}, 0};
  for (const std::size_t v : extreme)
    body.points.emplace_back(origin * read.mesh.vertices[v].cwiseProduct(scale));
  out.bodies.push_back(std::move(body));
}

TestRobot from_urdf(const std::string& name, const std::string& path) {
  TestRobot out{name, parse_urdf(robot_file(path), path), {}};
  const std::string scheme = "package://";
  for (std::uint32_t l = 0; l < out.robot.links.size(); ++l) {
    for (const Geometry& g : out.robot.links[l].collision) {
      if (g.shape == Geometry::Shape::Mesh) {
        add_mesh(out, l, folder() / g.mesh.substr(scheme.size()), g.origin, g.size);
      } else {
        out.bodies.push_back({out.robot.links[l].name, l, bounding_points(g), 0});
      }
    }
  }
  return out;
}

}  // namespace

TestRobot six_axis_arm() {
  TestRobot out{"six-axis arm", {}, {}};
  out.robot.links.push_back({"base", {}, {}});
  const Vec3 y = Vec3::UnitY(), z = Vec3::UnitZ();
  const std::array<std::pair<Vec3, Vec3>, 6> joints{{{z, {0, 0, 0.3}},
                                                     {y, {0, 0, 0.1}},
                                                     {y, {0, 0, 0.45}},
                                                     {z, {0, 0, 0.2}},
                                                     {y, {0, 0, 0.23}},
                                                     {z, {0, 0, 0.08}}}};
  for (const auto& [axis, offset] : joints)
    add_joint(out.robot, JointType::Revolute, axis, {Mat3::Identity(), offset});
  const std::array<double, 6> length{0.1, 0.45, 0.2, 0.23, 0.08, 0.1};
  for (std::uint32_t l = 1; l <= 6; ++l) {
    const double width = 0.1 - 0.01 * l;
    out.bodies.push_back(box_body(l, {width, width, length[l - 1]}, {0, 0, length[l - 1] / 2}));
  }
  return out;
}

TestRobot prismatic_chain() {
  TestRobot out{"chain with prismatic joints", {}, {}};
  out.robot.links.push_back({"base", {}, {}});
  add_joint(out.robot, JointType::Revolute, {0.1, 0.2, 1}, {Mat3::Identity(), {0.2, 0, 0.1}});
  add_joint(out.robot, JointType::Prismatic, {1, 0.3, -0.2},
            {rotation_from_rpy(0.3, -0.8, 0.5), {0.1, 0.1, 0.2}});
  add_joint(out.robot, JointType::Revolute, {0, 1, 0.4},
            {rotation_from_rpy(1, 0.2, -2), {0, 0.15, 0.1}});
  add_joint(out.robot, JointType::Prismatic, {0, 0, 1},
            {rotation_from_rpy(-0.4, 1.2, 0), {0.1, 0, 0}});
  add_joint(out.robot, JointType::Revolute, {1, -1, 0.2},
            {rotation_from_rpy(0, 0.1, 0.7), {0, 0, 0.2}});
  for (std::uint32_t l = 0; l <= 5; ++l)
    out.bodies.push_back(box_body(l, {0.1, 0.05 + 0.02 * l, 0.2}, {0.02 * l, 0.01, 0.1}));
  return out;
}

std::string robot_file(const std::string& path) {
  const fs::path file = folder() / path;
  if (folder().empty() || !fs::is_regular_file(file)) return {};
  const std::vector<char> bytes = io::read_file(file);
  return {bytes.begin(), bytes.end()};
}

std::vector<TestRobot> real_robots() {
  std::vector<TestRobot> out;
  const std::string ur5 = "ur5-description/urdf/ur5-robot.urdf";
  const std::string kr120 = "kuka-kr120-support/urdf/kr120r2500pro.urdf";
  const std::string puma = "puma560-vrml/unimation-puma560-rlkin.xml";
  if (!robot_file(ur5).empty()) out.push_back(from_urdf("UR5", ur5));
  if (!robot_file(kr120).empty()) out.push_back(from_urdf("KR120", kr120));
  if (!robot_file(puma).empty()) {
    TestRobot robot{"Puma 560", parse_rl(robot_file(puma), puma), {}};
    for (std::uint32_t l = 0; l < robot.robot.links.size(); ++l) {
      const fs::path mesh = folder() / "puma560-vrml" / (robot.robot.links[l].name + ".wrl");
      if (fs::is_regular_file(mesh)) add_mesh(robot, l, mesh, {}, Vec3::Ones());
    }
    out.push_back(std::move(robot));
  }
  return out;
}

std::vector<TestRobot> test_robots() {
  std::vector<TestRobot> out = real_robots();
  out.push_back(six_axis_arm());
  out.push_back(prismatic_chain());
  return out;
}

Path random_path(const Robot& robot, std::mt19937_64& random, std::size_t waypoints, double range,
                 bool subset) {
  std::uniform_real_distribution<double> value(-range, range);
  std::vector<char> moves(robot.variables.size(), 1);
  if (subset)
    for (char& m : moves) m = random() % 2 == 0 ? 1 : 0;
  Path path;
  for (std::size_t w = 0; w < waypoints; ++w) {
    std::vector<double> q(robot.variables.size());
    for (std::size_t i = 0; i < q.size(); ++i)
      q[i] = w > 0 && moves[i] == 0 ? path.front()[i] : value(random);
    path.push_back(std::move(q));
  }
  return path;
}

Transform reference_pose(const Robot& robot, std::uint32_t link, std::span<const double> q) {
  using Matrix = Eigen::Matrix<long double, 4, 4>;
  Matrix pose = Matrix::Identity();
  for (std::uint32_t l = link; l > 0; l = robot.joints[l - 1].parent) {
    const Joint& joint = robot.joints[l - 1];
    Matrix origin = Matrix::Identity(), motion = Matrix::Identity();
    origin.topLeftCorner<3, 3>() = joint.origin.linear.cast<long double>();
    origin.topRightCorner<3, 1>() = joint.origin.translation.cast<long double>();
    const auto axis = joint.axis.cast<long double>().eval();
    if (joint.type != JointType::Fixed) {
      const long double x =
          static_cast<long double>(joint.multiplier) * q[joint.variable] + joint.offset;
      if (joint.type == JointType::Prismatic) {
        motion.topRightCorner<3, 1>() = x * axis;
      } else {
        // By the half-angle quaternion, not by Rodrigues' formula.
        const Eigen::Quaternion<long double> turn(std::cos(x / 2), std::sin(x / 2) * axis.x(),
                                                  std::sin(x / 2) * axis.y(),
                                                  std::sin(x / 2) * axis.z());
        motion.topLeftCorner<3, 3>() = turn.normalized().toRotationMatrix();
      }
    }
    pose = (origin * motion * pose).eval();
  }
  return {pose.topLeftCorner<3, 3>().cast<double>(), pose.topRightCorner<3, 1>().cast<double>()};
}

std::vector<double> between(const std::vector<double>& a, const std::vector<double>& b, double s) {
  std::vector<double> q(a.size());
  for (std::size_t i = 0; i < a.size(); ++i) q[i] = (1 - s) * a[i] + s * b[i];
  return q;
}

double segment_distance(const Vec3& a, const Vec3& b, const Vec3& p) {
  const Vec3 d = b - a;
  const double length = d.squaredNorm();
  const double t = length > 0 ? std::clamp(d.dot(p - a) / length, 0.0, 1.0) : 0;
  return (p - a - t * d).norm();
}

namespace {

double triangle_distance(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 n = (b - a).cross(c - a);
  if ((b - a).cross(p - a).dot(n) >= 0 && (c - b).cross(p - b).dot(n) >= 0 &&
      (a - c).cross(p - c).dot(n) >= 0 && n.norm() > 0)
    return std::abs(n.normalized().dot(p - a));
  return std::min(
      {segment_distance(a, b, p), segment_distance(b, c, p), segment_distance(c, a, p)});
}

}  // namespace

double distance_to(const geom::Mesh& hull, const Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  bool inside = true;
  for (const geom::Triangle& t : hull.triangles) {
    const Vec3 &a = hull.vertices[t[0]], &b = hull.vertices[t[1]], &c = hull.vertices[t[2]];
    inside = inside && (b - a).cross(c - a).dot(p - a) <= 0;
    nearest = std::min(nearest, triangle_distance(a, b, c, p));
  }
  return inside ? 0 : nearest;
}

}  // namespace kaboum::test
