#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/triangle_search.h>
#include <kaboum/geom/winding.h>

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace kaboum::bcd {

/// The outer parallel body of a solid: all points within a distance of it. It says how large a ball
/// about a point may be that is to lie in it.
///
/// What is near the boundary and outside is held by caps of small balls, which an octree finds. The
/// nearest cap is as far away as the radius that it allows, but for a small share of the distance.
/// docs/algorithms/sphere-covers.md, "How far".
class ParallelBody {
 public:
  /// Surface and winding number are referred to.
  /// @param winding  of the mesh that `surface` is of, a closed chain
  /// @param share  size of the caps, as a share of the distance. Half its square is the share that
  ///   radii lose where one point of the surface is nearest to what is beyond; elsewhere they may
  ///   lose as much as the caps' size. The work grows with the inverse of its square.
  /// @pre distance > 0; share > 0
  ParallelBody(const geom::DistanceQuery& surface, const geom::WindingNumber& winding,
               double distance, double share);

  /// A radius such that the open ball of it about c lies in the body; 0 where c is not in the body
  /// for certain. [length]
  [[nodiscard]] double radius_about(const geom::Vec3& c) const;

  /// The same radius, and what it ends at.
  struct Room {
    double radius = 0;
    /// A point about as far from c as the radius says that a ball may not reach beyond, as far as
    /// is known. Not given where the radius is 0.
    std::optional<geom::Vec3> limit;
  };
  [[nodiscard]] Room room_about(const geom::Vec3& c) const;

  /// A larger one, if there is one: caps are cut until they have another size, a smaller share of
  /// the distance, or some thousand were.
  [[nodiscard]] double refined_radius_about(const geom::Vec3& c, double share) const;

  /// A point near the boundary that is about as far from c as the boundary is; nullopt: none is
  /// known.
  [[nodiscard]] std::optional<geom::Vec3> boundary_near(const geom::Vec3& c) const;

  /// Bounds of the signed distance from the solid's surface, negative inside. [length]
  struct SignedDistance {
    double lower, upper;
  };
  [[nodiscard]] SignedDistance signed_distance(const geom::Vec3& p) const;

  [[nodiscard]] double distance() const { return distance_; }

  /// Points x with |x − center| ≤ cap_reach() and normal · (x − center) ≥ height.
  struct Cap {
    geom::Vec3 center, normal;
    double height;
  };
  [[nodiscard]] double cap_reach() const { return h_; }

  /// Calls visit(cap) for caps whose centres lie in boxes for which bound(box) is at most `limit`,
  /// which visit may change; boxes of small bounds come first. All that is beyond the distance, and
  /// near the boundary, is in a cap: a connected set that has a point nearer than that, and meets
  /// no cap, lies in the body.
  template <class Bound, class Visit>
  void visit_caps(const double& limit, const Bound& bound, const Visit& visit) const {
    if (caps_.empty()) return;
    const auto nodes = tree_.nodes();
    std::array<std::pair<double, std::uint32_t>, geom::Bvh::kMaxDepth> stack;
    int size = 0;
    stack[size++] = {bound(nodes[0].box), 0};
    while (size > 0) {
      const auto [known, index] = stack[--size];
      if (known > limit) continue;
      const geom::Bvh::Node& node = nodes[index];
      if (node.leaf()) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i)
          visit(caps_[tree_.order()[i]]);
        continue;
      }
      std::pair<double, std::uint32_t> near{bound(nodes[index + 1].box), index + 1};
      std::pair<double, std::uint32_t> far{bound(nodes[node.first].box), node.first};
      if (far.first < near.first) std::swap(near, far);
      if (far.first <= limit) stack[size++] = far;
      if (near.first <= limit) stack[size++] = near;
    }
  }

 private:
  struct Cell;
  struct Look;

  [[nodiscard]] Look look_at(const Cell& cell, double h) const;
  [[nodiscard]] std::optional<Cap> cap_of(const Cell& cell, const Look& look, double h) const;
  /// The signed distance of a point from the surface, and the direction to the nearest place.
  struct Around {
    SignedDistance signed_distance;
    geom::Vec3 along;  ///< of length 1; not finite for a point of the surface
  };
  [[nodiscard]] Around look_around(const geom::Vec3& c) const;
  [[nodiscard]] SignedDistance signed_distance(const geom::Vec3& p,
                                               const geom::TriangleSearch::Nearest& near) const;
  [[nodiscard]] bool is_nearest_deciding(const geom::Vec3& c, const geom::Vec3& along, double s,
                                         double share) const;
  void find_caps();
  /// Calls visit(cap, distance) for caps that may be nearer than `limit`, which it may change.
  template <class Visit>
  void visit_near(const geom::Vec3& c, const double& limit, const Visit& visit) const;

  const geom::DistanceQuery& surface_;
  const geom::WindingNumber& winding_;
  double distance_, share_;
  double half_ = 0, h_ = 0;  ///< half the edge of the last cells, and half their diagonal
  std::vector<Cap> caps_;
  geom::Bvh tree_;  ///< over their centers
};

}  // namespace kaboum::bcd
