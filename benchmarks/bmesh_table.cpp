// Table of decimation runs: models × methods × targets, as CSV (and JSON with --json FILE).
//
//   bmesh_table [--methods distance,distance-fast,distance-best,planes,...] [--ratios 0.2,0.1]
//               [--epsilon 0.5,1] [--alone] [--direction outer|inner|any] [--json FILE] MESH...
//
// With --alone, rows of --epsilon say how many vertices a method needs that knows nothing of the
// error bound: the number of vertices is bisected until the certified Hausdorff distance of what
// comes of it is within epsilon; "seconds" are of the last run that was.
//
// Distances are in percent of the diagonal of the input's box. Maxima are certified upper bounds
// (gap 1 %), means come from samples spread evenly over the area. Only closed meshes are measured.
#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/directed_distance.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common.h"

namespace {

using namespace kaboum;  // NOLINT: a program
using benchmark::user_seconds;

struct Method {
  bmesh::Cost cost;
  bmesh::Effort effort;
};

const std::map<std::string, Method> kMethods{
    {"distance", {bmesh::Cost::Distance, bmesh::Effort::Normal}},
    {"distance-fast", {bmesh::Cost::Distance, bmesh::Effort::Fast}},
    {"distance-best", {bmesh::Cost::Distance, bmesh::Effort::Best}},
    {"mean", {bmesh::Cost::Mean, bmesh::Effort::Fast}},
    {"mean-normal", {bmesh::Cost::Mean, bmesh::Effort::Normal}},
    {"planes", {bmesh::Cost::Planes, bmesh::Effort::Fast}},
    {"planes-normal", {bmesh::Cost::Planes, bmesh::Effort::Normal}},
    {"planes-adapted", {bmesh::Cost::PlanesAdapted, bmesh::Effort::Fast}},
    {"planes-diagonal", {bmesh::Cost::PlanesDiagonal, bmesh::Effort::Fast}},
    {"triangles", {bmesh::Cost::Triangles, bmesh::Effort::Fast}}};

/// Mean distance of points spread over a's area from b: about `count` points, one at the middle of
/// each of the equal parts that a triangle's share is cut into.
double mean_distance(const geom::Mesh& a, const geom::DistanceQuery& b, double count) {
  const double total = geom::area(a);
  double sum = 0, weight = 0;
  std::uint32_t hint = geom::DistanceQuery::kNone;
  for (const geom::Triangle& t : a.triangles) {
    const geom::Vec3 &p = a.vertices[t[0]], u = a.vertices[t[1]] - p, v = a.vertices[t[2]] - p;
    const double area = 0.5 * u.cross(v).norm();
    const int n = std::max(1, static_cast<int>(std::sqrt(count * area / total)));
    // n² congruent parts: i, j and the orientation of the part.
    for (int i = 0; i < n; ++i) {
      for (int j = 0; i + j < n; ++j) {
        for (int up = 0; up < (i + j + 1 < n ? 2 : 1); ++up) {
          const double shift = up == 0 ? 1.0 / 3 : 2.0 / 3;
          const auto at = b.nearest(p + (i + shift) / n * u + (j + shift) / n * v, hint);
          hint = at.triangle;
          sum += area / (n * n) * at.upper;
          weight += area / (n * n);
        }
      }
    }
  }
  return weight > 0 ? sum / weight : 0;
}

std::vector<double> numbers(const std::string& list) {
  std::vector<double> out;
  std::istringstream in(list);
  for (std::string x; std::getline(in, x, ',');) out.push_back(std::stod(x));
  return out;
}

struct Target {
  double ratio = 0, epsilon = 0;
};

class Table {
 public:
  std::vector<std::string> methods{"planes", "distance-fast", "distance"};
  std::vector<Target> targets;
  bmesh::Direction direction = bmesh::Direction::Outer;
  bool alone = false;  // error bounds are met by the number of vertices
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();

  void run(const std::string& file) {
    geom::PrepareOptions how;
    how.drop_sheets = true;
    const geom::Prepared p = geom::prepare(io::read_mesh(file).mesh, how);
    const std::string name = std::filesystem::path(file).stem().string();
    if (!p.solid.closed()) {
      std::cerr << name << ": open, left out\n";
      return;
    }
    const geom::DistanceQuery original(p.solid.mesh());
    for (const Target& target : targets)
      for (const std::string& method : methods) row(name, p, original, method, target);
  }

  static void header() {
    std::cout
        << "model,vertices_in,method,ratio,epsilon,vertices,stop,seconds,contractions_per_second,"
           "to_result_max,to_original_max,to_result_mean,to_original_mean,pull_backs,flips,"
           "rejected_original\n";
  }

 private:
  struct Timed {
    bmesh::DecimateResult result;
    double seconds = 0;  // user CPU
  };

  static Timed timed(const geom::Prepared& p, const bmesh::DecimateOptions& o) {
    const double start = user_seconds();
    Timed t{bmesh::decimate(p.solid, o), 0};
    t.seconds = user_seconds() - start;
    return t;
  }

  /// Whether every point of either surface is certainly within `epsilon` of the other one.
  static bool within(const geom::Mesh& mesh, const geom::Mesh& input,
                     const geom::DistanceQuery& original, double epsilon) {
    geom::DistanceOptions gap;
    gap.relative_gap = 1e-3;
    return geom::directed_distance(mesh, original, gap).max_upper <= epsilon &&
           geom::directed_distance(input, geom::DistanceQuery(mesh), gap).max_upper <= epsilon;
  }

