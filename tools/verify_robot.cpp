#include "verify_robot.h"

#include <kaboum/geom/error.h>
#include <kaboum/geom/topology.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/cover.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "find_mesh.h"
#include "notes.h"
#include "prepared_original.h"
#include "robot_file.h"
#include "verdict.h"

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;
using robot::Geometry;
using verify::Answer;

bool same(const robot::Transform& a, const robot::Transform& b) {
  return a.linear == b.linear && a.translation == b.translation;
}
/// Whether a point of the one's frame is the same point of the link in the other's.
bool same_frame(const Geometry& a, const Geometry& b) {
  return a.shape == b.shape && a.size == b.size && same(a.origin, b.origin);
}

bool same_limits(const robot::Variable& a, const robot::Variable& b) {
  return a.lower == b.lower && a.upper == b.upper;
}

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

/// Why the robots do not move alike; empty if they do.
std::string difference_in_motion(const robot::Robot& original, const robot::Robot& result) {
  if (original.links[0].name != result.links[0].name)
    return "the result's root is '" + result.links[0].name + "' instead of '" +
           original.links[0].name + "'";
  for (const robot::Link& link : original.links)
    if (!result.find_link(link.name)) return "the result has no link '" + link.name + "'";
  for (std::size_t i = 0; i < original.joints.size(); ++i) {
    const robot::Joint& a = original.joints[i];
    const auto at = std::find_if(result.joints.begin(), result.joints.end(),
                                 [&](const robot::Joint& b) { return b.name == a.name; });
    if (at == result.joints.end()) return "the result has no joint '" + a.name + "'";
    const robot::Joint& b = *at;
    const auto child = static_cast<std::size_t>(at - result.joints.begin()) + 1;
    const bool fixed = a.type == robot::JointType::Fixed;
    const char* what = nullptr;
    if (a.type != b.type)
      what = "is of another type";
    else if (original.links[a.parent].name != result.links[b.parent].name)
      what = "has another parent";
    else if (original.links[i + 1].name != result.links[child].name)
      what = "has another child";
    else if (!same(a.origin, b.origin))
      what = "has another origin";
    else if (!fixed && a.axis != b.axis)
      what = "has another axis";
    else if (!fixed && (a.multiplier != b.multiplier || a.offset != b.offset ||
                        original.variables[a.variable].name != result.variables[b.variable].name))
      what = "mimics in another way";
    else if (!fixed && !same_limits(original.variables[a.variable], result.variables[b.variable]))
      what = "has other limits";
    if (what != nullptr) return "joint '" + a.name + "' " + what;
  }
  return {};
}

/// A mesh file that a robot's shape stands for.
struct File {
  std::string path, sha256;
  geom::Mesh mesh;
  std::vector<std::string> notes;
};

/// What was found of one shape.
struct Finding {
  Answer answer = Answer::Undefined;
  std::string text;  ///< one clause
  Json json = Json::object();
};

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

/// What is to hold the originals of a group, as far as it can.
struct Holders {
  geom::ConvexSet set;
  verify::Claim convex;  ///< all of them
  geom::Mesh sum;
};

