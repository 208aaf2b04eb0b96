// Parts made by OpenCASCADE, and samples of their exact faces.
//   cad_parts make DIR                  twelve parts as STEP, two of them as IGES as well
//   cad_parts check PART.step MESH N E  whether N points of the exact faces lie in the mesh's
//   solid,
//                                       and no one of N points of the mesh is farther than E, a
//                                       length or a percentage of the diagonal, from the part
// The check shares with the tools the winding number, the distance to triangles and the reader of
// MESH; faces are evaluated here. How far a point is from the part is measured at triangles that
// are within a hundredth of E of its faces, and E is enlarged by as much.

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GCE2d_MakeSegment.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <IGESControl_Writer.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Ax2d.hxx>
#include <gp_Ax3.hxx>
#include <gp_Circ.hxx>

#include <kaboum/base/parse_length.h>
#include <kaboum/base/random.h>
#include <kaboum/geom/distance.h>
#include <kaboum/geom/winding.h>
#include <kaboum/io/mesh_io.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>

namespace {

using kaboum::Random;
using kaboum::geom::Vec3;

TopoDS_Shape moved(const TopoDS_Shape& shape, double x, double y, double z) {
  gp_Trsf by;
  by.SetTranslation({x, y, z});
  return BRepBuilderAPI_Transform(shape, by, true).Shape();
}

TopoDS_Shape box(double x, double y, double z) { return BRepPrimAPI_MakeBox(x, y, z).Shape(); }
TopoDS_Shape cylinder(double r, double h) { return BRepPrimAPI_MakeCylinder(r, h).Shape(); }

TopoDS_Shape filleted() {
  const TopoDS_Shape block = box(40, 30, 20);
  BRepFilletAPI_MakeFillet fillet(block);
  for (TopExp_Explorer at(block, TopAbs_EDGE); at.More(); at.Next())
    fillet.Add(4, TopoDS::Edge(at.Current()));
  return fillet.Shape();
}

TopoDS_Shape flange() {
  TopoDS_Shape part = BRepAlgoAPI_Fuse(cylinder(40, 8), cylinder(18, 30)).Shape();
  part = BRepAlgoAPI_Cut(part, moved(cylinder(10, 50), 0, 0, -5)).Shape();
  for (int i = 0; i < 6; ++i)
    part = BRepAlgoAPI_Cut(part, moved(cylinder(3, 20), 30 * std::cos(i * M_PI / 3),
                                       30 * std::sin(i * M_PI / 3), -5))
               .Shape();
  return part;
}

/// Rings like those of a thread, turned.
TopoDS_Shape grooved() {
  TopoDS_Shape part = cylinder(10, 30);
  for (int i = 0; i < 8; ++i)
    part = BRepAlgoAPI_Cut(part, moved(BRepPrimAPI_MakeTorus(10, 1.2).Shape(), 0, 0, 3 + 3.3 * i))
               .Shape();
  return part;
}

/// A wire on a cylinder: half an ellipse in its parameters, and the line between its ends.
TopoDS_Wire half_ellipse(double radius, double height, double width) {
  const Handle(Geom_CylindricalSurface) on =
      new Geom_CylindricalSurface(gp_Ax3(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), radius);
  const gp_Ax2d along(gp_Pnt2d(2 * M_PI, height / 2), gp_Dir2d(2 * M_PI, height / 4));
  const Handle(Geom2d_Ellipse) ellipse = new Geom2d_Ellipse(along, 2 * M_PI, width);
  const Handle(Geom2d_TrimmedCurve) arc = new Geom2d_TrimmedCurve(ellipse, 0, M_PI);
  const Handle(Geom2d_TrimmedCurve) line =
      GCE2d_MakeSegment(ellipse->Value(0), ellipse->Value(M_PI));
  TopoDS_Wire wire =
      BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(arc, on), BRepBuilderAPI_MakeEdge(line, on));
  BRepLib::BuildCurves3d(wire);
  return wire;
}

/// A bolt with a thread made like that of OpenCASCADE's tutorial: a second solid, inside out.
TopoDS_Shape threaded() {
  BRepOffsetAPI_ThruSections thread(true);
  thread.AddWire(half_ellipse(7.9, 20, 2));
  thread.AddWire(half_ellipse(9, 20, 0.5));
  thread.CheckCompatibility(false);
  thread.Build();
  TopoDS_Compound bolt;
  BRep_Builder builder;
  builder.MakeCompound(bolt);
  builder.Add(bolt, cylinder(8, 20));
  builder.Add(bolt, thread.Shape());
  return bolt;
}

