#pragma once

#include "search/search.h"

namespace kaboum::plan::test {

/// The goal of a task, without branches.
struct GoalTarget : Target {
  explicit GoalTarget(const Task& of) : task(of) {}
  bool reached(const Word* state) override { return task.evaluator().holds(task.goal(), state); }
  bool allowed(const Word*, OperatorId) override { return true; }
  bool expects(const Word*, OperatorId) override { return true; }
  const Task& task;
};

}  // namespace kaboum::plan::test
