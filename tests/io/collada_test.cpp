// COLLADA: what is read is what the scene shows, in double precision; the rest is refused.

#include "io_test.h"

namespace kaboum::io::test {
namespace {

/// A document of the given parts; the mesh has the vertices of a bent pentagon.
struct Document {
  std::string asset = "";
  std::string positions =
      R"(<source id="p"><float_array id="pa" count="15">0 0 0 4 0 0 4 4 0 1 1 0 0 4 0.1</float_array>
   <technique_common><accessor source="#pa" count="5" stride="3">
    <param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/>
   </accessor></technique_common></source>)";
  std::string vertices = R"(<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>)";
  std::string faces = R"(<triangles count="2"><input semantic="VERTEX" source="#v" offset="0"/>)"
                      R"(<p>0 1 3 3 1 2</p></triangles>)";
  std::string node = R"(<node id="n"><instance_geometry url="#g"/></node>)";
  std::string libraries = "";
  std::string scene = R"(<instance_visual_scene url="#s"/>)";

  [[nodiscard]] std::string text() const {
    return R"(<?xml version="1.0" encoding="utf-8"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
 <asset>)" +
           asset +
           R"(</asset>
 <library_geometries><geometry id="g"><mesh>)" +
           positions + vertices + faces + R"(</mesh></geometry></library_geometries>)" + libraries +
           R"(
 <library_visual_scenes><visual_scene id="s">)" +
           node + R"(</visual_scene></library_visual_scenes>
 <scene>)" +
           scene +
           R"(</scene>
</COLLADA>)";
  }
};

ReadResult read(const Document& d) { return parse(d.text(), Format::Collada); }
std::vector<Vec3> triangles(const Document& d) { return soup(read(d).mesh); }

void expect_refused(const Document& d, const std::vector<std::string>& parts) {
  expect_error(d.text(), Format::Collada, parts);
}

Document with_faces(
    const std::string& element, const std::string& content,
    const std::string& inputs = R"(<input semantic="VERTEX" source="#v" offset="0"/>)") {
  Document d;
  d.faces =
      "<" + element + ">" + inputs + content + "</" + element.substr(0, element.find(' ')) + ">";
  return d;
}

Document with_node(const std::string& content) {
  Document d;
  d.node = "<node>" + content + R"(<instance_geometry url="#g"/></node>)";
  return d;
}

Document replaced(Document d, std::string Document::*part, const std::string& from,
                  const std::string& to) {
  std::string& text = d.*part;
  text.replace(text.find(from), from.size(), to);
  return d;
}

const std::vector<Vec3> kExpected = {Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(1, 1, 0),
                                     Vec3(1, 1, 0), Vec3(4, 0, 0), Vec3(4, 4, 0)};

TEST(Collada, TrianglesInDoublePrecision) {
  const ReadResult r = read(with_faces("triangles count=\"1\"", "<p>0 1 4</p>"));
  EXPECT_FALSE(r.single_precision);
  EXPECT_TRUE(has_note(r, "no face uses"));
  EXPECT_EQ(r.notes.size(), 1U);
  EXPECT_EQ(soup(r.mesh)[2], Vec3(0, 4, 0.1));
  EXPECT_EQ(triangles({}), kExpected);
}

