#pragma once

#include <cstddef>
#include <vector>

#include "merge.h"
#include "solid_field.h"
#include "tuning.h"

namespace kaboum::bcd {

/// What all parts of one search share: the solid, the tree of its cuts, which only grows, what is
/// known of pairs of bodies, and the account of the work done.
class SearchState {
 public:
  /// Keeps references to the mesh and the options, which must outlive this object.
  /// @param work  allowed. [ns]
  SearchState(const Mesh& closed, const CoverOptions& options, double work, Tuning how);
  /// The state that the constructor above gives for the same but `options`, which ask for another
  /// number of bodies, and `work`: nothing is found again that does not depend on these.
  SearchState(const SearchState& same, const CoverOptions& options, double work);

  [[nodiscard]] const CoverOptions& options() const { return options_; }
  [[nodiscard]] const Tuning& tuning() const { return tuning_; }
  [[nodiscard]] const SolidField& solid() const { return solid_; }
  [[nodiscard]] CutTree& tree() { return tree_; }
  [[nodiscard]] const CutTree& tree() const { return tree_; }

  /// Whether this share of the work allowed has been done; out_of_work() then says that it was.
  bool spent(double share);
  /// Epsilon is reached: from now on, what improves the result ends with improve_work, too, and
  /// where Tuning::patience times the work so far makes it no better.
  void begin_improving();
  /// The result has become better.
  void improved();
  [[nodiscard]] bool out_of_work() const { return out_of_work_; }
  /// @param fraction  estimate of the share of the work done, 0 to 1.
  void report(const char* stage, double fraction) const;

  /// Finds what only a search for cuts needs; to be called before any.
  void begin_cutting();
  /// From now on, bodies round this point are judged by its distance as well, if it lies in the
  /// hull of these points. @return whether it does.
  bool add_witness(const SolidField::Witness& witness, std::span<const Vec3> hull);

  /// One body per leaf, as they were when there were this many.
  [[nodiscard]] std::vector<Body> leaf_bodies(std::size_t count = kUnlimited) const;
  /// bcd::merge, with what is known of pairs.
  std::vector<Body> merged(std::vector<Body> bodies, std::size_t target, double epsilon,
                           double volume_weight = kVolumeWeight);

 private:
  const CoverOptions& options_;
  Tuning tuning_;
  SolidField solid_;
  CutTree tree_;
  PairMemo memo_;
  bool begun_ = false, improving_ = false, out_of_work_ = false;
  double patient_until_ = 0;  ///< [ns]
};

}  // namespace kaboum::bcd
