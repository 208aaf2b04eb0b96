// Certificates of convex sets as JSON: the record in the cache, and the report, which has the
// claims.

#include <kaboum/base/error.h>
#include <kaboum/certify/convex_set.h>

#include <array>
#include <nlohmann/json.hpp>

#include "record_count.h"
#include "request.h"
#include "set_record.h"
#include "wrap_record.h"

namespace kaboum::certify {
namespace {

using Json = nlohmann::ordered_json;

struct StopName {
  bcd::Stop stop;
  const char* name;
};
constexpr std::array<StopName, 5> kStops{{{bcd::Stop::Done, "done"},
                                          {bcd::Stop::TooManyBodies, "limits"},
                                          {bcd::Stop::TooCoarse, "float32 too coarse"},
                                          {bcd::Stop::Stuck, "stuck"},
                                          {bcd::Stop::OutOfWork, "out of work"}}};

Json record_of(const SetCertificate& c) {
  Json j;
  for (const StopName& s : kStops)
    if (s.stop == c.stop) j["stop"] = s.name;
  j["direction"] = name_of(c.direction);
  j["bodies"] = c.bodies;
  j["vertices"] = c.vertices;
  j["largest_body_vertices"] = c.largest_body_vertices;
  j["reach"] = {{"lower", c.distance_lower},
                {"upper", c.distance_upper},
                {"upper_percent", c.diagonal > 0 ? 100 * c.distance_upper / c.diagonal : 0.0}};
  if (c.depth_decided) j["depth_decided"] = true;
  j["closed"] = c.subject.holes == 0;
  j["holes"] = c.subject.holes;
  j["largest_hole"] = c.largest_hole;
  j["turned_triangles"] = c.subject.reversed_triangles;
  j["dropped_copies"] = c.subject.dropped_copies;
  j["dropped_sheets"] = c.subject.dropped_sheets;
  j["filled_triangles"] = c.filled_triangles;
  j["pieces"] = c.pieces;
  j["pre_step_triangles"] = c.pre_step_triangles;
  j["out_of_work"] = c.out_of_work;
  j["safety"] = c.safety;
  j["diagonal"] = c.diagonal;
  j["notes"] = c.notes;
  if (c.min_thickness > 0)
    j["min_thickness"] = {{"wished", c.min_thickness}, {"thickened", c.thickened}};
  if (c.max_aspect > 0) j["max_aspect"] = {{"wished", c.max_aspect}, {"thickened", c.thickened}};
  if (c.max_facets > 0) j["max_facets"] = {{"wished", c.max_facets}, {"most", c.most_facets}};
  if (!c.undecided.empty()) j["undecided"] = c.undecided;
  for (const SetCertificate::Region& one : c.regions)
    j["regions"].push_back({{"name", one.name}, {"bound", one.epsilon}, {"reached", one.reached}});
  if (c.wrap) j["wrap"] = record_of(*c.wrap);
  return j;
}

std::string text_of(const Json& j) {
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string to_json(const CertifiedSet& set) {
  const SetCertificate& c = set.certificate();
  Json j = record_of(c);
  if (c.direction == SetRequest::Direction::Outer) {
    j["cover"] = {
        {"of", in_words(c.subject)},
        {"surface", c.subject.dropped_sheets == 0 ? "verified" : "verified, without the sheets"},
        {"solid", !c.undecided.empty()   ? "undecided"
                  : c.subject.holes == 0 ? "verified"
                                         : "verified, of the closed mesh"}};
    j.erase("regions");  // a claim here
    for (const SetCertificate::Region& one : c.regions)
      j["cover"]["regions"].push_back({{"name", one.name},
                                       {"answer", "verified"},
                                       {"bound", one.epsilon},
                                       {"reached", one.reached}});
  } else {
    j["inside_of"] = in_words(c.subject);
    const char* verified = c.subject.holes == 0 ? "verified" : "verified, of the closed mesh";
    j["inside"] = verified;
    j.erase("depth_decided");  // a claim here
    if (c.depth_decided) j["depth"] = {{"answer", verified}, {"bound", c.distance_upper}};
  }
  return text_of(j);
}

std::string write_record(const SetCertificate& certificate) {
  return text_of(record_of(certificate));
}

SetCertificate read_record(std::string_view text) {
  try {
    const Json j = Json::parse(text);
    SetCertificate c;
    const std::string stop = j.at("stop").get<std::string>();
    bool known = false;
    for (const StopName& s : kStops)
      if (stop == s.name) {
        c.stop = s.stop;
        known = true;
      }
    if (!known) throw Error(ErrorCode::InvalidInput, "no certificate: unknown stop");
    c.direction = j.at("direction").get<std::string>() == "outer" ? SetRequest::Direction::Outer
                                                                  : SetRequest::Direction::Inner;
    c.bodies = count_at(j, "bodies");
    c.vertices = count_at(j, "vertices");
    c.largest_body_vertices = count_at(j, "largest_body_vertices");
    j.at("reach").at("lower").get_to(c.distance_lower);
    j.at("reach").at("upper").get_to(c.distance_upper);
    c.depth_decided = j.value("depth_decided", false);
    c.subject.holes = count_at(j, "holes");
    c.subject.reversed_triangles = count_at(j, "turned_triangles");
    c.subject.dropped_copies = count_at(j, "dropped_copies");
    c.subject.dropped_sheets = count_at(j, "dropped_sheets");
    j.at("largest_hole").get_to(c.largest_hole);
    c.filled_triangles = count_at(j, "filled_triangles");
    c.pieces = count_at(j, "pieces");
    c.pre_step_triangles = count_at(j, "pre_step_triangles");
    j.at("out_of_work").get_to(c.out_of_work);
    j.at("safety").get_to(c.safety);
    j.at("diagonal").get_to(c.diagonal);
    j.at("notes").get_to(c.notes);
    if (j.contains("min_thickness")) {
      j.at("min_thickness").at("wished").get_to(c.min_thickness);
      c.thickened = count_at(j.at("min_thickness"), "thickened");
    }
    if (j.contains("max_aspect")) {
      j.at("max_aspect").at("wished").get_to(c.max_aspect);
      c.thickened = count_at(j.at("max_aspect"), "thickened");
    }
    if (j.contains("max_facets")) {
      c.max_facets = count_at(j.at("max_facets"), "wished");
      c.most_facets = count_at(j.at("max_facets"), "most");
    }
    if (j.contains("undecided")) j.at("undecided").get_to(c.undecided);
    if (j.contains("regions"))
      for (const Json& one : j.at("regions"))
        c.regions.push_back({one.at("name").get<std::string>(), one.at("bound").get<double>(),
                             one.at("reached").get<bool>()});
    if (j.contains("wrap")) c.wrap = wrap_of(j.at("wrap"));
    c.subject.wrapped = c.wrap.has_value();
    return c;
  } catch (const nlohmann::json::exception&) {
    throw Error(ErrorCode::InvalidInput, "no certificate of a convex set");
  }
}

}  // namespace kaboum::certify
