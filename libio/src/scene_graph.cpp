// What the nodes of VRML 97 and X3D mean: surfaces in Shapes below grouping nodes, in double
// precision. Every node and every field on the way to a surface is known, or the file is refused;
// so is every node that can hold a surface and is not read.

#include "scene_graph.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <filesystem>
#include <optional>

#include "builder.h"
#include "formats.h"
#include "scene_copier.h"
#include "scene_fields.h"
#include "scene_nodes.h"
#include "scene_shapes.h"
#include "text.h"

namespace kaboum::io {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxInlineDepth = 16;

/// The fields of a Transform node with their default values.
struct TransformFields {
  geom::Vec3 center = geom::Vec3::Zero();
  geom::Vec3 scale = geom::Vec3::Ones();
  geom::Vec3 translation = geom::Vec3::Zero();
  Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
  Eigen::Vector4d scale_orientation = Eigen::Vector4d::Zero();

  /// T·C·R·SR·S·SR⁻¹·C⁻¹ (ISO/IEC 14772-1, 6.52).
  [[nodiscard]] Placement placement() const {
    Eigen::Matrix3d linear = io::rotation(rotation.head<3>(), rotation[3]);
    if (scale == geom::Vec3::Constant(scale.x())) {
      if (scale.x() != 1) linear *= scale.x();
    } else {
      const Eigen::Matrix3d orientation =
          io::rotation(scale_orientation.head<3>(), scale_orientation[3]);
      linear = linear * orientation * scale.asDiagonal() * orientation.transpose();
    }
    if (linear == Eigen::Matrix3d::Identity()) return {linear, translation};
    return {linear, translation + center - linear * center};
  }
};

/// What all files of a scene share.
struct Scene {
  MeshBuilder& builder;
  SceneCopier copier;
  std::optional<double> metres;  ///< the unit that the outermost file states
  fs::path directory;            ///< of the outermost file
  std::size_t depth = 0;         ///< of nested nodes
  std::vector<fs::path> inlined = {};
  bool routed = false;
  std::size_t proxies = 0;
  std::size_t choices = 0;  ///< Switch nodes
  std::size_t levels = 0;   ///< LOD nodes with several levels
  std::size_t lines = 0;    ///< nodes with lines or points only
};

/// Reads the nodes of one file.
class SceneReader {
 public:
  /// @param anchor  for an inlined file, the place of its Inline in the outermost file.
  SceneReader(const SceneFile& file, Scene& scene, int inline_depth, const char* anchor)
      : file_(file),
        scene_(scene),
        inline_depth_(inline_depth),
        fields_(file, scene.copier),
        shapes_(fields_, scene.copier, anchor, scene.lines) {}

  void read(const Placement& placement) {
    scene_.routed |= file_.routed;
    read_in_turn(file_.roots, placement);
  }

 private:
  // --- grouping nodes ---

  void read_child(const SceneNode& node, const Placement& placement) {
    if (++scene_.depth > kMaxSceneDepth)
      fields_.fail_at(node.where, "nodes are nested more than " + std::to_string(kMaxSceneDepth) +
                                      " deep; flatten the scene");
    scene_.copier.visit();
    const std::string_view type = node.type;
    if (contains(kGroups, type)) {
      read_group(node, placement);
    } else if (type == "Shape") {
      shapes_.read_shape(node, placement);
    } else if (type == "Switch") {
      read_switch(node, placement);
    } else if (type == "LOD") {
      read_levels(node, placement);
    } else if (type == "Inline") {
      read_inline(node, placement);
    } else if (type == "Billboard") {
      fields_.fail_at(node.where,
                      "a Billboard turns with the viewer, so its shapes have no place; export "
                      "the scene without it");
    } else if (!contains(kHarmless, type)) {
      fields_.fail_at(node.where,
                      "the node " + in_quotes(type) +
                          " is not known and might hold geometry; export the scene without it");
    }
    --scene_.depth;
  }

  void read_children(const SceneField& field, const Placement& placement) {
    if (!field.text.empty())
      fields_.fail_at(field.where, in_quotes(field.name) + " has no nodes; the file is damaged");
    read_in_turn(field.nodes, placement);
  }

  /// Siblings, of which Open Inventor's Rotation and Translation move those that follow, as Coin
  /// reads them in VRML 97 files; X3D has no such nodes.
  void read_in_turn(const std::vector<const SceneNode*>& nodes, Placement placement) {
    for (const SceneNode* const node : nodes) {
      if (file_.siblings_move && (node->type == "Rotation" || node->type == "Translation")) {
        scene_.copier.visit();
        placement = placement * read_move(*node);
      } else {
        read_child(*node, placement);
      }
    }
  }

