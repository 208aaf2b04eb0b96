// What the nodes of VRML 97 and X3D mean: surfaces in Shapes below grouping nodes, in double
// precision. Every node and every field on the way to a surface is known here, or the file is
// refused; so is every node that can hold a surface and is not read.

#include "scene_graph.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <optional>

#include "builder.h"
#include "formats.h"
#include "scene_copier.h"
#include "text.h"

namespace kaboum::io {
namespace {

namespace fs = std::filesystem;

constexpr int kMaxInlineDepth = 16;

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

constexpr std::array<std::string_view, 10> kGroups = {
    "Anchor",    "CADAssembly", "CADFace",       "CADLayer",    "CADPart",
    "Collision", "Group",       "PickableGroup", "StaticGroup", "Transform"};
/// Fields of grouping nodes and shapes that neither hold nor move a surface.
constexpr std::array<std::string_view, 14> kGroupFields = {
    "bboxCenter", "bboxDisplay", "bboxSize",   "castShadow", "collide",  "description", "enabled",
    "load",       "name",        "objectType", "parameter",  "pickable", "range",       "url"};
constexpr std::array<std::string_view, 9> kSurfaces = {
    "IndexedFaceSet",          "IndexedQuadSet", "IndexedTriangleFanSet", "IndexedTriangleSet",
    "IndexedTriangleStripSet", "QuadSet",        "TriangleFanSet",        "TriangleSet",
    "TriangleStripSet"};
constexpr std::array<std::string_view, 16> kSurfaceFields = {
    "attrib",   "color",       "colorIndex",       "colorPerVertex",  "convex", "creaseAngle",
    "fogCoord", "normal",      "normalIndex",      "normalPerVertex", "solid",  "texCoord",
    "metadata", "bboxDisplay", "radianceTransfer", "texCoordIndex"};
/// Geometry without surface.
constexpr std::array<std::string_view, 8> kLines = {"Arc2D",      "Circle2D",   "IndexedLineSet",
                                                    "LineSet",    "NurbsCurve", "PointSet",
                                                    "Polyline2D", "Polypoint2D"};
/// Nodes between shapes that hold none; parts of shapes stand there when they are kept for USE.
constexpr std::array<std::string_view, 83> kHarmless = {"Appearance",
                                                        "AudioClip",
                                                        "Background",
                                                        "BooleanFilter",
                                                        "BooleanSequencer",
                                                        "BooleanToggle",
                                                        "BooleanTrigger",
                                                        "CollisionSensor",
                                                        "Color",
                                                        "ColorChaser",
                                                        "ColorDamper",
                                                        "ColorInterpolator",
                                                        "ColorRGBA",
                                                        "Coordinate",
                                                        "CoordinateChaser",
                                                        "CoordinateDamper",
                                                        "CoordinateDouble",
                                                        "CoordinateInterpolator",
                                                        "CoordinateInterpolator2D",
                                                        "CylinderSensor",
                                                        "DirectionalLight",
                                                        "EaseInEaseOut",
                                                        "EnvironmentLight",
                                                        "Fog",
                                                        "FontStyle",
                                                        "ImageTexture",
                                                        "IntegerSequencer",
                                                        "IntegerTrigger",
                                                        "KeySensor",
                                                        "LinePickSensor",
                                                        "LoadSensor",
                                                        "LocalFog",
                                                        "Material",
                                                        "MetadataBoolean",
                                                        "MetadataDouble",
                                                        "MetadataFloat",
                                                        "MetadataInteger",
                                                        "MetadataSet",
                                                        "MetadataString",
                                                        "MovieTexture",
                                                        "NavigationInfo",
                                                        "Normal",
                                                        "NormalInterpolator",
                                                        "OrientationChaser",
                                                        "OrientationDamper",
                                                        "OrientationInterpolator",
                                                        "OrthoViewpoint",
                                                        "PixelTexture",
                                                        "PlaneSensor",
                                                        "PointLight",
                                                        "PointPickSensor",
                                                        "PositionChaser",
                                                        "PositionChaser2D",
                                                        "PositionDamper",
                                                        "PositionDamper2D",
                                                        "PositionInterpolator",
                                                        "PositionInterpolator2D",
                                                        "PrimitivePickSensor",
                                                        "ProximitySensor",
                                                        "ScalarChaser",
                                                        "ScalarDamper",
                                                        "ScalarInterpolator",
                                                        "Script",
                                                        "Sound",
                                                        "SphereSensor",
                                                        "SplinePositionInterpolator",
                                                        "SplinePositionInterpolator2D",
                                                        "SplineScalarInterpolator",
                                                        "SpotLight",
                                                        "SquadOrientationInterpolator",
                                                        "StringSensor",
                                                        "TexCoordDamper2D",
                                                        "TextureBackground",
                                                        "TextureCoordinate",
                                                        "TextureTransform",
                                                        "TimeSensor",
                                                        "TimeTrigger",
                                                        "TouchSensor",
                                                        "TransformSensor",
                                                        "Viewpoint",
                                                        "VisibilitySensor",
                                                        "VolumePickSensor",
                                                        "WorldInfo"};

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
  double metres = 1;
  std::size_t depth = 0;  ///< of nested nodes
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
      : file_(file), scene_(scene), inline_depth_(inline_depth), anchor_(anchor) {}

