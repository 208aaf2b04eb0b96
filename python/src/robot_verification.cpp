// Robots held by robots: kaboum.verify_robot, as `bound-verify robot`.

#include <kaboum/robot/mesh_files.h>
#include <kaboum/verify/matching_shapes.h>
#include <kaboum/verify/motion_alike.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "answers.h"
#include "robot.h"
#include "running.h"

namespace kaboum::python {
namespace {

using robot::Geometry;
using verify::Answer;

struct Finding {
  std::string link, shape, reason;
  Answer answer = Answer::Undefined;
};

struct Asked {
  bool visual = false, prepare = false, drop_sheets = false;
  verify::Claims claims = verify::Claims::All;
  std::optional<Length> epsilon;
  std::vector<std::string> packages;
  verify::InclusionOptions limits;
};

class RobotVerifier {
 public:
  RobotVerifier(const robot::RobotFile& original, const robot::RobotFile& result, Asked asked)
      : original_(original), result_(result), asked_(std::move(asked)) {}

  void decide() {
    motion_ = verify::difference_in_motion(original_.robot, result_.robot);
    std::size_t shapes = 0;
    for (const robot::Link& link : original_.robot.links) shapes += judge(link);
    if (shapes == 0)
      throw Error(ErrorCode::InvalidInput, original_.path.string() + ": no link has a shape");
    if (asked_.epsilon) look_for_strangers();
  }

  [[nodiscard]] Verdict verdict() const {
    Verdict out;
    out.answer = motion_.empty() ? Answer::Verified : Answer::Refuted;
    py::dict joints;
    joints["answer"] = verify::name_of(out.answer);
    joints["reason"] = motion_;
    out.claims["joints"] = joints;
    py::list shapes;
    for (const Finding& f : findings_) {
      out.answer = worse(out.answer, f.answer);
      py::dict shape;
      shape["link"] = f.link;
      shape["shape"] = f.shape;
      shape["answer"] = verify::name_of(f.answer);
      shape["reason"] = f.reason;
      shapes.append(shape);
    }
    out.claims["shapes"] = shapes;
    out.notes = notes_;
    return out;
  }

 private:
  /// Those to be held: for drawings, of links without, those for collisions.
  [[nodiscard]] const std::vector<Geometry>& shapes_of(const robot::Link& link) const {
    return asked_.visual && !link.visual.empty() ? link.visual : link.collision;
  }

  std::size_t judge(const robot::Link& link) {
    static const std::vector<Geometry> kNone;
    const auto index = result_.robot.find_link(link.name);
    const std::vector<Geometry>&shapes = shapes_of(link),
          &there = index ? result_.robot.links[*index].collision : kNone;
    for (const verify::MatchedShapes& match : verify::match_shapes(shapes, there)) {
      const Geometry& g = shapes[match.originals.front()];
      if (g.shape == Geometry::Shape::Mesh)
        judge_meshes(link, shapes, there, match);
      else
        findings_.push_back({link.name, describe(g), "", verify::find_again(g, match)});
    }
    return shapes.size();
  }

  void judge_meshes(const robot::Link& link, const std::vector<Geometry>& shapes,
                    const std::vector<Geometry>& there, const verify::MatchedShapes& match) {
    std::vector<geom::Mesh> bodies, meshes;
    std::vector<verify::Holders::NamedMesh> named;
    bodies.reserve(match.there.size());
    for (const std::size_t i : match.there) {
      bodies.push_back(read(there[i], result_));
      named.push_back({there[i].mesh, &bodies.back()});
    }
    const verify::Holders holders(named);
    for (const auto& [name, why] : holders.left_out()) notes_.push_back(name + ": " + why);
    bool held = true;
    double diagonal = 0;
    for (const std::size_t i : match.originals) {
      meshes.push_back(original_mesh(shapes[i]));
      diagonal = std::max(diagonal, geom::bounding_box(meshes.back()).diagonal());
      const verify::HeldShape found = holders.hold(meshes.back(), asked_.claims, asked_.limits);
      held = held && found.answer == Answer::Verified;
      findings_.push_back({link.name, shapes[i].mesh,
                           found.decisive ? found.decisive->reason : found.reason,
                           verify::beside_others(found.answer, match)});
    }
    if (!asked_.epsilon || !held) return;
    const verify::ScaledBound bound = verify::scaled_bound(
        *asked_.epsilon, diagonal, shapes[match.originals.front()].size.cwiseAbs());
    if (!(bound.bound > 0) || !std::isfinite(bound.bound))
      throw Error(ErrorCode::InvalidInput, original_.path.string() +
                                               ": epsilon is no length in the unit of " +
                                               shapes[match.originals.front()].mesh);
    const verify::HeldDistance far = holders.distance(meshes, bound.bound, asked_.limits);
    findings_.push_back({link.name, "bodies", far.claim ? far.claim->reason : "not all are convex",
                         verify::answer_of(far, bound)});
  }

