// Our reader of URDF against urdfdom, the reader of ROS, on random robots and on real ones: the
// same links, joints, shapes and limits, and the same bits of every number.

#include <gtest/gtest.h>
#include <kaboum/robot/robot.h>
#include <urdf_parser/urdf_parser.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <random>
#include <sstream>

#include "support/corpus.h"

namespace kaboum::robot {
namespace {

Vec3 vector_of(const urdf::Vector3& v) { return {v.x, v.y, v.z}; }

void expect_pose(const Transform& ours, const urdf::Pose& theirs) {
  const urdf::Rotation& q = theirs.rotation;
  EXPECT_EQ(ours.translation, vector_of(theirs.position));
  EXPECT_EQ(ours.linear, Eigen::Quaterniond(q.w, q.x, q.y, q.z).toRotationMatrix());
}

void expect_shape(const Geometry& ours, const urdf::Pose& origin, const urdf::Geometry& theirs) {
  expect_pose(ours.origin, origin);
  if (const auto* box = dynamic_cast<const urdf::Box*>(&theirs)) {
    EXPECT_EQ(ours.shape, Geometry::Shape::Box);
    EXPECT_EQ(ours.size, vector_of(box->dim));
  } else if (const auto* sphere = dynamic_cast<const urdf::Sphere*>(&theirs)) {
    EXPECT_EQ(ours.shape, Geometry::Shape::Sphere);
    EXPECT_EQ(ours.size.x(), sphere->radius);
  } else if (const auto* cylinder = dynamic_cast<const urdf::Cylinder*>(&theirs)) {
    EXPECT_EQ(ours.shape, Geometry::Shape::Cylinder);
    EXPECT_EQ(ours.size, Vec3(cylinder->radius, cylinder->length, cylinder->length));
  } else {
    const auto& mesh = dynamic_cast<const urdf::Mesh&>(theirs);
    EXPECT_EQ(ours.shape, Geometry::Shape::Mesh);
    EXPECT_EQ(ours.mesh, mesh.filename);
    EXPECT_EQ(ours.size, vector_of(mesh.scale));
  }
}

/// Follows mimicry, as ours is stored.
const urdf::Joint& leader_of(const urdf::ModelInterface& model, const urdf::Joint& joint,
                             double& multiplier, double& offset) {
  if (joint.mimic == nullptr) return joint;
  offset += multiplier * joint.mimic->offset;
  multiplier *= joint.mimic->multiplier;
  return leader_of(model, *model.getJoint(joint.mimic->joint_name), multiplier, offset);
}

void expect_joint(const Robot& ours, const Joint& joint, const Link& link,
                  const urdf::ModelInterface& model) {
  const urdf::JointConstSharedPtr theirs = model.getJoint(joint.name);
  ASSERT_TRUE(theirs) << joint.name;
  EXPECT_EQ(theirs->child_link_name, link.name);
  EXPECT_EQ(theirs->parent_link_name, ours.links[joint.parent].name);
  expect_pose(joint.origin, theirs->parent_to_joint_origin_transform);
  EXPECT_EQ(joint.type == JointType::Fixed, theirs->type == urdf::Joint::FIXED);
  EXPECT_EQ(joint.type == JointType::Prismatic, theirs->type == urdf::Joint::PRISMATIC);
  if (joint.type == JointType::Fixed) return;
  EXPECT_LT((joint.axis - vector_of(theirs->axis).normalized()).norm(), 1e-15);
  double multiplier = 1, offset = 0;
  const urdf::Joint& leader = leader_of(model, *theirs, multiplier, offset);
  EXPECT_EQ(joint.multiplier, multiplier);
  EXPECT_EQ(joint.offset, offset);
  const Variable& variable = ours.variables[joint.variable];
  EXPECT_EQ(variable.name, leader.name);
  const bool limited = leader.type != urdf::Joint::CONTINUOUS;
  ASSERT_EQ(variable.lower.has_value(), limited);
  if (limited) {
    EXPECT_EQ(*variable.lower, leader.limits->lower);
    EXPECT_EQ(*variable.upper, leader.limits->upper);
  }
  if (leader.limits && leader.limits->velocity > 0) {
    ASSERT_TRUE(variable.velocity.has_value());
    EXPECT_LE(*variable.velocity, leader.limits->velocity) << "mimicking joints may lower it";
  }
}

/// @return whether both read it; that one does and the other does not is a failure.
bool expect_same(const std::string& text) {
  const urdf::ModelInterfaceSharedPtr model = urdf::parseURDF(text);
  if (!model) return false;
  const Robot ours = parse_urdf(text, "robot.urdf");
  EXPECT_EQ(ours.name, model->getName());
  EXPECT_EQ(ours.links.size(), model->links_.size());
  EXPECT_EQ(ours.links[0].name, model->getRoot()->name);
  for (const Link& link : ours.links) {
    const urdf::LinkConstSharedPtr theirs = model->getLink(link.name);
    EXPECT_TRUE(theirs) << link.name;
    if (!theirs) continue;
    EXPECT_EQ(link.collision.size(), theirs->collision_array.size());
    EXPECT_EQ(link.visual.size(), theirs->visual_array.size());
    for (std::size_t i = 0; i < link.collision.size(); ++i)
      expect_shape(link.collision[i], theirs->collision_array[i]->origin,
                   *theirs->collision_array[i]->geometry);
    for (std::size_t i = 0; i < link.visual.size(); ++i)
      expect_shape(link.visual[i], theirs->visual_array[i]->origin,
                   *theirs->visual_array[i]->geometry);
  }
  for (std::size_t j = 0; j < ours.joints.size(); ++j)
    expect_joint(ours, ours.joints[j], ours.links[j + 1], *model);
  return true;
}

/// A tree of links in random order, with numbers in several notations.
std::string random_robot(std::mt19937_64& random) {
  const auto below = [&](std::uint64_t n) { return static_cast<int>(random() % n); };
  std::uniform_real_distribution<double> unit(-3, 3);
  const auto number = [&] {
    std::ostringstream out;
    out.precision(1 + below(17));
    if (below(3) == 0) out << std::scientific;
    out << unit(random);
    std::string text = out.str();
    if (below(9) == 0) text.assign("+").append(std::to_string(below(100))).append(".");
    return text;
  };
  const auto three = [&] {
    const std::string gap = below(5) == 0 ? "  " : " ";
    return (below(6) == 0 ? " " : "") + number() + gap + number() + gap + number();
  };
  const auto origin = [&] {
    switch (below(4)) {
      case 0:
        return std::string();
      case 1:
        return "<origin xyz='" + three() + "'/>";
      case 2:
        return "<origin rpy='" + three() + "'/>";
      default:
        return "<origin rpy='" + three() + "' xyz='" + three() + "'/>";
    }
  };
  const auto shape = [&]() -> std::string {
    switch (below(4)) {
      case 0:
        return "<box size='1 " + std::to_string(below(4)) + " 0.25'/>";
      case 1:
        return "<sphere radius='0." + std::to_string(below(100)) + "'/>";
      case 2:
        return "<cylinder length='" + std::to_string(below(3)) + "' radius='1e-2'/>";
      default:
        return below(2) == 0 ? "<mesh filename='package://a/b.stl'/>"
                             : "<mesh filename='b &amp; c.dae' scale='1 -2 0.001'/>";
    }
  };
  std::vector<std::string> elements;
  const int links = 1 + below(9);
  std::vector<std::string> movable;
  for (int i = 0; i < links; ++i) {
    std::string link = "<link name='l" + std::to_string(i * 7 % 10) + "'>";
    for (int k = below(3); k-- > 0;) {
      const std::string tag = below(2) == 0 ? "collision" : "visual";
      link += "<" + tag + ">" + origin() + "<geometry>" + shape() + "</geometry></" + tag + ">";
    }
    elements.push_back(link + "</link>");
    if (i == 0) continue;
    const std::string type =
        std::vector<std::string>{"fixed", "revolute", "continuous", "prismatic"}[below(4)];
    const std::string name = "j" + std::to_string(i * 3 % 10);
    std::string joint = "<joint type='" + type + "' name='" + name + "'>" + origin() +
                        "<parent link='l" + std::to_string(below(i) * 7 % 10) +
                        "'/><child link='l" + std::to_string(i * 7 % 10) + "'/>";
    if (below(3) != 0) joint += "<axis xyz='" + three() + "'/>";
    if (type != "fixed") {
      const std::string bound = below(3) == 0 ? "" : " lower='-1.5'";
      joint += "<limit effort='1' velocity='2'" + bound + " upper='2.25'/>";
      if (!movable.empty() && below(3) == 0)
        joint += "<mimic joint='" + movable[random() % movable.size()] + "'" +
                 (below(2) == 0 ? " multiplier='" + number() + "'" : "") +
                 (below(2) == 0 ? " offset='" + number() + "'" : "") + "/>";
      movable.push_back(name);
    }
    elements.push_back(joint + "</joint>");
  }
  std::shuffle(elements.begin(), elements.end(), random);
  std::string out = "<?xml version='1.0'?><robot name='r' version='1.0'>";
  for (const std::string& element : elements) out += element + "\n";
  return out + "</robot>";
}

TEST(Urdfdom, ReadsRandomRobotsAsWeDo) {
  std::mt19937_64 random(3);
  int read = 0;
  for (int i = 0; i < 400; ++i) {
    const std::string text = random_robot(random);
    SCOPED_TRACE(text);
    if (expect_same(text)) ++read;
    if (HasFailure()) return;
  }
  EXPECT_EQ(read, 400);
}

TEST(CorpusUrdfdom, ReadsRealRobotsAsWeDo) {
  int read = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(test::corpus())) {
    if (entry.path().extension() != ".urdf") continue;
    SCOPED_TRACE(entry.path());
    std::stringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    if (expect_same(text.str())) ++read;
  }
  EXPECT_GE(read, 2);
}

}  // namespace
}  // namespace kaboum::robot
