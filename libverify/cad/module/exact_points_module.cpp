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
#include <IGESData_IGESEntity.hxx>
#include <IGESGeom_BoundedSurface.hxx>
#include <IGESGeom_TrimmedSurface.hxx>
#include <IGESSolid_Face.hxx>
#include <Interface_CheckIterator.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Precision.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepData_StepModel.hxx>
#include <StepData_UndefinedEntity.hxx>
#include <StepGeom_BoundedSurface.hxx>
#include <StepGeom_CurveBoundedSurface.hxx>
#include <StepGeom_RectangularTrimmedSurface.hxx>
#include <StepGeom_Surface.hxx>
#include <StepShape_FaceSurface.hxx>
#include <StepShape_GeometricSet.hxx>
#include <StepShape_GeometricSetSelect.hxx>
#include <StepShape_ShapeRepresentation.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_MapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Shape.hxx>
#include <TopoDS_Vertex.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <gp_Pnt.hxx>
#include <gp_Pnt2d.hxx>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>
#include <stdexcept>
#include <string>
#include <unordered_set>

#include "../src/point_list.h"
#include "harmless.h"

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
      out.push_back(k == parts
                        ? to
                        : from + (to - from) * static_cast<double>(k) / static_cast<double>(parts));
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
      refuse("more points are to be looked at than fit; ask for fewer («exact-points»)");
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

/// What the file calls the entity: "entity #12".
std::string name_of(const Handle(Interface_InterfaceModel) & model, int entity) {
  if (entity <= 0 || entity > model->NbEntities()) return "the file";
  return "entity " + std::string(model->StringLabel(model->Value(entity))->ToCString());
}

/// Entities that may be wrong without a change of the shape.
class Harmless {
 public:
  Harmless(const char* path, bool iges) {
    if (iges) return;
    std::ifstream file(path, std::ios::binary);
    numbers_ = harmless_in_step(std::string{std::istreambuf_iterator<char>(file), {}});
  }
  [[nodiscard]] bool operator()(const Handle(Interface_InterfaceModel) & model, int entity) const {
    if (entity <= 0 || entity > model->NbEntities()) return false;
    const Handle(StepData_StepModel) step = Handle(StepData_StepModel)::DownCast(model);
    if (!step.IsNull()) return numbers_.contains(step->IdentLabel(model->Value(entity)));
    const auto iges = Handle(IGESData_IGESEntity)::DownCast(model->Value(entity));
    return !iges.IsNull() && harmless_in_iges(iges->TypeNumber());
  }

 private:
  std::unordered_set<int> numbers_;
};

void require_none_failed(const XSControl_Reader& reader, const Interface_CheckIterator& checks,
                         const Harmless& harmless, const char* what) {
  for (checks.Start(); checks.More(); checks.Next())
    if (checks.Value()->HasFailed() && !harmless(reader.Model(), checks.Number()))
      refuse(name_of(reader.Model(), checks.Number()) + " " + what + ": " +
             checks.Value()->CFail(1));
}

/// Every root of the file became a shape, and nothing in it failed.
void require_transferred(XSControl_Reader& reader, const Harmless& harmless) {
  const int roots = reader.NbRootsForTransfer();
  if (roots == 0) refuse("the file has nothing that could be a part");
  const int done = reader.TransferRoots();
  if (done != roots)
    refuse("only " + std::to_string(done) + " of " + std::to_string(roots) +
           " parts of the file can be made of what is in it");
  for (int i = 1; i <= reader.NbShapes(); ++i)
    if (reader.Shape(i).IsNull()) refuse("part " + std::to_string(i) + " of the file is empty");
  require_none_failed(reader, reader.WS()->ModelCheckList(false), harmless,
                      "is not what it should be");
  require_none_failed(reader, reader.WS()->TransferReader()->LastCheckList(), harmless,
                      "cannot be made");
}

/// Whether an entity that OpenCASCADE does not know may carry a face, by its name in the file.
bool may_have_faces(const std::string& name) {
  for (const char* word :
       {"FACE", "SHELL", "SOLID", "BREP", "TESSELLATED", "TRIANGULATED", "SURFACE", "VOLUME", "CSG",
        "BLOCK", "SPHERE", "TORUS", "CYLINDER", "CONE", "WEDGE", "MAPPED_ITEM"})
    if (name.find(word) != std::string::npos) return true;
  return false;
}

