#pragma once

#include <kaboum/plan/model.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "task/layout.h"
#include "task/solve_limits.h"

namespace kaboum::plan {

/// An argument of an external function, once ground: an object; or, evaluated in each state, the
/// value of a fluent or of another call; or kNone: the value of a term that is never known. Objects
/// and handles have numbers below these bits.
inline constexpr Index kTermOperand = Index{1} << 30U;  ///< or'ed with a fluent
inline constexpr Index kCallOperand = Index{1} << 31U;  ///< or'ed with a call
inline bool is_call(Index operand) { return operand != kNone && (operand & kCallOperand) != 0; }
inline bool is_term(Index operand) {
  return (operand & kCallOperand) == 0 && (operand & kTermOperand) != 0;
}

/// Calls of external functions, each made once for each footprint: what it reads of a state.
///
/// A function that is asked again about a state that agrees on what it read must read the same, so
/// the answers to a call are the leaves of a tree: each inner node is what is read next (a fluent,
/// or an argument's value), each edge a content. All edges are in one flat table.
class ExternalCalls {
 public:
  /// @pre all arguments outlive the calls.
  ExternalCalls(const Model& model, const Layout& layout, Limits& limits);

  /// The call of these arguments; equal ones are one.
  Index call(Index external, std::vector<Index> operands);

  struct Reply {
    enum class Kind : std::uint8_t {
      Value,
      None,      ///< false, or no value; also where an argument is not known
      NotFound,  ///< so far
      Open       ///< it depends on a sensed value
    };
    Kind kind = Kind::None;
    Index value = 0;                ///< an object or handle; of a truth value 0
    Index fluent = 0;               ///< of Open: the sensed one
    Index leaf = kNone;             ///< of Value and NotFound
    bool unknown_argument = false;  ///< of None: it was not called, for want of a known argument
  };
  /// @throws Error{InvalidInput} naming function and state if the function fails or contradicts
  ///         itself; LimitExceeded.
  Reply evaluate(Index call, const Word* state);

  /// Fluents that the answer in this state rests on are added to `fluents`.
  void footprint(Index call, const Word* state, std::vector<Index>& fluents);
  /// Whether the answer can differ between states.
  [[nodiscard]] bool depends_on_state(Index call) const { return calls_[call].depends; }
  /// Whether it is never made, for want of an argument that is ever known.
  [[nodiscard]] bool is_never_known(Index call) const { return calls_[call].never_known; }
  [[nodiscard]] Index external(Index call) const { return calls_[call].external; }

  [[nodiscard]] const HandleTable& handles() const { return handles_; }
  [[nodiscard]] const std::string& payload(Index leaf) const;
  /// The arguments of a call in a state, as names.
  std::vector<std::string> argument_names(Index call, const Word* state);

  /// From now on calls that found nothing are made once more. @pre something was not found.
  void try_again() {
    ++attempts_;
    missed_ = kNone;
  }
  [[nodiscard]] unsigned attempts() const { return attempts_; }
  /// The last call that found nothing since `try_again`, as "g(a): reason"; empty: there is none.
  [[nodiscard]] std::string missed() const;

  /// Makes some calls again. @throws Error{InvalidInput} if one answers differently.
  void confirm();

  [[nodiscard]] std::uint64_t calls_made() const { return made_; }
  [[nodiscard]] double seconds() const { return seconds_; }
  [[nodiscard]] std::size_t bytes() const;
  void seed(std::uint64_t seed) { seed_ = seed; }

 private:
  class Reading;

  struct Call {
    Index external = 0;
    std::vector<Index> operands;
    Index root = kNone;  ///< node, or leaf with kLeaf
    Index last = kNone;  ///< the leaf that it was given last
    bool depends = false;
    bool never_known = false;
  };
  struct Leaf {
    Index value = 0;
    Index text = kNone;          ///< payload or reason
    std::uint16_t attempts = 0;  ///< made so far
    Answer::Kind kind = Answer::Kind::Impossible;
    [[nodiscard]] bool operator==(const Leaf&) const = default;
  };
  struct Edge {
    Index node = kNone;
    Index content = 0;
    Index child = 0;
  };
  /// What was read, in order: fluents and their contents, or calls and their values.
  using Path = std::vector<std::pair<Index, Index>>;
  /// An answer that `confirm` can ask for again.
  struct Sample {
    Index call;
    std::vector<Index> arguments;
    Path path;
    Index leaf;
  };
  static constexpr Index kLeaf = Index{1} << 31U;

  /// Content of a fluent or value of a call; false: `reply` says why there is none.
  bool content(Index item, const Word* state, Index& content, Reply& reply);
  /// Objects for the operands; what is read for them goes to `path`.
  bool arguments(const Call& c, const Word* state, std::vector<Index>& objects, Path& path,
                 Reply& reply);
  Reply make(Index call, const Word* state, unsigned first_attempt);
  ExternalResult run(const Call& c, const std::vector<Index>& objects, Reading& reading,
                     unsigned attempt);
  Index insert(Index call, const Path& path, const std::vector<Index>& arguments, Leaf leaf);
  Index* edge(Index node, Index content);
  void add_edge(Index node, Index content, Index child);
  [[nodiscard]] std::size_t slot(Index node, Index content) const;
  Reply reply(Index leaf) const;
  Index text(std::string text);
  [[nodiscard]] std::string call_text(const Call& c, const std::vector<Index>& objects) const;
  [[nodiscard]] std::string state_text(const Path& path) const;

  const Model& model_;
  const Layout& layout_;
  Limits& limits_;
  HandleTable handles_;
  std::vector<Call> calls_;
  std::map<std::pair<Index, std::vector<Index>>, Index> call_index_;
  std::vector<Index> nodes_;  ///< what each reads
  std::vector<Edge> edges_;   ///< open addressing
  std::size_t edge_count_ = 0;
  std::vector<Leaf> leaves_;
  std::vector<std::string> texts_;
  std::vector<Sample> samples_;
  std::vector<std::uint8_t> sampled_;  ///< by external
  std::uint64_t seed_ = 0;
  unsigned attempts_ = 1;
  Index missed_ = kNone;  ///< a leaf
  std::string missed_call_;
  std::size_t bytes_told_ = 0;
  std::uint64_t made_ = 0;
  double seconds_ = 0;
};

}  // namespace kaboum::plan
