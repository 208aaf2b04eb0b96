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
  return std::ranges::find(names, "fbx") != names.end();
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

TEST(Assimp, GlbOfOurs) {
  if (!with_assimp()) return;
  const std::vector<char> bytes = serialise_mesh(tetrahedron(), Format::Glb);
  const ReadResult r = parse_mesh(bytes, Format::Glb, "ours");
  EXPECT_EQ(soup(r.mesh), soup(tetrahedron()));
}

TEST(Assimp, Errors) {
  if (!with_assimp()) {
    expect_error("x", Format::Fbx, {"assimp"}, ErrorCode::NotBuilt);
    return;
  }
  for (const Format format : {Format::Glb, Format::Gltf, Format::Fbx})
    expect_error("this is not such a file", format, {});
}

}  // namespace
}  // namespace kaboum::io::test
