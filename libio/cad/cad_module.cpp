// STEP and IGES by OpenCASCADE, as a module that is loaded when such a file is read: its libraries
// take longer to load than most programs run.
//
// Faces are made into triangles by its incremental mesher. Nodes on edges and vertices get one
// point each, whichever face they are asked of, so that solids are closed. The deviation is
// measured: at the nodes of a fine grid in the parameters of every triangle, from the exact surface
// to the triangle.

#include <BRepAdaptor_Surface.hxx>
#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IGESControl_Reader.hxx>
#include <Poly_PolygonOnTriangulation.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeAnalysis_ShapeTolerance.hxx>
#include <Standard_Failure.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Vertex.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>
#include <gp_Pnt.hxx>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "../src/cad_shape.h"

namespace kaboum::io {
namespace {

using geom::Vec3;

constexpr double kChord = 2e-4;  ///< wished deviation, as a share of the shape's diagonal
constexpr double kAngle = 0.35;  ///< between neighbouring triangles [rad]
constexpr int kGrid = 4;         ///< samples divide a triangle's sides by this
constexpr double kBetween = 2;   ///< the deviation between samples, in that at samples

Vec3 vector_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

double distance_to_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const Vec3 ab = b - a;
  const double length = ab.squaredNorm();
  const double t = length > 0 ? std::clamp((p - a).dot(ab) / length, 0.0, 1.0) : 0;
  return (p - a - t * ab).norm();
}

double distance_to_triangle(const Vec3& p, const std::array<Vec3, 3>& t) {
  const Vec3 n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double twice = n.norm();
  bool above = twice > 0;
  for (int i = 0; i < 3 && above; ++i) above = n.dot((t[(i + 1) % 3] - t[i]).cross(p - t[i])) >= 0;
  if (above) return std::abs(n.dot(p - t[0])) / twice;
  return std::min({distance_to_segment(p, t[0], t[1]), distance_to_segment(p, t[1], t[2]),
                   distance_to_segment(p, t[2], t[0])});
}

/// Takes the triangles of all faces of a meshed shape.
class Collector {
 public:
  /// @param chord  that was wished for: nearer triangles than that are not looked for
  Collector(const TopoDS_Shape& shape, double chord, CadShape& result)
      : result_(result), chord_(chord) {
    TopExp::MapShapes(shape, TopAbs_EDGE, edges_);
    TopExp::MapShapes(shape, TopAbs_VERTEX, vertices_);
  }

  void add_face(const TopoDS_Face& face) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
    if (mesh.IsNull()) {
      ++result_.bare_faces;
      return;
    }
    std::vector<std::uint32_t> number(static_cast<std::size_t>(mesh->NbNodes()) + 1, 0);
    name_border(face, mesh, location, number);
    std::vector<Vec3> point(number.size());
    for (int i = 1; i <= mesh->NbNodes(); ++i) {
      const Vec3 own = vector_of(mesh->Node(i).Transformed(location.Transformation()));
      if (number[i] == 0) {
        result_.points.push_back(own);
        number[i] = static_cast<std::uint32_t>(result_.points.size());
      }
      point[i] = result_.points[number[i] - 1];
      result_.deviation = std::max(result_.deviation, (point[i] - own).norm());
    }
    std::vector<std::array<int, 3>> nodes;
    std::vector<std::array<Vec3, 3>> corners;
    for (int t = 1; t <= mesh->NbTriangles(); ++t) {
      std::array<int, 3> n{};
      mesh->Triangle(t).Get(n[0], n[1], n[2]);
      nodes.push_back(n);
      corners.push_back({point[n[0]], point[n[1]], point[n[2]]});
      if (face.Orientation() == TopAbs_REVERSED) std::swap(n[1], n[2]);
      result_.triangles.push_back({number[n[0]] - 1, number[n[1]] - 1, number[n[2]] - 1});
    }
    if (!mesh->HasUVNodes()) {
      ++result_.bare_faces;
      return;
    }
    const BRepAdaptor_Surface surface(face);
    for (std::size_t t = 0; t < nodes.size(); ++t) measure(surface, mesh, nodes[t], t, corners);
  }

