#include <kaboum/geom/predicates.h>

#include <CGAL/Exact_rational.h>
#include <CGAL/Mpzf.h>
#include <CGAL/Simple_cartesian.h>

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

}  // namespace

Sign orient3d_exact(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto point = [](const Vec3& p) { return Exact::Point_3(p.x(), p.y(), p.z()); };
  return to_sign(CGAL::orientation(point(a), point(b), point(c), point(d)));
}

Sign orient2d_exact(double ax, double ay, double bx, double by, double cx, double cy) {
  return to_sign(
      CGAL::orientation(Exact::Point_2(ax, ay), Exact::Point_2(bx, by), Exact::Point_2(cx, cy)));
}

}  // namespace kaboum::geom::detail
