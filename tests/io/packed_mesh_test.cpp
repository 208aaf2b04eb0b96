// Meshes as text of pages: what is packed is what other programs unpack.
#include <gtest/gtest.h>
#include <kaboum/io/packed_mesh.h>

#include <array>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::io {
namespace {

/// RFC 4648, by its table of digits alone.
std::vector<unsigned char> unpacked(std::string_view text) {
  std::vector<unsigned char> out;
  std::uint32_t bits = 0;
  int count = 0;
  for (const char c : text) {
    if (c == '=') break;
    std::uint32_t digit = 0;
    if (c >= 'A' && c <= 'Z')
      digit = static_cast<std::uint32_t>(c - 'A');
    else if (c >= 'a' && c <= 'z')
      digit = 26 + static_cast<std::uint32_t>(c - 'a');
    else if (c >= '0' && c <= '9')
      digit = 52 + static_cast<std::uint32_t>(c - '0');
    else
      digit = c == '+' ? 62 : 63;
    bits = bits << 6 | digit;
    count += 6;
    if (count < 8) continue;
    count -= 8;
    out.push_back(static_cast<unsigned char>(bits >> count & 255U));
  }
  return out;
}

TEST(PackedMesh, KnownText) {
  const std::array<float, 2> numbers{1.0F, -2.5F};
  EXPECT_EQ(pack_floats(std::span(numbers).first(1)), "AACAPw==");
  EXPECT_EQ(pack_floats(numbers), "AACAPwAAIMA=");
  EXPECT_EQ(pack_floats({}), "");
}

TEST(PackedMesh, HoldsAllNumbers) {
  geom::Mesh mesh;
  for (int i = 0; i < 7; ++i) {
    mesh.vertices.emplace_back(0.1 * i, -1e-20 * i, 3e10 + i);
    mesh.triangles.push_back({static_cast<std::uint32_t>(i), 70000, 4294967294U});
    const PackedMesh packed = pack_mesh(mesh);
    EXPECT_EQ(packed.points.size() % 4, 0U);
    const std::vector<unsigned char> points = unpacked(packed.points);
    const std::vector<unsigned char> corners = unpacked(packed.triangles);
    ASSERT_EQ(points.size(), 12 * mesh.vertices.size());
    ASSERT_EQ(corners.size(), 12 * mesh.triangles.size());
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      for (std::size_t k = 0; k < 3; ++k) {
        float x = 0;
        std::memcpy(&x, &points[12 * v + 4 * k], 4);
        EXPECT_EQ(x, static_cast<float>(mesh.vertices[v][static_cast<int>(k)]));
        std::uint32_t corner = 0;
        std::memcpy(&corner, &corners[12 * v + 4 * k], 4);
        EXPECT_EQ(corner, mesh.triangles[v][k]);
      }
  }
}

}  // namespace
}  // namespace kaboum::io
