#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/bmesh/progressive.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/distance.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/winding.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/bracket.h>
#include <kaboum/verify/distance.h>
#include <kaboum/verify/inclusion.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iomanip>
#include <sstream>

#include "cli.h"
#include "extract_levels.h"
#include "holes_option.h"
#include "verdict.h"
#include "written_mesh.h"

namespace {

using namespace kaboum;  // the tool's own names are few
using tools::Json;

struct Options {
  std::string input, output, input_format, output_format;
  std::string direction_name = "outer", cost_name = "distance", effort_name = "normal";
  bmesh::Direction direction = bmesh::Direction::Outer;
  std::string vertices, progressive, from;
  double ratio = 0;
  std::string epsilon;
  std::optional<double> max_work;
  bmesh::Cost cost = bmesh::Cost::Distance;
  bmesh::Effort effort = bmesh::Effort::Normal;
  bool effort_given = false;
  bool as_printed = false;
  std::string precision = "auto";
  double sharp_angle = 90;
  bool keep_convex = false;
  bool verify = false;
  geom::PrepareOptions prepare;
  tools::HolesOption holes;
  std::string log, depfile;
  tools::CommonOptions common;
};

const std::map<std::string, bmesh::Direction> kDirections{{"outer", bmesh::Direction::Outer},
                                                          {"inner", bmesh::Direction::Inner},
                                                          {"any", bmesh::Direction::Any}};
const std::map<std::string, bmesh::Cost> kCosts{{"distance", bmesh::Cost::Distance},
                                                {"mean", bmesh::Cost::Mean},
                                                {"planes", bmesh::Cost::Planes},
                                                {"planes-adapted", bmesh::Cost::PlanesAdapted},
                                                {"planes-diagonal", bmesh::Cost::PlanesDiagonal},
                                                {"triangles", bmesh::Cost::Triangles}};

const std::map<std::string, bmesh::Effort> kEfforts{{"fast", bmesh::Effort::Fast},
                                                    {"normal", bmesh::Effort::Normal},
                                                    {"best", bmesh::Effort::Best}};

template <class T>
std::string name_of(const std::map<std::string, T>& names, T value) {
  for (const auto& [name, v] : names)
    if (v == value) return name;
  return "?";
}

void describe(CLI::App& app, Options& o) {
  app.add_option("INPUT", o.input, "Mesh to simplify (- for stdin)")->type_name("FILE");
  app.add_option(
         "-o,--output", o.output,
         "Where the result goes (- for stdout); {vertices} in the name stands for the wished "
         "number of vertices")
      ->type_name("FILE");
  app.add_option("--direction", o.direction_name,
                 "outer: the result encloses the input; inner: the input encloses the result; any: "
                 "neither, for comparison [outer]")
      ->check(CLI::IsMember({"outer", "inner", "any"}).description(""))
      ->type_name("outer|inner|any");
  app.add_option(
         "--vertices", o.vertices,
         "Stop at this many vertices (at least 4). Several numbers, as in 20000,10000,5000, "
         "give a series in one pass: each result encloses (inner: is enclosed by) the finer "
         "ones; the output's name then contains {vertices}")
      ->check([](const std::string& s) {
        return tools::parse_counts(s) ? std::string()
                                      : "must be a number of vertices from 4 on, or different ones "
                                        "separated by commas, without blanks";
      })
      ->type_name("N[,N...]");
  app.add_option("--progressive", o.progressive,
                 "Also write the mesh, all steps and the levels of --vertices to this file: any "
                 "number of vertices can be taken from it later, and bound-verify --progressive "
                 "checks it")
      ->type_name("FILE");
  app.add_option("--from", o.from,
                 "Instead of INPUT: take results from this progressive file, without computing "
                 "anything anew")
      ->type_name("FILE");
  app.add_option("--ratio", o.ratio,
                 "Stop at this fraction of the input's welded vertices (0 < R < 1)")
      ->check([](const std::string& s) {
        double r = 0;
        return CLI::detail::lexical_cast(s, r) && r > 0 && r < 1 ? std::string()
                                                                 : "must lie between 0 and 1";
      })
      ->type_name("R");
  app.add_option("--epsilon", o.epsilon,
                 "Keep every point of either surface within this distance of the other: a length "
                 "in the mesh's unit, or a "
                 "percentage of the bounding box's diagonal, as in 0.5%")
      ->check([](const std::string& s) {
        return tools::parse_length(s) ? std::string()
                                      : "must be a positive number, or a percentage such as 0.5%, "
                                        "without blanks or units";
      })
      ->type_name("LENGTH|P%");
  app.add_option(
         "--cost", o.cost_name,
         "Cost of a contraction. distance: the measured distance, for a small largest distance; "
         "mean: for a small mean distance; planes and the others: the thesis's, faster, and go "
         "on to fewer vertices, with spikes [distance]")
      ->check(CLI::IsMember(
                  {"planes", "planes-adapted", "planes-diagonal", "triangles", "distance", "mean"})
                  .description(""))
      ->type_name("planes|planes-adapted|planes-diagonal|triangles|distance|mean");
  app.add_option("--effort", o.effort_name,
                 "Tightness against time. fast: contractions only; normal and best: vertices are "
                 "also pulled back towards the input and edges flipped, many times slower (not "
                 "with --keep-convex, nor for open meshes) [normal]")
      ->check(CLI::IsMember({"fast", "normal", "best"}).description(""))
      ->type_name("fast|normal|best");
  app.add_option("--max-work", o.max_work,
                 "End after so much work, counted in steps that take about so many seconds of one "
                 "core, so that the result is the same on any machine; the best result so far is "
                 "written, and encloses as ever [12, and 2 per 1000 triangles beyond 10000; no "
                 "limit with --effort best]")
      ->check(tools::number_from(0.001, 1e9))
      ->type_name("SECONDS");
  app.add_flag("--as-printed", o.as_printed,
               "With the thesis's formulas as printed, to reproduce its tables (only with --cost "
               "planes-diagonal)");
  app.add_option(
         "--precision", o.precision,
         "Numbers of the result's coordinates; auto: float, or double where float is too coarse "
         "and the format can hold it [auto]")
      ->check(CLI::IsMember({"auto", "float", "double"}).description(""))
      ->type_name("auto|float|double");
  app.add_option("--sharp-angle", o.sharp_angle,
                 "Edges whose normals differ by more degrees than this resist growing spikes; 180: "
                 "none (only with --cost planes, planes-adapted and planes-diagonal)")
      ->check(tools::number_from(0, 180))
      ->capture_default_str()
      ->type_name("DEG");
  app.add_flag("--keep-convex", o.keep_convex, "Convex in, convex out, exactly");
  app.add_flag("--drop-sheets", o.prepare.drop_sheets,
               "Drop back-to-back faces without volume (they are then not enclosed)");
  tools::add_holes_options(app, o.holes, true);
  app.add_flag("--keep-orientation", o.prepare.keep_orientation,
               "Never turn inconsistent triangles or inside-out components");
  app.add_flag("--verify", o.verify,
               "Decide enclosure and distances anew, exactly and by independent means, before the "
               "result is written, against the input as prepared; a claim that does not hold gives "
               "exit code 1, an undecided one 7");
  app.add_option("--log", o.log, "Write the log of all steps, for bmesh-replay")->type_name("FILE");
  app.add_option("--depfile", o.depfile, "Write a Makefile dependency rule")->type_name("FILE");
  app.add_option("--input-format", o.input_format, "Format of INPUT [by extension]")
      ->type_name("NAME");
  app.add_option("--output-format", o.output_format, "Format of the result [by extension]")
      ->type_name("NAME");
  tools::add_common_options(app, o.common);
  app.footer(
      "Give at least one of --vertices, --ratio and --epsilon; the first one reached stops. With "
      "--from: --vertices.\n"
      "Exit codes: 0 done; 1 the wished number of vertices cannot be reached (the best result is "
      "written), the mesh is open and --holes keep leaves it so (the result is written and "
      "encloses nothing), float32 is too coarse here (nothing is written) or --verify found a "
      "claim that does not hold; 2 usage; 3 bad input; 4 output failed; 5 feature not built; 6 "
      "internal error; 7 limit reached (with --max-work the wished number of vertices, or what "
      "epsilon allows, is not reached: the best result is written).");
}

/// Faces whose inner side is not in the solid, among at most 20,000 looked at: only the surface
/// claim would protect them. Evidence, not proof.
struct SurfaceSamples {
  std::size_t faces = 0, outside = 0;
};

/// Ends early when some were found, or where so many surfaces lie behind each other that it would
/// take long.
SurfaceSamples sample_surface(const geom::Mesh& mesh, double diagonal) {
  constexpr std::size_t kMost = 20000, kRounds = 16, kEnough = 1000, kMostCrossings = 400'000;
  const geom::WindingNumber winding(mesh);
  const std::size_t step = mesh.triangles.size() / kMost + 1;
  SurfaceSamples samples;
  std::size_t crossings = 0;
  const auto look_at = [&](const geom::Triangle& tri) {
    const geom::Vec3 &a = mesh.vertices[tri[0]], &b = mesh.vertices[tri[1]],
                     &c = mesh.vertices[tri[2]];
    const geom::Vec3 n = (b - a).cross(c - a);
    if (!(n.norm() > 0)) return;
    int w = 0;
    bool touches = false;
    winding.crossings((a + b + c) / 3.0 - n * (1e-9 * diagonal / n.norm()),
                      [&](std::uint32_t, int sign) {
                        ++crossings;
                        w += sign;
                        touches = touches || sign == 0;
                      });
    if (touches) return;
    ++samples.faces;
    samples.outside += w < 1;
  };
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (std::size_t t = round * step; t < mesh.triangles.size(); t += kRounds * step) {
      if (crossings > kMostCrossings) return samples;
      look_at(mesh.triangles[t]);
    }
    if (samples.outside > 0 && samples.faces >= kEnough) break;
  }
  return samples;
}

