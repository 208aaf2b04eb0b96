// `bound-verify robot`: goes through the links of two robots and says what holds what.
#include "verify_robot.h"

#include <kaboum/base/error.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/verify/motion_alike.h>

#include <iostream>

#include "robot_judge.h"

namespace kaboum::tools {
namespace {

using robot::Geometry;
using verify::Answer;
using verify::MatchedShapes;

const char* name_of_shape(Geometry::Shape shape) {
  switch (shape) {
    case Geometry::Shape::Mesh:
      return "mesh";
    case Geometry::Shape::Box:
      return "box";
    case Geometry::Shape::Cylinder:
      return "cylinder";
    case Geometry::Shape::Sphere:
      break;
  }
  return "sphere";
}

class RobotVerifier {
 public:
  RobotVerifier(const VerifyRobotOptions& options, const CommonOptions& common)
      : o_(options),
        common_(common),
        original_(robot::read_robot(o_.original)),
        result_(robot::read_robot(o_.result)),
        meshes_(o_.packages),
        progress_(common.quiet),
        judge_(o_, [this](const std::string& what) { show(what); }) {}

  int run() {
    read_meshes();
    const std::string motion = verify::difference_in_motion(original_.robot, result_.robot);
    find_bare_links();
    say(motion.empty() ? "joints: verified: both robots move alike" : "joints: refuted: " + motion);
    answer_ = motion.empty() ? Answer::Verified : Answer::Refuted;
    for (const robot::Link& link : original_.robot.links) check(link);
    if (judge_.measures()) look_for_strangers();
    if (!common_.report.empty()) write_report(common_, "bound-verify", report(motion));
    progress_.show("");
    add_note_on_records();
    for (const std::string& note : judge_.notes.lines()) log(common_.quiet, "note: " + note);
    const std::string open =
        judge_.open() && answer_ == Answer::Verified ? ", as far as open meshes define it" : "";
    say(name_of(answer_) + open + ": " +
        robot::links_judged(links_.size(), original_.robot.links.size(), bare_) +
        except_sheets(judge_.dropped()));
    return exit_code(answer_);
  }

 private:
  [[nodiscard]] bool visual() const { return o_.geometry == "visual"; }

  /// Prints at once: what follows may take long.
  void say(const std::string& line) {
    if (common_.quiet) return;
    progress_.show("");
    std::ostream& out = common_.report == "-" ? std::cerr : std::cout;
    out << line << std::endl;
  }

  void show(const std::string& what) {
    progress_.show("link " + std::to_string(at_) + " of " +
                   std::to_string(original_.robot.links.size()) + ": deciding: " + what);
  }

  /// What is drawn, but does not collide, is easily overlooked.
  void find_bare_links() {
    bare_ = robot::bare_links(original_.robot, visual());
    if (visual()) bare_.other.clear();  // their shapes for collisions are judged
    for (const std::string& note : robot::notes_on(bare_, visual(), ": nothing of this is judged"))
      log(common_.quiet, "note: " + o_.original + ": " + note);
    for (const std::string& note : robot::notes_on_flat_shapes(original_, visual()))
      log(common_.quiet, "note: " + note);
  }

  /// Bodies of the other kind of shapes are easily taken.
  void add_note_on_records() {
    if (answer_ == Answer::Verified) return;
    if (const std::string record = meshes_.record_of_other_kind(original_, visual());
        !record.empty())
      judge_.notes.add(record, std::string("these bodies were made of a ") +
                                   (visual() ? "collision" : "visual") +
                                   " mesh of the original: judge them with" +
                                   (visual() ? "out --visual" : " --visual"));
  }

  /// Those to be held: for drawings, of links without, those for collisions, which
  /// `bcd-decompose --visual` leaves as they are.
  [[nodiscard]] const std::vector<Geometry>& shapes_of(const robot::Link& link) const {
    return visual() && !link.visual.empty() ? link.visual : link.collision;
  }
  [[nodiscard]] const std::vector<Geometry>& result_of(const std::string& link) const {
    static const std::vector<Geometry> kNone;
    const auto index = result_.robot.find_link(link);
    return index ? result_.robot.links[*index].collision : kNone;
  }

  /// Before anything is written, so that no mesh is written over.
  void read_meshes() {
    std::size_t shapes = 0;
    std::vector<std::string> inputs{o_.original, o_.result};
    const auto read_all = [&](const std::vector<Geometry>& of, const robot::RobotFile& robot) {
      for (const Geometry& g : of)
        if (g.shape == Geometry::Shape::Mesh) inputs.push_back(meshes_.file_of(g, robot).path);
    };
    for (const robot::Link& link : original_.robot.links) {
      shapes += shapes_of(link).size();
      read_all(shapes_of(link), original_);
    }
    for (const robot::Link& link : result_.robot.links) read_all(link.collision, result_);
    if (shapes == 0)
      throw Error(ErrorCode::InvalidInput, o_.original + ": no link has a shape" +
                                               (visual() ? "" : "; try --geometry visual"));
    require_apart({{"--report", common_.report}}, inputs);
  }

