// COLLADA 1.4 and 1.5: the meshes that the scene shows, placed by its nodes, in double precision.
// Every element on the way from the scene to a triangle is known, or the file is refused.

#include <array>
#include <map>
#include <numbers>
#include <optional>

#include "builder.h"
#include "collada_document.h"
#include "collada_geometry.h"
#include "formats.h"
#include "names.h"
#include "scene_copier.h"

namespace kaboum::io {
namespace {

using tinyxml2::XMLElement;

constexpr int kMaxDepth = 256;

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
constexpr std::array<std::string_view, 5> kVersions = {"1.4", "1.4.0", "1.4.1", "1.5", "1.5.0"};

class ColladaReader {
 public:
  ColladaReader(const Source& source, MeshBuilder& builder)
      : builder_(builder), scene_(builder), xml_(source), geometry_(xml_) {}

  void read() {
    const XMLElement& root = xml_.root();
    const std::string_view version = attribute(root, "version").value_or("");
    if (!is_named(root, "COLLADA") || !contains(kVersions, version))
      xml_.fail(root, "no COLLADA document of version 1.4 or 1.5");
    const XMLElement* scene = nullptr;
    xml_.each(root, [&](const XMLElement& e) {
      if (is_named(e, "scene")) {
        if (scene != nullptr) xml_.fail(e, "a second <scene>");
        scene = &e;
      } else if (is_named(e, "library_animations")) {
        animated_ = true;
      } else if (is_named(e, "extra")) {
        xml_.check_extra(e);
      } else if (!is_named(e, "asset") && !contains(kLibraries, e.Name())) {
        xml_.fail_unknown(e);
      }
    });
    read_asset(root);
    builder_.set_unit(1);  // what was scaled
    xml_.index(metres_);
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
      metres_ = xml_.metres_of(*unit);
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
      } else if (is_named(e, "extra")) {
        xml_.check_extra(e);
      } else {
        xml_.fail_unknown(e);
      }
    });
    if (shown == nullptr) xml_.fail(scene, "no visual scene is shown; export with geometry");
    Placement placement;
    if (metres_ != 1) placement.linear *= metres_;
    xml_.each(xml_.referred(*shown, "url", "visual_scene"), [&](const XMLElement& e) {
      if (is_named(e, "node")) {
        read_node(e, placement, nullptr, 0);
      } else if (is_named(e, "extra")) {
        xml_.check_extra(e);
      } else if (!is_named(e, "asset") && !is_named(e, "evaluate_scene")) {
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
        read_node(xml_.referred(e, "url", "node"), placement, obstacle, depth + 1);
      } else if (name == "instance_geometry") {
        if (obstacle != nullptr)
          xml_.fail(*obstacle, tag(*obstacle) +
                                   " moves meshes and is not supported; apply transforms before "
                                   "exporting");
        check_instance(e);
        place(xml_.referred(e, "url", "geometry"), placement);
      } else if (name == "instance_controller") {
        xml_.fail(e,
                  "a skinned or morphed mesh is not supported; apply its deformation before "
                  "exporting");
      } else if (name == "extra") {
        xml_.check_extra(e);
      } else if (!contains(kOther, name)) {
        xml_.fail_unknown(e);
      }
    });
  }

  void check_instance(const XMLElement& instance) const {
    xml_.each(instance, [&](const XMLElement& e) {
      if (is_named(e, "extra")) {
        xml_.check_extra(e);
      } else if (!is_named(e, "bind_material")) {
        xml_.fail_unknown(e);
      }
    });
  }

  /// What may be in a node besides meshes and nodes.
  static constexpr std::array<std::string_view, 9> kOther = {
      "asset",  "instance_camera", "instance_light", "lookat",   "matrix",
      "rotate", "scale",           "skew",           "translate"};

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
    const ColladaSurface& surface =
        found != surfaces_.end()
            ? found->second
            : surfaces_.emplace(&geometry, geometry_.read(geometry)).first->second;
    scene_.add_points(surface.points, placement, xml_.where(geometry));
    std::span<const std::uint32_t> corners = surface.corners;
    for (const ColladaSurface::Face& face : surface.faces) {
      scene_.add_face(corners.first(face.corners), face.where);
      corners = corners.subspan(face.corners);
    }
  }

  void add_notes() {
    scene_.add_notes();
    if (geometry_.lines() > 0)
      builder_.note(counted(geometry_.lines(), "set of lines was", "sets of lines were") +
                    " ignored.");
    if (animated_) builder_.note("Animations were ignored; nodes are where the file places them.");
    if (physics_)
      builder_.note("The file's physics scene was ignored; the visible meshes were read.");
    if (kinematics_)
      builder_.note("The file's kinematics was ignored; nodes are where the file places them.");
    const std::size_t hidden = xml_.geometry_count() - surfaces_.size();
    if (hidden > 0)
      builder_.note(counted(hidden, "geometry that the scene does not show was",
                            "geometries that the scene does not show were") +
                    " left out.");
  }

  MeshBuilder& builder_;
  SceneCopier scene_;
  ColladaDocument xml_;
  ColladaGeometry geometry_;
  double metres_ = 1;
  std::map<const XMLElement*, ColladaSurface> surfaces_;
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
