// Minimising a quadric over half-spaces. Source: [gaschler2016] Eq. 4.8, Alg. 1.

#include "placement.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace kaboum::bmesh {
namespace {

/// Squared sine below which two planes count as parallel, and volume of three unit normals below
/// which they count as flat: their common points are lost in rounding, and other planes bound the
/// place.
constexpr double kParallel = 1e-20, kFlat = 1e-12;
/// Multipliers may be negative by this share: what a place that is not quite the best costs is less
/// than what rounding does.
constexpr double kMultiplierSlack = 1e-12;

/// Cholesky factor of the regularised, trace-scaled quadratic part, with the reciprocals of its
/// diagonal: every half-space is transformed by it.
struct Cholesky {
  double i00, l10, i11, l20, l21, i22;

  Cholesky(const Quadric& q, double regularisation) {
    const double t = q.trace();
    const double s = t > 0 ? 1 / t : 0;
    const double e = t > 0 ? regularisation : 1;
    i00 = 1 / std::sqrt(std::max(q.xx * s, 0.0) + e);
    l10 = q.xy * s * i00;
    l20 = q.xz * s * i00;
    i11 = 1 / std::sqrt(std::max(q.yy * s + e - l10 * l10, 0.5 * e));
    l21 = (q.yz * s - l20 * l10) * i11;
    i22 = 1 / std::sqrt(std::max(q.zz * s + e - l20 * l20 - l21 * l21, 0.5 * e));
    scale = s;
  }
  /// L⁻¹ v
  [[nodiscard]] Vec3 forward(const Vec3& v) const {
    const double x = v.x() * i00;
    const double y = (v.y() - l10 * x) * i11;
    return {x, y, (v.z() - l20 * x - l21 * y) * i22};
  }
  /// L⁻ᵀ v
  [[nodiscard]] Vec3 backward(const Vec3& v) const {
    const double z = v.z() * i22;
    const double y = (v.y() - l21 * z) * i11;
    return {(v.x() - l10 * y - l20 * z) * i00, y, z};
  }

  double scale;
};

/// u·z ≥ c with unit u.
struct Plane {
  Vec3 u;
  double c;
};

/// Closest point to the origin in an intersection of half-spaces, by basis exchange. Planes are
/// compared as given; only those that enter the basis are transformed.
class ClosestPoint {
 public:
  /// z = Lᵀy + shift.
  ClosestPoint(std::span<const HalfSpace> half_spaces, const Cholesky& l, const Vec3& shift)
      : half_spaces_(half_spaces), l_(l), shift_(shift) {}

  /// @return y
  std::optional<Vec3> solve() {
    constexpr int kMaxExchanges = 64;
    for (int i = 0; i < kMaxExchanges; ++i) {
      const Vec3 y = l_.backward(z_ - shift_);
      const HalfSpace* worst = most_violated(y);
      if (worst == nullptr) return y;
      const std::optional<Plane> plane = transformed(*worst);
      if (!plane ||
          plane->c - plane->u.dot(z_) <= kTolerance * (z_.lpNorm<1>() + std::abs(plane->c)))
        return y;
      const int slot = free_slot();
      planes_[static_cast<std::size_t>(slot)] = *plane;
      if (!exchange(slot)) return std::nullopt;
    }
    return std::nullopt;
  }

 private:
  static constexpr double kTolerance = 1e-12;

  [[nodiscard]] const HalfSpace* most_violated(const Vec3& y) const {
    const HalfSpace* worst = nullptr;
    double violation = 0;
    for (const HalfSpace& h : half_spaces_) {
      const double v = h.offset - h.normal.dot(y);
      if (v > violation) {
        violation = v;
        worst = &h;
      }
    }
    return worst;
  }

  [[nodiscard]] std::optional<Plane> transformed(const HalfSpace& h) const {
    const Vec3 g = l_.forward(h.normal);
    const double norm = g.norm();
    if (!(norm > 0)) return std::nullopt;
    const double inverse = 1 / norm;
    return Plane{inverse * g, inverse * (h.offset + g.dot(shift_))};
  }

  /// The first of the four places that the basis does not use.
  [[nodiscard]] int free_slot() const {
    for (int slot = 0;; ++slot)
      if (std::find(basis_.begin(), basis_.end(), slot) == basis_.end()) return slot;
  }

