// bcd-decompose on robots: reads, certifies, writes a folder, and says what came of it.

#include "robot.h"

#include <kaboum/base/counted.h>
#include <kaboum/base/error.h>
#include <kaboum/base/number_text.h>
#include <kaboum/certify/large_epsilon.h>
#include <kaboum/certify/robot.h>
#include <kaboum/certify/robot_budget.h>
#include <kaboum/certify/sphere_repair.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/io/region_file.h>
#include <kaboum/page/robot_page.h>
#include <kaboum/page/set_page.h>
#include <kaboum/pairs/matrix.h>
#include <kaboum/picture/bodies.h>
#include <kaboum/picture/png_file.h>
#include <kaboum/robot/sphere_file.h>
#include <kaboum/robot_folder/certified_folder.h>
#include <kaboum/robot_folder/shapes_glb.h>
#include <kaboum/robot_folder/simple_shapes.h>
#include <kaboum/robot_folder/sphere_text.h>
#include <kaboum/scene/robot_pairs.h>
#include <kaboum/verify/sphere_verdict.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <utility>

#include "common/file_kind.h"
#include "inertia.h"
#include "robots/bodies.h"
#include "robots/check.h"
#include "robots/meeting_spheres.h"
#include "robots/next_steps.h"
#include "robots/output.h"
#include "robots/progress.h"
#include "robots/spheres_page.h"
#include "robots/summary.h"
#include "words.h"

namespace kaboum::tools {
namespace {

namespace fs = std::filesystem;

using robot_folder::RobotWriter;
using robot_folder::sphere_format_of;

certify::RobotRequest robot_request(const DecomposeOptions& o, const robot::RobotFile& robot,
                                    const robot::ShapeChoice& choice) {
  certify::RobotRequest r{
      certify::request_of(o.set), choice, {}, {}, read_epsilons(o.robot.epsilons, robot.robot)};
  r.format = o.input_format.stated();
  if (o.epsilon_map)
    r.take(robot::bounds_of_links(robot, choice, io::read_frame_regions(*o.epsilon_map)));
  return r;
}

certify::InertiaRequest inertia_request(const DecomposeOptions& o) {
  certify::InertiaRequest r{o.robot.shapes, density_of(o.inertia), o.set.preparation, {}};
  r.format = o.input_format.stated();
  return r;
}

std::string pairs_in_words(const scene::RobotPairs& pairs) {
  return "pairs of links that need no check: " + std::to_string(pairs.adjacent) + " adjacent, " +
         std::to_string(pairs.never) + " proved never to touch, " + std::to_string(pairs.fixed) +
         " fixed to each other; " + std::to_string(pairs.others) + " others";
}

Json pairs_report(const scene::RobotPairs& pairs) {
  return {{"adjacent", pairs.adjacent},
          {"never_in_contact", pairs.never},
          {"fixed_to_each_other", pairs.fixed},
          {"others", pairs.others}};
}

/// What was made, and where it goes.
struct Run {
  const DecomposeOptions& o;
  robot::RobotFile robot;
  certify::RobotRequest request = {};
  certify::CertifiedRobot made = {};
  std::vector<double> seconds = {};  ///< of each mesh, by the clock [s]
  std::vector<certify::LinkVerdict> verdicts = {};
  std::vector<certify::RegionVerdict> regions = {};
  Notes notes = {};                             ///< on meshes
  Notes written = {};                           ///< on what was written
  std::size_t cached = 0;                       ///< meshes
  std::optional<scene::RobotPairs> pairs = {};  ///< with --srdf
  std::vector<certify::LinkInertia> inertia = {};

