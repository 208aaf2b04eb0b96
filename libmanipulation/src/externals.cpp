// The external functions by their names.
#include <kaboum/base/error.h>
#include <kaboum/manipulation/externals.h>

#include "actions.h"

namespace kaboum::manipulation {

plan::ExternalBindings bind_externals(world::World world, const ExternalOptions& options) {
  if (!(options.clearance > 0) || !(options.lift > 0) || !(options.upright > 0) ||
      !(options.volume_epsilon > 0))
    throw Error(ErrorCode::InvalidArgument,
                "clearance, lift, upright and the epsilon of volumes are to be above 0");
  const auto geometry = std::make_shared<Geometry>(std::move(world), options);
  struct Entry {
    const char* name;
    std::size_t arguments;
    plan::Answer (*function)(Geometry&, const plan::Question&);
    bool refuses_early = false;
    std::size_t more = 0;  ///< arguments that may be left out, the robot
  };
  constexpr Entry kEntries[] = {{"reach", 2, reach, true},
                                {"grasp", 3, grasp},
                                {"place", 3, place},
                                {"transfer", 4, transfer, true},
                                {"fetch", 3, fetch, true},
                                {"put", 4, put},
                                {"putUpright", 4, put_upright},
                                {"lift", 2, lift},
                                {"join", 4, join},
                                {"push", 4, push},
                                {"handOver", 3, hand_over},
                                {"wander", 1, wander},
                                {"release", 3, release},
                                {"move", 2, move},
                                {"inside", 2, is_inside},
                                {"collides", 2, collides},
                                {"satisfy", 2, satisfy},
                                {"mate", 5, mate},
                                {"isReachable", 2, is_reachable},
                                {"graspMotionCollides", 2, grasp_motion_collides, false, 1},
                                {"sweptCollides", 3, swept_collides},
                                {"sweptVolume", 2, swept_volume},
                                {"pathVolume", 2, path_volume},
                                {"reachVolume", 2, reach_volume, true},
                                {"graspVolume", 2, grasp_volume},
                                {"occupiedVolume", 1, occupied_volume},
                                {"volumeCollides", 2, volume_collides},
                                {"volumesCollide", 2, volumes_collide},
                                {"volumeInside", 2, volume_inside},
                                {"follow", 2, follow}};
  plan::ExternalBindings out;
  for (const Entry& entry : kEntries) {
    plan::ExternalBinding& binding = out[entry.name];
    binding = [geometry, entry](const plan::Question& question) {
      const std::size_t given = question.arguments.size();
      if (given < entry.arguments || given > entry.arguments + entry.more)
        throw Error(
            ErrorCode::InvalidInput,
            std::string(entry.name) + " takes " + std::to_string(entry.arguments) +
                (entry.more > 0 ? " or " + std::to_string(entry.arguments + entry.more) : "") +
                " arguments in the library of the scene");
      return entry.function(*geometry, question);
    };
    if (entry.refuses_early) binding.refuse_early();
  }
  return out;
}

}  // namespace kaboum::manipulation
