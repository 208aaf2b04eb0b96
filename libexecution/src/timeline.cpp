// A plan as files: motions, and what happens between them.

#include "timeline.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/path.h>

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>

#include "finger_motion.h"
#include "node_events.h"

namespace kaboum::execution {
namespace fs = std::filesystem;
namespace {

using Json = nlohmann::ordered_json;

const char* extension_of(MotionFormat format) {
  switch (format) {
    case MotionFormat::Csv:
      return ".csv";
    case MotionFormat::Json:
      return ".json";
    case MotionFormat::Yaml:
      break;
  }
  return ".yaml";
}

std::string text_of(const motion::Trajectory& trajectory, const robot::Robot& robot,
                    MotionFormat format) {
  if (format == MotionFormat::Csv) return to_csv(trajectory, robot);
  return to_joint_trajectory(
      trajectory, robot,
      format == MotionFormat::Json ? motion::MessageFormat::Json : motion::MessageFormat::Yaml);
}

Json pose_json(const geom::Transform& pose) {
  Json rows = Json::array();
  for (int i = 0; i < 3; ++i)
    rows.push_back({pose.linear(i, 0), pose.linear(i, 1), pose.linear(i, 2), pose.translation[i]});
  return rows;
}

/// One field of a table: a number as it is in JSON, a text as CSV quotes it.
std::string field(const Json& value) {
  if (value.is_null()) return "";
  return value.is_string() ? robot::csv_field(value.get<std::string>()) : value.dump();
}

/// What is the same in plan.json and in a row of events.csv.
constexpr const char* kColumns[] = {"time",     "event", "robot", "object", "link", "file",
                                    "duration", "fact",  "value", "next",   "plan"};

/// What is taken or let go.
Json hold_json(const world::World& world, const NodeEvent& event, double time) {
  const world::RobotModel& robot = world.robots[event.by.robot];
  return {{"time", time},
          {"event", event.kind == NodeEvent::Kind::Take ? "take" : "release"},
          {"robot", robot.name},
          {"object", world.objects[event.object].name},
          {"link", robot.kinematics.links[event.by.link].name}};
}

/// How a step goes on: what decides it and what is sensed, at its end.
/// @param unplanned  of those that no branch is for, its number: the plan is not known yet
Json way_json(const plan::RunStep& step, double end, std::size_t unplanned) {
  Json way = {
      {"if", nullptr}, {"sensed", Json::object()}, {"events", Json::array()}, {"next", nullptr}};
  if (step.decides) way["if"] = {{"fact", step.decides->fact}, {"value", step.decides->value}};
  if (step.unplanned) way["plan"] = unplanned;
  for (const plan::SensedValue& s : step.sensed) {
    way["sensed"][s.fact] = s.value;
    way["events"].push_back(
        {{"time", end}, {"event", "sense"}, {"fact", s.fact}, {"value", s.value}});
  }
  return way;
}

}  // namespace

struct Timeline::Data {
  Json file, steps = Json::array();
};

Timeline::Timeline(const world::World& world, fs::path folder, MotionFormat format, double rate)
    : world_(world), folder_(std::move(folder)), format_(format), data_(std::make_unique<Data>()) {
  std::error_code error;
  fs::create_directories(folder_, error);
  if (error)
    throw Error(ErrorCode::OutputFailed,
                folder_.string() + ": cannot be created: " + error.message());
  data_->file = {{"kaboum_plan_run", 1}, {"unit", world.unit}, {"rate", rate}};
  Json& robots = data_->file["robots"] = Json::object();
  for (const world::RobotModel& robot : world.robots) {
    Json names = Json::array();
    for (const robot::Variable& v : robot.kinematics.variables) names.push_back(v.name);
    robots[robot.name] = {{"joint_names", std::move(names)}};
  }
  data_->file["plans"] = Json::array();
}

Timeline::~Timeline() = default;

void Timeline::begin(const plan::Model& model, const plan::Plan& plan,
                     std::shared_ptr<NodeMotions> motions) {
  model_ = &model;
  plan_ = &plan;
  motions_ = std::move(motions);
  steps_.clear();
  data_->file["plans"].push_back({{"first", nullptr}});
  ++plans_;
}

std::size_t Timeline::step_number(plan::Index node, const std::string& words) {
  const auto [found, added] = steps_.try_emplace({node, words}, data_->steps.size());
  if (added) data_->steps.push_back({{"step", found->second}, {"plan", plans_ - 1}});
  return found->second;
}

void Timeline::add_motion(plan::Index node, std::size_t robot,
                          const motion::Trajectory& trajectory) {
  char name[64];
  std::snprintf(name, sizeof name, "%05zu-node%u-", ++files_, node);
  const std::string file = name + world_.robots[robot].name + extension_of(format_);
  io::write_file(folder_ / file, text_of(trajectory, world_.robots[robot].kinematics, format_));
  data_->file["added"].push_back({{"file", file}, {"duration", trajectory.duration()}});
}

void Timeline::add(const plan::RunStep& step) {
  const std::size_t unplanned = unplanned_;
  if (step.unplanned) ++unplanned_;
  const auto before = state_of(world_, *model_, step.before),
             after = state_of(world_, *model_, step.after);
  if (!before || !after) return;  // the simulation has said so
  const std::size_t number = step_number(step.node, before->words);
  Json& plan = data_->file["plans"].back();
  if (plan["first"].is_null()) {
    plan["first"] = number;
    Json& start = plan["start"] = {{"robots", Json::object()}, {"objects", Json::object()}};
    for (std::size_t r = 0; r < world_.robots.size(); ++r)
      start["robots"][world_.robots[r].name] = before->state.q[r];
    for (std::size_t o = 0; o < world_.objects.size(); ++o) {
      const judge::CellState::Place& place = before->state.objects[o];
      Json& entry = start["objects"][world_.objects[o].name];
      if (place.away)
        entry = {{"away", true}};
      else if (place.hold)
        entry = {{"held_by", world_.robots[place.hold->robot].name}};
      else
        entry = {{"pose", pose_json(place.pose)}};
    }
  }
  Held held = held_in(before->state);
  const plan::Plan::Node& node = plan_->nodes[step.node];
  const std::vector<MotionPart>& parts = motions_->of(step.node, *before);
  const std::vector<NodeEvent> moving = motion_events(parts, held);
  Json& out = data_->steps[number];
  if (!out.contains("events")) {
    Json added = Json::array();
    if (data_->file.contains("added")) added = std::move(data_->file["added"]);
    double time = 0;
    std::size_t next = 0;
    Json events = Json::array();
    for (const NodeEvent& event : moving) {
      if (event.moves_fingers) {
        const Json& motion = added.at(next++);
        Json entry = hold_json(world_, event, time);
        entry["file"] = motion["file"];
        entry["duration"] = motion["duration"];
        entry["gripper"] = to_json<Json>(finger_motion_of(parts[event.motion], world_));
        time += motion["duration"].get<double>();
        events.push_back(std::move(entry));
        continue;
      }
      if (event.kind != NodeEvent::Kind::Move) {
        events.push_back(hold_json(world_, event, time));
        continue;
      }
      if (parts[event.motion].path.empty()) continue;  // the simulation has said so
      const Json& motion = added.at(next++);
      events.push_back({{"time", time},
                        {"event", "move"},
                        {"robot", world_.robots[parts[event.motion].robot].name},
                        {"file", motion["file"]},
                        {"duration", motion["duration"]}});
      time += motion["duration"].get<double>();
    }
    out["node"] = step.node;
    out["action"] = node.acts ? action_text(*model_, node.action) : "";
    out["duration"] = time;
    out["events"] = std::move(events);
    out["ways"] = Json::array();
  }
  data_->file.erase("added");
  const double end = out["duration"].get<double>();
  Json way = way_json(step, end, unplanned);
  for (const NodeEvent& event : settling_events(after->state, held))
    way["events"].push_back(hold_json(world_, event, end));
  if (step.next != plan::kNone) way["next"] = step_number(step.next, after->words);
  // `out` may have moved.
  Json& ways = data_->steps[number]["ways"];
  if (std::ranges::find(ways, way) == ways.end()) ways.push_back(std::move(way));
}

void Timeline::write(const std::vector<plan::Replan>& replans) const {
  Json file = data_->file;
  Json& steps = file["steps"] = data_->steps;
  for (Json& step : steps) {
    if (!step.contains("ways")) continue;
    Json ways = Json::array();
    for (Json& way : step["ways"]) {
      if (way.contains("plan")) {
        const unsigned plan = replans.at(way["plan"].get<std::size_t>()).plan;
        way["plan"] = plan > 0 ? Json(plan) : Json(nullptr);
      }
      if (std::ranges::find(ways, way) == ways.end()) ways.push_back(std::move(way));
    }
    step["ways"] = std::move(ways);
  }
  io::write_file(folder_ / "plan.json", file.dump(1) + "\n");
  std::string table = "step,way,action";
  for (const char* column : kColumns) table += std::string(",") + column;
  table += '\n';
  const auto row = [&](const Json& step, const Json& way, const Json& event) {
    table += field(step["step"]) + ',' + field(way) + ',' + field(step["action"]);
    for (const char* column : kColumns)
      table += ',' + (event.contains(column) ? field(event[column]) : std::string());
    table += '\n';
  };
  for (const Json& step : steps) {
    if (!step.contains("events")) continue;
    for (const Json& event : step["events"]) row(step, nullptr, event);
    std::size_t number = 0;
    for (const Json& way : step["ways"]) {
      for (const Json& event : way["events"]) row(step, number, event);
      Json end = {{"time", step["duration"]}, {"event", "end"}, {"next", way["next"]}};
      if (!way["if"].is_null()) end.update(way["if"]);
      if (way.contains("plan")) end["plan"] = way["plan"];
      row(step, number++, end);
    }
  }
  io::write_file(folder_ / "events.csv", table);
}

}  // namespace kaboum::execution
