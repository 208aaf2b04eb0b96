// Volume, area and box of exact shape and triangles. docs/algorithms/cad.md, "A second look"

#include "exact_integrals.h"

#include <BRepBndLib.hxx>
#include <BRepGProp.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Geom_Plane.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Face.hxx>

#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

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
      const double area = std::abs(exact.Mass()), slack = (std::abs(error) + kAccuracy) * area;
      const std::string name = "the area of face " + std::to_string(face + 1);
      const AreaBounds& bounds = result_.areas.at(face);
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
    allowed += std::abs(error) * std::abs(exact.Mass());
    if (!(std::abs(exact.Mass() - volume) <= allowed))
      refuse("the exact shape's volume", exact.Mass(), volume, allowed);
  }

 private:
  [[nodiscard]] const Vec3& point(std::uint32_t i) const { return result_.points[i]; }

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
