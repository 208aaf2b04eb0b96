#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/directed_distance.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/topology.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/inclusion.h>
#include <kaboum/verify/replay.h>

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "part.h"
#include "recorded.h"
#include "support/corpus.h"
#include "support/families.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;         // NOLINT: the test uses most of it
using namespace kaboum::bmesh;  // NOLINT
using verify::replay;

/// Families of so many triangles or more are left out; instrumented builds set a smaller limit.
std::size_t largest() {
  const char* limit = std::getenv("KABOUM_TEST_LARGEST");
  return limit != nullptr ? std::stoul(limit) : 4000;
}

/// Of triangles thin for their length, or bodies flat for their width: distances are small there
/// and samples many, so normal effort takes ten times longer than for others of the same size.
bool is_slender(const test::Family& f) {
  return f.name == "hull-flat" || f.name.starts_with("cone-") || f.name.starts_with("sliver-");
}

/// The slender families with a fifth of the triangles or fewer.
std::vector<test::Family> coarse_slender_families() {
  const auto rod = test::scaled(test::cylinder(16, 1, 1, 1), {0.01, 0.01, 3});
  const auto flat = test::scaled(test::random_hull(32, test::Cloud::Sphere, 5), {1, 1, 1e-4});
  return {{"coarse-hull-flat", test::convex_hull(flat.vertices), true, true, true},
          {"coarse-cone", test::cone(28, 1.7), true, true, true},
          {"coarse-cone-flat", test::cone(28, 0.001), true, true, true},
          {"coarse-cylinder-rotated", test::rotated(test::cylinder(16, 40, 1, 0), 0.4), true, true,
           false},
          {"coarse-rod", test::rotated(rod, 0.9), true, true, false}};
}

std::vector<test::Family> solids() {
  std::vector<test::Family> out;
  int refused = 0;
  std::vector<test::Family> families = test::closed_families();
  for (auto& f : coarse_slender_families()) families.push_back(std::move(f));
  for (auto& f : families) {
    if (!f.solid || f.mesh.triangles.size() >= largest()) continue;
    try {
      geom::prepare(f.mesh);
      out.push_back(std::move(f));
    } catch (const Error&) {
      ++refused;  // a solid with a sheet
    }
  }
  EXPECT_LE(refused, 1);
  return out;
}

DecimateOptions to_vertices(std::size_t n, Direction direction = Direction::Outer) {
  DecimateOptions o;
  o.vertices = n;
  o.direction = direction;
  o.precision = Precision::Double;
  return o;
}

struct Method {
  Cost cost;
  Effort effort;
};

/// The thesis's cost for all, the measured one where it does not take long: of slender families,
/// where they are coarse.
std::vector<Method> methods(const test::Family& f) {
  std::vector<Method> out{{Cost::Planes, Effort::Fast}};
  const std::size_t most = std::min<std::size_t>(300, largest() / 6);
  if (f.mesh.triangles.size() <= most && !is_slender(f))
    out.push_back({Cost::Distance, Effort::Normal});
  return out;
}

DecimateOptions with(const Method& method, DecimateOptions o) {
  o.cost = method.cost;
  o.effort = method.effort;
  return o;
}

TEST(Decimate, NeedsATarget) {
  const auto p = geom::prepare(solids().front().mesh);
  EXPECT_THROW(decimate(p.solid, {}), Error);
  DecimateOptions negative;
  negative.epsilon = -1;
  EXPECT_THROW(decimate(p.solid, negative), Error);
}

TEST(Decimate, ReachesTheWishedNumberOrSaysSo) {
  for (const auto& f : solids()) {
    const auto p = geom::prepare(f.mesh);
    const std::size_t n = p.solid.mesh().vertices.size() / 2;
    for (const Method& m : methods(f)) {
      const auto r = decimate(p.solid, with(m, to_vertices(n)));
      if (r.stop == Stop::VertexTarget) {
        EXPECT_EQ(r.mesh.vertices.size(), n) << f.name;
      } else {
        EXPECT_EQ(r.stop, Stop::Exhausted) << f.name;
        EXPECT_GT(r.mesh.vertices.size(), n) << f.name;
      }
      EXPECT_TRUE(geom::analyse(r.mesh).closed()) << f.name;
      EXPECT_EQ(r.statistics.vertices_out, r.mesh.vertices.size());
      EXPECT_EQ(r.statistics.vertices_in, r.statistics.contractions + r.mesh.vertices.size())
          << f.name;
    }
  }
}

