#include "regions.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <kaboum/geom/spatial_order.h>

namespace kaboum::bmesh {
namespace {

using geom::Triangle;

/// Vertices of a region: what is kept of them fits into a second-level cache.
constexpr std::size_t kRegion = 4096;
/// Rounds end near this many times the target: the last contractions compete all over the mesh.
constexpr double kEnd = 1.4, kLeast = 1.1;
/// The limit of a round is the cost up to which this share of the edges cost, less near the end.
constexpr double kShare = 0.75;
/// Edges looked at to find the limit of a round.
constexpr std::size_t kSamples = 8192;

class Rounds {
 public:
  Rounds(const Setting& setting, Reduction& mesh, OriginalSolid* solid, std::vector<Step>* steps,
         DecimateStatistics& statistics)
      : setting_(setting), m_(mesh), solid_(solid), steps_(steps), statistics_(statistics) {}

  void run(std::size_t target) {
    const double wished = static_cast<double>(target);
    for (int round = 0;; ++round) {
      const std::size_t before = m_.position.size();
      const auto n = static_cast<double>(before);
      if (before < 2 * kRegion || n < kEnd * wished) break;
      const double least = kLeast * wished / n;
      limit_ = limit(kShare * (1 - least));
      cut(round);
      contract(least);
      join();
      if (setting_.options.progress) setting_.options.progress(m_.position.size());
      if (100 * m_.position.size() > 97 * before) break;
    }
    restore_order();
  }

 private:
  struct Region {
    std::uint32_t first, last;  // vertices
    std::uint32_t triangles, triangles_end;
    std::uint32_t vertices_left = 0, triangles_left = 0;
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
      keys.push_back(setting_.cost.expected_key(
          setting_.cost.merged(m_.quadric[a], m_.quadric[b], pa, pb), pa, pb));
    }
    const auto at =
        keys.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(keys.size()));
    std::nth_element(keys.begin(), at, keys.end());
    return *at;
  }

  /// Sorts vertices along the curve and triangles by region.
  void cut(int round) {
    // The curve's grid lies elsewhere in each round, and with it the seams.
    const double golden = 0.3819660112501051;
    const std::vector<std::uint32_t> order =
        geom::spatial_order(m_.position, std::fmod(round * golden, 1.0));
    permute(m_.position, order);
    permute(m_.quadric, order);
    permute(m_.border, order);
    permute(m_.vertex, order);
    const std::size_t n = order.size();
    const std::size_t count = (n + kRegion - 1) / kRegion, size = (n + count - 1) / count;
    number_.resize(n);
    for (std::uint32_t i = 0; i < n; ++i) number_[order[i]] = i;

    std::vector<std::uint32_t> start(count + 2, 0), region(m_.triangles.size());
    for (std::size_t t = 0; t < m_.triangles.size(); ++t) {
      Triangle& tri = m_.triangles[t];
      for (std::uint32_t& v : tri) v = number_[v];
      region[t] = static_cast<std::uint32_t>(tri[0] / size);
      if (tri[1] / size != region[t] || tri[2] / size != region[t]) {
        region[t] = static_cast<std::uint32_t>(count);
        for (const std::uint32_t v : tri)
          m_.border[v] = static_cast<char>(m_.border[v] | Contraction::kLocked);
      }
      ++start[region[t] + 1];
    }
    std::partial_sum(start.begin(), start.end(), start.begin());
    regions_.assign(count, {});
    for (std::size_t r = 0; r < count; ++r) {
      regions_[r].first = static_cast<std::uint32_t>(r * size);
      regions_[r].last = static_cast<std::uint32_t>(std::min(n, (r + 1) * size));
      regions_[r].triangles = start[r];
      regions_[r].triangles_end = start[r + 1];
    }
    std::vector<std::uint32_t> place(m_.triangles.size());
    for (std::uint32_t t = 0; t < place.size(); ++t) place[start[region[t]]++] = t;
    permute(m_.triangles, place);
    permute(m_.triangle, place);
  }

