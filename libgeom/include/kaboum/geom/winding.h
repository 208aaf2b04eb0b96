#pragma once

#include <kaboum/geom/bvh.h>
#include <kaboum/geom/mesh.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>

namespace kaboum::geom {

/// Winding number of a mesh about points, exact.
///
/// For a closed chain it is the integer that says how often the surface goes round the point: the
/// solid is the closure of {w ≥ 1}. The number is the sum of signed crossings of a vertical ray
/// with the triangles. Rays through edges and vertices are told apart by a symbolic displacement of
/// the point, (x + ε, y + ε², z), so every sign is decided and nothing is counted twice. For an
/// open chain the result depends on the ray's direction and means nothing.
class WindingNumber {
 public:
  /// Keeps a reference to `mesh`, which must outlive this object.
  /// @param hierarchy  over the mesh (Bvh::of_parts is as good), where there is one already.
  /// @pre indices in range, coordinates finite.
  explicit WindingNumber(const Mesh& mesh, std::shared_ptr<const Bvh> hierarchy = nullptr);

  /// @return the winding number about p; nullopt if p lies on a triangle.
  [[nodiscard]] std::optional<int> operator()(const Vec3& p) const { return weighted(p, {}); }

  /// The same for the chain in which triangle i counts weight[i] times; triangles of weight 0 are
  /// not there. An empty span stands for weights of 1.
  [[nodiscard]] std::optional<int> weighted(const Vec3& p,
                                            std::span<const std::int8_t> weight) const;

  /// The terms of the number: calls visit(triangle, ±1) for each triangle that is crossed,
  /// and visit(triangle, 0) for each that p lies on. The sum over the triangles of a closed chain
  /// is the chain's winding number, unless p lies on it.
  void crossings(const Vec3& p, const std::function<void(std::uint32_t, int)>& visit) const;

 private:
  struct Hit;
  [[nodiscard]] Hit hit(const Vec3& p, std::uint32_t index) const;

  const Mesh& mesh_;
  std::shared_ptr<const Bvh> bvh_;
};

}  // namespace kaboum::geom
