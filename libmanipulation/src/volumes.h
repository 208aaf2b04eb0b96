#pragma once

#include "geometric_state.h"

namespace kaboum::manipulation {

/// A bounding volume of motions: for each thing that moves or rests, convex sets that contain it at
/// every instant. Handles of type `volume` name one by all that it is made of.
struct Volume {
  struct Shape {
    world::Item item;
    std::size_t carrier = world::Item::kObject;  ///< the robot it belongs to or that carries it
    std::shared_ptr<const collide::BoundingSet> set;  ///< that `place` refers to
    collide::PosedSet place;                          ///< in the world
  };
  std::vector<Shape> shapes;
  std::vector<Motion> motions;  ///< one after another
  /// True if fingers with joints move, or hold something: where they are is not known well enough
  /// for a set to contain them.
  bool has_loose_fingers = false;
};

/// A robot along a path with what it carries in a state.
Motion motion_in(const world::WorldState& state, std::size_t robot, robot::Path path);

/// The word of the volume that motions sweep. Numbers are exact: the word's motions are these.
/// @pre there is a motion, and each has a waypoint.
std::string volume_word(const world::World& world, const std::vector<Motion>& motions);
/// The word of the volume of an object that rests.
std::string volume_word(const world::World& world, std::size_t object,
                        const world::Transform& pose);

/// The volume of a word. It is kept for as long as the geometry, up to a number of volumes.
/// @throws Error{InvalidInput} for what is no word of a volume of the world, naming what is wrong;
///   Error{LimitReached} where single precision is too coarse for the robot's reach.
std::shared_ptr<const Volume> volume_of(Geometry& geometry, const std::string& word);

/// Whether two volumes are *not* certainly apart, their margin included: any instant of the one
/// against any instant of the other (Definition 1 of [gaschler2016], case 3). True where a robot or
/// an object is in both, and where one has loose fingers. Allowed contacts of the scene are not
/// looked at.
bool are_in_contact(const Geometry& geometry, const Volume& a, const Volume& b);

/// Whether all that is in a volume is certainly in a region at every instant (case 4). False where
/// it has loose fingers.
bool is_inside(const Geometry& geometry, const Volume& volume, std::size_t region);

}  // namespace kaboum::manipulation
