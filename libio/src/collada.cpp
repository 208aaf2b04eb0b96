// COLLADA 1.4 and 1.5: the meshes that the scene shows, placed by its nodes, in double precision.
// Every element on the way from the scene to a triangle is known here, or the file is refused.

#include <kaboum/base/error.h>

#include <algorithm>
#include <array>
#include <map>
#include <numbers>
#include <set>
#include <utility>

#include "builder.h"
#include "formats.h"
#include "scene_copier.h"
#include "xml.h"

namespace kaboum::io {
namespace {

using tinyxml2::XMLElement;

constexpr int kMaxDepth = 256;

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Libraries with nothing that a scene shows by itself.
constexpr std::array<std::string_view, 19> kLibraries = {"library_animation_clips",
                                                         "library_articulated_systems",
                                                         "library_cameras",
                                                         "library_controllers",
                                                         "library_effects",
                                                         "library_force_fields",
                                                         "library_formulas",
                                                         "library_geometries",
                                                         "library_images",
                                                         "library_joints",
                                                         "library_kinematics_models",
                                                         "library_kinematics_scenes",
                                                         "library_lights",
                                                         "library_materials",
                                                         "library_nodes",
                                                         "library_physics_materials",
                                                         "library_physics_models",
                                                         "library_physics_scenes",
                                                         "library_visual_scenes"};
/// Elements that are referred to by their id.
constexpr std::array<std::string_view, 6> kReferred = {"float_array", "geometry", "node",
                                                       "source",      "vertices", "visual_scene"};

/// The faces of a <geometry>.
struct Surface {
  struct Face {
    std::uint32_t corners;  ///< how many
    const char* where;
  };
  std::vector<geom::Vec3> points;
  std::vector<std::uint32_t> corners;  ///< of all faces
  std::vector<Face> faces;
};

class ColladaReader {
 public:
  ColladaReader(const Source& source, MeshBuilder& builder)
      : builder_(builder), scene_(builder), xml_(source.bytes, std::string(source.name)) {}

  void read() {
    const XMLElement& root = xml_.root();
    const std::string_view version = attribute(root, "version").value_or("");
    if (!is_named(root, "COLLADA") || !(version.starts_with("1.4") || version.starts_with("1.5")))
      xml_.fail(root, "no COLLADA document of version 1.4 or 1.5");
    const XMLElement* scene = nullptr;
    xml_.each(root, [&](const XMLElement& e) {
      if (is_named(e, "scene")) {
        if (scene != nullptr) xml_.fail(e, "a second <scene>");
        scene = &e;
      } else if (is_named(e, "library_animations")) {
        animated_ = true;
      } else if (!is_named(e, "asset") && !is_named(e, "extra") &&
                 !contains(kLibraries, e.Name())) {
        xml_.fail_unknown(e);
      }
    });
    read_asset(root);
    index(root);
    if (scene == nullptr)
      xml_.fail(root, "no <scene> says what is shown; export the file with its scene");
    read_scene(*scene);
    add_notes();
  }

 private:
  // --- the document ---

  void read_asset(const XMLElement& root) {
    const XMLElement* const asset = root.FirstChildElement("asset");
    if (asset == nullptr) return;
    if (const XMLElement* const unit = asset->FirstChildElement("unit")) {
      metres_ = metres(*unit);
      if (metres_ != 1)
        builder_.note("The file's unit is " + in_quotes(xml_.need(*unit, "meter")) +
                      " metres; coordinates were scaled to metres.");
    }
    if (const XMLElement* const up = asset->FirstChildElement("up_axis")) {
      std::string text = xml_.text(*up);
      std::string_view words = text;
      const std::string_view axis = next_word(words);
      if (axis != "Z_UP")
        builder_.note("The file's up axis is " + in_quotes(axis) +
                      "; the axes were left as they are.");
    }
  }

  [[nodiscard]] double metres(const XMLElement& unit) const {
    const double value = xml_.number(unit, attribute(unit, "meter").value_or("1"));
    if (!(value > 0)) xml_.fail(unit, "a unit of " + std::to_string(value) + " metres");
    return value;
  }

