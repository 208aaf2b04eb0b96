#include <kaboum/io/convex_io.h>
#include <kaboum/robot/path.h>

#include <sstream>

#include "cli.h"
#include "robot_bodies.h"
#include "robot_path.h"
#include "set_format.h"
#include "sweep_picture.h"
#include "swept_urdf.h"
#include "urdf_output.h"

namespace {

using namespace kaboum;
using tools::Json;

struct Options {
  std::string robot, path, output, output_format, epsilon = "0.005", bound = "balanced", reach;
  std::string links, geometry = "collision", unit = "m", preview, depfile, prefix;
  std::vector<std::string> joints;
  double simplify = 0;
  bool implicit_margin = false, no_merge = false, ignore_limits = false, degrees = false;
  std::string body_epsilon, body_effort = "normal", cache;
  bool no_cache = false;
  tools::BodyOptions bodies;
  tools::CommonOptions common;
};

const std::map<std::string, sweep::StepRule> kRules{
    {"baginski", sweep::StepRule::Baginski}, {"uniform", sweep::StepRule::Uniform},
    {"subset", sweep::StepRule::Subset},     {"second-order", sweep::StepRule::SecondOrder},
    {"adaptive", sweep::StepRule::Adaptive}, {"balanced", sweep::StepRule::Balanced}};

const std::map<std::string, bcd::Effort> kEfforts{
    {"fast", bcd::Effort::Fast}, {"normal", bcd::Effort::Normal}, {"best", bcd::Effort::Best}};

std::string check_length(const std::string& text) {
  const auto length = tools::parse_length(text);
  return length && !length->percent
             ? std::string()
             : "must be a positive length without a unit, as in 0.005, not " + text +
                   (length ? " (there is no diagonal that it could be a percentage of before the "
                             "volume is made)"
                           : "");
}

void describe(CLI::App& app, Options& o) {
  app.add_option("ROBOT", o.robot, "Robot: URDF, or the Robotics Library's rlkin or rlmdl XML")
      ->required()
      ->type_name("FILE");
  app.add_option(
         "--path", o.path,
         "Waypoints in joint space, joined linearly: .csv, one line each, the joints named "
         "in the first line or in the robot's order; or .json. Radians (--degrees: degrees) and "
         "metres")
      ->required()
      ->type_name("FILE");
  app.add_option(
         "-o,--output", o.output,
         "Where the bodies go: a .glb container, an .obj with one object per body, a folder "
         "with one STL per body, or a .urdf with them as shapes of one link, and "
         "a folder beside it (- for stdout)")
      ->required()
      ->type_name("PATH");
  app.add_option(
         "--epsilon", o.epsilon,
         "Largest margin round the bodies, by which they are enlarged. How far they then reach "
         "beyond what is swept is said at the end, and limited by --max-reach [0.005]")
      ->check(check_length)
      ->type_name("LENGTH");
  app.add_option("--bound", o.bound,
                 "How steps are chosen: baginski (not proved), uniform (the thesis's), subset, "
                 "second-order, adaptive (ends are poses), balanced (fewest) [balanced]")
      ->check(
          CLI::IsMember({"baginski", "uniform", "subset", "second-order", "adaptive", "balanced"})
              .description(""))
      ->type_name("NAME");
  app.add_option("--max-reach", o.reach,
                 "Largest distance of a hull, its margin apart, from what it bounds; takes more "
                 "bodies [no limit]")
      ->check(check_length)
      ->type_name("LENGTH");
  app.add_option(
         "--simplify", o.simplify,
         "Share of epsilon, 0 to 0.9, by which vertices may be left out: fewer of them, more "
         "bodies")
      ->check(tools::number_from(0, 0.9))
      ->capture_default_str()
      ->type_name("SHARE");
  app.add_flag("--implicit-margin", o.implicit_margin,
               "Do not enlarge the bodies of a .glb by the margin, but state it in the file: fewer "
               "vertices, but whatever reads them has to add it");
  app.add_flag("--no-merge", o.no_merge, "One body at least between two waypoints");
  app.add_flag("--ignore-limits", o.ignore_limits, "Allow waypoints outside the joints' limits");
  tools::add_joint_option(app, o.joints);
  tools::add_degrees_option(app, o.degrees);
  app.add_option("--links", o.links, "Only these links, separated by commas [all]")
      ->type_name("A,B");
  app.add_option("--geometry", o.geometry, "Which shapes of a URDF [collision]")
      ->check(CLI::IsMember({"collision", "visual"}).description(""))
      ->type_name("collision|visual");
  app.add_flag_callback(
      "--visual", [&o] { o.geometry = "visual"; }, "The same as --geometry visual");
  app.add_option("--package-path", o.bodies.packages,
                 "A package of package:// or a folder that holds it, besides $ROS_PACKAGE_PATH, "
                 "$AMENT_PREFIX_PATH and the folders above ROBOT; may be repeated")
      ->type_name("DIR");
  app.add_option("--body-epsilon", o.body_epsilon,
                 "Largest distance of the links' convex bodies from their meshes, a length or a "
                 "percentage of each mesh's diagonal [as --epsilon]")
      ->check([](const std::string& s) {
        return tools::parse_length(s) ? std::string() : "must be a positive number or percentage";
      })
      ->type_name("LENGTH|P%");
  app.add_flag("--drop-sheets", o.bodies.drop_sheets,
               "Drop back-to-back faces without volume (they are then not covered)");
  app.add_option("--max-vertices-per-body", o.bodies.max_vertices,
                 "Most vertices of a link's body (8 to 100000)")
      ->check(CLI::Range(8, 100000).description(""))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--effort", o.body_effort, "Of the decomposition [normal]")
      ->check(CLI::IsMember({"fast", "normal", "best"}).description(""))
      ->type_name("fast|normal|best");
  app.add_option("--from-cache", o.cache,
                 "Cache of decompositions, used and filled [as bcd-decompose]")
      ->type_name("DIR");
  app.add_flag("--no-cache", o.no_cache, "Decompose anew and store nothing");
  app.add_option("--unit", o.unit,
                 "Unit of length, noted in the container: m, dm, cm, mm, um, km, in or ft")
      ->check(tools::unit_name())
      ->capture_default_str()
      ->type_name("NAME");
  app.add_option("--mesh-prefix", o.prefix,
                 "Put before the bodies' file names in a .urdf, as in package://cell, with a slash "
                 "between; RViz and MoveIt need it [names relative to the URDF]")
      ->type_name("URI");
  app.add_option("--preview", o.preview, "Write a picture of the swept volume (PNG)")
      ->check(tools::png_name())
      ->type_name("FILE");
  app.add_option("--depfile", o.depfile, "Write a Makefile dependency rule")->type_name("FILE");
  tools::add_set_format_option(app, o.output_format);
  tools::add_common_options(app, o.common);
  app.footer(
      "The bodies contain the links' convex bodies, and these their meshes, at every "
      "configuration "
      "of the path (docs/algorithms/swept-volumes.md).\n"
      "Exit codes: 0 done; 1 float32 is too coarse for epsilon (nothing is written); 2 usage; "
      "3 bad input; 4 output failed; 5 not built; 6 internal error; 7 limit.");
}

std::vector<std::string> split(const std::string& list) {
  std::vector<std::string> out;
  std::istringstream stream(list);
  for (std::string item; std::getline(stream, item, ',');)
    if (!item.empty()) out.push_back(item);
  return out;
}

std::string parameters(const Options& o) {
  std::ostringstream out;
  out << "--epsilon " << o.epsilon << " --bound " << o.bound << " --body-epsilon " << o.body_epsilon
      << " --max-vertices-per-body " << o.bodies.max_vertices << " --effort " << o.body_effort
      << " --geometry " << o.geometry;
  if (!o.reach.empty()) out << " --max-reach " << o.reach;
  if (o.simplify > 0) out << " --simplify " << o.simplify;
  if (!o.links.empty()) out << " --links " << o.links;
  for (const std::string& joint : o.joints) out << " --joint " << joint;
  if (o.degrees) out << " --degrees";
  if (o.bodies.drop_sheets) out << " --drop-sheets";
  if (o.implicit_margin) out << " --implicit-margin";
  if (o.no_merge) out << " --no-merge";
  return out.str();
}

tools::LinkBodies bodies_of_links(const tools::RobotFile& file, const Options& o) {
  const certify::SetCache cache(o.cache.empty() ? certify::SetCache::default_folder()
                                                : std::filesystem::path(o.cache));
  tools::Progress progress(o.common.quiet);
  tools::BodyOptions options = o.bodies;
  if (!o.no_cache) options.cache = &cache;
  options.progress = [&](const std::string& stage) { progress.show(stage); };
  return tools::bodies_of(file, options);
}

int sweep_path(Options o) {
  tools::require_apart({{"--output", o.output},
                        {"--report", o.common.report},
                        {"--preview", o.preview},
                        {"--depfile", o.depfile}},
                       {o.robot, o.path});
  const tools::ThreadLimit threads(o.common.threads);
  const bool urdf =
      o.output_format.empty() && std::filesystem::path(o.output).extension() == ".urdf";
  const io::SetFormat format =
      urdf ? io::SetFormat::Directory : tools::set_format_for(o.output, o.output_format);
  if (o.implicit_margin && format != io::SetFormat::Glb)
    throw Error(ErrorCode::InvalidArgument,
                "--implicit-margin: only .glb can state a margin; " + o.output + " cannot");
  if (!o.prefix.empty() && !urdf)
    throw Error(ErrorCode::InvalidArgument, "--mesh-prefix is for an output that is a .urdf");
  if (format == io::SetFormat::Directory)
    io::require_replaceable(urdf ? std::filesystem::path(o.output).replace_extension()
                                 : std::filesystem::path(o.output));
  const tools::RobotFile file = tools::read_robot(o.robot);
  std::vector<std::string> notes;
  const robot::Path path = tools::read_path(
      o.path, file.robot, {!o.ignore_limits, o.degrees, tools::fixed_joints(o.joints)}, notes);
  for (const std::string& note : notes) tools::log(o.common.quiet, note);
  o.bodies.links = split(o.links);
  o.bodies.visual = o.geometry == "visual";
  if (o.body_epsilon.empty()) o.body_epsilon = o.epsilon;
  o.bodies.epsilon = *tools::parse_length(o.body_epsilon);
  o.bodies.effort = kEfforts.at(o.body_effort);
  const tools::LinkBodies links = bodies_of_links(file, o);
  for (const std::string& note : links.notes) tools::log(o.common.quiet, note);
  for (const std::string& note :
       tools::notes_on({{}, links.bare.other}, o.bodies.visual, ": nothing of this is swept"))
    tools::log(o.common.quiet, o.robot + ": " + note);
  sweep::SweepOptions options;
  options.epsilon = tools::parse_length(o.epsilon)->value;
  options.rule = kRules.at(o.bound);
  options.merge = !o.no_merge;
  options.simplify = o.simplify;
  options.explicit_margin = !o.implicit_margin;
  if (!o.reach.empty()) options.max_reach = tools::parse_length(o.reach)->value;
  const double before = tools::user_seconds();
  sweep::SweepResult result = [&] {
    try {
      return sweep::swept_volume(file.robot, links.bodies, path, options);
    } catch (const sweep::NoStepError& error) {
      const std::string move = tools::largest_move(path, file.robot);
      throw Error(error.code(), o.path + ": " + error.what() +
                                    (move.empty() ? "" : "; " + move + " (in radians or metres)"));
    }
  }();
  const double seconds = tools::user_seconds() - before;
  if (result.stop == sweep::SweepStop::TooCoarse) {
    tools::log(false, o.robot +
                          ": float32 is too coarse so far from the origin for this epsilon; allow "
                          "a larger one. Nothing is written");
    return tools::kNo;
  }
  geom::Provenance& p = result.set.provenance;
  p.source = file.path.filename().string();
  p.source_sha256 = file.sha256;
  p.tool = std::string("sweep-approx ") + tools::version();
  p.parameters = parameters(o);
  p.unit = o.unit;
  p.frame = file.robot.links[0].name;
  if (result.certified) {
    p.direction = "outer";
    p.epsilon = (result.reach + links.epsilon) * (1 + 1e-15);
  }
  // What is written is read back.
  const std::vector<char> bytes = io::serialise_convex_set(result.set, io::SetFormat::Glb);
  const geom::ConvexSet written = io::parse_convex_set(bytes, io::Format::Glb, "the result");
  ensure(!geom::find_not_convex(written), "a body of the swept volume is not convex");
  ensure(written.margin == result.set.margin, "the margin does not survive writing");
  std::ostringstream message;
  message.precision(3);
  message << written.bodies.size() << (written.bodies.size() == 1 ? " body" : " bodies") << " for "
          << links.bodies.size() << " of the robot; margin " << written.margin
          << "; no point farther than " << result.reach
          << " from what the robot's bodies sweep, these within " << links.epsilon
          << " of its shapes";
  if (!result.certified) message << "; NOT certified: --bound baginski is not proved";
  tools::log(o.common.quiet, message.str());
  if (format == io::SetFormat::Glb) {
    io::write_file(o.output, bytes);
  } else if (urdf) {
    const std::string prefix = tools::with_slash(o.prefix);
    tools::write_swept_urdf(o.output, result.set, prefix);
    tools::log(o.common.quiet,
               tools::how_meshes_are_found(
                   o.output, std::filesystem::path(o.output).stem().string(), prefix));
  } else {
    io::write_convex_set(o.output, result.set, format);
  }
  if (written.margin > 0) {
    std::ostringstream warning;
    warning.precision(17);
    warning << "WARNING: " << o.output << ": its bodies alone do NOT contain the robot: add "
            << written.margin << " to every body (collision margin, padding)";
    tools::log(false, warning.str());
  }
  if (!o.preview.empty())
    io::write_file(o.preview, tools::picture_of_sweep(file.robot, links.bodies, path, result));
  if (!o.common.report.empty()) {
    std::size_t vertices = 0;
    for (const geom::ConvexBody& body : written.bodies) vertices += body.hull.vertices.size();
    Json of_link = Json::object();
    for (std::size_t l = 0; l < file.robot.links.size(); ++l)
      if (result.of_link[l] > 0) of_link[file.robot.links[l].name] = result.of_link[l];
    const Json report = {{"robot", {{"file", o.robot}, {"sha256", file.sha256}}},
                         {"path", {{"file", o.path}, {"waypoints", path.size()}}},
                         {"parameters", p.parameters},
                         {"certified", result.certified},
                         {"bodies", written.bodies.size()},
                         {"vertices", vertices},
                         {"bodies_of_links", of_link},
                         {"bodies_at_rest", links.bodies.size()},
                         {"links_without_shapes", links.bare.all()},
                         {"margin", written.margin},
                         {"deviation", result.deviation},
                         {"left_out", result.left_out},
                         {"rounding", result.rounding},
                         {"reach", result.reach},
                         {"bodies_epsilon", links.epsilon},
                         {"resources", {{"user_seconds_sweeping", seconds}}}};
    tools::write_report(o.common, "sweep-approx", report);
  }
  if (!o.depfile.empty()) {
    std::vector<std::string> inputs{o.robot, o.path};
    inputs.insert(inputs.end(), links.files.begin(), links.files.end());
    tools::write_depfile(o.depfile, {o.output}, inputs);
  }
  return tools::kDone;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Bounds the volume that a robot sweeps along a path by convex bodies.",
               "sweep-approx"};
  Options options;
  describe(app, options);
  return tools::run(app, argc, argv, [&] { return sweep_path(options); });
}
