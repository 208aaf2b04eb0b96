// Hulls and derivatives of curves. docs/algorithms/cad.md

#include "exact_curve.h"

#include <Geom2d_BSplineCurve.hxx>
#include <Geom2d_BezierCurve.hxx>
#include <Geom2d_Circle.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_Hyperbola.hxx>
#include <Geom2d_Line.hxx>
#include <Geom2d_Parabola.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BezierCurve.hxx>
#include <Geom_Circle.hxx>
#include <Geom_Ellipse.hxx>
#include <Geom_Hyperbola.hxx>
#include <Geom_Line.hxx>
#include <Geom_Parabola.hxx>
#include <Geom_TrimmedCurve.hxx>

#include <algorithm>
#include <cmath>
#include <limits>

namespace kaboum::io {
namespace {

constexpr int kParts = 8;      ///< of a knot interval, for bounds of derivatives
constexpr double kWidest = 1;  ///< half the angle of an arc with one triangle round it [rad]

/// OpenCASCADE's classes of curves in the plane and in space.
struct Plane {
  static constexpr int kSize = 2;
  using Curve = Geom2d_Curve;
  using Line = Geom2d_Line;
  using Circle = Geom2d_Circle;
  using Ellipse = Geom2d_Ellipse;
  using Hyperbola = Geom2d_Hyperbola;
  using Parabola = Geom2d_Parabola;
  using Bezier = Geom2d_BezierCurve;
  using BSpline = Geom2d_BSplineCurve;
  using Trimmed = Geom2d_TrimmedCurve;
};
struct Space {
  static constexpr int kSize = 3;
  using Curve = Geom_Curve;
  using Line = Geom_Line;
  using Circle = Geom_Circle;
  using Ellipse = Geom_Ellipse;
  using Hyperbola = Geom_Hyperbola;
  using Parabola = Geom_Parabola;
  using Bezier = Geom_BezierCurve;
  using BSpline = Geom_BSplineCurve;
  using Trimmed = Geom_TrimmedCurve;
};

template <int N, class T>
Eigen::Matrix<double, N, 1> vector_of(const T& p) {
  Eigen::Matrix<double, N, 1> out;
  for (int i = 0; i < N; ++i) out[i] = p.Coord(i + 1);
  return out;
}

template <int N, class C>
Spline<N> spline_of(const C& curve, int degree, const std::vector<double>& knots) {
  Spline<N> out;
  out.degree = degree;
  out.knots = knots;
  for (int i = 1; i <= curve.NbPoles(); ++i) {
    typename Spline<N>::Pole pole;
    pole[N] = curve.IsRational() ? curve.Weight(i) : 1;
    for (int j = 0; j < N; ++j) pole[j] = curve.Pole(i).Coord(j + 1) * pole[N];
    out.poles.push_back(pole);
  }
  return out;
}

}  // namespace

template <int N>
int Spline<N>::interval(double t) const {
  const auto begin = knots.begin() + first(), end = knots.begin() + last() + 1;
  int k = static_cast<int>(std::upper_bound(begin, end, t) - knots.begin()) - 1;
  k = std::clamp(k, first(), last());
  while (k > first() && !(knots[k] < knots[k + 1])) --k;
  while (k < last() && !(knots[k] < knots[k + 1])) ++k;
  return k;
}

template <int N>
int Spline<N>::interval_before(double b, int from) const {
  int k = interval(b);
  while (k > from && !(knots[k] < b)) --k;
  while (k > from && !(knots[k] < knots[k + 1])) --k;
  return k;
}

template <int N>
void Spline<N>::bezier(int k, double a, double b, std::vector<Pole>& out) const {
  out.clear();
  std::vector<Pole> d(static_cast<std::size_t>(degree) + 1);
  for (int i = 0; i <= degree; ++i) {
    for (int j = 0; j <= degree; ++j) d[j] = poles[k - degree + j];
    for (int r = 1; r <= degree; ++r) {
      const double t = r <= degree - i ? a : b;
      for (int j = degree; j >= r; --j) {
        const double low = knots[k - degree + j], high = knots[k + j - r + 1];
        const double s = (t - low) / (high - low);
        d[j] = (1 - s) * d[j - 1] + s * d[j];
      }
    }
    out.push_back(d[degree]);
  }
}

template <int N>
CurveDerivatives<N> bezier_derivatives(const std::vector<Eigen::Matrix<double, N + 1, 1>>& points,
                                       double length) {
  // The curve's distance from a point c in its middle is A/w with A the sum of B_i w_i (P_i - c);
  // quotients of A, w and their derivatives are bounded by their coefficients.
  using Pole = Eigen::Matrix<double, N + 1, 1>;
  using Point = Eigen::Matrix<double, N, 1>;
  const int p = static_cast<int>(points.size()) - 1;
  Point c = Point::Zero();
  for (const Pole& pole : points) c += pole.template head<N>() / pole[N];
  c /= p + 1;
  std::vector<Pole> q = points;
  for (Pole& pole : q) pole.template head<N>() -= c * pole[N];
  Pole d1 = Pole::Zero(), d2 = Pole::Zero();
  Point r = Point::Zero();
  double w = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= p; ++i) {
    w = std::min(w, q[i][N]);
    r = r.cwiseMax((q[i].template head<N>() / q[i][N]).cwiseAbs());
    if (i + 1 <= p) d1 = d1.cwiseMax((q[i + 1] - q[i]).cwiseAbs());
    if (i + 2 <= p) d2 = d2.cwiseMax((q[i + 2] - 2 * q[i + 1] + q[i]).cwiseAbs());
  }
  d1 *= p / length;
  d2 *= p * (p - 1) / length / length;
  CurveDerivatives<N> out;
  out.first = (d1.template head<N>() + d1[N] * r) / w;
  out.second = (d2.template head<N>() + 2 * d1[N] * out.first + d2[N] * r) / w;
  return out;
}

