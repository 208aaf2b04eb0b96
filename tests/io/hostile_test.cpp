// Whatever the bytes, parse_mesh returns a valid mesh or throws Error.

#include <cstdlib>
#include <random>
#include <sstream>

#include "io_test.h"
#include "package.h"
#include "samples.h"

namespace kaboum::io::test {

std::vector<Sample> samples() {
  Mesh mesh = tetrahedron();
  mesh.vertices[3].z() = 0.5;
  const auto written = [&](Format format, bool doubles) {
    const std::vector<char> bytes = serialise_mesh(mesh, format, {doubles, "c"});
    return std::string(bytes.begin(), bytes.end());
  };
  std::string big =
      "ply\nformat binary_big_endian 1.0\nelement vertex 4\nproperty uchar r\nproperty float x\n"
      "property float y\nproperty float z\nelement tristrips 1\n"
      "property list int int vertex_indices\nend_header\n";
  for (int i = 0; i < 4; ++i) {
    big += '\x07';
    for (const int bit : {1, 2, 4}) append(big, (i & bit) != 0 ? 1.0F : 0.0F, true);
  }
  append(big, std::int32_t{6}, true);
  for (const int i : {0, 1, 2, 3, -1, 0}) append(big, std::int32_t{i}, true);
  return {
      {"stl", Format::Stl, written(Format::Stl, false)},
      {"stl-ascii", Format::Stl, written(Format::StlAscii, false)},
      {"ply", Format::Ply, written(Format::Ply, false)},
      {"ply-double", Format::Ply, written(Format::Ply, true)},
      {"ply-ascii", Format::Ply, written(Format::PlyAscii, false)},
      {"ply-big", Format::Ply, big},
      {"obj", Format::Obj,
       "v 0 0 0\nv 4 0 0\nv 4 4 0\nv 1 1 0 \\\n\nv 0 4 0\nv 2 2 5\nf 1/1 2//2 3/3/3 4 5\nf -6 -5 "
       "-1\nf 1 1 2\n"},
      {"off", Format::Off,
       "COFF # c\n5 2 0\n0 0 0 1 1 1\n4 0 0\n4 4 0\n1 1 0\n0 4 1e-3\n5 0 1 2 3 4 1 0 0\n3 0 1 4\n"},
      {"vrml", Format::Vrml,
       "#VRML V2.0 utf8\nDEF A Transform { rotation 0 0 1 0.5 scale 1 2 3 scaleOrientation 1 0 0 1 "
       "center 1 1 1\n"
       "children [ Shape { appearance Appearance { texture NULL } geometry DEF G IndexedFaceSet { "
       "ccw FALSE\n"
       "coord DEF C Coordinate { point [ 0 0 0, 4 0 0, 4 4 0, 1 1 0, 0 4 0 ] } coordIndex [ 0 1 2 "
       "3 4 -1 0 1 4 ] } }\n"
       "Switch { whichChoice 0 choice [ Shape { geometry USE G } ] } ] }\nUSE A WorldInfo { title "
       "\"x\" }\n"},
      {"x3d", Format::X3d,
       "<X3D><Scene><Transform DEF='A' rotation='0 0 1 0.5' scale='1 2 3' center='1 1 1'><Shape>"
       "<Appearance/><IndexedFaceSet DEF='G' ccw='false' coordIndex='0 1 2 3 4 -1 0 1 4'>"
       "<Coordinate DEF='C' point='0 0 0, 4 0 0, 4 4 0, 1 1 0, 0 4 0'/></IndexedFaceSet></Shape>"
       "<Switch whichChoice='0'><Shape><IndexedTriangleStripSet index='0 1 2 3 -1'><Coordinate "
       "USE='C'/></IndexedTriangleStripSet></Shape></Switch></Transform><LOD><Transform USE='A'/>"
       "</LOD><Shape><QuadSet><CoordinateDouble point='0 0 0 1 0 0 1 1 0 0 1 0'/></QuadSet></Shape>"
       "</Scene></X3D>"},
      {"collada", Format::Collada,
       "<COLLADA version='1.4.1'><asset><unit meter='0.5'/></asset><library_geometries><geometry "
       "id='g'><mesh><source id='p'><float_array id='a' count='12'>0 0 0 4 0 0 4 4 0 1 1 1"
       "</float_array><technique_common><accessor source='#a' count='4' stride='3'><param "
       "name='X'/>"
       "<param name='Y'/><param name='Z'/></accessor></technique_common></source><vertices id='v'>"
       "<input semantic='POSITION' source='#p'/></vertices><polylist count='2'><input "
       "semantic='VERTEX' source='#v' offset='0'/><vcount>4 3</vcount><p>0 1 2 3 2 1 0</p>"
       "</polylist><tristrips count='1'><input semantic='VERTEX' source='#v' offset='1'/><p>0 0 0 "
       "1 "
       "0 2 0 3</p></tristrips></mesh></geometry></library_geometries><library_visual_scenes>"
       "<visual_scene id='s'><node id='n'><rotate>0 0 1 30</rotate><matrix>1 0 0 0 0 1 0 0 0 0 1 2 "
       "0 "
       "0 0 1</matrix><instance_geometry url='#g'/></node><node><instance_node url='#n'/></node>"
       "</visual_scene></library_visual_scenes><scene><instance_visual_scene url='#s'/></scene>"
       "</COLLADA>"},
      {"3mf", Format::ThreeMf, three_mf(three_mf_model())},
  };
}

namespace {

void expect_mesh_or_error(std::string_view bytes, Format format) {
  try {
    const ReadResult r = parse(bytes, format);
    EXPECT_FALSE(r.mesh.triangles.empty());
    for (const Triangle& t : r.mesh.triangles)
      for (const std::uint32_t c : t) ASSERT_LT(c, r.mesh.vertices.size());
    for (const Vec3& p : r.mesh.vertices) ASSERT_TRUE(p.allFinite());
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

/// Some bytes changed, cut out, copied or replaced by ones that texts are made of.
std::string mutated(std::string bytes, std::mt19937_64& random) {
  for (std::size_t n = 1 + random() % 4; n > 0 && !bytes.empty(); --n) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 5) {
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
