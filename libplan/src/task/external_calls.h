#pragma once

#include <kaboum/plan/model.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "search/choices.h"
#include "task/answer_tree.h"
#include "task/layout.h"
#include "task/solve_limits.h"

namespace kaboum::plan {

/// Calls of external functions, each made once for each footprint: what it reads of a state. Those
/// that found nothing are made again when it is their turn.
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

  /// Asks functions that refuse early, as long as they read nothing but what their arguments name.
  void ask_early(Index call, const Word* state);

  /// What is known of a call's answers: a node of `answers()`.
  [[nodiscard]] Index answers_of(Index call) const { return calls_[call].answers.node; }
  [[nodiscard]] const AnswerTree& answers() const { return answers_; }

  /// Fluents that the answer in this state rests on are added to `fluents`.
  void footprint(Index call, const Word* state, std::vector<Index>& fluents);
  /// Whether the answer can differ between states.
  [[nodiscard]] bool depends_on_state(Index call) const { return calls_[call].depends; }
  /// Whether it is never made, for want of an argument that is ever known.
  [[nodiscard]] bool is_never_known(Index call) const { return calls_[call].never_known; }
  [[nodiscard]] Index external(Index call) const { return calls_[call].external; }

  [[nodiscard]] const HandleTable& handles() const { return handles_; }
  [[nodiscard]] const std::string& payload(Index leaf) const { return answers_.payload(leaf); }
  [[nodiscard]] std::size_t size() const { return calls_.size(); }
  /// "g(a, b)"; empty: some argument is read from the state.
  [[nodiscard]] std::string constant_text(Index call) const;
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
  /// A call whose value was chosen among several, when a failure may be due to that choice: some
  /// final answer rests on it. Empty: there is none.
  [[nodiscard]] std::string chosen() const;
  /// A call that was impossible by what is listed only, as "g(a): reason"; empty: there is none.
  [[nodiscard]] const std::string& listed() const { return listed_; }
  /// The first call that was impossible, as "g(a): reason", and how many others were; empty: none
  /// gave a reason.
  [[nodiscard]] std::string refused() const;

  /// While it lives, what is not found is not missed: it is asked of what is supposed only, and
  /// is missed when it is asked again of a state that there is.
  class Supposing {
   public:
    explicit Supposing(ExternalCalls& calls)
        : calls_(calls), missed_(calls.missed_), missed_call_(calls.missed_call_) {}
    ~Supposing() {
      calls_.missed_ = missed_;
      calls_.missed_call_ = std::move(missed_call_);
    }
    Supposing(const Supposing&) = delete;
    Supposing& operator=(const Supposing&) = delete;

   private:
    ExternalCalls& calls_;
    Index missed_;
    std::string missed_call_;
  };

  /// Makes some calls again. @throws Error{InvalidInput} if one answers differently.
  void confirm();

  [[nodiscard]] std::uint64_t calls_made() const { return made_; }
  [[nodiscard]] double seconds() const { return seconds_; }
  /// Of handles and answers; what is noted about their origins is left out.
  [[nodiscard]] std::size_t bytes() const { return handles_.bytes() + answers_.bytes(); }
  void seed(std::uint64_t seed, Choices choices) {
    seed_ = seed;
    choices_ = std::move(choices);
  }
  /// From now on searches pause (`Limits::paused`) where so many calls one after the other had no
  /// value, or had one before, while some that never had one rest on choices. 0: never.
  void pause_after(std::uint64_t calls_in_vain) { pause_after_ = calls_in_vain; }
  /// Whether it is so now.
  [[nodiscard]] bool is_in_vain() const;
  /// Calls that had no value so far, by failures that rest on choices.
  [[nodiscard]] std::vector<Index> failed_by_choice() const;
  /// Calls that chose among several things, and how much failed that rests on it.
  /// @param needed  failed calls without a value of which there is no plan.
  [[nodiscard]] ChoosingCalls choosing_calls(const std::vector<Index>& needed) const;

