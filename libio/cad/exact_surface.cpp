// Derivatives of surfaces over boxes of parameters. docs/algorithms/cad.md

#include "exact_surface.h"

#include <GeomAdaptor_Surface.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_BezierSurface.hxx>
#include <Geom_ConicalSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_Plane.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SphericalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <Geom_ToroidalSurface.hxx>
#include <gp_Pnt.hxx>

#include <algorithm>
#include <cmath>

#include "exact_curve.h"

namespace kaboum::io {
namespace {

using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;

Vec3 vector_of(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }

/// Bounds of |sin| or |cos| between two angles, from above.
double most_sine(double a, double b) {
  // A peak is at pi/2 + k pi.
  const double k = std::ceil((a - M_PI_2) / M_PI);
  if (M_PI_2 + k * M_PI <= b) return 1;
  return std::max(std::abs(std::sin(a)), std::abs(std::sin(b)));
}
double most_cosine(double a, double b) { return most_sine(a + M_PI_2, b + M_PI_2); }

/// Planes, cylinders, cones, spheres, tori, and what is parallel to them.
class Elementary : public ExactSurface {
 public:
  enum class Kind { Plane, Cylinder, Cone, Sphere, Torus };
  Elementary(const Handle(Geom_Surface) & surface, Kind kind, double major, double minor,
             double angle)
      : at_(surface), kind_(kind), major_(major), minor_(minor), angle_(angle) {}

  Vec3 value(const Vec2& at) const override { return vector_of(at_.Value(at.x(), at.y()).XYZ()); }
  bool is_plane() const override { return kind_ == Kind::Plane; }

  SurfaceDerivatives derivatives(const Box2& box) const override {
    const double low = box.min().y(), high = box.max().y();
    switch (kind_) {
      case Kind::Plane:
        return {1, 1, 0, 0, 0};
      case Kind::Cylinder:
        return {major_, 1, major_, 0, 0};
      case Kind::Cone: {
        const double slope = std::abs(std::sin(angle_));
        const double r = std::max(std::abs(major_ + low * std::sin(angle_)),
                                  std::abs(major_ + high * std::sin(angle_))) +
                         minor_;
        return {r, 1, r, slope, 0};
      }
      case Kind::Sphere: {
        const double c = major_ * most_cosine(low, high), s = major_ * most_sine(low, high);
        return {c, major_, c, s, major_};
      }
      case Kind::Torus:
        break;
    }
    const double r = major_ + minor_ * most_cosine(low, high);
    return {r, minor_, r, minor_ * most_sine(low, high), minor_};
  }

 private:
  GeomAdaptor_Surface at_;
  Kind kind_;
  double major_, minor_;  ///< radii; of cones: by what it is parallel to another
  double angle_;
};

/// A curve moved along a line.
class Extrusion : public ExactSurface {
 public:
  Extrusion(const Handle(Geom_Surface) & surface, ExactCurve<3> curve)
      : at_(surface), curve_(std::move(curve)) {
    const auto [low, high] = curve_.domain();
    domain_.min().x() = low;
    domain_.max().x() = high;
    for (auto t = curve_.kink(low, high); t; t = curve_.kink(*t, high)) kinks_[0].push_back(*t);
  }
  Vec3 value(const Vec2& at) const override { return vector_of(at_.Value(at.x(), at.y()).XYZ()); }
  SurfaceDerivatives derivatives(const Box2& box) const override {
    const auto d = curve_.derivatives(box.min().x(), box.max().x());
    return {d.first.norm(), 1, d.second.norm(), 0, 0};
  }

