#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/verify/replay.h>

#include <gtest/gtest.h>

#include <random>

#include "recorded.h"
#include "support/families.h"

namespace {

using namespace kaboum;         // NOLINT: the test uses most of it
using namespace kaboum::bmesh;  // NOLINT
using verify::replay;
using verify::replay_progressive;

test::Recorded record(const geom::Mesh& mesh, Direction direction, Cost cost = Cost::Planes,
                      Effort effort = Effort::Fast) {
  DecimateOptions o;
  o.direction = direction;
  o.cost = cost;
  o.effort = effort;
  return test::record(mesh, o, 0.4);
}

geom::Mesh sphere() {
  for (const auto& f : test::closed_families())
    if (f.convex && f.mesh.vertices.size() > 100) return f.mesh;
  throw std::logic_error("no convex family");
}

TEST(Replay, VerifiesWhatDecimateDid) {
  for (const Direction d : {Direction::Outer, Direction::Inner, Direction::Any}) {
    const test::Recorded r = record(sphere(), d);
    const auto checked = replay(r.input, r.log, r.result.mesh);
    EXPECT_TRUE(checked.verified) << checked.violation;
    EXPECT_TRUE(checked.closed);
    EXPECT_EQ(checked.steps, r.log.steps.size());
    EXPECT_EQ(checked.predicates == 0, d == Direction::Any);
    const test::Recorded best = record(sphere(), d, Cost::Distance, Effort::Best);
    const auto also = replay(best.input, best.log, best.result.mesh);
    EXPECT_TRUE(also.verified) << also.violation;
  }
}

// Pulling the vertex of a step inwards, by little or much, must be refuted even when the result is
// changed along with it (the result is compared last).
TEST(Replay, RefutesInwardSteps) {
  std::mt19937_64 random(51);
  const geom::Vec3 center = geom::bounding_box(sphere()).center();
  for (const Direction d : {Direction::Outer, Direction::Inner}) {
    const test::Recorded r = record(sphere(), d);
    for (const double size : {1e-2, 1e-4, 1e-6}) {
      for (int i = 0; i < 20; ++i) {
        Log mutant = r.log;
        auto& step = mutant.steps[random() % mutant.steps.size()];
        const double sign = d == Direction::Outer ? -1 : 1;
        step.position += sign * size * (step.position - center);
        const auto checked = replay(r.input, mutant, r.result.mesh);
        EXPECT_FALSE(checked.verified);
        EXPECT_FALSE(checked.violation.empty());
      }
    }
    Log swapped = r.log;
    swapped.direction = d == Direction::Outer ? Direction::Inner : Direction::Outer;
    EXPECT_FALSE(replay(r.input, swapped, r.result.mesh).verified);
  }
}

// Steps against the original: what they leave in the result must be refuted when it is moved, and
// so must any step into the solid that the result has to keep (outwards) or out of it (inwards).
TEST(Replay, RefutesStepsThatCutTheOriginal) {
  std::mt19937_64 random(52);
  const geom::Vec3 center = geom::bounding_box(sphere()).center();
  std::size_t flips = 0;
  for (const Direction d : {Direction::Outer, Direction::Inner}) {
    const test::Recorded r = record(sphere(), d, Cost::Distance, Effort::Normal);
    const auto checked = replay(r.input, r.log, r.result.mesh);
    ASSERT_TRUE(checked.verified) << checked.violation;
    EXPECT_GT(checked.against_original, 0U);
    std::size_t pull_backs = 0;
    for (const Step& s : r.log.steps) {
      pull_backs += s.kind == Step::Kind::Contract && s.kept == s.gone;
      flips += s.kind == Step::Kind::Flip;
    }
    EXPECT_GT(pull_backs, 0U);
    const double sign = d == Direction::Outer ? -1 : 1;
    int tried = 0;
    for (std::size_t i = 0; i < r.log.steps.size(); ++i) {
      if (r.log.steps[i].kind != Step::Kind::Contract) continue;
      // Far: through the surface of the sphere, whatever comes later.
      if (random() % 16 == 0) {
        Log mutant = r.log;
        mutant.steps[i].position += sign * 0.3 * (mutant.steps[i].position - center);
        const auto far = replay(r.input, mutant, r.result.mesh);
        EXPECT_FALSE(far.verified);
        EXPECT_NE(far.violation.find("step"), std::string::npos) << far.violation;
      }
      // Little: if it stays in the result.
      const auto& v = r.result.mesh.vertices;
      if (std::find(v.begin(), v.end(), r.log.steps[i].position) == v.end()) continue;
      Log mutant = r.log;
      mutant.steps[i].position += sign * 1e-6 * (mutant.steps[i].position - center);
      EXPECT_FALSE(replay(r.input, mutant, r.result.mesh).verified);
      ++tried;
    }
    EXPECT_GT(tried, 10);
  }
  EXPECT_GT(flips, 0U);
}

TEST(Replay, RefutesFlipsThatCutTheOriginal) {
  // A cube whose face diagonal is flipped is the same cube; flipping an edge of the cube itself
  // cuts it off (and is fine inwards).
  const geom::Mesh cube{
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      {{0, 2, 1},
       {0, 3, 2},
       {4, 5, 6},
       {4, 6, 7},
       {0, 1, 5},
       {0, 5, 4},
       {1, 2, 6},
       {1, 6, 5},
       {2, 3, 7},
       {2, 7, 6},
       {3, 0, 4},
       {3, 4, 7}}};
  // Vertices are numbered by their first use: 0 2 1 3 4 5 6 7.
  const auto number = [](std::uint32_t v) { return v == 1 ? 2U : v == 2 ? 1U : v; };
  const auto flipped = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, std::uint32_t d,
                           geom::Mesh* result) {
    *result = cube;
    for (auto& t : result->triangles) {
      const auto is = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
        for (int k = 0; k < 3; ++k)
          if (t[k] == x && t[(k + 1) % 3] == y && t[(k + 2) % 3] == z) return true;
        return false;
      };
      if (is(a, b, c))
        t = {d, c, a};
      else if (is(b, a, d))
        t = {c, d, b};
    }
    return Step::flip(number(a), number(b), number(c), number(d));
  };
  for (const Direction d : {Direction::Outer, Direction::Inner}) {
    Log log;
    log.direction = d;
    geom::Mesh result;
    log.steps = {flipped(0, 2, 1, 3, &result)};
    EXPECT_TRUE(replay(cube, log, result).verified) << replay(cube, log, result).violation;
    log.steps = {flipped(0, 1, 5, 2, &result)};
    EXPECT_EQ(replay(cube, log, result).verified, d == Direction::Inner);
    log.steps = {Step::flip(0, 1, 2, 3)};
    EXPECT_FALSE(replay(cube, log, result).verified) << "no such edge";
  }
}