  template <class T>
  static void permute(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
    std::vector<T> sorted(order.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, order.size(), 8192),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i)
                          sorted[i] = values[order[i]];
                      });
    values.swap(sorted);
  }

  /// @param share  of a region's vertices that stay at least.
  void contract(double share) {
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, regions_.size(), 1),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t r = range.begin(); r != range.end(); ++r)
                          contract(regions_[r], share);
                      });
  }

  /// Contracts within a region and writes what is left to where it was.
  void contract(Region& r, double share) {
    const auto part = [](const auto& all, std::uint32_t first, std::uint32_t last) {
      return std::vector(all.begin() + first, all.begin() + last);
    };
    std::vector<Triangle> triangles = part(m_.triangles, r.triangles, r.triangles_end);
    for (Triangle& t : triangles)
      for (std::uint32_t& v : t) v -= r.first;
    WorkingMesh mesh(part(m_.position, r.first, r.last), part(m_.border, r.first, r.last),
                     std::move(triangles));
    Contraction contraction(setting_, std::move(mesh), part(m_.quadric, r.first, r.last), solid_,
                            steps_ != nullptr ? &r.steps : nullptr, nullptr);
    contraction.pass(static_cast<std::size_t>(share * (r.last - r.first)), limit_);
    r.statistics = contraction.statistics();
    for (Step& s : r.steps) {
      s.kept = m_.vertex[r.first + s.kept];
      s.gone = m_.vertex[r.first + s.gone];
    }
    const WorkingMesh& left = contraction.mesh();
    for (std::uint32_t v = 0; v < left.position.size(); ++v) {
      if (!left.mesh.used(v) && (left.border[v] & Contraction::kLocked) == 0) continue;
      number_[r.first + v] = r.vertices_left;
      const std::uint32_t to = r.first + r.vertices_left++;
      m_.position[to] = left.position[v];
      m_.border[to] = static_cast<char>(left.border[v] & ~Contraction::kLocked);
      m_.quadric[to] = contraction.quadrics()[v];
      m_.vertex[to] = m_.vertex[r.first + v];
    }
    for (std::uint32_t t = 0; t < left.mesh.size(); ++t) {
      if (!left.mesh.alive(t)) continue;
      const std::uint32_t to = r.triangles + r.triangles_left++;
      for (int k = 0; k < 3; ++k) m_.triangles[to][k] = number_[r.first + left.mesh[t][k]];
      m_.triangle[to] = m_.triangle[r.triangles + t];
    }
  }

  /// Moves what the regions have left together.
  void join() {
    std::uint32_t vertices = 0, triangles = 0;
    const std::size_t size = regions_.front().last;
    std::vector<std::uint32_t> offset;
    for (Region& r : regions_) {
      offset.push_back(vertices);
      const auto move_down = [](auto& all, std::uint32_t from, std::uint32_t n, std::uint32_t to) {
        if (from != to) std::move(all.begin() + from, all.begin() + from + n, all.begin() + to);
      };
      move_down(m_.position, r.first, r.vertices_left, vertices);
      move_down(m_.border, r.first, r.vertices_left, vertices);
      move_down(m_.quadric, r.first, r.vertices_left, vertices);
      move_down(m_.vertex, r.first, r.vertices_left, vertices);
      move_down(m_.triangle, r.triangles, r.triangles_left, triangles);
      for (std::uint32_t t = 0; t < r.triangles_left; ++t)
        for (int k = 0; k < 3; ++k)
          m_.triangles[triangles + t][k] = m_.triangles[r.triangles + t][k] + vertices;
      vertices += r.vertices_left;
      triangles += r.triangles_left;
      add(statistics_, r.statistics);
      if (steps_ != nullptr) steps_->insert(steps_->end(), r.steps.begin(), r.steps.end());
    }
    for (std::size_t t = regions_.back().triangles_end; t < m_.triangles.size(); ++t) {
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t v = m_.triangles[t][k];
        m_.triangles[triangles][k] = offset[v / size] + number_[v];
      }
      m_.triangle[triangles++] = m_.triangle[t];
    }
    m_.position.resize(vertices);
    m_.border.resize(vertices);
    m_.quadric.resize(vertices);
    m_.vertex.resize(vertices);
    m_.triangles.resize(triangles);
    m_.triangle.resize(triangles);
  }

  void restore_order() {
    std::vector<std::uint32_t> order(m_.triangle.size());
    std::iota(order.begin(), order.end(), 0U);
    std::sort(order.begin(), order.end(),
              [&](std::uint32_t a, std::uint32_t b) { return m_.triangle[a] < m_.triangle[b]; });
    permute(m_.triangles, order);
    permute(m_.triangle, order);
  }

  const Setting& setting_;
  Reduction& m_;
  OriginalSolid* solid_;
  std::vector<Step>* steps_;
  DecimateStatistics& statistics_;
  double limit_ = 0;
  std::vector<Region> regions_;
  std::vector<std::uint32_t> number_;
};

}  // namespace

Reduction::Reduction(const geom::Mesh& mesh, std::vector<char> may_not_move,
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

void contract_in_regions(const Setting& setting, Reduction& mesh, std::size_t target,
                         OriginalSolid* solid, std::vector<Step>* steps,
                         DecimateStatistics& statistics) {
  Rounds(setting, mesh, solid, steps, statistics).run(target);
}

}  // namespace kaboum::bmesh
