// Table of convex decompositions: models × efforts × tasks, as CSV (and JSON with --json FILE).
//
//   bcd_table [--efforts fast,normal] [--tasks distance,bodies,vertices,epsilon] [--peer SUFFIX]
//             [--epsilon 1] [--most N] [--json FILE] MESH...
//
// For a mesh NAME.obj with a peer's result NAME.SUFFIX.obj beside it (coacd-0.05):
//   distance  the smallest distance with as many bodies as the peer used, ≤ N = 64 vertices each
//   bodies    the fewest bodies for the peer's distance, ≤ N = 64 vertices each
//   vertices  the same with ≤ 32 vertices each; what counts is their sum
// and for any mesh:
//   epsilon   the fewest bodies at this many percent of the diagonal, ≤ N vertices each
//
// Distances are certified upper bounds of the distance of any point of the union to the input's
// solid and triangles (holes filled), in percent of the diagonal of the input's box; those of the
// peer, whose bodies are replaced by their hulls, are measured in the same way. Every result's
// cover is decided exactly. Ratios are to the peer; their geometric means come last.
#include <kaboum/base/error.h>
#include <kaboum/bcd/cover.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common.h"
#include "excess.h"

namespace {

using namespace kaboum;  // NOLINT: a program
using benchmark::user_seconds;

const std::map<std::string, bcd::Effort> kEfforts{
    {"fast", bcd::Effort::Fast}, {"normal", bcd::Effort::Normal}, {"best", bcd::Effort::Best}};

std::vector<std::string> words(const std::string& list) {
  std::vector<std::string> out;
  std::istringstream in(list);
  for (std::string x; std::getline(in, x, ',');) out.push_back(x);
  return out;
}

/// What another program made of the model.
struct Peer {
  std::size_t bodies = 0, vertices = 0, largest = 0;
  double excess = 0;
};

class Table {
 public:
  std::vector<std::string> efforts{"fast", "normal"};
  std::vector<std::string> tasks{"distance", "bodies", "vertices"};
  std::string peer_suffix = "coacd-0.05";
  double epsilon_percent = 1;
  std::size_t most = 64;
  nlohmann::ordered_json rows = nlohmann::ordered_json::array();

  void run(const std::string& file) {
    geom::PrepareOptions how;
    how.drop_sheets = true;
    const geom::Prepared input = geom::prepare(io::read_mesh(file).mesh, how);
    const geom::Mesh closed = geom::close_holes(input.solid).mesh();
    const std::filesystem::path path(file);
    const std::string name = path.stem().string();
    std::optional<Peer> peer;
    const std::filesystem::path beside = path.parent_path() / (name + "." + peer_suffix + ".obj");
    if (std::filesystem::exists(beside)) peer = measured(beside, closed);
    const double diagonal = geom::bounding_box(input.solid.mesh()).diagonal();
    if (peer)
      print({{"model", name},
             {"task", peer_suffix},
             {"bodies", peer->bodies},
             {"vertices", peer->vertices},
             {"largest", peer->largest},
             {"reach_percent", 100 * peer->excess / diagonal}});
    for (const std::string& task : tasks) {
      if (task != "epsilon" && !peer) continue;
      for (const std::string& effort : efforts) {
        bcd::CoverOptions o;
        o.effort = kEfforts.at(effort);
        o.max_vertices = task == "vertices" ? 32 : most;
        if (task == "distance") {
          o.max_bodies = peer->bodies;
        } else {
          o.epsilon = task == "epsilon" ? 0.01 * epsilon_percent * diagonal : peer->excess;
        }
        row(name, input, closed, o, task, effort, peer);
      }
    }
  }

  void means() {
    for (const auto& [key, sum] : logarithms_)
      std::cout << "geometric mean of the ratio," << key << ','
                << std::exp(sum.first / static_cast<double>(sum.second)) << ",over," << sum.second
                << std::endl;
  }

  static void header() {
    std::cout << "model,task,effort,bodies,vertices,largest,reach_percent,stop,ratio,user_seconds,"
                 "verify_seconds,cover"
              << std::endl;
  }

 private:
  std::map<std::string, std::pair<double, std::size_t>> logarithms_;