  [[nodiscard]] Placement read_move(const SceneNode& node) const {
    TransformFields fields;
    const std::string_view own = node.type == "Rotation" ? "rotation" : "translation";
    for (const SceneField& field : node.fields)
      if (field.name != own || !read_transform_field(field, fields))
        fields_.fail_field(node, field);
    return fields.placement();
  }

  void read_group(const SceneNode& node, const Placement& outer) {
    const bool moves = node.type == "Transform" || node.type == "CADPart";
    TransformFields fields;
    for (const SceneField& field : node.fields) {
      if (field.name == "proxy" && node.type == "Collision") {
        ++scene_.proxies;
      } else if (!is_children(node, field) && !contains(kGroupFields, field.name) &&
                 !fields_.read_common(field) && !(moves && read_transform_field(field, fields))) {
        fields_.fail_field(node, field);
      }
    }
    const Placement placement = outer * fields.placement();
    for (const SceneField& field : node.fields)
      if (is_children(node, field)) read_children(field, placement);
  }

  static bool is_children(const SceneNode& node, const SceneField& field) {
    return field.name == "children" || (field.name == "shape" && node.type == "CADFace");
  }

  bool read_transform_field(const SceneField& field, TransformFields& fields) const {
    if (field.name == "translation") {
      fields_.read_vector(field, fields.translation);
    } else if (field.name == "rotation") {
      fields_.read_vector(field, fields.rotation);
    } else if (field.name == "scale") {
      fields_.read_vector(field, fields.scale);
    } else if (field.name == "scaleOrientation") {
      fields_.read_vector(field, fields.scale_orientation);
    } else if (field.name == "center") {
      fields_.read_vector(field, fields.center);
    } else {
      return false;
    }
    return true;
  }

  void read_switch(const SceneNode& node, const Placement& placement) {
    std::int64_t which = -1;
    const SceneField* choice = nullptr;
    for (const SceneField& field : node.fields) {
      if (field.name == "whichChoice") {
        which = fields_.integer(field, fields_.single(field));
      } else if ((field.name == "choice" || field.name == "children") && choice == nullptr) {
        choice = &field;
      } else if (!contains(kGroupFields, field.name) && !fields_.read_common(field)) {
        fields_.fail_field(node, field);
      }
    }
    if (choice == nullptr) return;
    ++scene_.choices;
    if (which >= 0 && static_cast<std::uint64_t>(which) < choice->nodes.size())
      read_child(*choice->nodes[static_cast<std::size_t>(which)], placement);
  }

  void read_levels(const SceneNode& node, const Placement& placement) {
    const SceneField* levels = nullptr;
    for (const SceneField& field : node.fields) {
      if ((field.name == "level" || field.name == "children") && levels == nullptr) {
        levels = &field;
      } else if (!contains(kGroupFields, field.name) && !fields_.read_common(field) &&
                 field.name != "center" && field.name != "forceTransitions") {
        fields_.fail_field(node, field);
      }
    }
    if (levels == nullptr || levels->nodes.empty()) return;
    scene_.levels += levels->nodes.size() > 1 ? 1 : 0;
    read_child(*levels->nodes[0], placement);  // the first is the finest
  }

  // --- other files ---

  void read_inline(const SceneNode& node, const Placement& placement) {
    const SceneField* url = nullptr;
    for (const SceneField& field : node.fields) {
      if (field.name == "url") {
        url = &field;
      } else if (field.name == "load") {
        if (!fields_.read_bool(field))
          fields_.fail_at(field.where,
                          "an Inline that is not loaded at first is not supported; delete it");
      } else if (field.name != "global" && !contains(kGroupFields, field.name) &&
                 !fields_.read_common(field)) {
        fields_.fail_field(node, field);
      }
    }
    const std::string name = url != nullptr ? first_string(*url) : "";
    if (name.empty()) return;
    const char* const where = url->where;
    const fs::path path = inline_path(name, where);
    if (inline_depth_ >= kMaxInlineDepth)
      fields_.fail_at(where, "files are nested more than " + std::to_string(kMaxInlineDepth) +
                                 " deep by Inline; does " + in_quotes(name) + " include itself?");
    const std::vector<char> bytes = read_file(path);
    const std::string shown = path.string();
    if (std::ranges::find(scene_.inlined, path) == scene_.inlined.end()) {
      scene_.copier.allow(bytes.size());
      scene_.inlined.push_back(path);
    }
    scene_.copier.spend(bytes.size() / 8);  // for reading it again
    const Source inner{{bytes.data(), bytes.size()}, shown, path.parent_path(), true};
    SceneFile file(inner);
    if (without_byte_order_mark(inner.bytes).starts_with('<')) {
      parse_x3d(file);
    } else {
      parse_vrml(file);
    }
    constexpr double kStandard = 1;  // in both standards, where a file does not state a unit
    if (file.metres.value_or(kStandard) != scene_.metres.value_or(kStandard))
      fields_.fail_at(where, "the inlined file " + in_quotes(shown) +
                                 " has another unit; export with one unit");
    SceneReader(file, scene_, inline_depth_ + 1, shapes_.outermost(where)).read(placement);
  }

