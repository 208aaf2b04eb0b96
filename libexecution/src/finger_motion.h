#pragma once

#include <kaboum/execution/robot_driver.h>

#include "motion_part.h"

namespace kaboum::execution {

/// How the fingers of a part close or open. @pre part.moves_fingers()
/// @throws as hold_of
FingerMotion finger_motion_of(const MotionPart& part, const world::World& world);
/// The same of the gripper that holds something. @pre held.fingers is not empty
/// @param from, to  configurations of its robot
FingerMotion finger_motion_of(const world::Attachment& held, const world::World& world,
                              const std::vector<double>& from, const std::vector<double>& to);

/// As drivers and files are told it (docs/planning/drivers.md).
template <typename Json>
Json to_json(const FingerMotion& fingers) {
  Json out = {{"name", fingers.gripper},  {"joint_names", fingers.joint_names},
              {"from", fingers.from},     {"to", fingers.to},
              {"within", fingers.within}, {"pads", fingers.pads}};
  if (fingers.force > 0) out["force"] = fingers.force;
  return out;
}

}  // namespace kaboum::execution