TEST(Replay, RefutesAnotherResult) {
  const test::Recorded r = record(sphere(), Direction::Outer);
  geom::Mesh moved = r.result.mesh;
  moved.vertices[3].x() = std::nextafter(moved.vertices[3].x(), 1e9);
  EXPECT_FALSE(replay(r.input, r.log, moved).verified);
  geom::Mesh fewer = r.result.mesh;
  fewer.triangles.pop_back();
  EXPECT_FALSE(replay(r.input, r.log, fewer).verified);
  geom::Mesh turned = r.result.mesh;
  std::swap(turned.triangles[0][0], turned.triangles[0][1]);
  EXPECT_FALSE(replay(r.input, r.log, turned).verified);
  geom::Mesh rotated = r.result.mesh;
  std::rotate(rotated.triangles[0].begin(), rotated.triangles[0].begin() + 1,
              rotated.triangles[0].end());
  std::reverse(rotated.triangles.begin(), rotated.triangles.end());
  EXPECT_TRUE(replay(r.input, r.log, rotated).verified) << "order does not matter";
}

TEST(Replay, RefutesDropsThatChangeTheSolid) {
  test::Recorded r = record(sphere(), Direction::Outer);
  r.log.dropped.push_back(5);
  EXPECT_FALSE(replay(r.input, r.log, r.result.mesh).verified);
  // A real copy may go.
  geom::Mesh twice = sphere();
  const auto n = twice.triangles.size();
  for (std::size_t t = 0; t < n; ++t) twice.triangles.push_back(twice.triangles[t]);
  const test::Recorded copy = record(twice, Direction::Outer);
  EXPECT_EQ(copy.log.dropped.size(), n);
  EXPECT_TRUE(replay(copy.input, copy.log, copy.result.mesh).verified);
  test::Recorded partial = copy;
  partial.log.dropped.pop_back();
  EXPECT_FALSE(replay(partial.input, partial.log, partial.result.mesh).verified);
}

