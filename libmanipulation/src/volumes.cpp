// Volumes that motions sweep, as words and as convex sets. Source: [gaschler2016] §3.3.3, Eq. 4.22,
// Definition 1; docs/planning/geometry.md, "Volumes".
#include "volumes.h"

#include <kaboum/base/error.h>
#include <kaboum/collide/inclusion.h>
#include <kaboum/robot/kinematics.h>
#include <kaboum/sweep/sweep.h>
#include <kaboum/world/gripper.h>
#include <kaboum/world/margins.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "stopwatch.h"

namespace kaboum::manipulation {
namespace {

using nlohmann::json;
using world::Item;

constexpr std::string_view kVolumePrefix = "swept ";
/// Volumes, and bodies of volumes, that are kept.
constexpr std::size_t kMostVolumes = 2'000, kMostBodies = 500'000;
/// A radius is at most this share of the sweep's epsilon, of which it may take half.
constexpr double kShareOfRadius = 0.25;
/// Of matrices that stand for rotations.
constexpr double kMostDefect = 1e-9;
/// As in words of poses. [length]
constexpr double kMostNumber = 1e6;

json numbers_of(const world::Transform& pose) {
  json out = json::array();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) out.push_back(pose.linear(row, column));
  for (int k = 0; k < 3; ++k) out.push_back(pose.translation[k]);
  return out;
}

[[noreturn]] void refuse_volume(const std::string& why) {
  throw Error(ErrorCode::InvalidInput,
              "a word is no volume: " + why +
                  ". Volumes are what sweptVolume, pathVolume, reachVolume, graspVolume and "
                  "occupiedVolume return");
}

double defect_of(const Eigen::Matrix3d& m) {
  return (m.transpose() * m - Eigen::Matrix3d::Identity()).norm();
}

world::Transform pose_in(const json& j) {
  const auto v = j.get<std::vector<double>>();
  if (v.size() != 12) refuse_volume("a pose has 12 numbers");
  if (!std::ranges::all_of(v, [](double x) { return std::abs(x) < kMostNumber; }))
    refuse_volume("a number of a pose is 1e6 at most");
  world::Transform out;
  for (int k = 0; k < 9; ++k) out.linear(k / 3, k % 3) = v[static_cast<std::size_t>(k)];
  for (int k = 0; k < 3; ++k) out.translation[k] = v[static_cast<std::size_t>(k) + 9];
  if (!(defect_of(out.linear) <= kMostDefect) || !(out.linear.determinant() > 0))
    refuse_volume("the first nine numbers of a pose are a rotation, row by row");
  return out;
}

Motion motion_of(const Geometry& geometry, const json& part) {
  Motion out;
  out.robot = robot_named(geometry, part.at("robot").get<std::string>());
  const robot::Robot& kinematics = geometry.world.robots[out.robot].kinematics;
  out.path = part.at("path").get<robot::Path>();
  if (out.path.empty()) refuse_volume("a path has a waypoint at least");
  for (const auto& q : out.path)
    if (q.size() != kinematics.variables.size())
      refuse_volume("a waypoint of " + geometry.world.robots[out.robot].name + " has " +
                    std::to_string(kinematics.variables.size()) + " joint values, not " +
                    std::to_string(q.size()));
  for (const auto& q : out.path)
    if (find_out_of_limits(kinematics, q) ||
        !std::ranges::all_of(q, [](double x) { return std::abs(x) < kMostNumber; }))
      refuse_volume("a waypoint of " + geometry.world.robots[out.robot].name +
                    " is outside the limits of its joints, or 1e6 or more");
  const json holds = part.value("holds", json::object());
  if (!holds.is_object()) refuse_volume("'holds' has objects by their names");
  for (const auto& [name, held] : holds.items()) {
    world::Attachment attachment;
    attachment.robot = out.robot;
    const auto link = kinematics.find_link(held.at("link").get<std::string>());
    if (!link)
      refuse_volume("robot '" + geometry.world.robots[out.robot].name + "' has no link '" +
                    held.at("link").get<std::string>() + "'");
    attachment.link = *link;
    attachment.pose = pose_in(held.at("pose"));
    out.holds.emplace_back(object_named(geometry, name), attachment);
  }
  std::ranges::sort(out.holds, {}, [](const auto& hold) { return hold.first; });
  return out;
}

/// Of points that a rounded transform takes somewhere, how far they may be from where the rotation
/// that is meant takes them. [length]
double error_of(const world::Transform& pose, double extent) {
  return 2 * defect_of(pose.linear) * extent +
         1e-14 * (extent + pose.translation.lpNorm<1>());  // 45 roundings
}

/// A shape's bodies in the frame of its link.
void add_bodies(std::vector<robot::LinkBody>& out, const collide::BoundingSet& set,
                std::uint32_t link, const world::Transform* pose) {
  for (std::size_t i = 0; i < set.size(); ++i) {
    const geom::ConvexBody& body = set.body(i);
    robot::LinkBody& moved = out.emplace_back();
    moved.name = body.name;
    moved.link = link;
    moved.points = body.core.vertices;
    moved.margin = body.radius;
    if (pose == nullptr) continue;
    double extent = 0;
    for (geom::Vec3& p : moved.points) {
      extent = std::max(extent, p.lpNorm<1>());
      p = *pose * p;
    }
    moved.margin = body.radius * (1 + 1e-8) + error_of(*pose, extent);
  }
}

void add_sweep(Volume& volume, const Geometry& geometry, const Motion& motion) {
  const world::RobotModel& robot = geometry.world.robots[motion.robot];
  std::vector<robot::LinkBody> bodies;
  std::vector<Item> items;
  std::vector<std::size_t> item_of;  // of each body
  const auto add = [&](const Item& item, std::uint32_t link, const world::Transform* pose) {
    add_bodies(bodies, geometry.world.outer(item), link, pose);
    item_of.resize(bodies.size(), items.size());
    items.push_back(item);
  };
  for (std::size_t i = 0; i < robot.shapes.size(); ++i)
    add({motion.robot, i}, robot.shapes[i].link, nullptr);
  for (const auto& [object, held] : motion.holds)
    add({Item::kObject, object}, held.link, &held.pose);

  sweep::SweepOptions options;
  options.epsilon = geometry.options.volume_epsilon;
  for (const robot::LinkBody& body : bodies)
    options.epsilon = std::max(options.epsilon, body.margin / kShareOfRadius);
  sweep::SweepResult swept = sweep::swept_volume(robot.kinematics, bodies, motion.path, options);
  if (swept.stop != sweep::Stop::Done)
    throw Error(ErrorCode::LimitReached,
                "numbers of single precision are too coarse for a volume of " + robot.name +
                    " that is " + std::to_string(options.epsilon) + " wide at most");

  std::vector<std::vector<geom::ConvexBody>> sets(items.size());
  for (std::size_t k = 0; k < swept.set.bodies.size(); ++k)
    sets[item_of[swept.sources[k]]].push_back(std::move(swept.set.bodies[k]));
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (sets[i].empty()) continue;
    auto set = std::make_shared<const collide::BoundingSet>(
        std::move(sets[i]), collide::Direction::Outer,
        geometry.world.outer(items[i]).epsilon() + swept.excess);
    const double extent = set->ball().center.norm() + set->ball().radius;
    collide::PosedSet place(*set, robot.base, error_of(robot.base, extent));
    volume.shapes.push_back({items[i], motion.robot, std::move(set), std::move(place)});
  }
}

