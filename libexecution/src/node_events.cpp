// What robots do in a node, in its order: motions, and what is taken and let go between them.

#include "node_events.h"

#include <kaboum/base/error.h>

#include <optional>

namespace kaboum::execution {
namespace {

class Events {
 public:
  explicit Events(Held& held) : held_(held) {}

  /// Has an object held by this alone.
  void hold(std::size_t object, std::optional<Holder> by) {
    const auto found = held_.find(object);
    const std::optional<Holder> before =
        found != held_.end() ? std::optional(found->second) : std::nullopt;
    if (before == by) return;
    if (by)
      out.push_back({NodeEvent::Kind::Take, 0, object, *by,
                     before.has_value() && before->robot == by->robot});
    if (before) out.push_back({NodeEvent::Kind::Release, 0, object, *before});
    if (by)
      held_[object] = *by;
    else
      held_.erase(object);
  }

  /// Likewise, while fingers close on it or open from it.
  void hold(std::size_t object, std::optional<Holder> by, std::size_t fingers) {
    const std::size_t before = out.size();
    hold(object, by);
    if (out.size() == before)
      throw Error(ErrorCode::InvalidInput,
                  "fingers of the plan close on what is held, or open from what is not");
    out[before].motion = fingers;
    out[before].moves_fingers = true;
  }

  std::vector<NodeEvent> out;

 private:
  Held& held_;
};

/// The robot that holds an object in a later motion of the node, if it is another one.
std::optional<Holder> next_holder(const std::vector<MotionPart>& parts, std::size_t i,
                                  std::size_t object) {
  for (std::size_t k = i + 1; k < parts.size(); ++k)
    if (const auto link = parts[k].holds.find(object); link != parts[k].holds.end())
      return parts[k].robot == parts[i].robot ? std::nullopt
                                              : std::optional(Holder{parts[k].robot, link->second});
  return std::nullopt;
}

}  // namespace

Held held_in(const judge::CellState& state) {
  Held out;
  for (std::size_t o = 0; o < state.objects.size(); ++o)
    if (const auto& hold = state.objects[o].hold) out[o] = {hold->robot, hold->link};
  return out;
}

std::vector<NodeEvent> motion_events(const std::vector<MotionPart>& parts, Held& held) {
  Events events(held);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const MotionPart& part = parts[i];
    if (part.opens) {
      // What else the gripper holds, mounted on it, is let go before.
      const Holder by{part.robot, part.holds.at(*part.opens)};
      for (const auto& [object, link] : part.holds)
        if (object != *part.opens && link == by.link) events.hold(object, std::nullopt);
      events.hold(*part.opens, std::nullopt, i);
      continue;
    }
    std::vector<std::size_t> let_go;
    for (const auto& [object, by] : held)
      if (by.robot == part.robot && !part.holds.contains(object)) let_go.push_back(object);
    for (const std::size_t object : let_go) events.hold(object, next_holder(parts, i, object));
    if (part.closes) events.hold(*part.closes, Holder{part.robot, part.holds.at(*part.closes)}, i);
    for (const auto& [object, link] : part.holds) events.hold(object, Holder{part.robot, link});
    if (part.closes) continue;
    events.out.push_back({NodeEvent::Kind::Move, i});
  }
  return std::move(events.out);
}

std::vector<NodeEvent> settling_events(const judge::CellState& after, Held& held) {
  Events events(held);
  for (std::size_t o = 0; o < after.objects.size(); ++o)
    if (!after.objects[o].hold) events.hold(o, std::nullopt);
  for (std::size_t o = 0; o < after.objects.size(); ++o)
    if (const auto& now = after.objects[o].hold) events.hold(o, Holder{now->robot, now->link});
  return std::move(events.out);
}

}  // namespace kaboum::execution
