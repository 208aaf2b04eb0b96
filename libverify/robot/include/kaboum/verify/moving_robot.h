#pragma once

#include <kaboum/robot/path.h>
#include <kaboum/robot/robot.h>
#include <kaboum/verify/claims.h>
#include <kaboum/verify/sweep.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace kaboum::verify {

/// The joints from the root to a link, in this verifier's words.
KinematicChain chain_to(const robot::Robot& robot, std::uint32_t link);

/// A shape of a link, without name; nullopt: it is a point, and nothing is left to be held. A
/// cylinder of radius 0, a line, has no curved side: it is a box.
/// @param mesh  what a mesh's file holds, before it is scaled; of other shapes not looked at
std::optional<MovingShape> moving_shape(const robot::Robot& robot, std::uint32_t link,
                                        const robot::Geometry& shape, geom::Mesh mesh = {});

/// True if this verifier's kinematics and the robot's, written apart, put the shapes' links in the
/// same place at all waypoints, up to the rounding of both.
/// @param links  of the shapes
/// @pre the last stage of each chain is the shape's place in its link
bool same_poses(const robot::Robot& robot, const std::vector<MovingShape>& shapes,
                const std::vector<std::uint32_t>& links, const robot::Path& path);

/// Values of the variables there. [rad or length]
std::vector<double> configuration_at(const robot::Path& path, const SweepPlace& place);

/// The worst answer of the claims that decide: convexity, the surface claim and, with
/// Claims::All, the solid claim where it means something.
Answer answer_of(const SweepClaims& found, Claims claims);

}  // namespace kaboum::verify
