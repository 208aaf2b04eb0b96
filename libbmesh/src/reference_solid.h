#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/winding.h>

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "work.h"

namespace kaboum::bmesh {

using geom::Vec3;

/// A tetrahedron with volume; the order of its corners does not matter.
using Tetrahedron = std::array<Vec3, 4>;

/// Whether the triangle (which may be degenerate) meets the tetrahedron's open interior. Exact: see
/// docs/algorithms/bounding-mesh.md, "Separating planes".
///
/// @pre the tetrahedron has volume.
bool meets_interior(const Tetrahedron& tetrahedron, const std::array<Vec3, 3>& triangle,
                    std::uint64_t* exact_calls = nullptr);

/// Whether two triangles in one plane have areas of the same orientation; false when either has
/// none. Exact.
bool same_orientation(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                      std::uint64_t* exact_calls = nullptr);

/// Whether two of the unit normals are nearly opposite.
bool opposed(std::span<const Vec3> normals);

namespace detail {

/// Four numbers that are computed with at once.
using Double4 = double __attribute__((vector_size(32)));

struct alignas(32) FourVectors {
  Double4 of[3];  // by axis
};

/// Corners and boxes of up to four triangles.
struct FourCorners {
  FourVectors corner[3], low, high;
  std::array<std::uint32_t, 4> triangle;
  unsigned all;  // a bit for each triangle
};

}  // namespace detail

/// Exact questions about the solid of the original: the certificate of steps that give back what
/// earlier steps have added.
class ReferenceSolid {
 public:
  /// Keeps a reference to `original`, which must outlive this object and be a closed chain.
  /// @param hierarchy  over it, where there is one already.
  /// @param work  counts what is done, if not null.
  explicit ReferenceSolid(const geom::Mesh& original,
                          std::shared_ptr<const geom::Bvh> hierarchy = nullptr,
                          Work* work = nullptr);

  /// Whether the tetrahedron's open interior meets no triangle of the original and its winding
  /// number there is at most 0 (`inside` false) or at least 1 (`inside` true). False also when the
  /// tetrahedron is so thin that no double is found inside. Safe to call from several threads.
  ///
  /// @param met  receives, when not null, up to kMostMet of the triangles that meet the interior.
  [[nodiscard]] bool contains(const Tetrahedron& tetrahedron, bool inside,
                              std::vector<std::uint32_t>* met = nullptr) const;
  static constexpr std::size_t kMostMet = 16;

  /// The original's triangles near a box, for several tetrahedra in it, four to a group.
  class Surroundings {
   public:
    /// Whether all near this box are held, and it is no small part of what is.
    [[nodiscard]] bool hold(const geom::Box3& box) const {
      return (box_.min.array() <= box.min.array()).all() &&
             (box.max.array() <= box_.max.array()).all() && box_.diagonal() <= 2 * box.diagonal();
    }

   private:
    friend class ReferenceSolid;
    geom::Box3 box_;
    std::vector<detail::FourCorners> groups_;  // in the hierarchy's order
  };

  /// Makes `around` hold the box. Safe to call from several threads.
  void look_around(const geom::Box3& box, Surroundings& around) const;

  /// As `contains`, of a tetrahedron in the box that `around` holds, with the same answer and the
  /// same triangles met.
  [[nodiscard]] bool contains(const Tetrahedron& tetrahedron, bool inside,
                              std::vector<std::uint32_t>* met, const Surroundings& around) const;

 private:
  [[nodiscard]] bool is_middle_in(const Tetrahedron& tetrahedron, bool inside) const;

  const geom::Mesh& original_;
  std::shared_ptr<const geom::Bvh> bvh_;
  geom::WindingNumber winding_;
  Work* work_;
};

}  // namespace kaboum::bmesh
