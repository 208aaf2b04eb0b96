// Spheres of robots: kaboum.write_spheres, repair_spheres and verify_spheres, as `bcd-decompose
// --bodies spheres`, its
// `--repair` and `bound-verify robot --spheres`.

#include <kaboum/certify/sphere_repair.h>
#include <kaboum/certify/sphere_shares.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/pairs/matrix.h>
#include <kaboum/robot/shape_options.h>
#include <kaboum/robot_folder/sphere_text.h>
#include <kaboum/verify/sphere_verdict.h>

#include <cmath>
#include <filesystem>
#include <system_error>

#include "answers.h"
#include "request_options.h"
#include "robot.h"
#include "running.h"

namespace kaboum::python {
namespace {

/// The file that a keyword names.
std::string file_of(const py::object& value, const char* name) {
  const auto path = path_of(value);
  if (!path)
    throw Error(ErrorCode::InvalidArgument, std::string(name) + " must be a str or an os.PathLike");
  return *path;
}

/// @throws Error{InvalidArgument} where what is to be written would take an input's place
void require_other(const std::string& output, const std::filesystem::path& input) {
  std::error_code absent;
  if (std::filesystem::equivalent(output, input, absent))
    throw Error(ErrorCode::InvalidArgument,
                output + " would be overwritten, which is read: name another file");
}

robot_folder::SphereFormat format_of(const std::string& file) {
  const std::optional<robot_folder::SphereFormat> out = robot_folder::sphere_format_of(file);
  if (!out)
    throw Error(ErrorCode::InvalidArgument,
                file + ": spheres are written to .yaml, .yml (cuRobo), .xrdf, .srdf and .urdf");
  return *out;
}

Length epsilon_of(const py::object& value) {
  const OptionDescription epsilon = [] {
    for (const auto& option : certify::set_options())
      if (option.name == std::string("epsilon")) return OptionDescription(option);
    throw Error(ErrorCode::Internal, "no option epsilon");
  }();
  certify::SetOptions options;
  const std::optional<std::string> text = text_of(epsilon, value);
  for (const auto& option : certify::set_options())
    if (text && option.name == std::string("epsilon")) option.assign(options, *text);
  const std::optional<Length> out = certify::request_of(options).epsilon;
  if (!out) throw Error(ErrorCode::InvalidArgument, "epsilon must be a length");
  return *out;
}

bcd::Effort effort_of(const std::string& name) {
  if (name == "fast") return bcd::Effort::Fast;
  if (name == "normal") return bcd::Effort::Normal;
  if (name == "best") return bcd::Effort::Best;
  throw Error(ErrorCode::InvalidArgument, "effort must be 'fast', 'normal' or 'best'");
}

certify::SphereShare share_of(const std::string& name) {
  if (name == "farthest") return certify::SphereShare::Farthest;
  if (name == "mean") return certify::SphereShare::Mean;
  throw Error(ErrorCode::InvalidArgument, "share must be 'farthest' or 'mean'");
}

/// The pairs of links that a file says need no check.
/// @param notes  gets what is wrong with the file
std::vector<robot_folder::UncheckedLinks> unchecked_links(const std::string& file,
                                                          const robot::Robot& robot,
                                                          std::vector<std::string>& notes) {
  const std::vector<char> text = io::read_file(file);
  const pairs::Matrix matrix =
      pairs::parse_matrix(std::string(text.begin(), text.end()), file, robot);
  pairs::require_own(matrix, file, robot);
  for (const pairs::MatrixFault& fault : matrix.faults)
    notes.push_back(file + ": line " + std::to_string(fault.line) + ": " + fault.text);
  std::vector<robot_folder::UncheckedLinks> out;
  for (const pairs::DisabledPair& pair : matrix.pairs) out.push_back({pair.a, pair.b, pair.reason});
  return out;
}

py::dict write_spheres(const py::object& robot, const py::object& file, const py::object& epsilon,
                       const py::object& epsilon_map, std::optional<std::size_t> robot_bodies,
                       const std::string& share, const std::string& effort, const py::object& pairs,
                       const py::kwargs& given) {
  certify::RobotRequest r;
  py::dict keywords = given;
  take_options(robot::shape_options(), keywords, r.shapes);
  const RunKeywords running = take_run_keywords(keywords);
  require_all_taken("write_spheres", keywords, keywords_of(robot::shape_options()));
  if (epsilon.is_none() == !robot_bodies.has_value())
    throw Error(ErrorCode::InvalidArgument, "one of epsilon and robot_bodies is to be stated");
  if (robot_bodies && *robot_bodies == 0)
    throw Error(ErrorCode::InvalidArgument, "robot_bodies must be 1 at least");
  const std::string path = file_of(file, "file");
  const robot_folder::SphereFormat format = format_of(path);
  if (!pairs.is_none() && format == robot_folder::SphereFormat::Urdf)
    throw Error(
        ErrorCode::InvalidArgument,
        "pairs: pairs of links have a place in .yaml (cuRobo), .xrdf and .srdf, not in " + path);
  const RobotValue value = robot_of(robot, "robot", robot::Motions::None);
  require_other(path, value.file->path);
  if (!pairs.is_none()) require_other(path, file_of(pairs, "pairs"));
  r.set.body_kind = certify::SetRequest::BodyKind::Spheres;
  r.set.effort = effort_of(effort);
  if (!epsilon.is_none()) r.set.epsilon = epsilon_of(epsilon);
  r.set.nearest = robot_bodies.has_value();
  r.take(robot::bounds_of_links(*value.file, r.shapes, frame_regions_of(epsilon_map)));
  const certify::SphereShare how = share_of(share);
  Watch watch(running.progress);
  std::vector<std::string> notes;
  const std::vector<robot_folder::UncheckedLinks> unchecked =
      pairs.is_none() ? std::vector<robot_folder::UncheckedLinks>()
                      : unchecked_links(file_of(pairs, "pairs"), value.file->robot, notes);
  std::optional<certify::CertifiedBodies> made;
  run(running.threads, [&] {
    const certify::SetCache kept(certify::SetCache::default_folder());
    const certify::SetCache* cache = running.no_cache ? nullptr : &kept;
    certify::RobotHooks hooks;
    hooks.progress = watch.hook();
    hooks.note = [&](const std::string& of, const std::string& text) {
      notes.push_back(std::string(of).append(": ").append(text));
    };
    if (robot_bodies)
      r.epsilons = certify::share_spheres(*value.file, r, *robot_bodies, how, cache, hooks);
    made.emplace(certify::certify_bodies(*value.file, r, cache, hooks));
    io::write_file(path, robot_folder::sphere_text(format, *value.file, *made, r.parameters(), path,
                                                   unchecked));
  });
  py::dict out;
  out["spheres"] = made->artefact().size();
  out["reach"] = made->certificate().distance;
  out["mean_reach"] = certify::mean_distance(*made);
  out["notes"] = notes;
  return out;
}

py::dict repair_spheres(const py::object& robot, const py::object& spheres, const py::object& file,
                        const py::object& epsilon, const std::string& effort,
                        const py::kwargs& given) {
  certify::RepairRequest r;
  const RunKeywords running =
      take_keywords("repair_spheres", robot::shape_options(), given, r.shapes, Runs::Threads);
  const std::string from = file_of(spheres, "spheres"), to = file_of(file, "file");
  if (format_of(from) != format_of(to))
    throw Error(ErrorCode::InvalidArgument,
                "spheres are written in the format that they have: name the file as " + from);
  const RobotValue value = robot_of(robot, "robot", robot::Motions::None);
  require_other(to, value.file->path);
  require_other(to, from);
  robot::require_links(*value.file, r.shapes.links);
  r.epsilon = epsilon_of(epsilon);
  r.effort = effort_of(effort);
  Watch watch(running.progress);
  certify::RepairedSpheres made;
  run(running.threads, [&] {
    certify::RobotHooks hooks;
    hooks.progress = watch.hook();
    const std::vector<char> text = io::read_file(from);
    made =
        certify::repair_spheres(*value.file, from, std::string(text.begin(), text.end()), r, hooks);
    io::write_file(to, made.text);
  });
  py::list links;
  for (const certify::RepairedLink& link : made.links) {
    py::dict one;
    one["link"] = link.link;
    one["kept"] = link.kept;
    one["grown"] = link.grown;
    one["moved"] = link.moved;
    one["shrunk"] = link.shrunk;
    one["added"] = link.added;
    one["reach"] = link.epsilon;
    links.append(one);
  }
  py::dict out;
  out["spheres"] = made.spheres;
  out["links"] = links;
  out["notes"] = made.notes;
  return out;
}

py::dict dict_of(const verify::LinkSpheresVerdict& link) {
  py::dict out;
  out["link"] = link.link;
  out["answer"] = verify::name_of(link.answer);
  out["sentence"] = link.sentence;
  out["spheres"] = link.spheres;
  out["share_outside"] = py::make_tuple(link.outside.share_lower, link.outside.share_upper);
  if (link.missed) {
    const geom::Vec3& p = link.missed->point;
    out["missed"] = py::make_tuple(p.x(), p.y(), p.z());
    out["depth"] = link.missed->depth;
  }
  if (link.reach.all) out["distance"] = verify::name_of(link.reach.all->answer);
  if (link.reach.regions.empty()) return out;
  py::list regions;
  for (const verify::LinkReach::InRegion& one : link.reach.regions) {
    py::dict region;
    region["name"] = one.name;
    region["answer"] = verify::name_of(one.claim.answer);
    region["reason"] = one.claim.reason;
    region["bound"] = one.epsilon;
    region["reached"] = one.reached;
    regions.append(region);
  }
  out["regions"] = regions;
  return out;
}

/// In metres; none: nothing is asked of distances.
std::optional<double> reach_of(const py::object& epsilon) {
  if (epsilon.is_none()) return std::nullopt;
  const Length out = epsilon_of(epsilon);
  if (out.percent)
    throw Error(ErrorCode::InvalidArgument,
                "epsilon: a percentage has no meaning for spheres that hold several meshes: state "
                "a length");
  return out.in("m").value;
}

Verdict verify_spheres(const py::object& robot, const py::object& spheres,
                       const py::object& epsilon, const py::object& epsilon_map,
                       const py::kwargs& given) {
  robot::ShapeChoice shapes;
  const RunKeywords running =
      take_keywords("verify_spheres", robot::shape_options(), given, shapes, Runs::Threads);
  const RobotValue value = robot_of(robot, "robot", robot::Motions::None);
  robot::require_links(*value.file, shapes.links);
  const std::string file = file_of(spheres, "spheres");
  const std::optional<double> reach = reach_of(epsilon);
  const robot::LinkBounds bounds =
      robot::bounds_of_links(*value.file, shapes, frame_regions_of(epsilon_map));
  Watch watch(running.progress);
  verify::SpheresVerdict found;
  run(running.threads, [&] {
    const robot::SphereFile read = robot::read_spheres(file);
    found = verify::decide_spheres(
        *value.file, read, file, shapes,
        [&](const verify::LinkSpheresVerdict& link) { watch("deciding: " + link.link); }, reach,
        bounds);
  });
  Verdict out;
  out.answer = found.answer;
  py::list links;
  for (const verify::LinkSpheresVerdict& link : found.links) links.append(dict_of(link));
  out.claims["links"] = links;
  out.claims["share_outside"] = py::make_tuple(found.share_lower, found.share_upper);
  out.claims["uncovered"] = found.uncovered;
  out.claims["depth"] = found.depth;
  out.claims["sentence"] = found.sentence;
  out.notes = found.notes;
  return out;
}

constexpr const char* kWriteDoc =
    R"(Covers the links of a robot by spheres and writes these, as `bcd-decompose ROBOT --bodies spheres`.

Parameters
----------
robot : Robot or path
file : str or path
    .yaml, .yml (cuRobo), .xrdf, .srdf or .urdf.
epsilon : float or str
    No point of a sphere is farther from its link's shapes. [length, or "2%" of each mesh's diagonal]
epsilon_map : name of a file, or list of dict, optional
    With epsilon: regions fixed in frames of links, or whole links, as `certify_robot` takes them.
robot_bodies : int
    Instead: so many spheres for all links together.
share : {'farthest', 'mean'}
    What robot_bodies makes least over the links.
effort : {'fast', 'normal', 'best'}
pairs : str or path, optional
    A file of pairs of links that need no check, as `kaboum-pairs ROBOT --srdf` writes one (SRDF; also MJCF, Drake's filter
    groups, XRDF and cuRobo's YAML). Those of links with spheres are written as well; not into a URDF.
{keywords}

Returns
-------
dict
    'spheres', their number; 'reach', certified: no point of them is farther from its link's shapes; 'mean_reach', the mean
    of that over the links; 'notes'.)";

constexpr const char* kRepairDoc =
    R"(Changes spheres as little as is found to suffice until they hold a robot, as `bcd-decompose ROBOT --repair SPHERES`.

Parameters
----------
robot : Robot or path
spheres : str or path
    As `verify_spheres` reads them.
file : str or path
    To be written, in the same format.
epsilon : float or str
    No point of a sphere is farther from its link's solid afterwards. [length, or "2%" of each link's diagonal]
