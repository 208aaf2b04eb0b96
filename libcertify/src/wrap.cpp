// Wraps: made, measured, and decided by libverify.
#include <kaboum/certify/wrap.h>
#include <kaboum/geom/directed_distance.h>
#include <kaboum/geom/moderate.h>
#include <kaboum/verify/inclusion.h>
#include <kaboum/wrap/wrap.h>

#include <charconv>
#include <cmath>

#include "given_solid.h"
#include "issuer.h"
#include "record_count.h"
#include "wrap_record.h"

namespace kaboum::certify {
namespace {

constexpr Length kOffset{0.1, true}, kSeal{1, true};
constexpr double kLeast = 1e-9, kMost = 100;  ///< of lengths asked for, in diagonals
constexpr double kOffsetShare = 0.25;         ///< of the farthest that is allowed
constexpr int kTries = 4;                     ///< of gaps to seal, each half of the one before

std::string number(double x) {
  std::array<char, 32> text{};
  const auto end =
      std::to_chars(text.data(), text.data() + text.size(), x, std::chars_format::general, 4).ptr;
  return {text.data(), end};
}

/// The widest gap whose closing keeps the wrap within `farthest` of the input. A ball leaves what
/// is within the offset and its radius; a twentieth is for what it is measured with.
double seal_within(double farthest, double offset) {
  return std::max(2 * (0.95 * farthest - offset), 0.5 * farthest);
}

void measure(const geom::Mesh& wrap, const geom::DistanceQuery& input, WrapCertificate& made) {
  geom::DistanceOptions wished;
  wished.relative_gap = 0.01;
  const geom::DirectedDistance far = geom::directed_distance(wrap, input, wished);
  made.farthest_lower = far.max_lower;
  made.farthest_upper = far.max_upper;
  made.at = far.at;
}

/// @throws Error{LimitReached}, Error{Internal}
void decide(const geom::Mesh& input, const geom::Mesh& wrap, const WrapRequest& request) {
  verify::InclusionOptions options;
  options.surface_only = true;
  options.progress = request.progress;
  const verify::Inclusion found = verify::verify_inclusion(input, wrap, options);
  ensure(found.outer_closed, "the wrap is not closed");
  if (found.surface.answer == verify::Answer::Undecided)
    throw Error(ErrorCode::LimitReached,
                "whether the wrap holds every triangle is not decided: " + found.surface.reason);
  ensure(found.surface.answer == verify::Answer::Verified,
         "the verification refutes that the wrap holds every triangle");
}

}  // namespace

void hold_exact_faces(const io::ReadResult& read, bool hold, std::optional<WrapRequest>& wrap) {
  if (!io::is_cad(read.format)) return;
  if (hold && !wrap) wrap.emplace();
  if (hold) wrap->where_needed = false;
  if (wrap) wrap->clearance = read.deviation;
}

void refuse_deviation(double clearance) {
  throw Error(ErrorCode::InvalidInput,
              "the exact faces may be " + number(clearance) +
                  " from the triangles that stand for them, which leaves nothing of epsilon; allow "
                  "more, or make what is claimed one about the triangles («prepare=strict»)");
}

std::string in_words(const WrapCertificate& wrap) {
  return "The solid is that of a wrap round all " + std::to_string(wrap.input_triangles) +
         " triangles: each lies inside, exactly; no point of it is farther from them than " +
         number(wrap.farthest_upper) + " (" + number(100 * wrap.farthest_upper / wrap.diagonal) +
         "% of the diagonal); gaps narrower than " + number(wrap.seal) + " are closed." +
         (wrap.clearance > 0 ? " All within " + number(wrap.clearance) +
                                   " of a triangle is inside, too: the exact faces."
                             : std::string());
}

std::string to_json(const WrapCertificate& wrap) { return record_of(wrap).dump(); }

nlohmann::ordered_json record_of(const WrapCertificate& wrap) {
  return {{"offset", wrap.offset},
          {"seal", wrap.seal},
          {"diagonal", wrap.diagonal},
          {"farthest_lower", wrap.farthest_lower},
          {"farthest_upper", wrap.farthest_upper},
          {"at", {wrap.at.x(), wrap.at.y(), wrap.at.z()}},
          {"every_triangle_inside", "verified"},
          {"clearance", wrap.clearance},
          {"input_triangles", wrap.input_triangles}};
}

WrapCertificate wrap_of(const nlohmann::ordered_json& record) {
  WrapCertificate out;
  record.at("offset").get_to(out.offset);
  record.at("seal").get_to(out.seal);
  record.at("diagonal").get_to(out.diagonal);
  record.at("farthest_lower").get_to(out.farthest_lower);
  record.at("farthest_upper").get_to(out.farthest_upper);
  for (int k = 0; k < 3; ++k) record.at("at").at(k).get_to(out.at[k]);
  record.at("clearance").get_to(out.clearance);
  out.input_triangles = count_at(record, "input_triangles");
  return out;
}

CertifiedWrap certify_wrap(const geom::Mesh& given, const WrapRequest& request) {
  geom::PrepareOptions both;
  both.quads = request.quads;
  both.diagonal = geom::PrepareOptions::Diagonal::Outward;
  const geom::Mesh other = request.quads.empty() ? geom::Mesh() : with_other_diagonals(given, both);
  const geom::Mesh& input = request.quads.empty() ? given : other;
  if (input.triangles.empty())
    throw Error(ErrorCode::InvalidInput, "there are no triangles to wrap");
  geom::require_valid(input);
  geom::require_moderate(input);
  WrapCertificate made;
  made.input_triangles = request.input_triangles.value_or(given.triangles.size());
  made.diagonal = geom::bounding_box(input).diagonal();
  if (!(made.diagonal > 0))
    throw Error(ErrorCode::InvalidInput,
                "all triangles lie in one point; there is nothing to wrap");
  made.offset = request.offset     ? request.offset->of(made.diagonal)
                : request.farthest ? kOffsetShare * *request.farthest
                                   : kOffset.of(made.diagonal);
  made.seal = request.seal       ? request.seal->of(made.diagonal)
              : request.farthest ? seal_within(*request.farthest, made.offset)
                                 : kSeal.of(made.diagonal);
  for (const auto& [length, name] : {std::pair{made.offset, "offset"},
                                     {made.seal, "seal"},
                                     {request.farthest.value_or(made.offset), "epsilon"}})
    if (!(length >= kLeast * made.diagonal && length <= kMost * made.diagonal))
      throw Error(ErrorCode::InvalidArgument, std::string(name) + ": " + number(length) +
                                                  " is not from " + number(kLeast) + " to " +
                                                  number(kMost) + " times the diagonal, which is " +
                                                  number(made.diagonal));
  made.clearance = request.clearance;
  if (made.offset < 3 * made.clearance) {
    if (request.offset)
      throw Error(ErrorCode::InvalidArgument,
                  "the exact surface is within " + number(made.clearance) +
                      " of the triangles; give an offset of at least three times that");
    made.offset = 3 * made.clearance;
    if (request.farthest && made.offset > *request.farthest)
      throw Error(ErrorCode::InvalidInput,
                  "the exact surface is within " + number(made.clearance) +
                      " of the triangles, which asks for a wrap of an offset of " +
                      number(made.offset) + ", more than epsilon leaves; allow a larger epsilon");
  }
  const geom::DistanceQuery query(input);
  wrap::WrapOptions options;
  options.offset = made.offset;
  options.float32 = request.float32;
  options.clearance = made.clearance;
  options.progress = request.progress;
  geom::Mesh mesh;
  for (int tried = 1;; ++tried) {
    options.seal = made.seal;
    if (request.float32 && request.may_be_double)
      options.float32 = wrap::float32_is_fine(geom::bounding_box(input), options);
    mesh = wrap::wrap(input, options).mesh;
    if (request.progress) request.progress("measuring the wrap");
    measure(mesh, query, made);
    if (!request.farthest || made.farthest_upper <= *request.farthest) break;
    if (request.seal || tried == kTries)
      throw Error(ErrorCode::InvalidInput,
                  "the wrap reaches " + number(made.farthest_upper) +
                      " beyond the triangles, which is more than the " + number(*request.farthest) +
                      " that epsilon leaves; seal smaller gaps, or allow a larger epsilon");
    made.seal /= 2;
  }
  if (request.progress) request.progress("verifying the wrap");
  decide(input, mesh, request);
  return Issuer::issue(std::move(mesh), made, std::vector<char>());
}

}  // namespace kaboum::certify
