// Formats without a reader of ours: read by assimp, where it is asked for.

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

bool can_read() {
  const auto names = readable_formats();
  return std::ranges::find(names, "fbx") != names.end();
}

ReadResult import(const std::string& bytes, const std::string& name) {
  return parse_mesh({bytes.data(), bytes.size()}, Format::Assimp, name);
}

/// Reading fails, and the message names the file and holds each of `parts`.
void expect_refused(const std::string& bytes, const std::string& name,
                    const std::vector<std::string>& parts) {
  try {
    import(bytes, name);
    ADD_FAILURE() << "no error for " << name << ": " << bytes.substr(0, 200);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), ErrorCode::InvalidInput) << e.what();
    EXPECT_TRUE(std::string_view(e.what()).starts_with(name + ": ")) << e.what();
    for (const std::string& part : parts)
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos)
          << "'" << part << "' is not in: " << e.what();
  }
}

/// A block of 1 by 2 by 4.5 at (3, 0, -1), seen from outside counter-clockwise: all float32.
const std::array<std::array<float, 3>, 8> kBlock = {{{3, 0, -1},
                                                     {4, 0, -1},
                                                     {4, 2, -1},
                                                     {3, 2, -1},
                                                     {3, 0, 3.5},
                                                     {4, 0, 3.5},
                                                     {4, 2, 3.5},
                                                     {3, 2, 3.5}}};
const std::array<std::array<int, 4>, 6> kFaces = {
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};

std::string text_of(float x) {
  std::string text = std::to_string(x);
  while (text.ends_with('0')) text.pop_back();
  return text.ends_with('.') ? text + "0" : text;
}

std::string words(const std::array<float, 3>& p) {
  return text_of(p[0]) + " " + text_of(p[1]) + " " + text_of(p[2]);
}

// --- 3DS: chunks of a number, their size and what they hold ---

std::string chunk(std::uint16_t kind, const std::string& content) {
  std::string bytes;
  append(bytes, kind);
  append(bytes, static_cast<std::uint32_t>(6 + content.size()));
  return bytes + content;
}

std::string three_ds(const std::string& more_of_editor = "") {
  std::string points, faces;
  append(points, static_cast<std::uint16_t>(kBlock.size()));
  for (const auto& p : kBlock)
    for (const float x : p) append(points, x);
  append(faces, static_cast<std::uint16_t>(2 * kFaces.size()));
  for (const auto& q : kFaces)
    for (const auto& t : {std::array{q[0], q[1], q[2]}, std::array{q[0], q[2], q[3]}}) {
      for (const int corner : t) append(faces, static_cast<std::uint16_t>(corner));
      append(faces, std::uint16_t{7});
    }
  const std::string mesh = chunk(0x4100, chunk(0x4110, points) + chunk(0x4120, faces));
  return chunk(0x4D4D,
               chunk(0x3D3D, chunk(0x4000, std::string("block\0", 6) + mesh) + more_of_editor));
}

// --- AC3D: text ---

const std::string kAcHead =
    "AC3Db\nMATERIAL \"m\" rgb 1 1 1  amb 1 1 1  emis 0 0 0  spec 0 0 0  shi 10  trans 0\n"
    "OBJECT world\nkids 1\nOBJECT poly\nname \"block\"\n";

std::string ac3d(const std::string& more_surfaces = "", int more = 0) {
  std::string text = kAcHead + "numvert 8\n";
  for (const auto& p : kBlock) text.append(words(p)).append("\n");
  text.append("numsurf ").append(std::to_string(6 + more)).append("\n");
  for (const auto& q : kFaces) {
    text += "SURF 0x0\nmat 0\nrefs 4\n";
    for (const int corner : q) text.append(std::to_string(corner)).append(" 0 0\n");
  }
  return text + more_surfaces + "kids 0\n";
}

// --- DXF: text, a line for a number and one for its value ---

std::string dxf() {
  std::string text = "0\nSECTION\n2\nENTITIES\n";
  for (const auto& q : kFaces) {
    text += "0\n3DFACE\n8\n0\n";
    for (int corner = 0; corner < 4; ++corner)
      for (int axis = 0; axis < 3; ++axis)
        text.append(std::to_string(10 * (axis + 1) + corner))
            .append("\n")
            .append(text_of(kBlock[q[corner]][axis]))
            .append("\n");
  }
  return text + "0\nENDSEC\n0\nEOF\n";
}