  /// Finds what can be referred to, wherever it is; tinyxml2 limits the depth.
  void index(const XMLElement& parent) {
    for (const XMLElement* e = parent.FirstChildElement(); e != nullptr;
         e = e->NextSiblingElement()) {
      if (is_named(*e, "extra")) continue;
      if (is_named(*e, "unit") && metres(*e) != metres_)
        xml_.fail(*e, "a part has another unit than the file; export with one unit");
      if (is_named(*e, "geometry")) geometries_.insert(e);
      const auto id = attribute(*e, "id");
      if (id && contains(kReferred, e->Name())) {
        const auto [entry, is_new] = ids_.try_emplace({e->Name(), *id}, e);
        if (!is_new) entry->second = nullptr;
      }
      index(*e);
    }
  }

  /// The `kind` element that an attribute of `e` refers to.
  [[nodiscard]] const XMLElement& referred(const XMLElement& e, const char* name,
                                           std::string_view kind) const {
    const std::string_view url = xml_.need(e, name);
    if (!url.starts_with('#'))
      xml_.fail(e, tag(e) + " refers to another file, " + in_quotes(url) +
                       "; export the scene as one file");
    const auto found = ids_.find({kind, url.substr(1)});
    if (found == ids_.end())
      xml_.fail(e, "there is no <" + std::string(kind) + "> " + in_quotes(url.substr(1)) +
                       "; the file is damaged");
    if (found->second == nullptr)
      xml_.fail(e, "there are several <" + std::string(kind) + "> " + in_quotes(url.substr(1)) +
                       "; export with names that are unique");
    return *found->second;
  }

  void read_scene(const XMLElement& scene) {
    const XMLElement* shown = nullptr;
    xml_.each(scene, [&](const XMLElement& e) {
      if (is_named(e, "instance_visual_scene")) {
        if (shown != nullptr) xml_.fail(e, "a second visual scene is shown; export one");
        shown = &e;
      } else if (is_named(e, "instance_physics_scene")) {
        physics_ = true;
      } else if (is_named(e, "instance_kinematics_scene")) {
        kinematics_ = true;
      } else if (!is_named(e, "extra")) {
        xml_.fail_unknown(e);
      }
    });
    if (shown == nullptr) xml_.fail(scene, "no visual scene is shown; export with geometry");
    Placement placement;
    if (metres_ != 1) placement.linear *= metres_;
    xml_.each(referred(*shown, "url", "visual_scene"), [&](const XMLElement& e) {
      if (is_named(e, "node")) {
        read_node(e, placement, nullptr, 0);
      } else if (!is_named(e, "asset") && !is_named(e, "evaluate_scene") && !is_named(e, "extra")) {
        xml_.fail_unknown(e);
      }
    });
  }

  // --- nodes ---

  /// @param obstacle  the outermost transform on the way that is not supported, or null.
  void read_node(const XMLElement& node, Placement placement, const XMLElement* obstacle,
                 int depth) {
    if (depth > kMaxDepth)
      xml_.fail(node, "nodes are nested more than " + std::to_string(kMaxDepth) +
                          " deep; does a node hold itself?");
    scene_.visit();
    xml_.each(node, [&](const XMLElement& e) {
      scene_.visit();
      if (const auto step = transform(e)) placement = placement * *step;
      if (obstacle == nullptr && (is_named(e, "skew") || is_named(e, "lookat"))) obstacle = &e;
    });
    xml_.each(node, [&](const XMLElement& e) {
      const std::string_view name = e.Name();
      if (name == "node") {
        read_node(e, placement, obstacle, depth + 1);
      } else if (name == "instance_node") {
        read_node(referred(e, "url", "node"), placement, obstacle, depth + 1);
      } else if (name == "instance_geometry") {
        if (obstacle != nullptr)
          xml_.fail(*obstacle, tag(*obstacle) +
                                   " moves meshes and is not supported; apply transforms before "
                                   "exporting");
        place(referred(e, "url", "geometry"), placement);
      } else if (name == "instance_controller") {
        xml_.fail(e,
                  "a skinned or morphed mesh is not supported; apply its deformation before "
                  "exporting");
      } else if (!contains(kOther, name)) {
        xml_.fail_unknown(e);
      }
    });
  }

