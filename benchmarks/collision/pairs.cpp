#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/kinematics.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <random>
#include <string>

#include "engine.h"
#include "timing.h"

/// What convex sets of a mesh buy: collision queries between two copies of it near contact, on the
/// triangle meshes (FCL's trees of them) and on sets of convex bodies, with several ways to decide
/// about these. A false alarm is a collision of the sets where the meshes are apart, a miss the
/// opposite.
///
///   set-collision-benchmark [--queries N] [--sets FOLDER] [--peer SUFFIX] [--csv FILE] MESH...
///
/// The sets of NAME.obj are all FOLDER/NAME.SETTING.{glb,obj}; NAME.SUFFIX.obj beside the mesh
/// (coacd-0.05) is another program's. Geometric means over the meshes come last.
namespace {

using namespace kaboum;
using namespace kaboum::collide;

Model model_of(const std::string& name, bool convex, const std::vector<geom::Mesh>& bodies) {
  Model model{name, convex, 0, {}, bodies};
  for (const geom::Mesh& body : bodies) model.robot.push_back({0, body});
  return model;
}

/// Sets of other programs are convex up to rounding only: the hulls of their bodies.
Model load_set(const std::string& path) {
  std::vector<geom::Mesh> bodies;
  for (const geom::ConvexBody& body : io::read_convex_set(path).bodies)
    if (auto hull = geom::convex_hull(body.core.vertices)) bodies.push_back(std::move(*hull));
  return model_of(path, true, bodies);
}

geom::Vec3 random_direction(std::mt19937_64& random) {
  std::normal_distribution<double> normal;
  return geom::Vec3(normal(random), normal(random), normal(random)).normalized();
}

/// Poses of the second copy: turned at random, moved along a random direction to the last contact
/// (by bisection), then between 1 % of the diagonal nearer and 2 % farther.
std::vector<geom::Transform> near_contact(const geom::Mesh& mesh, Engine& engine,
                                          std::size_t count) {
  const geom::Box3 box = geom::bounding_box(mesh);
  const geom::Vec3 center = 0.5 * (box.min + box.max);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  std::vector<geom::Transform> poses;
  while (poses.size() < count) {
    geom::Transform pose;
    pose.linear =
        robot::rotation_about(random_direction(random), 2 * std::numbers::pi * unit(random));
    const geom::Vec3 direction = random_direction(random);
    // The line goes past the middle, so that not only the bulk of both meets.
    const geom::Vec3 aside = 0.4 * unit(random) * box.diagonal() *
                             direction.cross(random_direction(random)).normalized();
    const auto place = [&](double distance) {
      pose.translation = center + distance * direction + aside - pose.linear * center;
      return pose;
    };
    // From far to near, the first contact; none where the copies pass each other.
    double far = 1.1 * box.diagonal(), near = -1;
    for (int step = 0; step < 60 && near < 0; ++step) {
      const double d = far - 0.02 * box.diagonal();
      if (d < 0) break;
      engine.place({place(d)});
      if (engine.collide())
        near = d;
      else
        far = d;
    }
    if (near < 0) continue;
    for (int i = 0; i < 20; ++i) {
      const double middle = 0.5 * (near + far);
      engine.place({place(middle)});
      (engine.collide() ? near : far) = middle;
    }
    poses.push_back(place(far + (0.03 * unit(random) - 0.01) * box.diagonal()));
  }
  return poses;
}

/// A program's way to decide about two sets.
struct Way {
  const char* name;
  std::unique_ptr<Engine> (*make)(const Model&);
};

constexpr std::array<Way, 6> kWays{{{"FCL, objects", make_fcl},
                                    {"FCL, tree", make_fcl_tree},
                                    {"FCL's GJK, tree", make_fcl_own_tree},
                                    {"libccd, tree", make_ccd_tree},
                                    {"FCL, directions", make_fcl_directions},
                                    {"libccd, directions", make_ccd_directions}}};

struct Options {
  std::size_t queries = 5000;
  std::filesystem::path sets = ".";
  std::string peer = "coacd-0.05";
  FILE* csv = nullptr;
  std::vector<std::filesystem::path> meshes;
};

/// The files folder/NAME.SETTING.{glb,obj}, by setting.
std::map<std::string, std::filesystem::path> sets_of(const std::string& name,
                                                     const std::filesystem::path& folder) {
  std::map<std::string, std::filesystem::path> out;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string file = entry.path().filename().string();
    const std::string kind = entry.path().extension().string();
    if ((kind == ".glb" || kind == ".obj") && file.starts_with(name + '.') &&
        file.size() > name.size() + 1 + kind.size())
      out[file.substr(name.size() + 1, file.size() - name.size() - 1 - kind.size())] = entry.path();
  }
  return out;
}