  geom::Mesh read(const Geometry& g, const robot::RobotFile& robot) const {
    return io::read_mesh(robot::find_only_mesh(g.mesh, robot.path, asked_.packages)).mesh;
  }

  /// As the file is, or as prepared.
  geom::Mesh original_mesh(const Geometry& g) const {
    geom::Mesh mesh = read(g, original_);
    if (!asked_.prepare) return mesh;
    return geom::prepare(mesh, {.drop_sheets = asked_.drop_sheets, .holes = geom::Holes::Fill})
        .solid.mesh();
  }

  /// Shapes of the result that stand for none of the original's: their distance is not judged.
  void look_for_strangers() {
    for (const robot::Link& link : result_.robot.links) {
      const auto index = original_.robot.find_link(link.name);
      const std::vector<Geometry> known =
          index ? shapes_of(original_.robot.links[*index]) : std::vector<Geometry>{};
      if (verify::count_strangers(known, link.collision) > 0)
        findings_.push_back(
            {link.name, "others", "how far shapes without a match reach", Answer::Undecided});
    }
  }

  const robot::RobotFile& original_;
  const robot::RobotFile& result_;
  Asked asked_;
  std::string motion_;
  std::vector<Finding> findings_;
  std::vector<std::string> notes_;
};

Verdict verify_robot(const py::object& original, const py::object& result,
                     const std::string& claims, const py::object& epsilon,
                     const std::string& geometry, const py::object& package_path, bool prepare,
                     bool drop_sheets, std::size_t max_contacts,
                     const std::optional<double>& max_work, int threads,
                     const py::object& progress) {
  const RobotValue first = robot_of(original, "original"), second = robot_of(result, "result");
  Asked asked{is_visual(geometry),
              prepare,
              drop_sheets,
              value_of(kClaims, claims, "claims"),
              length_of(epsilon, "epsilon"),
              packages_of(package_path),
              {}};
  asked.limits.max_contacts = max_contacts;
  asked.limits.max_work = max_work;
  Watch watch(progress);
  asked.limits.progress = watch.hook();
  RobotVerifier verifier(*first.file, *second.file, std::move(asked));
  run(threads, [&] { verifier.decide(); });
  return verifier.verdict();
}

}  // namespace

void bind_robot_verification(py::module_& module) {
  module.def(
      "verify_robot", &verify_robot, py::arg("original"), py::arg("result"), py::kw_only(),
      py::arg("claims") = "all", py::arg("epsilon") = py::none(), py::arg("geometry") = "collision",
      py::arg("package_path") = py::tuple(), py::arg("prepare") = false,
      py::arg("drop_sheets") = false,
      py::arg("max_contacts") = verify::InclusionOptions{}.max_contacts,
      py::arg("max_work") = py::none(), py::arg("threads") = 0, py::arg("progress") = py::none(),
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
prepare, drop_sheets, max_contacts, max_work, threads, progress
    As for `verify_mesh`.

Returns
-------
Verdict
    Its claims are 'joints' (both move alike) and 'shapes', a list of dicts with 'link', 'shape',
    'answer' and 'reason'.

Raises
------
Error
    'invalid_input' naming the file.)");
}

}  // namespace kaboum::python
