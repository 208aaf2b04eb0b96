#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Geom_Surface.hxx>

#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "exact_curve.h"

/// Surfaces of CAD files, with bounds of their derivatives over boxes of parameters.
/// docs/algorithms/cad.md
namespace kaboum::io {

using Vec2 = Eigen::Vector2d;
using Box2 = Eigen::AlignedBox2d;

/// Bounds of the lengths of a surface's derivatives by its parameters u and v.
struct SurfaceDerivatives {
  double u = 0, v = 0, uu = 0, uv = 0, vv = 0;
};

class ExactSurface {
 public:
  ExactSurface() = default;
  ExactSurface(const ExactSurface&) = delete;
  ExactSurface& operator=(const ExactSurface&) = delete;
  virtual ~ExactSurface() = default;

  [[nodiscard]] virtual Eigen::Vector3d value(const Vec2& at) const = 0;
  /// Over the box; across kinks, of the pieces beside them.
  [[nodiscard]] virtual SurfaceDerivatives derivatives(const Box2& box) const = 0;

  /// A value of u (direction 0) or v (1) strictly between two others where first derivatives may
  /// jump.
  [[nodiscard]] std::optional<double> kink(int direction, double a, double b) const;
  /// The parameters that it is defined for; infinite where all are, or where it repeats.
  [[nodiscard]] const Box2& domain() const { return domain_; }
  [[nodiscard]] virtual bool is_plane() const { return false; }

  /// Null where the kind of surface cannot be bounded; `kind` is its name then.
  static std::unique_ptr<ExactSurface> of(const Handle(Geom_Surface) & surface, std::string& kind);

 protected:
  /// Of a surface that is a curve in this direction.
  void take_curve(const ExactCurve<3>& curve, int direction);

  std::array<std::vector<double>, 2> kinks_;  ///< in one period
  std::array<double, 2> period_{0, 0};        ///< 0: none
  Box2 domain_{Vec2::Constant(-std::numeric_limits<double>::infinity()),
               Vec2::Constant(std::numeric_limits<double>::infinity())};
};

/// The surface that a trimmed one is a part of.
Handle(Geom_Surface) untrimmed_surface(Handle(Geom_Surface) surface);

}  // namespace kaboum::io
