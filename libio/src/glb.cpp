// Writing glTF 2.0 binary: one mesh, one node without transform.

#include <kaboum/base/error.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "bytes.h"
#include "formats.h"
#include "glb_chunks.h"
#include "output.h"

namespace kaboum::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kFloat = 5126, kUnsignedInt = 5125;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kTriangles = 4;

Json accessor(int view, int type, std::size_t count, const char* shape) {
  return {{"bufferView", view}, {"componentType", type}, {"count", count}, {"type", shape}};
}

Json describe(const geom::Mesh& mesh, const WriteOptions& options) {
  const std::size_t point_bytes = 12 * mesh.vertices.size();
  const std::size_t index_bytes = 12 * mesh.triangles.size();
  geom::Box3 box;
  for (const geom::Vec3& p : mesh.vertices) box.extend(p);
  Json positions = accessor(0, kFloat, mesh.vertices.size(), "VEC3");
  positions["min"] = {box.min.x(), box.min.y(), box.min.z()};
  positions["max"] = {box.max.x(), box.max.y(), box.max.z()};

  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "KABouM"}};
  if (!options.comment.empty()) json["asset"]["extras"] = {{"comment", one_line(options.comment)}};
  json["scene"] = 0;
  json["scenes"] = {{{"nodes", {0}}}};
  json["nodes"] = {{{"mesh", 0}}};
  const Json primitive = {{"attributes", {{"POSITION", 0}}}, {"indices", 1}, {"mode", kTriangles}};
  json["meshes"] = Json::array({{{"primitives", Json::array({primitive})}}});
  json["accessors"] =
      Json::array({positions, accessor(1, kUnsignedInt, 3 * mesh.triangles.size(), "SCALAR")});
  json["bufferViews"] = Json::array(
      {{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", point_bytes}, {"target", kArrayBuffer}},
       {{"buffer", 0},
        {"byteOffset", point_bytes},
        {"byteLength", index_bytes},
        {"target", kElementArrayBuffer}}});
  json["buffers"] = Json::array({{{"byteLength", point_bytes + index_bytes}}});
  return json;
}

}  // namespace

std::vector<char> write_glb(const geom::Mesh& mesh, const WriteOptions& options) {
  // Comments in another encoding than UTF-8 are replaced, not refused.
  std::string json = describe(mesh, options).dump(-1, ' ', false, Json::error_handler_t::replace);
  json.resize((json.size() + 3) / 4 * 4, ' ');
  const std::size_t binary = 12 * (mesh.vertices.size() + mesh.triangles.size());
  const std::size_t total = 12 + 8 + json.size() + 8 + binary;
  if (total > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::OutputFailed,
                "GLB files end at 4 GiB, this mesh needs more; write ply instead");
  Output out;
  out.reserve(total);
  for (const std::uint32_t word : {kGlbMagic, 2U, static_cast<std::uint32_t>(total),
                                   static_cast<std::uint32_t>(json.size()), kJsonChunk})
    out.little(word);
  out.text(json);
  out.little(static_cast<std::uint32_t>(binary));
  out.little(kBinaryChunk);
  for (const geom::Vec3& p : mesh.vertices)
    for (const double x : p) out.little(static_cast<float>(x));
  for (const geom::Triangle& t : mesh.triangles)
    for (const std::uint32_t corner : t) out.little(corner);
  return out.take();
}

}  // namespace kaboum::io
