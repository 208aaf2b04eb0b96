#pragma once

#include <Eigen/Core>
#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>

#include <optional>
#include <utility>
#include <vector>

/// Curves of CAD files as sets that can be bounded between any two parameters.
/// docs/algorithms/cad.md
namespace kaboum::io {

/// A B-spline in homogeneous coordinates, without a period. Weights are positive.
template <int N>
struct Spline {
  using Pole = Eigen::Matrix<double, N + 1, 1>;

  int degree = 0;
  std::vector<double> knots;  ///< each as often as it counts
  std::vector<Pole> poles;    ///< coordinates times weight, weight

  /// First and last number of the knot intervals that are not empty.
  [[nodiscard]] int first() const { return degree; }
  [[nodiscard]] int last() const { return static_cast<int>(poles.size()) - 1; }
  /// The knot interval that holds t, or the nearest one.
  [[nodiscard]] int interval(double t) const;
  /// The last one that [a, b] meets in more than its end.
  [[nodiscard]] int interval_before(double b, int from) const;
  /// Bézier points of the piece of knot interval k between a and b: its polar form.
  void bezier(int k, double a, double b, std::vector<Pole>& out) const;
};

/// Bounds of the absolute values of first and second derivatives, by coordinate.
template <int N>
struct CurveDerivatives {
  using Point = Eigen::Matrix<double, N, 1>;
  Point first = Point::Zero(), second = Point::Zero();
};

template <int N>
class ExactCurve {
 public:
  using Point = Eigen::Matrix<double, N, 1>;

  [[nodiscard]] Point value(double t) const;
  /// Appends points whose convex hull holds the curve between a and b.
  void add_hull(double a, double b, std::vector<Point>& out) const;
  /// Of the curve between a and b; where it has a kink, of the pieces beside it.
  [[nodiscard]] CurveDerivatives<N> derivatives(double a, double b) const;
  /// A parameter strictly between a and b where the first derivative may jump.
  [[nodiscard]] std::optional<double> kink(double a, double b) const;
  [[nodiscard]] bool is_line() const { return kind_ == Kind::Line; }
  /// Parameters that it is defined between; infinite for lines and the like.
  [[nodiscard]] std::pair<double, double> domain() const;

  /// Nothing where the kind of curve cannot be bounded (offset curves).
  static std::optional<ExactCurve<3>> of(const Handle(Geom_Curve) & curve);
  static std::optional<ExactCurve<2>> of(const Handle(Geom2d_Curve) & curve);

 private:
  template <int>
  friend class ExactCurve;
  enum class Kind { Line, Ellipse, Hyperbola, Parabola, Spline };

  template <class Handles>
  static std::optional<ExactCurve> make(const Handles& curve);
  void prepare();

  Kind kind_ = Kind::Line;
  Point origin_ = Point::Zero(), x_ = Point::Zero(), y_ = Point::Zero();
  Spline<N> spline_;
  std::vector<CurveDerivatives<N>> bounds_;  ///< by knot interval
};

/// Bounds of derivatives of the rational Bézier curve with these points over an interval.
template <int N>
CurveDerivatives<N> bezier_derivatives(const std::vector<Eigen::Matrix<double, N + 1, 1>>& points,
                                       double length);

}  // namespace kaboum::io
