/// Random unions of boxes and of prisms, whose parts are known: what covers them is decided by the
/// exact arrangement, which shares nothing with the library or the checker.

#include <gtest/gtest.h>
#include <kaboum/bcd/cover.h>
#include <kaboum/geom/convex_hull.h>

#include <random>

#include "solids.h"
#include "support/arrangement_oracle.h"
#include "support/oracle.h"
#include "support/shapes.h"

namespace kaboum::bcd {
namespace {

using geom::ConvexBody;
using geom::Mesh;
using geom::Vec3;
using verify::Answer;

/// A solid and convex bodies whose union it is.
struct KnownUnion {
  Mesh mesh;
  std::vector<ConvexBody> parts;
};

Mesh box_between(const Vec3& low, const Vec3& high) {
  return kaboum::test::translated(kaboum::test::box(high - low, 1), low);
}

/// The boundary of a union of boxes of a lattice, all coordinates multiples of 1/8.
KnownUnion union_of_boxes(std::mt19937& random, int count) {
  constexpr int kCells = 5;
  std::uniform_int_distribution<int> place(0, kCells), step(1, 4);
  std::array<std::vector<double>, 3> planes;
  for (std::vector<double>& axis : planes) {
    double x = 0;
    for (int i = 0; i <= kCells; ++i, x += 0.125 * step(random)) axis.push_back(x);
  }
  struct Box {
    std::array<int, 3> low, high;
  };
  std::vector<Box> boxes;
  KnownUnion out;
  while (boxes.size() < static_cast<std::size_t>(count)) {
    Box box{};
    Vec3 low, high;
    bool empty = false;
    for (std::size_t k = 0; k < 3; ++k) {
      const int a = place(random), b = place(random);
      box.low[k] = std::min(a, b);
      box.high[k] = std::max(a, b);
      empty = empty || a == b;
      low[static_cast<int>(k)] = planes[k][static_cast<std::size_t>(box.low[k])];
      high[static_cast<int>(k)] = planes[k][static_cast<std::size_t>(box.high[k])];
    }
    if (empty) continue;
    boxes.push_back(box);
    out.parts.push_back({"", box_between(low, high)});
  }
  out.mesh = test::lattice_solid(planes, [&](int x, int y, int z) {
    const std::array<int, 3> c{x, y, z};
    return std::any_of(boxes.begin(), boxes.end(), [&](const Box& box) {
      for (std::size_t k = 0; k < 3; ++k)
        if (c[k] < box.low[k] || c[k] >= box.high[k]) return false;
      return true;
    });
  });
  return out;
}

/// Convex prisms with corners on a lattice, across random axes, put into each other as they are:
/// the solid is where the winding number is at least one.
KnownUnion union_of_prisms(std::mt19937& random, int count) {
  std::uniform_int_distribution<int> coordinate(-8, 8), axis(0, 2);
  KnownUnion out;
  std::vector<Mesh> all;
  while (all.size() < static_cast<std::size_t>(count)) {
    const int k = axis(random);
    const int low = coordinate(random);
    std::vector<Vec3> points;
    for (int i = 0; i < 5; ++i) {
      Vec3 p;
      p[(k + 1) % 3] = 0.125 * coordinate(random);
      p[(k + 2) % 3] = 0.125 * coordinate(random);
      for (const int z : {low, low + 5}) {
        p[k] = 0.125 * z;
        points.push_back(p);
      }
    }
    if (const auto hull = geom::convex_hull(points)) {
      all.push_back(*hull);
      out.parts.push_back({"", *hull});
    }
  }
  out.mesh = kaboum::test::merged(all);
  return out;
}

/// Whether the bodies cover the mesh's solid and triangles, decided by the exact arrangement.
bool truly_covered(const Mesh& mesh, const std::vector<ConvexBody>& bodies) {
  std::vector<Mesh> hulls;
  hulls.reserve(bodies.size());
  for (const ConvexBody& body : bodies) hulls.push_back(body.core);
  const auto verdict = kaboum::test::arrangement_verdict(mesh, kaboum::test::merged(hulls));
  return *verdict.solid && *verdict.surface;
}

/// Random points of the solid, inside ones, in a body.
int expect_points_covered(const Mesh& mesh, const std::vector<ConvexBody>& bodies,
                          std::mt19937& random, int count) {
  const geom::Box3 box = geom::bounding_box(mesh);
  std::uniform_real_distribution<double> unit(0, 1);
  int inside = 0;
  for (int i = 0; i < count; ++i) {
    const Vec3 p =
        box.min + (box.max - box.min).cwiseProduct(Vec3(unit(random), unit(random), unit(random)));
    const auto w = kaboum::test::winding_number_slow(mesh, p);
    if (w && *w < 1) continue;
    ++inside;
    EXPECT_TRUE(test::covered(bodies, p)) << p.transpose();
  }
  return inside;
}

ConvexBody shrunk(ConvexBody body) {
  const Vec3 center = geom::bounding_box(body.core).center();
  for (Vec3& p : body.core.vertices) p = center + (1 - 1e-6) * (p - center);
  return body;
}

std::vector<ConvexBody> without(std::vector<ConvexBody> bodies, std::size_t i) {
  bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(i));
  return bodies;
}

/// The checker's answer, which has to be the arrangement's.
bool agreed_cover(const Mesh& mesh, const std::vector<ConvexBody>& bodies) {
  const bool truth = truly_covered(mesh, bodies);
  EXPECT_EQ(test::cover_of(mesh, test::set_of(bodies)), truth ? Answer::Verified : Answer::Refuted);
  return truth;
}

TEST(Csg, UnionsAreCoveredByTheirPartsAndRefuteMutants) {
  std::mt19937 random(11);
  int refuted_missing = 0, refuted_shrunk = 0;
  for (int trial = 0; trial < 6; ++trial) {
    SCOPED_TRACE(trial);
    const KnownUnion known =
        trial % 2 == 0 ? union_of_boxes(random, 3) : union_of_prisms(random, 3);
    EXPECT_TRUE(agreed_cover(known.mesh, known.parts));
    for (std::size_t i = 0; i < known.parts.size(); ++i) {
      if (!agreed_cover(known.mesh, without(known.parts, i))) ++refuted_missing;
      std::vector<ConvexBody> mutant = known.parts;
      mutant[i] = shrunk(mutant[i]);
      if (!agreed_cover(known.mesh, mutant)) ++refuted_shrunk;
    }
  }
  EXPECT_GE(refuted_missing, 12);
  EXPECT_GE(refuted_shrunk, 12);
}

TEST(Csg, UnionsAreDecomposedIntoAboutTheirParts) {
  std::mt19937 random(5);
  std::size_t parts = 0, found = 0;
  int refuted = 0, mutants = 0;
  for (int trial = 0; trial < 4; ++trial) {
    SCOPED_TRACE(trial);
    const KnownUnion known =
        trial % 2 == 0 ? union_of_boxes(random, 3) : union_of_prisms(random, 3);
    const geom::Prepared input = geom::prepare(known.mesh);
    const CoverCandidate result = find_cover(input.solid, test::quick(known.mesh, 1));
    EXPECT_EQ(result.stop, Stop::Done);
    test::expect_bodies(result.bodies, 64);
    EXPECT_TRUE(agreed_cover(input.solid.mesh(), result.bodies));
    EXPECT_GE(expect_points_covered(known.mesh, result.bodies, random, 300), 20);
    parts += known.parts.size();
    found += result.bodies.size();
    ++mutants;
    // A body may lie in others.
    bool needed = false;
    for (std::size_t i = 0; i < result.bodies.size() && !needed; ++i)
      needed = !agreed_cover(input.solid.mesh(), without(result.bodies, i));
    if (needed) ++refuted;
  }
  EXPECT_LE(found, 2 * parts);
  EXPECT_EQ(refuted, mutants);
}

/// Eight boxes round a point inside a cube. Where one of them lacks the corner there, every point
/// of the surface is covered, and the solid is not.
TEST(Csg, ACornerInsideTheSolidCannotBeLeftOut) {
  const Mesh cube = box_between(Vec3::Zero(), Vec3::Constant(2));
  std::vector<ConvexBody> octants;
  for (int i = 0; i < 8; ++i) {
    const Vec3 low((i & 1) != 0 ? 1 : 0, (i & 2) != 0 ? 1 : 0, (i & 4) != 0 ? 1 : 0);
    octants.push_back({"", box_between(low, low + Vec3::Ones())});
  }
  EXPECT_TRUE(agreed_cover(cube, octants));
  const Vec3 corner = Vec3::Ones();
  for (const double depth : {0.25, 0x1p-20}) {
    for (std::size_t i = 0; i < octants.size(); ++i) {
      std::vector<ConvexBody> mutant = octants;
      std::vector<Vec3> points;
      for (const Vec3& p : octants[i].core.vertices) {
        if (p != corner) {
          points.push_back(p);
          continue;
        }
        const Vec3 inward = geom::bounding_box(octants[i].core).center() - corner;
        for (int k = 0; k < 3; ++k)
          points.emplace_back(corner + 2 * depth * inward[k] * Vec3::Unit(k));
      }
      mutant[i].core = *geom::convex_hull(points);
      EXPECT_FALSE(truly_covered(cube, mutant));
      const verify::Cover cover = verify::verify_cover(cube, test::set_of(mutant));
      EXPECT_EQ(cover.convexity.convex.answer, Answer::Verified);
      EXPECT_EQ(cover.inclusion.surface.answer, Answer::Verified);
      EXPECT_EQ(cover.inclusion.solid.answer, Answer::Refuted);
    }
  }
}

}  // namespace
}  // namespace kaboum::bcd
