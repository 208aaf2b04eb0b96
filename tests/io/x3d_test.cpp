// X3D in XML: the nodes of VRML and those that X3D has added, in double precision.

#include <unistd.h>

#include <fstream>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

const std::string kPoints = R"(<Coordinate point="0 0 0, 1 0 0, 1 1 0.1, 0 1 0"/>)";
const std::string kX3dTriangle =
    "<Shape><Appearance><Material diffuseColor='1 0 0'/></Appearance>"
    R"(<IndexedFaceSet solid="false" coordIndex="0 1 2 -1">)" +
    kPoints + "</IndexedFaceSet></Shape>";
const std::vector<Vec3> kExpected = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(1, 1, 0.1)};

std::string x3d(const std::string& scene, const std::string& head = "") {
  return R"(<?xml version="1.0" encoding="UTF-8"?>
<!DOCTYPE X3D PUBLIC "ISO//Web3D//DTD X3D 3.0//EN" "http://www.web3d.org/specifications/x3d-3.0.dtd">
<X3D profile="Interchange" version="3.0">)" +
         head + "<Scene>\n" + scene + "</Scene></X3D>";
}

ReadResult read_x3d(const std::string& scene) { return parse(x3d(scene), Format::X3d); }
std::vector<Vec3> triangles(const std::string& scene) { return soup(read_x3d(scene).mesh); }

void expect_x3d_refused(const std::string& scene, const std::vector<std::string>& parts) {
  expect_error(x3d(scene), Format::X3d, parts);
}

std::string element(const std::string& name, const std::string& attributes,
                    const std::string& content) {
  std::string text = "<";
  return text.append(name).append(" ").append(attributes).append(">").append(content) + "</" +
         name + ">";
}

/// A group of `leaf`, used twice by a group that is used twice, and so on.
std::string doubled(const std::string& leaf) {
  std::string text = element("Group", "DEF='g0'", leaf);
  for (int i = 1; i < 60; ++i) {
    const std::string before = element("Group", "USE='g" + std::to_string(i - 1) + "'", "");
    text += element("Group", "DEF='g" + std::to_string(i) + "'", before + before);
  }
  return text;
}

std::string shape(const std::string& geometry) { return "<Shape>" + geometry + "</Shape>"; }

/// A geometry node with the four points.
std::string with_points(const std::string& type, const std::string& attributes) {
  return shape("<" + type + " " + attributes + ">" + kPoints + "</" + type + ">");
}

TEST(X3d, FaceSet) {
  const ReadResult r = read_x3d(kX3dTriangle);
  EXPECT_EQ(soup(r.mesh), kExpected);
  EXPECT_FALSE(r.single_precision);
  EXPECT_EQ(r.notes.size(), 1U);  // a vertex that is not used
  EXPECT_EQ(triangles(with_points("IndexedFaceSet", R"(ccw="false" coordIndex="0 1 2")"))[0],
            kExpected[2]);
  EXPECT_EQ(triangles(shape(R"(<IndexedFaceSet coordIndex="0 1 2"><CoordinateDouble )"
                            R"(containerField="coord" point="0 0 0 1 0 0 1 1 0.1"/>)"
                            "<Normal vector='0 0 1'/></IndexedFaceSet>")),
            kExpected);
}

