// Parts made by OpenCASCADE, and samples of their exact faces.
//   cad_parts make DIR                  twelve parts as STEP, two of them as IGES as well
//   cad_parts more DIR                  parts that are hard to read: ribs between samples of edges,
//                                       a tessellated solid, entities renamed and left out
//   cad_parts within PART               whether the exact edges and faces of a file, at their knots
//                                       and between, are as near the triangles as is claimed
//   cad_parts covers-box MESH           whether the box of the renamed and left out entities is in
//                                       the mesh's solid
//   cad_parts points PART FACES         whether the verifier's own reading, without the other one,
//                                       finds so many exact faces; else why not
//   cad_parts box MESH 'X Y Z X Y Z'    whether the mesh's box is that
//   cad_parts check PART.step MESH N E  whether N points of the exact faces lie in the mesh's
//   solid,
//                                       and no one of N points of the mesh is farther than E, a
//                                       length or a percentage of the diagonal, from the part
// The check shares with the tools the winding number, the distance to triangles and the reader of
// MESH; faces are evaluated here. How far a point is from the part is measured at triangles that
// are within a hundredth of E of its faces, and E is enlarged by as much.

#include <Adaptor3d_Curve.hxx>
#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <GCE2d_MakeSegment.hxx>
#include <Geom2d_Ellipse.hxx>
#include <Geom2d_TrimmedCurve.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <GeomConvert_CompCurveToBSplineCurve.hxx>
#include <Geom_BSplineCurve.hxx>
#include <Geom_BSplineSurface.hxx>
#include <Geom_CylindricalSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <Poly_Triangulation.hxx>
#include <STEPControl_Reader.hxx>
#include <STEPControl_Writer.hxx>
#include <ShapeFix_Shape.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
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

#include <kaboum/base/error.h>
#include <kaboum/base/parse_length.h>
#include <kaboum/base/random.h>
#include <kaboum/geom/triangle_search.h>
#include <kaboum/geom/winding.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/verify/exact_points.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <limits>
#include <map>
#include <sstream>

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

/// A block one side of which is a spline with a rib that is 5 high: between the samples of a
/// mesher.
TopoDS_Shape ribbed(double width) {
  const double at = 37.31;
  std::vector<double> x;  // of the poles
  for (int i = 0; i < 10; ++i) x.push_back(at * i / 10);
  for (int i = -3; i <= 3; ++i) x.push_back(at + i * width);
  for (int i = 1; i <= 10; ++i) x.push_back(at + 3 * width + (100 - at - 3 * width) * i / 10);
  const int count = static_cast<int>(x.size()), degree = 3, last = count - degree + 1;
  TColgp_Array1OfPnt poles(1, count);
  for (int i = 0; i < count; ++i) poles(i + 1) = gp_Pnt(x[i], x[i] == at ? -7.5 : 0, 0);
  TColStd_Array1OfReal knots(1, last);
  TColStd_Array1OfInteger times(1, last);
  for (int i = 1; i <= last; ++i) {
    times(i) = i == 1 || i == last ? degree + 1 : 1;
    knots(i) = (x[i - 1] + x[i] + x[i + 1]) / 3;
  }
  knots(1) = 0;
  knots(last) = 100;
  const Handle(Geom_BSplineCurve) side = new Geom_BSplineCurve(poles, knots, times, degree);
  const gp_Pnt a(100, 0, 0), b(100, 20, 0), c(0, 20, 0), d(0, 0, 0);
  BRepBuilderAPI_MakeWire wire;
  wire.Add(BRepBuilderAPI_MakeEdge(side).Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(a, b).Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(b, c).Edge());
  wire.Add(BRepBuilderAPI_MakeEdge(c, d).Edge());
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(0, 0, 10))
      .Shape();
}

/// A plane plate that is bounded by such a spline: no face is curved, only the edge.
TopoDS_Shape bumpy_sheet() {
  const TopoDS_Shape solid = ribbed(0.05);
  for (TopExp_Explorer at(solid, TopAbs_FACE); at.More(); at.Next()) {
    const BRepAdaptor_Surface surface(TopoDS::Face(at.Current()));
    if (surface.GetType() == GeomAbs_Plane &&
        std::abs(surface.Plane().Axis().Direction().Z()) > 0.9)
      return at.Current();
  }
  return solid;
}

