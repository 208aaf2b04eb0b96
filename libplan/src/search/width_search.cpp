// Best-first width search [lipovetzky2017bfws], BFWS(f5): states come first that have a fact, then
// two facts, which no state before them had with as much left to do and as much of a relaxed plan
// done; of these, those with little left to do: goals, and landmarks of the first state that did
// not come true on the way. Relaxed plans are made only where less is left than before, so most
// states take a small part of the time that an estimate does.
#include <kaboum/base/error.h>

#include <algorithm>
#include <bit>
#include <deque>
#include <map>
#include <utility>

#include "search/applicable_steps.h"
#include "search/difference_store.h"
#include "search/engine.h"
#include "search/landmarks.h"
#include "search/novelty.h"
#include "search/relaxation.h"
#include "search/relaxed_plan.h"

namespace kaboum::plan {
namespace {

constexpr std::size_t kMostPairBytes = std::size_t{1} << 29U;
constexpr std::size_t kQueueBytes = 640;  // of a queue with nothing in it, about

/// Facts that say something: an atom is true, a term has a value. By number, and by the words of a
/// state.
class SaidFacts {
 public:
  SaidFacts(const Layout& layout, const Relaxation& relaxation, const Word* start)
      : layout_(layout), facts_(relaxation.facts()), number_(facts_.size(), kNone) {
    std::vector<char> reached(facts_.size(), 0);
    for (const auto& o : relaxation.operators())
      for (const FactId f : o.adds) reached[f] = 1;
    in_word_.resize(layout.words());
    for (FactId f = 0; f < facts_.size(); ++f) {
      const Index fluent = facts_.fluent_of(f);
      if (!says(f) || !(reached[f] || facts_.holds(f, start))) continue;
      number_[f] = count_++;
      std::vector<Index>& fluents = in_word_[layout.fluents()[fluent].word];
      if (fluents.empty() || fluents.back() != fluent) fluents.push_back(fluent);
    }
  }

  [[nodiscard]] Index count() const { return count_; }
  [[nodiscard]] Index number(FactId f) const { return number_[f]; }
  /// Calls visit(number) for those that hold, ascending as fluents are.
  template <class Visit>
  void each(const Word* state, Index word, const Visit& visit) const {
    for (const Index i : in_word_[word]) {
      const Index n = number_[facts_.fact(i, layout_.fluents()[i].get(state))];
      if (n != kNone) visit(n);
    }
  }

 private:
  [[nodiscard]] bool says(FactId f) const {
    const Word content = facts_.content_of(f);
    return layout_.fluents()[facts_.fluent_of(f)].function
               ? content >= kFirstValue
               : content == static_cast<Word>(AtomKnowledge::True);
  }

  const Layout& layout_;
  const FactTable& facts_;
  Index count_ = 0;
  std::vector<Index> number_;                ///< by fact
  std::vector<std::vector<Index>> in_word_;  ///< fluents
};

class WidthSearch final : public Engine {
 public:
  explicit WidthSearch(const SearchInput& in)
      : in_(in),
        relaxed_(in.heuristics.relaxed(in.task, in.limits)),
        facts_(in.heuristics.relaxation->facts()),
        said_(in.task.layout(), *in.heuristics.relaxation, in.start.data()),
        applicable_(in.heuristics.steps(in.task, in.limits)),
        goals_(in.heuristics.relaxation->necessary_facts(in.heuristics.goal)),
        brings_(in.task.action_count()),
        landmarks_of_(said_.count()),
        store_(in.start.data(), in.task.layout().words()),
        scratch_(in.task.layout()),
        novelty_(said_.count(), kMostPairBytes),
        is_here_(said_.count(), 0) {
    for (const auto& o : in.heuristics.relaxation->operators())
      for (const FactId f : o.adds)
        if (!in.task.is_outcome(o.step) && said_.number(f) != kNone)
          brings_[o.step].push_back(said_.number(f));
    scratch_.keep_log(true);
    find_landmarks(in.heuristics.landmark(in.task, in.limits));
    nodes_.push_back({open_goals(in.start.data()) + landmarks_});
    marks_.assign(landmark_words(), 0);
    least_left_ = nodes_[0].left;
    push(0, 1);
  }

  std::optional<SearchResult> advance(std::uint64_t work, std::size_t besides) override {
    turn_ = work;
    besides_ = besides;
    std::optional<SearchResult> found;
    for (pause_ = work_ + turn_; work_ < pause_ && !found;) {
      if (open_.empty()) return SearchResult{Outcome::Unsolvable, {}};
      if (out_of_limits()) return SearchResult{};
      const Index state = pop();
      if (nodes_[state].plan == kNone && !make_plan(state)) continue;
      found = expand(state);
    }
    in_.statistics.states = std::max<std::uint64_t>(in_.statistics.states, store_.size());
    in_.statistics.state_bytes = std::max<std::uint64_t>(in_.statistics.state_bytes, bytes());
    return found;
  }