TEST(Decimate, VolumeOnlyGrowsOutwardsAndShrinksInwards) {
  for (const auto& f : solids()) {
    const auto p = geom::prepare(f.mesh);
    const double v = geom::signed_volume(p.solid.mesh());
    const std::size_t n = p.solid.mesh().vertices.size() / 4 + 4;
    for (const Method& m : methods(f)) {
      EXPECT_GE(geom::signed_volume(decimate(p.solid, with(m, to_vertices(n))).mesh),
                v * (1 - 1e-12))
          << f.name;
      EXPECT_LE(
          geom::signed_volume(decimate(p.solid, with(m, to_vertices(n, Direction::Inner))).mesh),
          v * (1 + 1e-12))
          << f.name;
    }
  }
}

TEST(Decimate, GivesTheSameResultTwice) {
  for (const auto& f : solids()) {
    const auto p = geom::prepare(f.mesh);
    for (const Method& m : methods(f)) {
      const DecimateOptions o = with(m, to_vertices(2 * p.solid.mesh().vertices.size() / 5));
      const auto a = decimate(p.solid, o), b = decimate(p.solid, o);
      ASSERT_EQ(a.mesh.triangles, b.mesh.triangles) << f.name;
      for (std::size_t i = 0; i < a.mesh.vertices.size(); ++i)
        ASSERT_EQ(a.mesh.vertices[i], b.mesh.vertices[i]);
    }
  }
}

TEST(Decimate, WritesFloatsWhenAsked) {
  for (const auto& f : solids()) {
    const auto p = geom::prepare(f.mesh);
    for (const Method& m : methods(f)) {
      DecimateOptions o = with(m, to_vertices(p.solid.mesh().vertices.size() / 3 + 4));
      o.precision = Precision::Float;
      const auto r = decimate(p.solid, o);
      std::size_t not_float = 0;
      for (const auto& v : r.mesh.vertices) not_float += !geom::is_float32(v);
      EXPECT_EQ(not_float, r.unrepresentable) << f.name;
      if (not_float != 0)
        std::cout << f.name << ": " << not_float << " vertices not representable\n";
    }
  }
}

TEST(Decimate, KeepsBordersInPlace) {
  for (const auto& f : test::open_families()) {
    const auto p = geom::prepare(f.mesh);
    ASSERT_FALSE(p.solid.closed()) << f.name;
    const auto r = decimate(p.solid, to_vertices(4));
    std::vector<geom::Vec3> after = r.mesh.vertices;
    for (std::size_t v = 0; v < p.solid.mesh().vertices.size(); ++v) {
      if (p.solid.border()[v] == 0) continue;
      EXPECT_NE(std::find(after.begin(), after.end(), p.solid.mesh().vertices[v]), after.end())
          << f.name;
    }
    EXPECT_LT(r.mesh.vertices.size(), p.solid.mesh().vertices.size()) << f.name;
  }
}

/// Triangles of the inner mesh that are not all in the outer one's solid, decided exactly.
std::size_t poking_out(const geom::Mesh& inner, const geom::Mesh& outer) {
  const verify::Inclusion found = verify::verify_inclusion(inner, outer);
  EXPECT_EQ(found.solid.answer, verify::Answer::Verified);
  EXPECT_NE(found.surface.answer, verify::Answer::Undecided);
  return found.surface.answer == verify::Answer::Verified ? 0
                                                          : found.surface.inner_triangles.size();
}

