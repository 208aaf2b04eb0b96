#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/error.h>
#include <kaboum/verify/replay.h>

#include <gtest/gtest.h>

#include <random>

#include "recorded.h"
#include "support/families.h"

namespace {

using namespace kaboum;         // NOLINT: the test uses most of it
using namespace kaboum::bmesh;  // NOLINT
using verify::replay;

test::Recorded run(const geom::Mesh& mesh, Direction direction, Cost cost = Cost::Planes,
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
    const test::Recorded r = run(sphere(), d);
    const auto checked = replay(r.input, r.log, r.result.mesh);
    EXPECT_TRUE(checked.verified) << checked.violation;
    EXPECT_TRUE(checked.closed);
    EXPECT_EQ(checked.steps, r.log.steps.size());
    EXPECT_EQ(checked.predicates == 0, d == Direction::Any);
    const test::Recorded best = run(sphere(), d, Cost::Distance, Effort::Best);
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
    const test::Recorded r = run(sphere(), d);
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
    const test::Recorded r = run(sphere(), d, Cost::Distance, Effort::Normal);
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
  const test::Recorded r = run(sphere(), Direction::Outer);
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
  test::Recorded r = run(sphere(), Direction::Outer);
  r.log.dropped.push_back(5);
  EXPECT_FALSE(replay(r.input, r.log, r.result.mesh).verified);
  // A real copy may go.
  geom::Mesh twice = sphere();
  const auto n = twice.triangles.size();
  for (std::size_t t = 0; t < n; ++t) twice.triangles.push_back(twice.triangles[t]);
  const test::Recorded copy = run(twice, Direction::Outer);
  EXPECT_EQ(copy.log.dropped.size(), n);
  EXPECT_TRUE(replay(copy.input, copy.log, copy.result.mesh).verified);
  test::Recorded partial = copy;
  partial.log.dropped.pop_back();
  EXPECT_FALSE(replay(partial.input, partial.log, partial.result.mesh).verified);
}

TEST(Replay, RefutesMovesOfTheBorder) {
  for (const auto& f : test::open_families()) {
    test::Recorded r = run(f.mesh, Direction::Outer);
    const auto checked = replay(r.input, r.log, r.result.mesh);
    EXPECT_TRUE(checked.verified) << f.name << ": " << checked.violation;
    EXPECT_FALSE(checked.closed);
    const auto p = geom::prepare(f.mesh);
    for (std::uint32_t v = 0; v < p.border.size(); ++v) {
      if (p.border[v] == 0) continue;
      Log mutant = r.log;
      mutant.steps.insert(mutant.steps.begin(),
                          {v, v, p.mesh.vertices[v] + geom::Vec3(0, 0, 1e-9)});
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
    if (p.filled_triangles == 0) continue;
    Log log = test::log_of_preparation(f.mesh, p, Direction::Outer);
    EXPECT_EQ(log.filled_triangles.size(), p.filled_triangles);
    DecimateOptions options;
    options.vertices = std::max<std::size_t>(p.mesh.vertices.size() / 2, 4);
    options.steps = &log.steps;
    const geom::Mesh result = decimate(p, options).mesh;
    const Log read = parse_log(serialise_log(log), "the log");
    const auto checked = replay(f.mesh, read, result);
    EXPECT_TRUE(checked.verified) << f.name << ": " << checked.violation;
    EXPECT_TRUE(checked.closed) << f.name;
    EXPECT_EQ(checked.filled, p.filled_triangles);
    Log mutant = log;
    mutant.filled_triangles.pop_back();
    EXPECT_FALSE(replay(f.mesh, mutant, result).verified) << f.name;
    mutant = log;
    std::swap(mutant.filled_triangles[0][0], mutant.filled_triangles[0][1]);
    EXPECT_FALSE(replay(f.mesh, mutant, result).verified) << f.name;
    mutant = log;
    mutant.filled_triangles[0][0] = 1U << 30;
    EXPECT_THROW(replay(f.mesh, mutant, result), Error) << f.name;
    if (!log.filled_vertices.empty()) {
      mutant = log;
      mutant.filled_vertices[0].x() = std::nan("");
      EXPECT_FALSE(replay(f.mesh, mutant, result).verified) << f.name;
      EXPECT_THROW(parse_log(serialise_log(mutant), "the log"), Error);
    }
  }
}

// The triangles of a log without steps: the input's, then what fills its holes.
geom::Mesh filled_by(const geom::Mesh& input, const Log& log) {
  geom::Mesh out = input;
  out.vertices.insert(out.vertices.end(), log.filled_vertices.begin(), log.filled_vertices.end());
  out.triangles.insert(out.triangles.end(), log.filled_triangles.begin(),
                       log.filled_triangles.end());
  return out;
}

// What fills holes decides about the solid: fills that close every edge, but are no fans on the
// holes' rims from their means, are refused.
TEST(Replay, RefusesFillsThatAreNoFans) {
  geom::Mesh box;  // without its top
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
      box.vertices.emplace_back(x, y, z);
  box.triangles = {{0, 2, 1}, {0, 3, 2}, {0, 1, 5}, {0, 5, 4}, {1, 2, 6},
                   {1, 6, 5}, {2, 3, 7}, {2, 7, 6}, {3, 0, 4}, {3, 4, 7}};
  // Numbered as the replay does: by first use.
  const std::array<std::uint32_t, 8> number{0, 2, 1, 3, 5, 4, 6, 7};
  geom::Mesh input;
  input.vertices.resize(8);
  for (std::size_t v = 0; v < 8; ++v) input.vertices[number[v]] = box.vertices[v];
  for (const geom::Triangle& t : box.triangles)
    input.triangles.push_back({number[t[0]], number[t[1]], number[t[2]]});

  geom::PrepareOptions options;
  options.holes = geom::Holes::Fill;
  const geom::Prepared p = geom::prepare(input, options);
  const Log log = test::log_of_preparation(input, p, Direction::Outer);
  ASSERT_EQ(log.filled_triangles.size(), 4U);
  ASSERT_EQ(log.filled_vertices.size(), 1U);
  const auto judged = [&](const Log& l) { return replay(input, l, filled_by(input, l)); };
  ASSERT_TRUE(judged(log).verified) << judged(log).violation;
  const auto refused = [&](const Log& l, const char* why) {
    const auto checked = judged(l);
    EXPECT_FALSE(checked.verified) << why;
    EXPECT_NE(checked.violation.find(why), std::string::npos) << checked.violation;
  };
  const auto rim = [&](std::size_t k) { return log.filled_triangles[k][0]; };

  Log mutant = log;  // a tip below the bottom takes the inside from the solid
  mutant.filled_vertices[0].z() = -5;
  refused(mutant, "from its mean");
  mutant = log;
  mutant.filled_vertices[0].z() = std::nextafter(1.0, 0.0);
  refused(mutant, "from its mean");

  mutant = log;  // triangles in another order: still a fan, but not in the order of its rim
  std::swap(mutant.filled_triangles[1], mutant.filled_triangles[2]);
  refused(mutant, "from its mean");

  mutant = log;  // two triangles instead of the fan: the rim is not theirs alone
  mutant.filled_vertices.clear();
  mutant.filled_triangles = {{rim(0), rim(1), rim(2)}, {rim(2), rim(3), rim(0)}};
  refused(mutant, "of those that fill holes");

  // A shell that is inside out, hung on the fan by an edge that both have.
  for (const bool apart : {false, true}) {
    mutant = log;
    const std::uint32_t tip = log.filled_triangles[0][2], far = tip + 1;
    mutant.filled_vertices.emplace_back(0.5, 0.5, apart ? 0.1 : -9);
    mutant.filled_triangles.push_back({rim(0), tip, far});
    mutant.filled_triangles.push_back({rim(0), rim(1), tip});
    mutant.filled_triangles.push_back({tip, rim(1), far});
    mutant.filled_triangles.push_back({rim(1), rim(0), far});
    refused(mutant, "of those that fill holes");
  }

  mutant = log;  // a vertex besides
  mutant.filled_vertices.emplace_back(0, 0, 9);
  refused(mutant, "does not");

  // Three fans that close one another, on edges of a closed mesh.
  mutant = log;
  const std::uint32_t tip = log.filled_triangles[0][2];
  const std::array<std::vector<std::uint32_t>, 3> paths{
      {{rim(0), rim(1), rim(2)}, {rim(0), tip, rim(2)}, {rim(0), rim(3), rim(2)}}};
  for (std::size_t k = 0; k < 3; ++k) {
    const auto &there = paths[k], &back = paths[(k + 1) % 3];
    const std::vector<std::uint32_t> loop{there[0], there[1], there[2], back[1]};
    const auto center =
        static_cast<std::uint32_t>(input.vertices.size() + mutant.filled_vertices.size());
    mutant.filled_vertices.emplace_back(0.5, 0.5, 3 - 2.0 * static_cast<double>(k));
    for (std::size_t i = 0; i < 4; ++i)
      mutant.filled_triangles.push_back({loop[i], loop[(i + 1) % 4], center});
  }
  refused(mutant, "of those that fill holes");
}

TEST(Replay, RefusesNonsense) {
  test::Recorded r = run(sphere(), Direction::Outer);
  Log mutant = r.log;
  mutant.steps[0].gone = 1U << 30;
  EXPECT_THROW(replay(r.input, mutant, r.result.mesh), Error);
  mutant = r.log;
  mutant.turned.push_back(1U << 30);
  EXPECT_THROW(replay(r.input, mutant, r.result.mesh), Error);
  mutant = r.log;
  mutant.steps[0].position.x() = std::nan("");
  EXPECT_FALSE(replay(r.input, mutant, r.result.mesh).verified);
}

}  // namespace
