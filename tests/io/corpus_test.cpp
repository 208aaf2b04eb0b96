// Reads the mesh collection and compares with its manifest.

#include <fstream>
#include <nlohmann/json.hpp>

#include "io_test.h"
#include "support/corpus.h"

namespace kaboum::io::test {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

Json entries(const fs::path& corpus) {
  std::ifstream file(corpus / "MANIFEST.json");
  return Json::parse(file)["entries"];
}

bool is_readable(const fs::path& path) {
  const auto format = format_from_name(path.extension().string());
  return format && std::ranges::any_of(readable_formats(), [&](const std::string& name) {
           return format_from_name(name) == format;
         });
}

/// Positions that are equal once rounded to float count as one in the manifest.
std::size_t float_positions(const Mesh& mesh) {
  std::map<std::array<float, 3>, int> positions;
  for (const Vec3& p : mesh.vertices)
    ++positions[{static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z())}];
  return positions.size();
}

void compare(const fs::path& file, const Json& entry) {
  std::vector<char> bytes;
  const ReadResult r = read_mesh(file, {}, &bytes);
  EXPECT_EQ(sha256(bytes), entry["sha256"]);
  EXPECT_EQ(r.file_triangles, entry["triangles"]);
  // The manifest keeps collapsed triangles. It merges at float32, so it sees more of them than a
  // reader of doubles; the vertices agree once rounded.
  EXPECT_LE(r.collapsed_triangles, entry["collapsed_triangles"].get<std::size_t>());
  if (r.single_precision) {
    EXPECT_EQ(r.mesh.triangles.size() + r.collapsed_triangles, entry["triangles"]);
  }
  EXPECT_EQ(float_positions(r.mesh), entry["welded_vertices"]);
  if (entry["closed"].get<bool>() && entry["inconsistent_edges"] == 0 &&
      entry["nonmanifold_edges"] == 0 && float_positions(r.mesh) == r.mesh.vertices.size()) {
    EXPECT_TRUE(is_closed_chain(r.mesh));
  }
  for (int axis = 0; axis < 3; ++axis) {
    geom::Box3 box;
    for (const Vec3& p : r.mesh.vertices) box.extend(p);
    const double tolerance = 1e-6 * entry["bbox_diagonal"].get<double>();
    EXPECT_NEAR(box.min[axis], entry["bbox_min"][axis].get<double>(), tolerance);
    EXPECT_NEAR(box.max[axis], entry["bbox_max"][axis].get<double>(), tolerance);
  }
}

TEST(Corpus, MatchesTheManifest) {
  const fs::path corpus = kaboum::test::corpus();
  std::size_t compared = 0;
  for (const Json& entry : entries(corpus)) {
    const fs::path file = corpus / entry["file"].get<std::string>();
    if (!is_readable(file)) continue;
    SCOPED_TRACE(file.string());
    if (entry.contains("non_finite_coordinates")) {
      EXPECT_THROW(read_mesh(file), Error);
      ++compared;
    } else if (entry.contains("welded_vertices")) {
      EXPECT_NO_THROW(compare(file, entry));
      ++compared;
    }
  }
  EXPECT_GT(compared, 0U);
  RecordProperty("meshes", static_cast<int>(compared));
}

}  // namespace
}  // namespace kaboum::io::test
