#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/bmesh/extract.h>
#include <kaboum/geom/float32.h>
#include <kaboum/verify/inclusion.h>

#include <gtest/gtest.h>
#include <kaboum/verify/replay.h>

#include <random>

#include "recorded.h"
#include "support/families.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;         // NOLINT: the test uses most of it
using namespace kaboum::bmesh;  // NOLINT
using verify::replay_progressive;
using verify::ReplayResult;

struct Series {
  geom::Mesh input;
  Progressive progressive;
  std::vector<DecimateResult> results;
};

Series run(const geom::Mesh& mesh, DecimateOptions o, const std::vector<std::size_t>& vertices) {
  Series s{mesh, {}, {}};
  const auto p = geom::prepare(mesh);
  s.progressive.log = test::log_of_preparation(mesh, p, o.direction);
  s.progressive.log.input_sha256 = std::string(64, 'a');
  s.progressive.log.tool = "test 1";
  s.progressive.base = p.solid.mesh();
  s.progressive.double_precision = o.precision == Precision::Double;
  o.record_steps = true;
  s.results = decimate_series(p.solid, o, vertices);
  std::vector<Step>& steps = s.progressive.log.steps;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const DecimateResult& result = s.results[i];
    steps.insert(steps.end(), result.steps.begin(), result.steps.end());
    s.progressive.levels.push_back({vertices[i], result.mesh.vertices.size(), steps.size()});
  }
  return s;
}

DecimateOptions options(Direction direction, Cost cost, Effort effort) {
  DecimateOptions o;
  o.direction = direction;
  o.cost = cost;
  o.effort = effort;
  return o;
}

bool encloses(const geom::Mesh& outer, const geom::Mesh& inner) {
  return verify::verify_inclusion(inner, outer).solid.answer == verify::Answer::Verified;
}

bool same(const geom::Mesh& a, const geom::Mesh& b) {
  return a.vertices == b.vertices && a.triangles == b.triangles;
}

Series small(Direction d = Direction::Outer) {
  return run(test::icosphere(2), options(d, Cost::Distance, Effort::Normal), {80, 40, 20});
}

TEST(Series, IsNestedAndCertifiedForEveryCostAndEffort) {
  const std::vector<geom::Mesh> meshes{test::torus(1, 0.4, 14, 7),
                                       test::noisy(test::uv_sphere(12, 8), 0.05, 7)};
  const std::vector<std::pair<Cost, Effort>> methods{{Cost::Planes, Effort::Fast},
                                                     {Cost::Planes, Effort::Normal},
                                                     {Cost::Distance, Effort::Fast},
                                                     {Cost::Distance, Effort::Normal},
                                                     {Cost::Distance, Effort::Best}};
  for (const geom::Mesh& mesh : meshes) {
    for (const auto& [cost, effort] : methods) {
      if (effort == Effort::Best && &mesh != &meshes.front()) continue;  // takes long
      for (const Direction d : {Direction::Outer, Direction::Inner}) {
        const Series s = run(mesh, options(d, cost, effort), {60, 40, 25});
        const geom::Mesh* finer = &s.input;
        std::size_t i = 0;
        for (const DecimateResult& r : s.results) {
          SCOPED_TRACE(std::to_string(i++));
          EXPECT_EQ(r.stop, Stop::VertexTarget);
          EXPECT_EQ(r.mesh.vertices.size(), s.progressive.levels[i - 1].requested);
          const bool outer = d == Direction::Outer;
          EXPECT_TRUE(encloses(outer ? r.mesh : *finer, outer ? *finer : r.mesh));
          finer = &r.mesh;
          const Extracted e = extract(s.progressive, s.progressive.levels[i - 1].requested, "pm");
          EXPECT_TRUE(e.level && e.reached && same(e.mesh, r.mesh));
        }
        const ReplayResult checked = replay_progressive(s.input, s.progressive);
        EXPECT_TRUE(checked.verified) << checked.violation;
        EXPECT_EQ(checked.levels, 3U);
        EXPECT_EQ(checked.steps, s.progressive.log.steps.size());
        if (effort != Effort::Fast) {
          EXPECT_GT(checked.against_original, 0U);
        }
      }
    }
  }
}

// Without levels in between, steps are certified against the original alone: the coarser mesh then
// need not enclose the finer one, and a checker that ignored levels would not see it.
TEST(Series, NestingIsNotForFree) {
  Series s =
      run(test::icosphere(3), options(Direction::Outer, Cost::Distance, Effort::Normal), {60});
  ASSERT_TRUE(replay_progressive(s.input, s.progressive).verified);
  const Extracted between = extract(s.progressive, 120, "pm");
  EXPECT_FALSE(between.level);
  EXPECT_TRUE(encloses(between.mesh, s.input));
  EXPECT_FALSE(encloses(s.results.front().mesh, between.mesh));
  s.progressive.levels.insert(s.progressive.levels.begin(), {120, 120, between.steps});
  const ReplayResult checked = replay_progressive(s.input, s.progressive);
  EXPECT_FALSE(checked.verified);
  EXPECT_EQ(checked.levels, 1U);
}

