// Robots held by robots: kaboum.verify_robot, as `bound-verify robot`.

#include <kaboum/base/error.h>
#include <kaboum/base/sha256.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/verify/exact_points.h>
#include <kaboum/verify/robot_verdict.h>

#include <map>

#include "answers.h"
#include "robot.h"
#include "running.h"

namespace kaboum::python {
namespace {

using verify::Answer;

/// The mesh files of both robots, each read once.
class Files {
 public:
  Files(std::vector<std::string> packages, std::size_t exact_points)
      : packages_(std::move(packages)), exact_points_(exact_points) {}

  const verify::MeshFile& of(const robot::Geometry& mesh, const robot::RobotFile& robot) {
    const std::string path = robot::find_only_mesh(mesh.mesh, robot.path, packages_).string();
    const auto at = files_.find(path);
    if (at != files_.end()) return at->second;
    return files_.emplace(path, verify::read_mesh_file(path, exact_points_)).first->second;
  }

 private:
  std::vector<std::string> packages_;
  std::size_t exact_points_;
  std::map<std::string, verify::MeshFile> files_;
};

Verdict verdict_of(const verify::RobotVerdict& found) {
  Verdict out;
  out.answer = found.answer;
  py::dict joints;
  joints["answer"] = verify::name_of(found.motion.empty() ? Answer::Verified : Answer::Refuted);
  joints["reason"] = found.motion;
  out.claims["joints"] = joints;
  py::list links, shapes;
  for (const verify::LinkVerdict& link : found.links) {
    py::dict one;
    one["link"] = link.link;
    one["answer"] = verify::name_of(link.answer);
    one["sentence"] = link.sentence;
    links.append(one);
    for (const verify::ShapeVerdict& s : link.shapes) {
      py::dict shape;
      shape["link"] = link.link;
      shape["shape"] = s.name;
      shape["answer"] = verify::name_of(s.answer);
      shape["reason"] = s.answer == Answer::Verified ? std::string() : s.text;
      shapes.append(shape);
    }
  }
  for (const auto& [link, count] : found.strangers) {
    py::dict shape;
    shape["link"] = link;
    shape["shape"] = "others";
    shape["answer"] = verify::name_of(Answer::Undecided);
    shape["reason"] = "how far shapes without a match reach";
    shapes.append(shape);
  }
  out.claims["links"] = links;
  out.claims["shapes"] = shapes;
  for (const auto& [file, text] : found.notes)
    out.notes.push_back(std::string(file).append(": ").append(text));
  return out;
}

/// False, True ('auto'), 'auto' or 'wrap'.
verify::Solid solid_of(const py::object& prepare) {
  if (py::isinstance<py::bool_>(prepare))
    return prepare.cast<bool>() ? verify::Solid::Prepared : verify::Solid::AsFile;
  if (py::isinstance<py::str>(prepare)) {
    const auto name = prepare.cast<std::string>();
    if (name == "auto") return verify::Solid::Prepared;
    if (name == "wrap") return verify::Solid::Enclosed;
  }
  throw Error(ErrorCode::InvalidArgument, "prepare: True, False, 'auto' or 'wrap'");
}

Verdict verify_robot(const py::object& original, const py::object& result,
                     const std::string& claims, const py::object& epsilon,
                     const std::string& geometry, const py::object& package_path,
                     const py::object& prepare, bool drop_sheets, std::size_t max_contacts,
                     const std::optional<double>& max_work, std::size_t exact_points, int threads,
                     const py::object& progress) {
  const RobotValue first = robot_of(original, "original"), second = robot_of(result, "result");
  Files files(packages_of(package_path), exact_points);
  verify::RobotQuestion question{
      first.file->robot, second.file->robot,
      [&](const robot::Geometry& mesh, bool of_result) -> const verify::MeshFile& {
        return files.of(mesh, of_result ? *second.file : *first.file);
      }};
  question.visual = is_visual(geometry);
  question.claims = value_of(kClaims, claims, "claims");
  question.solid = solid_of(prepare);
  question.drop_sheets = drop_sheets;
  question.epsilon = length_of(epsilon, "epsilon");
  question.limits.max_contacts = max_contacts;
  question.limits.max_work = max_work;
  Watch watch(progress);
  question.limits.progress = watch.hook();
  verify::RobotVerdict found;
  run(threads, [&] { found = verify::decide(question); });
  return verdict_of(found);
}

}  // namespace

void bind_robot_verification(py::module_& module) {
  module.def(
      "verify_robot", &verify_robot, py::arg("original"), py::arg("result"), py::kw_only(),
      py::arg("claims") = "all", py::arg("epsilon") = py::none(), py::arg("geometry") = "collision",
      py::arg("package_path") = py::tuple(), py::arg("prepare") = false,
      py::arg("drop_sheets") = false,
      py::arg("max_contacts") = verify::InclusionOptions{}.max_contacts,
      py::arg("max_work") = py::none(), py::arg("exact_points") = verify::kPointDensity,
      py::arg("threads") = 0, py::arg("progress") = py::none(),
      R"(Decides whether the collision shapes of a robot hold the shapes of another, as `bound-verify robot`.

Parameters
----------
original, result : Robot or path
claims : str
    Those that decide: 'all', 'solid' or 'surface'.
epsilon : float or str, optional
    Also decide that no body is farther than this from what it holds: a length in the robot's unit,
    or a percentage of the meshes' diagonal.
geometry : str
    Which shapes of the original are to be held: 'collision' or 'visual'.
package_path : str or sequence of str
    Folders that package:// is looked up in.
prepare : bool or str
    Also judge the solid of each mesh as the tools prepare it (True, 'auto'); 'wrap': all that closed
    meshes wind round, whichever way. Every triangle of the file is judged anyway.
drop_sheets, max_contacts, max_work, exact_points, threads, progress
    As for `verify_mesh`.

Returns
-------
Verdict
    Its claims are 'joints' (both move alike), 'links', a list of dicts with 'link', 'answer' and
    'sentence' (is every triangle of it inside: yes, or which not, and by how much), and 'shapes', a
    list of dicts with 'link', 'shape', 'answer' and 'reason'.

Raises
------
Error
    'invalid_input' naming the file.)");
}

}  // namespace kaboum::python
