// How far a changing mesh is from its original, at samples of both. Guides the search, never a
// claim.

#include <kaboum/base/parallel.h>

#include "sampled_error.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace kaboum::bmesh {

SampledError::SampledError(const geom::Mesh& original, int power, double spacing, double most,
                           Work* work, std::shared_ptr<const ClosestTriangle> closest)
    : mesh_(original),
      original_(closest ? std::move(closest) : std::make_shared<const ClosestTriangle>(original)),
      power_(power),
      work_(work),
      point_(original.vertices),
      weight_(original.vertices.size(), 0),
      head_(original.triangles.size(), kNone) {
  unit_ = 1 / (geom::bounding_box(original).max - geom::bounding_box(original).min).squaredNorm();
  add_samples(spacing, most);
  next_.assign(point_.size(), kNone);
}

void SampledError::add_samples(double spacing, double most) {
  const geom::Mesh& original = mesh_;
  // Triangles much larger than the average get inner samples: their corners say little of them.
  const double total = geom::area(original);
  const double large = 8 * total / static_cast<double>(original.triangles.size());
  constexpr int kMostCuts = 12, kMostInRow = 6;
  if (spacing > 0) spacing = std::max(spacing, std::sqrt(2 * total / most));
  for (const geom::Triangle& t : original.triangles) {
    const Vec3 &a = original.vertices[t[0]], &b = original.vertices[t[1]],
               &c = original.vertices[t[2]];
    const double area = 0.5 * (b - a).cross(c - a).norm();
    int cuts =
        area > large ? std::min(kMostCuts, 1 + static_cast<int>(std::sqrt(area / large))) : 0;
    if (spacing > 0) {
      int first = 0;
      double longest = 0;
      for (int k = 0; k < 3; ++k) {
        const double length = (original.vertices[t[(k + 1) % 3]] - original.vertices[t[k]]).norm();
        if (length > longest) longest = length, first = k;
      }
      // Narrow ones get a row of samples: a grid would put dozens where its corners' neighbours
      // have theirs.
      if (2 * area < longest * spacing && cuts == 0) {
        const int row = static_cast<int>(std::min<double>(kMostInRow, longest / spacing));
        const double share = area / (row + 3);
        for (const std::uint32_t v : t) weight_[v] += share;
        const Vec3 &p = original.vertices[t[first]], &q = original.vertices[t[(first + 1) % 3]],
                   &r = original.vertices[t[(first + 2) % 3]];
        for (int i = 1; i <= row; ++i) {
          const double f = static_cast<double>(i) / (row + 1);
          point_.push_back((2 * (p + f * (q - p)) + r) / 3);
          weight_.push_back(share);
        }
        continue;
      }
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

namespace {

/// The triangles of a working mesh, and their numbers there.
struct Present {
  Present(std::span<const Vec3> position, const Connectivity& working) {
    mesh.vertices.assign(position.begin(), position.end());
    for (std::uint32_t t = 0; t < working.size(); ++t) {
      if (!working.alive(t)) continue;
      mesh.triangles.push_back(working[t]);
      index.push_back(t);
    }
  }
  geom::Mesh mesh;
  std::vector<std::uint32_t> index;
};

}  // namespace

void SampledError::assign(std::span<const Vec3> position, const Connectivity& mesh) {
  const Present present(position, mesh);
  const geom::Mesh& current = present.mesh;
  const std::vector<std::uint32_t>& index = present.index;
  std::fill(head_.begin(), head_.end(), kNone);
  if (current.empty()) return;
  const ClosestTriangle proximity(current, false);
  // Runs of samples, each with hints of its own: the result does not depend on the threads.
  constexpr std::size_t kRun = 1024;
  std::vector<std::uint32_t> nearest(point_.size());
  parallel_for(std::size_t{0}, (point_.size() + kRun - 1) / kRun, [&](std::size_t run) {
    std::uint32_t hint = 0;
    std::uint64_t steps = 0;
    const std::size_t end = std::min(point_.size(), (run + 1) * kRun);
    for (std::size_t s = run * kRun; s < end; ++s) {
      proximity.squared(point_[s], hint, 0, &steps);
      nearest[s] = index[proximity.triangle(hint)];
    }
    count(work_, steps);
  });
  for (std::uint32_t s = 0; s < point_.size(); ++s) {
    next_[s] = head_[nearest[s]];
    head_[nearest[s]] = s;
  }
}

namespace {

/// Looks for the farthest points of the original between the samples.
class Between {
 public:
  /// A point of the original, and the place of the triangle it is nearest to.
  struct SurfaceSample {
    double squared;
    Vec3 point;
    std::uint32_t nearest;
  };

  Between(const ClosestTriangle& present, double enough) : present_(present), enough_(enough) {}
  /// Taken until now. [ns]
  [[nodiscard]] std::uint64_t steps() const { return steps_; }

  /// @param nearest  places of the triangles that the corners are nearest to.
  /// @return the farthest point found, if it is farther than √enough.
  std::optional<SurfaceSample> operator()(const std::array<Vec3, 3>& corner,
                                          const std::array<std::uint32_t, 3>& nearest) {
    std::optional<SurfaceSample> farthest;
    pieces_.assign(1, {corner, nearest, 0});
    while (!pieces_.empty()) {
      const SubTriangle p = pieces_.back();
      pieces_.pop_back();
      if (p.halvings == kMostHalvings || covered(p)) continue;
      const SurfaceSample middle = halve(p);
      if (middle.squared > (farthest ? farthest->squared : enough_)) farthest = middle;
    }
    return farthest;
  }

 private:
  static constexpr int kMostHalvings = 6;
  static constexpr std::uint64_t kFollowed = 60;  ///< [ns] that it takes to follow a point, about

  struct SubTriangle {
    std::array<Vec3, 3> corner;
    std::array<std::uint32_t, 3> nearest;
    int halvings;
  };

  /// The distance to one triangle is convex, so that of the corners bounds that of the piece.
  [[nodiscard]] bool covered(const SubTriangle& p) const {
    for (int k = 0; k < 3; ++k) {
      if (k > 0 && p.nearest[k] == p.nearest[k - 1]) continue;
      const std::array<Vec3, 3> t = present_.corners(p.nearest[k]);
      if (std::all_of(p.corner.begin(), p.corner.end(),
                      [&](const Vec3& x) { return squared_distance(x, t) <= enough_; }))
        return true;
    }
    return false;
  }

  /// Halves the longest side. @return its middle
  SurfaceSample halve(const SubTriangle& p) {
    int across = 0;
    double longest = 0;
    for (int k = 0; k < 3; ++k) {
      const double squared = (p.corner[(k + 2) % 3] - p.corner[(k + 1) % 3]).squaredNorm();
      if (squared > longest) longest = squared, across = k;
    }
    const int first = (across + 1) % 3, second = (across + 2) % 3;
    SurfaceSample middle{0, 0.5 * (p.corner[first] + p.corner[second]), p.nearest[first]};
    middle.squared = present_.squared_near(middle.point, middle.nearest);
    // What is near enough does not matter beyond that.
    steps_ += kFollowed;
    if (!(middle.squared <= enough_))
      middle.squared = present_.squared(middle.point, middle.nearest, 0, &steps_);
    for (const int k : {first, second}) {
      SubTriangle half = p;
      half.corner[k] = middle.point;
      half.nearest[k] = middle.nearest;
      ++half.halvings;
      pieces_.push_back(half);
    }
    return middle;
  }

  const ClosestTriangle& present_;
  double enough_;
  std::uint64_t steps_ = 0;
  std::vector<SubTriangle> pieces_;
};

}  // namespace

void SampledError::refine(std::span<const Vec3> position, const Connectivity& mesh, double enough) {
  const Present present(position, mesh);
  if (present.mesh.empty()) return;
  const ClosestTriangle proximity(present.mesh, false);
  std::vector<std::uint32_t> place(mesh.size());  // of a triangle
  for (std::uint32_t i = 0; i < present.index.size(); ++i)
    place[present.index[proximity.triangle(i)]] = i;
  std::vector<std::uint32_t> carrier(point_.size());
  for (std::uint32_t t = 0; t < head_.size(); ++t)
    for (std::uint32_t s = head_[t]; s != kNone; s = next_[s]) carrier[s] = place[t];

  constexpr std::size_t kRun = 1024;
  constexpr std::uint64_t kMostSteps = 100'000'000;  // each; needles and wide fans take far more
  const std::size_t n = mesh_.triangles.size();
  using Of = std::pair<std::size_t, Between::SurfaceSample>;  // of a triangle
  std::vector<std::vector<Of>> found((n + kRun - 1) / kRun);
  parallel_for(std::size_t{0}, found.size(), [&](std::size_t run) {
    Between between(proximity, enough);
    const std::size_t end = std::min(n, (run + 1) * kRun);
    for (std::size_t i = run * kRun; i < end && between.steps() < kMostSteps; ++i) {
      const geom::Triangle& t = mesh_.triangles[i];
      const auto at = between({mesh_.vertices[t[0]], mesh_.vertices[t[1]], mesh_.vertices[t[2]]},
                              {carrier[t[0]], carrier[t[1]], carrier[t[2]]});
      if (at) found[run].emplace_back(i, *at);
    }
    count(work_, between.steps());
  });
  const auto add = [&](std::size_t i, const Between::SurfaceSample& at) {
    const geom::Triangle& t = mesh_.triangles[i];
    const Vec3& a = mesh_.vertices[t[0]];
    const std::uint32_t to = present.index[proximity.triangle(at.nearest)];
    bool known = false;  // from the neighbour across an edge, or from earlier
    for (std::uint32_t s = head_[to]; s != kNone && !known; s = next_[s])
      known = point_[s] == at.point;
    if (known) return;
    point_.push_back(at.point);
    weight_.push_back(0.125 * (mesh_.vertices[t[1]] - a).cross(mesh_.vertices[t[2]] - a).norm());
    next_.push_back(head_[to]);
    head_[to] = static_cast<std::uint32_t>(point_.size() - 1);
  };
  for (const std::vector<Of>& run : found)
    for (const auto& [i, at] : run) add(i, at);
}

std::size_t SampledError::place_of(std::uint32_t t, std::span<const NewTriangle> added,
                                   std::size_t& from) {
  for (std::size_t i = 0; i < added.size(); ++i) {
    const std::size_t k = from + i < added.size() ? from + i : from + i - added.size();
    if (added[k].index != t) continue;
    from = k + 1 < added.size() ? k + 1 : 0;
    return k;
  }
  return 0;
}

double SampledError::largest(std::span<const std::uint32_t> removed,
                             std::span<const NewTriangle> added, std::span<const Point> points,
                             std::uint32_t& hint, const Range& range) const {
  const double limit = range.most;
  double worst = range.least;
  std::uint64_t steps = 0;
  for (const Point& p : points) {
    worst = std::max(worst, original_->squared(p.position, hint, worst, &steps));
    if (worst > limit) break;
  }
  count(work_, steps);
  if (worst > limit) return worst;
  NearestOf nearest(removed.empty() ? added.first(0) : added);
  std::uint64_t looked = 0;
  std::size_t from = 0;
  for (std::size_t i = 0; i < removed.size() && !(worst > limit); ++i) {
    std::size_t last = place_of(removed[i], added, from);
    for (std::uint32_t s = head_[removed[i]]; s != kNone && !(worst > limit); s = next_[s]) {
      worst = std::max(worst, nearest.squared(point_[s], last, worst));
      ++looked;
    }
  }
  count(work_, looked * nearest.steps());
  return worst > range.least ? worst : 0;
}

SampledError::Energy SampledError::energy(std::span<const std::uint32_t> removed,
                                          std::span<const NewTriangle> added,
                                          std::span<Point> points, std::uint32_t& hint,
                                          double limit, const Locating& how) const {
  Energy e;
  const auto add = [&](double squared, double weight) {
    // In units of the diagonal: otherwise the powers would overflow.
    e.sum += (weight * unit_) * (squared * unit_) * (power_ == 4 ? squared * unit_ : 1);
    e.squared = std::max(e.squared, squared);
    return e.sum <= limit;
  };
  std::uint64_t steps = 0;
  bool within = true;
  for (std::size_t i = 0; i < points.size() && within; ++i)
    within =
        add(how.again && points[i].nearest != kNone ? locate_again(points[i])
                                                    : locate(points[i], hint, steps, how.vicinity),
            points[i].weight);
  if (within) {
    NearestOf nearest(added);
    std::size_t from = 0;
    for (std::size_t i = 0; i < removed.size() && within; ++i) {
      std::size_t last = place_of(removed[i], added, from);
      for (std::uint32_t s = head_[removed[i]]; s != kNone && within; s = next_[s]) {
        within = add(nearest.squared(point_[s], last), weight_[s]);
        steps += nearest.steps();
      }
    }
  }
  count(work_, steps);
  return e;
}

void SampledError::commit(std::span<const std::uint32_t> removed,
                          std::span<const NewTriangle> added) {
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
  if (all == kNone) return;
  NearestOf nearest(added);
  std::size_t last = 0;
  std::uint64_t moved = 0;
  while (all != kNone) {
    const std::uint32_t s = all;
    all = next_[s];
    ++moved;
    nearest.squared(point_[s], last);
    const std::uint32_t t = added[last].index;
    next_[s] = head_[t];
    head_[t] = s;
  }
  count(work_, moved * nearest.steps());
}

void SampledError::save(std::span<const std::uint32_t> triangles,
                        std::vector<std::uint32_t>& out) const {
  for (const std::uint32_t t : triangles) {
    for (std::uint32_t s = head_[t]; s != kNone; s = next_[s]) out.push_back(s);
    out.push_back(kNone);
  }
}

void SampledError::restore(std::span<const std::uint32_t> triangles,
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
