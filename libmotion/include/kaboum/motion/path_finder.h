#pragma once

#include <kaboum/filter/batch_checker.h>
#include <kaboum/motion/find_path.h>

#include <memory>
#include <span>
#include <vector>

namespace kaboum::motion {

/// Paths of one robot in one state of a scene, query after query. What all queries share is made
/// once: a batch checker, by which the motions of a search are decided at every instant as they are
/// looked at. Const throughout: threads may share it.
class PathFinder {
 public:
  /// Refers to the checker. Takes about a tenth of a second.
  /// @throws as filter::BatchChecker
  PathFinder(const world::Checker& checker, world::WorldState state, std::size_t robot,
             const filter::BatchChecker::Options& options = {});
  ~PathFinder();
  PathFinder(PathFinder&&) noexcept;
  PathFinder& operator=(PathFinder&&) noexcept;
  PathFinder(const PathFinder&) = delete;
  PathFinder& operator=(const PathFinder&) = delete;

  /// As find_path: the same is claimed of what is returned. The path may be another one. It is the
  /// same on any number of threads and with any instruction set, whatever was asked before.
  /// @throws as find_path
  [[nodiscard]] PathAnswer find(const std::vector<double>& start,
                                std::span<const std::vector<double>> goals,
                                const PathOptions& options) const;

  [[nodiscard]] const world::Checker& checker() const;
  [[nodiscard]] const world::WorldState& state() const;
  [[nodiscard]] std::size_t robot() const;

 private:
  friend class Roadmap;
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace kaboum::motion
