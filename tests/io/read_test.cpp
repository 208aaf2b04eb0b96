#include <cmath>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

// --- numbers and merging, which all text formats share ---

double first_coordinate(const std::string& number) {
  return parse("v " + number + " 0 7\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", Format::Obj)
      .mesh.vertices[0]
      .x();
}

TEST(Numbers, AreTheNearestDoubles) {
  EXPECT_EQ(first_coordinate("0.1"), 0.1);
  EXPECT_EQ(first_coordinate("+1.5"), 1.5);
  EXPECT_EQ(first_coordinate("1."), 1.0);
  EXPECT_EQ(first_coordinate(".5"), 0.5);
  EXPECT_EQ(first_coordinate("-.5e-1"), -0.05);
  EXPECT_EQ(first_coordinate("1E+2"), 100.0);
  EXPECT_EQ(first_coordinate("0.1000000000000000055511151231257827"), 0.1);
  EXPECT_EQ(first_coordinate("9007199254740993"), 9007199254740992.0);
}

TEST(Numbers, UnderflowToZeroOrSubnormal) {
  EXPECT_EQ(first_coordinate("1e-400"), 0.0);
  EXPECT_EQ(first_coordinate("-1e-400"), 0.0);
  EXPECT_EQ(first_coordinate("1e-99999999999999999999"), 0.0);
  EXPECT_EQ(first_coordinate("0." + std::string(400, '0') + "1"), 0.0);
  EXPECT_EQ(first_coordinate("0e999999999999"), 0.0);
  EXPECT_EQ(first_coordinate("4.9e-324"), 4.9406564584124654e-324);
}

TEST(Numbers, OverflowAndNonFiniteNameLineAndValue) {
  for (const char* bad : {"1e400", "-1e400", "1e99999999999999999999", "nan", "inf", "-Infinity"})
    expect_error(std::string("v 0 0 0\nv ") + bad + " 0 0\n", Format::Obj,
                 {"line 2", bad, "finite"});
  expect_error("v " + std::string(400, '9') + " 0 0\n", Format::Obj, {"line 1", "finite"});
  for (const char* bad : {"1,5", "1.5x", "0x10", "+-1", "--1", "e5", "1e"})
    expect_error(std::string("v ") + bad + " 0 0\n", Format::Obj, {"line 1", bad, "not a number"});
}

TEST(Welding, MergesEqualPositionsInOrderOfFirstUse) {
  const ReadResult r = parse(
      "v 9 9 9\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv -0 0 -0.0\nv 0 0 1\nf 3 4 2\nf 5 6 4\n", Format::Obj);
  EXPECT_EQ(r.file_vertices, 6U);
  ASSERT_EQ(r.mesh.vertices.size(), 4U);
  EXPECT_EQ(r.mesh.vertices[0], Vec3(0, 0, 0));
  EXPECT_FALSE(std::signbit(r.mesh.vertices[0].x()));
  EXPECT_EQ(r.mesh.vertices[1], Vec3(1, 0, 0));
  EXPECT_EQ(r.mesh.vertices[2], Vec3(0, 1, 0));
  EXPECT_EQ(r.mesh.triangles[1], (Triangle{0, 3, 1}));
  EXPECT_TRUE(has_note(r, "1 vertex that no face uses"));
}

// What is an edge or corner of others goes; a segment or point apart stays, once.
TEST(Welding, CollapsedTrianglesAreEdgesOrStay) {
  const std::string v = "v 5 5 5\nv 0 0 0\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\n";
  const ReadResult r = parse(v + "f 2 3 4\nf 2 4 5\nf 4 4 2\nf 5 5 5\nf 2 4 2 4\n", Format::Obj);
  EXPECT_EQ(r.file_triangles, 6U);
  EXPECT_EQ(r.collapsed_triangles, 5U);
  EXPECT_EQ(r.mesh.triangles.size(), 1U);
  EXPECT_EQ(r.mesh.vertices.size(), 3U);
  EXPECT_FALSE(has_note(r, "equal corners"));
  // A segment with one end of its own, twice; a point; a quadrilateral that is a segment; the ends
  // of segments.
  const ReadResult apart =
      parse(v + "f 2 4 5\nf 1 1 2\nf 2 1 2\nf 6 6 6\nf 4 6 6 4\nf 1 1 1\n", Format::Obj);
  EXPECT_EQ(apart.file_triangles, 7U);
  EXPECT_EQ(apart.mesh.triangles.size(), 3U);
  EXPECT_EQ(apart.mesh.vertices.size(), 5U);
  EXPECT_EQ(apart.collapsed_triangles, 4U);
  EXPECT_TRUE(has_note(apart, "2 triangles with equal corners are segments or points"));
  const ReadResult point = parse(v + "f 2 4 5\nf 6 6 6\nf 6 6 6\n", Format::Obj);
  EXPECT_EQ(point.mesh.triangles.size(), 2U);
  EXPECT_EQ(point.mesh.vertices.size(), 4U);
  EXPECT_TRUE(has_note(point, "1 triangle with equal corners is a segment or point"));
  expect_error("v 0 0 0\nv 1 1 1\nf 1 1 2\n", Format::Obj, {"no triangles", "equal corners"});
}

