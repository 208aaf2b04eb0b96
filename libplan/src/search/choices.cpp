// Which choices are tried after which have failed.
#include "search/choices.h"

#include <algorithm>

namespace kaboum::plan {
namespace {

unsigned choice_of(const Choices& choices, const std::string& call) {
  const auto found = choices.find(call);
  return found == choices.end() ? 0 : found->second;
}

}  // namespace

void ChoiceSearch::add_failure(const Choices& choices, const ChoosingCalls& calls) {
  std::uint64_t blames = 0;
  for (const auto& [text, call] : calls) blames += call.blamed;
  Choices conflict, changed = choices;
  std::vector<Candidate> singles;
  for (const auto& [text, call] : calls) {
    if (blames > 0 && call.blamed == 0) continue;
    conflict[text] = call.choice;
    if (call.choice >= call.most) continue;
    changed[text] = call.choice + 1;
    singles.push_back({0, blames - call.blamed, 0, choices});
    singles.back().choices[text] = call.choice + 1;
  }
  if (conflict.empty()) return;
  const auto add = [&](Candidate candidate, Candidates& to) {
    if (!seen_.insert(candidate.choices).second) return;
    candidate.blamed_calls = conflict.size();
    candidate.order = seen_.size();
    to.insert(std::move(candidate));
  };
  add({0, 0, 0, std::move(changed)}, together_);
  for (Candidate& single : singles) add(std::move(single), single_);
  conflicts_.push_back(std::move(conflict));
}

bool ChoiceSearch::holds_conflict(const Choices& choices) const {
  return std::ranges::any_of(conflicts_, [&](const Choices& conflict) {
    return std::ranges::all_of(
        conflict, [&](const auto& c) { return choice_of(choices, c.first) == c.second; });
  });
}

std::optional<Choices> ChoiceSearch::take(Candidates& from) {
  while (!from.empty()) {
    Choices choices = std::move(from.extract(from.begin()).value().choices);
    if (!holds_conflict(choices)) return choices;
  }
  return std::nullopt;
}

std::optional<Choices> ChoiceSearch::next() {
  std::optional<Choices> out = take(one_by_one_ ? single_ : together_);
  if (!out) out = take(one_by_one_ ? together_ : single_);
  one_by_one_ = !one_by_one_;
  return out;
}

}  // namespace kaboum::plan
