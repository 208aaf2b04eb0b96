// Enclosing meshes in words.

#include "enclosure_words.h"

#include "decimation_case.h"

namespace kaboum::tools {

using verify::Answer;

std::string shortfall(const certify::EnclosureCertificate& c) {
  if (c.stop == bmesh::Stop::OutOfWork)
    return "the work allowed has ended; the result so far is written. Allow more with --max-work, "
           "or give --effort fast";
  if (!c.reached) return "fewer vertices cannot be reached; the result so far is written";
  if (c.inside.answer == Answer::Refuted)
    return "not every triangle is inside: some bound no solid; --prepare wrap encloses those as "
           "well";
  return {};
}

std::string summary(const certify::EnclosureCertificate& c) {
  return std::to_string(c.vertices_in) + " → " + std::to_string(c.vertices) +
         " vertices, outer, certified, within " + formatted(c.distance_upper) + " (" +
         formatted(c.diagonal > 0 ? 100 * c.distance_upper / c.diagonal : 0) + "%)";
}

}  // namespace kaboum::tools
