#include <unistd.h>

#include <fstream>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

const std::string kHeader = "#VRML V2.0 utf8\n";
const std::string kTriangle =
    "Shape { appearance Appearance { material Material { diffuseColor 1 0 0 } } # comment }\n"
    " geometry IndexedFaceSet { solid FALSE creaseAngle 0.5\n"
    " coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 .5 ] } coordIndex [ 0, 1, 2, -1 ] } }\n";

std::vector<Vec3> read_vrml(const std::string& body) {
  return soup(parse(kHeader + body, Format::Vrml).mesh);
}

void expect_near(const std::vector<Vec3>& actual, const std::vector<Vec3>& expected) {
  ASSERT_EQ(actual.size(), expected.size());
  for (std::size_t i = 0; i < actual.size(); ++i)
    EXPECT_LT((actual[i] - expected[i]).norm(), 1e-12) << i << ": " << actual[i].transpose();
}

TEST(Vrml, FaceSet) {
  const std::vector<Vec3> expected = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0.5)};
  EXPECT_EQ(read_vrml(kTriangle), expected);
  EXPECT_EQ(read_vrml("Group { children [ " + kTriangle + " ] }"), expected);
  EXPECT_EQ(read_vrml("Group { bboxSize 1 1 1 children " + kTriangle + " }"), expected);
  EXPECT_EQ(read_vrml("Shape { geometry IndexedFaceSet { ccw FALSE coordIndex [ 0 1 2 ]\n"
                      "coord Coordinate { point [ 0 0 0 1 0 0 0 1 .5 ] } } }"),
            (std::vector<Vec3>{Vec3(0, 1, 0.5), Vec3(1, 0, 0), Vec3(0, 0, 0)}));
}

TEST(Vrml, Transforms) {
  const std::string wrap = " children [ " + kTriangle + " ] }";
  EXPECT_EQ(read_vrml("Transform { translation 1 2 3" + wrap),
            (std::vector<Vec3>{Vec3(1, 2, 3), Vec3(2, 2, 3), Vec3(1, 3, 3.5)}));
  EXPECT_EQ(read_vrml("Transform { children [ " + kTriangle + " ] scale 2 2 2 }"),
            (std::vector<Vec3>{Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(0, 2, 1)}));
  expect_near(read_vrml("Transform { rotation 0 0 2 1.5707963267948966 translation 1 0 0" + wrap),
              {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 0, 0.5)});
  expect_near(read_vrml("Transform { center 1 0 0 rotation 0 0 1 3.141592653589793" + wrap),
              {Vec3(2, 0, 0), Vec3(1, 0, 0), Vec3(2, -1, 0.5)});
  // Scale by 2 along the diagonal x = y.
  expect_near(read_vrml("Transform { scale 2 1 1 scaleOrientation 0 0 1 0.7853981633974483" + wrap),
              {Vec3(0, 0, 0), Vec3(1.5, 0.5, 0), Vec3(0.5, 1.5, 0.5)});
  expect_near(
      read_vrml("Transform { translation 0 0 1 children Transform { scale 1 1 2" + wrap + " }"),
      {Vec3(0, 0, 1), Vec3(1, 0, 1), Vec3(0, 1, 2)});
  EXPECT_EQ(read_vrml("Transform { scale -1 1 1" + wrap),
            (std::vector<Vec3>{Vec3(0, 1, 0.5), Vec3(-1, 0, 0), Vec3(0, 0, 0)}));
}

