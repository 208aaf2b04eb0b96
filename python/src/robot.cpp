// Robots: reading them, and certified sets of their links.

#include "robot.h"

#include <kaboum/certify/link_verdict.h>
#include <kaboum/certify/robot_budget.h>
#include <kaboum/certify/set_options.h>
#include <kaboum/page/robot_page.h>
#include <kaboum/page/set_page.h>
#include <kaboum/picture/bodies.h>
#include <kaboum/picture/png_file.h>
#include <kaboum/robot/shape_options.h>
#include <kaboum/robot_folder/certified_folder.h>
#include <kaboum/robot_folder/loaders.h>
#include <kaboum/scene/robot_pairs.h>

#include <chrono>

#include "convex_set.h"
#include "mesh.h"
#include "pictures.h"
#include "request_options.h"
#include "running.h"

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
  out.reserve(links.size());
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
      .def_property_readonly(
          "unmodelled", [](const RobotValue& r) { return r.file->robot.unmodelled; },
          "Joints that move in ways that are not modelled, such as ball joints, with their places; "
          "they stand still here. Shapes do not depend on them; motions of such a robot are "
          "refused.")
      .def_property_readonly(
          "notes", [](const RobotValue& r) { return r.file->robot.notes; },
          "Sentences on what was left out, with their places.")
      .def("__repr__", [](const RobotValue& r) {
        return "<kaboum.Robot '" + r.file->robot.name + "' of " +
               std::to_string(r.file->robot.links.size()) + " links>";
      });
}

std::vector<Keyword> certify_keywords() {
  return keywords_of(robot::held_shape_options()) + keywords_of(link_options());
}

CertifiedValue certify_robot(const py::object& robot, const py::object& epsilons,
                             const py::object& epsilon_map, std::optional<std::size_t> robot_bodies,
                             std::optional<std::size_t> robot_vertices, bool partial,
                             const py::kwargs& given) {
  py::dict keywords = given;
  certify::SetOptions options;
  std::set<std::string> stated = take_options(link_options(), keywords, options);
  if (!epsilon_map.is_none()) stated.insert(certify::kRegionsOption);
  certify::RobotRequest r;
  take_options(robot::held_shape_options(), keywords, r.shapes);
  const RunKeywords running = take_run_keywords(keywords);
  require_all_taken("certify_robot", keywords, certify_keywords());
  require_none(certify::contradiction(options, stated));
  const RobotValue value = robot_of(robot, "robot", robot::Motions::None);
  const bool has_budget = robot_bodies || robot_vertices;
  if (!has_budget) certify::be_of_robot(options);
  r.set = certify::request_of(options);
  r.partial = partial;
  r.epsilons = epsilons_of(epsilons);
  r.take(robot::bounds_of_links(*value.file, r.shapes, frame_regions_of(epsilon_map)));
  if (has_budget)
    for (const char* other : {"epsilon", "max-bodies", "max-total-vertices"})
      if (stated.contains(other))
        throw Error(ErrorCode::InvalidArgument,
                    with_underscores(other) + " means nothing beside a budget of the whole robot");
  Watch watch(running.progress);
  return run(running.threads, [&] {
    const certify::SetCache kept(certify::SetCache::default_folder());
    const certify::SetCache* cache = running.no_cache ? nullptr : &kept;
    certify::RobotHooks hooks;
    hooks.progress = watch.hook();
    if (has_budget)
      r.set.epsilon =
          certify::epsilon_within(*value.file, r, {robot_bodies, robot_vertices}, cache, hooks);
    std::vector<std::string> notes;
    hooks.note = [&](const std::string& file, const std::string& text) {
      notes.push_back(file + ": " + text);
    };
    std::vector<double> seconds;
    using Clock = std::chrono::steady_clock;
    hooks.made = [&, last = Clock::now()](const certify::CertifiedLinkMesh&) mutable {
      seconds.push_back(std::chrono::duration<double>(Clock::now() - last).count());
      last = Clock::now();
    };
    certify::CertifiedRobot made = certify::certify_robot(*value.file, r, cache, hooks);
    return CertifiedValue{std::move(made), value.file, std::move(notes),
                          std::make_shared<const certify::RobotRequest>(std::move(r)),
                          std::move(seconds)};
  });
}

