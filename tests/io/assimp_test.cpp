#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "io_test.h"

// assimp leaks a little on some damaged files; LeakSanitizer is about our code.
extern "C" const char* __lsan_default_suppressions();  // NOLINT(bugprone-reserved-identifier)
extern "C" const char* __lsan_default_suppressions() { return "leak:libassimp"; }  // NOLINT

namespace kaboum::io::test {
namespace {

namespace fs = std::filesystem;

bool with_assimp() {
  const auto names = readable_formats();
  return std::ranges::find(names, "dae") != names.end();
}

std::string dae(const std::string& asset, const std::string& node, const std::string& faces) {
  return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset>)" +
         asset + R"(</asset>
 <library_geometries><geometry id="g"><mesh>
  <source id="p"><float_array id="pa" count="15">0 0 0 4 0 0 4 4 0 1 1 0 0 4 0.5</float_array>
   <technique_common><accessor source="#pa" count="5" stride="3">
    <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
   </accessor></technique_common></source>
  <vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
  )" + faces +
         R"(
 </mesh></geometry></library_geometries>
 <library_visual_scenes><visual_scene id="s">
  )" + node +
         R"(
 </visual_scene></library_visual_scenes>
 <scene><instance_visual_scene url="#s"/></scene>
</COLLADA>)";
}

const std::string kTriangles =
    R"(<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 3 3 1 2</p></triangles>)";
const std::string kNode = R"(<node id="n"><instance_geometry url="#g"/></node>)";

TEST(Assimp, Collada) {
  if (!with_assimp()) return;
  const ReadResult r = parse(dae("", kNode, kTriangles), Format::Collada);
  EXPECT_TRUE(r.single_precision);
  EXPECT_TRUE(has_note(r, "32-bit"));
  EXPECT_EQ(soup(r.mesh), (std::vector<Vec3>{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(1, 1, 0),
                                             Vec3(1, 1, 0), Vec3(4, 0, 0), Vec3(4, 4, 0)}));
}

TEST(Assimp, ColladaAxesUnitsAndTransforms) {
  if (!with_assimp()) return;
  for (const char* axis : {"X_UP", "Y_UP", "Z_UP"}) {
    const ReadResult r =
        parse(dae(std::string("<unit name=\"mm\" meter=\"0.5\"/><up_axis>") + axis + "</up_axis>",
                  R"(<node id="a"><translate>2 0 0</translate><node id="b"><rotate>0 0 1 90</rotate>
               <instance_geometry url="#g"/></node></node>)",
                  kTriangles),
              Format::Collada);
    ASSERT_EQ(r.mesh.vertices.size(), 4U);
    EXPECT_LT((r.mesh.vertices[1] - Vec3(1, 2, 0)).norm(), 1e-6) << r.mesh.vertices[1].transpose();
    EXPECT_TRUE(has_note(r, "'0.5' metres"));
    EXPECT_TRUE(has_note(r, axis));
    EXPECT_TRUE(has_note(r, "double"));
  }
  const ReadResult mirrored =
      parse(dae("", R"(<node id="a"><scale>-1 1 1</scale><instance_geometry url="#g"/></node>)",
                kTriangles),
            Format::Collada);
  EXPECT_EQ(soup(mirrored.mesh)[0], Vec3(-1, 1, 0));
  EXPECT_EQ(soup(mirrored.mesh)[2], Vec3(0, 0, 0));
}

TEST(Assimp, ColladaPolygonsAreSplitByUs) {
  if (!with_assimp()) return;
  const ReadResult r =
      parse(dae("", kNode,
                R"(<polylist count="1"><input semantic="VERTEX" source="#v" offset="0"/>
                                    <vcount>5</vcount><p>0 1 2 3 4</p></polylist>)"),
            Format::Collada);
  EXPECT_EQ(r.split_polygons, 1U);
  EXPECT_EQ(r.mesh.triangles.size(), 3U);
  EXPECT_FALSE(has_note(r, "plain fan"));
}

