// Convex sets as glTF 2.0 binary: one mesh and one node without transform per body; margin and
// provenance in the root's `extras`.

#include <kaboum/geom/error.h>

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "builder.h"
#include "bytes.h"
#include "convex_formats.h"
#include "formats.h"
#include "output.h"

namespace kaboum::io {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRecord = "kaboum_convex_set";
constexpr std::uint32_t kMagic = 0x46546C67;      // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;  // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr int kByte = 5121, kShort = 5123, kInt = 5125, kFloat = 5126;
constexpr int kArrayBuffer = 34962, kElementArrayBuffer = 34963;
constexpr int kTriangles = 4;

/// Something in the file that this reader leaves to others.
struct NotOurs {
  std::string why;
};

class Reader {
 public:
  Reader(const Source& source, SetReadDetails& details) : source_(source), details_(details) {}

  geom::ConvexSet read() {
    split_chunks();
    try {
      return read_scene();
    } catch (const Json::exception& e) {
      fail(source_, std::string("the JSON part is not that of a glTF file: ") + e.what());
    }
  }

 private:
  /// Bytes of an accessor in the binary chunk: element i at data + i · stride.
  struct View {
    const char* data;
    std::size_t count, stride;
    int type;
  };

  void split_chunks() {
    const std::string_view all = source_.bytes;
    if (all.size() < 20 || load_little<std::uint32_t>(all.data()) != kMagic)
      fail(source_, "not a GLB file: it does not begin with 'glTF' and a header");
    const auto word = [&](std::size_t at) { return load_little<std::uint32_t>(all.data() + at); };
    if (word(4) != 2)
      fail(source_, "glTF version " + std::to_string(word(4)) + "; only version 2 can be read");
    if (word(8) > all.size())
      fail(source_, all.data() + 8,
           "the header states " + std::to_string(word(8)) + " bytes, but the file has " +
               std::to_string(all.size()) + "; it is truncated, get it again");
    const std::size_t size = word(8);
    for (std::size_t at = 12; at + 8 <= size;) {
      const std::size_t length = word(at);
      if (length > size - at - 8)
        fail(source_, all.data() + at, "a chunk is longer than the file; the file is damaged");
      const std::string_view chunk = all.substr(at + 8, length);
      if (word(at + 4) == kJsonChunk && json_text_.empty()) json_text_ = chunk;
      if (word(at + 4) == kBinaryChunk && binary_.empty()) binary_ = chunk;
      at += 8 + (length + 3) / 4 * 4;
    }
    json_ = Json::parse(json_text_.begin(), json_text_.end(), nullptr, false);
    if (json_.is_discarded() || !json_.is_object())
      fail(source_, all.data() + 12, "the JSON part is damaged; get the file again");
  }

  geom::ConvexSet read_scene() {
    const Json* record = nullptr;
    if (json_.contains("extras") && json_["extras"].is_object() &&
        json_["extras"].contains(kRecord))
      record = &json_["extras"][kRecord];
    if (json_.contains("extensionsRequired") && !json_["extensionsRequired"].empty())
      throw NotOurs{"it needs glTF extensions"};
    geom::ConvexSet set;
    if (json_.contains("scenes")) {
      const std::size_t scene = json_.value("scene", std::size_t{0});
      const Json& root = json_.at("scenes").at(scene);
      if (root.contains("nodes"))
        for (const Json& node : root.at("nodes")) add_node(node.get<std::size_t>(), 0, set);
    } else if (json_.contains("meshes")) {
      for (const Json& mesh : json_.at("meshes")) add_mesh(mesh, {}, set);
    }
    details_.single_precision = true;
    if (record != nullptr) {
      take_record(*record, source_, set);
      details_.has_record = true;
    } else if (set.bodies.empty()) {
      fail(source_, "the scene holds no mesh");
    }
    return set;
  }

  void add_node(std::size_t index, int depth, geom::ConvexSet& set) {
    // A node of a valid scene appears once.
    const Json& node = json_.at("nodes").at(index);
    if (depth > 100 || ++visited_ > json_.at("nodes").size())
      fail(source_, "the scene's nodes form a cycle or a deep chain; the file is damaged");
    for (const char* key : {"matrix", "rotation", "scale", "translation"})
      if (node.contains(key)) throw NotOurs{"its nodes have transforms"};
    if (node.contains("mesh"))
      add_mesh(json_.at("meshes").at(node.at("mesh").get<std::size_t>()), node.value("name", ""),
               set);
    if (node.contains("children"))
      for (const Json& child : node.at("children"))
        add_node(child.get<std::size_t>(), depth + 1, set);
  }