template <int N>
Cells Cells::of(const Spline<N>& spline, int parts) {
  Cells out;
  for (int k = spline.first(); k <= spline.last(); ++k) {
    const double low = spline.knots[k], high = spline.knots[k + 1];
    for (int i = 0; i < parts && low < high; ++i) {
      const double t = low + (high - low) * i / parts;
      if (!out.begin.empty() && !(out.begin.back() < t)) continue;  // too narrow to be divided
      out.begin.push_back(t);
      out.interval.push_back(k);
    }
  }
  out.begin.push_back(spline.knots[spline.last() + 1]);
  return out;
}

std::pair<std::size_t, std::size_t> Cells::range(double a, double b) const {
  const auto first = begin.begin(), last = begin.end() - 1;
  const auto low = std::upper_bound(first, last, a), high = std::lower_bound(first, last, b);
  const std::size_t i = low == first ? 0 : static_cast<std::size_t>(low - first) - 1;
  const std::size_t j = high == first ? 0 : static_cast<std::size_t>(high - first) - 1;
  return {i, std::max(i, j)};
}

template <int N>
void ExactCurve<N>::prepare() {
  if (kind_ != Kind::Spline) return;
  cells_ = Cells::of(spline_, spline_.degree > 1 ? kParts : 1);
  std::vector<typename Spline<N>::Pole> points;
  for (std::size_t i = 0; i < cells_.interval.size(); ++i) {
    spline_.bezier(cells_.interval[i], cells_.begin[i], cells_.begin[i + 1], points);
    bounds_.push_back(bezier_derivatives<N>(points, cells_.begin[i + 1] - cells_.begin[i]));
  }
}

template <int N>
typename ExactCurve<N>::Point ExactCurve<N>::value(double t) const {
  switch (kind_) {
    case Kind::Line:
      return origin_ + t * x_;
    case Kind::Ellipse:
      return origin_ + std::cos(t) * x_ + std::sin(t) * y_;
    case Kind::Hyperbola:
      return origin_ + std::cosh(t) * x_ + std::sinh(t) * y_;
    case Kind::Parabola:
      return origin_ + t * x_ + t * t * y_;
    case Kind::Spline:
      break;
  }
  const int p = spline_.degree, k = spline_.interval(t);
  std::vector<typename Spline<N>::Pole> d(spline_.poles.begin() + (k - p),
                                          spline_.poles.begin() + k + 1);
  for (int r = 1; r <= p; ++r)
    for (int j = p; j >= r; --j) {
      const double low = spline_.knots[k - p + j], high = spline_.knots[k + j - r + 1];
      const double s = (t - low) / (high - low);
      d[j] = (1 - s) * d[j - 1] + s * d[j];
    }
  return d[p].template head<N>() / d[p][N];
}

