// Inverse kinematics: kaboum.inverse_kinematics, as kaboum-ik.

#include <kaboum/kinematics/inverse_options.h>
#include <kaboum/robot/base_pose.h>
#include <pybind11/numpy.h>

#include <cmath>
#include <memory>

#include "request_options.h"
#include "robot.h"
#include "running.h"

namespace kaboum::python {
namespace {

/// An answer, and the arm that it is of.
struct InverseValue {
  std::shared_ptr<const kinematics::Arm> arm;
  std::vector<std::string> joints;
  kinematics::InverseAnswer answer;
};

py::array_t<double> rows_array(const std::vector<std::vector<double>>& rows, std::size_t columns) {
  py::array_t<double> out({rows.size(), columns});
  for (std::size_t i = 0; i < rows.size(); ++i)
    for (std::size_t k = 0; k < columns; ++k) out.mutable_at(i, k) = rows[i][k];
  return out;
}

std::vector<std::string> free_names(const InverseValue& value, unsigned free) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < value.joints.size(); ++i)
    if ((free >> i & 1U) != 0) names.push_back(value.joints[i]);
  return names;
}

py::array_t<double> solutions_of(const InverseValue& value) {
  std::vector<std::vector<double>> rows;
  for (const auto& row : value.answer.rows) rows.push_back(row.q);
  return rows_array(rows, value.joints.size());
}

py::list details_of(const InverseValue& value) {
  py::list out;
  for (const auto& row : value.answer.rows) {
    py::dict one;
    one["within_limits"] = row.within;
    one["singular"] = kinematics::singular_names(row.singular);
    one["free"] = free_names(value, row.free);
    one["position_error"] = row.error.position;
    one["rotation_error"] = row.error.rotation;
    out.append(one);
  }
  return out;
}

py::list families_of(const InverseValue& value) {
  py::list out;
  for (const auto& [family, pose] : value.answer.families) {
    py::dict one;
    std::vector<std::string> free;
    for (const std::size_t joint : family.free) free.push_back(value.joints[joint]);
    one["free"] = free;
    py::list ranges;
    for (std::size_t i = 0; i < family.ranges.size(); ++i) {
      const std::size_t joint = family.free.size() == 1 ? family.free.front() : family.free[i];
      ranges.append(
          py::make_tuple(value.joints[joint], family.ranges[i].lower, family.ranges[i].upper));
    }
    one["ranges"] = ranges;
    one["singular"] = kinematics::singular_names(family.singular);
    std::vector<std::vector<double>> rows;
    for (const kinematics::Solution& s : family.representatives)
      rows.emplace_back(s.q.begin(), s.q.begin() + static_cast<long>(value.joints.size()));
    one["representatives"] = rows_array(rows, value.joints.size());
    out.append(one);
  }
  return out;
}

InverseValue inverse_kinematics(const py::object& robot, const py::object& pose,
                                const std::optional<std::string>& tip,
                                const std::optional<std::string>& base, const py::object& pose_of,
                                const py::object& reference, const py::kwargs& keywords) {
  kinematics::InverseRequest request;
  const RunKeywords running = take_keywords("inverse_kinematics", kinematics::inverse_options(),
                                            keywords, request, Runs::Alone);
  if (pose.is_none() == pose_of.is_none())
    throw Error(ErrorCode::InvalidArgument, "give pose, or pose_of");
  const RobotValue value = robot_of(robot, "robot");
  const robot::Robot& model = value.file->robot;
  auto arm = std::make_shared<kinematics::Arm>(kinematics::arm_of(
      model, base.value_or(model.links.front().name), tip ? *tip : kinematics::only_tip(model)));
  InverseValue out{arm, {}, {}};
  for (const std::uint32_t v : arm->variables) out.joints.push_back(model.variables[v].name);
  const auto joints_of = [&](const py::object& given, const char* name) {
    std::vector<double> q = numbers_of(given, name);
    if (q.size() != out.joints.size())
      throw Error(
          ErrorCode::InvalidArgument,
          std::string(name) + " must have a value for each of " + robot::names_of(out.joints));
    return q;
  };
  request.target = pose_of.is_none() ? pose_from(pose)
                                     : kinematics::forward(*arm, joints_of(pose_of, "pose_of"));
  if (!reference.is_none()) request.reference = joints_of(reference, "reference");
  Watch watch(running.progress);
  request.progress = watch.hook();
  out.answer = run(0, [&] { return kinematics::find_configurations(*arm, request); });
  return out;
}