  [[nodiscard]] bool feasible(const Vec3& z, std::initializer_list<int> others) const {
    for (const int i : others) {
      const Plane& p = plane(i);
      if (p.u.dot(z) < p.c - kTolerance * (z.lpNorm<1>() + std::abs(p.c))) return false;
    }
    return true;
  }

  /// New basis from {entering} and a subset of the old one.
  bool exchange(int entering) {
    const std::array<int, 3> old = basis_;
    const int n = size_;
    if (auto z = one(entering)) {
      const bool ok = n == 0   ? true
                      : n == 1 ? feasible(*z, {old[0]})
                      : n == 2 ? feasible(*z, {old[0], old[1]})
                               : feasible(*z, {old[0], old[1], old[2]});
      if (ok) return accept(*z, {entering, -1, -1}, 1);
    }
    for (int k = 0; k < n; ++k) {
      const auto z = two(entering, old[k]);
      if (!z) continue;
      const bool ok = n == 1   ? true
                      : n == 2 ? feasible(*z, {old[1 - k]})
                               : feasible(*z, {old[(k + 1) % 3], old[(k + 2) % 3]});
      if (ok) return accept(*z, {entering, old[k], -1}, 2);
    }
    for (int k = 0; k + 1 < n; ++k) {
      for (int l = k + 1; l < n; ++l) {
        const auto z = three(entering, old[k], old[l]);
        if (z && (n < 3 || feasible(*z, {old[3 - k - l]})))
          return accept(*z, {entering, old[k], old[l]}, 3);
      }
    }
    return false;
  }

  bool accept(const Vec3& z, std::array<int, 3> basis, int size) {
    z_ = z;
    basis_ = basis;
    size_ = size;
    return true;
  }

  [[nodiscard]] const Plane& plane(int i) const { return planes_[static_cast<std::size_t>(i)]; }

  // Closest points with one, two, three planes active and multipliers ≥ 0.
  [[nodiscard]] std::optional<Vec3> one(int i) const {
    const Plane& p = plane(i);
    if (p.c < 0) return std::nullopt;
    return Vec3(p.c * p.u);
  }

  [[nodiscard]] std::optional<Vec3> two(int i, int j) const {
    const Plane &p = plane(i), &q = plane(j);
    const double r = p.u.dot(q.u);
    const double det = 1 - r * r;
    if (det < kParallel) return std::nullopt;
    const double a = (p.c - r * q.c) / det, b = (q.c - r * p.c) / det;
    if (a < 0 || b < 0) return std::nullopt;
    return Vec3(a * p.u + b * q.u);
  }

  [[nodiscard]] std::optional<Vec3> three(int i, int j, int k) const {
    const Plane &p = plane(i), &q = plane(j), &r = plane(k);
    const Vec3 qr = q.u.cross(r.u), rp = r.u.cross(p.u), pq = p.u.cross(q.u);
    const double det = p.u.dot(qr);
    if (std::abs(det) < kFlat) return std::nullopt;
    const Vec3 z = (p.c * qr + q.c * rp + r.c * pq) / det;
    // z = λp + μq + νr  ⇒  λ = z·(q×r)/det and so on.
    const double slack = -kMultiplierSlack * z.lpNorm<1>();
    if (z.dot(qr) / det < slack || z.dot(rp) / det < slack || z.dot(pq) / det < slack)
      return std::nullopt;
    return z;
  }

  std::span<const HalfSpace> half_spaces_;
  const Cholesky& l_;
  const Vec3& shift_;
  std::array<Plane, 4> planes_;  // the basis, and the one that enters
  Vec3 z_ = Vec3::Zero();
  std::array<int, 3> basis_{-1, -1, -1};
  int size_ = 0;
};

}  // namespace

std::optional<Vec3> minimise(const Quadric& quadratic, const Vec3& linear,
                             std::span<const HalfSpace> half_spaces, double regularisation) {
  // With A' = LLᵀ, z = Lᵀy + L⁻¹b': the objective is |z|² plus a constant, and n·y ≥ d becomes
  // (L⁻¹n)·z ≥ d + (L⁻¹n)·(L⁻¹b').
  const Cholesky l(quadratic, regularisation);
  const Vec3 shift = l.forward(linear * l.scale);
  return ClosestPoint(half_spaces, l, shift).solve();
}

}  // namespace kaboum::bmesh
