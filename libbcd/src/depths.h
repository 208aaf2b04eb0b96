#pragma once

#include <kaboum/geom/winding.h>

#include <cstdint>
#include <queue>
#include <vector>

#include "boundary.h"
#include "depth_bounds.h"
#include "inscribe.h"

namespace kaboum::bcd {

/// Branch and bound for the deepest point of the solid that is in no body.
/// Bodies are added between searches; what was bounded before stays bounded.
class Depths {
 public:
  /// Keeps a reference to the winding numbers.
  Depths(const Mesh& mesh, const geom::WindingNumber& winding, const Boundary& boundary);

  struct Deepest {
    Vec3 point = Vec3::Zero();
    double depth = 0;  ///< no triangle is nearer to the point; 0: no point found
    double lower = 0;  ///< the point is in no body, and this deep
    double upper = 0;  ///< no point is deeper
  };

  /// A point in no body about as deep as any (to within the share `gap`, or any
  /// deeper than 0.8 · `enough`), unless none is deeper than `enough`. Gives up
  /// after `most` cubes; the bound is then wide.
  /// @param seeds  whether a point will do that is deep inside one cube, though
  /// it may be in bodies.
  Deepest search(const std::vector<Inscribed>& bodies, double enough, double gap, bool seeds,
                 std::size_t most);

  /// Cubes looked at so far.
  [[nodiscard]] std::size_t looked() const { return looked_; }

 private:
  struct Cube {
    Vec3 center;
    double half;
    double upper;  // no point of the solid in the cube is deeper
    double depth;  // no triangle of the boundary is nearer to the center; 0
                   // outside the solid
    std::uint32_t nearest;
    std::uint64_t number;
    bool operator<(const Cube& o) const {
      return upper != o.upper ? upper < o.upper : number > o.number;
    }
  };

  void add(const Vec3& center, double half, std::uint32_t hint, double known);
  [[nodiscard]] bool within(const Cube& cube, const std::vector<Inscribed>& bodies) const;
  [[nodiscard]] bool in_a_body(const Vec3& p, const std::vector<Inscribed>& bodies) const;

  DepthBounds bounds_;
  std::priority_queue<Cube> cubes_;
  std::uint64_t count_ = 0;
  std::size_t looked_ = 0;
};

}  // namespace kaboum::bcd