 private:
  GeomAdaptor_Surface at_;
  ExactCurve<3> curve_;
};

/// A curve turned round an axis: u is the angle, v the curve's parameter.
class Revolution : public ExactSurface {
 public:
  Revolution(const Handle(Geom_Surface) & surface, ExactCurve<3> curve, const gp_Ax1& axis)
      : at_(surface),
        curve_(std::move(curve)),
        origin_(vector_of(axis.Location().XYZ())),
        axis_(vector_of(axis.Direction().XYZ())) {
    const auto [low, high] = curve_.domain();
    domain_.min().y() = low;
    domain_.max().y() = high;
    for (auto t = curve_.kink(low, high); t; t = curve_.kink(*t, high)) kinks_[1].push_back(*t);
  }
  Vec3 value(const Vec2& at) const override { return vector_of(at_.Value(at.x(), at.y()).XYZ()); }
  SurfaceDerivatives derivatives(const Box2& box) const override {
    const auto d = curve_.derivatives(box.min().y(), box.max().y());
    std::vector<Vec3> hull;
    curve_.add_hull(box.min().y(), box.max().y(), hull);
    double radius = 0;
    for (const Vec3& p : hull) radius = std::max(radius, axis_.cross(p - origin_).norm());
    return {radius, d.first.norm(), radius, d.first.norm(), d.second.norm()};
  }

 private:
  GeomAdaptor_Surface at_;
  ExactCurve<3> curve_;
  Vec3 origin_, axis_;
};

/// A (rational) B-spline or Bézier surface.
class SplineSurface : public ExactSurface {
 public:
  SplineSurface(const Handle(Geom_BSplineSurface) & s) : at_(s) {
    Handle(Geom_BSplineSurface) surface = s;
    if (s->IsUPeriodic() || s->IsVPeriodic()) {
      surface = Handle(Geom_BSplineSurface)::DownCast(s->Copy());
      if (s->IsUPeriodic()) surface->SetUNotPeriodic();
      if (s->IsVPeriodic()) surface->SetVNotPeriodic();
      period_ = {s->IsUPeriodic() ? s->UPeriod() : 0, s->IsVPeriodic() ? s->VPeriod() : 0};
    }
    std::vector<double> knots[2];
    for (int i = 1; i <= surface->NbUKnots(); ++i)
      add_knot(0, surface->UKnot(i), surface->UMultiplicity(i), surface->UDegree(), knots[0]);
    for (int i = 1; i <= surface->NbVKnots(); ++i)
      add_knot(1, surface->VKnot(i), surface->VMultiplicity(i), surface->VDegree(), knots[1]);
    u_.degree = surface->UDegree();
    u_.knots = knots[0];
    v_.degree = surface->VDegree();
    v_.knots = knots[1];
    rows_ = surface->NbUPoles();
    columns_ = surface->NbVPoles();
    u_.poles.resize(rows_);
    v_.poles.resize(columns_);
    const bool rational = surface->IsURational() || surface->IsVRational();
    for (int i = 1; i <= rows_; ++i)
      for (int j = 1; j <= columns_; ++j) {
        const double w = rational ? surface->Weight(i, j) : 1;
        const gp_Pnt p = surface->Pole(i, j);
        poles_.emplace_back(p.X() * w, p.Y() * w, p.Z() * w, w);
        positive_ = positive_ && w > 0;
        const double first_row = rational ? surface->Weight(1, j) : 1,
                     first_column = rational ? surface->Weight(i, 1) : 1;
        by_v_ = by_v_ && w == first_row;
        by_u_ = by_u_ && w == first_column;
      }
    known_.resize(u_.knots.size() * v_.knots.size());
    for (int d = 0; d < 2; ++d) {
      const Spline<3>& s1 = d == 0 ? u_ : v_;
      if (period_[d] > 0) continue;
      domain_.min()[d] = s1.knots[s1.first()];
      domain_.max()[d] = s1.knots[s1.last() + 1];
    }
  }
  [[nodiscard]] bool positive() const { return positive_; }

  Vec3 value(const Vec2& at) const override { return vector_of(at_.Value(at.x(), at.y()).XYZ()); }

  SurfaceDerivatives derivatives(const Box2& box) const override {
    std::vector<int> is, js;
    intervals(u_, 0, box.min().x(), box.max().x(), is);
    intervals(v_, 1, box.min().y(), box.max().y(), js);
    SurfaceDerivatives out;
    for (const int i : is)
      for (const int j : js) {
        const SurfaceDerivatives& d = of_intervals(i, j);
        out.u = std::max(out.u, d.u);
        out.v = std::max(out.v, d.v);
        out.uu = std::max(out.uu, d.uu);
        out.uv = std::max(out.uv, d.uv);
        out.vv = std::max(out.vv, d.vv);
      }
    return out;
  }

