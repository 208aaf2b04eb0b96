#pragma once

#include <kaboum/bmesh/log.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "working_mesh.h"

namespace kaboum::bmesh {

/// The vertices of which rounded normals do not rule out that all around lies in one plane or two.
std::vector<std::uint32_t> flat_vertices(const geom::SolidMesh& input);

/// Takes away the vertices that a mesh does not need to be the set of points that it is: those
/// around which all lies, exactly, in one plane, or in two that meet along a straight edge through
/// the vertex. Vertices stay where they are, and so does the solid;
/// docs/algorithms/bounding-mesh.md, "Coplanar regions".
class Flattener {
 public:
  /// @param flat   what `flat_vertices` has found.
  /// @param steps  receives the steps, when not null.
  Flattener(const geom::SolidMesh& input, std::vector<std::uint32_t> flat,
            std::vector<Step>* steps);

  /// Goes on until there are no more than `target` vertices, or none can go.
  void run(std::size_t target);

  [[nodiscard]] std::size_t vertices() const { return vertices_; }
  [[nodiscard]] std::size_t contractions() const { return contractions_; }
  [[nodiscard]] std::size_t flips() const { return flips_; }
  /// Whether all coordinates left are float32 numbers.
  [[nodiscard]] bool is_float32() const;

  /// What is left; vertex i is vertex source[i] of the input.
  [[nodiscard]] geom::Mesh mesh(std::vector<std::uint32_t>* source = nullptr) const;

 private:
  using Corners = std::array<Vec3, 3>;
  struct Spoke {  // the triangle (v, at, next)
    std::uint32_t at, next;
    bool crease;  // at the edge (v, at)
  };

  void remove(std::uint32_t v);
  [[nodiscard]] bool look_at(std::uint32_t v);
  [[nodiscard]] bool may_be_flat() const;
  [[nodiscard]] bool order();
  [[nodiscard]] bool find_creases();
  void find_targets();
  [[nodiscard]] bool contracts_to(std::uint32_t w) const;
  [[nodiscard]] bool keeps_topology(std::uint32_t w) const;
  void contract_to(std::uint32_t w);
  [[nodiscard]] std::optional<std::size_t> flippable() const;
  void flip(std::size_t i);

  [[nodiscard]] Corners triangle(std::size_t i) const;  // i-th of the fan
  [[nodiscard]] const Vec3& place(std::uint32_t v) const { return m_.position[v]; }
  [[nodiscard]] std::size_t after(std::size_t i) const { return i + 1 == fan_.size() ? 0 : i + 1; }
  [[nodiscard]] bool around(std::uint32_t v) const;  // is it in the fan
  [[nodiscard]] bool joined(std::uint32_t a, std::uint32_t b) const;

  WorkingMesh m_;  // normals stay as they were: the planes do
  std::vector<Step>* steps_;
  std::size_t vertices_ = 0, contractions_ = 0, flips_ = 0;
  std::vector<std::uint32_t> todo_;
  std::size_t at_ = 0;       // in todo_
  std::vector<char> waits_;  // per vertex: is in todo_ from at_ on

  // Of the vertex at hand.
  std::uint32_t v_ = 0;
  std::vector<Spoke> fan_, sorted_;  // in the order round v; by `at`
  std::vector<std::uint32_t> targets_;
};

}  // namespace kaboum::bmesh
