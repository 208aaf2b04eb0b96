// Points of the exact faces and edges of STEP and IGES files, by OpenCASCADE's evaluators, as a
// module that is loaded when such a file is judged.
//
// It is the second reading of such a file and shares nothing with the one that makes triangles
// (libio/cad) but OpenCASCADE's file readers. Points prove nothing; each is a point of the part up
// to the rounding of its evaluation, so that one outside refutes.

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Curve2d.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepTopAdaptor_FClass2d.hxx>
#include <BRep_Tool.hxx>
#include <IGESControl_Reader.hxx>
#include <Interface_CheckIterator.hxx>
#include <Precision.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Vertex.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <gp_Pnt.hxx>
#include <gp_Pnt2d.hxx>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "../src/point_list.h"

namespace kaboum::verify {
namespace {

constexpr std::size_t kMostPoints = 30'000'000;
constexpr std::size_t kLeastInCell = 3;  ///< parts of an interval between knots of a surface

/// What keeps a file from being judged.
[[noreturn]] void refuse(const std::string& why) { throw std::runtime_error(why); }

/// Parameters from the first to the last of `ends`: these, and between two of them so many parts.
std::vector<double> divided(const TColStd_Array1OfReal& ends, std::size_t parts) {
  std::vector<double> out{ends.First()};
  for (int i = ends.Lower(); i < ends.Upper(); ++i) {
    const double from = ends.Value(i), to = ends.Value(i + 1);
    for (std::size_t k = 1; k <= parts; ++k)
      out.push_back(k == parts ? to : from + (to - from) * static_cast<double>(k) /
                                                 static_cast<double>(parts));
  }
  return out;
}

/// A curve's parameters, dense between any two of its knots.
template <class Curve>
std::vector<double> parameters_of(const Curve& curve, std::size_t density) {
  TColStd_Array1OfReal ends(1, curve.NbIntervals(GeomAbs_CN) + 1);
  curve.Intervals(ends, GeomAbs_CN);
  return divided(ends, density);
}

class Sampler {
 public:
  Sampler(std::size_t density, PointList& result) : density_(density), result_(result) {}

  void add(const TopoDS_Face& face) {
    const BRepAdaptor_Surface surface(face, true);
    add_inside(face, surface);
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next())
      add_edge(TopoDS::Edge(at.Current()), face, surface);
    for (TopExp_Explorer at(face, TopAbs_VERTEX); at.More(); at.Next())
      if (vertices_.Add(at.Current())) add_point(BRep_Tool::Pnt(TopoDS::Vertex(at.Current())));
    ++result_.faces;
  }

 private:
  [[noreturn]] void refuse_face(const char* why) const {
    refuse("face " + std::to_string(result_.faces + 1) + " " + why);
  }

  void add_point(const gp_Pnt& p) {
    for (int i = 1; i <= 3; ++i) {
      if (!std::isfinite(p.Coord(i))) refuse_face("has points that are no numbers");
      result_.coordinates.push_back(p.Coord(i));
    }
    result_.of_face.push_back(static_cast<std::uint32_t>(result_.faces));
    if (result_.of_face.size() > kMostPoints)
      refuse("more points are to be looked at than fit; ask for fewer (--exact-points)");
  }

  /// @param ends  of intervals between knots
  [[nodiscard]] std::vector<double> of_surface(const TColStd_Array1OfReal& ends) const {
    if (Precision::IsInfinite(ends.First()) || Precision::IsInfinite(ends.Last()))
      refuse_face("has no bounds");
    const auto intervals = static_cast<std::size_t>(ends.Length() - 1);
    return divided(ends, std::max(kLeastInCell, (density_ + intervals - 1) / intervals));
  }