std::string formatted(double x) {
  std::ostringstream s;
  s << std::setprecision(4) << x;
  return s.str();
}

class Job {
 public:
  explicit Job(Options options) : o_(std::move(options)) {
    o_.direction = kDirections.at(o_.direction_name);
    o_.cost = kCosts.at(o_.cost_name);
    o_.effort = kEfforts.at(o_.effort_name);
    o_.prepare.holes = o_.holes.value();
  }

  int run() {
    require(!o_.input.empty(), "give INPUT, or --from");
    require(!o_.output.empty() || !o_.progressive.empty(),
            "give -o for the result, or --progressive");
    if (!o_.vertices.empty()) counts_ = *tools::parse_counts(o_.vertices);
    require(!counts_.empty() || o_.ratio > 0 || !o_.epsilon.empty(),
            "give at least one of --vertices, --ratio and --epsilon");
    require(counts_.size() < 2 || o_.ratio == 0,
            "several numbers of --vertices cannot be joined with --ratio");
    require(counts_.size() < 2 || o_.log.empty(),
            "--log speaks of one result; --progressive holds the steps of a series");
    require(o_.progressive.empty() || o_.log.empty(), "--progressive contains what --log writes");
    outputs_ = tools::level_files(o_.output, counts_);
    require_separate_files();
    require(o_.depfile.empty() || !(o_.output.empty() || o_.output == "-"),
            "--depfile needs a result that is a file");
    if (!o_.output.empty())
      output_format_ = tools::format_for(o_.output, o_.output_format, "--output-format");
    const io::Format input_format = tools::format_for(o_.input, o_.input_format, "--input-format");
    require(o_.precision != "double" || holds_double(),
            "--precision double: the output format holds float32 only; write .ply, .obj or .off");
    require(!o_.verify || o_.direction != bmesh::Direction::Any,
            "--verify: direction 'any' claims nothing that could be verified");
    require(o_.progressive.empty() || o_.direction != bmesh::Direction::Any,
            "--progressive: direction 'any' claims nothing that the file could prove");
    read(input_format);
    if (!choose_precision()) return tools::kNo;
    if (!decimate()) return tools::kNo;
    for (std::size_t i = 0; i < levels_.size(); ++i) {
      Level& level = levels_[i];
      if (i > 0 && level.result.stop != bmesh::Stop::VertexTarget &&
          levels_[i - 1].result.stop != bmesh::Stop::VertexTarget) {
        repeat(levels_[i - 1], level);
        continue;
      }
      serialise(level);
      if (epsilon_ || o_.verify || !o_.common.report.empty()) measure(level);
      if (o_.verify) verify(level, i > 0 ? &levels_[i - 1] : nullptr);
      look_at_surface(level);
    }
    write_all();
    return conclude();
  }

