#pragma once

#include <kaboum/certify/robot.h>

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "file_names.h"

/// The folder that bcd-decompose makes of a robot:
/// - `bodies/MESH/MESH-0000.stl` …: the bodies of every distinct mesh and scale, once; no name of a
///   file, folder and extension apart, is there twice;
/// - `links/LINK.glb`: all bodies of a link in its frame, enlarged by the rounding of scale and
///   pose;
/// - the URDF under its own name, which refers to the bodies.
/// What else is in bodies/ and links/ stays.
namespace kaboum::tools {

class RobotFolder {
 public:
  /// @throws Error{InvalidArgument} where the robot's file would be overwritten;
  ///   Error{OutputFailed} where another robot is in the folder.
  RobotFolder(std::filesystem::path folder, const robot::RobotFile& robot);

  [[nodiscard]] const std::filesystem::path& urdf() const { return urdf_; }

  /// Gives every mesh at every scale, mirrored or not, a folder for its bodies: MuJoCo tells meshes
  /// apart by the stems of their names, and its versions differ where a mesh has several scales.
  /// @param taken  stems of meshes that stay
  /// @throws Error{OutputFailed} when something else is in the place of one.
  void name_bodies(const robot::LinkMeshes& meshes, const robot::ShapeChoice& choice,
                   const std::vector<std::string>& taken);

  /// The folder in bodies/ of the shape's mesh; of the shapes given to name_bodies by index.
  [[nodiscard]] const std::string& bodies_of(std::size_t shape) const {
    return stored_[*of_shape_[shape]].name;
  }

  /// Writes bodies/ and links/, then the URDF.
  /// @return the files of the links, relative to the folder.
  /// @throws Error{OutputFailed}; nothing but complete files is left behind.
  std::vector<std::string> write(const certify::CertifiedRobot& made, const std::string& urdf);

  /// What is in bodies/ and links/ and not of this result, as an earlier one with other options
  /// leaves it. It stays: it may be somebody's own.
  /// @pre written
  [[nodiscard]] std::vector<std::string> stale() const;

 private:
  struct Stored {
    std::size_t mesh = 0;
    geom::Vec3 scale;
    std::string name;  ///< of the folder, and the stem of its files
  };
  void require_own() const;
  void reserve_stem(const std::string& stem);

  std::filesystem::path folder_, urdf_;
  const robot::Robot& robot_;
  FileNames names_;
  std::vector<Stored> stored_;
  std::vector<std::optional<std::size_t>> of_shape_;  // index in stored_
  std::vector<std::string> links_;
};

}  // namespace kaboum::tools
