// What a URDF says, in few words.

#include "expected.h"

#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <numbers>
#include <sstream>
#include <stdexcept>

namespace engines {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using tinyxml2::XMLElement;

namespace {

Vector3d vector_of(const XMLElement* e, const char* attribute, const Vector3d& otherwise) {
  const char* text = e != nullptr ? e->Attribute(attribute) : nullptr;
  if (text == nullptr) return otherwise;
  std::istringstream stream(text);
  Vector3d v;
  stream >> v.x() >> v.y() >> v.z();
  if (!stream) throw std::runtime_error(std::string("bad numbers: ") + text);
  return v;
}

Isometry3d origin_of(const XMLElement* e) {
  const XMLElement* origin = e->FirstChildElement("origin");
  const Vector3d xyz = vector_of(origin, "xyz", Vector3d::Zero()),
                 rpy = vector_of(origin, "rpy", Vector3d::Zero());
  Isometry3d pose = Isometry3d::Identity();
  pose.linear() = (Eigen::AngleAxisd(rpy.z(), Vector3d::UnitZ()) *
                   Eigen::AngleAxisd(rpy.y(), Vector3d::UnitY()) *
                   Eigen::AngleAxisd(rpy.x(), Vector3d::UnitX()))
                      .toRotationMatrix();
  pose.translation() = xyz;
  return pose;
}

Shape shape_of(const XMLElement* collision, const Isometry3d& link,
               const std::filesystem::path& folder, const std::string& prefix) {
  Shape shape;
  shape.pose = link * origin_of(collision);
  const XMLElement* g = collision->FirstChildElement("geometry")->FirstChildElement();
  const std::string kind = g->Name();
  if (kind == "box") {
    shape.measure = measure_box(shape.pose, vector_of(g, "size", Vector3d::Zero()));
  } else if (kind == "cylinder") {
    shape.measure =
        measure_cylinder(shape.pose, g->DoubleAttribute("radius"), g->DoubleAttribute("length"));
  } else if (kind == "sphere") {
    shape.measure = measure_sphere(shape.pose, g->DoubleAttribute("radius"));
  } else {
    shape.mesh = g->Attribute("filename");
    if (!shape.mesh.starts_with(prefix)) throw std::runtime_error(shape.mesh + ": no " + prefix);
    shape.file = folder / shape.mesh.substr(prefix.size());
    shape.scale = vector_of(g, "scale", Vector3d::Ones());
    shape.measure = measure(shape.mesh, corners_of_stl(shape.file, shape.scale, shape.pose));
  }
  return shape;
}

}  // namespace

const std::array<Vector3d, 26>& directions() {
  static const std::array<Vector3d, 26> all = [] {
    std::array<Vector3d, 26> out;
    std::size_t n = 0;
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z)
          if (x != 0 || y != 0 || z != 0) out[n++] = Vector3d(x, y, z).normalized();
    return out;
  }();
  return all;
}

Measure measure(std::string name, std::span<const Vector3d> corners) {
  Measure out;
  out.name = std::move(name);
  const Vector3d middle = corners.empty() ? Vector3d::Zero() : corners[0];
  for (std::size_t i = 0; i + 2 < corners.size(); i += 3)
    out.volume +=
        (corners[i] - middle).cross(corners[i + 1] - middle).dot(corners[i + 2] - middle) / 6;
  for (std::size_t d = 0; d < out.reach.size(); ++d) {
    out.reach[d] = -std::numeric_limits<double>::infinity();
    for (const Vector3d& p : corners) out.reach[d] = std::max(out.reach[d], p.dot(directions()[d]));
  }
  return out;
}

Measure measure_box(const Isometry3d& pose, const Vector3d& size) {
  Measure out{"box", size.prod(), {}};
  for (std::size_t d = 0; d < out.reach.size(); ++d)
    out.reach[d] = directions()[d].dot(pose.translation()) +
                   (pose.linear().transpose() * directions()[d]).cwiseAbs().dot(size) / 2;
  return out;
}

Measure measure_cylinder(const Isometry3d& pose, double radius, double length) {
  Measure out{"cylinder", std::numbers::pi * radius * radius * length, {}};
  for (std::size_t d = 0; d < out.reach.size(); ++d) {
    const Vector3d u = pose.linear().transpose() * directions()[d];
    out.reach[d] = directions()[d].dot(pose.translation()) + radius * std::hypot(u.x(), u.y()) +
                   length / 2 * std::abs(u.z());
  }
  return out;
}

Measure measure_sphere(const Isometry3d& pose, double radius) {
  Measure out{"sphere", 4 * std::numbers::pi / 3 * radius * radius * radius, {}};
  for (std::size_t d = 0; d < out.reach.size(); ++d)
    out.reach[d] = directions()[d].dot(pose.translation()) + radius;
  return out;
}

