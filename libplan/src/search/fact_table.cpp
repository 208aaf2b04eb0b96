// Facts of a task by number, which of them a formula's leaf speaks of, and which an effect brings
// about or ends.
#include "search/fact_table.h"

namespace kaboum::plan {

using Kind = FormulaPool::Kind;

FactTable::FactTable(const Model& model, const Layout& layout) : layout_(layout) {
  for (Index i = 0; i < layout.fluents().size(); ++i) {
    const Fluent& f = layout.fluents()[i];
    first_fact_.push_back(static_cast<FactId>(size_));
    const std::size_t contents = f.handle     ? model.objects.size() + kFirstValue + 1
                                 : f.function ? layout.range_size(f) + kFirstValue
                                              : 4;
    contents_.push_back(contents);
    fluent_of_.insert(fluent_of_.end(), contents, i);
    size_ += contents;
  }
}

/// Contents of a leaf's fluent for which the leaf holds (or, if not positive, fails).
std::vector<FactId> FactTable::leaf_contents(const FormulaPool::Node& n, bool positive,
                                             bool& always) const {
  const Fluent& f = layout_.fluents()[n.a];
  always = false;
  std::vector<FactId> result;
  const Word count = contents_[n.a];
  for (Word c = 0; c < count; ++c) {
    bool holds = false;
    bool open = false;
    switch (n.kind) {
      case Kind::IsTrue:
        holds = c == static_cast<Word>(AtomKnowledge::True);
        open = c == static_cast<Word>(AtomKnowledge::Whether);
        break;
      case Kind::IsFalse:
        holds = c == static_cast<Word>(AtomKnowledge::False);
        open = c == static_cast<Word>(AtomKnowledge::Whether);
        break;
      case Kind::Whether:
      case Kind::ValueKnown:
        holds = c != 0;
        break;
      case Kind::ValueIs:
        holds = c == kFirstValue + n.b;
        open = c == kValueSensed;
        break;
      case Kind::ValueIsNot:
        holds = c >= kFirstValue && c != kFirstValue + n.b;
        open = c == kValueSensed;
        break;
      case Kind::ValueWhether:
        holds = c != kValueUnknown;
        break;
      default:
        break;
    }
    if (!open && holds == positive) result.push_back(fact(n.a, c));
  }
  // Exclusions and exclusive-or groups may decide without the content: optimistic then.
  always = f.exclusions != kNone || (!f.groups.empty() && !positive);
  return result;
}

std::vector<FactId> FactTable::added(const Change& c) const {
  using K = Change::Kind;
  const auto atom = [&](AtomKnowledge k) { return fact(c.fluent, static_cast<Word>(k)); };
  switch (c.kind) {
    case K::AddTrue:
      return {atom(AtomKnowledge::True)};
    case K::AddFalse:
      return {atom(AtomKnowledge::False)};
    case K::DeleteTrue:
    case K::DeleteFalse:
    case K::DeleteClosed:
    case K::Forget:
    case K::DeleteValue:
    case K::DeleteExclude:
    case K::Exclude:
      return {fact(c.fluent, 0)};
    case K::AddWhether:
    case K::AddClosed:
      return {atom(AtomKnowledge::Whether)};
    case K::AddValue:
      return {fact(c.fluent, kFirstValue + c.value)};
    case K::AddSensed:
      return {fact(c.fluent, kValueSensed)};
    case K::AddOptions: {
      std::vector<FactId> all;
      for (const Index o : c.options) all.push_back(fact(c.fluent, kFirstValue + o));
      return all;
    }
    case K::AddGroup:
    case K::DeleteGroup:
      return {};
  }
  return {};
}

std::vector<FactId> FactTable::added(const ConditionalEffect& c) const {
  std::vector<FactId> all;
  for (const auto* list : {&c.deletions, &c.direct, &c.additions, &c.sensing})
    for (const Change& change : *list)
      for (const FactId x : added(change)) all.push_back(x);
  for (const ConditionalEffect::Transfer& t : c.transfers)  // any value, or none
    for (Word content = 0; content < contents_[t.fluent]; ++content)
      if (content != kValueSensed) all.push_back(fact(t.fluent, content));
  return all;
}

bool FactTable::ends(const ConditionalEffect& c, FactId f) const {
  using K = Change::Kind;
  const Index fluent = fluent_of(f);
  const Word content = content_of(f);
  const auto is = [&](AtomKnowledge k) { return content == static_cast<Word>(k); };
  for (const auto* list : {&c.deletions, &c.direct, &c.additions})
    for (const Change& change : *list) {
      if (change.kind == K::AddGroup || change.kind == K::DeleteGroup || change.fluent != fluent)
        continue;
      switch (change.kind) {
        case K::AddTrue:
          if (!is(AtomKnowledge::True)) return true;
          break;
        case K::AddFalse:
          if (!is(AtomKnowledge::False)) return true;
          break;
        case K::DeleteTrue:
          if (is(AtomKnowledge::True)) return true;
          break;
        case K::DeleteFalse:
        case K::DeleteClosed:
          if (is(AtomKnowledge::False)) return true;
          break;
        case K::Forget:
          if (content != 0) return true;
          break;
        case K::AddValue:
          if (content != kFirstValue + change.value) return true;
          break;
        case K::DeleteValue:
          if (content == kFirstValue + change.value) return true;
          break;
        case K::DeleteExclude:
          if (content >= kFirstValue && content != kFirstValue + change.value) return true;
          break;
        default:
          break;  // observations: certain of nothing
      }
    }
  return false;
}

}  // namespace kaboum::plan
