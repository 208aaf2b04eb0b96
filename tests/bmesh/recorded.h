// Decimation with the log of what it has done, as `bmesh-decimate --log` writes it.
#pragma once

#include <kaboum/bmesh/decimate.h>
#include <kaboum/bmesh/log.h>
#include <kaboum/geom/prepare.h>

#include <gtest/gtest.h>

#include <cstddef>

namespace kaboum::test {

/// A log that holds the preparation and no step yet.
inline bmesh::Log log_of_preparation(const geom::Mesh& input, const geom::Prepared& prepared,
                                     bmesh::Direction direction) {
  bmesh::Log log;
  log.direction = direction;
  bmesh::record_preparation(prepared.report, input.triangles.size(), log);
  return log;
}

struct Recorded {
  geom::Mesh input;
  bmesh::Log log;
  bmesh::DecimateResult result;
};

/// @param share  of the vertices of the mesh as prepared that are left; 0: as the options say.
inline Recorded record(const geom::Mesh& mesh, bmesh::DecimateOptions options, double share = 0) {
  const geom::Prepared p = geom::prepare(mesh);
  Recorded r{mesh, log_of_preparation(mesh, p, options.direction), {}};
  if (share > 0)
    options.vertices =
        static_cast<std::size_t>(share * static_cast<double>(p.solid.mesh().vertices.size()));
  options.record_steps = true;
  r.result = bmesh::decimate(p.solid, options);
  r.log.steps = r.result.steps;
  return r;
}

/// The same mesh by the same steps.
inline void expect_same(const Recorded& one, const Recorded& other) {
  EXPECT_EQ(one.result.mesh.triangles, other.result.mesh.triangles);
  EXPECT_EQ(one.result.mesh.vertices, other.result.mesh.vertices);
  ASSERT_EQ(one.log.steps.size(), other.log.steps.size());
  for (std::size_t i = 0; i < one.log.steps.size(); ++i) {
    EXPECT_EQ(one.log.steps[i].kept, other.log.steps[i].kept);
    EXPECT_EQ(one.log.steps[i].gone, other.log.steps[i].gone);
    EXPECT_EQ(one.log.steps[i].position, other.log.steps[i].position);
  }
  EXPECT_EQ(one.result.statistics.predicates, other.result.statistics.predicates);
  EXPECT_EQ(one.result.statistics.placements, other.result.statistics.placements);
  EXPECT_EQ(one.result.statistics.pull_backs, other.result.statistics.pull_backs);
  EXPECT_EQ(one.result.statistics.rejected_original, other.result.statistics.rejected_original);
}

}  // namespace kaboum::test
