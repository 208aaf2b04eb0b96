// Any text given to kaboum-batch's readers either makes a record that is written as it is read, a
// rule with a program, or names of files, or is none or throws Error. The first byte selects the
// kind: a line of the journal, a program's report, a rule.

#include "fuzz.h"
#include "record.h"

namespace {

using namespace kaboum;

std::string text_of(const batch::Record& record) {
  return to_json(record).dump(-1, ' ', false, batch::Json::error_handler_t::replace);
}

void require_same(const batch::Record& record) {
  const std::string line = text_of(record);
  const auto again = batch::record_from(line);
  if (!again || text_of(*again) != line) fuzz::broken("a record", line);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::select(data, size, 3, [](int kind, const std::string& text) {
    switch (kind) {
      case 0:
        if (const auto record = batch::record_from(text)) require_same(*record);
        break;
      case 1: {
        const batch::Json report = batch::Json::parse(text, nullptr, false);
        if (!report.is_object()) break;
        batch::Record record;
        batch::add_report(record, report);
        require_same(record);
        break;
      }
      default:
        if (batch::parse_rule(text).command.empty()) fuzz::broken("a rule", "without a program");
    }
  });
}