/// The object's own set, where it rests.
void add_resting(Volume& volume, const Geometry& geometry, std::size_t object,
                 const world::Transform& pose) {
  const Item item{Item::kObject, object};
  const collide::BoundingSet& outer = geometry.world.outer(item);
  // It belongs to the world, which outlives the volume.
  const std::shared_ptr<const collide::BoundingSet> set(std::shared_ptr<void>(), &outer);
  const double extent = outer.ball().center.norm() + outer.ball().radius;
  volume.shapes.push_back(
      {item, Item::kObject, set, collide::PosedSet(outer, pose, error_of(pose, extent))});
}

/// Whether a motion moves joints of grippers, or holds something by a gripper that has some.
bool has_loose_fingers(const world::RobotModel& robot, const Motion& motion) {
  for (const world::Gripper& gripper : robot.grippers)
    for (const std::uint32_t variable : gripper.joints)
      for (const std::vector<double>& q : motion.path)
        if (q[variable] != motion.path.front()[variable]) return true;
  return std::ranges::any_of(motion.holds, [&](const auto& hold) {
    const world::Gripper* gripper = gripper_with_pads(robot, hold.second.link);
    return (gripper != nullptr && !gripper->joints.empty()) ||
           finger_joint_above(robot, hold.second.link);
  });
}

Volume make_volume(const Geometry& geometry, const std::string& word) {
  if (!word.starts_with(kVolumePrefix))
    refuse_volume("'" + word.substr(0, 40) + "' does not begin with 'swept'");
  Volume out;
  try {
    const json parts = json::parse(word.substr(kVolumePrefix.size()));
    if (!parts.is_array() || parts.empty()) refuse_volume("it is empty");
    for (const json& part : parts) {
      if (part.contains("object")) {
        add_resting(out, geometry, object_named(geometry, part.at("object").get<std::string>()),
                    pose_in(part.at("pose")));
        continue;
      }
      out.motions.push_back(motion_of(geometry, part));
      add_sweep(out, geometry, out.motions.back());
      if (has_loose_fingers(geometry.world.robots[out.motions.back().robot], out.motions.back()))
        out.has_loose_fingers = true;
    }
  } catch (const json::exception&) {
    refuse_volume("it is to be swept [{\"robot\": NAME, \"path\": [[NUMBER, ...], ...]}, ...]");
  }
  if (out.shapes.empty()) refuse_volume("none of what it is of has a bounding set");
  return out;
}

