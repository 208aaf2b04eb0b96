// Reads of a state by external functions.
#include "task/noted_reader.h"

#include <algorithm>

#include "task/atom_knowledge.h"

namespace kaboum::plan {

Index settled_content(const Layout& layout, Index fluent, const Word* state, Index& sensed) {
  const Fluent& f = layout.fluents()[fluent];
  const auto content = static_cast<Index>(f.get(state));
  if (f.function) {
    if (content == kValueSensed) sensed = fluent;
  } else if (content == static_cast<Index>(AtomKnowledge::Whether)) {
    sensed = fluent;
  } else if (content == static_cast<Index>(AtomKnowledge::Unknown) && !f.groups.empty()) {
    sensed = layout.sensed_tie(fluent, state);
  }
  return sensed == kNone ? content : kNone;
}

std::optional<Index> NotedReader::value(Index function, std::span<const Index> arguments) {
  const Layout::Field at = layout_.term(function, arguments.data());
  if (!at.exists) return std::nullopt;
  if (at.fluent == kNone) return at.value == kNone ? std::nullopt : std::optional<Index>(at.value);
  const Index content = read(at.fluent);
  if (content < kFirstValue) return std::nullopt;
  return layout_.object(at.fluent, content - kFirstValue);
}

std::optional<bool> NotedReader::truth(Index predicate, std::span<const Index> arguments) {
  const Layout::Field at = layout_.atom(predicate, arguments.data());
  if (!at.exists) return std::nullopt;
  const auto k = at.fluent == kNone ? at.atom : static_cast<AtomKnowledge>(read(at.fluent));
  if (k == AtomKnowledge::True) return true;
  if (k == AtomKnowledge::False) return false;
  return std::nullopt;
}

Index NotedReader::read(Index fluent) {
  for (const auto& [item, content] : notes_)
    if (item == fluent) return content;
  if (state_ == nullptr) throw ReadingStopped();
  const auto is_named = [&](Index object) {
    return named_ == nullptr || std::ranges::find(*named_, object) != named_->end();
  };
  if (!std::ranges::all_of(layout_.fluents()[fluent].arguments, is_named)) throw ReadingStopped();
  const Index content = settled_content(layout_, fluent, state_, sensed_);
  if (content == kNone) throw ReadingStopped();
  notes_.emplace_back(fluent, content);
  return content;
}

}  // namespace kaboum::plan
