// VRML 97 (ISO/IEC 14772-1): the geometry of IndexedFaceSet nodes below grouping nodes.
//
// The text is interpreted as it is read, without a tree. A DEF is the place of a node's text; USE
// reads it again from there. Transform's children are read after its other fields. Re-reading is
// bounded by a budget of tokens, linear in the file's size, so that nested USEs cannot explode.

#include <kaboum/geom/error.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <map>
#include <optional>

#include "builder.h"
#include "formats.h"
#include "text.h"

namespace kaboum::io {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxNodeDepth = 256;
constexpr int kMaxInlineDepth = 16;

constexpr std::array<std::string_view, 5> kGroups = {"Anchor", "Billboard", "Collision", "Group",
                                                     "Transform"};
constexpr std::array<std::string_view, 9> kSolids = {
    "Box",    "Cone", "Cylinder",           "ElevationGrid", "Extrusion",
    "Sphere", "Text", "IndexedTriangleSet", "TriangleSet"};
/// Nodes without surface that may stand between shapes.
constexpr std::array<std::string_view, 24> kHarmless = {"AudioClip",
                                                        "Background",
                                                        "ColorInterpolator",
                                                        "CoordinateInterpolator",
                                                        "CylinderSensor",
                                                        "DirectionalLight",
                                                        "Fog",
                                                        "NavigationInfo",
                                                        "NormalInterpolator",
                                                        "OrientationInterpolator",
                                                        "PlaneSensor",
                                                        "PointLight",
                                                        "PositionInterpolator",
                                                        "ProximitySensor",
                                                        "ScalarInterpolator",
                                                        "Script",
                                                        "Sound",
                                                        "SphereSensor",
                                                        "SpotLight",
                                                        "TimeSensor",
                                                        "TouchSensor",
                                                        "Viewpoint",
                                                        "VisibilitySensor",
                                                        "WorldInfo"};

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// x ↦ linear·x + translation, exact where it is the identity.
struct Placement {
  Eigen::Matrix3d linear = Eigen::Matrix3d::Identity();
  geom::Vec3 translation = geom::Vec3::Zero();

