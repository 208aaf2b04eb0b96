#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/robot/link_meshes.h>

#include <cmath>
#include <numbers>
#include <tuple>

#include "robots.h"

namespace kaboum::test {
namespace {

const std::string kLinks = "<link name='a'/><link name='b'/><link name='c'/>";

std::string joint(const std::string& name, const std::string& type, const std::string& parent,
                  const std::string& child, const std::string& inside = "") {
  return "<joint name='" + name + "' type='" + type + "'><parent link='" + parent +
         "'/><child link='" + child + "'/><axis xyz='0 0 2'/>" + inside + "</joint>";
}

std::string robot_of(const std::string& inside) { return "<robot name='r'>" + inside + "</robot>"; }

Robot parse(const std::string& text) { return parse_urdf(text, "r.urdf"); }

std::string message(const std::string& text, bool urdf = true) {
  try {
    urdf ? parse_urdf(text, "r.urdf") : parse_rl(text, "r.xml");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
    return error.what();
  }
  return "no error";
}

std::string versioned(const std::string& version, const std::string& inside) {
  return "<robot name='r' version='" + version + "'>" + inside + "</robot>";
}

std::string shaped(const std::string& shape) {
  return "<link name='a'><collision><geometry>" + shape + "</geometry></collision></link>";
}

/// Capsules and quaternions are of 1.1; 1.2 wants both limits, and takes those of continuous
/// joints.
TEST(Urdf, NewVersions) {
  const std::string capsule = shaped("<capsule radius='0.1' length='0.5'/>");
  EXPECT_NE(message(robot_of(capsule)).find("URDF 1.1"), std::string::npos);
  EXPECT_NE(message(versioned("1.0", capsule)).find("r.urdf:1:"), std::string::npos);
  for (const char* version : {"1.1", "1.2"}) {
    const Geometry read = parse(versioned(version, capsule)).links[0].collision.at(0);
    EXPECT_EQ(read.shape, Geometry::Shape::Capsule);
    EXPECT_EQ(read.size, Vec3(0.1, 0.5, 0.5));
  }
  const Robot ball = parse(versioned("1.1", shaped("<capsule radius='0.1' length='0'/>")));
  EXPECT_EQ(ball.links[0].collision.at(0).shape, Geometry::Shape::Sphere);
  EXPECT_NE(message(versioned("1.3", kLinks)).find("1.3 is not known"), std::string::npos);
  EXPECT_NE(message(versioned("1.1", shaped("<capsule radius='-1' length='1'/>"))), "no error");
  EXPECT_NE(message(versioned("1.1", shaped("<capsule radius='1'/>"))), "no error");

  const auto turned = [](const std::string& version, const std::string& origin) {
    return versioned(version, "<link name='a'/><link name='b'/>" +
                                  joint("j", "fixed", "a", "b", "<origin " + origin + "/>"));
  };
  const Robot robot = parse(turned("1.1", "xyz='1 2 3' quat_xyzw='0 0 3 4'"));
  const Mat3 third = rotation_about(Vec3::UnitZ(), 2 * std::atan2(3, 4));
  EXPECT_LT((robot.joints[0].origin.linear - third).norm(), 1e-15);
  EXPECT_EQ(robot.joints[0].origin.translation, Vec3(1, 2, 3));
  EXPECT_NE(message(turned("1.0", "quat_xyzw='0 0 0 1'")), "no error");
  for (const char* wrong : {"quat_xyzw='0 0 0 1' rpy='0 0 0'", "quat_xyzw='0 0 0 0'",
                            "quat_xyzw='0 0 1'", "quat_xyzw='0 0 0 nan'"})
    EXPECT_NE(message(turned("1.1", wrong)), "no error") << wrong;

  const auto limited = [](const std::string& version, const char* type, const std::string& limit) {
    return versioned(version,
                     "<link name='a'/><link name='b'/>" + joint("j", type, "a", "b", limit));
  };
  const std::string half = "<limit lower='-1' effort='1' velocity='1' acceleration='1' jerk='1'/>";
  EXPECT_EQ(parse(limited("1.1", "revolute", half)).variables[0].upper, 0);
  EXPECT_NE(message(limited("1.2", "revolute", half)).find("both lower and upper"),
            std::string::npos);
  const std::string both = "<limit lower='-1' upper='1' effort='1' velocity='1'/>";
  EXPECT_NE(message(limited("1.2", "prismatic", "")).find("wants <limit"), std::string::npos);
  EXPECT_EQ(parse(limited("1.1", "continuous", both)).variables[0].upper, std::nullopt);
  EXPECT_EQ(parse(limited("1.2", "continuous", both)).variables[0].upper, 1);
}

/// What a joint cannot say is fixed, and named with its line.
TEST(Urdf, JointsThatAreNotModelled) {
  for (const char* type : {"planar", "floating"}) {
    const Robot robot =
        parse(robot_of("<link name='a'/>\n<link name='b'/>" + joint("j", type, "a", "b")));
    EXPECT_EQ(robot.variables.size(), 0U);
    ASSERT_EQ(robot.unmodelled.size(), 1U);
    EXPECT_EQ(robot.unmodelled[0], "r.urdf:2: joint 'j' is planar or floating");
  }
}

/// Readers of ROS refuse such joints; others take them.
TEST(Urdf, JointsWithoutLimits) {
  for (const char* type : {"revolute", "prismatic"}) {
    const Robot robot =
        parse(robot_of("<link name='a'/>\n<link name='b'/>" + joint("j", type, "a", "b")));
    ASSERT_EQ(robot.variables.size(), 1U);
    EXPECT_EQ(robot.variables[0].lower, std::nullopt);
    ASSERT_EQ(robot.notes.size(), 1U);
    EXPECT_TRUE(robot.notes[0].starts_with("r.urdf:2: joint 'j' has no <limit>"));
  }
}

/// The hull of its points holds a capsule or an ellipsoid, and reaches little beyond.
TEST(Primitives, RoundShapesAreBounded) {
  for (const Geometry::Shape shape : {Geometry::Shape::Capsule, Geometry::Shape::Ellipsoid}) {
    Geometry g;
    g.shape = shape;
    g.size = {0.2, 0.7, shape == Geometry::Shape::Capsule ? 0.7 : 0.4};
    const auto hull = geom::convex_hull(bounding_points(g));
    ASSERT_TRUE(hull);
    const auto support = [&](const Vec3& n) {
      if (shape == Geometry::Shape::Ellipsoid) return n.cwiseProduct(g.size).norm();
      return g.size.x() + std::abs(n.z()) * g.size.y() / 2;
    };
    for (const geom::Triangle& t : hull->triangles) {
      const Vec3 &a = hull->vertices[t[0]], &b = hull->vertices[t[1]], &c = hull->vertices[t[2]];
      const Vec3 n = (b - a).cross(c - a).normalized();
      EXPECT_GE(n.dot(a), support(n) * (1 - 1e-15));
      EXPECT_LE(n.dot(a), support(n) + bounding_excess(g));
    }
  }
}

TEST(Urdf, JointsOfAllKinds) {
  const Robot robot = parse(robot_of(
      kLinks + "<link name='d'/><link name='e'/>" +
      joint("j1", "revolute", "a", "b",
            "<origin xyz='1 2 3' rpy='0 0 1.5707963267948966'/>"
            "<limit lower='-1' upper='2' effort='1' velocity='1'/>") +
      joint("j2", "prismatic", "b", "c", "<limit lower='0' upper='1' effort='1' velocity='0'/>") +
      joint("j3", "continuous", "c", "d",
            "<limit effort='1' velocity='1.5'/>"
            "<mimic joint='j1' multiplier='-2' offset='0.5'/>") +
      joint("j4", "fixed", "d", "e", "<origin xyz='0 0 1'/>")));
  ASSERT_EQ(robot.links.size(), 5U);
  ASSERT_EQ(robot.variables.size(), 2U);
  EXPECT_EQ(robot.variables[0].name, "j1");
  EXPECT_EQ(robot.variables[0].lower, -1);
  EXPECT_EQ(robot.variables[0].velocity, 0.75) << "j3 turns twice as fast";
  EXPECT_EQ(robot.variables[1].velocity, std::nullopt) << "0 says nothing";
  EXPECT_EQ(robot.joints[2].variable, 0U);
  EXPECT_EQ(robot.joints[2].multiplier, -2);
  EXPECT_EQ(robot.joints[0].axis, Vec3(0, 0, 1));
  const std::vector<double> q{0.25, 0.75};
  const std::vector<Transform> poses = forward(robot, q);
  // j3 turns by −2 · 0.25 + 0.5 = 0.
  EXPECT_LT((poses[4].translation - Vec3(1, 2, 4.75)).norm(), 1e-15);
  EXPECT_LT((poses[4].linear - rotation_from_rpy(0, 0, std::numbers::pi / 2 + 0.25)).norm(), 1e-15);
}

TEST(Urdf, Shapes) {
  const Robot robot = parse(robot_of(
      "<link name='a'><collision><origin xyz='0 0 1'/><geometry><box size='1 2 3'/></geometry>"
      "</collision><collision><geometry><cylinder radius='0.5' length='2'/></geometry></collision>"
      "<visual><geometry><sphere radius='2'/></geometry></visual>"
      "<visual><geometry><mesh filename='package://x/y.stl' scale='1 -1 0.001'/></geometry>"
      "</visual></link>"));
  const Link& link = robot.links[0];
  ASSERT_EQ(link.collision.size(), 2U);
  ASSERT_EQ(link.visual.size(), 2U);
  EXPECT_EQ(link.collision[0].size, Vec3(1, 2, 3));
  EXPECT_EQ(link.visual[1].mesh, "package://x/y.stl");
  EXPECT_EQ(link.visual[1].size, Vec3(1, -1, 0.001));
  const Robot scaled = parse(robot_of(
      "<link name='a'><visual><geometry><mesh filename='y.stl' scale=' .5'/></geometry></visual>"
      "</link>"));
  EXPECT_EQ(scaled.links[0].visual[0].size, Vec3(0.5, 0.5, 0.5));
  // Polytopes round round shapes: every point of these is inside.
  const auto cylinder = geom::convex_hull(bounding_points(link.collision[1]));
  const auto sphere = geom::convex_hull(bounding_points(link.visual[0]));
  ASSERT_TRUE(cylinder && sphere);
  double round_excess = 0, ball_excess = 0;
  for (const Vec3& p : cylinder->vertices)
    round_excess = std::max(round_excess, std::hypot(p.x(), p.y()) - 0.5);
  for (const Vec3& p : sphere->vertices) ball_excess = std::max(ball_excess, p.norm() - 2);
  EXPECT_LE(round_excess, bounding_excess(link.collision[1]));
  EXPECT_GT(round_excess, 0.9 * bounding_excess(link.collision[1]));
  EXPECT_LE(ball_excess, bounding_excess(link.visual[0]));
  EXPECT_GT(ball_excess, 0.9 * bounding_excess(link.visual[0]));
  EXPECT_EQ(bounding_excess(link.collision[0]), 0);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 d = Vec3(normal(random), normal(random), normal(random)).normalized();
    EXPECT_EQ(distance_to(*sphere, 2 * d), 0);
    EXPECT_GT(distance_to(*sphere, 2.05 * d), 0);
    const Vec3 round = 0.5 * Vec3(d.x(), d.y(), 0).normalized();
    EXPECT_EQ(distance_to(*cylinder, round + Vec3(0, 0, i % 2 == 0 ? 1 : -0.3)), 0);
    EXPECT_GT(distance_to(*cylinder, 1.01 * round), 0);
  }
}

TEST(Urdf, ShapesOfSizeZeroAreKept) {
  const Robot robot = parse(
      robot_of("<link name='a'>\n"
               "<collision><geometry><cylinder radius='0.2' length='0'/></geometry></collision>\n"
               "<collision><geometry><cylinder radius='0' length='3'/></geometry></collision>\n"
               "<collision><geometry><box size='1 0 2'/></geometry></collision>\n"
               "<collision><geometry><box size='0 0 4'/></geometry></collision>\n"
               "<collision><geometry><box size='0 0 0'/></geometry></collision>\n"
               "<collision><geometry><sphere radius='0'/></geometry></collision></link>"));
  const std::vector<Geometry>& shapes = robot.links[0].collision;
  ASSERT_EQ(shapes.size(), 6U);
  const std::vector<std::string> words{"cylinder of length 0",    "cylinder of radius 0",
                                       "box with 1 of 3 sides 0", "box with 2 of 3 sides 0",
                                       "box with 3 of 3 sides 0", "sphere of radius 0"};
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    EXPECT_EQ(shapes[i].line, static_cast<int>(i) + 2);
    EXPECT_EQ(describe(shapes[i]), words[i]);
    EXPECT_TRUE(is_flat(shapes[i]));
    EXPECT_EQ(is_point(shapes[i]), i >= 4);
    if (i >= 4) {
      EXPECT_THROW(bounding_points(shapes[i]), Error);
    }
  }
  // What bounds them has a volume, holds them, and is no larger than said.
  const std::vector<std::vector<Vec3>> held{
      {{0.2, 0, 0}, {0, -0.2, 0}, {0.14, 0.14, 0}},
      {{0, 0, 1.5}, {0, 0, -1.5}},
      {{0.5, 0, 1}, {-0.5, 0, 1}, {0.5, 0, -1}, {-0.5, 0, -1}},
      {{0, 0, 2}, {0, 0, -2}}};
  for (std::size_t i = 0; i < held.size(); ++i) {
    const auto hull = geom::convex_hull(bounding_points(shapes[i]));
    ASSERT_TRUE(hull);
    EXPECT_GT(geom::signed_volume(*hull), 0);
    for (const Vec3& p : held[i]) EXPECT_EQ(distance_to(*hull, p), 0);
    const auto flat = geom::bounding_box(geom::Mesh{held[i], {}});
    for (const Vec3& p : hull->vertices)
      EXPECT_LE((p.cwiseAbs() - flat.max.cwiseAbs()).maxCoeff(), bounding_excess(shapes[i]));
    EXPECT_LT(bounding_excess(shapes[i]), 0.01 * 4);
  }
}

