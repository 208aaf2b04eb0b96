#pragma once

#include <cstdint>
#include <vector>

#include "task/layout.h"

namespace kaboum::plan {

/// Hash of one word at its place; a state's hash is the exclusive or over its words, so it follows
/// every change at the cost of that change.
inline std::uint64_t word_hash(Index place, Word content) {
  std::uint64_t h = content ^ (0x9e3779b97f4a7c15ULL * (place + 1));
  h ^= h >> 32U;
  h *= 0xd6e8feb86659fd93ULL;
  h ^= h >> 32U;
  h *= 0xd6e8feb86659fd93ULL;
  h ^= h >> 32U;
  return h;
}

/// One change of knowledge, ground.
struct Change {
  enum class Kind : std::uint8_t {
    AddTrue,        ///< add(Kf, p)
    AddFalse,       ///< add(Kf, !p)
    DeleteTrue,     ///< del(Kf, p)
    DeleteFalse,    ///< del(Kf, !p)
    AddWhether,     ///< add(Kw, p): p is sensed
    Forget,         ///< del(Kw, p), del(Kv, f)
    AddValue,       ///< add(Kf, f = v)
    DeleteValue,    ///< del(Kf, f = v)
    Exclude,        ///< add(Kf, f != v)
    DeleteExclude,  ///< del(Kf, f != v)
    AddSensed,      ///< add(Kv, f): f is sensed
    AddGroup,       ///< add(Kx, p | q | ...)
    DeleteGroup,    ///< del(Kx, ...)
    AddClosed,      ///< add(LCW, p): all instances are sensed
    DeleteClosed,   ///< del(LCW, p): the list of true instances may be incomplete
    AddOptions,     ///< add(Kx, f = v | f = w | ...): one per option; the rest is excluded
  };
  Kind kind = Kind::AddTrue;
  Index fluent = 0;  ///< or group
  Index value = 0;   ///< position in the range
  std::vector<Index> options;
};

/// A knowledge state that can be changed: the five databases of the planner, kept consistent by
/// inference (docs/planning/knowledge-states.md), with its hash and, on request, undo.
class Knowledge {
 public:
  explicit Knowledge(const Layout& layout)
      : layout_(&layout),
        words_(layout.words(), 0),
        hash_(hash_of(words_.data(), layout.words())) {}

  void assign(const Word* words) {
    assign(words, hash_of(words, static_cast<Index>(words_.size())));
  }
  /// @param hash  hash_of(words, ...)
  void assign(const Word* words, std::uint64_t hash) {
    words_.assign(words, words + words_.size());
    hash_ = hash;
    log_.clear();
  }
  [[nodiscard]] const Word* words() const { return words_.data(); }
  [[nodiscard]] std::uint64_t hash() const { return hash_; }
  static std::uint64_t hash_of(const Word* words, Index count) {
    std::uint64_t h = 0;
    for (Index i = 0; i < count; ++i) h ^= word_hash(i, words[i]);
    return h;
  }

  /// From now on, changes can be undone back to a mark.
  void keep_log(bool on) { logging_ = on; }
  [[nodiscard]] std::size_t mark() const { return log_.size(); }
  /// Words that were written to since, and what they had been.
  [[nodiscard]] const std::vector<std::pair<Index, Word>>& log() const { return log_; }
  void undo(std::size_t mark) {
    for (; log_.size() > mark; log_.pop_back()) put(log_.back().first, log_.back().second);
  }

  void write(Index word, Word content) {
    if (words_[word] == content) return;
    if (logging_) log_.emplace_back(word, words_[word]);
    put(word, content);
  }
  void write(Index word, Word mask, Word bits) { write(word, (words_[word] & ~mask) | bits); }

  /// An action's effect: the world changes, or an observation is made at run time.
  /// @return false if the observation contradicts what is known; the state is then meaningless.
  bool apply(const Change& change);

  /// Something about the world as it is becomes known: the outcome of sensing, or an initial fact.
  /// @return false if it contradicts what is known; the state is then meaningless.
  bool learn_atom(Index fluent, bool truth);
  bool learn_value(Index fluent, Index value);
  bool learn_not_value(Index fluent, Index value);
  bool learn_group(Index group);
  bool learn_options(Index fluent, const std::vector<Index>& options);

  [[nodiscard]] AtomKnowledge atom(Index fluent) const {
    return static_cast<AtomKnowledge>(layout_->fluents()[fluent].get(words_.data()));
  }
  [[nodiscard]] Word value(Index fluent) const {
    return layout_->fluents()[fluent].get(words_.data());
  }
  [[nodiscard]] bool excluded(Index fluent, Index value) const;
  /// Values the term may still have, as positions.
  [[nodiscard]] std::vector<Index> possible_values(Index fluent, std::size_t range_size) const;

 private:
  void put(Index word, Word content) {
    hash_ ^= word_hash(word, words_[word]) ^ word_hash(word, content);
    words_[word] = content;
  }
  void set(Index fluent, Word content) {
    const Fluent& f = layout_->fluents()[fluent];
    write(f.word, f.mask, content << f.shift);
  }
  void clear_exclusions(const Fluent& f) {
    for (Index i = 0; i < f.exclusion_words; ++i) write(f.exclusions + i, 0);
  }
  void drop_groups(const Fluent& f);
  void clear(const Group& group);
  bool propagate(std::vector<Index> groups);
  bool propagate(const Group& g, std::vector<Index>& next);

  const Layout* layout_;
  std::vector<Word> words_;
  std::uint64_t hash_;
  bool logging_ = false;
  std::vector<std::pair<Index, Word>> log_;
};

}  // namespace kaboum::plan