  void read(const Placement& placement) {
    scene_.routed |= file_.routed;
    for (const SceneNode* const node : file_.roots) read_child(*node, placement);
  }

 private:
  // --- places and values ---

  [[noreturn]] void fail_at(const char* where, const std::string& what) const {
    fail(file_.source, where, what);
  }

  /// In VRML, values are part of the file; in X3D, only their element's line is known.
  [[noreturn]] void fail_value(const SceneField& field, std::string_view value,
                               const std::string& what) const {
    fail_at(file_.xml ? field.where : value.data(), what);
  }

  /// Takes the next value off the front of `text`; empty at its end.
  [[nodiscard]] std::string_view next_value(std::string_view& text) const {
    const auto is_space = [](char c) {
      return c == ',' || detail::char_class(c) != detail::kOther;
    };
    std::size_t i = 0;
    while (i < text.size() && (is_space(text[i]) || (text[i] == '#' && !file_.xml))) {
      if (text[i] == '#')
        while (i < text.size() && detail::char_class(text[i]) != detail::kEol) ++i;
      else
        ++i;
    }
    std::size_t end = i;
    while (end < text.size() && !is_space(text[end]) && (text[end] != '#' || file_.xml)) ++end;
    const std::string_view value = text.substr(i, end - i);
    text.remove_prefix(end);
    return value;
  }

  [[nodiscard]] double number(const SceneField& field, std::string_view value) const {
    if (value.empty()) fail_at(field.where, in_quotes(field.name) + " has too few numbers");
    const std::optional<double> x = to_double(value);
    if (!x || !std::isfinite(*x))
      fail_value(field, value,
                 in_quotes(value) + (x ? " is not a finite double; repair or remove it"
                                       : " is not a number; check that the file is complete"));
    return *x;
  }

  [[nodiscard]] std::int64_t integer(const SceneField& field, std::string_view value) const {
    std::int64_t number = 0;
    std::string_view digits = value;
    if (digits.starts_with('+')) digits.remove_prefix(1);
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    if (error != std::errc() || end != digits.data() + digits.size())
      fail_value(field, value,
                 in_quotes(value) + " where an integer is expected; the file is damaged");
    return number;
  }

  template <typename Vector>
  void read_vector(const SceneField& field, Vector& v) const {
    std::string_view text = field.text;
    scene_.copier.spend(text);
    for (double& x : v) x = number(field, next_value(text));
    if (!next_value(text).empty())
      fail_at(field.where, in_quotes(field.name) + " has too many numbers");
  }

  [[nodiscard]] bool read_bool(const SceneField& field) const {
    std::string_view text = field.text;
    const std::string_view value = next_value(text);
    const bool yes = value == "TRUE" || value == "true";
    if ((!yes && value != "FALSE" && value != "false") || !next_value(text).empty())
      fail_at(field.where, in_quotes(field.name) + " is neither true nor false");
    return yes;
  }

  [[nodiscard]] std::vector<std::int64_t> read_integers(const SceneField& field) const {
    std::vector<std::int64_t> values;
    std::string_view text = field.text;
    for (auto v = next_value(text); !v.empty(); v = next_value(text))
      values.push_back(integer(field, v));
    return values;
  }

  [[noreturn]] void fail_field(const SceneNode& node, const SceneField& field) const {
    fail_at(field.where,
            "the field " + in_quotes(field.name) + " of " + std::string(node.type) +
                (field.nodes.empty() ? "" : ", with " + in_quotes(field.nodes[0]->type)) +
                ", is not known and might hold geometry; export without it");
  }

  /// The field's only node, or nullptr.
  [[nodiscard]] const SceneNode* only(const SceneField& field) const {
    if (field.nodes.size() > 1)
      fail_at(field.where, in_quotes(field.name) + " has several nodes; the file is damaged");
    if (field.nodes.empty() && !field.text.empty())
      fail_at(field.where, in_quotes(field.name) + " has no node; the file is damaged");
    return field.nodes.empty() ? nullptr : field.nodes[0];
  }