// --- LWO: chunks of a name, their size and what they hold, the highest byte first ---

std::string iff(const std::string& name, const std::string& content) {
  std::string bytes = name;
  append(bytes, static_cast<std::uint32_t>(content.size()), true);
  return bytes + content;
}

std::string lwo(const std::string& more = "") {
  std::string points, polygons = "FACE";
  for (const auto& p : kBlock)
    for (const float x : p) append(points, x, true);
  for (const auto& q : kFaces) {
    append(polygons, std::uint16_t{4}, true);
    for (const int corner : q) append(polygons, static_cast<std::uint16_t>(corner), true);
  }
  std::string layer(16, '\0');  // its number, flags, pivot; no name
  layer += std::string(2, '\0');
  return iff("FORM", "LWO2" + iff("TAGS", std::string("s\0", 2)) + iff("LAYR", layer) +
                         iff("PNTS", points) + iff("POLS", polygons) + more);
}

// --- X: text ---

std::string direct_x(const std::string& more_of_mesh = "") {
  std::string text = "xof 0303txt 0032\nMesh block {\n8;\n";
  for (std::size_t i = 0; i < kBlock.size(); ++i) {
    for (const float x : kBlock[i]) text.append(text_of(x)).append(";");
    text += i + 1 < kBlock.size() ? ",\n" : ";\n";
  }
  text += "6;\n";
  for (std::size_t i = 0; i < kFaces.size(); ++i) {
    text += "4;";
    for (int k = 0; k < 4; ++k) text.append(std::to_string(kFaces[i][k])).append(k < 3 ? "," : ";");
    text += i + 1 < kFaces.size() ? ",\n" : ";\n";
  }
  return text + more_of_mesh + "}\n";
}

struct Imported {
  std::string name, bytes;
  /// Where assimp has the file's (x, y, z): formats whose z is up are turned, left-handed ones
  /// mirrored, and their faces reversed.
  Vec3 (*place)(double x, double y, double z);
  bool reversed;
};

std::vector<Imported> files() {
  const auto same = [](double x, double y, double z) { return Vec3(x, y, z); };
  const auto turned = [](double x, double y, double z) { return Vec3(x, z, -y); };
  const auto mirrored = [](double x, double y, double z) { return Vec3(x, y, -z); };
  return {{"block.3ds", three_ds(), turned, false},
          {"block.ac", ac3d(), same, false},
          {"block.dxf", dxf(), turned, false},
          {"block.lwo", lwo(), mirrored, true},
          {"block.x", direct_x(), mirrored, true}};
}

TEST(Imported, EveryVertexIsWhereTheFileHasIt) {
  if (!can_read()) return;
  for (const Imported& file : files()) {
    SCOPED_TRACE(file.name);
    const ReadResult r = import(file.bytes, file.name);
    EXPECT_EQ(r.format, Format::Assimp);
    EXPECT_TRUE(r.single_precision);
    EXPECT_EQ(r.unit, "");
    EXPECT_EQ(r.mesh.triangles.size(), 12U);
    const auto key = [](const Vec3& p) { return std::array{p.x(), p.y(), p.z()}; };
    std::set<std::array<double, 3>> expected, found;
    for (const auto& p : kBlock) expected.insert(key(file.place(p[0], p[1], p[2])));
    for (const Vec3& p : r.mesh.vertices) found.insert(key(p));
    EXPECT_EQ(found, expected);
    EXPECT_TRUE(is_closed_chain(r.mesh));
    double volume = 0;
    for (const Triangle& t : r.mesh.triangles)
      volume += r.mesh.vertices[t[0]].dot(r.mesh.vertices[t[1]].cross(r.mesh.vertices[t[2]])) / 6;
    EXPECT_EQ(std::round(volume), 9) << volume << (file.reversed ? " of a left-handed file" : "");
    EXPECT_TRUE(has_note(r, "Warning: assimp"));
    EXPECT_TRUE(has_note(r, "32-bit floats"));
    EXPECT_TRUE(has_note(r, "about the triangles that it delivered"));
  }
}

