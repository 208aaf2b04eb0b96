// Robots: reading them, and certified sets of their links.

#include "robot.h"

#include <kaboum/certify/link_verdict.h>

#include "convex_set.h"
#include "mesh.h"
#include "running.h"
#include "set_options.h"

namespace kaboum::python {
namespace {

py::dict joint_dict(const robot::Robot& robot, std::size_t index) {
  const robot::Joint& joint = robot.joints[index];
  py::dict out;
  out["name"] = joint.name;
  out["type"] = joint.type == robot::JointType::Fixed      ? "fixed"
                : joint.type == robot::JointType::Revolute ? "revolute"
                                                           : "prismatic";
  out["parent"] = robot.links[joint.parent].name;
  out["child"] = robot.links[index + 1].name;
  return out;
}

py::list limits_of(const robot::Robot& robot) {
  py::list out;
  for (const robot::Variable& v : robot.variables) out.append(py::make_tuple(v.lower, v.upper));
  return out;
}

std::vector<std::string> names_of(const std::vector<robot::Link>& links) {
  std::vector<std::string> out;
  for (const robot::Link& link : links) out.push_back(link.name);
  return out;
}

void bind_robot(py::module_& module) {
  py::class_<RobotValue>(module, "Robot",
                         "A robot as read from its file: a tree of links. It never changes.")
      .def_property_readonly("name", [](const RobotValue& r) { return r.file->robot.name; })
      .def_property_readonly(
          "path", [](const RobotValue& r) { return r.file->path.string(); }, "Of its file.")
      .def_property_readonly(
          "sha256", [](const RobotValue& r) { return r.file->sha256; }, "Of its file.")
      .def_property_readonly(
          "links", [](const RobotValue& r) { return names_of(r.file->robot.links); },
          "Names, parents first.")
      .def_property_readonly(
          "joints",
          [](const RobotValue& r) {
            py::list out;
            for (std::size_t i = 0; i < r.file->robot.joints.size(); ++i)
              out.append(joint_dict(r.file->robot, i));
            return out;
          },
          "Dicts of 'name', 'type', 'parent' and 'child'.")
      .def_property_readonly(
          "variables",
          [](const RobotValue& r) {
            std::vector<std::string> out;
            for (const robot::Variable& v : r.file->robot.variables) out.push_back(v.name);
            return out;
          },
          "Names of the joints that move freely: what the columns of a path are.")
      .def_property_readonly(
          "limits", [](const RobotValue& r) { return limits_of(r.file->robot); },
          "(lower, upper) of each variable; None where there is none. [rad or length]")
      .def("__repr__", [](const RobotValue& r) {
        return "<kaboum.Robot '" + r.file->robot.name + "' of " +
               std::to_string(r.file->robot.links.size()) + " links>";
      });
}

/// A CertifiedRobot, and the robot that it is of.
struct CertifiedValue {
  certify::CertifiedRobot made;
  std::shared_ptr<const robot::RobotFile> file;
};

void bind_certified(py::module_& module) {
  using Value = CertifiedValue;
  py::class_<Value>(module, "CertifiedRobot",
                    R"(Convex sets of a robot's links, decided exactly to hold their shapes.)")
      .def_property_readonly(
          "links",
          [](const Value& r) {
            py::dict out;
            for (const certify::CertifiedLink& link : r.made.links) {
              auto kept = std::make_shared<certify::CertifiedLink>(link);
              const std::string name = link.artefact().provenance.frame;
              out[py::str(name)] = SetValue{{kept, &kept->artefact()}};
            }
            return out;
          },
          "By its name, the ConvexSet of each link that has shapes, in its frame. [length]")
      .def_property_readonly(
          "verdicts",
          [](const Value& r) {
            py::list out;
            for (const certify::LinkVerdict& link : certify::verdicts(r.made))
              out.append(py::make_tuple(r.file->robot.links[link.link].name, name_of(link.outcome),
                                        link.sentence));
            return out;
          },
          "(link, verdict, sentence) of each link that has shapes: is every triangle of it inside? "
          "The verdict is 'held' if it is, as near as asked for; 'epsilon not reached' or 'work "
          "ended' if it is farther; 'kept' if a mesh of it could not be held.")
      .def_property_readonly(
          "distance", [](const Value& r) { return r.made.bodies.certificate().distance; },
          "Bound of how far a body reaches beyond its shape. [length]")
      .def("__repr__", [](const Value& r) {
        return "<kaboum.CertifiedRobot of " + std::to_string(r.made.links.size()) + " links>";
      });
}

CertifiedValue certify_robot(const py::object& robot, const py::object& epsilon,
                             std::optional<std::size_t> max_bodies,
                             std::size_t max_vertices_per_body, const std::string& effort,
                             const py::object& links, const std::string& geometry,
                             const py::object& package_path, const std::string& unit,
                             bool drop_sheets, bool partial, bool no_cache, int threads,
                             const py::object& progress) {
  const RobotValue value = robot_of(robot, "robot");
  certify::RobotRequest r;
  r.set.epsilon = length_of(epsilon, "epsilon");
  r.set.max_bodies = max_bodies;
  r.set.max_vertices = max_vertices_per_body;
  r.set.effort = value_of(kSetEfforts, effort, "effort");
  r.set.preparation.drop_sheets = drop_sheets;
  r.set.wrap.emplace().where_needed = true;
  r.set.unit = unit;
  r.partial = partial;
  r.shapes = {links_of(links), is_visual(geometry), packages_of(package_path)};
  Watch watch(progress);
  return run(threads, [&] {
    const certify::SetCache cache(certify::SetCache::default_folder());
    certify::RobotHooks hooks;
    hooks.progress = watch.hook();
    return CertifiedValue{
        certify::certify_robot(*value.file, r, no_cache ? nullptr : &cache, hooks), value.file};
  });
}

constexpr const char* kDoc =
    R"(Convex bodies that provably hold the shapes of a robot's links, as `bcd-decompose robot.urdf`.

Parameters
----------
robot : Robot or path
epsilon : float or str, optional
    No body's point is farther than this from its mesh: a length in the robot's unit, or a
    percentage of each mesh's diagonal. By default '1%'.
max_bodies : int, optional
    Of each mesh.
max_vertices_per_body : int
effort : str
    'fast', 'normal' or 'best'.
links : sequence of str, optional
    Only these.
geometry : str
    'collision' or 'visual'.
package_path : str or sequence of str
    Folders that package:// is looked up in.
partial : bool
    A mesh that cannot be held as asked for does not refuse the robot: it gets one body round a wrap
    of it, farther than epsilon; or none, and its link has no set. `verdicts` names the links.
unit, drop_sheets, no_cache, threads, progress
    As for `decompose`. Meshes that bound no solid are wrapped.

Raises
------
Error
    'invalid_argument' naming an unknown link; 'invalid_input' naming the link or file, with
    `partial` only where no link can be held.)";

}  // namespace

