// Robots held by robots: kaboum.verify_robot, as `bound-verify robot`.

#include <kaboum/base/error.h>
#include <kaboum/base/sha256.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/verify/robot_options.h>

#include <map>

#include "answers.h"
#include "arguments.h"
#include "request_options.h"
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

  /// @param skip  a mesh without a file is one with an error
  const verify::MeshFile& of(const robot::Geometry& mesh, const robot::RobotFile& robot,
                             bool skip) {
    robot::MeshFiles& places =
        places_.try_emplace(robot.path.string(), robot.path, packages_).first->second;
    if (skip) {
      const robot::FoundMesh found = places.look_for(mesh.mesh);
      if (found.files.empty()) {
        verify::MeshFile file{mesh.mesh, {}, {}};
        file.error = Error(ErrorCode::InvalidInput, found.what);
        return files_.emplace(robot.path.string() + '\n' + mesh.mesh, std::move(file))
            .first->second;
      }
    }
    const std::string path = places.only(mesh.mesh).string();
    const auto at = files_.find(path);
    if (at != files_.end()) return at->second;
    return files_.emplace(path, verify::read_mesh_file(path, exact_points_)).first->second;
  }

 private:
  std::vector<std::string> packages_;
  std::size_t exact_points_;
  std::map<std::string, robot::MeshFiles> places_;  // by robot
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
      if (!s.region.empty()) {
        shape["region"] = s.region;
        shape["reached"] = s.reached;
        if (s.bound) shape["bound"] = *s.bound;
      }
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

Verdict verify_robot(const py::object& original, const py::object& result,
                     const py::object& epsilon_map, const py::kwargs& given) {
  verify::RobotVerdictOptions options;
  const RunKeywords running =
      take_keywords("verify_robot", verify::robot_verdict_options(), given, options, Runs::Threads);
  require_none(contradiction(options));
  bring_lengths_into("m", verify::robot_verdict_options(), options);
  const RobotValue first = robot_of(original, "original", robot::Motions::None),
                   second = robot_of(result, "result", robot::Motions::None);
  robot::require_links(*first.file, options.shapes.links);
  Files files(options.shapes.packages, options.exact_points);
  verify::RobotQuestion question = verify::question_of(
      first.file->robot, second.file->robot,
      [&](const robot::Geometry& mesh, bool of_result) -> const verify::MeshFile& {
        return files.of(mesh, of_result ? *second.file : *first.file,
                        !of_result && options.shapes.skip_missing);
      },
      options);
  question.bounds =
      robot::bounds_of_links(*first.file, options.shapes, frame_regions_of(epsilon_map));
  Watch watch(running.progress);
  question.limits.progress = watch.hook();
  verify::RobotVerdict found;
  run(running.threads, [&] { found = verify::decide(question); });
  return verdict_of(found);
}

constexpr const char* kRobotVerificationDoc =
    R"(Decides whether the collision shapes of a robot hold the shapes of another, as `bound-verify robot`.

Parameters
----------
original, result : Robot or path
epsilon_map : name of a file, or list of dict, optional
    Also decide that no point of a body in a region is farther than the region's own epsilon from
    the meshes that it holds, as `certify_robot` takes it; shapes with 'region' say so.
{keywords}

Returns
-------
Verdict
    Its claims are 'joints' (both move alike), 'links', a list of dicts with 'link', 'answer' and
    'sentence' (is every triangle of it inside: yes, or which not, and by how much), and 'shapes', a
    list of dicts with 'link', 'shape', 'answer' and 'reason'; of a region also 'region', its name,
    'bound', in the mesh's unit, and 'reached'.

Raises
------
Error
    'invalid_input' naming the file.)";

}  // namespace

void bind_robot_verification(py::module_& module) {
  py::options signatures;
  signatures.disable_function_signatures();  // the table's
  const std::string text =
      document("verify_robot", "original: object, result: object, *, epsilon_map: object = None",
               keywords_of(verify::robot_verdict_options()), "kaboum.Verdict",
               kRobotVerificationDoc, Runs::Threads);
  module.def("verify_robot", &verify_robot, py::arg("original"), py::arg("result"), py::kw_only(),
             py::arg("epsilon_map") = py::none(), text.c_str());
}

}  // namespace kaboum::python
