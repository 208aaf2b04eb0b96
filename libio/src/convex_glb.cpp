// Convex sets as glTF 2.0 binary: one mesh and one node without transform per body, of triangles, a
// line or a point as its core is; radii and provenance in the root's `extras`. Sets in glTF files
// of other programs: one body per place of a mesh in the scene.

#include <kaboum/base/error.h>

#include <algorithm>
#include <array>
#include <deque>
#include <iterator>
#include <limits>
#include <numeric>

#include "builder.h"
#include "bytes.h"
#include "convex_formats.h"
#include "formats.h"
#include "glb_chunks.h"
#include "gltf.h"
#include "output.h"

namespace kaboum::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kInt = 5125, kFloat = 5126;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kPoints = 0, kLines = 1, kTriangles = 4;

/// The number of a record's version, 0 where there is none.
int version_of(const JsonItem::Json* record) {
  if (record == nullptr || !record->is_object()) return 0;
  const auto at = record->find("version");
  return at != record->end() && at->is_number_integer() ? at->get<int>() : 0;
}

}  // namespace

geom::ConvexSet read_gltf_set(const Source& source, SetReadDetails& details) {
  GltfFile file(source);
  std::vector<std::string> names;
  std::deque<MeshBuilder> builders;
  const JsonItem::Json* const record = gltf_set_record(file);
  const bool cores = version_of(record) == 2;
  const GltfFacts facts = read_gltf_scene(
      file,
      [&](const std::string& name) -> MeshBuilder& {
        names.push_back(name);
        return builders.emplace_back(source);
      },
      cores);
  if (record != nullptr && facts.placed)
    fail(source,
         "a convex set whose nodes have transforms, for which its record (the radii, what is "
         "certified) does not hold; write the set again without transforms");
  geom::ConvexSet set;
  for (std::size_t i = 0; i < builders.size(); ++i) {
    const bool core = cores && !builders[i].has_faces();
    if (!core && !builders[i].has_faces()) continue;  // lines and points, which the notes mention
    std::string name = names[i].empty() ? default_name(set.bodies.size()) : names[i];
    if (core) {
      const std::vector<geom::Vec3>& points = builders[i].points();
      if (points.empty() || points.size() > 2)
        fail(source, "body '" + name + "' has " + std::to_string(points.size()) +
                         " points and no triangles; the core of a body is a polytope, a segment "
                         "or a point");
      set.bodies.push_back({std::move(name), {points, {}}});
      continue;
    }
    ReadResult result = builders[i].finish(Format::Glb, facts.floats);
    for (const std::string& note : result.notes)
      details.notes.push_back(std::string(name).append(": ").append(note));
    set.bodies.push_back({std::move(name), std::move(result.mesh)});
  }
  details.single_precision = facts.floats;
  details.unit = gltf_unit(file);
  if (record != nullptr) {
    take_record(Json(*record), source, set);
    details.has_record = true;
  } else if (set.bodies.empty()) {
    fail(source, "the scene holds no mesh");
  }
  note_gltf_facts(facts, file);
  std::ranges::move(file.take_notes(), std::back_inserter(details.notes));
  return set;
}

namespace {

/// Colours that tell neighbouring bodies apart in a viewer; linear red, green and blue.
constexpr std::array<std::array<double, 3>, 10> kColours{{{0.08, 0.23, 0.50},
                                                          {0.80, 0.25, 0.02},
                                                          {0.06, 0.40, 0.10},
                                                          {0.60, 0.06, 0.07},
                                                          {0.32, 0.17, 0.55},
                                                          {0.27, 0.12, 0.09},
                                                          {0.76, 0.22, 0.53},
                                                          {0.25, 0.25, 0.25},
                                                          {0.50, 0.51, 0.05},
                                                          {0.03, 0.52, 0.62}}};

Json material(std::size_t index) {
  const auto& [red, green, blue] = kColours[index];
  return {{"name", "colour " + std::to_string(index)},
          {"pbrMetallicRoughness",
           {{"baseColorFactor", {red, green, blue, 1}},
            {"metallicFactor", 0},
            {"roughnessFactor", 0.7}}}};
}

}  // namespace

