// 3MF: the core specification (meshes, components, build) and the production extension, by which
// objects lie in several model files of the package. Other extensions are refused where they can
// hold geometry.

#include <kaboum/base/error.h>

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <set>
#include <utility>

#include "builder.h"
#include "formats.h"
#include "package.h"
#include "scene_copier.h"
#include "xml.h"

namespace kaboum::io {
namespace {

using tinyxml2::XMLElement;

constexpr int kMaxDepth = 256;

constexpr std::string_view kModelRelationship =
    "http://schemas.microsoft.com/3dmanufacturing/2013/01/3dmodel";
constexpr std::string_view kCore = "http://schemas.microsoft.com/3dmanufacturing/core/2015/02";
constexpr std::string_view kProduction =
    "http://schemas.microsoft.com/3dmanufacturing/production/2015/06";
constexpr std::string_view kMaterial =
    "http://schemas.microsoft.com/3dmanufacturing/material/2015/02";
constexpr std::string_view kTriangleSets =
    "http://schemas.microsoft.com/3dmanufacturing/trianglesets/2021/07";
/// In metres.
constexpr std::array<std::pair<std::string_view, double>, 6> kUnits = {{{"micron", 1e-6},
                                                                        {"millimeter", 1e-3},
                                                                        {"centimeter", 1e-2},
                                                                        {"inch", 0.0254},
                                                                        {"foot", 0.3048},
                                                                        {"meter", 1}}};

/// A namespace without what those of all extensions begin with.
std::string_view short_name(std::string_view space) {
  constexpr std::string_view kCommon = "http://schemas.microsoft.com/3dmanufacturing/";
  if (space.starts_with(kCommon)) space.remove_prefix(kCommon.size());
  return space;
}

/// A model file of the package.
struct Part {
  Part(std::string bytes, const std::string& name) : text(std::move(bytes)), xml(text, name) {}

  std::string text;
  XmlDocument xml;
  std::map<std::int64_t, const XMLElement*> objects = {};
  const XMLElement* build = nullptr;
  bool root = false;
};

class ThreeMfReader {
 public:
  ThreeMfReader(const Source& source, MeshBuilder& builder)
      : source_(source), builder_(builder), scene_(builder), package_(source) {}

  void read() {
    const std::string name = package_.target(kModelRelationship);
    root_key_ = Package::key(name);
    const Part& root = part(name);
    if (root.build == nullptr)
      root.xml.fail(root.xml.root(), "no <build>: nothing is to be made; export with geometry");
    check_attributes(root, *root.build);
    root.xml.each(*root.build, [&](const XMLElement& item) {
      if (qualified(item) != QualifiedName{kCore, "item"}) root.xml.fail_unknown(item);
      place(root, item, {}, 0);
    });
    add_notes();
  }

 private:
  // --- parts ---

  Part& part(std::string_view name) {
    const std::string key = Package::key(name);
    const auto found = parts_.find(key);
    if (found != parts_.end()) return *found->second;
    auto loaded = std::make_unique<Part>(package_.read(name),
                                         std::string(source_.name) + ": " + std::string(name));
    loaded->root = key == root_key_;
    read_model(*loaded);
    return *parts_.emplace(key, std::move(loaded)).first->second;
  }

  void read_model(Part& part) {
    const XMLElement& model = part.xml.root();
    if (qualified(model) != QualifiedName{kCore, "model"})
      part.xml.fail(model, "no 3MF model of the namespace " + std::string(kCore));
    check_extensions(part);
    read_unit(part);
    bool resources = false;
    part.xml.each(model, [&](const XMLElement& e) {
      const QualifiedName name = qualified(e);
      if (name == QualifiedName{kCore, "resources"}) {
        if (std::exchange(resources, true)) part.xml.fail(e, "a second <resources>");
        read_resources(part, e);
      } else if (name == QualifiedName{kCore, "build"}) {
        if (part.build != nullptr) part.xml.fail(e, "a second <build>");
        part.build = &e;
      } else if (name != QualifiedName{kCore, "metadata"}) {
        part.xml.fail_unknown(e);
      }
    });
  }

  void check_extensions(const Part& part) {
    const XMLElement& model = part.xml.root();
    std::string_view required = attribute(model, "requiredextensions").value_or("");
    for (auto prefix = next_word(required); !prefix.empty(); prefix = next_word(required)) {
      const auto space = namespace_of(model, prefix);
      if (space && is_harmless(*space)) continue;
      part.xml.fail(model, "the required extension " +
                               in_quotes(space ? short_name(*space) : prefix) +
                               " is not supported; export the model as plain meshes");
    }
  }