std::string count(std::size_t n, const char* one, const char* many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

bool closed(const geom::Mesh& mesh) { return geom::analyse(geom::weld(mesh)).closed(); }

class RobotVerifier {
 public:
  RobotVerifier(const VerifyRobotOptions& options, const CommonOptions& common)
      : o_(options),
        common_(common),
        original_(read_robot(o_.original)),
        result_(read_robot(o_.result)),
        progress_(common.quiet) {
    limits_.max_contacts = o_.max_contacts;
    if (o_.epsilon.empty()) return;
    epsilon_ = parse_length(o_.epsilon);
    if (!epsilon_)
      throw Error(ErrorCode::InvalidArgument,
                  "--epsilon: '" + o_.epsilon + "' is neither a positive length nor a percentage");
  }

  int run() {
    read_meshes();
    const std::string motion = difference_in_motion(original_.robot, result_.robot);
    find_bare_links();
    say(motion.empty() ? "joints: verified: both robots move alike" : "joints: refuted: " + motion);
    answer_ = motion.empty() ? Answer::Verified : Answer::Refuted;
    for (const robot::Link& link : original_.robot.links) check(link);
    if (epsilon_) look_for_strangers();
    if (!common_.report.empty()) report(motion);
    progress_.show("");
    note_other_kind();
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

  /// Hashes of the original's meshes that can be read.
  [[nodiscard]] std::set<std::string> hashes_of(bool visual) const {
    std::set<std::string> out;
    for (const robot::Link& link : original_.robot.links)
      for (const Geometry& g : visual ? link.visual : link.collision) try {
          if (g.shape == Geometry::Shape::Mesh)
            out.insert(
                io::sha256(io::read_file(resolve_mesh(g.mesh, original_.path, o_.packages))));
        } catch (const Error&) {  // NOLINT(bugprone-empty-catch): a note is not worth an error
        }
    return out;
  }

  /// Says so where the records beside the result's bodies name meshes of the kind that was not
  /// judged: --visual was given for one of both programs only.
  void note_other_kind() {
    if (answer_ == Answer::Verified) return;
    const bool visual = o_.geometry == "visual";
    const std::set<std::string> judged = hashes_of(visual), others = hashes_of(!visual);
    for (const auto& [path, file] : files_) {
      const fs::path record = fs::path(path).parent_path() / "convex-set.json";
      std::error_code error;
      if (!fs::is_regular_file(record, error)) continue;
      const std::vector<char> text = io::read_file(record);
      const Json json = Json::parse(text.begin(), text.end(), nullptr, false);
      if (!json.is_object() || !json.contains("source_sha256")) continue;
      const Json& hash = json["source_sha256"];
      if (!hash.is_string() || !others.contains(hash.get<std::string>()) ||
          judged.contains(hash.get<std::string>()))
        continue;
      notes_.add(record.string(), std::string("these bodies were made of a ") +
                                      (visual ? "collision" : "visual") +
                                      " mesh of the original: judge them with" +
                                      (visual ? "out --visual" : " --visual"));
      return;
    }
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
        if (g.shape == Geometry::Shape::Mesh) inputs.push_back(file_of(g, robot).path);
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

  /// The file of a mesh.
  const File& file_of(const Geometry& g, const RobotFile& robot) {
    const auto [at, fresh] = named_.try_emplace({robot.path.string(), g.mesh});
    if (!fresh) return *at->second;
    const File& file = read(find_only_mesh(g.mesh, robot.path, o_.packages).string());
    at->second = &file;
    return file;
  }

  const File& read(const std::string& path) {
    const auto at = files_.find(path);
    if (at != files_.end()) return at->second;
    std::vector<char> bytes;
    io::ReadResult read = io::read_mesh(path, {}, &bytes);
    return files_
        .emplace(path, File{path, io::sha256(bytes), std::move(read.mesh), std::move(read.notes)})
        .first->second;
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
        if (!same_frame(g, shapes[k])) continue;
        seen[k] = 1;
        group.originals.push_back(&file_of(shapes[k], original_));
      }
      for (const Geometry& h : there)
        if (same_frame(g, h)) group.bodies.push_back(&file_of(h, result_));
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
                                   [&](const Geometry& h) { return same_frame(g, h); });
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
    const Holders holders = holders_of(group);
    Judgement out;
    std::vector<geom::Mesh> meshes;
    bool held = true;
    for (const File* file : group.originals) {
      show(file->path);
      meshes.push_back(judged_mesh(*file));
      out.originals.push_back(hold(*file, meshes.back(), holders, group.bodies.empty()));
      held = held && out.originals.back().answer == Answer::Verified;
    }
    if (epsilon_ && held) out.distance = distance(group, meshes, holders);
    return out;
  }

  Holders holders_of(const Group& group) {
    Holders out;
    for (const File* file : group.bodies) {
      // Where each is closed, and the sum winds about a point, so does one of them.
      if (!closed(file->mesh)) {
        note(file->path, {"it is not closed and holds nothing"});
      } else if (!(geom::signed_volume(file->mesh) > 0)) {
        note(file->path, {"it is inside out and holds nothing"});
      } else {
        out.set.bodies.push_back({file->path, file->mesh});
      }
    }
    out.convex = verify::verify_convexity(out.set).convex;
    out.sum = verify::sum_of(out.set);
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

  /// Whether the mesh is held. @param none  the result has nothing of its frame
  Finding hold(const File& file, const geom::Mesh& mesh, const Holders& holders, bool none) {
    if (std::all_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const geom::Triangle& t) {
          return geom::is_degenerate(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
        }))
      return {Answer::Undecided, "none of its triangles has an area"};
    if (geom::signed_volume(mesh) < 0 && closed(mesh))
      return {Answer::Undecided,
              "it is inside out: its volume is negative" +
                  std::string(o_.prepare ? "" : "; --prepare judges it as bcd-decompose takes it")};
    const bool any = o_.claims != "solid" || (closed(mesh) && geom::signed_volume(mesh) > 0);
    if (holders.set.bodies.empty())
      return {none && any ? Answer::Refuted : Answer::Undecided,
              "the result's link has no closed mesh of its pose and scale"};
    const bool convex = holders.convex.answer == Answer::Verified;
    const verify::Inclusion in =
        naming(file.path, [&] { return verify::verify_inclusion(mesh, holders.sum, limits_); });
    Finding f;
    f.json["claims"] = {{"convex", claim_json(holders.convex)},
                        {"solid", claim_json(in.solid)},
                        {"surface", claim_json(in.surface)}};
    f.json["triangles_without_area"] = in.triangles_without_area;
    const bool solid = o_.claims != "surface" && in.inner_closed, surface = o_.claims != "solid";
    const verify::Claim* worst = nullptr;
    for (const auto& [claim, counts] :
         {std::pair{&in.solid, solid}, std::pair{&in.surface, surface}})
      if (counts && (worst == nullptr || worse(claim->answer, worst->answer) != worst->answer))
        worst = claim;
    if (worst == nullptr)
      return {Answer::Undefined, "it is not closed, so that it bounds no solid"};
    f.answer = worst->answer;
    open_ = open_ || !in.inner_closed;
    const std::string bodies =
        convex ? count(holders.set.bodies.size(), "convex body", "convex bodies")
               : count(holders.set.bodies.size(), "mesh", "meshes, not all convex");
    switch (f.answer) {
      case Answer::Verified:
        f.text = std::string(solid && surface ? "its solid and surface are"
                             : solid          ? "its solid is"
                                              : "its surface is") +
                 " within " + bodies;
        break;
      case Answer::Refuted:
        // Negative windings of what is not convex lower the sum.
        if (!convex) f.answer = Answer::Undecided;
        f.text = (convex ? "it is not within the " : "it is not known to be within the ") + bodies +
                 " of its pose";
        if (worst->witness)
          f.text += ": " + point(worst->witness->point) + " is " + number(worst->witness->depth) +
                    " outside, in the mesh's own unit";
        break;
      case Answer::Undecided:
      case Answer::Undefined:
        f.text = worst->reason;
        break;
    }
    if (f.answer != Answer::Verified && !o_.prepare && changes_by_preparing(mesh))
      note(file.path, {"bcd-decompose speaks of the mesh as prepared; --prepare judges that"});
    return f;
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

  /// How far the bodies of a group reach from all of its originals together.
  Finding distance(const Group& group, const std::vector<geom::Mesh>& originals,
                   const Holders& holders) {
    if (holders.convex.answer != Answer::Verified ||
        holders.set.bodies.size() < group.bodies.size())
      return {Answer::Undecided, "distances are decided of convex bodies only, and not all are"};
    geom::ConvexSet all;
    bool solid = true;
    double diagonal = 0;
    for (const geom::Mesh& mesh : originals) {
      all.bodies.push_back({"", mesh});
      solid = solid && closed(mesh);
      diagonal = std::max(diagonal, geom::bounding_box(mesh).diagonal());
    }
    const double bound =
        epsilon_->percent ? epsilon_->of(diagonal) : epsilon_->value / group.scale.maxCoeff();
    if (!(bound > 0) || !std::isfinite(bound))
      throw Error(ErrorCode::InvalidInput, o_.original +
                                               ": --epsilon is no length in the unit of " +
                                               group.originals.front()->path + ", whose scale is " +
                                               number(group.scale.maxCoeff()));
    show("distance to " + group.originals.front()->path);
    const verify::DistanceClaim claim =
        verify::verify_reach(holders.set, verify::sum_of(all), bound, solid, limits_);
    Finding f;
    f.answer = claim.answer;
    // By the largest factor; in other directions less may be far enough.
    const bool uneven = !epsilon_->percent && group.scale.minCoeff() < group.scale.maxCoeff();
    if (f.answer == Answer::Refuted && uneven) f.answer = Answer::Undecided;
    f.json["distance"] = {{"answer", name_of(claim.answer)},
                          {"reason", claim.reason},
                          {"bound", bound},
                          {"largest_found", claim.largest}};
    f.text = f.answer == Answer::Verified
                 ? "nowhere more than " + number(bound) + " from the solid"
                 : "at least " + number(claim.largest) + " from the solid at " + point(claim.at) +
                       ", claimed " + number(bound);
    f.text += ", in the mesh's own unit";
    if (!solid) f.text += " (to the surface, as it is open)";
    if (f.answer == Answer::Undecided && uneven) f.text += "; the scale is uneven";
    return f;
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
                                [&](const Geometry& g) { return same_frame(g, h); });
          }));
      if (strangers == 0) continue;
      answer_ = worse(answer_, Answer::Undecided);
      say("link '" + link.name + "': undecided: how far " + count(strangers, "shape", "shapes") +
          " of the result that the original has no match for reach from it");
    }
  }

  /// Triangles are numbered as read, or as prepared; not all of many are listed.
  static Json claim_json(const verify::Claim& claim) {
    Json json{{"answer", name_of(claim.answer)}, {"reason", claim.reason}};
    if (!claim.witness) return json;
    constexpr std::size_t kMost = 100;
    std::vector<std::uint32_t> triangles = claim.inner_triangles;
    std::sort(triangles.begin(), triangles.end());
    const std::size_t all = triangles.size();
    triangles.resize(std::min(all, kMost));
    const geom::Vec3& p = claim.witness->point;
    json["witness"] = {{"point", {p.x(), p.y(), p.z()}},
                       {"depth", claim.witness->depth},
                       {"triangles_outside", all},
                       {"triangles", triangles}};
    return json;
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
  Progress progress_;
  verify::InclusionOptions limits_;
  std::optional<Length> epsilon_;
  std::map<std::string, File> files_;
  std::map<std::pair<std::string, std::string>, const File*> named_;  // robot, reference
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
