#pragma once

#include <kaboum/robot/link_meshes.h>
#include <kaboum/robot/sphere_file.h>
#include <kaboum/verify/ball_cover.h>
#include <kaboum/verify/link_reach.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

/// The verdict on spheres that are to hold a robot's links.
namespace kaboum::verify {

/// A point of a link that none of its spheres holds.
struct MissedPoint {
  geom::Vec3 point = geom::Vec3::Zero();  ///< in the link's frame [length]
  double depth = 0;  ///< no more than its distance from the spheres; infinite: there are none
};

/// Verdict on the spheres of one link.
struct LinkSpheresVerdict {
  std::string link;
  std::uint32_t index = 0;  ///< of the link in the robot
  std::size_t spheres = 0, triangles = 0;
  Answer answer = Answer::Undefined;
  Inclusion inclusion;   ///< of the triangles, placed in the link's frame
  OutsideBalls outside;  ///< of these
  std::string open;      ///< why it is not known that shapes without triangles are held
  std::optional<MissedPoint> missed;  ///< the deepest that is known, where refuted
  Answer held = Answer::Undefined;    ///< `answer` without the distance
  LinkReach reach;                    ///< of the spheres beyond the shapes, if there are any
  std::string sentence;               ///< in words
  geom::Mesh mesh;                    ///< the triangles
  geom::ConvexSet balls;
};

/// Verdict on the spheres of a robot.
struct SpheresVerdict {
  Answer answer = Answer::Verified;
  std::vector<LinkSpheresVerdict> links;  ///< that have a shape, in the robot's order
  std::size_t spheres = 0, held = 0;      ///< held: number of links
  std::optional<double> epsilon = {};     ///< that was asked for [length]
  std::size_t within = 0;  ///< number of links with spheres, all within it, or what is their own
  std::vector<std::string> uncovered = {};  ///< links that have shapes and no spheres
  double share_lower = 0, share_upper = 0;  ///< of the area of all links, outside their own spheres
  double depth = 0;                         ///< the largest that is known and finite [length]
  std::vector<std::string> notes;           ///< what a user should know
  std::string sentence;                     ///< in words
};

/// Refuses spheres that cannot be a robot's.
/// @throws Error{InvalidInput} naming file and line: links that the robot does not have; frames of
///   links that the file's own robot has elsewhere (find_frame_elsewhere)
void require_spheres_of(const robot::RobotFile& robot, const robot::SphereFile& spheres,
                        const std::string& file);

/// Decides of each link of a robot whether its own spheres hold the triangles of its shapes, placed
/// in the link's frame in rounded arithmetic, and the solid that they bound as oriented. Links
/// without spheres have all outside. docs/algorithms/sphere-covers.md.
/// @param judged   called with each verdict as soon as it is there; may be empty
/// @param epsilon  decides as well that no point of a sphere is farther than this from its link's
///   shapes (measured_link) [length]
/// @param bounds   the same of single links, and of regions: what counts there
/// @throws as require_spheres_of; Error{InvalidInput} where there are no shapes; as reading meshes
SpheresVerdict decide_spheres(const robot::RobotFile& robot, const robot::SphereFile& spheres,
                              const std::string& file, const robot::ShapeChoice& shapes,
                              const std::function<void(const LinkSpheresVerdict&)>& judged = {},
                              std::optional<double> epsilon = {},
                              const robot::LinkBounds& bounds = {});

}  // namespace kaboum::verify
