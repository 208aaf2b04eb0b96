// Meshes as text for pages: base64 (RFC 4648) of numbers of 32 bits.

#include <kaboum/io/packed_mesh.h>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace kaboum::io {
namespace {

std::string to_base64(std::span<const unsigned char> bytes) {
  static constexpr char kDigits[] =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8U | (k < count ? std::uint32_t{bytes[i + k]} : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out += k <= count ? kDigits[word >> (18 - 6 * k) & 63U] : '=';
  }
  return out;
}

template <class Number>
std::string packed(std::span<const Number> numbers) {
  static_assert(sizeof(Number) == 4);
  std::vector<unsigned char> bytes;
  bytes.reserve(4 * numbers.size());
  for (const Number number : numbers) {
    const auto word = std::bit_cast<std::uint32_t>(number);
    for (unsigned k = 0; k < 4; ++k) bytes.push_back(word >> 8 * k & 255U);
  }
  return to_base64(bytes);
}

}  // namespace

PackedMesh pack_mesh(const geom::Mesh& mesh) {
  std::vector<float> points;
  points.reserve(3 * mesh.vertices.size());
  for (const geom::Vec3& v : mesh.vertices)
    for (const double x : v) points.push_back(static_cast<float>(x));
  std::vector<std::uint32_t> corners;
  corners.reserve(3 * mesh.triangles.size());
  for (const geom::Triangle& t : mesh.triangles) corners.insert(corners.end(), t.begin(), t.end());
  return {pack_floats(points), packed(std::span<const std::uint32_t>(corners))};
}

std::string pack_floats(std::span<const float> numbers) { return packed(numbers); }

}  // namespace kaboum::io
