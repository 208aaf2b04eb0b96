// The scene of a glTF 2.0 file: nodes, instances, meshes and their primitives.

#include "gltf.h"

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "formats.h"
#include "gltf_accessor.h"
#include "placement.h"

namespace kaboum::io {
namespace {

constexpr int kMaxNodeDepth = 256;
constexpr const char* kQuantization = "KHR_mesh_quantization";
constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";
constexpr const char* kDraco = "KHR_draco_mesh_compression";

enum Mode : std::uint8_t { Points, Lines, LineLoop, LineStrip, Triangles, Strip, Fan };

/// Rotation by a quaternion x, y, z, w. Those in files are rounded, some to bytes; their direction
/// counts.
Eigen::Matrix3d rotation(const JsonItem& item, const double* q) {
  const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
  if (!(length > 0.9 && length < 1.1))
    item.fail("a rotation that is no unit quaternion; the file is damaged, export it again");
  if (q[0] == 0 && q[1] == 0 && q[2] == 0) return Eigen::Matrix3d::Identity();
  return Eigen::Quaterniond(q[3], q[0], q[1], q[2]).normalized().toRotationMatrix();
}

class GltfReader {
 public:
  GltfReader(GltfFile& file, const std::function<MeshBuilder&(const std::string&)>& builder_for,
             bool cores)
      : file_(file), builder_for_(builder_for), cores_(cores) {}

  GltfFacts read() {
    visited_.resize(file_.count("nodes"));
    used_.resize(file_.count("meshes"));
    const std::size_t scenes = file_.count("scenes");
    if (scenes > 0) {
      read_scene(scenes);
    } else if (!visited_.empty()) {
      io::fail(file_.source(), "the file has nodes, but no scene; export it with a scene");
    } else {
      for (std::size_t i = 0; i < used_.size(); ++i)
        read_mesh(file_.root().at("meshes").at(i), i, {}, {});
    }
    add_notes();
    return facts_;
  }

 private:
  void read_scene(std::size_t scenes) {
    const JsonItem root = file_.root();
    if (scenes > 1 && !root.has("scene"))
      io::fail(file_.source(), "the file has " + std::to_string(scenes) +
                                   " scenes and names none as the default; export the one that is "
                                   "meant");
    const JsonItem scene = root.has("scene") ? file_.element("scenes", root.at("scene"))
                                             : root.at("scenes").at(std::size_t{0});
    file_.check_extensions(scene);
    if (scenes > 1)
      file_.note("The file has " + std::to_string(scenes) + " scenes; the default one was read.");
    if (!scene.has("nodes")) return;
    const JsonItem nodes = scene.at("nodes");
    for (std::size_t i = 0; i < nodes.size(); ++i) read_node(nodes.at(i), {}, 0);
  }

  void read_node(const JsonItem& index, const Placement& parent, int depth) {
    const JsonItem node = file_.element("nodes", index);
    if (depth > kMaxNodeDepth)
      node.fail("nodes are nested more than " + std::to_string(kMaxNodeDepth) +
                " deep; flatten the scene");
    if (visited_[index.integer()])
      index.fail("a node that appears twice in the scene; the file is damaged");
    visited_[index.integer()] = true;
    file_.check_extensions(node, {kInstancing, "KHR_node_visibility"});
    check_visible(node);
    const Placement placement = parent * local_placement(node);
    if (node.has("mesh")) read_mesh_node(node, placement);
    if (!node.has("children")) return;
    const JsonItem children = node.at("children");
    for (std::size_t i = 0; i < children.size(); ++i)
      read_node(children.at(i), placement, depth + 1);
  }

  static void check_visible(const JsonItem& node) {
    constexpr const char* kVisibility = "KHR_node_visibility";
    if (!node.has("extensions") || !node.at("extensions").has(kVisibility)) return;
    const JsonItem visibility = node.at("extensions").at(kVisibility);
    if (visibility.has("visible") && !visibility.at("visible").truth())
      node.fail("an invisible node (KHR_node_visibility); show or remove it");
  }

