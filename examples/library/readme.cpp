// What README.md and docs/cpp.md show of the library, compiled: a test looks for its lines there.

#include <kaboum/certify/convex_set.h>
#include <kaboum/certify/robot.h>
#include <kaboum/certify/sweep.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/path_file.h>

#include <filesystem>

#include "arm.h"
#include "box.h"

namespace {

// clang-format off
void convert_link() {
const auto input = kaboum::io::read_mesh("link.stl");
kaboum::certify::SetRequest request;
request.epsilon = kaboum::Length{0.002};  // in the mesh's unit
const auto made = kaboum::certify::certify_set(input.mesh, "", request);  // decided exactly, or an error
if (made) kaboum::io::write_file("link.glb", made->bytes());
}

void convert_robot(const kaboum::robot::Path& path) {
const auto arm = kaboum::robot::read_robot("arm.urdf");
const auto links = kaboum::certify::certify_robot(arm, {});                       // a set and its file per link
kaboum::certify::SweepRequest motion;
motion.search.epsilon = 0.005;  // in metres
const auto swept = kaboum::certify::certify_sweep(arm, links.bodies, path, motion);
}
// clang-format on

}  // namespace

int main() {
  const auto stl = kaboum::io::serialise_mesh(box({0, 0, 0}, {3, 2, 1}), kaboum::io::Format::Stl);
  kaboum::io::write_file("link.stl", stl);
  convert_link();
  const std::string urdf = write_arm();
  std::filesystem::copy_file(urdf, "arm.urdf", std::filesystem::copy_options::overwrite_existing);
  convert_robot({{0}, {0.1}});
  return std::filesystem::exists("link.glb") ? 0 : 1;
}
