#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "decimator.h"
#include "flatten.h"

namespace kaboum::bmesh {

/// Coplanar regions first, without any loss; then large meshes region by region; then the
/// decimation proper, which knows nothing of the vertices that are gone by then.
class DecimationRun {
 public:
  /// References must outlive this object. @param rising, sketch  as of Decimator
  DecimationRun(const geom::SolidMesh& input, const DecimateOptions& options, Work& work,
                std::optional<RisingBound> rising = std::nullopt, bool sketch = false);

  /// Runs on from where the last call has stopped.
  DecimateResult to(std::optional<std::size_t> target);

  /// As of Decimator.
  [[nodiscard]] double reached_alone() const;
  [[nodiscard]] double bound() const;
  void nest_in(const geom::Mesh& level);

 private:
  [[nodiscard]] bool is_reached(std::size_t target) const;
  void start(std::optional<std::size_t> target);
  void flatten();
  void append_steps();
  [[nodiscard]] std::vector<Step>* recorded(std::vector<Step>& steps) const;
  DecimateResult finished(DecimateResult result);

  const geom::SolidMesh& input_;
  DecimateOptions options_;
  Work& work_;
  std::optional<RisingBound> rising_;
  bool sketch_;
  std::vector<Step> steps_;        // since the last result, numbered as the input
  std::vector<Step> inner_steps_;  // numbered as below
  std::optional<Flattener> flattener_;
  geom::Mesh flat_;                    // what it has left, when it has done anything
  std::vector<char> flat_border_;      // of its vertices
  std::vector<std::uint32_t> source_;  // of its vertices: the input's
  std::vector<std::uint32_t> number_;  // the same of the vertices at hand; empty: the same numbers
  DecimateStatistics before_;          // of what the decimator knows nothing of
  std::optional<Context> context_;
  std::optional<ReferenceSolid> solid_;
  std::optional<Decimator> decimator_;
};

}  // namespace kaboum::bmesh