effort : {'fast', 'normal', 'best'}
{keywords}

Returns
-------
dict
    'spheres', their number; 'links', a list of dicts with 'link', 'kept', 'grown', 'moved', 'shrunk', 'added' and 'reach';
    'notes'.)";

constexpr const char* kVerifyDoc =
    R"(Decides whether the spheres of a file hold the links of a robot, as `bound-verify robot ROBOT --spheres FILE`.

Parameters
----------
robot : Robot or path
spheres : str or path
    cuRobo's YAML, XRDF, SRDF with link_sphere_approximation, or URDF with spheres as collision shapes.
epsilon : float or str
    Also decides that no point of a sphere is farther from its link's shapes. [length]
epsilon_map : name of a file, or list of dict, optional
    The same of whole links, and of regions fixed in their frames, as `certify_robot` takes them; percentages are of the
    largest diagonal that one of a link's shapes has.
{keywords}

Returns
-------
Verdict
    Its claims are 'links', a list of dicts with 'link', 'answer', 'sentence', 'spheres', 'share_outside' (bounds of the share
    of the surface), with epsilon 'distance' (an answer), with epsilon_map 'regions' (dicts) and, where it is refuted, 'missed' (a point) and 'depth';
    'share_outside', 'depth' and 'sentence' of all; 'uncovered', the names of links that have shapes and no spheres.

