#pragma once

#include <kaboum/base/work.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/geom/region.h>
#include <kaboum/geom/triangle_search.h>
#include <kaboum/geom/wide_bvh.h>
#include <kaboum/geom/winding.h>

#include <atomic>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace kaboum::bcd {

using geom::Box3;
using geom::Mesh;
using geom::Triangle;
using geom::Vec3;

/// A grid is this wide at least, as a share of the diagonal: flat solids have an inside, too.
inline constexpr double kFlattestGrid = 0.02;

/// What a decomposition has to contain: the solid of a closed chain and its triangles. Distances to
/// both, exact ones and quick ones.
class SolidField {
 public:
  /// @param mesh  a closed chain; kept by reference.
  /// @param nodes  number asked for, of nodes of the grid behind field(); with up to eight times as
  /// many it is no coarser than 0.7 · epsilon.
  /// @param epsilon  distances that matter; 0: all the same. [length]
  /// @param witnesses  whether to look for witnesses at once.
  /// @param work  what is counted there is what the search may do. [ns]
  SolidField(const Mesh& mesh, std::size_t nodes, double epsilon, bool witnesses = true,
             double work = std::numeric_limits<double>::infinity());
  /// The same solid for another search, with no witnesses yet and its own account of work: what
  /// either of them computes of the grid, both have.
  SolidField(const SolidField& same, double work);
  /// Neither copied nor moved: others refer to its hierarchy.
  SolidField(const SolidField&) = delete;
  SolidField(SolidField&&) = delete;
  SolidField& operator=(const SolidField&) = delete;
  SolidField& operator=(SolidField&&) = delete;
  ~SolidField() = default;

  /// Looks for witnesses all over the grid, unless that has been done.
  void find_witnesses();

  [[nodiscard]] const Mesh& mesh() const { return mesh_; }
  [[nodiscard]] const Box3& box() const { return box_; }
  [[nodiscard]] double diagonal() const { return diagonal_; }
  [[nodiscard]] const geom::DistanceQuery& surface() const { return parts_->surface; }

  /// Winding number ≥ 1, or on a triangle; exact.
  [[nodiscard]] bool contains(const Vec3& p) const;
  /// Winding number ≥ 1, and on no triangle; exact.
  [[nodiscard]] bool contains_round(const Vec3& p) const;
  /// Appends the triangles whose boxes meet the box. @return false when there are more than `most`.
  bool triangles_near(const Box3& box, std::size_t most, std::vector<std::uint32_t>& out) const;

  /// Signed distance to the surface, negative inside and no deeper than four spacings, interpolated
  /// on a grid whose nodes are computed when they are first needed. Good to about the grid's
  /// spacing, beyond the grid (some spacings round the mesh) an upper bound of as much; guides the
  /// search, never a claim. Same value whatever was asked before, from any thread.
  [[nodiscard]] double field(const Vec3& p) const;
  /// Distance to the solid or its triangles, up to rounding, if it exceeds `least`; else something
  /// ≤ `least`. `guess` is the field there, which is trusted to be no less.
  [[nodiscard]] double distance_above(double least, const Vec3& p, double guess) const;
  /// Points outside the solid, far from it compared with their neighbours: where a hull that spans
  /// a pit or a cavity is farthest from the solid, although its facets may be near.
  struct Witness {
    Vec3 point;
    double distance;
    /// How far from it a hull is judged by it still: of one cut into thin slices, all are.
    [[nodiscard]] double near() const { return 0.1 * distance; }
  };
  [[nodiscard]] const std::vector<Witness>& witnesses() const { return witnesses_; }
  /// Adds a point whose distance was measured, if it lies in the hull of these points and they are
  /// sampled to be nearer. @return whether it was added.
  bool add_witness(const Witness& witness, std::span<const Vec3> hull);
  /// What the square of a witness's distance from the next one is about. [length²]
  [[nodiscard]] double witness_area() const { return witness_area_; }
  [[nodiscard]] double spacing() const { return spacing_; }
  /// From now on a hull that may meet a region counts as so many times as far from the solid as
  /// epsilon is larger than the region's.
  void weigh(const std::vector<geom::BoundedRegion>& regions, double epsilon);
  /// The number that distances of the points' hull are multiplied with, 1 at least.
  [[nodiscard]] double weight(std::span<const Vec3> hull) const;
  /// Of all that looks at this solid.
  [[nodiscard]] Work& work() const { return work_; }
  [[nodiscard]] std::size_t nodes_computed() const { return parts_->computed; }

 private:
  [[nodiscard]] float node(int x, int y, int z) const;
  /// Distance to the surface, rounded, if it is below `limit`; where it is below `enough`, any
  /// number below that.
  [[nodiscard]] double rough_distance(const Vec3& p, double limit, double enough = 0) const;

  /// Search trees of the mesh and values of its grid, which searches of the same mesh share.
  struct Parts {
    explicit Parts(const Mesh& mesh);
    geom::DistanceQuery surface;
    geom::WindingNumber winding;  // refers to the hierarchy of `surface`
    struct Corner {
      Vec3 a, ab, ac;
    };
    std::vector<Corner> corners;  // of the triangles, in the order of the hierarchy
    geom::WideBvh wide;
    std::unique_ptr<std::atomic<float>[]> value;
    std::atomic<std::size_t> computed{0};
  };

  const Mesh& mesh_;
  Box3 box_;
  double diagonal_;
  std::shared_ptr<Parts> parts_;
  std::vector<geom::BoundedRegion> regions_;  ///< each with the weight in place of epsilon
  double spacing_ = 0, per_spacing_ = 0, witness_area_ = 0;
  double shallow_ = 0;  // pits that are no deeper need no witness
  int step_ = 1;        // of the grid, from one place looked at for a witness to the next
  bool witnesses_found_ = false;
  Vec3 origin_;
  std::array<int, 3> size_{};
  std::vector<Witness> witnesses_;
  mutable Work work_;
};

}  // namespace kaboum::bcd
