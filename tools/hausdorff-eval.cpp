#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/distance.h>
#include <kaboum/geom/error.h>
#include <kaboum/geom/topology.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/measure/measure.h>
#include <kaboum/measure/search.h>
#include <kaboum/measure/solid.h>
#include <kaboum/verify/cover.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "cli.h"
#include "picture/heatmap.h"
#include "picture/png_file.h"

namespace {

using namespace kaboum;  // the tool's own names are few
using geom::Vec3;
using tools::Json;

struct Options {
  std::string a, b, input_format, a_as = "auto", b_as = "auto";
  bool solid = false;
  double gap = 1e-3;
  std::uint64_t samples = 100000;
  std::string backend = "embree";
  std::string at_most;
  std::string csv, heatmap;
  int width = 1600, height = 800;
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
  app.add_flag("--solid", o.solid,
               "Measure solid to solid: 0 inside the other one, the largest distance also of inner "
               "points, no interior folds; both must be closed chains or sets");
  app.add_option(
         "--gap", o.gap,
         "Wished relative width of the certified intervals, from 1e-9 to 1; never finer than "
         "1e-9 of the diagonal")
      ->check(tools::number_from(1e-9, 1))
      ->capture_default_str()
      ->type_name("G");
  app.add_option("--samples", o.samples, "Points for mean and rms, each way, from 2 to 1e9")
      ->transform(whole_number)
      ->check(CLI::Range(std::uint64_t{2}, std::uint64_t{1000000000}).description(""))
      ->capture_default_str()
      ->type_name("N");
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
  app.add_option(
         "--at-most", o.at_most,
         "Exit with 1 unless the Hausdorff distance is certainly at most this: a length, or "
         "a percentage of the diagonal of both bounding boxes, as in 0.5%")
      ->check([](const std::string& s) {
        return tools::parse_length(s) ? std::string()
                                      : "must be a positive number, or a percentage such as 0.5%";
      })
      ->type_name("LENGTH|P%");
  app.add_option("--backend", o.backend, "Search structure: both give certified intervals [embree]")
      ->check(CLI::IsMember({"embree", "own"}).description(""))
      ->type_name("embree|own");
  app.add_option("--csv", o.csv, "Write the numbers as CSV, a line each way (- for stdout)")
      ->type_name("FILE");
  app.add_option("--heatmap", o.heatmap,
                 "Colours by distance: .png draws A and B with a scale, .ply is A with colours and "
                 "the distance as `quality`")
      ->type_name("FILE");
  app.add_option("--input-format", o.input_format, "Format of - and of unknown extensions")
      ->type_name("NAME");
  tools::add_common_options(app, o.common);
  app.get_option("--seed")->description("Seed of the points behind mean and rms");
  app.footer(
      "Measures surface to surface, or solid to solid with --solid.\n"
      "Prints one-sided distances both ways and the Hausdorff distance, in the files' unit and "
      "relative to the diagonal of both bounding boxes. min and max are certified intervals; "
      "mean and rms are estimates with their standard error.\n"
      "Exit codes: 0 done; 1 --at-most does not hold (or is not certain); 2 usage; 3 bad input; "
      "4 output failed; 5 feature not built; 6 internal error; 7 an interval stayed wider than "
      "wished (it is printed and holds all the same), or out of memory.");
}

/// One of the two inputs, and the surface that stands for it.
struct Side {
  std::string file, sha256;
  bool is_set = false;
  geom::Mesh input;  ///< unless it is a set
  geom::ConvexSet set;
  std::unique_ptr<measure::Solid> solid;  ///< with --solid
  geom::Mesh mesh;                        ///< the mesh, or the boundary of the union or the solid
  double error = 0;                       ///< how far `mesh` may be from the surface that is meant
  std::vector<std::string> notes;

