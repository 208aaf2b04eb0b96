#include "error_bound_certificate.h"

#include <gtest/gtest.h>

namespace {

using kaboum::bmesh::ErrorBoundCertificate;
using kaboum::geom::Mesh;
using kaboum::geom::Vec3;

// A square of four triangles around a middle vertex.
const Mesh kSquare{{{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}, {-1, 1, 0}, {0, 0, 0}},
                   {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}}};

std::vector<ErrorBoundCertificate::NewTriangle> raised(double z) {
  const auto& v = kSquare.vertices;
  const Vec3 top(0, 0, z);
  return {{0, {v[0], v[1], top}},
          {1, {v[1], v[2], top}},
          {2, {v[2], v[3], top}},
          {3, {v[3], v[0], top}}};
}

TEST(ErrorBoundCertificate, AdmitsUpToEpsilonAndNoFurther) {
  const std::vector<std::uint32_t> removed{0, 1, 2, 3};
  EXPECT_TRUE(ErrorBoundCertificate(kSquare, 0.1).admits(removed, raised(0.0999)));
  EXPECT_FALSE(ErrorBoundCertificate(kSquare, 0.1).admits(removed, raised(0.1001)));
}

// Each small step is within ε of the one before; the original is what counts.
TEST(ErrorBoundCertificate, DoesNotDrift) {
  ErrorBoundCertificate tolerance(kSquare, 0.1);
  const std::vector<std::uint32_t> removed{0, 1, 2, 3};
  for (const double z : {0.05, 0.09}) {
    ASSERT_TRUE(tolerance.admits(removed, raised(z)));
    tolerance.commit(removed);
  }
  EXPECT_FALSE(tolerance.admits(removed, raised(0.14)));
  EXPECT_TRUE(tolerance.admits(removed, raised(-0.05)));
}

// The new surface is near the old one everywhere, but leaves most of the old one bare.
TEST(ErrorBoundCertificate, AlsoWatchesTheOriginal) {
  ErrorBoundCertificate tolerance(kSquare, 0.1);
  const std::vector<std::uint32_t> removed{0, 1, 2, 3};
  const std::vector<ErrorBoundCertificate::NewTriangle> corner{
      {0, {Vec3(-1, -1, 0), Vec3(-0.8, -1, 0), Vec3(-1, -0.8, 0)}}};
  EXPECT_FALSE(tolerance.admits(removed, corner));
  EXPECT_FALSE(tolerance.admits(removed, {}));
}

// Two big triangles instead of four: pieces must be split between them.
TEST(ErrorBoundCertificate, SplitsPiecesBetweenCarriers) {
  ErrorBoundCertificate tolerance(kSquare, 0.01);
  const auto& v = kSquare.vertices;
  const std::vector<std::uint32_t> removed{0, 1, 2, 3};
  const std::vector<ErrorBoundCertificate::NewTriangle> halves{{0, {v[0], v[1], v[2]}},
                                                               {1, {v[0], v[2], v[3]}}};
  ASSERT_TRUE(tolerance.admits(removed, halves));
  tolerance.commit(removed);
  const std::vector<ErrorBoundCertificate::NewTriangle> other{{0, {v[0], v[1], v[3]}},
                                                              {1, {v[1], v[2], v[3]}}};
  const std::vector<std::uint32_t> two{0, 1};
  EXPECT_TRUE(tolerance.admits(two, other));
}

// Where all pieces of a triangle come together again, it is cut anew, or is one again; where some
// are carried by others, it stays in pieces.
TEST(ErrorBoundCertificate, MergesPiecesOfOneTriangle) {
  const auto& v = kSquare.vertices;
  const std::vector<std::uint32_t> four{0, 1, 2, 3}, two{0, 1}, one{0};
  const std::vector<ErrorBoundCertificate::NewTriangle> halves{{0, {v[0], v[1], v[2]}},
                                                               {1, {v[0], v[2], v[3]}}},
      other{{0, {v[0], v[1], v[3]}}, {1, {v[1], v[2], v[3]}}}, lifted{{0, {v[0], v[1], {1, 1, 1}}}};
  ErrorBoundCertificate tolerance(kSquare, 0.01);
  EXPECT_EQ(tolerance.pieces(), 4);
  ASSERT_TRUE(tolerance.admits(four, halves));
  tolerance.commit(four);
  EXPECT_EQ(tolerance.pieces(), 4) << "each of the halves has two";
  ASSERT_TRUE(tolerance.admits(two, other));
  tolerance.commit(two);
  EXPECT_EQ(tolerance.pieces(), 4) << "no more by the other diagonal";
  // Two triangles of other shapes: pieces.
  const Vec3 p(0.5, -1, 0);
  const std::vector<ErrorBoundCertificate::NewTriangle> slanted{
      {0, {v[0], p, v[3]}}, {1, {p, v[2], v[3]}}, {2, {p, v[1], v[2]}}};
  ASSERT_TRUE(tolerance.admits(two, slanted));
  tolerance.commit(two);
  const std::size_t cut = tolerance.pieces();
  EXPECT_GT(cut, 4);
  EXPECT_FALSE(tolerance.admits(one, lifted)) << "and nothing changes";
  ASSERT_TRUE(tolerance.admits(one, std::vector{slanted[0]}));
  tolerance.commit(one);
  EXPECT_EQ(tolerance.pieces(), cut);
  const std::vector<std::uint32_t> three{0, 1, 2};
  EXPECT_FALSE(tolerance.admits(three, raised(0.02)));
  ASSERT_TRUE(tolerance.admits(three, raised(0)));
  tolerance.commit(three);
  EXPECT_EQ(tolerance.pieces(), 4);
}

}  // namespace
