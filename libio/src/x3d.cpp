// X3D (ISO/IEC 19775) in XML (ISO/IEC 19776-1): elements become the nodes of a scene.

#include <algorithm>
#include <array>
#include <map>
#include <utility>

#include "scene_graph.h"
#include "text.h"

namespace kaboum::io {
namespace {

using tinyxml2::XMLElement;

template <std::size_t N>
bool contains(const std::array<std::string_view, N>& names, std::string_view name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Attributes that are no fields.
constexpr std::array<std::string_view, 6> kNoFields = {"DEF",   "USE", "containerField",
                                                       "class", "id",  "style"};
/// Elements with program text.
constexpr std::array<std::string_view, 5> kPrograms = {"ComposedShader", "PackagedShader", "Script",
                                                       "ShaderPart", "ShaderProgram"};

/// The field that a node belongs to when its element does not say (ISO/IEC 19776-1, table 6.x).
std::string_view default_field(std::string_view type) {
  constexpr std::array<std::string_view, 9> kSurfaces = {
      "IndexedFaceSet",          "IndexedQuadSet", "IndexedTriangleFanSet", "IndexedTriangleSet",
      "IndexedTriangleStripSet", "QuadSet",        "TriangleFanSet",        "TriangleSet",
      "TriangleStripSet"};
  constexpr std::array<std::string_view, 3> kVertexAttributes = {
      "FloatVertexAttribute", "Matrix3VertexAttribute", "Matrix4VertexAttribute"};
  constexpr std::array<std::string_view, 5> kTextureCoordinates = {
      "MultiTextureCoordinate", "TextureCoordinate", "TextureCoordinate3D", "TextureCoordinate4D",
      "TextureCoordinateGenerator"};
  constexpr std::array<std::string_view, 6> kMetadata = {"MetadataBoolean", "MetadataDouble",
                                                         "MetadataFloat",   "MetadataInteger",
                                                         "MetadataSet",     "MetadataString"};
  constexpr std::array<std::string_view, 21> kOtherGeometry = {"Arc2D",
                                                               "ArcClose2D",
                                                               "Box",
                                                               "Circle2D",
                                                               "Cone",
                                                               "Cylinder",
                                                               "Disk2D",
                                                               "ElevationGrid",
                                                               "Extrusion",
                                                               "GeoElevationGrid",
                                                               "IndexedLineSet",
                                                               "LineSet",
                                                               "NurbsCurve",
                                                               "NurbsPatchSurface",
                                                               "PointSet",
                                                               "Polyline2D",
                                                               "Polypoint2D",
                                                               "Rectangle2D",
                                                               "Sphere",
                                                               "Text",
                                                               "TriangleSet2D"};
  if (contains(kSurfaces, type) || contains(kOtherGeometry, type)) return "geometry";
  if (type == "Appearance") return "appearance";
  if (type == "Coordinate" || type == "CoordinateDouble") return "coord";
  if (type == "Normal") return "normal";
  if (type == "Color" || type == "ColorRGBA") return "color";
  if (type == "FogCoordinate") return "fogCoord";
  if (contains(kVertexAttributes, type)) return "attrib";
  if (contains(kTextureCoordinates, type)) return "texCoord";
  if (contains(kMetadata, type)) return "metadata";
  return "children";
}

class X3dParser {
 public:
  explicit X3dParser(SceneFile& file) : file_(file), xml_(*file.xml) {}

  void read() {
    if (!is_named(xml_.root(), "X3D"))
      xml_.fail(xml_.root(), "no X3D: the first element is " + tag(xml_.root()));
    bool has_scene = false;
    xml_.each(xml_.root(), [&](const XMLElement& e) {
      if (is_named(e, "head")) {
        for (const XMLElement* u = e.FirstChildElement("unit"); u != nullptr;
             u = u->NextSiblingElement("unit"))
          read_unit(*u);
      } else if (is_named(e, "Scene")) {
        if (std::exchange(has_scene, true)) xml_.fail(e, "a second <Scene>");
        xml_.each(e, [&](const XMLElement& child) {
          if (const SceneNode* const node = read_node(child)) file_.roots.push_back(node);
        });
      } else {
        xml_.fail_unknown(e);
      }
    });
  }

 private:
  void read_unit(const XMLElement& e) {
    const std::string_view category = xml_.need(e, "category");
    const double factor = xml_.number(e, xml_.need(e, "conversionFactor"));
    if (category == "length") {
      if (!(factor > 0)) xml_.fail(e, "a unit of " + shortest_digits(factor) + " metres");
      file_.metres = factor;
    } else if (category == "angle" && factor != 1) {
      xml_.fail(e, "angles in another unit than radians are not supported; export in radians");
    }
  }

  /// nullptr for statements that are no nodes.
  const SceneNode* read_node(const XMLElement& e) {
    const std::string_view type = e.Name();
    if (type == "ROUTE") file_.routed = true;
    if (type == "ROUTE" || type == "IMPORT" || type == "EXPORT") return nullptr;
    if (type == "ProtoDeclare" || type == "ExternProtoDeclare" || type == "ProtoInstance")
      xml_.fail(e, tag(e) + " is not supported; export the scene without prototypes");
    const auto use = attribute(e, "USE");
    if (use) return &used(e, *use);
    SceneNode& node = file_.nodes.emplace_back(SceneNode{type, xml_.where(e)});
    if (const auto name = attribute(e, "DEF")) defined_[*name] = &node;
    for (const auto* a = e.FirstAttribute(); a != nullptr; a = a->Next()) {
      const std::string_view name = a->Name();
      if (contains(kNoFields, name) || name == "xmlns" || name.starts_with("xmlns:")) continue;
      node.field(name, node.where).text = a->Value();
    }
    const auto read_child = [&](const XMLElement& child) {
      const SceneNode* const inner = read_node(child);
      if (inner == nullptr) return;
      const auto stated = attribute(child, "containerField");
      SceneField& field = node.field(
          stated && !stated->empty() ? *stated : default_field(inner->type), inner->where);
      if (node.fields.size() > kMaxSceneFields)
        xml_.fail(child, "a node with too many fields; the file is damaged");
      if (!field.text.empty())
        xml_.fail(child, "the field " + in_quotes(field.name) + " is given twice");
      field.nodes.push_back(inner);
    };
    if (contains(kPrograms, type)) {
      for (const XMLElement* c = e.FirstChildElement(); c != nullptr; c = c->NextSiblingElement())
        read_child(*c);
    } else {
      xml_.each(e, read_child);
    }
    return &node;
  }

  const SceneNode& used(const XMLElement& e, std::string_view name) {
    const auto found = defined_.find(name);
    if (found == defined_.end())
      xml_.fail(e, "USE " + in_quotes(name) + " without a DEF before; the file is damaged");
    if (found->second->type != std::string_view(e.Name()) || attribute(e, "DEF") ||
        e.FirstChildElement() != nullptr)
      xml_.fail(e, "USE " + in_quotes(name) + " is not of the node that DEF names");
    return *found->second;
  }

  SceneFile& file_;
  const XmlDocument& xml_;
  std::map<std::string_view, SceneNode*> defined_;
};

}  // namespace

void parse_x3d(SceneFile& file) {
  if (file.source.bytes.starts_with("#X3D"))
    fail(file.source, "X3D in classic encoding is not supported; convert the file to X3D in XML");
  if (file.source.bytes.starts_with("#VRML"))
    fail(file.source, "this is VRML, not X3D; name the file .wrl");
  if (file.source.bytes.starts_with(std::string_view("\xE0\0\0\1", 4)))
    fail(file.source, "binary X3D is not supported; convert the file to X3D in XML");
  file.xml = std::make_unique<XmlDocument>(file.source.bytes, std::string(file.source.name));
  X3dParser(file).read();
}

}  // namespace kaboum::io