TEST(Replay, RefutesMovesOfTheBorder) {
  for (const auto& f : test::open_families()) {
    test::Recorded r = record(f.mesh, Direction::Outer);
    const auto checked = replay(r.input, r.log, r.result.mesh);
    EXPECT_TRUE(checked.verified) << f.name << ": " << checked.violation;
    EXPECT_FALSE(checked.closed);
    const auto p = geom::prepare(f.mesh);
    for (std::uint32_t v = 0; v < p.solid.border().size(); ++v) {
      if (p.solid.border()[v] == 0) continue;
      Log mutant = r.log;
      mutant.steps.insert(mutant.steps.begin(),
                          {v, v, p.solid.mesh().vertices[v] + geom::Vec3(0, 0, 1e-9)});
      EXPECT_FALSE(replay(r.input, mutant, r.result.mesh).verified) << f.name;
      break;
    }
  }
}

// What fills holes is in the log, and only added.
TEST(Replay, FillsHoles) {
  for (const auto& f : test::open_families()) {
    geom::PrepareOptions fill;
    fill.holes = geom::Holes::Fill;
    geom::Prepared p;
    try {
      p = geom::prepare(f.mesh, fill);
    } catch (const Error&) {
      continue;  // one-sided
    }
    if (p.solid.filled_triangles() == 0) continue;
    Log log = test::log_of_preparation(f.mesh, p, Direction::Outer);
    EXPECT_EQ(log.rims.size(), p.report.holes);
    DecimateOptions options;
    options.vertices = std::max<std::size_t>(p.solid.mesh().vertices.size() / 2, 4);
    options.record_steps = true;
    const DecimateResult decimated = decimate(p.solid, options);
    log.steps = decimated.steps;
    const geom::Mesh& result = decimated.mesh;
    const Log read = parse_log(serialise_log(log), "the log");
    const auto checked = replay(f.mesh, read, result);
    EXPECT_TRUE(checked.verified) << f.name << ": " << checked.violation;
    EXPECT_TRUE(checked.closed) << f.name;
    EXPECT_EQ(checked.filled, p.solid.filled_triangles());
    Log mutant = log;
    mutant.rims.pop_back();
    EXPECT_FALSE(replay(f.mesh, mutant, result).verified) << f.name;
    mutant = log;
    std::ranges::reverse(mutant.rims[0]);
    EXPECT_FALSE(replay(f.mesh, mutant, result).verified) << f.name;
    mutant = log;
    mutant.rims[0].pop_back();
    EXPECT_FALSE(replay(f.mesh, mutant, result).verified) << f.name;
    mutant = log;
    mutant.rims[0][0] = 1U << 30;
    EXPECT_THROW(replay(f.mesh, mutant, result), Error) << f.name;
  }
}

geom::Mesh box_without_top() {
  geom::Mesh box;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
      box.vertices.emplace_back(x, y, z);
  box.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6},
                   {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  return box;
}