// --- STL ---

constexpr std::string_view kAsciiStl =
    "solid a name\n facet normal nan nan nan\n  outer loop\n   vertex 0 0 0\n   vertex 1e0 0 0\n"
    "   VERTEX 0 1 0.1\n  endloop\n endfacet\nendsolid a name\n";

TEST(Stl, Ascii) {
  const ReadResult r = parse(kAsciiStl, Format::Stl);
  EXPECT_EQ(r.format, Format::Stl);
  EXPECT_FALSE(r.single_precision);
  EXPECT_EQ(r.file_vertices, 3U);
  EXPECT_EQ(soup(r.mesh), (std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0.1)}));
  const std::string twice = std::string(kAsciiStl) + std::string(kAsciiStl);
  EXPECT_EQ(parse(twice, Format::StlAscii).mesh.triangles.size(), 2U);
  std::string windows(kAsciiStl);
  for (std::size_t at = 0; (at = windows.find('\n', at)) != std::string::npos; at += 2)
    windows.replace(at, 1, "\r\n");
  EXPECT_EQ(soup(parse(windows, Format::Stl).mesh), soup(r.mesh));
  EXPECT_EQ(soup(parse("\xEF\xBB\xBF" + windows, Format::Stl).mesh), soup(r.mesh));
}

TEST(Stl, AsciiErrors) {
  expect_error("solid x\nendsolid x\n", Format::Stl, {"no triangles"});
  expect_error("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0\n", Format::Stl,
               {"line 5", "truncated"});
  expect_error("solid x\nfacet normal 0 0 1\nouter lop\n", Format::Stl,
               {"line 3", "'lop'", "'loop'"});
  expect_error("solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 1e999\n", Format::Stl,
               {"line 4", "1e999"});
}

TEST(Stl, BinaryEvenWhenItBeginsWithSolid) {
  const std::vector<std::array<float, 9>> facets = {{0, 0, 0, 1, 0, 0, 0, 0.1F, -0.0F},
                                                    {0, 0, 0, 0, 0.1F, 0, 0, 0, 1}};
  for (const char* header : {"x", "solid", "solid facet normal\nfacet"}) {
    const ReadResult r = parse(binary_stl(facets, header), Format::Stl);
    EXPECT_TRUE(r.single_precision);
    EXPECT_EQ(r.file_vertices, 6U);
    EXPECT_EQ(r.mesh.vertices.size(), 4U);
    EXPECT_EQ(r.mesh.vertices[2], Vec3(0, 0.1F, 0));
    EXPECT_EQ(r.mesh.triangles[1], (Triangle{0, 2, 3}));
  }
  EXPECT_TRUE(has_note(parse(binary_stl(facets) + "tail", Format::Stl), "4 bytes after"));
  EXPECT_TRUE(has_note(parse(binary_stl(facets, "solid") + "tail", Format::Stl), "4 bytes after"));
}

TEST(Stl, BinaryErrors) {
  std::string huge = binary_stl({{0, 0, 0, 1, 0, 0, 0, 1, 0}});
  huge.replace(80, 4, std::string("\0\0\0\x80", 4));
  expect_error(huge, Format::Stl, {"2147483648 triangles", "107374182484", "134", "truncated"});
  expect_error(binary_stl({}), Format::Stl, {"no triangles"});
  expect_error("abc", Format::Stl, {"84"});
  const float inf = INFINITY;
  expect_error(binary_stl({{0, 0, 0, 1, 0, 0, 0, 1, inf}}), Format::Stl, {"byte 120", "finite"});
}

