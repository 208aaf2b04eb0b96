// The program hausdorff-eval: options, distance::Comparison, lines, report and pictures.

#include <kaboum/base/error.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/distance/compare_options.h>
#include <kaboum/geom/topology.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/page/distance_page.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <optional>
#include <set>

#include "common/cli.h"
#include "common/request_options.h"
#include "report.h"
#include "shape_file.h"

namespace {

using namespace kaboum;  // the tool's own names are few
using distance::Comparison;
using tools::Json;

struct Options {
  std::string a, b, a_as = "auto", b_as = "auto";
  tools::InputFormat input_format;
  distance::CompareOptions compare;
  std::set<std::string> stated;  ///< names of these options that were stated
  std::optional<Length> at_most;
  std::string csv, heatmap;
  tools::UnitOption unit;  // of A
  tools::CommonOptions common;
};

/// Writes a whole number such as 1e6 in digits; leaves all else alone.
std::string whole_number(const std::string& text) {
  char* end = nullptr;
  const double value = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(value >= 0 && value <= 1e15) || value != std::floor(value))
    return text;
  return std::to_string(static_cast<std::uint64_t>(value));
}

void describe(CLI::App& app, Options& o) {
  app.add_option("A", o.a, "Mesh or convex set (- for stdin)")->required()->type_name("A");
  app.add_option("B", o.b, "The other one")->required()->type_name("B");
  tools::add_request_options(app, distance::compare_options(), o.compare, o.stated);
  app.get_option("--samples")->transform(whole_number);
  const std::string kinds = "auto|mesh|set";
  for (auto* kind : {&o.a_as, &o.b_as})
    app.add_option(
           kind == &o.a_as ? "--a-as" : "--b-as", *kind,
           std::string(kind == &o.a_as ? "A" : "B") +
               " is a mesh, or a set of convex bodies of which the union's boundary counts; "
               "auto: a set if it is a folder, a container, or a GLB or OBJ file with "
               "several bodies that are all convex; sets with a margin above 0 need --solid [auto]")
        ->check(CLI::IsMember({"auto", "mesh", "set"}).description(""))
        ->type_name(kinds);
  tools::add_request_option(
      app,
      {.name = "at-most",
       .text =
           "Exit with 1 unless the Hausdorff distance is certainly at most this: a length in the "
           "files' unit or its own, as in 5mm, or a percentage of the diagonal of both bounding "
           "boxes, as in 0.5%; of STEP and IGES the deviation of the exact faces from the "
           "triangles counts, too",
       .kind = OptionDescription::Kind::Length},
      std::nullopt, [&o](const std::string& value) { o.at_most = parse_length(value); });
  app.add_option("--csv", o.csv, "Write the numbers as CSV, a line each way (- for stdout)")
      ->type_name("FILE");
  app.add_option("--heatmap", o.heatmap,
                 "Colours by distance: .png draws A and B with a scale, .html is a page that shows "
                 "them in a browser, .ply is A with colours and the distance as `quality`")
      ->type_name("FILE");
  tools::add_input_format(app, o.input_format, "Format of - and of unknown extensions");
  tools::add_unit_options(app, o.unit, "A");
  tools::add_common_options(app, o.common);
  app.footer(
      "Measures surface to surface, or solid to solid with --solid.\n"
      "Prints one-sided distances both ways and the Hausdorff distance, in the files' unit and "
      "relative to the diagonal of both bounding boxes. min and max are certified intervals; "
      "mean and rms are estimates with their standard error.\n"
      "Exit codes: 0 done; 1 --at-most does not hold (or is not certain); 2 usage; 3 bad input; "
      "4 output failed; 5 feature not built; 6 internal error; 7 an interval stayed wider than "
      "wished (it is printed and holds all the same), or out of memory.");
}

void check_files(const Options& o) {
  const auto require = [](bool condition, const char* message) {
    if (!condition) throw Error(ErrorCode::InvalidArgument, message);
  };
  require(o.a != "-" || o.b != "-", "A and B cannot both be standard input");
  tools::require_apart({{"--report", o.common.report}, {"--csv", o.csv}, {"--heatmap", o.heatmap}},
                       {o.a, o.b});
  require(o.heatmap.empty() || page::is_heatmap(o.heatmap),
          "--heatmap: give a .png, .html or .ply file");
}

distance::CompareOptions compare_options(const Options& o, tools::Progress& progress) {
  distance::CompareOptions out = o.compare;
  out.progress = [&progress](const std::string& stage) { progress.show(stage); };
  return out;
}

/// What a file is called on a page.
std::string shown_name(const std::string& file) {
  return file == "-" ? "standard input" : std::filesystem::path(file).filename().string();
}

