#include "verify_robot.h"

#include <kaboum/geom/error.h>
#include <kaboum/verify/held_shape.h>
#include <kaboum/verify/motion_alike.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <optional>
#include <tuple>

#include "notes.h"
#include "prepared_original.h"
#include "robot_file.h"
#include "robot_meshes.h"
#include "robot_verdict.h"
#include "verdict.h"

namespace kaboum::tools {
namespace {

using robot::Geometry;
using verify::Answer;

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

using File = RobotMeshes::File;

/// The shapes of a link with one frame: what the original has there, and what is to hold it.
struct Group {
  std::vector<const File*> originals, bodies;
  geom::Vec3 scale;
};

/// What was found of a group.
struct Judgement {
  std::vector<Finding> originals;
  std::optional<Finding> distance;  ///< of the bodies, where it was asked for and all are held
};

class RobotVerifier {
 public:
  RobotVerifier(const VerifyRobotOptions& options, const CommonOptions& common)
      : o_(options),
        common_(common),
        original_(read_robot(o_.original)),
        result_(read_robot(o_.result)),
        meshes_(o_.packages),
        progress_(common.quiet),
        claims_(o_.claims == "solid"     ? verify::Claims::Solid
                : o_.claims == "surface" ? verify::Claims::Surface
                                         : verify::Claims::All) {
    limits_.max_contacts = o_.max_contacts;
    if (o_.epsilon.empty()) return;
    epsilon_ = parse_length(o_.epsilon);
    if (!epsilon_)
      throw Error(ErrorCode::InvalidArgument,
                  "--epsilon: '" + o_.epsilon + "' is neither a positive length nor a percentage");
  }

  int run() {
    read_meshes();
    const std::string motion = verify::difference_in_motion(original_.robot, result_.robot);
    find_bare_links();
    say(motion.empty() ? "joints: verified: both robots move alike" : "joints: refuted: " + motion);
    answer_ = motion.empty() ? Answer::Verified : Answer::Refuted;
    for (const robot::Link& link : original_.robot.links) check(link);
    if (epsilon_) look_for_strangers();
    if (!common_.report.empty()) report(motion);
    progress_.show("");
    const bool visual = o_.geometry == "visual";
    if (answer_ != Answer::Verified)
      if (const std::string record = meshes_.record_of_other_kind(original_, visual);
          !record.empty())
        notes_.add(record, std::string("these bodies were made of a ") +
                               (visual ? "collision" : "visual") +
                               " mesh of the original: judge them with" +
                               (visual ? "out --visual" : " --visual"));
    for (const std::string& note : notes_.lines()) log(common_.quiet, "note: " + note);
    const std::string open =
        open_ && answer_ == Answer::Verified ? ", as far as open meshes define it" : "";
    say(name_of(answer_) + open + ": " +
        links_judged(links_.size(), original_.robot.links.size(), bare_) + except_sheets(dropped_));
    return exit_code(answer_);
  }

 private:
  /// Prints at once: what follows may take long.
  void say(const std::string& line) {
    if (common_.quiet) return;
    progress_.show("");
    std::ostream& out = common_.report == "-" ? std::cerr : std::cout;
    out << line << std::endl;
  }

  /// What is drawn, but does not collide, is easily overlooked.
  void find_bare_links() {
    const bool visual = o_.geometry == "visual";
    bare_ = bare_links(original_.robot, visual);
    if (visual) bare_.other.clear();  // their shapes for collisions are judged
    for (const std::string& note : notes_on(bare_, visual, ": nothing of this is judged"))
      log(common_.quiet, "note: " + o_.original + ": " + note);
    for (const std::string& note : notes_on_flat_shapes(original_, visual))
      log(common_.quiet, "note: " + note);
  }

  /// Those to be held: for drawings, of links without, those for collisions, which
  /// `bcd-decompose --visual` leaves as they are.
  [[nodiscard]] const std::vector<Geometry>& shapes_of(const robot::Link& link) const {
    return o_.geometry == "visual" && !link.visual.empty() ? link.visual : link.collision;
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
    const auto read_all = [&](const std::vector<Geometry>& of, const RobotFile& robot) {
      for (const Geometry& g : of)
        if (g.shape == Geometry::Shape::Mesh) inputs.push_back(meshes_.file_of(g, robot).path);
    };
    for (const robot::Link& link : original_.robot.links) {
      shapes += shapes_of(link).size();
      read_all(shapes_of(link), original_);
    }
    for (const robot::Link& link : result_.robot.links) read_all(link.collision, result_);
    if (shapes == 0)
      throw Error(ErrorCode::InvalidInput,
                  o_.original + ": no link has a shape" +
                      (o_.geometry == "visual" ? "" : "; try --geometry visual"));
    require_apart({{"--report", common_.report}}, inputs);
  }

