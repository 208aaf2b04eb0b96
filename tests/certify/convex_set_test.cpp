// Certified sets: what is returned is what is in the container, holds by the verifier, and comes
// out of the cache only for the request that it was made for.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/certify/mesh.h>
#include <kaboum/certify/robot.h>
#include <kaboum/certify/set_cache.h>
#include <kaboum/certify/sweep.h>
#include <kaboum/geom/triangle_search.h>
#include <kaboum/geom/width.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <string_view>
#include <type_traits>
#include <utility>

#include "set_record.h"
#include "support/shapes.h"
#include "support/temporary_folder.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;

SetRequest fast_request(double percent) {
  SetRequest request;
  request.epsilon = kaboum::Length{percent, true};
  request.effort = bcd::Effort::Fast;
  request.source = "torus.off";
  return request;
}

geom::Mesh coarse_torus() { return test::torus(1, 0.3, 24, 12); }

bool same_bodies(const geom::ConvexSet& a, const geom::ConvexSet& b) {
  if (a.bodies.size() != b.bodies.size()) return false;
  for (std::size_t i = 0; i < a.bodies.size(); ++i)
    if (a.bodies[i].core.vertices != b.bodies[i].core.vertices ||
        a.bodies[i].core.triangles != b.bodies[i].core.triangles)
      return false;
  return true;
}

TEST(CertifySet, IsWhatItsContainerHolds) {
  const auto made = certify_set(coarse_torus(), "abc", fast_request(5));
  ASSERT_TRUE(made);
  const geom::ConvexSet back =
      io::parse_convex_set(made->bytes(), io::Format::Glb, "the container");
  EXPECT_TRUE(same_bodies(made->artefact(), back));
  EXPECT_EQ(back.provenance.source_sha256, "abc");
  EXPECT_EQ(back.provenance.parameters, "--epsilon 5% --max-vertices-per-body 64 --effort fast");
  EXPECT_EQ(back.provenance.epsilon, made->certificate().distance_upper);
  EXPECT_EQ(made->certificate().stop, bcd::Stop::Done);
  EXPECT_LE(made->certificate().distance_upper, 0.05 * made->certificate().diagonal);
  const verify::Cover cover = verify::verify_cover(coarse_torus(), made->artefact());
  EXPECT_EQ(cover.inclusion.solid.answer, verify::Answer::Verified);
  EXPECT_EQ(cover.inclusion.surface.answer, verify::Answer::Verified);
}

TEST(CertifySet, InnerSetsLieInside) {
  SetRequest request = fast_request(3);
  request.direction = SetRequest::Direction::Inner;
  const auto made = certify_set(coarse_torus(), "", request);
  ASSERT_TRUE(made);
  ASSERT_FALSE(made->artefact().bodies.empty());
  const verify::Inclusion inside =
      verify::verify_inclusion(verify::sum_of(made->artefact()), coarse_torus());
  EXPECT_EQ(inside.solid.answer, verify::Answer::Verified);
}

