// Which calls of external functions failed, how often, and why.

#include "explain.h"

#include <algorithm>

namespace kaboum::tools {
namespace {

using Failures = std::vector<plan::FailedCalls::Failure>;

constexpr std::size_t kShown = 12;  // failures that are told

const char* verdict_of(const plan::FailedCalls::Failure& f) {
  return f.impossible ? "impossible" : "not found";
}

}  // namespace

Json failures_json(const Failures& failures) {
  Json out = Json::array();
  for (const auto& f : failures)
    out.push_back(
        {{"call", f.call}, {"reason", f.reason}, {"times", f.times}, {"verdict", verdict_of(f)}});
  return out;
}

std::string failures_text(const Failures& failures) {
  std::string out;
  for (std::size_t i = 0; i < std::min(kShown, failures.size()); ++i) {
    const plan::FailedCalls::Failure& f = failures[i];
    out += "  " + f.call + ": " + verdict_of(f) + ", " + std::to_string(f.times) +
           (f.times == 1 ? " time: " : " times: ") + f.reason + "\n";
  }
  if (failures.size() > kShown)
    out += "  and " + std::to_string(failures.size() - kShown) + " more (--report names all)\n";
  return out.empty() ? out : "calls that returned no value:\n" + out;
}

}  // namespace kaboum::tools
