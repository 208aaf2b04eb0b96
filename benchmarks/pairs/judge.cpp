// What kaboum-pairs says of a robot, judged by exact meshes at samples.
//
//   pairs-judge-benchmark ROBOT REPORT SAMPLES SEED [PACKAGES...]
//
// REPORT is that of `kaboum-pairs ROBOT --json` or `--report`. At so many configurations, a third
// of whose values are at limits, pairs that are said never to touch must not, and such that always
// do must; configurations that are said to show contacts must. Printed as JSON: how many were
// looked at, and what was wrong. The exit code is 1 where something was.

#include <kaboum/judge/placement.h>
#include <kaboum/judge/solid.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/robot/robot_file.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <random>
#include <string>

#include "motion/judged_robot.h"

namespace {

using namespace kaboum;
using nlohmann::json;

struct Link {
  std::unique_ptr<judge::Solid> solid;
  geom::Vec3 center = geom::Vec3::Zero();
  double radius = 0;
};

class JudgedPairs {
 public:
  JudgedPairs(const char* robot, const std::vector<std::string>& packages)
      : file_(robot::read_robot(robot, robot::Motions::All, {}, packages)) {
    robot::MeshFiles files(file_.path, packages);
    for (const robot::Link& link : file_.robot.links) {
      Link& made = links_.emplace_back();
      const geom::Mesh mesh = benchmarks::mesh_of_link(link, files);
      if (mesh.triangles.empty()) continue;
      geom::Box3 box;
      for (const geom::Vec3& v : mesh.vertices) box.extend(v);
      made.center = 0.5 * (box.min + box.max);
      for (const geom::Vec3& v : mesh.vertices)
        made.radius = std::max(made.radius, (1 + 1e-9) * (v - made.center).norm());
      made.solid = std::make_unique<judge::Solid>(mesh);
    }
  }

  void take(const json& report) {
    for (const json& pair : report["pairs"]) {
      const auto a = file_.robot.find_link(pair["links"][0].get<std::string>());
      const auto b = file_.robot.find_link(pair["links"][1].get<std::string>());
      const Pair made{a.value(), b.value(), pair["verdict"].get<std::string>()};
      if (!links_[made.a].solid || !links_[made.b].solid) continue;
      pairs_.push_back(made);
      if (made.verdict != "can touch" || !pair.contains("configuration")) continue;
      ++shown_;
      if (meet(made, places(values(pair["configuration"])))) continue;
      // What is inside of an open mesh does not meet it for the judge.
      if (is_closed(made))
        wrong(made, "does not meet there");
      else
        ++not_judged_;
    }
  }

  void sample(std::size_t count, std::uint64_t seed) {
    std::mt19937_64 random(seed);
    const auto from = [&](double low, double high) {
      return std::uniform_real_distribution<double>(low, high)(random);
    };
    for (std::size_t i = 0; i < count; ++i) {
      std::vector<double> q;
      for (const robot::Variable& v : file_.robot.variables) {
        const double low = v.lower.value_or(-4), high = v.upper.value_or(4);
        const auto which = random() % 6;
        q.push_back(which == 0 ? low : which == 1 ? high : from(low, high));
      }
      const std::vector<geom::Transform> at = places(q);
      for (const Pair& pair : pairs_) {
        if (pair.verdict == "never") {
          ++never_;
          if (meet(pair, at)) wrong(pair, "meets");
        } else if (pair.verdict == "always" && is_closed(pair)) {
          ++always_;
          if (!meet(pair, at)) wrong(pair, "is apart");
        }
      }
    }
  }

  [[nodiscard]] json said() const {
    return {{"never", never_},
            {"always", always_},
            {"shown", shown_},
            {"shown inside of open meshes", not_judged_},
            {"wrong", wrong_}};
  }
  [[nodiscard]] bool is_right() const { return wrong_.empty(); }

 private:
  struct Pair {
    std::uint32_t a, b;
    std::string verdict;
  };

  [[nodiscard]] std::vector<double> values(const json& stated) const {
    std::vector<double> out;
    for (const robot::Variable& v : file_.robot.variables)
      out.push_back(stated.at(v.name).get<double>());
    return out;
  }
  [[nodiscard]] std::vector<geom::Transform> places(const std::vector<double>& q) const {
    return judge::places(file_.robot, {}, q);
  }
  [[nodiscard]] bool meet(const Pair& pair, const std::vector<geom::Transform>& at) const {
    const Link &a = links_[pair.a], &b = links_[pair.b];
    return (at[pair.a] * a.center - at[pair.b] * b.center).norm() <= a.radius + b.radius &&
           a.solid->meets(at[pair.a], *b.solid, at[pair.b]);
  }
  [[nodiscard]] bool is_closed(const Pair& pair) const {
    return links_[pair.a].solid->closed() && links_[pair.b].solid->closed();
  }
  void wrong(const Pair& pair, const std::string& what) {
    const std::string text = file_.robot.links[pair.a].name + " " + file_.robot.links[pair.b].name +
                             ", '" + pair.verdict + "', " + what;
    ++wrong_[text];
  }

  robot::RobotFile file_;
  std::vector<Link> links_;
  std::vector<Pair> pairs_;
  std::size_t never_ = 0, always_ = 0, shown_ = 0, not_judged_ = 0;
  std::map<std::string, std::size_t> wrong_;
};

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) return 2;
  try {
    JudgedPairs pairs(argv[1], {argv + 5, argv + argc});
    std::ifstream report(argv[2]);
    pairs.take(json::parse(report));
    pairs.sample(std::strtoull(argv[3], nullptr, 10), std::strtoull(argv[4], nullptr, 10));
    std::cout << pairs.said() << '\n';
    return pairs.is_right() ? 0 : 1;
  } catch (const std::exception& error) {
    std::cerr << "pairs-judge-benchmark: " << error.what() << '\n';
    return 3;
  }
}
