// What became of a job, as JSON; figures out of the programs' reports.

#include "record.h"

namespace kaboum::batch {
namespace {

template <class Value>
Json json_of(const std::optional<Value>& value) {
  return value ? Json(*value) : Json();
}

/// The value at a path of keys, if it is there and a number.
std::optional<double> number_at(const Json& json, std::initializer_list<const char*> keys) {
  const Json* at = &json;
  for (const char* key : keys) {
    if (!at->is_object() || !at->contains(key)) return std::nullopt;
    at = &(*at)[key];
  }
  return at->is_number() ? std::optional(at->get<double>()) : std::nullopt;
}

std::string text_at(const Json& json, std::initializer_list<const char*> keys) {
  const Json* at = &json;
  for (const char* key : keys) {
    if (!at->is_object() || !at->contains(key)) return {};
    at = &(*at)[key];
  }
  return at->is_string() ? at->get<std::string>() : std::string();
}

Json sources_of(const Record& record) {
  Json sources = Json::array();
  for (const FileState& file : record.sources)
    sources.push_back({{"path", file.path.string()},
                       {"bytes", file.bytes},
                       {"modified", file.modified},
                       {"changed", file.changed}});
  return sources;
}

std::optional<std::uint64_t> count_at(const Json& json, std::initializer_list<const char*> keys) {
  const auto value = number_at(json, keys);
  if (!value || !(*value >= 0 && *value < 0x1p64)) return std::nullopt;  // no count, but a number
  return static_cast<std::uint64_t>(*value);
}

/// @throws Json::exception where there is no whole number: `get` would convert any.
template <class Integer>
Integer integer_at(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_number_integer()
             ? value.get<Integer>()
             : static_cast<Integer>(value.get_ref<const Json::number_unsigned_t&>());
}

/// "certified" of "certified: the result's solid contains the input's".
std::string first_clause(const std::string& text) { return text.substr(0, text.find(':')); }

void add_decimation(Record& r, const Json& report) {
  r.vertices_before = count_at(report, {"input", "vertices"});
  r.vertices_after = count_at(report, {"output", "vertices"});
  r.distance = number_at(report, {"distance", "hausdorff_upper"});
  r.diagonal = number_at(report, {"distance", "bbox_diagonal"});
  r.verdict = text_at(report, {"verification", "solid", "answer"});
  if (r.verdict.empty()) r.verdict = first_clause(text_at(report, {"claims", "solid"}));
}

void add_decomposition(Record& r, const Json& report) {
  r.vertices_after = count_at(report, {"vertices"});
  r.bodies = count_at(report, {"bodies"});
  r.distance = number_at(report, {"reach", "upper"});
  r.diagonal = number_at(report, {"diagonal"});
  r.verdict = text_at(report, {"cover", "solid"});
  if (r.verdict.empty()) r.verdict = text_at(report, {"inside"});
}

}  // namespace

Json to_json(const Record& r) {
  return {{"name", r.name},
          {"key", r.key},
          {"output", r.output},
          {"sha256", r.sha256},
          {"sources", sources_of(r)},
          {"state", r.state},
          {"exit_code", r.exit_code},
          {"reason", r.reason},
          {"input_bytes", r.input_bytes},
          {"output_bytes", r.output_bytes},
          {"wall_seconds", r.wall_seconds},
          {"cpu_seconds", r.cpu_seconds},
          {"peak_megabytes", r.peak_megabytes},
          {"vertices_before", json_of(r.vertices_before)},
          {"vertices_after", json_of(r.vertices_after)},
          {"bodies", json_of(r.bodies)},
          {"ratio", json_of(r.ratio)},
          {"distance", json_of(r.distance)},
          {"diagonal", json_of(r.diagonal)},
          {"verdict", r.verdict},
          {"parameters", r.parameters},
          {"picture", r.picture}};
}

std::optional<Record> record_from(const std::string& line) {
  const Json json = Json::parse(line, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    Record r;
    for (auto [key, text] : {std::pair{"name", &r.name},
                             {"key", &r.key},
                             {"output", &r.output},
                             {"sha256", &r.sha256},
                             {"state", &r.state},
                             {"reason", &r.reason},
                             {"verdict", &r.verdict},
                             {"parameters", &r.parameters},
                             {"picture", &r.picture}})
      json.at(key).get_to(*text);
    for (const Json& source : json.at("sources"))
      r.sources.push_back({source.at("path").get<std::string>(),
                           integer_at<std::uintmax_t>(source, "bytes"),
                           integer_at<std::int64_t>(source, "modified"),
                           integer_at<std::int64_t>(source, "changed")});
    r.exit_code = integer_at<int>(json, "exit_code");
    r.input_bytes = integer_at<std::uintmax_t>(json, "input_bytes");
    r.output_bytes = integer_at<std::uintmax_t>(json, "output_bytes");
    json.at("wall_seconds").get_to(r.wall_seconds);
    json.at("cpu_seconds").get_to(r.cpu_seconds);
    json.at("peak_megabytes").get_to(r.peak_megabytes);
    r.vertices_before = count_at(json, {"vertices_before"});
    r.vertices_after = count_at(json, {"vertices_after"});
    r.bodies = count_at(json, {"bodies"});
    r.ratio = number_at(json, {"ratio"});
    r.distance = number_at(json, {"distance"});
    r.diagonal = number_at(json, {"diagonal"});
    return r;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

void add_report(Record& r, const Json& report) {
  const std::string tool = text_at(report, {"tool"});
  if (tool == "bmesh-decimate") add_decimation(r, report);
  if (tool == "bcd-decompose") add_decomposition(r, report);
  if (r.vertices_before && r.vertices_after && *r.vertices_before > 0)
    r.ratio = static_cast<double>(*r.vertices_after) / static_cast<double>(*r.vertices_before);
}

}  // namespace kaboum::batch
