#include <kaboum/base/error.h>
#include <kaboum/certify/set_cache.h>
#include <kaboum/io/convex_io.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <sstream>

#include "certified_file.h"
#include "cli.h"
#include "holes_option.h"
#include "notes.h"
#include "robot_bodies.h"
#include "robot_decomposition.h"
#include "set_format.h"
#include "set_picture.h"
#include "urdf_output.h"

namespace {

using namespace kaboum;
using tools::Json;

struct Options {
  std::string input, output, input_format, output_format, epsilon, direction = "outer";
  std::string effort = "normal", method = "planes", pre_step = "auto";
  std::string unit = "m", frame, preview, depfile, geometry = "collision", prefix;
  std::vector<std::string> packages, links;
  std::size_t max_bodies = 0, max_vertices = 64, max_total = 0;
  double explode = 0.5, min_thickness = 0;
  std::optional<double> simplify, max_work;
  bool no_cache = false;
  geom::PrepareOptions prepare;
  tools::HolesOption holes;
  tools::CommonOptions common;
  tools::Notes* notes = nullptr;  ///< of a robot's meshes; null: said at once
};

/// Something that a user should know of the input.
void note(const Options& o, const std::string& text) {
  if (o.notes != nullptr) {
    o.notes->add(o.input, text);
  } else {
    tools::log(o.common.quiet, o.input + ": " + text);
  }
}

const std::map<std::string, bcd::Effort> kEfforts{
    {"fast", bcd::Effort::Fast}, {"normal", bcd::Effort::Normal}, {"best", bcd::Effort::Best}};

const std::map<std::string, bcd::Method> kMethods{{"planes", bcd::Method::Planes},
                                                  {"clusters", bcd::Method::Clusters},
                                                  {"voxels", bcd::Method::Voxels}};

const std::map<std::string, bcd::PreStep> kPreSteps{
    {"auto", bcd::PreStep::Auto}, {"on", bcd::PreStep::On}, {"off", bcd::PreStep::Off}};

void describe(CLI::App& app, Options& o) {
  app.add_option("INPUT", o.input,
                 "Mesh to decompose (- for stdin), or a robot (.urdf), every link of it")
      ->required()
      ->type_name("FILE");
  app.add_option("-o,--output", o.output,
                 "Where the bodies go: a .glb container, an .obj with one object per body, or a "
                 "folder with one STL per body (- for stdout); for robots a folder, which gets a "
                 "URDF, the bodies that it refers to, and a container per link")
      ->required()
      ->type_name("PATH");
  app.add_option("--epsilon", o.epsilon,
                 "Fewest bodies with no point farther than this from the solid: a length in the "
                 "mesh's unit, or a percentage of the bounding box's diagonal, as in 0.5% [1% "
                 "unless --max-bodies or --max-total-vertices is given]")
      ->check([](const std::string& s) {
        return tools::parse_length(s) ? std::string()
                                      : "must be a positive number, or a percentage such as 0.5%, "
                                        "without blanks or units";
      })
      ->type_name("LENGTH|P%");
  app.add_option("--max-bodies", o.max_bodies,
                 "Look for the smallest distance with at most this many bodies (1 to 100000; of a "
                 "robot, for each of its meshes)")
      ->check(CLI::Range(1, 100000).description(""))
      ->type_name("N");
  app.add_option("--max-vertices-per-body", o.max_vertices,
                 "Most vertices of a body (8 to 100000); physics engines take 64 or 255")
      ->check(CLI::Range(8, 100000).description(""))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--simplify", o.simplify,
                 "Share of epsilon that leaving out vertices may take (0 to 1): with 0.25, bodies "
                 "have up to half as many vertices more and collide falsely less often; not with "
                 "--max-total-vertices [0.5]")
      ->check(tools::number_from(0, 1))
      ->type_name("SHARE");
  app.add_option("--min-thickness", o.min_thickness,
                 "Thicken bodies that are less wide than this in some direction, for engines that "
                 "shrink hulls; counts towards epsilon [0]")
      ->check(tools::number_from(0, 1e30))
      ->type_name("LENGTH");
  app.add_option("--max-total-vertices", o.max_total,
                 "Smallest distance with at most this many vertices of all bodies together (8 to "
                 "10000000; of a robot, for each of its meshes), and at most --max-bodies where "
                 "that is given; searches longer")
      ->check(CLI::Range(8, 10000000).description(""))
      ->type_name("N");
  app.add_option("--direction", o.direction,
                 "outer: bodies that cover the solid; inner: bodies inside it, which leave out no "
                 "point deeper than epsilon (not of robots) [outer]")
      ->check(CLI::IsMember({"outer", "inner"}).description(""))
      ->type_name("outer|inner");
  app.add_option("--effort", o.effort, "How long to search [normal]")
      ->check(CLI::IsMember({"fast", "normal", "best"}).description(""))
      ->type_name("fast|normal|best");
  app.add_option("--max-work", o.max_work,
                 "End the search after so much work, counted in steps that take about so many "
                 "seconds of one core, so that the result is the same on any machine; what was "
                 "found is then checked and written [20, and 1 per 1000 triangles beyond 10000; no "
                 "limit with --effort best]")
      ->check(tools::number_from(0.001, 1e9))
      ->type_name("SECONDS");
  app.add_option("--method", o.method,
                 "How to find bodies; the claims are the same. clusters (of triangles, as HACD "
                 "does) and voxels (cuts across the axes, as V-HACD does) are there to be compared "
                 "with [planes]")
      ->check(CLI::IsMember({"planes", "clusters", "voxels"}).description(""))
      ->type_name("planes|clusters|voxels");
  app.add_option("--pre-step", o.pre_step,
                 "Simplify the input first to a mesh round it, within a tenth of epsilon (0.1% "
                 "where none is given); distances remain those to the input; auto: above 20000 "
                 "triangles, if a quarter of the vertices suffices [auto]")
      ->check(CLI::IsMember({"auto", "on", "off"}).description(""))
      ->type_name("auto|on|off");
  app.add_option("--unit", o.unit,
                 "Unit of length, noted in the container: m, dm, cm, mm, um, km, in or ft")
      ->check(tools::unit_name())
      ->capture_default_str()
      ->type_name("NAME");
  app.add_option("--frame", o.frame, "Coordinate frame, noted in the container")->type_name("NAME");
  app.add_option("--preview", o.preview, "Write a picture of the bodies (PNG)")
      ->check(tools::png_name())
      ->type_name("FILE");
  app.add_option("--explode", o.explode,
                 "How far apart the picture's second panel draws the bodies; 0: no second panel")
      ->check(tools::number_from(0, 10))
      ->capture_default_str()
      ->needs("--preview")
      ->type_name("X");
  app.add_flag("--no-cache", o.no_cache,
               "Neither use nor store results of earlier runs ($KABOUM_CACHE, else "
               "$XDG_CACHE_HOME/kaboum, else ~/.cache/kaboum)");
  app.add_flag("--drop-sheets", o.prepare.drop_sheets,
               "Drop back-to-back faces without volume (they are then not covered)");
  tools::add_holes_options(app, o.holes, false);
  app.add_flag("--keep-orientation", o.prepare.keep_orientation,
               "Never turn inconsistent triangles or inside-out components");
  app.add_option("--geometry", o.geometry, "Which shapes of a robot [collision]")
      ->check(CLI::IsMember({"collision", "visual"}).description(""))
      ->type_name("collision|visual");
  app.add_flag_callback(
      "--visual", [&o] { o.geometry = "visual"; }, "The same as --geometry visual");
  app.add_option("--links", o.links,
                 "Only these links of a robot, separated by commas; the others stay as they are "
                 "[all]")
      ->delimiter(',')
      ->type_name("A,B");
  app.add_option("--package-path", o.packages,
                 "A package of a robot's package:// or a folder that holds it, besides "
                 "$ROS_PACKAGE_PATH, $AMENT_PREFIX_PATH and the folders above the robot's file "
                 "(repeatable)")
      ->type_name("DIR");
  app.add_option(
         "--mesh-prefix", o.prefix,
         "Put before the bodies' file names in a robot's new URDF, as in package://arm, with "
         "a slash between; RViz and MoveIt need it [names relative to the URDF]")
      ->type_name("URI");
  app.add_option("--depfile", o.depfile, "Write a Makefile dependency rule")->type_name("FILE");
  app.add_option("--input-format", o.input_format, "Format of INPUT [by extension]")
      ->type_name("NAME");
  tools::add_set_format_option(app, o.output_format);
  tools::add_common_options(app, o.common);
  app.footer(
      "The union of the bodies contains the solid of INPUT and every one of its triangles; this "
      "is decided exactly on the bytes that are written. An open INPUT is closed by filling its "
      "holes first. With --direction inner, every body lies inside the solid instead.\n"
      "Exit codes: 0 done; 1 epsilon is not reached, or not within the limits or with "
      "--min-thickness (the best result is written); 2 usage; 3 bad input; 4 output failed; 5 "
      "not built; 6 internal error; 7 limit (epsilon is not reached with --max-work: the best "
      "result is written).");
}

