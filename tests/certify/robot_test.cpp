// Certified robots and sweeps in process: what is returned is what is in the containers, holds by
// the verifier, has the bytes of the tools; and wrong results are refused.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/certify/cache_folder.h>
#include <kaboum/certify/link_verdict.h>
#include <kaboum/certify/robot.h>
#include <kaboum/certify/robot_budget.h>
#include <kaboum/certify/sweep.h>
#include <kaboum/geom/width.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/region_excess.h>

#include <cmath>
#include <cstdlib>
#include <fstream>

#include "link_polytopes.h"
#include "support/shapes.h"
#include "support/temporary_folder.h"
#include "swept_motion.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;

constexpr const char* kArm = R"(<robot name="arm">
  <link name="base"><collision><geometry><box size="0.3 0.2 0.1"/></geometry></collision></link>
  <link name="fore arm">
    <collision><origin xyz="0.7 0.1 -0.3" rpy="0.3 0.1 -1.2"/>
      <geometry><mesh filename="part.off" scale="0.3 -0.3 0.2"/></geometry></collision>
    <collision><geometry><mesh filename="part.off" scale="0.3 0.3 0.2"/></geometry></collision>
  </link>
  <link name="tip"/>
  <joint name="elbow" type="continuous"><parent link="base"/><child link="fore arm"/>
    <origin xyz="0 0.1 0.2" rpy="0.2 0 0"/><axis xyz="0 0.6 0.8"/></joint>
  <joint name="end" type="fixed"><parent link="fore arm"/><child link="tip"/></joint>
</robot>)";

class RobotTest : public ::testing::Test {
 protected:
  void SetUp() override {
    write(part());
    std::ofstream(folder_ / "arm.urdf") << kArm;
    std::ofstream(folder_ / "quarter.csv") << "elbow\n0\n0.8\n1.5\n";
  }

  void write(const geom::Mesh& mesh) const {
    io::write_file(folder_ / "part.off", io::serialise_mesh(mesh, *io::format_from_name("off")));
  }
  static geom::Mesh part() { return test::torus(1, 0.3, 16, 8); }
  robot::RobotFile arm() const { return robot::read_robot((folder_ / "arm.urdf").string()); }
  static RobotRequest fast() {
    RobotRequest request;
    request.set.epsilon = Length{5, true};
    request.set.effort = bcd::Effort::Fast;
    return request;
  }
  static SweepRequest coarse() {
    SweepRequest request;
    request.search.epsilon = 0.05;
    return request;
  }
  const robot::Path quarter_{{0}, {0.8}, {1.5}};

