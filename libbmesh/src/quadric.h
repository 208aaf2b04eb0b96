#pragma once

#include <kaboum/geom/mesh.h>

namespace kaboum::bmesh {

using geom::Vec3;

/// Quadric metric x ↦ xᵀAx + 2bᵀx + c, A symmetric positive semidefinite. [length²]
/// Source: [gaschler2016] Eq. 4.3, A.1.
struct Quadric {
  double xx = 0, xy = 0, xz = 0, yy = 0, yz = 0, zz = 0;  // A
  double bx = 0, by = 0, bz = 0;
  double c = 0;

  Quadric& operator+=(const Quadric& q) {
    xx += q.xx, xy += q.xy, xz += q.xz, yy += q.yy, yz += q.yz, zz += q.zz;
    bx += q.bx, by += q.by, bz += q.bz;
    c += q.c;
    return *this;
  }
  Quadric& operator*=(double f) {
    xx *= f, xy *= f, xz *= f, yy *= f, yz *= f, zz *= f;
    bx *= f, by *= f, bz *= f;
    c *= f;
    return *this;
  }
  friend Quadric operator+(Quadric a, const Quadric& b) { return a += b; }

  [[nodiscard]] double operator()(const Vec3& p) const {
    const double x = p.x(), y = p.y(), z = p.z();
    return x * (xx * x + 2 * (xy * y + xz * z + bx)) + y * (yy * y + 2 * (yz * z + by)) +
           z * (zz * z + 2 * bz) + c;
  }
  [[nodiscard]] double trace() const { return xx + yy + zz; }
  /// ½ gradient at p: Ap + b.
  [[nodiscard]] Vec3 half_gradient(const Vec3& p) const {
    return {xx * p.x() + xy * p.y() + xz * p.z() + bx, xy * p.x() + yy * p.y() + yz * p.z() + by,
            xz * p.x() + yz * p.y() + zz * p.z() + bz};
  }
};

/// Squared distance to a point. [gaschler2016] Eq. A.3.
Quadric point_quadric(const Vec3& p);

/// Squared distance to the plane through p with unit normal n. [gaschler2016] Eq. A.5.
inline Quadric plane_quadric(const Vec3& p, const Vec3& n) {
  const double d = -n.dot(p);
  return {n.x() * n.x(), n.x() * n.y(), n.x() * n.z(), n.y() * n.y(), n.y() * n.z(),
          n.z() * n.z(), d * n.x(),     d * n.y(),     d * n.z(),     d * d};
}

/// Q1 + Q2 with its constant lowered by max(Q1(m), Q2(m)), m the minimiser of the sum.
/// [gaschler2016] §4.3.3, "Adjustment of the Constant". A cost, not an upper bound of min(Q1, Q2)
/// as printed: Q1 = 4x², Q2 = (x−1)² at x = 0.21 gives 0.1605 < 0.1764.
Quadric add_adapted(const Quadric& a, const Quadric& b);

/// Upper bound of Q1 and Q2 that is diagonal in the principal frame of Q1 + Q2.
/// [gaschler2016] §4.3.3, "Adjustment of all Coefficients".
///
/// As printed (Eq. 4.6) a row's diagonal entry is √(s_ii² + s_ij²), which is no bound: S =
/// [[1,1],[1,1]] at (1,1) gives 4 > 2√2. Corrected: s_ii + Σ_{j≠i} |s_ij| (Gershgorin). Eq. 4.7
/// likewise needs |t|.
///
/// @param length  the free parameter l > 0 of Eq. 4.7: where the bound of linear terms is tight.
Quadric add_diagonal(const Quadric& a, const Quadric& b, double length, bool as_printed);

}  // namespace kaboum::bmesh