std::string percent(double length, double diagonal) {
  std::ostringstream out;
  out.precision(3);
  out << length << " (" << (diagonal > 0 ? 100 * length / diagonal : 0) << " % of the diagonal)";
  return out.str();
}

/// What the options ask for.
certify::SetRequest request_of(const Options& o) {
  certify::SetRequest r;
  if (o.direction != "outer") r.direction = certify::SetRequest::Direction::Inner;
  if (!o.epsilon.empty()) r.epsilon = tools::parse_length(o.epsilon);
  if (o.max_bodies > 0) r.max_bodies = o.max_bodies;
  if (o.max_total > 0) r.max_total_vertices = o.max_total;
  r.max_vertices = o.max_vertices;
  r.effort = kEfforts.at(o.effort);
  r.method = kMethods.at(o.method);
  r.pre_step = kPreSteps.at(o.pre_step);
  r.simplify = o.simplify;
  r.max_work = o.max_work;
  r.min_thickness = o.min_thickness;
  r.preparation = o.prepare;
  r.preparation.holes = o.holes.value();
  r.unit = o.unit;
  r.frame = o.frame;
  return r;
}

/// float32 cannot hold the bodies closely enough: a valid "no", nothing is written.
struct TooCoarse {};

/// The bodies of one mesh, from the cache where possible.
tools::CertifiedFile decompose_mesh(const Options& o) {
  tools::Progress progress(o.common.quiet);
  const certify::Hooks hooks{[&](const std::string& stage) { progress.show(stage); },
                             [&](const std::string& text) { note(o, text); }};
  const certify::SetCache cache(certify::SetCache::default_folder());
  auto made = tools::certify_file(o.input, o.input_format, request_of(o),
                                  o.no_cache ? nullptr : &cache, hooks);
  if (!made) throw TooCoarse{};
  return std::move(*made);
}