  /// Calls visit(points) for every array of input coordinates.
  template <class Visit>
  void each_points(Visit&& visit) {
    if (!is_set) visit(input.vertices);
    for (geom::ConvexBody& body : set.bodies) visit(body.hull.vertices);
  }
};

/// One-sided results.
struct OneWay {
  measure::SolidDistance max;
  Vec3 nearest = Vec3::Zero();  ///< on the other surface, to max.at
  measure::Sampled sampled;
};

std::string formatted(double x, int digits = 6) {
  char text[40];
  std::snprintf(text, sizeof text, "%.*g", digits, x);
  return text;
}

class Job {
 public:
  explicit Job(Options options) : o_(std::move(options)), progress_(o_.common.quiet) {}

  int run() {
    check_files();
    start_ = now();
    a_ = read(o_.a, o_.a_as);
    b_ = read(o_.b, o_.b_as);
    check_range();
    read_ = now();
    measure();
    measured_ = now();
    write();
    return conclude();
  }

 private:
  using Time = std::chrono::steady_clock::time_point;
  static Time now() { return std::chrono::steady_clock::now(); }
  static double seconds(Time from, Time to) {
    return std::chrono::duration<double>(to - from).count();
  }

  static void require(bool condition, const std::string& message) {
    if (!condition) throw Error(ErrorCode::InvalidArgument, message);
  }

  void check_files() const {
    require(o_.a != "-" || o_.b != "-", "A and B cannot both be standard input");
    tools::require_apart(
        {{"--report", o_.common.report}, {"--csv", o_.csv}, {"--heatmap", o_.heatmap}},
        {o_.a, o_.b});
    if (o_.heatmap.empty()) return;
    const std::string extension = std::filesystem::path(o_.heatmap).extension().string();
    require(extension == ".png" || extension == ".ply", "--heatmap: give a .png or .ply file");
  }

  void say(const std::string& text) const { tools::log(o_.common.quiet, text); }

  Side read(const std::string& path, const std::string& as) {
    progress_.show("reading " + path);
    Side side;
    side.file = path;
    const bool folder = path != "-" && tools::is_folder(path);
    std::optional<io::Format> format;
    if (!folder) {
      const bool known =
          path != "-" &&
          io::format_from_name(std::filesystem::path(path).extension().string()).has_value();
      format = tools::format_for(path, known ? std::string() : o_.input_format, "--input-format");
    }
    require(!folder || as != "mesh",
            path + " is a folder, which holds a set of bodies, not a mesh");
    const bool may_be_set = folder || format == io::Format::Glb || format == io::Format::Obj;
    if (as == "set" || (as == "auto" && may_be_set)) {
      io::SetReadDetails details;
      std::vector<char> bytes;
      geom::ConvexSet set;
      if (folder) {
        set = io::read_convex_set(path, {}, &details);
        bytes = details.bytes;
      } else {
        bytes = io::read_file(path);
        set = io::parse_convex_set(bytes, *format, path, &details,
                                   std::filesystem::path(path).parent_path());
      }
      const std::optional<std::size_t> crooked =
          set.bodies.size() > 1 ? geom::find_not_convex(set) : std::nullopt;
      const bool is_set =
          as == "set" || folder || details.has_record || (set.bodies.size() > 1 && !crooked);
      if (!is_set) {
        if (crooked)
          side.notes.push_back("taken as a mesh, not as a set of bodies: body '" +
                               set.bodies[*crooked].name + "' is not exactly convex");
        return read_mesh(std::move(side), bytes, *format);
      }
      if (set.bodies.empty())
        throw Error(ErrorCode::InvalidInput, side.file + ": the empty set has no distance");
      side.sha256 = io::sha256(bytes);
      side.notes = details.notes;
      side.is_set = true;
      side.set = std::move(set);
      if (side.set.margin > 0 && !o_.solid)
        throw Error(ErrorCode::InvalidInput,
                    side.file +
                        ": a set with a margin has a curved surface, to which distances are not "
                        "stable (gaps close); measure solid to solid with --solid");
      return side;
    }
    const std::vector<char> bytes = io::read_file(path);
    if (format == io::Format::Glb && read_without_margin(side, bytes)) return side;
    return read_mesh(std::move(side), bytes, *format);
  }

