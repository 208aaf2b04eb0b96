#pragma once

#include <kaboum/execution/exact_cell.h>
#include <kaboum/execution/simulation.h>
#include <kaboum/world/exact_meshes.h>

#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::execution {

/// A plan's execution as data for a player: kinematics, shapes, motions in time, and which step is
/// followed by which. docs/pages.md.
///
/// Steps are nodes in geometric states: what is known besides may differ between runs that come to
/// the same one, and the ways on from it are all of theirs.
class Recording {
 public:
  /// All arguments outlive it.
  /// @throws Error{InvalidArgument} for options that are not above 0.
  Recording(const world::World& world, const plan::Model& model, const plan::Plan& plan,
            SimulationOptions options);
  ~Recording();
  Recording(const Recording&) = delete;
  Recording& operator=(const Recording&) = delete;

  /// One node in one state, as Simulation::carry_out; the first one is the plan's first.
  /// @throws Error{InvalidInput} where a configuration or pose is not known, or a payload names
  ///   what the scene does not have.
  void carry_out(const plan::RunStep& step);

  /// The plan has no branch for what the last step's sensing came to: it was made under
  /// assumptions.
  /// @throws Error{InvalidArgument} before the first step.
  void end_unplanned();

  /// The page's data. Bounding sets are written without their margins.
  /// @param exact  of the scene; may be empty.
  [[nodiscard]] std::string json(const std::vector<world::ExactMesh>& exact) const;

 private:
  struct Data;
  std::uint32_t state_number(const plan::KnownState& known);
  std::uint32_t step_number(plan::Index node, std::uint32_t state);
  void record_motions(plan::Index node);

  const world::World& world_;
  const plan::Model& model_;
  const plan::Plan& plan_;
  SimulationOptions options_;
  std::map<std::string, std::uint32_t> states_;                           ///< by words
  std::map<std::pair<plan::Index, std::uint32_t>, std::uint32_t> steps_;  ///< by node and state
  std::optional<std::pair<std::uint32_t, std::size_t>> last_;             ///< step, and its way on
  std::unique_ptr<Data> data_;
};

}  // namespace kaboum::execution
