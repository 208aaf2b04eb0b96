// Primitives that MuJoCo fits to meshes: geoms of another type than mesh that name one. As
// MuJoCo 4.0: the mesh's box of equal inertia, or its box along its main axes.

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "mjcf_model.h"

namespace kaboum::robot {
namespace {

/// Numbers as MuJoCo has them after reading: float32, placed and scaled in double.
std::vector<Vec3> placed(const MjcfMesh& asset, const geom::Mesh& mesh) {
  std::vector<Vec3> out;
  out.reserve(mesh.vertices.size());
  const Mat3 back = asset.reference.linear.transpose();
  for (const Vec3& v : mesh.vertices)
    out.emplace_back((back * (v.cast<float>().cast<double>() - asset.reference.translation))
                         .cwiseProduct(asset.scale));
  return out;
}

/// Main axes and moments of a symmetric matrix, falling, by Jacobi's method.
/// Source: Golub and Van Loan, Matrix Computations, 8.5. It ends where MuJoCo 4.0's does, which
/// takes off-diagonal elements below 1e-7 of the largest moment for 0 (found by comparing): axes
/// of meshes are not the exact ones there, and these are to be the same.
struct MainAxes {
  explicit MainAxes(const Mat3& matrix) {
    constexpr double kShare = 1e-7;
    constexpr int kMostTurns = 500;
    double least = 0;
    Eigen::Quaterniond turned = Eigen::Quaterniond::Identity();
    for (int turn = 0; turn < kMostTurns; ++turn) {
      axes = turned.toRotationMatrix();
      const Mat3 here = axes.transpose() * matrix * axes;
      moments = here.diagonal();
      const double xy = std::abs(here(0, 1)), xz = std::abs(here(0, 2)), yz = std::abs(here(1, 2));
      const int about = xy > xz && xy > yz ? 2 : xz > yz ? 1 : 0;
      const int row = about == 0 ? 1 : 0, column = about == 2 ? 1 : 2;
      least = kShare * moments.cwiseAbs().maxCoeff();
      if (!(std::abs(here(row, column)) > least)) break;
      const double tau = (moments[column] - moments[row]) / (2 * here(row, column));
      const double tangent = (tau >= 0 ? 1 : -1) / (std::abs(tau) + std::sqrt(1 + tau * tau));
      const double cosine = 1 / std::sqrt(1 + tangent * tangent);
      const double sine = std::copysign(std::sqrt(0.5 - 0.5 * cosine), tangent);
      Eigen::Quaterniond turn_here = Eigen::Quaterniond::Identity();
      turn_here.vec()[about] = about == 1 ? sine : -sine;
      turn_here.w() = std::sqrt(1 - sine * sine);
      turned = turned * turn_here;
      turned.normalize();
    }
    for (const int i : {0, 1, 0}) {
      if (!(moments[i] + least < moments[i + 1])) continue;
      std::swap(moments[i], moments[i + 1]);
      turned = turned * Eigen::AngleAxisd(std::numbers::pi / 2, Vec3::Unit((i + 2) % 3));
      turned.normalize();
    }
    axes = turned.toRotationMatrix();
  }

  Vec3 moments;
  Mat3 axes;  ///< columns
};

/// A mesh's middle and main moments, of unit density.
struct Moments {
  double amount = 0;  ///< volume, or area of a shell
  Vec3 center = Vec3::Zero();
  Vec3 main = Vec3::Zero();      ///< falling
  Mat3 axes = Mat3::Identity();  ///< columns, in the order of `main`
};

/// Sums over the tetrahedra between triangles and a point. @param kind  of MjcfMesh::inertia
class Tetrahedra {
 public:
  Tetrahedra(const std::vector<Vec3>& vertices, const std::vector<geom::Triangle>& triangles,
             const std::string& kind)
      : vertices_(vertices),
        triangles_(triangles),
        shell_(kind == "shell"),
        unsigned_(kind.empty() || kind == "legacy") {}