  /// Fields that any node may have.
  [[nodiscard]] bool read_common(const SceneField& field) const {
    if (field.name == "metadata") {
      for (const SceneNode* const n : field.nodes)
        if (!n->type.starts_with("Metadata"))
          fail_at(n->where, in_quotes(n->type) + " where metadata is expected");
      return true;
    }
    if (field.name != "visible") return false;
    std::string_view text = field.text;
    scene_.copier.spend(text);
    for (auto v = next_value(text); !v.empty(); v = next_value(text))
      if (v != "TRUE" && v != "true")
        fail_at(field.where, "nodes that are not visible are not supported; delete them");
    return true;
  }

  // --- grouping nodes ---

  void read_child(const SceneNode& node, const Placement& placement) {
    if (++scene_.depth > kMaxSceneDepth)
      fail_at(node.where, "nodes are nested more than " + std::to_string(kMaxSceneDepth) +
                              " deep; flatten the scene");
    scene_.copier.visit();
    const std::string_view type = node.type;
    if (contains(kGroups, type)) {
      read_group(node, placement);
    } else if (type == "Shape") {
      read_shape(node, placement);
    } else if (type == "Switch") {
      read_switch(node, placement);
    } else if (type == "LOD") {
      read_levels(node, placement);
    } else if (type == "Inline") {
      read_inline(node, placement);
    } else if (type == "Billboard") {
      fail_at(node.where,
              "a Billboard turns with the viewer, so its shapes have no place; export "
              "the scene without it");
    } else if (!contains(kHarmless, type)) {
      fail_at(node.where, "the node " + in_quotes(type) +
                              " is not known and might hold geometry; export the scene without it");
    }
    --scene_.depth;
  }

  void read_children(const SceneField& field, const Placement& placement) {
    if (!field.text.empty())
      fail_at(field.where, in_quotes(field.name) + " has no nodes; the file is damaged");
    for (const SceneNode* const child : field.nodes) read_child(*child, placement);
  }

  void read_group(const SceneNode& node, const Placement& outer) {
    const bool moves = node.type == "Transform" || node.type == "CADPart";
    TransformFields fields;
    for (const SceneField& field : node.fields) {
      if (field.name == "proxy" && node.type == "Collision") {
        ++scene_.proxies;
      } else if (!is_children(node, field) && !contains(kGroupFields, field.name) &&
                 !read_common(field) && !(moves && read_transform_field(field, fields))) {
        fail_field(node, field);
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
      read_vector(field, fields.translation);
    } else if (field.name == "rotation") {
      read_vector(field, fields.rotation);
    } else if (field.name == "scale") {
      read_vector(field, fields.scale);
    } else if (field.name == "scaleOrientation") {
      read_vector(field, fields.scale_orientation);
    } else if (field.name == "center") {
      read_vector(field, fields.center);
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
        which = integer(field, single(field));
      } else if ((field.name == "choice" || field.name == "children") && choice == nullptr) {
        choice = &field;
      } else if (!contains(kGroupFields, field.name) && !read_common(field)) {
        fail_field(node, field);
      }
    }
    if (choice == nullptr) return;
    ++scene_.choices;
    if (which >= 0 && static_cast<std::uint64_t>(which) < choice->nodes.size())
      read_child(*choice->nodes[static_cast<std::size_t>(which)], placement);
  }

  [[nodiscard]] std::string_view single(const SceneField& field) const {
    std::string_view text = field.text;
    const std::string_view value = next_value(text);
    if (value.empty() || !next_value(text).empty())
      fail_at(field.where, in_quotes(field.name) + " has not one value");
    return value;
  }

  void read_levels(const SceneNode& node, const Placement& placement) {
    const SceneField* levels = nullptr;
    for (const SceneField& field : node.fields) {
      if ((field.name == "level" || field.name == "children") && levels == nullptr) {
        levels = &field;
      } else if (!contains(kGroupFields, field.name) && !read_common(field) &&
                 field.name != "center" && field.name != "forceTransitions") {
        fail_field(node, field);
      }
    }
    if (levels == nullptr || levels->nodes.empty()) return;
    scene_.levels += levels->nodes.size() > 1 ? 1 : 0;
    read_child(*levels->nodes[0], placement);  // the first is the finest
  }

  // --- shapes ---