TEST(X3d, OtherSurfaces) {
  const Vec3 a(0, 0, 0), b(1, 0, 0), c(1, 1, 0.1), d(0, 1, 0);
  using Corners = std::vector<Vec3>;
  EXPECT_EQ(triangles(with_points("IndexedTriangleSet", R"(index="0 1 2 0 2 3")")),
            (Corners{a, b, c, a, c, d}));
  EXPECT_EQ(triangles(with_points("IndexedTriangleSet", R"(index="0 1 2" ccw="false")")),
            (Corners{c, b, a}));
  EXPECT_EQ(triangles(with_points("IndexedTriangleStripSet", R"(index="0 1 3 2 -1 0 1 2")")),
            (Corners{a, b, d, d, b, c, a, b, c}));
  EXPECT_EQ(triangles(with_points("IndexedTriangleFanSet", R"(index="0 1 2 3 -1")")),
            (Corners{a, b, c, a, c, d}));
  EXPECT_EQ(triangles(with_points("TriangleFanSet", R"(fanCount="4")")),
            (Corners{a, b, c, a, c, d}));
  EXPECT_EQ(triangles(with_points("TriangleFanSet", R"(fanCount="4" ccw="false")")),
            (Corners{b, a, c, c, a, d}));
  EXPECT_EQ(triangles(with_points("TriangleStripSet", R"(stripCount="4")")),
            (Corners{a, b, c, c, b, d}));
  for (const char* type : {"QuadSet", "IndexedQuadSet"}) {
    const ReadResult quad = read_x3d(with_points(type, type[0] == 'Q' ? "" : R"(index="0 1 2 3")"));
    EXPECT_EQ(quad.split_polygons, 1U);
    EXPECT_EQ(quad.mesh.triangles.size(), 2U);
  }
  EXPECT_EQ(
      triangles(shape(R"(<TriangleSet><Coordinate point="0 0 0 1 0 0 1 1 0.1"/></TriangleSet>)")),
      kExpected);
  // What does not come out even is not guessed.
  expect_x3d_refused(with_points("TriangleSet", ""), {"4 points"});
}

TEST(X3d, IncompleteSurfacesAreRefused) {
  expect_x3d_refused(with_points("IndexedTriangleSet", R"(index="0 1 2 3")"), {"last face"});
  expect_x3d_refused(with_points("IndexedQuadSet", R"(index="0 1 2")"), {"last face"});
  expect_x3d_refused(with_points("TriangleStripSet", R"(stripCount="3")"),
                     {"4 points", "faces of 3"});
  expect_x3d_refused(with_points("TriangleFanSet", R"(fanCount="2 2")"), {"run of 2"});
  expect_x3d_refused(with_points("TriangleFanSet", ""), {"faces of 0"});
  expect_x3d_refused(with_points("IndexedFaceSet", R"(coordIndex="0 1 4")"),
                     {"vertex 4", "there are 4"});
  expect_x3d_refused(with_points("IndexedTriangleSet", R"(index="0 1 -1")"), {"vertex -1"});
  expect_x3d_refused(with_points("IndexedFaceSet", R"(coordIndex="0 1 x")"), {"line 4", "'x'"});
  expect_x3d_refused(with_points("IndexedFaceSet", R"(coordindex="0 1 2")"), {"'coordindex'"});
  expect_x3d_refused(shape(R"(<TriangleSet><Coordinate point="0 0 0 1 0"/></TriangleSet>)"),
                     {"too few"});
}

TEST(X3d, Groups) {
  for (const char* group : {"Group", "StaticGroup", "Anchor", "Collision", "PickableGroup",
                            "Transform", "CADAssembly", "CADLayer", "CADPart", "CADFace", "LOD"}) {
    const std::string shown = element(group, "DEF='g'", kX3dTriangle);
    EXPECT_EQ(triangles(shown), kExpected);
    EXPECT_EQ(triangles(shown +
                        element("Transform", "translation='0 0 1'", element(group, "USE='g'", "")))
                  .size(),
              6U);
  }
  EXPECT_EQ(
      triangles("<CADFace><Shape containerField='shape'>" + kX3dTriangle.substr(7) + "</CADFace>"),
      kExpected);
  EXPECT_EQ(triangles("<CADPart translation='1 2 3'>" + kX3dTriangle + "</CADPart>")[0],
            Vec3(1, 2, 3));
  const std::string other = shape("<Box/>");
  EXPECT_EQ(triangles("<LOD range='1'>" + kX3dTriangle + other + "</LOD>"), kExpected);
  EXPECT_EQ(triangles("<Switch whichChoice='1'>" + other + kX3dTriangle + "</Switch>"), kExpected);
  const ReadResult proxy = read_x3d("<Collision><Shape containerField='proxy'><Box/></Shape>" +
                                    kX3dTriangle + "</Collision>");
  EXPECT_EQ(soup(proxy.mesh), kExpected);
  EXPECT_TRUE(has_note(proxy, "proxies"));
  const ReadResult hidden = read_x3d("<Switch>" + other + "</Switch>" + kX3dTriangle);
  EXPECT_TRUE(has_note(hidden, "Switch"));
}