/// No fold: not only the solid of an inner result, every triangle of it is inside. Returns the
/// number of contractions, 0 for meshes that have folds themselves.
std::size_t expect_no_fold(const std::string& name, const geom::Mesh& mesh, const Method& m,
                           Precision precision) {
  const auto p = geom::prepare(mesh);
  if (poking_out(p.solid.mesh(), p.solid.mesh()) > 0) return 0;
  DecimateOptions o =
      with(m, to_vertices(p.solid.mesh().vertices.size() / 6 + 4, Direction::Inner));
  o.precision = precision;
  const auto r = decimate(p.solid, o);
  EXPECT_EQ(poking_out(r.mesh, p.solid.mesh()), 0U) << name;
  return r.statistics.contractions;
}

TEST(Decimate, InnerSurfacesStayInside) {
  std::size_t contractions = 0;
  for (const auto& f : solids()) {
    if (f.mesh.triangles.size() > 1500) continue;
    for (const Method& m : methods(f)) {
      contractions += expect_no_fold(f.name, f.mesh, m, Precision::Float);
      if (m.effort == Effort::Fast)
        contractions += expect_no_fold(f.name, f.mesh, m, Precision::Double);
    }
  }
  EXPECT_GT(contractions, 1000U);
}

// A shaft that folded at this ratio before.
TEST(CorpusDecimate, InnerSurfaceOfAFemurStaysInside) {
  const geom::Mesh femur = io::read_mesh(test::corpus() / "clean-femur.off").mesh;
  EXPECT_GT(expect_no_fold("femur", femur, {Cost::Planes, Effort::Fast}, Precision::Float), 1000U);
}

// Every cost, both directions, replayed by the separate checker. The slender families are left with
// so many vertices by the measured cost that they are decimated once only; the coarse ones twice.
TEST(Decimate, EveryCostIsCertified) {
  const std::size_t most = std::min<std::size_t>(600, largest() / 6);
  for (const auto& f : solids()) {
    if (f.mesh.triangles.size() > most) continue;
    const auto p = geom::prepare(f.mesh);
    std::size_t contractions = 0;
    for (const Cost cost : {Cost::Distance, Cost::Planes, Cost::PlanesAdapted, Cost::PlanesDiagonal,
                            Cost::Triangles}) {
      for (const Direction direction : {Direction::Outer, Direction::Inner}) {
        DecimateOptions o = to_vertices(p.solid.mesh().vertices.size() / 5 + 4, direction);
        o.cost = cost;
        if (cost == Cost::Distance) {
          o.effort = Effort::Normal;
          if (is_slender(f)) o.vertices = p.solid.mesh().vertices.size() / 2;
        }
        const test::Recorded r = test::record(f.mesh, o);
        const auto checked = replay(f.mesh, r.log, r.result.mesh);
        EXPECT_TRUE(checked.verified) << f.name << ": " << checked.violation;
        contractions += r.result.statistics.contractions;
      }
    }
    EXPECT_GT(contractions, 0U) << f.name;
  }
}

TEST(Decimate, EpsilonHoldsBothWays) {
  for (const auto& f : solids()) {
    const auto p = geom::prepare(f.mesh);
    const double diagonal = geom::bounding_box(p.solid.mesh()).diagonal();
    for (const Method& m : methods(f))
      for (const double percent : {0.1, 2.0}) {
        DecimateOptions o = with(m, {});
        o.precision = Precision::Double;
        o.epsilon = 0.01 * percent * diagonal;
        const auto r = decimate(p.solid, o);
        const auto there = geom::directed_distance(p.solid.mesh(), geom::DistanceQuery(r.mesh));
        const auto back = geom::directed_distance(r.mesh, geom::DistanceQuery(p.solid.mesh()));
        EXPECT_LE(there.max_lower, *o.epsilon) << f.name;
        EXPECT_LE(back.max_lower, *o.epsilon) << f.name;
      }
  }
}