class Benchmark {
 public:
  explicit Benchmark(const Options& options) : options_(options) {
    line({"model", "set", "bodies", "vertices", "by", "p50_us", "p99_us", "max_us", "p50_faster",
          "p99_faster", "max_faster", "false_alarms", "alarms_to_peer", "misses"});
  }

  void run(const std::filesystem::path& path) {
    name_ = path.stem().string();
    const geom::Mesh mesh = io::read_mesh(path.string()).mesh;
    const auto triangles = make_fcl(model_of("triangles", false, {mesh}));
    poses_ = near_contact(mesh, *triangles, options_.queries);
    truth_ = answers(*triangles);
    reference_ = time(*triangles);
    std::printf("%s: %zu queries, %td of them apart\n", name_.c_str(), poses_.size(),
                std::count(truth_.begin(), truth_.end(), 0));
    line({name_, "mesh", "1", std::to_string(mesh.vertices.size()), "FCL, triangles",
          text(reference_.median), text(reference_.p99), text(reference_.most)});
    peer_alarms_.reset();
    const std::filesystem::path peer = path.parent_path() / (name_ + "." + options_.peer + ".obj");
    if (std::filesystem::exists(peer)) measure(options_.peer, peer);
    for (const auto& [setting, file] : sets_of(name_, options_.sets))
      if (setting != options_.peer) measure(setting, file);
  }

  void means() const {
    std::printf("geometric means, and in brackets the worst model's\n");
    for (const auto& [key, sums] : logarithms_) {
      std::printf("  %-22s %-22s %zu models: p99 %6.2f (%.2f), max %6.2f (%.2f) times faster",
                  key.first.c_str(), key.second.c_str(), sums.count, sums.mean(sums.p99),
                  sums.least_p99, sums.mean(sums.most), sums.least_most);
      std::printf("; false alarms to the peer's %.3f (%.3f)\n", sums.mean(sums.alarms),
                  sums.most_alarms);
    }
  }

 private:
  struct Sums {
    std::size_t count = 0;
    double p99 = 0, most = 0, alarms = 0;
    double least_p99 = 1e300, least_most = 1e300, most_alarms = 0;

    [[nodiscard]] double mean(double sum) const {
      return std::exp(sum / static_cast<double>(count));
    }
  };

  static std::string text(double value) {
    std::array<char, 32> out{};
    std::snprintf(out.data(), out.size(), "%.4g", value);
    return out.data();
  }

  void line(const std::vector<std::string>& cells) const {
    static constexpr std::array<int, 14> kWidths{14, 22, 6, 8, 22, 8, 8, 8, 10, 10, 10, 12, 14, 6};
    for (std::size_t i = 0; i < cells.size(); ++i) {
      std::printf(i < 2 || i == 4 ? "%-*s " : "%*s ", kWidths[i], cells[i].c_str());
      const bool quoted = cells[i].find(',') != std::string::npos;
      if (options_.csv != nullptr)
        std::fprintf(options_.csv, quoted ? "%s\"%s\"" : "%s%s", i > 0 ? "," : "",
                     cells[i].c_str());
    }
    std::printf("\n");
    std::fflush(stdout);
    if (options_.csv != nullptr) std::fprintf(options_.csv, "\n");
  }

