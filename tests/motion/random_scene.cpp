// Random arms among random hulls.

#include "random_scene.h"

#include <random>
#include <sstream>

#include "support/shapes.h"
#include "world/worlds.h"

namespace kaboum::test {
namespace {

using geom::Mesh;
using geom::Vec3;

constexpr double kLarger = 1.02;

Mesh larger(Mesh mesh) {
  Vec3 middle = Vec3::Zero();
  for (const Vec3& v : mesh.vertices) middle += v / static_cast<double>(mesh.vertices.size());
  for (Vec3& v : mesh.vertices) v = middle + kLarger * (v - middle);
  return to_float(mesh);
}

std::string pose_text(const Vec3& at, const Vec3& rpy) {
  std::ostringstream out;
  out.precision(17);
  out << R"("pose": {"position": [)" << at.x() << ", " << at.y() << ", " << at.z()
      << R"(], "rpy": [)" << rpy.x() << ", " << rpy.y() << ", " << rpy.z() << "]}";
  return out.str();
}

std::string urdf() {
  const std::string shape =
      "<collision><geometry><box size=\"1 1 1\"/></geometry></collision></link>";
  std::string out = "<robot name=\"arm\"><link name=\"base\"/>", parent = "base";
  for (const std::string n : {"1", "2", "3", "4"}) {
    out += "<link name=\"l" + n + "\">" + shape + "<joint name=\"j" + n +
           "\" type=\"revolute\"><parent link=\"" + parent + "\"/><child link=\"l" + n +
           "\"/><origin xyz=\"" + (n == "1" ? "0 0 0" : "0.5 0 0") + "\"/><axis xyz=\"" +
           (n == "1" || n == "4" ? "0 0 1" : "0 1 0") +
           "\"/><limit lower=\"-3\" upper=\"3\" effort=\"1\" velocity=\"2\"/></joint>";
    parent = "l" + n;
  }
  return out + "</robot>";
}

}  // namespace

RandomScene random_scene(std::uint32_t seed, int objects) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  SceneFiles files;
  RandomScene out;
  const std::string text = urdf();
  files.files["arm.urdf"] = {text.begin(), text.end()};
  out.exact.robot = robot::parse_urdf(text, "arm.urdf");
  std::string scene = R"({"kaboum_scene": 1, "unit": "m", "robots": [{"name": "arm", "urdf": )" +
                      files.ref("arm.urdf") + R"(, "links": [)";
  const Mesh bar = box_mesh({0, -0x1p-7, -0x1p-7}, {0.5, 0x1p-7, 0x1p-7});
  for (std::uint32_t n = 1; n <= 4; ++n) {
    const std::string link = "l" + std::to_string(n);
    files.put(link + ".glb", set_of({larger(bar)}, "outer", 0.01, link));
    scene += (n == 1 ? "" : ", ") + std::string(R"({"link": ")") + link + R"(", "outer": )" +
             files.ref(link + ".glb") + "}";
    out.exact.bodies.push_back({link, bar, {}, n});
  }
  scene += "]}], \"objects\": [";
  for (int i = 0; i < objects; ++i) {
    Vec3 size(0.3, 0.3, 0.3);
    if (i % 3 == 1) size = {0.6, 0.5, 0.001};
    if (i % 3 == 2) size = {0.7, 0.002, 0.002};
    const Mesh hull = to_float(scaled(random_hull(12, Cloud::Cube, seed * 100U + i), size));
    const std::string name = "o" + std::to_string(i);
    files.put(name + ".glb", set_of({larger(hull)}, "outer", 0.02));
    Vec3 at;
    do {
      at = 1.7 * Vec3(unit(random), unit(random), unit(random));
    } while (at.norm() < 0.6);
    const Vec3 rpy = 3 * Vec3(unit(random), unit(random), unit(random));
    scene += std::string(i == 0 ? "" : ", ") + R"({"name": ")" + name + "\", " +
             pose_text(at, rpy) + ", \"outer\": " + files.ref(name + ".glb") + "}";
    out.exact.bodies.push_back(
        {name, hull, {robot::rotation_from_rpy(rpy.x(), rpy.y(), rpy.z()), at}, {}});
  }
  out.world = files.world(scene + "]}");
  // Links and all that is no link beside them; those of neighbours may touch.
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = i + 1; j < out.exact.bodies.size(); ++j)
      if (j >= 4 || j > i + 1) out.exact.pairs.push_back({i, j});
  return out;
}

std::vector<double> random_values(const robot::Robot& robot, std::mt19937_64& random) {
  std::vector<double> q;
  for (const robot::Variable& v : robot.variables)
    q.push_back(std::uniform_real_distribution<double>(*v.lower, *v.upper)(random));
  return q;
}

}  // namespace kaboum::test