TEST(Imported, OnlyWhereItIsAskedFor) {
  EXPECT_EQ(format_of_file("a.STL", Format::Assimp), Format::Stl);  // what has a reader here
  EXPECT_EQ(format_of_file("a.fbx", Format::Assimp), Format::Fbx);
  EXPECT_EQ(format_of_file("a.3DS", Format::Assimp), Format::Assimp);
  EXPECT_EQ(format_of_file("a.3ds", Format::Obj), Format::Obj);
  EXPECT_FALSE(format_from_name("3ds") || format_from_name("assimp") || format_from_name(""));
  for (const std::string& extension : imported_extensions()) {
    EXPECT_FALSE(format_from_name(extension)) << extension;
    EXPECT_NE(route_to_assimp("a." + extension), "") << extension;
    EXPECT_EQ(format_of_file("a." + extension, Format::Assimp), Format::Assimp);
  }
  EXPECT_TRUE(std::ranges::is_sorted(imported_extensions()));
  EXPECT_EQ(route_to_assimp("a.stl"), "");
  const auto message = [](const char* file, std::optional<Format> stated) -> std::string {
    try {
      format_of_file(file, stated);
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::InvalidInput);
      return e.what();
    }
    return {};
  };
  EXPECT_NE(message("a.3ds", {}).find("a.3ds: "), std::string::npos);
  EXPECT_NE(message("a.3ds", {}).find("«importer=assimp»"), std::string::npos);
  EXPECT_EQ(message("a.lws", {}).find("assimp"), std::string::npos);
  EXPECT_NE(message("a.lws", Format::Assimp).find("3ds, ac, "), std::string::npos);
  EXPECT_NE(message("-", Format::Assimp).find("standard input: "), std::string::npos);
  try {
    read_mesh("no-such-file.3ds");
    ADD_FAILURE();
  } catch (const Error& e) {
    EXPECT_NE(std::string(e.what()).find("importer=assimp"), std::string::npos) << e.what();
  }
}

TEST(Imported, WithoutAssimpItIsNotBuilt) {
  if (can_read()) return;
  for (const Imported& file : files()) {
    try {
      import(file.bytes, file.name);
      ADD_FAILURE();
    } catch (const Error& e) {
      EXPECT_EQ(e.code(), ErrorCode::NotBuilt);
      EXPECT_NE(std::string(e.what()).find("KABOUM_WITH_ASSIMP"), std::string::npos) << e.what();
    }
  }
}

TEST(Imported, TheNameSaysTheFormat) {
  if (!can_read()) return;
  EXPECT_EQ(import(three_ds(), "A.B.3DS").mesh.triangles.size(), 12U);
  EXPECT_EQ(import(three_ds(), "folder/\xFF\"name.prj").mesh.triangles.size(), 12U);
  expect_refused(three_ds(), "standard input", {"by extensions"});
  expect_refused(three_ds(), "block.stl", {"by extensions"});
  expect_refused("", "block.3ds", {"empty"});
  expect_refused("this is no such file", "block.3ds", {"3ds"});
}

TEST(Imported, PointsAndLinesAreLeftOut) {
  if (!can_read()) return;
  const ReadResult r =
      import(ac3d("SURF 0x2\nmat 0\nrefs 3\n0 0 0\n1 0 0\n6 0 0\n", 1), "block.ac");
  EXPECT_EQ(r.mesh.triangles.size(), 12U);
  EXPECT_TRUE(has_note(r, "2 faces with fewer than three corners were ignored"));
  expect_refused(kAcHead + "numvert 1\n0 0 0\nkids 0\n", "point.ac", {"no triangles"});

  // Cut between two objects, or with surfaces that are more than stated.
  std::string two = ac3d();
  two.replace(two.find("kids 1"), 6, "kids 2");
  expect_refused(two, "cut.ac", {"more or fewer objects"});
  std::string five = ac3d();
  five.replace(five.find("numsurf 6"), 9, "numsurf 5");
  expect_refused(five, "five.ac", {"surfaces (numsurf)"});
}

TEST(Imported, SkinsAreRefused) {
  if (!can_read()) return;
  std::string weights = "SkinWeights {\n\"bone\";\n8;\n0,1,2,3,4,5,6,7;\n";
  for (int i = 0; i < 8; ++i) weights.append("1.0").append(i < 7 ? "," : ";\n");
  for (int i = 0; i < 16; ++i)
    weights.append(i % 5 == 0 ? "1.0" : "0.0").append(i < 15 ? "," : ";;\n");
  expect_refused(direct_x("XSkinMeshHeader {\n1;\n1;\n1;\n}\n" + weights + "}\n"), "block.x",
                 {"a mesh has a skin"});
}