  /// Runs a tool in the folder.
  int run(const std::string& command) const {
    return std::system(("cd '" + folder_.string() + "' && " KABOUM_BIN "/" + command).c_str());
  }
  std::vector<char> bytes(const std::string& file) const { return io::read_file(folder_ / file); }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(RobotTest, LinksAreHeldInTheirFrames) {
  const robot::RobotFile file = arm();
  std::size_t meshes = 0;
  RobotHooks hooks;
  hooks.made = [&](const CertifiedLinkMesh& mesh) {
    ++meshes;
    EXPECT_EQ(mesh.mesh.file, folder_ / "part.off");
  };
  const CertifiedRobot made = certify_robot(file, fast(), nullptr, hooks);
  EXPECT_EQ(meshes, 1U);  // mirrored is the same
  ASSERT_EQ(made.links.size(), 2U);
  EXPECT_EQ(made.links[0].certificate().distance, 0);
  const CertifiedLink& link = made.links[1];
  EXPECT_EQ(link.certificate().shapes, 2U);
  EXPECT_TRUE(link.artefact().provenance.covers_solid);
  EXPECT_TRUE(link.artefact().provenance.covers_surface);
  EXPECT_EQ(link.artefact().provenance.frame, "fore arm");
  EXPECT_GE(link.artefact().provenance.epsilon.value(), link.certificate().distance);
  const geom::ConvexSet back = io::parse_convex_set(link.bytes(), io::Format::Glb, "it");
  ASSERT_EQ(back.bodies.size(), link.artefact().bodies.size());
  for (const robot::Geometry& g : file.robot.links[1].collision) {
    geom::Mesh posed = part();
    for (geom::Vec3& v : posed.vertices) v = g.origin * v.cwiseProduct(g.size);
    if (g.size.prod() < 0)
      for (geom::Triangle& t : posed.triangles) std::swap(t[1], t[2]);
    const verify::Cover cover = verify::verify_cover(posed, back);
    EXPECT_EQ(cover.inclusion.solid.answer, verify::Answer::Verified);
    EXPECT_EQ(cover.inclusion.surface.answer, verify::Answer::Verified);
  }
}

TEST_F(RobotTest, ThicknessIsInTheRobotsUnit) {
  write(test::box({1, 1, 1e-3}, 1));  // its scales are 0.3 and 0.2
  RobotRequest request = fast();
  request.set.epsilon = Length{0.2};
  request.set.thickness = Length{0.05};
  const CertifiedRobot made = certify_robot(arm(), request);
  ASSERT_EQ(made.links.size(), 2U);
  const std::vector<geom::ConvexBody>& bodies = made.links[1].artefact().bodies;
  ASSERT_FALSE(bodies.empty());
  for (const geom::ConvexBody& body : bodies) {
    const double width = geom::least_width(body.core, 0.05).lower;
    EXPECT_GE(width, 0.05 * (1 - 1e-6));  // posed, and rounded
    EXPECT_LE(width, 0.05 * 2.5);
  }
}

// The mirrored shape and the other one have regions in other places of the one mesh: two sets.
TEST_F(RobotTest, RegionsAreNearerInEveryPlacement) {
  const robot::RobotFile file = arm();
  RobotRequest request = fast(), coarse = fast();
  for (RobotRequest* one : {&request, &coarse}) one->set.epsilon = Length{0.1};
  const robot::Geometry& g = file.robot.links[1].collision[0];
  geom::FrameRegions map;
  map.regions.push_back({{"'grip'", {{}, g.origin * geom::Vec3(0.3, 0, 0), 0.1}, Length{0.01}},
                         "tip",
                         "map.json: region 1"});
  request.take(robot::bounds_of_links(file, request.shapes, map));
  ASSERT_EQ(request.regions.size(), 1U);
  EXPECT_NE(request.parameters(), coarse.parameters());
  EXPECT_NE(request.parameters("fore arm"), coarse.parameters("fore arm"));
  EXPECT_EQ(request.parameters("base"), coarse.parameters("base"));
  const SetCache cache(folder_ / "cache");
  const CertifiedRobot plain = certify_robot(file, coarse, &cache),
                       made = certify_robot(file, request, &cache);
  EXPECT_EQ(plain.bodies.certificate().meshes.size(), 1U);
  ASSERT_EQ(made.bodies.certificate().meshes.size(), 2U);
  EXPECT_GT(made.bodies.artefact().size(), plain.bodies.artefact().size());
  const std::vector<RegionVerdict> verdicts = region_verdicts(file, request.regions, made.bodies);
  ASSERT_EQ(verdicts.size(), 1U);
  EXPECT_TRUE(verdicts[0].held && verdicts[0].reached);
  EXPECT_EQ(verdicts[0].epsilon, 0.01);
  EXPECT_EQ(verdicts[0].links, std::vector<std::string>{"fore arm"});
  EXPECT_FALSE(region_verdicts(file, request.regions, plain.bodies)[0].held);
  // The bodies of the shape that the region is at, in the link's frame.
  geom::Mesh posed = part();
  for (geom::Vec3& v : posed.vertices) v = g.origin * v.cwiseProduct(g.size);
  for (geom::Triangle& t : posed.triangles) std::swap(t[1], t[2]);
  const auto farthest = [&](const CertifiedRobot& robot) {
    const auto& shapes = robot.bodies.certificate().shapes;
    const auto first = std::ranges::find(shapes, 1U, &robot::LinkShape::link);
    geom::ConvexSet set = robot.bodies.certificate().meshes[*first->mesh].made.found.set.artefact();
    for (geom::ConvexBody& body : set.bodies) {
      for (geom::Vec3& v : body.core.vertices) v = g.origin * v.cwiseProduct(g.size);
      for (geom::Triangle& t : body.core.triangles) std::swap(t[1], t[2]);
    }
    return verify::verify_region_excess(set, posed, {"", map.regions[0].region, 0.01 + 1e-9}, true)
        .answer;
  };
  EXPECT_EQ(farthest(made), verify::Answer::Verified);
  EXPECT_EQ(farthest(plain), verify::Answer::Refuted);
}

TEST_F(RobotTest, RegionsAndBudgetsDoNotGoTogether) {
  RobotRequest request = fast();
  robot::LinkRegion region;
  region.name = "'grip'";
  region.region.radius = 1;
  region.epsilon = Length{0.01};
  request.regions["fore arm"] = {region};
  EXPECT_THROW(epsilon_within(arm(), request, {9, {}}), Error);
  request.set.max_bodies = 3;
  EXPECT_THROW(certify_robot(arm(), request), Error);
  request = fast();
  request.regions["nose"] = {region};
  EXPECT_THROW(certify_robot(arm(), request), Error);
  request = fast();
  request.epsilons["base"] = Length{0.1};
  EXPECT_THROW(request.take({{{"base", Length{0.2}}}, {}}), Error);
}

TEST_F(RobotTest, HasTheBytesOfTheTools) {
  const CertifiedRobot made = certify_robot(arm(), fast());
  ASSERT_EQ(run("bcd-decompose arm.urdf -o out --epsilon 5% --effort fast --no-cache --quiet"), 0);
  EXPECT_EQ(made.links[0].bytes(), bytes("out/links/base.glb"));
  EXPECT_EQ(made.links[1].bytes(), bytes("out/links/fore_arm.glb"));
  SweepRequest request = coarse();
  request.search.explicit_margin = true;
  request.parameters =
      "--epsilon 0.05 --bound balanced --body-epsilon 5% --max-vertices-per-body 64 --effort fast "
      "--geometry collision";
  const auto swept = certify_sweep(arm(), made.bodies, quarter_, request);
  ASSERT_TRUE(swept);
  ASSERT_EQ(run("sweep-approx arm.urdf --path quarter.csv -o swept.glb --epsilon 0.05 "
                "--body-epsilon 5% --effort fast --no-cache --quiet"),
            0);
  EXPECT_EQ(swept->bytes(), bytes("swept.glb"));
}

TEST_F(RobotTest, LinksAreKeptBetweenRuns) {
  const SetCache cache(folder_ / "cache");
  const CertifiedRobot made = certify_robot(arm(), fast(), &cache);
  const auto keep = [&] {
    std::vector<fs::path> out;
    for (const auto& entry : fs::directory_iterator(folder_ / "cache"))
      if (CacheFolder::kind_of({entry.path(), 0, {}}).starts_with("KABOUM-LINK"))
        out.push_back(entry.path());
    return out;
  };
  ASSERT_EQ(keep().size(), 1U);  // the other one is a box
  std::vector<std::string> notes;
  RobotHooks hooks;
  hooks.note = [&](const std::string&, const std::string& text) { notes.push_back(text); };
  const auto expect_same = [&](const RobotRequest& request) {
    notes.clear();
    const CertifiedRobot again = certify_robot(arm(), request, &cache, hooks);
    ASSERT_EQ(again.links.size(), made.links.size());
    for (std::size_t i = 0; i < made.links.size(); ++i) {
      const CertifiedLink &one = made.links[i], &other = again.links[i];
      EXPECT_EQ(one.bytes(), other.bytes());
      EXPECT_EQ(one.artefact().provenance, other.artefact().provenance);
      EXPECT_EQ(one.certificate().link, other.certificate().link);
      EXPECT_EQ(one.certificate().shapes, other.certificate().shapes);
      EXPECT_EQ(one.certificate().distance, other.certificate().distance);
      ASSERT_EQ(one.artefact().bodies.size(), other.artefact().bodies.size());
      for (std::size_t b = 0; b < one.artefact().bodies.size(); ++b) {
        EXPECT_EQ(one.artefact().bodies[b].name, other.artefact().bodies[b].name);
        EXPECT_EQ(one.artefact().bodies[b].core.vertices, other.artefact().bodies[b].core.vertices);
        EXPECT_EQ(one.artefact().bodies[b].core.triangles,
                  other.artefact().bodies[b].core.triangles);
      }
    }
  };
  expect_same(fast());
  EXPECT_TRUE(notes.empty());
  EXPECT_EQ(keep().size(), 1U);

  // What is damaged is made again.
  const fs::path entry = keep().front();
  std::vector<char> damaged = io::read_file(entry);
  damaged[damaged.size() / 2] ^= 1;
  io::write_file(entry, damaged);
  expect_same(fast());
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("made again"), std::string::npos);
  expect_same(fast());
  EXPECT_TRUE(notes.empty());