TEST(X3d, Transforms) {
  EXPECT_EQ(
      triangles("<Transform translation='0 0 2' scale='2 3 1'>" + kX3dTriangle + "</Transform>")[2],
      Vec3(2, 3, 2.1));
  const std::vector<Vec3> turned =
      triangles("<Transform rotation='0 0 1 1.5707963267948966'>" + kX3dTriangle + "</Transform>");
  EXPECT_LT((turned[1] - Vec3(0, 1, 0)).norm(), 1e-15);
  const ReadResult mirrored =
      read_x3d("<Transform scale='-1 1 1'>" + kX3dTriangle + "</Transform>");
  EXPECT_EQ(soup(mirrored.mesh)[2], Vec3(0, 0, 0));
  EXPECT_TRUE(has_note(mirrored, "mirror"));
  expect_x3d_refused("<Transform translation='0 0'>" + kX3dTriangle + "</Transform>", {"too few"});
  expect_x3d_refused("<Transform translation='0 0 0 0'>" + kX3dTriangle + "</Transform>",
                     {"too many"});
  expect_x3d_refused("<Group translation='0 0 1'>" + kX3dTriangle + "</Group>", {"'translation'"});
}

TEST(X3d, WhatMayHoldASurfaceIsRefusedByName) {
  for (const char* geometry :
       {"Sphere", "Cone", "Cylinder", "Text", "ElevationGrid", "Extrusion", "Disk2D", "Rectangle2D",
        "TriangleSet2D", "ArcClose2D", "NurbsPatchSurface", "NurbsTrimmedSurface",
        "GeoElevationGrid", "Mystery"})
    expect_x3d_refused(kX3dTriangle + shape(std::string("<") + geometry + "/>"),
                       {"line 4", geometry});
  for (const char* node :
       {"Billboard", "GeoTransform", "GeoLocation", "GeoLOD", "HAnimHumanoid", "ParticleSystem",
        "LayerSet", "LayoutGroup", "ScreenGroup", "EspduTransform", "VolumeData", "NurbsSet",
        "CollidableShape", "ClipPlane", "Rotation", "Translation", "Mystery"})
    expect_x3d_refused(kX3dTriangle + "<" + node + "/>", {node});
  for (const char* node : {"ProtoInstance", "ProtoDeclare", "ExternProtoDeclare"})
    expect_x3d_refused(kX3dTriangle + "<" + node + " name='P'/>", {node, "prototypes"});
  expect_x3d_refused(
      shape(R"(<IndexedFaceSet coordIndex="0"><GeoCoordinate containerField="coord"/>)"
            "</IndexedFaceSet>"),
      {"GeoCoordinate"});
  expect_x3d_refused(shape(R"(<IndexedFaceSet coordIndex="0"><GeoCoordinate/></IndexedFaceSet>)"),
                     {"GeoCoordinate"});
  expect_x3d_refused(shape("<Box containerField='appearance'/>"), {"Box"});
  expect_x3d_refused("<Group><Shape containerField='metadata'/></Group>", {"Shape"});
  expect_x3d_refused("<Group visible='false'>" + kX3dTriangle + "</Group>", {"visible"});
  expect_x3d_refused(kX3dTriangle + "text", {"'text"});
}

