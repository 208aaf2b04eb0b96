// Robots with simplified meshes: kaboum.decimate_robot, as bmesh-decimate on a robot.

#include <kaboum/certify/link_verdict.h>
#include <kaboum/page/robot_page.h>
#include <kaboum/robot/shape_options.h>
#include <kaboum/robot_folder/enclosed_folder.h>

#include <algorithm>

#include "answers.h"
#include "mesh.h"
#include "pictures.h"
#include "request_options.h"
#include "robot.h"
#include "running.h"

namespace kaboum::python {
namespace {

/// Enclosing meshes of a robot's links, and what they were asked to be.
struct EnclosedValue {
  std::shared_ptr<const certify::LinkEnclosures> made;
  std::shared_ptr<const robot::RobotFile> file;
  certify::LinkEnclosuresRequest request;
  io::Format format = io::Format::Stl;
  std::vector<std::string> notes;
};

std::vector<Keyword> decimate_keywords() {
  return keywords_of(robot::held_shape_options()) + keywords_of(link_mesh_options());
}

EnclosedValue decimate_robot(const py::object& robot, const py::object& epsilons,
                             const std::optional<std::string>& output_format, bool partial,
                             const py::kwargs& given) {
  py::dict keywords = given;
  certify::MeshOptions options;
  const auto known = link_mesh_options();
  const std::set<std::string> stated = take_options(known, keywords, options);
  robot::ShapeChoice shapes;
  take_options(robot::held_shape_options(), keywords, shapes);
  const RunKeywords running = take_run_keywords(keywords);
  require_all_taken("decimate_robot", keywords, decimate_keywords());
  require_none(certify::contradiction(options, stated));
  bring_lengths_into("m", known, options);
  std::optional<io::Format> format;
  if (output_format) format = format_of(output_format, "output_format");
  options.request.comment = "bmesh-decimate " KABOUM_VERSION;
  const RobotValue value = robot_of(robot, "robot", robot::Motions::None);
  certify::LinkEnclosuresRequest request{
      certify::link_request_of(options, format), shapes, {}, epsilons_of(epsilons)};
  request.partial = partial;
  EnclosedValue out{nullptr, value.file, request, format.value_or(io::Format::Stl), {}};
  Watch watch(running.progress);
  return run(running.threads, [&] {
    const certify::CacheFolder kept(certify::CacheFolder::default_folder());
    out.made = std::make_shared<const certify::LinkEnclosures>(certify::enclose_links(
        *value.file, request, running.no_cache ? nullptr : &kept, watch.hook()));
    for (const certify::EnclosedLinkMesh& mesh : out.made->meshes) {
      const std::string file = mesh.mesh.file.string();
      if (!mesh.flaw.empty()) {
        out.notes.push_back(mesh.flaw);
        continue;
      }
      for (const std::string& text : mesh.made.read_notes) out.notes.push_back(file + ": " + text);
      for (const std::string& text : mesh.made.enclosure.certificate().notes)
        out.notes.push_back(file + ": " + text);
    }
    return out;
  });
}

py::list meshes_of(const EnclosedValue& r) {
  const py::object loads = py::module_::import("json").attr("loads");
  py::list out;
  for (const certify::EnclosedLinkMesh& mesh : r.made->meshes) {
    py::dict one;
    one["file"] = mesh.mesh.file.string();
    one["flaw"] = mesh.flaw;
    if (mesh.flaw.empty()) {
      one["mesh"] = MeshValue{{r.made, &mesh.made.enclosure.artefact()}};
      one["certificate"] = dict_of(certify::certificate_of(mesh.made.enclosure));
      one["report"] = loads(certify::to_json(mesh.made.enclosure));
      one["cached"] = mesh.made.cached;
    }
    out.append(one);
  }
  return out;
}

py::dict write(const EnclosedValue& r, const py::object& folder, const py::object& formats,
               const std::optional<std::string>& loader,
               const std::optional<std::string>& mesh_prefix, bool no_cache) {
  const auto place = path_of(folder);
  if (!place) throw Error(ErrorCode::InvalidArgument, "folder must be a str or an os.PathLike");
  robot_folder::FolderOptions options = folder_options_of(*place, formats, loader, mesh_prefix);
  const std::string made = r.format == io::Format::Stl ? "stl" : "obj";
  if (options.bodies != made && loader)
    throw Error(ErrorCode::InvalidArgument, "loader '" + *loader + "' reads " + options.bodies +
                                                ": decimate_robot with output_format '" +
                                                options.bodies + "'");
  options.shapes = r.request.shapes;
  std::vector<std::string> notes;
  const robot_folder::WrittenRobot written = run(0, [&] {
    std::optional<certify::CacheFolder> cache;
    if (!no_cache) cache.emplace(certify::CacheFolder::default_folder());
    return robot_folder::write_robot(*place, *r.file, *r.made, options, r.format,
                                     cache ? &*cache : nullptr,
                                     [&](const std::string& file, const std::string& text) {
                                       notes.push_back(file + ": " + text);
                                     });
  });
  return dict_of(written, notes);
}

double distance_of(const EnclosedValue& r) {
  double most = 0;
  for (const certify::EnclosedLinkMesh& mesh : r.made->meshes)
    if (mesh.flaw.empty())
      most = std::max(most, mesh.made.enclosure.certificate().distance_upper *
                                mesh.mesh.scale.cwiseAbs().maxCoeff());
  return most;
}

void write_page(const EnclosedValue& r, const py::object& file) {
  write_preview(file,
                [&] {
                  return page::to_html({.robot = r.file->robot.name,
                                        .source = r.file->path.string(),
                                        .tool = "kaboum " KABOUM_VERSION,
                                        .unit = "the robot's unit",
                                        .notes = r.notes,
                                        .links = page::page_links(*r.file, *r.made, r.request),
                                        .counts = page::counts_of(*r.made),
                                        .made = "meshes"});
                },
                {});
}

constexpr const char* kRobotDecimationDoc =
    R"(Simplifies the meshes of a robot's links so that the results provably enclose them, as `bmesh-decimate robot.urdf`.

Parameters
----------
robot : Robot or path
epsilons
    As for `certify_robot`.
output_format : str, optional
    'stl' or 'obj'; by default STL, and OBJ for a mesh that float32 is too coarse for.
partial : bool
    A mesh that cannot be enclosed does not refuse the robot: it stays as it is. `verdicts` names the
    links.
{keywords}

Raises
------
Error
    'invalid_argument' naming an unknown link; 'invalid_input' naming the link or file, with
    `partial` only where no mesh can be enclosed.)";

constexpr const char* kRobotDecimationWriteDoc =
    R"(Writes the robot's folder, the same bytes as `bmesh-decimate ROBOT -o FOLDER`.

Parameters
----------
folder, formats, loader, mesh_prefix, no_cache
    As of `CertifiedRobot.write`.

Returns
-------
dict
    As of `CertifiedRobot.write`.)";

