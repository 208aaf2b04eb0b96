// What bmesh-decimate tells of its results: lines, a page, a report, and the files.

#include "results.h"

#include <kaboum/bmesh/progressive.h>
#include <kaboum/page/mesh_page.h>

#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>

#include "common/result_files.h"
#include "common/verdict.h"

namespace kaboum::tools {

namespace {

using certify::MeshCertificate;
using verify::Answer;

constexpr double kFar = 0.05;  ///< of the diagonal: worth a warning

/// Says all about one result.
class Lines {
 public:
  Lines(const DecimationCase& run, std::size_t place)
      : run_(run),
        place_(place),
        made_(run.series().meshes[place].certificate()),
        file_(run.files[place].empty() ? run.asked.progressive : run.files[place]) {}

  /// @return the exit code that this result gives
  [[nodiscard]] int conclude() const {
    say(summary());
    warn_of_distance();
    const int surface = made_.decided ? kDone : conclude_surface();
    const int verification = made_.decided ? conclude_verification(*made_.decided) : surface;
    const bool claims_nothing = !made_.closed && made_.direction != bmesh::Direction::Any;
    if (claims_nothing)
      complain(std::string("the mesh is open, so it has no solid that the result could ") +
               (run_.outer() ? "enclose" : "lie in") +
               "; the result is written. Leave out --holes keep to have the holes filled, or give "
               "--direction any if no enclosure is wished for");
    if (made_.stop == bmesh::Stop::OutOfWork) {
      complain("the work allowed has ended at " + std::to_string(made_.vertices) +
               " vertices; the result so far is written. Allow more with --max-work, or give "
               "--effort fast");
      return claims_nothing || verification == kNo ? kNo : kLimit;
    }
    if (made_.out_of_work)
      say("note: not as near as it might be: the work allowed has ended; allow more with "
          "--max-work");
    if (!made_.reached()) {
      complain(std::to_string(*made_.requested) + " vertices cannot be reached with --cost " +
               run_.asked.value("cost") + ": no further contraction is possible at " +
               std::to_string(made_.vertices) + "; the result so far is written");
      return kNo;
    }
    return claims_nothing ? kNo : verification;
  }

  [[nodiscard]] std::string summary() const {
    return file_ + ": " + page::summary_of(run_.made, place_);
  }

 private:
  void say(const std::string& text) const { log(run_.asked.common.quiet, text); }
  /// An error, about the input.
  void complain(const std::string& text) const {
    log(false, "bmesh-decimate: " + run_.asked.input + ": " + text);
  }

  void warn_of_distance() const {
    const double diagonal = run_.series().plan.diagonal;
    const auto warn = [&](const std::string& what, double length, const char* where) {
      if (!(length > kFar * diagonal)) return;
      say("warning: " + what + formatted(100 * length / diagonal) + "% of the diagonal " + where +
          "; " +
          (run_.series().plan.epsilon ? "use a smaller --epsilon"
                                      : "use more vertices, or --epsilon to bound the distance"));
    };
    warn("the result reaches ", made_.outliers.beyond_box, "beyond the input's bounding box");
    warn("the input has vertices ", made_.outliers.away, "away from the result");
  }

  [[nodiscard]] static std::string not_looked_at(const certify::DecidedSurface& surface) {
    return "whether " + std::to_string(surface.left_out) +
           (surface.left_out == 1 ? " triangle sticks" : " triangles stick") +
           " out was not decided, for the work allowed was done; allow more with --max-work";
  }

  /// Says which claim holds and which does not, where they differ. @return the exit code
  [[nodiscard]] int conclude_surface() const {
    const bool outer = run_.outer();
    if (made_.surface_answer() == Answer::Verified || !made_.surface) return kDone;
    const certify::DecidedSurface& surface = *made_.surface;
    if (surface.claim.answer != Answer::Refuted) {
      complain(std::string(outer ? "the input's solid is enclosed; "
                                 : "the result's solid is inside the input's; ") +
               not_looked_at(surface) + ". The result is written");
      return kLimit;
    }
    complain(sticking_out(surface) + ". The result is written" +
             (outer ? remedy() : std::string("; only its solid lies in the input's")));
    return kNo;
  }

