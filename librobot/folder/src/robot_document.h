#pragma once

#include <kaboum/robot_folder/new_shapes.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace kaboum::robot_folder {

/// How new meshes are named in a robot's document.
struct MeshNames {
  std::string prefix;           ///< put before them
  bool declare_convex = false;  ///< for Drake, which takes them for convex then
};

/// A copy of a robot's file, in its own format, in which bodies stand for the links' shapes.
/// Everything else stays; names of files relative to the robot's become relative to the new folder.
class RobotDocument {
 public:
  RobotDocument() = default;
  RobotDocument(const RobotDocument&) = delete;
  RobotDocument& operator=(const RobotDocument&) = delete;
  virtual ~RobotDocument() = default;

  /// Stems of the names of all meshes.
  [[nodiscard]] virtual std::vector<std::string> mesh_stems() const = 0;

  /// @throws Error{InvalidInput} when a link has another number of shapes here.
  virtual void require_shapes(const std::string& link, bool visual, std::size_t shapes) = 0;

  /// A mesh without a file (ShapeEdit::left_out). @param mesh  as Geometry::mesh
  virtual void leave_out(const std::string& /*mesh*/) {}

  /// The copy's text, the last thing to be asked for.
  /// @param visual  whether the new shapes stand for the shapes for drawing
  virtual std::string text(const NewShapes& shapes, bool visual, const MeshNames& names) = 0;

  /// For the user, on the copy; none before its text was asked for.
  [[nodiscard]] virtual std::vector<std::string> notes() const { return {}; }
};

/// @param folder  that the copy will be in
/// @throws Error{InvalidInput} for formats that no robot is written in.
std::unique_ptr<RobotDocument> document_of(const robot::RobotFile& robot,
                                           const std::filesystem::path& folder);

}  // namespace kaboum::robot_folder
