// Spheres, capsules and boxes of a robot to look at: glTF 2.0, whose nodes share meshes.
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot_folder/shapes_glb.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <bit>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>

namespace kaboum::robot_folder {
namespace {

using Json = nlohmann::json;
using geom::Vec3;
using robot::Geometry;

/// Triangles with a normal at each corner.
struct Drawn {
  std::vector<Vec3> points, normals;
  std::vector<geom::Triangle> triangles;
};

/// The unit ball, smooth.
Drawn ball() {
  Drawn out;
  for (const Vec3& p : geom::sphere_points(3).points) out.points.push_back(p.normalized());
  const geom::Mesh hull = *geom::convex_hull(out.points);
  out.points = out.normals = hull.vertices;
  for (Vec3& n : out.normals) n.normalize();
  out.triangles = hull.triangles;
  return out;
}

/// The side of a cylinder of radius 1 and length 1 about z; balls are at its ends.
Drawn tube() {
  constexpr std::uint32_t kSides = 48;
  Drawn out;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    const Vec3 n(std::cos(angle), std::sin(angle), 0);
    const std::uint32_t a = 2 * i, b = 2 * ((i + 1) % kSides);
    for (const double z : {-0.5, 0.5}) {
      out.points.emplace_back(n + Vec3(0, 0, z));
      out.normals.push_back(n);
    }
    out.triangles.push_back({a, b, a + 1});
    out.triangles.push_back({b, b + 1, a + 1});
  }
  return out;
}

/// The cube with edges of length 1.
Drawn cube() {
  Drawn out;
  for (int axis = 0; axis < 3; ++axis)
    for (const double side : {-0.5, 0.5}) {
      const auto first = static_cast<std::uint32_t>(out.points.size());
      for (const auto& [u, v] : std::array{std::pair(-0.5, -0.5), std::pair(0.5, -0.5),
                                           std::pair(0.5, 0.5), std::pair(-0.5, 0.5)}) {
        Vec3 p;
        p[axis] = side;
        p[(axis + 1) % 3] = u;
        p[(axis + 2) % 3] = v;
        out.points.push_back(p);
        out.normals.emplace_back(2 * side * Vec3::Unit(axis));
      }
      const bool outwards = side > 0;
      out.triangles.push_back({first, first + (outwards ? 1 : 2), first + (outwards ? 2 : 1)});
      out.triangles.push_back({first, first + (outwards ? 2 : 3), first + (outwards ? 3 : 2)});
    }
  return out;
}

class Scene {
 public:
  Scene() {
    json_["asset"] = {{"version", "2.0"}, {"generator", "KABouM " KABOUM_VERSION}};
    json_["scene"] = 0;
    constexpr double kHalf = std::numbers::sqrt2 / 2;
    // z is up in robots, y in glTF.
    nodes_.push_back({{"name", "robot"}, {"rotation", {-kHalf, 0, 0, kHalf}}});
    json_["scenes"] = {{{"nodes", {0}}}};
  }

  /// @return the node
  std::size_t add_link(const std::string& name, const robot::Transform& pose) {
    Json node{{"name", name}};
    place(node, pose);
    return add(0, std::move(node));
  }

  void add_shape(std::size_t link, const Geometry& g, std::size_t colour) {
    using Shape = Geometry::Shape;
    if (g.shape == Shape::Box) return instance(link, "box", g, g.size, colour);
    if (g.shape == Shape::Sphere)
      return instance(link, "ball", g, Vec3::Constant(g.size.x()), colour);
    for (const Geometry& part : robot::parts_of_capsule(g)) {
      if (part.shape == Shape::Sphere)
        add_shape(link, part, colour);
      else
        instance(link, "tube", part, Vec3(part.size.x(), part.size.x(), part.size.y()), colour);
    }
  }

  std::vector<char> bytes() {
    json_["nodes"] = nodes_;
    if (!meshes_.empty()) json_["meshes"] = meshes_;
    if (!materials_.empty()) json_["materials"] = materials_;
    if (!binary_.empty()) json_["buffers"] = {{{"byteLength", binary_.size()}}};
    std::string text = json_.dump();
    text.resize((text.size() + 3) / 4 * 4, ' ');
    binary_.resize((binary_.size() + 3) / 4 * 4);
    std::vector<char> out;
    const auto number = [&](std::size_t x) { append(out, static_cast<std::uint32_t>(x)); };
    const bool has_binary = !binary_.empty();
    number(0x46546C67);
    number(2);
    number(12 + 8 + text.size() + (has_binary ? 8 + binary_.size() : 0));
    number(text.size());
    number(0x4E4F534A);
    out.insert(out.end(), text.begin(), text.end());
    if (!has_binary) return out;
    number(binary_.size());
    number(0x004E4942);
    out.insert(out.end(), binary_.begin(), binary_.end());
    return out;
  }

 private:
  static void append(std::vector<char>& out, std::uint32_t x) {
    for (int i = 0; i < 4; ++i) out.push_back(static_cast<char>(x >> (8 * i) & 0xFFU));
  }

  static Json json_of(const Vec3& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
  }

  static void place(Json& node, const robot::Transform& pose) {
    if (!pose.translation.isZero(0)) node["translation"] = json_of(pose.translation);
    if (pose.linear.isIdentity(0)) return;
    const Eigen::Quaterniond q = Eigen::Quaterniond(pose.linear).normalized();
    node["rotation"] = {static_cast<float>(q.x()), static_cast<float>(q.y()),
                        static_cast<float>(q.z()), static_cast<float>(q.w())};
  }

