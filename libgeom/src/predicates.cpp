// What the filters of the predicates leave open [shewchuk1997], decided in exact dyadic numbers.
#include <kaboum/geom/in_sphere.h>
#include <kaboum/geom/predicates.h>

#include <CGAL/Exact_rational.h>
#include <CGAL/Mpzf.h>
#include <CGAL/Simple_cartesian.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

namespace kaboum::geom::detail {
namespace {

// Exact arithmetic on doubles, without CGAL's interval stage: the callers have filtered already,
// and what is left is mostly exactly zero. Mpzf (dyadic numbers) is ten times faster than
// rationals.
#ifdef CGAL_HAS_MPZF
using Exact = CGAL::Simple_cartesian<CGAL::Mpzf>;
#else
using Exact = CGAL::Simple_cartesian<CGAL::Exact_rational>;
#endif

Sign to_sign(CGAL::Sign s) { return static_cast<Sign>(static_cast<int>(s)); }

__extension__ typedef __int128 Wide;  // NOLINT(modernize-use-using): not standard C++

Sign to_sign(Wide x) { return static_cast<Sign>((x > 0) - (x < 0)); }

/// Differences of doubles as integers times one power of two. Between neighbouring points of a mesh
/// they are short, so that determinants fit into 128 bits; that settles most of what a filter
/// leaves open, which is mostly exactly zero, several times faster than numbers of any length.
template <int N>
class Differences {
 public:
  /// @return whether every difference is exact and their bits span at most `bits`.
  bool set(const std::array<double, N>& from, const std::array<double, N>& to, int bits) {
    int high = std::numeric_limits<int>::min(), low = std::numeric_limits<int>::max();
    std::array<double, N> difference;
    for (int i = 0; i < N; ++i) {
      const double a = from[i], b = to[i], d = b - a;
      const double b_back = d + (b - d);
      if ((b - b_back) + ((b - d) - a) != 0) return false;  // what the rounding of d took away
      difference[i] = d;
      if (d == 0) continue;
      const auto pattern = std::bit_cast<std::uint64_t>(d);
      const int exponent = static_cast<int>((pattern >> 52U) & 0x7FFU);
      if (exponent == 0 || exponent == 0x7FF) return false;
      high = std::max(high, exponent);
      const std::uint64_t mantissa = (pattern & 0xFFFFFFFFFFFFFU) | 0x10000000000000U;
      low = std::min(low, exponent - 52 + std::countr_zero(mantissa));
    }
    if (high < low) {  // all are zero
      value_.fill(0);
      return true;
    }
    if (high - low >= bits) return false;
    const int shift = 1023 - low;
    if (shift < -1000 || shift > 1000) return false;
    const double scale = std::ldexp(1.0, shift);
    for (int i = 0; i < N; ++i) value_[i] = static_cast<std::int64_t>(difference[i] * scale);
    return true;
  }
  Wide operator[](int i) const { return value_[i]; }

 private:
  std::array<std::int64_t, N> value_;
};

}  // namespace

Sign orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  // Most of what gets here: a point that is one of the others, and planes across axes.
  if (a == b || a == c || a == d || b == c || b == d || c == d) return Sign::Zero;
  for (int k = 0; k < 3; ++k)
    if (a[k] == b[k] && a[k] == c[k] && a[k] == d[k]) return Sign::Zero;
  Differences<9> v;
  if (v.set({a.x(), a.y(), a.z(), a.x(), a.y(), a.z(), a.x(), a.y(), a.z()},
            {b.x(), b.y(), b.z(), c.x(), c.y(), c.z(), d.x(), d.y(), d.z()}, 41)) {
    // Six products of three 41-bit numbers.
    return to_sign(v[6] * (v[1] * v[5] - v[2] * v[4]) + v[7] * (v[2] * v[3] - v[0] * v[5]) +
                   v[8] * (v[0] * v[4] - v[1] * v[3]));
  }
  const auto point = [](const Vec3& p) { return Exact::Point_3(p.x(), p.y(), p.z()); };
  return to_sign(CGAL::orientation(point(a), point(b), point(c), point(d)));
}

Sign orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy) {
  if ((ax == bx && ax == cx) || (ay == by && ay == cy)) return Sign::Zero;
  if ((ax == bx && ay == by) || (ax == cx && ay == cy) || (bx == cx && by == cy)) return Sign::Zero;
  Differences<4> v;
  if (v.set({ax, ay, ax, ay}, {bx, by, cx, cy}, 62)) return to_sign(v[0] * v[3] - v[1] * v[2]);
  return to_sign(
      CGAL::orientation(Exact::Point_2(ax, ay), Exact::Point_2(bx, by), Exact::Point_2(cx, cy)));
}

}  // namespace kaboum::geom::detail

namespace kaboum::geom {

Sign in_sphere(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d, const Vec3& e) {
  const Vec3 p = a - e, q = b - e, r = c - e, s = d - e;
  const auto minor = [](const Vec3& u, const Vec3& v) { return u.x() * v.y() - v.x() * u.y(); };
  const double pq = minor(p, q), qr = minor(q, r), rs = minor(r, s), sp = minor(s, p),
               pr = minor(p, r), qs = minor(q, s);
  const double pqr = p.z() * qr - q.z() * pr + r.z() * pq,
               qrs = q.z() * rs - r.z() * qs + s.z() * qr,
               rsp = r.z() * sp + s.z() * pr + p.z() * rs,
               spq = s.z() * pq + p.z() * qs + q.z() * sp;
  const double det = (r.squaredNorm() * spq - s.squaredNorm() * pqr) +
                     (p.squaredNorm() * qrs - q.squaredNorm() * rsp);
  // The rounded determinant errs by less than 1.8e-15 times its expansion with absolute values
  // (Shewchuk 1997), which is at most 24 xyz (x² + y² + z²), x, y, z the largest |coordinates| of
  // the differences. Within the window no underflow adds a noticeable part, and nothing overflows.
  const Vec3 most =
      p.cwiseAbs().cwiseMax(q.cwiseAbs()).cwiseMax(r.cwiseAbs()).cwiseMax(s.cwiseAbs());
  if (most.minCoeff() > 1e-50 && most.maxCoeff() < 1e50) {
    const double bound = 4.8e-14 * (most.x() * most.y() * most.z()) * most.squaredNorm();
    if (det > bound) return Sign::Positive;
    if (det < -bound) return Sign::Negative;
  }
  const auto point = [](const Vec3& x) { return detail::Exact::Point_3(x.x(), x.y(), x.z()); };
  return detail::to_sign(
      CGAL::side_of_oriented_sphere(point(a), point(b), point(c), point(d), point(e)));
}

}  // namespace kaboum::geom
