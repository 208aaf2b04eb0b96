// Scenes of a few boxes, as a world of bounding sets, as the judge's meshes and as a planning task.
#include "random_scene.h"

#include <kaboum/judge/placement.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "../actions/two_arms.h"

namespace kaboum::test {
namespace {

using geom::Transform;
using geom::Vec3;

struct LinkBox {
  std::string link;
  Vec3 size, center;
};

struct TurningAxis {
  std::string child;
  double height;
  char about;
  double limit;
};

constexpr double kReach = 0.95;  // of the arms, about [m]
constexpr double kEpsilon = 1e-5;

class Draw {
 public:
  explicit Draw(std::uint32_t seed) : random_(seed) {}
  int below(int n) { return static_cast<int>(random_() % static_cast<std::uint32_t>(n)); }
  double between(double low, double high) {
    return low + (high - low) * static_cast<double>(random_()) / 4294967296.0;
  }

 private:
  std::mt19937 random_;
};

world::BoundingSet exact_set(const geom::Mesh& mesh) {
  return {{{"", mesh}}, collide::Direction::Outer, kEpsilon};
}

Transform rotated(const Vec3& axis, double angle, const Vec3& at = Vec3::Zero()) {
  return {Eigen::AngleAxisd(angle, axis).toRotationMatrix(), at};
}

/// Six axes with a spherical wrist, or five.
struct ArmParts {
  std::vector<TurningAxis> axes;
  std::vector<LinkBox> bars;
  std::vector<double> home;

  ArmParts(bool six, double scale) {
    const double upper = 0.5 * scale, lower = (six ? 0.45 : 0.4) * scale;
    axes = {{"shoulder", 0.35, 'z', 2.9}, {"upper_arm", 0, 'y', 2.2}};
    bars = {{"shoulder", {0.12, 0.12, 0.12}, {0, 0, -0.08}},
            {"upper_arm", {0.07, 0.07, upper}, {0, 0, upper / 2}}};
    if (six) {
      axes.insert(axes.end(), {{"elbow", upper, 'y', 2.7},
                               {"forearm", 0.2 * scale, 'z', 3.1},
                               {"wrist", lower - 0.2 * scale, 'y', 2.3}});
      bars.insert(bars.end(), {{"elbow", {0.06, 0.06, 0.2 * scale}, {0, 0, 0.1 * scale}},
                               {"forearm", {0.05, 0.05, 0.18}, {0, 0, 0.11}}});
      home = {0, -0.3, 1.5, 0, 1.2, 0};
    } else {
      axes.insert(axes.end(), {{"forearm", upper, 'y', 2.7}, {"wrist", lower, 'y', 2.3}});
      bars.push_back({"forearm", {0.05, 0.05, lower - 0.06}, {0, 0, lower / 2}});
      home = {0, -0.6, 1.8, 1.2, 0};
    }
    axes.push_back({"hand", 0, 'z', 3.1});
    bars.insert(bars.end(), {{"wrist", {0.04, 0.04, 0.05}, {0, 0, 0.03}},
                             {"hand", {0.03, 0.03, 0.07}, {0, 0, 0.12}}});
  }

  [[nodiscard]] std::string urdf() const {
    std::string out = R"(<robot name="arm"><link name="base"/>)";
    for (const TurningAxis& a : axes) out += "<link name=\"" + a.child + "\"/>";
    std::string parent = "base";
    for (const TurningAxis& a : axes) {
      const std::string limit = std::to_string(a.limit);
      out += "<joint name=\"to_" + a.child + R"(" type="revolute"><parent link=")" + parent +
             R"("/><child link=")" + a.child + R"("/><origin xyz="0 0 )" +
             std::to_string(a.height) + R"("/><axis xyz=")" + (a.about == 'z' ? "0 0 1" : "0 1 0") +
             R"("/><limit lower="-)" + limit + R"(" upper=")" + limit +
             R"(" velocity="2" effort="1"/></joint>)";
      parent = a.child;
    }
    return out + "</robot>";
  }
};

}  // namespace

