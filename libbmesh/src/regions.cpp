// Large meshes are contracted region by region, so that threads do not meet and caches suffice.

#include "regions.h"

#include <kaboum/base/parallel.h>
#include <kaboum/geom/spatial_order.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <kaboum/base/parallel.h>

namespace kaboum::bmesh {
namespace {

using geom::Triangle;

/// Vertices of a region: what is kept of them fits into a second-level cache.
constexpr std::size_t kRegion = 4096;
/// Rounds end near this many times the target: the last contractions compete all over the mesh.
constexpr double kEnd = 1.4, kLeast = 1.1;
/// The limit of a round is the cost up to which this share of the edges cost, less near the end.
constexpr double kShare = 0.75;
/// Of the grid, how much farther it lies in each round: multiples of the golden section repeat
/// late.
constexpr double kGoldenShare = 0.3819660112501051;
/// Edges looked at to find the limit of a round.
constexpr std::size_t kSamples = 8192;

class Rounds {
 public:
  Rounds(const Context& context, PartialMesh& mesh, ReferenceSolid* solid, std::vector<Step>* steps,
         DecimateStatistics& statistics)
      : context_(context), m_(mesh), solid_(solid), steps_(steps), statistics_(statistics) {}

  void run(std::size_t target) {
    const double requested = static_cast<double>(target);
    for (int round = 0;; ++round) {
      if (context_.work != nullptr && context_.work->spent(kNoneContracts)) break;
      const std::size_t before = m_.position.size();
      const auto n = static_cast<double>(before);
      if (before < 2 * kRegion || n < kEnd * requested) break;
      const double least = kLeast * requested / n;
      limit_ = limit(kShare * (1 - least));
      cut(round);
      contract(least);
      join();
      if (context_.options.progress) context_.options.progress(m_.position.size());
      if (100 * m_.position.size() > 97 * before) break;
    }
    if (!order_.empty()) restore_order();
  }

 private:
  struct Region {
    std::uint32_t first, last;                       // vertices, in order_
    std::uint32_t first_triangle, last_triangle;     // in place_
    std::vector<std::uint32_t> vertices, triangles;  // left
    std::vector<Step> steps;
    DecimateStatistics statistics;
  };

  /// The cost up to which that share of the edges are expected to cost.
  [[nodiscard]] double limit(double share) const {
    std::vector<double> keys;
    const std::size_t step = 3 * m_.triangles.size() / kSamples + 1;
    for (std::size_t i = 0; i < 3 * m_.triangles.size(); i += step) {
      const Triangle& t = m_.triangles[i / 3];
      const std::uint32_t a = t[i % 3], b = t[(i + 1) % 3];
      const Vec3 &pa = m_.position[a], &pb = m_.position[b];
      const double key = context_.cost.expected_key(
          context_.cost.merged(m_.quadric[a], m_.quadric[b], pa, pb), pa, pb);
      if (std::isfinite(key)) keys.push_back(key);
    }
    if (keys.empty()) return 0;
    const auto at =
        keys.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(keys.size()));
    std::nth_element(keys.begin(), at, keys.end());
    return *at;
  }

