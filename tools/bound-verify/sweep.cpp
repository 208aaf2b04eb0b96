// `bound-verify sweep`: reads robot, path and set, has the claims decided, says what was found.
#include "sweep.h"

#include <kaboum/base/error.h>
#include <kaboum/robot/base_pose.h>
#include <kaboum/robot/path_file.h>

#include <iostream>
#include <optional>

#include "common/verdict.h"
#include "mesh_input.h"
#include "sweep_report.h"
#include "witness_file.h"

namespace kaboum::tools {
namespace {

using verify::Answer;

/// A container, a mesh file, a folder, or a URDF as sweep-approx writes it.
verify::SweptBodies read_swept(const std::string& path, const VerifySweepOptions& o) {
  std::optional<io::Format> format;
  const bool urdf = o.set_format.empty() && std::filesystem::path(path).extension() == ".urdf";
  if (!urdf && !is_folder(path)) format = format_for(path, o.set_format, "--approximation-format");
  return verify::read_swept_bodies(path, format, o.how.shapes.choice.packages);
}

/// Reads everything, and says what is to be known of it.
SweepCase read(const VerifySweepOptions& o, const CommonOptions& common) {
  SweepCase run{o,
                robot::read_robot(o.robot, robot::Motions::All, o.xacro_arguments,
                                  o.how.shapes.choice.packages),
                {},
                {},
                {},
                {}};
  if (!o.how.base_pose.empty())
    naming(o.robot, [&] {
      run.robot.robot =
          robot::placed(run.robot.robot, robot::parse_pose(o.how.base_pose, "--base-pose"));
    });
  std::vector<std::string> notes;
  run.path = robot::read_path(o.path, run.robot.robot, o.how.reading, notes);
  run.shapes = verify::read_motion_shapes(run.robot, o.how.shapes);
  require_apart({{"--report", common.report}, {"--witness", o.witness}}, run.shapes.files);
  run.swept = read_swept(o.swept, o);
  for (const auto& more : {run.shapes.notes, run.shapes.mesh_notes.lines()})
    notes.insert(notes.end(), more.begin(), more.end());
  for (const std::string& note : notes) log(common.quiet, note);
  for (const std::string& note : run.swept.notes) log(common.quiet, o.swept + ": " + note);
  return run;
}

void decide(SweepCase& run, Progress& progress) {
  const VerifySweepOptions& o = run.asked;
  verify::MotionQuestion question{run.robot.robot, run.shapes, run.path, run.swept.set,
                                  o.how.claims};
  question.gap = o.how.gap;
  question.max_cells = o.how.max_cells;
  question.progress = [&](const std::string& what) { progress.show("deciding: " + what); };
  run.verdict = verify::decide(question);
}

/// What to try where the meshes as they are were not found within the set; empty if nothing.
std::string preparing_hint(const verify::MotionShapes& shapes) {
  std::string changed;
  for (const std::string& path : shapes.files) {
    const geom::Mesh mesh = io::read_mesh(path).mesh;
    const auto prepared = [&](bool drop_sheets) -> std::optional<geom::Prepared> {
      try {
        return prepare_original(mesh, drop_sheets, true);
      } catch (const Error&) {
        return std::nullopt;
      }
    };
    if (const auto plain = prepared(false)) {
      if (changed.empty() && !plain->report.notes.empty()) changed = path;
    } else if (prepared(true)) {
      return path +
             ": sweep-approx takes it with --drop-sheets only, and as prepared; --prepare "
             "--drop-sheets judges that";
    }
  }
  if (changed.empty()) return {};
  return changed + ": sweep-approx speaks of the mesh as prepared; --prepare judges that";
}

}  // namespace

int verify_sweep(const VerifySweepOptions& o, const CommonOptions& common) {
  require_apart({{"--report", common.report}, {"--witness", o.witness}},
                {o.robot, o.path, o.swept});
  require_witness_format(o.witness);
  const ThreadLimit threads(common.threads);
  SweepCase run = read(o, common);
  Progress progress(common.quiet);
  decide(run, progress);
  progress.show("");
  if (!common.report.empty()) write_report(common, "bound-verify", report_of(run));
  const verify::MotionVerdict& found = run.verdict;
  if (!o.witness.empty() && found.claims.refuting)
    write_witness(o.witness, {found.claims.refuting->triangle, {{0, 1, 2}}},
                  "a part of the robot that is outside the swept set");
  if (common.quiet) return exit_code(found.answer);
  std::ostream& out = common.report == "-" ? std::cerr : std::cout;
  for (const std::string& line : lines_of(run)) out << line << '\n';
  if (found.answer != Answer::Verified && !o.how.shapes.prepare)
    if (const std::string hint = preparing_hint(run.shapes); !hint.empty())
      log(common.quiet, "note: " + hint);
  return exit_code(found.answer);
}

}  // namespace kaboum::tools
