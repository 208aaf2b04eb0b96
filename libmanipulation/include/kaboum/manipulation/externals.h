#pragma once

#include <kaboum/motion/find_path.h>
#include <kaboum/plan/externals.h>

#include <memory>

namespace kaboum::manipulation {

struct ExternalOptions {
  /// Of each call; its seed is the question's, and the work doubles with each attempt.
  motion::PathOptions path = {.most_work = 0.1};
  /// Things are put down from so far above, sums of ε apart. > 0 [length]
  double clearance = 1e-3;
};

/// The external functions that domains may declare (docs/planning/geometry.md), bound to a world.
/// They see the geometric state through the domain's functions `conf(ROBOT)` and `pose(OBJECT)`;
/// robots and objects of the world that the domain does not have stay as in the scene. Paths in
/// payloads are free at every instant (motion::find_path).
///
///     reach(robot, object) : conf           to where a grasp of the object is
///     grasp(robot, object, conf) : pose     of the object, in the hand of a robot there
///     place(robot, object, support) : conf  to where the held object stands on another one
///     release(robot, object, conf) : pose   of the object that is let go there
///     transfer(robot, object, support, conf) : pose
///                                           all that: reaches, grasps, puts the object on another
///                                           one, lets it go and moves to a configuration
///     move(robot, conf) : conf              to a configuration, with what is held
///     inside(object, region)                whether the object is in the region, for certain
///     collides(object, object)              whether the outer sets of two objects meet
plan::ExternalBindings bind_externals(world::World world, const ExternalOptions& options);

}  // namespace kaboum::manipulation
