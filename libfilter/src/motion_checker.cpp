// Motions one by one: the stretches of one fill the lanes. docs/algorithms/batches.md, "One by
// one".

#include <kaboum/base/error.h>
#include <kaboum/filter/motion_checker.h>
#include <kaboum/world/stretch_check.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "batch_impl.h"
#include "lanes.h"

namespace kaboum::filter {
namespace {

/// Stretches that a motion is looked at in at first: as many as the widest vectors have lanes.
constexpr std::size_t kFirst = 16;
constexpr std::size_t kParts = 4;             ///< that an open stretch is cut into
constexpr std::size_t kMostStretches = 1024;  ///< at a time; a motion with more is open
constexpr std::size_t kMostSuspects = 4;      ///< asked about exactly at a time
constexpr double kFine = 0.004;  ///< of the robot's size: moves that are not cut further

}  // namespace

struct MotionChecker::Impl {
  explicit Impl(const BatchChecker::Impl& of) : batch(of), memory(of.model) {}

  /// How far points move in half of the motion, about.
  [[nodiscard]] double move_of(std::span<const double> from, std::span<const double> to) const {
    double sum = 0;
    for (std::size_t k = 0; k < from.size(); ++k)
      sum += std::abs(to[k] - from[k]) * batch.model.levers[k];
    return 0.5 * sum;
  }

  /// Looks at the stretches, or at their middles alone.
  /// @param told  is told of pairs; or null
  bool finds_contact(std::span<const double> from, std::span<const double> to, float slack,
                     detail::Look look, detail::OpenPairs* told) {
    const std::size_t n = batch.model.variables;
    rows.resize(detail::blocks_size(shares.size(), n));
    ways.resize(rows.size());
    std::array<detail::Share, detail::kBlock> block;
    for (std::size_t first = 0; first < shares.size(); first += detail::kBlock) {
      for (std::size_t i = 0; i < detail::kBlock; ++i)
        block[i] = shares[std::min(first + i, shares.size() - 1)];
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t at = detail::place_of(first, k, n);
        for (std::size_t i = 0; i < detail::kBlock; ++i)
          detail::put_stretch(block[i], from[k], to[k], rows[at + i], ways[at + i]);
      }
    }
    answers.resize(shares.size());
    stretches += shares.size();
    suspects.assign(shares.size(), {});
    detail::filter_blocks(batch.model, batch.instructions, rows.data(),
                          look == detail::Look::Contacts ? nullptr : ways.data(), shares.size(),
                          memory, answers.data(), slack, look, told,
                          look == detail::Look::Contacts ? nullptr : suspects.data());
    return std::ranges::find(answers, Answer::Contact) != answers.end();
  }

  /// True if sets meet at the middle of an open stretch: those are looked at that are suspected of
  /// it, and a few others.
  bool has_met() {
    for (const bool unparted : {true, false}) {
      const auto is_one = [&](std::size_t i) {
        return answers[i] == Answer::Open && suspects[i].pair != detail::Suspect::kNone &&
               suspects[i].unparted == unparted;
      };
      std::size_t count = 0;
      for (std::size_t i = 0; i < answers.size(); ++i) count += is_one(i) ? 1 : 0;
      const std::size_t every = (count + kMostSuspects - 1) / kMostSuspects;
      std::size_t number = 0;
      for (std::size_t i = 0; i < answers.size(); ++i)
        if (is_one(i) && number++ % every == every / 2 && meets(i)) return true;
    }
    return false;
  }

  /// True if the suspected pair meets at the middle of a stretch.
  bool meets(std::size_t stretch) {
    const std::size_t n = batch.model.variables;
    if (!there) there = batch.state;
    std::vector<double>& q = there->q[batch.robot];
    for (std::size_t k = 0; k < n; ++k) q[k] = rows[detail::place_of(stretch, k, n)];
    return !batch.checker->are_apart(*there, {&batch.model.items[suspects[stretch].pair], 1},
                                     scratch);
  }

  const BatchChecker::Impl& batch;
  detail::LaneMemory memory;
  std::vector<detail::Suspect> suspects;
  std::optional<world::WorldState> there;  ///< of what is asked exactly
  std::vector<double> rows, ways;
  std::vector<detail::Share> shares, next;
  std::vector<Answer> answers;
  /// Notes stretches that stay open, and for which pairs.
  void leave_open(const detail::OpenPairs& told) {
    std::vector<std::uint32_t> numbers;
    bool any_pair = false;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      if (answers[i] != Answer::Open) continue;
      open.push_back({shares[i].begin, shares[i].end});
      const auto some = told.of(i);
      any_pair = any_pair || !some;
      if (some) numbers.insert(numbers.end(), some->begin(), some->end());
    }
    if (any_pair) return;
    std::ranges::sort(numbers);
    numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
    for (const std::uint32_t k : numbers) pairs.push_back(batch.model.items[k]);
  }

  std::vector<std::array<double, 2>> open;
  std::vector<std::array<world::Item, 2>> pairs;  ///< that these are open for; none: any
  std::vector<double> asked_from, asked_to;       ///< of the last motion
  double asked_resolution = 0;
  std::optional<world::StretchChecker> exactly;
  world::Scratch scratch;
  robot::Path path{{}, {}};
  std::size_t stretches = 0, exact = 0;
};