TEST(Urdf, OneShapeInAGeometry) {
  const auto two = [](const std::string& tag) {
    return robot_of("<link name='a'><" + tag +
                    "><geometry><sphere radius='1'/>\n<box size='1 2 3'/></geometry></" + tag +
                    "></link>");
  };
  const std::string wrong = ":2: link 'a': a second shape in one <geometry>: give it a <";
  EXPECT_NE(message(two("collision")).find(wrong + "collision>"), std::string::npos);
  // Of shapes for drawing, it is told, and refused where they are meant.
  const Robot drawn = parse(two("visual"));
  EXPECT_EQ(drawn.links[0].visual.size(), 1U);
  ASSERT_EQ(drawn.notes.size(), 1U);
  EXPECT_NE(drawn.notes[0].find(wrong + "visual>"), std::string::npos);
  ShapeChoice choice;
  EXPECT_TRUE(choice.shapes_of(drawn.links[0]).empty());
  choice.visual = true;
  EXPECT_THROW(std::ignore = choice.shapes_of(drawn.links[0]), Error);

  // Drake's mark of a convex mesh is no shape, wherever it is.
  for (const std::string mesh : {"<mesh filename='m.obj'/><drake:declare_convex/>",
                                 "<drake:declare_convex/><mesh filename='m.obj'/>",
                                 "<mesh filename='m.obj'><drake:declare_convex/></mesh>"}) {
    const Robot marked = parse(
        robot_of("<link name='a'><collision><geometry>" + mesh + "</geometry></collision></link>"));
    EXPECT_EQ(marked.links[0].collision.size(), 1U);
    EXPECT_TRUE(marked.notes.empty());
  }
  EXPECT_NE(message(robot_of("<link name='a'><collision><geometry><mesh filename='m.obj'/>"
                             "<drake:declare_convex><box/></drake:declare_convex></geometry>"
                             "</collision></link>"))
                .find("a second shape"),
            std::string::npos);
}