  void read_shape(const SceneNode& node, const Placement& placement) {
    for (const SceneField& field : node.fields) {
      if (field.name == "geometry") {
        if (const SceneNode* const geometry = only(field)) read_geometry(*geometry, placement);
      } else if (field.name == "appearance") {
        const SceneNode* const appearance = only(field);
        if (appearance != nullptr && appearance->type != "Appearance") fail_field(node, field);
      } else if (!contains(kGroupFields, field.name) && !read_common(field)) {
        fail_field(node, field);
      }
    }
  }

  void read_geometry(const SceneNode& node, const Placement& placement) {
    if (contains(kLines, node.type)) {
      ++scene_.lines;
      return;
    }
    if (!contains(kSurfaces, node.type))
      fail_at(node.where, "the geometry node " + in_quotes(node.type) +
                              " is not supported; export the scene as IndexedFaceSet");
    bool counter_clockwise = true;
    const SceneField* coordinates = nullptr;
    const SceneField* index = nullptr;
    for (const SceneField& field : node.fields) {
      if (field.name == "coord") {
        coordinates = &field;
      } else if (field.name == "ccw") {
        counter_clockwise = read_bool(field);
      } else if (field.name == index_name(node.type)) {
        index = &field;
      } else if (!contains(kSurfaceFields, field.name)) {
        fail_field(node, field);
      }
    }
    if (index != nullptr) scene_.copier.spend(index->text);
    points_.clear();
    if (coordinates != nullptr)
      if (const SceneNode* const points = only(*coordinates)) read_points(*points);
    scene_.copier.add_points(points_, placement, outermost(node.where));
    read_faces(node, index, !counter_clockwise);
  }

  /// The field that says which points make faces; empty when their order does.
  static std::string_view index_name(std::string_view type) {
    if (type == "IndexedFaceSet") return "coordIndex";
    if (type.starts_with("Indexed")) return "index";
    if (type == "TriangleStripSet") return "stripCount";
    if (type == "TriangleFanSet") return "fanCount";
    return "";
  }

  void read_points(const SceneNode& node) {
    if (node.type != "Coordinate" && node.type != "CoordinateDouble")
      fail_at(node.where, in_quotes(node.type) +
                              " where 'Coordinate' is expected; export the "
                              "scene with plain coordinates");
    for (const SceneField& field : node.fields) {
      if (field.name == "point") {
        std::string_view text = field.text;
        scene_.copier.spend(text);
        for (auto v = next_value(text); !v.empty(); v = next_value(text)) {
          geom::Vec3 p;
          p.x() = number(field, v);
          p.y() = number(field, next_value(text));
          p.z() = number(field, next_value(text));
          points_.push_back(p);
        }
      } else if (!read_common(field)) {
        fail_field(node, field);
      }
    }
  }

  /// How the corners of one run make faces.
  enum class Run { Polygon, Strip, Fan };

  void read_faces(const SceneNode& node, const SceneField* index, bool reversed) {
    const std::string_view type = node.type;
    const Run run = type.ends_with("StripSet") ? Run::Strip
                    : type.ends_with("FanSet") ? Run::Fan
                                               : Run::Polygon;
    const std::size_t corners = type.ends_with("QuadSet") ? 4 : 3;
    const bool separated = type == "IndexedFaceSet" || run != Run::Polygon;
    const char* const where = index != nullptr ? index->where : node.where;
    if (type.starts_with("Indexed")) {
      if (index == nullptr) return;
      read_indices(*index, separated ? 0 : corners, run, reversed);
      return;
    }
    // Points in order: in runs of stated lengths, or all alike.
    std::vector<std::int64_t> counts;
    if (run != Run::Polygon) {
      if (index != nullptr) counts = read_integers(*index);
    } else {
      counts.assign(points_.size() / corners, static_cast<std::int64_t>(corners));
    }
    std::uint64_t sum = 0;
    for (const std::int64_t count : counts) {
      if (count < 3 || count > 0xFFFFFFFFLL)
        fail_at(where, "a run of " + std::to_string(count) + " points; the file is damaged");
      sum += static_cast<std::uint64_t>(count);
    }
    if (sum != points_.size())
      fail_at(where, std::string(type) + " has " + std::to_string(points_.size()) +
                         " points, but faces of " + std::to_string(sum) + "; the file is damaged");
    std::uint32_t next = 0;
    for (const std::int64_t count : counts) {
      corners_.clear();
      for (std::int64_t i = 0; i < count; ++i) corners_.push_back(next++);
      add_run(run, reversed, where);
    }
  }

