// Configurations by the million: the vector code first, the checker where it leaves one open.

#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/base/processor.h>
#include <kaboum/filter/batch_checker.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "batch_impl.h"
#include "lanes.h"
#include "row_order.h"

namespace kaboum::filter {

std::vector<Instructions> instruction_sets() {
  std::vector<Instructions> out{Instructions::Baseline};
#ifdef KABOUM_AVX2
  if (has_avx2()) out.push_back(Instructions::Avx2);
  if (has_avx2() && __builtin_cpu_supports("avx512f") != 0 &&
      __builtin_cpu_supports("avx512dq") != 0)
    out.push_back(Instructions::Avx512);
#endif
  return out;
}

const char* name_of(Instructions set) {
  return set == Instructions::Avx512 ? "AVX-512" : set == Instructions::Avx2 ? "AVX2" : "baseline";
}

BatchCounts& BatchCounts::operator+=(const BatchCounts& other) {
  free += other.free;
  contact += other.contact;
  exactly += other.exactly;
  return *this;
}

BatchChecker::BatchChecker(const world::Checker& checker, world::WorldState state,
                           std::size_t robot, const Options& options) {
  if (robot >= checker.world().robots.size())
    throw Error(ErrorCode::InvalidArgument, "no such robot");
  const std::vector<Instructions> sets = instruction_sets();
  if (std::ranges::find(sets, options.instructions) == sets.end())
    throw Error(ErrorCode::InvalidArgument, "instructions that the processor lacks");
  world::Scratch scratch;
  static_cast<void>(checker.places(state, {}, scratch));  // throws where the state does not fit
  detail::Model model = detail::make_model(checker, state, robot, options.most_balls);
  impl_ = std::make_unique<Impl>(
      Impl{&checker, std::move(state), robot, options.instructions, std::move(model)});
}
BatchChecker::~BatchChecker() = default;
BatchChecker::BatchChecker(BatchChecker&&) noexcept = default;
BatchChecker& BatchChecker::operator=(BatchChecker&&) noexcept = default;

std::size_t BatchChecker::variables() const { return impl_->model.variables; }
bool BatchChecker::decides() const { return !impl_->model.unusable && impl_->model.variables > 0; }
std::size_t BatchChecker::balls() const { return impl_->model.outer.size(); }

void BatchChecker::filter(std::span<const double> rows, std::span<Answer> answers) const {
  impl_->filter(rows, answers, nullptr);
}

void BatchChecker::Impl::filter(std::span<const double> rows, std::span<Answer> answers,
                                detail::OpenPairs* pairs) const {
  if (rows.size() != answers.size() * model.variables)
    throw Error(ErrorCode::InvalidArgument,
                "rows of " + std::to_string(model.variables) + " values are expected");
  if (model.unusable || model.variables == 0) {
    std::ranges::fill(answers, Answer::Open);
    return;
  }
  if (model.always_contact) {
    std::ranges::fill(answers, Answer::Contact);
    return;
  }
  detail::LaneMemory memory(model);
  const std::vector<double> blocks =
      detail::in_blocks(rows.data(), answers.size(), model.variables);
  detail::filter_blocks(model, instructions, blocks.data(), nullptr, answers.size(), memory,
                        answers.data(), 0, detail::Look::All, pairs);
}

namespace {

/// @throws Error{InvalidArgument} unless these are so many rows of finite values
void require_rows(std::span<const double> rows, std::size_t count, std::size_t variables) {
  if (rows.size() != count * variables)
    throw Error(ErrorCode::InvalidArgument,
                "rows of " + std::to_string(variables) + " values are expected");
  if (!std::ranges::all_of(rows, [](double x) { return std::isfinite(x); }))
    throw Error(ErrorCode::InvalidArgument, "a value that is not finite");
}

/// Decides `free` part by part, by threads.
/// @param make_worker  makes what a thread works with: `filter(first, answers)` answers for as many
///   as there is room for, in an order of its own: `place(k)` is the place of answer k;
///   `is_free(k)` decides what is open
template <class MakeWorker>
BatchCounts decide_by_parts(std::span<std::uint8_t> free, std::size_t part_size,
                            const std::function<void()>& progress, const MakeWorker& make_worker) {
  using Answer = BatchChecker::Answer;
  BatchCounts out;
  std::mutex mutex;
  parallel_ranges((free.size() + part_size - 1) / part_size, {},
                  [&](std::size_t begin, std::size_t end) {
                    auto worker = make_worker();
                    std::vector<Answer> answers;
                    BatchCounts counts;
                    for (std::size_t part = begin; part < end; ++part) {
                      const std::size_t first = part * part_size;
                      answers.resize(std::min(part_size, free.size() - first));
                      worker.filter(first, answers);
                      for (std::size_t k = 0; k < answers.size(); ++k) {
                        bool is_free = answers[k] == Answer::Free;
                        if (answers[k] == Answer::Open) {
                          is_free = worker.is_free(k);
                          ++counts.exactly;
                        }
                        ++(is_free ? counts.free : counts.contact);
                        free[worker.place(k)] = is_free ? 1 : 0;
                      }
                      if (progress) {
                        const std::scoped_lock lock(mutex);
                        progress();
                      }
                    }
                    const std::scoped_lock lock(mutex);
                    out += counts;
                  });
  return out;
}

}  // namespace

/// What a thread decides rows with.
class BatchChecker::RowWorker {
 public:
  RowWorker(const Impl& impl, std::span<const double> rows)
      : impl_(impl), all_(rows), state_(impl.state) {}