  [[nodiscard]] const certify::BodiesCertificate& bodies() const {
    return made.bodies.certificate();
  }
  [[nodiscard]] int code() const {
    const int of_shapes = exit_code(outcome_of(verdicts));
    return of_shapes == kDone && !all_known(inertia) ? kNo : of_shapes;
  }
  /// The set of a link; null: a mesh of it is kept.
  [[nodiscard]] const certify::CertifiedLink* set_of(std::uint32_t link) const {
    for (const certify::CertifiedLink& set : made.links)
      if (set.certificate().link == link) return &set;
    return nullptr;
  }
};

/// What is said of a mesh that is done: with --verbose a line, else what helps where it is not as
/// asked for.
void take_note(Run& run, const certify::CertifiedLinkMesh& mesh, Notes& shortfalls) {
  const std::string file = mesh.mesh.file.string(), name = mesh.mesh.file.filename().string();
  const bool quiet = run.o.common.quiet, verbose = run.o.robot.verbose;
  if (!mesh.flaw.empty() && verbose) log(quiet, mesh.flaw);
  if (!mesh.held) return;
  const certify::SetCertificate& certificate = mesh.made.found.set.certificate();
  if (mesh.made.found.cached) ++run.cached;
  if (verbose)
    log(quiet, file + ": " + page::summary_of(certificate) +
                   (mesh.made.found.cached ? " (from the cache)" : ""));
  const std::string why = page::shortfall_of(certificate);
  if (!why.empty() && certificate.undecided.empty()) shortfalls.add(name, why);
}

/// What a budget for the whole robot allows: one epsilon, or of spheres one for each link.
void share_out(Run& run, const certify::SetCache* cache) {
  const auto given = [](std::size_t n) { return n > 0 ? std::optional(n) : std::nullopt; };
  const bool spheres = run.request.set.body_kind == certify::SetRequest::BodyKind::Spheres;
  std::string budget;
  if (run.o.robot_bodies > 0)
    budget = spheres ? counted(run.o.robot_bodies, "sphere", "spheres")
                     : counted(run.o.robot_bodies, "body", "bodies");
  if (run.o.robot_vertices > 0)
    budget += (budget.empty() ? "" : " and ") + counted(run.o.robot_vertices, "vertex", "vertices");
  SearchProgress progress("bcd-decompose", run.o.common.quiet,
                          "the least epsilon with no more than " + budget, cache != nullptr);
  certify::RobotHooks hooks;
  hooks.progress = [&](const std::string& stage) { progress.show(stage); };
  if (spheres)
    run.request.epsilons =
        share_spheres(run.robot, run.request, run.o.robot_bodies, run.o.share, cache, hooks);
  else
    run.request.set.epsilon =
        epsilon_within(run.robot, run.request,
                       {given(run.o.robot_bodies), given(run.o.robot_vertices)}, cache, hooks);
}

/// Lines of the links that have shapes.
std::vector<LinkLine> lines_of(const Run& run, const certify::CertifiedBodies& bodies) {
  const certify::BodiesCertificate& certificate = bodies.certificate();
  std::vector<LinkLine> out;
  for (const certify::LinkVerdict& link : run.verdicts) {
    LinkLine& line = out.emplace_back();
    line.name = run.robot.robot.links[link.link].name;
    line.outcome = link.outcome;
    line.dropped_sheets = link.dropped_sheets;
    line.epsilon =
        page::epsilon_of(line.name, run.request.epsilons, run.request.set.wanted_epsilon());
    if (const certify::CertifiedLink* set = run.set_of(link.link)) {
      line.within = set->certificate().distance;
      line.bodies = set->artefact().bodies.size();
      line.vertices = 0;
      for (const geom::ConvexBody& body : set->artefact().bodies)
        *line.vertices += body.core.vertices.size();
    }
    if (!run.made.links.empty()) continue;  // a link without a set has no bodies that are written
    for (std::size_t i = 0; i < certificate.shapes.size(); ++i)
      if (certificate.shapes[i].link == link.link)
        line.within = std::max(line.within, certificate.distances[i]);
    line.bodies = static_cast<std::size_t>(std::ranges::count(
        bodies.artefact(), link.link, [](const robot::LinkBody& body) { return body.link; }));
  }
  return out;
}

void say_table(const Run& run, const std::vector<LinkLine>& links, const Notes& shortfalls) {
  const std::string made =
      run.request.set.body_kind == certify::SetRequest::BodyKind::Spheres ? "spheres" : "bodies";
  for (const std::string& line : table_of(links, made, run.request.set.unit))
    log(run.o.common.quiet, line);
  for (const std::string& line : shortfalls.lines()) log(run.o.common.quiet, line);
}

/// Of the regions of --epsilon-map.
void say_regions(Run& run, const certify::CertifiedBodies& bodies) {
  run.regions = certify::region_verdicts(run.robot, run.request.regions, bodies);
  for (const certify::RegionVerdict& one : run.regions) log(run.o.common.quiet, in_words(one));
}

Json regions_report(const Run& run) {
  Json out = Json::array();
  for (const certify::RegionVerdict& one : run.regions)
    out.push_back({{"name", one.name},
                   {"links", one.links},
                   {"answer", one.held ? "verified" : "undecided"},
                   {"bound", one.epsilon},
                   {"reached", one.reached}});
  return out;
}

std::vector<std::string> all_notes(const Run& run) {
  std::vector<std::string> out = run.notes.lines();
  for (std::string& text : run.written.lines()) out.push_back(std::move(text));
  return out;
}

/// Hooks that show the progress and collect what is to be said.
certify::RobotHooks hooks_of(Run& run, MeshProgress& progress, Notes& shortfalls) {
  using Clock = std::chrono::steady_clock;
  certify::RobotHooks hooks =
      certify::hooks_of(run.notes, [&](const std::string& stage) { progress.show(stage); });
  hooks.made = [&, last = Clock::now()](const certify::CertifiedLinkMesh& mesh) mutable {
    run.seconds.push_back(std::chrono::duration<double>(Clock::now() - last).count());
    last = Clock::now();
    progress.made(mesh.held && mesh.made.found.cached);
    take_note(run, mesh, shortfalls);
  };
  return hooks;
}

void certify_links(Run& run, const robot::LinkMeshes& meshes) {
  const certify::SetCache kept(certify::SetCache::default_folder());
  const certify::SetCache* cache = run.o.no_cache ? nullptr : &kept;
  if (run.o.robot_bodies + run.o.robot_vertices > 0) share_out(run, cache);
  Notes shortfalls;
  {
    MeshProgress progress("bcd-decompose", run.o.common.quiet, meshes, cache != nullptr);
    run.made =
        certify::certify_robot(run.robot, run.request, cache, hooks_of(run, progress, shortfalls));
    run.verdicts = verdicts(run.made);
    if (!run.o.srdf) return say_table(run, lines_of(run, run.made.bodies), shortfalls);
    progress.other("looking for pairs of links that never touch",
                   cache != nullptr ? "nothing is written, but the cache keeps all bodies: the "
                                      "same command goes on there"
                                    : "nothing is written");
    run.pairs = scene::pairs_of(run.robot.robot, run.made);
  }
  say_table(run, lines_of(run, run.made.bodies), shortfalls);
}

/// Until it is written whole, the folder has no robot.
void write(Run& run, RobotWriter& writer) {
  std::optional<certify::CacheFolder> cache;
  if (!run.o.no_cache) cache.emplace(certify::CacheFolder::default_folder());
  LastWords words(run.o.common.quiet);
  words.set("bcd-decompose: ended by a signal while " + run.o.output +
            " was written, which has no robot until the same command is called again");
  write_certified(writer, run.made, cache ? &*cache : nullptr, note_in(run.written));
}

std::string counts_in_words(const Run& run, const page::RobotCounts& counts) {
  std::string out = counted(counts.bodies, "body", "bodies") + " of " +
                    counted(counts.links, "link", "links") + ", from " + counts.of_meshes();
  if (run.cached > 0) out += " (" + std::to_string(run.cached) + " from the cache)";
  return out;
}

/// @param files  of the links that have a set
Json links_report(const Run& run, const std::vector<std::string>& files) {
  Json out = Json::array();
  for (const certify::LinkVerdict& link : run.verdicts) {
    Json report = {{"link", run.robot.robot.links[link.link].name}, {"shapes", link.shapes}};
    report.update(report_of(link));
    for (const robot::LinkShape& shape : run.bodies().shapes) {
      if (shape.link != link.link || !shape.mesh) continue;
      const certify::CertifiedLinkMesh& mesh = run.bodies().meshes[*shape.mesh];
      Json one{{"file", mesh.mesh.file.string()}};
      if (mesh.held) one["result"] = report_of(mesh.made);
      if (!mesh.flaw.empty()) one["flaw"] = mesh.flaw;
      report["meshes"].push_back(std::move(one));
    }
    if (const certify::CertifiedLink* set = run.set_of(link.link)) {
      report["file"] = files[static_cast<std::size_t>(set - run.made.links.data())];
      report["bodies"] = set->artefact().bodies.size();
      report["reach_upper"] = set->certificate().distance;
    }
    out.push_back(std::move(report));
  }
  return out;
}

/// The command that decides it from the files alone; epsilon as well, where it is one for all links
/// and of distances to what the files hold, not to wraps.
RobotCheck check_of(const Run& run, const RobotWriter& output) {
  std::optional<Length> epsilon = run.request.set.wanted_epsilon();
  if (!run.o.robot.epsilons.empty() || outcome_of(run.verdicts) != certify::Outcome::Held)
    epsilon.reset();
  for (const certify::CertifiedLinkMesh& mesh : run.bodies().meshes)
    if (!mesh.held || mesh.made.found.set.certificate().wrap) epsilon.reset();
  return tools::check_of(run.o.input, output.folder().urdf().string(), run.o.robot,
                         run.o.set.preparation, epsilon, epsilon ? run.o.epsilon_map : std::nullopt,
                         run.verdicts);
}

Json robot_report(const Run& run, const RobotWriter& output) {
  const page::RobotCounts counts = page::counts_of(run.made);
  Json report = report_of(output);
  report.update({{"bodies", counts.bodies},
                 {"vertices", counts.vertices},
                 {"meshes", counts.meshes},
                 {"meshes_kept", counts.kept},
                 {"meshes_missing", counts.missing},
                 {"links", links_report(run, output.link_files())},
                 {"stop", run.code() == kDone ? "done" : "epsilon not reached"},
                 {"verdict", name_of(outcome_of(run.verdicts))},
                 {"sentence", in_words(run.verdicts)},
                 {"check", check_of(run, output).command},
                 {"input", {{"file", run.o.input}}},
                 {"notes", all_notes(run)},
                 {"regions", regions_report(run)},
                 {"parameters", run.request.parameters()}});
  if (run.pairs) report["pairs_of_links"] = pairs_report(*run.pairs);
  if (!run.o.inertia.empty()) report["inertia"] = report_of(run.robot.robot, run.inertia);
  return report;
}

void write_page(const Run& run, const RobotWriter& output) {
  const RobotCheck check = check_of(run, output);
  io::write_file(
      run.o.robot.html,
      to_html(page::RobotPage{
          .robot = run.robot.robot.name,
          .source = run.o.input,
          .tool = std::string("bcd-decompose ") + version() + " " + run.request.parameters(),
          .command = check.command,
          .passes = check.passes,
          .unit = run.request.set.unit,
          .files = output.documents(),
          .notes = all_notes(run),
          .steps = next_steps(output, run.o.robot, check, run.o.srdf),
          .links = page::page_links(run.robot, run.made, run.request, run.seconds),
          .counts = page::counts_of(run.made)}));
}

/// The format of a file of spheres, capsules or boxes: one of planners, or of robots.
struct BodyFormat {
  std::optional<robot_folder::SphereFormat> spheres;
  std::optional<robot_folder::ShapeFormat> shapes;
};

/// @throws Error{InvalidArgument} where it has no place for them, and on options of polytopes
BodyFormat format_of_shapes(const DecomposeOptions& o) {
  const bool spheres = o.set.request.body_kind == certify::SetRequest::BodyKind::Spheres;
  BodyFormat format;
  if (spheres) format.spheres = sphere_format_of(o.output);
  if (!format.spheres) format.shapes = robot_folder::shape_format_of(o.output);
  if (!format.spheres && !format.shapes)
    throw Error(ErrorCode::InvalidArgument,
                spheres ? "--bodies spheres of a robot: end --output in .yaml (cuRobo), .xrdf, "
                          ".srdf (link_sphere_approximation), or in .urdf, .xml (MJCF) or .sdf "
                          "(spheres as collision shapes)"
                        : "--bodies capsules, boxes or mixed of a robot: end --output in .urdf, "
                          ".xml (MJCF) or .sdf");
  if (!o.pairs.empty() && (!format.spheres || format.spheres == robot_folder::SphereFormat::Urdf))
    throw Error(ErrorCode::InvalidArgument,
                "--pairs: pairs of links have a place in .yaml (cuRobo), .xrdf and .srdf, not in " +
                    o.output);
  if (o.srdf || !o.robot.html.empty())
    throw Error(ErrorCode::InvalidArgument,
                "--srdf and --html-report need --bodies polytopes of a robot");
  if (!o.preview.empty() && !is_scene(o.preview) && !(format.spheres && is_page(o.preview)))
    throw Error(ErrorCode::InvalidArgument,
                "--preview: of a robot's spheres, capsules and boxes a scene (.glb) is written, of "
                "spheres in .yaml, .xrdf, .srdf and .urdf also a page (.html), not " +
                    o.preview);
  if (o.robot_vertices > 0)
    throw Error(ErrorCode::InvalidArgument,
                "--robot-vertices: spheres, capsules and boxes have no vertices to be shared out; "
                "state --robot-bodies");
  return format;
}

std::vector<robot_folder::UncheckedLinks> unchecked_of(const pairs::Matrix& matrix) {
  std::vector<robot_folder::UncheckedLinks> out;
  for (const pairs::DisabledPair& pair : matrix.pairs) out.push_back({pair.a, pair.b, pair.reason});
  return out;
}

/// The pairs of links that a file says need no check.
std::vector<robot_folder::UncheckedLinks> unchecked_links(const DecomposeOptions& o,
                                                          const robot::Robot& robot, Notes& notes) {
  if (o.pairs.empty()) return {};
  const std::vector<char> text = io::read_file(o.pairs);
  const pairs::Matrix matrix =
      pairs::parse_matrix(std::string(text.begin(), text.end()), o.pairs, robot);
  pairs::require_own(matrix, o.pairs, robot);
  for (const pairs::MatrixFault& fault : matrix.faults)
    notes.add(o.pairs, "line " + std::to_string(fault.line) + ": " + fault.text);
  return unchecked_of(matrix);
}

/// A file of spheres, capsules or boxes.
struct WrittenShapes {
  std::string text;
  double beyond = 0;  ///< the bodies, that its shapes reach [length]
};

/// Writes the file, and the scene of --preview.
WrittenShapes write_shapes(Run& run, const BodyFormat& format,
                           const certify::CertifiedBodies& bodies,
                           const std::vector<robot_folder::UncheckedLinks>& unchecked) {
  const DecomposeOptions& o = run.o;
  const robot_folder::SimpleShapes shapes = robot_folder::simple_shapes(bodies.artefact());
  robot::ModelText made;
  if (format.spheres)
    made.text = robot_folder::sphere_text(*format.spheres, run.robot, bodies,
                                          run.request.parameters(), o.output, unchecked);
  else
    made = robot_folder::text_of_shapes(*format.shapes, run.robot, o.robot.shapes, bodies, shapes,
                                        run.request.parameters(), o.output);
  // Nothing is written where either is refused.
  std::vector<char> scene;
  std::string page;
  if (is_page(o.preview))
    page =
        page_of_spheres(run.robot, o.output,
                        verify::decide_spheres(run.robot, robot::parse_spheres(o.output, made.text),
                                               o.output, o.robot.shapes));
  else if (!o.preview.empty())
    scene = robot_folder::glb_of_shapes(run.robot.robot, shapes);
  for (const std::string& note : made.notes) run.notes.add(o.output, note);
  io::write_file(o.output, made.text);
  if (is_page(o.preview))
    io::write_file(o.preview, page);
  else if (!o.preview.empty())
    io::write_file(o.preview, scene);
  return {std::move(made.text), format.spheres ? 0 : shapes.beyond};
}

/// The files that a robot is read from besides its own, its meshes too.
/// @throws Error{InvalidArgument} where one of them is to be written
std::vector<std::string> parts_of(const DecomposeOptions& o, const robot::RobotFile& robot,
                                  const robot::ShapeChoice& shapes) {
  std::vector<std::string> out = robot::included_files(robot);
  for (std::string& file : strings(robot::link_meshes(robot, shapes).files))
    out.push_back(std::move(file));
  require_apart({{"--output", o.output},
                 {"--report", o.common.report},
                 {"--preview", o.preview},
                 {"--depfile", o.depfile}},
                out);
  return out;
}

constexpr double kMore = 1.001;  ///< of a distance, so that it is decided

/// The command that decides it from the file alone, with epsilon where that is kept; else with how
/// far the bodies are.
/// @param distance  of the farthest point [m]
std::string check_of_shapes(const Run& run, const BodyFormat& format, bool reached,
                            double distance) {
  std::string out = "bound-verify robot " + shell_file(run.o.input) +
                    (format.spheres ? " --spheres " : " --bodies ") + shell_file(run.o.output) +
                    reading_words(run.o.robot);
  const std::optional<Length> epsilon = run.request.set.wanted_epsilon();
  if (reached && epsilon && !epsilon->percent && run.request.epsilons.empty())
    out += " --epsilon " + epsilon->text();
  else if (std::isfinite(distance))
    out += " --epsilon " + number_up(kMore * distance);
  return out +
         (run.o.epsilon_map ? " --epsilon-map " + shell_word(*run.o.epsilon_map) : std::string());
}

/// What was made, and what decides it.
/// @param without_pairs  of links that need no check
void say_shapes(const Run& run, const BodyFormat& format, const certify::CertifiedBodies& bodies,
                const std::string& check, double distance, bool without_pairs) {
  const DecomposeOptions& o = run.o;
  const bool spheres = o.set.request.body_kind == certify::SetRequest::BodyKind::Spheres;
  log(o.common.quiet, o.output + ": " +
                          (spheres ? counted(bodies.artefact().size(), "sphere", "spheres")
                                   : counted(bodies.artefact().size(), "body", "bodies")) +
                          ", no point farther from its link's shapes than " + number_up(distance) +
                          ", on the mean of links " + number_up(mean_distance(bodies)));
  log(o.common.quiet, "from the files alone: " + check);
  if (!o.pairs.empty())
    log(o.common.quiet, "its pairs: kaboum-pairs " + shell_file(o.input) + " --judge " +
                            shell_file(o.output) + " --fail-on open");
  if (format.spheres && o.preview.empty())
    log(o.common.quiet,
        "seen in a browser: by --preview FILE.html here, or --page FILE.html there");
  using Format = robot_folder::SphereFormat;
  if (without_pairs && (format.spheres == Format::Curobo || format.spheres == Format::Xrdf))
    log(o.common.quiet,
        o.output +
            ": no pairs of links are stated that need no check, and neighbouring links seem "
            "to collide then: kaboum-pairs ROBOT --srdf FILE finds them, --pairs FILE states "
            "them");
}

/// Warns of links whose spheres always meet, in what was written.
/// @return the warnings
Json warn_of_meeting(const robot::Robot& robot, const std::string& file, const std::string& text,
                     const std::vector<robot_folder::UncheckedLinks>& unchecked, bool quiet,
                     const std::string& epsilon) {
  std::vector<std::pair<std::string, std::string>> left_out;
  left_out.reserve(unchecked.size());
  for (const robot_folder::UncheckedLinks& pair : unchecked) left_out.emplace_back(pair.a, pair.b);
  Json out = Json::array();
  for (const MeetingLinks& links :
       meeting_links(robot, robot::parse_spheres(file, text), left_out)) {
    log(quiet, text_of(links, epsilon));
    out.push_back({{"links", {links.a, links.b}}, {"of_thousand", links.of_thousand}});
  }
  return out;
}

/// Pairs that a file of spheres states itself; none where it states none that can be read.
std::vector<robot_folder::UncheckedLinks> stated_pairs(const robot::Robot& robot,
                                                       const std::string& file,
                                                       const std::string& text) {
  if (sphere_format_of(file) == robot_folder::SphereFormat::Urdf) return {};
  try {
    return unchecked_of(pairs::parse_matrix(text, file, robot));
  } catch (const Error&) {
    return {};
  }
}

/// Spheres, capsules or boxes of all links, in one file: no meshes.
int decompose_into_shapes(const DecomposeOptions& o) {
  const BodyFormat format = format_of_shapes(o);
  const bool spheres = o.set.request.body_kind == certify::SetRequest::BodyKind::Spheres;
  Run run{o, robot::read_robot(o.input, robot::Motions::None, o.robot.xacro_arguments,
                               o.robot.shapes.packages)};
  run.request = robot_request(o, run.robot, o.robot.shapes);
  run.request.partial = true;
  const std::vector<robot_folder::UncheckedLinks> unchecked =
      unchecked_links(o, run.robot.robot, run.notes);
  const std::vector<std::string> parts = parts_of(o, run.robot, run.request.shapes);
  const certify::SetCache kept(certify::SetCache::default_folder());
  const certify::SetCache* cache = o.no_cache ? nullptr : &kept;
  if (o.robot_bodies > 0) {
    run.request.set.nearest = true;
    share_out(run, cache);
  }
  bool reached = true;
  Json meshes = Json::array();
  Notes shortfalls;
  const certify::CertifiedBodies bodies = [&] {
    MeshProgress progress("bcd-decompose", o.common.quiet,
                          certify::wanted_meshes(run.robot, run.request.shapes,
                                                 run.request.epsilons, run.request.regions),
                          cache != nullptr);
    certify::RobotHooks hooks = hooks_of(run, progress, shortfalls);
    hooks.made = [&, say = hooks.made](const certify::CertifiedLinkMesh& mesh) {
      // A link without spheres is no obstacle for whoever reads them.
      if (!mesh.held) throw Error(ErrorCode::LimitReached, mesh.flaw);
      say(mesh);
      if (!mesh.flaw.empty()) run.notes.add(mesh.mesh.file.string(), mesh.flaw);
      const certify::SetCertificate& certificate = mesh.made.found.set.certificate();
      reached =
          reached && mesh.flaw.empty() && certificate.reached() && certificate.undecided.empty();
      meshes.push_back({{"file", mesh.mesh.file.string()}, {"result", report_of(mesh.made)}});
    };
    return certify::certify_bodies(run.robot, run.request, cache, hooks);
  }();
  run.verdicts = verdicts(bodies);
  say_table(run, lines_of(run, bodies), shortfalls);
  say_regions(run, bodies);
  say_verdicts(run.robot.robot, run.verdicts, o.common.quiet);
  double distance = bodies.certificate().distance;
  const WrittenShapes written = write_shapes(run, format, bodies, unchecked);
  distance += written.beyond;
  if (const std::optional<Length>& epsilon = run.request.set.epsilon;
      format.shapes && run.request.epsilons.empty() && epsilon && !epsilon->percent)
    reached = reached && distance <= epsilon->value;
  const std::string check = check_of_shapes(run, format, reached, distance);
  say_shapes(run, format, bodies, check, distance, unchecked.empty());
  Json meeting = Json::array();
  if (format.spheres)
    meeting = warn_of_meeting(run.robot.robot, o.output, written.text, unchecked, o.common.quiet,
                              "--epsilons");
  say_notes(o.robot, o.common.quiet, run.notes);
  if (!o.common.report.empty())
    write_report(o.common, "bcd-decompose",
                 {{spheres ? "spheres" : "bodies", bodies.artefact().size()},
                  {"meeting", std::move(meeting)},
                  {"reach_upper", distance},
                  {"mean_reach_upper", mean_distance(bodies)},
                  {"meshes", std::move(meshes)},
                  {"stop", reached ? "done" : "epsilon not reached"},
                  {"input", {{"file", o.input}, {"sha256", run.robot.sha256}}},
                  {"output", {{"file", o.output}}},
                  {"check", check},
                  {"parameters", run.request.parameters()},
                  {"regions", regions_report(run)},
                  {"notes", run.notes.lines()}});
  if (!o.depfile.empty()) {
    std::vector<std::string> inputs{o.input};
    if (!o.pairs.empty()) inputs.push_back(o.pairs);
    if (!o.robot.epsilons.empty()) inputs.push_back(o.robot.epsilons);
    if (o.epsilon_map) inputs.push_back(*o.epsilon_map);
    inputs.insert(inputs.end(), parts.begin(), parts.end());
    for (std::string& file : strings(bodies.certificate().files)) inputs.push_back(std::move(file));
    write_depfile(o.depfile, {o.output}, inputs);
  }
  return reached ? kDone : kNo;
}

std::string text_of(const certify::RepairedLink& link) {
  std::string out = std::to_string(link.kept) + " kept";
  for (const auto& [count, what] :
       {std::pair(link.grown, " grown"), std::pair(link.moved, " moved"),
        std::pair(link.shrunk, " made smaller"), std::pair(link.added, " added")})
    if (count > 0) out += ", " + std::to_string(count) + what;
  return out;
}

/// The command that decides repaired spheres from the file alone.
/// @param reach  how far the farthest reaches [m]
std::string check_of_repaired(const DecomposeOptions& o, double reach) {
  const Length epsilon = *certify::request_of(o.set).epsilon;
  return "bound-verify robot " + shell_file(o.input) + " --spheres " + shell_file(o.output) +
         reading_words(o.robot) + " --epsilon " +
         (epsilon.percent ? number_up(kMore * reach) : epsilon.text());
}

/// Somebody's spheres, changed until they hold.
int repair(const DecomposeOptions& o) {
  if (!sphere_format_of(o.repair))
    throw Error(ErrorCode::InvalidArgument,
                "--repair: " + o.repair + " is " + in_words(kind_of(o.repair)) +
                    "; it takes spheres of a robot's links (.yaml, .yml, .xrdf, .srdf, or .urdf "
                    "with spheres)");
  if (sphere_format_of(o.output) != sphere_format_of(o.repair))
    throw Error(ErrorCode::InvalidArgument,
                "--repair: spheres are written in the format that they have: end --output as " +
                    o.repair + " does (.yaml, .yml, .xrdf, .srdf or .urdf)");
  const robot::RobotFile robot = robot::read_robot(
      o.input, robot::Motions::None, o.robot.xacro_arguments, o.robot.shapes.packages);
  robot::require_links(robot, o.robot.shapes.links);
  const std::vector<char> text = io::read_file(o.repair);
  Progress progress(o.common.quiet);
  certify::RobotHooks hooks;
  hooks.progress = [&](const std::string& stage) { progress.show(stage); };
  const certify::RepairedSpheres made = certify::repair_spheres(
      robot, o.repair, std::string(text.begin(), text.end()),
      {*certify::request_of(o.set).epsilon, o.robot.shapes, o.set.request.effort}, hooks);
  progress.show("");
  io::write_file(o.output, made.text);
  certify::RepairedLink all;
  Json links = Json::array();
  for (const certify::RepairedLink& link : made.links) {
    log(o.common.quiet, "link '" + link.link + "': " + text_of(link));
    links.push_back({{"link", link.link},
                     {"kept", link.kept},
                     {"grown", link.grown},
                     {"moved", link.moved},
                     {"shrunk", link.shrunk},
                     {"added", link.added},
                     {"reach_upper", link.epsilon}});
    all.kept += link.kept;
    all.grown += link.grown;
    all.moved += link.moved;
    all.shrunk += link.shrunk;
    all.added += link.added;
    all.epsilon = std::max(all.epsilon, link.epsilon);
  }
  log(o.common.quiet, o.output + ": " + counted(made.spheres, "sphere", "spheres") + " (" +
                          text_of(all) + ") hold every link; none reaches farther than " +
                          number_up(all.epsilon) + "; decided exactly");
  const std::string check = check_of_repaired(o, all.epsilon);
  log(o.common.quiet, "from the files alone: " + check);
  for (const std::string& note : made.notes) log(o.common.quiet, "note: " + note);
  Json meeting =
      warn_of_meeting(robot.robot, o.output, made.text,
                      stated_pairs(robot.robot, o.output, made.text), o.common.quiet, "--epsilon");
  if (!o.common.report.empty())
    write_report(o.common, "bcd-decompose",
                 {{"spheres", made.spheres},
                  {"meeting", std::move(meeting)},
                  {"kept", all.kept},
                  {"grown", all.grown},
                  {"moved", all.moved},
                  {"shrunk", all.shrunk},
                  {"added", all.added},
                  {"reach_upper", all.epsilon},
                  {"links", std::move(links)},
                  {"stop", "done"},
                  {"input", {{"file", o.input}, {"sha256", robot.sha256}}},
                  {"repaired", {{"file", o.repair}}},
                  {"check", check},
                  {"output", {{"file", o.output}}},
                  {"notes", made.notes}});
  if (!o.depfile.empty()) write_depfile(o.depfile, {o.output}, {o.input, o.repair});
  return kDone;
}

}  // namespace

int decompose_robot(const DecomposeOptions& o) {
  if (o.robot.shapes.skip_missing &&
      (!o.repair.empty() || o.set.request.body_kind != certify::SetRequest::BodyKind::Polytopes))
    throw Error(ErrorCode::InvalidArgument,
                "--missing-meshes skip is for --bodies polytopes: a link without spheres, capsules "
                "or boxes is no obstacle for whoever reads them; name the others by --links");
  if (!o.repair.empty()) return repair(o);
  if (o.set.request.direction != certify::SetRequest::Direction::Outer)
    throw Error(ErrorCode::InvalidArgument,
                "--direction inner: decompose the robot's meshes one by one");
  if (o.set.request.body_kind != certify::SetRequest::BodyKind::Polytopes)
    return decompose_into_shapes(o);
  if (const bool shapes = robot_folder::shape_format_of(o.output).has_value();
      (shapes || sphere_format_of(o.output)) && !fs::is_directory(o.output))
    throw Error(ErrorCode::InvalidArgument,
                o.output + ": such files hold spheres" + (shapes ? ", capsules or boxes" : "") +
                    ": state --bodies spheres" + (shapes ? ", capsules, boxes or mixed" : "") +
                    ", or name a folder for the robot, such as " +
                    fs::path(o.output).replace_extension().string() + ", not " + o.output);
  require_robot_folder(o.output, o.output_format);
  Run run{o, robot::read_robot(o.input, o.srdf ? robot::Motions::All : robot::Motions::None,
                               o.robot.xacro_arguments, o.robot.shapes.packages)};
  const std::vector<std::string> included =
      o.depfile.empty() ? std::vector<std::string>() : robot::included_files(run.robot);
  robot_folder::FolderOptions folder = folder_options(o.robot);
  if (!o.inertia.empty()) {
    run.inertia = find_inertia(run.robot, inertia_request(o));
    folder.inertials = inertials_of(run.robot.robot, run.inertia);
  }
  RobotWriter output(std::move(folder), o.output, run.robot, "bodies", "");
  run.request = robot_request(o, run.robot, output.options().shapes);
  run.request.partial = true;
  const certify::WantedMeshes meshes = certify::wanted_meshes(
      run.robot, run.request.shapes, run.request.epsilons, run.request.regions);
  output.plan(meshes);
  if (o.srdf) output.folder().require_own_document(".srdf");
  require_formats(meshes, o.input_format);
  certify_links(run, meshes);
  say_regions(run, run.made.bodies);
  if (run.pairs) output.add_document(".srdf", run.pairs->srdf);
  write(run, output);
  log(o.common.quiet,
      output.folder().urdf().string() + ": " + counts_in_words(run, page::counts_of(run.made)));
  say_verdicts(run.robot.robot, run.verdicts, o.common.quiet);
  log(o.common.quiet, "from the files alone: " + check_of(run, output).command);
  say(output, o.robot, o.common.quiet);
  for (const std::string& text : run.written.lines()) log(o.common.quiet, text);
  say_notes(o.robot, o.common.quiet, run.notes);
  if (run.pairs) log(o.common.quiet, pairs_in_words(*run.pairs));
  if (!o.inertia.empty())
    for (const std::string& line : in_words(run.robot.robot, run.inertia))
      log(o.common.quiet, line);
  if (is_page(o.preview))
    io::write_file(o.preview,
                   page::page_of_robot({o.input, o.set.request.unit,
                                        certify::request_of(o.set).parameters(), remedy_of_program,
                                        next_steps(output, o.robot, check_of(run, output), o.srdf)},
                                       run.robot, run.made, run.verdicts));
  else if (!o.preview.empty())
    io::write_file(o.preview, picture::encode_png(picture::draw_bodies(
                                  page::at_rest(run.robot.robot, run.made.links), o.explode)));
  if (!o.robot.html.empty()) write_page(run, output);
  if (!o.common.report.empty()) write_report(o.common, "bcd-decompose", robot_report(run, output));
  if (!o.depfile.empty()) {
    std::vector<std::string> inputs{o.input};
    if (!o.robot.epsilons.empty()) inputs.push_back(o.robot.epsilons);
    if (o.epsilon_map) inputs.push_back(*o.epsilon_map);
    inputs.insert(inputs.end(), included.begin(), included.end());
    for (std::string& file : strings(run.bodies().files)) inputs.push_back(std::move(file));
    write_depfile(o.depfile, output.documents(), inputs);
  }
  return run.code();
}

}  // namespace kaboum::tools
