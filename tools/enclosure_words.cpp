// Enclosing meshes in words.

#include "enclosure_words.h"

#include "cli.h"
#include "decimation_case.h"

namespace kaboum::tools {

using verify::Answer;

std::pair<std::string, int> shortfall(const certify::EnclosureCertificate& c) {
  if (c.stop == bmesh::Stop::OutOfWork)
    return {
        "the work allowed has ended; the result so far is written. Allow more with --max-work, "
        "or give --effort fast",
        kLimit};
  if (!c.reached) return {"fewer vertices cannot be reached; the result so far is written", kNo};
  for (const certify::MeshClaim& claim : c.claims) {
    if (claim.answer == Answer::Refuted)
      return {
          "the solid is enclosed, but not all triangles: some bound no solid; --prepare wrap "
          "encloses those as well",
          kNo};
    if (claim.answer == Answer::Undecided)
      return {std::string("the claim ") + name_of(claim.kind) + " is undecided: " + claim.reason,
              kLimit};
  }
  return {{}, kDone};
}

std::string summary(const certify::EnclosureCertificate& c) {
  return std::to_string(c.vertices_in) + " → " + std::to_string(c.vertices) +
         " vertices, outer, certified, within " + formatted(c.distance_upper) + " (" +
         formatted(c.diagonal > 0 ? 100 * c.distance_upper / c.diagonal : 0) + "%)";
}

}  // namespace kaboum::tools
