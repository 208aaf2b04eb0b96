#pragma once

#include "cluster_collapses.h"
#include "decimation_state.h"
#include "measured_policy.h"

namespace kaboum::bmesh {

/// Contractions, and what goes on between and after them: measured distances, optimisation against
/// the original, representable coordinates.
class Decimator {
 public:
  /// References must outlive this object.
  /// @param original  what `start` was made of, whatever has happened to it since.
  /// @param solid     of the original, or none yet.
  /// @param rising    of a run to a number of vertices: the error bound that rises.
  /// @param sketch    whether another run with such a bound follows: contractions with moves are
  ///   left to that.
  Decimator(const Context& context, const geom::Mesh& original, PartialMesh start,
            std::optional<ReferenceSolid>& solid, std::vector<Step>* steps,
            const std::optional<RisingBound>& rising, bool sketch);

  /// The largest distance measured before edges were contracted together with moves; 0 where there
  /// is none.
  [[nodiscard]] double reached_alone() const { return reached_alone_; }

  /// The error bound, as far as it has risen; 0 where there is none.
  [[nodiscard]] double bound() const { return state_.epsilon.value_or(0); }

  /// Runs on from where the last call has stopped.
  DecimateResult run(std::optional<std::size_t> target);

  /// Steps from now on are certified against this mesh, the present one, instead of the original.
  /// It must outlive this object.
  void nest_in(const geom::Mesh& level);

 private:
  [[nodiscard]] bool follows_distances() const;
  Stop contract_all(const std::optional<std::size_t>& target);
  void start_stages(std::size_t target);
  void contract_in_stages(std::size_t target);
  template <class Turn>
  void take_turns(std::size_t target, Turn&& turn);
  void collapse_in_rounds(std::size_t target);
  void collapse_within(std::size_t target);
  void raise_bound(std::size_t target);
  void raise_bound_by(double growth, std::size_t target);
  void refine();
  void contract_to(std::size_t target, double limit = Contraction::kNoLimit);
  void start_measuring();
  void start_optimising();
  void optimise(int passes);

  DecimationState state_;
  MeasuredPolicy policy_;
  ClusterCollapses clusters_;
  bool sketch_;               // no contractions with moves: another run will follow
  double reached_alone_ = 0;  // before contractions with moves
  std::size_t refined_ = 0;   // number of vertices when samples were added last
};

}  // namespace kaboum::bmesh