  [[nodiscard]] std::size_t bytes() const override {
    return store_.bytes() + novelty_.bytes() + nodes_.size() * (sizeof(Node) + sizeof(Index)) +
           marks_.size() * sizeof(std::uint64_t) + plan_facts_ * sizeof(Index) +
           plans_.size() * sizeof(std::vector<Index>) + classes_.size() * kQueueBytes +
           open_.size() * kQueueBytes;
  }

 private:
  struct Node {
    std::uint32_t left = 0;  ///< goals that are open, landmarks that did not come true
    Index plan = kNone;      ///< the relaxed plan at hand; kNone: to be made
    std::uint32_t done = 0;  ///< of its facts, how many have come to hold since
    std::size_t marks = 0;   ///< in `marks_`: landmarks that came true, then facts of the plan
  };

  [[nodiscard]] std::size_t landmark_words() const { return (landmarks_ + 63) / 64; }

  void find_landmarks(LandmarkHeuristic& heuristic) {
    if (!heuristic.count(in_.start.data())) return;
    for (const std::vector<FactId>& facts : heuristic.landmarks()) {
      if (std::any_of(facts.begin(), facts.end(),
                      [&](FactId f) { return said_.number(f) == kNone; }))
        continue;
      for (const FactId f : facts) landmarks_of_[said_.number(f)].push_back(landmarks_);
      ++landmarks_;
    }
  }

  [[nodiscard]] std::uint32_t open_goals(const Word* state) const {
    return static_cast<std::uint32_t>(std::count_if(
        goals_.begin(), goals_.end(), [&](FactId g) { return !facts_.holds(g, state); }));
  }

  void push(Index state, int novelty) { open_[{novelty, nodes_[state].left}].push_back(state); }
  Index pop() {
    const auto best = open_.begin();
    const Index state = best->second.front();
    best->second.pop_front();
    if (best->second.empty()) open_.erase(best);
    return state;
  }

  /// @return false: a dead end.
  bool make_plan(Index state) {
    const Word* const words = store_.read(state);
    const bool dead = relaxed_.evaluate(words) == RelaxedPlan::kDeadEnd;
    work_ += kPerEdge * relaxed_.walked();
    if (dead) return false;
    list_present(words);
    std::vector<Index> facts;
    for (const OperatorId step : relaxed_.steps()) {
      if (in_.task.is_outcome(step)) continue;
      for (const Index f : brings_[step])
        if (!is_here_[f]) facts.push_back(f);
    }
    std::sort(facts.begin(), facts.end());
    facts.erase(std::unique(facts.begin(), facts.end()), facts.end());
    Node& node = nodes_[state];
    node.plan = static_cast<Index>(plans_.size());
    const std::size_t before = std::exchange(node.marks, marks_.size());
    for (std::size_t i = 0; i < landmark_words(); ++i) marks_.push_back(marks_[before + i]);
    marks_.resize(marks_.size() + (facts.size() + 63) / 64, 0);
    plan_facts_ += facts.size();
    plans_.push_back(std::move(facts));
    return true;
  }

  void list_present(const Word* state) {
    for (const Index f : present_) is_here_[f] = 0;
    present_.clear();
    for (Index w = 0; w < in_.task.layout().words(); ++w)
      said_.each(state, w, [&](Index f) { present_.push_back(f); });
    for (const Index f : present_) is_here_[f] = 1;
  }

  /// Looked at as often as some work takes. It ends without reason where memory is all that it
  /// lacks: other searches may go on.
  bool out_of_limits() {
    if (work_ < next_look_) return false;
    next_look_ = work_ + 1'000'000;
    const std::size_t held = bytes() + store_.growth() + novelty_.growth() + besides_;
    return !in_.limits.fits(held) || in_.limits.check(held);
  }

  /// @return how the search ends, if it does.
  std::optional<SearchResult> expand(Index state) {
    const Word* const words = store_.read(state);
    list_present(words);
    applicable_.find(words, steps_);
    scratch_.assign(words, store_.hash(state));
    ++in_.statistics.expanded;
    work_ += 2'000 + 2 * in_.task.layout().words() + 10 * present_.size();
    for (const OperatorId step : steps_) {
      if (out_of_limits()) return SearchResult{};
      scratch_.undo(0);
      if (!in_.task.apply(step, scratch_)) continue;
      work_ += kPerStep + goals_.size();
      ++in_.statistics.generated;
      const auto [number, fresh] = store_.insert(scratch_, state, step);
      if (!fresh) continue;
      if (in_.target.reached(scratch_.words())) {
        std::vector<OperatorId> path = store_.path(number);
        in_.statistics.depth = std::max<std::uint64_t>(in_.statistics.depth, path.size());
        return SearchResult{Outcome::Solved, std::move(path)};
      }
      evaluate(state, words);
    }
    return std::nullopt;
  }

