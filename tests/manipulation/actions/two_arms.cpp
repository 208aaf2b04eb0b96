// Two arms and what they handle, as a world of exact boxes and as the judge's meshes.

#include "two_arms.h"

#include <kaboum/base/error.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/manipulation/words.h>
#include <kaboum/robot/kinematics.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>

namespace kaboum::test {
namespace {

using geom::Transform;
using geom::Vec3;

struct Bar {
  const char* link;
  Vec3 size, center;
};
const std::vector<Bar> kBars = {
    {"shoulder", {0.12, 0.12, 0.12}, {0, 0, -0.08}}, {"upper_arm", {0.07, 0.07, 0.5}, {0, 0, 0.25}},
    {"elbow", {0.06, 0.06, 0.2}, {0, 0, 0.1}},       {"forearm", {0.05, 0.05, 0.2}, {0, 0, 0.12}},
    {"wrist", {0.04, 0.04, 0.05}, {0, 0, 0.03}},     {"hand", {0.03, 0.03, 0.07}, {0, 0, 0.12}}};

std::string urdf() {
  std::string out = R"(<robot name="arm"><link name="base"/>)";
  for (const Bar& bar : kBars) out += "<link name=\"" + std::string(bar.link) + "\"/>";
  struct Axis {
    const char *parent, *child, *at, *axis, *limit;
  };
  int number = 0;
  for (const Axis& a : {Axis{"base", "shoulder", "0 0 0.35", "0 0 1", "2.9"},
                        Axis{"shoulder", "upper_arm", "0 0 0", "0 1 0", "2.2"},
                        Axis{"upper_arm", "elbow", "0 0 0.5", "0 1 0", "2.7"},
                        Axis{"elbow", "forearm", "0 0 0.2", "0 0 1", "3.1"},
                        Axis{"forearm", "wrist", "0 0 0.25", "0 1 0", "2.3"},
                        Axis{"wrist", "hand", "0 0 0", "0 0 1", "3.1"}})
    out += "<joint name=\"j" + std::to_string(++number) + R"(" type="revolute"><parent link=")" +
           a.parent + R"("/><child link=")" + a.child + R"("/><origin xyz=")" + a.at +
           R"("/><axis xyz=")" + a.axis + R"("/><limit lower="-)" + a.limit + R"(" upper=")" +
           a.limit + R"(" velocity="2" effort="1"/></joint>)";
  return out + "</robot>";
}

world::BoundingSet set_of(const geom::Mesh& mesh) {
  return {{{"", mesh}}, collide::Direction::Outer, TwoArms::kEpsilon};
}

Transform turned(const Vec3& axis, double angle, const Vec3& at) {
  return {Eigen::AngleAxisd(angle, axis).toRotationMatrix(), at};
}

}  // namespace

world::RobotModel on_rail(world::RobotModel robot, double lower, double upper) {
  robot::Robot& chain = robot.kinematics;
  for (robot::Joint& joint : chain.joints) ++joint.parent;
  robot::Joint rail;
  rail.name = "rail";
  rail.type = robot::JointType::Prismatic;
  rail.axis = Vec3::UnitY();
  rail.variable = static_cast<std::uint32_t>(chain.variables.size());
  chain.joints.insert(chain.joints.begin(), rail);
  chain.links.insert(chain.links.begin(), robot::Link());
  chain.links.front().name = "floor";
  chain.variables.push_back({"rail", lower, upper});
  robot.home.push_back(0);
  return robot;
}

geom::Mesh box_at(const Vec3& size, const Vec3& center) {
  std::vector<Vec3> points;
  for (const double x : {-0.5, 0.5})
    for (const double y : {-0.5, 0.5})
      for (const double z : {-0.5, 0.5})
        points.emplace_back(center + Vec3(x, y, z).cwiseProduct(size));
  return *geom::convex_hull(points);
}

