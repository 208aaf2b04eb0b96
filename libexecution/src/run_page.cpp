// Pages of runs: a scene, and the lines of a journal as a page reads them.

#include <kaboum/base/error.h>
#include <kaboum/base/json_damage.h>
#include <kaboum/execution/run_page.h>
#include <kaboum/page/page.h>
#include <kaboum/plan/plan.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "journal.h"
#include "page_scene.h"

namespace kaboum::execution {
namespace {

using nlohmann::json;

constexpr double kPictures = 1.0 / 25;  // between positions of a motion that is drawn [s]

/// Nodes of a plan's graph that are drawn: more take a browser, and the thread that serves it,
/// seconds.
constexpr std::size_t kMostDrawn = 2000;

/// A number as it is drawn: to a millionth.
json rounded(const json& x) {
  const double value = x.get<double>();
  return std::isfinite(value) ? json(std::round(value * 1e6) / 1e6) : json(0);
}

json rounded_all(const json& numbers, std::size_t first = 0) {
  json out = json::array();
  for (std::size_t i = first; i < numbers.size(); ++i) out.push_back(rounded(numbers.at(i)));
  return out;
}

/// Times and positions, the first and the last ones among them.
/// @param time_of, @param positions_of  of the i-th
template <class TimeOf, class PositionsOf>
json thinned(std::size_t count, const TimeOf& time_of, const PositionsOf& positions_of) {
  json times = json::array(), positions = json::array();
  double next = -1;
  for (std::size_t i = 0; i < count; ++i) {
    const double time = time_of(i);
    if (time < next && i + 1 < count) continue;
    next = time + kPictures * (1 - 1e-6);
    times.push_back(rounded(time));
    positions.push_back(positions_of(i));
  }
  return {{"times", std::move(times)}, {"positions", std::move(positions)}};
}

/// @throws nlohmann::json::exception for others than drivers are told
void thin_told(json& message) {
  if (!message.contains("trajectory")) return;
  json& trajectory = message["trajectory"];
  const json& points = trajectory.at("points");
  message["trajectory"] = thinned(
      points.size(),
      [&](std::size_t i) { return points.at(i).at("time_from_start").get<double>(); },
      [&](std::size_t i) { return rounded_all(points.at(i).at("positions")); });
}

/// @throws nlohmann::json::exception
void thin_heard(json& answer) {
  if (!answer.contains("executed")) return;
  const json rows = answer["executed"];
  answer["executed"] = thinned(
      rows.size(), [&](std::size_t i) { return rows.at(i).at(0).get<double>(); },
      [&](std::size_t i) { return rounded_all(rows.at(i), 1); });
}

/// The drawing of a plan. @throws nlohmann::json::exception; Error for what is no graph
std::string drawing_of(const json& graph) {
  const auto index = [](const json& node) {
    return node.is_null() ? plan::kNone : node.get<plan::Index>();
  };
  plan::PlanGraph out;
  out.root = index(graph.at("root"));
  for (const json& node : graph.at("nodes")) {
    plan::PlanGraph::Node& made = out.nodes.emplace_back();
    made.text = node.at("text").get<std::string>();
    made.branches = node.at("branches").get<bool>();
    for (const json& edge : node.at("next"))
      made.next.push_back({index(edge.at("to")), edge.at("if").get<std::string>()});
  }
  return plan_svg(out);
}

/// Text of JSON as what it says; as it is, where that is no object.
void read_text(json& text, void (*thin)(json&)) {
  if (!text.is_string()) return;
  const auto& inner = text.get_ref<const std::string&>();
  if (is_nested_too_deep(inner)) return;
  json read = json::parse(inner, nullptr, false);
  if (!read.is_object()) return;
  thin(read);
  text = std::move(read);
}

/// @param events  JSON; empty: they are yet to come
std::string page_of(const world::World& world, const std::filesystem::path& scene,
                    const std::vector<std::string>& packages, const std::string& events,
                    Notes& notes) {
  nlohmann::ordered_json data = {{"kaboum_run", 1}};
  std::vector<world::ExactMesh> exact;
  try {
    exact = exact_meshes(world, scene, packages);
  } catch (const Error& error) {
    notes.push_back(std::string("only bounding sets are shown: ") + error.what());
  }
  add_scene(data, world, exact);
  data["states"] = {initial_state_json(world)};
  std::string text = data.dump();
  if (!events.empty()) {
    text.pop_back();
    text += ",\"events\":" + events + "}";
  }
  return page::filled("run.html", {{"data", page::in_script(text)}});
}

}  // namespace

std::vector<std::string> journal_lines(const std::string& file) {
  std::vector<std::string> out;
  read_journal(file, [&](std::string line, const json& /*entry*/, std::size_t /*number*/) {
    out.push_back(std::move(line));
  });
  return out;
}

std::string run_event(const std::string& line) {
  constexpr const char* kUnread = R"({"unread":true})";
  if (is_nested_too_deep(line)) return kUnread;
  json event = json::parse(line, nullptr, false);
  if (!event.is_object()) return kUnread;
  event.erase("svg");
  event.erase("undrawn");
  try {
    if (event.contains("told")) read_text(event["told"], thin_told);
    if (event.contains("heard")) read_text(event["heard"], thin_heard);
    if (event.contains("graph")) {
      const std::size_t nodes = event["graph"].at("nodes").size();
      if (nodes > kMostDrawn)
        event["undrawn"] = nodes;
      else
        event["svg"] = drawing_of(event["graph"]);
      event.erase("graph");
    }
  } catch (const json::exception&) {
    return kUnread;
  } catch (const Error&) {
    return kUnread;
  }
  return dump(event);
}

PlanPage run_page(const world::World& world, const std::filesystem::path& scene,
                  const std::vector<std::string>& lines, const std::vector<std::string>& packages) {
  std::string events = "[";
  for (const std::string& line : lines) {
    if (events.size() > 1) events += ",\n";
    events += run_event(line);
  }
  PlanPage out;
  out.html = page_of(world, scene, packages, events + "]", out.notes);
  return out;
}

LiveRun::LiveRun(const world::World& world, const std::filesystem::path& scene, std::uint16_t port,
                 const std::vector<std::string>& packages) {
  page::EventServerOptions served;
  served.port = port;
  served.page = page_of(world, scene, packages, "", notes_);
  served.event = run_event;
  server_ = std::make_unique<page::EventServer>(std::move(served));
}

}  // namespace kaboum::execution
