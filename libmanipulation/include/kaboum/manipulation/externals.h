#pragma once

#include <kaboum/motion/find_path.h>
#include <kaboum/plan/externals.h>

#include <memory>

namespace kaboum::manipulation {

/// Work of the external functions, as in Tables 6.2, 6.4 and 6.7 of [gaschler2016].
struct GeometryCounters {
  std::uint64_t ik_calls = 0;         ///< poses that configurations were looked for
  std::uint64_t predicate_calls = 0;  ///< configurations and motions that were looked at
  std::uint64_t positive = 0;         ///< motions of these that were not free
  std::uint64_t paths = 0;            ///< that were looked for
  double ik_seconds = 0, path_seconds = 0;
  std::uint64_t volumes = 0;  ///< swept volumes that were made, and what they consist of
  std::uint64_t volume_bodies = 0, volume_triangles = 0;
  std::uint64_t volume_tests = 0;  ///< volumes against objects, regions and each other
  double volume_seconds = 0, volume_test_seconds = 0;
};

struct ExternalOptions {
  /// Options of each call; its seed is the question's, and the work doubles with each attempt.
  motion::PathOptions path = {.most_work = 0.02, .shortcuts = 20};
  /// Things are put down from so far above, sums of ε apart. > 0 [length]
  double clearance = 1e-3;
  double lift = 0.1;  ///< how far things are lifted to be weighed. > 0 [length]
  std::shared_ptr<GeometryCounters> counters = {};  ///< counted in, if there are some
  /// Is told what the bounded predicates are asked; may be none.
  std::shared_ptr<world::Observer> observer = {};
  /// Decides contacts of configurations and motions in their stead; may be none. Volumes and
  /// regions stay theirs. Nothing is certified then that a payload says to be free.
  std::shared_ptr<world::Substitute> substitute = {};
  double upright = 0.26;  ///< most that what is kept upright leans, at any instant. > 0 [rad]
  /// Most that volumes are enlarged by on account of what moves between the ends of their pieces.
  /// Where bodies of the scene's sets have a radius, four times that if it is more. > 0 [length]
  double volume_epsilon = 2e-3;
};

/// The external functions that domains may declare (docs/planning/geometry.md), bound to a world.
/// They see the geometric state through the domain's functions `conf(ROBOT)` and `pose(OBJECT)`;
/// robots and objects of the world that the domain does not have stay as in the scene. Paths in
/// payloads are free at every instant (motion::find_path).
///
///     reach(robot, object) : conf           to where a grasp of the object is
///     grasp(robot, object, conf) : pose     of the object, in the hand of a robot there
///     place(robot, object, support) : conf  to where the held object stands on another one
///     fetch(robot, object, conf) : pose     reaches and grasps, and goes to a configuration
///     put(robot, object, support, conf) : pose
///                                           places, lets go and goes to a configuration
///     putUpright(robot, object, support, conf) : pose
///                                           the same, upright until it stands
///     satisfy(robot, constraints) : conf    where constraints of the scene are met
///     mate(robot, object, onto, constraints, conf) : pose
///                                           mounts a held object where constraints between it and
///                                           another one are met, lets go and goes to a
///                                           configuration
///     isReachable(object, robot)            a grasp of it is within the joints' limits
///     graspMotionCollides([robot,] object, object)
///                                           fetching the first is not certainly free of the other
///     lift(robot, object) : conf            straight up with what is held, upright
///     join(robot, object, onto, conf) : pose
///                                           mounts a held object on another one, lets go,
///                                           withdraws and goes to a configuration
///     push(robot, object, support, conf) : pose
///                                           pushes an object along a straight line on what it
///                                           stands on, backs off and goes to a configuration
///     handOver(robot, object, robot) : pose in the hand of the second robot; both are home then
///     wander(robot) : conf                  to some configuration
///     release(robot, object, conf) : pose   of the object that is let go there
///     transfer(robot, object, support, conf) : pose
///                                           all that: reaches, grasps, puts the object on another
///                                           one, lets it go and moves to a configuration
///     move(robot, conf) : conf              to a configuration, with what is held
///     inside(object, region)                whether the object is in the region, for certain
///     collides(object, object)              whether the outer sets of two objects meet
///     sweptVolume(robot, conf) : volume     of a straight motion from where the robot is
///     pathVolume(robot, conf) : volume      of a free path to a configuration
///     reachVolume(robot, object) : volume   of a free path to where a grasp of the object is
///     graspVolume(robot, object) : volume   of fetching an object and going back
///     occupiedVolume(thing) : volume        of a robot or an object where it is
///     volumeCollides(volume, object)        not certainly free of an object where it is
///     volumesCollide(volume, volume)        not certainly apart, whatever the time of either
///     volumeInside(volume, region)          in the region at every instant, for certain
///     follow(robot, volume) : conf          along the path of a volume, to its end
///     sweptCollides(robot, conf, object)    whether a straight motion is not certainly free of it
plan::ExternalBindings bind_externals(world::World world, const ExternalOptions& options);

}  // namespace kaboum::manipulation