  /// A set with a margin that is measured as a mesh on request, with a note. False: no such set.
  static bool read_without_margin(Side& side, const std::vector<char>& bytes) {
    geom::ConvexSet set;
    try {
      set = io::parse_convex_set(bytes, io::Format::Glb, side.file);
    } catch (const Error&) {  // the mesh reader says what is wrong
      return false;
    }
    if (!(set.margin > 0)) return false;
    side.sha256 = io::sha256(bytes);
    side.notes.push_back("read as a mesh: the set's margin of " + formatted(set.margin) +
                         " is left out");
    side.input = verify::sum_of(set);
    return true;
  }

  Side read_mesh(Side side, const std::vector<char>& bytes, io::Format format) const {
    io::ReadResult result =
        io::parse_mesh(bytes, format, side.file, std::filesystem::path(side.file).parent_path());
    side.sha256 = io::sha256(bytes);
    side.notes.insert(side.notes.end(), result.notes.begin(), result.notes.end());
    if (result.collapsed_triangles != 0)
      side.notes.push_back(std::to_string(result.collapsed_triangles) +
                           (result.collapsed_triangles == 1 ? " triangle" : " triangles") +
                           " with repeated corners left out: no distance from or to the segments "
                           "that they span is measured");
    side.input = std::move(result.mesh);
    if (side.input.empty())
      throw Error(ErrorCode::InvalidInput, side.file + ": no triangles to measure to");
    return side;
  }

  static geom::Box3 box_of(Side& side) {
    geom::Box3 box;
    if (!side.is_set) box = geom::bounding_box(side.input);
    for (const geom::ConvexBody& body : side.set.bodies) box.extend(geom::bounding_box(body.hull));
    if (side.is_set) {
      box.min.array() -= side.set.margin;
      box.max.array() += side.set.margin;
    }
    return box;
  }

  /// The distance bounds hold below 1e60 only.
  void check_range() {
    geom::Box3 both;
    for (Side* side : {&a_, &b_}) {
      const geom::Box3 box = box_of(*side);
      if (box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff() > 1e60)
        throw Error(ErrorCode::InvalidInput,
                    side->file + ": coordinates beyond 1e60; scale the mesh");
      both.extend(box);
    }
    const double extent = (both.max - both.min).maxCoeff();
    if (extent > 0 && extent < 1e-60)
      throw Error(ErrorCode::InvalidInput,
                  a_.file + ", " + b_.file + ": extent below 1e-60; scale the meshes");
  }

  /// Moves both inputs near the origin, along the axes on which all differences are exact: then
  /// distances stay what they are, and rounding that is proportional to coordinates shrinks.
  void move_to_origin() {
    geom::Box3 box = box_of(a_);
    box.extend(box_of(b_));
    diagonal_ = box.diagonal();
    for (int axis = 0; axis < 3; ++axis) {
      const double shift = box.min[axis];
      if (std::max(std::abs(shift), std::abs(box.max[axis])) <= box.max[axis] - shift) continue;
      // Knuth's two-sum gives the rounding error of a difference.
      const auto exact = [&](double x) {
        const double d = x - shift, back = x - d;
        return (x - (d + back)) + (back - shift) == 0;
      };
      bool all = true;
      for (Side* side : {&a_, &b_})
        side->each_points([&](const std::vector<Vec3>& points) {
          all = all && std::all_of(points.begin(), points.end(),
                                   [&](const Vec3& v) { return exact(v[axis]); });
        });
      if (!all) continue;
      origin_[axis] = shift;
      for (Side* side : {&a_, &b_})
        side->each_points([&](std::vector<Vec3>& points) {
          for (Vec3& v : points) v[axis] -= shift;
        });
    }
  }