// Of several groups of a RAW file assimp 5.2 puts only the last one into its scene.
TEST(Imported, ScenesWithALostPartAreRefused) {
  if (!can_read()) return;
  const std::string one = "0 0 0 1 0 0 0 1 0\n";
  EXPECT_EQ(import("a\n" + one, "a.raw").mesh.triangles.size(), 1U);
  expect_refused("a\n" + one + "b\n" + one, "two.raw", {"lost in the importer"});
}

TEST(Imported, WhatAssimpCallsAnErrorIsRefused) {
  if (!can_read()) return;
  // It goes on with the vertices and surfaces that there are.
  std::string text = ac3d();
  text.replace(text.find("numvert 8"), 9, "numvert 9");
  expect_refused(text, "block.ac", {"assimp says", "not all vertices"});
  // Of a picture nothing depends.
  const std::string texture =
      iff("SURF", std::string("s\0\0\0", 4) + std::string("BLOK\0\x0C", 6) +
                      std::string("PROC\0\2\0\0", 8) + std::string(4, '\0'));
  EXPECT_NO_THROW(import(lwo(texture), "block.lwo"));
}

TEST(Imported, WhatAssimpWarnsOfIsNoted) {
  if (!can_read()) return;
  std::string text = ac3d();
  text.replace(text.find("refs 4\n0 0 0"), 12, "refs 4\n8 0 0");  // a vertex that is not there
  const ReadResult r = import(text, "block.ac");
  EXPECT_TRUE(has_note(r, "assimp warns: 'AC3D: Invalid vertex reference'"));
}

TEST(Imported, VerticesThatAreNotFinite) {
  if (!can_read()) return;
  std::string bytes = three_ds();
  float nan = std::numeric_limits<float>::quiet_NaN();
  bytes.replace(bytes.find("block") + 6 + 6 + 6 + 2, sizeof nan,
                std::string(reinterpret_cast<const char*>(&nan), sizeof nan));
  expect_refused(bytes, "block.3ds", {"not finite"});
}

/// The number of triangles; 0 where an error, which names the file, says why it is not read.
std::size_t triangles_of(const std::string& bytes, const std::string& name) {
  try {
    const ReadResult r = import(bytes, name);
    EXPECT_FALSE(r.mesh.triangles.empty());
    for (const Vec3& p : r.mesh.vertices) EXPECT_TRUE(p.allFinite());
    return r.mesh.triangles.size();
  } catch (const Error& e) {
    EXPECT_NE(e.code(), ErrorCode::Internal);
    EXPECT_TRUE(std::string_view(e.what()).starts_with(name + ": ")) << e.what();
    return 0;
  }
}

TEST(Imported, NoPartOfAFileIsRead) {
  if (!can_read()) return;
  for (const Imported& file : files()) {
    const std::size_t step = 1 + file.bytes.size() / 150;
    for (std::size_t size = 0; size < file.bytes.size(); size += step) {
      const std::size_t found = triangles_of(file.bytes.substr(0, size), file.name);
      // Of AC3D and X the last lines and braces hold nothing.
      EXPECT_TRUE(found == 0 || (found == 12 && size + 8 > file.bytes.size()))
          << file.name << " cut to " << size << " bytes: " << found;
    }
  }
}

TEST(Imported, DamagedFilesGiveAMeshOrAnError) {
  if (!can_read()) return;
  std::mt19937_64 random(5);
  for (const Imported& file : files()) {
    std::size_t read = 0;
    constexpr std::size_t kRounds = 100;
    for (std::size_t round = 0; round < kRounds; ++round) {
      std::string bytes = file.bytes;
      for (std::size_t n = 1 + random() % 4; n > 0; --n) {
        const std::size_t at = random() % bytes.size();
        switch (random() % 4) {
          case 0:
            bytes[at] = static_cast<char>(bytes[at] ^ (1U << (random() % 8)));
            break;
          case 1:
            bytes[at] = static_cast<char>(random());
            break;
          case 2:
            bytes.erase(at, 1 + random() % 8);
            break;
          default:
            bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 16));
        }
      }
      if (triangles_of(bytes, file.name) > 0) ++read;
    }
    EXPECT_LT(read, kRounds) << file.name;
  }
}

TEST(Imported, NestedTooDeep) {
  if (!can_read()) return;
  std::string text = "AC3Db\n";
  for (int i = 0; i < 300'000; ++i) text += "OBJECT group\nkids 1\n";
  text += "OBJECT poly\nkids 0\n";
  expect_refused(text, "deep.ac", {});
}

}  // namespace
}  // namespace kaboum::io::test
