// Certificates of convex sets as JSON.

#include <kaboum/base/error.h>
#include <kaboum/certify/convex_set.h>

#include <array>
#include <nlohmann/json.hpp>

#include "request.h"

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

}  // namespace

std::string SetCertificate::to_json() const {
  Json j;
  for (const StopName& s : kStops)
    if (s.stop == stop) j["stop"] = s.name;
  j["direction"] = name_of(direction);
  j["method"] = name_of(method);
  j["bodies"] = bodies;
  j["vertices"] = vertices;
  j["largest_body_vertices"] = largest_body_vertices;
  j["reach"] = {{"lower", distance_lower},
                {"upper", distance_upper},
                {"upper_percent", diagonal > 0 ? 100 * distance_upper / diagonal : 0.0}};
  j["closed"] = holes == 0;
  j["holes"] = holes;
  j["largest_hole"] = largest_hole;
  j["filled_triangles"] = filled_triangles;
  j["pieces"] = pieces;
  j["pre_step_triangles"] = pre_step_triangles;
  j["out_of_work"] = out_of_work;
  j["safety"] = safety;
  j["diagonal"] = diagonal;
  j["notes"] = notes;
  if (min_thickness > 0) j["min_thickness"] = {{"wished", min_thickness}, {"thickened", thickened}};
  if (direction == SetRequest::Direction::Outer) {
    j["cover"] = {{"surface", "verified"},
                  {"solid", holes == 0 ? "verified" : "of the closed mesh"}};
  } else {
    j["inside"] = holes == 0 ? "verified" : "verified, of the closed mesh";
  }
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

SetCertificate SetCertificate::from_json(std::string_view text) {
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
    const std::optional<bcd::Method> method = method_of(j.at("method").get<std::string>());
    if (!method) throw Error(ErrorCode::InvalidInput, "no certificate: unknown method");
    c.method = *method;
    j.at("bodies").get_to(c.bodies);
    j.at("vertices").get_to(c.vertices);
    j.at("largest_body_vertices").get_to(c.largest_body_vertices);
    j.at("reach").at("lower").get_to(c.distance_lower);
    j.at("reach").at("upper").get_to(c.distance_upper);
    j.at("holes").get_to(c.holes);
    j.at("largest_hole").get_to(c.largest_hole);
    j.at("filled_triangles").get_to(c.filled_triangles);
    j.at("pieces").get_to(c.pieces);
    j.at("pre_step_triangles").get_to(c.pre_step_triangles);
    j.at("out_of_work").get_to(c.out_of_work);
    j.at("safety").get_to(c.safety);
    j.at("diagonal").get_to(c.diagonal);
    j.at("notes").get_to(c.notes);
    if (j.contains("min_thickness")) {
      j.at("min_thickness").at("wished").get_to(c.min_thickness);
      j.at("min_thickness").at("thickened").get_to(c.thickened);
    }
    return c;
  } catch (const nlohmann::json::exception&) {
    throw Error(ErrorCode::InvalidInput, "no certificate of a convex set");
  }
}

}  // namespace kaboum::certify