  /// Gives every vertex and triangle a region.
  void cut(int round) {
    // The curve's grid lies elsewhere in each round, and with it the seams.
    order_ = geom::spatial_order(m_.position, std::fmod(round * kGoldenShare, 1.0));
    const std::size_t n = order_.size();
    const std::size_t count = (n + kRegion - 1) / kRegion, size = (n + count - 1) / count;
    number_.resize(n);
    parallel_for_light(n,
                       [&](std::size_t i) { number_[order_[i]] = static_cast<std::uint32_t>(i); });

    std::vector<std::uint32_t> start(count + 2, 0), region(m_.triangles.size());
    parallel_for_light(region.size(), [&](std::size_t t) {
      const Triangle& tri = m_.triangles[t];
      const std::size_t r = number_[tri[0]] / size;
      const bool seam = number_[tri[1]] / size != r || number_[tri[2]] / size != r;
      region[t] = static_cast<std::uint32_t>(seam ? count : r);
    });
    for (std::size_t t = 0; t < region.size(); ++t) {
      ++start[region[t] + 1];
      if (region[t] < count) continue;
      for (const std::uint32_t v : m_.triangles[t])
        m_.border[v] = static_cast<char>(m_.border[v] | Contraction::kLocked);
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    regions_ = std::vector<Region>(count);
    for (std::size_t r = 0; r < count; ++r) {
      regions_[r].first = static_cast<std::uint32_t>(r * size);
      regions_[r].last = static_cast<std::uint32_t>(std::min(n, (r + 1) * size));
      regions_[r].first_triangle = start[r];
      regions_[r].last_triangle = start[r + 1];
    }
    place_.resize(region.size());
    for (std::uint32_t t = 0; t < place_.size(); ++t) place_[start[region[t]]++] = t;
  }

  /// @param share  of a region's vertices that stay at least.
  void contract(double share) {
    parallel_for(std::size_t{0}, regions_.size(),
                 [&](std::size_t r) { contract(regions_[r], share); });
  }

  /// Contracts within a region and writes what is left to where it was.
  void contract(Region& r, double share) {
    const std::uint32_t *vertex = &order_[r.first], *triangle = &place_[r.first_triangle];
    const std::uint32_t n = r.last - r.first;
    std::vector<Vec3> position(n);
    std::vector<char> border(n);
    std::vector<Quadric> quadric(n);
    for (std::uint32_t v = 0; v < n; ++v) {
      position[v] = m_.position[vertex[v]];
      border[v] = m_.border[vertex[v]];
      quadric[v] = m_.quadric[vertex[v]];
    }
    std::vector<Triangle> triangles(r.last_triangle - r.first_triangle);
    for (std::size_t t = 0; t < triangles.size(); ++t)
      for (int k = 0; k < 3; ++k) triangles[t][k] = number_[m_.triangles[triangle[t]][k]] - r.first;
    Contraction contraction(
        context_, WorkingMesh(std::move(position), std::move(border), std::move(triangles)),
        std::move(quadric), solid_, steps_ != nullptr ? &r.steps : nullptr);
    contraction.pass(static_cast<std::size_t>(share * n), limit_);
    r.statistics = contraction.statistics();
    for (Step& s : r.steps) {
      s.kept = m_.vertex[vertex[s.kept]];
      s.gone = m_.vertex[vertex[s.gone]];
    }
    const WorkingMesh& left = contraction.mesh();
    r.vertices.reserve(contraction.vertices());
    for (std::uint32_t v = 0; v < n; ++v) {
      const bool locked = (left.border[v] & Contraction::kLocked) != 0;
      if (!left.mesh.used(v) && !locked) continue;
      const std::uint32_t to = vertex[v];
      r.vertices.push_back(to);
      m_.position[to] = left.position[v];
      m_.border[to] = static_cast<char>(left.border[v] & ~Contraction::kLocked);
      m_.quadric[to] = contraction.quadrics()[v];
    }
    for (std::uint32_t t = 0; t < left.mesh.size(); ++t) {
      if (!left.mesh.alive(t)) continue;
      const std::uint32_t to = triangle[t];
      r.triangles.push_back(to);
      for (int k = 0; k < 3; ++k) m_.triangles[to][k] = vertex[left.mesh[t][k]];
    }
  }

  /// Keeps what the regions have left: vertices in the order of the curve.
  void join() {
    std::vector<std::uint32_t> vertices, triangles;
    for (Region& r : regions_) {
      vertices.insert(vertices.end(), r.vertices.begin(), r.vertices.end());
      triangles.insert(triangles.end(), r.triangles.begin(), r.triangles.end());
      add(statistics_, r.statistics);
      if (steps_ != nullptr) steps_->insert(steps_->end(), r.steps.begin(), r.steps.end());
    }
    triangles.insert(triangles.end(), place_.begin() + regions_.back().last_triangle, place_.end());
    regions_.clear();
    keep(m_.quadric, vertices);
    keep(m_.position, vertices);
    keep(m_.border, vertices);
    keep(m_.vertex, vertices);
    for (std::uint32_t i = 0; i < vertices.size(); ++i) number_[vertices[i]] = i;
    keep(m_.triangle, triangles);
    keep(m_.triangles, triangles);
    parallel_for_light(m_.triangles.size(), [&](std::size_t t) {
      for (std::uint32_t& v : m_.triangles[t]) v = number_[v];
    });
  }

  void restore_order() {
    std::vector<std::uint32_t> order(m_.triangle.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return m_.triangle[a] < m_.triangle[b]; });
    keep(m_.triangles, order);
    keep(m_.triangle, order);
  }

  template <class T>
  static void keep(std::vector<T>& values, const std::vector<std::uint32_t>& which) {
    std::vector<T> kept(which.size());
    parallel_for_light(kept.size(), [&](std::size_t i) { kept[i] = values[which[i]]; });
    values = std::move(kept);
  }

  const Context& context_;
  PartialMesh& m_;
  ReferenceSolid* solid_;
  std::vector<Step>* steps_;
  DecimateStatistics& statistics_;
  double limit_ = 0;
  std::vector<Region> regions_;
  std::vector<std::uint32_t> order_;   // vertices along the curve
  std::vector<std::uint32_t> number_;  // of vertices: place in order_; when joined, the new number
  std::vector<std::uint32_t> place_;   // triangles by region, those on seams last
};

}  // namespace

PartialMesh::PartialMesh(const geom::Mesh& mesh, std::vector<char> may_not_move,
                         std::vector<Quadric> quadrics)
    : position(mesh.vertices),
      border(std::move(may_not_move)),
      quadric(std::move(quadrics)),
      vertex(mesh.vertices.size()),
      triangles(mesh.triangles),
      triangle(mesh.triangles.size()) {
  std::iota(vertex.begin(), vertex.end(), 0U);
  std::iota(triangle.begin(), triangle.end(), 0U);
}

void contract_in_regions(const Context& context, PartialMesh& mesh, std::size_t target,
                         ReferenceSolid* solid, std::vector<Step>* steps,
                         DecimateStatistics& statistics) {
  Rounds(context, mesh, solid, steps, statistics).run(target);
}

}  // namespace kaboum::bmesh