// --- OBJ ---

TEST(Obj, IndicesSlashesPolygonsAndContinuation) {
  const ReadResult r = parse(
      "# comment ending in a backslash \\\nmtllib x.mtl\no thing\n"
      "v 0 0 0 1.0\nv 1 0 \\\n 0 0.5 0.5 0.5\nvt 0 0\nvn nan 0 1\nv 1 1 0\nv 0 1 0\n"
      "f 1/1/1 2//1 3/1 \\\r\n 4\ns off\nf -4 -2 -1 # comment\n",
      Format::Obj);
  EXPECT_EQ(r.file_vertices, 4U);
  EXPECT_EQ(r.split_polygons, 1U);
  ASSERT_EQ(r.mesh.triangles.size(), 3U);
  EXPECT_EQ(r.mesh.triangles[0], (Triangle{0, 1, 2}));
  EXPECT_EQ(r.mesh.triangles[1], (Triangle{0, 2, 3}));
  EXPECT_EQ(r.mesh.triangles[2], (Triangle{0, 2, 3}));
  expect_error("v 0 0 0\nv 1 0 0\nf 1 2\n", Format::Obj, {"line 3", "fewer than three corners"});
}

// A name may end with a backslash; nothing is lost by it.
TEST(Obj, BackslashesSwallowNoStatement) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\n";
  for (const char* statement :
       {"g C:\\a\\\n", "o x \\\n", "usemtl y\\\r\n", "mtllib \\\n", "vn 0 0 1 \\\n", "vt 0 0\\\n",
        "l 1 2 \\\n", "p 1 \\\n 2 \\\n", "s 1\\\n", "curv 0 1 1 2\\\n"}) {
    const ReadResult r = parse(v + statement + "f 1 2 3\nf 1 2 4\n", Format::Obj);
    EXPECT_EQ(r.mesh.triangles.size(), 2U) << statement;
    EXPECT_TRUE(has_note(r, std::string(statement).starts_with("p") ? "line 6" : "line 5"))
        << statement;
    EXPECT_TRUE(has_note(r, "backslash")) << statement;
  }
  // What is no statement belongs to the line before.
  const ReadResult r = parse(v + "g a \\\n b c\nparm u 0 \\\n 1 2 \\\n3\nf 1 2 3\n", Format::Obj);
  EXPECT_EQ(r.mesh.triangles.size(), 1U);
  EXPECT_FALSE(has_note(r, "backslash"));
  // In a vertex or a face it does as well: nothing is left out without a word.
  expect_error("v 0 0 0 \\\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\n", Format::Obj,
               {"line 2", "'v'", "backslash"});
  expect_error(v + "f 1 2 3 \\\nf 1 2 4\n", Format::Obj, {"line 6", "'f'"});
  expect_error("v 0 0 0 1 x 1\n", Format::Obj, {"line 1", "'x'"});
  EXPECT_EQ(parse(v + "# C:\\a\\\nf 1 2 3\n", Format::Obj).mesh.triangles.size(), 1U);
  EXPECT_EQ(parse(v + "g x # C:\\a\\\nf 1 2 3\n", Format::Obj).mesh.triangles.size(), 1U);
}

TEST(Obj, FacesMayComeBeforeVertices) {
  EXPECT_EQ(parse("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0", Format::Obj).mesh.triangles.size(), 1U);
}

TEST(Obj, Errors) {
  const std::string v = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  expect_error(v + "f 1 2 4\n", Format::Obj, {"line 4", "vertex 4", "there are 3"});
  expect_error(v + "f 0 1 2\n", Format::Obj, {"line 4", "vertex 0"});
  expect_error(v + "f 1 2 -4\n", Format::Obj, {"line 4", "vertex -4"});
  expect_error(v + "f 1 2 99999999999\n", Format::Obj, {"line 4", "99999999999"});
  expect_error(v + "f 1 2 4294967295\n", Format::Obj, {"line 4", "4294967295"});
  expect_error(v + "f 1 2 99999999999999999999\n", Format::Obj, {"line 4", "not an integer"});
  expect_error(v + "f 1 2 x\n", Format::Obj, {"line 4", "'x'", "not an integer"});
  expect_error("v 0 0\n", Format::Obj, {"line 1", "fewer than three"});
  expect_error("# nothing\n", Format::Obj, {"no triangles"});
}

// --- OFF ---

