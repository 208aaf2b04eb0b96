#pragma once

#include "geometric_state.h"

namespace kaboum::manipulation {

/// What the external functions do, by their names (externals.h). Arguments are as many as declared
/// there. @throws Error{InvalidInput} for names and words that the scene does not know.
plan::Answer reach(Geometry& geometry, const plan::Question& question);
plan::Answer grasp(Geometry& geometry, const plan::Question& question);
plan::Answer place(Geometry& geometry, const plan::Question& question);
plan::Answer transfer(Geometry& geometry, const plan::Question& question);
plan::Answer fetch(Geometry& geometry, const plan::Question& question);
plan::Answer put(Geometry& geometry, const plan::Question& question);
plan::Answer put_upright(Geometry& geometry, const plan::Question& question);
plan::Answer lift(Geometry& geometry, const plan::Question& question);
plan::Answer join(Geometry& geometry, const plan::Question& question);
plan::Answer push(Geometry& geometry, const plan::Question& question);
plan::Answer hand_over(Geometry& geometry, const plan::Question& question);
plan::Answer wander(Geometry& geometry, const plan::Question& question);
plan::Answer release(Geometry& geometry, const plan::Question& question);
plan::Answer move(Geometry& geometry, const plan::Question& question);
plan::Answer is_inside(Geometry& geometry, const plan::Question& question);
plan::Answer collides(Geometry& geometry, const plan::Question& question);
plan::Answer satisfy(Geometry& geometry, const plan::Question& question);
plan::Answer mate(Geometry& geometry, const plan::Question& question);
plan::Answer is_reachable(Geometry& geometry, const plan::Question& question);
plan::Answer grasp_motion_collides(Geometry& geometry, const plan::Question& question);
plan::Answer swept_collides(Geometry& geometry, const plan::Question& question);
plan::Answer swept_volume(Geometry& geometry, const plan::Question& question);
plan::Answer path_volume(Geometry& geometry, const plan::Question& question);
plan::Answer reach_volume(Geometry& geometry, const plan::Question& question);
plan::Answer grasp_volume(Geometry& geometry, const plan::Question& question);
plan::Answer occupied_volume(Geometry& geometry, const plan::Question& question);
plan::Answer volume_collides(Geometry& geometry, const plan::Question& question);
plan::Answer volumes_collide(Geometry& geometry, const plan::Question& question);
plan::Answer volume_inside(Geometry& geometry, const plan::Question& question);
plan::Answer follow(Geometry& geometry, const plan::Question& question);

}  // namespace kaboum::manipulation