TEST(Decimate, EpsilonLeavesRoomForContractions) {
  const auto sphere = solids().front();
  const auto p = geom::prepare(sphere.mesh);
  DecimateOptions o;
  o.epsilon = 0.02 * geom::bounding_box(p.solid.mesh()).diagonal();
  const auto r = decimate(p.solid, o);
  EXPECT_EQ(r.stop, Stop::ErrorBound);
  EXPECT_LT(r.mesh.vertices.size(), p.solid.mesh().vertices.size() * 3 / 4) << sphere.name;
}

// Contractions that move the vertices around with them: far fewer vertices than without, and every
// step of them holds. On the sphere of 642 vertices 52 instead of 84 are left, and 50 instead of
// 68; on that of 162, which is nearer to what can be reached, 57 instead of 78 and 52 instead of
// 64: with so few, one vertex more or less hangs on ties between equal triangles, and four fifths
// are 51.
TEST(Decimate, MovingTheVerticesAroundSavesVertices) {
  const geom::Mesh sphere = test::icosphere(3);
  const auto p = geom::prepare(sphere);
  const double epsilon = 0.02 * geom::bounding_box(p.solid.mesh()).diagonal();
  for (const Direction direction : {Direction::Outer, Direction::Inner}) {
    DecimateOptions o;
    o.direction = direction;
    o.epsilon = epsilon;
    const std::size_t alone = decimate(p.solid, o).mesh.vertices.size();
    o.cost = Cost::Distance;
    o.effort = Effort::Normal;
    const auto [input, log, r] = test::record(sphere, o);
    EXPECT_EQ(r.stop, Stop::ErrorBound);
    EXPECT_LT(5 * r.mesh.vertices.size(), 4 * alone);
    const auto checked = replay(input, log, r.mesh);
    EXPECT_TRUE(checked.verified) << checked.violation;
    const auto there = geom::directed_distance(p.solid.mesh(), geom::DistanceQuery(r.mesh));
    const auto back = geom::directed_distance(r.mesh, geom::DistanceQuery(p.solid.mesh()));
    EXPECT_LE(std::max(there.max_lower, back.max_lower), epsilon);
  }
}

double hausdorff(const geom::Mesh& a, const geom::Mesh& b) {
  return std::max(geom::directed_distance(a, geom::DistanceQuery(b)).max_upper,
                  geom::directed_distance(b, geom::DistanceQuery(a)).max_upper);
}

// Vertices of the input that are left, between others that were pulled back to it: no place bounds
// the present mesh, but some bound the original.
TEST(Decimate, TightMeshesFindFloat32Places) {
  const geom::Mesh bracket = examples::make_bracket();
  for (const Cost cost : {Cost::Planes, Cost::Triangles}) {
    DecimateOptions o = to_vertices(bracket.vertices.size() * 3 / 10);
    o.cost = cost;
    o.effort = Effort::Normal;
    o.precision = Precision::Float;
    const auto [input, log, r] = test::record(bracket, o);
    EXPECT_EQ(r.unrepresentable, 0U);
    EXPECT_GE(1000 * r.mesh.vertices.size(), 999 * *o.vertices);  // hardly any contracted away
    const auto checked = replay(input, log, r.mesh);
    EXPECT_TRUE(checked.verified) << checked.violation;
  }
}

// A waved foot in the plane z = 0: near 0, float32 is finer than what is computed with double.
TEST(Decimate, FlatFeetFindFloat32Places) {
  geom::Mesh foot = test::icosphere(4);
  for (geom::Vec3& p : foot.vertices) {
    const double wave = (p.x() * p.x() + p.y() * p.y()) * std::cos(17 * std::atan2(p.y(), p.x()));
    const double r = 30.1 * (1 + 0.15 * wave);
    p = {r * p.x() + 7.3, r * p.y() - 3.1, std::max(30.1 * p.z(), -10.0) + 10};
  }
  for (const Cost cost : {Cost::Planes, Cost::Distance}) {
    DecimateOptions o = to_vertices(foot.vertices.size() / 2);
    o.cost = cost;
    o.precision = Precision::Float;
    const auto [input, log, r] = test::record(foot, o);
    EXPECT_EQ(r.unrepresentable, 0U);
    EXPECT_EQ(r.mesh.vertices.size(), *o.vertices);  // none is contracted away
    const auto checked = replay(input, log, r.mesh);
    EXPECT_TRUE(checked.verified) << checked.violation;
  }
}

