#pragma once

#include <kaboum/certify/link_bodies.h>
#include <kaboum/robot/robot_file.h>
#include <tinyxml2.h>

#include <filesystem>
#include <functional>
#include <string>

/// URDFs with shapes of bodies as <collision> elements.
namespace kaboum::robot_folder {

/// A number with the digits that tell it from all others, also for readers of float32.
std::string decimal(double x);
std::string decimals(const geom::Vec3& p, const char* between = " ");

/// Where a file of shapes of a robot's links comes from. @param what  "Spheres"
std::string origin_of(const std::string& what, const robot::RobotFile& robot,
                      const std::string& parameters);

/// A text as a comment of XML, in which there are no two hyphens: "-\-epsilon", which shells read
/// as
/// "--epsilon".
std::string comment_of_xml(const std::string& text);

std::string text_of(const tinyxml2::XMLDocument& document);

/// The folder that a file is in.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// True if a URDF is of 1.1 or 1.2, which have <capsule>.
bool has_capsules(const tinyxml2::XMLDocument& urdf);

/// Adds a <collision> with an origin. @return its <geometry>
tinyxml2::XMLElement* add_collision(tinyxml2::XMLElement& link, const geom::Vec3& xyz,
                                    const geom::Vec3& rpy);

/// The robot's URDF in which the links whose shapes are held have other <collision> elements.
/// @param add   adds those of a link, which has none
/// @param file  to be written: names of meshes for drawing are made relative to it
/// @throws Error{InvalidInput} where the robot is no URDF
std::string urdf_with(const robot::RobotFile& robot, const certify::CertifiedBodies& bodies,
                      const std::function<void(tinyxml2::XMLElement&, std::uint32_t)>& add,
                      const std::string& origin, const std::string& file);

}  // namespace kaboum::robot_folder
