#pragma once

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>

#include <array>
#include <cstdint>
#include <vector>

namespace kaboum::verify {

/// The checker's own view of the original's solid; shares nothing with ReferenceSolid, which the
/// optimisation uses.
class ReplaySolid {
 public:
  using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
  using Point = Kernel::Point_3;
  using Corners = std::array<std::uint32_t, 3>;

  /// @pre the triangles form a closed chain.
  ReplaySolid(std::vector<Point> points, std::vector<Corners> triangles);

  /// Whether the open tetrahedron meets no triangle of the original and its winding number there is
  /// at most 0 (`inside` false) or at least 1 (`inside` true). False when that cannot be decided.
  bool contains(const std::array<Point, 4>& tetrahedron, bool inside);

  [[nodiscard]] std::uint64_t predicates() const { return predicates_; }

 private:
  struct Box {
    std::array<double, 3> lo, hi;
  };
  [[nodiscard]] Box box_of(std::uint32_t triangle) const;
  void build(std::size_t node, std::size_t begin, std::size_t end);
  template <class Visit>
  bool visit(const Box& box, Visit&& visit) const;
  int side(const Point& a, const Point& b, const Point& c, const Point& d);
  bool separated(const std::array<Point, 4>& tetrahedron, const std::array<Point, 3>& triangle);
  template <class PointType>
  bool winding(const PointType& p, const Box& box, int& w);
  template <class PointType>
  bool crossings(const PointType& p, const PointType& q, const Box& swept, int& w);

  std::vector<Point> points_;
  std::vector<Corners> triangles_;
  std::vector<std::uint32_t> order_;
  std::vector<Box> boxes_;  // of a binary tree over ranges of order_; children 2i + 1 and 2i + 2
  Box all_{};
  std::uint64_t predicates_ = 0;
};

}  // namespace kaboum::verify