  static Placement local_placement(const JsonItem& node) {
    const bool has_trs = node.has("translation") || node.has("rotation") || node.has("scale");
    Placement placement;
    if (node.has("matrix")) {
      if (has_trs) node.fail("a matrix beside translation, rotation or scale; the file is damaged");
      const JsonItem matrix = node.at("matrix");
      const std::vector<double> m = matrix.numbers(16);  // column by column
      if (m[3] != 0 || m[7] != 0 || m[11] != 0 || m[15] != 1)
        matrix.fail("its last row is not 0 0 0 1; apply the transform before export");
      for (std::size_t column = 0; column < 3; ++column)
        for (std::size_t row = 0; row < 3; ++row)
          placement.linear(static_cast<int>(row), static_cast<int>(column)) = m[4 * column + row];
      placement.translation = {m[12], m[13], m[14]};
      return placement;
    }
    if (node.has("rotation"))
      placement.linear = rotation(node.at("rotation"), node.at("rotation").numbers(4).data());
    if (node.has("scale")) {
      const std::vector<double> s = node.at("scale").numbers(3);
      placement.linear = placement.linear * geom::Vec3(s[0], s[1], s[2]).asDiagonal();
    }
    if (node.has("translation")) {
      const std::vector<double> t = node.at("translation").numbers(3);
      placement.translation = {t[0], t[1], t[2]};
    }
    return placement;
  }

  void read_mesh_node(const JsonItem& node, const Placement& placement) {
    const JsonItem index = node.at("mesh");
    const JsonItem mesh = file_.element("meshes", index);
    if (node.has("skin")) node.fail("a mesh bent by a skin; apply the armature before export");
    check_morphing(node);
    const std::string name = node.has("name") ? node.at("name").text() : "";
    const auto number = static_cast<std::size_t>(index.integer());
    if (node.has("extensions") && node.at("extensions").has(kInstancing)) {
      for (const Placement& instance : instances(node.at("extensions").at(kInstancing)))
        read_mesh(mesh, number, name, placement * instance);
    } else {
      read_mesh(mesh, number, name, placement);
    }
  }

  /// EXT_mesh_gpu_instancing: a translation, rotation and scale per instance.
  std::vector<Placement> instances(const JsonItem& extension) {
    const JsonItem attributes = extension.at("attributes");
    std::vector<Placement> result;
    const auto read = [&](const char* name, const char* shape, const auto& integers,
                          const auto& apply) {
      if (!attributes.has(name)) return;
      const JsonItem index = attributes.at(name);
      const AccessorValues v = read_vectors(file_, index, shape, integers);
      if (result.empty()) result.resize(v.count);
      if (v.count != result.size())
        index.fail("the attributes of the instances differ in length; the file is damaged");
      for (std::size_t i = 0; i < v.count; ++i)
        apply(result[i], v.values.data() + i * (v.values.size() / v.count));
    };
    for (const std::string& name : attributes.keys())
      if (name != "TRANSLATION" && name != "ROTATION" && name != "SCALE" && !name.starts_with('_'))
        attributes.fail("an unknown attribute " + in_quotes(name) +
                        " of instances; make the instances real before export");
    constexpr std::array<Component, 0> kNone = {};
    constexpr std::array kShort = {Component::Int8, Component::Int16};
    read("ROTATION", "VEC4", kShort,
         [&](Placement& p, const double* q) { p.linear = rotation(attributes, q); });
    read("SCALE", "VEC3", kNone, [](Placement& p, const double* s) {
      p.linear = p.linear * geom::Vec3(s[0], s[1], s[2]).asDiagonal();
    });
    read("TRANSLATION", "VEC3", kNone, [](Placement& p, const double* t) {
      p.translation = {t[0], t[1], t[2]};
    });
    if (result.empty())
      attributes.fail(
          "instances without translation, rotation and scale; make them real before "
          "export");
    return result;
  }

  void check_morphing(const JsonItem& item) {
    if (!item.has("weights")) return;
    const JsonItem weights = item.at("weights");
    for (std::size_t i = 0; i < weights.size(); ++i)
      if (weights.at(i).number() != 0)
        weights.fail("a mesh in a morphed shape; apply the shape keys before export");
  }

