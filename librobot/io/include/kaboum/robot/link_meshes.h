#pragma once

#include <kaboum/robot/robot_file.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::robot {

/// Choice of the shapes of a robot's links that are meant.
struct ShapeChoice {
  std::vector<std::string> links;     ///< only these; empty: all that have a shape
  bool visual = false;                ///< shapes for drawing instead of those for collisions
  std::vector<std::string> packages;  ///< folders that package:// URIs are looked up in
  /// Shapes whose mesh files are missing are left out, and nothing is claimed of their links; else
  /// they refuse the robot.
  bool skip_missing = false;

  [[nodiscard]] bool has(const Link& link) const;
  /// @throws Error{InvalidInput} where one more is meant that could not be read (UnreadShape)
  [[nodiscard]] const std::vector<Geometry>& shapes_of(const Link& link) const;
};

/// A mesh at one scale.
struct LinkMesh {
  std::filesystem::path file;   ///< as it was found first
  std::filesystem::path place;  ///< where links in its name lead to
  Vec3 scale = Vec3::Ones();    ///< from the mesh's unit to the robot's, positive
  /// Why there is no such file (ShapeChoice::skip_missing), naming it with its place; `file` is
  /// then its name in the robot's file. Else empty.
  std::string missing = {};
};

/// One of the shapes that are meant.
struct LinkShape {
  std::uint32_t link = 0;
  std::size_t index = 0;            ///< among the link's shapes of the kind
  std::optional<std::size_t> mesh;  ///< index in LinkMeshes::meshes; none: a box, cylinder, sphere
};

struct LinkMeshes {
  std::vector<LinkMesh> meshes;  ///< each file once for every scale, mirrored or not
  std::vector<LinkShape> shapes;
  std::vector<std::filesystem::path> files;  ///< under all their names
};

/// The shapes of a robot's links, in their order, and the files of their meshes.
/// @throws Error{InvalidArgument} naming a link that the robot does not have; Error{InvalidInput}
///   naming all meshes whose files are missing, each with its place, unless they are skipped.
LinkMeshes link_meshes(const RobotFile& robot, const ShapeChoice& choice);

/// A mesh whose file is missing.
struct MissingMesh {
  std::string reference;           ///< as the robot's file states it
  int line = 0;                    ///< where it does so first; 0: not known
  std::vector<std::string> links;  ///< that have it
  std::string why;                 ///< as FoundMesh::why
};

/// Those of the shapes that are meant, in order.
/// @throws Error{InvalidArgument} naming a link that the robot does not have
std::vector<MissingMesh> missing_meshes(const RobotFile& robot, const ShapeChoice& choice);

/// An error's message that names them all. @pre there is one
std::string in_words(const RobotFile& robot, const std::vector<MissingMesh>& missing);

/// @throws Error{InvalidInput} naming them all, where there are some.
void require_meshes(const RobotFile& robot, const ShapeChoice& choice);

}  // namespace kaboum::robot
