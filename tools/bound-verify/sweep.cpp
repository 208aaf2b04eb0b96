// `bound-verify sweep`: reads robot, path and set, has the claims decided, says what was found.
#include "sweep.h"

#include <kaboum/base/error.h>
#include <kaboum/robot/base_pose.h>
#include <kaboum/robot/path_file.h>
#include <kaboum/verify/moving_robot.h>

#include <algorithm>
#include <iostream>

#include "common/motion_options.h"
#include "common/verdict.h"
#include "sweep_report.h"
#include "witness_file.h"

namespace kaboum::tools {
namespace {

using verify::Answer;

/// Reads everything, and says what is to be known of it.
SweepCase read(const VerifySweepOptions& o, const CommonOptions& common) {
  SweepCase run{o, robot::read_robot(o.files[0]), {}, {}, {}, 0, {}};
  if (!o.base_pose.empty())
    naming(o.files[0], [&] {
      run.robot.robot =
          robot::placed(run.robot.robot, robot::parse_pose(o.base_pose, "--base-pose"));
    });
  // Limits are no matter of the set.
  std::vector<std::string> notes;
  run.path = robot::read_path(o.files[1], run.robot.robot,
                              {false, o.degrees, fixed_joints(o.joints)}, notes);
  run.shapes = read_shapes(run.robot, o);
  require_apart({{"--report", common.report}, {"--witness", o.witness}}, run.shapes.files);
  ensure(verify::same_poses(run.robot.robot, run.shapes.shapes, run.shapes.links, run.path),
         "two ways to compute a link's pose disagree");
  run.swept = read_swept(o.files[2], o);
  for (const auto& more : {run.shapes.notes, run.shapes.mesh_notes.lines()})
    notes.insert(notes.end(), more.begin(), more.end());
  for (const std::string& note : notes) log(common.quiet, note);
  for (const std::string& note : run.swept.notes) log(common.quiet, o.files[2] + ": " + note);
  return run;
}

void decide(SweepCase& run, Progress& progress) {
  const VerifySweepOptions& o = run.asked;
  run.gap = o.gap.empty() ? verify::default_gap(run.swept.set) : parse_length(o.gap)->value;
  verify::SweepOptions options;
  options.gap = run.gap;
  options.max_cells = o.max_cells;
  options.solids = o.claims != "surface";
  options.progress = [&](const std::string& what) { progress.show("deciding: " + what); };
  run.claims = verify::verify_sweep(run.shapes.shapes, run.path, run.swept.set, options);
  run.answer = answer_of(run.claims, claims_of(o.claims));
  if (run.shapes.exact.empty()) return;
  progress.show("deciding: points of exact faces");
  run.exact = verify::verify_moving_points(run.shapes.exact, run.path, run.swept.set);
  if (run.exact) run.answer = verify::worse(run.answer, run.exact->points.answer);
}

}  // namespace

int verify_sweep(const VerifySweepOptions& o, const CommonOptions& common) {
  require_apart({{"--report", common.report}, {"--witness", o.witness}}, o.files);
  require_witness_format(o.witness);
  const ThreadLimit threads(common.threads);
  SweepCase run = read(o, common);
  Progress progress(common.quiet);
  decide(run, progress);
  progress.show("");
  if (!common.report.empty()) write_report(common, "bound-verify", report_of(run));
  if (!o.witness.empty() && run.claims.refuting)
    write_witness(o.witness, {run.claims.refuting->triangle, {{0, 1, 2}}},
                  "a part of the robot that is outside the swept set");
  if (common.quiet) return exit_code(run.answer);
  std::ostream& out = common.report == "-" ? std::cerr : std::cout;
  for (const std::string& line : lines_of(run)) out << line << '\n';
  if (run.answer != Answer::Verified && !o.prepare)
    if (const std::string hint = preparing_hint(run.shapes); !hint.empty())
      log(common.quiet, "note: " + hint);
  return exit_code(run.answer);
}

}  // namespace kaboum::tools
