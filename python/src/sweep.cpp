// Swept volumes: kaboum.sweep, as sweep-approx, and verify_sweep, as `bound-verify sweep`.

#include <kaboum/certify/sweep_options.h>
#include <kaboum/page/sweep_page.h>
#include <kaboum/page/sweep_picture.h>
#include <kaboum/robot/base_pose.h>
#include <kaboum/robot/path_file.h>
#include <kaboum/verify/robot_options.h>

#include "answers.h"
#include "convex_set.h"
#include "mesh.h"
#include "pictures.h"
#include "request_options.h"
#include "robot.h"
#include "running.h"

namespace kaboum::python {
namespace {

/// A file's path, or an array of waypoints x variables.
robot::Path path_from(const py::object& value, const robot::Robot& robot,
                      const robot::PathOptions& options, std::vector<std::string>& notes) {
  if (const auto file = path_of(value)) return robot::read_path(*file, robot, options, notes);
  const py::array given = array_from(value);
  if (!given) PyErr_Clear();
  if (given && given.ndim() == 2) require_doubles(given, "path");
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) PyErr_Clear();
  const std::size_t variables = robot.variables.size();
  if (!array || array.ndim() != 2 || static_cast<std::size_t>(array.shape(1)) != variables ||
      array.shape(0) == 0)
    throw Error(ErrorCode::InvalidArgument,
                "path must be the name of a file, or an array of waypoints x " +
                    std::to_string(variables) + " numbers, one for each of robot.variables");
  if (!options.fixed.empty())
    throw Error(ErrorCode::InvalidArgument, "joint is for paths in files, which may lack columns");
  robot::Path path;
  const double* q = array.data();
  for (py::ssize_t i = 0; i < array.shape(0); ++i, q += variables)
    path.emplace_back(q, q + variables);
  if (options.degrees) path = robot::from_degrees(std::move(path), robot);
  if (options.check_limits) robot::require_within_limits(path, robot, "path");
  return path;
}

/// What a set is swept by.
struct SweptBy {
  robot::RobotFile robot;
  certify::CertifiedBodies bodies;
  robot::Path path;
  std::string path_name;
};

struct SweptSet {
  certify::CertifiedSweep made;
  std::vector<std::string> notes;
  std::shared_ptr<const SweptBy> by = nullptr;

