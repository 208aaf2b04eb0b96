#pragma once

#include <kaboum/base/length.h>
#include <kaboum/certify/link_enclosures.h>
#include <kaboum/certify/link_verdict.h>
#include <kaboum/certify/robot.h>
#include <kaboum/certify/wanted_meshes.h>
#include <kaboum/geom/mesh.h>
#include <kaboum/page/preview.h>
#include <kaboum/robot/link_meshes.h>
#include <kaboum/robot/mesh_files.h>

#include <optional>
#include <string>
#include <vector>

/// Pages about robots that were made: a row for each link, with pictures.
namespace kaboum::page {

/// What is said of a link.
struct PageLink {
  std::string name;
  std::vector<std::string> meshes;  ///< files that its shapes come from
  std::size_t shapes = 0, bodies = 0, vertices = 0;
  std::string epsilon;            ///< asked for
  double reach = 0;               ///< certified: nothing is farther from the shapes [length]
  std::optional<double> seconds;  ///< none: from the cache
  certify::LinkVerdict verdict;
  /// In the link's frame, for the pictures.
  geom::Mesh original, result;
};

/// What a robot that was made consists of: terminal, report and page give these numbers.
struct RobotCounts {
  std::size_t links = 0;  ///< with shapes
  /// Of the robot; of these, that stay as they were, and that have no file.
  std::size_t meshes = 0, kept = 0, missing = 0;
  std::size_t bodies = 0;    ///< that were made, of primitive shapes too; of meshes: meshes
  std::size_t vertices = 0;  ///< of what was made

  /// "4 meshes", or "4 meshes, of which 1 stays as it was".
  [[nodiscard]] std::string of_meshes() const;
};

/// What is said of the robot.
struct RobotPage {
  std::string robot, source, tool;  ///< name; file; program and version
  std::string command = {};         ///< that decides it from the files alone; empty: there are none
  bool passes = true;               ///< the command's exit code is 0
  std::string unit = "m";
  std::vector<std::string> files = {}, notes = {};
  std::vector<Step> steps = {};  ///< what to do next
  std::vector<PageLink> links = {};
  RobotCounts counts = {};
  std::string made = "bodies";  ///< of what a link consists
};

/// A link's epsilon as it was asked for: its own, else that of all; empty: none.
std::string epsilon_of(const std::string& link, const certify::LinkEpsilons& own,
                       const std::optional<Length>& of_all);

/// One HTML file, pictures included.
std::string to_html(const RobotPage& page);

/// Shapes of a link as triangles in its frame, for pictures only. Meshes that cannot be read are
/// left out.
geom::Mesh drawn_shapes(const std::vector<robot::Geometry>& shapes, robot::MeshFiles& files);

/// Appends a mesh, moved; mirrored ones are turned.
void append_placed(geom::Mesh& to, const geom::Mesh& mesh, const robot::Geometry& place);

/// What a robot's convex bodies consist of.
RobotCounts counts_of(const certify::CertifiedRobot& made);

/// A row for each link of a robot's convex bodies that has shapes.
/// @param request  that they were made as
/// @param seconds  that each mesh took; empty: nothing is said of that
std::vector<PageLink> page_links(const robot::RobotFile& robot, const certify::CertifiedRobot& made,
                                 const certify::RobotRequest& request,
                                 const std::vector<double>& seconds);

/// Counts of the meshes round a robot's links. A mesh counts once, however many links have it.
RobotCounts counts_of(const certify::LinkEnclosures& made);

/// A row for each link that has shapes.
/// @param request  that the meshes were made as
std::vector<PageLink> page_links(const robot::RobotFile& robot, const certify::LinkEnclosures& made,
                                 const certify::LinkEnclosuresRequest& request);

}  // namespace kaboum::page
