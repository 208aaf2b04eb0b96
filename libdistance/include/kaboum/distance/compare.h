#pragma once

#include <kaboum/distance/minimum.h>
#include <kaboum/distance/sampling.h>
#include <kaboum/distance/search.h>
#include <kaboum/distance/solid.h>
#include <kaboum/geom/convex_set.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::distance {

/// Something to compare: a mesh, or convex bodies of which the union counts.
struct Shape {
  std::string name;  ///< for messages
  geom::Mesh mesh;   ///< unused with a set
  std::optional<geom::ConvexSet> set;
};

struct CompareOptions {
  bool solid = false;                        ///< solid to solid, else surface to surface
  double relative_gap = 1e-3;                ///< see geom::DistanceOptions
  std::uint64_t samples = 100000, seed = 1;  ///< of mean and rms, each way
  Backend backend = Backend::Embree;
  std::function<void(const std::string& stage)> progress;  ///< may be empty
};

/// One-sided distances.
struct OneWay {
  SolidDistance max;
  geom::Vec3 nearest = geom::Vec3::Zero();  ///< on the other surface, to max.at
  Sampled sampled;
};

/// Certified brackets and estimates. Points are in the coordinates of the shapes given. [length]
struct Compared {
  OneWay a_to_b, b_to_a;
  Minimum min;

  /// Bracket of the Hausdorff distance.
  [[nodiscard]] double lower() const;
  [[nodiscard]] double upper() const;
};

/// Two shapes that are measured against each other, as surfaces or as solids. Both are moved near
/// the origin along the axes on which that is exact, so that distances stay what they are and
/// rounding that is proportional to coordinates shrinks. A set's surface is that of its union.
class Comparison {
 public:
  enum Side { A, B };

  /// Finds the surfaces and builds the search structures over them.
  /// @throws Error{InvalidInput} naming the shape: no triangles, coordinates that are not finite or
  ///   beyond 1e60, an extent below 1e-60 (distance bounds do not hold then), a set with a margin
  ///   that is not measured as a solid, what Solid throws.
  Comparison(Shape a, Shape b, CompareOptions options);

  /// Deterministic on any number of threads.
  [[nodiscard]] Compared measure() const;

  /// The surface that stands for a shape, moved by −origin().
  [[nodiscard]] const geom::Mesh& surface(Side side) const { return sides_[side].surface; }
  /// Largest distance from the one that is meant. [length]
  [[nodiscard]] double surface_error(Side side) const { return sides_[side].error; }
  /// Diagonal of the bounding box of both. [length]
  [[nodiscard]] double diagonal() const { return diagonal_; }
  [[nodiscard]] const geom::Vec3& origin() const { return origin_; }

  /// Distance of each vertex from a side, with the coordinates of `surface`.
  [[nodiscard]] std::vector<double> distances(const geom::Mesh& from, Side to) const;

 private:
  struct Measured {
    Shape shape;
    std::unique_ptr<Solid> solid;  ///< if measured as such
    geom::Mesh surface;
    double error = 0;
    std::unique_ptr<geom::TriangleSearch> search;

    [[nodiscard]] geom::Box3 box() const;
    template <class Visit>
    void each_points(Visit&& visit);
    /// Distance of a point, given its distance from the surface; null: just so.
    [[nodiscard]] std::function<double(const geom::Vec3&, double)> distance() const;
  };

  void require_range() const;
  void move_to_origin();
  void find_surface(Measured& side) const;
  static bool certainly_within(const Measured& from, const Measured& to);
  [[nodiscard]] OneWay one_way(const char* name, const Measured& from, const Measured& to) const;
  void progress(const std::string& stage) const;

  CompareOptions options_;
  std::array<Measured, 2> sides_;
  double diagonal_ = 0;
  geom::Vec3 origin_ = geom::Vec3::Zero();
};

}  // namespace kaboum::distance