  [[nodiscard]] std::shared_ptr<const geom::ConvexSet> set() const {
    auto kept = std::make_shared<certify::CertifiedSweep>(made);
    return {kept, &kept->artefact()};
  }
};

const char* claim_of(const certify::SweepCertificate& c) {
  return c.motion == certify::MotionClaim::Decided  ? "decided"
         : c.motion == certify::MotionClaim::Proved ? "proved"
                                                    : "none";
}

void write_sweep_preview(const SweptSet& s, const py::object& file) {
  write_preview(
      file,
      [&] {
        const std::string summary =
            page::summary_of(s.made.certificate(), s.by->bodies.artefact().size());
        return page::page_of_sweep({s.by->robot.path.string(), s.by->path_name,
                                    remedy_of_python(summary), remedy_of_python},
                                   s.by->robot, s.by->bodies, s.by->path, s.made);
      },
      [&] {
        return page::picture_of_sweep(s.by->robot.robot, s.by->bodies.artefact(), s.by->path,
                                      s.made);
      });
}

void bind_sweep_class(py::module_& module) {
  py::class_<SweptSet>(
      module, "SweptSet",
      R"(Convex bodies that, enlarged by `margin`, hold a robot at every instant of a path.)")
      .def_property_readonly(
          "set", [](const SweptSet& s) { return SetValue{s.set()}; },
          "The ConvexSet; the radius of each body is `margin`.")
      .def_property_readonly(
          "bodies", [](const SweptSet& s) { return bodies_of(s.set()); },
          "A list of `Mesh`; nothing is copied.")
      .def_property_readonly(
          "margin", [](const SweptSet& s) { return s.made.certificate().margin; },
          "By which the bodies have to be enlarged. [length]")
      .def_property_readonly(
          "certificate", [](const SweptSet& s) { return dict_of(certify::certificate_of(s.made)); },
          kCertificateDoc)
      .def_property_readonly(
          "claim", [](const SweptSet& s) { return claim_of(s.made.certificate()); },
          "'decided', exactly and from the bodies; 'proved', by the steps; "
          "'none', of bound 'baginski'.")
      .def_property_readonly(
          "reach", [](const SweptSet& s) { return s.made.certificate().excess; },
          "No point of the set is farther from what the robot's bodies sweep. "
          "[length]")
      .def_property_readonly(
          "bodies_distance", [](const SweptSet& s) { return s.made.certificate().bodies_distance; },
          "Nor are the robot's bodies farther from its shapes. [length]")
      .def_property_readonly("notes", notes_of(&SweptSet::notes),
                             "What a user should know of the input.")
      .def_property_readonly(
          "bytes",
          [](const SweptSet& s) { return py::bytes(s.made.bytes().data(), s.made.bytes().size()); },
          "The certified container (.glb).")
      .def(
          "write",
          [](const SweptSet& s, const py::object& path) {
            write_set(s.made.artefact(), s.made.bytes(), path);
          },
          py::arg("path"), "As CertifiedSet.write.")
      .def("write_preview", &write_sweep_preview, py::arg("file"),
           "Writes a page (.html) that shows the bodies over the robot on its path, or a picture "
           "(.png) of the path's ends and the bodies, as `sweep-approx --preview`.")
      .def("__len__", [](const SweptSet& s) { return s.made.artefact().bodies.size(); })
      .def("__repr__", [](const SweptSet& s) {
        return "<kaboum.SweptSet of " + std::to_string(s.made.artefact().bodies.size()) +
               " bodies>";
      });
}

/// The robot where it is to stand.
robot::RobotFile placed_robot(const RobotValue& value, certify::SweptSetOptions& options) {
  robot::RobotFile out = *value.file;
  if (options.base_pose.empty()) return out;
  const robot::Transform base = robot::parse_pose(options.base_pose, "base_pose");
  certify::place(out.robot, base, options);
  return out;
}

SweptSet sweep_path(const py::object& robot, const py::object& path, bool verify,
                    const py::kwargs& given) {
  py::dict keywords = given;
  certify::SweptSetOptions options;
  take_options(certify::swept_set_options(), keywords, options);
  const RunKeywords running = take_run_keywords(keywords);
  require_all_taken("sweep", keywords, keywords_of(certify::swept_set_options()));
  bring_lengths_into("m", certify::swept_set_options(), options);
  robot::RobotFile placed = placed_robot(robot_of(robot, "robot"), options);
  SweptSet out;
  robot::Path waypoints = path_from(
      path, placed.robot,
      {!options.ignore_limits, options.degrees, numbers_by_name(options.joints)}, out.notes);
  certify::SweepRequest r = certify::sweep_request_of(options);
  r.decide_motion = verify;
  const certify::RobotRequest bodies = certify::bodies_request_of(options);
  const std::string path_name = path_of(path).value_or("the path");
  Watch watch(running.progress);
  r.search.progress = watch.hook();
  return run(running.threads, [&] {
    const certify::SetCache cache(certify::SetCache::default_folder());
    certify::RobotHooks hooks;
    hooks.progress = watch.hook();
    hooks.note = [&](const std::string& file, const std::string& text) {
      out.notes.push_back(file + ": " + text);
    };
    certify::CertifiedBodies made =
        certify::certify_bodies(placed, bodies, running.no_cache ? nullptr : &cache, hooks);
    auto swept = certify::certify_sweep(placed, made, waypoints, r);
    if (!swept) throw certify::TooCoarse(placed.path.string());
    out.made = std::move(*swept);
    out.by = std::make_shared<const SweptBy>(std::move(placed), std::move(made),
                                             std::move(waypoints), path_name);
    return out;
  });
}

/// Bodies that are to hold a motion.
std::shared_ptr<const geom::ConvexSet> swept_of(const py::object& swept,
                                                const std::vector<std::string>& packages,
                                                std::vector<std::string>& notes) {
  if (py::isinstance<SweptSet>(swept)) return swept.cast<SweptSet>().set();
  if (const auto path = path_of(swept)) {
    verify::SweptBodies read = verify::read_swept_bodies(*path, {}, packages);
    for (const std::string& note : read.notes) notes.push_back(*path + ": " + note);
    return std::make_shared<geom::ConvexSet>(std::move(read.set));
  }
  if (const auto set = set_of(swept)) return set;
  throw Error(ErrorCode::InvalidArgument, "swept must be a SweptSet or ConvexSet, or its file");
}

py::dict claims_of(const verify::MotionVerdict& found, const verify::MotionShapes& shapes,
                   verify::Claims deciding) {
  py::dict out;
  out["convex"] = dict_of(found.claims.convex);
  out["surface"] = dict_of(found.claims.surface);
  if (deciding == verify::Claims::All) out["solid"] = dict_of(found.claims.solid);
  if (const auto& exact = found.exact) {
    py::dict claim = dict_of(exact->points);
    claim["configurations"] = exact->configurations;
    if (exact->points.outside > 0) {
      claim["shape"] = shapes.exact[exact->shape].name;
      claim["segment"] = exact->segment;
      claim["s"] = exact->s;
    }
    out["exact_points"] = claim;
  } else if (shapes.cad) {
    out["exact_points"] = exact_points_not_looked_at();
  }
  return out;
}

Verdict verify_sweep(const py::object& robot, const py::object& path, const py::object& swept,
                     const py::kwargs& given) {
  verify::MotionVerdictOptions options;
  const RunKeywords running = take_keywords("verify_sweep", verify::motion_verdict_options(), given,
                                            options, Runs::Threads);
  require_none(contradiction(options));
  robot::RobotFile placed = *robot_of(robot, "robot").file;
  if (!options.base_pose.empty())
    placed.robot = robot::placed(placed.robot, robot::parse_pose(options.base_pose, "base_pose"));
  Verdict out;
  const robot::Path waypoints = path_from(path, placed.robot, options.reading, out.notes);
  const auto set = swept_of(swept, options.shapes.choice.packages, out.notes);
  Watch watch(running.progress);
  verify::MotionShapes shapes;
  const verify::MotionVerdict found = run(running.threads, [&] {
    shapes = verify::read_motion_shapes(placed, options.shapes);
    return verify::decide({placed.robot, shapes, waypoints, *set, options.claims, options.gap,
                           options.max_cells, watch.hook()});
  });
  for (const auto& more : {shapes.notes, shapes.mesh_notes.lines()})
    out.notes.insert(out.notes.end(), more.begin(), more.end());
  out.answer = found.answer;
  out.claims = claims_of(found, shapes, options.claims);
  return out;
}

constexpr const char* kSweepDoc =
    R"(Bounds the volume that a robot sweeps along a path by convex bodies.

Options and defaults are those of sweep-approx (docs/algorithms/swept-volumes.md).

Parameters
----------
robot : Robot or path
path : path or array
    A file (.csv, .json), or waypoints x robot.variables, joined linearly. [rad or length]
verify : bool
    Have the verifier decide the motion from the bodies as well, which takes longer.
{keywords}

Raises
------
Error
    'invalid_input' naming joint, waypoint or file; 'invalid_argument' when no step is short
    enough.)";

