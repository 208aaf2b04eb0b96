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
  const detail::Model& model = impl_->model;
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
  detail::filter_rows(model, impl_->instructions, rows.data(), nullptr, answers.size(), memory,
                      answers.data());
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
///   as there is room for, `is_free(i)` decides what that leaves open
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
                      for (std::size_t i = 0; i < answers.size(); ++i) {
                        bool is_free = answers[i] == Answer::Free;
                        if (answers[i] == Answer::Open) {
                          is_free = worker.is_free(first + i);
                          ++counts.exactly;
                        }
                        ++(is_free ? counts.free : counts.contact);
                        free[first + i] = is_free ? 1 : 0;
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

BatchCounts BatchChecker::decide(std::span<const double> rows, std::span<std::uint8_t> free,
                                 const std::function<void()>& progress) const {
  constexpr std::size_t kPart = 1024;
  struct Worker {
    const BatchChecker& checker;
    std::span<const double> rows;
    world::WorldState state;
    world::Scratch scratch;

    void filter(std::size_t first, std::span<Answer> answers) const {
      const std::size_t n = checker.variables();
      checker.filter(rows.subspan(first * n, answers.size() * n), answers);
    }
    bool is_free(std::size_t i) {
      const std::size_t n = checker.variables();
      const auto row = rows.subspan(i * n, n);
      state.q[checker.impl_->robot].assign(row.begin(), row.end());
      return checker.impl_->checker->is_free(state, scratch);
    }
  };
  require_rows(rows, free.size(), variables());
  return decide_by_parts(free, kPart, progress, [&] {
    return Worker{*this, rows, impl_->state, {}};
  });
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
    rows_.clear();
    widths_.clear();
    for (const Stretch& s : stretches_)
      for (std::size_t k = 0; k < n; ++k)
        detail::put_stretch(s, from_[s.motion * n + k], to_[s.motion * n + k], rows_.emplace_back(),
                            widths_.emplace_back());
    answers_.resize(stretches_.size());
    detail::filter_rows(model_, set_, rows_.data(), widths_.data(), answers_.size(), memory_,
                        answers_.data(), slack_);
  }

  const detail::Model& model_;
  Instructions set_;
  const double *from_, *to_;
  float slack_;
  std::vector<Answer> result_;
  std::vector<Stretch> stretches_;
  std::vector<double> rows_, widths_;
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

    [[nodiscard]] std::span<const double> row(std::span<const double> of, std::size_t i) const {
      return of.subspan(i * impl.model.variables, impl.model.variables);
    }
    void filter(std::size_t first, std::span<Answer> answers) const {
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
    bool is_free(std::size_t i) {
      options.scratch = &scratch;
      const auto a = row(from, i), b = row(to, i);
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
  return decide_by_parts(free, kPart, progress, [&] {
    return Worker{*impl_, from, to, exact, {}};
  });
}

}  // namespace kaboum::filter
