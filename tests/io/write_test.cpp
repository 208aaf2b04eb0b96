#include <cmath>
#include <cstring>
#include <nlohmann/json.hpp>
#include <random>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

/// A soup of triangles over awkward coordinates.
Mesh random_mesh(bool floats, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> unit(-1, 1);
  Mesh mesh;
  for (int i = 0; i < 200; ++i) {
    Vec3 p;
    for (double& x : p) {
      x = std::ldexp(unit(random), static_cast<int>(random() % 60) - 30);
      if (random() % 8 == 0) x = std::round(x);
      if (floats) x = static_cast<float>(x);
      if (!floats && random() % 16 == 0)
        x = std::ldexp(unit(random), static_cast<int>(random() % 2000) - 1000);
    }
    mesh.vertices.push_back(p);
  }
  mesh.vertices.push_back(Vec3(-0.0, 0.0, -0.0));
  for (int i = 0; i < 300; ++i) {
    const auto a = static_cast<std::uint32_t>(random() % 201);
    const auto b = static_cast<std::uint32_t>((a + 1 + random() % 100) % 201);
    const auto c = static_cast<std::uint32_t>((b + 1 + random() % 50) % 201);
    if (c != a) mesh.triangles.push_back({a, b, c});
  }
  return mesh;
}

bool same_bits(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (int k = 0; k < 3; ++k)
      if (std::bit_cast<std::uint64_t>(a[i][k]) != std::bit_cast<std::uint64_t>(b[i][k] + 0.0))
        return false;
  return true;
}

void expect_round_trip(const Mesh& mesh, Format format, const WriteOptions& options = {}) {
  const std::vector<char> bytes = serialise_mesh(mesh, format, options);
  EXPECT_EQ(bytes, serialise_mesh(mesh, format, options));
  const ReadResult back = parse_mesh(bytes, format, "round trip");
  EXPECT_TRUE(same_bits(soup(back.mesh), soup(mesh))) << static_cast<int>(format);
}

bool readable(Format format) {
  return std::ranges::any_of(readable_formats(), [&](const std::string& name) {
    return format_from_name(name) == format;
  });
}

TEST(Write, FloatsSurviveEveryFormat) {
  for (unsigned seed = 0; seed < 5; ++seed)
    for (const std::string& name : writable_formats()) {
      const Format format = *format_from_name(name);
      if (!readable(format)) continue;
      expect_round_trip(random_mesh(true, seed), format);
      expect_round_trip(random_mesh(true, seed), format, {true, "a comment \\"});
    }
}

TEST(Write, DoublesSurviveWhereHeld) {
  for (unsigned seed = 0; seed < 5; ++seed)
    for (const Format format :
         {Format::StlAscii, Format::Obj, Format::Ply, Format::PlyAscii, Format::Off}) {
      EXPECT_TRUE(holds_double(format));
      expect_round_trip(random_mesh(false, seed), format, {true, ""});
      if (format != Format::Ply) expect_round_trip(random_mesh(false, seed), format);
    }
}

TEST(Write, FloatFormatsRefuseDoublesByVertexAndRemedy) {
  Mesh mesh = tetrahedron();
  mesh.vertices.insert(mesh.vertices.begin(), Vec3(0.1, 0, 0));  // not used, so allowed
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& c : t) ++c;
  for (const double bad : {0.1, 1e39, 1e-50}) {
    mesh.vertices[3].y() = bad;
    for (const Format format : {Format::Stl, Format::Glb, Format::Ply}) {
      try {
        serialise_mesh(mesh, format);
        ADD_FAILURE();
      } catch (const Error& e) {
        EXPECT_EQ(e.code(), ErrorCode::OutputFailed);
        EXPECT_NE(std::string(e.what()).find("vertex 3"), std::string::npos) << e.what();
        EXPECT_NE(std::string(e.what()).find("double precision"), std::string::npos) << e.what();
      }
    }
  }
}

TEST(Write, InvalidMeshes) {
  const auto code = [](const Mesh& mesh, Format format) {
    try {
      serialise_mesh(mesh, format);
    } catch (const Error& e) {
      return e.code();
    }
    return ErrorCode::Internal;
  };
  Mesh mesh = tetrahedron();
  for (const Format format : {Format::Collada, Format::Gltf, Format::Vrml, Format::X3d})
    EXPECT_EQ(code(mesh, format), ErrorCode::InvalidArgument);
  EXPECT_EQ(code({}, Format::Ply), ErrorCode::InvalidArgument);
  mesh.vertices[0].x() = NAN;
  EXPECT_EQ(code(mesh, Format::Off), ErrorCode::InvalidArgument);
  mesh = tetrahedron();
  mesh.triangles[0][0] = 4;
  EXPECT_EQ(code(mesh, Format::Off), ErrorCode::InvalidArgument);
}

std::string text_of(const std::vector<char>& bytes) { return {bytes.begin(), bytes.end()}; }

