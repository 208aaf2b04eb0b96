// What kaboum-pairs prints, reports and writes.

#include "results.h"

#include <kaboum/pairs/srdf.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace kaboum::tools {
namespace {

using pairs::DecidedPair;
using pairs::Relation;
using pairs::Verdict;

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

Json bracket_json(const pairs::Bracket& bracket) {
  Json out = {{"at_least", bracket.lower}};
  out["at_most"] = std::isfinite(bracket.upper) ? Json(bracket.upper) : Json(nullptr);
  return out;
}

Json configuration_json(const robot::Robot& robot, const std::vector<double>& q) {
  Json out = Json::object();
  for (std::size_t v = 0; v < q.size(); ++v) out[robot.variables[v].name] = q[v];
  return out;
}

}  // namespace

std::string words_of(const pairs::Bracket& bracket) {
  return std::isfinite(bracket.upper) ? number(bracket.lower) + " to " + number(bracket.upper)
                                      : "at least " + number(bracket.lower);
}

Json pairs_json(const robot::Robot& robot, const std::vector<DecidedPair>& pairs) {
  Json out = Json::array();
  for (const DecidedPair& pair : pairs) {
    Json j = {{"links", {robot.links[pair.a].name, robot.links[pair.b].name}},
              {"relation", pairs::name_of(pair.relation)},
              {"verdict", pairs::name_of(pair.verdict)},
              {"distance", bracket_json(pair.nearest)}};
    if (pair.depth.lower > 0) j["depth"] = bracket_json(pair.depth);
    if (!pair.q.empty()) j["configuration"] = configuration_json(robot, pair.q);
    if (!pair.why.empty()) j["why"] = pair.why;
    if (pair.unfinished) j["unfinished"] = true;
    j["boxes"] = pair.boxes;
    if (pair.away) {
      j["away_from_joint"] = {{"beyond", pair.away->beyond},
                              {"verdict", pairs::name_of(pair.away->verdict)},
                              {"distance", bracket_json(pair.away->nearest)}};
      if (!pair.away->q.empty())
        j["away_from_joint"]["configuration"] = configuration_json(robot, pair.away->q);
    }
    out.push_back(std::move(j));
  }
  return out;
}

std::string line_of(const robot::Robot& robot, const DecidedPair& pair) {
  std::string out = robot.links[pair.a].name + " " + robot.links[pair.b].name + ": ";
  if (pair.relation != Relation::Moving) {
    out += pairs::name_of(pair.relation);
    out += "; ";
  }
  // What is at the joint is open often: links that touch there exactly.
  const bool away_only = pair.away && pair.away->beyond > 0;
  const bool open_at_joint =
      pair.verdict == Verdict::Open && away_only && pair.away->verdict == Verdict::Never;
  out += pairs::name_of(pair.verdict);
  if (open_at_joint) out += " at the joint";
  if (pair.depth.lower > 0) {
    out += ", " + words_of(pair.depth) + " deep";
    if (!pair.q.empty()) out += " at " + pairs::text_of(pair.q);
  } else if (pair.verdict != Verdict::Always) {
    out += ", smallest distance " + words_of(pair.nearest);
  }
  if (away_only) {
    out += "; farther than " + number(pair.away->beyond) + " from the joint: ";
    out += pairs::name_of(pair.away->verdict);
  }
  if (!pair.why.empty()) out += "; " + pair.why;
  if (pair.unfinished) out += "; a longer --timeout or more --max-boxes may decide it";
  return out;
}

std::string summary_of(const std::vector<DecidedPair>& pairs, double seconds) {
  const auto count = [&](Verdict verdict) {
    return std::to_string(std::ranges::count(pairs, verdict, &DecidedPair::verdict));
  };
  return std::to_string(pairs.size()) + " pairs: " + count(Verdict::Never) + " never touch, " +
         count(Verdict::Always) + " always do, " + count(Verdict::CanTouch) + " can, " +
         count(Verdict::Open) + " open (" + number(seconds) + " s)";
}

std::string to_srdf(const robot::Robot& robot, const std::vector<DecidedPair>& decided) {
  std::vector<pairs::UncheckedPair> disabled;
  for (const DecidedPair& pair : decided) {
    const bool never = pair.verdict == Verdict::Never;
    if (!never && !pairs::is_connected(pair)) continue;
    disabled.push_back(
        {pair.a, pair.b, pair.adjacent ? "Adjacent" : (never ? "Never" : "Default")});
  }
  return pairs::srdf_text(robot, disabled);
}

std::string left_out_of_srdf(const robot::Robot& robot, const std::vector<DecidedPair>& decided) {
  std::string names;
  std::size_t count = 0;
  for (const DecidedPair& pair : decided) {
    if (!pair.adjacent || pair.verdict == Verdict::Never || pairs::is_connected(pair)) continue;
    names += (count++ == 0 ? "" : "; ") + robot.links[pair.a].name + " " + robot.links[pair.b].name;
  }
  if (count == 0) return {};
  return std::to_string(count) +
         " pairs of adjacent links are not disabled, as they touch away from their joint, or it is "
         "not proved that they do not: " +
         names;
}

}  // namespace kaboum::tools