TEST(Series, WhatIsNotReachedStandsForAllAfterIt) {
  const geom::Mesh two =
      test::merged({test::icosphere(1), test::translated(test::icosphere(1), {5, 0, 0})});
  const Series s = run(two, options(Direction::Outer, Cost::Planes, Effort::Fast), {20, 6, 5});
  EXPECT_EQ(s.results[0].stop, Stop::VertexTarget);
  EXPECT_EQ(s.results[1].stop, Stop::Exhausted);
  EXPECT_TRUE(same(s.results[1].mesh, s.results[2].mesh));
  EXPECT_FALSE(extract(s.progressive, 5, "pm").reached);
  EXPECT_FALSE(extract(s.progressive, 4, "pm").reached);
  EXPECT_TRUE(replay_progressive(s.input, s.progressive).verified);
}

TEST(Series, NeedsFallingNumbers) {
  const auto p = geom::prepare(test::icosphere(1));
  for (const std::vector<std::size_t>& v :
       std::vector<std::vector<std::size_t>>{{}, {5, 5}, {5, 6}})
    EXPECT_THROW(decimate_series(p.solid, {}, v), Error);
}

TEST(Series, PreparationBelongsToTheBase) {
  geom::Mesh mesh =
      test::merged({test::flipped(test::icosphere(1)),
                    test::soup(test::translated(test::box({1, 1, 1}, 3), {4, 0, 0}))});
  mesh.triangles.push_back({0, 0, 1});
  const Series s = run(mesh, options(Direction::Outer, Cost::Planes, Effort::Fast), {40, 30});
  const ReplayResult checked = replay_progressive(s.input, s.progressive);
  EXPECT_TRUE(checked.verified) << checked.violation;
  EXPECT_GT(checked.reversed, 0U);
}

TEST(Progressive, ExtractsEveryNumberOfVertices) {
  for (const Direction d : {Direction::Outer, Direction::Inner}) {
    const Series s = small(d);
    std::size_t before = s.input.vertices.size() + 1;
    for (std::size_t n = s.input.vertices.size(); n >= 20; --n) {
      const Extracted e = extract(s.progressive, n, "pm");
      EXPECT_TRUE(e.reached);
      EXPECT_LE(e.mesh.vertices.size(), n);
      EXPECT_LE(e.mesh.vertices.size(), before);
      before = e.mesh.vertices.size();
      if (n % 10 == 0) {
        EXPECT_TRUE(encloses(d == Direction::Outer ? e.mesh : s.input,
                             d == Direction::Outer ? s.input : e.mesh));
      }
    }
  }
}

/// Writes the checksum anew.
void seal(std::vector<char>& bytes) {
  std::uint64_t sum = 14695981039346656037U;
  for (std::size_t i = 0; i + 8 < bytes.size(); ++i)
    sum = (sum ^ static_cast<std::uint8_t>(bytes[i])) * 1099511628211U;
  for (int i = 0; i < 8; ++i)
    bytes[bytes.size() - 8 + i] = static_cast<char>(static_cast<std::uint8_t>(sum >> (8 * i)));
}

TEST(Progressive, SurvivesARoundTrip) {
  const Series s = small();
  const auto bytes = serialise_progressive(s.progressive);
  const Progressive back = parse_progressive(bytes, "pm");
  EXPECT_EQ(serialise_progressive(back), bytes);
  EXPECT_EQ(back.log.tool, "test 1");
  EXPECT_TRUE(same(extract(back, 40, "pm").mesh, s.results[1].mesh));
}

TEST(Progressive, RefusesEveryTruncationAndTrailingBytes) {
  Progressive p;
  p.base = test::box({1, 1, 1}, 1);
  p.log.steps = {{0, 1, {0, 0, 0}}, Step::flip(1, 2, 3, 4)};
  p.levels = {{7, 7, 1}, {6, 6, 2}};
  std::vector<char> bytes = serialise_progressive(p);
  for (std::size_t n = 0; n < bytes.size(); ++n)
    EXPECT_THROW(parse_progressive(std::span(bytes).first(n), "pm"), Error) << n;
  bytes.push_back(0);
  EXPECT_THROW(parse_progressive(bytes, "pm"), Error);
  // The same with a checksum that matches.
  const std::vector<char> whole = serialise_progressive(p);
  for (const std::size_t n :
       {whole.size() - 1, whole.size() - 24, whole.size() / 2, whole.size() + 1}) {
    bytes = whole;
    bytes.resize(n);
    seal(bytes);
    EXPECT_THROW(parse_progressive(bytes, "pm"), Error) << n;
  }
}