  /// @param size  corners of a face; 0: faces end at an index of -1.
  void read_indices(const SceneField& index, std::size_t size, Run run, bool reversed) {
    corners_.clear();
    const char* last = index.where;
    std::string_view text = index.text;
    for (auto v = next_value(text); !v.empty(); v = next_value(text)) {
      const std::int64_t i = integer(index, v);
      if (!file_.xml) last = v.data();
      if (i == -1 && size == 0) {
        add_run(run, reversed, last);
        continue;
      }
      if (i < 0 || static_cast<std::uint64_t>(i) >= points_.size())
        fail_value(index, v,
                   "a face refers to vertex " + std::to_string(i) + ", but there are " +
                       std::to_string(points_.size()) + " (counted from 0); the file is damaged");
      corners_.push_back(static_cast<std::uint32_t>(i));
      if (corners_.size() == size) add_run(run, reversed, last);
    }
    if (!corners_.empty() && size != 0)
      fail_at(index.where, "the last face has " + std::to_string(corners_.size()) +
                               " corners; the file is damaged");
    add_run(run, reversed, last);
  }

  /// Makes faces of corners_, and clears it.
  void add_run(Run run, bool reversed, const char* where) {
    if (run == Run::Polygon) {
      if (reversed) std::ranges::reverse(corners_);
      if (!corners_.empty()) scene_.copier.add_face(corners_, outermost(where));
    } else {
      for (std::size_t i = 2; i < corners_.size(); ++i) {
        std::array triangle = {corners_[run == Run::Fan ? 0 : i - 2], corners_[i - 1], corners_[i]};
        // Every other triangle of a strip runs backwards.
        if ((run == Run::Strip && i % 2 == 1) != reversed) std::swap(triangle[0], triangle[1]);
        scene_.copier.add_face(triangle, outermost(where));
      }
    }
    corners_.clear();
  }

  // --- other files ---

  /// A place that outlives this reader, for the builder, which knows the outermost file only.
  [[nodiscard]] const char* outermost(const char* where) const {
    return anchor_ != nullptr ? anchor_ : where;
  }

  void read_inline(const SceneNode& node, const Placement& placement) {
    const SceneField* url = nullptr;
    for (const SceneField& field : node.fields) {
      if (field.name == "url") {
        url = &field;
      } else if (field.name == "load") {
        if (!read_bool(field))
          fail_at(field.where, "an Inline that is not loaded at first is not supported; delete it");
      } else if (field.name != "global" && !contains(kGroupFields, field.name) &&
                 !read_common(field)) {
        fail_field(node, field);
      }
    }
    const std::string name = url != nullptr ? first_string(*url) : "";
    if (name.empty()) return;
    const char* const where = url->where;
    const fs::path path = inline_path(name, where);
    if (inline_depth_ >= kMaxInlineDepth)
      fail_at(where, "files are nested more than " + std::to_string(kMaxInlineDepth) +
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
    if (file.metres != scene_.metres)
      fail_at(where,
              "the inlined file " + in_quotes(shown) + " has another unit; export with one unit");
    SceneReader(file, scene_, inline_depth_ + 1, outermost(where)).read(placement);
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

  /// Only files below or beside this one, never the network, devices or absolute places.
  [[nodiscard]] fs::path inline_path(std::string_view url, const char* where) const {
    const fs::path relative(url);
    if (url.find("://") != std::string_view::npos || relative.is_absolute())
      fail_at(where,
              "Inline of " + in_quotes(url) + " is not supported; use a path relative to the file");
    if (file_.source.directory.empty())
      fail_at(where, "Inline of " + in_quotes(url) +
                         " needs the file's directory; read the file by its path, not from a pipe");
    fs::path path = file_.source.directory / relative;
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
      fail_at(where, "the inlined file " + in_quotes(path.string()) +
                         " cannot be read; put it beside the scene");
    return path;
  }

  const SceneFile& file_;
  Scene& scene_;
  int inline_depth_;
  const char* anchor_;
  std::vector<geom::Vec3> points_;
  std::vector<std::uint32_t> corners_;
};

void add_notes(const Scene& scene) {
  MeshBuilder& builder = scene.builder;
  scene.copier.add_notes();
  if (scene.metres != 1)
    builder.note("The file's unit is " + std::to_string(scene.metres) +
                 " metres; coordinates were not scaled.");
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
  Scene scene{builder, SceneCopier(builder), file.metres};
  SceneReader(file, scene, 0, nullptr).read({});
  add_notes(scene);
  ReadResult result = builder.finish(format, false);
  for (const fs::path& path : scene.inlined) result.other_files.push_back(path.string());
  return result;
}

}  // namespace kaboum::io
