#include "inside_out.h"

#include <CGAL/Exact_rational.h>
#include <CGAL/Simple_cartesian.h>

#include <cmath>

namespace kaboum::verify {
namespace {

using Rationals = CGAL::Simple_cartesian<CGAL::Exact_rational>;

Rationals::Vector_3 to_rationals(const geom::Vec3& p) { return {p.x(), p.y(), p.z()}; }

/// Whether neither products of three coordinates nor sums of them can leave the range of normal
/// doubles: a difference of products that is not 0 is at least 2^-53 of the smaller.
bool is_far_from_limits(const geom::Mesh& mesh) {
  constexpr double kLargest = 1e80, kSmallest = 1e-80;
  for (const geom::Vec3& v : mesh.vertices)
    for (const double x : v)
      if (x != 0 && !(std::abs(x) >= kSmallest && std::abs(x) <= kLargest)) return false;
  return true;
}

}  // namespace

bool is_inside_out(const geom::Mesh& mesh) {
  if (is_far_from_limits(mesh)) {
    double sum = 0, magnitude = 0;
    for (const geom::Triangle& t : mesh.triangles) {
      const geom::Vec3& a = mesh.vertices[t[0]];
      const geom::Vec3& b = mesh.vertices[t[1]];
      const geom::Vec3& c = mesh.vertices[t[2]];
      sum += a.dot(b.cross(c));
      magnitude += a.norm() * b.norm() * c.norm();
    }
    // A term errs by less than 32 times 2^-52 of the product of its corners' norms, the sum by one
    // 2^-52 of all for each term; the factor 2 is for the rounding of this bound itself.
    const double error =
        2 * (32.0 + static_cast<double>(mesh.triangles.size())) * 0x1p-52 * magnitude;
    if (std::abs(sum) > error) return sum < 0;
  }
  Rationals::FT volume = 0;
  for (const geom::Triangle& t : mesh.triangles)
    volume +=
        CGAL::determinant(to_rationals(mesh.vertices[t[0]]), to_rationals(mesh.vertices[t[1]]),
                          to_rationals(mesh.vertices[t[2]]));
  return volume < 0;
}

}  // namespace kaboum::verify