  void read_unit(const Part& part) {
    const XMLElement& model = part.xml.root();
    const std::string_view unit = attribute(model, "unit").value_or("millimeter");
    const auto* const known =
        std::ranges::find(kUnits, unit, &std::pair<std::string_view, double>::first);
    if (known == kUnits.end()) part.xml.fail(model, "unknown unit " + in_quotes(unit));
    builder_.set_unit(known->second);
    if (unit_.empty()) unit_ = unit;
    if (unit != unit_)
      part.xml.fail(model, "the unit " + in_quotes(unit) + " is not that of the package, " +
                               in_quotes(unit_) + "; export with one unit");
  }

  /// Extensions of which neither elements nor attributes hold geometry (production's `path` apart).
  static bool is_harmless(std::string_view space) {
    return space == kCore || space == kProduction || space == kMaterial || space == kTriangleSets;
  }

  void read_resources(Part& part, const XMLElement& resources) {
    part.xml.each(resources, [&](const XMLElement& e) {
      const QualifiedName name = qualified(e);
      if (name == QualifiedName{kCore, "object"}) {
        const std::int64_t id = part.xml.integer(e, part.xml.need(e, "id"));
        if (!part.objects.emplace(id, &e).second)
          part.xml.fail(e, "a second object " + std::to_string(id) + "; the file is damaged");
      } else if (name != QualifiedName{kCore, "basematerials"} && name.space != kMaterial) {
        part.xml.fail_unknown(e);
      }
    });
  }

  /// Attributes of namespaces that are not known might say where geometry is.
  static void check_attributes(const Part& part, const XMLElement& e) {
    for (const auto* a = e.FirstAttribute(); a != nullptr; a = a->Next()) {
      const std::string_view plain = a->Name();
      if (plain == "xmlns" || plain.starts_with("xmlns:") || plain.starts_with("xml:")) continue;
      const QualifiedName name = qualified(e, *a);
      if (!name.space.empty() && !is_harmless(name.space))
        part.xml.fail(e, "the attribute " + in_quotes(plain) +
                             " is of an extension that might hold geometry; export without it");
    }
  }

  // --- objects ---

  /// An <item> of the build or a <component>.
  void place(const Part& part, const XMLElement& e, const Placement& outer, int depth) {
    if (depth > kMaxDepth)
      part.xml.fail(e, "components are nested more than " + std::to_string(kMaxDepth) +
                           " deep; does an object hold itself?");
    scene_.visit();
    check_attributes(part, e);
    const Part* home = &part;
    for (const auto* a = e.FirstAttribute(); a != nullptr; a = a->Next()) {
      if (qualified(e, *a) != QualifiedName{kProduction, "path"}) continue;
      if (!part.root)
        part.xml.fail(e, "a path in a model file that is not the package's first; export again");
      home = &this->part(a->Value());
    }
    const std::int64_t id = part.xml.integer(e, part.xml.need(e, "objectid"));
    const auto found = home->objects.find(id);
    if (found == home->objects.end())
      part.xml.fail(e, "there is no object " + std::to_string(id) + "; the file is damaged");
    read_object(*home, *found->second, outer * transform(part, e), depth);
  }

  /// Row vectors times the matrix: the first nine numbers are the transposed linear part.
  Placement transform(const Part& part, const XMLElement& e) {
    Placement result;
    const auto value = attribute(e, "transform");
    if (!value) return result;
    std::string_view words = *value;
    scene_.spend(words);
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 3; ++column) {
        const std::string_view word = next_word(words);
        if (word.empty()) part.xml.fail(e, "a transform has fewer than 12 numbers");
        const double x = part.xml.number(e, word);
        (row < 3 ? result.linear(column, row) : result.translation[column]) = x;
      }
    }
    if (!next_word(words).empty()) part.xml.fail(e, "a transform has more than 12 numbers");
    return result;
  }

  void read_object(const Part& part, const XMLElement& object, const Placement& placement,
                   int depth) {
    check_attributes(part, object);
    check_type(part, object);
    const bool first = shown_.insert(&object).second;
    const XMLElement* content = nullptr;
    part.xml.each(object, [&](const XMLElement& e) {
      scene_.visit();
      const QualifiedName name = qualified(e);
      if (name == QualifiedName{kCore, "mesh"} || name == QualifiedName{kCore, "components"}) {
        if (content != nullptr) part.xml.fail(e, "an object has more than one mesh");
        content = &e;
      } else if (name != QualifiedName{kCore, "metadatagroup"}) {
        part.xml.fail_unknown(e);
      }
    });
    if (content == nullptr) part.xml.fail(object, "an object has no mesh; the file is damaged");
    check_attributes(part, *content);
    if (qualified(*content).local == "mesh") {
      read_mesh(part, *content, placement, first);
      return;
    }
    part.xml.each(*content, [&](const XMLElement& e) {
      if (qualified(e) != QualifiedName{kCore, "component"}) part.xml.fail_unknown(e);
      place(part, e, placement, depth + 1);
    });
  }