  /// What may be in a node besides meshes and nodes.
  static constexpr std::array<std::string_view, 10> kOther = {
      "asset",  "extra",  "instance_camera", "instance_light", "lookat",
      "matrix", "rotate", "scale",           "skew",           "translate"};

  /// The placement that a transform element stands for; nullopt for other elements.
  [[nodiscard]] std::optional<Placement> transform(const XMLElement& e) {
    Placement result;
    if (is_named(e, "translate")) {
      const auto v = numbers<3>(e);
      result.translation = {v[0], v[1], v[2]};
    } else if (is_named(e, "scale")) {
      const auto v = numbers<3>(e);
      result.linear = geom::Vec3(v[0], v[1], v[2]).asDiagonal();
    } else if (is_named(e, "rotate")) {
      const auto v = numbers<4>(e);
      result.linear = rotation({v[0], v[1], v[2]}, v[3] * (std::numbers::pi / 180));
    } else if (is_named(e, "matrix")) {
      const auto v = numbers<16>(e);
      for (int row = 0; row < 3; ++row) {
        const std::size_t first = 4 * static_cast<std::size_t>(row);
        result.linear.row(row) = Eigen::RowVector3d(v[first], v[first + 1], v[first + 2]);
        result.translation[row] = v[first + 3];
      }
      if (v[12] != 0 || v[13] != 0 || v[14] != 0 || v[15] != 1)
        xml_.fail(e, "a matrix that is not affine (its last row is not 0 0 0 1)");
    } else {
      return std::nullopt;
    }
    return result;
  }

  template <std::size_t N>
  [[nodiscard]] std::array<double, N> numbers(const XMLElement& e) {
    const std::string text = xml_.text(e);
    scene_.spend(text);
    std::string_view words = text;
    std::array<double, N> values{};
    for (double& x : values) x = xml_.number(e, next_word(words));
    if (!next_word(words).empty())
      xml_.fail(e, tag(e) + " holds more than " + std::to_string(N) + " numbers");
    return values;
  }

  // --- geometry ---

  void place(const XMLElement& geometry, const Placement& placement) {
    const auto found = surfaces_.find(&geometry);
    const Surface& surface =
        found != surfaces_.end()
            ? found->second
            : surfaces_.emplace(&geometry, read_geometry(geometry)).first->second;
    scene_.add_points(surface.points, placement, xml_.where(geometry));
    std::span<const std::uint32_t> corners = surface.corners;
    for (const Surface::Face& face : surface.faces) {
      scene_.add_face(corners.first(face.corners), face.where);
      corners = corners.subspan(face.corners);
    }
  }

  Surface read_geometry(const XMLElement& geometry) {
    Surface surface;
    bool has_content = false;
    xml_.each(geometry, [&](const XMLElement& e) {
      const std::string_view name = e.Name();
      if (name == "asset" || name == "extra") return;
      if (std::exchange(has_content, true)) xml_.fail(e, "a geometry with two contents");
      if (name == "mesh") {
        read_mesh(e, surface);
      } else if (name == "spline") {
        ++lines_;
      } else if (name == "convex_mesh" || name == "brep") {
        xml_.fail(e, tag(e) + " is not supported; export the scene as meshes");
      } else {
        xml_.fail_unknown(e);
      }
    });
    return surface;
  }

