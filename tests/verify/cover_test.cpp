// Convex covers: verify_cover against decompositions whose truth is known, and the exact oracle.
#include <kaboum/verify/cover.h>

#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/predicates.h>

#include <Eigen/Geometry>
#include <algorithm>

#include "pairs.h"
#include "support/arrangement_oracle.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;        // NOLINT: a test
using namespace kaboum::test;  // NOLINT: a test
using geom::ConvexSet;
using verify::Answer;

ConvexSet set_of(const std::vector<Mesh>& bodies) {
  ConvexSet set;
  for (const Mesh& b : bodies) set.bodies.push_back({"body", b});
  return set;
}

Mesh whole_block(const Vec3& low, const Vec3& high) { return translated(box(high - low, 1), low); }

/// The boundary of an L, 2 × 2 × 1 without the upper right cube, by its cubes' outer faces.
Mesh ell() { return block_chain({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}); }

Answer answer_for(const std::optional<bool>& truth) {
  return truth.value() ? Answer::Verified : Answer::Refuted;
}

/// Both claims are as the oracle finds, and the solid claim is `expected`.
void expect_cover(const Mesh& original, const ConvexSet& set, Answer expected,
                  const std::string& what) {
  const auto cover = verify::verify_cover(original, set);
  EXPECT_EQ(cover.convexity.convex.answer, Answer::Verified)
      << what << ": " << cover.convexity.convex.reason;
  EXPECT_EQ(cover.inclusion.solid.answer, expected) << what;
  const auto truth = arrangement_verdict(original, verify::sum_of(set));
  EXPECT_EQ(cover.inclusion.solid.answer, answer_for(truth.solid)) << what;
  EXPECT_EQ(cover.inclusion.surface.answer, answer_for(truth.surface)) << what;
}

TEST(Cover, LInTwoBlocksTouchingOrOverlapping) {
  const Mesh left = whole_block({0, 0, 0}, {1, 2, 1}), right = whole_block({1, 0, 0}, {2, 1, 1});
  expect_cover(ell(), set_of({left, right}), Answer::Verified, "touching");
  expect_cover(ell(), set_of({left, whole_block({0, 0, 0}, {2, 1, 1})}), Answer::Verified,
               "overlapping");
  expect_cover(ell(), set_of({left}), Answer::Refuted, "one missing");
  expect_cover(ell(), set_of({whole_block({0, 0, 0}, {2, 2, 1})}), Answer::Verified, "hull");
  expect_cover(ell(), set_of({}), Answer::Refuted, "nothing");
  for (const double gap : {1e-3, 1e-10, 1e-15}) {
    expect_cover(ell(), set_of({left, translated(right, {gap, 0, 0})}), Answer::Refuted, "gap");
    expect_cover(ell(), set_of({left, translated(right, {-gap, 0, 0})}), Answer::Refuted, "short");
    expect_cover(ell(), set_of({left, translated(right, {0, 0, gap})}), Answer::Refuted, "lifted");
    expect_cover(ell(), set_of({left, whole_block({1 - gap, 0, 0}, {2 + gap, 1, 1})}),
                 Answer::Verified, "wider");
  }
}

/// All cubes of a 3 × 3 × 3 whole_block but some.
std::vector<Mesh> cubes_but(const std::vector<int>& missing) {
  std::vector<Mesh> bodies;
  for (int i = 0; i < 27; ++i) {
    if (std::find(missing.begin(), missing.end(), i) != missing.end()) continue;
    const Vec3 low(i % 3, i / 3 % 3, i / 9);
    bodies.push_back(whole_block(low, low + Vec3::Ones()));
  }
  return bodies;
}

TEST(Cover, VoidInTheMiddle) {
  const Mesh solid = box({3, 3, 3}, 2);
  const Mesh hollow = merged({solid, flipped(whole_block({1, 1, 1}, {2, 2, 2}))});
  expect_cover(solid, set_of(cubes_but({})), Answer::Verified, "all cubes");
  // Every triangle is covered, but not the solid.
  const auto cover = verify::verify_cover(solid, set_of(cubes_but({13})));
  EXPECT_EQ(cover.inclusion.surface.answer, Answer::Verified);
  expect_cover(solid, set_of(cubes_but({13})), Answer::Refuted, "void");
  expect_cover(hollow, set_of(cubes_but({13})), Answer::Verified, "void where the input has one");
  expect_cover(solid, set_of(cubes_but({4})), Answer::Refuted, "one of the surface missing");
  for (const double d : {1e-3, 1e-10}) {
    std::vector<Mesh> bodies = cubes_but({13});
    bodies.push_back(whole_block(Vec3::Constant(1 + d), Vec3::Constant(2)));
    expect_cover(solid, set_of(bodies), Answer::Refuted, "thin void");
    bodies.back() = whole_block(Vec3::Constant(1 - d), Vec3::Constant(2));
    expect_cover(solid, set_of(bodies), Answer::Verified, "void filled");
  }
  // The cubes share all their faces with one another; one moved by an ulp opens a gap.
  for (const int moved : {13}) {
    std::vector<Mesh> bodies = cubes_but({});
    for (Vec3& p : bodies[moved].vertices) p.x() = std::nextafter(p.x(), 9);
    expect_cover(solid, set_of(bodies), Answer::Refuted, "moved");
  }
}

