// MJCF and SDF robots: what is read and refused, and what an edit changes. tests/engines compares
// poses with the engines.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/robot/inertial_edit.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/sdf.h>

#include <functional>
#include <map>
#include <numbers>
#include <set>

namespace kaboum::robot {
namespace {

using Shape = Geometry::Shape;

std::string refusal(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
    return error.what();
  }
  return "no error";
}

std::string mjcf(const std::string& bodies, const std::string& before = "") {
  return "<mujoco model='m'>" + before + "<worldbody>" + bodies + "</worldbody></mujoco>";
}

MjcfRobot parse(const std::string& text) { return parse_mjcf(text, "m.xml"); }

/// A link by its name.
const Link& link_of(const Robot& robot, const std::string& name) {
  return robot.links.at(robot.find_link(name).value());
}

TEST(Mjcf, ClassesFramesAndReplicas) {
  const Robot robot =
      parse(mjcf("<body name='a' childclass='c'><joint name='j' range='-90 90'/>"
                 "<geom size='0.1'/><geom class='drawn' size='0.2'/>"
                 "<frame pos='1 0 0'><body name='b' pos='0 1 0'><geom type='box' size='1 2 3'/>"
                 "</body></frame>"
                 "<replicate count='2' offset='0 0 1' sep='_'><body name='r'/></replicate></body>",
                 "<default><default class='c'><joint axis='0 2 0'/></default>"
                 "<default class='drawn'><geom contype='0' conaffinity='0'/></default></default>"))
          .robot;
  ASSERT_EQ(robot.variables.size(), 1U);
  EXPECT_DOUBLE_EQ(robot.variables[0].upper.value(), std::numbers::pi / 2);
  EXPECT_EQ(robot.joints[0].axis, Vec3(0, 1, 0));
  EXPECT_EQ(link_of(robot, "a").collision.size(), 1U);
  EXPECT_EQ(link_of(robot, "a").visual.size(), 1U);
  EXPECT_EQ(link_of(robot, "b").collision.at(0).size, Vec3(2, 4, 6)) << "half lengths";
  EXPECT_EQ(link_of(robot, "b").visual.size(), 1U) << "MuJoCo draws what collides";
  const std::vector<double> q{0};
  const std::vector<Transform> poses = forward(robot, q);
  EXPECT_EQ(poses[robot.find_link("b").value()].translation, Vec3(1, 1, 0));
  EXPECT_EQ(poses[robot.find_link("r_1").value()].translation, Vec3(0, 0, 1));
}

/// A joint beside the body's origin, and several of one body.
TEST(Mjcf, JointsOfABody) {
  const Robot robot =
      parse(mjcf("<body name='a'><joint type='hinge' pos='1 0 0' axis='0 0 1' ref='90'/>"
                 "<joint type='slide' axis='1 0 0'/></body>"))
          .robot;
  ASSERT_EQ(robot.variables.size(), 2U);
  const std::vector<double> q{std::numbers::pi / 2 + std::numbers::pi, 0.5};
  const Transform pose = forward(robot, q)[robot.find_link("a").value()];
  // Half a turn about x = 1, then half a unit along what was x.
  EXPECT_LT((pose.translation - Vec3(1.5, 0, 0)).norm(), 1e-15);
}

TEST(Mjcf, WhatIsNotModelledIsNamed) {
  for (const char* joint : {"<freejoint/>", "<joint type='ball'/>", "<joint type='free'/>"}) {
    const Robot robot = parse(mjcf(std::string("\n<body name='a'>") + joint + "</body>")).robot;
    ASSERT_EQ(robot.unmodelled.size(), 1U) << joint;
    EXPECT_TRUE(robot.unmodelled[0].starts_with("m.xml:2: joint ")) << robot.unmodelled[0];
  }
  EXPECT_EQ(parse(mjcf("<body mocap='true'/>")).robot.unmodelled.size(), 1U);
  EXPECT_EQ(parse(mjcf("<geom type='plane' size='1 1 1'/>")).robot.notes.size(), 1U);
}

TEST(Mjcf, RefusedByNameAndLine) {
  const auto has = [](const std::string& text, const std::string& words) {
    const std::string got = refusal([&] { parse(text); });
    EXPECT_NE(got.find(words), std::string::npos) << got;
    EXPECT_NE(got.find("m.xml"), std::string::npos) << got;
  };
  const std::string mesh =
      "<asset><mesh name='p' file='p.stl'/><mesh name='v' vertex='0 0 0'/></asset>";
  has("<robot name='r'/>", "expected <mujoco>");
  has(mjcf("<geom type='mesh' mesh='q'/>", mesh), "no mesh 'q'");
  has(mjcf("<geom type='mesh' mesh='v'/>", mesh), "without a file");
  has(mjcf("<geom type='box' mesh='p'/>", mesh), "fits to the mesh 'p': its size is not stated");
  has(mjcf("<geom type='sdf' mesh='p'/>", mesh), "signed distance field");
  has(mjcf("<geom class='none' size='1'/>"), "no default class 'none'");
  has(mjcf("<geom type='box' size='1 1'/>"), "not positive");
  has(mjcf("<geom size='nan'/>"), "'nan'");
  has(mjcf("<geom size='1' quat='0 0 0 0'/>"), "no rotation");
  has(mjcf("<body><joint axis='0 0 0'/></body>"), "no direction");
  has(mjcf("<flexcomp/>"), "flexible");
  has(mjcf("<attach model='x'/>"), "mj_saveLastXML");
  has(mjcf("<body><geometry/></body>"), "no element of a body");
}

/// A box of 2 × 1 × 0.5 fits itself, longest moments first: the least length is its z.
TEST(Mjcf, PrimitivesFittedToMeshes) {
  const geom::Mesh box = [] {
    geom::Mesh out;
    for (int i = 0; i < 8; ++i)
      out.vertices.emplace_back((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 0.5 : -0.5,
                                (i & 4) != 0 ? 0.25 : -0.25);
    out.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                     {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
    return out;
  }();
  const std::string mesh =
      "<asset><mesh name='p' file='p.stl' refpos='-1 0 0'/><mesh name='h' file='p.stl' "
      "inertia='convex'/></asset>";
  const auto stated = [&](const std::string& geom, const std::string& compiler = "") {
    return state_fitted_sizes(mjcf(geom, mesh + compiler), "m.xml",
                              [&](const std::string&) { return geom::Mesh(box); });
  };
  const std::string text = stated("<geom type='box' mesh='p' pos='0 0 1' fitscale='2'/>");
  const Geometry shape = parse(text).robot.links[0].collision.at(0);
  EXPECT_EQ(shape.shape, Geometry::Shape::Box);
  EXPECT_LT((shape.origin.translation - Vec3(1, 0, 1)).norm(), 1e-12);
  // The box's lengths along its axes, in whichever order and direction these are.
  const Vec3 reach = shape.origin.linear.cwiseAbs() * shape.size / 2;
  EXPECT_LT((reach - Vec3(2, 1, 0.5)).norm(), 1e-9) << reach.transpose();
  for (const char* compiler : {"", "<compiler fitaabb='true'/>"}) {
    const Geometry ball =
        parse(stated("<geom mesh='p'/>", compiler)).robot.links[0].collision.at(0);
    EXPECT_EQ(ball.shape, Geometry::Shape::Sphere);
    EXPECT_NEAR(ball.size.x(), *compiler == '\0' ? 1.75 / 3 : 1, 1e-9);
  }
  EXPECT_EQ(stated("<geom size='1'/>"), mjcf("<geom size='1'/>", mesh)) << "as it was";
  // MuJoCo 2.2.2 passes over a geom's quat where its class turns it, and takes euler before all.
  for (const char* order : {"xyz", "ZYX", "zyz"})
    for (const std::string own : {"", "euler='0 0 0'", "quat='1 2 0 0'"}) {
      const std::string geom = "<geom type='box' mesh='p' pos='0 0 1' class='c' " + own + "/>";
      const std::string kinds = "<compiler eulerseq='" + std::string(order) +
                                "'/><default><geom zaxis='1 1 0'/><default class='c'><geom "
                                "axisangle='1 2 3 40'/></default></default>";
      const std::string turned = stated(geom, kinds);
      EXPECT_NE(turned.find("euler=\""), std::string::npos) << turned;
      EXPECT_EQ(turned.find(" quat=\""), std::string::npos) << turned;
      const Transform got = parse(turned).robot.links[0].collision.at(0).origin;
      const Transform frame =
          parse(mjcf("<geom type='box' size='1 1 1' pos='0 0 1' class='c' " + own + "/>", kinds))
              .robot.links[0]
              .collision.at(0)
              .origin;
      EXPECT_LT((got.translation - frame * Vec3(1, 0, 0)).norm(), 1e-12);
      const Mat3 in_mesh = frame.linear.transpose() * got.linear;
      EXPECT_LT((in_mesh.cwiseAbs() * shape.size / 4 - Vec3(1, 0.5, 0.25)).norm(), 1e-9) << turned;
    }
  const std::string degenerate = refusal([&] {
    stated("<geom type='box' mesh='p'/>",
           "<compiler eulerseq='xYz'/><default><geom euler='0 0 90'/></default>");
  });
  EXPECT_NE(degenerate.find("states not every rotation"), std::string::npos) << degenerate;
  const std::string hull = refusal([&] { stated("<geom type='box' mesh='h'/>"); });
  EXPECT_NE(hull.find("the hull of the mesh 'h'"), std::string::npos) << hull;
}

/// A class's rotation that an element's own one stands for here, and not in older engines.
TEST(Mjcf, RotationsThatEnginesTakeDifferently) {
  const auto notes = [](const std::string& own, const std::string& of_class) {
    const Robot robot =
        parse(mjcf("<geom size='1' " + own + "/>", "<default><geom " + of_class + "/></default>"))
            .robot;
    return robot.notes.size();
  };
  EXPECT_EQ(notes("quat='1 0 0 0'", "euler='0 0 90'"), 1U);
  EXPECT_EQ(notes("axisangle='1 0 0 10'", "zaxis='0 1 0'"), 1U);
  EXPECT_EQ(notes("euler='0 0 0'", "zaxis='0 1 0'"), 0U);
  EXPECT_EQ(notes("euler='0 0 0'", "euler='0 0 90'"), 0U);
  EXPECT_EQ(notes("quat='1 0 0 0'", "quat='0 0 0 1'"), 0U);
  EXPECT_EQ(notes("", "euler='0 0 90'"), 0U);
}

TEST(Mjcf, Includes) {
  const auto read = [](const std::string& file) -> std::string {
    if (file == "b.xml")
      return "<mujocoinclude><body name='b'><include file='c.xml'/></body></mujocoinclude>";
    return "<mujocoinclude><geom size='1'/></mujocoinclude>";
  };
  const std::string text = expand_mjcf(mjcf("<include file='b.xml'/>"), "m.xml", read);
  EXPECT_EQ(link_of(parse(text).robot, "b").collision.size(), 1U);
  EXPECT_NE(refusal([&] {
              expand_mjcf(mjcf("<include file='c.xml'/><include file='c.xml'/>"), "m.xml", read);
            }).find("already"),
            std::string::npos);
}

/// What an included file includes is looked for beside the model, then beside that file.
TEST(Mjcf, IncludesOfIncludes) {
  std::map<std::string, std::string> files{
      {"sub/a.xml", "<mujocoinclude><include file='b.xml'/></mujocoinclude>"},
      {"sub/b.xml", "<mujocoinclude><geom name='beside' size='1'/></mujocoinclude>"}};
  const auto expanded = [&] {
    return expand_mjcf(mjcf("<include file='sub/a.xml'/>"), "m.xml", [&](const std::string& file) {
      const auto at = files.find(file);
      if (at == files.end()) throw Error(ErrorCode::InvalidInput, file + ": no such file");
      return at->second;
    });
  };
  EXPECT_NE(expanded().find("beside"), std::string::npos);
  files["b.xml"] = "<mujocoinclude><geom name='first' size='1'/></mujocoinclude>";
  EXPECT_NE(expanded().find("first"), std::string::npos);
  files["sub/b.xml"] = "<mujocoinclude><include file='a.xml'/></mujocoinclude>";
  files.erase("b.xml");  // a circle
  EXPECT_NE(refusal(expanded).find("'sub/a.xml' is included already"), std::string::npos);
  files["sub/b.xml"] = "<mujocoinclude><include file='c.xml'/></mujocoinclude>";
  EXPECT_NE(refusal(expanded).find("c.xml: no such file"), std::string::npos);
}

/// Files that included files name are looked for in the compiler's folder, then beside those files.
TEST(Mjcf, FilesNamedByIncludes) {
  std::set<std::string> there;
  const auto name_of = [&](const std::string& compiler, const std::string& file) {
    const std::string text = expand_mjcf(
        mjcf("<include file='sub/asset/a.xml'/>", compiler), "m.xml",
        [&](const std::string&) {
          return "<mujocoinclude><asset><mesh name='x' file='" + file +
                 "'/></asset></mujocoinclude>";
        },
        [&](const std::string& path) { return there.contains(path); });
    EXPECT_EQ(text.find("included-from"), std::string::npos);
    const std::size_t begin = text.find("<mesh name=\"x\" file=\"") + 21;
    return text.substr(begin, text.find('"', begin) - begin);
  };
  const std::string compiler = "<compiler meshdir='m'/>";
  there = {"sub/asset/g/x.stl"};
  EXPECT_EQ(name_of("", "g/x.stl"), "sub/asset/g/x.stl");
  EXPECT_EQ(name_of(compiler, "g/x.stl"), "../sub/asset/g/x.stl");
  there = {"sub/asset/../g/x.stl"};
  EXPECT_EQ(name_of("", "../g/x.stl"), "sub/g/x.stl");
  there = {"sub/asset/g/x.stl", "m/g/x.stl"};
  EXPECT_EQ(name_of(compiler, "g/x.stl"), "g/x.stl");
  there = {};
  EXPECT_EQ(name_of("", "g/x.stl"), "g/x.stl");
}

ShapeEdit edit_with(bool visual, std::vector<std::vector<ShapeMeshes>> links) {
  ShapeEdit edit;
  edit.visual = visual;
  edit.links = std::move(links);
  edit.moved = [](const std::string& file) { return "../" + file; };
  return edit;
}

/// Two bodies for a mesh: the old geom goes where it neither is drawn nor weighs.
TEST(Mjcf, Edit) {
  const std::string before =
      "<compiler meshdir='d'/><asset><mesh name='p' file='p.stl' scale='2 2 2'/></asset>";
  const std::string text = mjcf(
      "<body name='a'><inertial pos='0 0 0' mass='1' diaginertia='1 1 1'/>"
      "<geom name='old' type='mesh' mesh='p' pos='1 0 0' friction='0.3'/>"
      "<geom type='mesh' mesh='p' contype='0' conaffinity='0'/></body>"
      "<body name='b'><geom type='mesh' mesh='p'/></body>",
      before);
  const ShapeMeshes two = std::vector<std::string>{"bodies/p-0.stl", "bodies/p-1.stl"};
  const std::string out = mjcf_with_shapes(text, "m.xml", edit_with(false, {{}, {two}, {two}}));
  const Robot robot = parse(out).robot;
  const Link& a = link_of(robot, "a");
  ASSERT_EQ(a.collision.size(), 2U);
  EXPECT_EQ(a.collision[1].mesh, "bodies/p-1.stl");
  EXPECT_EQ(a.collision[0].size, Vec3(2, 2, 2));
  EXPECT_EQ(a.collision[0].origin.translation, Vec3(1, 0, 0));
  EXPECT_EQ(a.visual.size(), 1U);
  EXPECT_EQ(a.visual[0].mesh, "../d/p.stl");
  EXPECT_EQ(out.find("name=\"old\""), std::string::npos);
  EXPECT_NE(out.find("friction=\"0.3\""), std::string::npos);
  const Link& b = link_of(robot, "b");
  EXPECT_EQ(b.collision.size(), 2U);
  EXPECT_EQ(b.visual.size(), 1U) << "it weighs, and is drawn";
  EXPECT_NE(out.find("mass=\"0\""), std::string::npos);

  const Robot drawn =
      parse(mjcf_with_shapes(text, "m.xml", edit_with(true, {{}, {two}, {two}}))).robot;
  EXPECT_EQ(link_of(drawn, "a").collision.size(), 2U);
  EXPECT_EQ(link_of(drawn, "a").collision[0].origin.translation, Vec3(0, 0, 0));
  EXPECT_EQ(link_of(drawn, "b").collision.size(), 2U);
}

std::string sdf(const std::string& inside) {
  return "<sdf version='1.9'><model name='s'>" + inside + "</model></sdf>";
}

TEST(Sdf, FramesAndShapes) {
  const Robot robot =
      parse_sdf(sdf("<link name='a'><pose>1 0 0 0 0 0</pose><collision name='c'><geometry><capsule>"
                    "<radius>1</radius><length>2</length></capsule></geometry></collision></link>"
                    "<link name='b'><pose relative_to='f'>0 0 1 0 0 0</pose></link>"
                    "<frame name='f' attached_to='a'><pose>0 1 0 0 0 0</pose></frame>"
                    "<joint name='j' type='revolute'><pose>0 0 1 0 0 0</pose><parent>a</parent>"
                    "<child>b</child><axis><xyz>0 1 0</xyz></axis></joint>"),
                "s.sdf")
          .robot;
  ASSERT_EQ(robot.variables.size(), 1U);
  EXPECT_EQ(link_of(robot, "a").collision.at(0).shape, Shape::Capsule);
  const std::vector<double> q{std::numbers::pi};
  const std::vector<Transform> poses = forward(robot, q);
  // b hangs one below its joint; half a turn puts it one above.
  EXPECT_LT((poses[robot.find_link("b").value()].translation - Vec3(1, 1, 3)).norm(), 1e-15);
}

TEST(Sdf, RefusedByNameAndLine) {
  const auto has = [](const std::string& text, const std::string& words) {
    const std::string got = refusal([&] { parse_sdf(text, "s.sdf"); });
    EXPECT_NE(got.find(words), std::string::npos) << got;
  };
  has("<sdf version='2.0'><model name='s'/></sdf>", "version 2.0");
  has("<sdf version='1.9'/>", "no <model>");
  has(sdf("<link name='a'/><link name='a'/>"), "there already");
  has(sdf("<link name='a'/>\n<frame name='a'/>"), "s.sdf:2: <frame>: the name 'a' is there");
  has(sdf("<link name='a'/><model name='a'><link name='b'/></model>"), "there already");
  has(sdf("<link name='__model__'/>"), "there already");
  has(sdf("<link name='a::b'/><model name='a'><link name='b'/></model>"), "'a::b' is there");
  const std::string joint =
      "<link name='a'/><link name='b'/><joint name='a' type='fixed'><parent>a</parent>"
      "<child>b</child></joint>";
  has(sdf(joint), "<joint>: the name 'a' is there already: <link> in line 1");
  has(sdf("<include><uri>model://x</uri></include>"), "gz sdf -p");
  has(sdf("<link name='a'/><model name='m'><include><uri>model://x</uri></include></model>"),
      "gz sdf -p");
  has(sdf("<link name='a'/><link name='b'/><joint name='j' type='revolute'><parent>a</parent>"
          "<child>m::b</child></joint>"),
      "no link 'm::b'");
  has(sdf("<link name='a'/><model name='m' placement_frame='f'><link name='b'/></model>"),
      "no frame 'm::f'");
  const std::string follower =
      "<link name='a'/><link name='b'/><joint name='j' type='revolute'><parent>a</parent>"
      "<child>b</child><axis><xyz>0 0 1</xyz><mimic joint='k'/></axis></joint>";
  has(sdf(follower), "'k', which does not exist");
  has(sdf(follower + "<link name='c'/><joint name='k' type='revolute'><parent>a</parent>"
                     "<child>c</child><axis><xyz>0 0 1</xyz><mimic joint='j'/></axis></joint>"),
      "in a circle");
  has(sdf("<link name='a'><pose relative_to='a'/></link>"), "relative to itself");
  has(sdf("<link name='a'><collision "
          "name='c'><geometry><heightmap/></geometry></collision></link>"),
      "not read");
  EXPECT_EQ(parse_sdf(sdf("<link name='a'/><link name='b'/><joint name='j' type='ball'>"
                          "<parent>a</parent><child>b</child></joint>"),
                      "s.sdf")
                .robot.unmodelled.size(),
            1U);
}

/// Links of nested models are called as from outside; a model is placed by a frame of its own.
TEST(Sdf, NestedModels) {
  const Robot robot =
      parse_sdf(sdf("<link name='a'><pose>0 0 1 0 0 0</pose></link>"
                    "<model name='m' placement_frame='f'><pose relative_to='a'>1 0 0 0 0 0</pose>"
                    "<frame name='f'><pose>0 0.5 0 0 0 0</pose></frame>"
                    "<link name='a'><pose>0 2 0 0 0 0</pose></link></model>"
                    "<joint name='j' type='revolute'><parent>a</parent><child>m::a</child>"
                    "<axis><xyz>0 0 1</xyz></axis></joint>"),
                "s.sdf")
          .robot;
  const std::vector<Transform> poses = forward(robot, std::vector<double>{0});
  const Transform& inner = poses[robot.find_link("m::a").value()];
  EXPECT_LT((inner.translation - Vec3(1, 1.5, 1)).norm(), 1e-15);
}

/// Before SDF 1.7 a joint may have the name of a nested model, which is what others mean by it.
TEST(Sdf, JointsThatAreCalledAsModels) {
  const Robot robot =
      parse_sdf(
          "<sdf version='1.6'><model name='s'><link name='base'/>"
          "<link name='lower'><pose>0 0 5 0 0 0</pose></link>"
          "<joint name='arm' type='fixed'><parent>base</parent><child>lower</child></joint>"
          "<model name='arm'><pose>10 0 0 0 0 0</pose><link name='tip'/></model></model></sdf>",
          "s.sdf")
          .robot;
  const std::vector<Transform> poses = forward(robot, {});
  EXPECT_EQ(poses[robot.find_link("arm::tip").value()].translation, Vec3(10, 0, 0));
  EXPECT_EQ(poses[robot.find_link("lower").value()].translation, Vec3(0, 0, 5));
}

/// A motor's limits are read as other readers do, up to a stray sign, and told; a joint's are not.
TEST(Sdf, StraySignsInLimits) {
  const auto with = [](const std::string& limits) {
    return sdf(
        "<link name='a'/><link name='b'/><joint name='j' type='revolute'><parent>a</parent>"
        "<child>b</child><axis><xyz>0 0 1</xyz><limit>" +
        limits + "</limit></axis></joint>");
  };
  const Robot robot = parse_sdf(with("<velocity>2.5\"</velocity>"), "s.sdf").robot;
  EXPECT_EQ(robot.variables.at(0).velocity, 2.5);
  ASSERT_EQ(robot.notes.size(), 1U);
  EXPECT_NE(robot.notes[0].find("s.sdf:1: <velocity>: 2.5 is taken of '2.5\"'"), std::string::npos);
  for (const std::string wrong :
       {"<velocity>\"2.5</velocity>", "<velocity>x</velocity>", "<upper>2.5\"</upper>"})
    EXPECT_NE(refusal([&] { parse_sdf(with(wrong), "s.sdf"); }).find("not 1 finite number"),
              std::string::npos)
        << wrong;
}

/// multiplier (q − reference) + offset, through another joint that follows as well.
TEST(Sdf, JointsThatFollow) {
  const auto joint = [](const std::string& name, const std::string& child,
                        const std::string& mimic) {
    return "<link name='" + child + "'/><joint name='" + name +
           "' type='revolute'><parent>a</parent><child>" + child +
           "</child><axis><xyz>0 0 1</xyz>" + mimic + "</axis></joint>";
  };
  const Robot robot =
      parse_sdf(sdf("<link name='a'/>" + joint("j", "b", "") +
                    joint("k", "c",
                          "<mimic joint='j'><multiplier>2</multiplier><offset>3"
                          "</offset><reference>0.5</reference></mimic>") +
                    joint("l", "d", "<mimic joint='k'><multiplier>-1</multiplier></mimic>")),
                "s.sdf")
          .robot;
  ASSERT_EQ(robot.variables.size(), 1U);
  EXPECT_EQ(robot.variables[0].name, "j");
  for (const Joint& joint_read : robot.joints) {
    if (joint_read.name != "k" && joint_read.name != "l") continue;
    const double sign = joint_read.name == "k" ? 1 : -1;
    EXPECT_EQ(joint_read.variable, 0U);
    EXPECT_EQ(joint_read.multiplier, sign * 2);
    EXPECT_EQ(joint_read.offset, sign * 2);
  }
}

TEST(Sdf, Edit) {
  const std::string text =
      sdf("<link name='a'><collision name='c'><pose>1 0 0 0 0 0</pose><geometry><mesh>"
          "<uri>p.stl</uri><scale>2 2 2</scale></mesh></geometry></collision></link>");
  const ShapeMeshes two = std::vector<std::string>{"bodies/p-0.stl", "bodies/p-1.stl"};
  const Robot robot =
      parse_sdf(sdf_with_shapes(text, "s.sdf", edit_with(false, {{}, {two}})), "s.sdf").robot;
  const Link& a = link_of(robot, "a");
  ASSERT_EQ(a.collision.size(), 2U);
  EXPECT_EQ(a.collision[1].mesh, "bodies/p-1.stl");
  EXPECT_EQ(a.collision[1].size, Vec3(2, 2, 2));
  EXPECT_EQ(a.collision[1].origin.translation, Vec3(1, 0, 0));
}

Inertial of_mass(double mass) {
  Inertial out;
  out.mass = mass;
  out.origin.translation = Vec3(0.1, 0.2, 0.3) * mass;
  out.inertia = Vec3(1, 2, 3).asDiagonal();
  return out;
}

/// Inertials go to the links that have them, whatever else has the same name.
TEST(Inertials, OfLinksOfOneName) {
  const std::string text =
      sdf("<model name='inner'><link name='base'><inertial><mass>3</mass></inertial></link></model>"
          "<link name='base'><inertial><mass>100</mass></inertial></link>");
  const InertialEdit outer = with_inertials(text, "s.sdf", {{"base", of_mass(7)}});
  EXPECT_TRUE(outer.missing.empty());
  Dynamics got = parse_sdf(outer.text, "s.sdf").dynamics;
  EXPECT_EQ(got.links.at("base").mass, 7);
  EXPECT_EQ(got.links.at("inner::base").mass, 3);
  const InertialEdit inner = with_inertials(text, "s.sdf", {{"inner::base", of_mass(7)}});
  EXPECT_TRUE(inner.missing.empty());
  got = parse_sdf(inner.text, "s.sdf").dynamics;
  EXPECT_EQ(got.links.at("base").mass, 100);
  EXPECT_EQ(got.links.at("inner::base").mass, 7);
}

TEST(Inertials, OfForeignElements) {
  const std::string foreign = "<gazebo><plugin><link name=\"base\"/></plugin></gazebo>";
  const InertialEdit made =
      with_inertials("<robot name='r'>" + foreign + "<link name='base'/></robot>", "r.urdf",
                     {{"base", of_mass(7)}});
  const std::map<std::string, Inertial> got = parse_dynamics(made.text, "r.urdf").links;
  EXPECT_EQ(got.at("base").mass, 7);
  EXPECT_EQ(got.at("base").origin.translation, of_mass(7).origin.translation);
  const std::size_t plugin = made.text.find("<plugin>"), end = made.text.find("</plugin>");
  EXPECT_EQ(made.text.substr(plugin, end - plugin).find("inertial"), std::string::npos);
}

/// A body without a name is called body1 before the one of that name; copies share an element.
TEST(Inertials, OfBodiesWithoutNames) {
  const std::string inertial = "<inertial pos='0 0 0' mass='2' diaginertia='1 1 1'/>";
  const std::string text = mjcf(
      "<body>" + inertial + "</body><body name='body1' pos='5 0 0'><frame pos='1 0 0'>" + inertial +
      "</frame></body><replicate count='2'><body name='r'>" + inertial + "</body></replicate>");
  const InertialEdit made = with_inertials(
      text, "m.xml",
      {{"body1", of_mass(7)}, {"body1-2", of_mass(8)}, {"r0", of_mass(9)}, {"world", of_mass(9)}});
  EXPECT_EQ(made.missing, (std::vector<std::string>{"r0", "world"}));
  const Dynamics got = parse(made.text).dynamics;
  EXPECT_EQ(got.links.at("body1").mass, 7);
  EXPECT_EQ(got.links.at("body1-2").mass, 8);
  EXPECT_EQ(got.links.at("body1-2").origin.translation, of_mass(8).origin.translation);
  EXPECT_EQ(got.links.at("r0").mass, 2);
}

/// Moments in axes that are turned are stated in the link's.
TEST(Inertials, OfTurnedAxes) {
  Inertial turned = of_mass(1);
  turned.origin.linear = rotation_from_rpy(0, 0, std::numbers::pi / 2);
  const InertialEdit made =
      with_inertials("<robot name='r'><link name='a'/></robot>", "r.urdf", {{"a", turned}});
  const Mat3 got = parse_dynamics(made.text, "r.urdf").links.at("a").inertia;
  EXPECT_LT((got - Mat3(Vec3(2, 1, 3).asDiagonal())).norm(), 1e-15);
}

}  // namespace
}  // namespace kaboum::robot
