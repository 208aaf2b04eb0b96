// glTF: scenes, primitives and accessors of every kind read rightly, all else refused.

#include <kaboum/io/convex_io.h>
#include <unistd.h>

#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

constexpr int kInt8 = 5120, kUInt8 = 5121, kInt16 = 5122, kUInt16 = 5123, kUInt32 = 5125,
              kFloat = 5126;

/// A glTF file in the making: JSON and one buffer.
struct Gltf {
  Json json = {{"asset", {{"version", "2.0"}}},
               {"scene", 0},
               {"scenes", {{{"nodes", {0}}}}},
               {"nodes", {{{"mesh", 0}}}},
               {"meshes", Json::array()}};
  std::string data;

  /// A view of `stride` and `offset` bytes in between; returns its number.
  template <typename T>
  std::size_t view(const std::vector<T>& values) {
    const std::size_t at = data.size();
    for (const T x : values) append(data, x);
    json["bufferViews"].push_back(
        {{"buffer", 0}, {"byteOffset", at}, {"byteLength", data.size() - at}});
    data.resize((data.size() + 3) / 4 * 4, '\0');
    return json["bufferViews"].size() - 1;
  }
  template <typename T>
  std::size_t accessor(const std::vector<T>& values, int type, const char* shape,
                       const Json& more = Json::object()) {
    const std::size_t width = shape == std::string("SCALAR") ? 1 : shape[3] - '0';
    Json a = {{"bufferView", view(values)},
              {"componentType", type},
              {"count", values.size() / width},
              {"type", shape}};
    a.update(more);
    json["accessors"].push_back(a);
    return json["accessors"].size() - 1;
  }
  void primitive(std::size_t position, const Json& more = Json::object()) {
    Json p = {{"attributes", {{"POSITION", position}}}};
    p.update(more);
    if (json["meshes"].empty())
      json["meshes"].push_back({{"name", "m"}, {"primitives", Json::array()}});
    json["meshes"].back()["primitives"].push_back(p);
  }
  [[nodiscard]] std::string glb() const {
    Json with_buffer = json;
    if (!data.empty()) with_buffer["buffers"] = {{{"byteLength", data.size()}}};
    return glb_of(with_buffer.dump(), data);
  }
  [[nodiscard]] static std::string glb_of(std::string text, const std::string& binary) {
    text.resize((text.size() + 3) / 4 * 4, ' ');
    std::string bytes = "glTF";
    append(bytes, std::uint32_t{2});
    append(bytes, static_cast<std::uint32_t>(12 + 8 + text.size() +
                                             (binary.empty() ? 0 : 8 + binary.size())));
    append(bytes, static_cast<std::uint32_t>(text.size()));
    bytes += "JSON" + text;
    if (binary.empty()) return bytes;
    append(bytes, static_cast<std::uint32_t>(binary.size()));
    return bytes + std::string("BIN\0", 4) + binary;
  }
};

const std::vector<float> kSquare = {0, 0, 0, 2, 0, 0, 2, 2, 0, 0, 2, 0};

/// One triangle of floats, to be changed.
Gltf triangle() {
  Gltf g;
  g.primitive(g.accessor<float>({0, 0, 0, 2, 0, 0, 0, 2, 0}, kFloat, "VEC3"));
  return g;
}

std::vector<Vec3> read(const Gltf& g) { return soup(parse(g.glb(), Format::Glb).mesh); }

using Corners = std::vector<Vec3>;
const Corners kTriangle = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 0)};

void expect_refused(const Gltf& g, const std::vector<std::string>& parts,
                    ErrorCode code = ErrorCode::InvalidInput) {
  expect_error(g.glb(), Format::Glb, parts, code);
}

