#pragma once

#include <kaboum/motion/roadmap.h>

#include <mutex>

#include "search_space.h"

namespace kaboum::motion {

struct PathFinder::Impl {
  Impl(const world::Checker& of, world::WorldState at, std::size_t which,
       const filter::BatchChecker::Options& options)
      : checker(&of),
        state(std::move(at)),
        robot(which),
        batch(of, state, which, options),
        metric(metric_of(of, state, which)) {}

  const world::Checker* checker;
  world::WorldState state;
  std::size_t robot;
  filter::BatchChecker batch;
  Metric metric;
  std::mutex mutex;
  std::vector<std::unique_ptr<SearchMemory>> idle;
  std::string identity_once;

  /// identity_of the finder's scene.
  const std::string& identity() {
    const std::scoped_lock lock(mutex);
    if (identity_once.empty()) identity_once = identity_of(*checker, state, robot);
    return identity_once;
  }

  /// Memory of one query, given back afterwards.
  class Borrowed {
   public:
    explicit Borrowed(Impl& of) : of_(of) {
      const std::scoped_lock lock(of_.mutex);
      if (of_.idle.empty()) {
        memory_ = std::make_unique<SearchMemory>();
        if (of_.batch.decides()) memory_->motions.emplace(of_.batch);
        return;
      }
      memory_ = std::move(of_.idle.back());
      of_.idle.pop_back();
    }
    ~Borrowed() {
      const std::scoped_lock lock(of_.mutex);
      of_.idle.push_back(std::move(memory_));
    }
    Borrowed(const Borrowed&) = delete;
    Borrowed& operator=(const Borrowed&) = delete;
    SearchMemory& operator*() const { return *memory_; }

   private:
    Impl& of_;
    std::unique_ptr<SearchMemory> memory_;
  };
};

}  // namespace kaboum::motion