std::vector<Vector3d> corners_of_stl(const std::filesystem::path& file, const Vector3d& scale,
                                     const Isometry3d& pose) {
  std::ifstream stream(file, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(stream)),
                          std::istreambuf_iterator<char>());
  std::uint32_t count = 0;
  if (bytes.size() >= 84) std::memcpy(&count, bytes.data() + 80, 4);
  if (count == 0 || bytes.size() != 84 + 50 * static_cast<std::size_t>(count))
    throw std::runtime_error(file.string() + ": no binary STL");
  std::vector<Vector3d> corners;
  for (std::size_t t = 0; t < count; ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      std::array<float, 3> p{};
      std::memcpy(p.data(), bytes.data() + 84 + 50 * t + 12 + 12 * c, 12);
      corners.emplace_back(pose * Vector3d(p[0], p[1], p[2]).cwiseProduct(scale));
    }
  if (scale.prod() < 0)
    for (std::size_t i = 0; i < corners.size(); i += 3) std::swap(corners[i], corners[i + 1]);
  return corners;
}

Robot read_urdf(const std::filesystem::path& urdf, const std::string& prefix) {
  tinyxml2::XMLDocument document;
  if (document.LoadFile(urdf.c_str()) != tinyxml2::XML_SUCCESS)
    throw std::runtime_error(urdf.string() + ": cannot be read");
  const XMLElement* root = document.RootElement();
  std::map<std::string, const XMLElement*> joint_to;
  for (const XMLElement* e = root->FirstChildElement("joint"); e != nullptr;
       e = e->NextSiblingElement("joint"))
    joint_to[e->FirstChildElement("child")->Attribute("link")] = e;
  Robot robot;
  for (const XMLElement* e = root->FirstChildElement("link"); e != nullptr;
       e = e->NextSiblingElement("link")) {
    Link link;
    link.name = link.top = link.model = e->Attribute("name");
    bool fixed = true;
    std::string at = link.name;
    for (auto j = joint_to.find(at); j != joint_to.end(); j = joint_to.find(at)) {
      link.pose = origin_of(j->second) * link.pose;
      at = j->second->FirstChildElement("parent")->Attribute("link");
      fixed = fixed && std::string(j->second->Attribute("type")) == "fixed";
      if (fixed) link.top = at;
      if (fixed && at != "world") link.model = at;
    }
    robot.root = at;
    for (const XMLElement* c = e->FirstChildElement("collision"); c != nullptr;
         c = c->NextSiblingElement("collision"))
      link.collisions.push_back(shape_of(c, link.pose, urdf.parent_path(), prefix));
    robot.links.push_back(std::move(link));
  }
  return robot;
}

std::vector<std::filesystem::path> outputs() {
  const std::filesystem::path folder = KABOUM_ENGINE_OUTPUTS;
  std::ifstream list(folder / "list.txt");
  std::vector<std::filesystem::path> out;
  for (std::string line; std::getline(list, line);) out.push_back(folder / line);
  if (out.empty()) throw std::runtime_error("no outputs: run the test engines.outputs first");
  return out;
}

std::filesystem::path prefixed() {
  return std::filesystem::path(KABOUM_ENGINE_OUTPUTS) / "prefixed" / "hard.urdf";
}

void expect_same(const std::string& where, std::vector<Measure> expected,
                 std::vector<Measure> loaded) {
  EXPECT_EQ(loaded.size(), expected.size()) << where;
  for (const Measure& e : expected) {
    double extent = 0;
    for (std::size_t d = 0; d < 13; ++d)
      extent = std::max({extent, std::abs(e.reach[d]), std::abs(e.reach[25 - d])});
    double nearest = std::numeric_limits<double>::infinity();
    auto found = loaded.end();
    for (auto l = loaded.begin(); l != loaded.end(); ++l) {
      double apart = std::abs(l->volume - e.volume) / e.volume;
      for (std::size_t d = 0; d < e.reach.size(); ++d)
        apart = std::max(apart, std::abs(l->reach[d] - e.reach[d]) / extent);
      if (!(apart < nearest)) continue;
      nearest = apart;
      found = l;
    }
    EXPECT_LE(nearest, 1e-6) << where << ": " << e.name << ", volume " << e.volume
                             << ", is not there; nearest "
                             << (found == loaded.end() ? "none" : found->name);
    if (nearest <= 1e-6) loaded.erase(found);
  }
}

std::map<std::string, std::vector<Measure>> bodies_by(const Robot& robot,
                                                      std::string Link::*merged) {
  std::map<std::string, std::vector<Measure>> out;
  for (const Link& link : robot.links)
    for (const Shape& shape : link.collisions) out[link.*merged].push_back(shape.measure);
  return out;
}

}  // namespace engines