  /// The surface that stands for an input.
  void find_surface(Side& side) {
    progress_.show("boundary of " + side.file);
    try {
      if (o_.solid) {
        side.solid = side.is_set ? std::make_unique<measure::Solid>(side.set)
                                 : std::make_unique<measure::Solid>(side.input);
        side.mesh = side.solid->boundary().mesh;
        side.error = side.solid->boundary().error;
      } else if (side.is_set) {
        measure::Boundary boundary = measure::union_boundary(side.set);
        side.mesh = std::move(boundary.mesh);
        side.error = boundary.error;
      } else {
        side.mesh = side.input;
      }
    } catch (const Error& error) {
      throw Error(error.code(), side.file + ": " + error.what());
    }
  }

  void measure() {
    move_to_origin();
    find_surface(a_);
    find_surface(b_);
    const auto backend = o_.backend == "own" ? measure::Backend::Own : measure::Backend::Embree;
    progress_.show("building search structures");
    const auto search_a = measure::make_search(a_.mesh, backend);
    const auto search_b = measure::make_search(b_.mesh, backend);
    built_ = now();
    to_b_ = one_way("A to B", a_, *search_a, b_, *search_b);
    to_a_ = one_way("B to A", b_, *search_b, a_, *search_a);
    progress_.show("smallest distance");
    if (o_.solid) {
      min_ = measure::solid_minimum(*a_.solid, *b_.solid);
    } else {
      min_ = measure::minimum_distance(a_.mesh, b_.mesh);
      // Surfaces that stand for others at a distance of at most `error`.
      const double error = a_.error + b_.error;
      for (OneWay* way : {&to_b_, &to_a_}) {
        way->max.max_lower = std::max(0.0, way->max.max_lower - error);
        way->max.max_upper += error;
      }
      min_.lower = std::max(0.0, min_.lower - error);
      min_.upper += error;
    }
    if (!o_.heatmap.empty()) make_heatmap(*search_a, *search_b);
  }

  /// Whether one solid lies within the other, decided exactly: all distances are then 0, which
  /// branch and bound only approaches where their surfaces coincide.
  static bool certainly_within(const Side& from, const Side& to) {
    if (from.set.margin > to.set.margin) return false;
    const auto chain = [](const Side& side) {
      return side.is_set ? verify::sum_of(side.set) : side.input;
    };
    const geom::Mesh inner = chain(from);
    for (const Vec3& v : from.mesh.vertices)
      if (to.solid->contains(v) == std::optional(false)) return false;
    return verify::verify_inclusion(inner, chain(to)).solid.answer == verify::Answer::Verified;
  }

  OneWay one_way(const char* name, const Side& from, const geom::TriangleSearch& from_search,
                 const Side& to, const geom::TriangleSearch& to_search) {
    OneWay way;
    geom::DistanceOptions d;
    d.relative_gap = o_.gap;
    progress_.show(std::string(name) + ": largest distance");
    if (o_.solid) {
      if (certainly_within(from, to)) {
        way.max.at = from.mesh.vertices[from.mesh.triangles.front()[0]];
        way.max.within_gap = true;
      } else {
        way.max = measure::solid_distance(*from.solid, *to.solid, from_search, to_search, d);
      }
    } else {
      static_cast<geom::DirectedDistance&>(way.max) =
          geom::directed_distance(from_search, to_search, d);
    }
    const auto& [a, b, c] = to_search.corners(to_search.nearest(way.max.at).triangle);
    way.nearest = geom::nearest_point(way.max.at, a, b, c);
    progress_.show(std::string(name) + ": sampling");
    way.sampled = measure::sample_distances(from.mesh, to_search, o_.samples, o_.common.seed,
                                            distance_to(to));
    return way;
  }

  /// How far a point is from a side, given how far it is from its surface.
  static std::function<double(const Vec3&, double)> distance_to(const Side& side) {
    if (!side.solid) return nullptr;
    return [&](const Vec3& p, double d) { return side.solid->distance(p, d); };
  }

  [[nodiscard]] double hausdorff_lower() const {
    return std::max(to_b_.max.max_lower, to_a_.max.max_lower);
  }
  [[nodiscard]] double hausdorff_upper() const {
    return std::max(to_b_.max.max_upper, to_a_.max.max_upper);
  }

