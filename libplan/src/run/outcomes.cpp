// Outcomes of sensing, as users state them.

#include <kaboum/base/error.h>
#include <kaboum/base/read_json.h>
#include <kaboum/plan/outcomes.h>

#include <nlohmann/json.hpp>

namespace kaboum::plan {

std::map<std::string, std::string> parse_outcomes(const std::string& text,
                                                  const std::string& file) {
  const std::string form =
      "expected a JSON object of outcomes, as {\"isSpillable(o1)\": true, \"place(o2)\": "
      "\"shelf\"}";
  const auto given = read_json<nlohmann::json>(text, file, form);
  const auto fail = [&] { throw Error(ErrorCode::InvalidInput, file + ": " + form); };
  if (!given.is_object()) fail();
  std::map<std::string, std::string> out;
  for (const auto& [name, value] : given.items()) {
    if (!value.is_boolean() && !value.is_string()) fail();
    out[name] = value.is_string() ? value.get<std::string>() : value.get<bool>() ? "true" : "false";
  }
  return out;
}

}  // namespace kaboum::plan