std::vector<char> write_glb_set(const geom::ConvexSet& set) {
  Json meshes = Json::array(), nodes = Json::array(), roots = Json::array();
  Json accessors = Json::array(), views = Json::array();
  std::size_t offset = 0;
  for (const geom::ConvexBody& body : set.bodies) {
    const geom::Mesh& core = body.core;
    std::vector<std::uint32_t> original(core.vertices.size());
    std::iota(original.begin(), original.end(), 0U);
    require_float(core, original, "GLB");
    geom::Box3 box;
    for (const geom::Vec3& p : core.vertices) box.extend(p);
    const std::size_t point_bytes = 12 * core.vertices.size();
    const std::size_t index_bytes = 12 * core.triangles.size();
    const std::size_t index = meshes.size(), first = accessors.size();
    views.push_back({{"buffer", 0},
                     {"byteOffset", offset},
                     {"byteLength", point_bytes},
                     {"target", kArrayBuffer}});
    if (index_bytes > 0)
      views.push_back({{"buffer", 0},
                       {"byteOffset", offset + point_bytes},
                       {"byteLength", index_bytes},
                       {"target", kElementArrayBuffer}});
    offset += point_bytes + index_bytes;
    accessors.push_back({{"bufferView", first},
                         {"componentType", kFloat},
                         {"count", core.vertices.size()},
                         {"type", "VEC3"},
                         {"min", {box.min.x(), box.min.y(), box.min.z()}},
                         {"max", {box.max.x(), box.max.y(), box.max.z()}}});
    if (index_bytes > 0)
      accessors.push_back({{"bufferView", first + 1},
                           {"componentType", kInt},
                           {"count", 3 * core.triangles.size()},
                           {"type", "SCALAR"}});
    Json primitive = {{"attributes", {{"POSITION", first}}}};
    if (index_bytes > 0) primitive["indices"] = first + 1;
    primitive["material"] = index % kColours.size();
    primitive["mode"] = index_bytes > 0 ? kTriangles : core.vertices.size() == 2 ? kLines : kPoints;
    meshes.push_back({{"name", body.name}, {"primitives", Json::array({primitive})}});
    nodes.push_back({{"name", body.name}, {"mesh", index}});
    roots.push_back(index);
  }
  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", kGltfGenerator}};
  json["scene"] = 0;
  json["scenes"] = Json::array({Json::object()});
  if (!set.bodies.empty()) {  // glTF knows no empty arrays
    json["scenes"][0]["nodes"] = roots;
    json["nodes"] = nodes;
    json["meshes"] = meshes;
    for (std::size_t i = 0; i < std::min(set.bodies.size(), kColours.size()); ++i)
      json["materials"].push_back(material(i));
    json["accessors"] = accessors;
    json["bufferViews"] = views;
    json["buffers"] = Json::array({{{"byteLength", offset}}});
  }
  json["extras"] = {{kGltfSetRecord, record_of(set)}};
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + text.size() + (offset > 0 ? 8 + offset : 0);
  if (total > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::OutputFailed, "GLB files end at 4 GiB, this set needs more; write obj");
  Output out;
  out.reserve(total);
  for (const std::uint32_t word : {kGlbMagic, 2U, static_cast<std::uint32_t>(total),
                                   static_cast<std::uint32_t>(text.size()), kJsonChunk})
    out.little(word);
  out.text(text);
  if (offset > 0) {
    out.little(static_cast<std::uint32_t>(offset));
    out.little(kBinaryChunk);
  }
  for (const geom::ConvexBody& body : set.bodies) {
    for (const geom::Vec3& p : body.core.vertices)
      for (const double x : p) out.little(static_cast<float>(x));
    for (const geom::Triangle& t : body.core.triangles)
      for (const std::uint32_t corner : t) out.little(corner);
  }
  return out.take();
}

}  // namespace kaboum::io