  void check(const robot::Link& link) {
    ++at_;
    const std::vector<Geometry>& shapes = shapes_of(link);
    if (shapes.empty()) return;
    const std::vector<Geometry>& there = result_of(link.name);
    Json json{{"link", link.name}, {"shapes", Json::array()}};
    std::vector<char> seen(shapes.size(), 0);
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const Geometry& g = shapes[i];
      if (seen[i] != 0) continue;
      if (g.shape != Geometry::Shape::Mesh) {
        add(json, link, name_of_shape(g.shape), describe(g), primitive(g, there));
        continue;
      }
      Group group{{}, {}, g.size.cwiseAbs()};
      for (std::size_t k = i; k < shapes.size(); ++k) {
        if (!verify::same_frame(g, shapes[k])) continue;
        seen[k] = 1;
        group.originals.push_back(&meshes_.file_of(shapes[k], original_));
      }
      for (const Geometry& h : there)
        if (verify::same_frame(g, h)) group.bodies.push_back(&meshes_.file_of(h, result_));
      add(json, link, group, there.size() - group.bodies.size());
    }
    links_.push_back(std::move(json));
  }

  /// @param others  shapes of the result's link in other frames.
  void add(Json& json, const robot::Link& link, const Group& group, std::size_t others) {
    const Judgement& judged = judgement_of(group);
    for (std::size_t i = 0; i < group.originals.size(); ++i) {
      const File& file = *group.originals[i];
      Finding f = judged.originals[i];
      if (f.answer == Answer::Refuted && others > 0) {
        f.answer = Answer::Undecided;
        f.text += "; what the " + count(others, "shape", "shapes") +
                  " of other poses hold is not looked at";
      }
      f.json["file"] = file.path;
      f.json["sha256"] = file.sha256;
      for (const File* body : group.bodies)
        f.json["held_by"].push_back({{"file", body->path}, {"sha256", body->sha256}});
      add(json, link, "mesh", file.path, f);
    }
    if (judged.distance) add(json, link, "bodies", "bodies", *judged.distance);
  }

  void add(Json& json, const robot::Link& link, const std::string& shape, const std::string& title,
           const Finding& f) {
    answer_ = worse(answer_, f.answer);
    say("link '" + link.name + "': " + title + ": " + name_of(f.answer) + ": " + f.text);
    Json entry{{"shape", shape}, {"answer", name_of(f.answer)}, {"text", f.text}};
    entry.update(f.json);
    json["shapes"].push_back(std::move(entry));
  }

  static Finding primitive(const Geometry& g, const std::vector<Geometry>& there) {
    if (there.empty() && !robot::is_flat(g))
      return {Answer::Refuted, "the result's link has no shape at all"};
    const bool found = std::any_of(there.begin(), there.end(),
                                   [&](const Geometry& h) { return verify::same_frame(g, h); });
    if (found) return {Answer::Verified, "the result has it as well"};
    return {Answer::Undecided, "the result has none of its size and pose"};
  }

  void note(const std::string& path, const std::vector<std::string>& notes) {
    for (const std::string& n : notes) notes_.add(path, n);
  }

  /// The same meshes with the same bodies, as many links have them, are judged once.
  const Judgement& judgement_of(const Group& group) {
    const std::tuple key{group.originals, group.bodies, group.scale.x(), group.scale.y(),
                         group.scale.z()};
    const auto at = judged_.find(key);
    return at != judged_.end() ? at->second : judged_.emplace(key, judge(group)).first->second;
  }

  Judgement judge(const Group& group) {
    std::vector<verify::Holders::NamedMesh> named;
    named.reserve(group.bodies.size());
    for (const File* file : group.bodies) named.push_back({file->path, &file->mesh});
    const verify::Holders holders(named);
    for (const auto& [path, why] : holders.left_out()) note(path, {why});
    Judgement out;
    std::vector<geom::Mesh> meshes;
    bool held = true;
    for (const File* file : group.originals) {
      show(file->path);
      meshes.push_back(judged_mesh(*file));
      out.originals.push_back(hold(*file, meshes.back(), holders));
      held = held && out.originals.back().answer == Answer::Verified;
    }
    if (epsilon_ && held) out.distance = distance(group, meshes, holders);
    return out;
  }

  /// As the file is, or as prepared.
  geom::Mesh judged_mesh(const File& file) {
    note(file.path, file.notes);
    if (!o_.prepare) {
      if (const auto found = find_inside_out(file.mesh)) note(file.path, {text_of(*found)});
      return file.mesh;
    }
    geom::Prepared prepared =
        naming(file.path, [&] { return prepare_original(file.mesh, o_.drop_sheets, true); });
    note(file.path, prepared.notes);
    if (prepared.dropped_sheets > 0) dropped_[file.path] = prepared.dropped_sheets;
    return std::move(prepared.mesh);
  }