  void filter(std::size_t first, std::span<Answer> answers) {
    const std::size_t n = impl_.model.variables;
    first_ = first;
    rows_ = all_.subspan(first * n, answers.size() * n);
    order_ = detail::order_of(impl_.model, rows_);
    if (!order_.empty()) {
      ordered_.clear();
      for (const std::uint32_t i : order_) {
        const auto row = rows_.subspan(i * n, n);
        ordered_.insert(ordered_.end(), row.begin(), row.end());
      }
      rows_ = ordered_;
    }
    pairs_ = detail::OpenPairs(answers.size());
    impl_.filter(rows_, answers, &pairs_);
  }

  [[nodiscard]] std::size_t place(std::size_t k) const {
    return first_ + (order_.empty() ? k : order_[k]);
  }

  bool is_free(std::size_t k) {
    const std::size_t n = impl_.model.variables;
    const auto row = rows_.subspan(k * n, n);
    state_.q[impl_.robot].assign(row.begin(), row.end());
    const auto left = pairs_.of(k);
    if (!left) return impl_.checker->is_free(state_, scratch_);
    open_.clear();
    for (const std::uint32_t i : *left) open_.push_back(impl_.model.items[i]);
    return impl_.checker->are_apart(state_, open_, scratch_);
  }

 private:
  const Impl& impl_;
  std::span<const double> all_;
  world::WorldState state_;
  world::Scratch scratch_;
  std::size_t first_ = 0;         ///< of the rows that were filtered last
  std::span<const double> rows_;  ///< these, in their order
  std::vector<std::uint32_t> order_;
  std::vector<double> ordered_;
  detail::OpenPairs pairs_{0};
  std::vector<std::array<world::Item, 2>> open_;
};

BatchCounts BatchChecker::decide(std::span<const double> rows, std::span<std::uint8_t> free,
                                 const std::function<void()>& progress) const {
  constexpr std::size_t kPart = 4096;
  require_rows(rows, free.size(), variables());
  return decide_by_parts(free, kPart, progress, [&] { return RowWorker(*impl_, rows); });
}

namespace {

/// A part of one of several motions.
struct Stretch : detail::Share {
  std::size_t motion = 0;
};

/// Motions that are looked at at once.
class MotionBatch {
 public:
  using Answer = BatchChecker::Answer;

  /// @param slack  as of detail::filter_rows
  MotionBatch(const detail::Model& model, Instructions set, const double* from, const double* to,
              std::size_t count, float slack)
      : model_(model),
        set_(set),
        from_(from),
        to_(to),
        slack_(slack),
        result_(count, Answer::Free),
        memory_(model) {
    for (std::size_t i = 0; i < count; ++i) stretches_.push_back({{}, i});
  }

  /// Halves stretches until they are free, in contact, or too short for that. @return of each
  /// motion what is known: free where all stretches are, in contact where one is
  const std::vector<Answer>& run() {
    while (!stretches_.empty()) {
      look();
      std::vector<Stretch> next;
      for (std::size_t i = 0; i < stretches_.size(); ++i) {
        const Stretch& s = stretches_[i];
        Answer& result = result_[s.motion];
        if (answers_[i] == Answer::Contact) result = Answer::Contact;
        if (answers_[i] != Answer::Open) continue;
        if (move_of(s) <= kFine * model_.size) {
          if (result == Answer::Free) result = Answer::Open;
          continue;
        }
        const double middle = 0.5 * (s.begin + s.end);
        next.push_back({{s.begin, middle}, s.motion});
        next.push_back({{middle, s.end}, s.motion});
      }
      stretches_ = std::move(next);
      leave_long_motions();
      std::erase_if(stretches_,
                    [&](const Stretch& s) { return result_[s.motion] == Answer::Contact; });
    }
    return result_;
  }

