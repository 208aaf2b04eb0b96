// Certificates of sets in words, as a report, as an exit code.

#include "words.h"

#include <sstream>

namespace kaboum::tools {
namespace {

std::string percent(double length, double diagonal) {
  std::ostringstream out;
  out.precision(3);
  out << length << " (" << (diagonal > 0 ? 100 * length / diagonal : 0) << " % of the diagonal)";
  return out.str();
}

}  // namespace

int code_of(const certify::SetCertificate& certificate) {
  if (certificate.stop == bcd::Stop::Done) return certificate.undecided.empty() ? kDone : kLimit;
  return certificate.stop == bcd::Stop::OutOfWork ? kLimit : kNo;
}

std::string shortfall(const certify::SetCertificate& c) {
  switch (c.stop) {
    case bcd::Stop::Done:
      return c.undecided.empty() ? std::string()
                                 : "every triangle is inside, but whether all that they bound is, "
                                   "is NOT decided: " +
                                       c.undecided;
    case bcd::Stop::OutOfWork:
      return "epsilon was not reached within the work allowed; allow more with --max-work, or a "
             "larger epsilon";
    case bcd::Stop::Stuck:
      if (c.thickened > 0)
        return "epsilon could not be reached with --min-thickness; allow thinner bodies or a "
               "larger epsilon";
      if (c.direction == certify::SetRequest::Direction::Inner)
        return "epsilon could not be reached: the search for deep points gave up; allow a larger "
               "epsilon, or --effort best";
      return "epsilon could not be reached; allow more vertices per body";
    case bcd::Stop::TooManyBodies:
    case bcd::Stop::TooCoarse:
      break;
  }
  return "within the limits of bodies and vertices nothing nearer was found; allow more, or a "
         "larger epsilon";
}

std::string summary(const certify::SetCertificate& c) {
  const bool outer = c.direction == certify::SetRequest::Direction::Outer;
  return std::to_string(c.bodies) + (c.bodies == 1 ? " body, " : " bodies, ") +
         std::to_string(c.vertices) +
         (outer ? " vertices; cover verified exactly" : " vertices; inside verified exactly") +
         (outer && c.subject.dropped_sheets > 0 ? " without the sheets dropped" : "") +
         (outer ? "; no point farther from the solid than " : "; no point left out deeper than ") +
         percent(c.distance_upper, c.diagonal);
}

Json report_of(const certify::CertifiedFile& made) {
  Json report = Json::parse(certify::to_json(made.found.set));
  Json notes = made.read_notes;
  for (const std::string& text : made.found.set.certificate().notes) notes.push_back(text);
  report["notes"] = std::move(notes);
  report["cached"] = made.found.cached;
  return report;
}

}  // namespace kaboum::tools
