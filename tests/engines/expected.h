#pragma once

#include <Eigen/Geometry>
#include <array>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

/// What a URDF and the files that it names say, read with as little code as possible and none of
/// the project's, to be compared with what an engine makes of them.
namespace engines {

/// A body's volume and how far it reaches in a number of directions: what collisions depend on.
struct Measure {
  std::string name;
  double volume = 0;
  std::array<double, 26> reach{};
};

/// The directions of Measure::reach, unit vectors.
const std::array<Eigen::Vector3d, 26>& directions();

/// Of a closed surface, three corners per triangle. The volume of one that is inside out is
/// negative.
Measure measure(std::string name, std::span<const Eigen::Vector3d> corners);
/// Of boxes, cylinders along z and spheres, about the pose's origin.
Measure measure_box(const Eigen::Isometry3d& pose, const Eigen::Vector3d& size);
Measure measure_cylinder(const Eigen::Isometry3d& pose, double radius, double length);
Measure measure_sphere(const Eigen::Isometry3d& pose, double radius);

/// Corners of a binary STL file's triangles, scaled and posed; those of mirrored ones are turned.
std::vector<Eigen::Vector3d> corners_of_stl(const std::filesystem::path& file,
                                            const Eigen::Vector3d& scale,
                                            const Eigen::Isometry3d& pose);

struct Shape {
  std::string mesh;  ///< its name in the URDF; empty for boxes, cylinders and spheres
  std::filesystem::path file;
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< with all joints at zero
  Measure measure;
};

struct Link {
  std::string name;
  std::string top;    ///< the farthest link above that only fixed joints lie between
  std::string model;  ///< the same, but for a link 'world' at the root
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< with all joints at zero
  std::vector<Shape> collisions;
};

struct Robot {
  std::string root;
  std::vector<Link> links;
};

/// @param prefix  that names of meshes begin with instead of being relative to the URDF.
/// @throws std::runtime_error when something is missing.
Robot read_urdf(const std::filesystem::path& urdf, const std::string& prefix = {});

/// The URDFs that outputs.sh has listed.
std::vector<std::filesystem::path> outputs();

/// One whose meshes are those of package://cell/prefixed/.
std::filesystem::path prefixed();

/// Fails the test unless both hold the same bodies, within 1e-6 of volume and size, in any order.
void expect_same(const std::string& where, std::vector<Measure> expected,
                 std::vector<Measure> loaded);

/// Bodies by the top (or model) link of each, as engines have them that merge what fixed joints
/// join.
std::map<std::string, std::vector<Measure>> bodies_by(const Robot& robot,
                                                      std::string Link::*merged);

}  // namespace engines