TEST(CertifySet, InnerSpheresLieInsideAndLeaveOutNothingDeep) {
  SetRequest request = fast_request(4);
  request.direction = SetRequest::Direction::Inner;
  request.body_kind = SetRequest::BodyKind::Spheres;
  request.source = "torus.off";
  const auto made = certify_set(coarse_torus(), "abc", request);
  ASSERT_TRUE(made);
  const SetCertificate& c = made->certificate();
  EXPECT_EQ(c.stop, bcd::Stop::Done);
  EXPECT_TRUE(c.depth_decided);
  EXPECT_EQ(c.distance_upper, 0.04 * c.diagonal);
  const geom::ConvexSet back =
      io::parse_convex_set(made->bytes(), io::Format::Glb, "the container");
  EXPECT_TRUE(same_bodies(made->artefact(), back));
  EXPECT_EQ(back.provenance.direction, "inner");
  EXPECT_FALSE(back.provenance.covers_solid);
  EXPECT_EQ(back.provenance.parameters,
            "--epsilon 4% --bodies spheres --direction inner --max-vertices-per-body 64 --effort "
            "fast");
  ASSERT_GT(back.bodies.size(), 5U);
  for (const geom::ConvexBody& body : back.bodies) {
    EXPECT_EQ(body.core.vertices.size(), 1U);
    EXPECT_GT(body.radius, 0);
  }
  EXPECT_EQ(verify::verify_within(back, coarse_torus()).solid.answer, verify::Answer::Verified);
  EXPECT_EQ(verify::verify_depth(coarse_torus(), back, *back.provenance.epsilon).answer,
            verify::Answer::Verified);
  EXPECT_NE(to_json(*made).find("\"depth\":{\"answer\":\"verified\""), std::string::npos);
  const Certificate claims = certificate_of(*made);
  EXPECT_EQ(claims.claims.back().kind, Claim::Kind::Depth);
  EXPECT_EQ(claims.claims.back().basis, Basis::Bytes);
  EXPECT_TRUE(read_record(write_record(c)).depth_decided);
  // Of polytopes it is measured.
  request.body_kind = SetRequest::BodyKind::Polytopes;
  const auto polytopes = certify_set(coarse_torus(), "abc", request);
  ASSERT_TRUE(polytopes);
  EXPECT_FALSE(polytopes->certificate().depth_decided);
  EXPECT_EQ(to_json(*polytopes).find("\"depth\""), std::string::npos);
  EXPECT_EQ(certificate_of(*polytopes).claims.back().basis, Basis::Measured);
}

// Deep nowhere: no sphere, and that nothing is left out is decided all the same.
TEST(CertifySet, InnerSpheresOfAThinPlateAreNone) {
  SetRequest request = fast_request(5);
  request.direction = SetRequest::Direction::Inner;
  request.body_kind = SetRequest::BodyKind::Spheres;
  const auto made = certify_set(test::box({4, 4, 0.1}, 1), "", request);
  ASSERT_TRUE(made);
  EXPECT_TRUE(made->artefact().bodies.empty());
  EXPECT_TRUE(made->certificate().depth_decided);
}

TEST(CertifySet, NoOtherKindLiesInside) {
  SetRequest request = fast_request(5);
  request.direction = SetRequest::Direction::Inner;
  for (const auto kind :
       {SetRequest::BodyKind::Capsules, SetRequest::BodyKind::Boxes, SetRequest::BodyKind::Mixed}) {
    request.body_kind = kind;
    EXPECT_THROW(certify_set(coarse_torus(), "", request), Error);
  }
}

/// Triangles that share nothing, some of which cross.
geom::Mesh soup() {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> at(-1, 1);
  geom::Mesh out;
  for (std::uint32_t t = 0; t < 5; ++t) {
    for (int k = 0; k < 3; ++k) out.vertices.emplace_back(at(random), at(random), at(random));
    out.triangles.push_back({3 * t, 3 * t + 1, 3 * t + 2});
  }
  return out;
}

/// The largest height of p above the planes of a body's facets, of bodies the least.
double height_above(const geom::ConvexSet& set, const geom::Vec3& p) {
  double nearest = std::numeric_limits<double>::infinity();
  for (const geom::ConvexBody& body : set.bodies) {
    double highest = -nearest;
    for (const auto& [i, j, k] : body.core.triangles) {
      const geom::Vec3& a = body.core.vertices[i];
      const geom::Vec3 n = (body.core.vertices[j] - a).cross(body.core.vertices[k] - a);
      if (n.norm() > 0) highest = std::max(highest, n.dot(p - a) / n.norm());
    }
    nearest = std::min(nearest, highest);
  }
  return nearest;
}