  void read_mesh(const JsonItem& mesh, std::size_t number, const std::string& node_name,
                 const Placement& placement) {
    file_.check_extensions(mesh);
    file_.spend(1);
    check_morphing(mesh);
    used_[number] = true;
    std::string name = mesh.has("name") ? mesh.at("name").text() : "";
    if (name.empty()) name = node_name;
    MeshBuilder& builder = builder_for_(name);
    const JsonItem primitives = mesh.at("primitives");
    for (std::size_t i = 0; i < primitives.size(); ++i)
      read_primitive(primitives.at(i), placement, builder);
    ++facts_.meshes;
    facts_.placed |= !placement.is_identity();
    facts_.mirrored |= placement.mirrors();
  }

  void read_primitive(const JsonItem& primitive, const Placement& placement, MeshBuilder& builder) {
    const std::uint64_t mode = primitive.integer_or("mode", Triangles);
    if (mode > Fan)
      primitive.fail("mode " + std::to_string(mode) +
                     " is not one of glTF 2.0; export the mesh as triangles");
    file_.check_extensions(primitive, {kDraco});  // which repeats the accessors, if they have data
    const bool core = cores_ && (mode == Points || mode == Lines);
    if (mode < Triangles && !core) {
      ++lines_;
      return;
    }
    const JsonItem attributes = primitive.at("attributes");
    if (!attributes.has("POSITION")) primitive.fail("it has no positions; export the mesh again");
    morphs_ |= primitive.has("targets") && primitive.at("targets").size() > 0;
    constexpr std::array kIntegers = {Component::Int8, Component::UInt8, Component::Int16,
                                      Component::UInt16};
    const JsonItem position = attributes.at("POSITION");
    const AccessorValues points =
        read_vectors(file_, position, "VEC3",
                     file_.uses(kQuantization) ? std::span<const Component>(kIntegers)
                                               : std::span<const Component>());
    facts_.floats &= points.floats;
    const std::size_t first = builder.point_count();
    for (std::size_t i = 0; i < points.count; ++i) {
      const double* const at = points.values.data() + 3 * i;
      const geom::Vec3 p = placement * geom::Vec3(at[0], at[1], at[2]);
      if (!p.allFinite())
        position.fail("vertex " + std::to_string(i) +
                      " is moved out of the range of numbers; check the scene's transforms");
      builder.add_point(p, file_.source().begin());
    }
    if (core) return;
    std::vector<std::uint32_t> corners;
    if (primitive.has("indices")) {
      corners = read_indices(file_, primitive.at("indices"), points.count);
    } else {
      for (std::size_t i = 0; i < points.count; ++i)
        corners.push_back(static_cast<std::uint32_t>(i));
    }
    for (std::uint32_t& corner : corners) corner += static_cast<std::uint32_t>(first);
    if (corners.size() < 3 || (mode == Triangles && corners.size() % 3 != 0))
      primitive.fail(std::to_string(corners.size()) + " corners, which do not make " +
                     (mode == Triangles ? "triangles" : "a strip or fan") +
                     "; the file is damaged");
    add_triangles(corners, static_cast<Mode>(mode), placement.mirrors(), builder);
  }

  static void add_triangles(const std::vector<std::uint32_t>& c, Mode mode, bool reversed,
                            MeshBuilder& builder) {
    const auto add = [&](std::uint32_t p, std::uint32_t q, std::uint32_t r) {
      builder.add_triangle(reversed ? geom::Triangle{r, q, p} : geom::Triangle{p, q, r});
    };
    if (mode == Triangles) {
      for (std::size_t i = 0; i + 2 < c.size(); i += 3) add(c[i], c[i + 1], c[i + 2]);
    } else if (mode == Strip) {  // every second triangle runs the other way
      for (std::size_t i = 0; i + 2 < c.size(); ++i) add(c[i], c[i + 1 + i % 2], c[i + 2 - i % 2]);
    } else {
      for (std::size_t i = 0; i + 2 < c.size(); ++i) add(c[i + 1], c[i + 2], c[0]);
    }
  }

