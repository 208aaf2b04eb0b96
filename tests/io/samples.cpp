#include "samples.h"

#include "io_test.h"
#include "package.h"

namespace kaboum::io::test {
namespace {

/// Quantised and sparse positions, a strip, instances, transforms, a second buffer.
constexpr const char* kGltfJson =
    R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"extensionsUsed":["KHR_mesh_quantization"],
"nodes":[{"children":[1,2],"matrix":[1,0,0,0,0,1,0,0,0,0,1,0,1,2,3,1]},
{"mesh":0,"rotation":[0,0,0.6,0.8],"scale":[1,2,-3]},
{"mesh":1,"extensions":{"EXT_mesh_gpu_instancing":{"attributes":{"TRANSLATION":0}}}}],
"meshes":[{"name":"a","primitives":[{"attributes":{"POSITION":1},"indices":3,"mode":5}]},
{"primitives":[{"attributes":{"POSITION":2}}]}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,2,0.5]},
{"bufferView":1,"componentType":5122,"normalized":true,"count":4,"type":"VEC3"},
{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,
"indices":{"bufferView":2,"componentType":5121},"values":{"bufferView":0,"byteOffset":4}}},
{"bufferView":2,"componentType":5121,"count":4,"type":"SCALAR"}],
"bufferViews":[{"buffer":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":32,"byteStride":8},
{"buffer":1,"byteLength":4}],
"buffers":[{)";
constexpr const char* kSecondBuffer = R"({"uri":"data:;base64,AAECAw==","byteLength":4}]})";

std::string gltf_data() {
  std::string data;
  for (const float x : {0.F, 0.F, 0.F, 1.F, 0.F, 0.5F, 0.F, 2.F, 0.F}) append(data, x);
  for (const int x : {0, 0, 0, 9, 99, 0, 0, 9, 0, 99, 0, 9, -99, 99, 32767, 9})
    append(data, static_cast<std::int16_t>(x));
  return data;
}

std::string binary_gltf() {
  std::string json = kGltfJson + std::string(R"("byteLength":68},)") + kSecondBuffer;
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::string data = gltf_data();
  std::string bytes = "glTF";
  append(bytes, std::uint32_t{2});
  append(bytes, static_cast<std::uint32_t>(28 + json.size() + data.size()));
  append(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append(bytes, static_cast<std::uint32_t>(data.size()));
  return bytes + std::string("BIN\0", 4) + data;
}

std::string text_gltf() {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::string data = gltf_data();
  std::string base64;
  std::uint32_t bits = 0, filled = 0;
  for (const char c : data + std::string(1, '\0')) {  // 69 bytes: no padding
    bits = bits << 8U | static_cast<unsigned char>(c);
    for (filled += 8; filled >= 6; filled -= 6) base64 += kDigits[bits >> (filled - 6) & 63U];
  }
  return kGltfJson + ("\"uri\":\"data:application/octet-stream;base64," + base64) +
         R"(","byteLength":68},)" + kSecondBuffer;
}

}  // namespace

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
      {"glb", Format::Glb, binary_gltf()},
      {"gltf", Format::Gltf, text_gltf()},
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

}  // namespace kaboum::io::test