py::dict write_robot(const CertifiedValue& robot, const py::object& folder,
                     const py::object& formats, const std::optional<std::string>& loader,
                     const std::optional<std::string>& mesh_prefix, bool srdf, bool no_cache,
                     const py::object& progress) {
  const auto place = path_of(folder);
  if (!place) throw Error(ErrorCode::InvalidArgument, "folder must be a str or an os.PathLike");
  const robot_folder::FolderOptions options =
      folder_options_of(*place, formats, loader, mesh_prefix);
  std::vector<std::string> notes;
  Watch watch(progress);
  const robot_folder::WrittenRobot written = run(0, [&] {
    std::vector<std::pair<std::string, std::string>> documents;
    if (srdf) {
      robot::require_modelled(*robot.file);
      const scene::RobotPairs pairs =
          scene::pairs_of(robot.file->robot, robot.made, [&] { watch("pairs of links"); });
      documents.emplace_back(".srdf", pairs.srdf);
    }
    watch("writing");
    std::optional<certify::CacheFolder> cache;
    if (!no_cache) cache.emplace(certify::CacheFolder::default_folder());
    return robot_folder::write_robot(*place, *robot.file, robot.made, options, documents,
                                     cache ? &*cache : nullptr,
                                     [&](const std::string& file, const std::string& text) {
                                       notes.push_back(file + ": " + text);
                                     });
  });
  return dict_of(written, notes);
}

constexpr const char* kRobotWriteDoc =
    R"(Writes the robot's folder, the same bytes as `bcd-decompose ROBOT -o FOLDER`.

It has the bodies of each mesh, a container for each link, and the robot's URDF with these bodies
instead of its shapes (docs/robots.md).

Parameters
----------
folder : str or path
    A new one, or one of an earlier result, whose files are replaced.
formats : str or sequence of str, optional
    'mjcf' and 'sdf', besides URDF.
loader : str, optional
    'moveit', 'mujoco', 'gazebo', 'bullet' or 'drake': sets formats, prefix and the bodies' format
    as the program needs them, where the other arguments do not. MuJoCo needs bodies of
    `min_thickness` 0.0001 m as well: `certify_robot` makes them.
mesh_prefix : str, optional
    Put before the new meshes' names, as in 'package://arm'; by default they are relative.
srdf : bool
    Also write pairs of links that need no check, for MoveIt. Refused where only some `links` were
    asked for.
no_cache : bool
    Write all files, also those that an earlier run has written just so.
progress
    As for `decimate`; of pairs of links.

Returns
-------
dict
    'documents': the files that hold the robot, the URDF first. 'links': the containers, 'stale':
    what is there of an earlier result, both relative to the folder. 'notes'.

Raises
------
Error
    'output_failed' where something else is in the folder's place; 'invalid_argument'.)";

void write_robot_preview(const CertifiedValue& robot, const py::object& file, double explode) {
  write_preview(
      file,
      [&] {
        const certify::SetRequest& set = robot.request->set;
        return page::page_of_robot(
            {robot.file->path.string(), set.unit, set.parameters(), remedy_of_python}, *robot.file,
            robot.made, certify::verdicts(robot.made));
      },
      [&] {
        return picture::encode_png(
            picture::draw_bodies(page::at_rest(robot.file->robot, robot.made.links), explode));
      });
}

