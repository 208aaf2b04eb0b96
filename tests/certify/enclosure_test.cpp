// Enclosing meshes of files and of robots' links: they hold the file's mesh by the verifier, are
// the same from the cache, and no entry is used that is not whole or is of another file.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/certify/link_enclosures.h>
#include <kaboum/certify/mesh_file.h>
#include <kaboum/certify/set_cache.h>
#include <kaboum/verify/distance.h>
#include <kaboum/verify/inclusion.h>

#include <cstdlib>
#include <fstream>

#include "enclosure_record.h"
#include "support/shapes.h"
#include "support/temporary_folder.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;
using verify::Answer;

class EnclosureTest : public ::testing::Test {
 protected:
  void SetUp() override { write("part.off", part()); }

  static geom::Mesh part() { return test::torus(1, 0.3, 48, 24); }
  void write(const std::string& name, const geom::Mesh& mesh) const {
    io::write_file(folder_ / name, io::serialise_mesh(mesh, *io::format_from_name("off")));
  }
  static EnclosureRequest fast() {
    EnclosureRequest request;
    request.mesh.epsilon = Length{2, true};
    request.mesh.effort = bmesh::Effort::Fast;
    request.mesh.format = io::Format::Stl;
    request.mesh.decide = false;
    return request;
  }
  [[nodiscard]] CacheFolder cache() const { return CacheFolder(folder_ / "cache"); }
  /// Cuts the entries of this kind short, or changes a byte of them.
  void damage(std::string_view kind) const {
    for (const CacheFolder::Entry& entry : cache().entries()) {
      if (CacheFolder::kind_of(entry) != kind) continue;
      std::fstream file(entry.path, std::ios::binary | std::ios::in | std::ios::out);
      file.seekp(static_cast<std::streamoff>(entry.bytes / 2));
      file.put('X');
      file.put('Y');
    }
  }

  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_.path();
};

TEST_F(EnclosureTest, HoldsTheFilesMesh) {
  EnclosureRequest request = fast();
  for (const bool decide : {false, true}) {
    request.mesh.decide = decide;
    const EnclosedFile made = enclose_file(folder_ / "part.off", {}, request);
    const EnclosureCertificate& c = made.enclosure.certificate();
    const geom::Mesh& mesh = made.enclosure.artefact();
    EXPECT_EQ(c.vertices_in, part().vertices.size());
    EXPECT_EQ(c.vertices, mesh.vertices.size());
    EXPECT_LT(c.vertices, c.vertices_in / 2);
    EXPECT_EQ(io::parse_mesh(made.enclosure.bytes(), io::Format::Stl, "it").mesh.vertices,
              mesh.vertices);
    const verify::Inclusion inclusion = verify::verify_inclusion(part(), mesh);
    EXPECT_EQ(inclusion.solid.answer, Answer::Verified);
    EXPECT_EQ(inclusion.surface.answer, Answer::Verified);
    EXPECT_LE(c.distance_upper, *c.epsilon);
    EXPECT_EQ(verify::verify_distance(mesh, part(), c.distance_upper * 1.0001).answer,
              Answer::Verified);
    ASSERT_FALSE(c.claims.empty());
    EXPECT_EQ(c.claims[0].kind, Claim::Kind::Solid);
    EXPECT_EQ(c.claims[0].basis, decide ? Basis::Bytes : Basis::Steps);
    EXPECT_EQ(c.claims[0].answer, Answer::Verified);
  }
}

TEST_F(EnclosureTest, WrapsCountTowardsEpsilon) {
  geom::Mesh open = part();
  open.triangles.resize(open.triangles.size() - 20);
  write("open.off", open);
  EnclosureRequest request = fast();
  request.preparation.holes = geom::Holes::Keep;
  EXPECT_THROW(enclose_file(folder_ / "open.off", {}, request), Error);
  request.mesh.epsilon = Length{0.3};
  request.wrap.emplace();
  const EnclosedFile made = enclose_file(folder_ / "open.off", {}, request);
  const EnclosureCertificate& c = made.enclosure.certificate();
  ASSERT_TRUE(c.wrap);
  EXPECT_LE(c.distance_upper, 0.3 * (1 + 1e-12));
  EXPECT_GT(c.distance_upper, c.wrap->farthest_upper);
  verify::InclusionOptions options;
  options.surface_only = true;
  EXPECT_EQ(verify::verify_inclusion(open, made.enclosure.artefact(), options).surface.answer,
            Answer::Verified);
}

