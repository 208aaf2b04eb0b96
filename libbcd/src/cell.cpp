// Bounded cells that space is cut into, and cubes that cover a box. docs/algorithms/
// convex-decomposition.md, "Cells".

#include "cell.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace kaboum::bcd {
namespace {

/// Of the way to the middle that a corner moves inwards where its faces are too much alike.
constexpr double kInward = 0x1p-30;

}  // namespace

Cell Cell::of(const Box3& box) {
  Cell cell;
  for (int i = 0; i < 8; ++i)
    cell.corners.emplace_back((i & 1) != 0 ? box.max.x() : box.min.x(),
                              (i & 2) != 0 ? box.max.y() : box.min.y(),
                              (i & 4) != 0 ? box.max.z() : box.min.z());
  cell.faces = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
  return cell;
}

std::vector<std::array<std::uint32_t, 2>> Cell::edges() const {
  std::vector<std::array<std::uint32_t, 2>> out;
  for (const auto& face : faces) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      out.push_back({std::min(a, b), std::max(a, b)});
    }
  }
  std::sort(out.begin(), out.end());
  out.erase(std::unique(out.begin(), out.end()), out.end());
  return out;
}

Vec3 Cell::center() const {
  Vec3 sum = Vec3::Zero();
  for (const Vec3& p : corners) sum += p / static_cast<double>(corners.size());
  return sum;
}

std::vector<Vec3> Cell::inward(double depth) const {
  const Vec3 middle = center();
  std::vector<std::vector<Vec3>> normals(corners.size());  // inwards, of the faces at each corner
  for (const auto& face : faces) {
    Vec3 normal = Vec3::Zero();
    for (std::size_t k = 1; k + 1 < face.size(); ++k)
      normal +=
          (corners[face[k]] - corners[face[0]]).cross(corners[face[k + 1]] - corners[face[0]]);
    const double length = normal.norm();
    if (!(length > 0)) continue;
    normal /= normal.dot(middle - corners[face[0]]) < 0 ? -length : length;
    for (const std::uint32_t v : face) normals[v].push_back(normal);
  }
  constexpr double kAlike = 1e-3;  // determinant of three normals
  std::vector<Vec3> out;
  for (std::size_t v = 0; v < corners.size(); ++v) {
    const std::vector<Vec3>& at = normals[v];
    Eigen::Matrix3d best = Eigen::Matrix3d::Zero();
    double volume = kAlike;
    for (std::size_t i = 0; i < at.size(); ++i)
      for (std::size_t j = 0; j < i; ++j)
        for (std::size_t k = 0; k < j; ++k) {
          const double v3 = std::abs(at[i].dot(at[j].cross(at[k])));
          if (v3 <= volume) continue;
          volume = v3;
          best << at[i].transpose(), at[j].transpose(), at[k].transpose();
        }
    out.push_back(corners[v] + (volume > kAlike ? Vec3(best.inverse() * Vec3::Constant(depth))
                                                : Vec3(kInward * (middle - corners[v]))));
  }
  return out;
}

std::vector<Cube> cubes_over(const Box3& box) {
  const Vec3 size = box.max - box.min;
  const double half = 0.5 * std::max(size.minCoeff(), size.maxCoeff() / 16);
  const Eigen::Array3i count = (size / (2 * half)).array().ceil().max(1).cast<int>();
  std::vector<Cube> out;
  for (int x = 0; x < count[0]; ++x)
    for (int y = 0; y < count[1]; ++y)
      for (int z = 0; z < count[2]; ++z)
        out.push_back({box.min + half * Vec3(2 * x + 1, 2 * y + 1, 2 * z + 1), half});
  return out;
}

Cell clip(const Cell& cell, const Plane& plane, bool lower, double shift) {
  std::vector<double> h(cell.corners.size());
  for (std::size_t i = 0; i < h.size(); ++i) {
    h[i] = plane.height(cell.corners[i]);
    h[i] = (lower ? h[i] : -h[i]) - shift;  // kept where ≤ 0
  }
  if (std::all_of(h.begin(), h.end(), [](double x) { return x < 0; })) return cell;
  if (std::all_of(h.begin(), h.end(), [](double x) { return x > 0; })) return {};
  Cell out;
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::vector<std::uint32_t> number(h.size(), kNone);
  std::vector<std::pair<std::array<std::uint32_t, 2>, std::uint32_t>> on_edge;  // each met twice
  const auto found = [&](const std::array<std::uint32_t, 2>& edge) {
    for (const auto& [known, at] : on_edge)
      if (known == edge) return at;
    return kNone;
  };
  std::vector<std::uint32_t> cap;
  for (const auto& face : cell.faces) {
    std::vector<std::uint32_t> loop;
    loop.reserve(face.size() + 1);
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[(k + 1) % face.size()];
      if (h[a] <= 0) {
        if (number[a] == kNone) {
          number[a] = static_cast<std::uint32_t>(out.corners.size());
          out.corners.push_back(cell.corners[a]);
          if (h[a] == 0) cap.push_back(number[a]);
        }
        loop.push_back(number[a]);
      }
      if ((h[a] < 0 && h[b] > 0) || (h[a] > 0 && h[b] < 0)) {
        const std::array<std::uint32_t, 2> edge{std::min(a, b), std::max(a, b)};
        std::uint32_t at = found(edge);
        if (at == kNone) {
          at = static_cast<std::uint32_t>(out.corners.size());
          on_edge.emplace_back(edge, at);
          const Vec3 &p = cell.corners[edge[0]], &q = cell.corners[edge[1]];
          out.corners.push_back(p + (h[edge[0]] / (h[edge[0]] - h[edge[1]])) * (q - p));
          cap.push_back(at);
        }
        loop.push_back(at);
      }
    }
    if (loop.size() >= 3) out.faces.push_back(std::move(loop));
  }
  if (out.faces.empty()) return {};
  if (cap.size() >= 3 && out.corners.size() > cap.size()) {
    // In order round the cut's centre.
    Vec3 center = Vec3::Zero();
    for (const std::uint32_t v : cap) center += out.corners[v] / static_cast<double>(cap.size());
    Vec3 u = plane.n.unitOrthogonal();
    const Vec3 w = plane.n.cross(u);
    std::vector<std::pair<double, std::uint32_t>> order;
    for (const std::uint32_t v : cap) {
      const Vec3 r = out.corners[v] - center;
      order.emplace_back(std::atan2(w.dot(r), u.dot(r)), v);
    }
    std::sort(order.begin(), order.end());
    std::vector<std::uint32_t> loop;
    loop.reserve(order.size());
    for (const auto& [angle, v] : order) loop.push_back(v);
    if (!lower) std::reverse(loop.begin(), loop.end());
    out.faces.push_back(std::move(loop));
  }
  return out;
}

}  // namespace kaboum::bcd