// Four blocks leave one small hole: a cell whose sides are short parts of long cuts.
TEST(Cover, HoleAmongLongCuts) {
  const Mesh original = whole_block({0, 0, 0}, {3, 3, 1});
  for (const double x : {0.25, 1.5, 2.5}) {
    for (const double y : {0.125, 1.0, 2.25}) {
      for (const double width : {0.125, 0x1p-20}) {
        for (const double above : {0.0, 1.0}) {  // coplanar lids, or blocks that reach through
          const double low = -above, high = 1 + above;
          std::vector<Mesh> blocks{whole_block({0, 0, low}, {x, 3, high}),
                                   whole_block({x + width, 0, low}, {3, 3, high}),
                                   whole_block({0, 0, low}, {3, y, high}),
                                   whole_block({0, y + width, low}, {3, 3, high})};
          auto cover = verify::verify_cover(original, set_of(blocks));
          EXPECT_EQ(cover.inclusion.solid.answer, Answer::Refuted) << x << ' ' << y;
          EXPECT_EQ(cover.inclusion.surface.answer, Answer::Refuted) << x << ' ' << y;
          blocks.push_back(whole_block({x, y, low}, {x + width, y + width, high}));
          cover = verify::verify_cover(original, set_of(blocks));
          EXPECT_EQ(cover.inclusion.solid.answer, Answer::Verified) << x << ' ' << y;
          EXPECT_EQ(cover.inclusion.surface.answer, Answer::Verified) << x << ' ' << y;
        }
      }
    }
  }
}

TEST(Cover, OpenOriginalsAreCoveredByTheirTriangles) {
  Mesh open = ell();
  open.triangles.pop_back();
  const ConvexSet set =
      set_of({whole_block({0, 0, 0}, {1, 2, 1}), whole_block({1, 0, 0}, {2, 1, 1})});
  auto cover = verify::verify_cover(open, set);
  EXPECT_EQ(cover.inclusion.solid.answer, Answer::Undefined);
  EXPECT_EQ(cover.inclusion.surface.answer, Answer::Verified);
  cover = verify::verify_cover(open, set_of({whole_block({0, 0, 0}, {1, 2, 1})}));
  EXPECT_EQ(cover.inclusion.surface.answer, Answer::Refuted);
}

TEST(Cover, BodiesMustBeConvex) {
  const Mesh unit = whole_block({0, 0, 0}, {1, 1, 1});
  const auto fault = [&](const Mesh& body) {
    const auto cover = verify::verify_cover(unit, set_of({unit, body}));
    if (cover.convexity.convex.answer == Answer::Verified) return std::string("none");
    EXPECT_EQ(cover.convexity.convex.answer, Answer::Refuted);
    EXPECT_EQ(cover.convexity.not_convex.size(), 1U);
    if (!cover.convexity.not_convex.empty()) {
      EXPECT_EQ(cover.convexity.not_convex[0].first, 1U);
    }
    return cover.convexity.convex.reason;
  };
  EXPECT_EQ(fault(unit), "none");
  EXPECT_EQ(fault(icosphere(2)), "none");
  EXPECT_EQ(fault(merged({unit, unit})), "none");  // twice the same set of points
  EXPECT_NE(fault(ell()), "none");
  EXPECT_NE(fault(flipped(unit)), "none");
  EXPECT_NE(fault(Mesh{}), "none");
  EXPECT_NE(fault(merged({unit, whole_block({2, 0, 0}, {3, 1, 1})})), "none");
  EXPECT_NE(fault(Mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}), "none");
  Mesh open = unit;
  open.triangles.pop_back();
  EXPECT_NE(fault(open), "none");
  // A rotated box's rectangles are bent by an ulp: one diagonal of each is convex, the other not.
  int bent = 0;
  for (int i = 1; i <= 20; ++i) bent += fault(rotated(unit, 0.1 * i)) != "none" ? 1 : 0;
  EXPECT_GE(bent, 10);
  Mesh dented = icosphere(2);
  dented.vertices[5] *= 1 - 1e-10;
  dented.vertices[5] *= 0.9;
  EXPECT_NE(fault(dented), "none");
}

/// Both claims have the same answer; a witness of the solid claim is `depth` deep at most and
/// nearly.
void expect_margin(const Mesh& original, ConvexSet set, double margin, Answer expected,
                   double depth, const std::string& what) {
  set_margin(set, margin);
  const auto cover = verify::verify_cover(original, set);
  EXPECT_EQ(cover.inclusion.solid.answer, expected) << what << ' ' << margin;
  if (expected == Answer::Refuted) {
    ASSERT_TRUE(cover.inclusion.solid.witness.has_value()) << what;
    EXPECT_LE(cover.inclusion.solid.witness->depth, depth + 1e-12) << what << ' ' << margin;
    EXPECT_GT(cover.inclusion.solid.witness->depth, 0) << what << ' ' << margin;
  }
}