/// Cubes of the unit grid as one body, turned so that no coordinate is a float32 number.
geom::Mesh cubes(const std::vector<std::array<int, 3>>& filled) {
  geom::Mesh mesh;
  for (const std::array<int, 3>& cube : filled) {
    for (int k = 0; k < 3; ++k) {
      for (const int side : {0, 1}) {
        std::array<int, 3> beside = cube;
        beside[k] += side == 1 ? 1 : -1;
        if (std::find(filled.begin(), filled.end(), beside) != filled.end()) continue;
        const auto n = static_cast<std::uint32_t>(mesh.vertices.size());
        for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
          geom::Vec3 p(cube[0], cube[1], cube[2]);
          p[k] += side;
          p[(k + 1) % 3] += i;
          p[(k + 2) % 3] += j;
          mesh.vertices.push_back(p);
        }
        for (geom::Triangle t : {geom::Triangle{0, 1, 2}, {0, 2, 3}}) {
          if (side == 0) std::swap(t[1], t[2]);
          mesh.triangles.push_back({n + t[0], n + t[1], n + t[2]});
        }
      }
    }
  }
  return test::rotated(mesh, 0.7);
}

// The corner in the middle has faces of all directions: no point lies behind all their planes, and
// none is float32. Flipped edges give it room.
TEST(Decimate, VerticesWithoutRoomGetIt) {
  DecimateOptions o = to_vertices(20);
  o.direction = Direction::Inner;
  o.precision = Precision::Float;
  const auto [input, log, r] = test::record(cubes({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}}), o);
  EXPECT_EQ(r.unrepresentable, 0U);
  EXPECT_GT(r.statistics.flips, 0U);
  const auto checked = replay(input, log, r.mesh);
  EXPECT_TRUE(checked.verified) << checked.violation;
  EXPECT_EQ(verify::verify_inclusion(r.mesh, input).solid.answer, verify::Answer::Verified);
}

TEST(Decimate, EffortThatHasNoEffectIsRefused) {
  const auto open = geom::prepare(test::open_families().front().mesh);
  const auto closed = geom::prepare(solids().front().mesh);
  DecimateOptions o = to_vertices(open.solid.mesh().vertices.size() / 2);
  o.cost = Cost::Distance;
  o.effort = Effort::Normal;
  EXPECT_EQ(possible_effort(closed.solid, o), Effort::Normal);
  EXPECT_EQ(possible_effort(open.solid, o), Effort::Fast);
  EXPECT_THROW(decimate(open.solid, o), Error);
  o.effort = Effort::Fast;
  EXPECT_LT(decimate(open.solid, o).mesh.vertices.size(), open.solid.mesh().vertices.size());
  o.effort = Effort::Best;
  o.direction = Direction::Any;
  EXPECT_EQ(possible_effort(open.solid, o), Effort::Best);
  o.keep_convex = true;
  EXPECT_EQ(possible_effort(closed.solid, o), Effort::Fast);
}

TEST(Decimate, OptionsThatACostDoesNotUseAreRefused) {
  const auto p = geom::prepare(solids().front().mesh);
  for (const Cost cost : {Cost::Distance, Cost::Mean, Cost::Planes, Cost::PlanesAdapted,
                          Cost::PlanesDiagonal, Cost::Triangles}) {
    DecimateOptions o = to_vertices(p.solid.mesh().vertices.size() / 2);
    o.cost = cost;
    o.as_printed = true;
    if (cost == Cost::PlanesDiagonal)
      EXPECT_NO_THROW(decimate(p.solid, o));
    else
      EXPECT_THROW(decimate(p.solid, o), Error);
    o.as_printed = false;
    o.sharp_angle = 90;
    if (cost == Cost::Planes || cost == Cost::PlanesAdapted || cost == Cost::PlanesDiagonal)
      EXPECT_NO_THROW(decimate(p.solid, o));
    else
      EXPECT_THROW(decimate(p.solid, o), Error);
  }
}