TEST_F(EnclosureTest, IsTheSameFromTheCache) {
  const CacheFolder kept = cache();
  const EnclosedFile first = enclose_file(folder_ / "part.off", {}, fast(), &kept);
  EXPECT_FALSE(first.cached);
  const EnclosedFile second = enclose_file(folder_ / "part.off", {}, fast(), &kept);
  EXPECT_TRUE(second.cached);
  EXPECT_EQ(first.enclosure.bytes(), second.enclosure.bytes());
  EXPECT_EQ(first.sha256, second.sha256);
  EXPECT_EQ(first.enclosure.artefact().vertices, second.enclosure.artefact().vertices);
  EXPECT_EQ(write_enclosure(first.enclosure.certificate()),
            write_enclosure(second.enclosure.certificate()));
  EXPECT_EQ(to_json(first.enclosure), to_json(second.enclosure));
  for (const char* other : {"vertices", "epsilon", "decide", "format", "sheets"}) {
    EnclosureRequest request = fast();
    const std::string what = other;
    if (what == "vertices") request.mesh.vertices = {100};
    if (what == "epsilon") request.mesh.epsilon = Length{3, true};
    if (what == "decide") request.mesh.decide = true;
    if (what == "format") request.mesh.format = io::Format::Obj;
    if (what == "sheets") request.preparation.drop_sheets = true;
    EXPECT_FALSE(enclose_file(folder_ / "part.off", {}, request, &kept).cached) << what;
  }
}

TEST_F(EnclosureTest, OtherBytesAreAnotherMesh) {
  const CacheFolder kept = cache();
  const EnclosedFile first = enclose_file(folder_ / "part.off", {}, fast(), &kept);
  write("part.off", test::scaled(part(), {1, 1, 1.5}));  // of the same size
  const EnclosedFile second = enclose_file(folder_ / "part.off", {}, fast(), &kept);
  EXPECT_FALSE(second.cached);
  EXPECT_NE(first.enclosure.bytes(), second.enclosure.bytes());
  // By its triangles it is found under another name.
  write("same.off", part());
  EXPECT_TRUE(enclose_file(folder_ / "same.off", {}, fast(), &kept).cached);
}

TEST_F(EnclosureTest, DamageIsNotUsed) {
  const CacheFolder kept = cache();
  const EnclosedFile first = enclose_file(folder_ / "part.off", {}, fast(), &kept);
  ASSERT_EQ(kept.entries().size(), 2U);  // the mesh, and what the file was read as
  for (const char* kind : {"KABOUM-MESH 2", "KABOUM-FILE 1"}) {
    damage(kind);
    const EnclosedFile again = enclose_file(folder_ / "part.off", {}, fast(), &kept);
    EXPECT_EQ(again.cached, std::string(kind) == "KABOUM-FILE 1") << kind;
    EXPECT_EQ(again.enclosure.bytes(), first.enclosure.bytes());
    for (const CacheFolder::Entry& entry : kept.entries())
      EXPECT_EQ(CacheFolder::flaw_of(entry), "") << "not written again";
  }
}

TEST_F(EnclosureTest, RecordsOfOtherThingsAreRefused) {
  const EnclosedFile made = enclose_file(folder_ / "part.off", {}, fast());
  const std::string record = write_enclosure(made.enclosure.certificate());
  EXPECT_EQ(write_enclosure(read_enclosure(record)), record);
  for (const auto& [from, to] :
       {std::pair{"\"solid\"", "\"solids\""}, std::pair{"\"verified\"", "\"sure\""},
        std::pair{"\"vertices_in\"", "\"vertices_out\""},
        std::pair{"by exact tests of every step", "by trust"}}) {
    std::string wrong = record;
    const std::size_t at = wrong.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    wrong.replace(at, std::string(from).size(), to);
    EXPECT_THROW(read_enclosure(wrong), Error) << to;
  }
  EXPECT_THROW(read_enclosure(""), Error);
  // Counts are whole: no number beyond them is converted.
  for (const char* count : {"1e300", "-1", "1.5"}) {
    const std::size_t at = record.find("\"vertices\":") + 11;
    const std::string wrong = std::string(record).replace(at, record.find(',', at) - at, count);
    EXPECT_THROW(read_enclosure(wrong), Error) << count;
  }
}

