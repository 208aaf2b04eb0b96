// Calls of external functions, cached by what they read of the state.
#include "task/external_calls.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <chrono>
#include <exception>

#include "task/atom_knowledge.h"

namespace kaboum::plan {
namespace {

constexpr std::uint8_t kConfirmed = 8;  // answers of each function that are asked for again

/// Leaves the host's function: what it wants to read is sensed, so that a branch comes first.
struct SensedValueRead {};

std::uint64_t mix(Index node, Index content) {
  std::uint64_t h = (std::uint64_t{node} << 32U | content) * 0x9e3779b97f4a7c15ULL;
  return h ^ (h >> 29U);
}

}  // namespace

/// The reader that a function is called with: notes what is read, or reads from notes.
class ExternalCalls::Reading final : public StateReader {
 public:
  Reading(ExternalCalls& calls, const Word* state, Path& path)
      : calls_(calls), state_(state), path_(path) {}

  Reply open;  ///< kind Open: a sensed value was asked for
  bool unnoted = false;

  std::optional<Index> value(Index function, std::span<const Index> arguments) override {
    const Layout::Field at = calls_.layout_.term(function, arguments.data());
    if (!at.exists) return std::nullopt;
    if (at.fluent == kNone)
      return at.value == kNone ? std::nullopt : std::optional<Index>(at.value);
    const Index content = read(at.fluent);
    if (content < kFirstValue) return std::nullopt;
    return calls_.layout_.object(at.fluent, content - kFirstValue);
  }
  std::optional<bool> truth(Index predicate, std::span<const Index> arguments) override {
    const Layout::Field at = calls_.layout_.atom(predicate, arguments.data());
    if (!at.exists) return std::nullopt;
    const auto k = at.fluent == kNone ? at.atom : static_cast<AtomKnowledge>(read(at.fluent));
    if (k == AtomKnowledge::True) return true;
    if (k == AtomKnowledge::False) return false;
    return std::nullopt;
  }

 private:
  Index read(Index fluent) {
    for (const auto& [item, content] : path_)
      if (item == fluent) return content;
    if (state_ == nullptr) {  // an answer is confirmed: it may not read more than before
      unnoted = true;
      throw SensedValueRead();
    }
    Index content = 0;
    if (!calls_.content(fluent, state_, content, open)) throw SensedValueRead();
    path_.emplace_back(fluent, content);
    return content;
  }

  ExternalCalls& calls_;
  const Word* state_;
  Path& path_;
};

ExternalCalls::ExternalCalls(const Model& model, const Layout& layout, Limits& limits)
    : model_(model),
      layout_(layout),
      limits_(limits),
      handles_(static_cast<Index>(model.objects.size())),
      edges_(64),
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
  const Fluent& f = layout_.fluents()[item];
  content = static_cast<Index>(f.get(state));
  Index sensed = kNone;
  if (f.function) {
    if (content == kValueSensed) sensed = item;
  } else if (content == static_cast<Index>(AtomKnowledge::Whether)) {
    sensed = item;
  } else if (content == static_cast<Index>(AtomKnowledge::Unknown) && !f.groups.empty()) {
    sensed = layout_.sensed_tie(item, state);
  }
  if (sensed == kNone) return true;
  why.kind = Reply::Kind::Open;
  why.fluent = sensed;
  return false;
}

bool ExternalCalls::arguments(const Call& c, const Word* state, std::vector<Index>& objects,
                              Path& path, Reply& why) {
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
  const Leaf& l = leaves_[leaf];
  const auto kind = l.kind == Answer::Kind::Value      ? Reply::Kind::Value
                    : l.kind == Answer::Kind::NotFound ? Reply::Kind::NotFound
                                                       : Reply::Kind::None;
  return {kind, l.value, 0, leaf};
}

ExternalCalls::Reply ExternalCalls::evaluate(Index call, const Word* state) {
  Index at = calls_[call].root;
  while (at != kNone && (at & kLeaf) == 0) {
    Index read = 0;
    Reply why;
    if (!content(nodes_[at], state, read, why)) return why;
    const Index* child = edge(at, read);
    at = child == nullptr ? kNone : *child;
  }
  if (at == kNone) return make(call, state, 0);
  const Leaf& l = leaves_[at & ~kLeaf];
  if (l.kind == Answer::Kind::NotFound && l.attempts < attempts_)
    return make(call, state, l.attempts);
  if (l.kind == Answer::Kind::NotFound && missed_ == kNone) {
    missed_ = at & ~kLeaf;
    missed_call_ = model_.externals[calls_[call].external].name;
  }
  return reply(at & ~kLeaf);
}

