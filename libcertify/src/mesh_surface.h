#pragma once

#include <kaboum/certify/mesh_certificate.h>
#include <kaboum/geom/prepare.h>

#include <vector>

// The surface claim about bounding meshes. Internal to kaboum_certify.
namespace kaboum::certify {

/// The triangles that are claimed to lie in a result's solid: those of the original, then the walls
/// that cancelled when it was prepared.
class ClaimedSurface {
 public:
  /// The original is referred to.
  explicit ClaimedSurface(const geom::Prepared& original);

  [[nodiscard]] const geom::Mesh& mesh() const {
    return original_.report.left_out.empty() ? original_.solid.mesh() : with_walls_;
  }
  /// Of mesh(): those that the solid claim does not protect.
  [[nodiscard]] const std::vector<std::uint32_t>& loose();
  /// The triangle of the input that triangle `t` of mesh() was; kFill: one that fills a hole.
  [[nodiscard]] std::uint32_t source(std::uint32_t t) const;
  static constexpr std::uint32_t kFill = 0xFFFFFFFF;

 private:
  const geom::Prepared& original_;
  geom::Mesh with_walls_;
  bool looked_ = false;
  std::vector<std::uint32_t> loose_;
};

/// What is allowed to be done for the surface claim of one result. [s]
/// @param allowed  for everything
/// @param done     by decimation
double work_for_surface(double allowed, double done, std::size_t results);

/// Decides within `work` whether triangles of `from` lie in the solid of `to`.
/// @param triangles  of `from`; of the others it is known
DecidedSurface decide_surface(const geom::Mesh& from, const std::vector<std::uint32_t>& triangles,
                              const geom::Mesh& to, double work);

/// How far the triangles of a claim that is refuted stick out, within `work`.
/// @pre no triangle is left open
void measure_sticking_out(const geom::Mesh& from, const geom::Mesh& to, double work,
                          DecidedSurface& surface);

}  // namespace kaboum::certify