 private:
  /// One result and what is known of it.
  struct Level {
    std::optional<std::size_t> wished;
    std::string file;  // empty: none
    bmesh::DecimateResult result;
    bool double_precision = false;
    std::vector<char> bytes;
    std::optional<geom::DirectedDistance> to_result, to_original;
    std::optional<verify::Inclusion> verified;
    std::vector<verify::Answer> verified_distance;
    double verified_bound = 0;
    std::optional<verify::Answer> nested;  // in the level before
    // Decided with --verify, and where faces of the input do not bound its solid.
    std::optional<verify::Claim> surface;
    std::size_t left_out = 0;    // triangles that it leaves open, for the work allowed was done
    verify::Bracket sticks_out;  // if it is refuted
    bool at_filling = false;     // its triangle fills a hole

    [[nodiscard]] double hausdorff() const {
      return std::max(to_result->max_upper, to_original->max_upper);
    }
    [[nodiscard]] bool reached() const {
      return (result.stop != bmesh::Stop::Exhausted && result.stop != bmesh::Stop::OutOfWork) ||
             !wished || result.mesh.vertices.size() <= *wished;
    }
  };

  static void require(bool condition, const char* message) {
    if (!condition) throw Error(ErrorCode::InvalidArgument, message);
  }

  [[nodiscard]] bool holds_double() const {
    return !output_format_ || io::holds_double(*output_format_);
  }

  /// A level that was not reached is also what the next one got to.
  static void repeat(const Level& from, Level& to) {
    const auto wished = to.wished;
    const std::string file = to.file;
    to = from;
    to.wished = wished;
    to.file = file;
    to.nested.reset();
  }

  /// No file may be written twice, nor the input overwritten.
  void require_separate_files() const {
    std::vector<std::pair<std::string, std::string>> files{{"--log", o_.log},
                                                           {"--progressive", o_.progressive},
                                                           {"--report", o_.common.report},
                                                           {"--depfile", o_.depfile}};
    for (const std::string& file : outputs_) files.emplace_back("--output", file);
    tools::require_apart(files, {o_.input});
  }

  /// The results come last, so that they are there only if everything that belongs to them is.
  void write_all() {
    std::vector<std::pair<std::string, std::function<void()>>> files;
    files.emplace_back(o_.log, [&] { io::write_file(o_.log, bmesh::serialise_log(log_)); });
    files.emplace_back(o_.progressive, [&] {
      io::write_file(o_.progressive, bmesh::serialise_progressive(progressive()));
    });
    files.emplace_back(o_.common.report,
                       [&] { tools::write_report(o_.common, "bmesh-decimate", report()); });
    files.emplace_back(o_.depfile, [&] {
      std::vector<std::string> targets = outputs_;
      if (!o_.progressive.empty()) targets.push_back(o_.progressive);
      std::vector<std::string> inputs{o_.input};
      inputs.insert(inputs.end(), input_.other_files.begin(), input_.other_files.end());
      tools::write_depfile(o_.depfile, targets, inputs);
    });
    for (const Level& level : levels_)
      files.emplace_back(level.file, [&level] { io::write_file(level.file, level.bytes); });
    tools::write_together(files);
  }

  [[nodiscard]] bmesh::Progressive progressive() const {
    bmesh::Progressive p{log_, precision_ == bmesh::Precision::Double, prepared_.mesh, {}};
    for (const Level& level : levels_)
      p.levels.push_back({level.wished.value_or(level.result.mesh.vertices.size()),
                          level.result.mesh.vertices.size(), level.result.steps});
    return p;
  }

  void say(const std::string& text) const { tools::log(o_.common.quiet, text); }

  /// Whether the steps are wished for.
  [[nodiscard]] bool records() const { return !o_.log.empty() || !o_.progressive.empty(); }

