// Quads that are not plane: whoever splits them the other way finds nothing outside.

#include <gtest/gtest.h>
#include <kaboum/certify/mesh_file.h>
#include <kaboum/certify/set_cache.h>
#include <kaboum/certify/wrap.h>
#include <kaboum/io/file_unit.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/inclusion.h>

#include <filesystem>
#include <fstream>
#include <string>

#include "support/temporary_folder.h"

namespace kaboum::certify {
namespace {

namespace fs = std::filesystem;

/// A cube whose top is a quad with one corner raised, which readers split along its lower diagonal;
/// `other`: two triangles along the higher one.
std::string cube(bool other) {
  std::string text =
      "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1.3\nv 0 1 1\n"
      "f 4 3 2 1\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
  return text + (other ? "f 5 6 7\nf 5 7 8\n" : "f 6 7 8 5\n");
}

io::ReadResult read(const std::string& text) {
  return io::parse_mesh({text.begin(), text.end()}, io::Format::Obj, "cube.obj");
}

bool holds(const geom::Mesh& outer, const geom::Mesh& inner) {
  verify::InclusionOptions options;
  options.surface_only = true;
  return verify::verify_inclusion(inner, outer, options).surface.answer == verify::Answer::Verified;
}

TEST(BentQuads, AWrapHoldsBothWaysOfSplitting) {
  const io::ReadResult given = read(cube(false));
  const geom::Mesh other = read(cube(true)).mesh;
  ASSERT_EQ(given.bent_quads.size(), 1U);
  WrapRequest request;
  request.offset = Length{0.5, true};
  request.seal = Length{2, true};
  const CertifiedWrap one_way = certify_wrap(given.mesh, request);
  EXPECT_FALSE(holds(one_way.artefact(), other));
  request.quads = given.bent_quads;
  const CertifiedWrap wrap = certify_wrap(given.mesh, request);
  EXPECT_TRUE(holds(wrap.artefact(), other));
  EXPECT_TRUE(holds(wrap.artefact(), given.mesh));
  EXPECT_EQ(wrap.certificate().input_triangles, given.mesh.triangles.size());
}

TEST(BentQuads, ArePartOfTheCachesKey) {
  const io::ReadResult given = read(cube(false));
  SetRequest plain;
  SetRequest outward = plain;
  outward.preparation.quads = given.bent_quads;
  outward.preparation.diagonal = geom::PrepareOptions::Diagonal::Outward;
  SetRequest inward = outward;
  inward.preparation.diagonal = geom::PrepareOptions::Diagonal::Inward;
  inward.direction = SetRequest::Direction::Inner;
  EXPECT_NE(SetCache::key_of(given.mesh, "x", plain).hash,
            SetCache::key_of(given.mesh, "x", outward).hash);
  EXPECT_NE(SetCache::key_of(given.mesh, "x", inward).hash,
            SetCache::key_of(given.mesh, "x", outward).hash);
}

TEST(BentQuads, ASetOfAMeshDoesNotStandForThatOfItsFile) {
  const test::TemporaryFolder temporary;
  const fs::path& folder = temporary.path();
  std::string text = cube(false);
  text.append(40000, '#').append("\n");  // large enough to be known by its bytes
  std::ofstream(folder / "cube.obj") << text;
  const SetCache cache(folder / "cache");
  SetRequest request;
  request.epsilon = Length{1, true};
  for (int again = 0; again < 2; ++again) {
    const CertifiedFile file = certify_file(folder / "cube.obj", {}, request, &cache);
    ASSERT_EQ(file.found.set.artefact().bodies.size(), 1U);
    EXPECT_TRUE(holds(file.found.set.artefact().bodies.front().core, read(cube(true)).mesh));
    // As a program would that knows nothing of quads.
    SetRequest plain = request;
    plain.source = "cube.obj";
    ASSERT_TRUE(find_or_certify(read(text).mesh, file.sha256, plain, &cache));
  }
}

TEST(BentQuads, AreFollowedThroughAScale) {
  io::ReadResult given = read(cube(false));
  const geom::Triangle before = given.mesh.triangles[given.bent_quads.front()];
  io::scale(given, 0.001, "cube.obj");
  ASSERT_EQ(given.bent_quads.size(), 1U);
  EXPECT_EQ(given.mesh.triangles[given.bent_quads.front()], before);
}

}  // namespace
}  // namespace kaboum::certify