Raises
------
Error
    'invalid_input' naming file and line.)";

}  // namespace

void bind_spheres(py::module_& module) {
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::vector<Keyword> shapes = keywords_of(robot::shape_options());
  const std::string write = document(
      "write_spheres",
      "robot: object, file: object, *, epsilon: object = None, epsilon_map: object = None, "
      "robot_bodies: int = None, share: str = 'farthest', effort: str = 'normal', "
      "pairs: object = None",
      shapes, "dict", kWriteDoc);
  module.def("write_spheres", &write_spheres, py::arg("robot"), py::arg("file"), py::kw_only(),
             py::arg("epsilon") = py::none(), py::arg("epsilon_map") = py::none(),
             py::arg("robot_bodies") = py::none(), py::arg("share") = "farthest",
             py::arg("effort") = "normal", py::arg("pairs") = py::none(), write.c_str());
  const std::string repair = document(
      "repair_spheres",
      "robot: object, spheres: object, file: object, *, epsilon: object, effort: str = 'normal'",
      shapes, "dict", kRepairDoc, Runs::Threads);
  module.def("repair_spheres", &repair_spheres, py::arg("robot"), py::arg("spheres"),
             py::arg("file"), py::kw_only(), py::arg("epsilon"), py::arg("effort") = "normal",
             repair.c_str());
  const std::string verify = document(
      "verify_spheres",
      "robot: object, spheres: object, *, epsilon: object = None, epsilon_map: object = None",
      shapes, "kaboum.Verdict", kVerifyDoc, Runs::Threads);
  module.def("verify_spheres", &verify_spheres, py::arg("robot"), py::arg("spheres"), py::kw_only(),
             py::arg("epsilon") = py::none(), py::arg("epsilon_map") = py::none(), verify.c_str());
}

}  // namespace kaboum::python
