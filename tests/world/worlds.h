#pragma once

#include <kaboum/world/scene.h>

#include <map>
#include <string>
#include <vector>

namespace kaboum::test {

/// Files that a scene names, in memory.
class SceneFiles {
 public:
  /// An arm of three links of length 1 in the plane z = 0, each a bar 0.1 thick, on a base; joints
  /// j1, j2, j3 turn about z within ±3. Files arm.urdf, base.glb, l1.glb, l2.glb, l3.glb; box.glb
  /// and inner.glb hold the cube of ±0.5, tray.glb the inner set of two boxes side by side that
  /// together are x from −2 to 2, y and z from −1 to 1.
  SceneFiles();

  void put(const std::string& name, const geom::ConvexSet& set);
  [[nodiscard]] std::string hash(const std::string& name) const;
  /// {"file": NAME, "sha256": …}
  [[nodiscard]] std::string ref(const std::string& name) const;
  [[nodiscard]] std::vector<char> read(const std::string& name) const;

  /// The arm named "arm", objects and more as given: members of the scene, without the first comma.
  [[nodiscard]] std::string scene(const std::string& rest = "",
                                  const std::string& robot_rest = "") const;
  [[nodiscard]] world::World world(const std::string& text) const;

  std::map<std::string, std::vector<char>> files;
};

geom::Mesh box_mesh(const geom::Vec3& low, const geom::Vec3& high);
geom::ConvexSet set_of(const std::vector<geom::Mesh>& hulls, const std::string& direction,
                       double epsilon, const std::string& frame = "");

}  // namespace kaboum::test
