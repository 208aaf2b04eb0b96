#pragma once

#include <kaboum/base/length.h>
#include <kaboum/geom/region.h>
#include <kaboum/robot/link_meshes.h>

#include <map>
#include <optional>
#include <set>
#include <string>
#include <vector>

/// How near bodies of single links, and what of them lies in regions, are to be held.
namespace kaboum::robot {

/// A region in a link's frame, and how far rounding may have moved its boundary on the way there.
struct LinkRegion : geom::RequestedRegion {
  double rounding = 0;  ///< at the frame's origin [length]
  double tilt = 0;      ///< what is added for each length from there [1]
};

/// Of links, by their names, in their frames.
using LinkRegions = std::map<std::string, std::vector<LinkRegion>>;

/// What counts of links instead of what counts of all.
struct LinkBounds {
  std::map<std::string, Length> epsilons;
  LinkRegions regions;
  /// All links that are fixed to the frame of a region, those without shapes as well: a body there
  /// is near no shape.
  std::set<std::string> groups = {};
};

/// Moves regions into the frames of all links with shapes that are fixed to the regions' frames:
/// joints that are fixed, and no others, lie between. So what a region means does not depend on
/// values of joints. Poses are those of the robot as read, which may be rounded.
/// @throws Error{InvalidInput} naming the place of frames and links that the robot does not have,
///   links that are there twice, and frames or links with which no shape that is meant moves; as
///   ShapeChoice::shapes_of
LinkBounds bounds_of_links(const RobotFile& robot, const ShapeChoice& choice,
                           const geom::FrameRegions& asked);

/// How a region is to stand for another one that is known up to rounding, and turned or scaled.
enum class Side {
  Round,  ///< it holds the other one, and its epsilon is no larger
  Within  ///< it lies in the other one, and its epsilon is no smaller
};

/// The region in the frame and unit of a shape of the link, before the shape's scale where it is a
/// mesh. Half-spaces and boxes stay what they are, up to the rounding that is added; so does a
/// ball, unless the scale is uneven: then the smallest ball round what becomes of it is meant, or
/// the largest one within. A length becomes one of the mesh's unit, a percentage stays one.
/// @return nullopt within a ball of which rounding leaves nothing
/// @throws Error{InvalidInput} where turned planes could not be told apart from others: after very
///   many joints, or with scales that differ a hundredfold by axis
std::optional<geom::RequestedRegion> region_in_shape(const LinkRegion& region,
                                                     const Geometry& shape, Side side);

/// The same in the link's frame.
std::optional<geom::RequestedRegion> region_in_link(const LinkRegion& region, Side side);

}  // namespace kaboum::robot
