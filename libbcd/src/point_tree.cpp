// A tree of boxes over points by halving their order; queries leave out boxes below a plane.

#include "point_tree.h"

#include <algorithm>

namespace kaboum::bcd {
namespace {

constexpr std::uint32_t kLeaf = 8;  // points
/// Boxes are wider by this share of the coordinates: their middles and halves are rounded.
constexpr double kBoxRounding = 0x1p-50;

/// Halves the points by their order along the longest side of their box, and each half again.
void sort_halves(std::span<geom::Vec3> points) {
  if (points.size() <= kLeaf) return;
  geom::Box3 box;
  for (const geom::Vec3& p : points) box.extend(p);
  int axis = 0;
  (box.max - box.min).maxCoeff(&axis);
  const std::size_t middle = points.size() / 2;
  std::nth_element(points.begin(), points.begin() + static_cast<std::ptrdiff_t>(middle),
                   points.end(),
                   [axis](const geom::Vec3& a, const geom::Vec3& b) { return a[axis] < b[axis]; });
  sort_halves(points.first(middle));
  sort_halves(points.subspan(middle));
}

}  // namespace

PointTree::PointTree(std::span<const geom::Vec3> points) : points_(points) {
  if (!points.empty()) add(0, static_cast<std::uint32_t>(points.size()));
}

std::vector<geom::Vec3> PointTree::ordered(std::span<const geom::Vec3> points) {
  std::vector<geom::Vec3> out(points.begin(), points.end());
  sort_halves(out);
  return out;
}

geom::Box3 PointTree::add(std::uint32_t first, std::uint32_t last) {
  const std::size_t self = nodes_.size();
  nodes_.emplace_back();
  geom::Box3 box;
  if (last - first <= kLeaf) {
    for (std::uint32_t i = first; i < last; ++i) box.extend(points_[i]);
  } else {
    const std::uint32_t middle = first + (last - first) / 2;
    for (const geom::Box3& half : {add(first, middle), add(middle, last)}) {
      box.extend(half.min);
      box.extend(half.max);
    }
  }
  const geom::Vec3 center = box.center();
  const double slack = kBoxRounding * (box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs())).maxCoeff();
  const geom::Vec3 half = 0.5 * (box.max - box.min) + geom::Vec3::Constant(slack);
  nodes_[self] = {center, half, first, last, static_cast<std::uint32_t>(nodes_.size())};
  return box;
}

bool PointTree::any_above(const geom::Vec3& n, double d) const {
  bool found = false;
  visit_above([&] { return std::pair<const geom::Vec3&, double>(n, d); },
              [&](const geom::Vec3& p) {
                found = n.dot(p) > d;
                return !found;
              });
  return found;
}

}  // namespace kaboum::bcd
