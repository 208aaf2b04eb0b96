// Putting a held object to where constraints between it and another one are met.
#include "sequence.h"

#include <algorithm>

namespace kaboum::manipulation {

using plan::Answer;

bool Sequence::mate(std::size_t robot, std::size_t object, std::size_t onto,
                    const world::ConstraintSet& set) {
  const world::World& world = geometry_.world;
  const std::string &name = world.objects[object].name, &below = world.objects[onto].name;
  if (!held_by(robot, object))
    return fail(Answer::Kind::Impossible, world.robots[robot].name + " does not hold " + name);
  if (onto == object || state_.absent[onto] || held_by(robot, onto))
    return fail(Answer::Kind::Impossible, below + " is not there to mount on");
  if (!satisfy(robot, set)) return false;
  const world::Attachment held = *held_by(robot, object);
  target_ = Target{object, pose_of_link(robot, held.link) * held.pose, onto, held.link, 0};
  return true;
}

}  // namespace kaboum::manipulation