bool write_step(const TopoDS_Shape& shape, const std::string& name) {
  STEPControl_Writer step;
  return step.Transfer(shape, STEPControl_AsIs) == IFSelect_RetDone &&
         step.Write(name.c_str()) == IFSelect_RetDone;
}

/// The statements of a STEP file's data section: "#12 = TYPE(...)".
std::vector<std::string> statements(const std::string& text) {
  std::vector<std::string> out;
  for (std::size_t at = text.find("DATA;") + 5; at < text.find("ENDSEC;", text.find("DATA;"));) {
    const std::size_t end = text.find(';', at) + 1;
    const std::string statement = text.substr(at, end - at);
    if (statement.find('#') == std::string::npos) break;
    out.push_back(statement);
    at = end;
  }
  return out;
}

void write_text(const std::string& name, const std::string& text) {
  std::ofstream(name, std::ios::binary) << text;
}

/// Of each type in a file of one box: one entity under an unknown name, and one left out.
void write_variants(const std::string& folder) {
  write_step(box(10, 20, 30), folder + "/base.step");
  std::ifstream in(folder + "/base.step", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  in.close();
  std::filesystem::remove(folder + "/base.step");
  const std::size_t begin = text.find("DATA;") + 5, end = text.find("ENDSEC;", begin);
  std::map<std::string, std::vector<std::size_t>> of_type;
  const std::vector<std::string> all = statements(text);
  for (std::size_t i = 0; i < all.size(); ++i) {
    const std::size_t name = all[i].find_first_of("ABCDEFGHIJKLMNOPQRSTUVWXYZ");
    if (name == std::string::npos) continue;
    of_type[all[i].substr(name, all[i].find_first_of(" (\n", name) - name)].push_back(i);
  }
  for (const auto& [type, places] : of_type) {
    const std::size_t place = places[places.size() / 2];
    for (const bool renamed : {true, false}) {
      std::string data;
      for (std::size_t i = 0; i < all.size(); ++i) {
        std::string statement = all[i];
        if (i == place && renamed)
          statement.replace(statement.find(type), type.size(), "X_" + type);
        if (i != place || renamed) data += statement;
      }
      write_text(folder + "/" + type + (renamed ? "-renamed" : "-dropped") + ".step",
                 text.substr(0, begin) + data + text.substr(end));
    }
  }
}

/// A box as usual, and a tetrahedron beside it that is tessellated.
void write_tessellated(const std::string& name) {
  write_step(box(1, 1, 1), name);
  std::ifstream in(name, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), {}};
  in.close();
  const std::size_t rep = text.find("ADVANCED_BREP_SHAPE_REPRESENTATION");
  text.insert(text.find("),", rep), ",#90001");
  text.insert(text.find("ENDSEC;", rep),
              "#90001=TESSELLATED_SOLID('',(#90002),$);\n"
              "#90002=TRIANGULATED_FACE('',#90003,4,(),$,(),((1,3,2),(1,2,4),(2,3,4),(3,1,4)));\n"
              "#90003=COORDINATES_LIST('',4,((3.,0.,0.),(4.,0.,0.),(3.,1.,0.),(3.,0.,1.)));\n");
  write_text(name, text);
}