  /// The result of fewest vertices that the bisection finds within `epsilon`: 0.5 % fewer are not,
  /// as far as distances grow while vertices are taken away.
  static Timed fewest(const geom::Prepared& p, const geom::DistanceQuery& original,
                      bmesh::DecimateOptions o, double epsilon) {
    std::size_t good = p.solid.mesh().vertices.size(), bad = 3;
    Timed best;
    best.result.mesh = p.solid.mesh();
    best.result.stop = bmesh::Stop::VertexTarget;
    while (good - bad > 1 && 200 * (good - bad) > good) {
      o.vertices =
          static_cast<std::size_t>(std::sqrt(static_cast<double>(good) * static_cast<double>(bad)));
      *o.vertices = std::clamp(*o.vertices, bad + 1, good - 1);
      Timed t = timed(p, o);
      if (within(t.result.mesh, p.solid.mesh(), original, epsilon)) {
        good = *o.vertices;
        best = std::move(t);
      } else {
        bad = *o.vertices;
      }
    }
    return best;
  }

  void row(const std::string& name, const geom::Prepared& p, const geom::DistanceQuery& original,
           const std::string& method, const Target& target) {
    const double diagonal = geom::bounding_box(p.solid.mesh()).diagonal();
    bmesh::DecimateOptions o;
    o.cost = kMethods.at(method).cost;
    o.effort = kMethods.at(method).effort;
    o.direction = direction;
    if (target.ratio > 0)
      o.vertices = std::max<std::size_t>(
          4, static_cast<std::size_t>(
                 std::ceil(target.ratio * static_cast<double>(p.solid.mesh().vertices.size()))));
    const double epsilon = 0.01 * target.epsilon * diagonal;
    if (epsilon > 0 && !alone) o.epsilon = epsilon;
    const auto [r, seconds] = epsilon > 0 && alone ? fewest(p, original, o, epsilon) : timed(p, o);
    const geom::DistanceQuery result(r.mesh);
    geom::DistanceOptions gap;
    gap.relative_gap = 1e-2;
    const double scale = 100 / diagonal;
    const double there = geom::directed_distance(p.solid.mesh(), result, gap).max_upper * scale;
    const double back = geom::directed_distance(r.mesh, original, gap).max_upper * scale;
    const double there_mean = mean_distance(p.solid.mesh(), result, 1e5) * scale;
    const double back_mean = mean_distance(r.mesh, original, 1e5) * scale;
    const char* stop = r.stop == bmesh::Stop::VertexTarget ? "vertices"
                       : r.stop == bmesh::Stop::ErrorBound ? "epsilon"
                                                           : "exhausted";
    const double speed = static_cast<double>(r.statistics.contractions) / seconds;
    std::cout << name << ',' << p.solid.mesh().vertices.size() << ',' << method << ','
              << target.ratio << ',' << target.epsilon << ',' << r.mesh.vertices.size() << ','
              << stop << ',' << seconds << ',' << speed << ',' << there << ',' << back << ','
              << there_mean << ',' << back_mean << ',' << r.statistics.pull_backs << ','
              << r.statistics.flips << ',' << r.statistics.rejected_original << std::endl;
    rows.push_back({{"model", name},
                    {"vertices_in", p.solid.mesh().vertices.size()},
                    {"method", method},
                    {"ratio", target.ratio},
                    {"epsilon_percent", target.epsilon},
                    {"vertices", r.mesh.vertices.size()},
                    {"stop", stop},
                    {"user_seconds", seconds},
                    {"contractions_per_second", speed},
                    {"to_result_max_percent", there},
                    {"to_original_max_percent", back},
                    {"to_result_mean_percent", there_mean},
                    {"to_original_mean_percent", back_mean}});
  }
};

}  // namespace

int main(int argc, char** argv) try {
  Table table;
  std::vector<std::string> files;
  std::string json;
  const std::vector<std::string> args(argv + 1, argv + argc);
  for (std::size_t i = 0; i < args.size(); ++i) {
    const auto value = [&] { return args.at(++i); };
    if (args[i] == "--methods") {
      table.methods.clear();
      std::istringstream list(value());
      for (std::string m; std::getline(list, m, ',');) table.methods.push_back(m);
    } else if (args[i] == "--ratios") {
      for (const double r : numbers(value())) table.targets.push_back({r, 0});
    } else if (args[i] == "--epsilon") {
      for (const double e : numbers(value())) table.targets.push_back({0, e});
    } else if (args[i] == "--direction") {
      {
        const std::string d = value();
        table.direction = d == "inner" ? bmesh::Direction::Inner
                          : d == "any" ? bmesh::Direction::Any
                                       : bmesh::Direction::Outer;
      }
    } else if (args[i] == "--alone") {
      table.alone = true;
    } else if (args[i] == "--json") {
      json = value();
    } else {
      files.push_back(args[i]);
    }
  }
  if (table.targets.empty()) table.targets = {{0.2, 0}, {0.1, 0}, {0.05, 0}, {0.02, 0}};
  Table::header();
  for (const std::string& file : files) try {
      table.run(file);
    } catch (const Error& e) {
      std::cerr << file << ": " << e.what() << '\n';
    }
  if (!json.empty()) std::ofstream(json) << table.rows.dump(1) << '\n';
  return 0;
} catch (const std::exception& e) {
  std::cerr << "bmesh_table: " << e.what() << '\n';
  return 2;
}
