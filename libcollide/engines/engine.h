#pragma once

#include <kaboum/geom/transform.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

namespace kaboum::collide {

/// One shape of a link, or of the scene.
struct Part {
  std::uint32_t link;  ///< of the robot; not used for the scene
  geom::Mesh mesh;     ///< in the link's frame
};

/// Robot and scene in one representation.
struct Model {
  std::string name;  ///< "triangles", "hulls" or "bounding sets"
  bool convex = true;
  double margin = 0;  ///< added to all parts of the robot
  std::vector<Part> robot;
  std::vector<geom::Mesh> scene;
};

/// A collision library with a model loaded.
class Engine {
 public:
  Engine() = default;
  virtual ~Engine() = default;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  /// Moves the robot's parts; `poses` are of the links.
  virtual void place(const std::vector<geom::Transform>& poses) = 0;
  /// Whether robot and scene collide.
  virtual bool collide() = 0;
  /// Distance between robot and scene, 0 or negative when they collide; NaN: not offered.
  virtual double distance() = 0;
};

std::unique_ptr<Engine> make_fcl(const Model& model);
std::unique_ptr<Engine> make_bullet(const Model& model);
/// Parts of the scene are taken as their bounding boxes: for scenes of boxes.
std::unique_ptr<Engine> make_ode(const Model& model);

/// Convex parts only, in a tree of oriented boxes for every link (BodyTree); pairs are decided by
/// FCL with libccd, by FCL's own GJK, and by libccd alone.
std::unique_ptr<Engine> make_fcl_tree(const Model& model);
std::unique_ptr<Engine> make_fcl_own_tree(const Model& model);
std::unique_ptr<Engine> make_ccd_tree(const Model& model);

/// The same, but asking only where no direction is found at once in which two parts are apart.
std::unique_ptr<Engine> make_fcl_directions(const Model& model);
std::unique_ptr<Engine> make_ccd_directions(const Model& model);

}  // namespace kaboum::collide
