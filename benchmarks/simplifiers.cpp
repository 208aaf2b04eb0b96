// Bounding decimation beside two-sided simplification, same meshes, same targets, same run:
// CGAL's Garland–Heckbert edge collapse and meshoptimizer. One thread.
//
//   simplifiers [--methods planes,distance-fast,distance,cgal,meshopt] [--ratios 0.05]
//               [--no-distances] [--repeat N] [--csv FILE] [--json FILE] [--out FOLDER]
//               MESH... [--subdivided MESH]...
//
// Every run has a process of its own, whose user CPU time and peak memory are therefore its own.
// Repeated runs alternate between the methods; the least time counts. `seconds` is the
// simplification alone (for ours all of bmesh::decimate, for CGAL edge_collapse without making its
// mesh), `seconds_all` includes making the method's own mesh and taking the result out.
// Distances to the prepared input are in percent of the diagonal: maxima certified upper bounds
// (gap 1 %), means from samples. --subdivided cuts every triangle into four first (common.h).
// --out: results go to FOLDER/MODEL-METHOD.off (of the last ratio), where they can be judged by
// others. CGAL's part is GPL: this program is never installed.
#include <CGAL/Polygon_mesh_processing/orient_polygon_soup.h>
#include <CGAL/Polygon_mesh_processing/polygon_soup_to_polygon_mesh.h>
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_simplification/Policies/Edge_collapse/GarlandHeckbert_plane_policies.h>
#include <CGAL/Surface_mesh_simplification/edge_collapse.h>
#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/distance/minimum.h>
#include <kaboum/distance/sampling.h>
#include <kaboum/distance/search.h>
#include <kaboum/geom/directed_distance.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/io/mesh_io.h>
#include <meshoptimizer.h>
#include <sys/wait.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cfloat>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common.h"