template <int N>
void ExactCurve<N>::add_hull(double a, double b, std::vector<Point>& out) const {
  const double middle = 0.5 * (a + b), half = 0.5 * (b - a);
  switch (kind_) {
    case Kind::Line:
      break;
    case Kind::Ellipse:
      if (half > kWidest) {
        add_hull(a, middle, out);
        add_hull(middle, b, out);
        return;
      }
      out.push_back(origin_ + (std::cos(middle) * x_ + std::sin(middle) * y_) / std::cos(half));
      break;
    case Kind::Hyperbola:
      out.push_back(origin_ + (std::cosh(middle) * x_ + std::sinh(middle) * y_) / std::cosh(half));
      break;
    case Kind::Parabola:
      out.push_back(origin_ + middle * x_ + a * b * y_);
      break;
    case Kind::Spline: {
      std::vector<typename Spline<N>::Pole> points;
      const int low = spline_.interval(a), high = spline_.interval_before(b, low);
      for (int k = low; k <= high; ++k) {
        if (!(spline_.knots[k] < spline_.knots[k + 1])) continue;
        const double from = k == low ? a : spline_.knots[k];
        const double to = k == high ? b : spline_.knots[k + 1];
        if (k != low && !(from < to)) continue;
        spline_.bezier(k, from, to, points);
        for (const auto& pole : points) out.push_back(pole.template head<N>() / pole[N]);
      }
      return;
    }
  }
  out.push_back(value(a));
  out.push_back(value(b));
}

template <int N>
CurveDerivatives<N> ExactCurve<N>::derivatives(double a, double b) const {
  const double t = std::max(std::abs(a), std::abs(b));
  const Point x = x_.cwiseAbs(), y = y_.cwiseAbs();
  CurveDerivatives<N> out;
  switch (kind_) {
    case Kind::Line:
      out.first = x;
      break;
    case Kind::Ellipse:
      out.first = (x.cwiseProduct(x) + y.cwiseProduct(y)).cwiseSqrt();
      out.second = out.first;
      break;
    case Kind::Hyperbola:
      out.first = std::sinh(t) * x + std::cosh(t) * y;
      out.second = std::cosh(t) * x + std::sinh(t) * y;
      break;
    case Kind::Parabola:
      out.first = x + 2 * t * y;
      out.second = 2 * y;
      break;
    case Kind::Spline:
      for (auto [i, last] = cells_.range(a, b); i <= last; ++i) {
        out.first = out.first.cwiseMax(bounds_[i].first);
        out.second = out.second.cwiseMax(bounds_[i].second);
      }
      break;
  }
  return out;
}

template <int N>
std::optional<double> ExactCurve<N>::kink(double a, double b) const {
  if (kind_ != Kind::Spline) return std::nullopt;
  for (int k = spline_.interval(a) + 1; k <= spline_.last(); ++k) {
    const double t = spline_.knots[k];
    if (!(t < b)) break;
    if (!(t > a)) continue;
    int count = 0;
    for (int i = k; i < static_cast<int>(spline_.knots.size()) && spline_.knots[i] == t; ++i)
      ++count;
    if (count >= spline_.degree) return t;
  }
  return std::nullopt;
}

template <int N>
std::pair<double, double> ExactCurve<N>::domain() const {
  constexpr double kFar = std::numeric_limits<double>::infinity();
  if (kind_ != Kind::Spline) return {-kFar, kFar};
  return {spline_.knots[spline_.first()], spline_.knots[spline_.last() + 1]};
}

std::vector<std::pair<double, double>> fold(double first, double last, double period, double a,
                                            double b) {
  if (!(period > 0)) return {{a, b}};
  if (b - a >= period) return {{first, last}};
  const double shift = std::floor((a - first) / period) * period;
  const auto within = [&](double t) { return std::clamp(t, first, last); };
  std::vector<std::pair<double, double>> out{{within(a - shift), within(b - shift)}};
  if (b - shift >= last) out.emplace_back(first, within(b - shift - period));
  if (a - shift <= first) out.emplace_back(last, last);  // where rounding ends on the other side
  return out;
}

