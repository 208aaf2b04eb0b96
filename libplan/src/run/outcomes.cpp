// Outcomes of sensing, as users state them.

#include <kaboum/base/error.h>
#include <kaboum/plan/outcomes.h>

#include <nlohmann/json.hpp>

namespace kaboum::plan {

std::map<std::string, std::string> parse_outcomes(const std::string& text,
                                                  const std::string& file) {
  const nlohmann::json given = nlohmann::json::parse(text, nullptr, false);
  const auto fail = [&] {
    throw Error(ErrorCode::InvalidInput,
                file +
                    ": expected a JSON object of outcomes, as {\"isSpillable(o1)\": true, "
                    "\"place(o2)\": \"shelf\"}");
  };
  if (!given.is_object()) fail();
  std::map<std::string, std::string> out;
  for (const auto& [name, value] : given.items()) {
    if (!value.is_boolean() && !value.is_string()) fail();
    out[name] = value.is_string() ? value.get<std::string>() : value.get<bool>() ? "true" : "false";
  }
  return out;
}

}  // namespace kaboum::plan