/// What the report says of one mesh: of its certificate, with what reading noted.
Json report_of(const tools::CertifiedFile& made) {
  Json report = Json::parse(made.found.set.certificate.to_json());
  Json notes = made.read_notes;
  for (const std::string& text : made.found.set.certificate.notes) notes.push_back(text);
  report["notes"] = std::move(notes);
  report["cached"] = made.found.cached;
  return report;
}

/// The exit code of a mesh's outcome.
int code_of(const certify::SetCertificate& certificate) {
  if (certificate.stop == bcd::Stop::Done) return tools::kDone;
  return certificate.stop == bcd::Stop::OutOfWork ? tools::kLimit : tools::kNo;
}

/// Why epsilon, if asked for, is not reached, and what helps; empty when it is.
std::string shortfall(const certify::SetCertificate& c) {
  switch (c.stop) {
    case bcd::Stop::Done:
      return {};
    case bcd::Stop::OutOfWork:
      return "epsilon was not reached within the work allowed; allow more with --max-work, or a "
             "larger epsilon";
    case bcd::Stop::Stuck:
      if (c.thickened > 0)
        return "epsilon could not be reached with --min-thickness; allow thinner bodies or a "
               "larger epsilon";
      if (c.direction == certify::SetRequest::Direction::Inner)
        return "epsilon could not be reached: the search for deep points gave up; allow a larger "
               "epsilon, or --effort best";
      return "epsilon could not be reached; allow more vertices per body";
    case bcd::Stop::TooManyBodies:
    case bcd::Stop::TooCoarse:
      break;
  }
  return "within the limits of bodies and vertices nothing nearer was found; allow more, or a "
         "larger epsilon";
}

