// Volume, area and box of exact shape and triangles. docs/algorithms/cad.md, "A second look"

#include "exact_integrals.h"

#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRepTools.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Geom2dAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <Geom_Plane.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <gp_Lin2d.hxx>
#include <gp_Pnt.hxx>
#include <gp_Pnt2d.hxx>
#include <gp_Vec.hxx>
#include <gp_Vec2d.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "exact_surface.h"

namespace kaboum::io {
namespace {

using geom::Vec3;

constexpr double kAccuracy = 1e-4;  ///< asked of integrals, as a share of their value

[[noreturn]] void refuse(const std::string& what, double exact, double of_triangles,
                         double allowed) {
  std::ostringstream text;
  text << what << " is " << exact << ", and of its triangles " << of_triangles
       << ": they may differ by " << allowed;
  throw std::runtime_error(text.str());
}

/// Integrals over faces, along their borders (Green's formula) and between all knots.
///
/// OpenCASCADE's own may miss what is between few knots, and state no error: they are done again
/// where they disagree with the triangles.
class KnotIntegral {
 public:
  /// @param about  where volumes are measured from
  KnotIntegral(const TopoDS_Face& face, const Vec3& about)
      : about_(about.x(), about.y(), about.z()) {
    face_ = TopoDS::Face(face.Oriented(TopAbs_FORWARD));
    sign_ = face.Orientation() == TopAbs_REVERSED ? -1 : 1;
    BRepTools::UVBounds(face_, low_[0], high_[0], low_[1], high_[1]);
    const Handle(Geom_Surface) surface = untrimmed_surface(BRep_Tool::Surface(face_));
    surface_.Load(surface);
    TColStd_Array1OfReal u(1, 1 + surface_.NbUIntervals(GeomAbs_CN)),
        v(1, 1 + surface_.NbVIntervals(GeomAbs_CN));
    surface_.UIntervals(u, GeomAbs_CN);
    surface_.VIntervals(v, GeomAbs_CN);
    add_knots(0, u, surface->IsUPeriodic() ? surface->UPeriod() : 0);
    add_knots(1, v, surface->IsVPeriodic() ? surface->VPeriod() : 0);
  }

  /// Its share of the volume, or its area. Nothing where finer sums do not settle.
  std::optional<double> operator()(bool volume) {
    volume_ = volume;
    double before = std::numeric_limits<double>::quiet_NaN();
    for (int parts = 1; parts <= kMostParts; parts *= 2) {
      const double sum = border(parts);
      if (std::abs(sum - before) <= kSettled * std::max(std::abs(sum), size_)) return sum;
      before = sum;
    }
    return std::nullopt;
  }

 private:
  static constexpr int kMostParts = 16;             ///< of each interval between knots
  static constexpr double kSettled = 1e-5;          ///< change by halves, as a share of the sum
  static constexpr std::size_t kMost = 40'000'000;  ///< evaluations

  /// Those of the face, wherever they repeat: OpenCASCADE knows them in one period only.
  void add_knots(int axis, const TColStd_Array1OfReal& knots, double period) {
    const double low = low_[axis], high = high_[axis];
    std::vector<double>& out = knots_[axis];
    out = {low, high};
    for (const double knot : knots) {
      double t = knot;
      if (period > 0) t += std::ceil((low - knot) / period) * period;
      for (; t < high; t += period) {
        if (t > low) out.push_back(t);
        if (!(period > 0)) break;
      }
    }
    std::sort(out.begin(), out.end());
  }

  /// Four points of Gauss in each part of [a, b].
  template <class F>
  static double gauss(double a, double b, int parts, const F& f) {
    constexpr std::array<double, 2> at{0.3399810435848563, 0.8611363115940526},
        weight{0.6521451548625461, 0.3478548451374538};
    double sum = 0;
    const double h = (b - a) / parts / 2;
    for (int k = 0; k < parts; ++k) {
      const double middle = a + (2 * k + 1) * h;
      for (int i = 0; i < 2; ++i)
        sum += weight[i] * h * (f(middle - at[i] * h) + f(middle + at[i] * h));
    }
    return sum;
  }

  double at(double u, double v) {
    gp_Pnt p;
    gp_Vec du, dv;
    surface_.D1(u, v, p, du, dv);
    ++evaluations_;
    const gp_Vec n = du.Crossed(dv);
    return volume_ ? gp_Vec(about_, p).Dot(n) / 3 : n.Magnitude();
  }

