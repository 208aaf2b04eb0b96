// What calls are about, and which other things are in the way of what they found: answers are kept
// for what they depend on, and shared by all states in which that is the same.
#include "involved.h"

#include <kaboum/world/motion_check.h>

#include <algorithm>

#include "stopwatch.h"

namespace kaboum::manipulation {
namespace {

constexpr signed char kUnknown = 0, kBeside = 1, kInTheWay = 2;

void add_attachment(std::string& key, const world::Attachment& held) {
  add_to_key(key, held.robot);
  add_to_key(key, held.link);
  add_to_key(key, held.pose);
  add_to_key(key, held.grasp.size());
  key += held.grasp;
}

}  // namespace

void add_to_key(std::string& key, std::span<const double> values) {
  key.append(reinterpret_cast<const char*>(values.data()), values.size_bytes());  // NOLINT: bits
}

void add_to_key(std::string& key, std::uint64_t number) {
  key.append(reinterpret_cast<const char*>(&number), sizeof number);  // NOLINT: bits
}

void add_to_key(std::string& key, const world::Transform& pose) {
  add_to_key(key, std::span(pose.linear.data(), 9));
  add_to_key(key, std::span(pose.translation.data(), 3));
}

Involved::Involved(Geometry& geometry, const GeometricState& state,
                   std::span<const std::size_t> robots, std::span<const std::size_t> objects)
    : geometry_(geometry),
      all_(state.world()),
      mounted_(state.mounted()),
      robots_(geometry.world.robots.size(), 0),
      objects_(geometry.world.objects.size(), 0) {
  for (const std::size_t r : robots) robots_[r] = 1;
  for (const std::size_t o : objects) objects_[o] = 1;
  for (std::size_t r = 0; r < robots_.size(); ++r)
    if (geometry.is_fixed_robot(r)) robots_[r] = 1;
  for (std::size_t o = 0; o < objects_.size(); ++o)
    if (geometry.is_fixed_object(o)) objects_[o] = 1;
  close();
}

bool Involved::is_carried(std::size_t object, std::size_t robot) const {
  const auto& held = all_.attachments[object];
  return held && held->robot == robot && !all_.absent[object];
}

/// With an object, what it is mounted on, what is mounted on it and what holds it are involved;
/// with a robot, all that it carries.
void Involved::close() {
  for (bool more = true; more;) {
    more = false;
    const auto add = [&](char& involved) {
      more = more || involved == 0;
      involved = 1;
    };
    for (std::size_t o = 0; o < objects_.size(); ++o) {
      if (all_.absent[o]) continue;
      const auto& held = all_.attachments[o];
      if (held && robots_[held->robot] != 0) add(objects_[o]);
      if (mounted_[o] && objects_[*mounted_[o]] != 0 && !geometry_.is_fixed_object(*mounted_[o]))
        add(objects_[o]);
      if (objects_[o] == 0) continue;
      if (held) add(robots_[held->robot]);
      if (mounted_[o]) add(objects_[*mounted_[o]]);
    }
  }
}

void Involved::add_all() {
  std::ranges::fill(robots_, 1);
  std::ranges::fill(objects_, 1);
}

world::WorldState Involved::state() const {
  world::WorldState out = all_;
  out.absent_robots.assign(robots_.size(), false);
  for (std::size_t r = 0; r < robots_.size(); ++r)
    if (robots_[r] == 0) out.absent_robots[r] = true;
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    if (objects_[o] != 0) continue;
    out.absent[o] = true;
    out.attachments[o].reset();
  }
  return out;
}

std::vector<std::optional<std::size_t>> Involved::mounted() const {
  auto out = mounted_;
  for (std::size_t o = 0; o < out.size(); ++o)
    if (objects_[o] == 0) out[o].reset();
  return out;
}

void Involved::add_to(std::string& key) const {
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    if (robots_[r] == 0) continue;
    add_to_key(key, r);
    add_to_key(key, all_.q[r]);
  }
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    if (objects_[o] == 0 || geometry_.is_fixed_object(o)) continue;
    const auto& held = all_.attachments[o];
    add_to_key(key, robots_.size() + o);
    add_to_key(key, all_.absent[o] ? 0 : held ? 1 : 2);
    add_to_key(key, mounted_[o] ? *mounted_[o] + 1 : 0);
    if (all_.absent[o]) continue;
    if (held)
      add_attachment(key, *held);
    else
      add_to_key(key, all_.poses[o]);
  }
}

