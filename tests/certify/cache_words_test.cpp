// Version words of the cache: beside each the hash of what it stands for, of fixed requests. Where
// a hash is another one, results have changed: give the word a new text and put both here.

#include <gtest/gtest.h>
#include <kaboum/base/sha256.h>
#include <kaboum/certify/enclosure.h>
#include <kaboum/certify/robot.h>
#include <kaboum/certify/set_cache.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/cover.h>

#include <bit>
#include <filesystem>
#include <fstream>
#include <string>

#include "cache_words.h"
#include "support/shapes.h"
#include "support/temporary_folder.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;

/// Sixteen digits of a hash.
std::string hash(const std::string& text) { return sha256(text).substr(0, 16); }

/// With the numbers of a mesh, all digits.
void append(std::string& text, const geom::Mesh& mesh) {
  for (const geom::Vec3& v : mesh.vertices)
    for (const double x : v) text += std::to_string(std::bit_cast<std::uint64_t>(x)) + ' ';
  for (const geom::Triangle& t : mesh.triangles)
    for (const std::uint32_t v : t) text += std::to_string(v) + ' ';
}

std::string hash_of(const geom::ConvexSet& set) {
  std::string text;
  for (const geom::ConvexBody& body : set.bodies) append(text, body.core);
  return hash(text);
}

/// The bytes, with the program's version left out.
std::string without_version(const std::vector<char>& bytes) {
  std::string text(bytes.begin(), bytes.end());
  const std::string version = KABOUM_VERSION;
  for (std::size_t at = text.find(version); at != std::string::npos; at = text.find(version, at))
    text.erase(at, version.size());
  return text;
}

/// A bent bar. No function of a library, which may round otherwise elsewhere, is in its numbers.
geom::Mesh bar() {
  geom::Mesh mesh = test::box({3, 0.7, 0.4}, 8);
  for (geom::Vec3& v : mesh.vertices) v.z() += 0.3 * (v.x() - 1.2) * (v.x() - 1.2);
  return mesh;
}

CertifiedSet set_of(const geom::Mesh& mesh, SetRequest::Direction direction) {
  SetRequest request;
  request.epsilon = Length{5, true};
  request.effort = bcd::Effort::Normal;
  request.direction = direction;
  return certify_set(mesh, "", request).value();
}

class InAFolder : public ::testing::Test {
 protected:
  void SetUp() override {
    io::write_file(folder_ / "part.off", io::serialise_mesh(bar(), io::Format::Off));
  }
  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};
using CacheWords = InAFolder;

TEST_F(CacheWords, OfSets) {
  const CertifiedSet outer = set_of(bar(), SetRequest::Direction::Outer),
                     inner = set_of(bar(), SetRequest::Direction::Inner);
  EXPECT_EQ(std::string(cache_words::kSets) + ": " + hash_of(outer.artefact()) + " " +
                hash_of(inner.artefact()),
            "planes 34: aeff5a557cd83f1a 7f71fb4b408bf883");
  EXPECT_EQ(std::string(cache_words::kContainers) + ": " + hash(without_version(outer.bytes())),
            "coloured: 2b2f69dff98fbbe8");
}

TEST_F(CacheWords, OfInnerBalls) {
  SetRequest request;
  request.epsilon = Length{5, true};
  request.effort = bcd::Effort::Fast;
  request.direction = SetRequest::Direction::Inner;
  request.body_kind = SetRequest::BodyKind::Spheres;
  const CertifiedSet balls = certify_set(bar(), "", request).value();
  std::string text;
  for (const geom::ConvexBody& body : balls.artefact().bodies) {
    append(text, body.core);
    text += std::to_string(std::bit_cast<std::uint64_t>(body.radius)) + ' ';
  }
  EXPECT_EQ(std::string(cache_words::kInnerBalls) + ": " + hash(text), "cubes 1: 15fcdca6a0b2a9b6");
}

TEST_F(CacheWords, OfLinks) {
  std::ofstream(folder_ / "arm.urdf") << R"(<robot name="arm"><link name="l"><collision>
    <origin xyz="0.7 0.1 -0.3"/><geometry>
    <mesh filename="part.off" scale="0.3 0.3 0.2"/></geometry></collision></link></robot>)";
  RobotRequest request;
  request.set.epsilon = Length{5, true};
  request.set.effort = bcd::Effort::Fast;
  const CertifiedRobot made =
      certify_robot(robot::read_robot((folder_ / "arm.urdf").string()), request);
  EXPECT_EQ(std::string(cache_words::kLinks) + ": " + hash_of(made.links.at(0).artefact()),
            "3, coloured: 812fd72cdf0aa258");
}

TEST_F(CacheWords, OfEnclosures) {
  EnclosureRequest request;
  request.mesh.epsilon = Length{2, true};
  request.mesh.format = io::Format::Stl;
  const EnclosedFile made = enclose_file(folder_ / "part.off", {}, request);
  std::string text;
  append(text, made.enclosure.artefact());
  EXPECT_EQ(std::string(cache_words::kEnclosures) + ": " + hash(text),
            "distance 9: 8a707f5d8c68cc1a");
}

TEST_F(CacheWords, OfReaders) {
  std::string text;
  for (const io::Format format :
       {io::Format::Off, io::Format::Obj, io::Format::Stl, io::Format::Ply, io::Format::Glb}) {
    const io::ReadResult read =
        io::parse_mesh(io::serialise_mesh(test::box({1, 2, 3}, 2), format), format, "box");
    append(text, read.mesh);
    text += read.unit;
    for (const std::string& note : read.notes) text += note;
  }
  EXPECT_EQ(std::string(cache_words::kReaders) + ": " + hash(text), "4: 3a7b975b9ab6bbc2");
}

// Of every answer one at least, so that one that is decided otherwise is seen.
TEST_F(CacheWords, OfDecisions) {
  const CertifiedSet outer = set_of(bar(), SetRequest::Direction::Outer);
  std::string text;
  const auto add = [&](const verify::Claim& claim) {
    text += std::string(verify::name_of(claim.answer)) + ": " + claim.reason + '\n';
  };
  geom::ConvexSet set = outer.artefact();
  for (const double epsilon : {0.0001, 0.05, 1.0}) {
    const auto excess = verify::verify_excess(set, bar(), epsilon, true);
    text += std::string(verify::name_of(excess.answer)) + ": " + excess.reason + '\n';
  }
  for (int i = 0; i < 3; ++i) {
    const verify::Cover cover = verify::verify_cover(bar(), set);
    for (const verify::Claim* claim :
         {&cover.convexity.convex, &cover.inclusion.solid, &cover.inclusion.surface})
      add(*claim);
    if (i == 0) set.bodies.pop_back();
    if (i == 1) std::swap(set.bodies[0].core.triangles[0][0], set.bodies[0].core.triangles[0][1]);
  }
  geom::Mesh open = bar();
  open.triangles.pop_back();
  add(verify::verify_inclusion(open, bar()).solid);
  add(verify::verify_inclusion(bar(), open).surface);
  EXPECT_EQ(std::string(cache_words::kDecisions) + ": " + hash(text),
            "decisions 4: 21a1b6f733975096")
      << text;
}

}  // namespace
}  // namespace kaboum::certify
