// A tree over a polytope's facets by their normals; the facet that a point is farthest beyond is
// found by branch and bound.

#include "facet_tree.h"

#include <algorithm>

namespace kaboum::bcd {
namespace {

constexpr std::uint32_t kLeaf = 6;  // facets
/// Rounding of a height, as a share of the coordinates: 16 units in the last place.
constexpr double kCornerSlack = 0x1p-48;

}  // namespace

FacetTree::FacetTree(std::vector<Facet> facets, const geom::Vec3& center, double size)
    : facets_(std::move(facets)),
      center_(center),
      slack_(kCornerSlack * (size + center.cwiseAbs().maxCoeff())) {
  if (!facets_.empty()) add(0, static_cast<std::uint32_t>(facets_.size()));
}

std::uint32_t FacetTree::add(std::uint32_t first, std::uint32_t last) {
  const auto self = static_cast<std::uint32_t>(nodes_.size());
  Node node{facets_[first].n, facets_[first].n, facets_[first].d - facets_[first].n.dot(center_),
            first, last - first};
  for (std::uint32_t i = first + 1; i < last; ++i) {
    node.low = node.low.cwiseMin(facets_[i].n);
    node.high = node.high.cwiseMax(facets_[i].n);
    node.least = std::min(node.least, facets_[i].d - facets_[i].n.dot(center_));
  }
  nodes_.push_back(node);
  if (last - first <= kLeaf) return self;
  int axis = 0;
  (node.high - node.low).maxCoeff(&axis);
  const std::uint32_t middle = first + (last - first) / 2;
  std::nth_element(facets_.begin() + first, facets_.begin() + middle, facets_.begin() + last,
                   [axis](const Facet& a, const Facet& b) { return a.n[axis] < b.n[axis]; });
  add(first, middle);
  nodes_[self].first = add(middle, last);
  nodes_[self].count = 0;
  return self;
}

double FacetTree::bound(const Node& node, const geom::Vec3& from_center) const {
  return node.low.cwiseProduct(from_center).cwiseMax(node.high.cwiseProduct(from_center)).sum() -
         node.least + slack_;
}

double FacetTree::beyond(const geom::Vec3& p, double least, double enough) const {
  return farthest(p, least, enough).first;
}

std::pair<double, std::uint32_t> FacetTree::farthest(const geom::Vec3& p, double least,
                                                     double enough) const {
  double best = least;
  std::uint32_t facet = 0;
  if (nodes_.empty()) return {best, facet};
  const geom::Vec3 from_center = p - center_;
  std::array<std::pair<double, std::uint32_t>, 64> stack;  // the facets are halved each time
  int size = 0;
  stack[size++] = {bound(nodes_[0], from_center), 0};
  while (size > 0 && best <= enough) {
    const auto [most, index] = stack[--size];
    if (most <= best) continue;
    const Node& node = nodes_[index];
    if (node.count > 0) {
      for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        const Facet& f = facets_[i];
        const double height = f.n.x() * p.x() + f.n.y() * p.y() + f.n.z() * p.z() - f.d;
        if (height > best) {
          best = height;
          facet = i;
        }
      }
      continue;
    }
    std::pair<double, std::uint32_t> left{bound(nodes_[index + 1], from_center), index + 1};
    std::pair<double, std::uint32_t> right{bound(nodes_[node.first], from_center), node.first};
    if (left.first > right.first) std::swap(left, right);
    stack[size++] = left;
    stack[size++] = right;
  }
  return {best, facet};
}

}  // namespace kaboum::bcd