 private:
  void add_knot(int direction, double t, int count, int degree, std::vector<double>& out) {
    out.insert(out.end(), static_cast<std::size_t>(count), t);
    if (count >= degree) kinks_[direction].push_back(t);
  }

  /// Those that meet [a, b]; of a period, wherever it is repeated.
  void intervals(const Spline<3>& s, int direction, double a, double b,
                 std::vector<int>& out) const {
    const auto add = [&](double low, double high) {
      for (int k = s.interval(low), last = s.interval_before(high, k); k <= last; ++k)
        if (s.knots[k] < s.knots[k + 1]) out.push_back(k);
    };
    const double period = period_[direction];
    if (!(period > 0)) {
      add(a, b);
      return;
    }
    const double first = s.knots[s.first()], last = s.knots[s.last() + 1];
    if (b - a >= period) {
      add(first, last);
      return;
    }
    const double shift = std::floor((a - first) / period) * period;
    add(std::clamp(a - shift, first, last), std::clamp(b - shift, first, last));
    if (b - shift >= last) add(first, std::clamp(b - shift - period, first, last));
    if (a - shift <= first) add(last, last);  // where rounding ends on the other side
  }

  const SurfaceDerivatives& of_intervals(int i, int j) const {
    Known& known = known_[static_cast<std::size_t>(i) * v_.knots.size() + j];
    if (!known.is) {
      known.value = compute(i, j);
      known.is = true;
    }
    return known.value;
  }

  SurfaceDerivatives compute(int i, int j) const {
    const int p = u_.degree, q = v_.degree;
    // Bézier points of the patch: along u for each row of poles, then along v.
    std::vector<std::vector<Vec4>> half(q + 1);
    Spline<3> line = u_;
    for (int b = 0; b <= q; ++b) {
      for (int a = 0; a <= p; ++a)
        line.poles[i - p + a] =
            poles_[static_cast<std::size_t>(i - p + a) * columns_ + (j - q + b)];
      line.bezier(i, u_.knots[i], u_.knots[i + 1], half[b]);
    }
    std::vector<std::vector<Vec4>> net(p + 1);
    Spline<3> across = v_;
    for (int a = 0; a <= p; ++a) {
      for (int b = 0; b <= q; ++b) across.poles[j - q + b] = half[b][a];
      across.bezier(j, v_.knots[j], v_.knots[j + 1], net[a]);
    }
    const double hu = u_.knots[i + 1] - u_.knots[i], hv = v_.knots[j + 1] - v_.knots[j];
    if (by_v_) return of_rows(net, hu, hv);
    if (!by_u_) return bounds(net, hu, hv);
    std::vector<std::vector<Vec4>> turned(q + 1, std::vector<Vec4>(p + 1));
    for (int a = 0; a <= p; ++a)
      for (int b = 0; b <= q; ++b) turned[b][a] = net[a][b];
    const SurfaceDerivatives d = of_rows(turned, hv, hu);
    return {d.v, d.u, d.vv, d.uv, d.uu};
  }

