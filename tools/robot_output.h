#pragma once

#include <kaboum/robot/link_meshes.h>

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "notes.h"
#include "report.h"
#include "robot_files.h"
#include "robot_folder.h"
#include "robot_options.h"
#include "robot_shapes.h"
#include "robot_urdf.h"

/// What tools that make robots with other shapes write, and say of that.
namespace kaboum::tools {

/// Refuses an output that is no folder.
/// @throws Error{InvalidArgument}
void require_robot_folder(const std::string& output, const std::string& output_format);

class RobotOutput {
 public:
  /// @param part, extension  as RobotFolder
  /// @throws as RobotFolder, RobotUrdf
  RobotOutput(const RobotOptions& options, const std::string& output, const robot::RobotFile& robot,
              std::string part, std::string extension);

  [[nodiscard]] robot::ShapeChoice choice() const { return {o_.links, o_.visual(), o_.packages}; }
  [[nodiscard]] const RobotFolder& folder() const { return folder_; }
  [[nodiscard]] RobotFolder& folder() { return folder_; }

  /// Names what will stand for the meshes, before anything is computed.
  /// @throws Error naming what cannot be replaced or read
  void plan(const robot::LinkMeshes& meshes);

  /// Another file that holds something of the robot, beside its URDF.
  void add_document(std::string extension, std::string text) {
    more_.emplace_back(std::move(extension), std::move(text));
  }

  /// Has `write` leave files alone that are there as an earlier run has written them.
  /// @param meshes  what all files of a mesh are made of, by the shape that it stands for
  void reuse(const certify::CacheFolder& cache,
             const std::map<std::size_t, std::span<const char>>& meshes);

  /// Writes the folder. Until then nothing is written.
  void write(const NewShapes& shapes, decltype(RobotContents::write_mesh) write_mesh,
             std::vector<std::pair<std::string, std::span<const char>>> links, Notes& notes);

  /// Containers of the links, relative to the folder, once it is written.
  [[nodiscard]] const std::vector<std::string>& link_files() const { return links_; }
  /// The files that hold the robot.
  [[nodiscard]] std::vector<std::string> documents() const;

  /// Says what a user should know of the folder.
  void say(bool quiet, const Notes& notes) const;
  /// What reports say of it: urdf, documents, stale, links_without_shapes.
  [[nodiscard]] Json report() const;

 private:
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> other_formats(
      const NewShapes& shapes, Notes& notes) const;
  void write_or_reuse(RobotContents& contents);
  [[nodiscard]] robot::BareLinks bare() const;

  const RobotOptions& o_;
  const robot::RobotFile& robot_;
  RobotFolder folder_;
  RobotUrdf urdf_;
  std::vector<std::string> links_;
  std::vector<std::pair<std::string, std::string>> more_;  // extension, text
  std::optional<certify::CacheFolder> cache_;              // none: all is written
  PartsHash meshes_hash_;                                  // of meshes' places and what is in them
  std::vector<std::string> places_;                        // of meshes, relative to the folder
};

/// "1 body", "2 bodies".
std::string counted(std::size_t n, const char* one, const char* many);

}  // namespace kaboum::tools