RobotValue robot_of(const py::object& value, const char* argument) {
  if (py::isinstance<RobotValue>(value)) return value.cast<RobotValue>();
  const auto path = path_of(value);
  if (!path)
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a kaboum.Robot, a str or an os.PathLike");
  return run(
      0, [&] { return RobotValue{std::make_shared<robot::RobotFile>(robot::read_robot(*path))}; });
}

std::vector<std::string> links_of(const py::object& links) {
  if (links.is_none()) return {};
  if (py::isinstance<py::str>(links)) return {links.cast<std::string>()};
  return links.cast<std::vector<std::string>>();
}

std::vector<std::string> packages_of(const py::object& packages) {
  if (packages.is_none()) return {};
  if (const auto one = path_of(packages)) return {*one};
  std::vector<std::string> out;
  for (const py::handle item : packages) {
    const auto path = path_of(py::reinterpret_borrow<py::object>(item));
    if (!path) throw Error(ErrorCode::InvalidArgument, "package_path must be folders' names");
    out.push_back(*path);
  }
  return out;
}

bool is_visual(const std::string& geometry) {
  static constexpr std::array<std::pair<const char*, bool>, 2> kNames{
      {{"collision", false}, {"visual", true}}};
  return value_of(kNames, geometry, "geometry");
}

void bind_robots(py::module_& module) {
  bind_robot(module);
  bind_certified(module);
  module.def(
      "read_robot", [](const py::object& path) { return robot_of(path, "path"); }, py::arg("path"),
      R"(Reads a robot: URDF, or the Robotics Library's rlkin and rlmdl.

Raises
------
Error
    'invalid_input' naming the line.)");
  module.def("certify_robot", &certify_robot, py::arg("robot"), py::kw_only(),
             py::arg("epsilon") = py::none(), py::arg("max_bodies") = py::none(),
             py::arg("max_vertices_per_body") = 64, py::arg("effort") = "normal",
             py::arg("links") = py::none(), py::arg("geometry") = "collision",
             py::arg("package_path") = py::tuple(), py::arg("unit") = "m",
             py::arg("drop_sheets") = false, py::arg("partial") = false,
             py::arg("no_cache") = false, py::arg("threads") = 0, py::arg("progress") = py::none(),
             kDoc);
}

}  // namespace kaboum::python