  /// Into how many parts the edges of a triangle are cut, so that none is longer than the limit.
  static int parts(const geom::Mesh& mesh, const geom::Triangle& t, double limit) {
    const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    return limit > 0 ? std::max(1, static_cast<int>(std::ceil(longest / limit))) : 1;
  }

  /// Triangles cut into parts of at most a hundredth of the diagonal, so that colours show what
  /// happens inside them; longer parts where many needles would make more than a million.
  [[nodiscard]] geom::Mesh refined(const geom::Mesh& mesh) const {
    constexpr double kMostParts = 1e6;
    double limit = diagonal_ / 100;
    for (; limit > 0 && limit < diagonal_; limit *= 1.25) {
      double sum = 0;
      for (const geom::Triangle& t : mesh.triangles) {
        const double n = parts(mesh, t, limit);
        if (n > 1) sum += n * n;
      }
      if (sum <= kMostParts) break;
    }
    geom::Mesh out;
    out.vertices = mesh.vertices;
    for (const geom::Triangle& t : mesh.triangles) {
      const Vec3 &a = mesh.vertices[t[0]], &b = mesh.vertices[t[1]], &c = mesh.vertices[t[2]];
      const int n = parts(mesh, t, limit);
      if (n <= 1) {
        out.triangles.push_back(t);
        continue;
      }
      const auto first = static_cast<std::uint32_t>(out.vertices.size());
      for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n - i; ++j)
          out.vertices.emplace_back(a + (static_cast<double>(i) / n) * (b - a) +
                                    (static_cast<double>(j) / n) * (c - a));
      const auto at = [&](int i, int j) {
        return first + static_cast<std::uint32_t>(i * (n + 1) - i * (i - 1) / 2 + j);
      };
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n - i; ++j) {
          out.triangles.push_back({at(i, j), at(i + 1, j), at(i, j + 1)});
          if (j + 1 < n - i)
            out.triangles.push_back({at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
        }
    }
    return geom::weld(out);
  }

  static std::vector<double> distances(const geom::Mesh& mesh, const Side& side,
                                       const geom::TriangleSearch& to) {
    const auto from = distance_to(side);
    std::vector<double> values(mesh.vertices.size(), 0);
    std::uint32_t hint = geom::TriangleSearch::kNone;
    for (std::size_t v = 0; v < values.size(); ++v) {
      const auto nearest = to.nearest(mesh.vertices[v], hint);
      hint = nearest.triangle;
      values[v] = from ? from(mesh.vertices[v], nearest.upper) : nearest.upper;
    }
    return values;
  }

  void make_heatmap(const geom::TriangleSearch& search_a, const geom::TriangleSearch& search_b) {
    progress_.show("colours");
    const bool ply = std::filesystem::path(o_.heatmap).extension() == ".ply";
    geom::Mesh a = refined(a_.mesh);
    const std::vector<double> to_b = distances(a, b_, search_b);
    if (ply) {
      for (Vec3& v : a.vertices) v += origin_;
      heatmap_ = picture::heatmap_ply(a, to_b, to_b_.max.max_upper);
      return;
    }
    const geom::Mesh b = refined(b_.mesh);
    const std::vector<double> to_a = distances(b, a_, search_a);
    heatmap_ = picture::encode_png(
        picture::draw_heatmap({{&a, &to_b, "A: distance to B", to_b_.max.at},
                               {&b, &to_a, "B: distance to A", to_a_.max.at}},
                              hausdorff_upper(), diagonal_, o_.width, o_.height));
  }

  // -- output ------------------------------------------------------------------------------------

  [[nodiscard]] double relative(double x) const { return diagonal_ > 0 ? x / diagonal_ : 0; }