  // Another place in the link's frame is another set.
  std::string urdf = kArm;
  urdf.replace(urdf.find("0.7 0.1 -0.3"), 3, "0.8");
  std::ofstream(folder_ / "arm.urdf") << urdf;
  const CertifiedRobot moved = certify_robot(arm(), fast(), &cache);
  EXPECT_NE(moved.links[1].bytes(), made.links[1].bytes());
  EXPECT_EQ(keep().size(), 2U);
}

TEST_F(RobotTest, PolytopesThatDoNotHoldTheBodiesAreRefused) {
  const CertifiedRobot made = certify_robot(arm(), fast());
  std::vector<robot::LinkBody> bodies;
  for (const robot::LinkBody& body : made.bodies.artefact())
    if (body.link == 1) bodies.push_back(body);
  const geom::ConvexSet& good = made.links[1].artefact();
  EXPECT_EQ(objection(good, bodies), "");
  geom::ConvexSet bad = good;
  bad.bodies.pop_back();
  EXPECT_NE(objection(bad, bodies), "");
  bad = good;
  set_margin(bad, 0.1);  // whoever reads the file may pass it over
  EXPECT_NE(objection(bad, bodies), "");
  bad = good;
  std::swap(bad.bodies.front(), bad.bodies.back());
  EXPECT_NE(objection(bad, bodies), "");
  for (std::size_t i = 0; i < good.bodies.size(); ++i) {
    // Each vertex of the bodies is within the margin of rounding of a facet's plane.
    bad = good;
    geom::Vec3 middle = geom::Vec3::Zero();
    for (const geom::Vec3& v : good.bodies[i].core.vertices) middle += v;
    middle /= static_cast<double>(good.bodies[i].core.vertices.size());
    for (geom::Vec3& v : bad.bodies[i].core.vertices) v = middle + (1 - 1e-4) * (v - middle);
    EXPECT_NE(objection(bad, bodies), "") << i;
  }
}

