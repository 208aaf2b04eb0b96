#pragma once

#include <kaboum/robot/link_meshes.h>
#include <kaboum/robot/model_text.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

/// The replacements of the shapes of a robot's links in new files.
namespace kaboum::robot_folder {

/// The replacement of a shape of a link.
struct NewShape {
  /// Names of its meshes' files, relative to the new robot's; none: the shape itself, a box,
  /// cylinder or sphere, or a mesh that nothing could be made of. An empty list: it is left out.
  std::optional<std::vector<std::string>> meshes;
  std::size_t first = 0;  ///< number in the names of its <collision> elements, and on
};

/// By link; links without stay as they are.
using NewShapes = std::vector<std::vector<NewShape>>;

/// A link of which all shapes for drawing are left out stays as it is, where what collided has its
/// files.
/// @param meshes_of  names of the files that stand for the mesh of a shape, given by its index;
///   none: it stays; an empty list: it is left out
NewShapes new_shapes(
    const robot::RobotFile& robot, const robot::ShapeChoice& choice,
    const std::vector<robot::LinkShape>& shapes,
    const std::function<std::optional<std::vector<std::string>>(std::size_t shape)>& meshes_of);

/// A name of a file relative to the robot's folder as it is relative to a new one; any other as it
/// is.
std::string moved_reference(const std::string& reference, const std::filesystem::path& from,
                            const std::filesystem::path& to);

/// Names of meshes that stay.
enum class KeptNames {
  Moved,  ///< as moved_reference
  Files,  ///< as files, relative to the new folder, also those of packages
};

/// The robot with its new collision shapes, each with the pose and scale of the shape that it
/// stands for.
/// @param folder  of the new files
/// @throws Error naming a mesh that is not found, of KeptNames::Files
robot::Model new_model(const robot::RobotFile& robot, const robot::ShapeChoice& choice,
                       const NewShapes& shapes, const std::filesystem::path& folder,
                       const std::string& prefix, KeptNames kept);

}  // namespace kaboum::robot_folder
