// Which calls of external functions failed, how often, and why.

#include <kaboum/plan/failed_calls.h>

#include <algorithm>

namespace kaboum::plan {

ExternalBindings FailedCalls::watch(const ExternalBindings& bindings) {
  ExternalBindings out;
  for (const auto& [name, function] : bindings) {
    if (!function.takes_seed()) {  // of names alone: it gives no reasons
      out[name] = function;
      continue;
    }
    const auto watched = [notes = notes_, name = name, function = function](const Question& q) {
      Answer answer = function(q);
      if (answer.kind != Answer::Kind::Value && !answer.reason.empty()) {
        std::string call = name + "(";
        for (std::size_t i = 0; i < q.arguments.size(); ++i)
          call += (i > 0 ? ", " : "") + q.arguments[i];
        auto& [impossible, times] = (*notes)[{call + ")", answer.reason}];
        impossible = (times == 0 || impossible) && answer.kind == Answer::Kind::Impossible;
        ++times;
      }
      return answer;
    };
    out[name] = ExternalBinding(watched, function.reads_state());
    if (function.refuses_early()) out[name].refuse_early();
  }
  return out;
}

std::vector<FailedCalls::Failure> FailedCalls::failures() const {
  std::vector<Failure> out;
  for (const auto& [what, how] : *notes_)
    out.push_back({what.first, what.second, how.first, how.second});
  std::ranges::stable_sort(out,
                           [](const Failure& a, const Failure& b) { return a.times > b.times; });
  return out;
}

}  // namespace kaboum::plan
