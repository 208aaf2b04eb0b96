// Robots and objects as exact meshes: every pair that is not allowed, by Solid.

#include <kaboum/base/error.h>
#include <kaboum/judge/cell.h>
#include <kaboum/judge/placement.h>

#include <algorithm>

namespace kaboum::judge {
namespace {

/// Spheres are larger by this share than needed: they only leave out.
constexpr double kLarger = 1 + 1e-9;

std::array<std::string, 2> sorted(std::string a, std::string b) {
  if (b < a) std::swap(a, b);
  return {std::move(a), std::move(b)};
}

}  // namespace

std::size_t Cell::add_robot(std::string name, robot::Robot kinematics,
                            const geom::Transform& base) {
  robots_.push_back({std::move(name), std::move(kinematics), base});
  return robots_.size() - 1;
}

void Cell::add(Thing thing, const geom::Mesh& mesh) {
  geom::Box3 box;
  for (const geom::Vec3& v : mesh.vertices) box.extend(v);
  thing.center = 0.5 * (box.min + box.max);
  for (const geom::Vec3& v : mesh.vertices)
    thing.radius = std::max(thing.radius, kLarger * (v - thing.center).norm());
  thing.solid = std::make_unique<Solid>(mesh);
  triangles_ += thing.solid->triangles();
  open_ += thing.solid->closed() ? 0 : 1;
  things_.push_back(std::move(thing));
  looked_at_.assign(things_.size() * things_.size(), 0);
}

void Cell::add_link(std::size_t robot, std::uint32_t link, const geom::Mesh& mesh) {
  const Robot& r = robots_.at(robot);
  add({r.name + "/" + r.kinematics.links.at(link).name, robot, link, nullptr, {}, 0}, mesh);
}

std::size_t Cell::add_object(std::string name, const geom::Mesh& mesh) {
  objects_.push_back(things_.size());
  add({std::move(name), kNone, objects_.size() - 1, nullptr, {}, 0}, mesh);
  return objects_.size() - 1;
}

void Cell::allow(const std::string& a, const std::string& b) {
  allowed_.push_back(sorted(a, b));
  std::ranges::fill(looked_at_, static_cast<signed char>(0));
}

geom::Transform Cell::pose_of(const CellState& state, std::size_t robot, std::uint32_t link) const {
  return places(robots_[robot].kinematics, robots_[robot].base, state.q[robot])[link];
}

geom::Transform Cell::pose_of(const CellState& state, std::size_t object) const {
  const CellState::Place& place = state.objects[object];
  if (!place.hold) return place.pose;
  return product(pose_of(state, place.hold->robot, place.hold->link), place.hold->pose);
}

std::vector<Cell::PosedThing> Cell::place(const CellState& state) const {
  ensure(state.q.size() == robots_.size() && state.objects.size() == objects_.size(),
         "a state of another cell");
  std::vector<std::vector<geom::Transform>> links;
  for (std::size_t r = 0; r < robots_.size(); ++r)
    links.push_back(places(robots_[r].kinematics, robots_[r].base, state.q[r]));
  std::vector<PosedThing> out;
  for (const Thing& thing : things_) {
    PosedThing placed{&thing, {}, {}, thing.robot, nullptr};
    if (thing.robot != kNone) {
      placed.at = links[thing.robot][thing.index];
    } else {
      const CellState::Place& place = state.objects[thing.index];
      if (place.away) continue;
      placed.at = place.pose;
      if (place.hold) {
        placed.hold = &*place.hold;
        placed.mover = place.hold->robot;
        placed.at = product(links[place.hold->robot][place.hold->link], place.hold->pose);
      }
    }
    placed.center = placed.at * thing.center;
    out.push_back(placed);
  }
  return out;
}

/// Whether links have at most one joint between them, or fixed ones only.
bool Cell::connected(const robot::Robot& robot, std::uint32_t a, std::uint32_t b) const {
  const auto rigid = [&](std::uint32_t link) {
    while (link > 0 && robot.joints[link - 1].type == robot::JointType::Fixed)
      link = robot.joints[link - 1].parent;
    return link;
  };
  if (rigid(a) == rigid(b)) return true;
  const auto has_shape = [&](std::uint32_t link) { return !robot.links[link].collision.empty(); };
  // From the one up to the other: all links between are frames without shapes.
  for (const auto& [low, high] : {std::pair{a, b}, std::pair{b, a}}) {
    int moving = 0;
    for (std::uint32_t at = low; at > 0;) {
      moving += robot.joints[at - 1].type == robot::JointType::Fixed ? 0 : 1;
      at = robot.joints[at - 1].parent;
      if (at == high) {
        if (moving <= 1) return true;
        break;
      }
      if (has_shape(at)) break;
    }
  }
  return false;
}

bool Cell::is_looked_at(const PosedThing& a, const PosedThing& b) const {
  for (const auto& [x, y] : {std::pair{&a, &b}, std::pair{&b, &a}})
    if (x->hold != nullptr && y->thing->robot == x->hold->robot) {
      const auto link = static_cast<std::uint32_t>(y->thing->index);
      if (link == x->hold->link ||
          std::ranges::find(x->hold->touching, link) != x->hold->touching.end())
        return false;
    }
  const auto number = [&](const PosedThing& p) {
    return static_cast<std::size_t>(p.thing - things_.data());
  };
  signed char& known = looked_at_[number(a) * things_.size() + number(b)];
  if (known == 0) {
    const bool allowed =
        std::ranges::find(allowed_, sorted(a.thing->name, b.thing->name)) != allowed_.end() ||
        (a.thing->robot != kNone && a.thing->robot == b.thing->robot &&
         connected(robots_[a.thing->robot].kinematics, static_cast<std::uint32_t>(a.thing->index),
                   static_cast<std::uint32_t>(b.thing->index)));
    known = allowed ? -1 : 1;
  }
  return known > 0;
}

template <typename Wanted>
std::optional<Meeting> Cell::find(const CellState& state, const Wanted& wanted) const {
  const std::vector<PosedThing> all = place(state);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const PosedThing &a = all[i], &b = all[j];
      if (!wanted(a, b)) continue;
      const double reach = a.thing->radius + b.thing->radius;
      if ((a.center - b.center).squaredNorm() > reach * reach || !is_looked_at(a, b)) continue;
      if (a.thing->solid->meets(a.at, *b.thing->solid, b.at))
        return Meeting{{a.thing->name, b.thing->name}};
    }
  return std::nullopt;
}

std::optional<Meeting> Cell::find_meeting(const CellState& state, std::size_t robot) const {
  return find(state, [&](const PosedThing& a, const PosedThing& b) {
    return robot == kNone ? a.mover != kNone || b.mover != kNone
                          : a.mover == robot || b.mover == robot;
  });
}

double Cell::displacement(const CellState& from, const CellState& to, std::size_t robot) const {
  const std::vector<PosedThing> a = place(from), b = place(to);
  double most = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a[i].mover == robot)
      most = std::max(most, (a[i].center - b[i].center).norm() +
                                (a[i].at.linear - b[i].at.linear).norm() * a[i].thing->radius);
  return most;
}

std::optional<Meeting> Cell::find_meeting_of(const CellState& state, std::size_t object) const {
  const Thing* thing = &things_[objects_.at(object)];
  return find(state, [&](const PosedThing& a, const PosedThing& b) {
    return a.thing == thing || b.thing == thing;
  });
}

}  // namespace kaboum::judge
