#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace kaboum::bcd {

/// The triangles of a convex hull that changes, and of every vertex those round it.
class HullMesh {
 public:
  using Index = std::uint32_t;
  static constexpr Index kNone = 0xFFFFFFFF;
  using Edge = std::array<Index, 2>;

  HullMesh(const std::vector<geom::Vec3>& points, const std::vector<geom::Triangle>& triangles);

  /// Vertices that there are, and slots of those that there were.
  [[nodiscard]] std::size_t count() const { return count_; }
  [[nodiscard]] std::size_t slots() const { return vertices_.size(); }
  [[nodiscard]] bool used(Index v) const { return !star_[v].empty(); }
  [[nodiscard]] const geom::Vec3& operator[](Index v) const { return vertices_[v]; }
  /// Triangles with this corner.
  [[nodiscard]] const std::vector<Index>& star(Index v) const { return star_[v]; }
  [[nodiscard]] std::size_t triangle_slots() const { return triangles_.size(); }
  [[nodiscard]] bool alive(Index t) const { return state_[t] == State::Alive; }
  [[nodiscard]] const geom::Triangle& triangle(Index t) const { return triangles_[t]; }
  /// Of both ends: the same only if no triangle of either has changed.
  [[nodiscard]] std::uint64_t version(Index a, Index b) const { return version_[a] + version_[b]; }
  [[nodiscard]] std::size_t valence(Index a, Index b) const {
    return star_[a].size() + star_[b].size();
  }
  [[nodiscard]] bool adjacent(Index a, Index b) const;
  /// The edges round both ends of an edge. @return false if the edge has not two triangles.
  bool link(Index a, Index b, std::vector<Edge>& edges) const;

  /// The alive triangle with the directed edge (b, a); kNone if there is none, or it is marked.
  [[nodiscard]] Index across(Index a, Index b) const;
  /// Marks a triangle, which is to go. @return whether it was alive.
  bool mark(Index t);
  void unmark(std::span<const Index> marked);
  /// The vertices round the marked triangles, in order, if they are one loop.
  [[nodiscard]] std::optional<std::vector<Index>> ring_round(std::span<const Index> marked) const;
  /// Puts a new vertex, and triangles from it to the ring, in the place of marked triangles.
  /// @param vanished  receives the vertices that have no triangle any more.
  /// @return the new vertex.
  Index replace(std::span<const Index> marked, const std::vector<Index>& ring,
                const geom::Vec3& position, std::vector<Index>& vanished);

 private:
  enum class State : char { Gone, Alive, Marked };
  void add_triangle(const geom::Triangle& t);

  std::vector<geom::Vec3> vertices_;
  std::vector<std::vector<Index>> star_;
  std::vector<std::uint64_t> version_;
  std::vector<geom::Triangle> triangles_;
  std::vector<State> state_;
  std::size_t count_;
};

}  // namespace kaboum::bcd
