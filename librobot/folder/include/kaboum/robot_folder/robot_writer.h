#pragma once

#include <kaboum/certify/cache_folder.h>
#include <kaboum/robot/dynamics.h>
#include <kaboum/robot/link_meshes.h>
#include <kaboum/robot/usd.h>
#include <kaboum/robot_folder/new_shapes.h>
#include <kaboum/robot_folder/robot_folder.h>

#include <functional>
#include <map>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace kaboum::robot_folder {

/// Contents of a robot's folder.
struct FolderOptions {
  robot::ShapeChoice shapes;       ///< that other shapes stand for
  std::string mesh_prefix;         ///< put before names of meshes in URDF and SDF
  bool mjcf = false, sdf = false;  ///< formats that are written besides the robot's own
  bool usd = false;                ///< with UsdPhysics; `RobotWriter::set_meshes`
  bool urdf = false;               ///< asked for: refused of robots that are in another format
  std::string bodies = "stl";      ///< format of convex bodies' files: stl or obj
  bool declare_convex = false;     ///< in the URDF, as Drake asks for
  std::map<std::string, robot::Inertial> inertials = {};  ///< by link, instead of the file's
};

/// Receiver of notes on files, for the user.
using FileNote = std::function<void(const std::string& file, const std::string& text)>;

/// A robot with other shapes on its way into a folder: URDF, other formats, meshes, links.
class RobotWriter {
 public:
  /// @param part, extension  as RobotFolder
  /// @throws as RobotFolder; Error{InvalidInput} when the robot's file is no URDF
  RobotWriter(FolderOptions options, const std::string& folder, const robot::RobotFile& robot,
              std::string part, std::string extension);
  ~RobotWriter();
  RobotWriter(const RobotWriter&) = delete;
  RobotWriter& operator=(const RobotWriter&) = delete;

  [[nodiscard]] const FolderOptions& options() const;
  [[nodiscard]] const robot::RobotFile& robot() const;
  [[nodiscard]] const RobotFolder& folder() const;
  [[nodiscard]] RobotFolder& folder();

  /// Names what will stand for the meshes, before anything is computed.
  /// @throws Error naming what cannot be replaced or read
  void plan(const robot::LinkMeshes& meshes);

  /// Another file that holds something of the robot, beside its URDF.
  void add_document(std::string extension, std::string text);

  /// The bodies of files that new shapes name, for formats that hold them themselves.
  void set_meshes(robot::MeshOfFile meshes);

  /// Has `write` leave files alone that are there as an earlier run has written them.
  /// @param meshes  what all files of a mesh are made of, by the shape that it stands for
  void reuse(const certify::CacheFolder& cache,
             const std::map<std::size_t, std::span<const char>>& meshes);

  /// Writes the folder. Until then nothing is written.
  void write(const NewShapes& shapes, decltype(RobotContents::write_mesh) write_mesh,
             std::vector<std::pair<std::string, std::span<const char>>> links,
             const FileNote& note);

  /// Containers of the links, relative to the folder, once it is written.
  [[nodiscard]] const std::vector<std::string>& link_files() const;
  /// The files that hold the robot; the URDF is the first.
  [[nodiscard]] std::vector<std::string> documents() const;
  /// Files in the folder that are not of this result (RobotFolder::stale).
  [[nodiscard]] std::vector<std::string> stale() const;
  /// Links that have no shape of the kind.
  [[nodiscard]] robot::BareLinks bare_links() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kaboum::robot_folder
