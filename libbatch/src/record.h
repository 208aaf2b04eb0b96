#pragma once

#include <kaboum/batch/batch.h>

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

namespace kaboum::batch {

using Json = nlohmann::ordered_json;

Json to_json(const Record& record);
/// nullopt: it is none, as of a line that was cut short.
std::optional<Record> record_from(const std::string& line);

/// Takes from a program's report what is known of it.
void add_report(Record& record, const Json& report);

}  // namespace kaboum::batch