TEST_F(RobotTest, SweptSetsAreDecidedOnTheBytes) {
  const robot::RobotFile file = arm();
  const CertifiedBodies bodies = certify_bodies(file, fast());
  const auto made = certify_sweep(file, bodies, quarter_, coarse());
  ASSERT_TRUE(made);
  EXPECT_EQ(made->certificate().motion, MotionClaim::Decided) << made->certificate().undecided;
  EXPECT_EQ(made->certificate().margin, margin_of(made->artefact()));
  EXPECT_GT(made->certificate().margin, 0);
  EXPECT_EQ(made->certificate().sources.size(), made->artefact().bodies.size());
  const auto decided = [&](const geom::ConvexSet& set) {
    return decide_motion(file, bodies, quarter_, set, 20000, {}).answer;
  };
  EXPECT_EQ(decided(made->artefact()), verify::Answer::Verified);
  geom::ConvexSet bad = made->artefact();
  set_margin(bad, 0);  // the steps' hulls alone
  EXPECT_EQ(decided(bad), verify::Answer::Refuted);
  bad = made->artefact();
  bad.bodies.pop_back();
  EXPECT_EQ(decided(bad), verify::Answer::Refuted);
  bad = made->artefact();
  for (geom::ConvexBody& body : bad.bodies)
    for (geom::Vec3& v : body.core.vertices) v.z() += 2 * made->certificate().margin;
  EXPECT_EQ(decided(bad), verify::Answer::Refuted);
}

TEST_F(RobotTest, ClaimsOfMotionAreNoMoreThanWhatIsKnown) {
  const robot::RobotFile file = arm();
  const CertifiedBodies bodies = certify_bodies(file, fast());
  SweepRequest request = coarse();
  request.decide_motion = false;
  const auto proved = certify_sweep(file, bodies, quarter_, request);
  ASSERT_TRUE(proved);
  EXPECT_EQ(proved->certificate().motion, MotionClaim::Proved);
  request = coarse();
  request.search.rule = sweep::StepRule::Baginski;
  const auto unproved = certify_sweep(file, bodies, quarter_, request);
  ASSERT_TRUE(unproved);
  EXPECT_EQ(unproved->certificate().motion, MotionClaim::None);
  EXPECT_EQ(unproved->artefact().provenance.direction, "");
  request.search.epsilon = 1e-9;
  request.search.rule = sweep::StepRule::Balanced;
  EXPECT_FALSE(certify_sweep(file, bodies, quarter_, request));
}

