// Constructs that may hold geometry are read, or the file is refused; so is what follows the counts
// that a file states. One test per format; glTF, COLLADA and 3MF have their own files.

#include "io_test.h"

namespace kaboum::io::test {
namespace {

TEST(Refusal, OffBeyondItsCounts) {
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  EXPECT_NO_THROW(parse(off + "\n# the end\n \n", Format::Off));
  EXPECT_NO_THROW(parse("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2 255 0 0", Format::Off));
  expect_error(off + off, Format::Off, {"line 7", "'OFF'", "3 vertices and 1 face"});
  expect_error(off + "3 0 2 1\n", Format::Off, {"line 7"});
  expect_error("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n", Format::Off, {});
}

std::string ply(const std::string& more_elements, const std::string& face_properties,
                const std::string& data, const char* format = "ascii") {
  return std::string("ply\nformat ") + format +
         " 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
         "property float z\nelement face 1\n" +
         face_properties + more_elements + "end_header\n" + data;
}

TEST(Refusal, PlyListsElementsAndCounts) {
  const std::string list = "property list uchar int vertex_indices\n",
                    points = "0 0 0\n1 0 0\n0 1 0\n";
  EXPECT_NO_THROW(parse(ply("", list, points + "3 0 1 2\n"), Format::Ply));
  EXPECT_NO_THROW(parse(ply("", list, points + "3 0 1 2\n\n \n"), Format::Ply));
  expect_error(ply("", list, points + "3 0 1 2\n3 0 2 1\n"), Format::Ply, {"line 14", "goes on"});
  expect_error(
      ply("", list + "property list uchar int vertex_index\n", points + "3 0 1 2 3 2 1 0\n"),
      Format::Ply, {"'face'", "two lists"});
  EXPECT_TRUE(
      has_note(parse(ply("", list + "property list uchar int other\n", points + "3 0 1 2 1 7\n"),
                     Format::Ply),
               "'other'"));
  EXPECT_NO_THROW(
      parse(ply("", list + "property list uchar float texcoord\n", points + "3 0 1 2 2 0.5 0.5\n"),
            Format::Ply));
  const auto with = [&](const std::string& element, const std::string& record) {
    return ply(element, list, points + "3 0 1 2\n" + record);
  };
  expect_error(with("element tetrahedron 1\nproperty list uchar int vertex_indices\n", "3 0 1 2\n"),
               Format::Ply, {"'tetrahedron'"});
  expect_error(
      with("element triangle 1\nproperty int a\nproperty int b\nproperty int c\n", "0 1 2\n"),
      Format::Ply, {"'triangle'"});
  expect_error(with("element bezier 1\nproperty list uchar float control_points\n", "3 0 1 2\n"),
               Format::Ply, {"bezier"});
  expect_error(
      with("element sphere 1\nproperty float x\nproperty float y\nproperty float r\n", "0 1 2\n"),
      Format::Ply, {"sphere"});
  EXPECT_NO_THROW(
      parse(with("element tetrahedron 0\nproperty list uchar int v\n", ""), Format::Ply));
  EXPECT_NO_THROW(parse(with("element edge 1\nproperty int vertex1\nproperty int vertex2\n"
                             "property uchar red\n",
                             "0 1 255\n"),
                        Format::Ply));
  std::string binary = ply("", list, "", "binary_little_endian");
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.F, 0.F, 1.F, 0.F}) append(binary, x);
  binary += '\3';
  for (const int i : {0, 1, 2}) append(binary, std::int32_t{i});
  EXPECT_NO_THROW(parse(binary, Format::Ply));
  EXPECT_NO_THROW(parse(binary + "\r\n", Format::Ply));
  expect_error(binary + std::string("\3\0\0\0\0\1\0\0\0\2\0\0\0", 13), Format::Ply, {"goes on"});
}

TEST(Refusal, ObjStatements) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  for (const char* statement : {"surf 0 1 0 1 1 2 3", "bzp 1 2 3", "bsp 1 2 3", "cdp 1 2 3",
                                "call other.obj", "csh ls", "F 1 2 3", "tri 1 2 3", "v 0 0 1 0.5"})
    expect_error(obj + statement + "\n", Format::Obj, {"line 5"});
  for (const char* statement : {"p 1", "l 1 2", "cdc 1 2", "curv 0 1 1 2", "curv2 1 2"})
    EXPECT_TRUE(has_note(parse(obj + statement + "\n", Format::Obj), "lines or curves"))
        << statement;
  for (const char* statement : {"vt 0 0",
                                "vn 0 0 1",
                                "vp 0",
                                "g a b",
                                "o x",
                                "s off",
                                "mg 1 2",
                                "usemtl m",
                                "mtllib a b",
                                "cstype bezier",
                                "deg 3",
                                "step 1",
                                "bmat u 1",
                                "parm u 0 1",
                                "trim 0 1 1",
                                "hole 0 1 1",
                                "scrv 0 1 1",
                                "sp 1",
                                "end",
                                "con 1 0 1 1 2 0 1 1",
                                "bevel on",
                                "lod 1",
                                "usemap x",
                                "shadow_obj x.obj",
                                "trace_obj x.obj",
                                "# call x",
                                "v 0 0 1 1",
                                "v 0 0 1 0.5 0.5 0.5"})
    EXPECT_NO_THROW(parse(obj + statement + "\n", Format::Obj)) << statement;
}

TEST(Refusal, StlBeyondItsCount) {
  const std::string stl = binary_stl({{0, 0, 0, 1, 0, 0, 0, 1, 0}});
  EXPECT_TRUE(has_note(parse(stl + "\n", Format::Stl), "1 byte after"));
  EXPECT_TRUE(has_note(parse(stl + std::string(400, '\0'), Format::Stl), "400 bytes after"));
  expect_error(stl + stl, Format::Stl, {"byte 134", "goes on"});
  const std::string solid =
      "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
      "endloop\nendfacet\nendsolid a\n";
  const ReadResult r = parse(solid + solid, Format::Stl);
  EXPECT_EQ(r.mesh.triangles.size(), 2U);
  EXPECT_TRUE(has_note(r, "2 solids"));
  expect_error(solid + "facet", Format::Stl, {"'facet'"});
}

TEST(Refusal, VrmlNodesAndFields) {
  const std::string faces =
      "IndexedFaceSet { coord Coordinate { point [ 0 0 0 1 0 0 0 1 0 ] } coordIndex [ 0 1 2 ] ";
  const std::string shape = "Shape { geometry " + faces + "} }\n", header = "#VRML V2.0 utf8\n";
  EXPECT_NO_THROW(parse(header + shape, Format::Vrml));
  for (const std::string& more : std::initializer_list<std::string>{
           "NurbsSurface { }", "EspduTransform { children [ ] }",
           "Group { shapes [ " + shape + "] }", "Shape { mesh " + faces + "} }",
           "Shape { geometry " + faces + "coordIndex [ 0 2 1 ] } }", faces + "}"})
    expect_error(header + shape + more, Format::Vrml, {"line 3"});
  EXPECT_TRUE(has_note(
      parse(header + shape + "Switch { choice [ " + shape + "] whichChoice -1 }", Format::Vrml),
      "choice"));
}

}  // namespace
}  // namespace kaboum::io::test
