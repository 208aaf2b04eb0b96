#pragma once

#include <kaboum/robot/dynamics.h>
#include <kaboum/robot/robot.h>

#include <filesystem>
#include <string>
#include <vector>

/// Robots as files: reading them, and what is to be said of their links.
namespace kaboum::robot {

/// A robot as read from its file.
struct RobotFile {
  enum class Format { Urdf, Rl, Mjcf, Sdf };

  Robot robot;
  std::filesystem::path path;
  std::string text;  ///< of the file; of xacro, what it stands for; of MJCF, with what it includes
  std::string sha256;  ///< of the text
  Format format = Format::Urdf;
  std::vector<std::string> xacro_arguments = {};  ///< that it was expanded with
  std::vector<std::string> packages = {};         ///< that what it includes was looked up in
};

/// What is said of a robot's motions.
enum class Motions {
  All,   ///< the joints are all there are: a robot with others (Robot::unmodelled) is refused
  None,  ///< shapes only
};

/// True if a file is xacro by its name, NAME.xacro, NAME.urdf.xacro, which read_robot expands.
bool is_xacro(const std::filesystem::path& path);

/// Reads URDF, MJCF, SDF, or the Robotics Library's rlkin and rlmdl (told apart by the root
/// element). Links of the latter get the mesh in the robot's folder that has their name; `bodyN`
/// also that of `linkN`.
///
/// Of a file called NAME.xacro, what the program `xacro` makes of it; its names of files are
/// relative to NAME.xacro. The program is run: such a file is trusted as a script is.
/// What an SDF robot includes is looked up as meshes are (find_model).
/// @param xacro_arguments  NAME:=VALUE each
/// @param packages  folders that package:// and model:// of what it includes, and $(find NAME) of
///   xacro, are looked up in
/// @throws Error{InvalidInput}, also where `xacro` is not installed, fails or takes too long;
///   Error{InvalidArgument} for arguments where there is no xacro, or that are none.
RobotFile read_robot(const std::string& path, Motions motions = Motions::All,
                     const std::vector<std::string>& xacro_arguments = {},
                     const std::vector<std::string>& packages = {});

/// @throws Error{InvalidInput} naming a joint that Robot does not model.
void require_modelled(const RobotFile& robot);

/// What a robot's file says of masses and forces.
Dynamics dynamics_of(const RobotFile& robot);

/// Files that read_robot read beside the robot's own: what xacro, MJCF and SDF include or attach.
/// @throws as read_robot
std::vector<std::string> included_files(const RobotFile& robot);

/// @throws Error{InvalidArgument} naming the first of `links` that the robot does not have.
void require_links(const RobotFile& robot, const std::vector<std::string>& links);

/// Links that have no shape of the kind asked for.
struct BareLinks {
  std::vector<std::string> empty;  ///< that have none at all
  std::vector<std::string> other;  ///< that have shapes of the other kind
  [[nodiscard]] std::vector<std::string> all() const;
};
/// @param visual  the kind: shapes for drawing, else those for collisions
/// @param links   only these; empty: all
BareLinks bare_links(const Robot& robot, bool visual, const std::vector<std::string>& links = {});

/// One line for each kind of bare links; `consequence` ends it.
std::vector<std::string> notes_on(const BareLinks& bare, bool visual,
                                  const std::string& consequence);

/// "8 of 9 links judged; 'l1' has shapes of the other kind only".
std::string links_judged(std::size_t judged, std::size_t asked, const BareLinks& bare);

/// One line for each box, cylinder and sphere without volume, with its place in the robot's file.
std::vector<std::string> notes_on_flat_shapes(const RobotFile& robot, bool visual,
                                              const std::vector<std::string>& links = {});

/// 'a', 'b' and 2 more.
std::string names_of(const std::vector<std::string>& names);

}  // namespace kaboum::robot
