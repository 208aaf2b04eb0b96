// Certificates of sets as a report, as an exit code.

#include "words.h"

namespace kaboum::tools {

int code_of(const certify::SetCertificate& certificate) {
  if (certificate.stop == bcd::Stop::Done) return certificate.undecided.empty() ? kDone : kLimit;
  return certificate.stop == bcd::Stop::OutOfWork ? kLimit : kNo;
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