template <int N>
std::vector<std::pair<double, double>> ExactCurve<N>::folded(double a, double b) const {
  const auto [first, last] = domain();
  return fold(first, last, period_, a, b);
}

namespace {

/// The basis without its trimming, and without a period.
template <class T, class Curve>
Curve untrimmed(Curve curve) {
  for (;;) {
    const Handle(typename T::Trimmed) trimmed = Handle(typename T::Trimmed)::DownCast(curve);
    if (trimmed.IsNull()) return curve;
    curve = trimmed->BasisCurve();
  }
}

}  // namespace

template <int N>
template <class Handles>
std::optional<ExactCurve<N>> ExactCurve<N>::make(const Handles& given) {
  using T = std::conditional_t<N == 2, Plane, Space>;
  const Handles curve = untrimmed<T>(given);
  ExactCurve out;
  const auto conic = [&](const auto& c, Kind kind, double a, double b) {
    out.kind_ = kind;
    out.origin_ = vector_of<N>(c->Location());
    out.x_ = a * vector_of<N>(c->XAxis().Direction());
    out.y_ = b * vector_of<N>(c->YAxis().Direction());
  };
  if (const auto line = Handle(typename T::Line)::DownCast(curve); !line.IsNull()) {
    out.origin_ = vector_of<N>(line->Position().Location());
    out.x_ = vector_of<N>(line->Position().Direction());
  } else if (const auto circle = Handle(typename T::Circle)::DownCast(curve); !circle.IsNull()) {
    conic(circle, Kind::Ellipse, circle->Radius(), circle->Radius());
  } else if (const auto ellipse = Handle(typename T::Ellipse)::DownCast(curve); !ellipse.IsNull()) {
    conic(ellipse, Kind::Ellipse, ellipse->MajorRadius(), ellipse->MinorRadius());
  } else if (const auto hyperbola = Handle(typename T::Hyperbola)::DownCast(curve);
             !hyperbola.IsNull()) {
    conic(hyperbola, Kind::Hyperbola, hyperbola->MajorRadius(), hyperbola->MinorRadius());
  } else if (const auto parabola = Handle(typename T::Parabola)::DownCast(curve);
             !parabola.IsNull()) {
    conic(parabola, Kind::Parabola, 1 / (4 * parabola->Focal()), 1);
    std::swap(out.x_, out.y_);
  } else if (const auto bezier = Handle(typename T::Bezier)::DownCast(curve); !bezier.IsNull()) {
    out.kind_ = Kind::Spline;
    std::vector<double> knots(static_cast<std::size_t>(bezier->Degree()) + 1, 0);
    knots.insert(knots.end(), knots.size(), 1);
    out.spline_ = spline_of<N>(*bezier, bezier->Degree(), knots);
  } else if (auto spline = Handle(typename T::BSpline)::DownCast(curve); !spline.IsNull()) {
    if (spline->IsPeriodic()) {
      out.period_ = spline->Period();
      spline = Handle(typename T::BSpline)::DownCast(spline->Copy());
      spline->SetNotPeriodic();
    }
    out.kind_ = Kind::Spline;
    std::vector<double> knots;
    for (int i = 1; i <= spline->NbKnots(); ++i)
      knots.insert(knots.end(), static_cast<std::size_t>(spline->Multiplicity(i)), spline->Knot(i));
    out.spline_ = spline_of<N>(*spline, spline->Degree(), knots);
  } else {
    return std::nullopt;
  }
  for (const auto& pole : out.spline_.poles)
    if (!(pole[N] > 0)) return std::nullopt;
  out.prepare();
  return out;
}

template <>
std::optional<ExactCurve<3>> ExactCurve<3>::of(const Handle(Geom_Curve) & curve) {
  return make(curve);
}
template <>
std::optional<ExactCurve<2>> ExactCurve<2>::of(const Handle(Geom2d_Curve) & curve) {
  return make(curve);
}

template class ExactCurve<2>;
template class ExactCurve<3>;
template struct Spline<2>;
template struct Spline<3>;
template Cells Cells::of<3>(const Spline<3>&, int);
template CurveDerivatives<3> bezier_derivatives<3>(const std::vector<Eigen::Matrix<double, 4, 1>>&,
                                                   double);

}  // namespace kaboum::io