  void check_type(const Part& part, const XMLElement& object) {
    const std::string_view type = attribute(object, "type").value_or("model");
    if (type == "support" || type == "solidsupport") {
      supports_.insert(&object);
    } else if (type == "other") {
      part.xml.fail(object,
                    "an object of type 'other' (a modifier or the like) is among those to be made; "
                    "delete it or export the model as plain meshes");
    } else if (type != "model" && type != "surface") {
      part.xml.fail(object, "unknown type of object " + in_quotes(type));
    }
  }

  void read_mesh(const Part& part, const XMLElement& mesh, const Placement& placement, bool first) {
    const XMLElement* vertices = nullptr;
    const XMLElement* triangles = nullptr;
    part.xml.each(mesh, [&](const XMLElement& e) {
      scene_.visit();
      const QualifiedName name = qualified(e);
      const bool is_vertices = name == QualifiedName{kCore, "vertices"};
      if (is_vertices || name == QualifiedName{kCore, "triangles"}) {
        const XMLElement*& list = is_vertices ? vertices : triangles;
        if (list != nullptr) part.xml.fail(e, "a mesh has two lists of one kind");
        list = &e;
      } else if (name.space != kTriangleSets) {
        part.xml.fail_unknown(e);
      }
    });
    if (vertices == nullptr || triangles == nullptr)
      part.xml.fail(mesh, "a mesh without vertices or triangles; the file is damaged");
    points_.clear();
    part.xml.each(*vertices, [&](const XMLElement& e) {
      if (qualified(e) != QualifiedName{kCore, "vertex"}) part.xml.fail_unknown(e);
      if (first) check_attributes(part, e);
      const auto coordinate = [&](const char* name) {
        return part.xml.number(e, part.xml.need(e, name));
      };
      points_.emplace_back(coordinate("x"), coordinate("y"), coordinate("z"));
    });
    scene_.add_points(points_, placement, source_.begin());
    part.xml.each(*triangles, [&](const XMLElement& e) {
      if (qualified(e) != QualifiedName{kCore, "triangle"}) part.xml.fail_unknown(e);
      std::array<std::uint32_t, 3> corners{};
      for (std::size_t k = 0; k < 3; ++k) {
        constexpr std::array<const char*, 3> kCorners = {"v1", "v2", "v3"};
        const std::int64_t i = part.xml.integer(e, part.xml.need(e, kCorners[k]));
        if (i < 0 || static_cast<std::uint64_t>(i) >= points_.size())
          part.xml.fail(e, "a triangle refers to vertex " + std::to_string(i) + ", but there are " +
                               std::to_string(points_.size()) +
                               " (counted from 0); the file is damaged");
        corners[k] = static_cast<std::uint32_t>(i);
      }
      scene_.add_face(corners, source_.begin());
    });
  }

  void add_notes() {
    scene_.add_notes();
    builder_.note("Coordinates are in the 3MF file's own unit (" + std::string(unit_) +
                  "); they were not scaled.");
    if (!supports_.empty())
      builder_.note(counted(supports_.size(), "support structure", "support structures") +
                    " of the build " + (supports_.size() == 1 ? "was" : "were") + " read as well.");
    std::size_t hidden = 0;
    for (const auto& [key, loaded] : parts_)
      for (const auto& [id, object] : loaded->objects) hidden += shown_.contains(object) ? 0 : 1;
    if (hidden > 0)
      builder_.note(counted(hidden, "object", "objects") + " that the build does not show " +
                    (hidden == 1 ? "was" : "were") + " left out.");
    std::size_t unused = 0;
    for (const std::string& name : package_.parts())
      unused += name.ends_with(".model") && !parts_.contains(name) ? 1 : 0;
    if (unused > 0)
      builder_.note(counted(unused, "model file", "model files") +
                    " of the package that the build does not show " +
                    (unused == 1 ? "was" : "were") + " left out.");
  }

  const Source& source_;
  MeshBuilder& builder_;
  SceneCopier scene_;
  Package package_;
  std::string root_key_;
  std::string_view unit_;  ///< of the root's text
  std::map<std::string, std::unique_ptr<Part>> parts_;
  std::set<const XMLElement*> shown_;
  std::set<const XMLElement*> supports_;
  std::vector<geom::Vec3> points_;
};

}  // namespace

ReadResult read_three_mf(Source source) {
  source.text = false;
  MeshBuilder builder(source);
  ThreeMfReader(source, builder).read();
  return builder.finish(Format::ThreeMf, false);
}

}  // namespace kaboum::io