/// A closed spline round (30, 0, 0) in the plane y = 0, 5 in radius, with a spike at its least z
/// that is 2 high; it starts at the angle `start`.
Handle(Geom_BSplineCurve) spiked_ring(double start) {
  constexpr double radius = 5, width = 0.02, at = 1.5 * M_PI, whole = 2 * M_PI;
  const double spike = std::fmod(at - start + whole, whole);
  std::vector<double> angles;  // of the poles, from the start
  for (int i = 0; i <= 40; ++i)
    if (std::abs(whole * i / 40 - spike) > 0.3) angles.push_back(whole * i / 40);
  for (int i = -3; i <= 3; ++i) angles.push_back(spike + i * width / radius);
  std::sort(angles.begin(), angles.end());
  const int count = static_cast<int>(angles.size()), degree = 3, last = count - degree + 1;
  TColgp_Array1OfPnt poles(1, count);
  const double step = angles[1];
  for (int i = 0; i < count; ++i) {
    const bool beside = i == 1 || i == count - 2;  // on the tangent where both ends meet
    const double a = beside || i == count - 1 ? start : start + angles[i];
    const double along = beside ? radius * (i == 1 ? step : -step) : 0;
    const double r = angles[i] == spike ? 3 * radius : radius;
    poles(i + 1) = gp_Pnt(30 + r * std::cos(a) - along * std::sin(a), 0,
                          r * std::sin(a) + along * std::cos(a));
  }
  TColStd_Array1OfReal knots(1, last);
  TColStd_Array1OfInteger times(1, last);
  for (int i = 1; i <= last; ++i) {
    times(i) = i == 1 || i == last ? degree + 1 : 1;
    knots(i) = (angles[i - 1] + angles[i] + angles[i + 1]) / 3;
  }
  knots(1) = 0;
  knots(last) = whole;
  return new Geom_BSplineCurve(poles, knots, times, degree);
}

/// Half of such a ring's lower side, turned by 0.1 rad round the z-axis or moved along y. The
/// spline starts inside the face: at the angle 1.4 pi, or outside it, at 0.5 pi.
TopoDS_Shape ring_sheet(bool turned, bool starts_inside) {
  const double start = starts_inside ? 1.4 * M_PI : 0.5 * M_PI;
  const Handle(Geom_BSplineCurve) ring = spiked_ring(start);
  // From the angle 1.25 pi to 1.75 pi; beyond its end it goes on at its start.
  const auto piece = [&](double from, double to) {
    const Handle(Geom_BSplineCurve) out = Handle(Geom_BSplineCurve)::DownCast(ring->Copy());
    out->Segment(from, to);
    return out;
  };
  Handle(Geom_BSplineCurve) border = piece(0.75 * M_PI, 1.25 * M_PI);
  if (starts_inside) {
    GeomConvert_CompCurveToBSplineCurve both(piece(1.85 * M_PI, 2 * M_PI));
    both.Add(piece(0, 0.35 * M_PI), 1e-9, true);
    border = both.BSplineCurve();
  }
  gp_Trsf by;
  if (turned)
    by.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), 0.1);
  else
    by.SetTranslation(gp_Vec(0, 20, 0));
  const auto other = Handle(Geom_Curve)::DownCast(border->Transformed(by));
  const auto side = [&](const gp_Pnt& p) -> TopoDS_Edge {
    if (!turned) return BRepBuilderAPI_MakeEdge(p, p.Transformed(by));
    const gp_Circ circle(gp_Ax2(gp_Pnt(0, 0, p.Z()), gp_Dir(0, 0, 1)), p.X());
    return BRepBuilderAPI_MakeEdge(circle, 0, 0.1);
  };
  BRepBuilderAPI_MakeWire wire;
  wire.Add(BRepBuilderAPI_MakeEdge(border).Edge());
  wire.Add(side(border->EndPoint()));
  wire.Add(BRepBuilderAPI_MakeEdge(other).Edge());
  wire.Add(side(border->StartPoint()));
  ring->SetPeriodic();
  Handle(Geom_Surface) surface = new Geom_SurfaceOfLinearExtrusion(ring, gp_Dir(0, 1, 0));
  if (turned)
    surface = new Geom_SurfaceOfRevolution(ring, gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)));
  const TopoDS_Face face = BRepBuilderAPI_MakeFace(surface, wire.Wire(), true).Face();
  ShapeFix_Shape fix(face);
  fix.Perform();
  return fix.Shape();
}