ExternalResult ExternalCalls::run(const Call& c, const std::vector<Index>& objects,
                                  Reading& reading, unsigned attempt) {
  ++made_;
  const auto start = std::chrono::steady_clock::now();
  ExternalContext context{reading, handles_, seed_, attempt};
  ExternalResult result = model_.external_functions[c.external].call(objects, context);
  seconds_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

/// Asks until something is found, or as often as is due; so what is found does not depend on when
/// the search first asked.
ExternalCalls::Reply ExternalCalls::make(Index call, const Word* state, unsigned first_attempt) {
  Reply why;
  Path path;
  std::vector<Index> objects;
  const Call c = calls_[call];  // a function's operands may be calls of others
  if (!arguments(c, state, objects, path, why)) return why;
  Leaf leaf;
  ExternalResult result;
  for (unsigned attempt = first_attempt; attempt < attempts_; ++attempt) {
    Reading reading(*this, state, path);
    try {
      result = run(c, objects, reading, attempt);
    } catch (const SensedValueRead&) {
      return reading.open;
    } catch (const LimitExceeded&) {
      throw;
    } catch (const Error& e) {
      throw Error(e.code(), "external function '" + call_text(c, objects) + "': " + e.what() +
                                state_text(path));
    } catch (const std::exception& e) {
      throw Error(ErrorCode::InvalidInput, "external function '" + call_text(c, objects) +
                                               "' failed: " + e.what() + state_text(path));
    }
    if (reading.open.kind == Reply::Kind::Open) return reading.open;  // it was told, but went on
    leaf.attempts = static_cast<std::uint16_t>(attempt + 1);
    if (limits_.check(0)) throw LimitExceeded();
    if (result.kind != Answer::Kind::NotFound) break;
  }
  leaf.kind = result.kind;
  leaf.value = result.value;
  leaf.text = text(result.kind == Answer::Kind::Value ? std::move(result.payload)
                                                      : std::move(result.reason));
  const Index made = insert(call, path, objects, leaf);
  if (leaf.kind == Answer::Kind::NotFound) {
    missed_ = made;
    missed_call_ = call_text(c, objects);
  }
  const std::size_t now = bytes();
  if (now > bytes_told_) {
    limits_.work(now - bytes_told_);
    bytes_told_ = now;
  }
  return reply(made);
}

/// Puts the answer where what was read leads.
Index ExternalCalls::insert(Index call, const Path& path, const std::vector<Index>& arguments,
                            Leaf leaf) {
  const auto fail = [&] {
    throw Error(ErrorCode::InvalidInput,
                "external function '" + call_text(calls_[call], arguments) +
                    "' reads other parts of the state when it is asked again: it may depend on its "
                    "arguments and the state only" +
                    state_text(path));
  };
  Index at = calls_[call].root;
  Index parent = kNone;
  const auto link = [&](Index content, Index child) {
    if (parent == kNone) {
      calls_[call].root = child;
    } else if (Index* known = edge(parent, content)) {
      *known = child;
    } else {
      add_edge(parent, content, child);
    }
  };
  Index content = 0;
  for (const auto& [item, read] : path) {
    const bool replaces = at != kNone && (at & kLeaf) != 0;
    if (replaces && leaves_[at & ~kLeaf].kind != Answer::Kind::NotFound) fail();
    if (at == kNone || replaces) {
      const auto node = static_cast<Index>(nodes_.size());
      nodes_.push_back(item);
      link(content, node);
      at = node;
    } else if (nodes_[at] != item) {
      fail();
    }
    parent = at;
    content = read;
    const Index* child = edge(at, read);
    at = child == nullptr ? kNone : *child;
  }
  if (at != kNone && (at & kLeaf) == 0) fail();
  if (at != kNone) {  // tried again
    leaves_[at & ~kLeaf] = leaf;
    return at & ~kLeaf;
  }
  // Answers that say the same are one, unless they may be replaced.
  Index& last = calls_[call].last;
  if (leaf.kind != Answer::Kind::NotFound && last != kNone && leaves_[last] == leaf) {
    link(content, last | kLeaf);
    return last;
  }
  const auto made = static_cast<Index>(leaves_.size());
  last = made;
  if (made >= kLeaf) throw Error(ErrorCode::LimitReached, "too many calls of external functions");
  leaves_.push_back(leaf);
  link(content, made | kLeaf);
  const Index external = calls_[call].external;
  if (sampled_[external] < kConfirmed) {
    ++sampled_[external];
    samples_.push_back({call, arguments, path, made});
  }
  return made;
}

/// In another order than at first, and twice, so that each follows calls that it did not follow.
void ExternalCalls::confirm() {
  for (int round = 0; round < (samples_.size() > 1 ? 2 : 1); ++round)
    for (std::size_t i = samples_.size(); i-- > 0;) {
      const Sample& s = samples_[i];
      const Leaf l = leaves_[s.leaf];
      Path path = s.path;
      Reading reading(*this, nullptr, path);
      bool same = l.attempts > 0;
      try {
        const ExternalResult r = run(calls_[s.call], s.arguments, reading, l.attempts - 1U);
        const std::string none;
        same = r.kind == l.kind && (r.kind != Answer::Kind::Value || r.value == l.value) &&
               (r.kind != Answer::Kind::Value || r.payload == payload(s.leaf));
      } catch (const SensedValueRead&) {
        same = l.kind == Answer::Kind::NotFound;  // a later attempt may have read more
      }
      if (!same)
        throw Error(ErrorCode::InvalidInput,
                    "external function '" + call_text(calls_[s.call], s.arguments) +
                        "' returned another value when it was called again: it may depend on its "
                        "arguments, the state and the seed only, not on calls made before" +
                        state_text(path));
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
  for (Index at = c.root; at != kNone && (at & kLeaf) == 0;) {
    add(nodes_[at]);
    Index read = 0;
    Reply why;
    if (!content(nodes_[at], state, read, why)) return;
    const Index* child = edge(at, read);
    at = child == nullptr ? kNone : *child;
  }
}

std::size_t ExternalCalls::slot(Index node, Index content) const {
  const std::size_t mask = edges_.size() - 1;
  std::size_t at = mix(node, content) & mask;
  while (edges_[at].node != kNone && (edges_[at].node != node || edges_[at].content != content))
    at = (at + 1) & mask;
  return at;
}

Index* ExternalCalls::edge(Index node, Index content) {
  Edge& e = edges_[slot(node, content)];
  return e.node == kNone ? nullptr : &e.child;
}

void ExternalCalls::add_edge(Index node, Index content, Index child) {
  if (++edge_count_ * 8 > edges_.size() * 7) {
    std::vector<Edge> old(edges_.size() * 2);
    old.swap(edges_);
    for (const Edge& e : old)
      if (e.node != kNone) edges_[slot(e.node, e.content)] = e;
  }
  edges_[slot(node, content)] = {node, content, child};
}

Index ExternalCalls::text(std::string text) {
  if (text.empty()) return kNone;
  texts_.push_back(std::move(text));
  return static_cast<Index>(texts_.size() - 1);
}

const std::string& ExternalCalls::payload(Index leaf) const {
  static const std::string kEmpty;
  const Index t = leaves_[leaf].text;
  return t == kNone ? kEmpty : texts_[t];
}

std::vector<std::string> ExternalCalls::argument_names(Index call, const Word* state) {
  std::vector<Index> objects;
  Path path;
  Reply why;
  arguments(Call(calls_[call]), state, objects, path, why);
  std::vector<std::string> names;
  names.reserve(objects.size());
  for (const Index o : objects) names.push_back(model_.name_of(o, handles_));
  return names;
}

std::string ExternalCalls::missed() const {
  if (missed_ == kNone) return "";
  const std::string& reason = payload(missed_);
  return missed_call_ + (reason.empty() ? "" : ": " + reason);
}

std::size_t ExternalCalls::bytes() const {
  return handles_.bytes() + nodes_.capacity() * sizeof(Index) + edges_.size() * sizeof(Edge) +
         leaves_.capacity() * sizeof(Leaf);
}

std::string ExternalCalls::call_text(const Call& c, const std::vector<Index>& objects) const {
  std::string text;
  for (const Index o : objects) text += (text.empty() ? "" : ", ") + model_.name_of(o, handles_);
  const std::string& name = model_.externals[c.external].name;
  return objects.empty() ? name : name + "(" + text + ")";
}

/// What was read: ", in a state where pose(o1) = p3, !held(o1)".
std::string ExternalCalls::state_text(const Path& path) const {
  std::string text;
  for (const auto& [item, content] : path) {
    if (is_call(item)) continue;
    const Fluent& f = layout_.fluents()[item];
    const Symbol& s = (f.function ? model_.functions : model_.predicates)[f.symbol];
    std::string name;
    for (const Index o : f.arguments)
      name.append(name.empty() ? "" : ", ").append(model_.objects[o].name);
    if (!f.arguments.empty()) name.insert(0, "(").append(")");
    name.insert(0, s.name);
    text += text.empty() ? ", in a state where " : ", ";
    const auto k = static_cast<AtomKnowledge>(content);
    if (f.function ? content < kFirstValue
                   : k != AtomKnowledge::True && k != AtomKnowledge::False) {
      text.append(name).append(" is not known");
    } else if (f.function) {
      text.append(name).append(" = ").append(
          model_.name_of(layout_.object(item, content - kFirstValue), handles_));
    } else {
      text.append(k == AtomKnowledge::True ? "" : "!").append(name);
    }
  }
  return text;
}

}  // namespace kaboum::plan