  void read_mesh(const XMLElement& mesh, Surface& surface) {
    const XMLElement* vertices = nullptr;
    xml_.each(mesh, [&](const XMLElement& e) {
      if (!is_named(e, "vertices")) return;
      if (vertices != nullptr) xml_.fail(e, "a mesh with two <vertices>");
      vertices = &e;
    });
    if (vertices == nullptr) xml_.fail(mesh, "a mesh without <vertices>; the file is damaged");
    read_vertices(*vertices, surface.points);
    xml_.each(mesh, [&](const XMLElement& e) {
      const std::string_view name = e.Name();
      if (name == "triangles" || name == "polylist" || name == "polygons" || name == "trifans" ||
          name == "tristrips") {
        read_faces(e, *vertices, surface);
      } else if (name == "lines" || name == "linestrips") {
        ++lines_;
      } else if (name != "source" && name != "vertices" && name != "extra") {
        xml_.fail_unknown(e);
      }
    });
  }

  void read_vertices(const XMLElement& vertices, std::vector<geom::Vec3>& points) {
    const XMLElement* position = nullptr;
    xml_.each(vertices, [&](const XMLElement& e) {
      if (is_named(e, "extra")) return;
      if (!is_named(e, "input")) xml_.fail_unknown(e);
      if (xml_.need(e, "semantic") != "POSITION") return;
      if (position != nullptr) xml_.fail(e, "vertices with two positions");
      position = &e;
    });
    if (position == nullptr) xml_.fail(vertices, "vertices without positions");
    read_points(referred(*position, "source", "source"), points);
  }

  void read_points(const XMLElement& source, std::vector<geom::Vec3>& points) {
    const XMLElement* const technique = source.FirstChildElement("technique_common");
    const XMLElement* const accessor =
        technique != nullptr ? technique->FirstChildElement("accessor") : nullptr;
    if (accessor == nullptr || accessor->NextSiblingElement() != nullptr)
      xml_.fail(source, "positions without one <accessor>; the file is damaged");
    const XMLElement& array = referred(*accessor, "source", "float_array");
    const std::vector<double> values = read_array(array);
    const std::uint64_t count = natural(*accessor, "count", std::nullopt);
    const std::uint64_t stride = natural(*accessor, "stride", 1);
    const std::uint64_t offset = natural(*accessor, "offset", 0);
    const std::array<std::uint64_t, 3> axes = read_params(*accessor, stride);
    // The values are in memory, so none of this overflows.
    if (offset > values.size() ||
        count * std::max<std::uint64_t>(stride, 1) > values.size() - offset)
      xml_.fail(*accessor, "an accessor takes more numbers than there are (" +
                               std::to_string(values.size()) + "); the file is damaged");
    for (std::uint64_t i = 0; i < count; ++i) {
      const std::uint64_t first = offset + i * stride;
      points.emplace_back(values[first + axes[0]], values[first + axes[1]],
                          values[first + axes[2]]);
    }
  }

  /// Places of X, Y and Z among the numbers of a vertex. Unnamed parameters are passed over.
  [[nodiscard]] std::array<std::uint64_t, 3> read_params(const XMLElement& accessor,
                                                         std::uint64_t stride) const {
    std::array<std::optional<std::uint64_t>, 3> axes;
    std::uint64_t number = 0;
    xml_.each(accessor, [&](const XMLElement& e) {
      if (!is_named(e, "param")) xml_.fail_unknown(e);
      constexpr std::array<std::string_view, 3> kNames = {"X", "Y", "Z"};
      for (std::size_t k = 0; k < 3; ++k) {
        if (attribute(e, "name") != kNames[k]) continue;
        if (axes[k]) xml_.fail(e, "positions with two parameters " + in_quotes(kNames[k]));
        axes[k] = number;
      }
      ++number;
    });
    if (!axes[0] || !axes[1] || !axes[2] || number > stride)
      xml_.fail(accessor,
                "positions need the parameters X, Y and Z, no more than the stride; "
                "export again");
    return {*axes[0], *axes[1], *axes[2]};
  }

  [[nodiscard]] std::vector<double> read_array(const XMLElement& array) const {
    const std::string text = xml_.text(array);
    std::string_view words = text;
    std::vector<double> values;
    for (auto word = next_word(words); !word.empty(); word = next_word(words))
      values.push_back(xml_.number(array, word));
    check_count(array, values.size(), "numbers");
    return values;
  }