namespace {

using namespace kaboum;  // NOLINT: a program
using benchmark::peak_megabytes;
using benchmark::user_seconds;
using Json = nlohmann::ordered_json;
using Point = CGAL::Simple_cartesian<double>::Point_3;
using SurfaceMesh = CGAL::Surface_mesh<Point>;
constexpr rlim_t kSecondsAllowed = 1800;  // CPU time of a run
namespace sms = CGAL::Surface_mesh_simplification;

struct Input {
  std::string file;
  bool subdivided = false;
};

struct Options {
  std::vector<std::string> methods{"planes", "distance-fast", "distance", "cgal", "meshopt"};
  std::vector<Input> inputs;
  std::vector<double> ratios;
  bool distances = true;
  int repeat = 1;
  std::string csv, json, out;
};

struct Result {
  geom::Mesh mesh;
  double seconds = 0;     // the simplification alone
  std::size_t split = 0;  // vertices added to hold the input
};

bmesh::DecimateOptions bounding(const std::string& method) {
  bmesh::DecimateOptions o;
  o.cost = bmesh::Cost::Distance;
  if (method == "planes") {
    o.cost = bmesh::Cost::Planes;
    o.effort = bmesh::Effort::Fast;
  } else if (method == "distance-fast") {
    o.effort = bmesh::Effort::Fast;
  } else if (method == "distance") {
    o.effort = bmesh::Effort::Normal;
  } else {
    throw Error(ErrorCode::InvalidArgument, "unknown method " + method);
  }
  return o;
}

Result by_kaboum(const std::string& method, const geom::Prepared& input, std::size_t target) {
  bmesh::DecimateOptions o = bounding(method);
  o.vertices = target;
  Result result;
  const double start = user_seconds();
  o.effort = bmesh::possible_effort(input.solid, o);
  result.mesh = bmesh::decimate(input.solid, o).mesh;
  result.seconds = user_seconds() - start;
  return result;
}

/// CGAL's mesh holds manifolds only: where the input is none, vertices are split until it is.
/// @return how many vertices were added
std::size_t convert(const geom::Mesh& input, SurfaceMesh& mesh) {
  using Vertex = SurfaceMesh::Vertex_index;
  for (const geom::Vec3& v : input.vertices) mesh.add_vertex({v.x(), v.y(), v.z()});
  bool manifold = true;
  for (const auto& [a, b, c] : input.triangles)
    manifold =
        manifold && mesh.add_face(Vertex(a), Vertex(b), Vertex(c)) != SurfaceMesh::null_face();
  if (manifold) return 0;
  namespace pmp = CGAL::Polygon_mesh_processing;
  mesh.clear();
  std::vector<Point> points;
  for (const geom::Vec3& v : input.vertices) points.emplace_back(v.x(), v.y(), v.z());
  std::vector<std::vector<std::size_t>> polygons;
  for (const geom::Triangle& t : input.triangles) polygons.emplace_back(t.begin(), t.end());
  pmp::orient_polygon_soup(points, polygons);
  pmp::polygon_soup_to_polygon_mesh(points, polygons, mesh);
  return mesh.number_of_vertices() - input.vertices.size();
}

/// Garland–Heckbert without constraints (its default policies), until `target` vertices are left.
Result by_cgal(const geom::Mesh& input, std::size_t target) {
  using Vertex = SurfaceMesh::Vertex_index;
  Result result;
  SurfaceMesh mesh;
  result.split = convert(input, mesh);
  const double start = user_seconds();
  const sms::GarlandHeckbert_plane_policies<SurfaceMesh, CGAL::Simple_cartesian<double>> policies(
      mesh);
  const auto reached = [target](const auto&, const auto& profile, std::size_t, std::size_t) {
    return profile.surface_mesh().number_of_vertices() <= target;
  };
  sms::edge_collapse(
      mesh, reached,
      CGAL::parameters::get_cost(policies.get_cost()).get_placement(policies.get_placement()));
  result.seconds = user_seconds() - start;
  mesh.collect_garbage();
  for (const Vertex v : mesh.vertices())
    result.mesh.vertices.emplace_back(mesh.point(v).x(), mesh.point(v).y(), mesh.point(v).z());
  for (const auto f : mesh.faces()) {
    geom::Triangle t{};
    int k = 0;
    for (const Vertex v : mesh.vertices_around_face(mesh.halfedge(f))) t[k++] = v;
    result.mesh.triangles.push_back(t);
  }
  return result;
}

/// meshoptimizer counts triangles: on a closed surface each contraction takes two.
Result by_meshopt(const geom::Mesh& input, std::size_t target) {
  Result result;
  std::vector<float> points;
  for (const geom::Vec3& v : input.vertices)
    for (int k = 0; k < 3; ++k) points.push_back(static_cast<float>(v[k]));
  std::vector<unsigned> indices;
  for (const geom::Triangle& t : input.triangles) indices.insert(indices.end(), t.begin(), t.end());
  const std::size_t fewer = 2 * (input.vertices.size() - target);
  const std::size_t triangles = input.triangles.size() - std::min(fewer, input.triangles.size());
  const double start = user_seconds();
  indices.resize(meshopt_simplify(indices.data(), indices.data(), indices.size(), points.data(),
                                  input.vertices.size(), 3 * sizeof(float), 3 * triangles,
                                  FLT_MAX));
  result.seconds = user_seconds() - start;
  constexpr std::uint32_t kUnused = ~0U;
  std::vector<std::uint32_t> place(input.vertices.size(), kUnused);
  for (std::size_t i = 0; i < indices.size(); ++i) {
    std::uint32_t& at = place[indices[i]];
    if (at == kUnused) {
      at = static_cast<std::uint32_t>(result.mesh.vertices.size());
      const float* p = &points[3 * std::size_t{indices[i]}];
      result.mesh.vertices.emplace_back(p[0], p[1], p[2]);
    }
    if (i % 3 == 0) result.mesh.triangles.emplace_back();
    result.mesh.triangles.back()[i % 3] = at;
  }
  return result;
}

/// Both ways, maximum and mean, in percent of the diagonal.
void measure_into(Json& row, const geom::Mesh& original, const geom::Mesh& result) {
  const double percent = 100 / geom::bounding_box(original).diagonal();
  geom::DistanceOptions gap;
  gap.relative_gap = 1e-2;
  const auto a = distance::make_search(original, distance::Backend::Embree),
             b = distance::make_search(result, distance::Backend::Embree);
  row["to_result_max"] = percent * geom::directed_distance(*a, *b, gap).max_upper;
  row["to_original_max"] = percent * geom::directed_distance(*b, *a, gap).max_upper;
  row["to_result_mean"] = percent * distance::sample_distances(original, *b, 100000, 1).mean.value;
  row["to_original_mean"] = percent * distance::sample_distances(result, *a, 100000, 1).mean.value;
}

Json run(const Options& o, const Input& input, const std::string& method, double ratio,
         bool distances) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  geom::PrepareOptions how;
  how.drop_sheets = true;
  geom::Mesh mesh = io::read_mesh(input.file).mesh;
  if (input.subdivided) mesh = benchmark::subdivided(mesh);
  const geom::Prepared p = geom::prepare(mesh, how);
  mesh = {};
  const std::size_t in = p.solid.mesh().vertices.size();
  const auto target = std::max<std::size_t>(
      4, static_cast<std::size_t>(std::ceil(ratio * static_cast<double>(in))));
  const double before = user_seconds(), megabytes = peak_megabytes();
  const Result result = method == "cgal"      ? by_cgal(p.solid.mesh(), target)
                        : method == "meshopt" ? by_meshopt(p.solid.mesh(), target)
                                              : by_kaboum(method, p, target);
  const double all = user_seconds() - before;
  Json row{{"model", std::filesystem::path(input.file).stem().string() +
                         (input.subdivided ? "-subdivided" : "")},
           {"closed", p.solid.closed()},
           {"vertices_in", in},
           {"triangles_in", p.solid.mesh().triangles.size()},
           {"method", method},
           {"ratio", ratio},
           {"vertices", result.mesh.vertices.size()},
           {"vertices_split", result.split},
           {"seconds", result.seconds},
           {"seconds_all", all},
           {"contractions_per_second",
            static_cast<double>(in - result.mesh.vertices.size()) / result.seconds},
           {"peak_megabytes", peak_megabytes()},
           {"peak_megabytes_read", megabytes}};
  if (distances) measure_into(row, p.solid.mesh(), result.mesh);
  if (!o.out.empty())
    io::write_file(std::filesystem::path(o.out) /
                       (std::filesystem::path(input.file).stem().string() + "-" + method + ".off"),
                   io::serialise_mesh(result.mesh, io::Format::Off));
  return row;
}

