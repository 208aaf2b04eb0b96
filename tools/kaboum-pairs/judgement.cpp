// What is said of a judged matrix: lines, JSON, JUnit and SARIF.

#include "judgement.h"

#include <kaboum/base/xml_text.h>

#include <algorithm>
#include <array>
#include <cstdio>

#include "common/shell_word.h"
#include "results.h"

namespace kaboum::tools {
namespace {

using pairs::JudgedPair;
using pairs::Judgement;
using pairs::MatrixFault;

std::string short_text(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", value);
  return text.data();
}

std::string name_of(const JudgedPair& pair) { return pair.stated.a + " " + pair.stated.b; }

/// What was found, in words.
std::string finding_of(const JudgedPair& pair) {
  std::string out = pairs::name_of(pair.judgement);
  if (!pair.found) return out + ": " + pair.why;
  switch (pair.judgement) {
    case Judgement::Proved:
      return out + ": at least " + short_text(pair.found->nearest.lower) + " apart";
    case Judgement::Refuted:
      out += ": they touch at " + pairs::text_of(pair.q);
      if (pair.found->away && pair.found->away->beyond > 0)
        out += ", farther than " + short_text(pair.found->away->beyond) + " from their joint";
      else if (pair.found->depth.lower > 0)
        out += ", " + words_of(pair.found->depth) + " deep";
      return out;
    case Judgement::Open:
      out += ": their smallest distance is " + words_of(pair.found->nearest);
      if (!pair.why.empty()) out += "; " + pair.why;
      return out;
    case Judgement::Connected: {
      out += std::string(" (") + pairs::name_of(pair.found->relation) + ")";
      if (pair.found->away)
        out += ": farther than " + short_text(pair.found->away->beyond) +
               " from the joint: " + pairs::name_of(pair.found->away->verdict);
      return out;
    }
    default:
      return out + ": they touch in every configuration";
  }
}

Json sarif_result(const JudgedMatrix& judged, const char* rule, const char* level,
                  const std::string& text, int line) {
  return {{"ruleId", rule},
          {"level", level},
          {"message", {{"text", text}}},
          {"locations",
           {{{"physicalLocation",
              {{"artifactLocation", {{"uri", judged.file}}},
               {"region", {{"startLine", std::max(1, line)}}}}}}}}};
}

}  // namespace

std::size_t JudgedMatrix::count(Judgement judgement) const {
  return static_cast<std::size_t>(std::ranges::count(pairs, judgement, &JudgedPair::judgement));
}

bool JudgedMatrix::fails(const FailOn& on) const {
  return count(Judgement::Refuted) > 0 || (on.open && count(Judgement::Open) > 0) ||
         (on.faults && !matrix.faults.empty());
}

std::string line_of(const JudgedPair& pair) {
  std::string out = "line " + std::to_string(pair.stated.line) + ": " + name_of(pair);
  if (!pair.stated.reason.empty()) out += " (" + pair.stated.reason + ")";
  return out + ": " + finding_of(pair);
}

std::string replay_of(const JudgedMatrix& judged, const JudgedPair& pair) {
  if (pair.judgement != Judgement::Refuted) return {};
  return judged.again + " --links " + shell_word(pair.stated.a + "," + pair.stated.b) +
         " --configuration=" + pairs::text_of(pair.q);
}

std::string summary_of(const JudgedMatrix& judged) {
  const auto count = [&](Judgement judgement) { return std::to_string(judged.count(judgement)); };
  return std::string(pairs::name_of(judged.matrix.format)) + ", " +
         std::to_string(judged.pairs.size()) + " pairs disabled: " + count(Judgement::Proved) +
         " proved never to touch, " + count(Judgement::Connected) + " connected, " +
         count(Judgement::Always) + " always in contact, " + count(Judgement::Refuted) +
         " refuted, " + count(Judgement::Open) + " open; " +
         std::to_string(judged.matrix.faults.size()) + " faults of the file";
}

Json matrix_json(const JudgedMatrix& judged) {
  Json out = {{"file", judged.file},
              {"format", pairs::name_of(judged.matrix.format)},
              {"disabled", Json::array()},
              {"faults", Json::array()}};
  for (const JudgedPair& pair : judged.pairs) {
    Json j = {{"links", {pair.stated.a, pair.stated.b}},
              {"line", pair.stated.line},
              {"judgement", pairs::name_of(pair.judgement)}};
    if (!pair.stated.reason.empty()) j["reason"] = pair.stated.reason;
    if (!pair.why.empty()) j["why"] = pair.why;
    const std::string replay = replay_of(judged, pair);
    if (!replay.empty()) j["replay"] = replay;
    out["disabled"].push_back(std::move(j));
  }
  for (const MatrixFault& fault : judged.matrix.faults)
    out["faults"].push_back(
        {{"fault", pairs::name_of(fault.kind)}, {"line", fault.line}, {"text", fault.text}});
  return out;
}

std::string to_junit(const JudgedMatrix& judged, const FailOn& on) {
  const std::size_t refuted = judged.count(Judgement::Refuted),
                    open = judged.count(Judgement::Open),
                    faults = on.faults ? judged.matrix.faults.size() : 0;
  const std::string file = escape_xml(judged.file);
  std::string out =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n  <testsuite name=\"" + file +
      "\" tests=\"" + std::to_string(judged.pairs.size() + faults) + "\" failures=\"" +
      std::to_string(refuted + (on.open ? open : 0) + faults) + "\" errors=\"0\" skipped=\"" +
      std::to_string(on.open ? 0 : open) + "\">\n";
  const auto begin_case = [&](const std::string& name, int line) {
    out += "    <testcase classname=\"" + file + "\" name=\"" + escape_xml(name) + "\" file=\"" +
           file + "\" line=\"" + std::to_string(line) + "\"";
  };
  for (const JudgedPair& pair : judged.pairs) {
    const std::string finding = escape_xml(finding_of(pair));
    begin_case(name_of(pair), pair.stated.line);
    const bool fails =
        pair.judgement == Judgement::Refuted || (on.open && pair.judgement == Judgement::Open);
    if (fails) {
      out += ">\n      <failure message=\"" + finding + "\">" +
             escape_xml(replay_of(judged, pair)) + "</failure>\n    </testcase>\n";
    } else if (pair.judgement == Judgement::Open) {
      out += ">\n      <skipped message=\"" + finding + "\"/>\n    </testcase>\n";
    } else {
      out += "/>\n";
    }
  }
  if (on.faults)
    for (const MatrixFault& fault : judged.matrix.faults) {
      begin_case(std::string(pairs::name_of(fault.kind)) + " in line " + std::to_string(fault.line),
                 fault.line);
      out += ">\n      <failure message=\"" + escape_xml(fault.text) + "\"/>\n    </testcase>\n";
    }
  return out + "  </testsuite>\n</testsuites>\n";
}

Json to_sarif(const JudgedMatrix& judged, const FailOn& on) {
  const auto rule = [](const char* id, const char* text) -> Json {
    return {{"id", id}, {"shortDescription", {{"text", text}}}};
  };
  Json rules = {rule("refuted", "A pair that is not checked touches in a configuration"),
                rule("open", "It is not decided whether a pair that is not checked can touch"),
                rule("unknown-link", "The robot has no link of this name"),
                rule("same-link", "A link is paired with itself"),
                rule("doubled", "A pair or group is stated twice"),
                rule("contradicting", "A pair is stated for two reasons, or disabled and enabled"),
                rule("empty-group", "A group has no links")};
  Json results = Json::array();
  for (const JudgedPair& pair : judged.pairs) {
    const std::string text = name_of(pair) + ": " + finding_of(pair);
    if (pair.judgement == Judgement::Refuted)
      results.push_back(sarif_result(judged, "refuted", "error",
                                     text + ". Replay: " + replay_of(judged, pair),
                                     pair.stated.line));
    else if (pair.judgement == Judgement::Open)
      results.push_back(
          sarif_result(judged, "open", on.open ? "error" : "warning", text, pair.stated.line));
  }
  for (const MatrixFault& fault : judged.matrix.faults)
    results.push_back(sarif_result(judged, pairs::name_of(fault.kind),
                                   on.faults ? "error" : "warning", fault.text, fault.line));
  return {
      {"$schema", "https://json.schemastore.org/sarif-2.1.0.json"},
      {"version", "2.1.0"},
      {"runs",
       Json::array(
           {{{"tool",
              {{"driver", {{"name", "kaboum-pairs"}, {"version", version()}, {"rules", rules}}}}},
             {"results", results}}})}};
}

}  // namespace kaboum::tools
