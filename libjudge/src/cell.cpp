// Robots and objects as exact meshes: every pair that is not allowed, by Solid.

#include <kaboum/base/error.h>
#include <kaboum/judge/cell.h>
#include <kaboum/judge/placement.h>

#include <algorithm>
#include <cmath>
#include <tuple>

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
      if ((x->hold->link_touches && link == x->hold->link) ||
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

double Cell::depth(const CellState& state, double step) const {
  double out = 0;
  const std::vector<PosedThing> all = place(state);
  for (std::size_t i = 0; i < all.size(); ++i)
    for (std::size_t j = i + 1; j < all.size(); ++j) {
      const PosedThing &a = all[i], &b = all[j];
      const double reach = a.thing->radius + b.thing->radius;
      if ((a.mover == kNone && b.mover == kNone) ||
          (a.center - b.center).squaredNorm() > reach * reach || !is_looked_at(a, b))
        continue;
      if (a.thing->solid->meets(a.at, *b.thing->solid, b.at))
        out = std::max(out, a.thing->solid->depth(a.at, *b.thing->solid, b.at, step));
    }
  return out;
}

std::vector<std::uint32_t> Cell::to_root(const robot::Robot& robot, std::uint32_t link) {
  std::vector<std::uint32_t> out;
  for (; link > 0; link = robot.joints[link - 1].parent) out.push_back(link);
  return out;
}

double Cell::approach(const PosedThing& a, const PosedThing& b, std::size_t robot,
                      const std::vector<double>& begin, const std::vector<double>& end) const {
  const robot::Robot& kinematics = robots_[robot].kinematics;
  const auto chain = [&](const PosedThing& p) -> std::vector<std::uint32_t> {
    if (p.mover != robot) return {};
    return to_root(kinematics,
                   p.hold != nullptr ? p.hold->link : static_cast<std::uint32_t>(p.thing->index));
  };
  const std::vector<std::uint32_t> from_a = chain(a), from_b = chain(b);
  double out = 0;
  for (const auto& [p, own, other] :
       {std::tuple{&a, &from_a, &from_b}, std::tuple{&b, &from_b, &from_a}}) {
    // From the frame of the link to the farthest point.
    double reach =
        p->thing->radius +
        (p->hold != nullptr ? p->hold->pose * p->thing->center : p->thing->center).norm();
    for (const std::uint32_t link : *own) {
      // Of joints above both, both follow.
      if (std::ranges::find(*other, link) != other->end()) break;
      const robot::Joint& joint = kinematics.joints[link - 1];
      const bool is_fixed = joint.type == robot::JointType::Fixed;
      const double from = is_fixed ? 0 : begin[joint.variable];
      const double to = is_fixed ? 0 : end[joint.variable];
      const double moved = std::abs(joint.multiplier * (to - from));
      out += moved * (joint.type == robot::JointType::Revolute ? reach : 1);
      reach += joint.origin.translation.norm();
      if (joint.type == robot::JointType::Prismatic)
        reach += std::abs(joint.offset) +
                 std::abs(joint.multiplier) * std::max(std::abs(from), std::abs(to));
    }
  }
  return out;
}

std::optional<Meeting> Cell::find_meeting_on(const CellState& from, const CellState& to,
                                             std::size_t robot, std::size_t samples,
                                             std::size_t& looked) const {
  const std::vector<double>&begin = from.q[robot], &end = to.q[robot];
  std::vector<std::vector<PosedThing>> placed(samples + 1);
  const auto at = [&](std::size_t k) -> const std::vector<PosedThing>& {
    if (!placed[k].empty()) return placed[k];
    CellState state = from;
    const double share =
        static_cast<double>(k) / static_cast<double>(std::max<std::size_t>(samples, 1));
    for (std::size_t i = 0; i < begin.size(); ++i)
      state.q[robot][i] = begin[i] + share * (end[i] - begin[i]);
    return placed[k] = place(state);
  };
  // How far two things are apart, at least.
  const auto apart = [](const PosedThing& a, const PosedThing& b, double least) {
    constexpr double kBelow = 0.4;
    const double balls = (a.center - b.center).norm() - a.thing->radius - b.thing->radius;
    double reach = std::max(balls, 0.5);
    if (balls >= reach) return balls;
    while (reach > least && a.thing->solid->is_within(a.at, *b.thing->solid, b.at, reach))
      reach *= kBelow;
    return reach > least ? reach : 0.0;
  };
  const std::vector<PosedThing>& first = at(0);
  for (std::size_t i = 0; i < first.size(); ++i)
    for (std::size_t j = i + 1; j < first.size(); ++j) {
      if (first[i].mover != robot && first[j].mover != robot) continue;
      if (!is_looked_at(first[i], first[j])) continue;
      const double way = kLarger * approach(first[i], first[j], robot, begin, end) /
                         static_cast<double>(std::max<std::size_t>(samples, 1));
      for (std::size_t k = 0;;) {
        const PosedThing &a = at(k)[i], &b = at(k)[j];
        ++looked;
        const double reach = a.thing->radius + b.thing->radius;
        if ((a.center - b.center).squaredNorm() <= reach * reach &&
            a.thing->solid->meets(a.at, *b.thing->solid, b.at))
          return Meeting{{a.thing->name, b.thing->name}};
        if (k == samples) break;
        // Where nothing moves, the start stands for all.
        const double steps =
            way == 0 ? static_cast<double>(samples) : std::floor(apart(a, b, way) / way);
        k = steps < static_cast<double>(samples - k) ? k + static_cast<std::size_t>(steps) + 1
                                                     : samples;
      }
    }
  return std::nullopt;
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