  void check(const robot::Link& link) {
    ++at_;
    const std::vector<Geometry>&shapes = shapes_of(link), &there = result_of(link.name);
    if (shapes.empty()) return;
    Json json{{"link", link.name}, {"shapes", Json::array()}};
    for (const MatchedShapes& match : verify::match_shapes(shapes, there)) {
      const Geometry& g = shapes[match.originals.front()];
      if (g.shape == Geometry::Shape::Mesh)
        add_meshes(json, link, match);
      else
        add(json, link, name_of_shape(g.shape), describe(g), finding_of(g, match));
    }
    links_.push_back(std::move(json));
  }

  void add_meshes(Json& json, const robot::Link& link, const MatchedShapes& match) {
    const std::vector<Geometry>&shapes = shapes_of(link), &there = result_of(link.name);
    MeshGroup group{{}, {}, shapes[match.originals.front()].size.cwiseAbs()};
    for (const std::size_t i : match.originals)
      group.originals.push_back(&meshes_.file_of(shapes[i], original_));
    for (const std::size_t i : match.there)
      group.bodies.push_back(&meshes_.file_of(there[i], result_));
    const GroupFindings& found = judge_.judge(group);
    for (std::size_t i = 0; i < group.originals.size(); ++i) {
      const RobotMeshes::File& file = *group.originals[i];
      Finding f = beside_others(found.originals[i], match);
      f.json["file"] = file.path;
      f.json["sha256"] = file.sha256;
      for (const RobotMeshes::File* body : group.bodies)
        f.json["held_by"].push_back({{"file", body->path}, {"sha256", body->sha256}});
      add(json, link, "mesh", file.path, f);
    }
    if (found.distance) add(json, link, "bodies", "bodies", *found.distance);
  }

  void add(Json& json, const robot::Link& link, const std::string& shape, const std::string& title,
           const Finding& f) {
    answer_ = worse(answer_, f.answer);
    say("link '" + link.name + "': " + title + ": " + name_of(f.answer) + ": " + f.text);
    Json entry{{"shape", shape}, {"answer", name_of(f.answer)}, {"text", f.text}};
    entry.update(f.json);
    json["shapes"].push_back(std::move(entry));
  }

  /// Shapes of the result that stand for none of the original's: their distance is not judged.
  void look_for_strangers() {
    for (const robot::Link& link : result_.robot.links) {
      const auto index = original_.robot.find_link(link.name);
      const std::vector<Geometry> known =
          index ? shapes_of(original_.robot.links[*index]) : std::vector<Geometry>{};
      const std::size_t strangers = verify::count_strangers(known, link.collision);
      if (strangers == 0) continue;
      answer_ = worse(answer_, Answer::Undecided);
      say("link '" + link.name + "': undecided: how far " + count(strangers, "shape", "shapes") +
          " of the result that the original has no match for reach from it");
    }
  }

  [[nodiscard]] Json report(const std::string& motion) const {
    const auto file = [](const std::string& path, const robot::RobotFile& robot) {
      return Json{{"file", path}, {"sha256", robot.sha256}};
    };
    return {{"relation", "robot"},
            {"verdict", name_of(answer_)},
            {"deciding_claims", o_.claims},
            {"geometry", o_.geometry},
            {"prepared", o_.prepare},
            {"dropped_sheet_triangles", judge_.dropped()},
            {"original", file(o_.original, original_)},
            {"result", file(o_.result, result_)},
            {"joints", {{"answer", motion.empty() ? "verified" : "refuted"}, {"reason", motion}}},
            {"links", links_},
            {"links_without_shapes", bare_.all()},
            {"links_with_other_shapes_only", bare_.other},
            {"notes", judge_.notes.lines()}};
  }

  const VerifyRobotOptions& o_;
  const CommonOptions& common_;
  robot::RobotFile original_, result_;
  RobotMeshes meshes_;
  Progress progress_;
  RobotJudge judge_;
  Answer answer_ = Answer::Verified;
  robot::BareLinks bare_;
  std::size_t at_ = 0;  // number of the link
  Json links_ = Json::array();
};

}  // namespace

int verify_robot(const VerifyRobotOptions& options, const CommonOptions& common) {
  if (options.result.empty())
    throw Error(ErrorCode::InvalidArgument, "--robot takes ORIGINAL and APPROXIMATION, two URDFs");
  const ThreadLimit threads(common.threads);
  return RobotVerifier(options, common).run();
}

}  // namespace kaboum::tools
