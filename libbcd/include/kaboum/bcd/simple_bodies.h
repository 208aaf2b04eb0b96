#pragma once

#include <kaboum/bcd/cover.h>
#include <kaboum/geom/solid_mesh.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <span>

namespace kaboum::bcd {

/// More capsules and boxes than these are not looked for.
inline constexpr std::size_t kMostSimpleBodies = 10'000;

/// Kinds of bodies that engines and planners have formulas for.
struct SimpleKinds {
  bool balls = false, capsules = false, boxes = false;
};

/// Request for SimpleBodySearch.
struct SimpleBodyOptions : SearchRun {
  SimpleKinds kinds;
  std::optional<std::size_t> max_bodies;
  Effort effort = Effort::Normal;
};

/// A search for few capsules and boxes whose union contains the input's solid and every triangle of
/// it. A capsule is a segment with a radius, float32 numbers; a box is the hull of its corners,
/// which are rounded to float32.
///
/// Bodies grow within the outer parallel body of the solid at the distance ε. Few of them are
/// chosen that hold sampled points, and two are replaced by one that holds what only they hold,
/// while there is one. Points of triangles that no body holds are added until there are none. With
/// `max_bodies` ε is the least for which so many are found. Of several kinds, each piece gets the
/// one that takes least to be queried. docs/algorithms/capsules-and-boxes.md.
///
/// No claim that they cover: certify::certify_set decides that. The distances are certified.
class SimpleBodySearch {
 public:
  /// @pre epsilon or max_bodies is given; a kind is
  /// @throws Error{InvalidArgument} on contradictory options
  SimpleBodySearch(const geom::SolidMesh& input, const SimpleBodyOptions& options);
  SimpleBodySearch(SimpleBodySearch&&) noexcept;
  SimpleBodySearch& operator=(SimpleBodySearch&&) noexcept;
  ~SimpleBodySearch();

  /// @throws Error{LimitReached} where epsilon takes more bodies than kMostSimpleBodies, or none
  ///   were found that hold all
  CoverCandidate find();

  /// The last result with bodies beside or in place of some, so that points of the solid are
  /// held, too. With `max_bodies` all are looked for anew. @throws as find
  CoverCandidate hold(std::span<const geom::Vec3> points);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace kaboum::bcd