  [[nodiscard]] bool is_identity() const {
    return linear == Eigen::Matrix3d::Identity() && translation == geom::Vec3::Zero();
  }
  [[nodiscard]] geom::Vec3 operator*(const geom::Vec3& p) const {
    if (linear == Eigen::Matrix3d::Identity()) return p + translation;
    return linear * p + translation;
  }
  [[nodiscard]] Placement operator*(const Placement& inner) const {
    if (is_identity()) return inner;
    if (inner.is_identity()) return *this;
    return {linear * inner.linear, *this * inner.translation};
  }
};

/// Axis and angle; the axis need not be of unit length.
Eigen::Matrix3d rotation(const Eigen::Vector4d& r) {
  const double length = r.head<3>().stableNorm();
  if (r[3] == 0 || length == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(r[3], r.head<3>() / length).toRotationMatrix();
}

/// The fields of a Transform node with their default values.
struct TransformFields {
  geom::Vec3 center = geom::Vec3::Zero();
  geom::Vec3 scale = geom::Vec3::Ones();
  geom::Vec3 translation = geom::Vec3::Zero();
  Eigen::Vector4d rotation = Eigen::Vector4d::Zero();
  Eigen::Vector4d scale_orientation = Eigen::Vector4d::Zero();

  /// T·C·R·SR·S·SR⁻¹·C⁻¹ (ISO/IEC 14772-1, 6.52).
  [[nodiscard]] Placement placement() const {
    Eigen::Matrix3d linear = io::rotation(rotation);
    if (scale == geom::Vec3::Constant(scale.x())) {
      if (scale.x() != 1) linear *= scale.x();
    } else {
      const Eigen::Matrix3d orientation = io::rotation(scale_orientation);
      linear = linear * orientation * scale.asDiagonal() * orientation.transpose();
    }
    if (linear == Eigen::Matrix3d::Identity()) return {linear, translation};
    return {linear, translation + center - linear * center};
  }
};

/// What all files of a scene share.
struct Scene {
  MeshBuilder& builder;
  std::uint64_t budget;   ///< tokens that may still be read
  std::size_t depth = 0;  ///< of nested nodes
  std::vector<fs::path> inlined = {};
  bool placed = false;    ///< a transform was applied
  bool mirrored = false;  ///< by a negative scale
  bool proxies = false;
  std::size_t lines = 0;  ///< nodes with lines or points only
  std::map<std::string, std::size_t, std::less<>> unknown = {};
};

class VrmlReader {
 public:
  /// @param anchor  for an inlined file, the place of its Inline in the outermost file.
  VrmlReader(const Source& source, Scene& scene, int inline_depth, const char* anchor)
      : source_(source),
        scene_(scene),
        inline_depth_(inline_depth),
        anchor_(anchor),
        at_(source.begin()) {}

  void read(const Placement& placement) {
    read_header();
    for (;;) {
      const std::string_view word = token();
      if (word.empty()) return;
      read_statement(word, placement);
    }
  }

 private:
  // --- tokens: words and numbers, "strings" with their quotes, and single brackets ---

  std::string_view token() {
    skip_space();
    last_ = at_;
    if (at_ == source_.end()) return {};
    spend();
    if (is_bracket(*at_)) return {at_++, 1};
    if (*at_ == '"') return string_token();
    const char* const first = at_;
    while (at_ != source_.end() && !is_space(*at_) && !is_bracket(*at_) && *at_ != '"' &&
           *at_ != '#')
      ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  std::string_view string_token() {
    const char* const first = at_++;
    while (at_ != source_.end() && *at_ != '"')
      at_ += *at_ == '\\' && at_ + 1 != source_.end() ? 2 : 1;
    if (at_ == source_.end())
      fail(source_, first, "a string without closing quote; the file is damaged");
    ++at_;
    return {first, static_cast<std::size_t>(at_ - first)};
  }

  void skip_space() {
    while (at_ != source_.end()) {
      if (*at_ == '#') {
        while (at_ != source_.end() && detail::char_class(*at_) != detail::kEol) ++at_;
      } else if (is_space(*at_)) {
        ++at_;
      } else {
        return;
      }
    }
  }

  static bool is_space(char c) { return c == ',' || detail::char_class(c) != detail::kOther; }
  static bool is_bracket(char c) { return c == '{' || c == '}' || c == '[' || c == ']'; }

  void spend() {
    if (scene_.budget == 0)
      throw Error(ErrorCode::LimitReached,
                  std::string(source_.name) + ": " + place(source_, at_) +
                      ": DEF and USE repeat too much; expand or simplify the scene");
    --scene_.budget;
  }

  std::string_view need(std::string_view what) {
    const std::string_view found = token();
    if (found.empty())
      fail(source_, source_.end(),
           "the file ends where " + std::string(what) +
               " is expected; it is truncated, get it again");
    return found;
  }

  void expect(std::string_view word) {
    const std::string_view found = need(in_quotes(word));
    if (found != word)
      fail(source_, last_,
           in_quotes(found) + " where '" + std::string(word) +
               "' is expected; the file is damaged or not VRML 97");
  }

  /// The next token without taking it.
  std::string_view peek() {
    const char* const at = at_;
    const char* const last = last_;
    const std::string_view found = token();
    at_ = at;
    last_ = last;
    return found;
  }

  static bool is_value(std::string_view word) {
    const char c = word.empty() ? '\0' : word.front();
    return (c >= '0' && c <= '9') || c == '-' || c == '+' || c == '.' || c == '"' ||
           word == "TRUE" || word == "FALSE";
  }

  // --- statements and nodes ---

  void read_header() {
    const std::string_view text = without_byte_order_mark(source_.bytes);
    at_ = text.data();
    if (text.starts_with("#VRML V1.0"))
      fail(source_, at_, "VRML 1.0 is not supported; convert the file to VRML 97 (V2.0)");
    if (text.starts_with("#X3D"))
      fail(source_, at_,
           "X3D in classic encoding is not supported; convert the file to X3D in XML");
    if (!text.starts_with("#VRML V2.0"))
      fail(source_, at_, "the file does not begin with '#VRML V2.0'; it is not a VRML 97 file");
  }

  /// A node, DEF, USE, PROTO or ROUTE that begins with `word`.
  void read_statement(std::string_view word, const Placement& placement) {
    if (word == "PROTO" || word == "EXTERNPROTO")
      fail(source_, last_,
           std::string(word) + " is not supported; export the scene without prototypes");
    if (word == "ROUTE") {
      for (int i = 0; i < 3; ++i) need("the rest of a ROUTE");
    } else {
      read_node(word, [&](std::string_view type) { read_child(type, placement); });
    }
  }

  /// Resolves DEF, USE and NULL around a node that begins with `word`, then calls `body(type)`
  /// behind the node's opening brace; `body` takes the closing brace.
  template <typename Body>
  void read_node(std::string_view word, const Body& body) {
    if (word == "NULL") return;
    if (++scene_.depth > kMaxNodeDepth) fail_depth();
    if (word == "USE") {
      const std::string_view name = need("a node name");
      const auto found = defs_.find(name);
      if (found == defs_.end())
        fail(source_, last_,
             "USE " + in_quotes(name) + " without a DEF before; the file is damaged");
      const char* const back = at_;
      at_ = found->second;
      read_plain_node(need("a node"), body);
      at_ = back;
    } else if (word == "DEF") {
      const std::string_view name = need("a node name");
      defs_[name] = at_;
      read_plain_node(need("a node"), body);
    } else {
      read_plain_node(word, body);
    }
    --scene_.depth;
  }

  [[noreturn]] void fail_depth() const {
    fail(
        source_, last_,
        "nodes are nested more than " + std::to_string(kMaxNodeDepth) + " deep; flatten the scene");
  }

  template <typename Body>
  void read_plain_node(std::string_view type, const Body& body) {
    if (is_bracket(type.front()) || is_value(type))
      fail(source_, last_, in_quotes(type) + " where a node is expected; the file is damaged");
    expect("{");
    body(type);
  }

  /// Calls `handle(field)` for every field of a node up to its closing brace. `handle` takes the
  /// field's value and returns true, or returns false to have it skipped.
  template <typename Handle>
  void read_fields(const Handle& handle) {
    for (;;) {
      const std::string_view field = need("a field or '}'");
      if (field == "}") return;
      if (is_bracket(field.front()) || is_value(field))
        fail(source_, last_, in_quotes(field) + " where a field is expected; the file is damaged");
      if (field == "ROUTE") {
        for (int i = 0; i < 3; ++i) need("the rest of a ROUTE");
      } else if (field == "PROTO" || field == "EXTERNPROTO") {
        read_statement(field, {});
      } else if (!handle(field)) {
        skip_value();
      }
    }
  }

  /// Skips to the bracket that closes the one just taken. DEFs in between are remembered.
  void skip_to_close() {
    for (std::size_t open = 1; open > 0;) {
      const std::string_view word = need("a closing bracket");
      if (word == "{" || word == "[") ++open;
      if (open > 2 * kMaxNodeDepth) fail_depth();
      if (word == "}" || word == "]") --open;
      if (word == "DEF") {
        const std::string_view name = need("a node name");
        defs_[name] = at_;
      }
    }
  }

  void skip_value() {
    const std::string_view word = need("a value");
    if (word == "[") {
      skip_to_close();
    } else if (is_value(word)) {
      while (is_value(peek())) token();
    } else {
      skip_node(word);
    }
  }

  void skip_node(std::string_view word) {
    if (word == "NULL") return;
    if (word == "USE") {
      need("a node name");
      return;
    }
    if (word == "DEF") {
      const std::string_view name = need("a node name");
      defs_[name] = at_;
      word = need("a node");
    }
    read_plain_node(word, [&](std::string_view) { skip_to_close(); });
  }

  void read_child(std::string_view type, const Placement& placement) {
    if (contains(kGroups, type)) {
      read_group(placement);
    } else if (type == "Shape") {
      read_fields([&](std::string_view field) {
        if (field != "geometry") return false;
        read_node(need("a geometry node"),
                  [&](std::string_view geometry) { read_geometry(geometry, placement); });
        return true;
      });
    } else if (type == "Switch") {
      read_switch(placement);
    } else if (type == "LOD") {
      read_fields([&](std::string_view field) {
        if (field != "level") return false;
        read_list(placement, 0);  // the first is the finest
        return true;
      });
    } else if (type == "Inline") {
      read_inline(placement);
    } else {
      if (!contains(kHarmless, type)) ++scene_.unknown[std::string(type)];
      skip_to_close();
    }
  }

  /// Group, Transform and the like: the children are read when the transform is known.
  void read_group(const Placement& placement) {
    TransformFields fields;
    std::vector<const char*> children;
    read_fields([&](std::string_view field) {
      if (field == "children") {
        children.push_back(at_);
        skip_value();
        return true;
      }
      if (field == "proxy") scene_.proxies = true;
      return read_transform_field(field, fields);
    });
    const char* const back = at_;
    const Placement inner = placement * fields.placement();
    for (const char* const list : children) {
      at_ = list;
      read_list(inner, std::nullopt);
    }
    at_ = back;
  }

  bool read_transform_field(std::string_view field, TransformFields& fields) {
    if (field == "translation") return read_numbers(fields.translation);
    if (field == "rotation") return read_numbers(fields.rotation);
    if (field == "scale") return read_numbers(fields.scale);
    if (field == "scaleOrientation") return read_numbers(fields.scale_orientation);
    if (field == "center") return read_numbers(fields.center);
    return false;
  }

  template <typename Vector>
  bool read_numbers(Vector& v) {
    for (double& x : v) x = parse_coordinate(source_, need("a number"));
    return true;
  }

  /// The nodes of an MFNode value; only the one numbered `only`, when given.
  void read_list(const Placement& placement, std::optional<std::int64_t> only) {
    std::string_view word = need("a node or '['");
    const bool bracketed = word == "[";
    if (bracketed) word = need("a node or ']'");
    for (std::int64_t i = 0; word != "]" || !bracketed; ++i) {
      if (!only || *only == i) {
        read_statement(word, placement);
      } else {
        skip_node(word);
      }
      if (!bracketed) return;
      word = need("a node or ']'");
    }
  }

  void read_switch(const Placement& placement) {
    std::int64_t which = -1;
    const char* choice = nullptr;
    read_fields([&](std::string_view field) {
      if (field == "whichChoice") {
        const std::string_view value = need("a choice");
        which = parse_integer(source_, value, "a choice");
        return true;
      }
      if (field == "choice") choice = at_;
      return false;
    });
    if (choice == nullptr || which < 0) return;
    const char* const back = at_;
    at_ = choice;
    read_list(placement, which);
    at_ = back;
  }

  // --- geometry ---

  void read_geometry(std::string_view type, const Placement& placement) {
    if (type == "IndexedFaceSet") {
      read_face_set(placement);
    } else if (type == "IndexedLineSet" || type == "PointSet") {
      ++scene_.lines;
      skip_to_close();
    } else if (contains(kSolids, type)) {
      fail(source_, last_,
           "the geometry node " + std::string(type) +
               " is not supported; export the scene as IndexedFaceSet");
    } else {
      fail(source_, last_,
           "unknown geometry node " + in_quotes(type) + "; export the scene as IndexedFaceSet");
    }
  }

  void read_face_set(const Placement& placement) {
    const char* const where = last_;
    bool counter_clockwise = true;
    const char* index = nullptr;
    points_.clear();
    read_fields([&](std::string_view field) {
      if (field == "coord") {
        read_node(need("a Coordinate node"), [&](std::string_view type) { read_points(type); });
      } else if (field == "ccw") {
        counter_clockwise = need("TRUE or FALSE") != "FALSE";
      } else if (field == "coordIndex") {
        index = at_;
        return false;
      } else {
        return false;
      }
      return true;
    });
    if (index == nullptr) return;
    const char* const back = at_;
    at_ = index;
    // A reflection turns the faces inside out; so does ccw FALSE.
    const bool mirrored = placement.linear.determinant() < 0;
    const std::size_t first = scene_.builder.point_count();
    for (const geom::Vec3& p : points_) scene_.builder.add_point(placement * p, outermost(where));
    read_faces(first, points_.size(), counter_clockwise == mirrored);
    scene_.mirrored |= mirrored;
    scene_.placed |= !placement.is_identity();
    at_ = back;
  }

  void read_points(std::string_view type) {
    if (type != "Coordinate")
      fail(source_, last_,
           in_quotes(type) + " where 'Coordinate' is expected; the file is damaged");
    read_fields([&](std::string_view field) {
      if (field != "point") return false;
      points_.clear();
      read_values([&](std::string_view value) {
        geom::Vec3 p;
        p.x() = parse_coordinate(source_, value);
        p.y() = parse_coordinate(source_, need("a coordinate"));
        p.z() = parse_coordinate(source_, need("a coordinate"));
        points_.push_back(p);
      });
      return true;
    });
  }

  void read_faces(std::size_t first, std::size_t count, bool reversed) {
    const auto add_face = [&](const char* where) {
      if (corners_.empty()) return;
      if (reversed) std::ranges::reverse(corners_);
      scene_.builder.add_face(corners_, outermost(where));
      corners_.clear();
    };
    corners_.clear();
    read_values([&](std::string_view value) {
      const std::int64_t i = parse_integer(source_, value, "a vertex index");
      if (i == -1) return add_face(last_);
      if (i < 0 || static_cast<std::uint64_t>(i) >= count)
        fail(source_, last_,
             "a face refers to vertex " + std::to_string(i) + ", but there are " +
                 std::to_string(count) + " (counted from 0); the file is damaged");
      corners_.push_back(static_cast<std::uint32_t>(first + static_cast<std::size_t>(i)));
    });
    add_face(last_);
  }

  /// Calls `take(value)` for the values of a multiple field, or for a single one without brackets.
  template <typename Take>
  void read_values(const Take& take) {
    std::string_view word = need("a value or '['");
    if (word != "[") return take(word);
    for (word = need("a value or ']'"); word != "]"; word = need("a value or ']'")) take(word);
  }

  // --- other files ---

  /// A place that outlives this reader, for the builder, which knows the outermost file only.
  [[nodiscard]] const char* outermost(const char* where) const {
    return anchor_ != nullptr ? anchor_ : where;
  }

  void read_inline(const Placement& placement) {
    std::string_view url;
    const char* where = last_;
    read_fields([&](std::string_view field) {
      if (field != "url") return false;
      read_values([&](std::string_view value) {
        if (!url.empty()) return;  // alternatives, best first
        url = value;
        where = last_;
      });
      return true;
    });
    if (url.size() < 3 || url.front() != '"') return;
    url = url.substr(1, url.size() - 2);
    const fs::path path = inline_path(url, where);
    if (inline_depth_ >= kMaxInlineDepth)
      fail(source_, where,
           "files are nested more than " + std::to_string(kMaxInlineDepth) +
               " deep by Inline; does " + in_quotes(url) + " include itself?");
    std::vector<char> bytes = read_file(path);
    const std::string name = path.string();
    if (std::ranges::find(scene_.inlined, path) == scene_.inlined.end()) {
      scene_.budget += 64 * std::uint64_t{bytes.size()};
      scene_.inlined.push_back(path);
    }
    scene_.budget -=
        std::min<std::uint64_t>(scene_.budget, bytes.size() / 8);  // for reading it again
    const Source inner{{bytes.data(), bytes.size()}, name, path.parent_path(), true};
    VrmlReader(inner, scene_, inline_depth_ + 1, outermost(where)).read(placement);
  }

  /// Only files below or beside this one, never the network, devices or absolute places.
  fs::path inline_path(std::string_view url, const char* where) {
    const fs::path relative(url);
    if (url.find("://") != std::string_view::npos || relative.is_absolute())
      fail(source_, where,
           "Inline of " + in_quotes(url) + " is not supported; use a path relative to the file");
    if (source_.directory.empty())
      fail(source_, where,
           "Inline of " + in_quotes(url) +
               " needs the file's directory; read the file by its path, not from a pipe");
    fs::path path = source_.directory / relative;
    std::error_code ignored;
    if (!fs::is_regular_file(path, ignored))
      fail(source_, where,
           "the inlined file " + in_quotes(path.string()) +
               " cannot be read; put it beside the scene");
    return path;
  }

  const Source& source_;
  Scene& scene_;
  int inline_depth_;
  const char* anchor_;
  const char* at_;
  const char* last_ = at_;                        ///< start of the latest token
  std::map<std::string_view, const char*> defs_;  ///< name to the text behind it
  std::vector<geom::Vec3> points_;
  std::vector<std::uint32_t> corners_;
};

void add_notes(const Scene& scene) {
  MeshBuilder& builder = scene.builder;
  if (scene.placed)
    builder.note(
        "Coordinates are the file's, moved by its transforms in rounded double precision.");
  if (scene.mirrored)
    builder.note("Transforms with negative scale mirror shapes; their faces were reversed.");
  if (!scene.inlined.empty())
    builder.note(counted(scene.inlined.size(), "other file was", "other files were") +
                 " read through Inline (first: " + scene.inlined.front().string() + ").");
  if (scene.proxies) builder.note("Collision proxies were ignored; the visible shapes were read.");
  if (scene.lines > 0)
    builder.note(
        counted(scene.lines, "set of lines or points was", "sets of lines or points were") +
        " ignored.");
  for (const auto& [type, count] : scene.unknown)
    builder.note(counted(count, "node", "nodes") + " of unknown type " + in_quotes(type) +
                 " skipped; surfaces in there are missing.");
}

}  // namespace

ReadResult read_vrml(const Source& source) {
  MeshBuilder builder(source);
  Scene scene{builder, 1'000'000 + 64 * std::uint64_t{source.bytes.size()}};
  VrmlReader(source, scene, 0, nullptr).read({});
  add_notes(scene);
  return builder.finish(Format::Vrml, false);
}

}  // namespace kaboum::io
