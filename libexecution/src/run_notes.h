#pragma once

#include <kaboum/execution/drive_plan.h>
#include <kaboum/judge/cell.h>
#include <kaboum/plan/replan.h>
#include <kaboum/world/world.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>

namespace kaboum::execution {

/// Entries of a journal beside the messages: which plan is carried out, at which of its nodes it
/// is, where everything is and what is known there, and why it is planned again
/// (docs/planning/drivers.md). Each is a JSON object in one line.
class RunNotes {
 public:
  /// @param world  outlives it
  explicit RunNotes(const world::World& world) : world_(world) {}

  /// A plan that is carried out from here on.
  std::string plan(const plan::Model& model, const plan::Plan& plan);
  /// A node is begun. Of what is known, and of where things are, only what has changed is said.
  std::string begun(plan::Index node, const std::string& action, const judge::CellState& state,
                    const plan::KnownState& known);
  /// It is done, with its sensing.
  std::string done(const plan::RunStep& step, const judge::CellState& state);

  static std::string planning(const plan::Unplanned& why, unsigned after);
  static std::string planned(const plan::Replan& replan);
  /// What the exact meshes say of what was done.
  static std::string verdict(const DriveReport& report);

 private:
  void add_changes(std::string& entry, const judge::CellState& state,
                   const plan::KnownState& known);

  const world::World& world_;
  std::uint64_t plans_ = 0, steps_ = 0;
  std::set<std::string> known_;
  std::map<std::string, std::string> places_;  ///< in JSON, by robot or object
};

}  // namespace kaboum::execution