std::vector<Involved::Thing> Involved::others() const {
  std::vector<Thing> out;
  std::string key;
  const auto number = [&] {
    const auto next = static_cast<std::uint32_t>(geometry_.placed.size());
    return geometry_.placed.try_emplace(key, next).first->second;
  };
  for (std::size_t r = 0; r < robots_.size(); ++r) {
    if (robots_[r] != 0) continue;
    Thing& thing = out.emplace_back();
    thing.robot = r;
    for (std::size_t i = 0; i < geometry_.world.robots[r].shapes.size(); ++i)
      thing.items.push_back({r, i});
    key.clear();
    add_to_key(key, r);
    add_to_key(key, all_.q[r]);
    for (std::size_t o = 0; o < objects_.size(); ++o) {
      if (!is_carried(o, r)) continue;
      thing.items.push_back({world::Item::kObject, o});
      add_to_key(key, o);
      add_attachment(key, *all_.attachments[o]);
    }
    thing.number = number();
  }
  for (std::size_t o = 0; o < objects_.size(); ++o) {
    if (objects_[o] != 0 || all_.absent[o] || all_.attachments[o]) continue;
    Thing& thing = out.emplace_back();
    thing.object = o;
    thing.items = {{world::Item::kObject, o}};
    key.clear();
    add_to_key(key, robots_.size() + o);
    add_to_key(key, all_.poses[o]);
    thing.number = number();
  }
  return out;
}

/// Those of some things that are in the way of one of the motions.
std::vector<Involved::Thing> Involved::decide(const Performed& performed,
                                              std::vector<Thing> things) const {
  const Stopwatch watch;
  std::vector<Thing> in_the_way;
  std::uint64_t asked = 0, positive = 0;
  for (const Motion& motion : performed.motions) {
    world::WorldState state = all_;
    state.absent.assign(objects_.size(), true);
    state.absent_robots.assign(robots_.size(), true);
    state.absent_robots[motion.robot] = false;
    for (auto& held : state.attachments)
      if (held && held->robot == motion.robot) held.reset();
    for (const auto& [object, held] : motion.holds) {
      state.absent[object] = false;
      state.attachments[object] = held;
    }
    std::vector<world::Item> items;
    for (const Thing& thing : things) {
      items.insert(items.end(), thing.items.begin(), thing.items.end());
      if (thing.robot != world::Item::kObject) state.absent_robots[thing.robot] = false;
      for (const world::Item& item : thing.items)
        if (item.robot == world::Item::kObject) state.absent[item.index] = false;
    }
    if (items.empty()) break;
    const auto found =
        find_obstacles(geometry_.checker, state, motion.robot, motion.decided(), items,
                       check_of(geometry_, motion.robot, state.attachments, motion.beside));
    ++asked;
    positive += found.empty() ? 0 : 1;
    const auto is_found = [&](const Thing& thing) {
      return std::ranges::any_of(thing.items, [&](const world::Item& item) {
        return std::binary_search(found.begin(), found.end(), item);
      });
    };
    std::ranges::copy_if(things, std::back_inserter(in_the_way), is_found);
    std::erase_if(things, is_found);
  }
  if (GeometryCounters* counters = geometry_.options.counters.get()) {
    counters->predicate_calls += asked;
    counters->positive += positive;
    counters->path_seconds += watch.seconds();
  }
  return in_the_way;
}

bool Involved::add_obstacles(Performed& performed) {
  std::vector<Thing> things = others(), unknown;
  for (const Thing& thing : things) {
    if (performed.in_the_way.size() <= thing.number)
      performed.in_the_way.resize(geometry_.placed.size(), kUnknown);
    if (performed.in_the_way[thing.number] == kUnknown) unknown.push_back(thing);
  }
  if (!unknown.empty()) {
    // Nothing is said of them unless all are decided: what decides may throw.
    const std::vector<Thing> obstacles = decide(performed, unknown);
    for (const Thing& thing : unknown) performed.in_the_way[thing.number] = kBeside;
    for (const Thing& thing : obstacles) performed.in_the_way[thing.number] = kInTheWay;
  }
  bool any = false;
  for (const Thing& thing : things) {
    if (performed.in_the_way[thing.number] != kInTheWay) continue;
    any = true;
    (thing.robot != world::Item::kObject ? robots_[thing.robot] : objects_[thing.object]) = 1;
  }
  if (any) close();
  return any;
}

}  // namespace kaboum::manipulation
