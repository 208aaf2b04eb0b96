// What models include and attach, written out; what is wrong with it is said. tests/engines
// compares what comes of it with MuJoCo and Drake.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/robot/mjcf.h>
#include <kaboum/robot/sdf.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <regex>

namespace kaboum::robot {
namespace {

namespace fs = std::filesystem;
using Files = std::map<std::string, std::string>;

std::string attached(const std::string& text, const Files& files) {
  return attach_mjcf(text, "main.xml", [&](const std::string& file) {
    const auto found = files.find(file);
    if (found == files.end())
      throw Error(ErrorCode::InvalidInput, file + ": there is no such file");
    return found->second;
  });
}

std::string refusal(const std::string& text, const Files& files) {
  try {
    parse_mjcf(attached(text, files), "main.xml");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
    return error.what();
  }
  return "nothing is refused";
}

std::string model_of(const std::string& attach, const std::string& before = "") {
  return "<mujoco>" + before +
         "<asset><model name=\"a\" file=\"sub/a.xml\"/></asset><worldbody><body name=\"t\">"
         "<geom size=\"1\"/>" +
         attach + "</body></worldbody></mujoco>";
}

const char* const kArm =
    "<mujoco model=\"arm\"><compiler meshdir=\"parts\"/><asset><mesh file=\"p.stl\"/></asset>"
    "<worldbody><body name=\"b\"><joint name=\"j\" range=\"-90 90\"/><geom type=\"mesh\" "
    "mesh=\"p\"/></body></worldbody></mujoco>";

TEST(AttachedModels, HaveTheirPrefixFilesAndAngles) {
  const MjcfRobot robot =
      parse_mjcf(attached(model_of("<attach model=\"a\" body=\"b\" prefix=\"l_\"/>"
                                   "<attach model=\"a\" body=\"b\" prefix=\"r_\"/>",
                                   "<compiler angle=\"radian\" meshdir=\"m\"/>"),
                          {{"sub/a.xml", kArm}}),
                 "main.xml");
  ASSERT_EQ(robot.robot.links.size(), 4U);
  EXPECT_EQ(robot.robot.links[2].name, "l_b");
  EXPECT_EQ(robot.robot.links[2].collision.at(0).mesh, "sub/parts/p.stl");
  ASSERT_EQ(robot.robot.variables.size(), 2U);
  EXPECT_EQ(robot.robot.variables[1].name, "r_j");
  EXPECT_NEAR(*robot.robot.variables[1].upper, std::numbers::pi / 2, 1e-15);
}

TEST(AttachedModels, AreAsTheyAreWithoutAny) {
  const std::string text = "<mujoco><worldbody/></mujoco>";
  EXPECT_EQ(attached(text, {}), text);
}

TEST(AttachedModels, AreRefusedByPlace) {
  const Files files{{"sub/a.xml", kArm}};
  const auto has = [&](const std::string& text, const Files& given, const std::string& words) {
    EXPECT_NE(refusal(text, given).find(words), std::string::npos) << refusal(text, given);
  };
  has(model_of("<attach model=\"z\" prefix=\"l_\"/>"), files, "there is no model 'z'");
  has(model_of("<attach model=\"a\" body=\"z\" prefix=\"l_\"/>"), files, "has no body 'z'");
  has(model_of("<attach model=\"a\" body=\"b\"/>"), files, "no prefix");
  has(model_of("<attach model=\"a\" prefix=\"l_\"/><attach model=\"a\" prefix=\"l_\"/>"), files,
      "'l_b' of a body is used");
  has(model_of(""), {}, "there is no such file");
  has(model_of("<attach model=\"a\" prefix=\"l_\"/>", "<compiler autolimits=\"false\"/>"), files,
      "autolimits");
  has(model_of("<attach model=\"a\" prefix=\"l_\"/>", "<default><geom material=\"m\"/></default>"),
      files, "main class states material");
  has(model_of("<attach model=\"a\" prefix=\"l_\"/>"),
      {{"sub/a.xml",
        "<mujoco><asset><model name=\"b\" file=\"b.xml\"/></asset><worldbody/></mujoco>"},
       {"sub/b.xml",
        "<mujoco><asset><model name=\"a\" file=\"a.xml\"/></asset><worldbody/></mujoco>"}},
      "attached to itself");
}

TEST(AttachedModels, AreRefusedWhatTheyCannotMean) {
  const auto has = [&](const std::string& inner, const std::string& words) {
    const std::string said =
        refusal(model_of("<attach model=\"a\" prefix=\"l_\"/>"),
                {{"sub/a.xml", "<mujoco>" + inner +
                                   "<worldbody><body name=\"b\"><geom size=\"1\" euler=\"1 2 "
                                   "3\"/></body></worldbody></mujoco>"}});
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_TRUE(said.starts_with("sub/a.xml:1: ")) << said;
  };
  has("<compiler eulerseq=\"abc\"/>", "eulerseq is 'abc'");
  has("<compiler eulerseq=\"xy\"/>", "eulerseq is 'xy'");
  has("<compiler angle=\"deg\"/>", "angle is 'deg'");
  has("<deformable><skin/><flex name=\"f\"/></deformable>", "flexible bodies");
}

/// Models that name the next one twice, and attach nothing.
TEST(AttachedModels, AreNotReadWithoutEnd) {
  Files files;
  for (int i = 0; i < 30; ++i) {
    const std::string next = "m" + std::to_string(i + 1) + ".xml";
    files["m" + std::to_string(i) + ".xml"] = "<mujoco><asset><model name=\"m\" file=\"" + next +
                                              "\"/><model name=\"n\" file=\"" + next +
                                              "\"/></asset><worldbody/></mujoco>";
  }
  files["m30.xml"] = "<mujoco><worldbody><body name=\"b\"/></worldbody></mujoco>";
  try {
    attached(files["m0.xml"], files);
    FAIL() << "it ends";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::LimitReached);
  }
}

/// Ten models that attach the next one ten times each.
TEST(AttachedModels, DoNotMultiplyWithoutEnd) {
  Files files;
  for (int i = 0; i < 10; ++i) {
    std::string attach;
    for (int k = 0; k < 10; ++k)
      attach += "<attach model=\"m\" prefix=\"p" + std::to_string(k) + "_\"/>";
    files["m" + std::to_string(i) + ".xml"] =
        "<mujoco><asset><model name=\"m\" file=\"m" + std::to_string(i + 1) +
        ".xml\"/></asset><worldbody><body>" + attach + "</body></worldbody></mujoco>";
  }
  files["m10.xml"] = "<mujoco><worldbody><body name=\"b\"/></worldbody></mujoco>";
  try {
    attached(files["m0.xml"], files);
    FAIL() << "it ends";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::LimitReached);
  }
}