  /// The first of the alternatives; they are quoted, but for a single one in X3D.
  [[nodiscard]] std::string first_string(const SceneField& field) const {
    std::string_view text = field.text;
    const std::size_t quote = text.find('"');
    if (quote == std::string_view::npos) {
      while (!text.empty() && detail::char_class(text.front()) != detail::kOther)
        text.remove_prefix(1);
      while (!text.empty() && detail::char_class(text.back()) != detail::kOther)
        text.remove_suffix(1);
      return std::string(text);
    }
    text.remove_prefix(quote + 1);
    return std::string(text.substr(0, text.find('"')));
  }

  /// Only files in the outermost file's folder or below, never the network, devices or absolute
  /// places.
  [[nodiscard]] fs::path inline_path(std::string_view url, const char* where) const {
    const fs::path relative(url);
    if (url.find("://") != std::string_view::npos || relative.is_absolute())
      fields_.fail_at(where, "Inline of " + in_quotes(url) +
                                 " is not supported; use a path relative to the file");
    if (file_.source.directory.empty())
      fields_.fail_at(
          where, "Inline of " + in_quotes(url) +
                     " needs the file's directory; read the file by its path, not from a pipe");
    fs::path path = file_.source.directory / relative;
    const fs::path inside =
        path.lexically_normal().lexically_relative(scene_.directory.lexically_normal());
    if (inside.empty() || *inside.begin() == "..")
      fields_.fail_at(where, "Inline of " + in_quotes(url) +
                                 " leaves the folder of the file; put it there, or below");
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
      fields_.fail_at(where, "the inlined file " + in_quotes(path.string()) +
                                 " cannot be read; put it beside the scene");
    return path;
  }

  const SceneFile& file_;
  Scene& scene_;
  int inline_depth_;
  SceneFields fields_;
  ShapeReader shapes_;
};

void add_notes(const Scene& scene) {
  MeshBuilder& builder = scene.builder;
  scene.copier.add_notes();
  if (scene.metres) {
    builder.set_unit(*scene.metres);
    if (*scene.metres != 1)
      builder.note("The file's unit is " + shortest_digits(*scene.metres) +
                   " metres; coordinates were not scaled.");
  }
  if (!scene.inlined.empty())
    builder.note(counted(scene.inlined.size(), "other file was", "other files were") +
                 " read through Inline (first: " + scene.inlined.front().string() + ").");
  if (scene.proxies > 0)
    builder.note("Collision proxies were ignored; the visible shapes were read.");
  if (scene.choices > 0)
    builder.note(
        counted(scene.choices, "Switch: its choice was", "Switch nodes: their choices were") +
        " read, the others left out.");
  if (scene.levels > 0)
    builder.note(
        counted(scene.levels, "LOD: its finest level was", "LOD nodes: their finest levels were") +
        " read.");
  if (scene.routed)
    builder.note("Events and animations were ignored; the scene is as it is at first.");
  if (scene.lines > 0)
    builder.note(
        counted(scene.lines, "set of lines or points was", "sets of lines or points were") +
        " ignored.");
}

}  // namespace

SceneField& SceneNode::field(std::string_view name, const char* place) {
  for (SceneField& f : fields)
    if (f.name == name) return f;
  return fields.emplace_back(SceneField{name, {}, {}, place});
}

ReadResult read_scene(const Source& source, Format format) {
  MeshBuilder builder(source);
  SceneFile file(source);
  if (format == Format::Vrml) {
    parse_vrml(file);
  } else {
    parse_x3d(file);
  }
  Scene scene{builder, SceneCopier(builder), file.metres, source.directory};
  SceneReader(file, scene, 0, nullptr).read({});
  add_notes(scene);
  ReadResult result = builder.finish(format, false);
  for (const fs::path& path : scene.inlined) result.other_files.push_back(path.string());
  return result;
}

}  // namespace kaboum::io
