#pragma once

#include <kaboum/geom/mesh.h>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "box_tree.h"
#include "number.h"

namespace kaboum::verify {

/// One of the two chains that are compared.
enum Operand : int { kInside = 0, kOutside = 1 };

/// A set of chains.
using OperandMask = unsigned;
inline constexpr OperandMask mask_of(int chain) { return 1U << chain; }

struct Face {
  std::array<std::uint32_t, 3> v;
  int axis;                 ///< a projection along it does not collapse the face; −1: no area
  bool upward;              ///< the projection along `axis` is counter-clockwise
  std::uint8_t chain;       ///< Chain
  std::uint8_t directions;  ///< that it certainly faces: set_axis
  std::uint32_t source;     ///< index in the mesh it comes from

  /// Which corner a vertex is; −1: none.
  [[nodiscard]] int place_of(std::uint32_t vertex) const {
    for (int k = 0; k < 3; ++k) {
      if (v[k] == vertex) return k;
    }
    return -1;
  }
};

/// The face of the same chain across an edge.
struct Neighbour {
  static constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::uint32_t face = kNone;  ///< kNone: the edge has not just two faces of the chain, or they run
                               ///< through it the same way
  std::uint8_t edge = 0;       ///< there; it runs the other way
  bool alone = false;          ///< nor has the edge a face of the other chain
};

/// Both meshes with one set of vertices, equal coordinates merged (−0 = +0): faces of the inside
/// chain first. Vertices and each chain's faces are numbered along a curve through space, so that
/// what is near is near in memory, whatever the files' order. Faces with repeated corners are kept
/// apart; faces without area stay among the others, as they count in the balance of edges, but are
/// marked.
///
/// Coordinates are the meshes' times one power of two that brings the largest to about 1, so that
/// products neither overflow nor underflow; if some coordinate would not survive that exactly, they
/// stay as they are (scaled() is then false).
class MeshPair {
 public:
  MeshPair(const geom::Mesh& inside, const geom::Mesh& outside);

  [[nodiscard]] const std::vector<Face>& faces() const { return faces_; }
  [[nodiscard]] const Face& face(std::uint32_t f) const { return faces_[f]; }
  [[nodiscard]] std::uint32_t begin(int chain) const { return chain == kInside ? 0 : split_; }
  [[nodiscard]] std::uint32_t end(int chain) const {
    return chain == kInside ? split_ : static_cast<std::uint32_t>(faces_.size());
  }
  [[nodiscard]] std::uint32_t count(int chain) const { return end(chain) - begin(chain); }

  [[nodiscard]] const Vec3& point(std::uint32_t vertex) const { return points_[vertex]; }
  [[nodiscard]] const Vec3& corner(std::uint32_t f, int k) const { return points_[faces_[f].v[k]]; }
  /// Length in the meshes' unit, and a point there, of what is one here.
  [[nodiscard]] double length_outside(double length) const { return length / scale_; }
  [[nodiscard]] Vec3 point_outside(const Vec3& p) const { return p / scale_; }
  [[nodiscard]] double scale() const { return scale_; }
  [[nodiscard]] bool scaled() const { return scaled_; }
  [[nodiscard]] std::size_t vertex_count() const { return points_.size(); }
  /// The largest |coordinate| of a face's corner; 0 without faces.
  [[nodiscard]] double largest_coordinate() const;

  /// Faces that touch both vertices of an edge are among these, in order of their numbers.
  [[nodiscard]] std::span<const std::uint32_t> around_edge(std::uint32_t u, std::uint32_t v) const {
    return around(first_[u + 1] - first_[u] <= first_[v + 1] - first_[v] ? u : v);
  }
  /// Faces that touch a vertex, in order of their numbers.
  [[nodiscard]] std::span<const std::uint32_t> around(std::uint32_t vertex) const {
    return {incident_.data() + first_[vertex], incident_.data() + first_[vertex + 1]};
  }

  /// The face across an edge from corner k to the next.
  [[nodiscard]] const Neighbour& neighbour(std::uint32_t f, int k) const {
    return neighbours_[f][k];
  }

  /// Every directed edge of the chain is cancelled by its opposite.
  [[nodiscard]] bool closed(int chain) const { return unbalanced(chain) == 0; }
  /// Outside minus inside is a closed chain.
  [[nodiscard]] bool same_border() const { return unbalanced_[2] == 0; }
  /// Number of the chain's edges that are not balanced.
  [[nodiscard]] std::size_t unbalanced(int chain) const { return unbalanced_[chain]; }

  [[nodiscard]] std::size_t without_area(int chain) const { return without_area_[chain]; }
  /// All of a chain's faces, those with repeated corners first, else as the mesh has them.
  [[nodiscard]] std::vector<Face> in_order_of_sources(int chain) const;
  /// The faces with repeated corners.
  [[nodiscard]] const std::vector<Face>& repeated(int chain) const { return repeated_[chain]; }

  /// Boxes of the faces with area.
  [[nodiscard]] const BoxTree& tree(int chain) const { return tree_[chain]; }

  /// Side of a point with respect to a face's plane; exact.
  [[nodiscard]] Sign side(std::uint32_t f, const Vec3& p) const {
    return geom::orient3d(corner(f, 0), corner(f, 1), corner(f, 2), p);
  }

 private:
  void rescale();
  void add_faces(int chain, std::span<Face> faces);
  void list_incidences();
  void find_neighbours();

  std::vector<Vec3> points_;
  double scale_ = 1;
  bool scaled_ = false;
  std::vector<Face> faces_;
  std::uint32_t split_ = 0;
  std::vector<std::uint32_t> first_, incident_;
  std::vector<std::array<Neighbour, 3>> neighbours_;
  std::array<std::size_t, 3> unbalanced_{};  // edges of either chain, and of their difference
  std::array<std::size_t, 2> without_area_{};
  std::array<std::vector<Face>, 2> repeated_;
  std::array<BoxTree, 2> tree_;
};

}  // namespace kaboum::verify