  /// The count that the file states is the count that is there.
  void check_count(const XMLElement& e, std::uint64_t actual, const std::string& what) const {
    const std::uint64_t stated = natural(e, "count", std::nullopt);
    if (stated != actual)
      xml_.fail(e, tag(e) + " states " + std::to_string(stated) + " " + what + ", but holds " +
                       std::to_string(actual) + "; the file is damaged");
  }

  [[nodiscard]] std::uint64_t natural(const XMLElement& e, const char* name,
                                      std::optional<std::uint64_t> otherwise) const {
    const auto value = attribute(e, name);
    if (!value && otherwise) return *otherwise;
    const std::int64_t number = xml_.integer(e, xml_.need(e, name));
    if (number < 0 || number > 0xFFFFFFFFLL)
      xml_.fail(e, "the number " + in_quotes(*value) + " is out of range; the file is damaged");
    return static_cast<std::uint64_t>(number);
  }

  // --- faces ---

  /// Where the vertex is among the numbers of a corner.
  struct Layout {
    std::uint64_t stride = 0;
    std::optional<std::uint64_t> vertex = {};
  };

  [[nodiscard]] Layout read_inputs(const XMLElement& faces, const XMLElement& vertices) const {
    Layout layout;
    xml_.each(faces, [&](const XMLElement& e) {
      if (!is_named(e, "input")) return;
      const std::uint64_t offset = natural(e, "offset", std::nullopt);
      if (offset > 1000) xml_.fail(e, "an offset out of range; the file is damaged");
      layout.stride = std::max(layout.stride, offset + 1);
      const std::string_view semantic = xml_.need(e, "semantic");
      if (semantic == "POSITION" || (semantic == "VERTEX" && layout.vertex))
        xml_.fail(e, "faces with two positions; export again");
      if (semantic != "VERTEX") return;
      if (&referred(e, "source", "vertices") != &vertices)
        xml_.fail(e, "faces of the vertices of another mesh; the file is damaged");
      layout.vertex = offset;
    });
    return layout;
  }

  void read_faces(const XMLElement& faces, const XMLElement& vertices, Surface& surface) {
    const Layout layout = read_inputs(faces, vertices);
    const std::string_view kind = faces.Name();
    std::vector<std::uint32_t> sizes;  // of polylist
    std::vector<const XMLElement*> lists;
    bool has_sizes = false;
    xml_.each(faces, [&](const XMLElement& e) {
      if (is_named(e, "p")) {
        lists.push_back(&e);
      } else if (is_named(e, "vcount") && kind == "polylist") {
        if (std::exchange(has_sizes, true)) xml_.fail(e, "a second <vcount>");
        sizes = integers(e);
      } else if (is_named(e, "ph")) {
        xml_.fail(e, "polygons with holes are not supported; triangulate before exporting");
      } else if (!is_named(e, "input") && !is_named(e, "extra")) {
        xml_.fail_unknown(e);
      }
    });
    if (!lists.empty() && !layout.vertex) xml_.fail(faces, "faces without vertices");
    if (kind == "triangles" || kind == "polylist") {
      if (lists.size() > 1) xml_.fail(*lists[1], "a second <p>; the file is damaged");
      const std::vector<std::uint32_t> corners =
          lists.empty() ? std::vector<std::uint32_t>{} : corners_of(*lists[0], layout, surface);
      if (kind == "triangles") {
        if (corners.size() % 3 != 0)
          xml_.fail(faces, "triangles of which one is not complete; the file is damaged");
        sizes.assign(corners.size() / 3, 3);
      }
      check_count(faces, sizes.size(), "faces");
      add_faces(lists.empty() ? faces : *lists[0], corners, sizes, surface);
      return;
    }
    check_count(faces, lists.size(), "<p>");
    for (const XMLElement* const list : lists) {
      const std::vector<std::uint32_t> corners = corners_of(*list, layout, surface);
      if (kind == "polygons") {
        const std::array size = {static_cast<std::uint32_t>(corners.size())};
        add_faces(*list, corners, size, surface);
        continue;
      }
      for (std::size_t i = 2; i < corners.size(); ++i) {
        const bool fan = kind == "trifans";
        const std::uint32_t a = corners[fan ? 0 : i - 2], b = corners[i - 1], c = corners[i];
        // Every other triangle of a strip runs backwards.
        const bool turned = !fan && i % 2 == 1;
        const std::array triangle = {turned ? b : a, turned ? a : b, c};
        add_faces(*list, triangle, std::array{3U}, surface);
      }
    }
  }

