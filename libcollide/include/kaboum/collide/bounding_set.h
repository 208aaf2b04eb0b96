#pragma once

#include <kaboum/collide/proximity.h>
#include <kaboum/geom/convex_set.h>

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace kaboum::collide {

namespace detail {
class Facings;
struct Shapes;
}  // namespace detail

enum class Direction {
  Outer,  ///< contains its solid
  Inner,  ///< lies in its solid
};

/// A union of convex bodies that bounds a solid from one side; ready for queries.
class BoundingSet {
 public:
  /// @param bodies   exactly convex (geom::is_convex)
  /// @param epsilon  an outer set's points are within it of the solid, radii included; what an
  ///   inner one leaves out of the solid is not deeper. [length]
  /// @throws Error{InvalidArgument} for a radius or epsilon that is negative or not finite;
  ///   Error{InvalidInput} as Polytope.
  BoundingSet(std::vector<geom::ConvexBody> bodies, Direction direction, double epsilon);

  /// A set as its container states it.
  /// @throws Error{InvalidInput} when it states no direction or no epsilon, or a body is not
  ///   exactly convex.
  explicit BoundingSet(const geom::ConvexSet& set);

  [[nodiscard]] std::size_t size() const { return bodies_.size(); }
  [[nodiscard]] const geom::ConvexBody& body(std::size_t i) const { return bodies_[i]; }
  /// The core of a body.
  [[nodiscard]] const Polytope& polytope(std::size_t i) const { return polytopes_[i]; }
  /// A ball that holds all bodies, in the set's frame; rounded up. Radius 0
  /// where there are none. [length]
  struct Ball {
    geom::Vec3 center = geom::Vec3::Zero();
    double radius = 0;
  };
  [[nodiscard]] const Ball& ball() const { return ball_; }
  /// Box along the axes of the set's frame that holds all bodies.
  [[nodiscard]] const geom::Box3& box() const { return box_; }
  /// True if all bodies are balls of one radius, and more than a few: points of a sensor.
  [[nodiscard]] bool is_cloud() const { return is_cloud_; }
  [[nodiscard]] Direction direction() const { return direction_; }
  [[nodiscard]] double epsilon() const { return epsilon_; }

 private:
  friend class detail::Facings;

  std::vector<geom::ConvexBody> bodies_;
  std::vector<Polytope> polytopes_;
  std::shared_ptr<const detail::Shapes> shapes_;
  /// Boxes that each hold kBlock boxes of the level below; level 0 are the bodies', radii included.
  struct Level {
    std::size_t from = 0, count = 0;  ///< place in rows_, rows of `count`
    [[nodiscard]] std::size_t at(std::size_t row) const { return from + row * count; }
  };
  static constexpr std::size_t kBlock = 64;
  void add_levels();
  std::vector<float> rows_;    ///< lower ends of boxes, axis by axis, then upper ends; by levels
  std::vector<Level> levels_;  ///< up to one of at most kBlock boxes
  Ball ball_;
  geom::Box3 box_;
  Direction direction_ = Direction::Outer;
  double epsilon_ = 0;
  bool is_cloud_ = false;
};

/// A set at a place. Refers to the set.
class PosedSet {
 public:
  /// @param error  how far a point of the body may be from its exact image under the pose: of
  ///   rotations that are rounded, of kinematics. [length]
  /// @throws Error{InvalidArgument} when `linear` is no rotation (to 1e-9) or a number is not
  ///   finite.
  explicit PosedSet(const BoundingSet& set, const geom::Transform& pose = {}, double error = 0);

  /// Moves it; cheaper than a new one.
  void place(const geom::Transform& pose, double error = 0);

  [[nodiscard]] const BoundingSet& set() const { return *set_; }
  [[nodiscard]] const geom::Transform& pose() const { return pose_; }
  [[nodiscard]] double error() const { return error_; }
  /// Radii of balls that hold the image of the ball of a body's radius, and that it holds: `linear`
  /// may stretch it. [length]
  [[nodiscard]] double radius_above(std::size_t i) const {
    return set_->body(i).radius * (1 + defect_);
  }
  [[nodiscard]] double radius_below(std::size_t i) const {
    return set_->body(i).radius * (1 - defect_);
  }
  [[nodiscard]] Posed body(std::size_t i) const {
    return {set_->polytope(i), pose_, Posed::Checked{}};
  }
  /// Boxes along the axes that hold all bodies, and one; radii and error included.
  [[nodiscard]] geom::Box3 box() const;
  [[nodiscard]] geom::Box3 box(std::size_t i) const;
  [[nodiscard]] std::vector<geom::Box3> boxes() const;  ///< of each body

 private:
  friend class detail::Facings;

  const BoundingSet* set_;
  geom::Transform pose_;
  double error_ = 0;
  double defect_ = 0;  ///< of `linear` from a rotation, more than twice what it stretches by
};

/// Axes that separated the bodies of two sets, from one query to the next. Belongs to who asks: one
/// for every pair of sets and thread.
class Memory {
 public:
  /// The axis of bodies i and j of sets of the sizes n and m; null where there are too many pairs.
  Axis* axis(std::size_t i, std::size_t j, std::size_t n, std::size_t m);

 private:
  std::vector<Axis> axes_;
};

/// Two bodies, of the first and the second set.
struct BodyPair {
  std::size_t a = 0, b = 0;
};

/// Definition 1 of [gaschler2016], cases 1 to 3: whether two solids collide, by their outer sets:
/// of objects, robots' links, or swept volumes. The first pair of bodies whose exact images,
/// enlarged by errors and `slack`, meet, among 64 bodies of b after the other; nullopt for none.
///
/// Never nullopt when the solids meet, or come within `slack` of each other. Always nullopt when
/// they are farther apart than both epsilons, errors and the slack. The same for any memory.
/// @throws Error{InvalidArgument} for an inner set.
std::optional<BodyPair> find_collision(const PosedSet& a, const PosedSet& b, double slack = 0,
                                       Memory* memory = nullptr, Decided* decided = nullptr);

/// True if two solids certainly collide: a point is in both of their inner sets, however wrong the
/// places are.
/// @throws Error{InvalidArgument} for an outer set with an epsilon above 0.
bool certainly_collide(const PosedSet& a, const PosedSet& b);

/// A certified bracket of the distance between two sets, and the bodies and points it is between.
struct Clearance {
  /// Bounds of the sets' distance; `lower` is one of the solids of outer sets, too. lower = 0: they
  /// may meet. [length]
  double lower = 0, upper = 0;
  BodyPair bodies;
  geom::Vec3 on_a = geom::Vec3::Zero(), on_b = geom::Vec3::Zero();  ///< of the cores
};

/// nullopt when a set has no bodies.
std::optional<Clearance> clearance(const PosedSet& a, const PosedSet& b);

}  // namespace kaboum::collide