 private:
  struct Call {
    Index external = 0;
    std::vector<Index> operands;
    AnswerTree::Root answers;
    bool depends = false;
    bool never_known = false;
    bool had_value = false;
    bool failed_by_choice = false;  ///< as far as it was known when it failed
  };
  /// An answer that `confirm` can ask for again.
  struct Sample {
    Index call;
    std::vector<Index> arguments;
    Footprint path;
    Index leaf;
  };

  /// Content of a fluent or value of a call; false: `reply` says why there is none.
  bool content(Index item, const Word* state, Index& content, Reply& reply);
  /// Objects for the operands; what is read for them goes to `path`.
  bool arguments(const Call& c, const Word* state, std::vector<Index>& objects, Footprint& path,
                 Reply& reply);
  Reply make(Index call, const Word* state, unsigned first_attempt);
  ExternalResult run(const Call& c, const std::vector<Index>& objects, StateReader& reader,
                     unsigned attempt);
  Index keep(Index call, const Footprint& path, const std::vector<Index>& arguments,
             const AnswerTree::Leaf& leaf);
  [[nodiscard]] unsigned choice_of(const std::string& call) const;
  /// All that a handle rests on.
  [[nodiscard]] std::set<Index> choosing_calls_of(Index handle) const;
  /// Notes which calls choose, and which of their values an answer rests on.
  void blame(Index call, const std::vector<Index>& objects, const std::vector<Index>& read,
             const ExternalResult& result, bool handle);
  /// So many nodes of trees were added to what is noted.
  void count_noted(std::size_t nodes);
  /// Notes what rests on what was chosen.
  void note(Index call, const std::vector<Index>& objects, const Footprint& path,
            const ExternalResult& result, bool fresh);
  [[nodiscard]] Reply reply(Index leaf) const;
  static Reply open(Index fluent) { return {Reply::Kind::Open, 0, fluent}; }
  [[nodiscard]] std::string text(const Call& c, const std::vector<Index>& objects) const;

  const Model& model_;
  const Layout& layout_;
  Limits& limits_;
  HandleTable handles_;
  std::vector<Call> calls_;
  std::map<std::pair<Index, std::vector<Index>>, Index> call_index_;
  AnswerTree answers_;
  std::vector<Sample> samples_;
  std::vector<std::uint8_t> sampled_;  ///< by external
  std::uint64_t seed_ = 0;
  unsigned attempts_ = 1;
  Choices choices_;
  std::vector<std::pair<std::string, ChoosingCall>> choosing_;
  std::map<std::string, Index> choosing_index_;
  /// What handles are of: the calls that chose them, and other handles that were read for them. One
  /// handle may come of several calls, also after something has failed by it.
  struct Origin {
    std::set<Index> choosing, read;
  };
  std::map<Index, Origin> origins_;
  std::set<Index> rest_on_choice_;  ///< handles, as far as it was known when they were made
  /// By what failures read, which calls failed so, and how often.
  std::map<Index, std::map<Index, std::uint64_t>> failures_;
  std::map<Index, std::map<Index, std::uint64_t>> failures_of_own_choice_;  ///< by choosing call
  std::uint64_t pause_after_ = 0, in_vain_ = 0;
  std::size_t failed_ = 0;  ///< calls that had no value so far, by choices
  bool early_ = false;      ///< functions are stopped where they read what no argument names
  Index missed_ = kNone;    ///< a leaf
  std::string missed_call_;
  std::map<Index, std::string> chosen_;  ///< handles that rest on a choice, and whose value it was
  std::set<Index> final_;                ///< handles that final answers rest on
  std::set<Index> chosen_types_;
  std::string any_choice_;  ///< a choice that anything may rest on
  std::string refused_, listed_;
  std::size_t refusals_ = 0;
  std::size_t noted_bytes_ = 0;  ///< of what is noted about origins, choices and failures
  std::size_t bytes_told_ = 0;
  std::uint64_t made_ = 0;
  double seconds_ = 0;
};

}  // namespace kaboum::plan
