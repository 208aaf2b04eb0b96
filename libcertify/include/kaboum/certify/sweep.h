#pragma once

#include <kaboum/certify/link_bodies.h>
#include <kaboum/robot/path.h>
#include <kaboum/sweep/sweep.h>

#include <optional>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Request for a swept set.
struct SweepRequest {
  /// epsilon: of the margin [length]. Its progress is told of the decision, too.
  sweep::SweepOptions search;
  /// Have libverify decide, from the bodies that are in the container, that these hold the robot
  /// all along the path. It takes longer than the search; without it the claim rests on the proof
  /// of the steps (docs/algorithms/swept-volumes.md).
  bool decide_motion = true;
  std::size_t max_cells = 20000;  ///< of that decision, see verify::SweepOptions

  // What the container says of itself.
  std::string parameters, unit = "m";
};

/// Why a swept set holds the robot all along the path.
enum class MotionClaim {
  None,     ///< not known: of StepRule::Baginski
  Proved,   ///< by the steps' proof
  Decided,  ///< by libverify as well, on the bytes in the container
};

/// Certificate of a swept set. A claim only as part of a CertifiedSweep.
struct SweepCertificate {
  MotionClaim motion = MotionClaim::None;
  std::string undecided;  ///< why it is not decided where that was asked for; one clause
  std::size_t bodies = 0, vertices = 0;
  double margin = 0;     ///< of the set: it holds the robot with this margin only [length]
  double deviation = 0;  ///< see sweep::SweepResult, as all below
  double left_out = 0, rounding = 0, excess = 0;
  /// Distance of bodies from shapes; `excess` is from what these bodies sweep. [length]
  double bodies_distance = 0;
  std::vector<std::size_t> of_link;
  std::vector<std::size_t> sources;  ///< the robot's body that each body of the set sweeps
};

/// A set that was serialised, read back, and decided exactly by libverify to consist of convex
/// bodies; its certificate says what is known of the motion. Its bytes are a GLB container.
using CertifiedSweep = Certified<geom::ConvexSet, SweepCertificate>;

/// What is claimed of it: convex bodies, and the motion.
Certificate certificate_of(const CertifiedSweep& sweep);

/// Convex bodies that, enlarged by the set's margin, hold the robot's bodies at every configuration
/// of the path: sweep::swept_volume, serialised, read back, decided.
///
/// @param bodies  of the same robot
/// @return nullopt when float32 is too coarse for epsilon so far from the origin.
/// @throws Error{InvalidArgument} as sweep::swept_volume; sweep::NoStepError; Error{Internal} when
///   the set does not pass the exact check, which would be a defect.
std::optional<CertifiedSweep> certify_sweep(const robot::RobotFile& robot,
                                            const CertifiedBodies& bodies, const robot::Path& path,
                                            const SweepRequest& request);

}  // namespace kaboum::certify