  void add_faces(const XMLElement& list, std::span<const std::uint32_t> corners,
                 std::span<const std::uint32_t> sizes, Surface& surface) const {
    std::uint64_t sum = 0;
    for (const std::uint32_t size : sizes) sum += size;
    if (sum != corners.size())
      xml_.fail(list, "faces of " + std::to_string(sum) + " corners, but there are " +
                          std::to_string(corners.size()) + "; the file is damaged");
    surface.corners.insert(surface.corners.end(), corners.begin(), corners.end());
    for (const std::uint32_t size : sizes) surface.faces.push_back({size, xml_.where(list)});
  }

  /// The vertices of a <p>, range-checked.
  [[nodiscard]] std::vector<std::uint32_t> corners_of(const XMLElement& list, const Layout& layout,
                                                      const Surface& surface) const {
    const std::vector<std::uint32_t> all = integers(list);
    if (all.size() % layout.stride != 0)
      xml_.fail(list, std::to_string(all.size()) + " numbers for corners of " +
                          std::to_string(layout.stride) + " each; the file is damaged");
    std::vector<std::uint32_t> corners;
    for (std::size_t i = *layout.vertex; i < all.size(); i += layout.stride) {
      if (all[i] >= surface.points.size())
        xml_.fail(list, "a face refers to vertex " + std::to_string(all[i]) + ", but there are " +
                            std::to_string(surface.points.size()) +
                            " (counted from 0); the file is damaged");
      corners.push_back(all[i]);
    }
    return corners;
  }

  [[nodiscard]] std::vector<std::uint32_t> integers(const XMLElement& e) const {
    const std::string text = xml_.text(e);
    std::string_view words = text;
    std::vector<std::uint32_t> values;
    for (auto word = next_word(words); !word.empty(); word = next_word(words)) {
      const std::int64_t value = xml_.integer(e, word);
      if (value < 0 || value > 0xFFFFFFFFLL)
        xml_.fail(e, "the index " + in_quotes(word) + " is out of range; the file is damaged");
      values.push_back(static_cast<std::uint32_t>(value));
    }
    return values;
  }

  void add_notes() {
    scene_.add_notes();
    if (lines_ > 0)
      builder_.note(counted(lines_, "set of lines was", "sets of lines were") + " ignored.");
    if (animated_) builder_.note("Animations were ignored; nodes are where the file places them.");
    if (physics_)
      builder_.note("The file's physics scene was ignored; the visible meshes were read.");
    if (kinematics_)
      builder_.note("The file's kinematics was ignored; nodes are where the file places them.");
    const std::size_t hidden = geometries_.size() - surfaces_.size();
    if (hidden > 0)
      builder_.note(counted(hidden, "geometry that the scene does not show was",
                            "geometries that the scene does not show were") +
                    " left out.");
  }

  MeshBuilder& builder_;
  SceneCopier scene_;
  XmlDocument xml_;
  double metres_ = 1;
  std::map<std::pair<std::string_view, std::string_view>, const XMLElement*> ids_;
  std::set<const XMLElement*> geometries_;
  std::map<const XMLElement*, Surface> surfaces_;
  std::size_t lines_ = 0;
  bool animated_ = false;
  bool physics_ = false;
  bool kinematics_ = false;
};

}  // namespace

ReadResult read_collada(const Source& source) {
  MeshBuilder builder(source);
  ColladaReader(source, builder).read();
  return builder.finish(Format::Collada, false);
}

}  // namespace kaboum::io
