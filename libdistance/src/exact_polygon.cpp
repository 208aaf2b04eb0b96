// Planar convex polygons with rational corners, cut by planes. docs/algorithms/distances.md,
// "Solids".
#include "exact_polygon.h"

namespace kaboum::distance::exact {

void split(const Polygon& polygon, const Plane& plane, Polygon& below, Polygon& above) {
  below.clear();
  above.clear();
  std::vector<Number> h;
  h.reserve(polygon.size());
  bool any_below = false, any_above = false;
  for (const Point& p : polygon) {
    h.push_back(height(plane, p));
    any_below = any_below || h.back() < 0;
    any_above = any_above || h.back() > 0;
  }
  if (!any_above) {
    below = polygon;
    return;
  }
  if (!any_below) {
    above = polygon;
    return;
  }
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const std::size_t j = (i + 1) % polygon.size();
    if (h[i] <= 0) below.push_back(polygon[i]);
    if (h[i] >= 0) above.push_back(polygon[i]);
    if ((h[i] < 0 && h[j] > 0) || (h[i] > 0 && h[j] < 0)) {
      const Number s = h[i] / (h[i] - h[j]);
      Point x;
      for (int k = 0; k < 3; ++k) x[k] = polygon[i][k] + s * (polygon[j][k] - polygon[i][k]);
      below.push_back(x);
      above.push_back(x);
    }
  }
}

}  // namespace kaboum::distance::exact