TEST_F(EnclosureTest, SetsOfKnownFilesAreThoseOfReadOnes) {
  SetRequest request;
  request.epsilon = Length{5, true};
  request.effort = bcd::Effort::Fast;
  const SetCache kept(folder_ / "cache");
  const CertifiedFile first = certify_file(folder_ / "part.off", {}, request, &kept);
  EXPECT_FALSE(first.found.cached);
  const CertifiedFile known = certify_file(folder_ / "part.off", {}, request, &kept);
  EXPECT_TRUE(known.found.cached);
  EXPECT_EQ(first.found.set.bytes(), known.found.set.bytes());
  EXPECT_EQ(first.sha256, known.sha256);
  damage("KABOUM-SET 3");
  EXPECT_FALSE(certify_file(folder_ / "part.off", {}, request, &kept).found.cached);
  write("part.off", test::scaled(part(), {1, 1, 1.5}));
  EXPECT_FALSE(certify_file(folder_ / "part.off", {}, request, &kept).found.cached);
}

TEST_F(EnclosureTest, LinksHaveTheirOwnEpsilon) {
  std::ofstream(folder_ / "arm.urdf") << R"(<robot name="arm">
    <link name="a"><collision><geometry><mesh filename="part.off"/></geometry></collision></link>
    <link name="b"><collision><geometry><mesh filename="part.off"/></geometry></collision></link>
    <link name="c"><collision><geometry><mesh filename="part.off" scale="0.001 0.001 0.001"/></geometry></collision></link>
    <joint name="i" type="fixed"><parent link="a"/><child link="b"/></joint>
    <joint name="j" type="fixed"><parent link="b"/><child link="c"/></joint></robot>)";
  const robot::RobotFile file = robot::read_robot((folder_ / "arm.urdf").string());
  LinkEnclosuresRequest request{fast(), {}, {}, {{"b", Length{1, true}}, {"c", Length{1e-4}}}};
  const LinkEnclosures made = enclose_links(file, request);
  ASSERT_EQ(made.meshes.size(), 3U);
  EXPECT_EQ(made.meshes[0].epsilon, (Length{2, true}));
  EXPECT_EQ(made.meshes[1].epsilon, (Length{1, true}));
  EXPECT_NEAR(made.meshes[2].epsilon->value, 0.1, 1e-15);
  EXPECT_FALSE(made.meshes[2].epsilon->percent);
  request.epsilons = {{"d", Length{1, true}}};
  EXPECT_THROW(enclose_links(file, request), Error);
}

// Sheets that are dropped on request are not asked for; what else preparing leaves out is.
TEST_F(EnclosureTest, SegmentsAreHeldThoughSheetsMayBeDropped) {
  geom::Mesh mesh = test::box({1, 1, 1}, 1);
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  const geom::Vec3 end{0.5, 0.5, 4};
  mesh.vertices.insert(mesh.vertices.end(), {geom::Vec3{0.5, 0.5, 0.5}, end});
  mesh.triangles.push_back({first, first + 1, first + 1});
  EnclosureRequest request = fast();
  request.preparation.drop_sheets = true;
  request.wrap.emplace().where_needed = true;
  const auto made = certify_enclosure(mesh, request);
  ASSERT_TRUE(made);
  EXPECT_EQ(made->certificate().inside.answer, Answer::Verified);
  EXPECT_GE(geom::bounding_box(made->artefact()).max.z(), end.z());
}

}  // namespace
}  // namespace kaboum::certify