TEST(Gltf, QuantisedPositions) {
  const std::vector<int> raw = {0, 0, 0, 100, 0, 0, 0, 100, 0, 0, 0, 127};
  const auto check = [&]<typename T>(T, int type, double unit) {
    for (const bool normalised : {false, true}) {
      Gltf g;
      std::vector<T> values;
      for (std::size_t i = 0; i < raw.size(); ++i) {  // padded to four, as vertex data has to be
        values.push_back(static_cast<T>(raw[i]));
        if (i % 3 == 2) values.push_back(T{77});
      }
      g.json["extensionsUsed"] = g.json["extensionsRequired"] = {"KHR_mesh_quantization"};
      const std::size_t view = g.view(values);
      g.json["bufferViews"][view]["byteStride"] = 4 * sizeof(T);
      g.json["accessors"].push_back({{"bufferView", view},
                                     {"componentType", type},
                                     {"normalized", normalised},
                                     {"count", 4},
                                     {"type", "VEC3"},
                                     {"min", {0, 0, 0}},
                                     {"max", {100, 100, 127}}});
      g.primitive(0, {{"mode", 5}});
      g.json["nodes"][0]["scale"] = {4, 4, 4};
      const ReadResult r = parse(g.glb(), Format::Glb);
      EXPECT_EQ(soup(r.mesh)[1], Vec3(normalised ? 4 * (100 / unit) : 400, 0, 0)) << type;
      EXPECT_EQ(soup(r.mesh)[4].z(), normalised ? 4 * (127 / unit) : 508) << type;
      EXPECT_EQ(r.single_precision, !normalised);
      g.json["accessors"][0]["max"][2] = 126;
      expect_refused(g, {"accessors[0]", "max", "126", "127"});
      g.json["accessors"][0].erase("max");
      g.json.erase("extensionsUsed");
      g.json.erase("extensionsRequired");
      expect_refused(g, {"accessors[0]", "KHR_mesh_quantization"});
    }
  };
  check(std::int8_t{}, kInt8, 127);
  check(std::uint8_t{}, kUInt8, 255);
  check(std::int16_t{}, kInt16, 32767);
  check(std::uint16_t{}, kUInt16, 65535);
}

TEST(Gltf, NormalisedIntegersStayAboveMinusOne) {
  Gltf g;
  g.json["extensionsUsed"] = {"KHR_mesh_quantization"};
  g.primitive(g.accessor<std::int16_t>({-32768, 0, 0, 32767, 0, 0, 0, 32767, 0}, kInt16, "VEC3",
                                       {{"normalized", true}}));
  EXPECT_EQ(read(g), (Corners{Vec3(-1, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0)}));
}

TEST(Gltf, StripsFansAndLists) {
  const Vec3 a(0, 0, 0), b(2, 0, 0), c(2, 2, 0), d(0, 2, 0);
  for (const int mode : {4, 5, 6}) {
    Gltf g;
    const std::size_t p = g.accessor(kSquare, kFloat, "VEC3");
    const std::vector<std::uint8_t> list = {0, 1, 2, 0, 2, 3}, strip = {0, 1, 3, 2},
                                    fan = {0, 1, 2, 3};
    g.primitive(p, {{"mode", mode},
                    {"indices", g.accessor(mode == 4   ? list
                                           : mode == 5 ? strip
                                                       : fan,
                                           kUInt8, "SCALAR")}});
    const Corners expected = mode == 4   ? Corners{a, b, c, a, c, d}
                             : mode == 5 ? Corners{a, b, d, b, c, d}
                                         : Corners{b, c, a, c, d, a};
    EXPECT_EQ(read(g), expected) << mode;
  }
  Gltf g = triangle();
  g.json["meshes"][0]["primitives"][0]["mode"] = 7;
  expect_refused(g, {"meshes[0].primitives[0]", "mode 7"});
  g.json["meshes"][0]["primitives"][0]["mode"] = 1;
  expect_refused(g, {"no triangles"});
  g = triangle();
  g.primitive(0, {{"mode", 0}});
  EXPECT_TRUE(has_note(parse(g.glb(), Format::Glb), "lines or points"));
}

TEST(Gltf, IndicesOfEveryType) {
  const auto check = [&]<typename T>(T, int type) {
    Gltf g;
    const std::size_t p = g.accessor(kSquare, kFloat, "VEC3");
    g.primitive(p, {{"indices", g.accessor(std::vector<T>{2, 1, 0}, type, "SCALAR")}});
    EXPECT_EQ(read(g), (Corners{Vec3(2, 2, 0), Vec3(2, 0, 0), Vec3(0, 0, 0)}));
    Gltf bad;
    const std::size_t q = bad.accessor(kSquare, kFloat, "VEC3");
    bad.primitive(q, {{"indices", bad.accessor(std::vector<T>{2, 1, 4}, type, "SCALAR")}});
    expect_refused(bad, {"accessors[1]", "vertex 4", "4"});
  };
  check(std::uint8_t{}, kUInt8);
  check(std::uint16_t{}, kUInt16);
  check(std::uint32_t{}, kUInt32);
  Gltf g;
  const std::size_t p = g.accessor(kSquare, kFloat, "VEC3");
  g.primitive(p, {{"indices", g.accessor<std::int16_t>({0, 1, 2}, kInt16, "SCALAR")}});
  expect_refused(g, {"unsigned"});
}