  /// Of a surface whose weights are the same in each row: it is a Bézier curve of curves, one for
  /// each row.
  static SurfaceDerivatives of_rows(const std::vector<std::vector<Vec4>>& net, double hu,
                                    double hv) {
    const int p = static_cast<int>(net.size()) - 1;
    const auto point = [&](int a, std::size_t b) -> Vec3 {
      return net[a][b].head<3>() / net[a][b][3];
    };
    /// The rational curve with the weights of all rows.
    const auto curve = [&](const auto& of) {
      std::vector<Vec4> out;
      for (std::size_t b = 0; b < net[0].size(); ++b) {
        const double w = net[0][b][3];
        const Vec3 x = of(b) * w;
        out.emplace_back(x.x(), x.y(), x.z(), w);
      }
      return out;
    };
    SurfaceDerivatives out;
    for (int a = 0; a <= p; ++a) {
      const auto d =
          bezier_derivatives<3>(curve([&](std::size_t b) -> Vec3 { return point(a, b); }), hv);
      out.v = std::max(out.v, d.first.norm());
      out.vv = std::max(out.vv, d.second.norm());
      if (a == p) break;
      const auto step = [&](std::size_t b) -> Vec3 { return point(a + 1, b) - point(a, b); };
      out.uv = std::max(out.uv, p / hu * bezier_derivatives<3>(curve(step), hv).first.norm());
      for (std::size_t b = 0; b < net[0].size(); ++b) {
        out.u = std::max(out.u, p / hu * step(b).norm());
        if (a + 2 > p) continue;
        const Vec3 second = point(a + 2, b) - 2 * point(a + 1, b) + point(a, b);
        out.uu = std::max(out.uu, p * (p - 1) / hu / hu * second.norm());
      }
    }
    return out;
  }

  /// As for curves: quotients of A = sum of B_ab w_ab (P_ab - c) and w are bounded.
  static SurfaceDerivatives bounds(std::vector<std::vector<Vec4>>& net, double hu, double hv) {
    const int p = static_cast<int>(net.size()) - 1, q = static_cast<int>(net[0].size()) - 1;
    Vec3 c = Vec3::Zero();
    for (const auto& row : net)
      for (const Vec4& x : row) c += x.head<3>() / x[3];
    c /= (p + 1) * (q + 1);
    double w = std::numeric_limits<double>::infinity(), r = 0;
    for (auto& row : net)
      for (Vec4& x : row) {
        x.head<3>() -= c * x[3];
        w = std::min(w, x[3]);
        r = std::max(r, x.head<3>().norm() / x[3]);
      }
    struct Norm {
      double a = 0, w = 0;
      void take(const Vec4& d) {
        a = std::max(a, d.head<3>().norm());
        w = std::max(w, std::abs(d[3]));
      }
      void times(double f) {
        a *= f;
        w *= f;
      }
    } u, v, uu, uv, vv;
    for (int a = 0; a <= p; ++a)
      for (int b = 0; b <= q; ++b) {
        if (a < p) u.take(net[a + 1][b] - net[a][b]);
        if (b < q) v.take(net[a][b + 1] - net[a][b]);
        if (a + 1 < p) uu.take(net[a + 2][b] - 2 * net[a + 1][b] + net[a][b]);
        if (b + 1 < q) vv.take(net[a][b + 2] - 2 * net[a][b + 1] + net[a][b]);
        if (a < p && b < q) uv.take(net[a + 1][b + 1] - net[a + 1][b] - net[a][b + 1] + net[a][b]);
      }
    u.times(p / hu);
    v.times(q / hv);
    uu.times(p * (p - 1) / hu / hu);
    vv.times(q * (q - 1) / hv / hv);
    uv.times(p * q / hu / hv);
    SurfaceDerivatives out;
    out.u = (u.a + u.w * r) / w;
    out.v = (v.a + v.w * r) / w;
    out.uu = (uu.a + 2 * u.w * out.u + uu.w * r) / w;
    out.vv = (vv.a + 2 * v.w * out.v + vv.w * r) / w;
    out.uv = (uv.a + u.w * out.v + v.w * out.u + uv.w * r) / w;
    return out;
  }

  struct Known {
    bool is = false;
    SurfaceDerivatives value;
  };