  /// Those of a grid that are inside the face's loops.
  void add_inside(const TopoDS_Face& face, const BRepAdaptor_Surface& surface) {
    TColStd_Array1OfReal u_ends(1, surface.NbUIntervals(GeomAbs_CN) + 1),
        v_ends(1, surface.NbVIntervals(GeomAbs_CN) + 1);
    surface.UIntervals(u_ends, GeomAbs_CN);
    surface.VIntervals(v_ends, GeomAbs_CN);
    BRepTopAdaptor_FClass2d loops(face, Precision::PConfusion());
    const std::vector<double> us = of_surface(u_ends), vs = of_surface(v_ends);
    for (const double u : us)
      for (const double v : vs)
        if (loops.Perform(gp_Pnt2d(u, v)) == TopAbs_IN) add_point(surface.Value(u, v));
  }

  void add_edge(const TopoDS_Edge& edge, const TopoDS_Face& face,
                const BRepAdaptor_Surface& surface) {
    if (edges_.Add(edge)) {
      ++result_.edges;
      if (!BRep_Tool::Degenerated(edge)) {
        const BRepAdaptor_Curve curve(edge);
        for (const double t : of_curve(curve)) add_point(curve.Value(t));
      }
    }
    // The same edge as the face has it: within the tolerance, but not the same.
    double first = 0, last = 0;
    if (BRep_Tool::CurveOnSurface(edge, face, first, last).IsNull()) return;
    const BRepAdaptor_Curve2d curve(edge, face);
    for (const double t : of_curve(curve)) {
      const gp_Pnt2d uv = curve.Value(t);
      add_point(surface.Value(uv.X(), uv.Y()));
    }
  }

  template <class Curve>
  [[nodiscard]] std::vector<double> of_curve(const Curve& curve) const {
    if (Precision::IsInfinite(curve.FirstParameter()) ||
        Precision::IsInfinite(curve.LastParameter()))
      refuse_face("has an edge without an end");
    return parameters_of(curve, density_);
  }

  std::size_t density_;
  PointList& result_;
  TopTools_MapOfShape edges_, vertices_;
};

/// Every root of the file became a shape, and nothing in it failed.
void require_transferred(XSControl_Reader& reader) {
  const int roots = reader.NbRootsForTransfer();
  if (roots == 0) refuse("the file has nothing that could be a part");
  const int done = reader.TransferRoots();
  if (done != roots)
    refuse("only " + std::to_string(done) + " of " + std::to_string(roots) +
           " parts of the file can be made of what is in it");
  for (int i = 1; i <= reader.NbShapes(); ++i)
    if (reader.Shape(i).IsNull()) refuse("part " + std::to_string(i) + " of the file is empty");
  Interface_CheckIterator checks = reader.WS()->TransferReader()->LastCheckList();
  for (checks.Start(); checks.More(); checks.Next())
    if (checks.Value()->HasFailed())
      refuse("entity " + std::to_string(checks.Number()) +
             " of the file cannot be made: " + checks.Value()->CFail(1));
}

void list(XSControl_Reader& reader, const char* path, std::size_t density, PointList& result) {
  if (reader.ReadFile(path) != IFSelect_RetDone)
    refuse("the file cannot be read; it is damaged or of another kind");
  require_transferred(reader);
  Sampler sampler(density, result);
  for (TopExp_Explorer at(reader.OneShape(), TopAbs_FACE); at.More(); at.Next())
    sampler.add(TopoDS::Face(at.Current()));
  if (result.faces == 0) refuse("the file has no faces");
}

}  // namespace
}  // namespace kaboum::verify

extern "C" __attribute__((visibility("default"))) void kaboum_list_exact_points(
    const char* path, bool iges, std::size_t density, kaboum::verify::PointList& result) {
  try {
    if (iges) {
      IGESControl_Reader reader;
      kaboum::verify::list(reader, path, density, result);
    } else {
      STEPControl_Reader reader;
      kaboum::verify::list(reader, path, density, result);
    }
  } catch (const Standard_Failure& failure) {
    result.error = std::string("OpenCASCADE failed: ") + failure.GetMessageString();
  } catch (const std::exception& failure) {
    result.error = failure.what();
  }
}
