// Point clouds in all their formats, and files that are not what they say.

#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/io/number_array.h>
#include <kaboum/io/point_cloud.h>

#include <bit>
#include <cmath>
#include <cstring>
#include <functional>
#include <random>

namespace kaboum::io {
namespace {

using geom::Vec3;

PointCloud read(const std::string& bytes, const std::string& name) {
  return parse_point_cloud({bytes.data(), bytes.size()}, name);
}

std::string message(const std::string& bytes, const std::string& name) {
  try {
    read(bytes, name);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidInput);
    EXPECT_TRUE(std::string(error.what()).starts_with(name)) << error.what();
    return error.what();
  }
  return "no error";
}

/// Bytes of numbers one after the other.
template <typename... Numbers>
std::string packed(bool big, Numbers... numbers) {
  std::string out;
  const auto add = [&](auto number) {
    std::string raw(sizeof number, '\0');
    std::memcpy(raw.data(), &number, sizeof number);
    if (big) std::ranges::reverse(raw);
    out += raw;
  };
  (add(numbers), ...);
  return out;
}

const std::vector<Vec3> kTwo{{1, 2, 3}, {-0.5, 4, 1e-3F}};

void expect_two(const PointCloud& cloud, const char* what) {
  ASSERT_EQ(cloud.points.size(), 2) << what;
  for (int i = 0; i < 2; ++i) EXPECT_EQ(cloud.points[i], kTwo[i]) << what;
  EXPECT_EQ(cloud.numbers, (std::vector<std::uint32_t>{1, 2})) << what;
  EXPECT_EQ(cloud.invalid, 0U) << what;
}

std::string pcd_header(const std::string& data, const std::string& points = "2",
                       const std::string& rest = "VIEWPOINT 0 0 0 1 0 0 0\n") {
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y rgb z\nSIZE 4 8 4 4\n"
         "TYPE F F U F\nCOUNT 1 1 1 1\nWIDTH " +
         points + "\nHEIGHT 1\n" + rest + "POINTS " + points + "\nDATA " + data + "\n";
}

const std::string kBinary = packed(false, 1.0F, 2.0, 0xffU, 3.0F, -0.5F, 4.0, 0U, 1e-3F);
/// Field after field, as compressed ones are.
const std::string kByField = packed(false, 1.0F, -0.5F, 2.0, 4.0, 0xffU, 0U, 3.0F, 1e-3F);

std::string compressed(const std::string& packed_bytes, std::size_t size) {
  return packed(false, static_cast<std::uint32_t>(packed_bytes.size()),
                static_cast<std::uint32_t>(size)) +
         packed_bytes;
}

/// LZF without repetitions.
std::string literal(const std::string& bytes) {
  std::string out;
  for (std::size_t at = 0; at < bytes.size(); at += 32) {
    const std::string part = bytes.substr(at, 32);
    out += static_cast<char>(part.size() - 1);
    out += part;
  }
  return out;
}

TEST(PointCloud, FormatsSayTheSame) {
  const std::string z = "0.0010000000474974513";
  expect_two(read("x y z r\n1 2 3 255\n# none\n-0.5\t4 " + z + " 7 // more\n\n", "a.xyz"), "xyz");
  expect_two(read("X,Y,Z\r\n1,2,3\r\n-0.5,4," + z + "\r\n", "a.CSV"), "csv");
  expect_two(read("1;2;3\n-0.5;4;" + z, "a.txt"), "txt");
  expect_two(read("ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty uchar red\n"
                  "property float y\nproperty double z\nend_header\n1 9 2 3\n-0.5 9 4 " +
                      z + "\n",
                  "a.ply"),
             "ascii ply");
  for (const bool big : {false, true})
    expect_two(
        read("ply\nformat binary_" + std::string(big ? "big" : "little") +
                 "_endian 1.0\nelement vertex 2\nproperty float x\nproperty uchar red\n"
                 "property float y\nproperty float z\nelement face 0\nproperty list uchar int "
                 "vertex_indices\nend_header\n" +
                 packed(big, 1.0F, '\7', 2.0F, 3.0F, -0.5F, '\7', 4.0F, 1e-3F),
             "a.ply"),
        "binary ply");
  expect_two(read(pcd_header("ascii") + "1 2 255 3\n-0.5 4 0 " + z + "\n", "a.pcd"), "ascii pcd");
  expect_two(read(pcd_header("binary") + kBinary, "a.pcd"), "binary pcd");
  expect_two(read(pcd_header("binary_compressed") + compressed(literal(kByField), 40), "a.pcd"),
             "compressed pcd");
  const std::string header = "{'descr': '<f8', 'fortran_order': True, 'shape': (2, 3), }\n";
  expect_two(read("\x93NUMPY\x01" + std::string(1, '\0') +
                      packed(false, static_cast<std::uint16_t>(header.size())) + header +
                      packed(false, 1.0, -0.5, 2.0, 4.0, 3.0, static_cast<double>(1e-3F)),
                  "a.npy"),
             "npy");
}

/// What the reader unpacks is what was there; packed here by another way than the reader's.
TEST(PointCloud, RepetitionsAreUnpacked) {
  std::string points;
  for (int i = 0; i < 300; ++i) points += packed(false, 1.0F);
  std::string fields;
  for (int f = 0; f < 3; ++f) fields += points;
  std::string lzf = literal(packed(false, 1.0F));
  // Copies of 264, 9 and 3 bytes from four bytes back.
  std::size_t size = 4;
  while (size + 264 <= fields.size()) {
    lzf += std::string("\xe0\xff\x03", 3);
    size += 264;
  }
  while (size + 9 <= fields.size()) {
    lzf += std::string("\xe0\x00\x03", 3);
    size += 9;
  }
  while (size + 3 <= fields.size()) {
    lzf += std::string("\x20\x03", 2);
    size += 3;
  }
  if (size < fields.size()) lzf += literal(fields.substr(size));
  const std::string header =
      "VERSION .7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 30\nHEIGHT 10\n"
      "POINTS 300\nDATA binary_compressed\n";
  const PointCloud cloud = read(header + compressed(lzf, fields.size()), "a.pcd");
  ASSERT_EQ(cloud.points.size(), 300);
  for (const Vec3& p : cloud.points) EXPECT_EQ(p, Vec3(1, 1, 1));
}

TEST(PointCloud, PointsThatAreNoneAreCounted) {
  const PointCloud cloud = read("nan nan nan\n1 2 3\n1 -inf 2\n-0.5 4 0.5\n", "a.xyz");
  EXPECT_EQ(cloud.points.size(), 2);
  EXPECT_EQ(cloud.numbers, (std::vector<std::uint32_t>{2, 4}));
  EXPECT_EQ(cloud.invalid, 2U);
  EXPECT_EQ(cloud.first_invalid, 1U);
  const PointCloud binary =
      read(pcd_header("binary") + packed(false, NAN, 2.0, 0U, 3.0F, 1.0F, 4.0, 0U, 5.0F), "a.pcd");
  EXPECT_EQ(binary.invalid, 1U);
  EXPECT_EQ(binary.numbers, (std::vector<std::uint32_t>{2}));
  EXPECT_NE(message("nan 1 2\n", "a.xyz").find("none of its 1 point has finite"),
            std::string::npos);
}

TEST(PointCloud, ViewpointsAreNoticed) {
  const auto with = [](const std::string& line) {
    return read(pcd_header("binary", "2", line) + kBinary, "a.pcd").has_viewpoint;
  };
  EXPECT_FALSE(with("VIEWPOINT 0 0 0 1 0 0 0\n"));
  EXPECT_FALSE(with(""));
  EXPECT_TRUE(with("VIEWPOINT 0 0 0.1 1 0 0 0\n"));
  EXPECT_TRUE(with("VIEWPOINT 0 0 0 0 1 0 0\n"));
}

TEST(PointCloud, WhatIsDamagedIsRefusedByPlace) {
  const std::vector<std::array<std::string, 3>> cases{
      {"", "a.xyz", "empty"},
      {"# nothing\n", "a.xyz", "no points"},
      {"1 2 3\n1 2\n", "a.xyz", "line 2: 2 numbers"},
      {"1 2 3\n1 2 x\n", "a.xyz", "line 2"},
      {"1 2 3\n1 2 1e999\n", "a.xyz", "line 2"},
      {"a b c\n1 2 3\n", "a.xyz", "line 1"},
      {"1 2 3\n", "a.las", "no format of point clouds"},
      {"1 2 3\n", "a", "no format of point clouds"},
      {"nonsense\n", "a.pcd", "line 1: unknown line"},
      {"nonsense", "a.pcd", "ends in its PCD header"},
      {pcd_header("octal") + kBinary, "a.pcd", "line 11: data of the kind"},
      {pcd_header("binary") + kBinary.substr(1), "a.pcd",
       "states 2 points of 20 bytes, more than the file holds"},
      {pcd_header("binary") + kBinary + "x", "a.pcd", "goes on after"},
      {pcd_header("binary", "1000000000000") + kBinary, "a.pcd", "more than the file holds"},
      {pcd_header("ascii") + "1 2 3 4\n", "a.pcd", "states 2 points, and the file has 1"},
      {pcd_header("ascii") + "1 2 3 4\n1 2 3 4\n1 2 3 4\n", "a.pcd",
       "states 2 points, and the file has 3"},
      {pcd_header("ascii") + "1 2 3 4\n1 2 3\n", "a.pcd", "line 13: 3 values where 4"},
      {"FIELDS x y\nSIZE 4 4\nTYPE F F\nCOUNT 1 1\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 1\n",
       "a.pcd", "no field 'z'"},
      {"FIELDS x y z x\nSIZE 4 4 4 4\nTYPE F F F F\nWIDTH 1\nHEIGHT 1\nPOINTS 1\nDATA ascii\n1 1 1 "
       "1\n",
       "a.pcd", "two fields 'x'"},
      {"FIELDS x y z\nSIZE 4 4\n", "a.pcd", "line 2: 2 entries for 3 fields"},
      {"FIELDS x y z\nSIZE 3 4 4\nTYPE F F F\nWIDTH 1\nHEIGHT 1\nDATA binary\n", "a.pcd",
       "3 bytes"},
      {"FIELDS x y z\nTYPE F G F\n", "a.pcd", "line 2: 'G' where a type"},
      {"FIELDS x y z\nWIDTH 2\nHEIGHT 3\nPOINTS 5\nDATA ascii\n", "a.pcd", "states 5 POINTS"},
      {"FIELDS x y z\nWIDTH 1000000000000\nHEIGHT 1000000000000\nDATA ascii\n", "a.pcd",
       "more than a file holds"},
      {"FIELDS x y z\nWIDTH -2\n", "a.pcd", "line 2"},
      {"FIELDS x y z\nDATA ascii\n", "a.pcd", "no WIDTH"},
      {"FIELDS x y z\nTYPE F F F\nWIDTH 1\nDATA binary\n" + kBinary.substr(0, 12), "a.pcd",
       "no SIZE"},
      {"FIELDS x y z\nSIZE 4 4 4\nWIDTH 1\nDATA binary\n" + kBinary.substr(0, 12), "a.pcd",
       "no TYPE"},
      {"FIELDS x y z\nWIDTH 1\nWIDTH 2\n", "a.pcd", "line 3: 'WIDTH' is there twice"},
      {"FIELDS x y z\nCOLUMNS x y z\n", "a.pcd", "line 2"},
      {"FIELDS x\nTYPE,,\n", "a.pcd", "line 2"},
      {"0,5;1,5;2,5\n", "a.csv", "line 1: commas and semicolons"},
      {pcd_header("binary_compressed") + compressed(literal(kByField), 40).substr(0, 30), "a.pcd",
       "cut"},
      {pcd_header("binary_compressed") + compressed(literal(kByField), 44), "a.pcd",
       "another size"},
      {pcd_header("binary_compressed") +
           compressed(std::string("\xe0\xff\x03", 3) + std::string(40, '\0'), 40),
       "a.pcd", "damaged"},
      {pcd_header("binary_compressed") + compressed(literal(kByField.substr(4)), 40), "a.pcd",
       "damaged"},
      {pcd_header("binary_compressed") + "abc", "a.pcd", "cut"},
      {"ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty "
       "float z\n"
       "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 "
       "0 1 2\n",
       "a.ply", "a file with faces is a mesh"},
      {"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nproperty "
       "float z\nend_header\n1 2 3\n1 2\n",
       "a.ply", ""},
      {"ply\nformat ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\nend_header\n1 "
       "2\n1 2\n",
       "a.ply", "x, y and z once"},
      {"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty "
       "float z\nend_header\n1 2 3\n4\n",
       "a.ply", "goes on"},
      {"ply\nformat binary_little_endian 1.0\nelement vertex 1000000000\nproperty float "
       "x\nproperty float y\nproperty float z\nend_header\nabc",
       "a.ply", "more than a file"},
      {"ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty "
       "float z\nend_header\n",
       "a.ply", "no points"},
      {"ply\nformat ascii 1.0\nend_header\n", "a.ply", "no element 'vertex'"},
      {"\x93NUMPY\x01" + std::string(1, '\0'), "a.npy", "no array"}};
  for (const auto& [bytes, name, words] : cases) {
    const std::string said = message(bytes, name);
    EXPECT_NE(said, "no error") << words;
    EXPECT_NE(said.find(words), std::string::npos) << said << "\nwithout: " << words;
  }
}

/// Bytes changed and cut at random: refused, or read; never more points than there is room for.
TEST(PointCloud, DamageNeverHurts) {
  const std::vector<std::pair<std::string, std::string>> files{
      {pcd_header("binary") + kBinary, "a.pcd"},
      {pcd_header("binary_compressed") + compressed(literal(kByField), 40), "a.pcd"},
      {pcd_header("ascii") + "1 2 255 3\n-0.5 4 0 1\n", "a.pcd"},
      {"ply\nformat binary_little_endian 1.0\nelement vertex 2\nproperty float x\nproperty float "
       "y\n"
       "property float z\nend_header\n" +
           packed(false, 1.0F, 2.0F, 3.0F, 4.0F, 5.0F, 6.0F),
       "a.ply"},
      {"1 2 3\n4,5,6\n", "a.xyz"}};
  std::mt19937_64 random(1);
  std::size_t refused = 0;
  for (int round = 0; round < 20'000; ++round) {
    auto [bytes, name] = files[random() % files.size()];
    for (std::uint64_t k = random() % 4; k > 0; --k)
      bytes[random() % bytes.size()] = static_cast<char>(random());
    if (random() % 4 == 0) bytes.resize(random() % bytes.size());
    try {
      EXPECT_LE(read(bytes, name).points.size(), bytes.size());
    } catch (const Error&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 1000U);
}

}  // namespace
}  // namespace kaboum::io
