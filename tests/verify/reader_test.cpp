// What is verified is what is in the files: the project's reader against a second, plain one.
#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "plain_reader.h"
#include "support/corpus.h"
#include "support/families.h"

namespace {

using namespace kaboum;        // NOLINT: a test
using namespace kaboum::test;  // NOLINT: a test
namespace fs = std::filesystem;

Corner corner(const geom::Vec3& p) { return {p.x() + 0.0, p.y() + 0.0, p.z() + 0.0}; }

Polygon triangle(const geom::Mesh& mesh, const geom::Triangle& t) {
  return {corner(mesh.vertices[t[0]]), corner(mesh.vertices[t[1]]), corner(mesh.vertices[t[2]])};
}

using Edges = std::map<std::pair<Corner, Corner>, long>;

void add(const Polygon& p, Edges& edges, long factor) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Corner &a = p[i], &b = p[(i + 1) % p.size()];
    if (a < b) edges[{a, b}] += factor;
    if (b < a) edges[{b, a}] -= factor;
  }
}

enum class Comparison { Same, SameBorders, Refused };

/// Compares both readings of a file: triangles one by one, files with polygons by the sum of their
/// edges.
Comparison compare(const std::string& path) {
  io::ReadResult read;
  try {
    read = io::read_mesh(path);
  } catch (const Error&) {
    return Comparison::Refused;
  }
  std::vector<Polygon> plain = read_plainly(path);
  for (Polygon& p : plain) {
    for (Corner& c : p) {
      for (double& x : c) x += 0.0;  // −0 = +0
    }
  }
  std::size_t triangles = 0;
  bool polygons = false;
  for (const Polygon& p : plain) {
    triangles += p.size() < 3 ? 0 : p.size() - 2;
    polygons = polygons || p.size() != 3;
  }
  EXPECT_EQ(read.file_triangles, triangles) << path;
  if (polygons) {
    Edges edges;
    for (const Polygon& p : plain) add(p, edges, 1);
    for (const geom::Triangle& t : read.mesh.triangles) add(triangle(read.mesh, t), edges, -1);
    EXPECT_TRUE(std::all_of(edges.begin(), edges.end(), [](const auto& e) {
      return e.second == 0;
    })) << path;
    return Comparison::SameBorders;
  }
  std::erase_if(plain,
                [](const Polygon& p) { return p[0] == p[1] || p[1] == p[2] || p[2] == p[0]; });
  EXPECT_EQ(read.mesh.triangles.size(), plain.size()) << path;
  for (std::size_t i = 0; i < std::min(plain.size(), read.mesh.triangles.size()); ++i) {
    if (triangle(read.mesh, read.mesh.triangles[i]) == plain[i]) continue;
    ADD_FAILURE() << path << ": triangle " << i;
    break;
  }
  return Comparison::Same;
}

TEST(Reader, ReadsWhatTheWritersWroteLikeAPlainOne) {
  const fs::path folder = fs::temp_directory_path() / ("reader-test-" + std::to_string(getpid()));
  fs::create_directory(folder);
  int compared = 0;
  for (const auto& list : {closed_families(), open_families()}) {
    for (std::size_t i = 0; i < list.size(); i += 3) {
      for (const char* format : {"off", "obj", "ply", "ply-ascii", "stl", "stl-ascii"}) {
        const io::Format f = io::format_from_name(format).value();
        io::WriteOptions options;
        options.double_precision = true;
        std::vector<char> bytes;
        try {
          bytes = io::serialise_mesh(list[i].mesh, f, options);
        } catch (const Error&) {
          continue;  // binary STL cannot hold the coordinates
        }
        const std::string name = format;
        const fs::path path = folder / ("mesh." + name.substr(0, 3));
        io::write_file(path, bytes);
        SCOPED_TRACE(list[i].name + " as " + name);
        EXPECT_EQ(compare(path), Comparison::Same);
        // Both read what was handed over, not merely the same.
        const auto plain = read_plainly(path);
        ASSERT_EQ(plain.size(), list[i].mesh.triangles.size());
        for (std::size_t t = 0; t < plain.size(); ++t)
          ASSERT_EQ(plain[t], triangle(list[i].mesh, list[i].mesh.triangles[t]));
        ++compared;
      }
    }
  }
  fs::remove_all(folder);
  EXPECT_GE(compared, 80);
}

TEST(CorpusReader, ReadsLikeAPlainOne) {
  int compared = 0;
  for (const auto& entry : fs::recursive_directory_iterator(test::corpus())) {
    const std::string extension = entry.path().extension();
    if (extension != ".off" && extension != ".obj" && extension != ".stl" && extension != ".ply")
      continue;
    if (compare(entry.path()) != Comparison::Refused) ++compared;
  }
  EXPECT_GT(compared, 0);
}

}  // namespace