// What fills holes decides about the solid: whatever closes the mesh, but is no fan on the rim of a
// hole from its mean, is refused.
TEST(Replay, RefusesFillsThatAreNoFans) {
  const geom::Mesh input = box_without_top();
  geom::PrepareOptions options;
  options.holes = geom::Holes::Fill;
  const geom::Prepared p = geom::prepare(input, options);
  const Log log = test::log_of_preparation(input, p, Direction::Outer);
  ASSERT_EQ(log.rims.size(), 1U);
  const std::vector<std::uint32_t> rim = log.rims[0];
  ASSERT_EQ(rim.size(), 4U);
  ASSERT_TRUE(replay(input, log, p.solid.mesh()).verified)
      << replay(input, log, p.solid.mesh()).violation;
  const auto refused = [&](const Log& l, const char* why) {
    const auto checked = replay(input, l, p.solid.mesh());
    EXPECT_FALSE(checked.verified) << why;
    EXPECT_NE(checked.violation.find(why), std::string::npos) << checked.violation;
  };

  for (const double z : {-5.0, std::nextafter(1.0, 0.0)}) {  // the tip follows from the rim
    geom::Mesh other = p.solid.mesh();
    other.vertices.back().z() = z;
    const auto checked = replay(input, log, other);
    EXPECT_FALSE(checked.verified);
    EXPECT_NE(checked.violation.find("not those of the result"), std::string::npos);
  }

  Log mutant = log;  // two triangles instead of the fan: the rim is not theirs alone
  mutant.rims = {{rim[0], rim[1], rim[2]}, {rim[2], rim[3], rim[0]}};
  refused(mutant, "is no hole");
  mutant = log;  // a loop to and fro
  mutant.rims.push_back({rim[0], rim[1]});
  refused(mutant, "is no hole");
  mutant = log;  // a vertex twice
  mutant.rims[0].insert(mutant.rims[0].end(), rim.begin(), rim.end());
  refused(mutant, "is no hole");
  mutant = log;  // the hole twice, once backwards: closed as well
  mutant.rims.push_back(rim);
  refused(mutant, "is no hole");
  mutant.rims[1] = {rim[0], rim[3], rim[2], rim[1]};
  mutant.rims.push_back(rim);
  refused(mutant, "is no hole");
  mutant = log;  // on edges of a closed part
  mutant.rims.push_back({0, 1, 2});
  refused(mutant, "is no hole");
  mutant = log;  // not closed
  mutant.rims.clear();
  refused(mutant, "not those of the result");

  // Later turns are of closed chains: the fan alone is none, nor is what leaves a part out.
  mutant = log;
  mutant.reversed_after_filling = {10, 11, 12, 13};
  refused(mutant, "no closed chain");
  mutant = log;
  for (std::uint32_t t = 0; t < 13; ++t) mutant.reversed_after_filling.push_back(t);
  refused(mutant, "is no hole");
  mutant = log;  // as if the input had been inside out when it was filled
  for (std::uint32_t t = 0; t < 14; ++t) mutant.reversed_after_filling.push_back(t);
  refused(mutant, "is no hole");
  mutant = log;
  mutant.reversed_after_filling = {14};
  refused(mutant, "is not there");
  mutant.reversed_after_filling = {3, 3};
  EXPECT_THROW(replay(input, mutant, p.solid.mesh()), Error);
}

/// Three tetrahedra round the edge that they share, apart elsewhere. Each has faces missing, as the
/// bits of its two digits (base 4) of `missing` say, and is inside out where its bit of `turned` is
/// set.
geom::Mesh tetrahedra_round_an_edge(unsigned missing, unsigned turned) {
  geom::Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {0, 0, 1}};
  const std::array<std::pair<double, double>, 6> round{
      {{2, 0}, {1, 2}, {-1, 2}, {-2, 0}, {-1, -2}, {1, -2}}};
  for (std::uint32_t i = 0; i < 3; ++i) {
    const std::uint32_t k = 2 + 2 * i;
    for (std::size_t j = 0; j < 2; ++j)
      mesh.vertices.emplace_back(round[2 * i + j].first, round[2 * i + j].second,
                                 0.25 * static_cast<double>(1 + j));
    const std::array<geom::Triangle, 4> faces{
        {{0, 1, k + 1}, {0, k, 1}, {0, k + 1, k}, {1, k, k + 1}}};
    const std::array<std::array<bool, 4>, 4> present{{{true, true, true, true},
                                                      {false, true, true, true},
                                                      {true, false, true, true},
                                                      {false, true, false, true}}};
    for (std::size_t j = 0; j < 4; ++j) {
      if (!present[missing >> 2 * i & 3U][j]) continue;
      geom::Triangle t = faces[j];
      if ((turned >> i & 1U) != 0) std::swap(t[1], t[2]);
      mesh.triangles.push_back(t);
    }
  }
  return mesh;
}

