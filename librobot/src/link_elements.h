#pragma once

#include <kaboum/robot/dynamics.h>
#include <tinyxml2.h>

#include <map>
#include <string>

// Where a document states a robot's links. Internal to kaboum_robot.
namespace kaboum::robot {

/// What a reader says of a document's links.
struct LinkElements {
  /// The elements that state links, by the links' names: none of links that have no element of
  /// their own, or share it.
  std::map<std::string, const tinyxml2::XMLElement*> elements;
  std::map<std::string, Inertial> inertials;  ///< by the links' names
};

/// @throws as parse_dynamics
LinkElements urdf_links(const tinyxml2::XMLDocument& document, const std::string& name);
/// @throws as parse_mjcf
LinkElements mjcf_links(const tinyxml2::XMLDocument& document, const std::string& name);
/// @throws as parse_sdf
LinkElements sdf_links(tinyxml2::XMLDocument& document, const std::string& name);

}  // namespace kaboum::robot