TEST(Off, HeadersCommentsAndColours) {
  const std::vector<Vec3> expected = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0.1)};
  for (const char* text :
       {"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 .1\n3 0 1 2\n", "OFF 3 1 0\n0 0 0\n1 0 0\n0 1 .1\n3 0 1 2",
        "# c\nOFF # c\n# c\n3 1 # c\n\n0 0 0 # c\n1 0 0\n# c\n0 1 .1\n3 0 1 2 255 0 0 # c\n",
        "COFF\n3 1 0\n0 0 0 255 0 0 255\n1 0 0 1 1 1 1\n0 1 .1 0 0 0 0\n3 0 1 2 0.1 0.2 0.3\n",
        "NOFF\r\n3 1 0\r\n0 0 0 0 0 1\r\n1 0 0 0 0 1\r\n0 1 .1 nan nan nan\r\n3 0 1 2\r\n",
        "STCNOFF\n3 1 0\n0 0 0 0 0 1 1 1 1 1 0 0\n1 0 0 0\n0 1 .1 0\n3 0 1 2\n",
        "3 1 0\n0 0 0\n1 0 0\n0 1 .1\n3 0 1 2\n"})
    EXPECT_EQ(soup(parse(text, Format::Off).mesh), expected) << text;
}

TEST(Off, Errors) {
  expect_error("OFF\n2147483648 1 0\n0 0 0\n", Format::Off, {"line 2", "2147483648", "more than"});
  expect_error("OFF\n-1 1 0\n", Format::Off, {"line 2", "-1"});
  expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n", Format::Off,
               {"line 6", "vertex 3", "there are 3"});
  expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n2000000000 0 1 2\n", Format::Off,
               {"line 6", "2000000000 corners"});
  expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n", Format::Off, {"truncated"});
  expect_error("OFF\n3 0 0\n0 0 0\n1 0 0\n0 1 0\n", Format::Off, {"no triangles"});
  expect_error("4OFF\n3 0 0\n", Format::Off, {"three-dimensional"});
  expect_error("OFF BINARY\n", Format::Off, {"binary OFF"});
  expect_error("PLY\n", Format::Off, {"'PLY'", "'OFF'"});
}

// --- PLY ---

TEST(Ply, AsciiWithExtras) {
  const ReadResult r = parse(
      "ply\nformat ascii 1.0\ncomment x\nobj_info y\nelement material 1\nproperty list uchar float "
      "w\n"
      "element vertex 4\nproperty uchar red\nproperty double z\nproperty float y\nproperty int16 "
      "x\n"
      "element face 2\nproperty float quality\nproperty list uint8 uint32 vertex_index\n"
      "property list uchar float texcoord\nelement edge 1\nproperty int a\nend_header\n"
      "2 nan nan\n255 0.1 0 0\n1 0 0 1\n1 0 1 1\n1 0 1 0\n0.5 3 0 1 2 2 0 0\n0.5 3 0 2 3 0\n7\n",
      Format::Ply);
  EXPECT_FALSE(r.single_precision);
  EXPECT_EQ(soup(r.mesh), (std::vector<Vec3>{Vec3(0, 0, 0.1), Vec3(1, 0, 0), Vec3(1, 1, 0),
                                             Vec3(0, 0, 0.1), Vec3(1, 1, 0), Vec3(0, 1, 0)}));
}

std::string binary_ply(bool big) {
  std::string s = std::string("ply\nformat ") +
                  (big ? "binary_big_endian" : "binary_little_endian") +
                  " 1.0\nelement vertex 4\nproperty float x\nproperty double y\nproperty short z\n"
                  "property uchar red\nelement face 2\nproperty list ushort short vertex_indices\n"
                  "property char flag\nend_header\n";
  const double points[4][3] = {{0, 0, 0}, {1, 0.1, 0}, {1, 1, 300}, {0, 1, -2}};
  for (const auto& p : points) {
    append(s, static_cast<float>(p[0]), big);
    append(s, p[1], big);
    append(s, static_cast<std::int16_t>(p[2]), big);
    s += '\xFF';
  }
  for (const auto& corners : {std::vector<int>{0, 1, 3}, std::vector<int>{1, 2, 3}}) {
    append(s, static_cast<std::uint16_t>(corners.size()), big);
    for (const int c : corners) append(s, static_cast<std::int16_t>(c), big);
    s += '\x01';
  }
  return s;
}

