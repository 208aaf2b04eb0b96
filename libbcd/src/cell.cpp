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
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kFaces{
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}}};
  for (const auto& face : kFaces) {
    for (const std::uint32_t v : face) cell.faces.add_corner(v);
    cell.faces.end_loop();
  }
  return cell;
}

std::vector<std::array<std::uint32_t, 2>> Cell::edges() const {
  std::vector<std::array<std::uint32_t, 2>> out;
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::span<const std::uint32_t> face = faces[f];
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
  for (std::size_t f = 0; f < faces.size(); ++f) {
    const std::span<const std::uint32_t> face = faces[f];
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

namespace {

constexpr std::uint32_t kNotKept = 0xFFFFFFFF;

/// Grows with the angle of a vector from −x on, counter-clockwise, without its functions.
double turn_of(double x, double y) {
  const double size = std::abs(x) + std::abs(y), t = size > 0 ? x / size : 1;
  return y < 0 ? t : 2 - t;
}

/// Room for clipping, kept from one cell to the next.
struct ClipScratch {
  std::vector<double> height;
  std::vector<std::uint32_t> number;  // of a corner that is kept
  struct OnEdge {
    std::uint32_t from, to, at;
  };
  std::vector<OnEdge> on_edge;
  std::vector<std::uint32_t> cap;
  std::vector<std::pair<double, std::uint32_t>> order;
};

ClipScratch& clip_scratch() {
  static thread_local ClipScratch s;
  return s;
}

/// The face in the cutting plane: its corners in order round their middle.
void add_cap(const Plane& plane, bool lower, ClipScratch& s, Cell& out) {
  Vec3 center = Vec3::Zero();
  for (const std::uint32_t v : s.cap) center += out.corners[v] / static_cast<double>(s.cap.size());
  const Vec3 u = plane.n.unitOrthogonal(), w = plane.n.cross(u);
  s.order.clear();
  for (const std::uint32_t v : s.cap) {
    const Vec3 r = out.corners[v] - center;
    s.order.emplace_back(turn_of(u.dot(r), w.dot(r)), v);
  }
  std::sort(s.order.begin(), s.order.end());
  if (!lower) std::reverse(s.order.begin(), s.order.end());
  for (const auto& [turn, v] : s.order) out.faces.add_corner(v);
  out.faces.end_loop();
}

/// The point of an edge at height 0, which both of its faces have.
std::uint32_t cut_edge(const Cell& cell, std::uint32_t a, std::uint32_t b, ClipScratch& s,
                       Cell& out) {
  const std::uint32_t from = std::min(a, b), to = std::max(a, b);
  for (const ClipScratch::OnEdge& known : s.on_edge)
    if (known.from == from && known.to == to) return known.at;
  const auto at = static_cast<std::uint32_t>(out.corners.size());
  s.on_edge.push_back({from, to, at});
  const Vec3 &p = cell.corners[from], &q = cell.corners[to];
  out.corners.push_back(p + (s.height[from] / (s.height[from] - s.height[to])) * (q - p));
  s.cap.push_back(at);
  return at;
}

}  // namespace

Cell clip(const Cell& cell, const Plane& plane, bool lower, double shift) {
  Cell out;
  return clip(cell, plane, lower, shift, out) ? out : cell;
}

bool clip(const Cell& cell, const Plane& plane, bool lower, double shift, Cell& out) {
  ClipScratch& s = clip_scratch();
  const std::size_t count = cell.corners.size();
  s.height.resize(count);
  bool all_below = true, all_above = true;
  for (std::size_t i = 0; i < count; ++i) {
    const double h = plane.height(cell.corners[i]);
    s.height[i] = (lower ? h : -h) - shift;  // kept where ≤ 0
    all_below = all_below && s.height[i] < 0;
    all_above = all_above && s.height[i] > 0;
  }
  if (all_below) return false;
  out.corners.clear();
  out.faces.clear();
  if (all_above) return true;
  s.number.assign(count, kNotKept);
  s.on_edge.clear();
  s.cap.clear();
  for (std::size_t f = 0; f < cell.faces.size(); ++f) {
    const std::span<const std::uint32_t> face = cell.faces[f];
    for (std::size_t k = 0; k < face.size(); ++k) {
      const std::uint32_t a = face[k], b = face[k + 1 < face.size() ? k + 1 : 0];
      const double ha = s.height[a], hb = s.height[b];
      if (ha <= 0) {
        if (s.number[a] == kNotKept) {
          s.number[a] = static_cast<std::uint32_t>(out.corners.size());
          out.corners.push_back(cell.corners[a]);
          if (ha == 0) s.cap.push_back(s.number[a]);
        }
        out.faces.add_corner(s.number[a]);
      }
      if ((ha < 0 && hb > 0) || (ha > 0 && hb < 0))
        out.faces.add_corner(cut_edge(cell, a, b, s, out));
    }
    out.faces.end_loop();
  }
  if (out.faces.empty()) {
    out.corners.clear();
  } else if (s.cap.size() >= 3 && out.corners.size() > s.cap.size()) {
    add_cap(plane, lower, s, out);
  }
  return true;
}

}  // namespace kaboum::bcd