TEST(Gltf, SparseAccessors) {
  for (const bool base : {true, false}) {
    Gltf g;
    const std::vector<float> zeros(9, 0.0F);
    const std::size_t v = g.view(zeros), i = g.view<std::uint16_t>({1, 2}),
                      w = g.view<float>({2, 0, 0, 0, 2, 0});
    g.json["accessors"].push_back({{"componentType", kFloat},
                                   {"count", 3},
                                   {"type", "VEC3"},
                                   {"max", {2, 2, 0}},
                                   {"sparse",
                                    {{"count", 2},
                                     {"indices", {{"bufferView", i}, {"componentType", kUInt16}}},
                                     {"values", {{"bufferView", w}}}}}});
    if (base) g.json["accessors"][0]["bufferView"] = v;
    g.primitive(0);
    EXPECT_EQ(read(g), kTriangle);
    Gltf bad = g;
    bad.json["accessors"][0]["sparse"]["count"] = 4;
    expect_refused(bad, {"accessors[0].sparse"});
    bad = g;
    bad.data[bad.json["bufferViews"][i]["byteOffset"].get<std::size_t>() + 2] = 1;
    expect_refused(bad, {"accessors[0].sparse.indices", "rise"});
    bad.json["accessors"][0].erase("sparse");
    bad.json["accessors"][0].erase("max");
    if (!base) expect_refused(bad, {"accessors[0]", "no data"});
    bad = g;
    bad.json["accessors"][0]["count"] = std::uint64_t{1} << 52U;
    expect_refused(bad, {"repeat"}, ErrorCode::LimitReached);
  }
}

TEST(Gltf, InterleavedAndOffset) {
  Gltf g;
  const std::size_t v = g.view<float>({9, 9, 0, 0, 0, 9, 9, 2, 0, 0, 9, 9, 0, 2, 0});
  g.json["bufferViews"][v]["byteStride"] = 20;
  g.json["accessors"].push_back({{"bufferView", v},
                                 {"byteOffset", 8},
                                 {"componentType", kFloat},
                                 {"count", 3},
                                 {"type", "VEC3"}});
  g.primitive(0);
  EXPECT_EQ(read(g), kTriangle);
  g.json["accessors"][0]["byteOffset"] = 12;
  expect_refused(g, {"accessors[0]", "beyond"});
  g.json["accessors"][0]["byteOffset"] = 8;
  for (const int stride : {4, 256}) {
    g.json["bufferViews"][v]["byteStride"] = stride;
    expect_refused(g, {"bufferViews[0]", "byteStride"});
  }
}

TEST(Gltf, StatedBounds) {
  Gltf g = triangle();
  g.json["accessors"][0]["min"] = {0, 0, 0};
  g.json["accessors"][0]["max"] = {2, 2, 0};
  EXPECT_EQ(read(g), kTriangle);
  g.json["accessors"][0]["max"] = {2, 2.5, 0};
  expect_refused(g, {"accessors[0]", "max", "2.5"});
  g.json["accessors"][0]["max"] = {2, 2};
  expect_refused(g, {"accessors[0].max"});
  // Statements in decimals mean the float nearest to them.
  Gltf tenth;
  tenth.primitive(tenth.accessor<float>({0.1F, 0, 0, 2, 0, 0, 0.3F, 2, 0}, kFloat, "VEC3",
                                        {{"min", {0.1, 0, 0}}}));
  EXPECT_EQ(read(tenth)[0].x(), double{0.1F});
}