TEST(Urdf, WorldIsImplied) {
  const Robot robot = parse(robot_of("<link name='a'/>\n" + joint("j", "fixed", "world", "a")));
  ASSERT_EQ(robot.links.size(), 2U);
  EXPECT_EQ(robot.links[0].name, "world");
  EXPECT_EQ(robot.links[1].name, "a");
  ASSERT_EQ(robot.notes.size(), 1U);
  EXPECT_NE(robot.notes[0].find("r.urdf:2: joint 'j' begins at link 'world'"), std::string::npos)
      << robot.notes[0];
  // One of the file's own is not implied, and no other name is.
  EXPECT_TRUE(
      parse(robot_of("<link name='world'/><link name='a'/>" + joint("j", "fixed", "world", "a")))
          .notes.empty());
  EXPECT_NE(message(robot_of("<link name='a'/>" + joint("j", "fixed", "base", "a")))
                .find("its parent link 'base' does not exist"),
            std::string::npos);
}

TEST(Urdf, BadFilesAreRefused) {
  const std::string limit = "<limit lower='0' upper='1' effort='1' velocity='1'/>";
  const auto has = [](const std::string& text, const std::string& words) {
    const std::string got = message(text);
    EXPECT_NE(got.find(words), std::string::npos) << got;
    EXPECT_NE(got.find("r.urdf"), std::string::npos) << got;
  };
  has("", "the file is empty");
  has("<robot", "r.urdf:1");
  has("<mesh/>", "expected <robot>");
  has(robot_of(""), "r.urdf");
  has(robot_of(kLinks + joint("j", "spring", "a", "b")), "");
  has(robot_of(kLinks + joint("j", "fixed", "a", "b") + joint("k", "fixed", "c", "b")), "already");
  has(robot_of(kLinks + joint("j", "fixed", "a", "b")), "");  // c is alone: two roots
  has(robot_of(kLinks + joint("j", "fixed", "b", "c") + joint("k", "fixed", "c", "b")),
      "connected");
  has(robot_of(kLinks + joint("j", "fixed", "a", "x")), "");
  has(robot_of(kLinks + joint("j", "continuous", "a", "b", "<mimic joint='z'/>") +
               joint("k", "fixed", "b", "c")),
      "does not exist");
  has(robot_of(kLinks + joint("j", "continuous", "a", "b", "<mimic joint='k'/>") +
               joint("k", "continuous", "b", "c", "<mimic joint='j'/>")),
      "circle");
  has(robot_of(kLinks + joint("j", "continuous", "a", "b", "<mimic joint='k'/>") +
               joint("k", "fixed", "b", "c")),
      "fixed");
  has(robot_of(kLinks +
               "<joint name='j' type='continuous'><parent link='a'/><child link='b'/>"
               "<axis xyz='0 0 0'/></joint>" +
               joint("k", "fixed", "b", "c")),
      "direction");
  has(robot_of(kLinks + joint("j", "fixed", "a", "b", "<origin xyz='0 nan 0'/>") +
               joint("k", "fixed", "b", "c")),
      "");
  has(robot_of(kLinks + joint("j", "fixed", "a", "b", "<origin xyz='0 1e999 0'/>") +
               joint("k", "fixed", "b", "c")),
      "");
  has(robot_of("<link name='a'>\n<collision><geometry>\n<box size='1 -2 1'/></geometry>"
               "</collision></link>"),
      "r.urdf:3: link 'a': a box whose size is negative");
  has(robot_of(
          "\n<link name='a'><visual><geometry><sphere radius='x'/></geometry></visual></link>"),
      "r.urdf:2: <sphere>: radius is 'x', no finite number");
  has(robot_of(kLinks + "\n<gazebo><xacro:if value='1'/></gazebo>"), "r.urdf:2: <xacro:if>");
  has(robot_of("<link name='${prefix}a'/>"), "run: xacro");
  // What readers would leave out without a word.
  const std::string box = "<geometry><box size='1 1 1'/></geometry>";
  has(robot_of("<link name='a'>\n<Collision>" + box + "</Collision></link>"), ":2: <Collision>");
  has(robot_of("<link name='a'><group><collision>" + box + "</collision></group></link>"),
      "<group>");
  has(robot_of("<link name='a'/><include filename='b.urdf'/>"), "<include>");
  has(robot_of("<link name='a'/><xi:include href='b.urdf'/>"), "<xi:include>");
  has(robot_of("<link name='a'><link name='b'/></link>"), "<link> in <link>");
  has(robot_of("<link name='a'/><group><joint name='j'/></group>"), "<group>");
  has(robot_of("<link name='a'><collision><geometry><mesh filename='m.stl'><origin xyz='0 0 1'/>"
               "</mesh></geometry></collision></link>"),
      "belongs beside <geometry>");
  has(robot_of("<link name='a'/>") + robot_of("<link name='b'/>"), "one robot");
  for (const std::string tag : {"self_collision_checking", "self_filter"}) {
    std::string link = "<link name='a'><";
    link.append(tag).append(">").append(box).append("</").append(tag).append("></link>");
    EXPECT_EQ(message(robot_of(link)), "no error");
  }
  EXPECT_EQ(message(robot_of("<link name='a'/><gazebo reference='a'><visual/></gazebo>"
                             "<transmission name='t'><joint name='j'/></transmission>"
                             "<material name='grey'/>")),
            "no error");
  has(robot_of("<link name='a'><visual><geometry><mesh filename='$(find p)/m.stl'/></geometry>"
               "</visual></link>"),
      "run: xacro");
  has(robot_of("<link name='a'><collision><geometry><mesh filename='x' scale='1 0 1'/></geometry>"
               "</collision></link>"),
      "0");
  has(robot_of("<link name='a'><collision><geometry><mesh filename='x' scale='1 2'/></geometry>"
               "</collision></link>"),
      "three finite numbers");
  std::string deep = "<robot name='r'>";
  for (int i = 0; i < 100000; ++i) deep += "<link>";
  has(deep, "r.urdf");
  std::string closed = "<robot name='r'>";
  for (int i = 0; i < 400; ++i) closed += "<x>";
  for (int i = 0; i < 400; ++i) closed += "</x>";
  has(closed + "</robot>", "DEPTH");
  has(std::string("<robot>\0</robot>", 16), "text");
}