TEST(Collada, KindsOfFaces) {
  const ReadResult pentagon =
      read(with_faces("polylist count=\"1\"", "<vcount>5</vcount><p>0 1 2 3 4</p>"));
  EXPECT_EQ(pentagon.split_polygons, 1U);
  EXPECT_EQ(pentagon.mesh.triangles.size(), 3U);
  EXPECT_EQ(triangles(with_faces("polylist count=\"2\"", "<vcount>3 3</vcount><p>0 1 3 3 1 2</p>")),
            kExpected);
  EXPECT_EQ(triangles(with_faces("polygons count=\"2\"", "<p>0 1 3</p><p>3 1 2</p>")), kExpected);
  EXPECT_EQ(triangles(with_faces("tristrips count=\"1\"", "<p>0 1 3 2</p>")), kExpected);
  EXPECT_EQ(triangles(with_faces("trifans count=\"1\"", "<p>1 3 0</p>"))[0], Vec3(4, 0, 0));
  EXPECT_EQ(
      read(with_faces("trifans count=\"2\"", "<p>1 2 3 0</p><p>0 1 3</p>")).mesh.triangles.size(),
      3U);
  // Corners of several numbers; only the one of VERTEX counts.
  EXPECT_EQ(triangles(with_faces("triangles count=\"2\"", "<p>9 0 9 1 9 3 9 3 9 1 9 2</p>",
                                 R"(<input semantic="VERTEX" source="#v" offset="1"/>)"
                                 R"(<input semantic="NORMAL" source="#none" offset="0"/>)")),
            kExpected);
  Document lines = {};
  lines.faces += R"(<lines count="1"><input semantic="VERTEX" source="#v" offset="0"/>)"
                 R"(<p>0 1</p></lines>)";
  EXPECT_TRUE(has_note(read(lines), "1 set of lines"));
}

TEST(Collada, Accessors) {
  Document d;
  d.positions =
      R"(<source id="p"><float_array id="pa" count="14">9 0 0 0 7 0 4 0 7 .1 1 1 7 5</float_array>
   <technique_common><accessor source="#pa" count="3" stride="4" offset="1">
    <param name="Z" type="float"/><param name="X" type="float"/><param name="Y" type="float"/>
    <param type="float"/></accessor></technique_common></source>)";
  d.faces = R"(<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/>)"
            R"(<p>0 1 2</p></triangles>)";
  EXPECT_EQ(triangles(d), (std::vector<Vec3>{Vec3(0, 0, 0), Vec3(4, 0, 0), Vec3(1, 1, 0.1)}));
  expect_refused(replaced(d, &Document::positions, "count=\"3\"", "count=\"4\""), {"accessor"});
  expect_refused(replaced(d, &Document::positions, "stride=\"4\"", "stride=\"3\""), {"stride"});
  expect_refused(replaced(d, &Document::positions, "name=\"Z\"", "name=\"W\""), {"X, Y and Z"});
  expect_refused(replaced(d, &Document::positions, "name=\"Z\"", "name=\"X\""), {"'X'"});
  expect_refused(replaced(d, &Document::positions, "#pa", "other.dae#pa"), {"another file"});
  expect_refused(replaced(d, &Document::positions, "#pa", "#pb"), {"'pb'"});
  expect_refused(replaced(d, &Document::positions, "count=\"14\"", "count=\"13\""),
                 {"states 13", "holds 14"});
  expect_refused(replaced(d, &Document::positions, " .1 ", " INF "), {"finite"});
  expect_refused(replaced(d, &Document::positions, " .1 ", " 1,5 "), {"line 4", "'1,5'"});
}

TEST(Collada, CountsAreCompared) {
  expect_refused(with_faces("triangles count=\"3\"", "<p>0 1 3 3 1 2</p>"),
                 {"states 3", "holds 2"});
  expect_refused(with_faces("triangles count=\"1\"", ""), {"states 1", "holds 0"});
  expect_refused(with_faces("triangles count=\"1\"", "<p>0 1 3 3</p>"), {"complete"});
  expect_refused(with_faces("triangles", "<p>0 1 3</p>"), {"'count'"});
  expect_refused(with_faces("triangles count=\"2\"", "<p>0 1 3</p><p>3 1 2</p>"), {"second <p>"});
  expect_refused(with_faces("polylist count=\"2\"", "<vcount>5</vcount><p>0 1 2 3 4</p>"),
                 {"states 2"});
  expect_refused(with_faces("polylist count=\"1\"", "<vcount>4</vcount><p>0 1 2 3 4</p>"),
                 {"4 corners"});
  expect_refused(with_faces("polygons count=\"1\"", "<p>0 1 3</p><p>3 1 2</p>"), {"states 1"});
  expect_refused(with_faces("tristrips count=\"2\"", "<p>0 1 3 2</p>"), {"states 2"});
  expect_refused(with_faces("triangles count=\"1\"", "<p>0 1 3</p>",
                            R"(<input semantic="VERTEX" source="#v" offset="1"/>)"),
                 {"3 numbers"});
  expect_refused(with_faces("triangles count=\"1\"", "<p>0 1 5</p>"), {"vertex 5", "there are 5"});
  for (const char* bad : {"p", "-1", "1.5", "99999999999"})
    expect_refused(with_faces("triangles count=\"1\"", "<p>0 1 " + std::string(bad) + "</p>"),
                   {"line 7", bad});
}

TEST(Collada, Transforms) {
  EXPECT_EQ(triangles(with_node("<translate>1 2 3</translate>"))[1], Vec3(5, 2, 3));
  EXPECT_EQ(triangles(with_node("<matrix>0 -1 0 1 1 0 0 2 0 0 1 3 0 0 0 1</matrix>"))[1],
            Vec3(1, 6, 3));
  // The first is the outermost.
  EXPECT_EQ(triangles(with_node("<translate>1 0 0</translate><scale>2 3 4</scale>"))[5],
            Vec3(9, 12, 0));
  const std::vector<Vec3> turned = triangles(with_node("<rotate>0 0 2 90</rotate>"));
  EXPECT_LT((turned[1] - Vec3(0, 4, 0)).norm(), 1e-15);
  const ReadResult mirrored = read(with_node("<scale>-1 1 1</scale>"));
  EXPECT_TRUE(has_note(mirrored, "mirror"));
  EXPECT_EQ(soup(mirrored.mesh)[0], Vec3(-1, 1, 0));
  EXPECT_EQ(soup(mirrored.mesh)[2], Vec3(0, 0, 0));
  expect_refused(with_node("<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 1 1</matrix>"), {"affine"});
  expect_refused(with_node("<translate>1 2</translate>"), {"not a number"});
  expect_refused(with_node("<translate>1 2 3 4</translate>"), {"more than 3"});
  expect_refused(with_node("<skew>45 0 1 0 1 0 0</skew>"), {"<skew>", "apply transforms"});
  expect_refused(with_node("<lookat>0 0 0 1 0 0 0 0 1</lookat>"), {"<lookat>"});
  Document camera;
  camera.node += R"(<node><lookat>0 0 0 1 0 0 0 0 1</lookat><instance_camera url="#c"/></node>)";
  EXPECT_EQ(triangles(camera), kExpected);
}

TEST(Collada, UnitsAndAxes) {
  for (const char* axis : {"X_UP", "Y_UP", "Z_UP"}) {
    Document d = with_node("<translate>2 0 0</translate>");
    d.asset = std::string("<unit name=\"mm\" meter=\"0.5\"/><up_axis>") + axis + "</up_axis>";
    const ReadResult r = read(d);
    EXPECT_EQ(soup(r.mesh)[1], Vec3(3, 0, 0));
    EXPECT_TRUE(has_note(r, "'0.5' metres"));
    EXPECT_EQ(r.unit, "m");
    EXPECT_EQ(has_note(r, "up axis"), axis != std::string("Z_UP"));
  }
  Document metre;
  metre.asset = "<unit meter=\"1.0\"/><up_axis>Z_UP</up_axis>";
  EXPECT_FALSE(has_note(read(metre), "scaled"));
  EXPECT_EQ(triangles(metre), kExpected);
  metre.libraries = R"(<library_nodes><asset><unit meter="0.1"/></asset></library_nodes>)";
  expect_refused(metre, {"another unit"});
  metre.asset = "<unit meter=\"0\"/>";
  expect_refused(metre, {"unit"});
}

TEST(Collada, NodesAndScenes) {
  Document d;
  d.libraries = R"(<library_nodes><node id="m"><translate>0 0 5</translate>)"
                R"(<instance_geometry url="#g"/></node></library_nodes>)";
  d.node += R"(<node><translate>1 0 0</translate><node><instance_node url="#m"/></node></node>)";
  const std::vector<Vec3> both = triangles(d);
  ASSERT_EQ(both.size(), 12U);
  EXPECT_EQ(both[6], Vec3(1, 0, 5));
  // A scene and a geometry that are not shown.
  d.libraries +=
      R"(<library_visual_scenes><visual_scene id="t"><node><skew/></node></visual_scene>)"
      R"(</library_visual_scenes>)"
      R"(<library_geometries><geometry id="h"><brep/></geometry></library_geometries>)";
  EXPECT_EQ(triangles(d), both);
  EXPECT_TRUE(has_note(read(d), "1 geometry that the scene does not show"));

  expect_refused(replaced(d, &Document::node, "\"#m\"", "\"parts.dae#m\""), {"another file"});
  expect_refused(replaced(d, &Document::node, "\"#m\"", "\"#x\""), {"'x'"});
  expect_refused(replaced(d, &Document::node, "\"#g\"", "\"#h\""), {"<brep>"});
  expect_refused(replaced(d, &Document::libraries, "id=\"h\"", "id=\"g\""), {"several", "'g'"});
  expect_refused(replaced(d, &Document::scene, "#s", "#u"), {"'u'"});
  expect_refused(replaced(d, &Document::scene, "<", R"(<instance_visual_scene url="#s"/><)"),
                 {"second"});
  d.scene = "";
  expect_refused(d, {"no visual scene"});
}

TEST(Collada, WhatMayHoldASurfaceIsRefusedByName) {
  const auto refused = [](std::string Document::*part, const std::string& more,
                          const std::vector<std::string>& parts) {
    Document d;
    d.*part += more;
    expect_refused(d, parts);
  };
  refused(&Document::node, R"(<node><instance_controller url="#k"/></node>)", {"skinned"});
  refused(&Document::node, "<node><instance_thing/></node>", {"<instance_thing>"});
  refused(&Document::node, "<thing/>", {"<thing>"});
  refused(&Document::faces, "<patches/>", {"<patches>"});
  refused(&Document::faces, "text", {"'text'"});
  refused(&Document::libraries, "<library_things/>", {"<library_things>"});
  refused(&Document::scene, "<instance_thing/>", {"<instance_thing>"});
  refused(&Document::vertices, R"(<vertices id="w"/>)", {"two <vertices>"});
  expect_refused(with_faces("polygons count=\"1\"", "<ph><p>0 1 2</p><h>0 1 3</h></ph>"),
                 {"holes"});
  for (const char* name : {"convex_mesh", "brep"}) {
    Document d;
    d.node = R"(<node><instance_geometry url="#h"/></node>)";
    d.libraries = "<library_geometries><geometry id=\"h\"><" + std::string(name) +
                  "/></geometry></library_geometries>";
    expect_refused(d, {name});
  }
  Document physics;
  physics.scene += R"(<instance_physics_scene url="#x"/><instance_kinematics_scene url="#y"/>)";
  physics.libraries = "<library_animations/><library_physics_scenes/>";
  const ReadResult r = read(physics);
  EXPECT_TRUE(has_note(r, "physics"));
  EXPECT_TRUE(has_note(r, "kinematics"));
  EXPECT_TRUE(has_note(r, "Animations"));
}

// Other programs' data, by the names of these, wherever it is on the way to a triangle.
TEST(Collada, ExtraDataOfUnknownProfilesIsRefused) {
  const auto extra = [](const std::string& profile, const std::string& content = "<x/>") {
    return "<extra><technique profile=\"" + profile + "\">" + content + "</technique></extra>";
  };
  const auto everywhere = [&](const std::string& text) {
    std::vector<Document> all(7);
    all[0].node = "<node>" + text + R"(<instance_geometry url="#g"/></node>)";
    all[1].node = R"(<node><instance_geometry url="#g">)" + text + "</instance_geometry></node>";
    all[2].node += text;
    all[3].scene += text;
    all[4].libraries = text;
    all[5].faces += text;
    all[6].vertices =
        R"(<vertices id="v"><input semantic="POSITION" source="#p"/>)" + text + "</vertices>";
    return all;
  };
  for (const char* profile : {"blender", "MAYA", "GOOGLEEARTH", "FCOLLADA", "OpenCOLLADA3dsMax"})
    for (const Document& d : everywhere(extra(profile))) EXPECT_NO_THROW(read(d)) << d.text();
  for (const char* profile : {"blender_volumes", "MAYA2", "VENDOR"})
    for (const Document& d : everywhere(extra(profile))) expect_refused(d, {profile});
  for (const Document& d :
       everywhere(extra("MAYA", "<segment_scale_compensate>1</segment_scale_compensate>")))
    expect_refused(d, {"compensate"});
  EXPECT_NO_THROW(
      read(with_node(extra("MAYA", "<segment_scale_compensate>0</segment_scale_compensate>"))));
  Document d;
  d.node = R"(<node><instance_geometry url="#g"><shape/></instance_geometry></node>)";
  expect_refused(d, {"shape"});
}

TEST(Collada, Damaged) {
  expect_error("this is no XML", Format::Collada, {"XML"});
  expect_error("<COLLADA version=\"1.3\"/>", Format::Collada, {"1.4"});
  expect_error("<COLLADA version=\"1.4.1\"/>", Format::Collada, {"no <scene>"});
  const std::string text = Document().text();
  for (std::size_t n = 0; n < text.size(); ++n) {
    if (text.find_first_not_of('>', n) == std::string::npos) continue;
    EXPECT_THROW(parse(text.substr(0, n), Format::Collada), Error) << n;
  }
  expect_error(text + text, Format::Collada, {});
  expect_error(text + "<x/>", Format::Collada, {"second root"});
  expect_error(text + "rest", Format::Collada, {});
}

TEST(Collada, NestingIsLimited) {
  const auto twice = [](int id) {
    const std::string url = "<instance_node url=\"#m" + std::to_string(id) + "\"/>";
    return url + url;
  };
  Document d;
  d.libraries = "<library_nodes><node id=\"m0\">" + twice(0) + "</node></library_nodes>";
  d.node = "<node>" + twice(0) + "</node>";
  expect_refused(d, {"nested"});
  const std::string blank = "<translate>0 0 1" + std::string(100'000, ' ') + "</translate>";
  for (const std::string& leaf :
       {std::string(), std::string(R"(<instance_geometry url="#g"/>)"), blank}) {
    d.libraries = "<library_nodes><node id=\"m0\">" + leaf + "</node>";
    for (int i = 1; i < 60; ++i)
      d.libraries += "<node id=\"m" + std::to_string(i) + "\">" + twice(i - 1) + "</node>";
    d.libraries += "</library_nodes>";
    d.node = "<node>" + twice(59) + "</node>";
    expect_error(d.text(), Format::Collada, {"repeat"}, ErrorCode::LimitReached);
  }
  std::string deep;
  for (int i = 0; i < 200; ++i) deep += "<node>";
  for (int i = 0; i < 200; ++i) deep += "</node>";
  d.node = deep;
  expect_refused(d, {"deep"});
}

TEST(Collada, HostileXml) {
  std::string entities = Document().text();
  entities.insert(entities.find("<COLLADA"),
                  R"(<!DOCTYPE lolz [<!ENTITY a "0"><!ENTITY b "&a;&a;&a;">]>)");
  expect_error(entities, Format::Collada, {});
  Document d;
  d.positions.replace(d.positions.find("0 0 0 4"), 1, "&b;");
  expect_refused(d, {"&b;"});
  Document long_name;
  long_name.node = "<node name=\"" + std::string(5'000'000, 'x') + "\"" +
                   R"(><instance_geometry url="#g"/></node>)";
  EXPECT_EQ(triangles(long_name), kExpected);
  std::string zero = Document().text();
  zero[100] = '\0';
  expect_error(zero, Format::Collada, {"UTF-8"});
}

}  // namespace
}  // namespace kaboum::io::test