TEST(Cover, AMarginClosesGapsUpToHalfTheirWidth) {
  const Mesh left = whole_block({0, 0, 0}, {1, 2, 1}), right = whole_block({1, 0, 0}, {2, 1, 1});
  const ConvexSet set = set_of({left, translated(right, {0.25, 0, 0})});
  for (const double margin : {1e-9, 1e-3, 0.1, 0.1249}) {
    expect_margin(ell(), set, margin, Answer::Refuted, 0.125 - margin, "gap");
  }
  for (const double margin : {0.1251, 0.13, 0.5}) {
    expect_margin(ell(), set, margin, Answer::Verified, 0, "gap");
    ConvexSet with = set;
    set_margin(with, margin);
    EXPECT_EQ(verify::verify_cover(ell(), with).inclusion.surface.answer, Answer::Verified);
  }
  // The distance is the margin exactly: nothing may be said.
  ConvexSet equal = set;
  set_margin(equal, 0.125);
  verify::InclusionOptions soon;
  soon.max_cells = 20'000;
  EXPECT_EQ(verify::verify_cover(ell(), equal, soon).inclusion.solid.answer, Answer::Undecided);
  expect_margin(ell(), set_of({left, right}), 0.5, Answer::Verified, 0, "no gap");
  // The empty set has no margin.
  expect_margin(ell(), set_of({}), 100, Answer::Refuted, std::numeric_limits<double>::infinity(),
                "nothing");
}

// No triangle of the original is uncovered: only a search of the void itself finds the deep point.
// Layers that stick out within a margin that is hardly thicker: over several bodies and triangles,
// round an edge, however thin.
TEST(Cover, ThinLayersWithinAMargin) {
  verify::InclusionOptions few;
  few.max_cells = 3000;
  for (const double out : {1e-3, 1e-6, 1e-9}) {
    const Mesh grown = translated(box(Vec3::Constant(2 + 2 * out), 3), Vec3::Constant(-out));
    ConvexSet set = set_of({whole_block({0, 0, 0}, {2, 2, 2})});
    set_margin(set, 2 * out);  // more than at the corners, √3
    EXPECT_EQ(verify::verify_cover(grown, set, few).inclusion.solid.answer, Answer::Verified)
        << out;
    set_margin(set, 1.7 * out);
    EXPECT_NE(verify::verify_cover(grown, set, few).inclusion.solid.answer, Answer::Verified)
        << out;
  }
}

TEST(Cover, AMarginFillsVoidsUpToTheirInnerRadius) {
  const Mesh solid = box({3, 3, 3}, 2);
  const ConvexSet set = set_of(cubes_but({13}));
  for (const double margin : {0.01, 0.3, 0.49, 0.4999}) {
    expect_margin(solid, set, margin, Answer::Refuted, 0.5 - margin, "void");
  }
  for (const double margin : {0.501, 0.6}) {
    expect_margin(solid, set, margin, Answer::Verified, 0, "void");
  }
  // A void where the original has one too counts for nothing; nor does what is outside.
  const Mesh hollow = merged({solid, flipped(whole_block({1.1, 1.1, 1.1}, {1.9, 1.9, 1.9}))});
  expect_margin(hollow, set, 0.11, Answer::Verified, 0, "hollow");
  expect_margin(hollow, set, 0.09, Answer::Refuted, 0.01, "hollow");
  // Turned, so that no side of a cell is parallel to a face.
  std::vector<Mesh> turned;
  for (const auto& body : set.bodies) turned.push_back(rotated(body.core, 0.7));
  expect_margin(rotated(solid, 0.7), set_of(turned), 0.505, Answer::Verified, 0, "turned");
  expect_margin(rotated(solid, 0.7), set_of(turned), 0.495, Answer::Refuted, 0.005 + 1e-9,
                "turned");
}

struct Block {
  Vec3 low, high;
  [[nodiscard]] double distance(const Vec3& p) const {
    return (low - p).cwiseMax(p - high).cwiseMax(0.0).norm();
  }
};

// Random blocks over random unit cubes: membership and distances are a line each.
TEST(Cover, MarginsAgainstSamples) {
  std::array<int, 3> answers{};
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Random random(seed);
    const auto uniform = [&] { return static_cast<double>(random() % 100'000) / 100'000; };
    std::vector<std::array<int, 3>> cells{{0, 0, 0}};
    for (int i = 1; i < 8; ++i) {
      if (random() % 3 != 0) cells.push_back({i % 2, i / 2 % 2, i / 4});
    }
    std::vector<Block> blocks(3 + random() % 8);
    std::vector<Mesh> bodies;
    for (Block& b : blocks) {
      for (int k = 0; k < 3; ++k) {
        b.low[k] = 1.6 * uniform() - 0.6;
        b.high[k] = b.low[k] + 0.6 + 2 * uniform();
      }
      bodies.push_back(whole_block(b.low, b.high));
    }
    ConvexSet set = set_of(bodies);
    set_margin(set, 0.05 + 0.8 * uniform());
    const auto away = [&](const Vec3& p) {
      double least = std::numeric_limits<double>::infinity();
      for (const Block& b : blocks) least = std::min(least, b.distance(p));
      return least;
    };
    verify::InclusionOptions soon;
    soon.max_cells = 200'000;
    const verify::Claim claim = verify::verify_cover(block_chain(cells), set, soon).inclusion.solid;
    ++answers.at(static_cast<std::size_t>(claim.answer));
    if (claim.answer == Answer::Refuted) {
      ASSERT_TRUE(claim.witness.has_value()) << seed;
      const Vec3& p = claim.witness->point;
      EXPECT_NEAR(away(p) - margin_of(set).value(), claim.witness->depth, 1e-9) << seed;
      EXPECT_GT(away(p), margin_of(set).value()) << seed;
      EXPECT_TRUE(std::any_of(cells.begin(), cells.end(), [&](const std::array<int, 3>& c) {
        const Vec3 low(c[0], c[1], c[2]);
        return Block{low, low + Vec3::Ones()}.distance(p) == 0;
      })) << seed;
    } else if (claim.answer == Answer::Verified) {
      for (int i = 0; i < 20'000; ++i) {
        const std::array<int, 3>& c = cells[random() % cells.size()];
        const Vec3 p = Vec3(c[0], c[1], c[2]) + Vec3(uniform(), uniform(), uniform());
        ASSERT_LE(away(p), margin_of(set).value()) << seed;
      }
    }
  }
  EXPECT_GE(answers[static_cast<std::size_t>(Answer::Verified)], 8);
  EXPECT_GE(answers[static_cast<std::size_t>(Answer::Refuted)], 8);
  EXPECT_LE(answers[static_cast<std::size_t>(Answer::Undecided)], 4);
}