/// Segments and points of a mesh bound nothing, so that no solid is near or far because of them.
void note_what_bounds_nothing(tools::ShapeFile& file) {
  const geom::Mesh& mesh = file.shape.mesh;
  const auto flat = std::ranges::count_if(mesh.triangles, [&](const geom::Triangle& t) {
    return geom::is_degenerate(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  });
  if (flat > 0)
    file.notes.push_back(
        std::to_string(flat) +
        (flat == 1 ? " triangle without area bounds" : " triangles without area bound") +
        " nothing: with --solid no distance from or to it is measured");
}

/// The exit code, said where it is not 0.
/// @param deviations  of exact faces from the triangles that stand for them, added
/// @param unit  of both files; empty: not known
int conclude(const Options& o, double diagonal, const std::string& unit, double deviations,
             const distance::Compared& result) {
  if (o.at_most) {
    const double limit = o.at_most->in(unit).of(diagonal);
    if (deviations > 0 ? (result.upper() + deviations) * (1 + 0x1p-50) > limit
                       : result.upper() > limit) {
      tools::log(false, "hausdorff-eval: " +
                            std::string(result.lower() > limit
                                            ? "the Hausdorff distance exceeds "
                                            : "it is not certain that the Hausdorff distance is "
                                              "at most ") +
                            tools::formatted(limit) +
                            (deviations > 0 ? ": the deviation of exact faces, " +
                                                  tools::formatted(deviations) + ", is added to " +
                                                  tools::formatted(result.upper())
                                            : ""));
      return tools::kNo;
    }
    if (deviations > 0)
      tools::log(o.common.quiet,
                 "note: --at-most holds of the triangles, and from the exact faces to the other "
                 "surface; from there to the exact faces nothing is certain");
  }
  if (!result.a_to_b.max.within_gap || !result.b_to_a.max.within_gap) {
    tools::log(false,
               "hausdorff-eval: the work allowed did not reach the wished gap; the interval "
               "holds, but is wider");
    return tools::kLimit;
  }
  return tools::kDone;
}

int run(const Options& o) {
  check_files(o);
  const auto now = [] { return std::chrono::steady_clock::now(); };
  const auto since = [&](auto start) {
    return std::chrono::duration<double>(now() - start).count();
  };
  tools::Progress progress(o.common.quiet);
  const auto start = now();
  const auto read = [&](const std::string& file, const std::string& as,
                        const tools::UnitOption& unit) {
    progress.show("reading " + file);
    return tools::read_shape(file, {as, o.input_format, unit});
  };
  std::array<tools::ShapeFile, 2> files{read(o.a, o.a_as, o.unit), read(o.b, o.b_as, {})};
  if (o.compare.solid)
    for (tools::ShapeFile& file : files) note_what_bounds_nothing(file);
  io::require_same_unit(o.a, files[0].unit, o.b, files[1].unit);
  const double reading = since(start);
  const auto begin = now();
  const auto shape_of = [](tools::ShapeFile& file) {
    distance::Shape shape = std::move(file.shape);
    file.shape.name = shape.name;
    return shape;
  };
  const Comparison comparison(shape_of(files[0]), shape_of(files[1]), compare_options(o, progress));
  const double building = since(begin);
  const auto built = now();
  const distance::Compared result = comparison.measure();
  progress.show("colours");
  if (!o.heatmap.empty())
    io::write_file(
        o.heatmap,
        page::heatmap(o.heatmap,
                      {comparison, result, {shown_name(o.a), shown_name(o.b)}, o.compare.solid}));
  const double measuring = since(built);
  const tools::ComparisonReport report{files, comparison, result, o.compare.solid};
  if (!o.csv.empty()) io::write_file(o.csv, report.csv());
  if (!o.common.report.empty()) {
    Json json = report.json();
    json["options"] = {{"gap", o.compare.relative_gap},
                       {"scale", o.unit.scale},
                       {"samples", o.compare.samples},
                       {"seed", o.compare.seed},
                       {"backend", value_of(distance::compare_options(), "backend", o.compare)}};
    json["resources"] = {{"seconds_reading", reading},
                         {"seconds_building", building},
                         {"seconds_measuring", measuring},
                         {"threads", o.common.threads}};
    tools::write_report(o.common, "hausdorff-eval", json);
  }
  if (!o.common.quiet && o.csv != "-" && o.common.report != "-")
    io::write_file("-", report.table());
  for (const tools::ShapeFile& file : files)
    for (const std::string& note : file.notes)
      tools::log(o.common.quiet, "note: " + file.shape.name + ": " + note);
  return conclude(o, comparison.diagonal(), files[files[0].unit.empty() ? 1 : 0].unit,
                  files[0].deviation + files[1].deviation, result);
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Distances between two surfaces, with certified intervals.", "hausdorff-eval");
  Options options;
  describe(app, options);
  return tools::run(app, argc, argv, [&] {
    const tools::ThreadLimit limit(options.common.threads);
    return run(options);
  });
}
