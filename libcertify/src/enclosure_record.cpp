// Certificates of enclosing meshes as JSON: the record in the cache, and reports.

#include "enclosure_record.h"

#include <kaboum/base/error.h>

#include <array>
#include <nlohmann/json.hpp>

#include "record_count.h"
#include "wrap_record.h"

namespace kaboum::certify {
namespace {

using Json = nlohmann::ordered_json;
using verify::Answer;

constexpr std::array kStopNames{std::pair{bmesh::Stop::VertexTarget, "vertices"},
                                std::pair{bmesh::Stop::ErrorBound, "epsilon"},
                                std::pair{bmesh::Stop::OutOfWork, "out of work"},
                                std::pair{bmesh::Stop::Exhausted, "exhausted"}};
constexpr std::array kClaimKinds{
    Claim::Kind::Solid,  Claim::Kind::Winding,          Claim::Kind::Surface,
    Claim::Kind::Nested, Claim::Kind::OriginalToResult, Claim::Kind::ResultToOriginal};
constexpr std::array kBases{Basis::Bytes, Basis::Meshes, Basis::Steps, Basis::Measured};
constexpr std::array kAnswers{Answer::Verified, Answer::Refuted, Answer::Undecided,
                              Answer::Undefined};

/// The value of that name. @throws Error{InvalidInput}
template <class Values>
auto named(const Values& values, const std::string& name) {
  for (const auto value : values)
    if (name == name_of(value)) return value;
  throw Error(ErrorCode::InvalidInput, "no certificate of a mesh: unknown word '" + name + "'");
}

Json record_of(const EnclosureCertificate& c) {
  Json j{{"vertices_in", c.vertices_in},
         {"vertices", c.vertices},
         {"triangles", c.triangles},
         {"in_spare_format", c.in_spare_format},
         {"diagonal", c.diagonal},
         {"epsilon", c.epsilon ? Json(*c.epsilon) : Json()},
         {"distance_upper", c.distance_upper}};
  for (const auto& [stop, name] : kStopNames)
    if (stop == c.stop) j["stop"] = name;
  j["reached"] = c.reached;
  j["out_of_work"] = c.out_of_work;
  j["turned_triangles"] = c.subject.reversed_triangles;
  j["dropped_copies"] = c.subject.dropped_copies;
  j["dropped_sheets"] = c.subject.dropped_sheets;
  j["holes"] = c.subject.holes;
  j["every_triangle_inside"] = {{"answer", name_of(c.inside.answer)},
                                {"reason", c.inside.reason},
                                {"outside", c.inside.outside}};
  if (c.inside.farther) j["every_triangle_inside"]["sticks_out_upper"] = *c.inside.farther;
  j["claims"] = Json::array();
  for (const Claim& claim : c.claims) j["claims"].push_back(record_of(claim));
  if (c.wrap) j["wrap"] = record_of(*c.wrap);
  j["notes"] = c.notes;
  return j;
}

std::string line_of(const Json& j) {
  return j.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace

std::string to_json(const CertifiedEnclosure& enclosure) {
  Json j = record_of(enclosure.certificate());
  j["of"] = in_words(enclosure.certificate().subject);
  return line_of(j);
}

std::string write_enclosure(const EnclosureCertificate& certificate) {
  return line_of(record_of(certificate));
}

EnclosureCertificate read_enclosure(std::string_view text) {
  try {
    const Json j = Json::parse(text);
    EnclosureCertificate c;
    c.vertices_in = count_at(j, "vertices_in");
    c.vertices = count_at(j, "vertices");
    c.triangles = count_at(j, "triangles");
    j.at("in_spare_format").get_to(c.in_spare_format);
    j.at("diagonal").get_to(c.diagonal);
    if (!j.at("epsilon").is_null()) c.epsilon = j.at("epsilon").get<double>();
    j.at("distance_upper").get_to(c.distance_upper);
    bool known = false;
    for (const auto& [stop, name] : kStopNames)
      if (j.at("stop").get<std::string>() == name) {
        c.stop = stop;
        known = true;
      }
    if (!known) throw Error(ErrorCode::InvalidInput, "no certificate of a mesh: unknown stop");
    j.at("reached").get_to(c.reached);
    j.at("out_of_work").get_to(c.out_of_work);
    c.subject.reversed_triangles = count_at(j, "turned_triangles");
    c.subject.dropped_copies = count_at(j, "dropped_copies");
    c.subject.dropped_sheets = count_at(j, "dropped_sheets");
    c.subject.holes = count_at(j, "holes");
    const Json& inside = j.at("every_triangle_inside");
    c.inside.answer = named(kAnswers, inside.at("answer").get<std::string>());
    inside.at("reason").get_to(c.inside.reason);
    c.inside.outside = count_at(inside, "outside");
    if (inside.contains("sticks_out_upper"))
      c.inside.farther = inside.at("sticks_out_upper").get<double>();
    for (const Json& claim : j.at("claims")) {
      Claim& out = c.claims.emplace_back();
      out.kind = named(kClaimKinds, claim.at("claim").get<std::string>());
      out.basis = named(kBases, claim.at("basis").get<std::string>());
      out.answer = named(kAnswers, claim.at("answer").get<std::string>());
      out.reason = claim.value("reason", std::string());
      if (claim.contains("distance")) out.distance = claim.at("distance").get<double>();
    }
    if (j.contains("wrap")) c.wrap = wrap_of(j.at("wrap"));
    c.subject.wrapped = c.wrap.has_value();
    j.at("notes").get_to(c.notes);
    return c;
  } catch (const nlohmann::json::exception&) {
    throw Error(ErrorCode::InvalidInput, "no certificate of an enclosing mesh");
  }
}

}  // namespace kaboum::certify
