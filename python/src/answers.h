#pragma once

#include <kaboum/certify/certificate.h>
#include <kaboum/verify/inclusion.h>
#include <kaboum/verify/points.h>

#include "arguments.h"

/// What the verifier answered.
namespace kaboum::python {

/// An answer to all that was asked, and what it is made of.
struct Verdict {
  verify::Answer answer = verify::Answer::Undefined;
  py::dict claims;
  std::vector<std::string> notes;
};

/// 'answer', 'reason', 'witness' (a point) and 'depth'.
py::dict dict_of(const verify::Claim& claim);
/// 'answer', 'reason', 'points', 'outside' and, where some are, 'farthest', 'at' and 'face'.
py::dict dict_of(const verify::PointClaim& claim);
/// The claim about exact faces where the triangles alone were judged.
py::dict exact_points_not_looked_at();

inline constexpr const char* kCertificateDoc =
    R"(What is certified, a dict of the same shape for all results.

'direction', 'of' (what it holds, or lies in), 'claims' (each with 'claim', 'answer', 'basis', and where there is one 'reason'
or 'distance'), and 'distance' ('lower', 'upper'), or None where it was not measured.)";

/// A certificate as kCertificateDoc says.
inline py::object dict_of(const certify::Certificate& certificate) {
  return py::module_::import("json").attr("loads")(certify::to_json(certificate));
}

}  // namespace kaboum::python