RandomScene::RandomScene(std::uint32_t seed) {
  Draw draw(seed);
  tool.translation = {0, 0, 0.155};
  const bool six = draw.below(3) != 0;
  const std::size_t arms = draw.below(3) == 0 ? 2 : 1;
  const double scale = draw.between(0.8, 1.1);
  const ArmParts parts(six, scale);
  for (std::size_t r = 0; r < arms; ++r) {
    world::RobotModel robot;
    robot.name = "arm" + std::to_string(r);
    robot.kinematics = robot::parse_urdf(parts.urdf(), "arm");
    if (r > 0) {
      const double angle = draw.between(0, 2 * std::numbers::pi);
      robot.base = rotated(Vec3::UnitZ(), draw.between(0, 2 * std::numbers::pi),
                           draw.between(0.6, 1.3) * Vec3(std::cos(angle), std::sin(angle), 0));
    }
    robot.home = parts.home;
    robot.home[0] = draw.between(-2, 2);
    for (std::size_t i = 0; i < parts.bars.size(); ++i) {
      const LinkBox& bar = parts.bars[i];
      const std::uint32_t link = *robot.kinematics.find_link(bar.link);
      robot.shapes.push_back({link, exact_set(box_at(bar.size, bar.center)), {}});
      hand = link;
      if (i > 0)
        robot.allowed.push_back(
            {robot.shapes[i - 1].link, link, world::AllowedPair::Reason::Adjacent});
    }
    robot.tools = {{"suction", hand, tool}};
    for (judge::Cell* c : {&cell, &grown}) c->add_robot(robot.name, robot.kinematics, robot.base);
    world.robots.push_back(std::move(robot));
  }
  for (std::size_t r = 0; r < arms; ++r)
    for (const LinkBox& bar : parts.bars)
      for (judge::Cell* c : {&cell, &grown})
        c->add_link(r, *world.robots[r].kinematics.find_link(bar.link),
                    box_at(bar.size, bar.center));

  const auto object = [&](const std::string& name, const Vec3& size,
                          const Transform& at) -> world::Object& {
    const geom::Mesh mesh = box_at(size, Vec3::Zero());
    cell.add_object(name, mesh);
    grown.add_object(name, box_at(size + Vec3::Constant(2 * kGrown), Vec3::Zero()));
    world.objects.push_back({name, at, exact_set(mesh), {}, {}, {}});
    return world.objects.back();
  };
  const auto near = [&] {
    const Transform& base =
        world.robots[static_cast<std::size_t>(draw.below(static_cast<int>(arms)))].base;
    const double angle = draw.between(-std::numbers::pi, std::numbers::pi);
    const double radius = draw.between(0.25, kReach * scale);
    return Vec3(base.translation +
                Vec3(radius * std::cos(angle), radius * std::sin(angle), draw.between(0.05, 0.8)));
  };

  using Kind = world::Feature::Kind;
  const int count = 1 + draw.below(3);
  for (int b = 0; b < count; ++b) {
    const Vec3 size(draw.between(0.03, 0.1), draw.between(0.03, 0.1), draw.between(0.04, 0.16));
    std::vector<Transform> grasps;
    const int grasp_count = 1 + draw.below(4);
    for (int g = 0; g < grasp_count; ++g) {
      // The tool looks at a side, rotated about its own axis.
      const int side = draw.below(6);
      const double sign = side % 2 == 0 ? 1 : -1;
      Vec3 normal = Vec3::Zero();
      normal[side / 2] = sign;
      const Eigen::Matrix3d faces =
          Eigen::Quaterniond::FromTwoVectors(normal, -Vec3::UnitZ()).toRotationMatrix();
      const Transform look = {faces, Vec3(0, 0, size[side / 2] / 2 + kGap)};
      grasps.push_back(judge::product(
          rotated(Vec3::UnitZ(), draw.between(-std::numbers::pi, std::numbers::pi)), look));
    }
    Transform at = rotated(Vec3::UnitZ(), draw.between(-std::numbers::pi, std::numbers::pi));
    const int where = draw.below(10);
    if (where < 6) {  // where an arm can hold it
      const auto r = static_cast<std::size_t>(draw.below(static_cast<int>(arms)));
      judge::CellState there = state();
      for (std::size_t j = 0; j < there.q[r].size(); ++j)
        there.q[r][j] = draw.between(-0.95, 0.95) * parts.axes[j].limit;
      const auto g = static_cast<std::size_t>(draw.below(grasp_count));
      at = judge::product(judge::product(cell.pose_of(there, r, hand), tool), grasps[g]);
    } else if (where < 8) {
      at.translation = near();
    } else {
      at.translation = near() + Vec3(draw.between(-2, 2), draw.between(-2, 2), 0.5);
    }
    world::Object& o = object("b" + std::to_string(b), size, at);
    o.features = {{"bottom", Kind::Point, {0, 0, -size.z() / 2}, {}}};
    for (std::size_t g = 0; g < grasps.size(); ++g)
      o.grasps.push_back({"g" + std::to_string(g), grasps[g]});
    blocks.push_back({world.objects.size() - 1, size.z() / 2, std::move(grasps)});
  }
  const int walls = draw.below(4);
  for (int w = 0; w < walls; ++w) {
    Vec3 at = near();
    // Some stand right beside a block.
    if (draw.below(2) == 0)
      at = world.objects[static_cast<std::size_t>(draw.below(count))].pose.translation +
           Vec3(draw.between(-0.15, 0.15), draw.between(-0.15, 0.15), draw.between(-0.15, 0.15));
    object("wall" + std::to_string(w),
           {draw.between(0.02, 0.3), draw.between(0.02, 0.3), draw.between(0.02, 0.3)},
           rotated(Vec3::UnitZ(), draw.between(0, 3), at));
  }
  if (draw.below(2) == 0) {
    const Vec3 at = near();
    const double height = 0.02;
    world::Object& o = object("shelf", {draw.between(0.1, 0.3), draw.between(0.1, 0.3), height},
                              {Eigen::Matrix3d::Identity(), at});
    o.features = {{"top", Kind::Point, {0, 0, height / 2}, {}}};
    shelf = world.objects.size() - 1;
    shelf_top = at + Vec3(0, 0, height / 2);
  }
  world.attachments.resize(world.objects.size());

  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const int wanted = draw.below(4);
    if (shelf && wanted == 0 && stowed.empty()) stowed.push_back(b);
    if (wanted == 1 || wanted == 2) removed.push_back(b);
  }
  if (removed.empty() && stowed.empty()) removed.push_back(0);

  std::string robots, names, init, goal;
  const auto list = [](std::string& out, const std::string& more, const char* between) {
    out += (out.empty() ? "" : between) + more;
  };
  for (const world::RobotModel& r : world.robots) {
    list(robots, r.name, ", ");
    init += "  K(isEmpty(" + r.name + ")) K(conf(" + r.name + ") = home)\n";
  }
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    const std::string name = "b" + std::to_string(b);
    list(names, name, ", ");
    init += "  K(isFree(" + name + ")) K(!isStowed(" + name + ")) K(pose(" + name + ") = start)\n";
  }
  for (const std::size_t b : removed) list(goal, "K(isRemoved(b" + std::to_string(b) + "))", " & ");
  for (const std::size_t b : stowed) list(goal, "K(isStowed(b" + std::to_string(b) + "))", " & ");
  task = "domain scenes\ntypes: robot, block, board, conf handle, pose handle\nconstants: robot " +
         robots + "; block " + names + (shelf ? "; board shelf" : "") +
         "; conf home; pose start, away\n"
         "predicates: isEmpty(robot), isHeld(robot, block), isFree(block), isRemoved(block), "
         "isStowed(block)\n"
         "functions: conf(robot) : conf; pose(block) : pose\n"
         "externals: fetch(robot, block, conf) : pose; put(robot, block, board, conf) : pose\n"
         "init:\n" +
         init +
         "action pick(?r : robot, ?o : block)\n  preconds: K(isEmpty(?r)) & K(isFree(?o)) &\n"
         "    let ?p = extern(fetch(?r, ?o, home))\n  effects: add(Kf, !isEmpty(?r)), add(Kf, "
         "!isFree(?o)), add(Kf, !isStowed(?o)), add(Kf, isHeld(?r, ?o)), add(Kf, pose(?o) = ?p)\n"
         "action drop(?r : robot, ?o : block)\n  preconds: K(isHeld(?r, ?o))\n  effects: add(Kf, "
         "isEmpty(?r)), add(Kf, !isHeld(?r, ?o)), add(Kf, isRemoved(?o)), add(Kf, pose(?o) = "
         "away)\n";
  if (shelf)
    task +=
        "action stow(?r : robot, ?o : block)\n  preconds: K(isHeld(?r, ?o)) &\n"
        "    let ?p = extern(put(?r, ?o, shelf, home))\n  effects: add(Kf, isEmpty(?r)), add(Kf, "
        "!isHeld(?r, ?o)), add(Kf, isFree(?o)), add(Kf, isStowed(?o)), add(Kf, pose(?o) = ?p)\n";
  task += "goal: " + goal + "\n";
}

judge::CellState RandomScene::state() const {
  judge::CellState out;
  for (const world::RobotModel& robot : world.robots) out.q.push_back(robot.home);
  for (const world::Object& o : world.objects) out.objects.push_back({o.pose, {}, false});
  return out;
}

}  // namespace kaboum::test
