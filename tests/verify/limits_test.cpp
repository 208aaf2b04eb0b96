// Limits leave claims undecided, never verified, and the same ones on any number of threads.
#include <kaboum/base/error.h>
#include <kaboum/verify/mesh_verdict.h>

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <limits>
#include <random>

#include "allowance.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;        // NOLINT: a test
using namespace kaboum::test;  // NOLINT: a test

TEST(Inclusion, LimitsLeaveItUndecided) {
  const Mesh a = box({1, 1, 1}, 2), b = translated(box({1, 1, 1}, 3), {0.25, 0.25, 0.25});
  verify::InclusionOptions options;
  options.max_contacts = 3;
  const auto few_contacts = verify::verify_inclusion(a, b, options);
  EXPECT_EQ(few_contacts.solid.answer, verify::Answer::Undecided);
  EXPECT_FALSE(few_contacts.solid.reason.empty());
  options = {};
  options.max_pieces = 1;
  // They share the plane of a face, and more than one piece of it.
  const Mesh within = translated(box({1, 1, 1}, 2), {0.5, 0.5, 0});
  const Mesh around = translated(box({2, 2, 1}, 3), {0, 0, 0});
  ASSERT_EQ(verify::verify_inclusion(within, around).solid.answer, verify::Answer::Verified);
  const auto few_pieces = verify::verify_inclusion(within, around, options);
  EXPECT_EQ(few_pieces.solid.answer, verify::Answer::Undecided);
  // What other triangles show is refuted all the same.
  EXPECT_EQ(verify::verify_inclusion(a, b, options).solid.answer, verify::Answer::Refuted);
}

/// Triangles of random corners: each crosses a large part of the others.
Mesh tangle(std::size_t triangles, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  Mesh mesh;
  for (std::uint32_t t = 0; t < triangles; ++t) {
    for (int k = 0; k < 3; ++k)
      mesh.vertices.emplace_back(coordinate(random), coordinate(random), coordinate(random));
    mesh.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return mesh;
}

TEST(Inclusion, EndsAfterTheWorkAllowedOnAnyNumberOfThreads) {
  const Mesh mesh = tangle(300, 1);
  verify::InclusionOptions options;
  options.max_work = 0.5;
  const auto found = verify::verify_inclusion(mesh, mesh, options);
  EXPECT_EQ(found.solid.answer, verify::Answer::Undecided);
  EXPECT_GT(found.left_out, 0U);
  EXPECT_LE(found.left_out, 600U);
  // Steps are counted, not time: the same again, on one thread.
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(verify::verify_inclusion(mesh, mesh, options).left_out, found.left_out);
  EXPECT_EQ(verify::verify_inclusion(mesh, mesh, options).samples, found.samples);
}

TEST(Inclusion, UndecidedTrianglesAreNeverVerified) {
  // One triangle of the inner mesh sticks out; whatever the limit, it is not "verified".
  const Mesh outer = box({1, 1, 1}, 6);
  Mesh inner = translated(box({0.5, 0.5, 0.5}, 6), {0.25, 0.25, 0.25});
  inner.vertices.back().z() = 1.5;
  for (const double work : {1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1.0}) {
    verify::InclusionOptions options;
    options.max_work = work;
    const auto found = verify::verify_inclusion(inner, outer, options);
    EXPECT_NE(found.solid.answer, verify::Answer::Verified) << work;
    EXPECT_NE(found.surface.answer, verify::Answer::Verified) << work;
    if (work >= 1) {
      EXPECT_EQ(found.solid.answer, verify::Answer::Refuted);
    }
  }
}

void join(Mesh& mesh, const Mesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  for (const geom::Triangle& t : other.triangles)
    mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
}

Mesh spike(const Vec3& apex) {
  return {{apex, {-1.8, -1.5, 0}, {-1.8, 1.5, 0}, {-1.8, 0, 0.3}},
          {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

/// What is left out may stick out farther: a spike that much of the outer mesh cuts, beside a box
/// that nothing cuts and that sticks out a little.
TEST(Verdict, LimitsLeaveNoBoundOfWhatSticksOut) {
  Mesh outer = translated(box({4, 4, 4}, 1), {-2, -2, -2});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(-1.8, 1.8);
  for (int i = 0; i < 12; ++i) {
    Mesh tetrahedron = spike(Vec3::Zero());
    for (Vec3& p : tetrahedron.vertices)
      p = {coordinate(random), coordinate(random), coordinate(random)};
    join(outer, tetrahedron);
  }
  Mesh inner = translated(box({0.11, 0.05, 0.05}, 1), {1.9, 1.9, 1.9});
  join(inner, spike({9, 0.1, 0.1}));
  ASSERT_GT(geom::signed_volume(spike({9, 0.1, 0.1})), 0);
  bool left_out = false;  // the spike, and not the box
  for (double work = 1e-5; work < 1; work *= 1.1) {
    verify::MeshQuestion question{inner, outer};
    question.max_work = work;
    const verify::MeshVerdict verdict = verify::decide(question);
    if (verdict.surface_depth) {
      EXPECT_GE(verdict.surface_depth->upper, 7 - 1e-9) << work;
      left_out = left_out || (verdict.surface_depth->lower > 0 && verdict.surface_depth->lower < 1);
    }
    if (verdict.solid_depth) {
      EXPECT_GE(verdict.solid_depth->upper, 7 - 1e-9) << work;
    }
  }
  EXPECT_TRUE(left_out);
  EXPECT_EQ(verify::decide({inner, outer}).answer, verify::Answer::Refuted);
}

TEST(Steps, LimitsEndWithTheirScope) {
  // Whatever ends a loop's body; else what comes after it would be given up.
  verify::Allowance allowance(1);
  EXPECT_THROW(allowance.loop(4, [](std::size_t) { throw Error(ErrorCode::Internal, "a bug"); }),
               Error);
  verify::count_steps(2'000'000'000);
}

TEST(Inclusion, WorkHasToBePositive) {
  for (const double work : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    verify::InclusionOptions options;
    options.max_work = work;
    EXPECT_THROW(verify::verify_inclusion(box({1, 1, 1}, 1), box({1, 1, 1}, 1), options), Error);
  }
}

}  // namespace