int make_more(const std::string& folder) {
  for (const bool turned : {false, true})
    for (const bool inside : {false, true})
      if (!write_step(ring_sheet(turned, inside), folder + "/" + (turned ? "turned" : "moved") +
                                                      (inside ? "-inside" : "-outside") + ".step"))
        return 1;
  for (const double width : {0.3, 0.2, 0.05, 0.01, 0.002}) {
    std::ostringstream name;
    name << folder << "/rib-" << width << ".step";
    if (!write_step(ribbed(width), name.str())) return 1;
  }
  if (!write_step(bumpy_sheet(), folder + "/sheet.step")) return 1;
  // The same on a spline surface, without curves in its parameters: reading has to make them.
  Interface_Static::SetIVal("write.surfacecurve.mode", 0);
  const bool written =
      write_step(BRepBuilderAPI_NurbsConvert(bumpy_sheet()).Shape(), folder + "/projected.step");
  Interface_Static::SetIVal("write.surfacecurve.mode", 1);
  if (!written) return 1;
  write_tessellated(folder + "/tessellated.step");
  std::filesystem::create_directory(folder + "/variants");
  write_variants(folder + "/variants");
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

/// The ends of intervals between which an edge or a surface is a polynomial or the like.
/// @param period  with that the knots repeat; 0: they do not
std::vector<double> breaks(const TColStd_Array1OfReal& knots, double from, double to,
                           double period = 0) {
  std::vector<double> out{from, to};
  for (int i = knots.Lower(); i <= knots.Upper(); ++i)
    for (int k = -2; k <= 2; ++k)
      if (const double t = knots(i) + k * period; (k == 0 || period > 0) && t > from && t < to)
        out.push_back(t);
  std::sort(out.begin(), out.end());
  return out;
}

/// Parameters at the ends of these intervals and between.
std::vector<double> dense(const std::vector<double>& ends, int between) {
  std::vector<double> out;
  for (std::size_t i = 0; i + 1 < ends.size(); ++i)
    for (int k = 0; k < between; ++k)
      out.push_back(ends[i] + (ends[i + 1] - ends[i]) * k / between);
  out.push_back(ends.back());
  return out;
}

/// Whether all exact edges and faces are within the claimed deviation of the triangles, by
/// OpenCASCADE's evaluators.
int within(const char* part) {
  const kaboum::io::ReadResult claimed = kaboum::io::read_mesh(part);
  const kaboum::geom::DistanceQuery query(claimed.mesh);
  STEPControl_Reader reader;
  if (reader.ReadFile(part) != IFSelect_RetDone) return 3;
  reader.TransferRoots();
  const TopoDS_Shape shape = reader.OneShape();
  double worst = 0;
  std::size_t count = 0;
  const auto distance = [&](const gp_Pnt& p) {
    ++count;
    return query.nearest({p.X(), p.Y(), p.Z()}).lower;
  };
  for (TopExp_Explorer at(shape, TopAbs_EDGE); at.More(); at.Next()) {
    if (BRep_Tool::Degenerated(TopoDS::Edge(at.Current()))) continue;
    const BRepAdaptor_Curve curve(TopoDS::Edge(at.Current()));
    std::vector<double> ends{curve.FirstParameter(), curve.LastParameter()};
    if (curve.GetType() == GeomAbs_BSplineCurve)
      ends = breaks(curve.BSpline()->Knots(), ends[0], ends[1]);
    for (const double t : dense(ends, ends.size() > 2 ? 20 : 200))
      worst = std::max(worst, distance(curve.Value(t)));
  }
  for (const TopoDS_Face& face : faces_of(shape)) {
    const BRepAdaptor_Surface surface(face);
    double u0 = 0, u1 = 0, v0 = 0, v1 = 0;
    BRepTools::UVBounds(face, u0, u1, v0, v1);
    std::vector<double> us{u0, u1}, vs{v0, v1};
    if (surface.GetType() == GeomAbs_BSplineSurface) {
      us = breaks(surface.BSpline()->UKnots(), u0, u1);
      vs = breaks(surface.BSpline()->VKnots(), v0, v1);
    } else if (surface.GetType() == GeomAbs_SurfaceOfExtrusion &&
               surface.BasisCurve()->GetType() == GeomAbs_BSplineCurve) {
      const auto basis = surface.BasisCurve()->BSpline();
      us = breaks(basis->Knots(), u0, u1, basis->IsPeriodic() ? basis->Period() : 0);
    } else if (surface.GetType() == GeomAbs_SurfaceOfRevolution &&
               surface.BasisCurve()->GetType() == GeomAbs_BSplineCurve) {
      const auto basis = surface.BasisCurve()->BSpline();
      vs = breaks(basis->Knots(), v0, v1, basis->IsPeriodic() ? basis->Period() : 0);
    }
    for (const double u : dense(us, us.size() > 2 ? 8 : 60))
      for (const double v : dense(vs, vs.size() > 2 ? 8 : 60)) {
        const double d = distance(surface.Value(u, v));
        if (d <= claimed.deviation) continue;
        const BRepClass_FaceClassifier place(face, gp_Pnt2d(u, v), 1e-9);
        if (place.State() != TopAbs_OUT) worst = std::max(worst, d);
      }
  }
  std::cout << part << ": no one of " << count << " points farther than " << worst << ", where "
            << claimed.deviation << " is claimed\n";
  return worst <= claimed.deviation ? 0 : 1;
}

/// Whether points of the box of the variants are in the mesh's solid.
int covers_box(const char* result) {
  const auto mesh = kaboum::io::read_mesh(result).mesh;
  const kaboum::geom::WindingNumber winding(mesh);
  std::size_t outside = 0;
  for (int i = 0; i < 27; ++i) {
    const Vec3 p(9.99 * (i % 3) / 2 + 0.005, 19.99 * (i / 3 % 3) / 2 + 0.005,
                 29.99 * (i / 9) / 2 + 0.005);
    const auto w = winding(p);
    if (w && *w < 1) ++outside;
  }
  std::cout << outside << " of 27 points outside\n";
  return outside == 0 ? 0 : 1;
}

/// Whether the mesh's box is that, up to chords: least and largest coordinates, as a text.
int has_box(const char* file, const char* text) {
  const auto box = kaboum::geom::bounding_box(kaboum::io::read_mesh(file).mesh);
  std::istringstream numbers(text);
  double off = 0;
  for (int i = 0; i < 6; ++i) {
    double x = 0;
    if (!(numbers >> x)) return 2;
    off = std::max(off, std::abs(x - (i < 3 ? box.min[i] : box.max[i - 3])));
  }
  std::cout << box.min.transpose() << ' ' << box.max.transpose() << '\n';
  return off < 0.02 ? 0 : 1;
}

}  // namespace

