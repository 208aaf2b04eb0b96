// Configurations by the million: the vector code first, the checker where it leaves one open.

#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/base/processor.h>
#include <kaboum/filter/batch_checker.h>

#include <algorithm>
#include <cmath>
#include <mutex>

#include "lanes.h"
#include "model.h"

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

struct BatchChecker::Impl {
  const world::Checker* checker;
  world::WorldState state;
  std::size_t robot;
  Instructions instructions;
  detail::Model model;
};

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
  detail::filter_rows(model, impl_->instructions, rows.data(), answers.size(), memory,
                      answers.data());
}

BatchCounts BatchChecker::decide(std::span<const double> rows, std::span<std::uint8_t> free,
                                 const std::function<void()>& progress) const {
  constexpr std::size_t kPart = 1024;
  const std::size_t variables = impl_->model.variables;
  if (rows.size() != free.size() * variables)
    throw Error(ErrorCode::InvalidArgument,
                "rows of " + std::to_string(variables) + " values are expected");
  if (!std::ranges::all_of(rows, [](double x) { return std::isfinite(x); }))
    throw Error(ErrorCode::InvalidArgument, "a value that is not finite");
  BatchCounts out;
  std::mutex mutex;
  parallel_ranges((free.size() + kPart - 1) / kPart, {}, [&](std::size_t begin, std::size_t end) {
    world::Scratch scratch;
    world::WorldState state = impl_->state;
    std::vector<Answer> answers;
    BatchCounts counts;
    for (std::size_t part = begin; part < end; ++part) {
      const std::size_t first = part * kPart, count = std::min(kPart, free.size() - first);
      answers.resize(count);
      filter(rows.subspan(first * variables, count * variables), answers);
      for (std::size_t i = 0; i < count; ++i) {
        bool is_free = answers[i] == Answer::Free;
        if (answers[i] == Answer::Open) {
          const auto row = rows.subspan((first + i) * variables, variables);
          state.q[impl_->robot].assign(row.begin(), row.end());
          is_free = impl_->checker->is_free(state, scratch);
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

}  // namespace kaboum::filter