TEST(Gltf, TransformsInDouble) {
  Gltf g = triangle();
  g.json["nodes"] = {{{"children", {1}}, {"translation", {0.1, 0, 0}}},
                     {{"mesh", 0}, {"scale", {-3, 3, 3}}, {"rotation", {0, 0, 1, 0}}}};
  const ReadResult r = parse(g.glb(), Format::Glb);
  // Turned by half about z and mirrored; the faces are turned back.
  ASSERT_EQ(r.mesh.vertices.size(), 3U);
  EXPECT_LT((soup(r.mesh)[0] - Vec3(0.1, -6, 0)).norm(), 1e-15);
  EXPECT_LT((soup(r.mesh)[1] - Vec3(6.1, 0, 0)).norm(), 1e-15);
  EXPECT_EQ(soup(r.mesh)[2], Vec3(0.1, 0, 0));
  EXPECT_TRUE(has_note(r, "double"));
  EXPECT_TRUE(has_note(r, "mirror"));
  g = triangle();
  g.json["nodes"][0]["matrix"] = {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1};
  EXPECT_EQ(read(g), (Corners{Vec3(5, 6, 7), Vec3(5, 8, 7), Vec3(3, 6, 7)}));
  g.json["nodes"][0]["matrix"][3] = 0.5;
  expect_refused(g, {"nodes[0].matrix", "last row"});
  g.json["nodes"][0]["matrix"][3] = 0;
  g.json["nodes"][0]["scale"] = {1, 1, 1};
  expect_refused(g, {"nodes[0]"});
  for (const Json& bad : {Json{0, 0, 0, 0}, Json{0, 0, 0, 2}, Json{0, 0, 1}, Json{"0", 0, 0, 1}}) {
    g = triangle();
    g.json["nodes"][0]["rotation"] = bad;
    expect_refused(g, {"nodes[0].rotation"});
  }
  g = triangle();
  g.json["nodes"][0]["scale"] = {1e300, 1, 1};
  g.json["nodes"][0]["translation"] = {1e308, 0, 0};
  EXPECT_NO_THROW(read(g));
  g.json["nodes"][0]["scale"] = {1e308, 1, 1};
  expect_refused(g, {"range"});
}

TEST(Gltf, Instances) {
  Gltf g = triangle();
  const std::size_t t = g.accessor<float>({0, 0, 0, 3, 0, 0}, kFloat, "VEC3"),
                    s = g.accessor<float>({1, 1, 1, 2, 2, 2}, kFloat, "VEC3"),
                    r = g.accessor<std::int8_t>({0, 0, 0, 127, 0, 0, 127, 0}, kInt8, "VEC4",
                                                {{"normalized", true}});
  g.json["extensionsUsed"] = {"EXT_mesh_gpu_instancing"};
  g.json["nodes"][0]["translation"] = {0, 0, 10};
  g.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {
      {"TRANSLATION", t}, {"ROTATION", r}, {"SCALE", s}};
  for (const bool required : {false, true}) {
    if (required) g.json["extensionsRequired"] = {"EXT_mesh_gpu_instancing"};
    const Corners c = read(g);
    ASSERT_EQ(c.size(), 6U);
    EXPECT_EQ(c[1], Vec3(2, 0, 10));
    EXPECT_EQ(c[3], Vec3(3, 0, 10));
    EXPECT_LT((c[4] - Vec3(-1, 0, 10)).norm(), 1e-15);
  }
  const std::string glb = g.glb();
  EXPECT_EQ(parse_convex_set(glb, Format::Glb, "sample").bodies.size(), 2U);
  Gltf bad = g;
  bad.json["accessors"][s]["count"] = 1;
  expect_refused(bad, {"differ"});
  bad = g;
  bad.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = Json::object();
  expect_refused(bad, {"instances"});
  bad = g;
  bad.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"]["MATRIX"] = t;
  expect_refused(bad, {"MATRIX"});
}