TEST(X3d, IgnoresWhatHoldsNone) {
  const ReadResult r = read_x3d(
      "<WorldInfo title='x'/><Viewpoint DEF='V'/><DirectionalLight/><TimeSensor DEF='T'/>"
      "<Script><field name='a' type='SFNode' accessType='initializeOnly'/><![CDATA[code <> ]]>"
      "</Script><ROUTE fromNode='T' fromField='x' toNode='V' toField='y'/>" +
      kX3dTriangle + shape("<IndexedLineSet coordIndex='0 1'>" + kPoints + "</IndexedLineSet>"));
  EXPECT_EQ(soup(r.mesh), kExpected);
  EXPECT_TRUE(has_note(r, "lines"));
  EXPECT_TRUE(has_note(r, "animations"));
}

TEST(X3d, Units) {
  const auto unit = [](const std::string& attributes) {
    return x3d(kX3dTriangle, "<head><meta name='a' content='b'/><unit " + attributes + "/></head>");
  };
  const ReadResult r =
      parse(unit("category='length' name='mm' conversionFactor='0.001'"), Format::X3d);
  EXPECT_EQ(soup(r.mesh), kExpected);
  EXPECT_TRUE(has_note(r, "0.001"));
  EXPECT_EQ(r.unit, "mm");
  EXPECT_EQ(parse(unit("category='length' name='x' conversionFactor='0.5'"), Format::X3d).unit,
            "0.5 m");
  // Metres are a unit where they are stated; without, the file says nothing.
  const ReadResult metres =
      parse(unit("category='length' name='m' conversionFactor='1'"), Format::X3d);
  EXPECT_EQ(metres.unit, "m");
  EXPECT_FALSE(has_note(metres, "metres"));
  EXPECT_EQ(read_x3d(kX3dTriangle).unit, "");
  EXPECT_EQ(parse(unit("category='mass' name='g' conversionFactor='1'"), Format::X3d).unit, "");
  const ReadResult tiny =
      parse(unit("category='length' name='nm' conversionFactor='0.000000001'"), Format::X3d);
  EXPECT_EQ(tiny.unit, "1e-09 m");
  EXPECT_TRUE(has_note(tiny, "unit is 1e-09 metres"));
  expect_error(unit("category='length' name='x' conversionFactor='-0.000000001'"), Format::X3d,
               {"unit of -1e-09 metres"});
  EXPECT_NO_THROW(parse(unit("category='mass' name='g' conversionFactor='0.001'"), Format::X3d));
  expect_error(unit("category='angle' name='degree' conversionFactor='0.01745'"), Format::X3d,
               {"radians"});
}

TEST(X3d, Damaged) {
  expect_error("#X3D V3.0 utf8\n", Format::X3d, {"classic"});
  expect_error("#VRML V2.0 utf8\n", Format::X3d, {"VRML"});
  expect_error(std::string("\xE0\0\0\1xyz", 7), Format::X3d, {"binary"});
  expect_error("<html/>", Format::X3d, {"no X3D"});
  expect_error("<X3D/>", Format::X3d, {"no triangles"});
  expect_error(x3d(kX3dTriangle) + x3d(kX3dTriangle), Format::X3d, {});
  expect_error("<X3D><Scene/><Scene/></X3D>", Format::X3d, {"second"});
  expect_x3d_refused("<Group USE='x'/>", {"'x'", "DEF"});
  expect_x3d_refused("<Group DEF='x'/><Shape USE='x'/>", {"'x'"});
  expect_x3d_refused("<Shape>" + kX3dTriangle.substr(7, kX3dTriangle.size() - 15) +
                         "<IndexedFaceSet coordIndex=''/></Shape>",
                     {"several"});
  // Its own descendant.
  expect_x3d_refused("<Group DEF='x'><Group USE='x'/></Group>", {"deep"});
  expect_error(x3d(doubled(kX3dTriangle)), Format::X3d, {"repeat"}, ErrorCode::LimitReached);
}

