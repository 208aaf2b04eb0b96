// Spheres of a robot that are shared out to its links, against the best split of bars whose numbers
// are known; and meshes that spheres are not found for.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/certify/sphere_shares.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/robot/robot_file.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

#include "support/shapes.h"
#include "support/temporary_folder.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;

/// Two links, bars of these lengths that are 1 wide and high.
constexpr double kLong = 8, kShort = 2;
constexpr const char* kBars = R"(<robot name="bars">
  <link name="long"><collision><geometry><mesh filename="long.off"/></geometry></collision></link>
  <link name="short"><collision><geometry><box size="2 1 1"/></geometry></collision></link>
  <link name="none"/>
  <joint name="j" type="fixed"><parent link="long"/><child link="short"/></joint>
  <joint name="k" type="fixed"><parent link="short"/><child link="none"/></joint>
</robot>)";

class SphereShares : public ::testing::Test {
 protected:
  void SetUp() override {
    io::write_file(folder_ / "long.off",
                   io::serialise_mesh(test::box({kLong, 1, 1}, 1), io::Format::Off));
    std::ofstream(folder_ / "bars.urdf") << kBars;
  }
  [[nodiscard]] robot::RobotFile bars() const {
    return robot::read_robot((folder_ / "bars.urdf").string());
  }
  static RobotRequest request() {
    RobotRequest out;
    out.set.body_kind = SetRequest::BodyKind::Spheres;
    out.set.effort = bcd::Effort::Fast;
    out.set.nearest = true;
    out.partial = true;
    return out;
  }
  [[nodiscard]] std::size_t count_of_shared(std::size_t spheres, SphereShare share) const {
    const CertifiedBodies made = shared(spheres, share);
    return made.artefact().size();
  }
  CertifiedBodies shared(std::size_t spheres, SphereShare share) const {
    RobotRequest asked = request();
    asked.epsilons = share_spheres(bars(), asked, spheres, share);
    return certify_bodies(bars(), asked);
  }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

/// Of n balls in a row, each of which holds one n-th of a bar's length: the farthest point.
double distance_in_a_row(double length, std::size_t n) {
  const double half = 0.5 * length / static_cast<double>(n);
  return std::sqrt(half * half + 0.5) - 0.5;
}

/// The least that a split of so many spheres to the two bars gives.
double least_of_splits(std::size_t spheres, SphereShare share) {
  double out = std::numeric_limits<double>::infinity();
  for (std::size_t n = 1; n < spheres; ++n) {
    const double a = distance_in_a_row(kLong, n), b = distance_in_a_row(kShort, spheres - n);
    out = std::min(out, share == SphereShare::Mean ? 0.5 * (a + b) : std::max(a, b));
  }
  return out;
}

// One epsilon is found within 5 %, then what it allows is brought nearer in steps of 4 %.
constexpr double kAccuracy = 1.1;

TEST_F(SphereShares, AreAsNearAsTheBestSplit) {
  for (const std::size_t spheres : {3U, 10U}) {
    const CertifiedBodies farthest = shared(spheres, SphereShare::Farthest),
                          mean = shared(spheres, SphereShare::Mean);
    for (const CertifiedBodies* made : {&farthest, &mean})
      EXPECT_LE(made->artefact().size(), spheres);
    EXPECT_LE(farthest.certificate().distance,
              kAccuracy * least_of_splits(spheres, SphereShare::Farthest))
        << spheres;
    EXPECT_LE(mean_distance(mean), kAccuracy * least_of_splits(spheres, SphereShare::Mean))
        << spheres;
  }
}

// Of two links that are alike, one epsilon gives both as many; the third sphere is used all the
// same.
TEST_F(SphereShares, WhatIsLeftIsUsed) {
  std::ofstream(folder_ / "bars.urdf") << R"(<robot name="twins">
  <link name="a"><collision><geometry><box size="2 1 1"/></geometry></collision></link>
  <link name="b"><collision><geometry><box size="2 1 1"/></geometry></collision></link>
  <joint name="j" type="fixed"><parent link="a"/><child link="b"/></joint>
</robot>)";
  const CertifiedBodies made = shared(3, SphereShare::Farthest);
  EXPECT_EQ(made.artefact().size(), 3U);
  const double one = distance_in_a_row(kShort, 1), two = distance_in_a_row(kShort, 2);
  EXPECT_LE(made.certificate().distance, kAccuracy * one);
  EXPECT_LE(mean_distance(made), kAccuracy * 0.5 * (one + two));
}

TEST_F(SphereShares, OneForEachIsTheFewest) {
  EXPECT_EQ(count_of_shared(2, SphereShare::Mean), 2U);
  try {
    shared(1, SphereShare::Farthest);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_NE(std::string(error.what()).find("are 2 spheres; the budget is less"),
              std::string::npos)
        << error.what();
  }
}

TEST_F(SphereShares, AMeshThatNoneAreFoundForHasLargerOnes) {
  RobotRequest asked = request();
  asked.set.nearest = false;
  asked.set.epsilon = Length{0.2};
  asked.shapes.links = {"long"};
  const CertifiedBodies within = certify_bodies(bars(), asked);
  const std::size_t needed = within.artefact().size();
  asked.set.most_spheres = needed - 1;
  const CertifiedBodies larger = certify_bodies(bars(), asked);
  ASSERT_EQ(larger.certificate().meshes.size(), 1U);
  const CertifiedLinkMesh& mesh = larger.certificate().meshes[0];
  EXPECT_TRUE(mesh.held);
  EXPECT_NE(mesh.flaw.find("It has spheres within 0.4 instead"), std::string::npos) << mesh.flaw;
  EXPECT_GT(larger.certificate().distance, 0.2);
  EXPECT_LE(larger.certificate().distance, 0.4 * (1 + 1e-6));
  EXPECT_LT(larger.artefact().size(), needed);
  EXPECT_GT(larger.artefact().size(), 0U);

  // Not of its own accord; and not by any distance.
  asked.partial = false;
  EXPECT_THROW(certify_bodies(bars(), asked), Error);
  asked.partial = true;
  asked.set.most_spheres = 1;
  EXPECT_THROW(certify_bodies(bars(), asked), Error);
}

// Trials of a budget, too: what has larger spheres is not within epsilon.
TEST_F(SphereShares, LargerSpheresAreNotWithinABudgetsEpsilon) {
  RobotRequest asked = request();
  asked.set.most_spheres = 5;
  asked.epsilons = share_spheres(bars(), asked, 40, SphereShare::Farthest);
  const CertifiedBodies made = certify_bodies(bars(), asked);
  for (const CertifiedLinkMesh& mesh : made.certificate().meshes) EXPECT_EQ(mesh.flaw, "");
  EXPECT_LE(made.certificate().distance, 1.06 * distance_in_a_row(kLong, 5));
}

}  // namespace
}  // namespace kaboum::certify
