#pragma once

#include <kaboum/world/checker.h>

#include <array>
#include <cstdint>
#include <vector>

#include "ball_cover.h"

/// A robot among obstacles in floats, and how far these are off. docs/algorithms/batches.md. Plain
/// arrays: the vector code calls no function of a header.
namespace kaboum::filter::detail {

/// A joint that moves: pose = pose of the parent · fixed · (turn about z by x, or slide along z by
/// x), x = multiplier · q[variable] + offset.
struct Step {
  double multiplier = 1, offset = 0;
  std::uint32_t parent = 0;  ///< of the frames, 0 the root's
  std::uint32_t variable = 0;
  bool turns = true;
  float fixed[12] = {};  ///< rotation row by row, then translation
  float length = 0;      ///< of the translation, rounded up
  float slide = 0;       ///< the largest |x| of a slide, rounded up
  float path = 0;        ///< sum of lengths and slides from the root on, about
  float factor = 0;      ///< |multiplier|, rounded up
};

/// A ball fixed to a frame.
struct FrameBall {
  float center[3] = {};
  float length = 0;  ///< of the centre, rounded up
  /// Outer: the radius and all errors, rounded up. Inner: without them, rounded down.
  float radius = 0;
};

/// A range of indices.
struct Range {
  std::uint32_t begin = 0, end = 0;
};

/// A corner of a body or of the hull of a link's set, in its frame.
struct Corner {
  float at[3] = {};
};

/// A plane fixed to one shape of a pair that is above it: where the other one's corners are all
/// beyond it by more than `offset`, the two are apart.
struct Witness {
  float normal[3] = {};
  float offset = 0;  ///< of the shape's hull along the normal, with radii, margin and all errors
  bool of_first = true;
};

/// A convex body: of a link in its frame, or of an obstacle in the world.
struct BodyModel {
  FrameBall ball;    ///< holds all of it
  Range balls;       ///< of Model::outer, which hold it too; of a link
  Range corners;     ///< whose hull holds it with a radius; none: it is not looked at by directions
  float reach = 0;   ///< of the corners, rounded up
  float offset = 0;  ///< the radius and all errors along any direction, rounded up
  float error = 0;   ///< of the corners' places, rounded up
};

/// The bounding set of a link.
struct ShapeModel {
  std::uint32_t frame = 0;
  FrameBall whole;  ///< holds all of it
  Range bodies, inner;
  std::uint32_t hull = 0;  ///< of Model::bodies: the hull of all, whose balls are none
  Range corners;
  float reach = 0;          ///< of the corners, rounded up
  float corner_radius = 0;  ///< of balls round the corners whose hull holds all of it, as FrameBall
};

/// A box along its own axes, enlarged by a ball: a sphere, capsule or box, or what holds a body.
struct Obstacle {
  float axes[9] = {};  ///< row by row, from the world
  float center[3] = {}, half[3] = {};
  float radius = 0;  ///< and all errors, rounded up
  /// What lies in the body likewise: radius without errors, rounded down; below 0: nothing.
  float inner_center[3] = {}, inner_half[3] = {};
  float inner_radius = -1;
  Range planes;            ///< of Model::planes: the body lies below all of them
  std::uint32_t body = 0;  ///< of Model::bodies
};

/// A half-space n·x ≤ offset that holds a body, errors included.
struct Plane {
  float normal[3] = {};
  float offset = 0;
};

/// A point of a cloud.
struct CloudPoint {
  float at[3] = {};
};

/// A box along the world's axes that holds points of a cloud; nodes below one follow it.
struct CloudNode {
  float low[3] = {}, high[3] = {};
  Range points;            ///< of a leaf; else empty
  std::uint32_t next = 0;  ///< the node after all that are below this one
};

/// Balls of one radius round very many points, by a tree.
struct CloudModel {
  Range nodes;
  float radius = 0;        ///< and all errors, rounded up
  float inner_radius = 0;  ///< without them, rounded down; not above 0: none
};

/// The obstacles of one thing, and a box along the world's axes round them.
struct ObstacleGroup {
  float center[3] = {}, half[3] = {};  ///< half: errors included, rounded up
  Range obstacles;                     ///< none of a cloud
  CloudModel cloud;                    ///< nodes: empty where it is none
};

/// Shapes that one frame moves, held by a ball.
struct Cluster {
  std::uint32_t frame = 0;
  FrameBall whole;
};

/// A cluster and a thing, or two clusters: what they are apart by is so of all their shapes.
struct ClusterPair {
  std::uint32_t a = 0, b = 0;  ///< of Model::clusters; b of Model::groups where it is one
  bool with_group = false;
  std::uint32_t common = 0;  ///< as of ShapePair
  float margin = 0;          ///< the largest of the pairs', rounded up
};

/// Of a pair that is in no pair of clusters.
inline constexpr std::uint32_t kNoCluster = ~0U;

/// A shape and a thing that are to be apart by more than the margin.
struct ObstaclePair {
  std::uint32_t shape = 0, group = 0;
  float margin = 0, least_margin = 0;   ///< rounded up, and down
  std::uint32_t clusters = kNoCluster;  ///< of Model::cluster_pairs
};

struct ShapePair {
  std::uint32_t a = 0, b = 0;
  std::uint32_t common = 0;  ///< the last frame that both are fixed to or hang from
  float margin = 0, least_margin = 0;
  Range witnesses;
  std::uint32_t clusters = kNoCluster;  ///< as of ObstaclePair
};

/// Share of the robot's size: things that a link is farther from than that are not looked at, so no
/// motion is decided with a larger resolution.
inline constexpr double kReachSlack = 1e-2;

/// All that the vector code reads. Coordinates are the world's, from the robot's base on.
struct Model {
  std::size_t variables = 0;
  std::vector<double> low, high;  ///< rows with values beyond are left open
  std::vector<double> more;       ///< of each variable, what holds the rounding of its stretches
  /// Half of the largest acceleration divided by the speed that it is bounded by: 1/2, or 1 where a
  /// slide follows a turn.
  float bend = 0.5F;
  float blur_of_turns = 0, blur_of_slides = 0;  ///< errors of velocities, by the rates of joints
  float base[9] = {};                           ///< rotation of the root
  std::vector<Step> steps;                      ///< of frame i + 1
  std::vector<FrameBall> outer, inner;
  std::vector<ShapeModel> shapes;
  std::vector<BodyModel> bodies;
  std::vector<Corner> corners;
  std::vector<Witness> witnesses;
  std::vector<Obstacle> obstacles;
  std::vector<Plane> planes;
  std::vector<CloudPoint> cloud_points;
  std::vector<CloudNode> cloud_nodes;
  std::vector<ObstacleGroup> groups;
  std::vector<ObstaclePair> obstacle_pairs;
  std::vector<ShapePair> shape_pairs;
  std::vector<Cluster>
      clusters;  ///< of frames with several shapes, and of those in pairs with them
  std::vector<ClusterPair> cluster_pairs;
  bool obstacles_first = false;  ///< of the pairs, as they are looked at
  /// The things of the pairs: of shape_pairs, then of obstacle_pairs.
  std::vector<std::array<world::Item, 2>> items;
  /// For each variable, how far a point of the robot may move for a change by 1, about; only what
  /// is worth halving hangs on it.
  std::vector<double> levers;
  double size = 0;              ///< of the robot, about
  bool always_contact = false;  ///< of things that the variables do not move
  bool unusable = false;        ///< nothing can be said: every row is open
};

Model make_model(const world::Checker& checker, const world::WorldState& state, std::size_t robot,
                 std::size_t most_balls);

}  // namespace kaboum::filter::detail
