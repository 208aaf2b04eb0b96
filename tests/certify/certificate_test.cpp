// Certificates in one shape: what each artefact claims, and as JSON.

#include <gtest/gtest.h>
#include <kaboum/certify/convex_set.h>
#include <kaboum/certify/enclosure.h>
#include <kaboum/certify/mesh.h>
#include <kaboum/certify/wrap.h>

#include <nlohmann/json.hpp>
#include <set>
#include <string>

#include "support/shapes.h"

namespace kaboum::certify {
namespace {

using Kind = Claim::Kind;
using verify::Answer;

geom::Mesh torus() { return test::torus(1, 0.3, 16, 8); }

/// A cube whose last face is missing.
geom::Mesh open_box() {
  geom::Mesh mesh = test::box({1, 1, 1}, 1);
  mesh.triangles.resize(mesh.triangles.size() - 2);
  return mesh;
}

std::set<Kind> kinds_of(const Certificate& certificate) {
  std::set<Kind> out;
  for (const Claim& claim : certificate.claims) out.insert(claim.kind);
  return out;
}

SetRequest fast() {
  SetRequest request;
  request.epsilon = Length{5, true};
  request.effort = bcd::Effort::Fast;
  return request;
}

TEST(CertificateOf, ACoverSaysWhatWasDecidedAndHowFar) {
  const auto set = certify_set(torus(), "", fast());
  ASSERT_TRUE(set);
  const Certificate c = certificate_of(*set);
  EXPECT_EQ(c.direction, Certificate::Direction::Outer);
  EXPECT_EQ(c.subject, "the input");
  EXPECT_EQ(kinds_of(c),
            (std::set{Kind::Convex, Kind::Solid, Kind::Surface, Kind::ResultToOriginal}));
  EXPECT_TRUE(c.holds());
  ASSERT_TRUE(c.distance);
  EXPECT_EQ(c.distance->upper, set->certificate().distance_upper);
  EXPECT_GT(c.distance->upper, 0);
}

TEST(CertificateOf, AnInnerSetSpeaksOfDepth) {
  SetRequest request = fast();
  request.direction = SetRequest::Direction::Inner;
  const auto set = certify_set(torus(), "", request);
  ASSERT_TRUE(set);
  const Certificate c = certificate_of(*set);
  EXPECT_EQ(c.direction, Certificate::Direction::Inner);
  EXPECT_EQ(kinds_of(c), (std::set{Kind::Convex, Kind::Solid, Kind::Depth}));
}

TEST(CertificateOf, AFilledHoleIsPartOfTheSubject) {
  const auto set = certify_set(open_box(), "", fast());
  ASSERT_TRUE(set);
  EXPECT_NE(certificate_of(*set).subject, "the input");
}

TEST(CertificateOf, ABoundingMeshStatesHausdorffsDistance) {
  MeshRequest request;
  request.vertices = {60};
  const auto made = certify_mesh(prepare_mesh(torus()), request);
  ASSERT_TRUE(made);
  const Certificate c = certificate_of(*made);
  EXPECT_TRUE(c.holds());
  ASSERT_TRUE(c.distance);
  EXPECT_EQ(c.distance->upper, made->certificate().hausdorff_upper());
}

TEST(CertificateOf, AMeshOfAnyDirectionClaimsNothing) {
  MeshRequest request;
  request.vertices = {60};
  request.direction = bmesh::Direction::Any;
  request.decide = false;
  const auto made = certify_mesh(prepare_mesh(torus()), request);
  ASSERT_TRUE(made);
  const Certificate c = certificate_of(*made);
  EXPECT_EQ(c.direction, Certificate::Direction::Any);
  EXPECT_TRUE(c.claims.empty());
  EXPECT_FALSE(c.holds());
}

TEST(CertificateOf, AWrapHoldsEveryTriangle) {
  const auto wrap = certify_wrap(open_box(), {});
  const Certificate c = certificate_of(wrap);
  EXPECT_EQ(kinds_of(c), (std::set{Kind::Surface, Kind::ResultToOriginal}));
  EXPECT_TRUE(c.holds());
}

TEST(Certificate, HoldsOnlyWhereNothingIsRefutedOrOpen) {
  Certificate c;
  EXPECT_FALSE(c.holds());  // of nothing
  for (const Answer answer : {Answer::Refuted, Answer::Undecided}) {
    c.claims = {{.kind = Kind::Convex, .basis = Basis::Bytes, .answer = Answer::Verified},
                {.kind = Kind::Solid, .basis = Basis::Bytes, .answer = answer}};
    EXPECT_FALSE(c.holds());
  }
  c.claims.back().answer = Answer::Undefined;
  EXPECT_TRUE(c.holds());
}

TEST(Certificate, AsJsonHasTheSameKeysForAll) {
  Certificate c{.direction = Certificate::Direction::Inner,
                .subject = "the input",
                .claims = {},
                .distance = {}};
  c.claims = {
      {.kind = Kind::Depth, .basis = Basis::Measured, .answer = Answer::Verified, .distance = 0.25},
      {.kind = Kind::Solid,
       .basis = Basis::Bytes,
       .answer = Answer::Undecided,
       .reason = "a limit"}};
  const auto j = nlohmann::json::parse(to_json(c));
  EXPECT_EQ(j["direction"], "inner");
  EXPECT_EQ(j["of"], "the input");
  EXPECT_TRUE(j["distance"].is_null());
  EXPECT_EQ(j["claims"][0]["distance"], 0.25);
  EXPECT_EQ(j["claims"][1]["reason"], "a limit");
  EXPECT_EQ(j["claims"][1]["answer"], "undecided");
}

}  // namespace
}  // namespace kaboum::certify