 private:
  /// Nodes on edges and vertices: one number for all faces that they are on.
  void name_border(const TopoDS_Face& face, const Handle(Poly_Triangulation) & mesh,
                   const TopLoc_Location& location, std::vector<std::uint32_t>& number) {
    poles_.clear();
    for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
      const TopoDS_Edge edge = TopoDS::Edge(at.Current());
      const Handle(Poly_PolygonOnTriangulation) polygon =
          BRep_Tool::PolygonOnTriangulation(edge, mesh, location);
      if (polygon.IsNull()) continue;
      const int count = polygon->NbNodes(), index = edges_.FindIndex(edge);
      const int first = vertices_.FindIndex(TopExp::FirstVertex(edge)),
                last = vertices_.FindIndex(TopExp::LastVertex(edge));
      for (int i = 1; i <= count; ++i) {
        std::pair<int, int> key{index, i};
        if (i == 1 || BRep_Tool::Degenerated(edge)) {
          key = {-1, first};
        } else if (i == count) {
          key = {-1, last};
        }
        std::uint32_t& known = border_[key];
        const int node = polygon->Node(i);
        if (BRep_Tool::Degenerated(edge)) poles_[node] = free_parameter(edge, face);
        if (known == 0) {
          result_.points.push_back(
              vector_of(mesh->Node(node).Transformed(location.Transformation())));
          known = static_cast<std::uint32_t>(result_.points.size());
        }
        number[node] = known;
      }
    }
  }

  /// Of an edge that is a point of the surface: the parameter that means nothing there, 1 or 2.
  static int free_parameter(const TopoDS_Edge& edge, const TopoDS_Face& face) {
    gp_Pnt2d first, last;
    BRep_Tool::UVPoints(edge, face, first, last);
    return std::abs(first.X() - last.X()) >= std::abs(first.Y() - last.Y()) ? 1 : 2;
  }

  void measure(const BRepAdaptor_Surface& surface, const Handle(Poly_Triangulation) & mesh,
               const std::array<int, 3>& node, std::size_t own,
               const std::vector<std::array<Vec3, 3>>& triangles) {
    std::array<gp_Pnt2d, 3> uv;
    for (int i = 0; i < 3; ++i) uv[i] = mesh->UVNode(node[i]);
    for (int i = 0; i < 3; ++i) {
      // A pole has one of its many parameters: what the other two corners lie between is meant.
      const auto pole = poles_.find(node[i]);
      if (pole == poles_.end()) continue;
      const gp_Pnt2d &p = uv[(i + 1) % 3], &q = uv[(i + 2) % 3];
      uv[i].SetCoord(pole->second, 0.5 * (p.Coord(pole->second) + q.Coord(pole->second)));
    }
    for (int i = 0; i <= kGrid; ++i) {
      for (int j = 0; i + j <= kGrid; ++j) {
        const double a = static_cast<double>(i) / kGrid, b = static_cast<double>(j) / kGrid;
        const gp_XY at = uv[0].XY() * (1 - a - b) + uv[1].XY() * a + uv[2].XY() * b;
        const Vec3 p = vector_of(surface.Value(at.X(), at.Y()));
        double near = distance_to_triangle(p, triangles[own]);
        // Near poles, the middle between parameters lies beside another triangle of the face.
        for (std::size_t t = 0; t < triangles.size() && near > chord_; ++t)
          near = std::min(near, distance_to_triangle(p, triangles[t]));
        result_.deviation = std::max(result_.deviation, kBetween * near);
        ++result_.samples;
      }
    }
  }

  CadShape& result_;
  double chord_;
  TopTools_IndexedMapOfShape edges_, vertices_;
  std::map<int, int> poles_;  ///< of the face: nodes at a point, and the parameter that is free
  std::map<std::pair<int, int>, std::uint32_t> border_;  ///< number and one; 0: none yet
};

/// The name of the entity that a solid was made of.
std::string name_of(const XSControl_Reader& reader, const TopoDS_Shape& solid) {
  const Handle(Standard_Transient) entity =
      reader.WS()->TransferReader()->EntityFromShapeResult(solid, 1);
  const Handle(StepRepr_RepresentationItem) item =
      Handle(StepRepr_RepresentationItem)::DownCast(entity);
  if (item.IsNull() || item->Name().IsNull()) return {};
  return item->Name()->ToCString();
}

void read(XSControl_Reader& reader, const char* path, CadShape& result) {
  if (reader.ReadFile(path) != IFSelect_RetDone) {
    result.error = "the file cannot be read; it is damaged or of another kind";
    return;
  }
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  Bnd_Box box;
  if (!shape.IsNull()) BRepBndLib::Add(shape, box, false);
  if (shape.IsNull() || box.IsVoid()) {
    result.error = "the file has no faces";
    return;
  }
  const double diagonal = std::sqrt(box.SquareExtent());
  const BRepMesh_IncrementalMesh meshing(shape, kChord * diagonal, false, kAngle, false);
  Collector collector(shape, kChord * diagonal, result);
  for (TopExp_Explorer at(shape, TopAbs_SOLID); at.More(); at.Next())
    result.solids.push_back(name_of(reader, at.Current()));
  for (TopExp_Explorer at(shape, TopAbs_FACE, TopAbs_SOLID); at.More(); at.Next())
    ++result.loose_faces;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next())
    collector.add_face(TopoDS::Face(at.Current())), ++result.faces;
  // Faces, edges and vertices may be this far from each other.
  result.deviation += ShapeAnalysis_ShapeTolerance().Tolerance(shape, 1);
}

}  // namespace
}  // namespace kaboum::io

extern "C" __attribute__((visibility("default"))) void kaboum_read_cad(
    const char* path, bool iges, kaboum::io::CadShape& result) {
  try {
    if (iges) {
      IGESControl_Reader reader;
      kaboum::io::read(reader, path, result);
    } else {
      STEPControl_Reader reader;
      kaboum::io::read(reader, path, result);
    }
  } catch (const Standard_Failure& failure) {
    result.error = std::string("OpenCASCADE failed: ") + failure.GetMessageString();
  } catch (const std::exception& failure) {
    result.error = std::string("OpenCASCADE failed: ") + failure.what();
  }
}