/// A spline turned round z.
TopoDS_Shape vase() {
  TColgp_Array1OfPnt points(1, 5);
  const std::array<std::array<double, 2>, 5> profile{
      {{10, 0}, {16, 10}, {7, 22}, {9, 30}, {13, 38}}};
  for (int i = 0; i < 5; ++i) points(i + 1) = gp_Pnt(profile[i][0], 0, profile[i][1]);
  const gp_Pnt low(0, 0, 0), high(0, 0, 38);
  BRepBuilderAPI_MakeWire wire(BRepBuilderAPI_MakeEdge(low, points(1)),
                               BRepBuilderAPI_MakeEdge(GeomAPI_PointsToBSpline(points).Curve()),
                               BRepBuilderAPI_MakeEdge(points(5), high),
                               BRepBuilderAPI_MakeEdge(high, low));
  return BRepPrimAPI_MakeRevol(BRepBuilderAPI_MakeFace(wire.Wire()).Shape(),
                               gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)))
      .Shape();
}

TopoDS_Shape loft() {
  BRepOffsetAPI_ThruSections sections(true);
  for (int i = 0; i < 4; ++i) {
    const gp_Circ circle(gp_Ax2(gp_Pnt(3.0 * i * i, 0, 15 * i), gp_Dir(0.1 * i, 0, 1)), 12 - 2 * i);
    sections.AddWire(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle)));
  }
  sections.Build();
  return sections.Shape();
}

TopoDS_Shape assembly() {
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (int i = 0; i < 50; ++i) {
    const TopoDS_Shape part = i % 2 == 0 ? box(6, 6, 6) : cylinder(3, 8);
    builder.Add(all, moved(part, 10 * (i % 10), 10 * (i / 10), 0));
  }
  return all;
}

int make(const std::string& folder) {
  const std::vector<std::pair<std::string, TopoDS_Shape>> parts{
      {"box", box(30, 20, 10)},
      {"cylinder", cylinder(10, 40)},
      {"sphere", BRepPrimAPI_MakeSphere(15).Shape()},
      {"cone", BRepPrimAPI_MakeCone(15, 0, 30).Shape()},
      {"torus", BRepPrimAPI_MakeTorus(20, 5).Shape()},
      {"fillets", filleted()},
      {"flange", flange()},
      {"grooves", grooved()},
      {"thread", threaded()},
      {"vase", vase()},
      {"loft", loft()},
      {"assembly", assembly()}};
  for (const auto& [name, shape] : parts) {
    STEPControl_Writer step;
    if (step.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone ||
        step.Write((folder + "/" + name + ".step").c_str()) != IFSelect_RetDone)
      return 1;
    if (name != "flange" && name != "box") continue;
    IGESControl_Writer iges("MM", 1);  // solids
    if (!iges.AddShape(shape) || !iges.Write((folder + "/" + name + ".iges").c_str())) return 1;
  }
  return 0;
}

/// A point of a face, and its parameters there.
struct Sample {
  Vec3 point;
  gp_Pnt2d parameters;
  std::size_t face;  ///< number of it
};

std::vector<TopoDS_Face> faces_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Face> out;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next())
    out.push_back(TopoDS::Face(at.Current()));
  return out;
}

/// Points of the exact faces: of random triangles, random parameters. Between the edge of a hole
/// and its chord they may be of the surface, but not of the face.
std::vector<Sample> samples(const TopoDS_Shape& shape, std::size_t count) {
  BRepMesh_IncrementalMesh(shape, 0.02, false, 0.2, false);
  struct Part {
    BRepAdaptor_Surface surface;
    Handle(Poly_Triangulation) mesh;
  };
  std::vector<Part> parts;
  std::vector<std::pair<std::size_t, int>> triangles;
  for (const TopoDS_Face& face : faces_of(shape)) {
    TopLoc_Location location;
    const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
    for (int t = 1; !mesh.IsNull() && t <= mesh->NbTriangles(); ++t)
      triangles.emplace_back(parts.size(), t);
    parts.push_back({BRepAdaptor_Surface(face), mesh});
  }
  Random random(1);
  std::vector<Sample> out;
  while (out.size() < count) {
    const auto& [part, t] = triangles[random.index(triangles.size())];
    std::array<int, 3> n{};
    parts[part].mesh->Triangle(t).Get(n[0], n[1], n[2]);
    double a = random.between(0, 1), b = random.between(0, 1);
    if (a + b > 1) {
      a = 1 - a;
      b = 1 - b;
    }
    const gp_XY uv = parts[part].mesh->UVNode(n[0]).XY() * (1 - a - b) +
                     parts[part].mesh->UVNode(n[1]).XY() * a +
                     parts[part].mesh->UVNode(n[2]).XY() * b;
    const gp_Pnt p = parts[part].surface.Value(uv.X(), uv.Y());
    out.push_back({{p.X(), p.Y(), p.Z()}, uv, part});
  }
  return out;
}

