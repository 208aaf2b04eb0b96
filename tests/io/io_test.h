#pragma once

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::io::test {

using geom::Mesh;
using geom::Triangle;
using geom::Vec3;

inline ReadResult parse(std::string_view text, Format format,
                        const std::filesystem::path& directory = {}) {
  return parse_mesh({text.data(), text.size()}, format, "sample", directory);
}

/// Parsing fails with `code`, and the message holds each of `parts`.
inline void expect_error(std::string_view text, Format format,
                         const std::vector<std::string>& parts,
                         ErrorCode code = ErrorCode::InvalidInput) {
  try {
    parse(text, format);
    ADD_FAILURE() << "no error for: " << text.substr(0, 200);
  } catch (const Error& e) {
    EXPECT_EQ(e.code(), code) << e.what();
    for (const std::string& part : parts)
      EXPECT_NE(std::string(e.what()).find(part), std::string::npos)
          << "'" << part << "' is not in: " << e.what();
    EXPECT_NE(std::string(e.what()).find("sample"), std::string::npos) << e.what();
  }
}

inline Mesh tetrahedron() {
  return {{Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

/// Every directed edge is cancelled by its opposite.
inline bool is_closed_chain(const Mesh& mesh) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> balance;
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      a < b ? ++balance[{a, b}] : --balance[{b, a}];
    }
  }
  return std::ranges::all_of(balance, [](const auto& entry) { return entry.second == 0; });
}

/// Corner positions of all triangles in order: what a file says, whatever its vertex numbers.
inline std::vector<Vec3> soup(const Mesh& mesh) {
  std::vector<Vec3> corners;
  for (const Triangle& t : mesh.triangles)
    for (const std::uint32_t c : t) corners.push_back(mesh.vertices[c]);
  return corners;
}

inline bool has_note(const ReadResult& result, std::string_view part) {
  return std::ranges::any_of(
      result.notes, [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

template <typename T>
void append(std::string& bytes, T value, bool big_endian = false) {
  std::array<char, sizeof(T)> raw = std::bit_cast<std::array<char, sizeof(T)>>(value);
  if (big_endian) std::ranges::reverse(raw);
  bytes.append(raw.data(), raw.size());
}

inline std::string binary_stl(const std::vector<std::array<float, 9>>& facets,
                              std::string header = "x") {
  header.resize(80, '\0');
  append(header, static_cast<std::uint32_t>(facets.size()));
  for (const auto& facet : facets) {
    header.append(12, '\0');
    for (const float x : facet) append(header, x);
    header.append(2, '\0');
  }
  return header;
}

}  // namespace kaboum::io::test