  [[nodiscard]] std::string table() const {
    std::ostringstream out;
    const auto row = [&](const char* name, const std::string& ab, const std::string& ba) {
      char line[200];
      std::snprintf(line, sizeof line, "%-6s %-34s %-34s\n", name, ab.c_str(), ba.c_str());
      std::string text = line;
      while (text.size() > 1 && text[text.size() - 2] == ' ') text.erase(text.size() - 2, 1);
      out << text;
    };
    const auto percent = [&](double x) { return formatted(100 * relative(x), 4) + "%"; };
    const auto interval = [&](double lower, double upper) {
      return "[" + formatted(lower) + ", " + formatted(upper) + "]";
    };
    const auto estimate = [](const measure::Estimate& e) {
      return formatted(e.value) + " ± " + formatted(e.standard_error, 2);
    };
    out << (o_.solid                 ? "solid to solid (mean and rms: over the boundaries)"
            : a_.is_set || b_.is_set ? "surface to surface (sets: boundary of the union)"
                                     : "surface to surface")
        << "; percentages of the diagonal of both boxes, " << formatted(diagonal_) << '\n';
    row("", "A to B", "B to A");
    row("min", interval(min_.lower, min_.upper), interval(min_.lower, min_.upper));
    row("mean", estimate(to_b_.sampled.mean), estimate(to_a_.sampled.mean));
    row("", percent(to_b_.sampled.mean.value), percent(to_a_.sampled.mean.value));
    row("rms", estimate(to_b_.sampled.rms), estimate(to_a_.sampled.rms));
    row("", percent(to_b_.sampled.rms.value), percent(to_a_.sampled.rms.value));
    row("max", interval(to_b_.max.max_lower, to_b_.max.max_upper),
        interval(to_a_.max.max_lower, to_a_.max.max_upper));
    row("", percent(to_b_.max.max_upper), percent(to_a_.max.max_upper));
    out << "Hausdorff distance " << interval(hausdorff_lower(), hausdorff_upper()) << ", "
        << percent(hausdorff_upper()) << " of that diagonal\n";
    return out.str();
  }

  static Json to_json(const Vec3& p) { return {p.x(), p.y(), p.z()}; }

  [[nodiscard]] Json to_json(const Side& side) const {
    Json j{{"file", side.file},
           {"sha256", side.sha256},
           {"kind", side.is_set
                        ? (o_.solid ? "convex set: union" : "convex set: boundary of the union")
                        : (o_.solid ? "mesh: its solid" : "mesh")}};
    if (side.is_set) j["bodies"] = side.set.bodies.size();
    if (side.is_set && o_.solid) j["margin"] = side.set.margin;
    const geom::TopologyReport topology = geom::analyse(side.mesh);
    j["vertices"] = topology.vertices;
    j["triangles"] = topology.triangles;
    j["components"] = topology.components;
    if (!side.is_set && !o_.solid) j["closed"] = topology.closed();
    j["degenerate_triangles"] = topology.degenerate_triangles;
    j["surface_error"] = side.error;
    j["notes"] = side.notes;
    return j;
  }

  [[nodiscard]] Json to_json(const OneWay& way) const {
    return {{"min", min_.upper},
            {"min_lower", min_.lower},
            {"min_upper", min_.upper},
            {"mean", way.sampled.mean.value},
            {"mean_standard_error", way.sampled.mean.standard_error},
            {"rms", way.sampled.rms.value},
            {"rms_standard_error", way.sampled.rms.standard_error},
            {"mean_and_rms_rounding", way.sampled.rounding},
            {"max_lower", way.max.max_lower},
            {"max_upper", way.max.max_upper},
            {"max_at", to_json(Vec3(way.max.at + origin_))},
            {"max_nearest", to_json(Vec3(way.nearest + origin_))},
            {"max_within_gap", way.max.within_gap},
            {"max_inside", way.max.inside},
            {"relative",
             {{"min", relative(min_.upper)},
              {"mean", relative(way.sampled.mean.value)},
              {"rms", relative(way.sampled.rms.value)},
              {"max_lower", relative(way.max.max_lower)},
              {"max_upper", relative(way.max.max_upper)}}},
            {"samples", way.sampled.samples},
            {"queries", way.max.queries},
            {"cells", way.max.cells}};
  }

