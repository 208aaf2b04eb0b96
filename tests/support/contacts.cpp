// Pairs of polytopes that nearly touch.

#include "contacts.h"

#include <kaboum/geom/convex_hull.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <vector>

namespace kaboum::test {
namespace {

using geom::Mesh;
using geom::Transform;
using geom::Vec3;

double from(std::mt19937_64& random, double low, double high) {
  return std::uniform_real_distribution<double>(low, high)(random);
}

Vec3 vector_from(std::mt19937_64& random, double low, double high) {
  const double x = from(random, low, high), y = from(random, low, high),
               z = from(random, low, high);
  return {x, y, z};
}

Mesh hull_of(std::mt19937_64& random, double size, bool whole) {
  for (;;) {
    Vec3 shape = Vec3::Constant(size);
    const auto kind = random() % 4;
    if (kind == 0) shape.x() *= 1e-5;                    // flat
    if (kind == 1) shape.y() = shape.z() = 1e-5 * size;  // a needle
    std::vector<Vec3> points;
    for (auto i = 4 + random() % 4; i-- > 0;) {
      if (whole) {
        const Vec3 p = vector_from(random, 0, 3).array().floor().matrix();
        points.emplace_back(p);
      } else {
        points.emplace_back(vector_from(random, -1, 1).cwiseProduct(shape));
      }
    }
    if (const auto hull = geom::convex_hull(points)) return *hull;
  }
}

Eigen::Matrix3d rotation(std::mt19937_64& random) {
  const Vec3 axis = vector_from(random, -1, 1);
  return Eigen::AngleAxisd(from(random, -3, 3), axis.normalized()).toRotationMatrix();
}

/// Some point of the feature farthest along d, and the points of it.
Vec3 farthest(std::mt19937_64& random, const Mesh& mesh, const Transform& pose, const Vec3& d) {
  double most = -std::numeric_limits<double>::infinity(), size = 0;
  for (const Vec3& p : mesh.vertices) {
    most = std::max(most, d.dot(pose.linear * p));
    size = std::max(size, p.norm());
  }
  Vec3 sum = Vec3::Zero();
  double shares = 0;
  for (const Vec3& p : mesh.vertices) {
    if (d.dot(pose.linear * p) < most - 1e-12 * size * d.norm()) continue;
    const double share = from(random, 0.1, 1);
    sum += share * (pose * p);
    shares += share;
  }
  return sum / shares;
}

Vec3 some_edge(std::mt19937_64& random, const Mesh& mesh, const Transform& pose) {
  const geom::Triangle& t = mesh.triangles[random() % mesh.triangles.size()];
  const auto i = random() % 3;
  return pose.linear * (mesh.vertices[t[(i + 1) % 3]] - mesh.vertices[t[i]]);
}

Vec3 some_normal(std::mt19937_64& random, const Mesh& mesh, const Transform& pose) {
  const geom::Triangle& t = mesh.triangles[random() % mesh.triangles.size()];
  const Vec3& a = mesh.vertices[t[0]];
  return pose.linear * (mesh.vertices[t[1]] - a).cross(mesh.vertices[t[2]] - a);
}

}  // namespace

Contact random_contact(std::mt19937_64& random) {
  Contact c;
  const bool whole = random() % 5 == 0;
  c.size = whole ? 1 : std::pow(10.0, from(random, -6, 6));
  c.a = hull_of(random, c.size, whole);
  c.b = hull_of(random, c.size, whole);
  if (!whole) {
    const double far = random() % 3 == 0 ? 1000 : random() % 2 == 0 ? 1 : 0;
    c.pose_a = {rotation(random), far * c.size * vector_from(random, -1, 1)};
    c.pose_b.linear = rotation(random);
  }
  // The direction in which they touch.
  Vec3 d = vector_from(random, -1, 1);
  switch (random() % 4) {
    case 0:
      break;
    case 1:
      d = some_normal(random, c.a, c.pose_a);
      break;
    case 2:
      d = some_edge(random, c.a, c.pose_a).cross(some_edge(random, c.b, c.pose_b));
      break;
    default: {  // facet to facet
      d = some_normal(random, c.a, c.pose_a);
      if (whole) break;
      const Vec3 other = some_normal(random, c.b, c.pose_b);
      c.pose_b.linear =
          (Eigen::Quaterniond::FromTwoVectors(other, -d).toRotationMatrix() * c.pose_b.linear)
              .eval();
    }
  }
  if (!(d.norm() > 0)) d = Vec3::UnitX();
  d.normalize();
  const Vec3 p = farthest(random, c.a, c.pose_a, d), q = farthest(random, c.b, c.pose_b, -d);
  if (whole) {
    c.pose_b.translation = (p - q).array().round().matrix();
    return c;
  }
  c.pose_b.translation = p - q;
  const double unit = 0x1p-53 * (c.size + p.norm());
  c.pose_b.translation += (static_cast<double>(random() % 9) - 4) * unit * d;
  return c;
}

}  // namespace kaboum::test