// Inner sets: what is deeper than epsilon inside the original must be in a body.
TEST(Depth, OfBlocksInACube) {
  const Mesh unit = box({1, 1, 1}, 3);
  const auto depth = [&](const std::vector<Mesh>& bodies, double epsilon) {
    return verify::verify_depth(unit, set_of(bodies), epsilon).answer;
  };
  const Mesh inset = whole_block(Vec3::Constant(0.125), Vec3::Constant(0.875));
  EXPECT_EQ(depth({unit}, 1e-6), Answer::Verified);
  EXPECT_EQ(depth({inset}, 0.126), Answer::Verified);
  EXPECT_EQ(depth({inset}, 0.124), Answer::Refuted);
  EXPECT_EQ(depth({}, 0.499), Answer::Refuted);
  EXPECT_EQ(depth({}, 0.501), Answer::Verified);
  // A gap between two bodies is as deep as it is far from the surface, however thin.
  const std::vector<Mesh> halves{whole_block(Vec3::Zero(), {0.5, 1, 1}),
                                 whole_block({0.5 + 0x1p-10, 0, 0}, {1, 1, 1})};
  EXPECT_EQ(depth(halves, 0.4), Answer::Refuted);
  verify::InclusionOptions few;  // boxes at the common face do not tell, the exact claim does
  few.max_cells = 3000;
  const ConvexSet both = set_of({halves[0], whole_block({0.5, 0, 0}, {1, 1, 1})});
  EXPECT_EQ(verify::verify_depth(unit, both, 1e-3, few).answer, Answer::Verified);
  const auto claim = verify::verify_depth(unit, set_of({inset}), 0.1);
  ASSERT_TRUE(claim.witness.has_value());
  EXPECT_LE(claim.witness->depth, 0.025 + 1e-9);
}

// Bodies overlap by little more than rounding; their common faces reach the original's surface, and
// no direction is that of an axis. Only what both leave together tells what is in neither.
TEST(Depth, OfPartsThatBarelyOverlap) {
  const Mesh ball = icosphere(3);
  const auto depth = [&](double overlap, double epsilon) {
    std::vector<Mesh> bodies;
    for (const double side : {-1.0, 1.0}) {
      std::vector<Vec3> points;
      for (const Vec3& p : ball.vertices) {
        const Vec3 inside = 0.99 * p;
        if (side * inside.x() > 0) points.push_back(inside);
        const double x = -side * overlap / 2;
        points.emplace_back(x, std::sqrt(1 - x * x) * 0.98 * p.normalized().y(),
                            std::sqrt(1 - x * x) * 0.98 * p.normalized().z());
      }
      bodies.push_back(rotated(*geom::convex_hull(points), 0.7));
    }
    verify::InclusionOptions soon;
    soon.max_cells = 30'000;
    return verify::verify_depth(rotated(ball, 0.7), set_of(bodies), epsilon, soon).answer;
  };
  EXPECT_EQ(depth(1e-7, 0.1), Answer::Verified);
  EXPECT_EQ(depth(0x1p-45, 0.1), Answer::Undecided);
  EXPECT_NE(depth(-1e-7, 0.1), Answer::Verified);
  EXPECT_EQ(depth(-1e-2, 0.1), Answer::Refuted);
}