  GeomAdaptor_Surface at_;
  Spline<3> u_, v_;  ///< knots and degrees; their poles are places for rows and columns
  int rows_ = 0, columns_ = 0;
  std::vector<Vec4> poles_;
  bool positive_ = true;
  bool by_u_ = true, by_v_ = true;  ///< weights depend on u, on v only
  mutable std::vector<Known> known_;
};

std::unique_ptr<ExactSurface> elementary(const Handle(Geom_Surface) & surface,
                                         const Handle(Geom_Surface) & basis, double offset) {
  using Kind = Elementary::Kind;
  const auto make = [&](Kind kind, double major, double minor, double angle) {
    return std::make_unique<Elementary>(surface, kind, major, minor, angle);
  };
  const double more = std::abs(offset);
  if (basis->IsKind(STANDARD_TYPE(Geom_Plane))) return make(Kind::Plane, 0, 0, 0);
  if (const auto s = Handle(Geom_CylindricalSurface)::DownCast(basis); !s.IsNull())
    return make(Kind::Cylinder, s->Radius() + more, 0, 0);
  if (const auto s = Handle(Geom_ConicalSurface)::DownCast(basis); !s.IsNull())
    return make(Kind::Cone, s->RefRadius(), more, s->SemiAngle());
  if (const auto s = Handle(Geom_SphericalSurface)::DownCast(basis); !s.IsNull())
    return make(Kind::Sphere, s->Radius() + more, 0, 0);
  if (const auto s = Handle(Geom_ToroidalSurface)::DownCast(basis); !s.IsNull())
    return make(Kind::Torus, s->MajorRadius(), s->MinorRadius() + more, 0);
  return nullptr;
}

}  // namespace

std::optional<double> ExactSurface::kink(int direction, double a, double b) const {
  const double period = period_[direction];
  std::optional<double> out;
  for (const double knot : kinks_[direction]) {
    const double t = period > 0 ? knot + std::ceil((a - knot) / period) * period : knot;
    for (const double at : {t, t + period})
      if (at > a && at < b && (!out || at < *out)) out = at;
  }
  return out;
}

Handle(Geom_Surface) untrimmed_surface(Handle(Geom_Surface) surface) {
  for (;;) {
    const auto trimmed = Handle(Geom_RectangularTrimmedSurface)::DownCast(surface);
    if (trimmed.IsNull()) return surface;
    surface = trimmed->BasisSurface();
  }
}

std::unique_ptr<ExactSurface> ExactSurface::of(const Handle(Geom_Surface) & given,
                                               std::string& kind) {
  const Handle(Geom_Surface) surface = untrimmed_surface(given);
  kind = surface->DynamicType()->Name();
  if (auto out = elementary(surface, surface, 0)) return out;
  if (const auto s = Handle(Geom_OffsetSurface)::DownCast(surface); !s.IsNull())
    return elementary(surface, untrimmed_surface(s->BasisSurface()), s->Offset());
  if (const auto s = Handle(Geom_SurfaceOfLinearExtrusion)::DownCast(surface); !s.IsNull()) {
    auto curve = ExactCurve<3>::of(s->BasisCurve());
    if (!curve) return nullptr;
    return std::make_unique<Extrusion>(surface, std::move(*curve));
  }
  if (const auto s = Handle(Geom_SurfaceOfRevolution)::DownCast(surface); !s.IsNull()) {
    auto curve = ExactCurve<3>::of(s->BasisCurve());
    if (!curve) return nullptr;
    return std::make_unique<Revolution>(surface, std::move(*curve), s->Axis());
  }
  Handle(Geom_BSplineSurface) spline = Handle(Geom_BSplineSurface)::DownCast(surface);
  if (const auto bezier = Handle(Geom_BezierSurface)::DownCast(surface); !bezier.IsNull()) {
    TColgp_Array2OfPnt poles(1, bezier->NbUPoles(), 1, bezier->NbVPoles());
    TColStd_Array2OfReal weights(1, bezier->NbUPoles(), 1, bezier->NbVPoles());
    bezier->Poles(poles);
    bezier->Weights(weights);
    TColStd_Array1OfReal ends(1, 2);
    ends(1) = 0;
    ends(2) = 1;
    TColStd_Array1OfInteger u(1, 2), v(1, 2);
    u.Init(bezier->UDegree() + 1);
    v.Init(bezier->VDegree() + 1);
    spline = new Geom_BSplineSurface(poles, weights, ends, ends, u, v, bezier->UDegree(),
                                     bezier->VDegree());
  }
  if (spline.IsNull()) return nullptr;
  auto out = std::make_unique<SplineSurface>(spline);
  if (!out->positive()) return nullptr;
  return out;
}

}  // namespace kaboum::io
