// A part of a mesh as it was before a step that may be taken back.

#include "region_snapshot.h"

namespace kaboum::bmesh {

RegionSnapshot::RegionSnapshot(WorkingMesh& mesh, SampledError& sampled,
                               DecimateStatistics& statistics, std::vector<Step>* steps)
    : m_(mesh),
      sampled_(sampled),
      statistics_(statistics),
      steps_(steps),
      mark_(mesh.mesh.size(), 0) {}

void RegionSnapshot::take(std::span<const std::uint32_t> vertices) {
  triangles_.clear(), corners_.clear(), positions_.clear(), samples_.clear();
  vertices_.assign(vertices.begin(), vertices.end());
  ++mark_value_;
  for (const std::uint32_t v : vertices) {
    positions_.push_back(m_.position[v]);
    m_.mesh.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t) {
      if (mark_[t] == mark_value_) return;
      mark_[t] = mark_value_;
      triangles_.push_back(t);
      corners_.push_back(m_.mesh[t]);
    });
  }
  sampled_.save(triangles_, samples_);
  step_count_ = steps_ != nullptr ? steps_->size() : 0;
  pull_backs_ = statistics_.pull_backs;
}

void RegionSnapshot::restore() {
  for (std::size_t i = 0; i < vertices_.size(); ++i) m_.position[vertices_[i]] = positions_[i];
  for (std::size_t i = 0; i < triangles_.size(); ++i) m_.mesh.restore(triangles_[i], corners_[i]);
  for (const std::uint32_t t : triangles_) m_.update_normal(t);
  sampled_.restore(triangles_, samples_);
  if (steps_ != nullptr) steps_->resize(step_count_);
  statistics_.pull_backs = pull_backs_;
}

}  // namespace kaboum::bmesh
