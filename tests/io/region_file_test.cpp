// Regions with an epsilon each: their three shapes, lengths, and texts that are none.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/io/region_file.h>

namespace kaboum::io {
namespace {

std::string message(const std::string& text) {
  try {
    parse_regions(text, "map.json");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
    return error.what();
  }
  return "no error";
}

/// A region beside a sound one.
std::string second(const std::string& members) {
  return message(R"({"regions": [{"epsilon": 1, "box": [[0,0,0],[1,1,1]]}, {)" + members + "}]}");
}

TEST(Regions, AreRead) {
  const auto regions = parse_regions(R"({"regions": [
      {"name": "grip", "epsilon": "0.2%", "box": [[0, 0, 0], [1, 2, 3]]},
      {"epsilon": 0.5, "ball": {"center": [1, 0, 0], "radius": 2}},
      {"epsilon": "2mm", "half_space": {"normal": [0, 0, -2], "offset": 4}}]})",
                                     "map.json");
  ASSERT_EQ(regions.size(), 3U);
  EXPECT_EQ(regions[0].name, "'grip'");
  EXPECT_EQ(regions[0].epsilon.text(), "0.2%");
  EXPECT_TRUE(geom::holds(regions[0].region, {0.5, 1.5, 2.5}));
  EXPECT_FALSE(geom::holds(regions[0].region, {0.5, 2.5, 2.5}));
  EXPECT_EQ(regions[1].name, "region 2");
  EXPECT_EQ(regions[1].epsilon, Length{0.5});
  EXPECT_TRUE(geom::holds(regions[1].region, {2.9, 0, 0}));
  EXPECT_FALSE(geom::holds(regions[1].region, {3.1, 0, 0}));
  EXPECT_EQ(regions[2].epsilon.in("m").value, 0.002);
  EXPECT_TRUE(geom::holds(regions[2].region, {0, 0, -1.9}));
  EXPECT_FALSE(geom::holds(regions[2].region, {0, 0, -2.1}));
}

TEST(Regions, TwoOfOneNameAreRefused) {
  const std::string one = R"({"name": "a", "epsilon": 1, "box": [[0,0,0],[1,1,1]]})",
                    of_robot = R"({"name": "a", "frame": "f", "radius": 1, "epsilon": 1})";
  EXPECT_EQ(message("{\"regions\": [" + one + ", " + one + "]}"),
            "map.json: region 2: the name 'a' is another region's: give each a name of its own");
  EXPECT_THROW(parse_frame_regions("{\"regions\": [" + of_robot + ", " + of_robot + "]}", "m"),
               Error);
}

TEST(Regions, RefusalsNameTextAndRegion) {
  EXPECT_EQ(message("{"), "map.json: the JSON is cut short: it ends at line 1, column 1");
  for (const char* text : {"{}", "[]", R"({"regions": []})", R"({"regions": 1})"})
    EXPECT_TRUE(message(text).starts_with("map.json: give {\"regions\"")) << text;
  const auto refused = [](const std::string& members, const std::string& why) {
    const std::string said = second(members);
    EXPECT_TRUE(said.starts_with("map.json: region 2: " + why)) << said;
  };
  refused(R"("epsilon": 1)", "one of box");
  refused(R"("box": [[0,0,0],[1,1,1]])", "epsilon is missing");
  refused(R"("epsilon": "2 mm", "box": [[0,0,0],[1,1,1]])", "epsilon must be");
  refused(R"("epsilon": 1, "box": [[2,0,0],[1,1,1]])", "box: the lower corner");
  refused(R"("epsilon": 1, "epsilon": 2, "box": [[0,0,0],[1,1,1]])", "'epsilon' is given twice");
  refused(R"("epsilon": 1, "colour": 2, "box": [[0,0,0],[1,1,1]])", "there is no member 'colour'");
}

TEST(Regions, OfRobotsNameFramesAndLinks) {
  const geom::FrameRegions map = parse_frame_regions(R"({"regions": [
      {"frame": "hand", "radius": 0.1, "epsilon": "2mm", "name": "grip"},
      {"link": "finger", "epsilon": "0.5%"},
      {"frame": "hand", "box": [[0, 0, 0], [1, 2, 3]], "epsilon": 1}]})",
                                                     "map.json");
  ASSERT_EQ(map.regions.size(), 2U);
  ASSERT_EQ(map.links.size(), 1U);
  EXPECT_EQ(map.regions[0].frame, "hand");
  EXPECT_EQ(map.regions[0].name, "'grip'");
  EXPECT_EQ(map.regions[0].place, "map.json: region 1");
  EXPECT_EQ(map.regions[0].epsilon, Length{0.002});
  EXPECT_TRUE(geom::holds(map.regions[0].region, {0, 0.09, 0}));
  EXPECT_FALSE(geom::holds(map.regions[0].region, {0, 0.11, 0}));
  EXPECT_EQ(map.regions[1].name, "region 3");
  EXPECT_TRUE(geom::holds(map.regions[1].region, {0.5, 1.5, 2.5}));
  EXPECT_EQ(map.links[0].link, "finger");
  EXPECT_EQ(map.links[0].epsilon.text(), "0.5%");
}

TEST(Regions, OfRobotsAreRefusedWithTextAndRegion) {
  const auto refused = [](const std::string& members, const std::string& why) {
    std::string said = "no error";
    try {
      parse_frame_regions("{\"regions\": [{\"link\": \"a\", \"epsilon\": 1}, {" + members + "}]}",
                          "map.json");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
      said = error.what();
    }
    EXPECT_TRUE(said.starts_with("map.json: region 2: " + why)) << said;
  };
  refused(R"("epsilon": 1, "box": [[0,0,0],[1,1,1]])", "frame is missing");
  refused(R"("epsilon": 1, "frame": "hand")", "one of radius, box");
  refused(R"("epsilon": 1, "frame": "hand", "radius": 1, "box": [[0,0,0],[1,1,1]])",
          "one of radius");
  refused(R"("epsilon": 1, "frame": 3, "radius": 1)", "frame is no text");
  refused(R"("epsilon": 1, "frame": "hand", "radius": 0)", "radius must be above 0");
  refused(R"("epsilon": 1, "frame": "hand", "frame": "arm", "radius": 1)",
          "'frame' is given twice");
  refused(R"("frame": "hand", "radius": 1)", "epsilon is missing");
  refused(R"("epsilon": 1, "link": "hand", "radius": 1)", "a link is meant as a whole");
  refused(R"("epsilon": 1, "link": "hand", "frame": "hand")", "a link is meant as a whole");
  refused(R"("epsilon": 1, "frame": "hand", "radius": 1, "colour": 2)",
          "there is no member 'colour'");
  // Meshes have none of them.
  EXPECT_TRUE(second(R"("epsilon": 1, "frame": "hand", "box": [[0,0,0],[1,1,1]])")
                  .starts_with("map.json: region 2: a mesh has no frames"));
  EXPECT_TRUE(
      second(R"("epsilon": 1, "radius": 1)").starts_with("map.json: region 2: there is no"));
}

}  // namespace
}  // namespace kaboum::io