// Shells that share a rim, and are turned against each other after its holes are filled.
TEST(Replay, FillsHolesOfShellsTurnedLater) {
  geom::PrepareOptions fill;
  fill.holes = geom::Holes::Fill;
  std::size_t fans_turned = 0;
  for (unsigned missing = 1; missing < 64; ++missing)
    for (unsigned turned = 0; turned < 8; ++turned) {
      const geom::Mesh input = tetrahedra_round_an_edge(missing, turned);
      geom::Prepared p;
      try {
        p = geom::prepare(input, fill);
      } catch (const Error&) {
        continue;  // what was meant cannot be told
      }
      const Log log = test::log_of_preparation(input, p, Direction::Outer);
      const auto checked = replay(input, log, p.solid.mesh());
      EXPECT_TRUE(checked.verified) << missing << ' ' << turned << ": " << checked.violation;
      EXPECT_EQ(checked.filled, p.solid.filled_triangles());
      if (log.reversed_after_filling.empty()) continue;
      Log mutant = log;
      mutant.reversed_after_filling.pop_back();
      EXPECT_FALSE(replay(input, mutant, p.solid.mesh()).verified) << missing << ' ' << turned;
      if (log.reversed_after_filling.back() < input.triangles.size()) continue;  // a closed shell
      ++fans_turned;
      mutant.reversed_after_filling.clear();
      EXPECT_FALSE(replay(input, mutant, p.solid.mesh()).verified) << missing << ' ' << turned;
    }
  EXPECT_GT(fans_turned, 100U);
}

// Nothing is verified about nothing: no triangles, none with an area, none that are left.
TEST(Replay, NothingIsVerifiedOfNothing) {
  geom::Mesh sheet;
  sheet.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 1}};
  geom::Mesh needle = sheet;  // collinear
  needle.vertices[2] = {0.5, 0, 0};
  geom::Mesh segment = sheet;
  segment.triangles = {{0, 1, 1}};
  Log drops_both, drops_one;
  drops_both.dropped = {0, 1};
  drops_one.dropped = {0};
  const std::vector<std::pair<geom::Mesh, Log>> cases{
      {{}, {}}, {needle, {}}, {sheet, drops_both}, {segment, drops_one}};
  for (const Direction d : {Direction::Outer, Direction::Inner})
    for (const auto& [mesh, log] : cases) {
      Progressive p;
      p.log = log;
      p.log.direction = d;
      geom::Mesh left = mesh;
      if (!log.dropped.empty()) left = {};
      p.base = left;
      for (const auto& found : {replay(mesh, p.log, left), replay_progressive(mesh, p)}) {
        EXPECT_FALSE(found.verified);
        EXPECT_NE(found.violation.find("no triangle with an area"), std::string::npos)
            << found.violation;
      }
    }
  // Two triangles back to back that are not dropped have an area.
  EXPECT_TRUE(replay(sheet, {}, sheet).verified);
}

TEST(Replay, RefusesNonsense) {
  test::Recorded r = record(sphere(), Direction::Outer);
  Log mutant = r.log;
  mutant.steps[0].gone = 1U << 30;
  EXPECT_THROW(replay(r.input, mutant, r.result.mesh), Error);
  mutant = r.log;
  mutant.reversed.push_back(1U << 30);
  EXPECT_THROW(replay(r.input, mutant, r.result.mesh), Error);
  mutant = r.log;
  mutant.steps[0].position.x() = std::nan("");
  EXPECT_FALSE(replay(r.input, mutant, r.result.mesh).verified);
}

}  // namespace