  void print(const nlohmann::ordered_json& row) {
    const char* columns[] = {"model",    "task",         "effort",         "bodies",
                             "vertices", "largest",      "reach_percent",  "stop",
                             "ratio",    "user_seconds", "verify_seconds", "cover"};
    for (const char* column : columns) {
      if (column != columns[0]) std::cout << ',';
      if (!row.contains(column)) continue;
      if (row[column].is_string()) {
        std::cout << row[column].get<std::string>();
      } else {
        std::cout << row[column];
      }
    }
    std::cout << std::endl;
    rows.push_back(row);
  }

  static double excess_of(const std::vector<geom::Mesh>& hulls, const geom::Mesh& closed) {
    const bcd::SolidField solid(closed, 100000, 0);
    bcd::ExcessOptions gap;
    gap.relative_gap = 0.005;
    double excess = 0;
    for (const bcd::Excess& r : bcd::measure(hulls, solid, gap)) excess = std::max(excess, r.upper);
    return excess;
  }

  static Peer measured(const std::filesystem::path& file, const geom::Mesh& closed) {
    Peer peer;
    std::vector<geom::Mesh> hulls;
    for (const geom::ConvexBody& body : io::read_convex_set(file).bodies) {
      std::optional<geom::Mesh> hull = geom::convex_hull(body.core.vertices);
      if (!hull) continue;
      peer.vertices += hull->vertices.size();
      peer.largest = std::max(peer.largest, hull->vertices.size());
      hulls.push_back(*std::move(hull));
    }
    peer.bodies = hulls.size();
    peer.excess = excess_of(hulls, closed);
    return peer;
  }

  void row(const std::string& name, const geom::Prepared& input, const geom::Mesh& closed,
           const bcd::CoverOptions& o, const std::string& task, const std::string& effort,
           const std::optional<Peer>& peer) {
    const double start = user_seconds();
    bcd::CoverCandidate result = bcd::find_cover(input.solid, o);
    const double seconds = user_seconds() - start;
    const char* stop = result.stop == bcd::Stop::Done            ? "done"
                       : result.stop == bcd::Stop::TooManyBodies ? "max-bodies"
                       : result.stop == bcd::Stop::TooCoarse     ? "too coarse"
                                                                 : "stuck";
    const double diagonal = geom::bounding_box(input.solid.mesh()).diagonal();
    geom::ConvexSet set;
    set.bodies = std::move(result.bodies);
    const verify::Cover cover = verify::verify_cover(closed, set);
    const bool verified = cover.convexity.convex.answer == verify::Answer::Verified &&
                          cover.inclusion.solid.answer == verify::Answer::Verified &&
                          cover.inclusion.surface.answer == verify::Answer::Verified;
    nlohmann::ordered_json out{{"model", name},
                               {"task", task},
                               {"effort", effort},
                               {"bodies", set.bodies.size()},
                               {"vertices", result.statistics.vertices},
                               {"largest", result.statistics.largest},
                               {"reach_percent", 100 * result.excess_upper / diagonal},
                               {"stop", stop},
                               {"user_seconds", seconds},
                               {"verify_seconds", user_seconds() - start - seconds},
                               {"cover", verified ? "verified" : "NOT VERIFIED"}};
    if (peer && task != "epsilon") {
      const auto ratio_of = [](std::size_t a, std::size_t b) {
        return static_cast<double>(a) / static_cast<double>(b);
      };
      const double ratio = task == "distance" ? result.excess_upper / peer->excess
                           : task == "bodies"
                               ? ratio_of(set.bodies.size(), peer->bodies)
                               : ratio_of(result.statistics.vertices, peer->vertices);
      out["ratio"] = ratio;
      auto& [sum, count] = logarithms_[task + ',' + effort];
      sum += std::log(ratio);
      ++count;
    }
    print(out);
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
    if (args[i] == "--efforts") {
      table.efforts = words(value());
    } else if (args[i] == "--tasks") {
      table.tasks = words(value());
    } else if (args[i] == "--peer") {
      table.peer_suffix = value();
    } else if (args[i] == "--epsilon") {
      table.epsilon_percent = std::stod(value());
    } else if (args[i] == "--most") {
      table.most = std::stoul(value());
    } else if (args[i] == "--json") {
      json = value();
    } else {
      files.push_back(args[i]);
    }
  }
  Table::header();
  for (const std::string& file : files) try {
      table.run(file);
    } catch (const Error& e) {
      std::cerr << file << ": " << e.what() << '\n';
    }
  table.means();
  if (!json.empty()) std::ofstream(json) << table.rows.dump(1) << '\n';
  return 0;
} catch (const std::exception& e) {
  std::cerr << "bcd_table: " << e.what() << '\n';
  return 2;
}