/// run() in a process of its own.
Json run_apart(const Options& o, const Input& input, const std::string& method, double ratio,
               bool distances) {
  int ends[2];
  if (pipe(ends) != 0) throw Error(ErrorCode::Internal, "no pipe");
  const pid_t child = fork();
  if (child < 0) throw Error(ErrorCode::Internal, "no process");
  if (child == 0) {
    close(ends[0]);
    const rlimit limit{kSecondsAllowed, kSecondsAllowed};
    setrlimit(RLIMIT_CPU, &limit);
    Json row;
    try {
      row = run(o, input, method, ratio, distances);
    } catch (const std::exception& e) {
      row = {{"error", e.what()}};
    }
    const std::string text = row.dump();
    const bool sent = write(ends[1], text.data(), text.size()) == static_cast<ssize_t>(text.size());
    _exit(sent ? 0 : 1);
  }
  close(ends[1]);
  std::string text;
  char part[4096];
  for (ssize_t n = 0; (n = read(ends[0], part, sizeof part)) > 0;)
    text.append(part, static_cast<std::size_t>(n));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  Json row = Json::parse(text, nullptr, false);
  if (row.is_discarded())
    row = {{"error", "the process ended with status " + std::to_string(status)}};
  if (row.contains("error")) row["error"] = method + ": " + row["error"].get<std::string>();
  return row;
}