TEST_F(RobotTest, SaysWhichFileIsAtFault) {
  const auto error_of = [&](const RobotRequest& request) -> std::string {
    try {
      certify_bodies(arm(), request);
    } catch (const Error& error) {
      return error.what();
    }
    return {};
  };
  RobotRequest request = fast();
  request.set.direction = SetRequest::Direction::Inner;
  EXPECT_NE(error_of(request).find("outer"), std::string::npos);
  request = fast();
  request.shapes.links = {"nobody"};
  EXPECT_NE(error_of(request).find("nobody"), std::string::npos);
  request.shapes.links = {"tip"};
  EXPECT_NE(error_of(request).find("no link has a shape"), std::string::npos);
  write(test::translated(part(), {1e9, 0, 0}));
  EXPECT_THROW(certify_bodies(arm(), fast()), TooCoarse);
  EXPECT_NE(error_of(fast()).find("part.off: float32"), std::string::npos);
  fs::remove(folder_ / "part.off");
  EXPECT_NE(error_of(fast()).find("part.off"), std::string::npos);
}

/// A box, and a fin of two quads back to back that are split along different diagonals.
geom::Mesh finned() {
  geom::Mesh out = test::box({1, 1, 1}, 1);
  const auto first = static_cast<std::uint32_t>(out.vertices.size());
  for (const auto& [x, y] : {std::pair{1.1, 0.2}, {1.4, 0.2}, {1.4, 0.8}, {1.1, 0.8}})
    out.vertices.emplace_back(x, y, 0.5);
  for (const geom::Triangle& t : {geom::Triangle{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}})
    out.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return out;
}

constexpr const char* kMixed = R"(<robot name="mixed">
  <link name="good"><collision><geometry><mesh filename="part.off"/></geometry></collision></link>
  <link name="sheet"><collision><geometry><mesh filename="sheet.off"/></geometry></collision></link>
  <link name="bad"><collision><geometry><mesh filename="bad.off"/></geometry></collision>
    <collision><geometry><mesh filename="part.off"/></geometry></collision></link>
  <joint name="a" type="fixed"><parent link="good"/><child link="sheet"/></joint>
  <joint name="b" type="fixed"><parent link="good"/><child link="bad"/></joint>
</robot>)";

class MixedRobotTest : public RobotTest {
 protected:
  void SetUp() override {
    RobotTest::SetUp();
    std::ofstream(folder_ / "mixed.urdf") << kMixed;
    std::ofstream(folder_ / "bad.off") << "OFF\n4 4 0\n0 0 0\n";
    geom::Mesh sheet = test::box({1, 1, 1}, 1);
    const auto first = static_cast<std::uint32_t>(sheet.vertices.size());
    sheet.vertices.insert(sheet.vertices.end(), {{1, 0.2, 0.5}, {1.3, 0.2, 0.5}, {1.3, 0.8, 0.5}});
    sheet.triangles.push_back({first, first + 1, first + 2});
    sheet.triangles.push_back({first, first + 2, first + 1});
    write_as("sheet.off", sheet);
  }
  void write_as(const std::string& name, const geom::Mesh& mesh) const {
    io::write_file(folder_ / name, io::serialise_mesh(mesh, *io::format_from_name("off")));
  }
  robot::RobotFile mixed() const { return robot::read_robot((folder_ / "mixed.urdf").string()); }
  static RobotRequest tolerant() {
    RobotRequest request = fast();
    request.partial = true;
    request.set.wrap.emplace().where_needed = true;
    return request;
  }
  static LinkEnclosuresRequest enclosures() {
    LinkEnclosuresRequest request;
    request.mesh.mesh.epsilon = Length{5, true};
    request.mesh.mesh.effort = bmesh::Effort::Fast;
    request.mesh.mesh.format = io::Format::Stl;
    request.mesh.mesh.decide = false;
    request.mesh.wrap.emplace().where_needed = true;
    request.partial = true;
    return request;
  }
  void expect_inside(const geom::Mesh& triangles, const geom::Mesh& of) const {
    verify::InclusionOptions options;
    options.surface_only = true;
    EXPECT_EQ(verify::verify_inclusion(triangles, of, options).surface.answer,
              verify::Answer::Verified);
  }
  geom::Mesh mesh_of(const std::string& name) const { return io::read_mesh(folder_ / name).mesh; }
};

// What a hook throws ends the work, and is no flaw of the mesh that is being looked at.
TEST_F(MixedRobotTest, WhatAHookThrowsIsNoFlawOfAMesh) {
  const robot::RobotFile robot = mixed();
  const auto stop = [](const std::string&) {
    throw Error(ErrorCode::InvalidInput, "the user's own");
  };
  const auto message_of = [](const auto& work) -> std::string {
    try {
      work();
    } catch (const Error& error) {
      return error.what();
    }
    return "nothing thrown";
  };
  RobotHooks hooks;
  hooks.progress = stop;
  const std::string of_sets = message_of([&] { certify_robot(robot, tolerant(), nullptr, hooks); }),
                    of_meshes =
                        message_of([&] { enclose_links(robot, enclosures(), nullptr, stop); });
  EXPECT_TRUE(of_sets.ends_with("the user's own")) << of_sets;
  EXPECT_TRUE(of_meshes.ends_with("the user's own")) << of_meshes;
}