TEST(Ply, BinaryOfBothByteOrders) {
  for (const bool big : {false, true}) {
    const ReadResult r = parse(binary_ply(big), Format::Ply);
    EXPECT_FALSE(r.single_precision);
    EXPECT_EQ(soup(r.mesh), (std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0.1, 0), Vec3(0, 1, -2),
                                               Vec3(1, 0.1, 0), Vec3(1, 1, 300), Vec3(0, 1, -2)}));
  }
}

TEST(Ply, TriangleStrips) {
  const ReadResult r = parse(
      "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
      "property float z\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n8 0 1 2 3 -1 2 3 4\n",
      Format::Ply);
  EXPECT_EQ(r.mesh.triangles, (std::vector<Triangle>{{0, 1, 2}, {2, 1, 3}, {2, 3, 4}}));
}

TEST(Ply, Errors) {
  const std::string start = "ply\nformat ascii 1.0\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  const std::string face = "element face 1\nproperty list uchar int vertex_indices\n";
  expect_error("plx\n", Format::Ply, {"'ply'"});
  expect_error("no line end", Format::Ply, {"no line ends"});
  expect_error("ply\nend_header\n", Format::Ply, {"'format'"});
  expect_error("ply\nformat binary 1.0\n", Format::Ply, {"line 2", "'binary'"});
  expect_error(start + "element vertex 3\n", Format::Ply, {"end_header", "truncated"});
  expect_error(start + "property float x\n", Format::Ply, {"line 3", "'element'"});
  expect_error(start + "element vertex -3\n", Format::Ply, {"line 3", "-3"});
  expect_error(start + "element vertex\n", Format::Ply, {"line 3"});
  expect_error(start + "element vertex 1\nproperty quad x\n", Format::Ply, {"line 4", "'quad'"});
  expect_error(start + "end_header\n", Format::Ply, {"'vertex'"});
  expect_error(start + "element vertex 2147483648\n" + xyz + "end_header\n0 0 0\n", Format::Ply,
               {"2147483648", "'vertex'", "more than"});
  expect_error("ply\nformat binary_big_endian 1.0\nelement vertex 9223372036854775807\n" + xyz +
                   "end_header\nxxxx",
               Format::Ply, {"9223372036854775807", "more than"});
  expect_error(start + "element vertex 3\n" + xyz + face + "end_header\n0 0 0\n1 0 0\n0 1 nan\n",
               Format::Ply, {"line 12", "'nan'"});
  expect_error(start + "element vertex 3\n" + xyz + face +
                   "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 -2147483648\n",
               Format::Ply, {"vertex -2147483648", "there are 3"});
  expect_error(
      start + "element vertex 3\n" + xyz + face + "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n",
      Format::Ply, {"truncated"});
  expect_error(start + "element vertex 1\n" + xyz + "end_header\n0 0 0\n", Format::Ply,
               {"no triangles"});
  // Without properties, records take no room; their number must not matter.
  expect_error(
      start + "element vertex 1\n" + xyz + "element e 9223372036854775807\nend_header\n0 0 0",
      Format::Ply, {"no triangles"});
}

// --- names ---

TEST(Formats, Names) {
  EXPECT_EQ(format_from_name("stl"), Format::Stl);
  EXPECT_EQ(format_from_name(".STL"), Format::Stl);
  EXPECT_EQ(format_from_name("ply-ascii"), Format::PlyAscii);
  EXPECT_EQ(format_from_name(".dae"), Format::Collada);
  EXPECT_EQ(format_from_name(".wrl"), Format::Vrml);
  EXPECT_EQ(format_from_name("3mf"), Format::ThreeMf);
  EXPECT_EQ(format_from_name(""), std::nullopt);
  EXPECT_EQ(format_from_name(".stp"), Format::Step);
  EXPECT_EQ(format_from_name("xyz"), std::nullopt);
  for (const auto& names : {readable_formats(), writable_formats()}) {
    EXPECT_TRUE(std::ranges::is_sorted(names));
    for (const std::string& name : names) EXPECT_TRUE(format_from_name(name)) << name;
  }
}

TEST(Formats, EmptyAndCompressedFiles) {
  for (const std::string& name : readable_formats()) {
    expect_error("", *format_from_name(name), {"empty"});
    expect_error("\x1F\x8B\x08", *format_from_name(name), {"gzip"});
  }
}

}  // namespace
}  // namespace kaboum::io::test