  /// From the least u of the face to this one.
  double along_u(double u, double v, int parts) {
    double sum = 0;
    for (std::size_t i = 0; i + 1 < knots_[0].size() && knots_[0][i] < u; ++i)
      sum += gauss(knots_[0][i], std::min(u, knots_[0][i + 1]), parts,
                   [&](double x) { return at(x, v); });
    return sum;
  }

  double border(int parts) {
    double sum = 0;
    size_ = 0;
    for (TopExp_Explorer e(face_, TopAbs_EDGE); e.More(); e.Next()) {
      const TopoDS_Edge edge = TopoDS::Edge(e.Current());
      if (edge.Orientation() != TopAbs_FORWARD && edge.Orientation() != TopAbs_REVERSED) continue;
      double a = 0, b = 0;
      const Handle(Geom2d_Curve) curve = BRep_Tool::CurveOnSurface(edge, face_, a, b);
      if (curve.IsNull()) continue;
      const std::vector<double> t = ends_of(curve, a, b);
      double part = 0;
      for (std::size_t i = 0; i + 1 < t.size() && evaluations_ < kMost; ++i)
        part += gauss(t[i], t[i + 1], parts, [&](double x) {
          gp_Pnt2d p;
          gp_Vec2d d;
          curve->D1(x, p, d);
          return d.Y() == 0 ? 0 : along_u(p.X(), p.Y(), parts) * d.Y();
        });
      sum += edge.Orientation() == TopAbs_REVERSED ? -part : part;
      size_ = std::max(size_, std::abs(part));
    }
    if (evaluations_ >= kMost) return std::numeric_limits<double>::quiet_NaN();
    return volume_ ? sign_ * sum : std::abs(sum);
  }

  /// Parameters between which curve and surface have no knots: lines meet each knot once.
  [[nodiscard]] std::vector<double> ends_of(const Handle(Geom2d_Curve) & curve, double a,
                                            double b) const {
    const Geom2dAdaptor_Curve adaptor(curve, a, b);
    TColStd_Array1OfReal own(1, 1 + adaptor.NbIntervals(GeomAbs_CN));
    adaptor.Intervals(own, GeomAbs_CN);
    std::vector<double> out(own.begin(), own.end());
    if (adaptor.GetType() == GeomAbs_Line) {
      const gp_Lin2d line = adaptor.Line();
      for (int axis = 0; axis < 2; ++axis)
        for (const double knot : knots_[axis]) {
          const double t =
              (knot - line.Location().Coord(axis + 1)) / line.Direction().Coord(axis + 1);
          if (t > a && t < b) out.push_back(t);
        }
    }
    std::sort(out.begin(), out.end());
    return out;
  }

  TopoDS_Face face_;
  gp_Pnt about_;
  int sign_ = 1;
  bool volume_ = false;
  std::array<double, 2> low_{}, high_{};
  std::array<std::vector<double>, 2> knots_;
  GeomAdaptor_Surface surface_;
  double size_ = 0;  ///< of the largest part of a sum
  std::size_t evaluations_ = 0;
};

class Integrals {
 public:
  Integrals(const TopoDS_Shape& shape, const ExactCover& cover, double deviation)
      : shape_(shape), result_(cover), deviation_(deviation) {}

  void check_box() const {
    Bnd_Box box;
    BRepBndLib::AddOptimal(shape_, box, false, false);
    if (box.IsVoid()) return;
    const gp_Pnt low = box.CornerMin(), high = box.CornerMax();
    const double allowed = deviation_ + box.GetGap();
    Vec3 least = result_.points.at(result_.triangles.at(0)[0]), most = least;
    for (const geom::Triangle& t : result_.triangles)
      for (const std::uint32_t i : t) {
        least = least.cwiseMin(result_.points[i]);
        most = most.cwiseMax(result_.points[i]);
      }
    for (int i = 0; i < 3; ++i) {
      const std::string side = std::string("the exact shape's box: its end in ") + "xyz"[i];
      // The other way round says nothing: OpenCASCADE's boxes miss what is thin.
      if (!(low.Coord(i + 1) >= least[i] - allowed))
        refuse(side, low.Coord(i + 1), least[i], allowed);
      if (!(high.Coord(i + 1) <= most[i] + allowed))
        refuse(side, high.Coord(i + 1), most[i], allowed);
    }
  }