  void read(io::Format format) {
    const bool hash = records() || !o_.common.report.empty();
    std::vector<char> bytes;
    input_ = io::read_mesh(o_.input, format, hash ? &bytes : nullptr);
    if (hash) log_.input_sha256 = io::sha256(bytes);
    for (const std::string& note : input_.notes) say("note: " + note);
    notes_ = input_.notes;
    const std::size_t triangles = input_.mesh.triangles.size();
    prepared_ = tools::naming(o_.input, [&] { return geom::prepare(input_.mesh, o_.prepare); });
    // Closed by its own fill, a flat sheet would be certified to lie in a solid that is nothing.
    if (prepared_.filled_triangles > 0 && !geom::convex_hull(prepared_.mesh.vertices))
      throw Error(ErrorCode::InvalidInput,
                  o_.input +
                      ": all triangles lie in one plane and enclose nothing; give the sheet a "
                      "thickness, or have bcd-decompose cover it");
    if (records()) {
      log_.direction = o_.direction;
      log_.tool = std::string("bmesh-decimate ") + tools::version();
      bmesh::record_preparation(prepared_, triangles, log_);
    }
    input_.mesh = {};
    if (!prepared_.closed)
      prepared_.notes.emplace_back("its border stays where it is, as --holes keep asks");
    for (const std::string& note : prepared_.notes) say("note: " + note);
    notes_.insert(notes_.end(), prepared_.notes.begin(), prepared_.notes.end());
    box_ = geom::bounding_box(prepared_.mesh);
    if (!o_.epsilon.empty()) epsilon_ = tools::parse_length(o_.epsilon)->of(box_.diagonal());
    if (epsilon_ && *epsilon_ > 0.1 * box_.diagonal())
      say("note: epsilon is " + formatted(100 * *epsilon_ / box_.diagonal()) +
          "% of the diagonal, which bounds hardly anything; 1% is written --epsilon 1%");
    if (epsilon_ && !(*epsilon_ > 0))
      throw Error(ErrorCode::InvalidInput,
                  o_.input + ": a percentage of a mesh without extent is no length");
    seconds_read_ = tools::user_seconds();
  }

  bool choose_precision() {
    precision_ = o_.precision == "double" ? bmesh::Precision::Double : bmesh::Precision::Float;
    if (precision_ == bmesh::Precision::Double) return true;
    double limit = 1e-6 * box_.diagonal();
    if (epsilon_) limit = std::min(limit, *epsilon_ / 100);
    const double spacing = geom::float32_spacing(
        std::max(box_.min.cwiseAbs().maxCoeff(), box_.max.cwiseAbs().maxCoeff()));
    if (spacing <= limit) return true;
    if (!double_instead("float32 numbers are " + formatted(spacing) +
                            " apart at these coordinates, more than " + formatted(limit) +
                            " (a millionth of the diagonal, or a hundredth of epsilon)",
                        "move the mesh towards the origin"))
      return false;
    precision_ = bmesh::Precision::Double;
    return true;
  }

  /// Falls back to double where that is allowed; else says what to do.
  bool double_instead(const std::string& why, const std::string& remedy) const {
    if (o_.precision == "auto" && holds_double()) {
      say("note: " + why + ": writing double");
      return true;
    }
    tools::log(false,
               "bmesh-decimate: " + o_.input + ": " + why +
                   "; nothing is written. Write .ply, .obj, .off or (--output-format) stl-ascii, "
                   "which hold doubles" +
                   (o_.precision == "auto" ? "" : ", with --precision double") + "; or " + remedy);
    return false;
  }

  bool decimate() {
    bmesh::DecimateOptions d;
    d.direction = o_.direction;
    d.cost = o_.cost;
    d.keep_convex = o_.keep_convex;
    d.effort = o_.effort;
    effort_ = bmesh::effective_effort(prepared_, d);
    if (o_.effort_given && effort_ != o_.effort) {
      notes_.push_back("--effort " + o_.effort_name + " has no effect " +
                       (o_.keep_convex ? "with --keep-convex" : "on open meshes"));
      say("note: " + notes_.back());
    }
    d.as_printed = o_.as_printed;
    d.precision = precision_;
    d.sharp_angle = o_.sharp_angle;
    d.epsilon = epsilon_;
    d.max_work = o_.max_work;
    if (o_.ratio > 0) {
      const auto n = static_cast<std::size_t>(
          std::ceil(o_.ratio * static_cast<double>(prepared_.mesh.vertices.size())));
      counts_ = {std::max({n, counts_.empty() ? 0 : counts_.front(), std::size_t{4}})};
    }
    if (records()) d.steps = &log_.steps;
    tools::Progress progress(o_.common.quiet);
    const std::size_t start = prepared_.mesh.vertices.size();
    d.progress = [&](std::size_t vertices) {
      std::string text =
          std::to_string(vertices) + " of " + std::to_string(start) + " vertices left";
      if (!counts_.empty()) text += ", " + std::to_string(counts_.back()) + " wished";
      progress.show(text);
    };
    work_allowed_ = bmesh::work_allowed(prepared_, d);
    std::vector<bmesh::DecimateResult> results;
    if (counts_.size() > 1) {
      results = bmesh::decimate_series(prepared_, d, counts_);
    } else {
      if (!counts_.empty()) d.vertices = counts_.front();
      results.push_back(bmesh::decimate(prepared_, d));
    }
    seconds_decimated_ = tools::user_seconds();
    std::size_t unrepresentable = 0;
    for (std::size_t i = 0; i < results.size(); ++i) {
      Level& level = levels_.emplace_back();
      if (!counts_.empty()) level.wished = counts_[i];
      level.file = outputs_[i];
      level.result = std::move(results[i]);
      level.double_precision =
          precision_ == bmesh::Precision::Double || level.result.unrepresentable != 0;
      unrepresentable = std::max(unrepresentable, level.result.unrepresentable);
    }
    if (unrepresentable == 0) return true;
    const std::string vertices =
        std::to_string(unrepresentable) + (unrepresentable == 1 ? " vertex" : " vertices");
    return prepared_.closed
               ? double_instead(vertices + " without a certified float32 position",
                                "move the mesh towards the origin")
               : double_instead(
                     vertices +
                         " without a certified float32 position: an open mesh's "
                         "border stays where it is, and its coordinates are no "
                         "float32 numbers",
                     "round the input's coordinates to float32 first, or close its holes");
  }

