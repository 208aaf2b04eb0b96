#pragma once

#include <kaboum/robot/mjcf.h>
#include <tinyxml2.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

// MJCF documents and the elements that a robot's shapes come from. Internal to kaboum_robot.
namespace kaboum::robot {

/// A mesh asset.
struct MjcfMesh {
  const tinyxml2::XMLElement* element = nullptr;
  std::string file;  ///< as stated, without meshdir
  Vec3 scale = Vec3::Ones();
  Transform reference;  ///< refpos and refquat
  std::string inertia;  ///< how its moments are computed: legacy (also empty), exact, shell, convex
};

/// A primitive fitted to a mesh.
struct MjcfFit {
  Transform pose;            ///< in the mesh's frame
  Vec3 size = Vec3::Zero();  ///< half sizes, as MJCF states them; 0: a mesh without volume
  /// The rotation as the compiler's euler angles, where a class of the geom turns it: then MuJoCo
  /// 2.2.2 passes over a `quat` of the geom's own. It takes `euler` before all else.
  std::optional<Vec3> euler;
};

/// The primitive that MuJoCo makes of a geom of another type that names a mesh.
/// @param mesh    of the asset's file
/// @param by_box  <compiler fitaabb="true"/>
/// @pre asset.inertia is not convex
MjcfFit fit_to_mesh(Geometry::Shape shape, const MjcfMesh& asset, const geom::Mesh& mesh,
                    bool by_box);

/// A robot with the elements of its shapes.
struct MjcfModel : MjcfRobot {
  using Elements = std::vector<std::vector<const tinyxml2::XMLElement*>>;
  Elements collision, visual;  ///< of each link, in the order of its shapes
  /// The bodies of links; none of the world and of links that are made for joints.
  std::vector<const tinyxml2::XMLElement*> bodies;
  std::map<std::string, MjcfMesh> meshes;
  std::string mesh_folder, texture_folder;  ///< of the compiler
  /// Bodies whose mass is that of their geoms, by link.
  std::vector<bool> weighed_by_geoms;
  /// Attributes of a geom as its classes complete them.
  std::map<const tinyxml2::XMLElement*, std::map<std::string, std::string>> geoms;
  /// Geoms that are fitted to meshes, as they are in the frame of their element.
  std::map<const tinyxml2::XMLElement*, MjcfFit> fitted;
};

/// @param meshes  gives the meshes that geoms are fitted to; without, such geoms are refused
/// @throws as parse_mjcf
MjcfModel read_mjcf(const tinyxml2::XMLDocument& document, const std::string& name,
                    const MeshSource& meshes = {});

}  // namespace kaboum::robot
