// Plans as JSON, docs/planning/plans.md.
#include <kaboum/base/error.h>
#include <kaboum/base/read_json.h>
#include <kaboum/plan/plan.h>

#include <algorithm>
#include <nlohmann/json.hpp>

namespace kaboum::plan {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::uint64_t kMaximumAttempts = 1000, kMaximumChoice = 1'000'000;

Json names(const Model& model, const std::vector<Index>& objects) {
  Json list = Json::array();
  for (const Index o : objects) list.push_back(model.objects[o].name);
  return list;
}

Json link(Index next) { return next == kNone ? Json("goal") : Json(next); }

class Reader {
 public:
  Reader(const Model& model, const std::string& file) : model_(model), file_(file) {}

  Plan read(const std::string& file_text) {
    const Json json = read_json<Json>(file_text, file_, "write the plan again (kaboum-plan solve)");
    if (!json.is_object() || json.value("format", Json()) != Json("kaboum-plan"))
      fail("not a kaboum-plan file");
    if (json.value("version", Json()) != Json(1)) fail("unknown version of the format");
    if (json.contains("domain") && text(json, "domain") != model_.name)
      fail("it is a plan of domain '" + text(json, "domain") + "', not of '" + model_.name + "'");
    Plan plan;
    if (json.contains("attempts")) {
      const Json& seed = member(json, "seed");
      const Json& attempts = member(json, "attempts");
      if (!seed.is_number_unsigned() || !attempts.is_number_unsigned() ||
          attempts.get<std::uint64_t>() > kMaximumAttempts)
        fail("'seed' and 'attempts' are whole numbers, the latter at most " +
             std::to_string(kMaximumAttempts));
      plan.seed = seed.get<std::uint64_t>();
      plan.attempts = attempts.get<unsigned>();
      if (json.contains("choice"))
        fail("'choice', one for all calls, is of an older version: plan again");
      if (json.contains("choices")) plan.choices = choices(member(json, "choices"));
    }
    if (json.contains("not_certified")) plan.not_certified = text(json, "not_certified");
    const Json& nodes = member(json, "nodes");
    if (!nodes.is_array()) fail("'nodes' is not a list");
    for (const Json& n : nodes) {
      where_ = "node " + std::to_string(plan.nodes.size());
      plan.nodes.push_back(node(n));
    }
    where_ = "root";
    plan.root = next(member(json, "root"));
    for (std::size_t i = 0; i < plan.nodes.size(); ++i) {
      where_ = "node " + std::to_string(i);
      check(plan.nodes[i].next, plan);
      for (const Plan::Branch::Case& c : plan.nodes[i].branch.cases) check(c.next, plan);
    }
    check(plan.root, plan);
    return plan;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const {
    throw Error(ErrorCode::InvalidInput,
                file_ + ": " + (where_.empty() ? "" : where_ + ": ") + message);
  }
  void check(Index next, const Plan& plan) const {
    if (next != kNone && next >= plan.nodes.size()) fail("leads to a node that is not there");
  }
  const Json& member(const Json& json, const char* key) const {
    if (!json.is_object()) fail("expected an object");
    const auto found = json.find(key);
    if (found == json.end()) fail(std::string("'") + key + "' is missing");
    return *found;
  }
  [[nodiscard]] std::string text(const Json& json, const char* key) const {
    const Json& value = member(json, key);
    if (!value.is_string()) fail(std::string("'") + key + "' is not a text");
    return value.get<std::string>();
  }
  [[nodiscard]] Index next(const Json& json) const {
    if (json.is_string() && json.get<std::string>() == "goal") return kNone;
    if (!json.is_number_unsigned() || json.get<std::uint64_t>() >= kNone)
      fail("a successor is a node's number or \"goal\"");
    return json.get<Index>();
  }
  [[nodiscard]] Index object(const Json& json) const {
    if (!json.is_string()) fail("expected a constant's name");
    const auto name = json.get<std::string>();
    for (std::size_t i = 0; i < model_.objects.size(); ++i)
      if (model_.objects[i].name == name) return static_cast<Index>(i);
    fail("unknown constant '" + name + "'");
  }
  template <class Symbols>
  [[nodiscard]] Index symbol(const Symbols& symbols, const std::string& name,
                             const char* what) const {
    for (std::size_t i = 0; i < symbols.size(); ++i)
      if (symbols[i].name == name) return static_cast<Index>(i);
    fail(std::string("unknown ") + what + " '" + name + "'");
  }
  [[nodiscard]] std::vector<Index> objects(const Json& json,
                                           const std::vector<Index>& types) const {
    if (!json.is_array() || json.size() != types.size()) fail("wrong number of arguments");
    std::vector<Index> result;
    for (std::size_t i = 0; i < types.size(); ++i) {
      result.push_back(object(json[i]));
      if (!model_.is_a(result.back(), types[i]))
        fail("'" + model_.objects[result.back()].name + "' is not of type " +
             model_.types[types[i]].name);
    }
    return result;
  }

  [[nodiscard]] Choices choices(const Json& json) const {
    Choices out;
    if (!json.is_object()) fail("'choices' is no object of calls");
    for (const auto& [call, choice] : json.items()) {
      if (!choice.is_number_unsigned() || choice.get<std::uint64_t>() > kMaximumChoice)
        fail("'choices': that of '" + call + "' is no whole number of at most " +
             std::to_string(kMaximumChoice));
      out.emplace(call, choice.get<unsigned>());
    }
    return out;
  }

  [[nodiscard]] Plan::Node node(const Json& json) const {
    Plan::Node n;
    if (!json.is_object()) fail("expected an object");
    if (json.contains("action")) {
      n.acts = true;
      n.action.schema = symbol(model_.actions, text(json, "action"), "action");
      std::vector<Index> types;
      for (const Action::Parameter& p : model_.actions[n.action.schema].parameters)
        types.push_back(p.type);
      n.action.arguments = objects(member(json, "arguments"), types);
    }
    if (json.contains("calls")) n.calls = calls(json["calls"]);
    if (json.contains("branch")) {
      n.branches = true;
      n.branch = branch(json["branch"]);
      if (json.contains("next")) fail("has both 'branch' and 'next'");
    } else {
      n.next = next(member(json, "next"));
    }
    if (!n.acts && !n.branches) fail("has neither 'action' nor 'branch'");
    return n;
  }

  [[nodiscard]] std::vector<Plan::Call> calls(const Json& json) const {
    if (!json.is_array()) fail("'calls' is not a list");
    std::vector<Plan::Call> result;
    for (const Json& c : json) {
      Plan::Call made;
      made.external = symbol(model_.externals, text(c, "external"), "external function");
      const Json& arguments = member(c, "arguments");
      if (!arguments.is_array()) fail("'arguments' is not a list");
      for (const Json& a : arguments) {
        if (!a.is_string()) fail("an argument of a call is not a text");
        made.arguments.push_back(a.get<std::string>());
      }
      made.value = text(c, "value");
      if (c.contains("payload")) made.payload = text(c, "payload");
      result.push_back(std::move(made));
    }
    return result;
  }

  [[nodiscard]] Plan::Branch branch(const Json& json) const {
    Plan::Branch b;
    b.function = json.is_object() && json.contains("function");
    const std::vector<Symbol>& symbols = b.function ? model_.functions : model_.predicates;
    const char* key = b.function ? "function" : "predicate";
    b.symbol = symbol(symbols, text(json, key), key);
    if (symbols[b.symbol].numeric) fail("a number is never sensed");
    b.arguments = objects(member(json, "arguments"), symbols[b.symbol].parameters);
    const Json& cases = member(json, "cases");
    if (!cases.is_array() || cases.empty()) fail("'cases' is not a list of cases");
    for (const Json& c : cases) {
      Plan::Branch::Case made;
      const Json& value = member(c, "value");
      if (b.function) {
        made.value = object(value);
      } else if (value.is_boolean()) {
        made.value = value.get<bool>() ? 1 : 0;
      } else {
        fail("the value of a predicate's case is true or false");
      }
      made.next = next(member(c, "next"));
      if (std::ranges::find(b.cases, made.value, &Plan::Branch::Case::value) != b.cases.end())
        fail("two cases of its branch are for the same value");
      b.cases.push_back(made);
    }
    return b;
  }

  const Model& model_;
  std::string file_;
  std::string where_;
};

}  // namespace

std::string write_plan(const Model& model, const Plan& plan) {
  Json nodes = Json::array();
  for (const Plan::Node& n : plan.nodes) {
    Json j = Json::object();
    if (n.acts) {
      j["action"] = model.actions[n.action.schema].name;
      j["arguments"] = names(model, n.action.arguments);
    }
    for (const Plan::Call& c : n.calls) {
      Json call = {{"external", model.externals[c.external].name},
                   {"arguments", c.arguments},
                   {"value", c.value}};
      if (!c.payload.empty()) call["payload"] = c.payload;
      j["calls"].push_back(std::move(call));
    }
    if (n.branches) {
      Json cases = Json::array();
      for (const Plan::Branch::Case& c : n.branch.cases)
        cases.push_back(
            {{"value", n.branch.function ? Json(model.objects[c.value].name) : Json(c.value != 0)},
             {"next", link(c.next)}});
      const std::string& symbol =
          (n.branch.function ? model.functions : model.predicates)[n.branch.symbol].name;
      j["branch"] = {{n.branch.function ? "function" : "predicate", symbol},
                     {"arguments", names(model, n.branch.arguments)},
                     {"cases", std::move(cases)}};
    } else {
      j["next"] = link(n.next);
    }
    nodes.push_back(std::move(j));
  }
  Json json = {{"format", "kaboum-plan"}, {"version", 1}, {"domain", model.name}};
  if (plan.attempts > 0) {
    json["seed"] = plan.seed;
    json["attempts"] = plan.attempts;
    if (!plan.choices.empty()) json["choices"] = plan.choices;
  }
  if (!plan.not_certified.empty()) json["not_certified"] = plan.not_certified;
  json["root"] = link(plan.root);
  json["nodes"] = std::move(nodes);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

Plan read_plan(const Model& model, const std::string& json, const std::string& file_name) {
  return Reader(model, file_name).read(json);
}

}  // namespace kaboum::plan
