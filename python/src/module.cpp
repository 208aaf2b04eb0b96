// The module kaboum._kaboum, which python/kaboum/__init__.py hands on.

#include "bindings.h"

PYBIND11_MODULE(_kaboum, module) {
  using namespace kaboum::python;
  // Names in messages and pickles are those that users import.
  const py::object name = module.attr("__name__");
  module.attr("__name__") = "kaboum";
  module.attr("__version__") = KABOUM_VERSION;
  bind_errors(module);
  bind_meshes(module);
  bind_preparation(module);
  bind_decimation(module);
  bind_convex_sets(module);
  bind_distances(module);
  bind_robots(module);
  bind_robot_decimation(module);
  bind_sweeps(module);
  bind_verification(module);
  bind_sweep_verification(module);
  bind_robot_verification(module);
  bind_spheres(module);
  bind_planning(module);
  bind_inverse_kinematics(module);
  bind_wraps(module);
  bind_replay_and_cache(module);
  bind_scenes(module);
  bind_worlds(module);
  bind_batches(module);
  bind_pictures(module);
  bind_trimesh(module);
  bind_option_tables(module);
  module.attr("__name__") = name;
}