TEST(CertifySet, WrapsHoldWhatIsWithinTheClearanceOfTriangles) {
  const geom::Mesh input = soup();
  SetRequest request = fast_request(10);
  request.wrap.emplace();
  request.wrap->clearance = 0.01;
  const auto made = certify_set(input, "", request);
  ASSERT_TRUE(made);
  const SetCertificate& c = made->certificate();
  ASSERT_TRUE(c.wrap);
  EXPECT_EQ(c.stop, bcd::Stop::Done);
  EXPECT_LE(c.distance_upper, 0.1 * geom::bounding_box(input).diagonal());
  EXPECT_GE(c.distance_upper, c.wrap->farthest_upper + 0.01);
  EXPECT_EQ(made->artefact().provenance.epsilon, c.distance_upper);
  const verify::Cover cover = verify::verify_cover(input, made->artefact());
  EXPECT_EQ(cover.inclusion.surface.answer, verify::Answer::Verified);
  // Points at the clearance from those of triangles, in any direction.
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> share(0, 1);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 5000; ++n) {
    const auto& [i, j, k] = input.triangles[random() % input.triangles.size()];
    const double u = share(random), v = (1 - u) * share(random);
    const geom::Vec3 p =
        (1 - u - v) * input.vertices[i] + u * input.vertices[j] + v * input.vertices[k];
    const geom::Vec3 d(normal(random), normal(random), normal(random));
    ASSERT_LE(height_above(made->artefact(), p + 0.01 * d.normalized()), 1e-9);
  }
  // Corners are no farther than it says.
  const geom::DistanceQuery query(input);
  for (const geom::ConvexBody& body : made->artefact().bodies)
    for (const geom::Vec3& p : body.core.vertices)
      EXPECT_LE(query.nearest(p).lower, c.distance_upper);
}

// What a wrap takes is off the regions' epsilons: points of bodies are as near to the triangles.
TEST(CertifySet, RegionsRoundAWrapAreAsNearToTheTriangles) {
  geom::Mesh arc;  // half a tube, open
  for (std::uint32_t i = 0; i <= 24; ++i) {
    const double angle = std::numbers::pi * i / 24;
    for (const double z : {0.0, 1.0})
      arc.vertices.emplace_back(std::cos(angle), std::sin(angle), z);
    if (i == 24) break;
    arc.triangles.push_back({2 * i, 2 * i + 2, 2 * i + 1});
    arc.triangles.push_back({2 * i + 1, 2 * i + 2, 2 * i + 3});
  }
  const geom::DistanceQuery query(arc);
  SetRequest request = fast_request(1);
  request.epsilon = Length{0.5};
  request.wrap.emplace();
  request.wrap->offset = Length{0.02};
  geom::Region near, away;
  near.radius = 10;
  away.center = {50, 50, 50};
  away.radius = 0.5;
  // One that is never reached may be as fine as it likes.
  request.regions = {{"near", near, Length{0.1}}, {"away", away, Length{1e-9}}};
  const auto made = certify_set(arc, "", request);
  ASSERT_TRUE(made && made->certificate().wrap);
  EXPECT_GT(made->certificate().wrap->farthest_upper, 0.015);
  EXPECT_GT(made->artefact().bodies.size(), 4U);  // which are within 0.1 of the wrap
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> share(0, 1);
  for (const geom::ConvexBody& body : made->artefact().bodies)
    for (int i = 0; i < 3000; ++i) {
      geom::Vec3 sum = geom::Vec3::Zero();
      double weight = 0;
      for (int k = 0; k < 3; ++k) {
        const double w = std::pow(share(random), 2);
        sum += w * body.core.vertices[random() % body.core.vertices.size()];
        weight += w;
      }
      ASSERT_LE(query.nearest(sum / weight).lower, 0.1);
    }
  const std::vector<SetCertificate::Region>& regions = made->certificate().regions;
  ASSERT_EQ(regions.size(), 2U);
  EXPECT_TRUE(regions[0].reached && regions[0].epsilon == 0.1);
  EXPECT_FALSE(regions[1].reached);
}

