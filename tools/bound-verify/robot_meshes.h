#pragma once

#include <kaboum/robot/mesh_files.h>
#include <kaboum/robot/robot_file.h>
#include <kaboum/verify/robot_verdict.h>

#include <map>
#include <string>
#include <utility>
#include <vector>

namespace kaboum::tools {

/// The mesh files that robots' shapes stand for, each read once.
class RobotMeshes {
 public:
  /// @param packages  folders that package:// URIs are looked up in.
  /// @param exact_points  how densely points of the exact faces of CAD files are looked at; 0: not
  RobotMeshes(std::vector<std::string> packages, std::size_t exact_points)
      : packages_(std::move(packages)), exact_points_(exact_points) {}

  /// The file of a mesh, where there is only one that may be meant. @throws Error naming it.
  /// @param skip  a mesh without a file is one with an error
  const verify::MeshFile& file_of(const robot::Geometry& mesh, const robot::RobotFile& robot,
                                  bool skip = false);

  /// A record beside one of the files read that names a mesh which the original has among its
  /// shapes of the other kind only; empty: there is none. @param visual  the kind that is judged.
  [[nodiscard]] std::string record_of_other_kind(const robot::RobotFile& original,
                                                 bool visual) const;

 private:
  const verify::MeshFile& read(const std::string& path);
  robot::MeshFiles& files_of(const robot::RobotFile& robot);

  std::vector<std::string> packages_;
  std::size_t exact_points_;
  std::map<std::string, robot::MeshFiles> places_;  // by robot
  std::map<std::string, verify::MeshFile> files_;
  std::map<std::pair<std::string, std::string>, const verify::MeshFile*>
      named_;  // robot, reference
};

}  // namespace kaboum::tools
