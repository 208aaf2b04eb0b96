// bmesh-decimate on robots: encloses the links' meshes, writes a folder, and says what came of it.

#include "robot.h"

#include <kaboum/base/counted.h>
#include <kaboum/base/error.h>
#include <kaboum/certify/link_enclosures.h>
#include <kaboum/certify/mesh_file.h>
#include <kaboum/page/robot_page.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/robot_folder/enclosed_folder.h>

#include <algorithm>

#include "common/last_words.h"
#include "common/result_files.h"
#include "results.h"
#include "robots/bodies.h"
#include "robots/check.h"
#include "robots/next_steps.h"
#include "robots/output.h"
#include "robots/summary.h"

namespace kaboum::tools {
namespace {

using robot_folder::RobotWriter;

/// Format of the new meshes: what engines read.
io::Format format_of_meshes(const DecimationOptions& o) {
  const std::string name = o.output_format.empty() ? o.robot.bodies : o.output_format;
  if (name != "stl" && name != "obj")
    throw Error(ErrorCode::InvalidArgument,
                "--output-format " + name + ": a robot's meshes are stl or obj");
  return name == "stl" ? io::Format::Stl : io::Format::Obj;
}

certify::EnclosureRequest enclosure_request(const DecimationOptions& o) {
  require_sound(o);
  if (o.mesh.request.vertices.size() > 1)
    throw Error(ErrorCode::InvalidArgument, "--vertices: a robot's meshes are no series");
  const io::Format format = format_of_meshes(o);
  require_sound_formats(o, format);
  const bool may_change = o.output_format.empty() && format == io::Format::Stl;
  return certify::link_request_of(mesh_options_of(o, format),
                                  may_change ? std::nullopt : std::optional(format));
}

/// What was made, and where it goes.
struct Run {
  const DecimationOptions& o;
  robot::RobotFile robot;
  certify::LinkEnclosuresRequest request = {};
  certify::LinkEnclosures made = {};
  std::vector<certify::LinkVerdict> verdicts = {};
  Notes notes = {};    ///< on meshes
  Notes written = {};  ///< on what was written

