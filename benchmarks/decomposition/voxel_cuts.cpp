// Cuts chosen by volumes of voxels, for comparison. Source: [mamou2016], V-HACD.

#include "voxel_cuts.h"

#include <kaboum/base/parallel.h>
#include <kaboum/geom/convex_hull.h>

#include <algorithm>
#include <cmath>

namespace kaboum::bcd {
namespace {

/// Bodies no longer than this share of the diagonal are not cut.
constexpr double kThinnest = 1e-6;

}  // namespace

VoxelCuts::VoxelCuts(const SolidField& solid, std::size_t voxels)
    : origin_(solid.box().min), smallest_(kThinnest * solid.diagonal()) {
  const Vec3 size = (solid.box().max - solid.box().min).cwiseMax(kFlattestGrid * solid.diagonal());
  spacing_ = std::cbrt(size.prod() / static_cast<double>(voxels));
  for (int k = 0; k < 3; ++k) size_[k] = static_cast<int>(std::ceil(size[k] / spacing_));
  filled_.resize(static_cast<std::size_t>(size_[0]) * static_cast<std::size_t>(size_[1]) *
                 static_cast<std::size_t>(size_[2]));
  parallel_for(0, size_[2], [&](int z) {
    std::size_t at = static_cast<std::size_t>(z) * static_cast<std::size_t>(size_[0]) *
                     static_cast<std::size_t>(size_[1]);
    for (int y = 0; y < size_[1]; ++y)
      for (int x = 0; x < size_[0]; ++x, ++at)
        filled_[at] = solid.contains(origin_ + spacing_ * Vec3(x + 0.5, y + 0.5, z + 0.5)) ? 1 : 0;
  });
}

VoxelCuts::Volumes VoxelCuts::volumes(const Range& range) const {
  // The ends of every line of voxel corners along x: the others are in their hull.
  const int rows = range.high[1] - range.low[1] + 1, layers = range.high[2] - range.low[2] + 1;
  struct Line {
    int first = std::numeric_limits<int>::max(), last = std::numeric_limits<int>::min();
  };
  static thread_local std::vector<Line> lines;
  lines.assign(static_cast<std::size_t>(rows) * static_cast<std::size_t>(layers), {});
  const auto line_at = [&](int y, int z) -> Line& {
    return lines[static_cast<std::size_t>(z) * static_cast<std::size_t>(rows) +
                 static_cast<std::size_t>(y)];
  };
  Volumes out;
  for (int z = range.low[2]; z < range.high[2]; ++z) {
    for (int y = range.low[1]; y < range.high[1]; ++y) {
      Line row;
      for (int x = range.low[0]; x < range.high[0]; ++x) {
        if (!filled(x, y, z)) continue;
        ++out.voxels;
        row.first = std::min(row.first, x);
        row.last = x + 1;
      }
      if (row.last < row.first) continue;
      for (const int dz : {0, 1}) {
        for (const int dy : {0, 1}) {
          Line& line = line_at(y - range.low[1] + dy, z - range.low[2] + dz);
          line.first = std::min(line.first, row.first);
          line.last = std::max(line.last, row.last);
        }
      }
    }
  }
  static thread_local std::vector<Vec3> points;
  points.clear();
  for (int z = 0; z < layers; ++z) {
    for (int y = 0; y < rows; ++y) {
      const Line& line = line_at(y, z);
      if (line.last < line.first) continue;
      points.emplace_back(line.first, y, z);
      points.emplace_back(line.last, y, z);
    }
  }
  static thread_local geom::HullBuilder builder;
  if (builder.build(points))
    for (const Triangle& t : builder.triangles())
      out.hull += points[t[0]].cross(points[t[1]]).dot(points[t[2]]) / 6;
  return out;
}

double VoxelCuts::cost(const Range& range, int axis, int at) const {
  constexpr double kBalance = 0.05;
  Range below = range, above = range;
  below.high[axis] = above.low[axis] = at;
  const Volumes a = volumes(below), b = volumes(above);
  if (a.voxels == 0 || b.voxels == 0) return std::numeric_limits<double>::infinity();
  return a.hull - a.voxels + b.hull - b.voxels + kBalance * std::abs(a.voxels - b.voxels);
}

std::optional<Plane> VoxelCuts::choose(const Cell& cell, const std::vector<Vec3>& hull) const {
  Box3 box, part;
  for (const Vec3& p : cell.corners) box.extend(p);
  for (const Vec3& p : hull) part.extend(p);
  Range range;
  for (int k = 0; k < 3; ++k) {
    const auto index = [&](double x) {
      return std::clamp(static_cast<int>(std::ceil((x - origin_[k]) / spacing_ - 0.5)), 0,
                        size_[k]);
    };
    range.low[k] = index(std::max(box.min[k], part.min[k]));
    range.high[k] = std::max(range.low[k], index(std::min(box.max[k], part.max[k])));
  }
  struct Candidate {
    int axis, at;
    double cost;
  };
  std::vector<Candidate> list;
  const auto best = [&]() -> const Candidate* {
    parallel_for(std::size_t{0}, list.size(),
                 [&](std::size_t i) { list[i].cost = cost(range, list[i].axis, list[i].at); });
    const auto at =
        std::min_element(list.begin(), list.end(),
                         [](const Candidate& a, const Candidate& b) { return a.cost < b.cost; });
    return at == list.end() || !std::isfinite(at->cost) ? nullptr : &*at;
  };
  for (int k = 0; k < 3; ++k) {
    const int stride = std::max(1, (range.high[k] - range.low[k]) / 16);
    for (int i = range.low[k] + stride; i < range.high[k]; i += stride) list.push_back({k, i, 0});
  }
  if (const Candidate* coarse = best()) {
    const Candidate c = *coarse;
    const int stride = std::max(1, (range.high[c.axis] - range.low[c.axis]) / 16);
    list.clear();
    for (int i = std::max(c.at - stride, range.low[c.axis]) + 1;
         i < std::min(c.at + stride, range.high[c.axis]); ++i)
      list.push_back({c.axis, i, 0});
    const Candidate fine = *best();
    return Plane{Vec3::Unit(fine.axis), origin_[fine.axis] + spacing_ * fine.at};
  }
  int axis = 0;
  const double longest = (part.max - part.min).maxCoeff(&axis);
  if (!(longest > smallest_)) return std::nullopt;
  return Plane{Vec3::Unit(axis), part.center()[axis]};
}

}  // namespace kaboum::bcd
