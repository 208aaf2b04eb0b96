// Requests in words: the record in containers, and part of the cache's key.

#include "request.h"

#include <array>
#include <charconv>

namespace kaboum::certify {
namespace {

std::string digits(double x) {
  std::array<char, 32> text{};
  const auto [end, error] = std::to_chars(text.data(), text.data() + text.size(), x);
  return {text.data(), end};
}

const char* name_of(bcd::Effort effort) {
  switch (effort) {
    case bcd::Effort::Fast:
      return "fast";
    case bcd::Effort::Normal:
      return "normal";
    case bcd::Effort::Best:
      break;
  }
  return "best";
}

struct MethodName {
  bcd::Method method;
  const char* name;
};
constexpr std::array<MethodName, 3> kMethods{{{bcd::Method::Planes, "planes"},
                                              {bcd::Method::Clusters, "clusters"},
                                              {bcd::Method::Voxels, "voxels"}}};

}  // namespace

const char* name_of(bcd::Method method) {
  for (const MethodName& m : kMethods)
    if (m.method == method) return m.name;
  return "";
}

std::optional<bcd::Method> method_of(std::string_view name) {
  for (const MethodName& m : kMethods)
    if (m.name == name) return m.method;
  return {};
}

const char* name_of(SetRequest::Direction direction) {
  return direction == SetRequest::Direction::Outer ? "outer" : "inner";
}

std::optional<Length> SetRequest::wanted_epsilon() const {
  if (epsilon || max_bodies || max_total_vertices) return epsilon;
  return Length{1, true};
}

std::string SetRequest::parameters() const {
  std::string out;
  const auto add = [&](const std::string& text) { out += (out.empty() ? "" : " ") + text; };
  if (const auto wanted = wanted_epsilon()) add("--epsilon " + wanted->text());
  if (max_bodies) add("--max-bodies " + std::to_string(*max_bodies));
  if (max_total_vertices) add("--max-total-vertices " + std::to_string(*max_total_vertices));
  if (direction != Direction::Outer) add(std::string("--direction ") + name_of(direction));
  if (min_thickness > 0) add("--min-thickness " + digits(min_thickness));
  add("--max-vertices-per-body " + std::to_string(max_vertices));
  add(std::string("--effort ") + name_of(effort));
  if (simplify) add("--simplify " + digits(*simplify));
  if (max_work) add("--max-work " + digits(*max_work));
  if (improve_work) add("--improve-work " + digits(*improve_work));
  if (method != bcd::Method::Planes) add(std::string("--method ") + name_of(method));
  if (pre_step != bcd::PreStep::Auto)
    add(pre_step == bcd::PreStep::On ? "--pre-step on" : "--pre-step off");
  if (scale != 1) add("--scale " + digits(scale));
  if (preparation.drop_sheets) add("--drop-sheets");
  if (preparation.holes == geom::Holes::Refuse) add("--holes refuse");
  if (preparation.keep_orientation) add("--keep-orientation");
  if (wrap && !wrap->where_needed) add("--prepare wrap");
  if (wrap && wrap->offset) add("--offset " + wrap->offset->text());
  if (wrap && wrap->seal) add("--seal " + wrap->seal->text());
  return out;
}

geom::Provenance origin_of(const SetRequest& request, const std::string& sha256) {
  geom::Provenance p;
  p.source = request.source;
  p.source_sha256 = sha256;
  p.tool = "bcd-decompose " KABOUM_VERSION;
  p.parameters = request.parameters();
  p.unit = request.unit;
  p.frame = request.frame;
  p.direction = name_of(request.direction);
  return p;
}

}  // namespace kaboum::certify