 private:
  static constexpr double kFine = 0.004;  ///< of the robot's size: moves that are not halved
  /// Stretches of a motion at a time; one with more is open, which bounds the memory.
  static constexpr std::size_t kMostStretches = 1024;

  void leave_long_motions() {
    std::vector<std::size_t> counts(result_.size(), 0);
    for (const Stretch& s : stretches_) ++counts[s.motion];
    for (std::size_t i = 0; i < counts.size(); ++i)
      if (counts[i] > kMostStretches && result_[i] == Answer::Free) result_[i] = Answer::Open;
    std::erase_if(stretches_, [&](const Stretch& s) { return counts[s.motion] > kMostStretches; });
  }

  /// How far points move in half of a stretch, about.
  [[nodiscard]] double move_of(const Stretch& s) const {
    double sum = 0;
    for (std::size_t k = 0; k < model_.variables; ++k)
      sum +=
          std::abs(to_[s.motion * model_.variables + k] - from_[s.motion * model_.variables + k]) *
          model_.levers[k];
    return 0.5 * (s.end - s.begin) * sum;
  }

  void look() {
    const std::size_t n = model_.variables;
    rows_.resize(detail::blocks_size(stretches_.size(), n));
    ways_.resize(rows_.size());
    for (std::size_t i = 0; i < rows_.size() / n; ++i) {
      const Stretch& s = stretches_[std::min(i, stretches_.size() - 1)];
      for (std::size_t k = 0; k < n; ++k) {
        const std::size_t at = detail::place_of(i, k, n);
        detail::put_stretch(s, from_[s.motion * n + k], to_[s.motion * n + k], rows_[at],
                            ways_[at]);
      }
    }
    answers_.resize(stretches_.size());
    detail::filter_blocks(model_, set_, rows_.data(), ways_.data(), answers_.size(), memory_,
                          answers_.data(), slack_);
  }

  const detail::Model& model_;
  Instructions set_;
  const double *from_, *to_;
  float slack_;
  std::vector<Answer> result_;
  std::vector<Stretch> stretches_;
  std::vector<double> rows_, ways_;
  std::vector<Answer> answers_;
  detail::LaneMemory memory_;
};

}  // namespace

BatchCounts BatchChecker::decide_motions(std::span<const double> from, std::span<const double> to,
                                         std::span<std::uint8_t> free,
                                         const world::MotionOptions& options,
                                         const std::function<void()>& progress) const {
  constexpr std::size_t kPart = 64;
  struct Worker {
    const Impl& impl;
    std::span<const double> from, to;
    world::MotionOptions options;
    world::Scratch scratch;
    std::size_t begin = 0;  ///< of the motions that were filtered last

    [[nodiscard]] std::span<const double> row(std::span<const double> of, std::size_t i) const {
      return of.subspan(i * impl.model.variables, impl.model.variables);
    }
    void filter(std::size_t first, std::span<Answer> answers) {
      begin = first;
      const detail::Model& model = impl.model;
      const std::size_t n = model.variables;
      bool usable = options.around.empty() && detail::decides_motions(model, options.resolution);
      for (std::size_t i = first; usable && i < first + answers.size(); ++i)
        usable = detail::is_within(model, row(from, i)) && detail::is_within(model, row(to, i));
      if (usable)
        std::ranges::copy(
            MotionBatch(model, impl.instructions, from.data() + first * n, to.data() + first * n,
                        answers.size(), detail::slack_of(options.resolution, model.size))
                .run(),
            answers.begin());
      else
        std::ranges::fill(answers, Answer::Open);
    }
    [[nodiscard]] std::size_t place(std::size_t k) const { return begin + k; }
    bool is_free(std::size_t k) {
      options.scratch = &scratch;
      const auto a = row(from, begin + k), b = row(to, begin + k);
      return check_motion(*impl.checker, impl.state, impl.robot,
                          {{a.begin(), a.end()}, {b.begin(), b.end()}}, options)
                 .outcome == world::MotionAnswer::Outcome::Free;
    }
  };
  require_rows(from, free.size(), variables());
  require_rows(to, free.size(), variables());
  if (!(options.resolution > 0))
    throw Error(ErrorCode::InvalidArgument, "a resolution must be above 0");
  world::MotionOptions exact = options;
  exact.where = false;
  exact.progress = {};
  return decide_by_parts(free, kPart, progress,
                         [&] { return Worker{*impl_, from, to, exact, {}, 0}; });
}

}  // namespace kaboum::filter