/// What the volumes have in common, or carry: for margins.
world::WorldState carried_in(const world::World& world, const Volume& a, const Volume& b) {
  world::WorldState out = initial_state(world);
  std::ranges::fill(out.attachments, std::nullopt);
  for (const Volume* volume : {&a, &b})
    for (const Motion& motion : volume->motions)
      for (const auto& [object, held] : motion.holds) out.attachments[object] = held;
  return out;
}

bool is_allowed(const world::World& world, const Item& a, const Item& b) {
  return std::ranges::any_of(world.allowed, [&](const std::array<Item, 2>& pair) {
    return (pair[0] == a && pair[1] == b) || (pair[0] == b && pair[1] == a);
  });
}

}  // namespace

Motion motion_in(const world::WorldState& state, std::size_t robot, robot::Path path) {
  Motion out;
  out.robot = robot;
  out.path = std::move(path);
  for (std::size_t o = 0; o < state.attachments.size(); ++o)
    if (const auto& held = state.attachments[o]; held && held->robot == robot && !state.absent[o])
      out.holds.emplace_back(o, *held);
  return out;
}

std::string volume_word(const world::World& world, const std::vector<Motion>& motions) {
  json parts = json::array();
  for (const Motion& motion : motions) {
    const world::RobotModel& robot = world.robots[motion.robot];
    json& part = parts.emplace_back();
    part = {{"robot", robot.name}, {"path", motion.path}};
    for (const auto& [object, held] : motion.holds)
      part["holds"][world.objects[object].name] = {{"link", robot.kinematics.links[held.link].name},
                                                   {"pose", numbers_of(held.pose)}};
  }
  return std::string(kVolumePrefix) + parts.dump();
}

std::string volume_word(const world::World& world, std::size_t object,
                        const world::Transform& pose) {
  const json parts =
      json::array({{{"object", world.objects[object].name}, {"pose", numbers_of(pose)}}});
  return std::string(kVolumePrefix) + parts.dump();
}

std::shared_ptr<const Volume> volume_of(Geometry& geometry, const std::string& word) {
  if (const auto kept = geometry.volumes.find(word); kept != geometry.volumes.end())
    return kept->second;
  const Stopwatch watch;
  auto made = std::make_shared<const Volume>(make_volume(geometry, word));
  if (GeometryCounters* counters = geometry.options.counters.get();
      counters != nullptr && !made->motions.empty()) {
    ++counters->volumes;
    for (const Volume::Shape& shape : made->shapes) {
      counters->volume_bodies += shape.set->size();
      for (std::size_t i = 0; i < shape.set->size(); ++i)
        counters->volume_triangles += shape.set->body(i).core.triangles.size();
    }
    counters->volume_seconds += watch.seconds();
  }
  std::size_t bodies = 0;
  for (const Volume::Shape& shape : made->shapes) bodies += shape.set->size();
  if (geometry.volumes.size() >= kMostVolumes || geometry.volume_bodies + bodies > kMostBodies) {
    geometry.volumes.clear();
    geometry.volume_bodies = 0;
  }
  geometry.volume_bodies += bodies;
  return geometry.volumes.emplace(word, std::move(made)).first->second;
}

namespace {

void count_test(const Geometry& geometry, const Stopwatch& watch) {
  if (GeometryCounters* counters = geometry.options.counters.get()) {
    ++counters->volume_tests;
    counters->volume_test_seconds += watch.seconds();
  }
}

}  // namespace

bool are_in_contact(const Geometry& geometry, const Volume& a, const Volume& b) {
  const Stopwatch watch;
  const world::World& world = geometry.world;
  const world::WorldState state = carried_in(world, a, b);
  const auto meet = [&](const Volume::Shape& x, const Volume::Shape& y) {
    if (x.item == y.item || (x.carrier == y.carrier && x.carrier != Item::kObject)) return true;
    if (is_allowed(world, x.item, y.item)) return false;
    return find_collision(x.place, y.place, margin_between(world, state, x.item, y.item))
        .has_value();
  };
  const bool found =
      a.has_loose_fingers || b.has_loose_fingers ||
      std::ranges::any_of(a.shapes, [&](const Volume::Shape& x) {
        return std::ranges::any_of(b.shapes, [&](const Volume::Shape& y) { return meet(x, y); });
      });
  count_test(geometry, watch);
  return found;
}

bool is_inside(const Geometry& geometry, const Volume& volume, std::size_t region) {
  const Stopwatch watch;
  const world::Region& where = geometry.world.regions[region];
  const double extent = where.inner.ball().center.norm() + where.inner.ball().radius;
  const collide::PosedSet place(where.inner, where.pose, error_of(where.pose, extent));
  const bool inside = !volume.has_loose_fingers &&
                      std::ranges::all_of(volume.shapes, [&](const Volume::Shape& shape) {
                        return find_inclusion(shape.place, place) == collide::Inclusion::Included;
                      });
  count_test(geometry, watch);
  return inside;
}

}  // namespace kaboum::manipulation
