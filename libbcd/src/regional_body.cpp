// Outer parallel bodies that are narrower in regions. docs/algorithms/sphere-covers.md, "Regions".
#include "regional_body.h"

#include <algorithm>
#include <array>

namespace kaboum::bcd {

RegionalBody::RegionalBody(const geom::DistanceQuery& surface, const geom::WindingNumber& winding,
                           double distance, double share,
                           const std::vector<geom::BoundedRegion>& regions, double epsilon)
    : whole_(surface, winding, distance, share) {
  for (const geom::BoundedRegion& one : regions) {
    if (!(one.epsilon < epsilon)) continue;
    parts_.push_back(
        {one.region, std::make_unique<ParallelBody>(surface, winding,
                                                    distance * (one.epsilon / epsilon), share)});
  }
}

namespace {

/// The least of what all allows and, of each region, the larger one of the distance from it and of
/// what its own body allows.
template <class Radius>
double least_radius(const RegionalBody& body, const geom::Vec3& c, const Radius& radius_in) {
  double out = radius_in(body.whole());
  const std::array<geom::Vec3, 1> at{c};
  for (const RegionalBody::Part& part : body.parts()) {
    const double apart = (1 - kApartSlack) * geom::distance_from(part.region, at);
    if (apart < out) out = std::min(out, std::max(apart, radius_in(*part.body)));
  }
  return out;
}

}  // namespace

double RegionalBody::radius_about(const geom::Vec3& c) const {
  return least_radius(*this, c, [&](const ParallelBody& body) { return body.radius_about(c); });
}

ParallelBody::Room RegionalBody::room_about(const geom::Vec3& c) const {
  if (parts_.empty()) return whole_.room_about(c);
  ParallelBody::Room out{radius_about(c), std::nullopt};
  if (!(out.radius > 0)) return out;
  // A distance falls fastest towards what is nearest.
  const double step = 1e-4 * out.radius;
  geom::Vec3 along;
  for (int k = 0; k < 3; ++k) along[k] = radius_about(c - step * geom::Vec3::Unit(k)) - out.radius;
  if (along.norm() > 0) out.limit = c + out.radius * along.normalized();
  return out;
}

double RegionalBody::refined_radius_about(const geom::Vec3& c, double share) const {
  return least_radius(
      *this, c, [&](const ParallelBody& body) { return body.refined_radius_about(c, share); });
}

}  // namespace kaboum::bcd