std::string summary(const certify::SetCertificate& c) {
  return std::to_string(c.bodies) + (c.bodies == 1 ? " body, " : " bodies, ") +
         std::to_string(c.vertices) +
         (c.direction == certify::SetRequest::Direction::Outer
              ? " vertices; cover verified exactly; no point farther from the solid than "
              : " vertices; inside verified exactly; no point left out deeper than ") +
         percent(c.distance_upper, c.diagonal);
}

bool is_robot(const std::string& path) {
  std::string extension = std::filesystem::path(path).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return extension == ".urdf";
}

/// Options that a plain mesh has no use for are mistakes.
void require_effect(const CLI::App& app, const Options& o) {
  if (is_robot(o.input)) return;
  for (const char* option :
       {"--geometry", "--visual", "--links", "--package-path", "--mesh-prefix"})
    if (app.get_option(option)->count() != 0)
      throw Error(ErrorCode::InvalidArgument, std::string(option) + " is for robots (.urdf); " +
                                                  o.input + " is taken for a mesh");
}

int decompose_robot(const Options& o) {
  if (o.direction != "outer")
    throw Error(ErrorCode::InvalidArgument,
                "--direction inner: decompose the robot's meshes one by one");
  if (!o.output_format.empty() || o.output == "-")
    throw Error(ErrorCode::InvalidArgument, "-o: a robot's bodies need a folder");
  const std::filesystem::path folder(o.output);
  const bool names_file = is_robot(o.output) || io::format_from_name(folder.extension().string());
  if (names_file && !tools::is_folder(folder))
    throw Error(ErrorCode::InvalidArgument,
                "-o: a robot's bodies need a folder, which gets a URDF, the bodies and a container "
                "per link; name one without the extension of a file, such as " +
                    std::filesystem::path(folder).replace_extension().string() + ", not " +
                    o.output);
  tools::RobotDecomposition robot;
  robot.robot = o.input;
  robot.folder = o.output;
  robot.visual = o.geometry == "visual";
  robot.links = o.links;
  robot.packages = o.packages;
  robot.prefix = tools::with_slash(o.prefix);
  robot.parameters = request_of(o).parameters() + (robot.visual ? " --geometry visual" : "");
  robot.unit = o.unit;
  int code = tools::kDone;
  tools::Notes notes;
  const tools::RobotResult result = tools::decompose_robot(
      robot, [&](const std::filesystem::path& file, const geom::Vec3& scale) -> tools::MeshBodies {
        Options mesh = o;
        mesh.input = file.string();
        mesh.notes = &notes;
        if (const auto epsilon = tools::parse_length(o.epsilon))
          mesh.epsilon = tools::epsilon_of_mesh(*epsilon, scale.maxCoeff()).text();
        // A little more than rounding takes away.
        mesh.min_thickness = o.min_thickness / scale.minCoeff() * (1 + 1e-12);
        tools::CertifiedFile made = decompose_mesh(mesh);
        const certify::SetCertificate& certificate = made.found.set.certificate;
        tools::MeshBodies bodies{std::move(made.found.set.set), report_of(made),
                                 std::move(made.other_files)};
        tools::log(o.common.quiet, mesh.input + ": " + summary(certificate) +
                                       (made.found.cached ? " (from the cache)" : ""));
        if (const std::string why = shortfall(certificate); !why.empty()) {
          tools::log(o.common.quiet, mesh.input + ": " + why);
          code = std::max(code, code_of(certificate));
        }
        return bodies;
      });
  const auto counted = [&](const char* key, const char* one, const char* many) {
    const Json& value = result.report[key];
    const std::size_t n = value.is_array() ? value.size() : value.get<std::size_t>();
    return std::to_string(n) + ' ' + (n == 1 ? one : many);
  };
  tools::log(o.common.quiet, result.report["urdf"].get<std::string>() + ": " +
                                 counted("bodies", "body", "bodies") + " of " +
                                 counted("links", "link", "links") + ", from " +
                                 counted("meshes", "mesh", "meshes"));
  tools::log(o.common.quiet, tools::how_meshes_are_found(result.report["urdf"].get<std::string>(),
                                                         "bodies", robot.prefix));
  for (const std::string& text : notes.lines()) tools::log(o.common.quiet, text);
  for (const std::string& text : result.notes) tools::log(o.common.quiet, text);
  for (const std::string& text :
       tools::notes_on({{}, result.bare.other}, robot.visual,
                       robot.visual ? ", which stay as they are"
                                    : ": nothing of this is covered (--visual covers those)"))
    tools::log(o.common.quiet, o.input + ": " + text);
  if (!o.preview.empty()) io::write_file(o.preview, tools::picture_of(result.at_rest, o.explode));
  if (!o.common.report.empty()) {
    Json report = result.report;
    report["stop"] = code == tools::kDone ? "done" : "epsilon not reached";
    report["links_without_shapes"] = result.bare.all();
    report["input"] = {{"file", o.input}};
    report["parameters"] = robot.parameters;
    tools::write_report(o.common, "bcd-decompose", report);
  }
  if (!o.depfile.empty()) {
    std::vector<std::string> inputs;
    for (const std::filesystem::path& p : result.inputs) inputs.push_back(p.string());
    tools::write_depfile(o.depfile, {result.report["urdf"].get<std::string>()}, inputs);
  }
  return code;
}

