// Clusters of triangles, each by few points whose hull holds them.

#include "hull_tree.h"

#include <kaboum/geom/convex_hull.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "numbers.h"
#include "simplex.h"

namespace kaboum::pairs::detail {
namespace {

constexpr std::size_t kFewPoints = 20;     ///< that are kept as they are
constexpr std::size_t kManyCorners = 100;  ///< of which those that are kept are chosen at once

/// Distance of p from the hull of the points, from above: that of a mean of them.
double distance_to_hull(const Vec3& p, const std::vector<Vec3>& points) {
  Simplex s;
  Vec3 nearest = points.front() - p;
  s.add(nearest, p, points.front());
  s.reduce();
  double best = nearest.norm();
  for (int step = 0; step < 30 && s.size < 4; ++step) {
    double least = nearest.dot(points.front() - p);
    std::size_t at = 0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const double along = nearest.dot(points[i] - p);
      if (along < least) {
        least = along;
        at = i;
      }
    }
    if (nearest.squaredNorm() - least <= 1e-12 * best * best) break;
    s.add(points[at] - p, p, points[at]);
    nearest = s.reduce();
    Vec3 mean = Vec3::Zero();
    double sum = 0;
    for (int i = 0; i < s.size; ++i) {
      mean += s.weights[i] * s.points[i];
      sum += s.weights[i];
    }
    best = std::min(best, mean.norm() / sum);
  }
  return best;
}

/// Of points, those that are vertices of their hull, and perhaps some more.
std::vector<Vec3> corners_of(const std::vector<Vec3>& points) {
  geom::HullBuilder hull;
  if (!hull.build(points)) return points;
  std::vector<Vec3> out;
  for (const std::uint32_t v : hull.vertices()) out.push_back(points[v]);
  return out;
}

/// Some of the points, and how far the others are from the hull of those at most.
double choose(const std::vector<Vec3>& corners, double size, std::vector<Vec3>& chosen) {
  std::vector<char> taken(corners.size(), 0);
  const auto take = [&](std::size_t i) {
    if (taken[i] == 0) chosen.push_back(corners[i]);
    taken[i] = 1;
  };
  // Of many corners, the farthest ones in directions spread evenly (a spiral); of few, those that
  // come farthest out of the hull of the others, one after the other.
  const bool many = corners.size() > kManyCorners;
  const std::size_t directions = many ? HullTree::kMostPoints : 14;
  for (std::size_t k = 0; k < directions; ++k) {
    const double z = 1 - 2 * (static_cast<double>(k) + 0.5) / static_cast<double>(directions);
    const double turn = static_cast<double>(k) * std::numbers::pi * (3 - std::sqrt(5.0));
    const double across = std::sqrt(1 - z * z);
    const Vec3 d(across * std::cos(turn), across * std::sin(turn), z);
    std::size_t best = 0;
    for (std::size_t i = 1; i < corners.size(); ++i)
      if (d.dot(corners[i]) > d.dot(corners[best])) best = i;
    take(best);
  }
  std::vector<double> far(corners.size(), 0);
  for (; !many;) {
    std::size_t farthest = 0;
    double most = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      if (taken[i] != 0) continue;
      if (far[i] == 0 || far[i] > most) far[i] = distance_to_hull(corners[i], chosen);
      if (far[i] <= most) continue;
      most = far[i];
      farthest = i;
    }
    if (most <= 2e-3 * size || chosen.size() >= HullTree::kMostPoints) break;
    take(farthest);
  }
  double all = 0;
  for (std::size_t i = 0; i < corners.size(); ++i)
    if (taken[i] == 0) all = std::max(all, distance_to_hull(corners[i], chosen));
  return all;
}

}  // namespace

HullTree::HullTree(const Mesh& mesh) {
  if (mesh.triangles.empty()) return;
  std::vector<std::uint32_t> order(mesh.triangles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::vector<Vec3> centers;
  centers.reserve(order.size());
  for (const geom::Triangle& t : mesh.triangles) {
    centers.emplace_back((mesh.vertices[t[0]] + mesh.vertices[t[1]] + mesh.vertices[t[2]]) / 3);
    for (const std::uint32_t v : t)
      extent_ = std::max(extent_, mesh.vertices[v].norm() * (1 + kRounding));
  }
  build(mesh, order, 0, order.size(), centers);
}

std::uint32_t HullTree::build(const Mesh& mesh, std::vector<std::uint32_t>& order,
                              std::size_t begin, std::size_t end,
                              const std::vector<Vec3>& centers) {
  std::vector<std::uint32_t> indices;
  for (std::size_t i = begin; i < end; ++i)
    for (const std::uint32_t v : mesh.triangles[order[i]]) indices.push_back(v);
  std::ranges::sort(indices);
  indices.erase(std::unique(indices.begin(), indices.end()), indices.end());
  std::vector<Vec3> points;
  points.reserve(indices.size());
  geom::Box3 box, middles;
  for (const std::uint32_t v : indices) {
    points.push_back(mesh.vertices[v]);
    box.extend(mesh.vertices[v]);
  }
  for (std::size_t i = begin; i < end; ++i) middles.extend(centers[order[i]]);

  Cluster cluster;
  cluster.center = box.center();
  for (const Vec3& p : points) cluster.reach = std::max(cluster.reach, (p - cluster.center).norm());
  cluster.reach = cluster.reach * (1 + kRounding) + kRounding * extent_;
  if (points.size() > kFewPoints) {
    std::vector<Vec3> corners = corners_of(points);
    if (corners.size() > HullTree::kMostPoints) {
      std::vector<Vec3> chosen;
      cluster.radius = choose(corners, box.diagonal(), chosen) + kRounding * extent_;
      corners = std::move(chosen);
    }
    points = std::move(corners);
  }
  cluster.first = static_cast<std::uint32_t>(coordinates_.size());
  cluster.count = static_cast<std::uint32_t>(points.size());
  for (int k = 0; k < 3; ++k)
    for (const Vec3& p : points) coordinates_.push_back(p[k]);

  const auto index = static_cast<std::uint32_t>(clusters_.size());
  cluster.triangle = order[begin];
  clusters_.push_back(cluster);
  if (end - begin == 1) return index;
  const Vec3 lengths = middles.max - middles.min;
  int axis = 0;
  lengths.maxCoeff(&axis);
  const double middle = middles.center()[axis];
  const auto from = order.begin() + static_cast<std::ptrdiff_t>(begin),
             to = order.begin() + static_cast<std::ptrdiff_t>(end);
  auto cut =
      std::stable_partition(from, to, [&](std::uint32_t t) { return centers[t][axis] < middle; });
  // Halves, where the middle leaves little on one side: no tree is deep.
  const std::ptrdiff_t few = (to - from) / 16;
  if (cut - from <= few || to - cut <= few) {
    cut = from + (to - from) / 2;
    std::nth_element(from, cut, to, [&](std::uint32_t s, std::uint32_t t) {
      return centers[s][axis] != centers[t][axis] ? centers[s][axis] < centers[t][axis] : s < t;
    });
  }
  const auto half = static_cast<std::size_t>(cut - order.begin());
  const std::uint32_t left = build(mesh, order, begin, half, centers);
  const std::uint32_t right = build(mesh, order, half, end, centers);
  clusters_[index].left = left;
  clusters_[index].right = right;
  return index;
}

}  // namespace kaboum::pairs::detail
