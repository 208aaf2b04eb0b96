// Plans as data of a page that plays them.

#include <kaboum/base/error.h>
#include <kaboum/execution/recording.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <utility>

#include "motion_part.h"
#include "page_scene.h"
#include "simulation_state.h"

namespace kaboum::execution {
namespace {

using Json = nlohmann::ordered_json;

}  // namespace

struct Recording::Data {
  Json states = Json::array(), nodes = Json::array(), steps = Json::array();
};

Recording::Recording(const world::World& world, const plan::Model& model, const plan::Plan& plan,
                     SimulationOptions options)
    : world_(world),
      model_(model),
      plan_(plan),
      options_(std::move(options)),
      data_(std::make_unique<Data>()) {
  require_valid(options_, world);
  data_->nodes = Json::array_t(plan.nodes.size());
}

Recording::~Recording() = default;

std::uint32_t Recording::state_number(const plan::KnownState& known) {
  const auto stated = state_of(world_, model_, known);
  if (!stated)
    throw Error(ErrorCode::InvalidInput,
                "a configuration or pose is not known when the plan is carried out: it cannot be "
                "shown");
  const auto [found, added] =
      states_.emplace(stated->words, static_cast<std::uint32_t>(states_.size()));
  if (added) data_->states.push_back(state_json(stated->state));
  return found->second;
}

std::uint32_t Recording::step_number(plan::Index node, std::uint32_t state) {
  const auto [found, added] =
      steps_.emplace(std::pair(node, state), static_cast<std::uint32_t>(steps_.size()));
  if (added) data_->steps.push_back({{"node", node}, {"before", state}, {"ways", Json::array()}});
  return found->second;
}

void Recording::record_motions(plan::Index number) {
  Json& out = data_->nodes[number];
  if (!out.is_null()) return;
  const plan::Plan::Node& node = plan_.nodes[number];
  Json motions = Json::array();
  for (const plan::Plan::Call& call : node.calls)
    for (const MotionPart& part :
         parts_of(call.payload, world_,
                  "node " + std::to_string(number) + ", " + action_text(model_, node.action))) {
      if (part.path.empty()) continue;
      const motion::Trajectory trajectory = trajectory_of(part, world_, options_);
      Json times = Json::array(), holds = Json::object();
      for (std::size_t i = 0; i < part.path.size(); ++i) times.push_back(trajectory.time_at(i));
      for (const auto& [object, link] : part.holds) holds[std::to_string(object)] = link;
      motions.push_back({{"robot", part.robot},
                         {"holds", std::move(holds)},
                         {"times", std::move(times)},
                         {"path", part.path}});
    }
  out = {{"action", node.acts ? action_text(model_, node.action) : ""},
         {"motions", std::move(motions)}};
}

void Recording::carry_out(const plan::RunStep& step) {
  const std::uint32_t before = state_number(step.before), after = state_number(step.after);
  const std::uint32_t number = step_number(step.node, before);
  record_motions(step.node);
  Json way = {{"outcome", step.outcome}, {"after", after}, {"next", nullptr}};
  if (step.next != plan::kNone) way["next"] = step_number(step.next, after);
  Json& ways = data_->steps[number]["ways"];
  auto found = std::ranges::find_if(ways, [&](const Json& other) {
    return other["outcome"] == way["outcome"] && other["after"] == way["after"] &&
           other["next"] == way["next"];
  });
  if (found == ways.end()) found = ways.insert(ways.end(), std::move(way));
  last_ = {number, static_cast<std::size_t>(found - ways.begin())};
}

void Recording::end_unplanned() {
  if (!last_) throw Error(ErrorCode::InvalidArgument, "no step has been carried out yet");
  data_->steps[last_->first]["ways"][last_->second]["unplanned"] = true;
}

std::string Recording::json(const std::vector<world::ExactMesh>& exact) const {
  Json out = {{"kaboum_player", 1}};
  add_scene(out, world_, exact);
  out["root"] = data_->steps.empty() ? Json(nullptr) : Json(0);
  out["states"] = data_->states;
  if (data_->states.empty()) out["states"].push_back(initial_state_json(world_));
  out["nodes"] = data_->nodes;
  out["steps"] = data_->steps;
  return out.dump();
}

}  // namespace kaboum::execution
