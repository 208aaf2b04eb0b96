#pragma once

#include <cstdint>
#include <optional>
#include <queue>
#include <unordered_map>
#include <vector>

#include "facet_tree.h"
#include "half_space.h"
#include "hull_mesh.h"
#include "point_tree.h"
#include "solid_field.h"
#include "tangent_planes.h"

namespace kaboum::bcd {

/// What adds no more to a hull than this is all the same, where `free_cost` may be added. [length]
double negligible(double free_cost, double size);

/// Contracts edges of a convex hull, so that every new vertex and all facets contain the old hull.
class Contractor {
 public:
  /// Costs are distances from the solid, which is kept by reference, as are the points.
  Contractor(const std::vector<Vec3>& points, const std::vector<Triangle>& triangles,
             const SolidField& solid, bool many);
  Contractor(const Contractor&) = delete;
  Contractor& operator=(const Contractor&) = delete;
  ~Contractor() = default;

  /// Contracts edges in any order, those first that bring a vertex little beyond the hull, while
  /// there are more vertices than `cap`: of many, which go first matters little, and looking for
  /// the cheapest each time would take long. What is far less than `free_cost` is all the same.
  void contract_roughly(std::size_t cap, double free_cost);

  /// Contracts, the cheapest first, while there are more vertices than `cap`, then calls reached(),
  /// then contracts what costs at most `free_cost`. @return the largest cost of a contraction done.
  template <class Reached>
  double run(std::size_t cap, double free_cost, Reached&& reached) {
    double largest = 0;
    bool told = false;
    begin(cap);
    while (const Entry* e = next(cap)) {
      const bool enough = mesh_.count() <= cap;
      if (!told && enough && (e->cost > 0 || mesh_.count() <= kFreeAbove)) {
        reached();
        told = true;
      }
      // A dozen vertices are few enough: no distance is spent on fewer.
      if (enough && (e->cost > free_cost || mesh_.count() <= kFreeAbove)) break;
      if (mesh_.count() <= kFewestVertices) break;
      largest = std::max(largest, contract_next());
    }
    if (!told) reached();
    return largest;
  }

  [[nodiscard]] std::vector<Vec3> vertices() const;
  [[nodiscard]] std::size_t count() const { return mesh_.count(); }

 private:
  using Index = HullMesh::Index;
  static constexpr std::size_t kFreeAbove = 12, kFewestVertices = 5;
  struct Entry {
    double cost;
    Index a, b;
    std::uint64_t version;
    bool guessed;  ///< the cost; there is no position
    Vec3 position = Vec3::Zero();
    bool operator<(const Entry& o) const {
      if (cost != o.cost) return cost > o.cost;
      return a != o.a ? a > o.a : b > o.b;
    }
  };
  /// What is known of an edge that a rough contraction was not made of.
  struct Attempt {
    std::uint64_t version;
    double growth;  ///< or less than it is
    Vec3 position;
  };
  using TriedEdges = std::unordered_map<std::uint64_t, Attempt>;

  [[nodiscard]] bool in_fan(Index a, Index b) const;
  void begin(std::size_t cap);
  const Entry* next(std::size_t cap);
  double contract_next();
  void push_all();
  void push(Index a, Index b, bool certain = false);
  void contract_round(Index v, std::size_t slots, double growth, TriedEdges& tried);
  [[nodiscard]] bool place(Index a, Index b, Vec3& best, double& cost);
  [[nodiscard]] bool find_position(Index a, Index b, Vec3& best);
  bool contract(Index a, Index b, const Vec3& position);
  [[nodiscard]] std::vector<Index> mark_visible(Index a, Index b, const Vec3& position);
  [[nodiscard]] bool contains_original(const std::vector<Index>& ring, const Vec3& position) const;

  const SolidField& solid_;
  double size_;             // of the hull [length]
  double rounding_;         // points no farther beyond a plane are on it [length]
  std::vector<Vec3> near_;  // the original's vertices, neighbours near each other
  PointTree original_;
  std::optional<FacetTree> facets_;  // the original's
  TangentPlanes tangents_;
  HullMesh mesh_;
  std::vector<PlaneQuadric> quadric_;  // of a vertex: the original's facets that are near it
  bool queued_ = false;                // all edges are in the queue
  bool few_ = false;                   // vertices are left, so that fans are worth a closer look
  std::priority_queue<Entry> queue_;
  std::vector<HullMesh::Edge> link_;  // of the edge at hand
  std::vector<HalfSpace> half_spaces_;
};

}  // namespace kaboum::bcd