TwoArms::TwoArms() {
  for (const char* name : {"left", "right"}) {
    world::RobotModel robot;
    robot.name = name;
    robot.kinematics = robot::parse_urdf(urdf(), "arm");
    robot.base.translation = {0, world.robots.empty() ? 0.35 : -0.35, 0};
    robot.home = {0, -0.3, 1.5, 0, 1.2, 0};
    for (std::size_t i = 0; i < kBars.size(); ++i) {
      const std::uint32_t link = *robot.kinematics.find_link(kBars[i].link);
      robot.shapes.push_back({link, set_of(box_at(kBars[i].size, kBars[i].center)), {}});
      hand = link;
      if (i > 0)
        robot.allowed.push_back(
            {robot.shapes[i - 1].link, link, world::AllowedPair::Reason::Adjacent});
    }
    robot.tools = {{"suction", hand, {Eigen::Matrix3d::Identity(), {0, 0, 0.155}}}};
    const std::size_t number = cell.add_robot(robot.name, robot.kinematics, robot.base);
    (void)number;
    world.robots.push_back(std::move(robot));
  }
  for (std::size_t r = 0; r < world.robots.size(); ++r)
    for (std::size_t i = 0; i < kBars.size(); ++i)
      cell.add_link(r, world.robots[r].shapes[i].link, box_at(kBars[i].size, kBars[i].center));
  const auto object = [&](const char* name, const Vec3& size, const Vec3& at) -> world::Object& {
    const geom::Mesh mesh = box_at(size, Vec3::Zero());
    cell.add_object(name, mesh);
    world.objects.push_back({name, {Eigen::Matrix3d::Identity(), at}, set_of(mesh), {}, {}, {}});
    return world.objects.back();
  };
  using Kind = world::Feature::Kind;
  object("table", {0.6, 1.4, 0.1}, {0.6, 0, -0.051});
  world::Object& block = object("block", {0.05, 0.05, 0.16}, {0.5, 0.3, 0.08});
  block.features = {{"bottom", Kind::Point, {0, 0, -0.08}, {}},
                    {"mount", Kind::Plane, {0, 0, -0.08}, {0, 0, -1}}};
  // From above, and from four sides below the middle.
  block.grasps = {{"top", turned(Vec3::UnitX(), std::numbers::pi, {0, 0, 0.08 + kGap})}};
  for (int k = 0; k < 4; ++k) {
    // The tool's z looks at the side: the block's axis along the tool's x.
    const Transform side = turned(Vec3::UnitY(), std::numbers::pi / 2, {0.03, 0, 0.025 + kGap});
    const Eigen::Matrix3d about =
        Eigen::AngleAxisd(k * std::numbers::pi / 2, Vec3::UnitZ()).toRotationMatrix();
    block.grasps.push_back({"side" + std::to_string(k), {side.linear * about, side.translation}});
  }
  world::Object& socket = object("socket", {0.1, 0.1, 0.04}, {0.55, 0.05, 0.021});
  socket.features = {{"seat", Kind::Plane, {0, 0, 0.02}, {0, 0, 1}},
                     {"entry", Kind::Point, {0, 0, 0.09}, {}},
                     {"top", Kind::Point, {0, 0, 0.02}, {}}};
  object("wall", {0.02, 0.3, 0.3}, {0.5, 0, 1.8});
  world.attachments.resize(world.objects.size());
}

world::Attachment TwoArms::hold(std::size_t robot, std::size_t grasp) const {
  world::Attachment out;
  out.robot = robot;
  out.link = hand;
  out.pose = world.robots[robot].tools[0].pose * world.objects[kBlock].grasps[grasp].pose;
  return *manipulation::place_of(manipulation::word_of(world, out), world, kBlock).attachment;
}

std::string TwoArms::word(const world::Attachment& held) const {
  return manipulation::word_of(world, held);
}

judge::Hold TwoArms::hold_of(const world::Attachment& held) const {
  return {held.robot, held.link, held.pose, held.touching};
}

judge::CellState TwoArms::state() const {
  judge::CellState out;
  for (const world::RobotModel& robot : world.robots) out.q.push_back(robot.home);
  for (const world::Object& o : world.objects) out.objects.push_back({o.pose, {}, false});
  return out;
}

std::optional<std::string> WordState::value(const std::string& function,
                                            const std::vector<std::string>& arguments) {
  const std::string term = function + "(" + arguments.at(0) + ")";
  read_.push_back(term);
  const auto found = words_.find(term);
  if (found == words_.end()) throw Error(ErrorCode::InvalidInput, "no term " + term);
  return found->second;
}

bool WordState::has_term(const std::string& function, const std::vector<std::string>& arguments) {
  return words_.contains(function + "(" + arguments.at(0) + ")");
}

std::optional<bool> WordState::truth(const std::string& predicate,
                                     const std::vector<std::string>& /*arguments*/) {
  throw Error(ErrorCode::InvalidInput, "no predicate " + predicate);
}

plan::Answer ask(const plan::ExternalBindings& all, const std::string& function,
                 const std::vector<std::string>& arguments,
                 const std::map<std::string, std::string>& words, unsigned attempts,
                 unsigned choice) {
  plan::Answer answer;
  for (unsigned attempt = 0; attempt < attempts; ++attempt) {
    WordState state(words);
    answer = all.at(function)({arguments, state, 1000U + attempt, attempt, choice});
    if (answer.kind != plan::Answer::Kind::NotFound) break;
  }
  return answer;
}

std::vector<Motion> motions_of(const plan::Answer& answer) {
  std::vector<Motion> out;
  for (const nlohmann::json& part : nlohmann::json::parse(answer.payload)) {
    Motion m;
    m.robot = part.at("robot").get<std::string>();
    if (part.contains("holds")) m.holds = part["holds"].get<std::map<std::string, std::string>>();
    m.path = part.at("path").get<robot::Path>();
    out.push_back(std::move(m));
  }
  return out;
}

std::vector<std::vector<double>> samples_of(const robot::Path& path, double step) {
  std::vector<std::vector<double>> out{path.front()};
  for (std::size_t s = 0; s + 1 < path.size(); ++s) {
    double most = 0;
    for (std::size_t j = 0; j < path[s].size(); ++j)
      most = std::max(most, std::abs(path[s + 1][j] - path[s][j]));
    const int count = std::max(1, static_cast<int>(std::ceil(most / step)));
    for (int i = 1; i <= count; ++i) {
      std::vector<double> q = path[s];
      for (std::size_t j = 0; j < q.size(); ++j) q[j] += (path[s + 1][j] - q[j]) * i / count;
      out.push_back(i == count ? path[s + 1] : std::move(q));
    }
  }
  return out;
}

}  // namespace kaboum::test