// Small meshes are decimated again, within the distance that a first time led to, and nearer than
// levels of a series, which are made once; every step holds.
TEST(Decimate, SmallMeshesAreDecimatedWithinARisingBound) {
  const geom::Mesh sphere = test::scaled(test::icosphere(2), {1, 2, 0.5});
  const auto p = geom::prepare(sphere);
  for (const Direction direction : {Direction::Outer, Direction::Inner}) {
    DecimateOptions o = to_vertices(p.solid.mesh().vertices.size() / 5, direction);
    o.precision = Precision::Float;
    o.cost = Cost::Distance;
    o.effort = Effort::Normal;
    const auto [input, log, r] = test::record(sphere, o);
    EXPECT_EQ(r.stop, Stop::VertexTarget);
    EXPECT_EQ(r.mesh.vertices.size(), *o.vertices);
    EXPECT_EQ(r.steps.size(), log.steps.size());  // none of the first time
    EXPECT_EQ(r.mesh.vertices, decimate(p.solid, o).mesh.vertices);
    const auto checked = replay(input, log, r.mesh);
    EXPECT_TRUE(checked.verified) << checked.violation;
    const std::size_t requested = *std::exchange(o.vertices, std::nullopt);
    const auto once = decimate_series(p.solid, o, std::vector{requested});
    EXPECT_LT(hausdorff(p.solid.mesh(), r.mesh),
              0.95 * hausdorff(p.solid.mesh(), once.front().mesh));
  }
}

// Hardly any contraction: nothing has been reached that joint ones could go by.
TEST(Decimate, FewContractionsStayNear) {
  const auto p = geom::prepare(test::icosphere(5));
  DecimateOptions o = to_vertices(p.solid.mesh().vertices.size() * 9 / 10);
  const double fast = hausdorff(p.solid.mesh(), decimate(p.solid, o).mesh);
  o.cost = Cost::Distance;
  o.effort = Effort::Normal;
  EXPECT_LE(hausdorff(p.solid.mesh(), decimate(p.solid, o).mesh), 1.2 * fast);
}

TEST(Decimate, KeepsConvexity) {
  int tried = 0;
  for (const auto& f : solids()) {
    if (!f.convex) continue;
    ++tried;
    const auto p = geom::prepare(f.mesh);
    for (const Direction direction : {Direction::Outer, Direction::Inner}) {
      for (const Precision precision : {Precision::Double, Precision::Float}) {
        DecimateOptions o =
            to_vertices(std::max<std::size_t>(8, p.solid.mesh().vertices.size() / 4), direction);
        o.keep_convex = true;
        o.precision = precision;
        const auto r = decimate(p.solid, o);
        EXPECT_TRUE(geom::is_convex(r.mesh)) << f.name;
        if (direction == Direction::Outer && precision == Precision::Double &&
            f.name != "sliver-cylinder") {
          EXPECT_LT(r.mesh.vertices.size(), p.solid.mesh().vertices.size()) << f.name;
        }
      }
    }
  }
  EXPECT_GE(tried, 3);
  for (const auto& f : solids()) {
    if (geom::is_convex(geom::prepare(f.mesh).solid.mesh())) continue;
    DecimateOptions o = to_vertices(8);
    o.keep_convex = true;
    EXPECT_THROW(decimate(geom::prepare(f.mesh).solid, o), Error) << f.name;
  }
}

// Appendix A.2 says that the cost of triangle centres alone keeps convex meshes convex. It does
// not.
TEST(Decimate, TrianglesCostAloneLosesConvexity) {
  int lost = 0;
  for (const auto& f : solids()) {
    if (!f.convex) continue;
    const auto p = geom::prepare(f.mesh);
    DecimateOptions o = to_vertices(p.solid.mesh().vertices.size() * 2 / 3);
    o.cost = Cost::Triangles;
    lost += !geom::is_convex(geom::weld(decimate(p.solid, o).mesh));
  }
  EXPECT_GT(lost, 0);
}