TEST(CertifySet, DistancesOfAWrapAndOfItsCoverAddUp) {
  SetRequest request = fast_request(10);
  request.epsilon.reset();
  request.max_bodies = 6;
  WrapRequest wrap;
  wrap.offset = kaboum::Length{2, true};
  wrap.seal = kaboum::Length{8, true};
  wrap.clearance = 0.01;
  const CertifiedWrap round = certify_wrap(soup(), wrap);
  const auto of_wrap = certify_set(round.artefact(), "", request);
  request.wrap = wrap;
  const auto of_input = certify_set(soup(), "", request);
  ASSERT_TRUE(of_wrap && of_input);
  EXPECT_TRUE(same_bodies(of_wrap->artefact(), of_input->artefact()));
  const double sum =
      of_wrap->certificate().distance_upper + round.certificate().farthest_upper + 0.01;
  EXPECT_GE(of_input->certificate().distance_upper, sum);
  EXPECT_LE(of_input->certificate().distance_upper, sum * (1 + 1e-14));
}

TEST(CertifySet, BodiesInsideHaveNoWrap) {
  SetRequest request = fast_request(10);
  request.direction = SetRequest::Direction::Inner;
  request.wrap.emplace();
  EXPECT_THROW(certify_set(coarse_torus(), "", request), Error);
}

TEST(CertifySet, WhatFloat32CannotHoldIsNotMade) {
  EXPECT_FALSE(certify_set(test::translated(coarse_torus(), {1e9, 0, 0}), "", fast_request(1)));
}

TEST(CertifySet, ProgressMayCancel) {
  struct Cancelled {};
  Hooks hooks;
  hooks.progress = [](const std::string&) { throw Cancelled(); };
  EXPECT_THROW(certify_set(coarse_torus(), "", fast_request(1), hooks), Cancelled);
}

TEST(SetCertificate, SurvivesItsRecord) {
  const auto made =
      certify_set(test::without(coarse_torus(), [](const geom::Vec3& p) { return p.x() > 1.2; }),
                  "", fast_request(5));
  ASSERT_TRUE(made);
  SetCertificate c = made->certificate();
  EXPECT_GT(c.subject.holes, 0U);
  EXPECT_FALSE(c.notes.empty());
  c.min_thickness = 0.25;
  c.max_aspect = 20;
  c.thickened = 3;
  c.stop = bcd::Stop::Stuck;
  c.subject.reversed_triangles = 4;
  c.subject.dropped_copies = 5;
  c.subject.dropped_sheets = 6;
  EXPECT_EQ(write_record(read_record(write_record(c))), write_record(c));
  EXPECT_EQ(read_record(write_record(c)).subject, c.subject);
  EXPECT_FALSE(c.reached());
  c.wrap = WrapCertificate{0.1, 0.2, 3, 0.25, 0.3, {1, 2, 3}, 0.05, 12};
  c.subject.wrapped = true;
  EXPECT_EQ(write_record(read_record(write_record(c))), write_record(c));
  EXPECT_TRUE(read_record(write_record(c)).subject.wrapped);
  for (const char* bad : {"", "{}", "[]", "{\"stop\": \"whenever\"}", "{\"stop\": 3}"})
    EXPECT_THROW(read_record(bad), Error) << bad;
}

/// What a report says with this key; "" without it.
std::string said(const CertifiedSet& set, const std::string& key) {
  const std::string text = to_json(set), start = '"' + key + "\":\"";
  const std::size_t at = text.find(start);
  if (at == std::string::npos) return {};
  const std::size_t begin = at + start.size();
  return text.substr(begin, text.find('"', begin) - begin);
}

/// A coarse_torus, and beside it a square seen from both sides: four triangles without volume.
geom::Mesh with_sheet() {
  geom::Mesh sheet;
  sheet.vertices = {{3, 0, 0}, {4, 0, 0}, {4, 1, 0}, {3, 1, 0}};
  sheet.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
  return test::merged({coarse_torus(), sheet});
}