TEST(Gltf, InstancesCannotMultiplyWithoutEnd) {
  Gltf g;
  const std::vector<float> zeros(30'000, 1.0F);
  const std::size_t p = g.accessor(zeros, kFloat, "VEC3");
  g.primitive(p, {{"mode", 5}});
  g.json["nodes"][0]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"] = {{"SCALE", p}};
  expect_refused(g, {"repeat"}, ErrorCode::LimitReached);
}

TEST(Gltf, ExtensionsThatMayHoldGeometryAreRefused) {
  for (const char* name : {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                           "KHR_meshopt_compression", "VENDOR_shapes"}) {
    Gltf g = triangle();
    g.json["extensionsRequired"] = {name};
    expect_refused(g, {name});
  }
  const auto with = [](const Json::json_pointer& where, const char* name) {
    Gltf g = triangle();
    g.json[where]["extensions"][name] = Json::object();
    return g;
  };
  for (const char* where : {"", "/scenes/0", "/nodes/0", "/meshes/0", "/meshes/0/primitives/0",
                            "/accessors/0", "/bufferViews/0"}) {
    expect_refused(with(Json::json_pointer(where), "VENDOR_shapes"), {"VENDOR_shapes"});
    EXPECT_EQ(read(with(Json::json_pointer(where), "KHR_materials_unlit")), kTriangle);
  }
  for (const char* name : {"KHR_physics_rigid_bodies", "OMI_physics_body"})
    expect_refused(with(Json::json_pointer("/nodes/0"), name), {name});
  // What begins like harmless ones, and what moves nodes.
  for (const char* name :
       {"AGI_articulations", "KHR_texture_geometry_displace", "KHR_materials_displacement",
        "EXT_materials_shells", "EXT_texture_relief", "ADOBE_materials_", "MSFT_texture_",
        "MSFT_packing_vertices", "KHR_lights_solid", "KHR_audio_shape", "KHR_animation_rig",
        "KHR_xmp_mesh"}) {
    Gltf required = triangle();
    required.json["extensionsRequired"] = {name};
    expect_refused(required, {name});
    expect_refused(with(Json::json_pointer("/nodes/0"), name), {name});
  }
  Gltf g = triangle();
  g.json["extensionsRequired"] = {"KHR_texture_basisu"};
  EXPECT_EQ(read(g), kTriangle);
  // Compressed data beside plain data is not needed; without plain data the file is refused.
  g = with(Json::json_pointer("/meshes/0/primitives/0"), "KHR_draco_mesh_compression");
  EXPECT_EQ(read(g), kTriangle);
  g.json["accessors"][0].erase("bufferView");
  expect_refused(g, {"accessors[0]", "no data"});
  g = with(Json::json_pointer("/nodes/0"), "KHR_node_visibility");
  EXPECT_EQ(read(g), kTriangle);
  g.json["nodes"][0]["extensions"]["KHR_node_visibility"]["visible"] = false;
  expect_refused(g, {"invisible"});
}

TEST(Gltf, SkinsAndMorphs) {
  Gltf g = triangle();
  g.json["nodes"][0]["skin"] = 0;
  expect_refused(g, {"nodes[0]", "skin"});
  g = triangle();
  g.json["meshes"][0]["primitives"][0]["targets"] = {{{"POSITION", 0}}};
  EXPECT_TRUE(has_note(parse(g.glb(), Format::Glb), "Morph"));
  for (const char* where : {"/nodes/0/weights", "/meshes/0/weights"}) {
    Gltf bad = g;
    bad.json[Json::json_pointer(where)] = {0};
    EXPECT_EQ(read(bad), kTriangle);
    bad.json[Json::json_pointer(where)] = {0.5};
    expect_refused(bad, {"weights", "morphed"});
  }
}

TEST(Gltf, Scenes) {
  Gltf g = triangle();
  g.json["nodes"] = {{{"mesh", 0}}, {{"mesh", 0}, {"translation", {5, 0, 0}}}};
  g.json["scenes"] = {{{"nodes", {0}}}, {{"nodes", {1}}}, {{"nodes", {0, 1}}}};
  g.json["scene"] = 1;
  EXPECT_EQ(read(g)[0], Vec3(5, 0, 0));
  EXPECT_TRUE(has_note(parse(g.glb(), Format::Glb), "3 scenes"));
  EXPECT_TRUE(has_note(parse(g.glb(), Format::Glb), "1 further node with a mesh"));
  g.json["scene"] = 2;
  EXPECT_EQ(read(g).size(), 6U);  // all roots
  EXPECT_FALSE(has_note(parse(g.glb(), Format::Glb), "further node"));
  g.json.erase("scene");
  expect_refused(g, {"3 scenes"});
  g.json["scene"] = 3;
  expect_refused(g, {"number 3 of 3 scenes"});
  g.json.erase("scene");
  g.json.erase("scenes");
  expect_refused(g, {"no scene"});
  g.json.erase("nodes");
  EXPECT_EQ(read(g), kTriangle);
  g = triangle();
  g.json["meshes"].push_back(g.json["meshes"][0]);
  EXPECT_TRUE(has_note(parse(g.glb(), Format::Glb), "1 mesh that the scene does not show"));
  g.json["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"mesh", 1}, {"children", {0}}}};
  expect_refused(g, {"twice"});
  g.json["scenes"][0]["nodes"] = {1, 1};
  expect_refused(g, {"twice"});
  g = triangle();
  for (std::size_t i = 0; i < 1200; ++i) g.json["nodes"].push_back({{"children", {i + 2}}});
  g.json["nodes"].push_back({{"mesh", 0}});
  g.json["scenes"][0]["nodes"] = {1};
  expect_refused(g, {"deep"});
}

TEST(Gltf, BuffersInDataUrisAndFiles) {
  Gltf g = triangle();
  const std::string data = g.data;
  const auto text = [&](const std::string& uri, std::size_t length) {
    Json json = g.json;
    json["buffers"] = {{{"uri", uri}, {"byteLength", length}}};
    return json.dump();
  };
  // 36 bytes: two floats of 2.0 (00 00 00 40) among zeros.
  const std::string base64 = "AAAAAAAAAAAAAAAAAAAAQAAAAAAAAAAAAAAAAAAAAEAAAAAA";
  const std::string uri = "data:application/octet-stream;base64," + base64;
  EXPECT_EQ(soup(parse(text(uri, 36), Format::Gltf).mesh), kTriangle);
  expect_error(text(uri, 37), Format::Gltf, {"buffers[0]", "37"});
  expect_error(text(uri.substr(0, 60) + "*" + uri.substr(61), 36), Format::Gltf, {"base64"});
  expect_error(text("data:application/octet-stream,xx", 36), Format::Gltf, {"base64"});
  const fs::path directory =
      fs::path(::testing::TempDir()) / ("kaboum-gltf-uri-" + std::to_string(::getpid()));
  fs::create_directories(directory / "inner");
  std::ofstream(directory / "inner/a b.bin", std::ios::binary) << data;
  std::ofstream(directory / "out.bin", std::ios::binary) << data;
  const ReadResult r = parse(text("inner/a%20b.bin", 36), Format::Gltf, directory);
  EXPECT_EQ(soup(r.mesh), kTriangle);
  EXPECT_TRUE(has_note(r, "a b.bin"));
  EXPECT_EQ(r.other_files, std::vector{(directory / "inner/a b.bin").string()});
  EXPECT_NO_THROW(parse(text("./out.bin", 36), Format::Gltf, directory));
  const std::string absolute = (directory / "out.bin").string();
  for (const std::string& bad : {std::string("../out.bin"), std::string("inner/../../out.bin"),
                                 absolute, "file://" + absolute, std::string("http://x/out.bin"),
                                 std::string("%2E%2E/out.bin"), std::string("%zz"), std::string()})
    EXPECT_THROW(parse(text(bad, 36), Format::Gltf, directory / "inner"), Error) << bad;
  expect_error(text("absent.bin", 36), Format::Gltf, {"folder"});
  EXPECT_THROW(parse(text("absent.bin", 36), Format::Gltf, directory), Error);
  fs::remove_all(directory);
}

TEST(Gltf, NoGeometryIsLostOrMerged) {
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
  expect_error(points, Format::Gltf, {"data.bin"});
  fs::remove_all(directory);
}

TEST(Gltf, GlbOfOurs) {
  const std::vector<char> bytes = serialise_mesh(tetrahedron(), Format::Glb);
  const ReadResult r = parse_mesh(bytes, Format::Glb, "ours");
  EXPECT_EQ(soup(r.mesh), soup(tetrahedron()));
}

TEST(Gltf, HostileJson) {
  for (const char* bad : {"-1", "0.5", "1e300", "\"0\"", "null", "[]", "{}", "99", "true",
                          "18446744073709551615", "9007199254740993"}) {
    for (const char* where :
         {"/scene", "/nodes/0/mesh", "/scenes/0/nodes/0",
          "/meshes/0/primitives/0/attributes/POSITION", "/accessors/0/count",
          "/accessors/0/componentType", "/accessors/0/bufferView", "/bufferViews/0/buffer",
          "/bufferViews/0/byteOffset", "/bufferViews/0/byteLength", "/accessors/0/byteOffset",
          "/meshes", "/nodes", "/accessors", "/scenes", "/asset", "/extensionsRequired"}) {
      Gltf g = triangle();
      g.json[Json::json_pointer(where)] = Json::parse(bad);
      try {
        parse(g.glb(), Format::Glb);
        // An empty list of what the file does not need.
        EXPECT_TRUE((bad == std::string("[]") && where == std::string("/extensionsRequired")))
            << where << " " << bad;
      } catch (const Error& e) {
        EXPECT_TRUE(e.code() == ErrorCode::InvalidInput || e.code() == ErrorCode::LimitReached);
        EXPECT_TRUE(std::string_view(e.what()).starts_with("sample: ")) << e.what();
      }
    }
  }
  expect_error(std::string(1'000'000, '['), Format::Gltf, {"nested"});
  expect_error(R"({"asset":{"version":"2.0"},"scene":0,"scene":1})", Format::Gltf,
               {"'scene' twice"});
  expect_error(R"({"asset":{"version":"1.0"}})", Format::Gltf, {"'1.0'"});
  expect_error(R"({"asset":{"version":"2.0","minVersion":"2.1"}})", Format::Gltf, {"'2.1'"});
  expect_error("{}", Format::Gltf, {"'asset' is missing"});
  expect_error("[1]", Format::Gltf, {"not an object"});
}

TEST(Gltf, Chunks) {
  const std::string good = triangle().glb();
  EXPECT_NO_THROW(parse(good, Format::Glb));
  EXPECT_NO_THROW(parse(good, Format::Gltf));  // known by its first bytes
  EXPECT_TRUE(has_note(parse(good + "xyz", Format::Glb), "3 bytes after"));
  for (std::size_t n = 0; n < good.size(); ++n)
    EXPECT_THROW(parse(good.substr(0, n), Format::Glb), Error) << n;
  const std::string part = good.substr(12);
  std::string twice = good + part;
  const auto size = static_cast<std::uint32_t>(twice.size());
  std::memcpy(twice.data() + 8, &size, 4);
  expect_error(twice, Format::Glb, {"second chunk"});
}

TEST(Gltf, ARecordIsNeverLost) {
  geom::ConvexSet set;
  set.bodies = {{"a", tetrahedron()}, {"b", tetrahedron()}};
  set_margin(set, 0.5);
  const std::vector<char> bytes = serialise_convex_set(set, SetFormat::Glb);
  const std::string glb(bytes.begin(), bytes.end());
  expect_error(glb, Format::Glb, {"margin"});  // as a mesh
  const auto changed = [&](const Json::json_pointer& where, const Json& value) {
    std::uint32_t length = 0;
    std::memcpy(&length, glb.data() + 12, 4);
    Json json = Json::parse(glb.substr(20, length));
    json[where] = value;
    return Gltf::glb_of(json.dump(), glb.substr(20 + length + 8));
  };
  SetReadDetails details;
  const auto read_set = [&](const std::string& b) {
    return parse_convex_set(b, Format::Glb, "sample", &details);
  };
  EXPECT_EQ(margin_of(read_set(glb)), 0.5);
  // The identity says nothing; the record holds.
  EXPECT_EQ(margin_of(read_set(changed(Json::json_pointer("/nodes/0/matrix"),
                                       {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}))),
            0.5);
  EXPECT_EQ(margin_of(read_set(changed(Json::json_pointer("/nodes/0/translation"), {0, 0, 0}))),
            0.5);
  EXPECT_THROW(read_set(changed(Json::json_pointer("/nodes/0/translation"), {0, 0, 1})), Error);
  EXPECT_THROW(read_set(changed(Json::json_pointer("/nodes/1/scale"), {2, 2, 2})), Error);
  // Without a margin a set is a mesh, too.
  set_margin(set, 0);
  const std::vector<char> plain = serialise_convex_set(set, SetFormat::Glb);
  EXPECT_EQ(parse_mesh(plain, Format::Glb, "sample").mesh.triangles.size(), 8U);
}

TEST(Gltf, SetsOfOtherPrograms) {
  Gltf g = triangle();
  g.json["meshes"][0].erase("name");
  g.json["nodes"] = {{{"mesh", 0}, {"name", "x"}}, {{"mesh", 0}, {"translation", {5, 0, 0}}}};
  g.json["scenes"][0]["nodes"] = {0, 1};
  SetReadDetails details;
  const geom::ConvexSet set = parse_convex_set(g.glb(), Format::Glb, "sample", &details);
  ASSERT_EQ(set.bodies.size(), 2U);
  EXPECT_EQ(set.bodies[0].name, "x");
  EXPECT_EQ(set.bodies[1].name, "body-0001");
  EXPECT_EQ(soup(set.bodies[1].core)[0], Vec3(5, 0, 0));
  EXPECT_FALSE(details.has_record);
}

}  // namespace
}  // namespace kaboum::io::test