MotionChecker::MotionChecker(const BatchChecker& batch)
    : impl_(std::make_unique<Impl>(*batch.impl_)) {}
MotionChecker::~MotionChecker() = default;
MotionChecker::MotionChecker(MotionChecker&&) noexcept = default;
MotionChecker& MotionChecker::operator=(MotionChecker&&) noexcept = default;

std::size_t MotionChecker::stretches() const { return impl_->stretches; }
std::size_t MotionChecker::exact() const { return impl_->exact; }
std::span<const std::array<double, 2>> MotionChecker::open() const { return impl_->open; }
std::span<const std::array<world::Item, 2>> MotionChecker::open_pairs() const {
  return impl_->pairs;
}

MotionChecker::Answer MotionChecker::filter(std::span<const double> from,
                                            std::span<const double> to, double resolution) {
  Impl& s = *impl_;
  s.open.clear();
  s.pairs.clear();
  s.asked_from.assign(from.begin(), from.end());
  s.asked_to.assign(to.begin(), to.end());
  s.asked_resolution = resolution;
  const detail::Model& model = s.batch.model;
  if (!detail::decides_motions(model, resolution) || !detail::is_within(model, from) ||
      !detail::is_within(model, to))
    return Answer::Open;
  const float slack = detail::slack_of(resolution, model.size);
  const double fine = kFine * model.size;
  double move = s.move_of(from, to);  // in half of a stretch
  std::size_t parts = 1;
  while (parts < kFirst && move > fine) {
    parts *= 2;
    move /= 2;
  }
  s.shares.assign(1, {});
  for (bool first = true;; first = false) {
    s.next.clear();
    const auto share = 1 / static_cast<double>(parts);
    for (const detail::Share& whole : s.shares) {
      // Halves of halves: the ends are those of check_motion's stretches, without rounding.
      const double length = (whole.end - whole.begin) * share;
      for (std::size_t i = 0; i < parts; ++i)
        s.next.push_back({whole.begin + static_cast<double>(i) * length,
                          whole.begin + static_cast<double>(i + 1) * length});
    }
    std::swap(s.shares, s.next);
    if (s.shares.size() > kMostStretches) return Answer::Open;
    // Most motions that are not free are found in contact at first sight.
    if (first && s.finds_contact(from, to, slack, detail::Look::Contacts, nullptr))
      return Answer::Contact;
    const bool last = move <= fine;
    detail::OpenPairs told(last ? s.shares.size() : 0);
    if (s.finds_contact(from, to, slack, first && !last ? detail::Look::Apart : detail::Look::One,
                        last ? &told : nullptr))
      return Answer::Contact;
    if (s.has_met()) return Answer::Contact;
    if (last) {
      s.leave_open(told);
      return s.open.empty() ? Answer::Free : Answer::Open;
    }
    s.next.clear();
    for (std::size_t i = 0; i < s.shares.size(); ++i)
      if (s.answers[i] == Answer::Open) s.next.push_back(s.shares[i]);
    if (s.next.empty()) return Answer::Free;
    std::swap(s.shares, s.next);
    parts = kParts;
    move /= kParts;
  }
}

bool MotionChecker::are_open_free(std::span<const double> from, std::span<const double> to,
                                  const world::MotionOptions& options, std::size_t& intervals) {
  Impl& s = *impl_;
  if (!std::ranges::equal(from, s.asked_from) || !std::ranges::equal(to, s.asked_to) ||
      options.resolution != s.asked_resolution)
    throw Error(ErrorCode::InvalidArgument, "open stretches of another motion than the last one");
  if (s.open.empty() || !options.around.empty()) return false;
  ++s.exact;
  if (!s.exactly) s.exactly.emplace(*s.batch.checker, s.batch.state, s.batch.robot);
  const auto answer = s.exactly->is_apart(from, to, s.open,
                                          detail::slack_of(options.resolution, s.batch.model.size),
                                          options.most_intervals, s.pairs);
  intervals += answer.intervals;
  return answer.apart;
}

bool MotionChecker::is_free(std::span<const double> from, std::span<const double> to,
                            const world::MotionOptions& options) {
  // Vector code knows nothing of room about a motion.
  if (options.around.empty()) {
    const Answer answer = filter(from, to, options.resolution);
    if (answer != Answer::Open) return answer == Answer::Free;
  }
  Impl& s = *impl_;
  ++s.exact;
  s.path[0].assign(from.begin(), from.end());
  s.path[1].assign(to.begin(), to.end());
  world::MotionOptions exact = options;
  exact.where = false;
  exact.progress = {};
  exact.scratch = &s.scratch;
  return check_motion(*s.batch.checker, s.batch.state, s.batch.robot, s.path, exact).outcome ==
         world::MotionAnswer::Outcome::Free;
}

}  // namespace kaboum::filter