  void add_mesh(const Json& mesh, std::string name, geom::ConvexSet& set) {
    if (mesh.contains("name")) name = mesh.at("name").get<std::string>();
    if (name.empty()) name = default_name(set.bodies.size());
    MeshBuilder builder(source_);
    std::size_t triangles = 0;
    for (const Json& primitive : mesh.at("primitives")) {
      if (primitive.value("mode", kTriangles) != kTriangles)
        throw NotOurs{"it holds lines, points or strips"};
      if (primitive.contains("targets")) throw NotOurs{"it holds morph targets"};
      triangles += add_primitive(primitive, builder);
    }
    if (triangles == 0) fail(source_, "mesh " + in_quotes(name) + " has no triangles");
    ReadResult result = builder.finish(Format::Glb, true);
    for (const std::string& note : result.notes) {
      details_.notes.push_back(name);
      details_.notes.back().append(": ").append(note);
    }
    set.bodies.push_back({std::move(name), std::move(result.mesh)});
  }

  std::size_t add_primitive(const Json& primitive, MeshBuilder& builder) {
    const View points = view_of(primitive.at("attributes").at("POSITION"), "VEC3", 12);
    if (points.type != kFloat) throw NotOurs{"its positions are not float"};
    const auto first = static_cast<std::int64_t>(builder.point_count());
    for (std::size_t i = 0; i < points.count; ++i) {
      const char* const at = points.data + i * points.stride;
      builder.add_point(
          {load_little<float>(at), load_little<float>(at + 4), load_little<float>(at + 8)}, at);
    }
    std::size_t count = points.count;
    std::optional<View> indices;
    if (primitive.contains("indices")) {
      indices = view_of(primitive.at("indices"), "SCALAR", 0);
      count = indices->count;
    }
    if (count % 3 != 0)
      fail(source_, "a mesh has " + std::to_string(count) +
                        " triangle corners, which is no multiple of three; the file is damaged");
    for (std::size_t i = 0; i < count; i += 3) {
      geom::Triangle t;
      for (std::size_t k = 0; k < 3; ++k) {
        const char* const at =
            indices ? indices->data + (i + k) * indices->stride : source_.begin();
        const std::int64_t index =
            indices ? index_at(at, indices->type) : static_cast<std::int64_t>(i + k);
        builder.corner(index, 0, at);
        if (index >= static_cast<std::int64_t>(points.count))
          fail(source_, at, "an index is out of range; the file is damaged");
        t[k] = static_cast<std::uint32_t>(first + index);
      }
      builder.add_triangle(t);
    }
    return count / 3;
  }

  static std::int64_t index_at(const char* at, int type) {
    if (type == kByte) return load_little<std::uint8_t>(at);
    if (type == kShort) return load_little<std::uint16_t>(at);
    return load_little<std::uint32_t>(at);
  }

  /// @param size  of an element in bytes; 0: an index of the accessor's component type.
  View view_of(const Json& number, const char* shape, std::size_t size) {
    const Json& accessor = json_.at("accessors").at(number.get<std::size_t>());
    if (accessor.contains("sparse") || !accessor.contains("bufferView"))
      throw NotOurs{"it has sparse accessors"};
    View view{};
    view.type = accessor.at("componentType").get<int>();
    if (accessor.at("type") != shape)
      fail(source_, "an accessor is not of type " + std::string(shape));
    if (size == 0) {
      if (view.type != kByte && view.type != kShort && view.type != kInt)
        fail(source_, "the indices are not unsigned integers; the file is damaged");
      size = view.type == kByte ? 1 : view.type == kShort ? 2 : 4;
    }
    view.count = accessor.at("count").get<std::size_t>();
    const Json& buffer_view =
        json_.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
    const Json& buffer = json_.at("buffers").at(buffer_view.at("buffer").get<std::size_t>());
    if (buffer.contains("uri")) throw NotOurs{"its data is in other files"};
    const std::size_t offset = buffer_view.value("byteOffset", std::size_t{0});
    const std::size_t length = buffer_view.at("byteLength").get<std::size_t>();
    const std::size_t start = accessor.value("byteOffset", std::size_t{0});
    view.stride = buffer_view.value("byteStride", size);
    const bool inside =
        offset <= binary_.size() && length <= binary_.size() - offset && start <= length &&
        view.stride >= size && view.stride <= 252 && view.count <= binary_.size() &&
        (view.count == 0 || (view.count - 1) * view.stride + size <= length - start);
    if (!inside) fail(source_, "an accessor reaches beyond the binary part; the file is damaged");
    // Meshes may share data; a hostile file would multiply it.
    work_ += view.count * size;
    if (work_ > 64 * source_.bytes.size())
      throw Error(ErrorCode::LimitReached,
                  std::string(source_.name) +
                      ": its meshes use the same data over and over; write each body once");
    view.data = binary_.data() + offset + start;
    return view;
  }