Options parse(const std::vector<std::string>& args) {
  Options o;
  const auto list = [](const std::string& text) {
    std::vector<std::string> out;
    std::istringstream in(text);
    for (std::string x; std::getline(in, x, ',');) out.push_back(x);
    return out;
  };
  for (std::size_t i = 0; i < args.size(); ++i) {
    const auto value = [&] { return args.at(++i); };
    if (args[i] == "--methods") {
      o.methods = list(value());
    } else if (args[i] == "--ratios") {
      for (const std::string& r : list(value())) o.ratios.push_back(std::stod(r));
    } else if (args[i] == "--subdivided") {
      o.inputs.push_back({value(), true});
    } else if (args[i] == "--no-distances") {
      o.distances = false;
    } else if (args[i] == "--repeat") {
      o.repeat = std::stoi(value());
    } else if (args[i] == "--csv") {
      o.csv = value();
    } else if (args[i] == "--json") {
      o.json = value();
    } else if (args[i] == "--out") {
      o.out = value();
    } else if (args[i].starts_with("--")) {
      throw Error(ErrorCode::InvalidArgument, "unknown option " + args[i]);
    } else {
      o.inputs.push_back({args[i]});
    }
  }
  if (o.ratios.empty()) o.ratios = {0.05};
  return o;
}

std::string csv(const Json& rows) {
  std::ostringstream out;
  const auto line = [&](const Json& row, const auto& field) {
    const char* separator = "";
    for (const auto& item : row.items()) {
      out << std::exchange(separator, ",") << field(item);
    }
    out << '\n';
  };
  if (!rows.empty()) line(rows.front(), [](const auto& item) { return item.key(); });
  for (const Json& row : rows) {
    line(row, [](const auto& item) {
      return item.value().is_string() ? item.value().template get<std::string>()
                                      : item.value().dump();
    });
  }
  return out.str();
}

/// All methods on one input: the first of the repeated runs, with the least time of all of them.
/// A method that failed once is not tried again.
std::vector<Json> compare(const Options& o, const Input& input, double ratio) {
  std::vector<Json> best(o.methods.size());
  for (int i = 0; i < o.repeat; ++i) {
    for (std::size_t m = 0; m < o.methods.size(); ++m) {
      if (best[m].contains("error")) continue;
      const Json row = run_apart(o, input, o.methods[m], ratio, o.distances && i == 0);
      if (i == 0 || row.contains("error")) best[m] = row;
      if (row.contains("error")) continue;
      for (const char* key : {"seconds", "seconds_all"})
        best[m][key] = std::min(best[m][key].get<double>(), row[key].get<double>());
      best[m]["contractions_per_second"] =
          (row["vertices_in"].get<double>() - row["vertices"].get<double>()) /
          best[m]["seconds"].get<double>();
      best[m]["repeats"] = i + 1;
      std::cerr << best[m].dump() << std::endl;
    }
  }
  return best;
}

}  // namespace

int main(int argc, char** argv) try {
  const Options o = parse({argv + 1, argv + argc});
  Json rows = Json::array();
  bool complete = true;
  for (const Input& input : o.inputs) {
    for (const double ratio : o.ratios) {
      for (const Json& row : compare(o, input, ratio)) {
        if (!row.contains("error")) rows.push_back(row);
        if (!row.contains("error")) continue;
        complete = false;
        std::cerr << input.file << ": " << row["error"].get<std::string>() << '\n';
      }
    }
  }
  std::cout << csv(rows);
  if (!o.csv.empty()) std::ofstream(o.csv) << csv(rows);
  if (!o.json.empty()) std::ofstream(o.json) << rows.dump(1) << '\n';
  return complete ? 0 : 1;
} catch (const std::exception& e) {
  std::cerr << "simplifiers: " << e.what() << '\n';
  return 2;
}
