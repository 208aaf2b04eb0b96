// Cutting a planar convex polygon in two, in rounded arithmetic whose error is counted.
// docs/algorithms/distances.md.
#include <kaboum/geom/clip.h>

namespace kaboum::geom {

bool cut(const ConvexPolygon& polygon, const Vec3& p, const Vec3& n, ConvexPolygon& below,
         ConvexPolygon& above) {
  std::array<double, ConvexPolygon::kCapacity> height{};
  double highest = 0;
  for (int i = 0; i < polygon.size; ++i) {
    height[i] = n.dot(polygon.corner[i] - p);
    highest = std::max(highest, std::abs(height[i]));
  }
  // Corners within rounding of the plane count as on it, lest cuts leave splinters.
  const double on = 1e-9 * highest;
  bool any_below = false, any_above = false;
  for (int i = 0; i < polygon.size; ++i) {
    any_below = any_below || height[i] < -on;
    any_above = any_above || height[i] > on;
  }
  if (!any_below || !any_above) return false;
  below.size = above.size = 0;
  for (int i = 0; i < polygon.size; ++i) {
    const int j = (i + 1) % polygon.size;
    const Vec3 &a = polygon.corner[i], &b = polygon.corner[j];
    if (std::max(below.size, above.size) > ConvexPolygon::kCapacity - 2) return false;
    if (height[i] <= on) below.corner[below.size++] = a;
    if (height[i] >= -on) above.corner[above.size++] = a;
    if ((height[i] < -on && height[j] > on) || (height[i] > on && height[j] < -on)) {
      const Vec3 x = a + (height[i] / (height[i] - height[j])) * (b - a);
      below.corner[below.size++] = x;
      above.corner[above.size++] = x;
    }
  }
  return true;
}

std::optional<CuttingPlane> bisector(const std::array<Vec3, 3>& first,
                                     const std::array<Vec3, 3>& second, const Vec3& near,
                                     double least) {
  // The unit normal that looks at `near`, and the height of `near` above the plane; 0 without area.
  const auto plane = [&](const std::array<Vec3, 3>& t, double& height) -> Vec3 {
    const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
    const double length = n.norm();
    if (!(length > 0)) return Vec3::Zero();
    const double h = n.dot(near - t[0]) / length;
    height = std::abs(h);
    return (h < 0 ? -1 : 1) * (n / length);
  };
  double h1 = 0, h2 = 0;
  const Vec3 n1 = plane(first, h1), n2 = plane(second, h2);
  if (n1.isZero(0) || n2.isZero(0)) return std::nullopt;
  const Vec3 n = n1 - n2;
  const double square = n.squaredNorm();
  if (square < least) return std::nullopt;
  return CuttingPlane{near - ((h1 - h2) / square) * n, n};
}

void halve(const ConvexPolygon& polygon, ConvexPolygon& first, ConvexPolygon& second) {
  if (polygon.size < ConvexPolygon::kCapacity) {
    int from = 0, to = 1;
    for (int i = 0; i < polygon.size; ++i)
      for (int j = i + 1; j < polygon.size; ++j)
        if ((polygon.corner[j] - polygon.corner[i]).squaredNorm() >
            (polygon.corner[to] - polygon.corner[from]).squaredNorm()) {
          from = i;
          to = j;
        }
    const Vec3 &a = polygon.corner[from], &b = polygon.corner[to];
    if (cut(polygon, 0.5 * a + 0.5 * b, b - a, first, second)) return;
  }
  // Too many corners, or all of them in one place: along a diagonal, or into the whole and an edge.
  const int middle = polygon.size / 2;
  first.size = second.size = 0;
  for (int i = 0; i <= middle; ++i) first.corner[first.size++] = polygon.corner[i];
  for (int i = middle; i < polygon.size; ++i) second.corner[second.size++] = polygon.corner[i];
  second.corner[second.size++] = polygon.corner[0];
}

PrismCut cut_by_prism(const ConvexPolygon& polygon, const Vec3& a, const Vec3& b, const Vec3& c,
                      bool halving) {
  PrismCut out;
  if (!halving && polygon.size < ConvexPolygon::kCapacity) {
    const Vec3 n = (b - a).cross(c - a);
    ConvexPolygon rest = polygon;
    const std::array<const Vec3*, 3> corner{&a, &b, &c};
    for (int k = 0; k < 3; ++k) {
      const Vec3 &p = *corner[k], &q = *corner[(k + 1) % 3];
      ConvexPolygon inside;
      if (!cut(rest, p, (q - p).cross(n), inside, out.piece[out.count])) continue;
      ++out.count;
      rest = inside;
    }
    if (out.count > 0) {
      out.piece[out.count++] = rest;
      return out;
    }
  }
  halve(polygon, out.piece[0], out.piece[1]);
  out.count = 2;
  return out;
}

}  // namespace kaboum::geom
