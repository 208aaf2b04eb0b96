// `bound-verify robot`: reads two robots, has them judged, prints and reports the verdict.
#include "robot.h"

#include <kaboum/base/error.h>
#include <kaboum/base/notes.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/facets.h>
#include <kaboum/geom/inside_out.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/io/region_file.h>
#include <kaboum/robot/robot_file.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iostream>
#include <map>

#include "common/verdict.h"
#include "mesh_input.h"
#include "robot_meshes.h"

namespace kaboum::tools {
namespace {

using robot::Geometry;
using verify::Answer;

const char* name_of_shape(const verify::ShapeVerdict& shape) {
  if (shape.bound) return "bodies";
  switch (shape.shape) {
    case Geometry::Shape::Mesh:
      return "mesh";
    case Geometry::Shape::Box:
      return "box";
    case Geometry::Shape::Cylinder:
      return "cylinder";
    case Geometry::Shape::Capsule:
      return "capsule";
    case Geometry::Shape::Ellipsoid:
      return "ellipsoid";
    case Geometry::Shape::Sphere:
      break;
  }
  return "sphere";
}

/// Triangles are numbered as read, or as prepared; not all of many are listed.
Json claim_json(const verify::Claim& claim) {
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

Json shape_json(const verify::ShapeVerdict& s) {
  Json json{{"shape", name_of_shape(s)}, {"answer", name_of(s.answer)}, {"text", s.text}};
  if (s.file != nullptr) {
    json["file"] = s.file->path;
    json["sha256"] = s.file->sha256;
    for (const verify::MeshFile* body : s.held_by) {
      json["held_by"].push_back({{"file", body->path},
                                 {"sha256", body->sha256},
                                 {"vertices", body->mesh.vertices.size()}});
      if (geom::is_convex(body->mesh))
        json["held_by"].back()["facets"] = geom::float32_facet_count(body->mesh);
    }
  }
  if (s.convex) {
    json["claims"]["convex"] = claim_json(*s.convex);
    if (s.solid) json["claims"]["solid"] = claim_json(*s.solid);
    if (s.triangles) json["claims"]["surface"] = claim_json(*s.triangles);
    json["triangles_without_area"] = s.triangles_without_area;
    json["limited"] = s.limited;
    json["triangles_left_out"] = s.left_out;
  }
  if (const auto& points = s.exact_points) {
    Json& claim = json["claims"]["exact_points"];
    claim = {{"answer", name_of(points->answer)}, {"reason", points->reason},
             {"points", points->points},          {"outside", points->outside},
             {"faces_outside", points->faces},    {"rounding", points->rounding}};
    if (points->outside > 0) {
      claim["farthest"] = points->farthest;
      claim["at"] = {points->at.x(), points->at.y(), points->at.z()};
      claim["face"] = points->face + 1;
    }
  }
  if (s.sticks_out) {
    json["sticks_out_lower"] = s.sticks_out->lower;
    if (std::isfinite(s.sticks_out->upper)) json["sticks_out_upper"] = s.sticks_out->upper;
  }
  if (s.distance)
    json["distance"] = {{"answer", name_of(s.distance->answer)},
                        {"reason", s.distance->reason},
                        {"bound", *s.bound},
                        {"largest_found", s.distance->largest}};
  if (!s.region.empty()) {
    json["region"] = s.region;
    json["reached"] = s.reached;
  }
  return json;
}

Json link_json(const verify::LinkVerdict& link) {
  Json json{{"link", link.link},
            {"answer", name_of(link.answer)},
            {"sentence", link.sentence},
            {"shapes", Json::array()}};
  for (const verify::ShapeVerdict& shape : link.shapes) json["shapes"].push_back(shape_json(shape));
  return json;
}

class RobotVerifier {
 public:
  RobotVerifier(const VerifyRobotOptions& options, const CommonOptions& common)
      : o_(options),
        common_(common),
        original_(robot::read_robot(o_.original, robot::Motions::None, o_.xacro_arguments,
                                    o_.how.shapes.packages)),
        result_(robot::read_robot(o_.result, robot::Motions::None, {}, o_.how.shapes.packages)),
        meshes_(o_.how.shapes.packages, o_.how.exact_points),
        progress_(common.quiet) {}

  int run() {
    robot::require_links(original_, o_.how.shapes.links);
    const verify::RobotQuestion question = question_of();
    read_meshes(question);
    find_bare_links();
    const verify::RobotVerdict verdict =
        verify::decide(question, [&](const verify::LinkVerdict& link) {
          say("link '" + link.link + "': " + name_of(link.answer) + ": " + link.sentence);
        });
    for (const auto& [link, count] : verdict.strangers)
      say("link '" + link + "': undecided: how far " + std::to_string(count) +
          (count == 1 ? " shape" : " shapes") +
          " of the result that the original has no match for reach from it");
    say(line_on_joints(verdict.motion));
    take_notes(verdict);
    if (!common_.report.empty()) write_report(common_, "bound-verify", report(verdict));
    progress_.show("");
    for (const std::string& note : notes_.lines()) log(common_.quiet, "note: " + note);
    const std::string open = verdict.open && verdict.answer == Answer::Verified
                                 ? ", as far as open meshes define it"
                                 : "";
    say(name_of(verdict.answer) + open + ": " +
        robot::links_judged(
            verdict.links.size(),
            o_.how.shapes.links.empty() ? original_.robot.links.size() : o_.how.shapes.links.size(),
            bare_) +
        except_sheets(dropped_in(verdict)) +
        (verdict.answer == Answer::Verified && has_exact_faces(verdict)
             ? o_.how.exact_points > 0
                   ? "; of the triangles, which stand for exact faces; no point of "
                     "these that was looked at sticks out"
                   : kOfTriangles
             : ""));
    return exit_code(verdict.answer);
  }

 private:
  [[nodiscard]] bool is_prepared() const { return o_.how.solid != verify::Solid::AsFile; }
  [[nodiscard]] bool visual() const { return o_.how.shapes.visual; }

  verify::RobotQuestion question_of() {
    const auto file_of = [this](const Geometry& mesh, bool of_result) -> const verify::MeshFile& {
      return meshes_.file_of(mesh, of_result ? result_ : original_,
                             !of_result && o_.how.shapes.skip_missing);
    };
    verify::RobotQuestion q = verify::question_of(original_.robot, result_.robot, file_of, o_.how);
    q.bounds = bounds_of(o_, original_);
    q.progress = [this](const std::string& what) { progress_.show("deciding: " + what); };
    return q;
  }

  /// Prints at once: what follows may take long.
  void say(const std::string& line) {
    if (common_.quiet) return;
    progress_.show("");
    std::ostream& out = common_.report == "-" ? std::cerr : std::cout;
    out << line << std::endl;
  }

  /// What is drawn, but does not collide, is easily overlooked.
  void find_bare_links() {
    bare_ = robot::bare_links(original_.robot, visual(), o_.how.shapes.links);
    if (visual()) bare_.other.clear();  // their shapes for collisions are judged
    for (const std::string& note : original_.robot.notes) log(common_.quiet, "note: " + note);
    for (const std::string& note : robot::notes_on(bare_, visual(), ": nothing of this is judged"))
      log(common_.quiet, "note: " + o_.original + ": " + note);
    for (const std::string& note :
         robot::notes_on_flat_shapes(original_, visual(), o_.how.shapes.links))
      log(common_.quiet, "note: " + note);
  }

  void take_notes(const verify::RobotVerdict& verdict) {
    for (const auto& [file, text] : verdict.notes) notes_.add(file, text);
    std::map<std::string, bool> regions;  // whether any body reaches them
    for (const verify::LinkVerdict& link : verdict.links)
      for (const verify::ShapeVerdict& shape : link.shapes)
        if (!shape.region.empty()) regions[shape.region] = regions[shape.region] || shape.reached;
    for (const auto& [region, reached] : regions)
      if (!reached) notes_.add(*o_.epsilon_map, "no body of a mesh reaches the region " + region);
    if (!is_prepared())
      for (const verify::LinkVerdict& link : verdict.links)
        for (const verify::ShapeVerdict& shape : link.shapes)
          if (shape.file != nullptr) note_on_unprepared(shape);
    if (verdict.answer == Answer::Verified) return;
    // Bodies of the other kind of shapes are easily taken.
    if (const std::string record = meshes_.record_of_other_kind(original_, visual());
        !record.empty())
      notes_.add(record, std::string("these bodies were made of a ") +
                             (visual() ? "collision" : "visual") +
                             " mesh of the original: judge them with" +
                             (visual() ? "out --visual" : " --visual"));
    if (has_sets_of_shapes())
      notes_.add(o_.result,
                 "links with a mesh have spheres, boxes, cylinders or capsules here: whether these "
                 "hold the link together is decided by bound-verify robot " +
                     o_.original + " --bodies " + o_.result + (visual() ? " --visual" : ""));
  }

  /// Whether some link has shapes that are no meshes in place of a mesh.
  [[nodiscard]] bool has_sets_of_shapes() const {
    const auto is_mesh = [](const Geometry& g) { return g.shape == Geometry::Shape::Mesh; };
    return std::ranges::any_of(original_.robot.links, [&](const robot::Link& link) {
      const auto other = result_.robot.find_link(link.name);
      if (!other || std::ranges::none_of(shapes_of(link), is_mesh)) return false;
      // Results have what holds them as collision shapes.
      const std::vector<Geometry>& shapes = result_.robot.links[*other].collision;
      return !shapes.empty() && std::ranges::none_of(shapes, is_mesh);
    });
  }
  [[nodiscard]] const std::vector<Geometry>& shapes_of(const robot::Link& link) const {
    return visual() ? link.visual : link.collision;
  }

  void note_on_unprepared(const verify::ShapeVerdict& shape) {
    if (!shape.is_judged) return;
    if (const auto found = geom::find_inside_out(shape.file->mesh); found && found->refusal.empty())
      notes_.add(shape.file->path, text_of(*found));
    if (shape.answer == Answer::Verified) return;
    try {
      if (!prepare_original(shape.file->mesh, false, true).report.notes.empty())
        notes_.add(shape.file->path,
                   "bcd-decompose speaks of the mesh as prepared; --prepare judges that");
    } catch (const Error&) {  // NOLINT(bugprone-empty-catch): then it is not prepared either
    }
  }

  /// Before anything is written, so that no mesh is written over.
  void read_meshes(const verify::RobotQuestion& question) {
    const bool skip = o_.how.shapes.skip_missing;
    robot::ShapeChoice of_result = o_.how.shapes;
    of_result.visual = false;
    of_result.links.clear();
    if (!skip) robot::require_meshes(original_, o_.how.shapes);
    for (const robot::Link& link : result_.robot.links)
      if (question.is_asked(link)) of_result.links.push_back(link.name);
    if (!of_result.links.empty()) robot::require_meshes(result_, of_result);
    std::size_t shapes = 0;
    std::vector<std::string> inputs{o_.original, o_.result, o_.epsilon_map.value_or("")};
    const auto read_all = [&](const std::vector<Geometry>& of, const robot::RobotFile& robot,
                              bool may_lack) {
      for (const Geometry& g : of)
        if (g.shape == Geometry::Shape::Mesh)
          inputs.push_back(meshes_.file_of(g, robot, may_lack).path);
    };
    for (const robot::Link& link : original_.robot.links) {
      if (!question.is_asked(link)) continue;
      shapes += question.shapes_of(link).size();
      read_all(question.shapes_of(link), original_, skip);
    }
    for (const robot::Link& link : result_.robot.links)
      if (question.is_asked(link)) read_all(link.collision, result_, false);
    if (shapes == 0)
      throw Error(ErrorCode::InvalidInput, o_.original + ": no link has a shape" +
                                               (visual() ? "" : "; try --geometry visual"));
    require_apart({{"--report", common_.report}}, inputs);
  }

  /// Whether triangles of some mesh that was judged stand for exact faces.
  static bool has_exact_faces(const verify::RobotVerdict& verdict) {
    for (const verify::LinkVerdict& link : verdict.links)
      for (const verify::ShapeVerdict& shape : link.shapes) {
        if (shape.file == nullptr) continue;
        const auto format =
            io::format_from_name(std::filesystem::path(shape.file->path).extension().string());
        if (format && io::is_cad(*format)) return true;
      }
    return false;
  }

  static DroppedSheets dropped_in(const verify::RobotVerdict& verdict) {
    DroppedSheets out;
    for (const verify::LinkVerdict& link : verdict.links)
      for (const verify::ShapeVerdict& shape : link.shapes)
        if (shape.dropped_sheets > 0) out[shape.name] = shape.dropped_sheets;
    return out;
  }

  [[nodiscard]] Json report(const verify::RobotVerdict& verdict) const {
    const auto file = [](const std::string& path, const robot::RobotFile& robot) {
      return Json{{"file", path}, {"sha256", robot.sha256}};
    };
    Json links = Json::array();
    for (const verify::LinkVerdict& link : verdict.links) links.push_back(link_json(link));
    return {{"relation", "robot"},
            {"verdict", name_of(verdict.answer)},
            {"deciding_claims", name_of(o_.how.claims)},
            {"geometry", visual() ? "visual" : "collision"},
            {"prepared", is_prepared()},
            {"prepare",
             is_prepared() ? value_of(verify::robot_verdict_options(), "prepare", o_.how) : "off"},
            {"dropped_sheet_triangles", dropped_in(verdict)},
            {"original", file(o_.original, original_)},
            {"result", file(o_.result, result_)},
            {"joints", json_of_joints(verdict.motion)},
            {"links", std::move(links)},
            {"links_without_shapes", bare_.all()},
            {"links_with_other_shapes_only", bare_.other},
            {"notes", notes_.lines()}};
  }

  const VerifyRobotOptions& o_;
  const CommonOptions& common_;
  robot::RobotFile original_, result_;
  RobotMeshes meshes_;
  Progress progress_;
  robot::BareLinks bare_;
  Notes notes_;
};

}  // namespace

robot::LinkBounds bounds_of(const VerifyRobotOptions& o, const robot::RobotFile& robot) {
  if (!o.epsilon_map) return {};
  return robot::bounds_of_links(robot, o.how.shapes, io::read_frame_regions(*o.epsilon_map));
}

std::string line_on_joints(const std::string& difference) {
  return difference.empty() ? "joints: verified: both robots move alike"
                            : "joints: refuted: " + difference;
}

Json json_of_joints(const std::string& difference) {
  return {{"answer", difference.empty() ? "verified" : "refuted"}, {"reason", difference}};
}

int verify_robot(const VerifyRobotOptions& options, const CommonOptions& common) {
  const ThreadLimit threads(common.threads);
  VerifyRobotOptions in_metres = options;
  bring_lengths_into("m", verify::robot_verdict_options(), in_metres.how);
  return RobotVerifier(in_metres, common).run();
}

}  // namespace kaboum::tools