constexpr const char* kVerifyDoc =
    R"(Decides whether a set holds a robot at every instant of a path, as `bound-verify sweep`.

Parameters
----------
robot : Robot or path
path : path or array
    As for `sweep`.
swept : SweptSet, ConvexSet, name of a file or folder, or list of meshes
    A file may be a URDF as sweep-approx writes it.
{keywords}

Raises
------
Error
    As `sweep`.)";

}  // namespace

void bind_sweeps(py::module_& module) {
  bind_sweep_class(module);
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  std::string text =
      document("sweep", "robot: object, path: object", keywords_of(certify::swept_set_options()),
               "kaboum.SweptSet", kSweepDoc);
  text.replace(text.find("*,"), 2, "*, verify: bool = False,");
  module.def("sweep", &sweep_path, py::arg("robot"), py::arg("path"), py::kw_only(),
             py::arg("verify") = false, text.c_str());
}

void bind_sweep_verification(py::module_& module) {
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string text = document("verify_sweep", "robot: object, path: object, swept: object",
                                    keywords_of(verify::motion_verdict_options()), "kaboum.Verdict",
                                    kVerifyDoc, Runs::Threads);
  module.def("verify_sweep", &verify_sweep, py::arg("robot"), py::arg("path"), py::arg("swept"),
             text.c_str());
}

}  // namespace kaboum::python