  /// The bytes that are verified and written.
  void serialise(Level& level) const {
    level.bytes = tools::serialise_checked(
        level.result.mesh, output_format_.value_or(io::Format::Ply), level.double_precision,
        std::string("bmesh-decimate ") + tools::version());
  }

  /// Distances not far above rounding may take any number: then the bracket is wider.
  static constexpr std::size_t kMaxPieces = std::size_t{1} << 20;

  void measure(Level& level) const {
    const geom::DistanceQuery original(prepared_.mesh), result(level.result.mesh);
    geom::DistanceOptions wished;
    wished.max_pieces = kMaxPieces;
    level.to_result = geom::directed_distance(prepared_.mesh, result, wished);
    level.to_original = geom::directed_distance(level.result.mesh, original, wished);
    if (!epsilon_) return;
    ensure(std::max(level.to_result->max_lower, level.to_original->max_lower) <= *epsilon_,
           "the measured distance exceeds the carried bound");
    // The bound carried through the contractions holds as well; the measured one may lie above it
    // by its gap.
    for (auto* d : {&*level.to_result, &*level.to_original})
      d->max_upper = std::min(d->max_upper, *epsilon_);
  }

  /// The solid claim is certified; whether triangles stick out is decided where the input has faces
  /// that do not bound its solid (folds, inside-out parts): the surface claim fails only there.
  void look_at_surface(Level& level) {
    if (!prepared_.closed || o_.direction == bmesh::Direction::Any) return;
    const bool outer = o_.direction == bmesh::Direction::Outer;
    if (level.verified) {
      level.surface = level.verified->surface;
    } else {
      if (!samples_) samples_ = sample_surface(prepared_.mesh, box_.diagonal());
      if (samples_->outside == 0) return;
      const geom::Mesh& result = level.result.mesh;
      verify::InclusionOptions options;
      options.surface_only = true;
      options.max_work = (1 - kDepthShare) * work_for_surface();
      const verify::Inclusion found = verify::verify_inclusion(
          outer ? prepared_.mesh : result, outer ? result : prepared_.mesh, options);
      level.surface = found.surface;
      level.left_out = found.left_out;
    }
    if (level.surface->answer != verify::Answer::Refuted || level.left_out > 0) return;
    const geom::Mesh &from = outer ? prepared_.mesh : level.result.mesh,
                     &to = outer ? level.result.mesh : prepared_.mesh;
    verify::BracketEffort effort;
    effort.max_work = kDepthShare * work_for_surface();
    level.sticks_out =
        verify::bracket_distance(from, level.surface->inner_triangles, to, true, effort);
    std::uint32_t& triangle = level.sticks_out.triangle;
    level.at_filling = outer && triangle >= prepared_.source.size();
    if (outer && !level.at_filling) triangle = prepared_.source[triangle];
  }

  /// Of what is allowed for the surface of one result, for how far its triangles stick out.
  static constexpr double kDepthShare = 0.3;

  /// What decimation has left of the work allowed, within shares of it; for one result. [s]
  [[nodiscard]] double work_for_surface() const {
    constexpr double kLeast = 0.15, kMost = 0.25;
    if (!std::isfinite(work_allowed_)) return work_allowed_;
    const double left = work_allowed_ - levels_.back().result.work;
    return std::clamp(left, kLeast * work_allowed_, kMost * work_allowed_) /
           static_cast<double>(levels_.size());
  }

  /// Decides the claims anew from the bytes that will be written, by other means than those that
  /// made them. A refuted certificate is our bug: nothing is written.
  void verify(Level& level, const Level* before) const {
    const io::Format format = output_format_.value_or(io::Format::Ply);
    const io::ReadResult back = io::parse_mesh(level.bytes, format, "the result");
    tools::Progress progress(o_.common.quiet);
    verify::InclusionOptions options;
    options.progress = [&](const std::string& what) { progress.show("verifying: " + what); };
    const auto bounds = [&](const geom::Mesh& other) {
      const bool outer = o_.direction == bmesh::Direction::Outer;
      return verify::verify_inclusion(outer ? other : back.mesh, outer ? back.mesh : other,
                                      options);
    };
    level.verified = bounds(prepared_.mesh);
    if (before != nullptr)
      level.nested =
          bounds(io::parse_mesh(before->bytes, format, "the level before").mesh).solid.answer;
    const auto failed = [](verify::Answer a) { return a == verify::Answer::Refuted; };
    ensure(!failed(level.verified->solid.answer) && !(level.nested && failed(*level.nested)),
           "the verification refutes that the result is bounding; nothing is written");
    progress.show("verifying: distances");
    // Epsilon, or the measured bound with room that keeps it decidable.
    level.verified_bound =
        epsilon_ ? *epsilon_ : std::max(level.hausdorff() * (1 + 1e-3), 1e-6 * box_.diagonal());
    for (const bool forth : {true, false}) {
      const verify::DistanceClaim claim =
          verify::verify_distance(forth ? prepared_.mesh : back.mesh,
                                  forth ? back.mesh : prepared_.mesh, level.verified_bound);
      ensure(!failed(claim.answer),
             "the verification refutes the measured distance; nothing is written");
      level.verified_distance.push_back(claim.answer);
    }
  }

  static Json verification(const Level& level) {
    const auto claim = [&](const verify::Claim& c) {
      Json json{{"answer", name_of(c.answer)}, {"reason", c.reason}};
      if (c.witness) {
        json["depth"] = c.witness->depth;
        json["triangles"] = c.inner_triangles.size() + c.outer_triangles.size();
      }
      return json;
    };
    Json json{{"solid", claim(level.verified->solid)},
              {"relative", level.verified->relative},
              {"surface", claim(level.verified->surface)},
              {"distance_bound", level.verified_bound},
              {"distance_original_to_result", name_of(level.verified_distance[0])},
              {"distance_result_to_original", name_of(level.verified_distance[1])}};
    if (level.nested) json["nested"] = name_of(*level.nested);
    return json;
  }

