// Which calls of external functions failed, how often, and why.

#include "explain.h"

#include <algorithm>

namespace kaboum::tools {
namespace {

constexpr std::size_t kShown = 12;  // failures that are told

}  // namespace

plan::ExternalBindings Explanation::watch(const plan::ExternalBindings& bindings) {
  plan::ExternalBindings out;
  for (const auto& [name, function] : bindings) {
    if (!function.takes_seed()) {  // of names alone: it gives no reasons
      out[name] = function;
      continue;
    }
    const auto watched = [notes = notes_, name = name,
                          function = function](const plan::Question& q) {
      plan::Answer answer = function(q);
      if (answer.kind != plan::Answer::Kind::Value && !answer.reason.empty()) {
        std::string call = name + "(";
        for (std::size_t i = 0; i < q.arguments.size(); ++i)
          call += (i > 0 ? ", " : "") + q.arguments[i];
        auto& [final, times] = (*notes)[{call + ")", answer.reason}];
        final = answer.kind == plan::Answer::Kind::Impossible;
        ++times;
      }
      return answer;
    };
    out[name] = plan::ExternalBinding(watched, function.reads_state());
  }
  return out;
}

std::vector<Explanation::Failure> Explanation::failures() const {
  std::vector<Failure> out;
  for (const auto& [what, how] : *notes_)
    out.push_back({what.first, what.second, how.first, how.second});
  std::ranges::stable_sort(out,
                           [](const Failure& a, const Failure& b) { return a.times > b.times; });
  return out;
}

Json Explanation::json() const {
  Json out = Json::array();
  for (const Failure& f : failures())
    out.push_back({{"call", f.call},
                   {"reason", f.reason},
                   {"times", f.times},
                   {"verdict", f.final ? "impossible" : "not found"}});
  return out;
}

std::string Explanation::text() const {
  const std::vector<Failure> all = failures();
  std::string out;
  for (std::size_t i = 0; i < std::min(kShown, all.size()); ++i)
    out += "  " + all[i].call + ": " + (all[i].final ? "impossible" : "not found") + ", " +
           std::to_string(all[i].times) + (all[i].times == 1 ? " time: " : " times: ") +
           all[i].reason + "\n";
  if (all.size() > kShown)
    out += "  and " + std::to_string(all.size() - kShown) + " more (--report names all)\n";
  return out.empty() ? out : "calls that returned no value:\n" + out;
}

}  // namespace kaboum::tools
