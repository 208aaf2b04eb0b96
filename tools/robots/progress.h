#pragma once

#include <kaboum/robot/link_meshes.h>

#include <chrono>
#include <string>
#include <vector>

#include "common/cli.h"
#include "common/last_words.h"

/// How far the work on a robot is.
namespace kaboum::tools {

/// Which of a robot's meshes are done, what is left, and what a signal leaves behind.
class MeshProgress {
 public:
  /// @param meshes  in the order in which they are made
  /// @param kept    those that are done are in the cache
  MeshProgress(const std::string& program, bool quiet, const robot::LinkMeshes& meshes, bool kept);

  /// What is done to the next mesh. @return the line that is shown
  std::string show(const std::string& stage);
  /// The next mesh is done.
  void made(bool cached);
  /// No mesh is worked on any more, but this. @param left  what a signal leaves
  void other(const std::string& stage, const std::string& left);

 private:
  using Clock = std::chrono::steady_clock;

  void say_end();
  [[nodiscard]] std::string time_left() const;

  std::string program_;
  bool quiet_, kept_;
  std::vector<std::string> names_;
  std::vector<double> sizes_;  ///< of the files [bytes]
  std::size_t done_ = 0;
  double worked_ = 0, worked_seconds_ = 0;  ///< of the meshes that were not in the cache
  Clock::time_point begin_ = Clock::now(), last_ = begin_, said_ = begin_;
  Progress progress_;
  LastWords words_;
};

/// A search of which nobody knows how long it takes.
class SearchProgress {
 public:
  /// Where there is no terminal, it is said at once, and now and then, what is looked for.
  /// @param kept  what was tried is in the cache
  SearchProgress(const std::string& program, bool quiet, const std::string& what, bool kept);

  void show(const std::string& stage);

 private:
  using Clock = std::chrono::steady_clock;

  std::string what_;
  bool quiet_;
  Clock::time_point begin_ = Clock::now(), said_ = begin_;
  Progress progress_;
  LastWords words_;
};

}  // namespace kaboum::tools