  [[nodiscard]] Json report() const {
    Json r;
    r["input"] = {{"file", o_.input},
                  {"sha256", log_.input_sha256},
                  {"reader_delivers_float32", input_.single_precision},
                  {"file_vertices", input_.file_vertices},
                  {"file_triangles", input_.file_triangles},
                  {"split_polygons", input_.split_polygons}};
    r["input"].update(tools::to_json(geom::analyse(prepared_.mesh)));
    r["preparation"] = {
        {"collapsed_triangles", input_.collapsed_triangles + prepared_.collapsed_triangles},
        {"dropped_copies", prepared_.dropped_copies},
        {"cancelled_walls", prepared_.cancelled_walls},
        {"dropped_sheets", prepared_.dropped_sheets},
        {"turned_components", prepared_.turned_components},
        {"turned_triangles", prepared_.turned_triangles},
        {"holes", prepared_.holes},
        {"filled_triangles", prepared_.filled_triangles},
        {"largest_hole", prepared_.largest_hole},
        {"notes", notes_}};
    r["options"] = {{"direction", name_of(kDirections, o_.direction)},
                    {"cost", name_of(kCosts, o_.cost)},
                    {"effort", name_of(kEfforts, effort_)},
                    {"as_printed", o_.as_printed},
                    {"precision", precision_ == bmesh::Precision::Double ? "double" : "float"},
                    {"vertices", counts_.empty()       ? Json()
                                 : counts_.size() == 1 ? Json(counts_.front())
                                                       : Json(counts_)},
                    {"epsilon", epsilon_ ? Json(*epsilon_) : Json()},
                    {"sharp_angle", o_.sharp_angle},
                    {"keep_convex", o_.keep_convex},
                    {"max_work", o_.max_work ? Json(*o_.max_work) : Json()}};
    if (!o_.progressive.empty()) r["progressive"] = o_.progressive;
    if (levels_.size() == 1) {
      r.update(result(levels_.front()));
    } else {
      for (const Level& level : levels_) {
        Json& entry = r["levels"].emplace_back();
        entry["vertices"] = *level.wished;
        entry["reached"] = level.result.stop == bmesh::Stop::VertexTarget;
        entry.update(result(level));
      }
    }
    r["resources"] = {{"user_seconds_reading", seconds_read_},
                      {"user_seconds_decimating", seconds_decimated_ - seconds_read_},
                      {"threads", o_.common.threads}};
    return r;
  }

  /// What the report says of one result.
  [[nodiscard]] Json result(const Level& level) const {
    Json r;
    r["stop"] = stop_name(level);
    r["out_of_work"] = level.result.out_of_work;
    r["output"] = {{"file", level.file.empty() ? Json() : Json(level.file)},
                   {"precision", level.double_precision ? "double" : "float"}};
    r["output"].update(tools::to_json(geom::analyse(level.result.mesh)));
    r["claims"] = claims(level);
    if (level.verified) r["verification"] = verification(level);
    const bmesh::DecimateStatistics& s = level.result.statistics;
    r["certificate"] = {{"contractions", s.contractions},
                        {"moves", s.moves},
                        {"pull_backs", s.pull_backs},
                        {"flips", s.flips},
                        {"placements", s.placements},
                        {"predicates", s.predicates},
                        {"exact_fallbacks", s.exact_fallbacks},
                        {"rejected",
                         {{"topology", s.rejected_topology},
                          {"no_position", s.rejected_no_position},
                          {"predicate", s.rejected_predicate},
                          {"fold", s.rejected_fold},
                          {"distance", s.rejected_distance},
                          {"spike", s.rejected_spike},
                          {"original", s.rejected_original}}}};
    const double diagonal = box_.diagonal();
    r["distance"] = {{"meaning",
                      "one-sided, surface to surface, certified brackets of the maximum, in the "
                      "input's unit; "
                      "the original is the input after preparation"},
                     {"bbox_diagonal", diagonal},
                     {"original_to_result", tools::to_json(*level.to_result, diagonal)},
                     {"result_to_original", tools::to_json(*level.to_original, diagonal)},
                     {"hausdorff_upper", level.hausdorff()}};
    return r;
  }

  [[nodiscard]] Json claims(const Level& level) const {
    if (o_.direction == bmesh::Direction::Any) return {{"solid", "none"}, {"surface", "none"}};
    const bool outer = o_.direction == bmesh::Direction::Outer;
    Json c;
    c["input"] =
        prepared_.turned_triangles + prepared_.dropped_copies + prepared_.dropped_sheets == 0
            ? "as in the file"
            : "as prepared: with triangles turned or dropped as listed under preparation";
    if (prepared_.holes != 0)
      c["input"] =
          c["input"].get<std::string>() + "; its holes filled: the solid is the one so closed";
    c["solid"] = prepared_.closed
                     ? (outer ? "certified: the result's solid contains the input's"
                              : "certified: the input's solid contains the result's")
                     : "open mesh: certified only that the generalised winding number nowhere " +
                           std::string(outer ? "falls" : "rises");
    if (levels_.size() > 1)
      c["nested"] = outer ? "certified: contains the finer results"
                          : "certified: contained in the finer results";
    if (!prepared_.closed) {
      c["surface"] = "none";
      return c;
    }
    if (level.surface) {
      c["surface"] = decided_surface(*level.surface);
      if (level.left_out > 0) c["surface_triangles_left_out"] = level.left_out;
      if (level.surface->answer == verify::Answer::Refuted) {
        const verify::Bracket& out = level.sticks_out;
        c["surface_triangles_outside"] = level.surface->inner_triangles.size();
        c["surface_depth"] = {{"lower", out.lower},
                              {"upper", std::isfinite(out.upper) ? Json(out.upper) : Json()},
                              {"at", {out.at.x(), out.at.y(), out.at.z()}},
                              {"triangle", level.at_filling ? Json() : Json(out.triangle)}};
      }
      return c;
    }
    if (!outer) {
      c["surface"] = o_.keep_convex
                         ? "none"
                         : "certified: every triangle of the result lies in the input's solid, "
                           "unless those of the input do not";
      return c;
    }
    c["surface"] =
        "sampled: every input face looked at bounds the input's solid, which is contained";
    c["surface_faces_sampled"] = samples_->faces;
    c["surface_faces_outside_solid"] = samples_->outside;
    return c;
  }