  /// How to have all triangles enclosed.
  [[nodiscard]] std::string remedy() const {
    const std::string why = run_.made.why_not_wrapped;
    if (run_.asked.records())
      return "; --prepare wrap encloses every triangle, or write the wrap with mesh-prepare first, "
             "if steps are wished for";
    if (!why.empty()) return "; a wrap would hold every triangle, but: " + why;
    return "; --prepare wrap encloses every triangle";
  }

  [[nodiscard]] std::string sticking_out(const certify::DecidedSurface& surface) const {
    const bool outer = run_.outer();
    const std::size_t count = surface.claim.inner_triangles.size();
    const verify::Bracket& out = surface.sticks_out;
    const std::string depth = in_words(out);
    std::string text =
        outer ? "the input's solid is enclosed, but not all of its triangles"
              : "the result's solid is inside the input's, but not all of its triangles";
    text += (surface.left_out > 0 ? ": at least " : ": ") + std::to_string(count) +
            (count == 1 ? " sticks out" : " stick out");
    if (!depth.empty()) text += ", by " + depth;
    if (out.lower > 0)
      text += ", farthest at " + point(out.at) +
              (surface.at_filling ? ", where a hole was filled"
                                  : ", triangle " + std::to_string(out.triangle) +
                                        (outer ? " of the input" : " of the result"));
    text += " (the input is folded or inside out there: such faces bound no solid)";
    if (surface.left_out > 0) text += "; " + not_looked_at(surface);
    return text;
  }

  /// Says which claims are not verified. @return the exit code that they give
  [[nodiscard]] int conclude_verification(const certify::DecidedMesh& decided) const {
    int code = kDone;
    const auto look = [&](const std::string& what, Answer answer, const std::string& detail) {
      if (answer == Answer::Verified) return;
      log(false, "bmesh-decimate: " + file_ + ": " + what + " is " + name_of(answer) +
                     (detail.empty() ? "" : ": " + detail));
      if (answer == Answer::Undecided && code == kDone) code = kLimit;
      if (answer != Answer::Undecided) code = kNo;
    };
    look("the solid claim", decided.inclusion.solid.answer, decided.inclusion.solid.reason);
    if (made_.surface) {  // open meshes have none
      const verify::Claim& surface = made_.surface->claim;
      look("the surface claim", surface.answer,
           surface.answer == Answer::Refuted ? sticking_out(*made_.surface) : surface.reason);
      if (surface.answer == Answer::Refuted && run_.outer())
        say("note" + remedy().replace(0, 1, ":"));
    }
    if (decided.nested) look("the nesting in the level before", *decided.nested, "");
    look("a distance", decided.original_to_result, "");
    look("a distance", decided.result_to_original, "");
    if (code == kDone) say("verified from the written bytes");
    return code;
  }

