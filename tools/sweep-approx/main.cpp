// The program sweep-approx: options, certify::certify_robot and certify_sweep, files.

#include <kaboum/base/error.h>
#include <kaboum/page/sweep_page.h>
#include <kaboum/page/sweep_picture.h>
#include <kaboum/robot/base_pose.h>
#include <kaboum/robot/path_file.h>
#include <kaboum/robot_folder/urdf_text.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <sstream>

#include "common/result_files.h"
#include "options.h"
#include "robots/bodies.h"
#include "robots/check.h"
#include "robots/urdf_output.h"
#include "scene_robot.h"
#include "swept_urdf.h"

namespace kaboum::tools {
namespace {

/// What was read and made.
struct Run {
  const SweepApproxOptions& o;
  robot::RobotFile robot;
  robot::Path path;
  certify::CertifiedBodies bodies;
  robot::BareLinks bare;
  certify::SweepRequest request;
  std::vector<certify::LinkVerdict> verdicts = {};
  certify::CertifiedSweep swept;
  double seconds = 0;                      ///< of the sweeping
  std::vector<std::string> included = {};  ///< by the robot, where they are asked for
};

certify::CertifiedBodies make_bodies(const SweepApproxOptions& o, const robot::RobotFile& robot,
                                     Notes& notes) {
  certify::RobotRequest request = certify::bodies_request_of(o.sweep);
  request.partial = true;
  const certify::SetCache cache(o.cache.empty() ? certify::SetCache::default_folder()
                                                : std::filesystem::path(o.cache));
  require_formats(certify::wanted_meshes(robot, request.shapes), {});
  notes = {};
  for (const std::string& note :
       robot::notes_on_flat_shapes(robot, request.shapes.visual, request.shapes.links))
    log(o.common.quiet, note);
  Progress progress(o.common.quiet);
  certify::RobotHooks hooks =
      certify::hooks_of(notes, [&](const std::string& stage) { progress.show(stage); });
  hooks.made = [&](const certify::CertifiedLinkMesh& mesh) {
    if (mesh.held && !mesh.made.found.set.certificate().reached())
      notes.add(mesh.mesh.file.string(),
                "the decomposition does not reach " + mesh.epsilon->text());
  };
  return certify::certify_bodies(robot, request, o.no_cache ? nullptr : &cache, hooks);
}

/// Makes the bodies and the verdicts on their links. Those that are not held are not swept, as if
/// the others alone were asked for: `o.sweep.links`. @throws Error{InvalidInput} where none is held
void make_bodies(SweepApproxOptions& o, Run& run) {
  Notes notes;
  run.bodies = make_bodies(o, run.robot, notes);
  run.verdicts = verdicts(run.bodies);
  const auto is_kept = [](const auto& link) { return link.outcome >= certify::Outcome::Kept; };
  if (std::ranges::any_of(run.verdicts, is_kept)) {
    o.sweep.links.clear();
    std::string why;
    for (const certify::LinkVerdict& link : run.verdicts) {
      const std::string& name = run.robot.robot.links[link.link].name;
      if (is_kept(link))
        why += (why.empty() ? "link '" : "; link '") + name + "': " + link.sentence;
      else
        o.sweep.links.push_back(name);
    }
    if (o.sweep.links.empty()) throw Error(ErrorCode::InvalidInput, why);
    run.bodies = make_bodies(o, run.robot, notes);
  }
  for (const std::string& note : notes.lines()) log(o.common.quiet, note);
}

/// Names the links that are not held as asked for.
void say_bad_links(const Run& run) {
  for (const certify::LinkVerdict& link : run.verdicts)
    if (link.outcome != certify::Outcome::Held)
      log(false, "link '" + run.robot.robot.links[link.link].name + "': " + link.sentence +
                     (link.outcome >= certify::Outcome::Kept ? "; it is NOT swept" : ""));
}

/// @return whether float32 is fine enough.
bool sweep_bodies(Run& run) {
  const double before = user_seconds();
  Progress progress(run.o.common.quiet);
  run.request.search.progress = [&](const std::string& stage) { progress.show(stage); };
  try {
    auto made = certify::certify_sweep(run.robot, run.bodies, run.path, run.request);
    if (!made) return false;
    run.swept = std::move(*made);
  } catch (const sweep::NoStepError& error) {
    const std::string move = robot::largest_move(run.path, run.robot.robot);
    throw Error(error.code(), run.o.path + ": " + error.what() +
                                  (move.empty() ? "" : "; " + move + " (in radians or metres)"));
  }
  run.seconds = user_seconds() - before;
  return true;
}

std::string summary(const Run& run) {
  std::string out;
  for (const certify::LinkVerdict& link : run.verdicts)
    if (link.outcome >= certify::Outcome::Kept)
      out += (out.empty() ? "; NOT swept, as they are not held: " : ", ") +
             run.robot.robot.links[link.link].name;
  return page::summary_of(run.swept.certificate(), run.bodies.artefact().size()) + out;
}

void write_set(const Run& run, io::SetFormat format) {
  const SweepApproxOptions& o = run.o;
  if (format == io::SetFormat::Glb) {
    io::write_file(o.output, run.swept.bytes());
  } else if (o.urdf()) {
    const std::string prefix = robot_folder::with_slash(o.prefix);
    write_swept_urdf(o.output, run.swept.artefact(), prefix);
    log(o.common.quiet,
        how_meshes_are_found(o.output, std::filesystem::path(o.output).stem().string(), prefix));
  } else {
    io::write_convex_set(o.output, run.swept.artefact(), format);
  }
  if (run.swept.certificate().margin > 0) {
    std::ostringstream warning;
    warning.precision(17);
    warning << "WARNING: " << o.output << ": its bodies alone do NOT contain the robot: add "
            << run.swept.certificate().margin << " to every body (collision margin, padding)";
    log(false, warning.str());
  }
}

Json report_of(const Run& run) {
  const certify::SweepCertificate& c = run.swept.certificate();
  Json of_link = Json::object();
  for (std::size_t l = 0; l < run.robot.robot.links.size(); ++l)
    if (c.of_link[l] > 0) of_link[run.robot.robot.links[l].name] = c.of_link[l];
  Json links = Json::array();
  for (const certify::LinkVerdict& link : run.verdicts) {
    links.push_back({{"link", run.robot.robot.links[link.link].name}});
    links.back().update(tools::report_of(link));
  }
  return {{"robot", {{"file", run.o.robot}, {"sha256", run.robot.sha256}}},
          {"path", {{"file", run.o.path}, {"waypoints", run.path.size()}}},
          {"parameters", run.request.parameters},
          {"certified", c.motion != certify::MotionClaim::None},
          {"bodies", c.bodies},
          {"vertices", c.vertices},
          {"bodies_of_links", of_link},
          {"links", std::move(links)},
          {"verdict", name_of(outcome_of(run.verdicts))},
          {"bodies_at_rest", run.bodies.artefact().size()},
          {"links_without_shapes", run.bare.all()},
          {"margin", c.margin},
          {"deviation", c.deviation},
          {"left_out", c.left_out},
          {"rounding", c.rounding},
          {"reach", c.excess},
          {"bodies_epsilon", c.bodies_distance},
          {"resources", {{"user_seconds_sweeping", run.seconds}}}};
}

void write_files(const Run& run, io::SetFormat format) {
  const SweepApproxOptions& o = run.o;
  const auto preview = [&] {
    if (is_page(o.preview))
      io::write_file(
          o.preview,
          page::page_of_sweep({o.robot, o.path, remedy_of_program(summary(run)), remedy_of_program},
                              run.robot, run.bodies, run.path, run.swept));
    else
      io::write_file(o.preview, page::picture_of_sweep(run.robot.robot, run.bodies.artefact(),
                                                       run.path, run.swept));
  };
  const auto depfile = [&] {
    std::vector<std::string> inputs{o.robot, o.path};
    if (!o.scene.empty()) inputs.push_back(o.scene);
    inputs.insert(inputs.end(), run.included.begin(), run.included.end());
    for (std::string& file : strings(run.bodies.certificate().files))
      inputs.push_back(std::move(file));
    write_depfile(o.depfile, {o.output}, inputs);
  };
  write_together(
      {{o.preview, preview},
       {o.common.report, [&] { write_report(o.common, "sweep-approx", report_of(run)); }},
       {o.depfile, depfile},
       {o.output, [&] { write_set(run, format); }}});
}

/// The robot that is asked for, where it stands. `o.robot` becomes its file.
robot::RobotFile placed_robot(SweepApproxOptions& o) {
  robot::RobotFile robot;
  robot::Transform base;
  if (!o.scene.empty()) {
    const SceneRobot found = read_scene_robot(o.scene, o.robot_name);
    o.robot = found.file;
    robot = robot::read_robot(o.robot, robot::Motions::All, {}, o.sweep.packages);
    robot.robot.variables = found.variables;
    base = found.base;
  } else if (o.robot.empty()) {
    throw Error(ErrorCode::InvalidArgument, "which robot? Give ROBOT, or --scene");
  } else {
    robot = robot::read_robot(o.robot, robot::Motions::All, o.xacro_arguments, o.sweep.packages);
    if (!o.sweep.base_pose.empty()) base = robot::parse_pose(o.sweep.base_pose, "--base-pose");
  }
  naming(o.robot, [&] { certify::place(robot.robot, base, o.sweep); });
  return robot;
}

int sweep_path(SweepApproxOptions o) {
  robot::RobotFile robot = placed_robot(o);
  require_apart({{"--output", o.output},
                 {"--report", o.common.report},
                 {"--preview", o.preview},
                 {"--depfile", o.depfile}},
                {o.robot, o.path, o.scene});
  const ThreadLimit threads(o.common.threads);
  const io::SetFormat format = output_format(o);
  Run run{o, std::move(robot), {}, {}, {}, {}, {}, {}};
  if (!o.depfile.empty()) run.included = robot::included_files(run.robot);
  std::vector<std::string> notes;
  run.path = robot::read_path(
      o.path, run.robot.robot,
      {!o.sweep.ignore_limits, o.sweep.degrees, numbers_by_name(o.sweep.joints)}, notes);
  for (const std::string& note : run.robot.robot.notes) log(o.common.quiet, note);
  for (const std::string& note : notes) log(o.common.quiet, note);
  const std::vector<std::string> links = o.sweep.links;
  make_bodies(o, run);
  run.request = certify::sweep_request_of(o.sweep);
  run.bare = robot::bare_links(run.robot.robot, o.sweep.visual, links);
  for (const std::string& note :
       robot::notes_on({{}, run.bare.other}, o.sweep.visual, ": nothing of this is swept"))
    log(o.common.quiet, o.robot + ": " + note);
  if (!sweep_bodies(run)) {
    log(false, o.robot +
                   ": float32 is too coarse so far from the origin for this epsilon; allow a "
                   "larger one. Nothing is written");
    return kNo;
  }
  log(o.common.quiet, summary(run));
  say_bad_links(run);
  if (!o.sweep.base_pose.empty())
    log(o.common.quiet,
        "in the world's frame: bound-verify sweep needs --base-pose " + o.sweep.base_pose);
  write_files(run, format);
  return exit_code(outcome_of(run.verdicts));
}

}  // namespace
}  // namespace kaboum::tools

int main(int argc, char** argv) {
  using namespace kaboum;
  CLI::App app{"Bounds the volume that a robot sweeps along a path by convex bodies.",
               "sweep-approx"};
  tools::SweepApproxOptions options;
  tools::describe(app, options);
  return tools::run(app, argc, argv, [&] {
    bring_lengths_into("m", certify::swept_set_options(), options.sweep);
    return tools::sweep_path(options);
  });
}