TEST(CertifySet, ClaimsSayWhatTheyAreAbout) {
  SetRequest request = fast_request(5);
  const auto whole = certify_set(coarse_torus(), "", request);
  ASSERT_TRUE(whole);
  EXPECT_EQ(said(*whole, "of"), "the input");
  EXPECT_EQ(said(*whole, "surface"), "verified");
  EXPECT_EQ(said(*whole, "solid"), "verified");
  request.preparation.drop_sheets = true;
  const auto made = certify_set(with_sheet(), "", request);
  ASSERT_TRUE(made);
  EXPECT_EQ(said(*made, "of"),
            "the input: without 4 triangles of sheets, of which nothing is claimed");
  EXPECT_EQ(said(*made, "surface"), "verified, without the sheets");
  EXPECT_EQ(said(*made, "solid"), "verified");
  EXPECT_EQ(made->certificate().subject.dropped_sheets, 4U);
  EXPECT_FALSE(made->artefact().provenance.covers_surface);
  const auto open =
      certify_set(test::without(coarse_torus(), [](const geom::Vec3& p) { return p.x() > 1.2; }),
                  "", fast_request(5));
  ASSERT_TRUE(open);
  EXPECT_EQ(said(*open, "of"), "the input: with 1 hole filled, its solid the one so closed");
  EXPECT_EQ(said(*open, "solid"), "verified, of the closed mesh");
}

// Nobody but the library makes or changes a value that claims something.
template <class T>
constexpr bool kSealed =
    !std::is_aggregate_v<T> &&
    !std::is_constructible_v<T, decltype(std::declval<T&>().artefact()),
                             decltype(std::declval<T&>().certificate()), std::vector<char>> &&
    !std::is_constructible_v<T, decltype(std::declval<T&>().artefact())> &&
    std::is_const_v<std::remove_reference_t<decltype(std::declval<T&>().artefact())>> &&
    std::is_const_v<std::remove_reference_t<decltype(std::declval<T&>().certificate())>> &&
    std::is_const_v<std::remove_reference_t<decltype(std::declval<T&>().bytes())>>;
static_assert(kSealed<CertifiedSet> && kSealed<CertifiedMesh> && kSealed<CertifiedLink> &&
              kSealed<CertifiedBodies> && kSealed<CertifiedSweep>);

template <class Work>
bool is_internal_error(const Work& work) {
  try {
    work();
  } catch (const Error& error) {
    return error.code() == ErrorCode::Internal;
  }
  return false;
}

TEST(Certified, WhatIsMadeByDefaultClaimsNothing) {
  EXPECT_FALSE(CertifiedSet());
  EXPECT_TRUE(is_internal_error([] { (void)to_json(CertifiedSet()); }));
  EXPECT_TRUE(is_internal_error([] { (void)certificate_of(CertifiedMesh()); }));
  EXPECT_TRUE(is_internal_error([none = CertifiedMesh()] { (void)none.bytes(); }));
  EXPECT_TRUE(is_internal_error([none = CertifiedSweep()] { (void)none.certificate(); }));
  EXPECT_TRUE(is_internal_error([] {
    (void)certify_sweep(robot::RobotFile(), CertifiedBodies(), {{0}, {1}}, SweepRequest());
  }));
}

/// `for (auto& body : (*certify_set(…)).artefact().bodies)` would loop over what is gone.
template <class Made>
constexpr bool kLendsParts = requires(Made made) {
  static_cast<Made&&>(made).artefact();
}
|| requires(Made made) { static_cast<Made&&>(made).bytes(); }
|| requires(Made made) { static_cast<Made&&>(made).certificate(); };
static_assert(!kLendsParts<CertifiedSet> && !kLendsParts<const CertifiedMesh>);
static_assert(kLendsParts<CertifiedSet&>);