TEST(Urdf, SurvivesGarbage) {
  // Cut short, and with bytes replaced: an error or a robot, nothing else.
  const std::string good = robot_of(
      kLinks +
      joint("j1", "revolute", "a", "b", "<limit lower='-1' upper='2' effort='1' velocity='1'/>") +
      joint("j2", "continuous", "b", "c", "<mimic joint='j1'/>"));
  ASSERT_EQ(message(good), "no error");
  std::mt19937_64 random(11);
  for (int i = 0; i < 3000; ++i) {
    std::string text = good;
    if (i % 3 == 0) text.resize(random() % text.size());
    for (int k = 0; k < 3 && !text.empty(); ++k)
      text[random() % text.size()] = static_cast<char>("<>/'\"= 0-9az&;\n"[random() % 15]);
    message(text);
  }
}

TEST(CorpusRl, BothDescriptionsOfThePuma) {
  const std::string kin = robot_file("puma560-vrml/unimation-puma560-rlkin.xml");
  const std::string mdl = robot_file("puma560-vrml/unimation-puma560-rlmdl.xml");
  const Robot a = parse_rl(kin, "kin"), b = parse_rl(mdl, "mdl");
  ASSERT_EQ(a.variables.size(), 6U);
  EXPECT_NEAR(*a.variables[1].lower, -225 * std::numbers::pi / 180, 1e-15);
  EXPECT_EQ(a.variables[0].velocity, std::nullopt);
  EXPECT_NEAR(b.variables[0].velocity.value_or(0), 320 * std::numbers::pi / 180, 1e-14);
  std::mt19937_64 random(6);
  for (int trial = 0; trial < 100; ++trial) {
    const std::vector<double> q = random_path(a, random, 1, 3, false).front();
    const auto pa = forward(a, q), pb = forward(b, q);
    for (int l = 0; l <= 6; ++l) {
      const Transform& x = pa[*a.find_link("link" + std::to_string(l))];
      const Transform& y = pb[*b.find_link("body" + std::to_string(l))];
      EXPECT_LT((x.linear - y.linear).norm() + (x.translation - y.translation).norm(), 1e-14);
    }
  }
  // Where the scene draws the links at rest.
  const auto rest = forward(a, std::vector<double>(6, 0));
  EXPECT_LT((rest[*a.find_link("link2")].translation - Vec3(0.4318, 0.1291, 0.6604)).norm(), 1e-12);
  EXPECT_LT((rest[*a.find_link("link4")].translation - Vec3(0.4115, 0.1291, 1.0935)).norm(), 1e-12);
}

