// Minimising a quadric in half-spaces, for positions of vertices. Source: [gaschler2016] Alg. 1.
// Deviation: an active-set method instead of all subsets of planes; the same minimiser.

#include "half_space.h"

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <cstddef>

namespace kaboum::bcd {
namespace {

using geom::Vec3;

/// A triangle with a smaller sine has no certain normal.
constexpr double kSliver = 1e-14;
/// More steps than any position has taken: rounding might go round in circles.
constexpr int kMostSteps = 60;
/// Planes that meet at a smaller angle (by the square of its sine, or the determinant of three
/// normals) have no certain common points; multipliers of rounding's size count as positive.
constexpr double kParallel = 1e-12, kSingular = 1e-9, kTinyMultiplier = 1e-12;

/// The half-space most violated joins the up to three that are active, and the minimiser for these
/// alone is found among their subsets; the minimum grows each time, so none comes back.
class ActiveSet {
 public:
  ActiveSet(const PlaneQuadric& q, const Eigen::Matrix3d& inverse, double tolerance)
      : q_(q), inverse_(inverse), free_(inverse * q.b), tolerance_(tolerance), best_(free_) {}

  [[nodiscard]] const Vec3& best() const { return best_; }

  [[nodiscard]] const HalfSpace* most_violated(const std::vector<HalfSpace>& all) const {
    const HalfSpace* worst = nullptr;
    double least = -tolerance_;
    for (const HalfSpace& h : all) {
      const double height = h.height(best_);
      if (height < least) {
        least = height;
        worst = &h;
      }
    }
    return worst;
  }

  /// @return false where no subset with the new one is met by a minimiser.
  bool add(const HalfSpace& h) {
    active_[count_++] = {&h, inverse_ * h.n};
    return on_newest() || on_two() || on_three();
  }

 private:
  struct Active {
    const HalfSpace* plane = nullptr;
    Vec3 column = Vec3::Zero();
  };

  [[nodiscard]] const Active& newest() const { return active_[count_ - 1]; }
  [[nodiscard]] double lack(const Active& x) const { return -x.plane->height(free_); }
  [[nodiscard]] bool holds_all(const Vec3& v) const {
    for (std::size_t i = 0; i < count_; ++i)
      if (active_[i].plane->height(v) < -tolerance_) return false;
    return true;
  }
  void keep(const Vec3& v, const std::array<Active, 4>& active, std::size_t count) {
    best_ = v;
    active_ = active;
    count_ = count;
  }

  bool on_newest() {
    const Active c = newest();
    const double gcc = c.plane->n.dot(c.column);
    const Vec3 v = free_ + (lack(c) / gcc) * c.column;
    if (!holds_all(v)) return false;
    keep(v, {c}, 1);
    return true;
  }

  bool on_two() {
    const Active c = newest();
    const double gcc = c.plane->n.dot(c.column);
    for (std::size_t i = 0; i + 1 < count_; ++i) {
      const Active x = active_[i];
      const double gxx = x.plane->n.dot(x.column), gxc = x.plane->n.dot(c.column);
      const double det = gxx * gcc - gxc * gxc;
      if (!(det > kParallel * gxx * gcc)) continue;
      const double lx = (lack(x) * gcc - lack(c) * gxc) / det;
      const double lc = (lack(c) * gxx - lack(x) * gxc) / det;
      const Vec3 v = free_ + lx * x.column + lc * c.column;
      if (lx < 0 || lc < 0 || !holds_all(v)) continue;
      keep(v, {x, c}, 2);
      return true;
    }
    return false;
  }

  bool on_three() {
    const Active c = newest();
    for (std::size_t i = 0; i + 1 < count_; ++i) {
      for (std::size_t j = i + 1; j + 1 < count_; ++j) {
        const HalfSpace &x = *active_[i].plane, &y = *active_[j].plane, &z = *c.plane;
        const Vec3 yz = y.n.cross(z.n), zx = z.n.cross(x.n), xy = x.n.cross(y.n);
        const double det = x.n.dot(yz);
        if (std::abs(det) < kSingular) continue;
        const Vec3 v = (x.d * yz + y.d * zx + z.d * xy) / det;
        const Vec3 gradient = q_.a * (v - free_) / det;  // = Σ multiplier · normal
        const double tiny = kTinyMultiplier * gradient.norm();
        if (gradient.dot(yz) < -tiny || gradient.dot(zx) < -tiny || gradient.dot(xy) < -tiny ||
            !holds_all(v))
          continue;
        keep(v, {active_[i], active_[j], c}, 3);
        return true;
      }
    }
    return false;
  }

  const PlaneQuadric& q_;
  const Eigen::Matrix3d& inverse_;
  Vec3 free_;  // without half-spaces
  double tolerance_;
  Vec3 best_;
  std::array<Active, 4> active_;
  std::size_t count_ = 0;
};

}  // namespace

std::optional<HalfSpace> beyond_triangle(const Vec3& a, const Vec3& b, const Vec3& c) {
  const Vec3 u = b - a, w = c - a;
  const Vec3 n = u.cross(w);
  const double length = n.norm();
  if (!(length > kSliver * (u.squaredNorm() + w.squaredNorm()))) return std::nullopt;
  const Vec3 unit = n / length;
  return HalfSpace{unit, unit.dot(a)};
}

std::optional<Vec3> minimise_beyond(const PlaneQuadric& q,
                                    const std::vector<HalfSpace>& half_spaces, double tolerance) {
  const Eigen::Matrix3d inverse = q.a.inverse();
  if (!inverse.allFinite()) return std::nullopt;
  ActiveSet set(q, inverse, tolerance);
  for (int step = 0; step < kMostSteps; ++step) {
    const HalfSpace* worst = set.most_violated(half_spaces);
    if (worst == nullptr) return set.best();
    if (!set.add(*worst)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace kaboum::bcd