TEST(Write, CommentsCannotBreakTheFile) {
  const WriteOptions options{false, "solid one\nv 1 2 3\r\nend_header\\"};
  for (const std::string& name : writable_formats()) {
    const Format format = *format_from_name(name);
    if (readable(format)) expect_round_trip(tetrahedron(), format, options);
  }
  EXPECT_NE(text_of(serialise_mesh(tetrahedron(), Format::Obj, {false, "by me"})).find("# by me"),
            std::string::npos);
  // A binary STL header must not look like the ASCII format.
  EXPECT_FALSE(text_of(serialise_mesh(tetrahedron(), Format::Stl, options)).starts_with("solid"));
}

TEST(Write, StlNormals) {
  Mesh mesh = tetrahedron();
  mesh.vertices.push_back(Vec3(2, 0, 0));
  mesh.triangles.push_back({0, 1, 4});  // no area
  const std::string ascii = text_of(serialise_mesh(mesh, Format::StlAscii));
  EXPECT_NE(ascii.find("facet normal 0 0 -1\n"), std::string::npos) << ascii;
  EXPECT_NE(ascii.find("facet normal 0.57735026 0.57735026 0.57735026\n"), std::string::npos)
      << ascii;
  EXPECT_NE(ascii.find("facet normal 0 0 0\n"), std::string::npos) << ascii;
  const std::vector<char> binary = serialise_mesh(mesh, Format::Stl);
  ASSERT_EQ(binary.size(), 84U + 50 * 5);
  float z = 0;
  std::memcpy(&z, binary.data() + 84 + 8, 4);
  EXPECT_EQ(z, -1.0F);
  for (const double tiny : {1e-30, 1e30}) {
    Mesh scaled = tetrahedron();
    for (Vec3& p : scaled.vertices) p *= tiny;
    EXPECT_NE(text_of(serialise_mesh(scaled, Format::StlAscii)).find("normal 0.57735026"),
              std::string::npos);
  }
}

TEST(Write, GlbIsValid) {
  for (const std::string comment : {"", "x", "xy", "xyz", "\xFF"}) {
    const std::vector<char> bytes = serialise_mesh(tetrahedron(), Format::Glb, {false, comment});
    const auto word = [&](std::size_t at) {
      std::uint32_t value = 0;
      std::memcpy(&value, bytes.data() + at, 4);
      return value;
    };
    EXPECT_EQ(word(0), 0x46546C67U);
    EXPECT_EQ(word(4), 2U);
    ASSERT_EQ(word(8), bytes.size());
    const std::uint32_t json_size = word(12);
    EXPECT_EQ(json_size % 4, 0U);
    EXPECT_EQ(word(20 + json_size) % 4, 0U);
    ASSERT_EQ(28 + json_size + word(20 + json_size), bytes.size());
    const auto json = nlohmann::json::parse(bytes.begin() + 20, bytes.begin() + 20 + json_size);
    EXPECT_EQ(json["asset"]["version"], "2.0");
    EXPECT_EQ(json["scenes"][json["scene"].get<int>()]["nodes"], nlohmann::json::array({0}));
    EXPECT_EQ(json["nodes"], nlohmann::json::parse(R"([{"mesh":0}])"));
    const auto& primitive = json["meshes"][0]["primitives"][0];
    EXPECT_EQ(primitive["mode"], 4);
    const auto& positions = json["accessors"][primitive["attributes"]["POSITION"].get<int>()];
    EXPECT_EQ(positions["componentType"], 5126);
    EXPECT_EQ(positions["type"], "VEC3");
    EXPECT_EQ(positions["count"], 4);
    EXPECT_EQ(positions["min"], nlohmann::json::parse("[0.0,0.0,0.0]"));
    EXPECT_EQ(positions["max"], nlohmann::json::parse("[1.0,1.0,1.0]"));
    const auto& indices = json["accessors"][primitive["indices"].get<int>()];
    EXPECT_EQ(indices["componentType"], 5125);
    EXPECT_EQ(indices["count"], 12);
    EXPECT_EQ(json["bufferViews"][1]["byteOffset"], 48);
    EXPECT_EQ(json["buffers"][0]["byteLength"], 96);
  }
}

TEST(Write, PlyAsciiStatesDoubleWhenFloatsDoNotDo) {
  Mesh mesh = tetrahedron();
  EXPECT_NE(text_of(serialise_mesh(mesh, Format::PlyAscii)).find("float x"), std::string::npos);
  mesh.vertices[1].x() = 0.1;
  EXPECT_NE(text_of(serialise_mesh(mesh, Format::PlyAscii)).find("double x"), std::string::npos);
}

TEST(Write, UnusedVerticesAreLeftOut) {
  Mesh mesh = tetrahedron();
  mesh.vertices.insert(mesh.vertices.begin() + 1, Vec3(NAN, 0, 0));
  for (Triangle& t : mesh.triangles)
    for (std::uint32_t& c : t) c += c > 0 ? 1 : 0;
  EXPECT_EQ(serialise_mesh(mesh, Format::Off), serialise_mesh(tetrahedron(), Format::Off));
}

}  // namespace
}  // namespace kaboum::io::test