  const Source& source_;
  SetReadDetails& details_;
  std::string_view json_text_, binary_;
  Json json_;
  std::size_t visited_ = 0, work_ = 0;
};

}  // namespace

std::optional<geom::ConvexSet> read_glb_set(const Source& source, SetReadDetails& details,
                                            std::string& why) {
  Source binary = source;
  binary.text = false;
  try {
    return Reader(binary, details).read();
  } catch (const NotOurs& not_ours) {
    why = not_ours.why;
    return std::nullopt;
  }
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
    const geom::Mesh& hull = body.hull;
    std::vector<std::uint32_t> original(hull.vertices.size());
    std::iota(original.begin(), original.end(), 0U);
    require_float(hull, original, "GLB");
    geom::Box3 box;
    for (const geom::Vec3& p : hull.vertices) box.extend(p);
    const std::size_t point_bytes = 12 * hull.vertices.size();
    const std::size_t index_bytes = 12 * hull.triangles.size();
    const std::size_t index = meshes.size();
    views.push_back({{"buffer", 0},
                     {"byteOffset", offset},
                     {"byteLength", point_bytes},
                     {"target", kArrayBuffer}});
    views.push_back({{"buffer", 0},
                     {"byteOffset", offset + point_bytes},
                     {"byteLength", index_bytes},
                     {"target", kElementArrayBuffer}});
    offset += point_bytes + index_bytes;
    accessors.push_back({{"bufferView", 2 * index},
                         {"componentType", kFloat},
                         {"count", hull.vertices.size()},
                         {"type", "VEC3"},
                         {"min", {box.min.x(), box.min.y(), box.min.z()}},
                         {"max", {box.max.x(), box.max.y(), box.max.z()}}});
    accessors.push_back({{"bufferView", 2 * index + 1},
                         {"componentType", kInt},
                         {"count", 3 * hull.triangles.size()},
                         {"type", "SCALAR"}});
    const Json primitive = {{"attributes", {{"POSITION", 2 * index}}},
                            {"indices", 2 * index + 1},
                            {"material", index % kColours.size()},
                            {"mode", kTriangles}};
    meshes.push_back({{"name", body.name}, {"primitives", Json::array({primitive})}});
    nodes.push_back({{"name", body.name}, {"mesh", index}});
    roots.push_back(index);
  }
  Json json;
  json["asset"] = {{"version", "2.0"}, {"generator", "KABouM"}};
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
  json["extras"] = {{kRecord, record_of(set)}};
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::size_t total = 12 + 8 + text.size() + (offset > 0 ? 8 + offset : 0);
  if (total > std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::OutputFailed, "GLB files end at 4 GiB, this set needs more; write obj");
  Output out;
  out.reserve(total);
  for (const std::uint32_t word : {kMagic, 2U, static_cast<std::uint32_t>(total),
                                   static_cast<std::uint32_t>(text.size()), kJsonChunk})
    out.little(word);
  out.text(text);
  if (offset > 0) {
    out.little(static_cast<std::uint32_t>(offset));
    out.little(kBinaryChunk);
  }
  for (const geom::ConvexBody& body : set.bodies) {
    for (const geom::Vec3& p : body.hull.vertices)
      for (const double x : p) out.little(static_cast<float>(x));
    for (const geom::Triangle& t : body.hull.triangles)
      for (const std::uint32_t corner : t) out.little(corner);
  }
  return out.take();
}

}  // namespace kaboum::io