  std::size_t add(std::size_t parent, Json node) {
    nodes_.push_back(std::move(node));
    nodes_[parent]["children"].push_back(nodes_.size() - 1);
    return nodes_.size() - 1;
  }

  void instance(std::size_t link, const char* kind, const Geometry& g, const Vec3& scale,
                std::size_t colour) {
    Json node{{"mesh", mesh_of(kind, colour)}, {"scale", json_of(scale)}};
    place(node, g.origin);
    add(link, std::move(node));
  }

  /// A kind in a colour; kinds have the same triangles in all of them.
  std::size_t mesh_of(const std::string& kind, std::size_t colour) {
    const auto [at, fresh] = mesh_by_.try_emplace({kind, colour}, meshes_.size());
    if (!fresh) return at->second;
    Json primitive = triangles_of(kind);
    primitive["material"] = material_of(colour);
    meshes_.push_back({{"name", kind}, {"primitives", {std::move(primitive)}}});
    return at->second;
  }

  const Json& triangles_of(const std::string& kind) {
    const auto [at, fresh] = drawn_by_.try_emplace(kind);
    if (!fresh) return at->second;
    const Drawn drawn = kind == "ball" ? ball() : kind == "tube" ? tube() : cube();
    const std::size_t points = add_vectors(drawn.points, true),
                      normals = add_vectors(drawn.normals, false);
    const std::size_t begin = binary_.size();
    for (const geom::Triangle& t : drawn.triangles)
      for (const std::uint32_t corner : t) append(binary_, corner);
    const std::size_t indices = add_view(
        begin,
        {{"componentType", 5125}, {"count", 3 * drawn.triangles.size()}, {"type", "SCALAR"}});
    at->second = {{"attributes", {{"POSITION", points}, {"NORMAL", normals}}},
                  {"indices", indices}};
    return at->second;
  }

  std::size_t add_vectors(const std::vector<Vec3>& vectors, bool bounds) {
    const std::size_t begin = binary_.size();
    Vec3 low = vectors.front(), high = low;
    for (const Vec3& v : vectors) {
      low = low.cwiseMin(v);
      high = high.cwiseMax(v);
      for (const double x : v) append(binary_, std::bit_cast<std::uint32_t>(static_cast<float>(x)));
    }
    Json accessor{{"componentType", 5126}, {"count", vectors.size()}, {"type", "VEC3"}};
    if (bounds) {
      accessor["min"] = json_of(low);
      accessor["max"] = json_of(high);
    }
    return add_view(begin, std::move(accessor));
  }

  std::size_t add_view(std::size_t begin, Json accessor) {
    Json& views = json_["bufferViews"];
    views.push_back({{"buffer", 0}, {"byteOffset", begin}, {"byteLength", binary_.size() - begin}});
    accessor["bufferView"] = views.size() - 1;
    Json& accessors = json_["accessors"];
    accessors.push_back(std::move(accessor));
    return accessors.size() - 1;
  }

  std::size_t material_of(std::size_t colour) {
    // Tableau's ten colours but for greys, linear.
    static constexpr std::array<std::array<double, 3>, 8> kColours{{{0.08, 0.19, 0.38},
                                                                    {0.88, 0.28, 0.04},
                                                                    {0.10, 0.36, 0.08},
                                                                    {0.75, 0.10, 0.10},
                                                                    {0.42, 0.20, 0.37},
                                                                    {0.18, 0.48, 0.47},
                                                                    {0.85, 0.58, 0.08},
                                                                    {0.34, 0.18, 0.11}}};
    const auto [at, fresh] = material_by_.try_emplace(colour % kColours.size(), materials_.size());
    if (!fresh) return at->second;
    const auto& rgb = kColours[at->first];
    materials_.push_back({{"pbrMetallicRoughness",
                           {{"baseColorFactor", {rgb[0], rgb[1], rgb[2], 1.0}},
                            {"metallicFactor", 0.0},
                            {"roughnessFactor", 0.8}}}});
    return at->second;
  }

  Json json_;
  std::vector<Json> nodes_, meshes_, materials_;
  std::vector<char> binary_;
  std::map<std::pair<std::string, std::size_t>, std::size_t> mesh_by_;
  std::map<std::string, Json> drawn_by_;
  std::map<std::size_t, std::size_t> material_by_;
};

/// All joints at 0, or at the limit that is next to it.
std::vector<double> rest_of(const robot::Robot& robot) {
  std::vector<double> out;
  for (const robot::Variable& v : robot.variables) {
    double x = 0;
    if (v.lower) x = std::max(x, *v.lower);
    if (v.upper) x = std::min(x, *v.upper);
    out.push_back(x);
  }
  return out;
}

}  // namespace

std::vector<char> glb_of_shapes(const robot::Robot& robot, const SimpleShapes& shapes) {
  const std::vector<robot::Transform> poses = robot::forward(robot, rest_of(robot));
  std::map<std::uint32_t, std::size_t> nodes;
  Scene scene;
  for (const SimpleShape& shape : shapes.shapes) {
    const auto [at, fresh] = nodes.try_emplace(shape.link);
    if (fresh) at->second = scene.add_link(robot.links[shape.link].name, poses[shape.link]);
    scene.add_shape(at->second, geometry_of(shape), shape.link);
  }
  return scene.bytes();
}

}  // namespace kaboum::robot_folder