void add_face(const TopoDS_Face& face, kaboum::geom::Mesh& out) {
  TopLoc_Location location;
  const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
  if (mesh.IsNull()) return;
  const auto first = static_cast<std::uint32_t>(out.vertices.size()) - 1;  // nodes begin with 1
  for (int n = 1; n <= mesh->NbNodes(); ++n) {
    const gp_Pnt p = mesh->Node(n).Transformed(location.Transformation());
    out.vertices.emplace_back(p.X(), p.Y(), p.Z());
  }
  for (int t = 1; t <= mesh->NbTriangles(); ++t) {
    std::array<int, 3> n{};
    mesh->Triangle(t).Get(n[0], n[1], n[2]);
    if (face.Orientation() == TopAbs_REVERSED) std::swap(n[1], n[2]);
    out.triangles.push_back({first + n[0], first + n[1], first + n[2]});
  }
}

/// Triangles of the exact faces of its solids, seen from outside.
kaboum::geom::Mesh triangles_of(const TopoDS_Shape& shape, double deflection) {
  BRepMesh_IncrementalMesh(shape, deflection, false, 0.5, false);
  kaboum::geom::Mesh out;
  for (TopExp_Explorer solid(shape, TopAbs_SOLID); solid.More(); solid.Next()) {
    const std::size_t begin = out.triangles.size();
    for (TopExp_Explorer at(solid.Current(), TopAbs_FACE); at.More(); at.Next())
      add_face(TopoDS::Face(at.Current()), out);
    double volume = 0;
    for (std::size_t t = begin; t < out.triangles.size(); ++t) {
      const auto& [a, b, c] = out.triangles[t];
      volume += out.vertices[a].dot(out.vertices[b].cross(out.vertices[c]));
    }
    for (std::size_t t = begin; t < out.triangles.size() && volume < 0; ++t)
      std::swap(out.triangles[t][1], out.triangles[t][2]);
  }
  return out;
}

/// A point of the triangle, at random.
Vec3 point_in(const kaboum::geom::Mesh& mesh, const kaboum::geom::Triangle& t, Random& random) {
  double a = random.between(0, 1), b = random.between(0, 1);
  if (a + b > 1) {
    a = 1 - a;
    b = 1 - b;
  }
  return mesh.vertices[t[0]] * (1 - a - b) + mesh.vertices[t[1]] * a + mesh.vertices[t[2]] * b;
}

/// How far points of the mesh are from the part at most: corners, and `count` points by area.
double farthest(const kaboum::geom::Mesh& mesh, const kaboum::geom::Mesh& part, std::size_t count) {
  const kaboum::geom::WindingNumber winding(part);
  const kaboum::geom::DistanceQuery query(part);
  double out = 0;
  const auto look_at = [&](const Vec3& p) {
    const double distance = query.nearest(p).upper;
    if (distance <= out) return;
    if (const auto w = winding(p); w && *w < 1) out = distance;
  };
  for (const Vec3& v : mesh.vertices) look_at(v);
  std::vector<double> area;  // of the triangles so far
  for (const auto& t : mesh.triangles)
    area.push_back((area.empty() ? 0 : area.back()) +
                   (mesh.vertices[t[1]] - mesh.vertices[t[0]])
                       .cross(mesh.vertices[t[2]] - mesh.vertices[t[0]])
                       .norm());
  Random random(2);
  for (std::size_t i = 0; i < count; ++i) {
    const auto at = std::upper_bound(area.begin(), area.end(), random.between(0, area.back()));
    const auto t = std::min<std::size_t>(at - area.begin(), area.size() - 1);
    look_at(point_in(mesh, mesh.triangles[t], random));
  }
  return out;
}

int check(const char* part, const char* result, std::size_t count, const char* allowed) {
  const auto length = kaboum::parse_length(allowed);
  STEPControl_Reader reader;
  if (!length || reader.ReadFile(part) != IFSelect_RetDone) return 3;
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  const std::vector<Sample> points = samples(shape, count);
  const std::vector<TopoDS_Face> faces = faces_of(shape);
  const auto mesh = kaboum::io::read_mesh(result).mesh;
  const kaboum::geom::WindingNumber winding(mesh);
  std::size_t outside = 0, off = 0;
  kaboum::geom::Box3 box;
  for (const Sample& s : points) {
    box.extend(s.point);
    const auto w = winding(s.point);
    if (!w || *w >= 1) continue;
    const BRepClass_FaceClassifier place(faces[s.face], s.parameters, 1e-9);
    ++(place.State() == TopAbs_OUT ? off : outside);
  }
  const double epsilon = length->of(box.diagonal()), deflection = epsilon / 100;
  const double reach = farthest(mesh, triangles_of(shape, deflection), count);
  std::cout << outside << " of " << count << " points outside (" << off
            << " more are no points of the faces); no one of " << count << " farther than "
            << reach + deflection << ", where " << epsilon << " is allowed\n";
  return outside == 0 && reach <= epsilon + deflection ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "make" && argc == 3) return make(argv[2]);
  if (command == "check" && argc == 6)
    return check(argv[2], argv[3], std::strtoull(argv[4], nullptr, 10), argv[5]);
  std::cerr << "usage: cad_parts make DIR | check PART.step MESH POINTS EPSILON\n";
  return 2;
}