class IncludedModels : public ::testing::Test {
 protected:
  IncludedModels()
      : folder_(fs::path(::testing::TempDir()) / ("included-" + std::to_string(::getpid()))) {}
  ~IncludedModels() override { fs::remove_all(folder_); }

  void file(const std::string& name, const std::string& text) const {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  [[nodiscard]] std::string included(const std::string& text) const {
    return include_sdf(text, "r.sdf", (folder_ / "r.sdf").string(),
                       [](const std::string& uri, const std::string& from) {
                         const fs::path found = find_model(uri, from, {});
                         std::ifstream in(found);
                         return IncludedModel{found.lexically_normal().string(),
                                              {std::istreambuf_iterator<char>(in),
                                               std::istreambuf_iterator<char>()}};
                       });
  }
  [[nodiscard]] std::string refusal(const std::string& text) const {
    try {
      parse_sdf(included(text), "r.sdf");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
      return error.what();
    }
    return "nothing is refused";
  }
  fs::path folder_;
};

std::string robot_with(const std::string& include) {
  return "<sdf version=\"1.9\"><model name=\"r\"><link name=\"base\"/>" + include +
         "</model></sdf>";
}

TEST_F(IncludedModels, ArePlacedAndTheirFilesFound) {
  file("arm/model.config",
       "<model><sdf version=\"1.4\">old.sdf</sdf><sdf version=\"1.9\"> new.sdf\n</sdf>"
       "<sdf version=\"1.99\">newer.sdf</sdf></model>");
  file("arm/new.sdf",
       "<sdf version=\"1.9\"><model name=\"arm\"><link name=\"l\"><collision name=\"c\"><geometry>"
       "<mesh><uri>meshes/p.stl</uri></mesh></geometry></collision></link></model></sdf>");
  const SdfRobot robot =
      parse_sdf(included(robot_with(
                    "<include><uri>arm</uri><name>left</name><pose>1 2 3 0 0 0</pose></include>"
                    "<include><uri>model://arm</uri></include>")),
                "r.sdf");
  const auto left = robot.robot.find_link("left::l"), right = robot.robot.find_link("arm::l");
  ASSERT_TRUE(left && right);
  EXPECT_EQ(robot.robot.links[*left].collision.at(0).mesh, "arm/meshes/p.stl");
  EXPECT_EQ(robot.robot.joints[*left - 1].origin.translation, Vec3(1, 2, 3));
}

// A document that is nothing but an include is of the version of what it includes.
TEST_F(IncludedModels, HaveTheVersionOfTheirOwnDocument) {
  file("arm.sdf",
       "<sdf version=\"1.9\"><model name=\"arm\"><link name=\"l\"/><link name=\"m\"/>"
       "<joint name=\"j\" type=\"revolute\"><pose>0 0 0 0 0 1</pose><parent>l</parent>"
       "<child>m</child><axis><xyz>1 0 0</xyz><limit><lower>-1</lower><upper>1</upper></limit>"
       "</axis></joint></model></sdf>");
  file("by.sdf", "<sdf version=\"1.4\"><include><uri>arm.sdf</uri></include></sdf>");
  const auto axis_by = [&](const std::string& by) {
    const SdfRobot robot = parse_sdf(
        included(robot_with("<include><uri>" + by + "</uri><name>a</name></include>")), "r.sdf");
    const auto moved = robot.robot.find_link("a::m");
    EXPECT_TRUE(moved);
    return moved ? robot.robot.joints[*moved - 1].axis : Vec3(Vec3::Zero());
  };
  EXPECT_EQ(axis_by("by.sdf"), axis_by("arm.sdf"));
}

// What is beside the model, and what it included, is nothing of the robot's.
TEST_F(IncludedModels, LeaveTheRestOfTheirDocuments) {
  file("part.sdf",
       "<sdf version=\"1.5\"><model name=\"part\"><link name=\"l\"><collision name=\"c\"><geometry>"
       "<mesh><uri>p.stl</uri></mesh></geometry></collision></link></model></sdf>");
  std::string worlds;
  for (int i = 0; i < 50; ++i)
    worlds += "<world name=\"w\"><include><uri>part.sdf</uri></include></world>";
  file("sub/arm.sdf",
       "<sdf version=\"1.9\"><model name=\"arm\"><link name=\"l\"><collision name=\"c\"><geometry>"
       "<mesh><uri>file://p.stl</uri></mesh></geometry></collision></link></model>" +
           std::regex_replace(worlds, std::regex("part.sdf"), "../part.sdf") + "</sdf>");
  std::string includes;
  for (int i = 0; i < 20; ++i)
    includes += "<include><uri>sub/arm.sdf</uri><name>a" + std::to_string(i) + "</name></include>";
  const SdfRobot robot = parse_sdf(included(robot_with(includes)), "r.sdf");
  EXPECT_EQ(robot.robot.links.size(), 22U);
  for (const Link& link : robot.robot.links)
    for (const Geometry& g : link.collision) EXPECT_EQ(g.mesh, "sub/p.stl");
}

TEST_F(IncludedModels, AreRefusedByPlace) {
  file(
      "self/model.sdf",
      "<sdf version=\"1.9\"><model name=\"m\"><include><uri>../self</uri></include></model></sdf>");
  file("empty/readme", "");
  file("light/model.sdf", "<sdf version=\"1.9\"><light name=\"sun\"/></sdf>");
  file("no.sdf", "<sdf version=\"1.9\"/>");
  const auto has = [&](const std::string& include, const std::string& words) {
    const std::string said = refusal(robot_with(include));
    EXPECT_NE(said.find(words), std::string::npos) << said;
    EXPECT_TRUE(said.starts_with("r.sdf:1: <include>")) << said;
  };
  has("<include/>", "no <uri>");
  has("<include><uri>gone</uri></include>", "there is nothing of that name");
  has("<include><uri>model://gone_from_here</uri></include>", "no folder called gone_from_here");
  has("<include><uri>https://fuel.gazebosim.org/x</uri></include>", "get it onto this machine");
  has("<include><uri>empty</uri></include>", "the folder has no model.sdf");
  has("<include><uri>no.sdf</uri></include>", "has no <model>");
  has("<include merge=\"true\"><uri>self</uri></include>", "merge");
  EXPECT_NE(refusal(robot_with("<include><uri>self</uri></include>")).find("includes itself"),
            std::string::npos);
  EXPECT_EQ(parse_sdf(included(robot_with("<include><uri>light</uri></include>")), "r.sdf")
                .robot.links.size(),
            2U);
}

}  // namespace
}  // namespace kaboum::robot
