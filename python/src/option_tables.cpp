// The tables of options, for the typed stub, the reference page and tests of both.

#include <kaboum/certify/mesh_options.h>
#include <kaboum/certify/set_options.h>
#include <kaboum/certify/sweep_options.h>
#include <kaboum/distance/compare_options.h>
#include <kaboum/engines/engine_options.h>
#include <kaboum/execution/task_options.h>
#include <kaboum/kinematics/inverse_options.h>
#include <kaboum/motion/keep_options.h>
#include <kaboum/motion/path_options.h>
#include <kaboum/motion/trajectory_options.h>
#include <kaboum/picture/panels.h>
#include <kaboum/plan/solve_options.h>
#include <kaboum/robot/shape_options.h>
#include <kaboum/scene/derived_features.h>
#include <kaboum/scene/scene_options.h>
#include <kaboum/verify/robot_options.h>
#include <kaboum/world/check_options.h>
#include <kaboum/world/margins.h>

#include "preparation.h"
#include "request_options.h"
#include "robot.h"

namespace kaboum::python {

void bind_option_tables(py::module_& module) {
  module.def(
      "_option_tables",
      [] {
        py::dict out;
        out["prepare"] = table_of(keywords_of(repair_options()));
        out["wrap"] = table_of(keywords_of(certify::wrap_options()));
        out["decimate"] = table_of(keywords_of(certify::mesh_options()));
        out["decompose"] = table_of(keywords_of(certify::set_options()));
        out["decimate_robot"] = table_of(keywords_of(link_mesh_options()));
        out["certify_robot"] = table_of(keywords_of(link_options()));
        out["shapes"] = table_of(keywords_of(robot::shape_options()));
        out["held_shapes"] = table_of(keywords_of(robot::held_shape_options()));
        out["draw"] = table_of(keywords_of(picture::panel_options()));
        out["sweep"] = table_of(keywords_of(certify::swept_set_options()));
        out["hausdorff"] = table_of(keywords_of(distance::compare_options()));
        out["verify_mesh"] = table_of(keywords_of(verify::mesh_verdict_options()));
        out["verify_cover"] = table_of(keywords_of(verify::cover_verdict_options()));
        out["verify_robot"] = table_of(keywords_of(verify::robot_verdict_options()));
        out["verify_sweep"] = table_of(keywords_of(verify::motion_verdict_options()));
        out["margins"] = table_of(keywords_of(world::margin_options()));
        out["check"] = table_of(keywords_of(world::state_options()));
        out["engines"] = table_of(keywords_of(engines::engine_options()));
        out["check_motion"] = table_of(keywords_of(world::motion_options()));
        out["find_path"] = table_of(keywords_of(motion::path_options()));
        out["keep"] = table_of(keywords_of(motion::keep_options()));
        out["trajectory"] = table_of(keywords_of(motion::trajectory_options()));
        out["link_pairs"] = table_of(keywords_of(world::pair_options()));
        out["inverse_kinematics"] = table_of(keywords_of(kinematics::inverse_options()));
        out["solve"] = table_of(keywords_of(plan::solve_options()));
        out["task"] = table_of(keywords_of(execution::task_options()));
        out["plan_page"] = table_of(keywords_of(execution::page_options()));
        out["run_plan"] = table_of(keywords_of(execution::run_options()));
        out["update_scene"] = table_of(keywords_of(scene::update_options()));
        out["add_grasps"] = table_of(keywords_of(scene::grasp_options()));
        out["add_places"] = table_of(keywords_of(scene::place_options()));
        out["make_scene"] = table_of(keywords_of(scene::scene_options()));
        return out;
      },
      "By function, its options as the library describes them: a list of dicts.");
}

}  // namespace kaboum::python