TEST(Certified, WhatWasMovedFromClaimsNothing) {
  auto made = certify_set(coarse_torus(), "", fast_request(5));
  ASSERT_TRUE(made);
  const CertifiedSet taken = std::move(*made);
  EXPECT_TRUE(taken);
  EXPECT_FALSE(*made);  // NOLINT(bugprone-use-after-move)
  EXPECT_TRUE(is_internal_error([&] { (void)to_json(*made); }));
}

TEST(SetRequest, OnePercentStandsForNoTarget) {
  SetRequest request;
  EXPECT_EQ(request.wanted_epsilon(), (kaboum::Length{1, true}));
  request.max_bodies = 3;
  EXPECT_FALSE(request.wanted_epsilon());
  request.epsilon = kaboum::Length{0.1, false};
  EXPECT_EQ(request.parameters().substr(0, 13), "--epsilon 0.1");
}

class SetCacheTest : public ::testing::Test {
 protected:
  std::vector<fs::path> entries() const {
    return {fs::directory_iterator(folder_), fs::directory_iterator()};
  }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(SetCacheTest, HasTheSameBytesForTheSameRequestOnly) {
  const SetCache cache(folder_);
  const auto first = find_or_certify(coarse_torus(), "abc", fast_request(5), &cache);
  ASSERT_TRUE(first);
  EXPECT_FALSE(first->cached);
  const auto again = find_or_certify(coarse_torus(), "abc", fast_request(5), &cache);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->cached);
  EXPECT_EQ(again->set.bytes(), first->set.bytes());
  EXPECT_EQ(to_json(again->set), to_json(first->set));
  std::string flaw;
  EXPECT_FALSE(cache.find(SetCache::key_of(coarse_torus(), "abc", fast_request(4)), flaw));
  EXPECT_FALSE(cache.find(SetCache::key_of(coarse_torus(), "abd", fast_request(5)), flaw));
  EXPECT_FALSE(cache.find(
      SetCache::key_of(test::scaled(coarse_torus(), {1, 1, 1.0000001}), "abc", fast_request(5)),
      flaw));
  SetRequest inner = fast_request(5);
  inner.direction = SetRequest::Direction::Inner;
  EXPECT_FALSE(cache.find(SetCache::key_of(coarse_torus(), "abc", inner), flaw));
  SetRequest wrapped = fast_request(5);
  wrapped.wrap.emplace();
  const std::string round = SetCache::key_of(coarse_torus(), "abc", wrapped).hash;
  EXPECT_NE(round, SetCache::key_of(coarse_torus(), "abc", fast_request(5)).hash);
  wrapped.wrap->clearance = 1e-3;
  EXPECT_NE(round, SetCache::key_of(coarse_torus(), "abc", wrapped).hash);
  EXPECT_TRUE(flaw.empty());
}

/// A least width is asked for in one way only, which records and keys of the cache know.
template <class T>
constexpr bool kHasOtherThickness = requires(T request) {
  request.min_thickness;
};
static_assert(!kHasOtherThickness<SetRequest> && kHasOtherThickness<bcd::CoverOptions>);

TEST_F(SetCacheTest, ThickBodiesAreNotThinOnesOfBefore) {
  const SetCache cache(folder_);
  const geom::Mesh plate = test::box({1, 1, 1e-3}, 1);
  SetRequest request = fast_request(30);
  ASSERT_TRUE(find_or_certify(plate, "abc", request, &cache));
  request.thickness = Length{0.1};
  const auto thick = find_or_certify(plate, "abc", request, &cache);
  ASSERT_TRUE(thick);
  EXPECT_FALSE(thick->cached);
  EXPECT_EQ(thick->set.certificate().min_thickness, 0.1);
  const auto again = find_or_certify(plate, "abc", request, &cache);
  ASSERT_TRUE(again);
  EXPECT_TRUE(again->cached);
  for (const geom::ConvexBody& body : again->set.artefact().bodies)
    EXPECT_GE(geom::least_width(body.core, 0.1).lower, 0.1);
}