TEST(Assimp, ColladaIndexListsHoldNumbersOnly) {
  if (!with_assimp()) return;
  // assimp itself does not return from these.
  for (const char* bad : {"p", "-1", "\xA5", "1.5", "<![CDATA[x]]>"}) {
    std::string faces = kTriangles;
    faces.insert(faces.find(" 3 3"), std::string(" ") + bad);
    expect_error(dae("", kNode, faces), Format::Collada, {"line 1", "index list"});
  }
}

TEST(Assimp, NoGeometryIsLostOrMerged) {
  if (!with_assimp()) return;
  // A degenerate triangle, a duplicate one, and two points closer than any welding tolerance.
  const std::string points =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
       "meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],
       "accessors":[{"bufferView":0,"componentType":5126,"count":4,"type":"VEC3"},
                    {"bufferView":1,"componentType":5121,"count":12,"type":"SCALAR"}],
       "bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":48},{"buffer":0,"byteOffset":48,"byteLength":12}],
       "buffers":[{"uri":"data.bin","byteLength":60}]})";
  const fs::path directory =
      fs::path(::testing::TempDir()) / ("kaboum-gltf-" + std::to_string(::getpid()));
  fs::create_directories(directory);
  std::string data;
  const float near_one = std::nextafter(1.0F, 2.0F);
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, near_one, 0.F, 0.F, 0.F, 1.F, 0.F})
    append(data, x);
  data += std::string("\0\1\2\0\1\3\0\1\3\0\0\3", 12);
  std::ofstream(directory / "data.bin", std::ios::binary) << data;
  std::ofstream(directory / "mesh.gltf") << points;
  const ReadResult r = read_mesh(directory / "mesh.gltf");
  EXPECT_EQ(r.file_triangles, 4U);
  EXPECT_EQ(r.collapsed_triangles, 1U);
  EXPECT_EQ(r.mesh.vertices.size(), 4U);
  EXPECT_EQ(r.mesh.vertices[2].x(), double{near_one});
  EXPECT_TRUE(has_note(r, "data.bin"));
  // Without the directory the buffer cannot be found.
  expect_error(points, Format::Gltf, {"gltf"});
  fs::remove_all(directory);
}

TEST(Assimp, X3d) {
  if (!with_assimp()) return;
  const ReadResult r = parse(
      R"(<?xml version="1.0" encoding="UTF-8"?>
<X3D profile="Interchange" version="3.0"><Scene><Transform translation="0 0 2"><Shape>
<IndexedFaceSet coordIndex="0 1 2 3 -1"><Coordinate point="0 0 0 1 0 0 1 1 0 0 1 0"/></IndexedFaceSet>
</Shape></Transform></Scene></X3D>)",
      Format::X3d);
  EXPECT_EQ(r.mesh.vertices.size(), 4U);
  EXPECT_EQ(r.mesh.triangles.size(), 2U);
  EXPECT_EQ(r.mesh.vertices[0], Vec3(0, 0, 2));
}

TEST(Assimp, GlbOfOurs) {
  if (!with_assimp()) return;
  const std::vector<char> bytes = serialise_mesh(tetrahedron(), Format::Glb);
  const ReadResult r = parse_mesh(bytes, Format::Glb, "ours");
  EXPECT_EQ(soup(r.mesh), soup(tetrahedron()));
}

TEST(Assimp, Errors) {
  if (!with_assimp()) {
    expect_error("x", Format::Collada, {"assimp"}, ErrorCode::NotBuilt);
    return;
  }
  for (const Format format : {Format::Glb, Format::Gltf, Format::Collada, Format::Fbx, Format::X3d})
    expect_error("this is not such a file", format, {});
  expect_error(dae("", "", kTriangles), Format::Collada, {});
}

}  // namespace
}  // namespace kaboum::io::test
