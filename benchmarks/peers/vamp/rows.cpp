// VAMP's answers for configurations, and its time.
//
//   vamp-rows-ROBOT SCENE ROWS VERDICTS
//
// SCENE has lines: `cuboid x y z roll pitch yaw half-x half-y half-z`, `capsule x y z roll pitch
// yaw radius length`, `sphere x y z radius`; they are added as VAMP's Python module adds them. ROWS
// are values of float64; VERDICTS gets a byte for each row, 1 where VAMP calls it free, as
// `validate` of its module does. Printed as JSON: CPU time for a row in packs of as many as there
// are lanes, which are answered as one, and for a row that has an answer of its own, the same in
// all lanes; and how many packs have an answer that is not that of their rows. Made by build.py.

#include ROBOT_FILE

#include <algorithm>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>
#include <vamp/collision/factory.hh>
#include <vector>

namespace {

namespace factory = vamp::collision::factory;
using Robot = vamp::robots::ROBOT;
constexpr std::size_t kLanes = vamp::FloatVectorWidth;
using Scene = vamp::collision::Environment<vamp::FloatVector<kLanes>>;
using Block = Robot::ConfigurationBlock<kLanes>;

double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

Scene read_scene(const char* name) {
  vamp::collision::Environment<float> out;
  std::ifstream file(name);
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind;
    words >> kind;
    std::vector<float> v;
    for (float x = 0; words >> x;) v.push_back(x);
    const std::array<float, 3> at{v.at(0), v.at(1), v.at(2)};
    if (kind == "sphere") {
      out.spheres.push_back(factory::sphere::array(at, v.at(3)));
      continue;
    }
    const std::array<float, 3> angles{v.at(3), v.at(4), v.at(5)};
    if (kind == "cuboid") {
      const auto box = factory::cuboid::array(at, angles, {v.at(6), v.at(7), v.at(8)});
      (box.axis_3_z == 1. ? out.z_aligned_cuboids : out.cuboids).push_back(box);
    } else {
      const auto rod = factory::cylinder::center::array(at, angles, v.at(6), v.at(7));
      (rod.xv == 0. && rod.yv == 0. ? out.z_aligned_capsules : out.capsules).push_back(rod);
    }
  }
  out.sort();
  return Scene(out);
}

std::vector<double> read_rows(const char* name) {
  std::ifstream file(name, std::ios::binary | std::ios::ate);
  std::vector<double> out(static_cast<std::size_t>(file.tellg()) / sizeof(double));
  file.seekg(0);
  file.read(reinterpret_cast<char*>(out.data()),
            static_cast<std::streamsize>(out.size() * sizeof(double)));
  return out;
}

/// Rows first, first + step, ... in the lanes.
Block block_of(const std::vector<double>& rows, std::size_t first, std::size_t step) {
  Block out;
  for (std::size_t i = 0; i < Robot::dimension; ++i) {
    alignas(vamp::FloatVectorAlignment) std::array<float, kLanes> lanes{};
    for (std::size_t k = 0; k < kLanes; ++k)
      lanes[k] = static_cast<float>(rows[(first + k * step) * Robot::dimension + i]);
    out[i] = vamp::FloatVector<kLanes>(lanes);
  }
  return out;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) return 2;
  const Scene scene = read_scene(argv[1]);
  const std::vector<double> rows = read_rows(argv[2]);
  const std::size_t count = rows.size() / Robot::dimension;
  std::vector<char> verdicts(count);
  std::vector<Block> singles;
  for (std::size_t i = 0; i < count; ++i) singles.push_back(block_of(rows, i, 0));
  double alone = 1e9;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const double start = cpu_seconds();
    for (std::size_t i = 0; i < count; ++i)
      verdicts[i] = Robot::fkcc<kLanes>(scene, singles[i]) ? 1 : 0;
    alone = std::min(alone, cpu_seconds() - start);
  }
  std::ofstream(argv[3], std::ios::binary)
      .write(verdicts.data(), static_cast<std::streamsize>(count));
  const std::size_t packs = count / kLanes;
  std::vector<Block> blocks;
  for (std::size_t p = 0; p < packs; ++p) blocks.push_back(block_of(rows, p * kLanes, 1));
  std::vector<char> answers(packs);
  double best = 1e9;
  for (int repeat = 0; repeat < 5; ++repeat) {
    const double start = cpu_seconds();
    for (std::size_t p = 0; p < packs; ++p)
      answers[p] = Robot::fkcc<kLanes>(scene, blocks[p]) ? 1 : 0;
    best = std::min(best, cpu_seconds() - start);
  }
  std::size_t differ = 0;
  for (std::size_t p = 0; p < packs; ++p) {
    const auto first = verdicts.begin() + static_cast<std::ptrdiff_t>(p * kLanes);
    const bool all = std::all_of(first, first + kLanes, [](char c) { return c != 0; });
    differ += all != (answers[p] != 0) ? 1 : 0;
  }
  std::cout << "{\"rows\": " << count << ", \"nanoseconds\": "
            << (packs == 0 ? 0 : 1e9 * best / static_cast<double>(packs * kLanes))
            << ", \"nanoseconds alone\": "
            << (count == 0 ? 0 : 1e9 * alone / static_cast<double>(count))
            << ", \"packs that differ\": " << differ << "}\n";
}
