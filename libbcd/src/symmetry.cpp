// Planes of symmetry of a solid, found by its principal axes and checked at samples.

#include "symmetry.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace kaboum::bcd {
namespace {

constexpr std::size_t kSamples = 200;    ///< on the surface
constexpr std::size_t kPartners = 64;    ///< of an extreme vertex, that may be its mirror images
constexpr std::size_t kMostPlanes = 16;  ///< a solid of revolution has any number
constexpr double kTolerance = 1e-3;      ///< of the diagonal

/// Area, and what a mirror plane has to keep: centroid and principal axes of the surface.
struct Moments {
  double area = 0;
  Vec3 center = Vec3::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
};

Moments moments_of(const Mesh& mesh) {
  Moments out;
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  const Vec3 origin = geom::bounding_box(mesh).center();
  Vec3 first = Vec3::Zero();
  for (const Triangle& t : mesh.triangles) {
    const Vec3 a = mesh.vertices[t[0]] - origin, b = mesh.vertices[t[1]] - origin,
               c = mesh.vertices[t[2]] - origin;
    const double area = 0.5 * (b - a).cross(c - a).norm();
    const Vec3 sum = a + b + c;
    out.area += area;
    first += area / 3 * sum;
    second += area / 12 *
              (a * a.transpose() + b * b.transpose() + c * c.transpose() + sum * sum.transpose());
  }
  if (!(out.area > 0)) return out;
  const Vec3 mean = first / out.area;
  out.center = origin + mean;
  out.axes =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(second / out.area - mean * mean.transpose())
          .eigenvectors();
  return out;
}

/// Centroids of triangles, about as many as asked for, the larger triangles' rather.
std::vector<Vec3> samples_of(const Mesh& mesh, double area) {
  std::vector<Vec3> out;
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    sum += 0.5 * (b - a).cross(c - a).norm();
    if (sum * kSamples < area * static_cast<double>(out.size() + 1)) continue;
    out.emplace_back((a + b + c) / 3);
  }
  return out;
}

/// Normals between an extreme vertex and those as far from the centre, which may be its images.
void add_bisectors(const Mesh& mesh, const Vec3& center, double tolerance,
                   std::vector<Vec3>& normals) {
  std::size_t extreme = 0;
  const auto radius = [&](std::size_t v) { return (mesh.vertices[v] - center).norm(); };
  for (std::size_t v = 1; v < mesh.vertices.size(); ++v)
    if (radius(v) > radius(extreme)) extreme = v;
  std::vector<std::pair<double, std::size_t>> partners;  // nearest first
  for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
    const double apart = (mesh.vertices[v] - mesh.vertices[extreme]).norm();
    if (apart > 10 * tolerance && radius(v) > radius(extreme) - tolerance)
      partners.emplace_back(apart, v);
  }
  std::sort(partners.begin(), partners.end());
  const std::size_t count = std::min(kPartners, partners.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t v = partners[i * partners.size() / count].second;
    normals.emplace_back((mesh.vertices[v] - mesh.vertices[extreme]).normalized());
    // A plane through the extreme vertex mirrors its neighbours.
    const std::size_t near = partners[0].second;
    const Vec3 across = mesh.vertices[v] - mesh.vertices[near];
    if (across.norm() > 10 * tolerance) normals.emplace_back(across.normalized());
  }
}

}  // namespace

std::vector<Plane> mirror_planes(const SolidField& solid) {
  const Mesh& mesh = solid.mesh();
  const Moments moments = moments_of(mesh);
  if (!(moments.area > 0)) return {};
  const double tolerance = kTolerance * solid.diagonal();
  std::vector<Vec3> normals{Vec3::UnitX(), Vec3::UnitY(), Vec3::UnitZ()};
  for (int k = 0; k < 3; ++k) normals.emplace_back(moments.axes.col(k));
  add_bisectors(mesh, moments.center, tolerance, normals);
  const std::vector<Vec3> samples = samples_of(mesh, moments.area);
  std::vector<Plane> out;
  for (const Vec3& n : normals) {
    if (out.size() >= kMostPlanes) break;
    const Plane plane{n, n.dot(moments.center)};
    const bool known = std::any_of(out.begin(), out.end(),
                                   [&](const Plane& p) { return std::abs(p.n.dot(n)) > 1 - 1e-4; });
    if (known) continue;
    const bool mirrors = std::all_of(samples.begin(), samples.end(), [&](const Vec3& p) {
      const Vec3 image = p - 2 * plane.height(p) * n;
      return solid.surface().nearest(image).lower <= tolerance;
    });
    if (mirrors) out.push_back(plane);
  }
  return out;
}

}  // namespace kaboum::bcd