TEST_F(SetCacheTest, DamagedEntriesAreMadeAgain) {
  const SetCache cache(folder_);
  const auto made = find_or_certify(coarse_torus(), "abc", fast_request(5), &cache);
  ASSERT_TRUE(made);
  ASSERT_EQ(entries().size(), 1U);
  const fs::path entry = entries()[0];
  std::ifstream in(entry, std::ios::binary);
  const std::string whole{std::istreambuf_iterator<char>(in), {}};
  for (const std::size_t at :
       {std::size_t{0}, std::size_t{20}, std::size_t{100}, whole.size() / 2, whole.size() - 1}) {
    std::string damaged = whole;
    damaged[at] = static_cast<char>(damaged[at] ^ 1);
    std::ofstream(entry, std::ios::binary) << damaged;
    std::string flaw;
    EXPECT_FALSE(cache.find(SetCache::key_of(coarse_torus(), "abc", fast_request(5)), flaw)) << at;
    EXPECT_FALSE(flaw.empty()) << at;
  }
  std::vector<std::string> notes;
  Hooks hooks;
  hooks.note = [&](const std::string& text) { notes.push_back(text); };
  const auto again = find_or_certify(coarse_torus(), "abc", fast_request(5), &cache, hooks);
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->cached);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("it is made again"), std::string::npos);
  EXPECT_EQ(again->set.bytes(), made->set.bytes());
}

TEST_F(SetCacheTest, EntriesThatClaimMoreThanTheirContainersAreMadeAgain) {
  const SetCache cache(folder_);
  SetRequest request = fast_request(5);
  request.preparation.drop_sheets = true;
  const auto made = find_or_certify(with_sheet(), "abc", request, &cache);
  ASSERT_TRUE(made);
  ASSERT_EQ(entries().size(), 1U);
  std::ifstream in(entries()[0], std::ios::binary);
  std::string whole{std::istreambuf_iterator<char>(in), {}};
  const std::string count = "\"dropped_sheets\":4";
  ASSERT_NE(whole.find(count), std::string::npos);
  whole.replace(whole.find(count), count.size(), "\"dropped_sheets\":0");
  const std::size_t hash = whole.find('\n') + 1, rest = whole.find('\n', hash) + 1;
  whole.replace(hash, rest - hash - 1, io::sha256(std::string_view(whole).substr(rest)));
  std::ofstream(entries()[0], std::ios::binary) << whole;
  std::string flaw;
  EXPECT_FALSE(cache.find(SetCache::key_of(with_sheet(), "abc", request), flaw));
  EXPECT_NE(flaw.find("another input"), std::string::npos) << flaw;
}

TEST_F(SetCacheTest, EntriesThatClaimAnotherDistanceOrWrapAreMadeAgain) {
  const SetCache cache(folder_);
  SetRequest request = fast_request(20);
  request.wrap.emplace();
  ASSERT_TRUE(find_or_certify(soup(), "abc", request, &cache));
  ASSERT_EQ(entries().size(), 1U);
  std::ifstream in(entries()[0], std::ios::binary);
  const std::string good{std::istreambuf_iterator<char>(in), {}};
  for (const auto& [from, to] :
       {std::pair("\"upper\":", "\"upper\":1e-9,\"x\":"),
        std::pair("\"clearance\":0.0", "\"clearance\":0.5"), std::pair("\"wrap\":", "\"w\":")}) {
    std::string whole = good;
    ASSERT_NE(whole.find(from), std::string::npos) << from;
    whole.replace(whole.find(from), std::string_view(from).size(), to);
    const std::size_t hash = whole.find('\n') + 1, rest = whole.find('\n', hash) + 1;
    whole.replace(hash, rest - hash - 1, io::sha256(std::string_view(whole).substr(rest)));
    std::ofstream(entries()[0], std::ios::binary) << whole;
    std::string flaw;
    EXPECT_FALSE(cache.find(SetCache::key_of(soup(), "abc", request), flaw)) << to;
    EXPECT_FALSE(flaw.empty());
  }
}

}  // namespace
}  // namespace kaboum::certify