constexpr const char* kInverseKinematicsDoc =
    R"(The configurations with which a robot's chain reaches a pose, as `kaboum-ik`.

All of them, in closed form, for arms with a spherical wrist, with three parallel axes, or with five
axes; some, where further joints come before six such axes (a rail); else those that a numeric
search finds.

Parameters
----------
robot : Robot or path
pose : array, optional
    Of `tip` in the frame of `base`: x, y, z and roll, pitch, yaw; or and a quaternion x, y, z, w; or
    and the matrix of the rotation, row by row; or a 4 x 4 matrix.
tip : str, optional
    A link; by default the only one that no joint starts from.
base : str, optional
    A link above it; by default the robot's root.
pose_of : array, optional
    Instead of `pose`: the pose that these joint values reach.
reference : array, optional
    Whole turns nearest to it are chosen; the numeric search starts there.
{keywords}

Raises
------
Error
    'invalid_argument' naming the links that there are, or another number of values.)";

void bind_answer(py::module_& module) {
  py::class_<InverseValue>(module, "InverseKinematics",
                           "Configurations that reach a pose; true where there is one.")
      .def("__bool__", [](const InverseValue& v) { return !v.answer.rows.empty(); })
      .def("__len__", [](const InverseValue& v) { return v.answer.rows.size(); })
      .def_property_readonly(
          "joints", [](const InverseValue& v) { return v.joints; },
          "Names: what the columns of `solutions` are.")
      .def_property_readonly("solutions", &solutions_of,
                             "n x k float64, a row for each configuration. [rad or length]")
      .def_property_readonly("details", &details_of,
                             "A dict for each row: 'within_limits', "
                             "'singular', 'free' (joints that may have other "
                             "values), 'position_error', 'rotation_error'.")
      .def_property_readonly("families", &families_of,
                             "Dicts of configurations that hang together: "
                             "'free' joints, their 'ranges' (joint, from, "
                             "to), 'singular', and 'representatives', n x k, "
                             "which are among the solutions.")
      .def_property_readonly(
          "complete", [](const InverseValue& v) { return v.answer.incomplete.empty(); },
          "Whether there are no others, up to the accuracy of closed forms.")
      .def_property_readonly(
          "incomplete", [](const InverseValue& v) { return v.answer.incomplete; },
          "Why there may be others; else empty.")
      .def_property_readonly(
          "family",
          [](const InverseValue& v) -> py::object {
            if (!v.answer.form) return py::none();
            return py::str(kinematics::name_of(v.answer.form->family));
          },
          "The kind of arm that has a closed form, or None: the search was "
          "numeric.")
      .def("__repr__", [](const InverseValue& v) {
        return "<kaboum.InverseKinematics of " + std::to_string(v.answer.rows.size()) +
               " configurations>";
      });
}

}  // namespace

void bind_inverse_kinematics(py::module_& module) {
  bind_answer(module);
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string text =
      document("inverse_kinematics",
               "robot: object, pose: object = None, *, tip: object = None, base: object = None, "
               "pose_of: object = None, reference: object = None",
               keywords_of(kinematics::inverse_options()), "kaboum.InverseKinematics",
               kInverseKinematicsDoc, Runs::Alone);
  module.def("inverse_kinematics", &inverse_kinematics, py::arg("robot"),
             py::arg("pose") = py::none(), py::kw_only(), py::arg("tip") = py::none(),
             py::arg("base") = py::none(), py::arg("pose_of") = py::none(),
             py::arg("reference") = py::none(), text.c_str());
}

}  // namespace kaboum::python
