#pragma once

#include <kaboum/geom/transform.h>

#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

namespace kaboum::collide {

/// The convex hull of points, for queries: vertices coordinate by coordinate, for the processor's
/// sake. What is not a vertex may be among the points; they may be flat, or one point.
class Polytope {
 public:
  /// @throws Error{InvalidInput} when there are no points, and for coordinates that are not finite
  ///   or beyond 1e60.
  explicit Polytope(std::span<const geom::Vec3> points);

  struct Support {
    std::uint32_t index = 0;
    double value = 0;  ///< rounded product, the largest
  };
  /// The first of the points that are farthest along d, in rounded arithmetic.
  [[nodiscard]] Support support(const geom::Vec3& d) const {
    Support best{0, d.x() * x_[0] + d.y() * y_[0] + d.z() * z_[0]};
    for (std::uint32_t i = 1; i < x_.size(); ++i) {
      const double along = d.x() * x_[i] + d.y() * y_[i] + d.z() * z_[i];
      best.index = along > best.value ? i : best.index;
      best.value = along > best.value ? along : best.value;
    }
    return best;
  }

  /// The coordinates in floats: eight x, eight y, eight z, and so on; the last point is repeated.
  /// Empty where they are too large or too small for that.
  [[nodiscard]] const std::vector<float>& floats() const { return floats_; }

  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(x_.size()); }
  [[nodiscard]] geom::Vec3 point(std::uint32_t i) const { return {x_[i], y_[i], z_[i]}; }
  /// Mean of the points, rounded.
  [[nodiscard]] const geom::Vec3& center() const { return center_; }
  [[nodiscard]] const geom::Box3& box() const { return box_; }
  /// Largest |coordinate| of a point, per axis.
  [[nodiscard]] const geom::Vec3& magnitude() const { return magnitude_; }

 private:
  std::vector<double> x_, y_, z_;
  std::vector<float> floats_;
  geom::Vec3 center_ = geom::Vec3::Zero(), magnitude_ = geom::Vec3::Zero();
  geom::Box3 box_;
};

/// A polytope at a place: the exact image of its points under the matrix and vector of doubles as
/// they are. Refers to both.
class Posed {
 public:
  /// @throws Error{InvalidArgument} for a pose with numbers that are not finite, or beyond 1e30
  ///   (matrix) or 1e60 (vector).
  Posed(const Polytope& body, const geom::Transform& pose);
  struct Checked {};
  /// For a pose that was looked at before.
  /// @pre no number of it is beyond what the other constructor takes; it is a rotation up to 1e-8.
  Posed(const Polytope& body, const geom::Transform& pose, Checked /*unused*/)
      : body_(&body),
        pose_(&pose),
        extent_(extent_of(body, pose)),
        magnitude_(extent_ + pose.translation.cwiseAbs()),
        is_small_(true) {}

  [[nodiscard]] const Polytope& body() const { return *body_; }
  [[nodiscard]] const geom::Transform& pose() const { return *pose_; }
  /// |L| · largest |coordinates|
  [[nodiscard]] const geom::Vec3& extent() const { return extent_; }
  /// extent() + |t|: what rounding errors of placed points are relative to.
  [[nodiscard]] const geom::Vec3& magnitude() const { return magnitude_; }
  [[nodiscard]] geom::Vec3 center() const { return placed(body_->center()); }
  /// Rounded image of a point.
  [[nodiscard]] geom::Vec3 point(std::uint32_t i) const { return placed(body_->point(i)); }
  /// Farthest along d, in rounded arithmetic; the value contains the translation.
  [[nodiscard]] Polytope::Support support(const geom::Vec3& d) const {
    Polytope::Support s = body_->support(pose_->linear.transpose() * d);
    s.value += d.dot(pose_->translation);
    return s;
  }
  /// True if products of its points with directions may be looked at in floats.
  [[nodiscard]] bool is_rough() const { return is_small_ && !body_->floats().empty(); }
  /// Box along the axes that holds the exact image, and `reach` round it.
  [[nodiscard]] geom::Box3 box(double reach = 0) const;

 private:
  [[nodiscard]] geom::Vec3 placed(const geom::Vec3& p) const {
    const Eigen::Matrix3d& l = pose_->linear;
    const geom::Vec3& t = pose_->translation;
    return {l(0, 0) * p[0] + l(0, 1) * p[1] + l(0, 2) * p[2] + t[0],
            l(1, 0) * p[0] + l(1, 1) * p[1] + l(1, 2) * p[2] + t[1],
            l(2, 0) * p[0] + l(2, 1) * p[1] + l(2, 2) * p[2] + t[2]};
  }

  static geom::Vec3 extent_of(const Polytope& body, const geom::Transform& pose) {
    const Eigen::Matrix3d& l = pose.linear;
    const geom::Vec3& m = body.magnitude();
    const auto along = [&](int k) {
      return std::abs(l(k, 0)) * m[0] + std::abs(l(k, 1)) * m[1] + std::abs(l(k, 2)) * m[2];
    };
    return {along(0), along(1), along(2)};
  }

  const Polytope* body_;
  const geom::Transform* pose_;
  geom::Vec3 extent_, magnitude_;
  bool is_small_ = false;  ///< no entry of the matrix is above 2
};

}  // namespace kaboum::collide