  void add_notes() {
    std::size_t unused = 0;
    for (const bool used : used_) unused += used ? 0 : 1;
    if (unused > 0)
      file_.note(counted(unused, "mesh that the scene does not show was",
                         "meshes that the scene does not show were") +
                 " left out.");
    std::size_t hidden = 0;
    for (std::size_t i = 0; i < visited_.size(); ++i) {
      const JsonItem node = file_.root().at("nodes").at(i);
      if (visited_[i] || !node.has("mesh")) continue;
      const std::uint64_t mesh = node.at("mesh").integer();
      if (mesh < used_.size() && used_[mesh]) ++hidden;  // else the mesh is counted
    }
    if (hidden > 0)
      file_.note(counted(hidden, "further node with a mesh, which the scene does not show, was",
                         "further nodes with meshes, which the scene does not show, were") +
                 " left out.");
    if (lines_ > 0)
      file_.note(counted(lines_, "set of lines or points was", "sets of lines or points were") +
                 " ignored.");
    if (morphs_) file_.note("Morph targets were ignored; their weights are 0.");
    if (file_.count("animations") > 0)
      file_.note("Animations were ignored; the scene is as its nodes state it.");
    if (file_.uses("MSFT_lod")) file_.note("Of levels of detail, the finest was read.");
  }

  GltfFile& file_;
  const std::function<MeshBuilder&(const std::string&)>& builder_for_;
  GltfFacts facts_;
  std::vector<bool> visited_, used_;  ///< nodes; meshes
  std::size_t lines_ = 0;
  const bool cores_;
  bool morphs_ = false;
};

/// The triangles of convex bodies with radii are smaller than the bodies.
void refuse_radii(const GltfFile& file) {
  const JsonItem::Json* const record = gltf_set_record(file);
  if (record == nullptr) return;
  const JsonItem item(file.source(), *record, std::string("extras.") + kGltfSetRecord);
  if (!item.has("margin") || item.at("margin").number() != 0)
    item.fail(
        "a convex set whose bodies have a radius (a margin), which a mesh would lose; use the file "
        "as a set of bodies, or write it with the margin made explicit");
}

}  // namespace

GltfFacts read_gltf_scene(GltfFile& file,
                          const std::function<MeshBuilder&(const std::string&)>& builder_for,
                          bool cores) {
  return GltfReader(file, builder_for, cores).read();
}

void note_gltf_facts(const GltfFacts& facts, GltfFile& file) {
  if (facts.placed)
    file.note("Coordinates are the file's, moved by its transforms in rounded double precision.");
  if (facts.mirrored)
    file.note("Transforms with negative determinant mirror meshes; their faces were reversed.");
}

const JsonItem::Json* gltf_set_record(const GltfFile& file) {
  const JsonItem root = file.root();
  if (!root.has("extras") || !root.json()["extras"].is_object()) return nullptr;
  const JsonItem extras = root.at("extras");
  return extras.has(kGltfSetRecord) ? &extras.json()[kGltfSetRecord] : nullptr;
}

std::string gltf_unit(const GltfFile& file) {
  if (const JsonItem::Json* const record = gltf_set_record(file)) {
    if (!record->is_object()) return "";
    const auto unit = record->find("unit");
    return unit != record->end() && unit->is_string() ? unit->get<std::string>() : "";
  }
  // A mesh of ours is in the unit of what it was made of, which need not be metres.
  const JsonItem::Json& asset = file.root().at("asset").json();
  return asset.value("generator", JsonItem::Json()) == kGltfGenerator ? "" : "m";
}

ReadResult read_gltf(const Source& source, Format format) {
  GltfFile file(source);
  MeshBuilder builder(source);
  const GltfFacts facts =
      read_gltf_scene(file, [&](const std::string&) -> MeshBuilder& { return builder; });
  refuse_radii(file);
  note_gltf_facts(facts, file);
  for (std::string& note : file.take_notes()) builder.note(std::move(note));
  ReadResult result = builder.finish(format, facts.floats);
  result.other_files = file.other_files();
  result.unit = gltf_unit(file);
  return result;
}

}  // namespace kaboum::io