  [[nodiscard]] std::vector<char> answers(Engine& engine) const {
    std::vector<char> out;
    for (const auto& pose : poses_) {
      engine.place({pose});
      out.push_back(engine.collide() ? 1 : 0);
    }
    return out;
  }

  [[nodiscard]] Statistics time(Engine& engine) const {
    std::vector<double> times;
    return times_of(
        poses_.size(),
        [&](std::size_t i) {
          engine.place({poses_[i]});
          engine.collide();
        },
        times);
  }

  void measure(const std::string& setting, const std::filesystem::path& file) {
    const Model model = load_set(file.string());
    std::size_t vertices = 0;
    for (const geom::Mesh& body : model.scene) vertices += body.vertices.size();
    for (const Way& way : kWays) {
      const auto engine = way.make(model);
      const Statistics s = time(*engine);
      const double p99 = reference_.p99 / s.p99, most = reference_.most / s.most;
      std::vector<std::string> cells{name_,
                                     setting,
                                     std::to_string(model.scene.size()),
                                     std::to_string(vertices),
                                     way.name,
                                     text(s.median),
                                     text(s.p99),
                                     text(s.most),
                                     text(reference_.median / s.median),
                                     text(p99),
                                     text(most)};
      Sums& sums = logarithms_[{setting, way.name}];
      ++sums.count;
      sums.p99 += std::log(p99);
      sums.most += std::log(most);
      sums.least_p99 = std::min(sums.least_p99, p99);
      sums.least_most = std::min(sums.least_most, most);
      count_alarms(setting, *engine, cells, sums);
      line(cells);
    }
  }

  void count_alarms(const std::string& setting, Engine& engine, std::vector<std::string>& cells,
                    Sums& sums) {
    std::size_t alarms = 0, missed = 0;
    const std::vector<char> found = answers(engine);
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      alarms += found[i] > truth_[i] ? 1 : 0;
      missed += found[i] < truth_[i] ? 1 : 0;
    }
    if (!peer_alarms_ && setting == options_.peer) peer_alarms_ = alarms;
    // One more of each: there may be none.
    const double ratio =
        peer_alarms_ ? (static_cast<double>(alarms) + 1) / (static_cast<double>(*peer_alarms_) + 1)
                     : 1;
    cells.insert(cells.end(),
                 {std::to_string(alarms), peer_alarms_ ? text(ratio) : "", std::to_string(missed)});
    sums.alarms += std::log(ratio);
    sums.most_alarms = std::max(sums.most_alarms, ratio);
  }

  const Options& options_;
  std::string name_;
  std::vector<geom::Transform> poses_;
  std::vector<char> truth_;
  Statistics reference_{};
  std::optional<std::size_t> peer_alarms_;
  std::map<std::pair<std::string, std::string>, Sums> logarithms_;
};

/// @return whether the command line is understood.
bool parsed(int argc, char** argv, Options& options) {
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (!word.starts_with("--")) {
      options.meshes.emplace_back(word);
      continue;
    }
    if (++i == argc) return false;
    if (word == "--queries")
      options.queries = std::stoul(argv[i]);
    else if (word == "--sets")
      options.sets = argv[i];
    else if (word == "--peer")
      options.peer = argv[i];
    else if (word == "--csv") {
      options.csv = std::fopen(argv[i], "w");
      if (options.csv == nullptr)
        throw Error(ErrorCode::OutputFailed, std::string(argv[i]) + " cannot be written");
    } else {
      return false;
    }
  }
  return !options.meshes.empty() && options.queries > 0;
}

}  // namespace

int main(int argc, char** argv) {
  try {
    Options options;
    if (!parsed(argc, argv, options)) {
      std::fprintf(stderr,
                   "usage: set-collision-benchmark [--queries N] [--sets FOLDER] [--peer SUFFIX] "
                   "[--csv FILE] MESH...\n");
      return 2;
    }
    Benchmark benchmark(options);
    for (const auto& mesh : options.meshes) benchmark.run(mesh);
    benchmark.means();
    if (options.csv != nullptr && std::fclose(options.csv) != 0) return 4;
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "set-collision-benchmark: %s\n", error.what());
    return 1;
  }
}