// Turned blocks in a turned cube, many of which barely overlap: membership and depth are a line
// each.
TEST(Depth, AgainstSamples) {
  std::array<int, 3> answers{};
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const auto uniform = [&] { return static_cast<double>(random() % 100'000) / 100'000; };
    const auto turn = [&] {
      return Eigen::Quaterniond(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5, 1)
          .normalized()
          .toRotationMatrix();
    };
    const auto turned = [](Mesh mesh, const Eigen::Matrix3d& r) {
      for (Vec3& v : mesh.vertices) v = r * v;
      return *geom::convex_hull(mesh.vertices);
    };
    const Eigen::Matrix3d frame = turn();
    const Mesh original = turned(whole_block(Vec3::Constant(-1), Vec3::Constant(1)), frame);
    // Slabs side by side, overlapping by next to nothing, in a direction of their own.
    const Eigen::Matrix3d slabs = turn();
    std::vector<Block> blocks;
    const double overlap = std::pow(10, -2 - 6 * uniform());
    for (double x = -1.8; x < 1.8;) {
      const double next = x + 0.3 + uniform();
      const double wide = 1.75 - 0.9 * uniform() * (seed % 2 == 0 ? 0 : 1);
      blocks.push_back({{x - overlap, -wide, -1.75}, {next, 1.75, wide}});
      x = next + (seed % 5 == 0 && blocks.size() == 2 ? 2 * overlap : 0);
    }
    std::vector<Mesh> bodies;
    for (const Block& b : blocks) bodies.push_back(turned(whole_block(b.low, b.high), slabs));
    const double epsilon = 0.05 + 0.2 * uniform();
    verify::InclusionOptions soon;
    soon.max_cells = 50'000;
    const verify::Claim claim = verify::verify_depth(original, set_of(bodies), epsilon, soon);
    ++answers.at(static_cast<std::size_t>(claim.answer));
    const auto outside = [&](const Vec3& at, double by) {
      const Vec3 p = slabs.transpose() * at;
      return std::all_of(blocks.begin(), blocks.end(), [&](const Block& b) {
        return (b.low - p).cwiseMax(p - b.high).maxCoeff() > by;
      });
    };
    const auto depth = [&](const Vec3& p) {
      return 1 - (frame.transpose() * p).cwiseAbs().maxCoeff();
    };
    if (claim.answer == Answer::Refuted) {
      ASSERT_TRUE(claim.witness.has_value()) << seed;
      EXPECT_TRUE(outside(claim.witness->point, -1e-12)) << seed;
      EXPECT_GT(depth(claim.witness->point), epsilon) << seed;
    } else if (claim.answer == Answer::Verified) {
      for (int i = 0; i < 20'000; ++i) {
        Vec3 p = frame * (2 * Vec3(uniform(), uniform(), uniform()) - Vec3::Ones());
        if (i % 2 == 0) {  // near where two slabs meet
          p = slabs.transpose() * p;
          p.x() = blocks[random() % blocks.size()].low.x() + overlap * (2 * uniform() - 0.5);
          p = slabs * p;
        }
        if (!outside(p, 1e-12)) continue;
        ASSERT_LE(depth(p), epsilon) << seed;
      }
    }
  }
  EXPECT_GE(answers[static_cast<std::size_t>(Answer::Verified)], 8);
  EXPECT_GE(answers[static_cast<std::size_t>(Answer::Refuted)], 4);
  EXPECT_LE(answers[static_cast<std::size_t>(Answer::Undecided)], 12);
}