void write_robot_page(const CertifiedValue& robot, const py::object& file) {
  write_preview(
      file,
      [&] {
        return page::to_html(
            {.robot = robot.file->robot.name,
             .source = robot.file->path.string(),
             .tool = "kaboum " KABOUM_VERSION " " + robot.request->parameters(),
             .unit = robot.request->set.unit,
             .notes = spelled(robot.notes),
             .links = page::page_links(*robot.file, robot.made, *robot.request, robot.seconds),
             .counts = page::counts_of(robot.made)});
      },
      {});
}

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
          "regions",
          [](const Value& r) {
            py::list out;
            for (const certify::RegionVerdict& one :
                 certify::region_verdicts(*r.file, r.request->regions, r.made.bodies)) {
              py::dict region;
              region["name"] = one.name;
              region["links"] = one.links;
              region["answer"] = one.held ? "verified" : "undecided";
              region["bound"] = one.epsilon;
              region["reached"] = one.reached;
              out.append(region);
            }
            return out;
          },
          "Dicts of the regions of `epsilon_map`, as `bcd-decompose` reports them.")
      .def_property_readonly(
          "distance", [](const Value& r) { return r.made.bodies.certificate().distance; },
          "Bound of how far a body reaches beyond its shape. [length]")
      .def_property_readonly("notes", notes_of(&Value::notes),
                             "What a user should know of the meshes.")
      .def("write", &write_robot, py::arg("folder"), py::kw_only(), py::arg("formats") = py::none(),
           py::arg("loader") = py::none(), py::arg("mesh_prefix") = py::none(),
           py::arg("srdf") = false, py::arg("no_cache") = false, py::arg("progress") = py::none(),
           kRobotWriteDoc)
      .def(
          "write_preview", &write_robot_preview, py::arg("file"), py::kw_only(),
          py::arg("explode") = picture::kExplode,
          R"(Writes a page (.html) that shows the bodies over the links' shapes, or a picture (.png) of the
bodies, at zero joint values, as `bcd-decompose ROBOT --preview`.

The picture has a second panel, with the bodies moved apart by the share `explode` of their distance
from the middle; 0: it has none.)")
      .def("write_page", &write_robot_page, py::arg("file"),
           "Writes a page (.html) with a row for each link: pictures, counts, verdict; as "
           "`bcd-decompose ROBOT --html-report`, without the files of a folder and the command "
           "that checks them.")
      .def("__repr__", [](const Value& r) {
        return "<kaboum.CertifiedRobot of " + std::to_string(r.made.links.size()) + " links>";
      });
}

constexpr const char* kRobotDoc =
    R"(Convex bodies that provably hold the shapes of a robot's links, as `bcd-decompose robot.urdf`.

Parameters
----------
robot : Robot or path
epsilons : dict, optional
    Of single links, by name: a length or a percentage, instead of `epsilon`.
epsilon_map : name of a file, or list of dict, optional
    Regions fixed in frames of links, or whole links, with an epsilon each, as `bcd-decompose ROBOT
    --epsilon-map` reads them, or its "regions" (docs/formats.md, "Regions of robots").
robot_bodies, robot_vertices : int, optional
    The most of all links together: the least epsilon, the same for all links, that allows it.
partial : bool
    A mesh that cannot be held as asked for does not refuse the robot: it gets one body round a wrap
    of it, farther than epsilon; or none, and its link has no set. `verdicts` names the links.
{keywords}

Raises
------
Error
    'invalid_argument' naming an unknown link; 'invalid_input' naming the link or file, with
    `partial` only where no link can be held.)";

/// Keywords that are no options of a set, in the signature.
constexpr const char* kRobotParameters =
    "robot: object, *, epsilons: object = None, epsilon_map: object = None, "
    "robot_bodies: object = None, robot_vertices: object = None, partial: bool = False";

RobotValue read_robot_file(const py::object& file, const py::object& xacro_args,
                           const py::object& package_path) {
  const auto path = path_of(file);
  if (!path || (xacro_args.is_none() && package_path.is_none()))
    return robot_of(file, "path", robot::Motions::None);
  const std::vector<std::string> arguments = names_given(xacro_args);
  std::vector<std::string> packages;
  if (const auto one = path_of(package_path)) {
    packages.push_back(*one);
  } else if (!package_path.is_none()) {
    for (const py::handle& folder : package_path) {
      const auto place = path_of(py::reinterpret_borrow<py::object>(folder));
      if (!place)
        throw Error(ErrorCode::InvalidArgument, "package_path must be a path or several of them");
      packages.push_back(*place);
    }
  }
  return run(0, [&] {
    return RobotValue{std::make_shared<robot::RobotFile>(
        robot::read_robot(*path, robot::Motions::None, arguments, packages))};
  });
}

}  // namespace

std::vector<Option<certify::SetOptions>> link_options() {
  std::vector<Option<certify::SetOptions>> out;
  for (const Option<certify::SetOptions>& option : certify::set_options())
    if (option.name != "bodies" && option.name != "direction" && option.name != "scale" &&
        option.name != "frame")
      out.push_back(option);
  return out;
}