TEST(Progressive, RefusesWhatCannotBe) {
  Progressive good;
  good.base = test::box({1, 1, 1}, 1);
  good.log.steps = {{0, 1, {0, 0, 0}}};
  good.levels = {{7, 7, 0}, {6, 6, 1}};
  const auto refused = [&](const auto& damage) {
    Progressive p = good;
    damage(p);
    EXPECT_THROW(parse_progressive(serialise_progressive(p), "pm"), Error);
  };
  EXPECT_NO_THROW(parse_progressive(serialise_progressive(good), "pm"));
  refused([](Progressive& p) { p.base.vertices[0].x() = std::nan(""); });
  refused([](Progressive& p) { p.base.triangles[0][0] = 8; });
  refused([](Progressive& p) { p.base.triangles[0][0] = p.base.triangles[0][1]; });
  refused([](Progressive& p) { p.levels[1].steps = 2; });
  refused([](Progressive& p) { p.levels[1].requested = 7; });
  refused([](Progressive& p) { std::swap(p.levels[0], p.levels[1]); });
  for (const Step& step :
       {Step{0, 9, {0, 0, 0}}, Step{9, 9, {0, 0, 0}}, Step{0, 0, {0, std::nan(""), 0}},
        Step::flip(0, 1, 2, 3), Step::flip(0, 1, 2, 9)}) {
    Progressive p = good;
    p.log.steps = {step};
    EXPECT_THROW(extract(p, 6, "pm"), Error);
    p.levels.clear();
    EXPECT_THROW(extract(p, 4, "pm"), Error);
  }
}

TEST(Progressive, NoSingleDamagedBytePasses) {
  Progressive p;
  p.base = test::box({1, 1, 1}, 1);
  p.log.steps = {{0, 1, {0, 0, 0}}};
  p.levels = {{7, 7, 1}};
  const std::vector<char> bytes = serialise_progressive(p);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (int bit = 0; bit < 8; ++bit) {
      std::vector<char> damaged = bytes;
      damaged[at] = static_cast<char>(damaged[at] ^ (1U << bit));
      EXPECT_THROW(parse_progressive(damaged, "pm"), Error) << "byte " << at;
    }
  }
}

// One byte anywhere, changed at random by somebody who mends the checksum: an error, a refutation,
// or a file that still is a proof.
TEST(Progressive, MutantsAreRefusedRefutedOrHarmless) {
  std::mt19937_64 random(53);
  for (const Direction d : {Direction::Outer, Direction::Inner}) {
    const Series s = small(d);
    const auto bytes = serialise_progressive(s.progressive);
    int refused = 0, refuted = 0, harmless = 0;
    for (int i = 0; i < 100; ++i) {
      auto mutant = bytes;
      const std::size_t at = random() % (mutant.size() - 8);
      mutant[at] = static_cast<char>(mutant[at] ^ (1U << (random() % 8)));
      seal(mutant);
      try {
        const Progressive p = parse_progressive(mutant, "mutant");
        for (const std::size_t n : {80, 40, 20, 10}) extract(p, n, "mutant");
        if (p.log.input_sha256 != s.progressive.log.input_sha256 || p.log.direction != d) {
          ++refused;  // bound-verify compares the one and says the other
          continue;
        }
        const ReplayResult checked = replay_progressive(s.input, p);
        if (!checked.verified) {
          ++refuted;
          continue;
        }
        ++harmless;
        if (harmless > 20) continue;
        const geom::Mesh* finer = &s.input;
        std::vector<geom::Mesh> levels;
        levels.reserve(p.levels.size());
        for (const auto& level : p.levels) {
          levels.push_back(extract(p, level.requested, "mutant").mesh);
          EXPECT_TRUE(d == Direction::Outer ? encloses(levels.back(), *finer)
                                            : encloses(*finer, levels.back()))
              << "byte " << at;
          finer = &levels.back();
        }
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::InvalidInput) << error.what();
        ++refused;
      }
    }
    EXPECT_GT(refused, 7);
    EXPECT_GT(refuted, 17);  // many moves are undone by a later one of the same vertex
  }
}

TEST(Progressive, RefutesInwardSteps) {
  std::mt19937_64 random(54);
  for (const Direction d : {Direction::Outer, Direction::Inner}) {
    const Series s = small(d);
    const double sign = d == Direction::Outer ? -1 : 1;
    int refuted = 0, tried = 0;
    for (std::size_t i = 0; i < s.progressive.log.steps.size(); ++i) {
      const Step& step = s.progressive.log.steps[i];
      if (step.kind != Step::Kind::Contract || random() % 20 != 0) continue;
      Progressive mutant = s.progressive;
      mutant.log.steps[i].position += sign * 0.3 * step.position;  // through the sphere
      ++tried;
      refuted += replay_progressive(s.input, mutant).verified ? 0 : 1;
    }
    EXPECT_EQ(refuted, tried);
    EXPECT_GT(tried, 10);
  }
}

TEST(Progressive, RefutesAnotherBase) {
  const Series s = small();
  for (int i = 0; i < 3; ++i) {
    Progressive mutant = s.progressive;
    if (i == 0) mutant.base.vertices[5].x() += 1e-12;
    if (i == 1) std::swap(mutant.base.triangles[3][0], mutant.base.triangles[3][1]);
    if (i == 2) mutant.base.triangles.pop_back();
    EXPECT_FALSE(replay_progressive(s.input, mutant).verified);
  }
  Progressive mutant = s.progressive;
  ++mutant.levels[1].vertices;
  EXPECT_FALSE(replay_progressive(s.input, mutant).verified);
  EXPECT_THROW(extract(mutant, 40, "pm"), Error);
}

}  // namespace