TEST(Vrml, RotationAndTranslationMoveWhatFollowsInTheirGroup) {
  const std::string turn = "Rotation { rotation 0 0 1 1.5707963267948966 } ";
  // The later move is the inner one, as in Coin.
  expect_near(read_vrml(turn + "Translation { translation 1 0 0 } " + kTriangle),
              {Vec3(0, 1, 0), Vec3(0, 2, 0), Vec3(-1, 1, 0.5)});
  expect_near(read_vrml("Translation { translation 1 0 0 } " + turn + kTriangle),
              {Vec3(1, 0, 0), Vec3(1, 1, 0), Vec3(0, 0, 0.5)});
  expect_near(read_vrml("Group { children [ " + turn + kTriangle + " ] } " + kTriangle),
              {Vec3(0, 0, 0), Vec3(0, 1, 0), Vec3(-1, 0, 0.5), Vec3(0, 0, 0), Vec3(1, 0, 0),
               Vec3(0, 1, 0.5)});
  expect_near(read_vrml(kTriangle + turn), {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0.5)});
  EXPECT_THROW(read_vrml("Rotation { rotation 0 0 1 1 angle 2 } " + kTriangle), Error);
  EXPECT_THROW(read_vrml("Rotation { translation 0 0 1 } " + kTriangle), Error);
  EXPECT_THROW(read_vrml("Translation { translation 0 0 } " + kTriangle), Error);
}

TEST(Vrml, FieldsGivenTwice) {
  EXPECT_EQ(
      read_vrml("Shape { appearance Appearance { material Material { shininess 1 diffuseColor 1 0 "
                "0 diffuseColor 0 1 0 } }"
                " geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0, 1 0 0, 0 1 .5 ] } "
                "coordIndex [ 0 1 2 ] } }")
          .size(),
      3U);
  EXPECT_THROW(
      read_vrml("Transform { translation 1 0 0 translation 2 0 0 children [ " + kTriangle + " ] }"),
      Error);
}

TEST(Vrml, Box) {
  const auto box = parse(
      kHeader + "Transform { translation 1 0 0 children Shape { geometry Box { size 1 2 4 } } }",
      Format::Vrml);
  const std::vector<Vec3> corners = soup(box.mesh);
  ASSERT_EQ(corners.size(), 36U);
  double six_volumes = 0;
  for (std::size_t i = 0; i < corners.size(); i += 3)
    six_volumes += corners[i].dot(corners[i + 1].cross(corners[i + 2]));
  EXPECT_DOUBLE_EQ(six_volumes, 6 * 8);
  EXPECT_EQ(corners.front().x(), 0.5);
  EXPECT_EQ(read_vrml("Shape { geometry Box { } }").size(), 36U);
  for (const std::string bad :
       {"size 0 1 1", "size -1 1 1", "size 1 1", "size 1 1 nan", "radius 1"})
    EXPECT_THROW(read_vrml("Shape { geometry Box { " + bad + " } }"), Error) << bad;
}

TEST(Vrml, DefAndUse) {
  EXPECT_EQ(read_vrml("DEF A " + kTriangle + "Transform { translation 5 0 0 children [ USE A ] }"),
            (std::vector<Vec3>{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0.5), Vec3(5, 0, 0),
                               Vec3(6, 0, 0), Vec3(5, 1, 0.5)}));
  // A coordinate node shared; a DEF inside of a node that is skipped.
  EXPECT_EQ(read_vrml("Script { field SFNode c DEF C Coordinate { point [ 0 0 0 1 0 0 0 1 0 ] } }\n"
                      "Shape { geometry IndexedFaceSet { coord USE C coordIndex [ 0 1 2 -1 ] } }\n"
                      "Shape { geometry IndexedFaceSet { coord USE C coordIndex [ 2 1 0 ] } }")
                .size(),
            6U);
}

TEST(Vrml, OtherGroups) {
  const std::string other = "Shape { geometry Sphere { } }";
  EXPECT_EQ(read_vrml("Switch { whichChoice 1 choice [ " + other + " " + kTriangle + " ] }").size(),
            3U);
  EXPECT_EQ(read_vrml("Switch { choice [ " + other + " ] whichChoice -1 } " + kTriangle).size(),
            3U);
  EXPECT_EQ(read_vrml("LOD { range [ 1 ] level [ " + kTriangle + " " + other + " ] }").size(), 3U);
  EXPECT_EQ(read_vrml("Anchor { url \"x\" children " + kTriangle + " }").size(), 3U);
  EXPECT_EQ(read_vrml("Collision { proxy " + other + " children [ " + kTriangle + " ] }").size(),
            3U);
}