/// Keywords that are no options of a mesh, in the signature.
constexpr const char* kRobotDecimationParameters =
    "robot: object, *, epsilons: object = None, output_format: object = None, partial: bool = "
    "False";

void bind_robot_decimation_class(py::module_& module) {
  using Value = EnclosedValue;
  py::class_<Value>(module, "EnclosedRobot",
                    "Meshes round those of a robot's links; true if every triangle of all links is "
                    "inside, as near as asked for.")
      .def("__bool__",
           [](const Value& r) {
             return certify::outcome_of(certify::verdicts(*r.made)) == certify::Outcome::Held;
           })
      .def_property_readonly(
          "meshes", &meshes_of,
          "A dict for each distinct mesh and scale: 'file', 'flaw' (why there is "
          "none round it, else ''), 'mesh' (in the file's frame and unit), "
          "'report' and 'cached'.")
      .def_property_readonly(
          "verdicts",
          [](const Value& r) {
            py::list out;
            for (const certify::LinkVerdict& link : certify::verdicts(*r.made))
              out.append(py::make_tuple(r.file->robot.links[link.link].name,
                                        certify::name_of(link.outcome), link.sentence));
            return out;
          },
          "(link, verdict, sentence) of each link that has shapes, as of `CertifiedRobot`; also "
          "'undecided' and 'not held'.")
      .def_property_readonly("distance", &distance_of,
                             "Bound of how far a mesh reaches beyond its original. [length]")
      .def_property_readonly("notes", notes_of(&Value::notes),
                             "What a user should know of the meshes.")
      .def("write", &write, py::arg("folder"), py::kw_only(), py::arg("formats") = py::none(),
           py::arg("loader") = py::none(), py::arg("mesh_prefix") = py::none(),
           py::arg("no_cache") = false, kRobotDecimationWriteDoc)
      .def("write_page", &write_page, py::arg("file"),
           "Writes a page (.html) with a row for each link: pictures, counts, verdict; as "
           "`bmesh-decimate ROBOT --html-report`, without the files of a folder and the command "
           "that checks them.")
      .def("__repr__", [](const Value& r) {
        return "<kaboum.EnclosedRobot of " + std::to_string(r.made->meshes.size()) + " meshes>";
      });
}

}  // namespace

std::vector<Option<certify::MeshOptions>> link_mesh_options() {
  std::vector<Option<certify::MeshOptions>> out;
  for (const Option<certify::MeshOptions>& option : certify::mesh_options())
    if (option.name != "direction") out.push_back(option);
  return out;
}

void bind_robot_decimation(py::module_& module) {
  bind_robot_decimation_class(module);
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string text =
      document("decimate_robot", kRobotDecimationParameters, decimate_keywords(),
               "kaboum.EnclosedRobot", kRobotDecimationDoc);
  module.def("decimate_robot", &decimate_robot, py::arg("robot"), py::kw_only(),
             py::arg("epsilons") = py::none(), py::arg("output_format") = py::none(),
             py::arg("partial") = false, text.c_str());
}

}  // namespace kaboum::python
