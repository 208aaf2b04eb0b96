#pragma once

#include <kaboum/io/mesh_io.h>

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "source.h"
#include "xml.h"

// The scenes of VRML 97 and X3D as trees. The two differ in syntax (vrml.cpp, x3d.cpp) and share
// what nodes mean (scene_graph.cpp). Internal to kaboum_io.
namespace kaboum::io {

struct SceneNode;

/// A field of a node: values as text, or nodes.
struct SceneField {
  std::string_view name;
  std::string_view text = {};  ///< without the brackets around it
  std::vector<const SceneNode*> nodes = {};
  const char* where = nullptr;  ///< in the file
};

struct SceneNode {
  std::string_view type;
  const char* where;  ///< in the file
  std::vector<SceneField> fields = {};

  /// The field of that name, made when there is none.
  SceneField& field(std::string_view name, const char* place);
};

/// A file's nodes. USE refers to the node that DEF named, so that a node may have several parents,
/// or be among its own descendants.
struct SceneFile {
  explicit SceneFile(const Source& s) : source(s) {}

  const Source& source;
  std::unique_ptr<XmlDocument> xml = {};  ///< holds the texts of X3D
  std::deque<SceneNode> nodes = {};
  std::vector<const SceneNode*> roots = {};
  std::optional<double> metres = {};  ///< the unit of length that the file states
  bool routed = false;                ///< events are sent between nodes
  bool siblings_move = false;  ///< Rotation and Translation move what follows, as in Open Inventor
};

constexpr std::size_t kMaxSceneDepth = 256;
constexpr std::size_t kMaxSceneFields = 256;  ///< of one node; looked through one by one

/// Parses VRML 97 into `file`.
void parse_vrml(SceneFile& file);
/// Parses X3D in XML into `file`.
void parse_x3d(SceneFile& file);

}  // namespace kaboum::io