TEST(X3d, CrowdedElementsEnd) {
  // Pairs of attributes are compared somewhere: more than so many are refused before that.
  std::string crowded = "<X3D";
  for (int i = 0; i < 300'000; ++i) crowded += " a" + std::to_string(i) + "='>'";
  expect_error(crowded + "/>", Format::X3d, {"attributes"});
  std::string fields = "<Group>";
  for (int i = 0; i < 100'000; ++i)
    fields += "<Group containerField='f" + std::to_string(i) + "'/>";
  expect_x3d_refused(fields + "</Group>", {"too many fields"});
  // Text that makes nothing, read_x3d again and again.
  const std::string blank = "coordIndex='" + std::string(100'000, ' ') + "'";
  expect_error(x3d(doubled(with_points("IndexedFaceSet", blank))), Format::X3d, {"repeat"},
               ErrorCode::LimitReached);
  // Quotation marks elsewhere are none.
  const std::string quotes(1000, '"');
  EXPECT_EQ(triangles("<!-- " + quotes + " --><Script><![CDATA[<a " + quotes + ">]]></Script>" +
                      kX3dTriangle),
            kExpected);
}

TEST(X3d, Inline) {
  const std::filesystem::path directory =
      std::filesystem::path(::testing::TempDir()) / ("kaboum-x3d-" + std::to_string(::getpid()));
  std::filesystem::create_directories(directory);
  std::ofstream(directory / "a.x3d") << x3d(kX3dTriangle);
  std::ofstream(directory / "b.wrl")
      << "#VRML V2.0 utf8\nShape { geometry IndexedFaceSet { coordIndex [ 0 1 2 ]\n"
         "coord Coordinate { point [ 0 0 0, 1 0 0, 1 1 0.1 ] } } }";
  std::ofstream(directory / "mm.x3d")
      << x3d(kX3dTriangle, "<head><unit category='length' conversionFactor='0.001'/></head>");
  std::ofstream(directory / "loop.x3d") << x3d("<Inline url='loop.x3d'/>");
  std::ofstream(directory / "m.x3d")
      << x3d(kX3dTriangle, "<head><unit category='length' conversionFactor='1'/></head>");
  std::ofstream(directory / "turned.wrl")
      << "#VRML V2.0 utf8\nTranslation { translation 0 0 5 } Inline { url \"b.wrl\" }";
  const auto inlined = [&](const std::string& attributes, const std::string& head = "") {
    return parse(
        x3d("<Transform translation='0 0 1'><Inline " + attributes + "/></Transform>", head),
        Format::X3d, directory);
  };
  for (const char* url :
       {R"(url='"a.x3d" "other.x3d"')", "url='a.x3d'", R"(url='"b.wrl"' load='true')"}) {
    const ReadResult r = inlined(url);
    EXPECT_EQ(soup(r.mesh)[1], Vec3(1, 0, 1));
    EXPECT_TRUE(has_note(r, "Inline"));
  }
  for (const char* bad : {"url='loop.x3d'", "url='mm.x3d'", "url='none.x3d'", "url='/etc/passwd'",
                          "url='http://example.org/a.x3d'", "url='a.x3d' load='false'"})
    EXPECT_THROW(inlined(bad), Error) << bad;
  // In each file what its format says: VRML's moves, and units, metres where none is stated.
  EXPECT_EQ(soup(inlined("url='turned.wrl'").mesh)[1], Vec3(1, 0, 6));
  const auto unit = [](const std::string& metres) {
    return "<head><unit category='length' conversionFactor='" + metres + "'/></head>";
  };
  EXPECT_EQ(inlined("url='m.x3d'").unit, "");
  EXPECT_EQ(inlined("url='a.x3d'", unit("1")).unit, "m");
  EXPECT_EQ(inlined("url='m.x3d'", unit("1")).unit, "m");
  EXPECT_EQ(inlined("url='mm.x3d'", unit("0.001")).unit, "mm");
  for (const char* other : {"url='a.x3d'", "url='m.x3d'", "url='b.wrl'"})
    EXPECT_THROW(inlined(other, unit("0.001")), Error) << other;
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace kaboum::io::test
