// Which choices are tried after which have failed.
#include "search/choices.h"

#include <algorithm>

namespace kaboum::plan {
namespace {

unsigned choice_of(const Choices& choices, const std::string& call) {
  const auto found = choices.find(call);
  return found == choices.end() ? 0 : found->second;
}

/// A node of a tree for each, and its text.
std::size_t bytes_of(const Choices& choices) {
  constexpr std::size_t kNodeBytes = 96;
  std::size_t out = kNodeBytes;
  for (const auto& [call, choice] : choices) out += kNodeBytes + call.size();
  return out;
}

}  // namespace

void ChoiceSearch::add_failure(const Choices& choices, const ChoosingCalls& calls) {
  std::uint64_t blames = 0;
  for (const auto& [text, call] : calls) blames += call.blamed;
  const auto add = [&](bool needed, std::size_t count, std::uint64_t spared, Choices changed,
                       Candidates& to) {
    if (!seen_.insert(changed).second) return;
    bytes_ += 2 * bytes_of(changed);  // seen, and to be tried
    to.insert({!needed, count, spared, seen_.size(), std::move(changed)});
  };
  const auto change = [&](bool needed) {
    Choices conflict, changed = choices;
    for (const auto& [text, call] : calls) {
      if (needed ? !call.needed : blames > 0 && call.blamed == 0) continue;
      conflict[text] = call.choice;
      if (call.choice < call.most) changed[text] = call.choice + 1;
    }
    if (conflict.empty()) return conflict;
    add(needed, conflict.size(), 0, changed, together_);
    for (const auto& [text, choice] : conflict) {
      if (changed[text] == choice) continue;
      Choices single = choices;
      single[text] = choice + 1;
      add(needed, conflict.size(), blames - calls.at(text).blamed, std::move(single), single_);
    }
    return conflict;
  };
  change(true);
  Choices conflict = change(false);
  if (conflict.empty()) return;
  bytes_ += bytes_of(conflict);
  conflicts_.push_back(std::move(conflict));
}

bool ChoiceSearch::holds_conflict(const Choices& choices) const {
  return std::ranges::any_of(conflicts_, [&](const Choices& conflict) {
    return std::ranges::all_of(
        conflict, [&](const auto& c) { return choice_of(choices, c.first) == c.second; });
  });
}

void ChoiceSearch::drop_conflicts(Candidates& from) const {
  while (!from.empty() && holds_conflict(from.begin()->choices)) from.erase(from.begin());
}

std::optional<Choices> ChoiceSearch::next() {
  drop_conflicts(together_);
  drop_conflicts(single_);
  one_by_one_ = !one_by_one_;
  if (together_.empty() && single_.empty()) return std::nullopt;
  const auto rank = [](const Candidates& c) {
    return c.empty() ? 2 : c.begin()->not_needed ? 1 : 0;
  };
  const int together = rank(together_), single = rank(single_);
  Candidates& from = single < together || (single == together && one_by_one_) ? single_ : together_;
  return std::move(from.extract(from.begin()).value().choices);
}

}  // namespace kaboum::plan