TEST(Vrml, SkipsWhatHasNoSurface) {
  const ReadResult r =
      parse(kHeader +
                "WorldInfo { title \"a } [ \\\" string\" info [ \"x\" ] } DEF V Viewpoint { "
                "position 0 0 1 }\n" +
                kTriangle +
                "Shape { geometry IndexedLineSet { coord Coordinate { point [ 0 0 0 1 1 1 ] } "
                "coordIndex [ 0 1 ] } }\n"
                "ROUTE V.position TO V.position\n",
            Format::Vrml);
  EXPECT_EQ(r.mesh.triangles.size(), 1U);
  EXPECT_TRUE(has_note(r, "lines or points"));
  EXPECT_TRUE(has_note(r, "animations"));
  EXPECT_FALSE(has_note(r, "Viewpoint"));
  // What is not known might hold a surface.
  for (const char* node : {"Mystery { a [ B { c 1 } ] d NULL }", "Billboard { children [ ] }",
                           "Group { mystery 1 }", "Shape { geometry IndexedFaceSet { points 1 } }"})
    expect_error(kHeader + kTriangle + node, Format::Vrml, {"line 5"});
}

TEST(Vrml, Errors) {
  expect_error("#VRML V1.0 ascii\n", Format::Vrml, {"VRML 1.0"});
  expect_error("hello", Format::Vrml, {"#VRML V2.0"});
  expect_error(kHeader, Format::Vrml, {"no triangles"});
  expect_error(kHeader + "PROTO X [ ] { }", Format::Vrml, {"line 2", "PROTO"});
  expect_error(kHeader + "Shape { geometry Sphere { radius 1 } }", Format::Vrml,
               {"line 2", "Sphere"});
  expect_error(kHeader + "Shape {\n geometry Foo { } }", Format::Vrml, {"line 3", "'Foo'"});
  expect_error(kHeader + "Group { children [ USE X ] }", Format::Vrml, {"'X'", "DEF"});
  expect_error(kHeader + "Group { children [ ", Format::Vrml, {"truncated"});
  expect_error(kHeader + "WorldInfo { title \"x }", Format::Vrml, {"quote"});
  expect_error(kHeader +
                   "Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 0 ] }\n"
                   "coordIndex [ 0 1 2 ] } }",
               Format::Vrml, {"line 3", "vertex 1", "there are 1"});
  expect_error(kHeader + "Shape { geometry IndexedFaceSet { coord Coordinate { point [ 0 0 ] } } }",
               Format::Vrml, {"line 2", "too few"});
  expect_error(kHeader +
                   "Transform { scale 1e308 1 1 children Transform { scale 1e308 1 1 children " +
                   kTriangle + "} }",
               Format::Vrml, {"not finite"});
  expect_error(kHeader + "Group { children [ NULL ] }", Format::Vrml, {"NULL"});
  expect_error(kHeader + "Group { children [ 1 ] }", Format::Vrml, {"no nodes"});
  expect_error(kHeader + "Transform { scale 1 1 1 scale 2 2 2 }", Format::Vrml, {"twice"});
  expect_error(kHeader + "Shape { geometry IndexedFaceSet { ccw 1 } }", Format::Vrml, {"'ccw'"});
  expect_error(kHeader + "Inline { url \"other.wrl\" }", Format::Vrml, {"directory"});
}

