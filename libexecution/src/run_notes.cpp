// What a journal says of the plan, in JSON.

#include "run_notes.h"

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>
#include <vector>

#include "journal.h"

namespace kaboum::execution {
namespace {

using nlohmann::json;

json rows_of(const geom::Transform& pose) {
  json rows = json::array();
  for (int i = 0; i < 3; ++i)
    rows.push_back({pose.linear(i, 0), pose.linear(i, 1), pose.linear(i, 2), pose.translation[i]});
  return rows;
}

json next_of(plan::Index next) { return next == plan::kNone ? json(nullptr) : json(next); }

json place_of(const world::World& world, const judge::CellState::Place& place) {
  if (place.away) return {{"away", true}};
  if (!place.hold) return {{"pose", rows_of(place.pose)}};
  const world::RobotModel& robot = world.robots[place.hold->robot];
  return {{"held_by", robot.name},
          {"link", robot.kinematics.links[place.hold->link].name},
          {"pose", rows_of(place.hold->pose)}};
}

}  // namespace

std::string RunNotes::plan(const plan::Model& model, const plan::Plan& plan) {
  const plan::PlanGraph graph = plan_graph(model, plan);
  json nodes = json::array();
  for (const plan::PlanGraph::Node& node : graph.nodes) {
    json next = json::array();
    for (const plan::PlanGraph::Edge& edge : node.next)
      next.push_back({{"to", next_of(edge.to)}, {"if", edge.label}});
    nodes.push_back({{"text", node.text}, {"branches", node.branches}, {"next", std::move(next)}});
  }
  return dump({{"plan", plans_++},
               {"name", model.name},
               {"graph", {{"root", next_of(graph.root)}, {"nodes", std::move(nodes)}}}});
}

std::string RunNotes::begun(plan::Index node, const std::string& action,
                            const judge::CellState& state, const plan::KnownState& known) {
  std::string entry =
      dump({{"step", steps_}, {"plan", plans_ - 1}, {"node", node}, {"action", action}});
  add_changes(entry, state, known);
  return entry;
}

std::string RunNotes::done(const plan::RunStep& step, const judge::CellState& state) {
  json said = {{"step_done", steps_++}, {"next", next_of(step.next)}, {"outcome", step.outcome}};
  if (step.unplanned) said["unplanned"] = true;
  std::string entry = dump(said);
  add_changes(entry, state, step.after);
  return entry;
}

void RunNotes::add_changes(std::string& entry, const judge::CellState& state,
                           const plan::KnownState& known) {
  std::set<std::string> now = sentences_of(known.facts());
  std::vector<std::string> learned, gone;
  std::ranges::set_difference(now, known_, std::back_inserter(learned));
  std::ranges::set_difference(known_, now, std::back_inserter(gone));
  known_ = std::move(now);
  // Places are compared, and said, as text: an object has one place at a time.
  const auto changed = [&](const std::string& kind, const std::string& name, const json& place) {
    std::string text = dump(place);
    std::string& was = places_[kind + name];
    if (was == text) return std::string();
    was = text;
    return dump(name) + ':' + text + ',';
  };
  std::string robots, objects;
  for (std::size_t r = 0; r < world_.robots.size(); ++r)
    robots += changed("robot ", world_.robots[r].name, state.q[r]);
  for (std::size_t o = 0; o < world_.objects.size(); ++o)
    objects += changed("object ", world_.objects[o].name, place_of(world_, state.objects[o]));
  entry.pop_back();
  const auto add = [&](const char* name, std::string members) {
    if (members.empty()) return;
    members.pop_back();
    entry.append(",\"").append(name).append("\":{").append(members).append("}");
  };
  add("q", std::move(robots));
  add("objects", std::move(objects));
  if (!learned.empty()) entry += ",\"learned\":" + dump(learned);
  if (!gone.empty()) entry += ",\"gone\":" + dump(gone);
  entry += '}';
}

std::string RunNotes::planning(const plan::Unplanned& why, unsigned after) {
  return dump(
      {{"replanning",
        {{"outcome", why.outcome}, {"actions_before", why.actions}, {"after_plan", after}}}});
}

std::string RunNotes::planned(const plan::Replan& r) {
  return dump({{"replanned",
                {{"outcome", r.outcome},
                 {"status", name_of(r.result)},
                 {"reason", r.reason},
                 {"nodes", r.nodes},
                 {"known_before", r.reached},
                 {"circle", r.circle},
                 {"plan", r.plan > 0 ? json(r.plan) : json(nullptr)},
                 {"wall_seconds", r.seconds}}}});
}

std::string RunNotes::verdict(const DriveReport& report) {
  const SimulationReport& r = report.run.simulation;
  return dump({{"verdict", report.good() ? "good" : "not good"},
               {"samples", r.samples + r.executed.samples},
               {"collisions", r.collisions + r.executed.collisions},
               {"limit_violations", r.limit_violations},
               {"jumps", r.jumps},
               {"problems", r.problems}});
}

}  // namespace kaboum::execution
