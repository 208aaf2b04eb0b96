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

/// Parts of knot intervals, for which derivatives are bounded.
struct Cells {
  std::vector<double> begin;  ///< of each; and the end of the last
  std::vector<int> interval;  ///< knot interval of each

  /// @param parts  of each interval
  template <int N>
  static Cells of(const Spline<N>& spline, int parts);
  /// First and last one that meet [a, b]; the nearest ones beyond their ends.
  [[nodiscard]] std::pair<std::size_t, std::size_t> range(double a, double b) const;
};

/// Parts of [first, last] that [a, b] stands for, where what is there repeats with a period.
std::vector<std::pair<double, double>> fold(double first, double last, double period, double a,
                                            double b);

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
  /// Of what it was made of: with this period that repeats beyond the domain; 0: it does not.
  [[nodiscard]] double period() const { return period_; }
  /// Parts of the domain that [a, b] stands for where the curve repeats.
  [[nodiscard]] std::vector<std::pair<double, double>> folded(double a, double b) const;

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
  double period_ = 0;
  Point origin_ = Point::Zero(), x_ = Point::Zero(), y_ = Point::Zero();
  Spline<N> spline_;
  Cells cells_;                              ///< of the spline
  std::vector<CurveDerivatives<N>> bounds_;  ///< by cell
};

/// Bounds of derivatives of the rational Bézier curve with these points over an interval.
template <int N>
CurveDerivatives<N> bezier_derivatives(const std::vector<Eigen::Matrix<double, N + 1, 1>>& points,
                                       double length);

}  // namespace kaboum::io
