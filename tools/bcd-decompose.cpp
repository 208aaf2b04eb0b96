#include <kaboum/bcd/decompose.h>
#include <kaboum/geom/error.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/io/convex_io.h>

#include <sstream>

#include "cli.h"

namespace {

using namespace kaboum;
using tools::Json;

struct Options {
  std::string input, output, input_format, output_format, epsilon, effort = "normal", depfile,
                                                                   unit = "m", frame;
  std::size_t max_bodies = 0, max_vertices = 64;
  geom::PrepareOptions prepare;
  tools::CommonOptions common;
};

const std::map<std::string, bcd::Effort> kEfforts{
    {"fast", bcd::Effort::Fast}, {"normal", bcd::Effort::Normal}, {"best", bcd::Effort::Best}};

std::string percent(double x, double diagonal) {
  std::ostringstream out;
  out.precision(3);
  out << x << " (" << (diagonal > 0 ? 100 * x / diagonal : 0) << " %)";
  return out.str();
}

int decompose(const Options& o) {
  const tools::ThreadLimit threads(o.common.threads);
  std::vector<char> bytes;
  const io::ReadResult read =
      io::read_mesh(o.input, tools::format_for(o.input, o.input_format, "--input-format"), &bytes);
  const geom::Prepared prepared = geom::prepare(read.mesh, o.prepare);
  const double diagonal = geom::bounding_box(prepared.mesh).diagonal();
  bcd::DecomposeOptions options;
  if (!o.epsilon.empty()) options.epsilon = tools::parse_length(o.epsilon)->of(diagonal);
  if (o.max_bodies > 0) options.max_bodies = o.max_bodies;
  if (o.epsilon.empty() && o.max_bodies == 0) options.epsilon = 0.01 * diagonal;
  options.max_vertices = o.max_vertices;
  options.effort = kEfforts.at(o.effort);
  tools::Progress progress(o.common.quiet);
  options.progress = [&](const bcd::Progress& p) {
    progress.show(p.stage + " " + std::to_string(static_cast<int>(100 * p.fraction)) + " %");
  };
  const double before = tools::user_seconds();
  bcd::DecomposeResult result = bcd::decompose(prepared, options);
  const double seconds = tools::user_seconds() - before;
  geom::ConvexSet set;
  set.bodies = std::move(result.bodies);
  geom::Provenance& p = set.provenance;
  p.source = o.input;
  p.source_sha256 = io::sha256(bytes);
  p.tool = std::string("bcd-decompose ") + tools::version();
  p.unit = o.unit;
  p.frame = o.frame;
  p.direction = "outer";
  p.epsilon = result.reach_upper;
  io::write_convex_set(o.output, set);
  tools::log(o.common.quiet, std::to_string(set.bodies.size()) + " bodies, " +
                                 std::to_string(result.statistics.vertices) +
                                 " vertices (largest " + std::to_string(result.statistics.largest) +
                                 "), reach " + percent(result.reach_lower, diagonal) + " to " +
                                 percent(result.reach_upper, diagonal));
  if (!o.common.report.empty()) {
    Json json;
    json["bodies"] = set.bodies.size();
    json["vertices"] = result.statistics.vertices;
    json["largest"] = result.statistics.largest;
    json["reach"] = {{"lower", result.reach_lower},
                     {"upper", result.reach_upper},
                     {"upper_percent", 100 * result.reach_upper / diagonal}};
    json["diagonal"] = diagonal;
    json["user_seconds"] = seconds;
    tools::write_json(o.common.report, json);
  }
  return result.stop == bcd::Stop::Done ? tools::kDone : tools::kNo;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Convex bodies that contain a solid.", "bcd-decompose"};
  Options o;
  app.add_option("INPUT", o.input, "Mesh to decompose (- for stdin)")
      ->required()
      ->type_name("FILE");
  app.add_option("-o,--output", o.output, "Result: .glb, .obj, or a folder")
      ->required()
      ->type_name("PATH");
  app.add_option("--epsilon", o.epsilon,
                 "Largest distance from the bodies to the solid [1% unless --max-bodies is given]")
      ->check([](const std::string& s) {
        return tools::parse_length(s) ? std::string()
                                      : "must be a positive number, or a percentage such as 0.5%";
      })
      ->type_name("LENGTH|P%");
  app.add_option("--max-bodies", o.max_bodies, "Most bodies")
      ->check(CLI::Range(1, 1000000))
      ->type_name("N");
  app.add_option("--max-vertices-per-body", o.max_vertices, "Most vertices of a body")
      ->check(CLI::Range(8, 1000000))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--effort", o.effort, "fast, normal, best")
      ->check(CLI::IsMember({"fast", "normal", "best"}))
      ->capture_default_str();
  app.add_flag("--drop-sheets", o.prepare.drop_sheets, "Drop sheets");
  app.add_option("--input-format", o.input_format, "Format of INPUT [by extension]")
      ->type_name("NAME");
  tools::add_common_options(app, o.common);
  return tools::run(app, argc, argv, [&] { return decompose(o); });
}
