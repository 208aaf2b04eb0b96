#pragma once

#include <kaboum/verify/cover.h>

#include <limits>
#include <span>

namespace kaboum::verify {

/// One factor of a link's pose: a fixed transform, then a turn about (a slide along) `axis` by
/// multiplier · q[variable] + offset.
struct KinematicStage {
  enum class Motion { None, Turn, Slide };
  Motion motion = Motion::None;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();  ///< of the fixed transform
  geom::Vec3 translation = geom::Vec3::Zero();
  geom::Vec3 axis = geom::Vec3::UnitZ();  ///< any length but 0
  std::uint32_t variable = 0;
  double multiplier = 1, offset = 0;
};

/// The stages from the root to a shape, whose last fixed transform is the shape's place.
using KinematicChain = std::vector<KinematicStage>;

/// Pose of what the chain carries, for values of the variables; by long double arithmetic.
Eigen::Matrix<double, 3, 4> pose_of(const KinematicChain& chain, std::span<const double> q);

/// Bounds, for q(s) = from + s (to − from), 0 ≤ s ≤ 1, of what the chain does to the points no
/// farther than `radius` from the origin of its last frame. Rounded up.
struct MotionBound {
  double distance = 0;      ///< from the root's origin [length]
  double speed = 0;         ///< |dx/ds| [length]
  double acceleration = 0;  ///< |d²x/ds²| [length]
  double rounding = 0;      ///< of a position computed in double, the chain's own included [length]
};
MotionBound bound_motion(const KinematicChain& chain, std::span<const double> from,
                         std::span<const double> to, double radius);

/// A shape of a robot, as its file states it, before anything bounded it.
struct MovingShape {
  enum class Kind { Mesh, Box, Cylinder, Sphere };
  std::string name;
  Kind kind = Kind::Mesh;
  geom::Mesh mesh;                       ///< in the last frame of the chain
  geom::Vec3 size = geom::Vec3::Ones();  ///< edges; radius and length along z; radius
  KinematicChain chain;
};

struct SweepOptions {
  /// Stretches and parts of triangles that move, and measure, less are not divided further.
  double gap = 0;                 ///< > 0 [length]
  std::size_t max_cells = 20000;  ///< looked at, per triangle and segment
  bool solids = true;             ///< decide the solid claim as well
  /// Limits of the solid claim; by default it has no end by work.
  InclusionOptions inclusion{.max_work = std::numeric_limits<double>::infinity()};
  std::function<void(const std::string&)> progress;  ///< called from one thread
};

/// A gap that is small beside the set. [length]
double default_gap(const geom::ConvexSet& set);

/// A place of the motion.
struct SweepPlace {
  std::size_t shape = 0, segment = 0;  ///< segment i leads from waypoint i to i + 1
  double s = 0;                        ///< where in it, 0 to 1
  geom::Vec3 point = geom::Vec3::Zero();
  double distance = 0;               ///< from the nearest body, margin not taken off [length]
  std::vector<geom::Vec3> triangle;  ///< the part of the shape that the point belongs to
};

struct SweepClaims {
  Claim convex;  ///< as verify_convexity
  /// At every configuration of the path every triangle of the meshes, and every box, cylinder and
  /// sphere, lies within the margin of the bodies.
  Claim surface;
  /// So do the solids of the closed meshes; Undefined when no mesh is closed.
  Claim solid;
  std::size_t open_meshes = 0;          ///< about which the solid claim says nothing
  std::optional<SweepPlace> refuting;   ///< of the surface claim
  std::optional<SweepPlace> undecided;  ///< the first place that could not be decided
  SweepPlace farthest;                  ///< of the places sampled, the one farthest from the bodies
  std::size_t cells = 0, samples = 0;   ///< looked at
  std::size_t undecided_cells = 0;
};

/// Decides whether a set of convex bodies, margin included, holds the shapes during a whole path,
/// linear between its waypoints: not only at samples. docs/algorithms/swept-volumes.md, "Checked
/// from files alone", has the proof. Shares nothing with what makes such sets.
///
/// The same for any number of threads.
/// @param path  at least one waypoint; each has a value for every variable of the chains.
/// @throws as verify_cover
SweepClaims verify_sweep(std::span<const MovingShape> shapes,
                         const std::vector<std::vector<double>>& path, const geom::ConvexSet& set,
                         const SweepOptions& options);

}  // namespace kaboum::verify
