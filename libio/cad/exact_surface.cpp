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
#include <unordered_map>

#include "exact_curve.h"

namespace kaboum::io {
namespace {

constexpr int kParts = 4;  ///< of a knot interval, for bounds of derivatives

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

/// Wherever the curve repeats.
CurveDerivatives<3> derivatives_of(const ExactCurve<3>& curve, double low, double high) {
  CurveDerivatives<3> out;
  for (const auto& [a, b] : curve.folded(low, high)) {
    const auto d = curve.derivatives(a, b);
    out.first = out.first.cwiseMax(d.first);
    out.second = out.second.cwiseMax(d.second);
  }
  return out;
}

/// A curve moved along a line.
class Extrusion : public ExactSurface {
 public:
  Extrusion(const Handle(Geom_Surface) & surface, ExactCurve<3> curve)
      : at_(surface), curve_(std::move(curve)) {
    take_curve(curve_, 0);
  }
  Vec3 value(const Vec2& at) const override { return vector_of(at_.Value(at.x(), at.y()).XYZ()); }
  SurfaceDerivatives derivatives(const Box2& box) const override {
    const auto d = derivatives_of(curve_, box.min().x(), box.max().x());
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
    take_curve(curve_, 1);
  }
  Vec3 value(const Vec2& at) const override { return vector_of(at_.Value(at.x(), at.y()).XYZ()); }
  SurfaceDerivatives derivatives(const Box2& box) const override {
    const auto d = derivatives_of(curve_, box.min().y(), box.max().y());
    std::vector<Vec3> hull;
    for (const auto& [a, b] : curve_.folded(box.min().y(), box.max().y()))
      curve_.add_hull(a, b, hull);
    double radius = 0;
    for (const Vec3& p : hull) radius = std::max(radius, axis_.cross(p - origin_).norm());
    // Only what the curve moves away from the axis turns with it.
    const Vec3 a = axis_.cwiseAbs(), f = d.first;
    const Vec3 away(a.y() * f.z() + a.z() * f.y(), a.z() * f.x() + a.x() * f.z(),
                    a.x() * f.y() + a.y() * f.x());
    return {radius, f.norm(), radius, std::min(f.norm(), away.norm()), d.second.norm()};
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
    u_cells_ = Cells::of(u_, u_.degree > 1 ? kParts : 1);
    v_cells_ = Cells::of(v_, v_.degree > 1 ? kParts : 1);
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
    std::vector<std::size_t> is, js;
    cells(u_cells_, 0, box.min().x(), box.max().x(), is);
    cells(v_cells_, 1, box.min().y(), box.max().y(), js);
    SurfaceDerivatives out;
    for (const std::size_t i : is)
      for (const std::size_t j : js) {
        const SurfaceDerivatives& d = of_cells(i, j);
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
  void cells(const Cells& s, int direction, double a, double b,
             std::vector<std::size_t>& out) const {
    const auto add = [&](double low, double high) {
      for (auto [k, last] = s.range(low, high); k <= last; ++k) out.push_back(k);
    };
    for (const auto& [low, high] : fold(s.begin.front(), s.begin.back(), period_[direction], a, b))
      add(low, high);
  }

  const SurfaceDerivatives& of_cells(std::size_t i, std::size_t j) const {
    const auto [at, fresh] = known_.try_emplace(i * v_cells_.interval.size() + j);
    if (fresh) at->second = compute(i, j);
    return at->second;
  }

  SurfaceDerivatives compute(std::size_t cell_i, std::size_t cell_j) const {
    const int p = u_.degree, q = v_.degree;
    const int i = u_cells_.interval[cell_i], j = v_cells_.interval[cell_j];
    const double u0 = u_cells_.begin[cell_i], u1 = u_cells_.begin[cell_i + 1];
    const double v0 = v_cells_.begin[cell_j], v1 = v_cells_.begin[cell_j + 1];
    // Bézier points of the patch: along u for each row of poles, then along v.
    std::vector<std::vector<Vec4>> half(q + 1);
    Spline<3> line = u_;
    for (int b = 0; b <= q; ++b) {
      for (int a = 0; a <= p; ++a)
        line.poles[i - p + a] =
            poles_[static_cast<std::size_t>(i - p + a) * columns_ + (j - q + b)];
      line.bezier(i, u0, u1, half[b]);
    }
    std::vector<std::vector<Vec4>> net(p + 1);
    Spline<3> across = v_;
    for (int a = 0; a <= p; ++a) {
      for (int b = 0; b <= q; ++b) across.poles[j - q + b] = half[b][a];
      across.bezier(j, v0, v1, net[a]);
    }
    const double hu = u1 - u0, hv = v1 - v0;
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

  GeomAdaptor_Surface at_;
  Spline<3> u_, v_;  ///< knots and degrees; their poles are places for rows and columns
  int rows_ = 0, columns_ = 0;
  std::vector<Vec4> poles_;
  bool positive_ = true;
  bool by_u_ = true, by_v_ = true;  ///< weights depend on u, on v only
  Cells u_cells_, v_cells_;
  mutable std::unordered_map<std::size_t, SurfaceDerivatives> known_;
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

void ExactSurface::take_curve(const ExactCurve<3>& curve, int direction) {
  const auto [low, high] = curve.domain();
  for (auto t = curve.kink(low, high); t; t = curve.kink(*t, high)) kinks_[direction].push_back(*t);
  period_[direction] = curve.period();
  if (curve.period() > 0) {
    kinks_[direction].push_back(low);  // where it starts; derivatives are bounded up to there
  } else {
    domain_.min()[direction] = low;
    domain_.max()[direction] = high;
  }
}

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
