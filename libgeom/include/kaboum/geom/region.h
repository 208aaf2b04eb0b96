#pragma once

#include <kaboum/base/length.h>
#include <kaboum/geom/mesh.h>

#include <span>
#include <string>
#include <vector>

namespace kaboum::geom {

/// Points x with normal · x ≤ offset.
struct HalfSpace {
  Vec3 normal = Vec3::Zero();  ///< a unit vector, up to rounding
  double offset = 0;           ///< [length]

  friend bool operator==(const HalfSpace&, const HalfSpace&) = default;
};

/// A convex part of space: what several half-spaces have in common or, without any, a closed ball.
struct Region {
  std::vector<HalfSpace> sides;
  Vec3 center = Vec3::Zero();
  double radius = 0;  ///< [length]

  friend bool operator==(const Region&, const Region&) = default;
};

/// The box along the axes.
Region box_region(const Box3& box);

/// True if the point is in the region, in rounded arithmetic.
bool holds(const Region& region, const Vec3& p);

/// No more than the distance of the hull of points (one at least) from the region, but for
/// rounding; below 0, or 0, where they meet. Often less than the distance. [length]
double distance_from(const Region& region, std::span<const Vec3> hull);

/// A region in which a bound of distances of its own holds.
struct BoundedRegion {
  std::string name;
  Region region;
  double epsilon = 0;  ///< [length]
};

/// The same as it is asked for, perhaps with a percentage of a mesh's diagonal.
struct RequestedRegion {
  std::string name;
  Region region;
  Length epsilon;

  friend bool operator==(const RequestedRegion&, const RequestedRegion&) = default;
};

/// Regions fixed in frames of a robot, and epsilons of whole links, as they are asked for.
struct FrameRegions {
  struct Fixed : RequestedRegion {
    std::string frame;  ///< name of a link
    std::string place;  ///< where it is stated, for messages
  };
  struct OfLink {
    std::string link;
    Length epsilon;
    std::string place;
  };
  std::vector<Fixed> regions;
  std::vector<OfLink> links;
};

/// The regions of a mesh with such a diagonal of its box.
/// @throws Error{InvalidArgument} as Length::of
std::vector<BoundedRegion> bounded(const std::vector<RequestedRegion>& regions, double diagonal);

}  // namespace kaboum::geom
