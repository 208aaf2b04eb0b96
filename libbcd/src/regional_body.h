#pragma once

#include <kaboum/geom/region.h>

#include <memory>
#include <optional>
#include <vector>

#include "parallel_body.h"

namespace kaboum::bcd {

/// The outer parallel body of a solid, without what is farther from the solid than regions allow
/// that lie in it. A convex set is in it that is in the parallel body at the distance, and for each
/// region is apart from that, or in the parallel body at the region's distance.
class RegionalBody {
 public:
  /// As of ParallelBody.
  /// @param regions  their distances are shares of `distance`, as far as they are below `epsilon`
  RegionalBody(const geom::DistanceQuery& surface, const geom::WindingNumber& winding,
               double distance, double share, const std::vector<geom::BoundedRegion>& regions,
               double epsilon);

  /// As of ParallelBody. [length]
  [[nodiscard]] double radius_about(const geom::Vec3& c) const;
  [[nodiscard]] ParallelBody::Room room_about(const geom::Vec3& c) const;
  [[nodiscard]] double refined_radius_about(const geom::Vec3& c, double share) const;
  [[nodiscard]] std::optional<geom::Vec3> boundary_near(const geom::Vec3& c) const {
    return whole_.boundary_near(c);
  }
  [[nodiscard]] ParallelBody::SignedDistance signed_distance(const geom::Vec3& p) const {
    return whole_.signed_distance(p);
  }
  [[nodiscard]] double distance() const { return whole_.distance(); }

  /// The parallel body that all is in.
  [[nodiscard]] const ParallelBody& whole() const { return whole_; }
  struct Part {
    geom::Region region;
    std::unique_ptr<ParallelBody> body;
  };
  /// The bodies of the regions: a point in a region has to be in that region's body as well.
  [[nodiscard]] const std::vector<Part>& parts() const { return parts_; }

 private:
  ParallelBody whole_;
  std::vector<Part> parts_;
};

/// Share of a distance, or of a size, that is slack where something is to be apart from a region.
/// [1]
inline constexpr double kApartSlack = 1e-5;

}  // namespace kaboum::bcd
