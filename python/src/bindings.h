#pragma once

#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

/// The Python module: each file binds one part of the libraries. Whatever can take time runs
/// without the interpreter's lock.
namespace kaboum::python {

namespace py = pybind11;

void bind_batches(py::module_& module);
void bind_errors(py::module_& module);
void bind_meshes(py::module_& module);
void bind_preparation(py::module_& module);
void bind_decimation(py::module_& module);
void bind_convex_sets(py::module_& module);
void bind_distances(py::module_& module);
void bind_robots(py::module_& module);
void bind_robot_decimation(py::module_& module);
void bind_sweeps(py::module_& module);
void bind_verification(py::module_& module);
void bind_sweep_verification(py::module_& module);
void bind_robot_verification(py::module_& module);
void bind_spheres(py::module_& module);
void bind_pictures(py::module_& module);
void bind_planning(py::module_& module);
void bind_inverse_kinematics(py::module_& module);
void bind_wraps(py::module_& module);
void bind_replay_and_cache(py::module_& module);
void bind_scenes(py::module_& module);
void bind_worlds(py::module_& module);
void bind_trimesh(py::module_& module);
void bind_option_tables(py::module_& module);

}  // namespace kaboum::python
