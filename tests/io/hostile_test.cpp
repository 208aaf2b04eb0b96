// Whatever the bytes, parse_mesh returns a valid mesh or throws Error.

#include <kaboum/io/convex_io.h>

#include <cstdlib>
#include <random>
#include <sstream>

#include "io_test.h"
#include "package.h"
#include "samples.h"

namespace kaboum::io::test {

namespace {

void expect_mesh_or_error(std::string_view bytes, Format format) {
  try {
    const ReadResult r = parse(bytes, format);
    EXPECT_FALSE(r.mesh.triangles.empty());
    for (const Triangle& t : r.mesh.triangles)
      for (const std::uint32_t c : t) ASSERT_LT(c, r.mesh.vertices.size());
    for (const Vec3& p : r.mesh.vertices) ASSERT_TRUE(p.allFinite());
    // Sets have a reader of their own, which may refuse more.
    if (format == Format::Glb || format == Format::Gltf) {
      for (const geom::ConvexBody& body : parse_convex_set(bytes, format, "sample").bodies)
        ASSERT_FALSE(body.core.empty());
    }
  } catch (const Error& e) {
    EXPECT_NE(e.code(), ErrorCode::Internal);
    EXPECT_TRUE(std::string_view(e.what()).starts_with("sample: ")) << e.what();
  }
}

TEST(Hostile, SamplesAreValid) {
  for (const Sample& s : samples()) EXPECT_NO_THROW(parse(s.bytes, s.format)) << s.name;
}

TEST(Hostile, TruncatedAtEveryByte) {
  for (const Sample& s : samples()) {
    for (std::size_t n = 0; n < s.bytes.size(); ++n) {
      // A copy of that very size, so that sanitizers see every overrun.
      const std::vector<char> cut(s.bytes.begin(),
                                  s.bytes.begin() + static_cast<std::ptrdiff_t>(n));
      expect_mesh_or_error({cut.data(), cut.size()}, s.format);
    }
  }
}

TEST(Hostile, BinaryFilesNeverParseTruncated) {
  for (const Sample& s : samples()) {
    if (s.name != "stl" && s.name != "ply" && s.name != "ply-big") continue;
    for (std::size_t n = 0; n < s.bytes.size(); ++n)
      EXPECT_THROW(parse(s.bytes.substr(0, n), s.format), Error) << s.name << " " << n;
  }
}

/// Some bytes changed, cut out, copied or replaced by ones that texts are made of; numbers
/// replaced.
std::string mutated(std::string bytes, std::mt19937_64& random) {
  constexpr std::array kNumbers = {"-1",  "0",     "4294967295", "9223372036854775807",
                                   "0.5", "1e400", "1e-400",     "99999",
                                   "nan", "2",     "1000000000", "7"};
  for (std::size_t n = 1 + random() % 4; n > 0 && !bytes.empty(); --n) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 6) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << (random() % 8)));
        break;
      case 1:
        bytes[at] = static_cast<char>(random());
        break;
      case 2:
        bytes.erase(at, 1 + random() % 8);
        break;
      case 3:
        bytes.insert(at, bytes.substr(random() % bytes.size(), random() % 16));
        break;
      case 4: {  // the next number
        const std::size_t first = bytes.find_first_of("0123456789", at);
        if (first == std::string::npos) break;
        const std::size_t end = bytes.find_first_not_of("0123456789", first);
        bytes.replace(first, std::min(end, bytes.size()) - first,
                      kNumbers[random() % kNumbers.size()]);
        break;
      }
      default:
        bytes[at] = "0123456789-.e{}[]#\\\n \""[random() % 22];
    }
  }
  return bytes;
}

/// How many mutations of each sample; more by the environment variable KABOUM_MUTATIONS.
int mutations() {
  const char* const asked = std::getenv("KABOUM_MUTATIONS");
  return asked != nullptr ? std::atoi(asked) : 2000;
}

TEST(Hostile, MutatedModelsInSoundPackages) {
  std::mt19937_64 random(4);
  for (int round = 0; round < mutations() / 4; ++round)
    expect_mesh_or_error(three_mf(mutated(three_mf_model(), random)), Format::ThreeMf);
}

TEST(Hostile, RandomMutations) {
  std::mt19937_64 random(1);
  for (const Sample& s : samples()) {
    for (int round = 0; round < mutations(); ++round) {
      const std::string bytes = mutated(s.bytes, random);
      const std::vector<char> exact(bytes.begin(), bytes.end());
      expect_mesh_or_error({exact.data(), exact.size()}, s.format);
    }
  }
}

TEST(Hostile, Garbage) {
  std::mt19937_64 random(2);
  for (const Sample& s : samples()) {
    for (const std::size_t size : {1, 4, 84, 85, 134, 1000, 100000}) {
      std::string bytes(size, '\0');
      expect_mesh_or_error(bytes, s.format);
      for (char& c : bytes) c = static_cast<char>(random());
      expect_mesh_or_error(bytes, s.format);
      expect_mesh_or_error(s.bytes.substr(0, s.bytes.size() / 2) + bytes, s.format);
    }
  }
}

TEST(Hostile, LongLines) {
  const std::string spaces(3'000'000, ' '), digits(3'000'000, '1'), letters(3'000'000, 'a');
  for (const Sample& s : samples())
    for (const std::string& line : {spaces, digits, letters})
      for (const char* start : {"", "solid ", "v ", "f ", "OFF\n", "ply\n", "#VRML V2.0 utf8\n"})
        expect_mesh_or_error(std::string(start).append(line), s.format);
}

TEST(Hostile, HugePolygonsEnd) {
  // A zigzag in which nearly every corner is reflex, shuffled so that it is not simple.
  std::mt19937_64 random(3);
  std::ostringstream text;
  for (int i = 0; i < 200'000; ++i)
    text << "v " << random() % 1000 << ' ' << random() % 1000 << " 0\n";
  text << 'f';
  for (int i = 1; i <= 200'000; ++i) text << ' ' << i;
  expect_mesh_or_error(text.str(), Format::Obj);
}

}  // namespace
}  // namespace kaboum::io::test
