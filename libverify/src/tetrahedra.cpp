// Boxes as tetrahedra, and cuts of tetrahedra by planes, rounded.
#include "tetrahedra.h"

#include <algorithm>

namespace kaboum::verify {

std::array<Tetrahedron, 6> tetrahedra(const Bounds& box) {
  std::array<Tetrahedron, 6> result;
  std::array<int, 3> order{0, 1, 2};
  for (auto& tetrahedron : result) {
    Vec3 p(box.low.data());
    tetrahedron[0] = p;
    for (int i = 0; i < 3; ++i) {
      p[order[i]] = box.high[order[i]];
      tetrahedron[i + 1] = p;
    }
    std::next_permutation(order.begin(), order.end());
  }
  return result;
}

void cut(const Part& part, const Plane& plane, std::vector<Part>& above, std::vector<Part>& below) {
  std::array<double, 4> height;
  std::array<int, 4> order{0, 1, 2, 3};
  for (int i = 0; i < 4; ++i) height[i] = plane.normal.dot(part.corners[i]) - plane.height;
  std::sort(order.begin(), order.end(), [&](int i, int j) { return height[i] > height[j]; });
  const auto corner = [&](int i) -> const Vec3& { return part.corners[order[i]]; };
  const auto between = [&](int i, int j) -> Vec3 {
    const double h = height[order[i]], t = h / (h - height[order[j]]);
    return (1 - t) * corner(i) + t * corner(j);
  };
  const int cuts = part.cuts + 1;
  const auto prism = [&](std::vector<Part>& to, const std::array<Vec3, 3>& p,
                         const std::array<Vec3, 3>& q) {
    to.push_back({{p[0], p[1], p[2], q[0]}, cuts});
    to.push_back({{p[1], p[2], q[0], q[1]}, cuts});
    to.push_back({{p[2], q[0], q[1], q[2]}, cuts});
  };
  const auto positive = std::count_if(height.begin(), height.end(), [](double h) { return h > 0; });
  if (positive == 1 || positive == 3) {
    const bool tip_above = positive == 1;
    const int tip = tip_above ? 0 : 3;
    std::array<Vec3, 3> base, middle;
    for (int k = 0; k < 3; ++k) {
      const int other = tip_above ? k + 1 : k;
      base[k] = corner(other);
      middle[k] = tip_above ? between(tip, other) : between(other, tip);
    }
    (tip_above ? above : below).push_back({{corner(tip), middle[0], middle[1], middle[2]}, cuts});
    prism(tip_above ? below : above, base, middle);
  } else {
    const Vec3 ac = between(0, 2), ad = between(0, 3), bc = between(1, 2), bd = between(1, 3);
    prism(above, {corner(0), ac, ad}, {corner(1), bc, bd});
    prism(below, {corner(2), ac, bc}, {corner(3), ad, bd});
  }
}

}  // namespace kaboum::verify