// Bodies that overlap all over: what is left out is found without the lines in which they meet, of
// which there are too many here.
TEST(Depth, OfBodiesThatOverlapManyTimes) {
  Random random(18);
  const auto uniform = [&] { return static_cast<double>(random() % 100'000) / 50'000 - 1; };
  const Mesh ball = icosphere(2);
  std::vector<Mesh> bodies;
  for (int i = 0; i < 60; ++i) {
    const Vec3 centre = Vec3(uniform(), uniform(), uniform()).normalized() * 0.4;
    std::vector<Vec3> points;
    points.reserve(60);
    for (int k = 0; k < 60; ++k)
      points.push_back(centre + 0.5 * Vec3(uniform(), uniform(), uniform()).normalized());
    bodies.push_back(*geom::convex_hull(points));
  }
  const auto in_a_body = [&](const Vec3& p) {
    return std::any_of(bodies.begin(), bodies.end(), [&](const Mesh& body) {
      return std::all_of(body.triangles.begin(), body.triangles.end(),
                         [&](const geom::Triangle& t) {
                           return geom::orient3d(body.vertices[t[0]], body.vertices[t[1]],
                                                 body.vertices[t[2]], p) != geom::Sign::Positive;
                         });
    });
  };
  double deepest = 0;
  for (int i = 0; i < 200'000; ++i) {
    const Vec3 p(uniform(), uniform(), uniform());
    double depth = 2;
    for (const geom::Triangle& t : ball.triangles) {
      const Vec3 &a = ball.vertices[t[0]], &b = ball.vertices[t[1]], &c = ball.vertices[t[2]];
      depth = std::min(depth, (b - a).cross(c - a).normalized().dot(a - p));
      if (depth <= deepest) break;
    }
    if (depth > deepest && !in_a_body(p)) deepest = depth;
  }
  ASSERT_GT(deepest, 0.05);
  verify::InclusionOptions few;
  few.max_contacts = 2000;
  int verified = 0;
  for (const double share : {0.5, 0.9, 0.999, 1.2, 1.5, 2.0}) {
    const verify::Claim claim = verify::verify_depth(ball, set_of(bodies), share * deepest, few);
    if (share < 1) {
      EXPECT_EQ(claim.answer, Answer::Refuted) << share;
      ASSERT_TRUE(claim.witness.has_value());
      EXPECT_FALSE(in_a_body(claim.witness->point)) << share;
      EXPECT_EQ(claim.inner_triangles.size(), 1U);
    }
    EXPECT_NE(claim.answer, Answer::Undecided) << share;
    verified += claim.answer == Answer::Verified ? 1 : 0;
  }
  EXPECT_GE(verified, 1);
}

/// Where a point was before `rotated`.
Vec3 back(const Vec3& p, double angle) { return rotated(Mesh{{p}, {}}, -angle).vertices.front(); }

// Originals of blocks that run through one another, so that hardly a triangle bounds the solid as a
// whole; every other one turned, so that corners of its triangles' parts are rounded, with blocks a
// little larger, as what touches would be parted by rounding. How deep a point is the empty cubes
// of a grid tell.
TEST(Depth, OfOriginalsThatCutThemselves) {
  constexpr int kSide = 6;
  std::array<int, 3> answers{};
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Random random(seed);
    const auto uniform = [&] { return static_cast<double>(random() % 100'000) / 100'000; };
    const double inset = 0.1 + 0.6 * uniform();
    std::vector<Mesh> blocks, bodies;
    std::vector<Block> of_original, of_bodies;
    for (int i = 0; i < 4; ++i) {
      Vec3 low, high;
      for (int k = 0; k < 3; ++k) {
        low[k] = static_cast<double>(random() % (kSide - 1));
        high[k] = std::min<double>(kSide, low[k] + 2 + static_cast<double>(random() % 3));
      }
      const Vec3 grown = Vec3::Constant(seed % 2 == 0 ? 0 : 1e-3 * (i + 1));
      blocks.push_back(whole_block(low - grown, high + grown));
      of_original.push_back({low, high});
      const Vec3 by = Vec3::Constant(inset);
      if (((high - low).array() <= 2 * inset).any() || seed % 3 == 0) continue;
      bodies.push_back(whole_block(low + by, high - by));
      of_bodies.push_back({low + by, high - by});
    }
    std::vector<Block> empty;
    for (int c = 0; c < (kSide + 2) * (kSide + 2) * (kSide + 2); ++c) {
      const std::array<int, 3> at{c % (kSide + 2) - 1, c / (kSide + 2) % (kSide + 2) - 1,
                                  c / (kSide + 2) / (kSide + 2) - 1};
      const Vec3 low(at[0], at[1], at[2]);
      const Block cube{low, low + Vec3::Ones()};
      if (std::none_of(of_original.begin(), of_original.end(),
                       [&](const Block& b) { return b.distance(low + Vec3::Constant(0.5)) == 0; }))
        empty.push_back(cube);
    }
    const auto depth = [&](const Vec3& p) {
      double least = 100;
      for (const Block& b : empty) least = std::min(least, b.distance(p));
      return least;
    };
    const auto in_a_body = [&](const Vec3& p) {
      return std::any_of(of_bodies.begin(), of_bodies.end(),
                         [&](const Block& b) { return b.distance(p) == 0; });
    };
    const double epsilon = 0.15 + 1.2 * uniform();
    verify::InclusionOptions soon;
    soon.max_cells = 10'000;
    const double angle = seed % 2 == 0 ? 0 : 0.7;
    const double loose = angle == 0 ? 0 : 0.02;
    for (Mesh& b : bodies) b = *geom::convex_hull(rotated(b, angle).vertices);
    const verify::Claim claim =
        verify::verify_depth(rotated(merged(blocks), angle), set_of(bodies), epsilon, soon);
    ++answers.at(static_cast<std::size_t>(claim.answer));
    if (claim.answer == Answer::Refuted) {
      ASSERT_TRUE(claim.witness.has_value()) << seed;
      const Vec3 at = back(claim.witness->point, angle);
      EXPECT_FALSE(in_a_body(at)) << seed;
      EXPECT_GT(depth(at), epsilon - loose) << seed;
    } else if (claim.answer == Answer::Verified) {
      for (int i = 0; i < 4000; ++i) {
        const Vec3 p = kSide * Vec3(uniform(), uniform(), uniform());
        if (in_a_body(p)) continue;
        ASSERT_LE(depth(p), epsilon + loose) << seed;
      }
    }
  }
  EXPECT_EQ(answers[static_cast<std::size_t>(Answer::Undecided)], 0);
  EXPECT_GE(answers[static_cast<std::size_t>(Answer::Verified)], 3);
  EXPECT_GE(answers[static_cast<std::size_t>(Answer::Refuted)], 8);
}

// Two beams that touch by a part of a face each: the deepest ball reaches through it.
TEST(Depth, OfBlocksThatTouchByAFace) {
  const double deepest = 2 - std::sqrt(2);
  for (const double angle : {0.0, 0.7}) {
    // Turned, they overlap instead, as rounding would part them.
    const Mesh lying = whole_block({2, 0, 3}, {angle == 0 ? 3 : 3.01, 4, 4});
    const Mesh standing = whole_block({3, 0, 1}, {4, 4, 4});
    const auto depth = [&](const std::vector<Mesh>& bodies, double epsilon) {
      std::vector<Mesh> turned;
      for (const Mesh& b : bodies) turned.push_back(*geom::convex_hull(rotated(b, angle).vertices));
      const Mesh original = rotated(merged({lying, standing}), angle);
      return verify::verify_depth(original, set_of(turned), epsilon).answer;
    };
    EXPECT_EQ(depth({}, deepest * 1.001), Answer::Verified) << angle;
    EXPECT_EQ(depth({}, deepest * 0.999), Answer::Refuted) << angle;
    EXPECT_EQ(depth({}, 0.525), Answer::Refuted) << angle;
    // Bodies that hold all but a shell; one that is missing, or too small, is not forgiven.
    const Mesh long_one = whole_block({2.2, 0.2, 3.2}, {3.8, 3.8, 3.8});
    const Mesh high_one = whole_block({3.2, 0.2, 1.2}, {3.8, 3.8, 3.8});
    EXPECT_EQ(depth({long_one, high_one}, 0.3), Answer::Verified) << angle;
    EXPECT_EQ(depth({long_one}, 0.3), Answer::Refuted) << angle;
    EXPECT_EQ(depth({high_one}, 0.3), Answer::Refuted) << angle;
    EXPECT_EQ(depth({long_one, whole_block({3.2, 0.6, 1.2}, {3.8, 3.8, 3.8})}, 0.3),
              Answer::Refuted)
        << angle;
  }
}

// A fold inside the original, and a part that is inside out, are no part of its boundary: what is
// near them only is deep all the same.
TEST(Depth, FoldsAreNoBoundary) {
  const Mesh unit = box({1, 1, 1}, 3);
  const Mesh within = whole_block(Vec3::Constant(0.25), Vec3::Constant(0.75));
  const auto depth = [&](const Mesh& original, double epsilon) {
    verify::InclusionOptions soon;
    soon.max_cells = 30'000;
    return verify::verify_depth(original, set_of({}), epsilon, soon).answer;
  };
  EXPECT_EQ(depth(merged({unit, flipped(within)}), 0.26), Answer::Verified);  // a cavity
  const Mesh doubled = merged({unit, within});
  EXPECT_EQ(depth(doubled, 0.26), Answer::Refuted);
  EXPECT_EQ(depth(doubled, 0.49), Answer::Refuted);
  EXPECT_EQ(depth(doubled, 0.51), Answer::Verified);
  EXPECT_EQ(depth(doubled, 0.1), Answer::Refuted);
}

TEST(Cover, ReachInsideCavitiesThatTheBodiesFill) {
  // [0,10]³ without [3,7]³, closed and with a narrow neck: the deepest point is in the middle.
  const Mesh cube = whole_block(Vec3::Zero(), Vec3::Constant(10));
  const Mesh hollow = merged({cube, flipped(whole_block(Vec3::Constant(3), Vec3::Constant(7)))});
  const ConvexSet set = set_of({cube});
  EXPECT_EQ(verify::verify_excess(set, hollow, 2.01, true).answer, Answer::Verified);
  const auto beyond = verify::verify_excess(set, hollow, 1.99, true);
  EXPECT_EQ(beyond.answer, Answer::Refuted);
  EXPECT_GT(beyond.largest, 1.99);
  EXPECT_LE(beyond.largest, 2);
  EXPECT_EQ(verify::verify_excess(set, hollow, 0.1, true).answer, Answer::Refuted);
  std::vector<std::array<int, 3>> cells;
  for (int i = 0; i < 27; ++i) {
    if (i != 13 && i != 22) cells.push_back({i % 3, i / 3 % 3, i / 9});
  }
  const Mesh bottle = block_chain(cells);
  const ConvexSet all = set_of({whole_block(Vec3::Zero(), Vec3::Constant(3))});
  EXPECT_EQ(verify::verify_excess(all, bottle, 0.6, true).answer, Answer::Verified);
  EXPECT_EQ(verify::verify_excess(all, bottle, 0.45, true).answer, Answer::Refuted);
}

// Walls about which nothing winds, and sheets, are to be covered like all triangles: so what covers
// them is not far away. The depth inside what is inside out counts from its walls.
TEST(Cover, ReachFromTrianglesThatBoundNoSolid) {
  const Mesh unit = whole_block({0, 0, 0}, {1, 1, 1});
  const auto grown = [](const Vec3& low, const Vec3& high) {
    return whole_block(low - Vec3::Constant(0.1), high + Vec3::Constant(0.1));
  };
  const Mesh plate = whole_block({5, 0, 0}, {6, 1, 0.25});
  const Mesh turned = merged({unit, flipped(plate)});
  const ConvexSet set = set_of({grown({0, 0, 0}, {1, 1, 1}), grown({5, 0, 0}, {6, 1, 0.25})});
  EXPECT_EQ(verify::verify_excess(set, turned, 0.18, true).answer, Answer::Verified);
  EXPECT_EQ(verify::verify_excess(set, turned, 0.17, true).answer, Answer::Refuted);
  const ConvexSet cube = set_of({grown({0, 0, 0}, {1, 1, 1})});
  EXPECT_EQ(verify::verify_excess(cube, flipped(unit), 0.51, true).answer, Answer::Verified);
  EXPECT_EQ(verify::verify_excess(cube, flipped(unit), 0.49, true).answer, Answer::Refuted);

  Mesh half = plate;
  half.triangles.resize(2);
  const Mesh sheet = merged({half, flipped(half)});
  EXPECT_EQ(verify::verify_excess(set_of({grown({5, 0, 0}, {6, 1, 0})}), sheet, 1.42, true).answer,
            Answer::Verified);
}

TEST(Cover, ReachAlongASlantedSeam) {
  // The L of three unit cubes, cut from its outer to its inner corner: nothing is outside it.
  const auto prism = [](const std::vector<Vec3>& base) {
    std::vector<Vec3> points = base;
    for (const Vec3& p : base) points.push_back(p + Vec3::UnitZ());
    return *geom::convex_hull(points);
  };
  const Mesh letter = block_chain({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
  const auto cut = [&](double end) {
    return set_of({prism({{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {1, 1, 0}}),
                   prism({{0, 0, 0}, {0, 2, 0}, {end, 2, 0}, {1, 1, 0}})});
  };
  for (const double epsilon : {1e-2, 1e-6, 1e-12})
    EXPECT_EQ(verify::verify_excess(cut(1), letter, epsilon, true).answer, Answer::Verified);
  // A wedge that sticks out by 1/8 at its end.
  EXPECT_EQ(verify::verify_excess(cut(1.125), letter, 0.126, true).answer, Answer::Verified);
  const auto beyond = verify::verify_excess(cut(1.125), letter, 0.124, true);
  EXPECT_EQ(beyond.answer, Answer::Refuted);
  EXPECT_GT(beyond.largest, 0.124);
  const Mesh sum = verify::sum_of(cut(1.125));
  const geom::Triangle& named = sum.triangles[beyond.triangle];
  EXPECT_TRUE(std::any_of(named.begin(), named.end(),
                          [&](std::uint32_t v) { return sum.vertices[v].x() == 1.125; }));
}

TEST(Cover, ReachWithAMargin) {
  const Mesh unit = whole_block({0, 0, 0}, {1, 1, 1});
  ConvexSet set = set_of({whole_block({0, 0, 0}, {1.25, 1, 1})});
  set_margin(set, 0.125);
  EXPECT_EQ(verify::verify_excess(set, unit, 0.376, true).answer, Answer::Verified);
  const auto beyond = verify::verify_excess(set, unit, 0.374, true);
  EXPECT_EQ(beyond.answer, Answer::Refuted);
  EXPECT_GT(beyond.largest, 0.374);
  EXPECT_LE(beyond.largest, 0.375);
  EXPECT_EQ(verify::verify_excess(set, unit, 0.2, true).answer, Answer::Refuted);
  // Between two blocks: the margin leads from one to the other.
  const Mesh two = merged({unit, whole_block({1.25, 0, 0}, {2, 1, 1})});
  const auto between =
      verify::verify_excess(set_of({whole_block({0, 0, 0}, {1.125, 1, 1})}), two, 0.2, true);
  EXPECT_EQ(between.answer, Answer::Verified);
  set = set_of({whole_block({0, 0, 0}, {1.125, 1, 1})});
  set_margin(set, 0.125);
  EXPECT_EQ(verify::verify_excess(set, two, 0.178, true).answer, Answer::Verified);
  EXPECT_EQ(verify::verify_excess(set, two, 0.176, true).answer, Answer::Refuted);
  // Of what is no box, no more is known than that its core is nearer than epsilon less the margin.
  std::vector<Vec3> corners = set.bodies[0].core.vertices;
  corners.emplace_back(0.5, 0.5, 1.01);
  set = set_of({*geom::convex_hull(corners)});
  set_margin(set, 0.125);
  EXPECT_EQ(verify::verify_excess(set, two, 0.2, true).answer, Answer::Undecided);
}

TEST(Cover, RandomBoxesOverRandomCubes) {
  int yes = 0, no = 0;
  for (std::uint64_t seed = 0; seed < 14; ++seed) {
    Random random(seed);
    std::vector<std::array<int, 3>> cells;
    for (int i = 0; i < 8; ++i) {
      if (random() % 4 != 0) cells.push_back({i % 2, i / 2 % 2, i / 4});
    }
    if (cells.empty()) continue;
    const Mesh original = block_chain(cells);
    std::vector<Mesh> bodies;
    for (int i = 0; i < 7; ++i) {
      Vec3 low, high;
      for (int k = 0; k < 3; ++k) {
        low[k] = static_cast<double>(random() % 2);
        high[k] = low[k] + 1 + static_cast<double>(random() % 2);
      }
      if (random() % 4 == 0) high.x() += std::ldexp(1, -40);
      bodies.push_back(whole_block(low, high));
    }
    const ConvexSet set = set_of(bodies);
    const auto answer = verify::verify_cover(original, set).inclusion.solid.answer;
    const auto truth = arrangement_verdict(original, verify::sum_of(set));
    EXPECT_EQ(answer, answer_for(truth.solid)) << seed;
    EXPECT_EQ(verify::verify_cover(original, set).inclusion.surface.answer,
              answer_for(truth.surface))
        << seed;
    ++(answer == Answer::Verified ? yes : no);
  }
  EXPECT_GE(yes, 2);
  EXPECT_GE(no, 2);
}

}  // namespace
