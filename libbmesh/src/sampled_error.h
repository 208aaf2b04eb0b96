#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "change.h"
#include "closest_triangle.h"
#include "connectivity.h"
#include "nearest_of.h"
#include "work.h"

namespace kaboum::bmesh {

/// How far a changing mesh is from its original, measured at sample points both ways: the costs of
/// decimation and the objective of the optimisation. Nothing here is certified.
///
/// Samples of the original (its vertices, and points on its large triangles) are carried by the
/// current triangle nearest to them, so that a change has to look at the samples of the triangles
/// it removes only. Samples of the current mesh are measured against the original through a
/// hierarchy.
class SampledError {
 public:
  static constexpr std::uint32_t kNone = ~0U;

  /// A point of the new triangles, and the area it stands for.
  struct Point {
    Vec3 position;
    double weight;
    double share = 0;  ///< of the apex's moves that it follows
    /// Place of the original's triangle that it is nearest to, or was when it was somewhere near.
    std::uint32_t nearest = kNone;
  };
  /// How points are located.
  struct Locating {
    /// Where they have been located near by: from there, so that they may be found farther than
    /// they are.
    bool again = false;
    /// Looked at instead of all of the original, where it is large enough.
    const ClosestTriangle::Vicinity* vicinity = nullptr;
  };
  struct Energy {
    double sum = 0;      ///< Σ weight · distance^power, in units of the diagonal
    double squared = 0;  ///< largest squared distance [length²]
  };

  /// Keeps a reference to the mesh, which must outlive this object. @pre it has triangles.
  /// @param power    of the distances in the energy: 4, which goes after the largest, or 2.
  /// @param spacing  samples lie no farther apart than this, within reason; 0: as the mesh has
  ///   them.
  /// @param most  so many samples, about, are added for that.
  /// @param work  counts what is done, if not null.
  /// @param closest  distances to the original, where others have them already.
  explicit SampledError(const geom::Mesh& original, int power = 4, double spacing = 0,
                        double most = 6000, Work* work = nullptr,
                        std::shared_ptr<const ClosestTriangle> closest = nullptr);
  [[nodiscard]] int power() const { return power_; }
  [[nodiscard]] std::size_t samples() const { return point_.size(); }

  /// Gives every sample to the current triangle nearest to it.
  void assign(std::span<const Vec3> position, const Connectivity& mesh);

  /// Bounds of a largest distance, squared: between them it has to be known. [length²]
  struct Range {
    double least = 0;  ///< what is no more than that counts as 0
    double most;       ///< measuring stops beyond that
  };

  /// Largest squared distance after the change: from `points` to the original, and from the samples
  /// of the triangles `removed` to the triangles `added`. Stops when it exceeds `range.most` and
  /// returns what it has by then. Where some triangle is within `range.least`, no nearer one is
  /// looked for.
  double largest(std::span<const std::uint32_t> removed, std::span<const NewTriangle> added,
                 std::span<const Point> points, std::uint32_t& hint, const Range& range) const;

  /// The same as a sum, with the maximum besides. Stops when the sum exceeds `limit`; the points up
  /// to there are located.
  /// @param how  the points are located.
  Energy energy(std::span<const std::uint32_t> removed, std::span<const NewTriangle> added,
                std::span<Point> points, std::uint32_t& hint, double limit,
                const Locating& how) const;
  Energy energy(std::span<const std::uint32_t> removed, std::span<const NewTriangle> added,
                std::span<Point> points, std::uint32_t& hint, double limit) const {
    return energy(removed, added, points, hint, limit, Locating());
  }

  /// The same of a point that has been located near by, from there: nearly always right, and never
  /// nearer than it is.
  double locate_again(Point& point, double enough = 0) const {
    return original_->squared_near(point.position, point.nearest, enough);
  }
  /// Finds where the original is nearest to a point. @return the squared distance
  double locate(Point& point, std::uint32_t& hint) const { return locate(point, hint, nullptr); }
  /// The same in a vicinity, where that is large enough.
  double locate(Point& point, std::uint32_t& hint,
                const ClosestTriangle::Vicinity* vicinity) const {
    std::uint64_t steps = 0;
    const double squared = locate(point, hint, steps, vicinity);
    count(work_, steps);
    return squared;
  }

  /// Makes the vicinity hold what is in the ball.
  void gather(const Vec3& center, double radius, ClosestTriangle::Vicinity& out) const {
    std::uint64_t steps = 0;
    original_->gather(center, radius, out, &steps);
    count(work_, steps);
  }

  /// Hands the samples of `removed` to the nearest of `added`.
  void commit(std::span<const std::uint32_t> removed, std::span<const NewTriangle> added);

  /// Looks between the samples for points of the original that are farther than √enough from the
  /// present mesh, and adds the farthest of each triangle to the samples, with the weight of a
  /// quarter of the triangle besides the others'.
  void refine(std::span<const Vec3> position, const Connectivity& mesh, double enough);

  /// Appends the samples that the triangles carry to `out`, each list ended by kNone.
  void save(std::span<const std::uint32_t> triangles, std::vector<std::uint32_t>& out) const;
  /// Gives back what `save` has written, for the same triangles. @pre since then samples have moved
  /// among these triangles only.
  void restore(std::span<const std::uint32_t> triangles, std::span<const std::uint32_t> saved);

  /// Calls visit(point, weight) for each sample that triangle t carries.
  template <class Visit>
  void for_each_sample(std::uint32_t t, Visit&& visit) const {
    for (std::uint32_t s = head_[t]; s != kNone; s = next_[s]) visit(point_[s], weight_[s]);
  }

  /// Calls visit(i, point) for each sample of `removed`, i the place of the nearest of `added`.
  template <class Visit>
  void for_each_assignment(std::span<const std::uint32_t> removed,
                           std::span<const NewTriangle> added, Visit&& visit) const {
    NearestOf nearest(added);
    std::uint64_t found = 0;
    std::size_t from = 0;
    for (const std::uint32_t t : removed) {
      std::size_t last = place_of(t, added, from);
      for (std::uint32_t s = head_[t]; s != kNone; s = next_[s], ++found) {
        nearest.squared(point_[s], last);
        visit(last, point_[s]);
      }
    }
    count(work_, found * nearest.steps());
  }

  [[nodiscard]] const ClosestTriangle& original() const { return *original_; }

 private:
  /// Where triangle t stays among the new ones; the first, if it vanishes.
  /// @param from  where it is looked for first; receives where the next one is likely to be.
  static std::size_t place_of(std::uint32_t t, std::span<const NewTriangle> added,
                              std::size_t& from);
  void add_samples(double spacing, double most);
  double locate(Point& point, std::uint32_t& hint, std::uint64_t& steps,
                const ClosestTriangle::Vicinity* vicinity = nullptr) const {
    if (point.nearest != kNone) hint = point.nearest;
    const double squared = original_->squared(point.position, hint, 0, &steps, vicinity);
    point.nearest = hint;
    return squared;
  }

  const geom::Mesh& mesh_;
  std::shared_ptr<const ClosestTriangle> original_;
  int power_;
  Work* work_;
  double unit_;  // 1 / diagonal²
  std::vector<Vec3> point_;
  std::vector<double> weight_;  // area of the original; places that refine found count besides
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t> head_;  // per current triangle
};

}  // namespace kaboum::bmesh
