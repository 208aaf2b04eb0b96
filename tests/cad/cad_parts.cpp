// Parts made by OpenCASCADE, and samples of their exact faces.
//   cad_parts make DIR                  ten parts as STEP, two of them as IGES as well
//   cad_parts check PART.step MESH N E  whether N points of the exact faces lie in the mesh's
//   solid, and
//                                       no vertex of the mesh is farther than E from all of N
//                                       points
// The check shares with the tools the winding number and the reader of MESH; faces are evaluated
// here.

#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
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
#include <GeomAPI_PointsToBSpline.hxx>
#include <Geom_BSplineCurve.hxx>
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
#include <gp_Circ.hxx>

#include <kaboum/base/random.h>
#include <kaboum/geom/winding.h>
#include <kaboum/io/mesh_io.h>

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

/// Points of the exact faces: of random triangles, random parameters.
std::vector<Vec3> samples(const TopoDS_Shape& shape, std::size_t count) {
  BRepMesh_IncrementalMesh(shape, 0.5, false, 0.5, false);
  struct Part {
    BRepAdaptor_Surface surface;
    Handle(Poly_Triangulation) mesh;
  };
  std::vector<Part> parts;
  std::vector<std::pair<std::size_t, int>> triangles;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) {
    TopLoc_Location location;
    const TopoDS_Face face = TopoDS::Face(at.Current());
    const Handle(Poly_Triangulation) mesh = BRep_Tool::Triangulation(face, location);
    if (mesh.IsNull()) continue;
    for (int t = 1; t <= mesh->NbTriangles(); ++t) triangles.emplace_back(parts.size(), t);
    parts.push_back({BRepAdaptor_Surface(face), mesh});
  }
  Random random(1);
  std::vector<Vec3> points;
  while (points.size() < count) {
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
    points.emplace_back(p.X(), p.Y(), p.Z());
  }
  return points;
}

int check(const char* part, const char* result, std::size_t count, double epsilon) {
  STEPControl_Reader reader;
  if (reader.ReadFile(part) != IFSelect_RetDone) return 3;
  reader.TransferRoots();
  const std::vector<Vec3> points = samples(reader.OneShape(), count);
  const auto mesh = kaboum::io::read_mesh(result).mesh;
  const kaboum::geom::WindingNumber winding(mesh);
  std::size_t outside = 0;
  for (const Vec3& p : points)
    if (const auto w = winding(p); w && *w < 1) ++outside;
  double farthest = 0;
  for (const Vec3& v : mesh.vertices) {
    double near = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < points.size(); i += 1 + points.size() / 20000)
      near = std::min(near, (v - points[i]).norm());
    farthest = std::max(farthest, near);
  }
  std::cout << outside << " of " << count << " points outside; vertices within " << farthest
            << '\n';
  return outside == 0 && farthest <= epsilon ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "make" && argc == 3) return make(argv[2]);
  if (command == "check" && argc == 6)
    return check(argv[2], argv[3], std::strtoull(argv[4], nullptr, 10), std::atof(argv[5]));
  std::cerr << "usage: cad_parts make DIR | check PART.step MESH POINTS EPSILON\n";
  return 2;
}
