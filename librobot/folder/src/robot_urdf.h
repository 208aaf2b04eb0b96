#pragma once

#include <kaboum/robot/robot_file.h>
#include <kaboum/robot_folder/new_shapes.h>
#include <tinyxml2.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::robot_folder {

/// How new meshes are named in a URDF.
struct MeshNames {
  std::string prefix;           ///< put before them
  bool declare_convex = false;  ///< for Drake, which takes them for convex then
};

/// A copy of a robot's URDF in which bodies stand for the links' shapes. Everything else stays;
/// names of files relative to the robot's become relative to the new folder.
class RobotUrdf {
 public:
  /// @param folder  that the copy will be in
  /// @throws Error{InvalidInput} when the file is no URDF.
  RobotUrdf(const robot::RobotFile& robot, std::filesystem::path folder);

  /// Stems of the names of all meshes.
  [[nodiscard]] std::vector<std::string> mesh_stems() const;

  /// @throws Error{InvalidInput} when a link has another number of shapes here.
  void require_shapes(const std::string& link, bool visual, std::size_t shapes);

  /// Makes the <collision> elements of a link the bodies, each with the pose and scale of the shape
  /// that it stands for, so that the inclusion holds without rounding.
  /// @param visual  whether they stand for the shapes for drawing
  void replace(const std::string& link, bool visual, const std::vector<NewShape>& shapes,
               const MeshNames& names);
  /// Keeps the <collision> elements of a link.
  void keep(const std::string& link);

  /// The original's text.
  [[nodiscard]] std::string_view original() const { return text_; }

  /// The copy's text, the last thing to be asked for.
  std::string text();

 private:
  using Element = tinyxml2::XMLElement;
  Element* element_of(const std::string& link);
  Element* collision(const Element* original, const std::string& link, std::size_t number);
  void move_references(Element* element);

  std::string file_;
  std::filesystem::path from_, folder_;
  std::string text_;
  tinyxml2::XMLDocument document_;
};

}  // namespace kaboum::robot_folder