  /// Lists facts that the successor at hand has besides its parent's, and all that it has.
  void list_changes(const Word* parent) {
    fresh_.clear();
    gone_.clear();
    changed_.clear();
    for (const auto& [word, before] : scratch_.log()) changed_.push_back(word);
    std::sort(changed_.begin(), changed_.end());
    changed_.erase(std::unique(changed_.begin(), changed_.end()), changed_.end());
    for (const Index word : changed_) {
      const auto before = static_cast<std::ptrdiff_t>(gone_.size());
      said_.each(parent, word, [&](Index f) { gone_.push_back(f); });
      said_.each(scratch_.words(), word, [&](Index f) {
        if (is_here_[f]) {
          gone_.erase(std::find(gone_.begin() + before, gone_.end(), f));
        } else {
          fresh_.push_back(f);
        }
      });
    }
    now_.clear();
    for (const Index f : gone_) is_here_[f] = 0;
    for (const Index f : present_)
      if (is_here_[f]) now_.push_back(f);
    for (const Index f : gone_) is_here_[f] = 1;
    now_.insert(now_.end(), fresh_.begin(), fresh_.end());
  }

  void evaluate(Index parent, const Word* words) {
    list_changes(words);
    const Node before = nodes_[parent];
    Node node{open_goals(scratch_.words()), before.plan, 0, marks_.size()};
    node.left += mark_landmarks(before, node);
    if (node.left < before.left) {
      node.plan = kNone;
    } else {
      node.done = mark_plan(before, node);
    }
    if (node.left < least_left_) {
      least_left_ = node.left;
      pause_ = work_ + turn_;  // as long as it leads nearer
    }
    const bool same = node.left == before.left && node.done == before.done;
    const std::vector<Index>& looked_at = same ? fresh_ : now_;
    const std::size_t pairs = looked_at.size() * now_.size();
    work_ += now_.size() + 30 * looked_at.size() + (pairs > Novelty::kMostPairs ? 0 : 8 * pairs);
    const auto [entry, added] =
        classes_.try_emplace({node.left, node.done}, static_cast<Index>(classes_.size()));
    const int novelty = novelty_.of(entry->second, looked_at, now_);
    nodes_.push_back(node);
    push(static_cast<Index>(nodes_.size() - 1), novelty);
  }

  void mark(std::size_t first, std::size_t bit) {
    marks_[first + bit / 64] |= std::uint64_t{1} << (bit % 64);
  }
  [[nodiscard]] std::uint32_t marked(std::size_t first, std::size_t words) const {
    std::uint32_t count = 0;
    for (std::size_t i = 0; i < words; ++i)
      count += static_cast<std::uint32_t>(std::popcount(marks_[first + i]));
    return count;
  }

  /// @return how many landmarks did not come true.
  std::uint32_t mark_landmarks(const Node& before, const Node& node) {
    for (std::size_t i = 0; i < landmark_words(); ++i) marks_.push_back(marks_[before.marks + i]);
    for (const Index f : fresh_)
      for (const Index landmark : landmarks_of_[f]) mark(node.marks, landmark);
    return landmarks_ - marked(node.marks, landmark_words());
  }

  /// @return how many of the relaxed plan's facts have come to hold.
  std::uint32_t mark_plan(const Node& before, const Node& node) {
    const std::vector<Index>& plan = plans_[before.plan];
    const std::size_t words = (plan.size() + 63) / 64, first = node.marks + landmark_words();
    for (std::size_t i = 0; i < words; ++i)
      marks_.push_back(marks_[before.marks + landmark_words() + i]);
    for (const Index f : fresh_) {
      const auto found = std::lower_bound(plan.begin(), plan.end(), f);
      if (found != plan.end() && *found == f)
        mark(first, static_cast<std::size_t>(found - plan.begin()));
    }
    return marked(first, words);
  }

  const SearchInput in_;
  RelaxedPlan& relaxed_;
  const FactTable& facts_;
  SaidFacts said_;
  ApplicableSteps& applicable_;
  std::vector<FactId> goals_;                     ///< that every goal state has
  std::vector<std::vector<Index>> brings_;        ///< facts, by step
  Index landmarks_ = 0;                           ///< their number
  std::vector<std::vector<Index>> landmarks_of_;  ///< by fact
  DifferenceStore store_;
  Knowledge scratch_;  ///< the successor at hand
  Novelty novelty_;
  std::uint64_t work_ = 0, pause_ = 0, turn_ = 0, next_look_ = 0;
  std::size_t besides_ = 0;
  std::size_t plan_facts_ = 0;  ///< of all plans
  std::uint32_t least_left_ = 0;
  std::deque<Node> nodes_;  ///< by state
  std::vector<std::vector<Index>> plans_;
  std::deque<std::uint64_t> marks_;
  std::map<std::pair<std::uint32_t, std::uint32_t>, Index> classes_;  ///< by left, done
  std::map<std::pair<int, std::uint32_t>, std::deque<Index>> open_;   ///< by novelty, left
  std::vector<OperatorId> steps_;
  std::vector<char> is_here_;                        ///< by fact: in present_
  std::vector<Index> present_;                       ///< facts of the state that is expanded
  std::vector<Index> changed_, fresh_, gone_, now_;  ///< of the successor at hand
};

}  // namespace

std::unique_ptr<Engine> width_engine(const SearchInput& in) {
  return std::make_unique<WidthSearch>(in);
}

}  // namespace kaboum::plan