bool is_face(const Handle(Standard_Transient) & entity) {
  return entity->IsKind(STANDARD_TYPE(StepShape_FaceSurface)) ||
         entity->IsKind(STANDARD_TYPE(IGESSolid_Face)) ||
         entity->IsKind(STANDARD_TYPE(IGESGeom_TrimmedSurface)) ||
         entity->IsKind(STANDARD_TYPE(IGESGeom_BoundedSurface));
}

/// @param shape  that was made of a face
void require_in(const std::set<const void*>& part, const TopoDS_Shape& shape,
                const std::string& label) {
  bool found = false;
  if (!shape.IsNull())
    for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next())
      found = found || part.contains(at.Current().TShape().get());
  if (!found) refuse(label + " is a face that no part of the file has");
}

/// Surfaces that are faces by themselves: those of geometric sets.
std::vector<Handle(Standard_Transient)> surfaces_of(const Handle(Standard_Transient) & entity) {
  std::vector<Handle(Standard_Transient)> out;
  const auto set = Handle(StepShape_GeometricSet)::DownCast(entity);
  for (int i = 1; !set.IsNull() && i <= set->NbElements(); ++i) {
    const Handle(Standard_Transient) element = set->ElementsValue(i).Value();
    if (!element.IsNull() && element->IsKind(STANDARD_TYPE(StepGeom_Surface)))
      out.push_back(element);
  }
  return out;
}

/// Bounded surfaces that a representation holds, and trimmed ones that nothing holds, are no face
/// of a part.
void require_no_loose_surfaces(const Handle(Interface_InterfaceModel) & model) {
  const Interface_Graph graph(model);
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    if (!entity->IsKind(STANDARD_TYPE(StepGeom_BoundedSurface))) continue;
    bool loose = false, held = false;
    for (Interface_EntityIterator at = graph.Sharings(entity); at.More(); at.Next()) {
      held = true;
      loose = loose || at.Value()->IsKind(STANDARD_TYPE(StepShape_ShapeRepresentation));
    }
    const bool trimmed = entity->IsKind(STANDARD_TYPE(StepGeom_RectangularTrimmedSurface)) ||
                         entity->IsKind(STANDARD_TYPE(StepGeom_CurveBoundedSurface));
    if (loose || (trimmed && !held))
      refuse(name_of(model, i) + " is a surface that no part of the file has");
  }
}

/// Every face that the file has is one of the part's, wherever it is placed.
void require_faces_of(XSControl_Reader& reader, const TopoDS_Shape& part) {
  std::set<const void*> in_part;
  for (TopExp_Explorer at(part, TopAbs_FACE); at.More(); at.Next())
    in_part.insert(at.Current().TShape().get());
  const Handle(Interface_InterfaceModel) model = reader.Model();
  const Handle(Transfer_TransientProcess) process =
      reader.WS()->TransferReader()->TransientProcess();
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Handle(Standard_Transient) entity = model->Value(i);
    const std::string label = name_of(model, i);
    const Handle(StepData_UndefinedEntity) unknown =
        Handle(StepData_UndefinedEntity)::DownCast(entity);
    if (!unknown.IsNull() && may_have_faces(unknown->StepType()))
      refuse(label + " is of a type that cannot be read, " + unknown->StepType());
    for (const Handle(Standard_Transient) & surface : surfaces_of(entity))
      require_in(in_part, TransferBRep::ShapeResult(process, surface),
                 name_of(model, model->Number(surface)));
    if (is_face(entity)) require_in(in_part, TransferBRep::ShapeResult(process, entity), label);
  }
  require_no_loose_surfaces(model);
}

void list(XSControl_Reader& reader, const char* path, bool iges, std::size_t density,
          PointList& result) {
  if (reader.ReadFile(path) != IFSelect_RetDone)
    refuse("the file cannot be read; it is damaged or of another kind");
  require_transferred(reader, Harmless(path, iges));
  const TopoDS_Shape part = reader.OneShape();
  require_faces_of(reader, part);
  Sampler sampler(density, result);
  for (TopExp_Explorer at(part, TopAbs_FACE); at.More(); at.Next())
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
      kaboum::verify::list(reader, path, iges, density, result);
    } else {
      STEPControl_Reader reader;
      kaboum::verify::list(reader, path, iges, density, result);
    }
  } catch (const Standard_Failure& failure) {
    result.error = std::string("OpenCASCADE failed: ") + failure.GetMessageString();
  } catch (const std::exception& failure) {
    result.error = failure.what();
  }
}