// Powers of two change no rounding, so the result must be the same but for the factor.
TEST(Decimate, DoesNotDependOnTheScale) {
  for (const auto& f : solids()) {
    if (f.mesh.triangles.size() > 400) continue;
    const auto p = geom::prepare(f.mesh);
    for (const Method& m : methods(f)) {
      const DecimateOptions o = with(m, to_vertices(p.solid.mesh().vertices.size() / 5 + 4));
      const auto r = decimate(p.solid, o);
      for (const int exponent : {-20, 20}) {
        geom::Mesh scaled = f.mesh;
        for (auto& v : scaled.vertices) v *= std::ldexp(1.0, exponent);
        const auto s = decimate(geom::prepare(scaled).solid, o);
        ASSERT_EQ(s.mesh.triangles, r.mesh.triangles) << f.name;
        for (std::size_t i = 0; i < r.mesh.vertices.size(); ++i)
          ASSERT_EQ(s.mesh.vertices[i], r.mesh.vertices[i] * std::ldexp(1.0, exponent)) << f.name;
      }
    }
  }
}

// Other factors and far offsets round the input differently, and a greedy choice may then fall
// another way: no violation, and the same distance on the average over the families.
TEST(Decimate, IsAsGoodAtAnyScaleAndFarFromTheOrigin) {
  if (largest() < 1500) GTEST_SKIP() << "so few families have no average";
  for (const double factor : {1e-6, 1e6, 1.0}) {
    double log_ratios = 0;
    int cases = 0;
    for (const auto& f : solids()) {
      // Corners that lie on edges do not after rounding: another mesh, not the same one moved.
      if (f.name.starts_with("t-junctions")) continue;
      if (f.mesh.triangles.size() > 1500 || f.mesh.triangles.size() < 200) continue;
      const auto p = geom::prepare(f.mesh);
      const double diagonal = geom::bounding_box(p.solid.mesh()).diagonal();
      geom::Mesh moved = f.mesh;
      for (auto& v : moved.vertices)
        v = factor == 1 ? geom::Vec3(v + 1e4 * diagonal * geom::Vec3(1, -0.7, 0.3))
                        : geom::Vec3(factor * v);
      const auto q = geom::prepare(moved);
      const DecimateOptions to_quarter = to_vertices(p.solid.mesh().vertices.size() / 4 + 4);
      const double reference =
          hausdorff(p.solid.mesh(), decimate(p.solid, to_quarter).mesh) / diagonal;
      const auto [input, log, r] = test::record(moved, to_quarter);
      EXPECT_TRUE(replay(input, log, r.mesh).verified) << f.name << " " << factor;
      const double there =
          hausdorff(q.solid.mesh(), r.mesh) / geom::bounding_box(q.solid.mesh()).diagonal();
      EXPECT_LE(there, 2 * reference + 1e-7) << f.name << " " << factor;
      log_ratios += std::log((there + 1e-7) / (reference + 1e-7));
      ++cases;
    }
    ASSERT_GT(cases, 10);
    EXPECT_LE(std::exp(log_ratios / cases), 1.1) << "factor " << factor;
    EXPECT_GE(std::exp(log_ratios / cases), 0.9) << "factor " << factor;
  }
}

TEST(Decimate, ProgressMayCancel) {
  test::Family big;
  for (auto& f : test::closed_families())
    if (f.solid && f.mesh.vertices.size() > big.mesh.vertices.size()) big = std::move(f);
  DecimateOptions o = to_vertices(4);
  struct Cancelled {};
  o.progress = [](std::size_t) { throw Cancelled{}; };
  const auto p = geom::prepare(big.mesh);
  ASSERT_GT(p.solid.mesh().vertices.size(), 1100U) << "the largest family gives no progress";
  EXPECT_THROW(decimate(p.solid, o), Cancelled);
}

}  // namespace
