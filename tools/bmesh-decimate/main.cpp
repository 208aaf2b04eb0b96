// Bounding meshes: reads, has kaboum::certify make and certify them, writes.

#include <kaboum/base/error.h>
#include <kaboum/bmesh/log.h>
#include <kaboum/certify/large_epsilon.h>
#include <kaboum/certify/mesh_file.h>

#include <CLI/CLI.hpp>
#include <utility>

#include "common/result_files.h"
#include "levels.h"
#include "results.h"
#include "robot.h"

namespace {

using namespace kaboum;  // the tool's own names are few

void say(const tools::DecimationCase& run, const std::string& text) {
  tools::log(run.asked.common.quiet, text);
}

void note(tools::DecimationCase& run, const std::string& text) {
  say(run, "note: " + text);
  run.notes.push_back(text);
}

/// Whether the triangles stand for exact faces, which are to be enclosed as well.
bool wraps_exact_faces(const tools::DecimationOptions& o, io::Format format) {
  return io::is_cad(format) && o.mesh.request.direction == bmesh::Direction::Outer &&
         o.mesh.preparation.holds_exact_faces();
}

/// What is asked for, where it is not contradictory.
tools::DecimationCase case_of(const tools::DecimationOptions& o) {
  tools::require_sound(o);
  tools::DecimationCase run{.asked = o};
  run.files = tools::level_files(o.output, o.mesh.request.vertices);
  tools::require_separate_files(o, run.files);
  if (!o.depfile.empty() && (o.output.empty() || o.output == "-"))
    throw Error(ErrorCode::InvalidArgument, "--depfile needs a result that is a file");
  std::optional<io::Format> format;  // none: only the progressive file is written
  if (!o.output.empty()) format = tools::format_for(o.output, o.output_format, "--output-format");
  run.input.format = tools::format_for(o.input, o.input_format);
  tools::require_sound_formats(o, format);
  if (wraps_exact_faces(o, run.input.format) && o.records())
    throw Error(ErrorCode::InvalidArgument,
                "--log and --progressive start from triangles, and " + o.input +
                    " has exact faces: write a wrap round them with mesh-prepare first, and "
                    "simplify that, or claim it of the triangles alone (--prepare strict)");
  run.options = tools::mesh_options_of(o, format);
  return run;
}

void read(tools::DecimationCase& run) {
  const tools::DecimationOptions& o = run.asked;
  const bool hash = o.records() || !o.common.report.empty();
  std::vector<char> bytes;
  run.input = io::read_mesh(o.input, run.input.format, hash ? &bytes : nullptr);
  if (hash) run.log.input_sha256 = io::sha256(bytes);
  apply(run.input, o.unit, o.input);
  tools::naming(o.input,
                [&] { bring_lengths_into(run.input.unit, certify::mesh_options(), run.options); });
  for (const std::string& text : run.input.notes) note(run, text);
  if (const std::string text =
          certify::warning_of(run.request().epsilon, geom::bounding_box(run.input.mesh).diagonal());
      !text.empty())
    note(run, text);
  if (o.records() && !run.input.bent_quads.empty())
    note(run,
         "quads that are not plane stay split as they are read, for the steps start from there: "
         "bound-verify judges that without --prepare");
}

/// Makes and certifies the results.
void bound(tools::DecimationCase& run) {
  const tools::DecimationOptions& o = run.asked;
  {
    tools::Progress progress(o.common.quiet);
    const certify::MeshHooks hooks{
        .progress = [&](const std::string& stage) { progress.show(stage); },
        .found = [&] { run.seconds_decimated = tools::user_seconds(); },
        .prepared = [&] { run.seconds_read = tools::user_seconds(); }};
    run.made = tools::naming(o.input, [&] {
      return bound_mesh(
          run.input.mesh, run.request(),
          certify::preparation_of(run.options, run.input.bent_quads, run.input.deviation), hooks);
    });
  }
  for (const std::string& text : notes_of(run.made)) note(run, text);
  if (!run.original().solid.closed())
    note(run, "its border stays where it is, as --holes keep asks");
  if (o.records()) {
    run.log.direction = run.request().direction;
    run.log.tool = run.request().comment;
    bmesh::record_preparation(run.original().report, run.input.mesh.triangles.size(), run.log);
    run.log.steps = std::move(run.made.series.steps);
  }
  run.input.mesh = {};
}

/// Says what was planned. @return whether there are numbers that results are made of
bool say_plan(tools::DecimationCase& run) {
  const tools::DecimationOptions& o = run.asked;
  const certify::MeshPlan& plan = run.series().plan;
  const auto& shortage = run.series().shortage;
  if (shortage && !say_shortage(run, *shortage)) return false;
  if (o.stated.contains("effort") && plan.effort != run.request().effort)
    note(run, "--effort " + o.value("effort") + " has no effect " +
                  (run.request().keep_convex ? "with --keep-convex" : "on open meshes"));
  return true;
}

int simplify_robot(const CLI::App& app, const tools::DecimationOptions& options) {
  try {
    return tools::decimate_robot(app, options);
  } catch (const certify::TooCoarse& error) {  // a valid "no"
    tools::log(false, std::string(error.what()) + ". Nothing is written");
    return tools::kNo;
  }
}

int decimate(const tools::DecimationOptions& options) {
  tools::DecimationCase run = case_of(options);
  read(run);
  bound(run);
  if (!say_plan(run)) return tools::kNo;
  write_files(run);
  return conclude(run);
}

/// Takes results from a progressive file: what makes a result is in there.
int extract(const CLI::App& app, const tools::DecimationOptions& o) {
  std::vector<std::string> others{"INPUT",      "--progressive", "--require-closed",
                                  "--log",      "--preview",     "--input-format",
                                  "--importer", "--unit",        "--scale"};
  for (const auto& option : certify::mesh_options())
    if (option.name != "vertices") others.push_back("--" + option.name);
  tools::require_absent(app, "--from", others);
  return tools::extract_levels(
      {o.from, o.output, o.output_format, o.mesh.request.vertices, o.depfile, o.common});
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Simplifies a triangle mesh so that the result provably encloses it (or is enclosed by it).",
      "bmesh-decimate");
  tools::DecimationOptions options;
  describe(app, options);
  return tools::run(app, argc, argv, [&] {
    const tools::ThreadLimit limit(options.common.threads);
    const bool robot = tools::is_robot(options.input);
    if (robot && (options.from == "collision" || options.from == "visual"))
      options.robot.shapes.visual = std::exchange(options.from, {}) == "visual";
    if (!options.from.empty()) return extract(app, options);
    if (options.mesh.preparation.mode != certify::PreparationOptions::Mode::Auto)
      tools::require_absent(app, "--prepare " + options.value("prepare"), {"--require-closed"});
    if (robot) return simplify_robot(app, options);
    tools::require_options_of_meshes(app, options.input);
    return decimate(options);
  });
}