TEST(Rl, BadFilesAreRefused) {
  const auto has = [](const std::string& text, const std::string& words) {
    const std::string got = message(text, false);
    EXPECT_NE(got.find(words), std::string::npos) << got;
  };
  const auto of = [](const std::string& inside) { return "<rlkin><x>" + inside + "</x></rlkin>"; };
  const std::string ends = "<frame><a idref='w'/><b idref='l'/></frame>";
  const std::string frames = "<world id='w'/><link id='l'/>";
  EXPECT_EQ(message(of(frames + "<transform id='t'>" + ends + "</transform>"), false), "no error");
  has("<rlkin>", "XML");
  has("<rlkin/>", "no kinematics");
  has("<robot/>", "expected <rlkin>");
  has(of("<link/>"), "no id");
  has(of("<world id='w'><translation><x>5</x></translation></world>"), "moved or turned");
  has(of("<world id='w'><rotation><z>90</z></rotation></world>"), "moved or turned");
  has(of(frames + "<helical id='t'>" + ends + "</helical>"), "<helical>");
  has(of("<world id='w'/><transform>" + ends + "</transform>"), "'l'");
  has(of(frames + "<revolute id='t'>" + ends + "<dh><a>1x</a></dh></revolute>"), "'1x'");
  has(of(frames + "<revolute>" + ends + "</revolute>"), "no id");
  has(of(frames + "<link id='l'/>"), "exists already");
  has(of(frames + "<fixed>" + ends + "</fixed><fixed>" + ends + "</fixed>"), "two joints");
  has(of(frames + "<fixed>" + ends +
         "</fixed><fixed><frame><a idref='l'/><b idref='w'/></frame></fixed>"),
      "nothing moves");
}

}  // namespace
}  // namespace kaboum::test