TEST(Vrml, NestingIsLimited) {
  std::string deep = kHeader;
  for (int i = 0; i < 100000; ++i) deep += "Group { children [ ";
  expect_error(deep, Format::Vrml, {});
  for (int i = 0; i < 100000; ++i) deep += "] } ";
  expect_error(deep, Format::Vrml, {"deep"});
  expect_error(kHeader + "DEF A Group { children [ USE A ] }", Format::Vrml, {"deep"});
  // Each level doubles the one before.
  std::string bomb = kHeader + "DEF N0 " + kTriangle;
  for (int i = 1; i < 60; ++i) {
    const std::string before = "USE N" + std::to_string(i - 1);
    bomb += "DEF N" + std::to_string(i) + " Group { children [ " + before + " " + before + " ] }\n";
  }
  expect_error(bomb, Format::Vrml, {"repeat too much"}, ErrorCode::LimitReached);
  // Moves without shapes, again and again.
  std::string moves = kHeader + "DEF M Group { children [ ";
  for (int i = 0; i < 30'000; ++i) moves += "Translation { } ";
  moves += "] }\n";
  for (int i = 0; i < 30'000; ++i) moves += "USE M ";
  expect_error(moves, Format::Vrml, {"repeat too much"}, ErrorCode::LimitReached);
}

TEST(Vrml, Inline) {
  const std::filesystem::path directory =
      std::filesystem::path(::testing::TempDir()) / ("kaboum-inline-" + std::to_string(::getpid()));
  std::filesystem::create_directories(directory / "parts");
  std::ofstream(directory / "parts" / "a.wrl") << kHeader << kTriangle;
  std::ofstream(directory / "parts" / "loop.wrl") << kHeader << "Inline { url \"loop.wrl\" }";
  std::ofstream(directory / "parts" / "bad.wrl") << kHeader << "\n\nShape { geometry Sphere { } }";
  const auto text = [](const std::string& url) {
    return kHeader + "Transform { translation 1 0 0 children Inline { url [ \"" + url + "\" ] } }";
  };
  const ReadResult r = parse(text("parts/a.wrl"), Format::Vrml, directory);
  EXPECT_EQ(soup(r.mesh), (std::vector<Vec3>{Vec3(1, 0, 0), Vec3(2, 0, 0), Vec3(1, 1, 0.5)}));
  EXPECT_TRUE(has_note(r, "Inline"));
  EXPECT_EQ(r.other_files, std::vector{(directory / "parts/a.wrl").string()});
  const auto message = [&](const std::string& url) -> std::string {
    try {
      parse(text(url), Format::Vrml, directory);
      return "no error";
    } catch (const Error& e) {
      return e.what();
    }
  };
  EXPECT_NE(message("parts/loop.wrl").find("include itself"), std::string::npos);
  EXPECT_NE(message("parts/bad.wrl").find("bad.wrl: line 4"), std::string::npos)
      << message("parts/bad.wrl");
  EXPECT_NE(message("parts/none.wrl").find("cannot be read"), std::string::npos);
  EXPECT_NE(message("http://example.org/x.wrl").find("not supported"), std::string::npos);
  EXPECT_NE(message("/etc/passwd").find("not supported"), std::string::npos);
  // Out of the folder, from here or from a file in it; within it `..` is as good as any other.
  std::ofstream(directory / "outside.wrl") << kHeader << kTriangle;
  std::ofstream(directory / "parts" / "up.wrl") << kHeader << "Inline { url \"../outside.wrl\" }";
  EXPECT_EQ(message("parts/../parts/a.wrl"), "no error");
  EXPECT_EQ(message("parts/up.wrl"), "no error");
  const auto from_parts = [&](const std::string& url) -> std::string {
    try {
      parse(text(url), Format::Vrml, directory / "parts");
      return "no error";
    } catch (const Error& e) {
      return e.what();
    }
  };
  EXPECT_EQ(from_parts("a.wrl"), "no error");
  for (const char* url : {"../outside.wrl", "up.wrl", "x/../../outside.wrl", ".."})
    EXPECT_NE(from_parts(url).find("leaves the folder"), std::string::npos) << url;
  std::filesystem::remove_all(directory);
}

}  // namespace
}  // namespace kaboum::io::test
