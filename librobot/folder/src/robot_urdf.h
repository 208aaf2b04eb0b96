#pragma once

#include <kaboum/robot/robot_file.h>
#include <kaboum/robot_folder/new_shapes.h>
#include <tinyxml2.h>

#include <cstddef>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "robot_document.h"

namespace kaboum::robot_folder {

/// A copy of a robot's URDF in which bodies stand for the links' shapes.
class RobotUrdf : public RobotDocument {
 public:
  /// @param folder  that the copy will be in
  /// @throws Error{InvalidInput} when the file is no URDF.
  RobotUrdf(const robot::RobotFile& robot, std::filesystem::path folder);

  [[nodiscard]] std::vector<std::string> mesh_stems() const override;
  void require_shapes(const std::string& link, bool visual, std::size_t shapes) override;
  std::string text(const NewShapes& shapes, bool visual, const MeshNames& names) override;
  [[nodiscard]] std::vector<std::string> notes() const override { return notes_; }

 private:
  using Element = tinyxml2::XMLElement;
  /// Makes the <collision> elements of a link the bodies, each with the pose and scale of the shape
  /// that it stands for, so that the inclusion holds without rounding.
  /// @param visual  whether they stand for the shapes for drawing
  void replace(const std::string& link, bool visual, const std::vector<NewShape>& shapes,
               const MeshNames& names);
  /// Keeps the <collision> elements of a link.
  void keep(const std::string& link);

  /// States the link `world` that joints may begin at without it (robot::parse_urdf).
  void state_world();
  Element* element_of(const std::string& link);
  Element* collision(const Element* original, const std::string& link, std::size_t number);
  void move_references(Element* element);

  const robot::Robot& robot_;
  std::string file_;
  std::filesystem::path from_, folder_;
  std::string text_;
  std::vector<std::string> notes_;
  tinyxml2::XMLDocument document_;
};

}  // namespace kaboum::robot_folder
