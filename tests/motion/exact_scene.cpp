// Contacts of convex meshes, by rational numbers where directions in doubles do not tell them
// apart.

#include "exact_scene.h"

#include <kaboum/robot/kinematics.h>

#include <algorithm>
#include <limits>

#include "support/rational_contact.h"

namespace kaboum::test {
namespace {

using geom::Vec3;

struct Posed {
  std::vector<Vec3> points;
  std::vector<Vec3> normals;
  Vec3 middle = Vec3::Zero();
};

Posed posed(const geom::Mesh& mesh, const geom::Transform& pose) {
  Posed out;
  for (const Vec3& v : mesh.vertices) {
    out.points.push_back(pose * v);
    out.middle += out.points.back() / static_cast<double>(mesh.vertices.size());
  }
  for (const auto& t : mesh.triangles)
    out.normals.push_back((out.points[t[1]] - out.points[t[0]])
                              .cross(out.points[t[2]] - out.points[t[0]])
                              .normalized());
  return out;
}

/// Whether a direction shows them farther apart than all roundings.
bool clearly_apart(const Posed& a, const Posed& b) {
  const auto separates = [&](const Vec3& direction) {
    double high = -std::numeric_limits<double>::infinity(), low = -high;
    for (const Vec3& p : a.points) high = std::max(high, direction.dot(p));
    for (const Vec3& p : b.points) low = std::min(low, direction.dot(p));
    return low - high > 1e-9;
  };
  if (separates((b.middle - a.middle).normalized())) return true;
  return std::any_of(a.normals.begin(), a.normals.end(), separates) ||
         std::any_of(b.normals.begin(), b.normals.end(),
                     [&](const Vec3& n) { return separates(-n); });
}

}  // namespace

std::optional<std::string> ExactScene::find_contact(const std::vector<double>& q) const {
  const std::vector<geom::Transform> links = forward(robot, q);
  std::vector<geom::Transform> poses;
  std::vector<Posed> placed;
  for (const Body& body : bodies) {
    poses.push_back(body.link ? links[*body.link] * body.pose : body.pose);
    placed.push_back(posed(body.hull, poses.back()));
  }
  for (const auto& [i, j] : pairs)
    if (!clearly_apart(placed[i], placed[j]) &&
        rational_within(bodies[i].hull, poses[i], bodies[j].hull, poses[j], 0))
      return bodies[i].name + " and " + bodies[j].name;
  return std::nullopt;
}

}  // namespace kaboum::test
