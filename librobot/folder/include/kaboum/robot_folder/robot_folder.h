#pragma once

#include <kaboum/io/file_names.h>
#include <kaboum/robot/link_meshes.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

/// The folder that is made of a robot:
/// - `bodies/MESH/MESH-0000.stl` …: the bodies of every distinct mesh and scale, once; or
///   `meshes/MESH.stl`, the meshes round them. No name of a file, folder and extension apart, is
///   there twice;
/// - `links/LINK.glb`: all bodies of a link in its frame, enlarged by the rounding of scale and
///   pose;
/// - the robot in other formats, and the URDF under its own name: they refer to the new files, and
///   a comment says that they are ours, to be replaced.
/// What else is in these folders stays.
namespace kaboum::robot_folder {

/// The result for one mesh at one scale.
struct StoredMesh {
  std::size_t mesh = 0;
  geom::Vec3 scale;
  std::string name;  ///< of the folder or file, and the stem of files
  std::string extension;
  bool left_out = false;  ///< nothing was made of it
};

/// The text of a document with a comment that says that it is ours, to be replaced.
std::string marked(std::string document);

/// Files written into the folder; documents and URDF are marked.
struct RobotContents {
  /// Writes a mesh's files.
  std::function<void(const StoredMesh& stored, const std::filesystem::path& place)> write_mesh;
  std::vector<std::pair<std::string, std::span<const char>>>
      links;                                                   ///< name of the link, container
  std::vector<std::pair<std::string, std::string>> documents;  ///< extension, text
  std::string urdf;
};

class RobotFolder {
 public:
  /// @param part  folder in it for what stands for meshes: "bodies" or "meshes"
  /// @param extension  of what is in there; empty: folders
  /// @throws Error{InvalidArgument} where the robot's file would be overwritten;
  ///   Error{OutputFailed} where another robot is in the folder.
  RobotFolder(std::filesystem::path folder, const robot::RobotFile& robot, std::string part,
              std::string extension);

  [[nodiscard]] const std::filesystem::path& urdf() const { return urdf_; }
  [[nodiscard]] const std::filesystem::path& path() const { return folder_; }
  [[nodiscard]] const std::string& part() const { return part_; }
  /// The file of another format.
  [[nodiscard]] std::filesystem::path document(const std::string& extension) const;

  /// True if documents of an earlier robot are here that `write` would take away.
  [[nodiscard]] bool has_other_documents(const RobotContents& contents) const;
  /// @throws Error{OutputFailed} where somebody's own file has a document's name
  void require_own_document(const std::string& extension) const;

  /// Gives every mesh at every scale, mirrored or not, a name of its own: MuJoCo tells meshes
  /// apart by the stems of their names, and its versions differ where a mesh has several scales.
  /// @param taken  stems of meshes that stay
  /// @throws Error{OutputFailed} when something else is in the place of one.
  void name_meshes(const robot::LinkMeshes& meshes, const robot::ShapeChoice& choice,
                   const std::vector<std::string>& taken);

  /// The name of what stands for the shape's mesh; of the shapes given to name_meshes by index.
  [[nodiscard]] const std::string& name_of(std::size_t shape) const {
    return stored_[*of_shape_[shape]].name;
  }
  /// The folder or file itself, relative to this one.
  [[nodiscard]] std::string place_of(std::size_t shape) const {
    return place_of(stored_[*of_shape_[shape]]);
  }
  [[nodiscard]] std::string place_of(const StoredMesh& s) const {
    return part_ + "/" + s.name + s.extension;
  }
  /// Another extension for a mesh, after name_meshes.
  /// @throws Error{OutputFailed} when something else is in its place.
  void set_extension(std::size_t mesh, const std::string& extension);

  /// Nothing is written of a mesh, after name_meshes.
  void leave_out(std::size_t mesh);

  /// Writes all; the URDF comes last, and is not there while bodies are replaced: a robot that is
  /// there is whole, whenever a program is ended. Programs that write into one folder at the same
  /// time take turns, where its file system has locks, and the last one's robot stays.
  /// @throws Error{OutputFailed}; nothing but complete files is left behind.
  void write(const RobotContents& contents);
  /// The files of the links, relative to the folder.
  [[nodiscard]] static std::vector<std::string> link_files(const RobotContents& contents);

  /// Files that are there and not of this result, as an earlier one with other options leaves it.
  /// It stays: it may be somebody's own.
  /// @param links  files of the links
  [[nodiscard]] std::vector<std::string> stale(const std::vector<std::string>& links) const;

 private:
  void require_own() const;
  void begin() const;
  void require_replaceable(const std::filesystem::path& place) const;
  void require_replaceable(const StoredMesh& stored) const;
  void reserve_stem(const std::string& stem);

  std::filesystem::path folder_, urdf_;
  std::string part_, extension_;
  const robot::Robot& robot_;
  io::FileNames names_;
  std::vector<StoredMesh> stored_;
  std::vector<std::optional<std::size_t>> of_shape_;  // index in stored_
};

}  // namespace kaboum::robot_folder