  void check_areas() const {
    std::size_t face = 0, begin = 0;
    for (TopExp_Explorer at(shape_, TopAbs_FACE); at.More(); at.Next(), ++face) {
      const std::size_t end = result_.ends.at(face);
      const TopoDS_Face f = TopoDS::Face(at.Current());
      GProp_GProps exact;
      const double error = BRepGProp::SurfaceProperties(f, exact, kAccuracy);
      double area = std::abs(exact.Mass()), slack = (std::abs(error) + kAccuracy) * area;
      const std::string name = "the area of face " + std::to_string(face + 1);
      const AreaBounds& bounds = result_.areas.at(face);
      if (!(std::abs(area - std::abs(bounds.value)) <= bounds.error + slack)) {
        area = KnotIntegral(f, Vec3::Zero())(false).value_or(area);
        slack = kAccuracy * area;
      }
      if (!(std::abs(area - std::abs(bounds.value)) <= bounds.error + slack))
        refuse(name, area, std::abs(bounds.value), bounds.error + slack);
      if (untrimmed_surface(BRep_Tool::Surface(f))->IsKind(STANDARD_TYPE(Geom_Plane)))
        check_plane_area(area, slack, name, begin, end);
      begin = end;
    }
  }

  void check_volume() const {
    if (!is_closed()) return;
    const Vec3 middle = result_.points.at(result_.triangles.at(0)[0]);
    double volume = 0, allowed = 0;
    for (const geom::Triangle& t : result_.triangles) {
      const Vec3 a = point(t[0]) - middle, b = point(t[1]) - middle, c = point(t[2]) - middle;
      volume += a.dot(b.cross(c)) / 6;
      allowed += ball_sum((b - a).cross(c - a).norm() / 2,
                          (b - a).norm() + (c - b).norm() + (a - c).norm());
    }
    GProp_GProps exact;
    const double error = BRepGProp::VolumeProperties(shape_, exact, kAccuracy);
    const double stated = exact.Mass(), slack = std::abs(error) * std::abs(stated);
    if (std::abs(stated - volume) <= allowed + slack) return;
    const std::optional<double> finer = finer_volume(middle);
    if (!finer) refuse("the exact shape's volume", stated, volume, allowed + slack);
    allowed += kAccuracy * std::abs(*finer);
    if (!(std::abs(*finer - volume) <= allowed))
      refuse("the exact shape's volume", *finer, volume, allowed);
  }

 private:
  [[nodiscard]] const Vec3& point(std::uint32_t i) const { return result_.points[i]; }

  [[nodiscard]] std::optional<double> finer_volume(const Vec3& about) const {
    double sum = 0;
    for (TopExp_Explorer at(shape_, TopAbs_FACE); at.More(); at.Next()) {
      const std::optional<double> part = KnotIntegral(TopoDS::Face(at.Current()), about)(true);
      if (!part) return std::nullopt;
      sum += *part;
    }
    return sum;
  }

  /// Volume of all points within the deviation of a triangle.
  [[nodiscard]] double ball_sum(double area, double perimeter) const {
    const double d = deviation_;
    return 2 * d * area + M_PI * d * d * perimeter / 2 + 4 * M_PI * d * d * d / 3;
  }

  [[nodiscard]] bool is_closed() const {
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sum;
    for (const geom::Triangle& t : result_.triangles)
      for (int i = 0; i < 3; ++i) {
        const std::uint32_t a = t[i], b = t[(i + 1) % 3];
        if (a < b) ++sum[{a, b}];
        if (b < a) --sum[{b, a}];
      }
    for (const auto& side : sum)
      if (side.second != 0) return false;
    return true;
  }

  void check_plane_area(double area, double slack, const std::string& name, std::size_t begin,
                        std::size_t end) const {
    Vec3 twice = Vec3::Zero();
    std::map<std::pair<std::uint32_t, std::uint32_t>, int> sides;
    for (std::size_t i = begin; i < end; ++i) {
      const geom::Triangle& t = result_.triangles[i];
      twice += (point(t[1]) - point(t[0])).cross(point(t[2]) - point(t[0]));
      for (int k = 0; k < 3; ++k) {
        const std::uint32_t a = t[k], b = t[(k + 1) % 3];
        ++sides[std::minmax(a, b)];
      }
    }
    const double d = deviation_;
    double allowed = slack;
    for (const auto& [side, count] : sides)
      if (count == 1)
        allowed += 2 * d * (point(side.first) - point(side.second)).norm() + M_PI * d * d;
    if (!(std::abs(area - twice.norm() / 2) <= allowed))
      refuse(name, area, twice.norm() / 2, allowed);
  }

  const TopoDS_Shape& shape_;
  const ExactCover& result_;
  double deviation_;
};

}  // namespace

void check_integrals(const TopoDS_Shape& shape, const ExactCover& cover, double deviation,
                     bool solid) {
  const Integrals integrals(shape, cover, deviation);
  integrals.check_box();
  integrals.check_areas();
  if (solid) integrals.check_volume();
}

}  // namespace kaboum::io