RobotValue robot_of(const py::object& value, const char* argument, robot::Motions motions) {
  if (py::isinstance<RobotValue>(value)) {
    auto out = value.cast<RobotValue>();
    if (motions == robot::Motions::All) robot::require_modelled(*out.file);
    return out;
  }
  const auto path = path_of(value);
  if (!path)
    throw Error(ErrorCode::InvalidArgument,
                std::string(argument) + " must be a kaboum.Robot, a str or an os.PathLike");
  return run(0, [&] {
    return RobotValue{std::make_shared<robot::RobotFile>(robot::read_robot(*path, motions))};
  });
}

std::vector<std::string> names_given(const py::object& names) {
  if (names.is_none()) return {};
  if (py::isinstance<py::str>(names)) return {names.cast<std::string>()};
  try {
    return names.cast<std::vector<std::string>>();
  } catch (const py::cast_error&) {
    throw Error(ErrorCode::InvalidArgument, "names must be a str or a sequence of str");
  }
}

certify::LinkEpsilons epsilons_of(const py::object& given) {
  certify::LinkEpsilons out;
  if (given.is_none()) return out;
  if (!py::isinstance<py::dict>(given))
    throw Error(ErrorCode::InvalidArgument, "epsilons must be a dict of links and lengths");
  for (const auto& [link, epsilon] : given.cast<py::dict>()) {
    if (!py::isinstance<py::str>(link))
      throw Error(ErrorCode::InvalidArgument, "epsilons must be a dict of links and lengths");
    const auto name = link.cast<std::string>();
    const auto length = length_of(py::reinterpret_borrow<py::object>(epsilon),
                                  ("epsilons['" + name + "']").c_str());
    if (!length)
      throw Error(ErrorCode::InvalidArgument, "epsilons['" + name + "'] must be a length");
    out.emplace(name, length->in("m"));
  }
  return out;
}

robot_folder::FolderOptions folder_options_of(const std::string& folder, const py::object& formats,
                                              const std::optional<std::string>& loader,
                                              const std::optional<std::string>& mesh_prefix) {
  robot_folder::FolderOptions options;
  for (const std::string& format : names_given(formats)) {
    if (format == "mjcf")
      options.mjcf = true;
    else if (format == "sdf")
      options.sdf = true;
    else if (format == "urdf")
      options.urdf = true;
    else
      refuse_name("formats", format, {"urdf", "mjcf", "sdf"});
  }
  if (mesh_prefix) options.mesh_prefix = *mesh_prefix;
  if (!loader) return options;
  robot_folder::FolderOptions out = options;
  robot_folder::apply(robot_folder::loader_of(*loader), folder, out);
  if (!formats.is_none()) {
    out.mjcf = options.mjcf;
    out.sdf = options.sdf;
    out.urdf = options.urdf;
  }
  if (mesh_prefix) out.mesh_prefix = *mesh_prefix;
  return out;
}

py::dict dict_of(const robot_folder::WrittenRobot& written, const std::vector<std::string>& notes) {
  py::dict out;
  out["documents"] = written.documents;
  out["links"] = written.links;
  out["stale"] = written.stale;
  out["notes"] = notes;
  return out;
}

void bind_robots(py::module_& module) {
  bind_robot(module);
  bind_certified(module);
  module.def("read_robot", &read_robot_file, py::arg("path"), py::kw_only(),
             py::arg("xacro_args") = py::none(), py::arg("package_path") = py::none(),
             R"(Reads a robot: URDF, xacro, MJCF, SDF, or the Robotics Library's rlkin and rlmdl.

Parameters
----------
xacro_args : sequence of str, optional
    Arguments of a file called NAME.xacro, as in 'name:=left'.
package_path : path or sequence of paths, optional
    Packages, or folders that hold them, which $(find NAME) of xacro and included models of SDF
    name, besides those of the environment and the folders above the file.

Raises
------
Error
    'invalid_input' naming the line.)");
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string text = document("certify_robot", kRobotParameters, certify_keywords(),
                                    "kaboum.CertifiedRobot", kRobotDoc);
  module.def("certify_robot", &certify_robot, py::arg("robot"), py::kw_only(),
             py::arg("epsilons") = py::none(), py::arg("epsilon_map") = py::none(),
             py::arg("robot_bodies") = py::none(), py::arg("robot_vertices") = py::none(),
             py::arg("partial") = false, text.c_str());
}

}  // namespace kaboum::python