  /// The same words as under "verification".
  [[nodiscard]] std::string decided_surface(const verify::Claim& surface) const {
    const bool outer = o_.direction == bmesh::Direction::Outer;
    std::string text = name_of(surface.answer);
    if (surface.answer == verify::Answer::Verified)
      return text + (outer ? ": every triangle of the input lies in the result's solid"
                           : ": every triangle of the result lies in the input's solid");
    if (surface.answer == verify::Answer::Refuted)
      return text + ": " + std::to_string(surface.inner_triangles.size()) + " triangles of the " +
             (outer ? "input do not lie in the result's solid"
                    : "result do not lie in the input's solid");
    return surface.reason.empty() ? text : text + ": " + surface.reason;
  }

  static const char* stop_name(const Level& level) {
    switch (level.result.stop) {
      case bmesh::Stop::VertexTarget:
        return "vertices";
      case bmesh::Stop::ErrorBound:
        return "epsilon";
      case bmesh::Stop::OutOfWork:
        return "out of work";
      case bmesh::Stop::Exhausted:
        break;
    }
    return "exhausted";
  }

  int conclude() const {
    bool no = false, limit = false;
    for (const Level& level : levels_) {
      const int code = conclude(level);
      no = no || code == tools::kNo;
      limit = limit || code == tools::kLimit;
    }
    return no ? tools::kNo : limit ? tools::kLimit : tools::kDone;
  }

  int conclude(const Level& level) const {
    const std::size_t vertices = level.result.mesh.vertices.size();
    std::string line =
        name_for_people(level) + ": " + std::to_string(level.result.statistics.vertices_in) +
        " → " + std::to_string(vertices) + " vertices, " + name_of(kDirections, o_.direction);
    if (o_.direction != bmesh::Direction::Any)
      line += prepared_.closed ? ", certified" : ", NOTHING IS ENCLOSED: the mesh is open";
    if (level.to_result)
      line += ", within " + formatted(level.hausdorff()) + " (" +
              formatted(100 * level.hausdorff() / box_.diagonal()) + "%)";
    if (level.wished && level.result.stop == bmesh::Stop::ErrorBound)
      line += "; epsilon allows no fewer, " + std::to_string(*level.wished) + " were wished";
    say(line);
    warn_of_distance(level);
    warn_of_surface(level);
    const int verification = level.verified ? conclude_verification(level) : tools::kDone;
    const bool claims_nothing = !prepared_.closed && o_.direction != bmesh::Direction::Any;
    if (claims_nothing)
      tools::log(false, "bmesh-decimate: " + o_.input +
                            ": the mesh is open, so it has no solid that the result could " +
                            (o_.direction == bmesh::Direction::Outer ? "enclose" : "lie in") +
                            "; the result is written. Leave out --holes keep to have the holes "
                            "filled, or give --direction any if no enclosure is wished for");
    if (level.result.stop == bmesh::Stop::OutOfWork) {
      tools::log(false, "bmesh-decimate: " + o_.input + ": the work allowed has ended at " +
                            std::to_string(vertices) +
                            " vertices; the result so far is written. Allow more with --max-work, "
                            "or give --effort fast");
      return claims_nothing || verification == tools::kNo ? tools::kNo : tools::kLimit;
    }
    if (level.result.out_of_work)
      say("note: not as near as it might be: the work allowed has ended; allow more with "
          "--max-work");
    if (!level.reached()) {
      tools::log(false, "bmesh-decimate: " + o_.input + ": " + std::to_string(*level.wished) +
                            " vertices cannot be reached with --cost " + o_.cost_name +
                            ": no further contraction is possible at " + std::to_string(vertices) +
                            "; the result so far is written");
      return tools::kNo;
    }
    return claims_nothing ? tools::kNo : verification;
  }

  [[nodiscard]] std::string name_for_people(const Level& level) const {
    return level.file.empty() ? o_.progressive : level.file;
  }

  /// Says which claims are not verified. @return the exit code that they give
  [[nodiscard]] int conclude_verification(const Level& level) const {
    using verify::Answer;
    int code = tools::kDone;
    const auto look = [&](const std::string& what, Answer answer, const std::string& detail) {
      if (answer == Answer::Verified) return;
      tools::log(false, "bmesh-decimate: " + name_for_people(level) + ": " + what + " is " +
                            name_of(answer) + (detail.empty() ? "" : ": " + detail));
      if (answer == Answer::Undecided && code == tools::kDone) code = tools::kLimit;
      if (answer != Answer::Undecided) code = tools::kNo;
    };
    look("the solid claim", level.verified->solid.answer, level.verified->solid.reason);
    const verify::Claim& surface = level.verified->surface;
    if (surface.answer == Answer::Refuted) {
      look("the surface claim", surface.answer,
           std::to_string(surface.inner_triangles.size()) + " triangles stick out, by " +
               tools::in_words(level.sticks_out));
    } else if (surface.answer != Answer::Undefined) {  // open meshes have none
      look("the surface claim", surface.answer, surface.reason);
    }
    if (level.nested) look("the nesting in the level before", *level.nested, "");
    for (const Answer answer : level.verified_distance) look("a distance", answer, "");
    if (code == tools::kDone) say("verified from the written bytes");
    return code;
  }

