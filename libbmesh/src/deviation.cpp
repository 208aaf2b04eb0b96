#include "deviation.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>

namespace kaboum::bmesh {

Deviation::Deviation(const geom::Mesh& original, int power, double spacing)
    : original_(original),
      power_(power),
      point_(original.vertices),
      weight_(original.vertices.size(), 0),
      head_(original.triangles.size(), kNone) {
  unit_ = 1 / (geom::bounding_box(original).max - geom::bounding_box(original).min).squaredNorm();
  add_samples(original, spacing);
  next_.assign(point_.size(), kNone);
}

void Deviation::add_samples(const geom::Mesh& original, double spacing) {
  // Triangles much larger than the average get inner samples: their corners say little of them.
  const double total = geom::area(original);
  const double large = 8 * total / static_cast<double>(original.triangles.size());
  constexpr int kMostCuts = 12;
  constexpr double kMost = 6000;  // about; besides what the mesh has
  if (spacing > 0) spacing = std::max(spacing, std::sqrt(2 * total / kMost));
  for (const geom::Triangle& t : original.triangles) {
    const Vec3 &a = original.vertices[t[0]], &b = original.vertices[t[1]],
               &c = original.vertices[t[2]];
    const double area = 0.5 * (b - a).cross(c - a).norm();
    int cuts =
        area > large ? std::min(kMostCuts, 1 + static_cast<int>(std::sqrt(area / large))) : 0;
    if (spacing > 0) {
      const double longest = std::sqrt(
          std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()}));
      cuts = std::max(cuts, static_cast<int>(std::min<double>(kMostCuts, longest / spacing)));
    }
    // Barycentric grid of cuts + 2 points a side, without the corners.
    const int n = cuts + 1;
    const int inner = (n + 1) * (n + 2) / 2 - 3;
    const double share = area / (inner + 3);
    for (const std::uint32_t v : t) weight_[v] += cuts == 0 ? area / 3 : share;
    if (cuts == 0) continue;
    for (int i = 0; i <= n; ++i) {
      for (int j = 0; i + j <= n; ++j) {
        if (i == n || j == n || i + j == 0) continue;
        point_.push_back(a + (static_cast<double>(i) / n) * (b - a) +
                         (static_cast<double>(j) / n) * (c - a));
        weight_.push_back(share);
      }
    }
  }
}

void Deviation::assign(std::span<const Vec3> position, const Connectivity& mesh) {
  geom::Mesh current;
  current.vertices.assign(position.begin(), position.end());
  std::vector<std::uint32_t> index;
  for (std::uint32_t t = 0; t < mesh.size(); ++t) {
    if (!mesh.alive(t)) continue;
    current.triangles.push_back(mesh[t]);
    index.push_back(t);
  }
  std::fill(head_.begin(), head_.end(), kNone);
  if (current.empty()) return;
  const Proximity proximity(current);
  // Runs of samples, each with hints of its own: the result does not depend on the threads.
  constexpr std::size_t kRun = 1024;
  std::vector<std::uint32_t> nearest(point_.size());
  tbb::parallel_for(std::size_t{0}, (point_.size() + kRun - 1) / kRun, [&](std::size_t run) {
    std::uint32_t hint = 0;
    const std::size_t end = std::min(point_.size(), (run + 1) * kRun);
    for (std::size_t s = run * kRun; s < end; ++s) {
      proximity.squared(point_[s], hint);
      nearest[s] = index[proximity.triangle(hint)];
    }
  });
  for (std::uint32_t s = 0; s < point_.size(); ++s) {
    next_[s] = head_[nearest[s]];
    head_[nearest[s]] = s;
  }
}

double Deviation::to_nearest(const Vec3& p, std::span<const NewTriangle> added, std::size_t first,
                             double enough, std::size_t* which) {
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < added.size(); ++i) {
    const std::size_t k = first + i < added.size() ? first + i : first + i - added.size();
    const double d = squared_distance(p, added[k].corner);
    if (d >= best) continue;
    best = d;
    if (which != nullptr) *which = k;
    if (best <= enough) break;
  }
  return best;
}

std::size_t Deviation::place_of(std::uint32_t t, std::span<const NewTriangle> added) {
  for (std::size_t k = 0; k < added.size(); ++k)
    if (added[k].index == t) return k;
  return 0;
}

double Deviation::largest(std::span<const std::uint32_t> removed,
                          std::span<const NewTriangle> added, std::span<const Point> points,
                          std::uint32_t& hint, double limit) const {
  double worst = 0;
  for (const Point& p : points) {
    worst = std::max(worst, original_.squared(p.position, hint, worst));
    if (worst > limit) return worst;
  }
  for (const std::uint32_t t : removed) {
    std::size_t last = place_of(t, added);
    for (std::uint32_t s = head_[t]; s != kNone; s = next_[s]) {
      worst = std::max(worst, to_nearest(point_[s], added, last, worst, &last));
      if (worst > limit) return worst;
    }
  }
  return worst;
}

Deviation::Energy Deviation::energy(std::span<const std::uint32_t> removed,
                                    std::span<const NewTriangle> added, std::span<Point> points,
                                    std::uint32_t& hint, double limit) const {
  Energy e;
  const auto add = [&](double squared, double weight) {
    // In units of the diagonal, lest the powers overflow.
    e.sum += (weight * unit_) * (squared * unit_) * (power_ == 4 ? squared * unit_ : 1);
    e.squared = std::max(e.squared, squared);
    return e.sum <= limit;
  };
  for (Point& p : points)
    if (!add(locate(p, hint), p.weight)) return e;
  for (const std::uint32_t t : removed) {
    std::size_t last = place_of(t, added);
    for (std::uint32_t s = head_[t]; s != kNone; s = next_[s])
      if (!add(to_nearest(point_[s], added, last, 0, &last), weight_[s])) return e;
  }
  return e;
}

void Deviation::commit(std::span<const std::uint32_t> removed, std::span<const NewTriangle> added) {
  if (added.empty()) return;
  std::uint32_t all = kNone;
  for (const std::uint32_t t : removed) {
    std::uint32_t s = head_[t];
    head_[t] = kNone;
    while (s != kNone) {
      const std::uint32_t next = next_[s];
      next_[s] = all;
      all = s;
      s = next;
    }
  }
  std::size_t last = 0;
  while (all != kNone) {
    const std::uint32_t s = all;
    all = next_[s];
    to_nearest(point_[s], added, last, 0, &last);
    const std::uint32_t t = added[last].index;
    next_[s] = head_[t];
    head_[t] = s;
  }
}

void Deviation::save(std::span<const std::uint32_t> triangles,
                     std::vector<std::uint32_t>& out) const {
  for (const std::uint32_t t : triangles) {
    for (std::uint32_t s = head_[t]; s != kNone; s = next_[s]) out.push_back(s);
    out.push_back(kNone);
  }
}

void Deviation::restore(std::span<const std::uint32_t> triangles,
                        std::span<const std::uint32_t> saved) {
  std::size_t i = 0;
  for (const std::uint32_t t : triangles) {
    std::uint32_t* link = &head_[t];
    for (; saved[i] != kNone; ++i) {
      *link = saved[i];
      link = &next_[saved[i]];
    }
    *link = kNone;
    ++i;
  }
}

}  // namespace kaboum::bmesh
