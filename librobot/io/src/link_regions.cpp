// Regions of robots in the frames of links and of their meshes.
// docs/algorithms/exact-inclusion.md, "Regions of robots".

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/robot/link_regions.h>

#include <algorithm>
#include <cmath>

namespace kaboum::robot {
namespace {

/// What one pose moves a point at distance 1 by, besides what its rotation is not orthogonal by.
constexpr double kStep = 0x1p-48;
/// Planes that are turned by more are not told apart from others by who decides.
constexpr double kMostTilt = 0x1p-39;

/// A link below links that no joint moves against it.
struct RigidPlace {
  std::uint32_t top = 0;  ///< the first of these
  Transform pose;         ///< from the link's frame to that of `top`
  double tilt = 0;        ///< what the poses there move a point at distance 1 by
  double reach = 0;       ///< sum of the steps there [length]
};

/// What a pose moves a point at distance 1 by, where its transpose stands for its inverse.
double tilt_of(const Mat3& turn) {
  return kStep + 2 * (turn.transpose() * turn - Mat3::Identity()).norm();
}

/// Of all links.
std::vector<RigidPlace> rigid_places(const Robot& robot) {
  std::vector<RigidPlace> out(robot.links.size());
  for (std::uint32_t l = 1; l < robot.links.size(); ++l) {
    const Joint& joint = robot.joints[l - 1];
    out[l].top = l;
    if (joint.type != JointType::Fixed || joint.unmodelled) continue;
    out[l] = out[joint.parent];
    out[l].pose = out[l].pose * joint.origin;
    out[l].tilt += tilt_of(joint.origin.linear);
    out[l].reach += joint.origin.translation.norm();
  }
  return out;
}

/// How far from the origin a region is known to begin, or ends. [length]
double extent_of(const geom::Region& region) {
  double out = region.sides.empty() ? region.center.norm() + region.radius : 0;
  for (const geom::HalfSpace& side : region.sides) out = std::max(out, std::abs(side.offset));
  return out;
}

/// A region of one rigid part's frame in that of another.
LinkRegion moved(const geom::RequestedRegion& region, const RigidPlace& from,
                 const RigidPlace& to) {
  LinkRegion out{region};
  const Mat3 turn = to.pose.linear.transpose() * from.pose.linear;
  const Vec3 step = to.pose.linear.transpose() * (from.pose.translation - to.pose.translation);
  for (geom::HalfSpace& side : out.region.sides) {
    side.normal = turn * side.normal;
    side.offset += side.normal.dot(step);
  }
  out.region.center = turn * out.region.center + step;
  out.tilt = from.tilt + to.tilt;
  out.rounding = out.tilt * (from.reach + to.reach + extent_of(region.region));
  return out;
}

std::vector<std::string> names_of_links(const Robot& robot) {
  std::vector<std::string> out;
  out.reserve(robot.links.size());
  for (const Link& link : robot.links) out.push_back(link.name);
  return out;
}

/// @throws Error{InvalidInput} naming the place
std::uint32_t link_called(const std::string& name, const char* as, const std::string& place,
                          const Robot& robot) {
  if (const auto found = robot.find_link(name)) return *found;
  throw Error(ErrorCode::InvalidInput, place + ": robot '" + robot.name + "' has no " + as + " '" +
                                           name + "'" + did_you_mean(name, names_of_links(robot)));
}

}  // namespace

LinkBounds bounds_of_links(const RobotFile& file, const ShapeChoice& choice,
                           const geom::FrameRegions& asked) {
  const Robot& robot = file.robot;
  const std::vector<RigidPlace> places = rigid_places(robot);
  const auto is_meant = [&](const Link& link) {
    return choice.has(link) && !choice.shapes_of(link).empty();
  };
  LinkBounds out;
  for (const geom::FrameRegions::OfLink& one : asked.links) {
    const Link& link = robot.links[link_called(one.link, "link", one.place, robot)];
    if (!is_meant(link))
      throw Error(ErrorCode::InvalidInput,
                  one.place + ": link '" + one.link + "' has no shape that is meant");
    if (!out.epsilons.emplace(one.link, one.epsilon).second)
      throw Error(ErrorCode::InvalidInput,
                  one.place + ": link '" + one.link + "' has an epsilon already");
  }
  for (const geom::FrameRegions::Fixed& one : asked.regions) {
    const std::uint32_t frame = link_called(one.frame, "frame", one.place, robot);
    std::vector<std::string> group;
    bool any = false;
    for (std::uint32_t l = 0; l < robot.links.size(); ++l) {
      if (places[l].top != places[frame].top) continue;
      const Link& link = robot.links[l];
      group.push_back(link.name);
      out.groups.insert(link.name);
      if (!is_meant(link)) continue;
      any = true;
      out.regions[link.name].push_back(l == frame ? LinkRegion{one}
                                                  : moved(one, places[frame], places[l]));
    }
    if (!any)
      throw Error(ErrorCode::InvalidInput,
                  one.place + ": no shape that is meant is fixed to frame '" + one.frame +
                      "': " + names_of(group) + (group.size() == 1 ? " has" : " have") +
                      " none, and links that joints move against it do not count");
  }
  return out;
}

std::optional<geom::RequestedRegion> region_in_shape(const LinkRegion& region,
                                                     const Geometry& shape, Side side) {
  const bool is_mesh = shape.shape == Geometry::Shape::Mesh;
  const Vec3 scale = is_mesh ? shape.size : Vec3(Vec3::Ones());
  const double least = scale.cwiseAbs().minCoeff(), most = scale.cwiseAbs().maxCoeff();
  const Transform& pose = shape.origin;
  const bool is_moved = !pose.linear.isIdentity(0) || !pose.translation.isZero(0);
  const double sign = side == Side::Round ? 1 : -1;
  double rounding = region.rounding, tilt = region.tilt;
  if (is_moved) {
    tilt += tilt_of(pose.linear);
    // Its own, and that of others, whose origin is another one.
    rounding += tilt * (pose.translation.norm() + extent_of(region.region));
  }
  geom::RequestedRegion out = region;
  geom::Region& made = out.region;
  // Of the mesh's diagonal, which grows by the least scale at least.
  if (out.epsilon.percent)
    out.epsilon.value *= side == Side::Round ? least / most : 1;
  else
    out.epsilon.value /= side == Side::Round ? most : least;
  if (made.sides.empty()) {
    made.center = (pose.linear.transpose() * (made.center - pose.translation)).cwiseQuotient(scale);
    made.radius = (made.radius + sign * rounding) / (side == Side::Round ? least : most);
    if (!(made.radius > 0)) return std::nullopt;
    return out;
  }
  if (tilt * (most / least) > kMostTilt)
    throw Error(ErrorCode::InvalidInput,
                "the region " + region.name +
                    " has planes, which are turned too often, or by a scale that differs too much "
                    "by axis: state it in a frame that is nearer, or as a ball");
  for (geom::HalfSpace& plane : made.sides) {
    plane.offset += sign * rounding - plane.normal.dot(pose.translation);
    plane.normal = (pose.linear.transpose() * plane.normal).cwiseProduct(scale);
    const double length = plane.normal.norm();
    plane.normal /= length;
    plane.offset /= length;
  }
  return out;
}

std::optional<geom::RequestedRegion> region_in_link(const LinkRegion& region, Side side) {
  return region_in_shape(region, Geometry{}, side);
}

}  // namespace kaboum::robot