  const DecimationCase& run_;
  std::size_t place_;
  const MeshCertificate& made_;
  std::string file_;
};

}  // namespace

std::string formatted(double x) {
  std::ostringstream s;
  s << std::setprecision(4) << x;
  return s.str();
}

bool say_shortage(const DecimationCase& run, const certify::Float32Shortage& shortage) {
  const std::string why = reason_of(shortage);
  if (run.request().may_be_double()) {
    log(run.asked.common.quiet, "note: " + why + ": writing double");
    return true;
  }
  log(false,
      "bmesh-decimate: " + run.asked.input + ": " + why +
          "; nothing is written. Write .ply, .obj, .off or (--output-format) stl-ascii, "
          "which hold doubles" +
          (run.asked.value("precision") == "auto" ? "" : ", with --precision double") + "; or " +
          remedy_of(shortage) +
          (run.made.why_not_wrapped.empty() ? ""
                                            : ". Nor is it wrapped: " + run.made.why_not_wrapped));
  return false;
}

std::string summary_of(const DecimationCase& run, std::size_t place) {
  return Lines(run, place).summary();
}

std::string page_of(const DecimationCase& run) {
  page::MeshWords words{run.asked.input, {}, run.notes};
  for (std::size_t i = 0; i < run.series().meshes.size(); ++i)
    words.summaries.push_back(summary_of(run, i));
  return page::page_of_meshes(words, run.made);
}

int conclude(const DecimationCase& run) {
  bool no = false, limit = false;
  for (std::size_t i = 0; i < run.series().meshes.size(); ++i) {
    const int code = Lines(run, i).conclude();
    no = no || code == kNo;
    limit = limit || code == kLimit;
  }
  if (!run.made.undecided.empty()) {
    log(false, "bmesh-decimate: " + run.asked.input +
                   ": whether all that its triangles bound is enclosed is NOT decided: " +
                   run.made.undecided + ". The result is written; --prepare wrap encloses it");
    limit = true;
  }
  return no ? kNo : limit ? kLimit : kDone;
}

namespace {

const char* name_of_stop(bmesh::Stop stop) {
  switch (stop) {
    case bmesh::Stop::VertexTarget:
      return "vertices";
    case bmesh::Stop::ErrorBound:
      return "epsilon";
    case bmesh::Stop::OutOfWork:
      return "out of work";
    case bmesh::Stop::Exhausted:
      break;
  }
  return "exhausted";
}

Json input_of(const DecimationCase& run) {
  Json json{{"file", run.asked.input},
            {"sha256", run.log.input_sha256},
            {"unit", run.input.unit},
            {"scale", run.asked.unit.scale},
            {"reader_delivers_float32", run.input.single_precision},
            {"file_vertices", run.input.file_vertices},
            {"file_triangles", run.input.file_triangles},
            {"split_polygons", run.input.split_polygons}};
  json.update(to_json(geom::analyse(run.original().solid.mesh())));
  return json;
}

Json preparation_of(const DecimationCase& run) {
  const geom::PreparationReport& p = run.original().report;
  return {{"prepare", run.asked.value("prepare")},
          {"why_wrapped", run.made.why_wrapped.empty() ? Json() : Json(run.made.why_wrapped)},
          {"why_not_wrapped",
           run.made.why_not_wrapped.empty() ? Json() : Json(run.made.why_not_wrapped)},
          {"undecided", run.made.undecided.empty() ? Json() : Json(run.made.undecided)},
          {"wrap", run.wrap() ? Json::parse(certify::to_json(*run.wrap())) : Json()},
          {"collapsed_triangles", run.input.collapsed_triangles + p.collapsed_triangles},
          {"dropped_copies", p.dropped_copies},
          {"cancelled_walls", p.cancelled_walls},
          {"dropped_sheets", p.dropped_sheets},
          {"turned_components", p.reversed_components},
          {"turned_triangles", p.reversed_triangles},
          {"holes", p.holes},
          {"filled_triangles", run.original().solid.filled_triangles()},
          {"largest_hole", p.largest_hole},
          {"notes", run.notes}};
}

Json options_of(const DecimationCase& run) {
  const DecimationOptions& o = run.asked;
  const certify::MeshPlan& plan = run.series().plan;
  const certify::MeshRequest& r = o.mesh.request;
  certify::MeshOptions planned;
  planned.request.effort = plan.effort;
  return {{"direction", o.value("direction")},
          {"cost", o.value("cost")},
          {"effort", value_of(certify::mesh_options(), "effort", planned)},
          {"as_printed", r.as_printed},
          {"precision", plan.precision == bmesh::Precision::Double ? "double" : "float"},
          {"vertices", plan.vertices.empty()       ? Json()
                       : plan.vertices.size() == 1 ? Json(plan.vertices.front())
                                                   : Json(plan.vertices)},
          {"epsilon", plan.epsilon ? Json(*plan.epsilon) : Json()},
          {"sharp_angle", r.sharp_angle.value_or(bmesh::kSharpAngle)},
          {"keep_convex", r.keep_convex},
          {"max_work", r.max_work ? Json(*r.max_work) : Json()}};
}

Json verification_of(const certify::DecidedMesh& decided) {
  const auto claim = [](const verify::Claim& c) {
    Json json{{"answer", name_of(c.answer)}, {"reason", c.reason}};
    if (c.witness) {
      json["depth"] = c.witness->depth;
      json["triangles"] = c.inner_triangles.size() + c.outer_triangles.size();
    }
    return json;
  };
  Json json{{"solid", claim(decided.inclusion.solid)},
            {"relative", decided.inclusion.relative},
            {"surface", claim(decided.inclusion.surface)},
            {"distance_bound", decided.distance_bound},
            {"distance_original_to_result", name_of(decided.original_to_result)},
            {"distance_result_to_original", name_of(decided.result_to_original)}};
  if (decided.nested) json["nested"] = name_of(*decided.nested);
  return json;
}

/// The same words as under "verification".
std::string decided_surface(const verify::Claim& surface, bool outer) {
  std::string text = name_of(surface.answer);
  if (surface.answer == Answer::Verified)
    return text + (outer ? ": every triangle of the input lies in the result's solid"
                         : ": every triangle of the result lies in the input's solid");
  if (surface.answer == Answer::Refuted)
    return text + ": " + std::to_string(surface.inner_triangles.size()) + " triangles of the " +
           (outer ? "input do not lie in the result's solid"
                  : "result do not lie in the input's solid");
  return surface.reason.empty() ? text : text + ": " + surface.reason;
}

void add_surface(Json& json, const MeshCertificate& c, bool outer) {
  if (!c.closed) {
    json["surface"] = "none";
  } else if (c.surface) {
    const certify::DecidedSurface& surface = *c.surface;
    json["surface"] = decided_surface(surface.claim, outer);
    json["surface_triangles_looked_at"] = surface.looked_at;
    if (surface.left_out > 0) json["surface_triangles_left_out"] = surface.left_out;
    if (surface.claim.answer == Answer::Refuted) {
      const verify::Bracket& out = surface.sticks_out;
      json["surface_triangles_outside"] = surface.claim.inner_triangles.size();
      json["surface_depth"] = {{"lower", out.lower},
                               {"upper", std::isfinite(out.upper) ? Json(out.upper) : Json()},
                               {"at", {out.at.x(), out.at.y(), out.at.z()}},
                               {"triangle", surface.at_filling ? Json() : Json(out.triangle)}};
    }
  }
}

Json claims_of(const DecimationCase& run, const MeshCertificate& c) {
  if (c.direction == bmesh::Direction::Any) return {{"solid", "none"}, {"surface", "none"}};
  const bool outer = run.outer();
  Json json{{"of", in_words(c.subject)}};
  json["solid"] = c.closed ? (outer ? "certified: the result's solid contains the input's"
                                    : "certified: the input's solid contains the result's")
                           : "open mesh: certified only that the generalised winding number "
                             "nowhere " +
                                 std::string(outer ? "falls" : "rises");
  if (run.series().meshes.size() > 1)
    json["nested"] = outer ? "certified: contains the finer results"
                           : "certified: contained in the finer results";
  add_surface(json, c, outer);
  return json;
}

Json steps_of(const bmesh::DecimateStatistics& s) {
  return {{"contractions", s.contractions},
          {"moves", s.moves},
          {"pull_backs", s.pull_backs},
          {"flips", s.flips},
          {"placements", s.placements},
          {"predicates", s.predicates},
          {"exact_fallbacks", s.exact_fallbacks},
          {"rejected",
           {{"topology", s.rejected_topology},
            {"no_position", s.rejected_no_position},
            {"predicate", s.rejected_predicate},
            {"fold", s.rejected_fold},
            {"distance", s.rejected_distance},
            {"spike", s.rejected_spike},
            {"original", s.rejected_original}}}};
}

/// What the report says of one result.
Json result_of(const DecimationCase& run, std::size_t place) {
  const certify::CertifiedMesh& made = run.series().meshes[place];
  const MeshCertificate& c = made.certificate();
  const std::string& file = run.files[place];
  const double diagonal = run.series().plan.diagonal;
  Json r;
  r["stop"] = name_of_stop(c.stop);
  r["out_of_work"] = c.out_of_work;
  r["output"] = {{"file", file.empty() ? Json() : Json(file)},
                 {"precision", c.double_precision ? "double" : "float"}};
  r["output"].update(to_json(geom::analyse(made.artefact())));
  r["claims"] = claims_of(run, c);
  if (c.decided) r["verification"] = verification_of(*c.decided);
  r["certificate"] = steps_of(c.statistics);
  r["distance"] = {{"meaning",
                    "one-sided, surface to surface, certified brackets of the maximum, in the "
                    "input's unit; "
                    "the original is the input after preparation"},
                   {"bbox_diagonal", diagonal},
                   {"original_to_result", to_json(*c.original_to_result, diagonal)},
                   {"result_to_original", to_json(*c.result_to_original, diagonal)},
                   {"hausdorff_upper", c.hausdorff_upper()}};
  return r;
}

}  // namespace

Json report_of(const DecimationCase& run) {
  Json r{
      {"input", input_of(run)}, {"preparation", preparation_of(run)}, {"options", options_of(run)}};
  if (!run.asked.progressive.empty()) r["progressive"] = run.asked.progressive;
  if (run.series().meshes.size() == 1) {
    r.update(result_of(run, 0));
  } else {
    for (std::size_t i = 0; i < run.series().meshes.size(); ++i) {
      const MeshCertificate& c = run.series().meshes[i].certificate();
      Json& entry = r["levels"].emplace_back();
      entry["vertices"] = *c.requested;
      entry["reached"] = c.stop == bmesh::Stop::VertexTarget;
      entry.update(result_of(run, i));
    }
  }
  r["resources"] = {{"user_seconds_reading", run.seconds_read},
                    {"user_seconds_decimating", run.seconds_decimated - run.seconds_read},
                    {"threads", run.asked.common.threads}};
  return r;
}

namespace {

bmesh::Progressive progressive(const DecimationCase& run) {
  bmesh::Progressive p{run.log,
                       run.series().plan.precision == bmesh::Precision::Double,
                       run.original().solid.mesh(),
                       {}};
  for (const certify::CertifiedMesh& made : run.series().meshes) {
    const certify::MeshCertificate& c = made.certificate();
    p.levels.push_back({c.requested.value_or(c.vertices), c.vertices, c.steps});
  }
  return p;
}

void write_rule(const DecimationCase& run) {
  std::vector<std::string> targets = run.files;
  if (!run.asked.progressive.empty()) targets.push_back(run.asked.progressive);
  std::vector<std::string> inputs{run.asked.input};
  inputs.insert(inputs.end(), run.input.other_files.begin(), run.input.other_files.end());
  write_depfile(run.asked.depfile, targets, inputs);
}

}  // namespace

void require_separate_files(const DecimationOptions& asked, const std::vector<std::string>& files) {
  std::vector<std::pair<std::string, std::string>> outputs{{"--log", asked.log},
                                                           {"--progressive", asked.progressive},
                                                           {"--preview", asked.preview},
                                                           {"--report", asked.common.report},
                                                           {"--depfile", asked.depfile}};
  for (const std::string& file : files) outputs.emplace_back("--output", file);
  require_apart(outputs, {asked.input});
}

void write_files(const DecimationCase& run) {
  const DecimationOptions& o = run.asked;
  std::vector<std::pair<std::string, std::function<void()>>> files;
  files.emplace_back(o.log, [&] { io::write_file(o.log, bmesh::serialise_log(run.log)); });
  files.emplace_back(o.progressive, [&] {
    io::write_file(o.progressive, bmesh::serialise_progressive(progressive(run)));
  });
  files.emplace_back(o.preview, [&] { io::write_file(o.preview, page_of(run)); });
  files.emplace_back(o.common.report,
                     [&] { write_report(o.common, "bmesh-decimate", report_of(run)); });
  files.emplace_back(o.depfile, [&] { write_rule(run); });
  for (std::size_t i = 0; i < run.series().meshes.size(); ++i)
    files.emplace_back(run.files[i],
                       [&run, i] { io::write_file(run.files[i], run.series().meshes[i].bytes()); });
  write_together(files);
}

}  // namespace kaboum::tools
