// A small arm and some boxes as files in memory.

#include "worlds.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/io/convex_io.h>

namespace kaboum::test {
namespace {

using geom::Vec3;

std::string arm_urdf() {
  std::string out =
      "<robot name=\"arm\"><link name=\"base\"><collision><geometry><box size=\"0.2 "
      "0.2 0.1\"/></geometry></collision></link>";
  std::string parent = "base";
  for (const char* n : {"1", "2", "3"}) {
    std::string link = "l";
    link += n;
    out += "<link name=\"" + link +
           "\"><collision><origin xyz=\"0.5 0 0\"/><geometry><box size=\"1 0.1 "
           "0.1\"/></geometry></collision></link><joint name=\"j" +
           n + "\" type=\"revolute\"><parent link=\"" + parent + "\"/><child link=\"" + link +
           "\"/><origin xyz=\"" + (parent == "base" ? "0 0 0.1" : "1 0 0") +
           "\"/><axis xyz=\"0 0 1\"/><limit lower=\"-3\" upper=\"3\" effort=\"1\" "
           "velocity=\"1\"/></joint>";
    parent = link;
  }
  return out + "</robot>";
}

}  // namespace

geom::Mesh box_mesh(const Vec3& low, const Vec3& high) {
  std::vector<Vec3> points;
  for (const double x : {low.x(), high.x()})
    for (const double y : {low.y(), high.y()})
      for (const double z : {low.z(), high.z()}) points.emplace_back(x, y, z);
  return *geom::convex_hull(points);
}

geom::ConvexSet set_of(const std::vector<geom::Mesh>& hulls, const std::string& direction,
                       double epsilon, const std::string& frame) {
  geom::ConvexSet out;
  for (const geom::Mesh& hull : hulls) out.bodies.push_back({"body", hull});
  out.provenance.direction = direction;
  if (epsilon >= 0) out.provenance.epsilon = epsilon;
  out.provenance.covers_solid = out.provenance.covers_surface = direction == "outer";
  out.provenance.frame = frame;
  return out;
}

SceneFiles::SceneFiles() {
  const std::string text = arm_urdf();
  files["arm.urdf"] = {text.begin(), text.end()};
  put("base.glb",
      set_of({box_mesh({-0.125, -0.125, -0.0625}, {0.125, 0.125, 0.0625})}, "outer", 0.05, "base"));
  for (const std::string link : {"l1", "l2", "l3"})
    put(link + ".glb", set_of({box_mesh({0, -0.0625, -0.0625}, {0.5, 0.0625, 0.0625}),
                               box_mesh({0.5, -0.0625, -0.0625}, {1, 0.0625, 0.0625})},
                              "outer", 0.03, link));
  const geom::Mesh cube = box_mesh({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  put("box.glb", set_of({cube}, "outer", 0.01));
  put("inner.glb", set_of({cube}, "inner", 0.01));
  put("tray.glb",
      set_of({box_mesh({-2, -1, -1}, {0, 1, 1}), box_mesh({0, -1, -1}, {2, 1, 1})}, "inner", 0.01));
}

void SceneFiles::put(const std::string& name, const geom::ConvexSet& set) {
  files[name] = io::serialise_convex_set(set, io::SetFormat::Glb);
}

std::string SceneFiles::hash(const std::string& name) const { return io::sha256(files.at(name)); }

std::string SceneFiles::ref(const std::string& name) const {
  return R"({"file": ")" + name + R"(", "sha256": ")" + hash(name) + "\"}";
}

std::vector<char> SceneFiles::read(const std::string& name) const {
  if (!files.contains(name))
    throw Error(ErrorCode::InvalidInput, name + ": cannot be read: no such file");
  return files.at(name);
}

std::string SceneFiles::scene(const std::string& rest, const std::string& robot_rest) const {
  std::string out = R"({"kaboum_scene": 1, "unit": "m",
  "robots": [{"name": "arm", "urdf": )" +
                    ref("arm.urdf") + R"(,
    "links": [)";
  for (const std::string link : {"base", "l1", "l2", "l3"})
    out += std::string(link == "base" ? "\n      " : ",\n      ")
               .append(R"({"link": ")")
               .append(link) +
           R"(", "outer": )" + ref(link + ".glb") + "}";
  out += "]" + (robot_rest.empty() ? "" : ",\n    " + robot_rest) + "}]";
  return out + (rest.empty() ? "" : ",\n  " + rest) + "}\n";
}

world::World SceneFiles::world(const std::string& text) const {
  return world::parse_scene(text, "scene.json",
                            [this](const std::string& file) { return read(file); });
}

}  // namespace kaboum::test