  [[nodiscard]] static std::string not_looked_at(const Level& level) {
    return "whether " + std::to_string(level.left_out) +
           (level.left_out == 1 ? " triangle sticks" : " triangles stick") +
           " out was not decided, for the work allowed was done; allow more with --max-work";
  }

  /// Which claim holds and which does not, where they differ.
  void warn_of_surface(const Level& level) const {
    if (!level.surface) return;
    const bool outer = o_.direction == bmesh::Direction::Outer;
    if (level.surface->answer == verify::Answer::Undecided && !level.verified) {
      tools::log(o_.common.quiet,
                 std::string("warning: ") +
                     (outer ? "the input's solid is enclosed; whether all of its triangles are"
                            : "the result's solid is inside the input's; whether all of its "
                              "triangles are") +
                     " is left open: " + std::to_string(samples_->outside) + " of " +
                     std::to_string(samples_->faces) +
                     " triangles of the input looked at bound no solid, and " +
                     not_looked_at(level));
      return;
    }
    if (level.surface->answer != verify::Answer::Refuted) return;
    const std::size_t count = level.surface->inner_triangles.size();
    const std::string depth = tools::in_words(level.sticks_out);
    std::string text =
        outer ? "the input's solid is enclosed, but not all of its triangles"
              : "the result's solid is inside the input's, but not all of its triangles";
    text += (level.left_out > 0 ? ": at least " : ": ") + std::to_string(count) +
            (count == 1 ? " sticks out" : " stick out");
    if (!depth.empty()) text += ", by " + depth;
    if (level.sticks_out.lower > 0)
      text += ", farthest at " + tools::point(level.sticks_out.at) +
              (level.at_filling ? ", where a hole was filled"
                                : ", triangle " + std::to_string(level.sticks_out.triangle) +
                                      (outer ? " of the input" : " of the result"));
    text += " (the input is folded or inside out there: such faces bound no solid)";
    if (level.left_out > 0) text += "; " + not_looked_at(level);
    tools::log(o_.common.quiet, "warning: " + text);
  }

  /// Without --epsilon nothing keeps vertices near the original: few of them mean spikes, or
  /// inwards that little is left. Some vertices of the input tell without measuring it all.
  void warn_of_distance(const Level& level) const {
    constexpr double kFar = 0.05;  // of the diagonal
    constexpr std::size_t kSamples = 1000;
    const geom::Mesh& mesh = level.result.mesh;
    if (mesh.triangles.empty()) return;
    const geom::Box3 result = geom::bounding_box(mesh);
    const double beyond =
        std::max((box_.min - result.min).maxCoeff(), (result.max - box_.max).maxCoeff());
    const geom::DistanceQuery surface(mesh);
    double away = 0;
    const std::vector<geom::Vec3>& vertices = prepared_.mesh.vertices;
    for (std::size_t i = 0; i < vertices.size(); i += vertices.size() / kSamples + 1)
      away = std::max(away, surface.nearest(vertices[i]).lower);
    const auto warn = [&](const std::string& what, double length, const char* where) {
      if (!(length > kFar * box_.diagonal())) return;
      tools::log(o_.common.quiet,
                 "warning: " + what + formatted(100 * length / box_.diagonal()) +
                     "% of the diagonal " + where + "; " +
                     (epsilon_ ? "use a smaller --epsilon"
                               : "use more vertices, or --epsilon to bound the distance"));
    };
    warn("the result reaches ", beyond, "beyond the input's bounding box");
    warn("the input has vertices ", away, "away from the result");
  }

  Options o_;
  io::ReadResult input_{};
  geom::Prepared prepared_;
  std::optional<SurfaceSamples> samples_;
  geom::Box3 box_;
  std::optional<double> epsilon_;
  std::vector<std::size_t> counts_;  // wished numbers of vertices, falling; none with epsilon alone
  std::vector<std::string> outputs_;         // the file of each, or of the result
  std::optional<io::Format> output_format_;  // none: only the progressive file is written
  bmesh::Precision precision_ = bmesh::Precision::Float;
  std::vector<Level> levels_;
  bmesh::Log log_;
  std::vector<std::string> notes_;
  bmesh::Effort effort_ = bmesh::Effort::Fast;  // that is made
  double seconds_read_ = 0, seconds_decimated_ = 0;
  double work_allowed_ = 0;
};

/// Options that only some costs follow are not ignored silently with others.
void require_cost_follows(const CLI::App& app, const Options& o) {
  const std::string with = "--cost " + o.cost_name;
  if (o.cost_name != "planes-diagonal") tools::require_absent(app, with, {"--as-printed"});
  if (!o.cost_name.starts_with("planes")) tools::require_absent(app, with, {"--sharp-angle"});
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Simplifies a triangle mesh so that the result provably encloses it (or is enclosed by it).",
      "bmesh-decimate");
  Options options;
  describe(app, options);
  return tools::run(app, argc, argv, [&] {
    const tools::ThreadLimit limit(options.common.threads);
    if (!options.from.empty()) {
      // What makes a result is in the file.
      tools::require_absent(
          app, "--from",
          {"INPUT", "--progressive", "--direction", "--ratio", "--epsilon", "--cost", "--effort",
           "--max-work", "--as-printed", "--precision", "--sharp-angle", "--keep-convex",
           "--drop-sheets", "--holes", "--require-closed", "--keep-orientation", "--verify",
           "--log", "--input-format"});
      return tools::extract_levels({options.from, options.output, options.output_format,
                                    options.vertices, options.depfile, options.common});
    }
    require_cost_follows(app, options);
    options.effort_given = app.count("--effort") > 0;
    return Job(options).run();
  });
}
