// Which shapes of a result are to hold which of the original's.
#include <gtest/gtest.h>
#include <kaboum/verify/matching_shapes.h>

#include <cmath>

namespace kaboum::test {
namespace {

using robot::Geometry;
using verify::Answer;
using verify::MatchedShapes;
using Shape = Geometry::Shape;

Geometry shape(Shape kind, double x, double size = 1) {
  Geometry g;
  g.shape = kind;
  g.origin.translation.x() = x;
  g.size.setConstant(size);
  return g;
}

TEST(MatchingShapes, OneFrameIsOneGroup) {
  const std::vector<Geometry> original{shape(Shape::Mesh, 0), shape(Shape::Box, 0),
                                       shape(Shape::Mesh, 1), shape(Shape::Mesh, 0)};
  const std::vector<Geometry> result{shape(Shape::Mesh, 0), shape(Shape::Mesh, 0, 2),
                                     shape(Shape::Mesh, 0), shape(Shape::Box, 0)};
  const std::vector<MatchedShapes> matches = verify::match_shapes(original, result);
  ASSERT_EQ(matches.size(), 3U);
  EXPECT_EQ(matches[0].originals, (std::vector<std::size_t>{0, 3}));
  EXPECT_EQ(matches[0].there, (std::vector<std::size_t>{0, 2}));  // not the one of another scale
  EXPECT_EQ(matches[0].elsewhere, 2U);
  EXPECT_EQ(matches[1].originals, (std::vector<std::size_t>{1}));
  EXPECT_EQ(matches[1].there, (std::vector<std::size_t>{3}));
  EXPECT_EQ(matches[2].originals, (std::vector<std::size_t>{2}));
  EXPECT_TRUE(matches[2].there.empty());
  EXPECT_EQ(matches[2].elsewhere, 4U);
}

// The last bit of a place is a difference.
TEST(MatchingShapes, FramesAreComparedBitByBit) {
  const auto matches =
      verify::match_shapes({shape(Shape::Mesh, 1)}, {shape(Shape::Mesh, std::nextafter(1.0, 2.0))});
  EXPECT_TRUE(matches[0].there.empty());
}

TEST(MatchingShapes, BoxesAreFoundAgain) {
  const Geometry box = shape(Shape::Box, 0), flat = shape(Shape::Box, 0, 0);
  const auto found = [](const Geometry& g, const std::vector<Geometry>& result) {
    return verify::find_again(g, verify::match_shapes({g}, result).front());
  };
  EXPECT_EQ(found(box, {shape(Shape::Box, 0)}), Answer::Verified);
  EXPECT_EQ(found(box, {shape(Shape::Box, 0, 2)}), Answer::Undecided);
  EXPECT_EQ(found(box, {}), Answer::Refuted);
  EXPECT_EQ(found(flat, {}), Answer::Undecided);
}

TEST(MatchingShapes, OthersMayHoldWhatIsNotHeld) {
  MatchedShapes alone, beside;
  beside.elsewhere = 1;
  EXPECT_EQ(verify::beside_others(Answer::Refuted, alone), Answer::Refuted);
  EXPECT_EQ(verify::beside_others(Answer::Refuted, beside), Answer::Undecided);
  EXPECT_EQ(verify::beside_others(Answer::Verified, beside), Answer::Verified);
}

TEST(MatchingShapes, Strangers) {
  const std::vector<Geometry> original{shape(Shape::Mesh, 0), shape(Shape::Box, 0)};
  EXPECT_EQ(verify::count_strangers(original, original), 0U);
  EXPECT_EQ(verify::count_strangers(
                original, {shape(Shape::Mesh, 0), shape(Shape::Mesh, 1), shape(Shape::Sphere, 0)}),
            2U);
  EXPECT_EQ(verify::count_strangers({}, original), 2U);
}

// A length of the robot is divided by the largest factor: what is near enough by that is so by all.
TEST(MatchingShapes, BoundsOfScaledMeshes) {
  const auto even = verify::scaled_bound({0.5, false}, 7, {2, 2, 2});
  EXPECT_EQ(even.bound, 0.25);
  EXPECT_FALSE(even.uneven);
  const auto uneven = verify::scaled_bound({0.5, false}, 7, {2, 4, 2});
  EXPECT_EQ(uneven.bound, 0.125);
  EXPECT_TRUE(uneven.uneven);
  const auto percent = verify::scaled_bound({50, true}, 7, {2, 4, 2});
  EXPECT_EQ(percent.bound, 3.5);
  EXPECT_FALSE(percent.uneven);

  verify::HeldDistance distance;
  EXPECT_EQ(answer_of(distance, even), Answer::Undecided);
  distance.claim.emplace().answer = Answer::Refuted;
  EXPECT_EQ(answer_of(distance, even), Answer::Refuted);
  EXPECT_EQ(answer_of(distance, uneven), Answer::Undecided);
  distance.claim->answer = Answer::Verified;
  EXPECT_EQ(answer_of(distance, uneven), Answer::Verified);
}

}  // namespace
}  // namespace kaboum::test