int decompose(const Options& o) {
  if (o.max_total > 0 && o.direction != "outer")
    throw Error(ErrorCode::InvalidArgument, "--max-total-vertices needs --direction outer");
  if (o.pre_step == "on" && o.direction != "outer")
    throw Error(ErrorCode::InvalidArgument, "--pre-step on needs --direction outer");
  if (o.simplify && o.direction != "outer")
    throw Error(ErrorCode::InvalidArgument, "--simplify needs --direction outer");
  if (o.simplify && o.max_total > 0)
    throw Error(ErrorCode::InvalidArgument,
                "--simplify means nothing with --max-total-vertices, which leaves out as many "
                "vertices as the distance allows");
  tools::require_apart({{"--output", o.output},
                        {"--report", o.common.report},
                        {"--preview", o.preview},
                        {"--depfile", o.depfile}},
                       {o.input});
  const tools::ThreadLimit threads(o.common.threads);
  if (is_robot(o.input)) return decompose_robot(o);
  const io::SetFormat format = tools::set_format_for(o.output, o.output_format);
  if (format == io::SetFormat::Directory) io::require_replaceable(o.output);
  const tools::CertifiedFile made = decompose_mesh(o);
  const auto& [set, certificate, container] = made.found.set;
  tools::log(o.common.quiet, summary(certificate) + (made.found.cached ? " (from the cache)" : ""));
  const std::string why = shortfall(certificate);
  if (!why.empty()) tools::log(o.common.quiet, why);
  if (!o.preview.empty()) io::write_file(o.preview, tools::picture_of(set, o.explode));
  if (!o.common.report.empty()) {
    Json report = report_of(made);
    report["input"] = {{"file", o.input}, {"sha256", made.sha256}};
    report["parameters"] = set.provenance.parameters;
    tools::write_report(o.common, "bcd-decompose", report);
  }
  if (!o.depfile.empty()) {
    std::vector<std::string> inputs{o.input};
    inputs.insert(inputs.end(), made.other_files.begin(), made.other_files.end());
    tools::write_depfile(o.depfile, {o.output}, inputs);
  }
  if (format == io::SetFormat::Glb) {
    io::write_file(o.output, container);
  } else {
    io::write_convex_set(o.output, set, format);
  }
  return code_of(certificate);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Decomposes a solid into few convex bodies whose union provably contains it.",
               "bcd-decompose"};
  Options options;
  describe(app, options);
  return tools::run(app, argc, argv, [&] {
    try {
      require_effect(app, options);
      return decompose(options);
    } catch (const TooCoarse&) {
      tools::log(false, tools::too_coarse(options.input) + ". Nothing is written");
      return static_cast<int>(tools::kNo);
    }
  });
}