  Finding hold(const File& file, const geom::Mesh& mesh, const verify::Holders& holders) {
    const verify::HeldShape held =
        naming(file.path, [&] { return holders.hold(mesh, claims_, limits_); });
    open_ = open_ || (held.decisive && !held.inclusion->inner_closed);
    if (held.decisive && held.answer != Answer::Verified && !o_.prepare &&
        changes_by_preparing(mesh))
      note(file.path, {"bcd-decompose speaks of the mesh as prepared; --prepare judges that"});
    return finding_of(held, holders, o_.prepare);
  }

  void show(const std::string& what) {
    progress_.show("link " + std::to_string(at_) + " of " +
                   std::to_string(original_.robot.links.size()) + ": deciding: " + what);
  }

  static bool changes_by_preparing(const geom::Mesh& mesh) {
    try {
      return !prepare_original(mesh, false, true).notes.empty();
    } catch (const Error&) {
      return false;
    }
  }

  /// How far the bodies of a group are from all of its originals together.
  Finding distance(const Group& group, const std::vector<geom::Mesh>& originals,
                   const verify::Holders& holders) {
    double diagonal = 0;
    for (const geom::Mesh& mesh : originals)
      diagonal = std::max(diagonal, geom::bounding_box(mesh).diagonal());
    const double bound =
        epsilon_->percent ? epsilon_->of(diagonal) : epsilon_->value / group.scale.maxCoeff();
    if (!(bound > 0) || !std::isfinite(bound))
      throw Error(ErrorCode::InvalidInput, o_.original +
                                               ": --epsilon is no length in the unit of " +
                                               group.originals.front()->path + ", whose scale is " +
                                               number(group.scale.maxCoeff()));
    show("distance to " + group.originals.front()->path);
    const bool uneven = !epsilon_->percent && group.scale.minCoeff() < group.scale.maxCoeff();
    return finding_of(holders.distance(originals, bound, limits_), bound, uneven);
  }

  /// Shapes of the result that stand for none of the original's: their distance is not judged.
  void look_for_strangers() {
    for (const robot::Link& link : result_.robot.links) {
      const auto index = original_.robot.find_link(link.name);
      const std::vector<Geometry> known =
          index ? shapes_of(original_.robot.links[*index]) : std::vector<Geometry>{};
      const auto strangers = static_cast<std::size_t>(
          std::count_if(link.collision.begin(), link.collision.end(), [&](const Geometry& h) {
            return std::none_of(known.begin(), known.end(),
                                [&](const Geometry& g) { return verify::same_frame(g, h); });
          }));
      if (strangers == 0) continue;
      answer_ = worse(answer_, Answer::Undecided);
      say("link '" + link.name + "': undecided: how far " + count(strangers, "shape", "shapes") +
          " of the result that the original has no match for reach from it");
    }
  }

  void report(const std::string& motion) const {
    const auto file = [](const std::string& path, const RobotFile& robot) {
      return Json{{"file", path}, {"sha256", robot.sha256}};
    };
    write_json(
        common_.report,
        {{"tool", "bound-verify"},
         {"version", version()},
         {"relation", "robot"},
         {"verdict", name_of(answer_)},
         {"deciding_claims", o_.claims},
         {"geometry", o_.geometry},
         {"prepared", o_.prepare},
         {"dropped_sheet_triangles", dropped_},
         {"original", file(o_.original, original_)},
         {"result", file(o_.result, result_)},
         {"joints", {{"answer", motion.empty() ? "verified" : "refuted"}, {"reason", motion}}},
         {"links", links_},
         {"links_without_shapes", bare_.all()},
         {"links_with_other_shapes_only", bare_.other},
         {"notes", notes_.lines()},
         {"resources", {{"user_seconds", user_seconds()}, {"peak_megabytes", peak_megabytes()}}}});
  }

  const VerifyRobotOptions& o_;
  const CommonOptions& common_;
  RobotFile original_, result_;
  RobotMeshes meshes_;
  Progress progress_;
  verify::Claims claims_;
  verify::InclusionOptions limits_;
  std::optional<Length> epsilon_;
  using GroupKey =
      std::tuple<std::vector<const File*>, std::vector<const File*>, double, double, double>;
  std::map<GroupKey, Judgement> judged_;
  Answer answer_ = Answer::Verified;
  bool open_ = false;
  BareLinks bare_;
  DroppedSheets dropped_;
  std::size_t at_ = 0;  // number of the link
  Notes notes_;
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
