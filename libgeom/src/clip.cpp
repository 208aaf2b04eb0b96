#include <kaboum/geom/clip.h>

namespace kaboum::geom {

bool cut(const ConvexPolygon& polygon, const Vec3& p, const Vec3& n, ConvexPolygon& below,
         ConvexPolygon& above) {
  std::array<double, ConvexPolygon::kCapacity> height{};
  double reach = 0;
  for (int i = 0; i < polygon.size; ++i) {
    height[i] = n.dot(polygon.corner[i] - p);
    reach = std::max(reach, std::abs(height[i]));
  }
  // Corners within rounding of the plane count as on it, lest cuts leave splinters.
  const double on = 1e-9 * reach;
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
