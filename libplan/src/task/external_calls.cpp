// Calls of external functions, cached by what they read of the state.
#include "task/external_calls.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <chrono>
#include <exception>

#include "task/call_text.h"
#include "task/noted_reader.h"

namespace kaboum::plan {
namespace {

/// Answers of each function that are asked for again; of those that take long to find, as paths do.
constexpr std::uint8_t kConfirmed = 8, kLongConfirmed = 2;

/// About as much as a node of a tree takes, with what it holds.
constexpr std::size_t kNodeBytes = 96;

/// Handle types whose values a query compares with something.
void add_compared(const Model& model, const Query& q, std::set<Index>& types) {
  const auto add = [&](Index type) {
    if (type != kNone && model.types[type].handle) types.insert(type);
  };
  if (q.kind == Query::Kind::KnownValue || q.kind == Query::Kind::WhetherValue)
    add(model.functions[q.symbol].range);
  if (q.kind == Query::Kind::External && q.value) add(model.externals[q.symbol].range);
  for (const Query& child : q.children) add_compared(model, child, types);
}

void add_compared(const Model& model, const std::vector<Effect>& effects, std::set<Index>& types) {
  for (const Effect& e : effects) {
    add_compared(model, e.condition, types);
    add_compared(model, e.children, types);
  }
}

std::set<Index> compared_handle_types(const Model& model) {
  std::set<Index> types;
  add_compared(model, model.goal, types);
  for (const Action& a : model.actions) {
    add_compared(model, a.precondition, types);
    add_compared(model, a.effects, types);
  }
  for (const Rule& r : model.rules) add_compared(model, r.body, types);
  return types;
}

}  // namespace

ExternalCalls::ExternalCalls(const Model& model, const Layout& layout, Limits& limits)
    : model_(model),
      layout_(layout),
      limits_(limits),
      handles_(static_cast<Index>(model.objects.size())),
      sampled_(model.externals.size(), 0) {}

Index ExternalCalls::call(Index external, std::vector<Index> operands) {
  const auto [it, fresh] =
      call_index_.emplace(std::pair(external, operands), static_cast<Index>(calls_.size()));
  if (!fresh) return it->second;
  Call c;
  c.external = external;
  c.depends = model_.external_functions[external].reads_state;
  for (const Index o : operands) {
    c.depends |= is_term(o) || (is_call(o) && calls_[o & ~kCallOperand].depends);
    c.never_known |= o == kNone || (is_call(o) && calls_[o & ~kCallOperand].never_known);
  }
  c.operands = std::move(operands);
  calls_.push_back(std::move(c));
  return it->second;
}

bool ExternalCalls::content(Index item, const Word* state, Index& content, Reply& why) {
  if (is_call(item)) {
    why = evaluate(item & ~kCallOperand, state);
    content = why.value;
    return why.kind == Reply::Kind::Value;
  }
  Index sensed = kNone;
  content = settled_content(layout_, item, state, sensed);
  if (sensed == kNone) return true;
  why.kind = Reply::Kind::Open;
  why.fluent = sensed;
  return false;
}

bool ExternalCalls::arguments(const Call& c, const Word* state, std::vector<Index>& objects,
                              Footprint& path, Reply& why) {
  if (c.never_known) {
    why = {};
    why.unknown_argument = true;
    return false;
  }
  for (const Index o : c.operands) {
    if (!is_call(o) && !is_term(o)) {
      objects.push_back(o);
      continue;
    }
    const Index item = is_call(o) ? o : o & ~kTermOperand;
    Index read = 0;
    if (!content(item, state, read, why)) return false;
    if (std::none_of(path.begin(), path.end(), [&](const auto& p) { return p.first == item; }))
      path.emplace_back(item, read);
    if (is_call(o)) {
      objects.push_back(read);
    } else {
      if (read < kFirstValue) {
        why = {};  // of an earlier operand, which may have had a value
        why.unknown_argument = true;
        return false;
      }
      objects.push_back(layout_.object(item, read - kFirstValue));
    }
  }
  return true;
}

ExternalCalls::Reply ExternalCalls::reply(Index leaf) const {
  const AnswerTree::Leaf l = answers_.leaf(leaf);
  const auto kind = l.kind == Answer::Kind::Value      ? Reply::Kind::Value
                    : l.kind == Answer::Kind::NotFound ? Reply::Kind::NotFound
                                                       : Reply::Kind::None;
  return {kind, l.value, 0, leaf};
}

ExternalCalls::Reply ExternalCalls::evaluate(Index call, const Word* state) {
  Index at = calls_[call].answers.node;
  while (at != kNone && !AnswerTree::is_leaf(at)) {
    Index read = 0;
    Reply why;
    if (!content(answers_.reads(at), state, read, why)) return why;
    at = answers_.child(at, read);
  }
  if (at == kNone) return make(call, state, 0);
  const Index leaf = AnswerTree::leaf_number(at);
  const AnswerTree::Leaf l = answers_.leaf(leaf);
  if (l.kind == Answer::Kind::NotFound && l.attempts < attempts_)
    return make(call, state, l.attempts);
  if (l.kind == Answer::Kind::NotFound && missed_ == kNone) {
    missed_ = leaf;
    const Call c = calls_[call];
    Reply why;
    Footprint path;
    std::vector<Index> objects;
    arguments(c, state, objects, path, why);
    missed_call_ = text(c, objects);
  }
  return reply(leaf);
}

void ExternalCalls::ask_early(Index call, const Word* state) {
  if (!model_.external_functions[calls_[call].external].refuses_early) return;
  struct Reset {
    bool& early;
    ~Reset() { early = false; }
  };
  const Reset reset{early_};
  early_ = true;
  evaluate(call, state);
}

ExternalResult ExternalCalls::run(const Call& c, const std::vector<Index>& objects,
                                  StateReader& reader, unsigned attempt) {
  ++made_;
  const auto start = std::chrono::steady_clock::now();
  const unsigned choice = choices_.empty() ? 0 : choice_of(text(c, objects));
  ExternalContext context{reader, handles_, seed_, attempt, choice, early_};
  ExternalResult result = model_.external_functions[c.external].call(objects, context);
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

/// Asks until something is found, or as often as is due; so what is found does not depend on when
/// the search first asked.
ExternalCalls::Reply ExternalCalls::make(Index call, const Word* state, unsigned first_attempt) {
  Reply why;
  Footprint path;
  std::vector<Index> objects;
  const Call c = calls_[call];  // a function's operands may be calls of others
  if (!arguments(c, state, objects, path, why)) return why;
  AnswerTree::Leaf leaf;
  ExternalResult result;
  std::size_t known = 0;
  for (unsigned attempt = first_attempt; attempt < attempts_; ++attempt) {
    NotedReader reader(layout_, state, path, early_ ? &objects : nullptr);
    known = handles_.size();
    try {
      result = run(c, objects, reader, attempt);
    } catch (const ReadingStopped&) {
      if (early_ && reader.sensed() == kNone) --made_;
      return open(reader.sensed());
    } catch (const LimitExceeded&) {
      throw;
    } catch (const Error& e) {
      throw Error(e.code(), "external function '" + text(c, objects) + "': " + e.what() +
                                state_text(model_, handles_, layout_, path));
    } catch (const std::exception& e) {
      throw Error(ErrorCode::InvalidInput, "external function '" + text(c, objects) +
                                               "' failed: " + e.what() +
                                               state_text(model_, handles_, layout_, path));
    } catch (...) {
      throw Error(ErrorCode::InvalidInput, "external function '" + text(c, objects) +
                                               "' failed: it threw what is no std::exception" +
                                               state_text(model_, handles_, layout_, path));
    }
    if (reader.sensed() != kNone) return open(reader.sensed());  // it was told, but went on
    leaf.attempts = static_cast<std::uint16_t>(attempt + 1);
    if (limits_.check(0)) throw LimitExceeded();
    if (result.kind != Answer::Kind::NotFound) break;
  }
  note(call, objects, path, result, handles_.size() > known);
  leaf.kind = result.kind;
  leaf.value = result.value;
  leaf.text = answers_.text(result.kind == Answer::Kind::Value ? std::move(result.payload)
                                                               : std::move(result.reason));
  const Index made = keep(call, path, objects, leaf);
  if (leaf.kind == Answer::Kind::NotFound) {
    missed_ = made;
    missed_call_ = text(c, objects);
  }
  const std::size_t now = bytes() + noted_bytes_;
  if (now > bytes_told_) {
    limits_.work(now - bytes_told_);
    bytes_told_ = now;
  }
  return reply(made);
}

unsigned ExternalCalls::choice_of(const std::string& call) const {
  const auto found = choices_.find(call);
  return found == choices_.end() ? 0 : found->second;
}

void ExternalCalls::count_noted(std::size_t nodes) { noted_bytes_ += nodes * kNodeBytes; }

void ExternalCalls::blame(Index call, const std::vector<Index>& objects,
                          const std::vector<Index>& read, const ExternalResult& result,
                          bool handle) {
  const auto rests = [&](Index object) { return rest_on_choice_.contains(object); };
  Call& made = calls_[call];
  Index own = kNone;
  if (result.choices > 0) {
    const std::string name = text(made, objects);
    const auto [at, fresh] = choosing_index_.emplace(name, static_cast<Index>(choosing_.size()));
    own = at->second;
    if (fresh) {
      choosing_.emplace_back(name, ChoosingCall{choice_of(name)});
      count_noted(2);
    }
    ChoosingCall& chooses = choosing_[own].second;
    chooses.most = std::max(chooses.most, result.choices);
  }
  const bool by_choice = own != kNone || std::ranges::any_of(read, rests);
  const bool value = result.kind == Answer::Kind::Value;
  const bool failed_before = !made.had_value && made.failed_by_choice;
  in_vain_ = value && !made.had_value ? 0 : in_vain_ + 1;
  made.had_value |= value;
  if (handle) {
    const auto [at, fresh] = origins_.try_emplace(result.value);
    Origin& origin = at->second;
    std::size_t added = fresh ? 1 : 0;
    if (own != kNone && origin.choosing.insert(own).second) ++added;
    for (const Index object : read)
      if ((object >= model_.objects.size() || origins_.contains(object)) &&
          origin.read.insert(object).second)
        ++added;
    if (by_choice && rest_on_choice_.insert(result.value).second) ++added;
    count_noted(added);
  } else {
    const auto add = [&](std::map<Index, std::map<Index, std::uint64_t>>& to, Index source) {
      const auto [by, fresh] = to.try_emplace(source);
      const auto [times, first] = by->second.try_emplace(call, 0);
      ++times->second;
      count_noted((fresh ? 1 : 0) + (first ? 1 : 0));
    };
    for (const Index object : read) add(failures_, object);
    if (own != kNone) add(failures_of_own_choice_, own);
    made.failed_by_choice |= !value && by_choice;
  }
  const bool fails = !made.had_value && made.failed_by_choice;
  failed_ += (fails ? 1U : 0U) - (failed_before ? 1U : 0U);
  if (is_in_vain()) limits_.pause_after(0);
}

bool ExternalCalls::is_in_vain() const {
  return pause_after_ > 0 && failed_ > 0 && in_vain_ >= pause_after_;
}

std::vector<Index> ExternalCalls::failed_by_choice() const {
  std::vector<Index> out;
  for (Index call = 0; call < calls_.size(); ++call)
    if (!calls_[call].had_value && calls_[call].failed_by_choice) out.push_back(call);
  return out;
}

std::set<Index> ExternalCalls::choosing_calls_of(Index handle) const {
  std::set<Index> out, seen = {handle};
  for (std::vector<Index> left = {handle}; !left.empty();) {
    const auto origin = origins_.find(left.back());
    left.pop_back();
    if (origin == origins_.end()) continue;
    out.insert(origin->second.choosing.begin(), origin->second.choosing.end());
    for (const Index read : origin->second.read)
      if (seen.insert(read).second) left.push_back(read);
  }
  return out;
}

ChoosingCalls ExternalCalls::choosing_calls(const std::vector<Index>& needed) const {
  ChoosingCalls out(choosing_.begin(), choosing_.end());
  const auto blame = [&](Index source, const std::map<Index, std::uint64_t>& failures) {
    ChoosingCall& chosen = out[choosing_[source].first];
    for (const auto& [call, times] : failures) {
      chosen.blamed += times;
      chosen.needed |= std::ranges::find(needed, call) != needed.end();
    }
  };
  for (const auto& [handle, failures] : failures_)
    for (const Index source : choosing_calls_of(handle)) blame(source, failures);
  for (const auto& [source, failures] : failures_of_own_choice_) blame(source, failures);
  return out;
}

void ExternalCalls::note(Index call, const std::vector<Index>& objects, const Footprint& path,
                         const ExternalResult& result, bool fresh) {
  const Call c = calls_[call];
  std::vector<Index> read = objects;
  for (const auto& [item, content] : path) {
    if (is_call(item))
      read.push_back(content);
    else if (layout_.fluents()[item].function && content >= kFirstValue)
      read.push_back(layout_.object(item, content - kFirstValue));
  }
  const Index range = model_.externals[c.external].range;
  const bool handle =
      result.kind == Answer::Kind::Value && range != kNone && model_.types[range].handle;
  if (handle && result.fixed) read = objects;
  blame(call, objects, read, result, handle);
  if (result.kind == Answer::Kind::NotFound) return;
  if (result.kind == Answer::Kind::Impossible && !result.reason.empty() && refusals_++ == 0)
    refused_ = text(c, objects) + ": " + result.reason;
  if (result.kind == Answer::Kind::Impossible && result.listed && listed_.empty())
    listed_ = text(c, objects) + ": " + result.reason;
  if (!handle) {
    const std::size_t before = final_.size();
    final_.insert(read.begin(), read.end());
    count_noted(final_.size() - before);
  }
  const auto source = std::find_if(read.begin(), read.end(),
                                   [&](Index object) { return chosen_.contains(object); });
  if (result.kind != Answer::Kind::Value || (!result.chosen && source == read.end())) return;
  const std::string by = source == read.end() ? text(c, objects) : chosen_.at(*source);
  if (!handle) {
    if (result.chosen) any_choice_ = by;
    return;
  }
  // What was known before may have been read before.
  const bool is_new = chosen_.emplace(result.value, by).second;
  if (is_new) count_noted(1);
  if (is_new && !fresh) any_choice_ = by;
  chosen_types_.insert(range);
}

std::string ExternalCalls::chosen() const {
  if (chosen_.empty() || !any_choice_.empty()) return any_choice_;
  for (const auto& [handle, by] : chosen_)
    if (final_.contains(handle)) return by;
  for (const Index type : compared_handle_types(model_))
    if (chosen_types_.contains(type)) return chosen_.begin()->second;
  return "";
}

std::string ExternalCalls::refused() const {
  if (refusals_ < 2) return refused_;
  return refused_ + "; and " + std::to_string(refusals_ - 1) +
         (refusals_ == 2 ? " other call without a value" : " other calls without a value");
}

/// Notes the answer where it is found again; some are noted to be confirmed as well.
Index ExternalCalls::keep(Index call, const Footprint& path, const std::vector<Index>& arguments,
                          const AnswerTree::Leaf& leaf) {
  const auto made = answers_.insert(calls_[call].answers, path, leaf);
  if (!made)
    throw Error(ErrorCode::InvalidInput,
                "external function '" + text(calls_[call], arguments) +
                    "' reads other parts of the state when it is asked again: it may depend on its "
                    "arguments and the state only" +
                    state_text(model_, handles_, layout_, path));
  const Index external = calls_[call].external;
  const bool takes_long =
      leaf.kind == Answer::Kind::NotFound ||
      (leaf.kind == Answer::Kind::Value && !answers_.payload(made->leaf).empty());
  if (made->fresh && sampled_[external] < (takes_long ? kLongConfirmed : kConfirmed)) {
    ++sampled_[external];
    samples_.push_back({call, arguments, path, made->leaf});
  }
  return made->leaf;
}

/// In another order than at first, and twice, so that each follows calls that it did not follow.
void ExternalCalls::confirm() {
  for (int round = 0; round < (samples_.size() > 1 ? 2 : 1); ++round)
    for (std::size_t i = samples_.size(); i-- > 0;) {
      const Sample& s = samples_[i];
      const AnswerTree::Leaf l = answers_.leaf(s.leaf);
      Footprint path = s.path;
      NotedReader reader(layout_, nullptr, path);
      bool same = l.attempts > 0;
      try {
        const ExternalResult r = run(calls_[s.call], s.arguments, reader, l.attempts - 1U);
        same = r.kind == l.kind && (r.kind != Answer::Kind::Value || r.value == l.value) &&
               (r.kind != Answer::Kind::Value || r.payload == payload(s.leaf));
      } catch (const ReadingStopped&) {
        same = l.kind == Answer::Kind::NotFound;  // a later attempt may have read more
      }
      if (!same)
        throw Error(ErrorCode::InvalidInput,
                    "external function '" + text(calls_[s.call], s.arguments) +
                        "' returned another value when it was called again: it may depend on its "
                        "arguments, the state and the seed only, not on calls made before" +
                        state_text(model_, handles_, layout_, path));
    }
}

void ExternalCalls::footprint(Index call, const Word* state, std::vector<Index>& fluents) {
  const Call& c = calls_[call];
  const auto add = [&](Index item) {
    if (is_call(item)) {
      footprint(item & ~kCallOperand, state, fluents);
    } else if (std::find(fluents.begin(), fluents.end(), item) == fluents.end()) {
      fluents.push_back(item);
    }
  };
  // Operands first: they are read even where the call is not made.
  for (const Index o : c.operands)
    if (is_call(o) || is_term(o)) add(is_call(o) ? o : o & ~kTermOperand);
  for (Index at = c.answers.node; at != kNone && !AnswerTree::is_leaf(at);) {
    add(answers_.reads(at));
    Index read = 0;
    Reply why;
    if (!content(answers_.reads(at), state, read, why)) return;
    at = answers_.child(at, read);
  }
}

std::vector<std::string> ExternalCalls::argument_names(Index call, const Word* state) {
  std::vector<Index> objects;
  Footprint path;
  Reply why;
  arguments(Call(calls_[call]), state, objects, path, why);
  std::vector<std::string> names;
  names.reserve(objects.size());
  for (const Index o : objects) names.push_back(model_.name_of(o, handles_));
  return names;
}

std::string ExternalCalls::constant_text(Index call) const {
  const Call& c = calls_[call];
  const auto is_read = [](Index o) { return o == kNone || is_call(o) || is_term(o); };
  return std::ranges::any_of(c.operands, is_read) ? "" : text(c, c.operands);
}

std::string ExternalCalls::missed() const {
  if (missed_ == kNone) return "";
  const std::string& reason = payload(missed_);
  return missed_call_ + (reason.empty() ? "" : ": " + reason);
}

std::string ExternalCalls::text(const Call& c, const std::vector<Index>& objects) const {
  return call_text(model_, handles_, c.external, objects);
}

}  // namespace kaboum::plan