  Moments moments() const {
    Moments out;
    const Vec3 middle = centroid();
    for (const geom::Triangle& t : triangles_) {
      const Vec3 c = center(t);
      const double amount = weight(t, c - middle);
      out.amount += amount;
      out.center += amount * (0.75 * c + 0.25 * middle);
    }
    out.center /= out.amount;
    Mat3 products = Mat3::Zero();
    out.amount = 0;
    for (const geom::Triangle& t : triangles_) {
      const std::array<Vec3, 3> v{corner(t, 0) - out.center, corner(t, 1) - out.center,
                                  corner(t, 2) - out.center};
      const double amount = weight(t, (v[0] + v[1] + v[2]) / 3);
      out.amount += amount;
      const Vec3 sum = v[0] + v[1] + v[2];
      Mat3 second = sum * sum.transpose();
      for (const Vec3& p : v) second += p * p.transpose();
      products += amount / (shell_ ? 12 : 20) * second;
    }
    const Mat3 inertia = products.trace() * Mat3::Identity() - products;
    const MainAxes found(inertia);
    out.main = found.moments;
    out.axes = found.axes;
    return out;
  }

 private:
  [[nodiscard]] const Vec3& corner(const geom::Triangle& t, std::size_t i) const {
    return vertices_[t[i]];
  }
  [[nodiscard]] Vec3 center(const geom::Triangle& t) const {
    return (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3;
  }
  [[nodiscard]] Vec3 area(const geom::Triangle& t) const {
    return 0.5 * (corner(t, 1) - corner(t, 0)).cross(corner(t, 2) - corner(t, 0));
  }
  /// @param from  the point, to the triangle's middle
  [[nodiscard]] double weight(const geom::Triangle& t, const Vec3& from) const {
    if (shell_) return area(t).norm();
    const double volume = from.dot(area(t)) / 3;
    return unsigned_ ? std::abs(volume) : volume;
  }
  [[nodiscard]] Vec3 centroid() const {
    Vec3 sum = Vec3::Zero();
    double total = 0;
    for (const geom::Triangle& t : triangles_) {
      const double size = area(t).norm();
      sum += size * center(t);
      total += size;
    }
    return sum / total;
  }

  const std::vector<Vec3>& vertices_;
  const std::vector<geom::Triangle>& triangles_;
  bool shell_, unsigned_;
};

/// Half sizes as MJCF states them, of a box of equal inertia.
Vec3 size_by_inertia(Geometry::Shape shape, const Moments& m) {
  Vec3 box;
  for (int i = 0; i < 3; ++i)
    box[i] = 0.5 * std::sqrt(std::max(0.0, 6 * (m.main.sum() - 2 * m.main[i]) / m.amount));
  const double round = (box.x() + box.y()) / 2;
  switch (shape) {
    case Geometry::Shape::Sphere:
      return {box.mean(), 0, 0};
    case Geometry::Shape::Capsule:
      return {round, std::max(0.0, box.z() - round / 2), 0};
    case Geometry::Shape::Cylinder:
      return {round, box.z(), 0};
    default:
      return box;
  }
}

/// Half sizes of what has the same box along the axes. @param half  of that box
Vec3 size_by_box(Geometry::Shape shape, const Vec3& half) {
  const double round = std::max(half.x(), half.y());
  switch (shape) {
    case Geometry::Shape::Sphere:
      return {half.maxCoeff(), 0, 0};
    case Geometry::Shape::Capsule:
      return {round, half.z() - round, 0};
    case Geometry::Shape::Cylinder:
      return {round, half.z(), 0};
    default:
      return half;
  }
}

}  // namespace

MjcfFit fit_to_mesh(Geometry::Shape shape, const MjcfMesh& asset, const geom::Mesh& mesh,
                    bool by_box) {
  const std::vector<Vec3> vertices = placed(asset, mesh);
  const Moments m = Tetrahedra(vertices, mesh.triangles, asset.inertia).moments();
  MjcfFit out;
  if (!(m.amount > 1e-14) || !m.main.allFinite() || !(m.main.z() > 0)) return out;
  out.pose = {m.axes, m.center};
  if (!by_box) {
    out.size = size_by_inertia(shape, m);
    return out;
  }
  geom::Box3 box;
  for (const Vec3& v : vertices) box.extend(m.axes.transpose() * (v - m.center));
  out.size = size_by_box(shape, box.max - box.center());
  out.pose.translation += m.axes * box.center();
  return out;
}

}  // namespace kaboum::robot