  [[nodiscard]] int code() const { return exit_code(outcome_of(verdicts)); }
};

/// What was asked for and not reached, and what helps; empty: nothing.
std::string shortfall(const certify::EnclosureCertificate& c) {
  if (c.stop == bmesh::Stop::OutOfWork)
    return "the work allowed has ended; the result so far is written. Allow more with --max-work, "
           "or give --effort fast";
  if (!c.reached) return "fewer vertices cannot be reached; the result so far is written";
  if (c.inside.answer == verify::Answer::Refuted)
    return "not every triangle is inside: some bound no solid; --prepare wrap encloses those as "
           "well";
  return {};
}

std::string summary(const certify::EnclosureCertificate& c) {
  return std::to_string(c.vertices_in) + " → " + std::to_string(c.vertices) +
         " vertices, outer, certified, within " + formatted(c.distance_upper) + " (" +
         formatted(c.diagonal > 0 ? 100 * c.distance_upper / c.diagonal : 0) + "%)";
}

/// Lines of the links that have shapes.
std::vector<LinkLine> lines_of(const Run& run) {
  std::vector<LinkLine> out;
  std::size_t at = 0;
  for (const std::vector<robot::LinkShape>& shapes : run.made.shapes_by_link()) {
    const robot::Link& link = run.robot.robot.links[shapes.front().link];
    LinkLine& line = out.emplace_back();
    line.name = link.name;
    line.outcome = run.verdicts[at].outcome;
    line.dropped_sheets = run.verdicts[at++].dropped_sheets;
    line.epsilon = page::epsilon_of(link.name, run.request.epsilons, run.request.mesh.mesh.epsilon);
    line.vertices = 0;
    for (const robot::LinkShape& shape : shapes) {
      if (!shape.mesh || !run.made.meshes[*shape.mesh].flaw.empty()) continue;
      const certify::EnclosureCertificate& c =
          run.made.meshes[*shape.mesh].made.enclosure.certificate();
      const robot::Geometry& place = run.request.shapes.shapes_of(link)[shape.index];
      ++line.bodies;
      *line.vertices += c.vertices;
      line.within = std::max(line.within, c.distance_upper * place.size.cwiseAbs().maxCoeff());
    }
  }
  return out;
}

void say_meshes(Run& run) {
  const bool quiet = run.o.common.quiet;
  Notes shortfalls;
  for (const certify::EnclosedLinkMesh& mesh : run.made.meshes) {
    const std::string file = mesh.mesh.file.string();
    if (!mesh.flaw.empty()) {
      if (run.o.robot.verbose) log(quiet, mesh.flaw);
      continue;
    }
    const certify::EnclosureCertificate& c = mesh.made.enclosure.certificate();
    if (run.o.robot.verbose)
      log(quiet, file + ": " + summary(c) + (mesh.made.cached ? " (from the cache)" : ""));
    if (const std::string why = shortfall(c); !why.empty())
      shortfalls.add(mesh.mesh.file.filename().string(), why);
    for (const std::string& text : mesh.made.read_notes) run.notes.add(file, text);
    for (const std::string& text : c.notes) run.notes.add(file, text);
  }
  for (const std::string& line : table_of(lines_of(run), "meshes", "m")) log(quiet, line);
  for (const std::string& line : shortfalls.lines()) log(quiet, line);
}

std::vector<std::string> all_notes(const Run& run) {
  std::vector<std::string> out = run.notes.lines();
  for (std::string& text : run.written.lines()) out.push_back(std::move(text));
  return out;
}

std::string counts_in_words(const Run& run) {
  const page::RobotCounts counts = page::counts_of(run.made);
  const auto cached = std::ranges::count_if(
      run.made.meshes, [](const auto& mesh) { return mesh.flaw.empty() && mesh.made.cached; });
  std::string out =
      counted(counts.bodies, "mesh", "meshes") + " of " + counted(counts.links, "link", "links");
  if (counts.kept + counts.missing > 0) out += ", from " + counts.of_meshes();
  if (cached > 0) out += " (" + std::to_string(cached) + " from the cache)";
  return out;
}

/// The command that decides it from the files alone; epsilon as well, where it is one for all links
/// and of distances to what the files hold, not to wraps or exact faces.
RobotCheck check_of(const Run& run, const RobotWriter& output) {
  std::optional<Length> epsilon = run.request.mesh.mesh.epsilon;
  if (!run.request.epsilons.empty() || outcome_of(run.verdicts) != certify::Outcome::Held)
    epsilon.reset();
  for (const certify::EnclosedLinkMesh& mesh : run.made.meshes)
    if (!mesh.flaw.empty() || mesh.made.enclosure.certificate().wrap) epsilon.reset();
  return tools::check_of(run.o.input, output.folder().urdf().string(), run.o.robot,
                         run.o.mesh.preparation, epsilon, {}, run.verdicts);
}

Json decimated_report(const Run& run, const RobotWriter& output) {
  Json report = report_of(output), links = Json::array();
  const page::RobotCounts counts = page::counts_of(run.made);
  std::size_t before = 0, at = 0;
  for (const std::vector<robot::LinkShape>& shapes : run.made.shapes_by_link()) {
    Json link{{"link", run.robot.robot.links[shapes.front().link].name},
              {"shapes", shapes.size()},
              {"meshes", Json::array()}};
    link.update(report_of(run.verdicts[at++]));
    for (const robot::LinkShape& shape : shapes) {
      if (!shape.mesh) continue;
      const certify::EnclosedLinkMesh& mesh = run.made.meshes[*shape.mesh];
      if (!mesh.flaw.empty()) {
        link["meshes"].push_back({{"file", mesh.mesh.file.string()}, {"flaw", mesh.flaw}});
        continue;
      }
      Json result = Json::parse(certify::to_json(mesh.made.enclosure));
      result["cached"] = mesh.made.cached;
      link["meshes"].push_back({{"file", mesh.mesh.file.string()},
                                {"sha256", mesh.made.sha256},
                                {"result", std::move(result)}});
    }
    links.push_back(std::move(link));
  }
  for (const certify::EnclosedLinkMesh& mesh : run.made.meshes)
    if (mesh.flaw.empty()) before += mesh.made.enclosure.certificate().vertices_in;
  report.update({{"meshes", counts.meshes},
                 {"meshes_kept", counts.kept},
                 {"meshes_missing", counts.missing},
                 {"vertices_in", before},
                 {"vertices", counts.vertices},
                 {"links", std::move(links)},
                 {"stop", run.code() == kDone    ? "done"
                          : run.code() == kLimit ? "limit"
                                                 : "not reached"},
                 {"verdict", name_of(outcome_of(run.verdicts))},
                 {"sentence", in_words(run.verdicts)},
                 {"check", check_of(run, output).command},
                 {"input", {{"file", run.o.input}}},
                 {"notes", all_notes(run)},
                 {"parameters", run.request.mesh.parameters()}});
  return report;
}

void write_page(const Run& run, const RobotWriter& output) {
  const RobotCheck check = check_of(run, output);
  const page::RobotPage page{.robot = run.robot.robot.name,
                             .source = run.o.input,
                             .tool = std::string("bmesh-decimate ") + version(),
                             .command = check.command,
                             .passes = check.passes,
                             .unit = "the robot's unit",
                             .files = output.documents(),
                             .notes = all_notes(run),
                             .steps = next_steps(output, run.o.robot, check, {}),
                             .links = page::page_links(run.robot, run.made, run.request),
                             .counts = page::counts_of(run.made),
                             .made = "meshes"};
  io::write_file(run.o.robot.html, to_html(page));
}

void require_separate(const DecimationOptions& o) {
  std::vector<std::string> inputs{o.input};
  if (!o.robot.epsilons.empty()) inputs.push_back(o.robot.epsilons);
  require_apart({{"--output", o.output},
                 {"--report", o.common.report},
                 {"--html-report", o.robot.html},
                 {"--depfile", o.depfile}},
                inputs);
}

}  // namespace

int decimate_robot(const CLI::App& app, DecimationOptions o) {
  require_absent(app, "a robot (.urdf), whose page is --html-report", {"--preview"});
  require_absent(app, "a robot (.urdf)", {"--progressive", "--log"});
  require_absent(app, "a robot (.urdf), which states its meshes' scales itself",
                 {"--unit", "--scale"});
  if (o.mesh.request.direction != bmesh::Direction::Outer)
    throw Error(ErrorCode::InvalidArgument, "--direction " + o.value("direction") +
                                                ": a robot's meshes are enclosed; simplify them "
                                                "one by one for others");
  require_robot_folder(o.output, "");
  if (o.robot.writes("usd"))
    throw Error(ErrorCode::InvalidArgument,
                "--robot-format usd is for convex bodies (bcd-decompose): enclosing meshes have "
                "hollows, which convexHull would fill");
  apply_preset(app, o.output, o.robot, nullptr);
  bring_lengths_into("m", certify::mesh_options(), o.mesh);
  require_separate(o);
  Run run{o, robot::read_robot(o.input, robot::Motions::None, o.robot.xacro_arguments,
                               o.robot.shapes.packages)};
  const std::vector<std::string> included =
      o.depfile.empty() ? std::vector<std::string>() : robot::included_files(run.robot);
  const io::Format format = format_of_meshes(o);
  o.robot.declare_convex = false;  // they are not
  RobotWriter output(folder_options(o.robot), o.output, run.robot, "meshes",
                     format == io::Format::Stl ? ".stl" : ".obj");
  run.request = {enclosure_request(o),
                 output.options().shapes,
                 {},
                 read_epsilons(o.robot.epsilons, run.robot.robot)};
  run.request.partial = true;
  run.request.format = o.input_format.stated();
  const certify::WantedMeshes meshes =
      certify::wanted_meshes(run.robot, run.request.shapes, run.request.epsilons);
  output.plan(meshes);
  require_formats(meshes, o.input_format);
  {
    Progress progress(o.common.quiet);
    LastWords words(o.common.quiet);
    words.set(std::string("bmesh-decimate: ended by a signal, and nothing is written. ") +
              (o.no_cache ? "Nothing is kept (--no-cache)"
                          : "The cache keeps the meshes that are done: the same command goes on "
                            "there"));
    const certify::CacheFolder cache(certify::CacheFolder::default_folder());
    run.made = certify::enclose_links(run.robot, run.request, o.no_cache ? nullptr : &cache,
                                      [&](const std::string& stage) { progress.show(stage); });
  }
  run.verdicts = verdicts(run.made);
  say_meshes(run);
  std::optional<certify::CacheFolder> written;
  if (!o.no_cache) written.emplace(certify::CacheFolder::default_folder());
  robot_folder::write_enclosed(output, run.made, written ? &*written : nullptr,
                               note_in(run.written));
  log(o.common.quiet, output.folder().urdf().string() + ": " + counts_in_words(run));
  say_verdicts(run.robot.robot, run.verdicts, o.common.quiet);
  log(o.common.quiet, "from the files alone: " + check_of(run, output).command);
  say(output, o.robot, o.common.quiet);
  for (const std::string& text : run.written.lines()) log(o.common.quiet, text);
  say_notes(o.robot, o.common.quiet, run.notes);
  if (!o.robot.html.empty()) write_page(run, output);
  if (!o.common.report.empty())
    write_report(o.common, "bmesh-decimate", decimated_report(run, output));
  if (!o.depfile.empty()) {
    std::vector<std::string> inputs{o.input};
    if (!o.robot.epsilons.empty()) inputs.push_back(o.robot.epsilons);
    inputs.insert(inputs.end(), included.begin(), included.end());
    for (std::string& file : strings(run.made.files)) inputs.push_back(std::move(file));
    write_depfile(o.depfile, output.documents(), inputs);
  }
  return run.code();
}

}  // namespace kaboum::tools