TEST_F(MixedRobotTest, OneBadMeshIsNamedAndTheRestHeld) {
  const robot::RobotFile robot = mixed();
  EXPECT_THROW(certify_robot(robot, fast()), Error);
  const CertifiedRobot made = certify_robot(robot, tolerant());
  const std::vector<LinkVerdict> found = verdicts(made);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].outcome, Outcome::Held);
  EXPECT_EQ(found[1].outcome, Outcome::Held);
  EXPECT_EQ(found[2].outcome, Outcome::Kept);
  EXPECT_EQ(found[0].sentence, "every triangle is inside");
  EXPECT_EQ(found[2].sentence.find("NOT enclosed, its mesh stays as it was: "), 0U);
  EXPECT_NE(found[2].sentence.find("bad.off"), std::string::npos);
  EXPECT_EQ(outcome_of(found), Outcome::Kept);
  EXPECT_EQ(in_words(found), "NOT every triangle is known to be inside: 1 of 3 links is not held");
  ASSERT_EQ(made.links.size(), 2U);  // no set of a link without one of its shapes
  EXPECT_EQ(made.links[1].certificate().link, 1U);
  const CertifiedLinkMesh& sheet = made.bodies.certificate().meshes[1];
  EXPECT_TRUE(sheet.made.found.set.certificate().wrap);
  expect_inside(mesh_of("sheet.off"), verify::sum_of(made.links[1].artefact()));
}

TEST_F(MixedRobotTest, TooNearForAWrapIsHeldFartherAway) {
  RobotRequest request = tolerant();
  request.shapes.links = {"sheet"};
  request.set.epsilon = Length{1e-7};
  const CertifiedRobot made = certify_robot(mixed(), request);
  const std::vector<LinkVerdict> found = verdicts(made);
  ASSERT_EQ(found.size(), 1U);
  EXPECT_EQ(found[0].outcome, Outcome::Far);
  EXPECT_EQ(found[0].sentence.find("every triangle is inside, but not as near"), 0U);
  expect_inside(mesh_of("sheet.off"), verify::sum_of(made.links.at(0).artefact()));
  request.set.wrap.reset();  // as --prepare strict: then it stays, and nothing is made
  EXPECT_THROW(certify_robot(mixed(), request), Error);
  request.shapes.links = {"sheet", "good"};
  request.set.epsilon = Length{5, true};
  const std::vector<LinkVerdict> kept = verdicts(certify_robot(mixed(), request));
  EXPECT_EQ(kept.at(0).outcome, Outcome::Held);
  EXPECT_EQ(kept.at(1).outcome, Outcome::Kept);
}

TEST_F(MixedRobotTest, MeshesThatBoundNothingAreWrappedWhereTheyWouldStickOut) {
  write_as("sheet.off", finned());
  const LinkEnclosures made = enclose_links(mixed(), enclosures());
  const std::vector<LinkVerdict> found = verdicts(made);
  ASSERT_EQ(found.size(), 3U);
  EXPECT_EQ(found[0].outcome, Outcome::Held);
  EXPECT_EQ(found[1].outcome, Outcome::Held);
  EXPECT_EQ(found[2].outcome, Outcome::Kept);
  const EnclosedFile& fin = made.meshes.at(1).made;
  EXPECT_TRUE(fin.enclosure.certificate().wrap);
  expect_inside(finned(), fin.enclosure.artefact());
  // Not wrapped, it would stick out: which is said, with how far.
  LinkEnclosuresRequest request = enclosures();
  request.mesh.wrap.reset();
  const LinkEnclosures plain = enclose_links(mixed(), request);
  const LinkVerdict out = verdicts(plain).at(1);
  EXPECT_EQ(out.outcome, Outcome::Outside);
  EXPECT_NE(out.sentence.find("4 triangles stick out, by up to 0."), std::string::npos)
      << out.sentence;
  const TrianglesInside& inside = plain.meshes.at(1).made.enclosure.certificate().inside;
  ASSERT_TRUE(inside.farther);
  EXPECT_LE(*inside.farther, 0.41);
  EXPECT_GE(*inside.farther, 0.3);
}

}  // namespace
}  // namespace kaboum::certify