/// The verifier's reading alone: where both are asked, the other one refuses first.
int list_points(const char* path, const char* faces) {
  const std::vector<char> bytes = kaboum::io::read_file(path);
  try {
    const auto points = kaboum::verify::read_exact_points(bytes, kaboum::io::Format::Step, path, 2,
                                                          1, std::strtoull(faces, nullptr, 10));
    std::cout << points.points.size() << " points of " << points.faces << " faces\n";
    return 0;
  } catch (const kaboum::Error& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
}

int main(int argc, char** argv) {
  const std::string command = argc > 1 ? argv[1] : "";
  if (command == "make" && argc == 3) return make(argv[2]);
  if (command == "more" && argc == 3) return make_more(argv[2]);
  if (command == "covers-box" && argc == 3) return covers_box(argv[2]);
  if (command == "points" && argc == 4) return list_points(argv[2], argv[3]);
  if (command == "box" && argc == 4) return has_box(argv[2], argv[3]);
  if (command == "within" && argc == 3) return within(argv[2]);
  if (command == "check" && argc == 6)
    return check(argv[2], argv[3], std::strtoull(argv[4], nullptr, 10), argv[5]);
  std::cerr
      << "usage: cad_parts make DIR | more DIR | within PART.step | covers-box MESH | points PART "
         "FACES | box MESH 'X Y Z X Y Z' | check PART.step MESH POINTS EPSILON\n";
  return 2;
}