  [[nodiscard]] Json report() const {
    Json r;
    r["tool"] = "hausdorff-eval";
    r["version"] = tools::version();
    r["a"] = to_json(a_);
    r["b"] = to_json(b_);
    r["measure"] = o_.solid ? "solid to solid" : "surface to surface";
    r["options"] = {{"gap", o_.gap},
                    {"samples", o_.samples},
                    {"seed", o_.common.seed},
                    {"backend", o_.backend}};
    r["bbox_diagonal"] = diagonal_;
    r["a_to_b"] = to_json(to_b_);
    r["b_to_a"] = to_json(to_a_);
    r["hausdorff_lower"] = hausdorff_lower();
    r["hausdorff_upper"] = hausdorff_upper();
    r["hausdorff_relative"] = {{"lower", relative(hausdorff_lower())},
                               {"upper", relative(hausdorff_upper())}};
    r["min_at"] = {{"a", to_json(Vec3(min_.on_a + origin_))},
                   {"b", to_json(Vec3(min_.on_b + origin_))}};
    r["resources"] = {{"seconds_reading", seconds(start_, read_)},
                      {"seconds_building", seconds(read_, built_)},
                      {"seconds_measuring", seconds(built_, measured_)},
                      {"user_seconds", tools::user_seconds()},
                      {"peak_megabytes", tools::peak_megabytes()},
                      {"threads", o_.common.threads}};
    return r;
  }

  [[nodiscard]] std::string csv() const {
    std::string out =
        "direction,min_lower,min_upper,mean,mean_standard_error,rms,rms_standard_error,max_lower,"
        "max_upper,bbox_diagonal\n";
    for (const OneWay* way : {&to_b_, &to_a_}) {
      out += way == &to_b_ ? "a_to_b" : "b_to_a";
      for (const double x :
           {min_.lower, min_.upper, way->sampled.mean.value, way->sampled.mean.standard_error,
            way->sampled.rms.value, way->sampled.rms.standard_error, way->max.max_lower,
            way->max.max_upper, diagonal_})
        out += "," + formatted(x, 17);
      out += "\n";
    }
    return out;
  }

  void write() const {
    if (!o_.heatmap.empty()) io::write_file(o_.heatmap, heatmap_);
    if (!o_.csv.empty()) io::write_file(o_.csv, csv());
    if (!o_.common.report.empty()) tools::write_json(o_.common.report, report());
    if (!o_.common.quiet && o_.csv != "-" && o_.common.report != "-") io::write_file("-", table());
  }

  [[nodiscard]] int conclude() const {
    for (const Side* side : {&a_, &b_})
      for (const std::string& note : side->notes) say("note: " + side->file + ": " + note);
    if (!o_.at_most.empty()) {
      const double limit = tools::parse_length(o_.at_most)->of(diagonal_);
      if (hausdorff_upper() > limit) {
        tools::log(false, "hausdorff-eval: " +
                              std::string(hausdorff_lower() > limit
                                              ? "the Hausdorff distance exceeds "
                                              : "it is not certain that the Hausdorff distance is "
                                                "at most ") +
                              formatted(limit));
        return tools::kNo;
      }
    }
    if (!to_b_.max.within_gap || !to_a_.max.within_gap) {
      tools::log(false,
                 "hausdorff-eval: the work allowed did not reach the wished gap; the interval "
                 "holds, but is wider");
      return tools::kLimit;
    }
    return tools::kDone;
  }

  Options o_;
  tools::Progress progress_;
  Side a_, b_;
  OneWay to_b_, to_a_;
  measure::Minimum min_;
  double diagonal_ = 0;
  Vec3 origin_ = Vec3::Zero();  ///< in the files' coordinates
  std::vector<char> heatmap_;
  Time start_, read_, built_, measured_;
};

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Distances between two surfaces, with certified intervals.", "hausdorff-eval");
  Options options;
  describe(app, options);
  return tools::run(app, argc, argv, [&] {
    const tools::ThreadLimit limit(options.common.threads);
    return Job(options).run();
  });
}
