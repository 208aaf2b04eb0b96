// The files that damage is done to.
#include "models.h"

#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeEdge.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakeWire.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepOffsetAPI_ThruSections.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeCylinder.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <GeomAPI_PointsToBSpline.hxx>
#include <Geom_BSplineCurve.hxx>
#include <IGESControl_Controller.hxx>
#include <IGESControl_Writer.hxx>
#include <Interface_Static.hxx>
#include <STEPControl_Writer.hxx>
#include <TColStd_Array1OfInteger.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TColgp_Array1OfPnt.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Face.hxx>
#include <TopoDS_Wire.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Circ.hxx>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>

namespace kaboum::test {
namespace {

TopoDS_Shape box(double x, double y, double z) { return BRepPrimAPI_MakeBox(x, y, z).Shape(); }
TopoDS_Shape cylinder(double r, double h) { return BRepPrimAPI_MakeCylinder(r, h).Shape(); }

TopoDS_Shape moved(const TopoDS_Shape& shape, double x, double y, double z) {
  gp_Trsf by;
  by.SetTranslation({x, y, z});
  return BRepBuilderAPI_Transform(shape, by, true).Shape();
}

/// The same shape in another place: an instance.
TopoDS_Shape placed(const TopoDS_Shape& shape, double x, double y, double z, double turn = 0) {
  gp_Trsf rotation, by;
  rotation.SetRotation(gp_Ax1(gp_Pnt(0, 0, 0), gp_Dir(0, 0, 1)), turn);
  by.SetTranslation({x, y, z});
  return shape.Moved(TopLoc_Location(by * rotation));
}

TopoDS_Shape mirrored(const TopoDS_Shape& shape, double at) {
  gp_Trsf by;
  by.SetMirror(gp_Ax2(gp_Pnt(at, 0, 0), gp_Dir(1, 0, 0)));
  return BRepBuilderAPI_Transform(shape, by, true).Shape();
}

TopoDS_Shape together(const std::vector<TopoDS_Shape>& shapes) {
  TopoDS_Compound all;
  BRep_Builder builder;
  builder.MakeCompound(all);
  for (const TopoDS_Shape& shape : shapes) builder.Add(all, shape);
  return all;
}

TopoDS_Shape plate_with_holes() {
  TopoDS_Shape part = box(40, 30, 4);
  for (const double x : {8.0, 20.0, 32.0})
    part = BRepAlgoAPI_Cut(part, moved(cylinder(3, 10), x, 15, -2)).Shape();
  return part;
}

TopoDS_Shape flange() {
  const TopoDS_Shape part = BRepAlgoAPI_Fuse(cylinder(20, 5), cylinder(9, 16)).Shape();
  return BRepAlgoAPI_Cut(part, moved(cylinder(5, 30), 0, 0, -5)).Shape();
}

/// Rings like those of a thread, turned.
TopoDS_Shape thread() {
  TopoDS_Shape part = cylinder(6, 14);
  for (int i = 0; i < 4; ++i)
    part = BRepAlgoAPI_Cut(part, moved(BRepPrimAPI_MakeTorus(6, 0.8).Shape(), 0, 0, 2 + 3.0 * i))
               .Shape();
  return part;
}

TopoDS_Shape thin_ribs() {
  TopoDS_Shape part = box(40, 20, 3);
  for (int i = 0; i < 3; ++i)
    part = BRepAlgoAPI_Fuse(part, moved(box(0.3, 20, 9), 9 + 10.0 * i, 0, 2)).Shape();
  return part;
}

/// A profile whose lower edge is a cubic spline with one narrow rib, extruded.
/// @param width  of the rib's control points from each other
TopoDS_Shape spike(double width) {
  constexpr double kAt = 37.31, kHeight = 5;
  std::vector<double> xs;
  for (int i = 0; i < 10; ++i) xs.push_back(kAt * i / 10);
  for (int i = -3; i <= 3; ++i) xs.push_back(kAt + i * width);
  for (int i = 1; i <= 10; ++i) xs.push_back(kAt + 3 * width + (100 - kAt - 3 * width) * i / 10);
  const int n = static_cast<int>(xs.size()), knots = n - 2;
  TColgp_Array1OfPnt poles(1, n);
  for (int i = 0; i < n; ++i) poles(i + 1) = gp_Pnt(xs[i], i == 13 ? -1.5 * kHeight : 0, 0);
  TColStd_Array1OfReal at(1, knots);
  TColStd_Array1OfInteger times(1, knots);
  for (int i = 1; i <= knots; ++i) {
    const bool end = i == 1 || i == knots;
    times(i) = end ? 4 : 1;
    at(i) = i == 1 ? 0 : i == knots ? 100 : (xs[i - 1] + xs[i] + xs[i + 1]) / 3;
  }
  const Handle(Geom_BSplineCurve) lower = new Geom_BSplineCurve(poles, at, times, 3);
  const std::array<gp_Pnt, 4> corner{gp_Pnt(0, 0, 0), gp_Pnt(100, 0, 0), gp_Pnt(100, 20, 0),
                                     gp_Pnt(0, 20, 0)};
  BRepBuilderAPI_MakeWire wire(
      BRepBuilderAPI_MakeEdge(lower), BRepBuilderAPI_MakeEdge(corner[1], corner[2]),
      BRepBuilderAPI_MakeEdge(corner[2], corner[3]), BRepBuilderAPI_MakeEdge(corner[3], corner[0]));
  return BRepPrimAPI_MakePrism(BRepBuilderAPI_MakeFace(wire.Wire()).Face(), gp_Vec(0, 0, 10))
      .Shape();
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
  for (int i = 0; i < 3; ++i) {
    const gp_Circ circle(gp_Ax2(gp_Pnt(3.0 * i * i, 0, 12 * i), gp_Dir(0.1 * i, 0, 1)), 10 - 2 * i);
    sections.AddWire(BRepBuilderAPI_MakeWire(BRepBuilderAPI_MakeEdge(circle)));
  }
  sections.Build();
  return sections.Shape();
}

/// Five faces of a box, as a shell.
TopoDS_Shape open_shell() {
  TopoDS_Shell shell;
  BRep_Builder builder;
  builder.MakeShell(shell);
  const TopoDS_Shape whole = box(20, 15, 10);
  int count = 0;
  for (TopExp_Explorer at(whole, TopAbs_FACE); at.More() && count < 5; at.Next(), ++count)
    builder.Add(shell, at.Current());
  return shell;
}

TopoDS_Shape loose_faces() {
  std::vector<TopoDS_Shape> faces;
  for (const TopoDS_Shape& part : {box(20, 15, 10), moved(cylinder(5, 12), 40, 0, 0)})
    for (TopExp_Explorer at(part, TopAbs_FACE); at.More(); at.Next()) faces.push_back(at.Current());
  return together(faces);
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  std::filesystem::remove(file);
  if (text.empty()) throw std::runtime_error("OpenCASCADE wrote nothing");
  return text;
}

std::filesystem::path scratch() {
  std::string name = (std::filesystem::temp_directory_path() / "cad-model-XXXXXX").string();
  const int fd = ::mkstemp(name.data());
  if (fd < 0) throw std::runtime_error("no temporary file can be made");
  return name;
}

CadModel step(const std::string& name, const TopoDS_Shape& shape, const char* unit = "MM",
              bool assembly = false) {
  STEPControl_Writer writer;
  Interface_Static::SetCVal("write.step.unit", unit);
  Interface_Static::SetIVal("write.step.assembly", assembly ? 1 : 0);
  const std::filesystem::path file = scratch();
  if (writer.Transfer(shape, STEPControl_AsIs) != IFSelect_RetDone ||
      writer.Write(file.c_str()) != IFSelect_RetDone)
    throw std::runtime_error(name + " cannot be written");
  return {name + ".step", text_of(file)};
}

CadModel iges(const std::string& name, const TopoDS_Shape& shape, bool solids,
              const char* unit = "MM") {
  IGESControl_Controller::Init();
  IGESControl_Writer writer(unit, solids ? 1 : 0);
  const std::filesystem::path file = scratch();
  if (!writer.AddShape(shape) || !writer.Write(file.c_str()))
    throw std::runtime_error(name + " cannot be written");
  return {name + ".iges", text_of(file)};
}

/// Two boxes, the second of triangles, as AP 242 has them.
CadModel tessellated() {
  CadModel model = step("tessellated", box(1, 1, 1));
  const std::string solid =
      "#9002 = TESSELLATED_SOLID('second',(#9000),$);\n"
      "#9000 = TRIANGULATED_FACE('',#9001,8,(),$,(),((1,3,4),(1,4,2),(5,6,8),(5,8,7),(1,2,6),"
      "(1,6,5),(3,7,8),(3,8,4),(1,5,7),(1,7,3),(2,4,8),(2,8,6)));\n"
      "#9001 = COORDINATES_LIST('',8,((3.0,0.0,0.0),(4.0,0.0,0.0),(3.0,1.0,0.0),(4.0,1.0,0.0),"
      "(3.0,0.0,1.0),(4.0,0.0,1.0),(3.0,1.0,1.0),(4.0,1.0,1.0)));\n";
  // Beside the box, among the items of its representation.
  const std::string items = "ADVANCED_BREP_SHAPE_REPRESENTATION('',(";
  const std::size_t at = model.text.find(items);
  const std::size_t end = model.text.rfind("ENDSEC;");
  if (at == std::string::npos) throw std::runtime_error("no representation of the box");
  model.text.insert(end, solid);
  model.text.insert(at + items.size(), "#9002,");
  model.unread = {{9000, {3, 0, 0, 4, 0, 0, 3, 1, 0, 4, 1, 0, 3, 0, 1, 4, 0, 1, 3, 1, 1, 4, 1, 1}}};
  return model;
}

}  // namespace

std::vector<CadModel> cad_models() {
  const TopoDS_Shape bolt = BRepAlgoAPI_Fuse(cylinder(3, 12), cylinder(6, 3)).Shape();
  const TopoDS_Shape sphere = BRepPrimAPI_MakeSphere(8).Shape(),
                     cone = BRepPrimAPI_MakeCone(8, 2, 14).Shape(),
                     torus = BRepPrimAPI_MakeTorus(10, 3).Shape();
  return {step("box", box(30, 20, 10)),
          step("plate", plate_with_holes()),
          step("sphere", sphere),
          step("cone-inch", cone, "INCH"),
          step("torus", torus),
          step("flange", flange()),
          step("thread", thread()),
          step("ribs", thin_ribs()),
          step("spike", spike(0.2)),
          step("vase", vase()),
          step("loft", loft()),
          step("assembly", together({bolt, placed(bolt, 20, 0, 0), placed(bolt, 0, 20, 5, 0.7)}),
               "MM", true),
          step("assembly-inch", together({box(9, 5, 4), placed(box(9, 5, 4), 0, 12, 0, 0.3)}),
               "INCH", true),
          step("mirrored", together({bolt, mirrored(moved(bolt, 2, 0, 0), 14)}), "MM", true),
          step("several", together({box(5, 5, 5), moved(sphere, 20, 0, 0), moved(cone, 0, 25, 0)})),
          step("shell", open_shell()),
          step("faces", loose_faces()),
          tessellated(),
          iges("flange", flange(), true),
          iges("several-inch", together({box(5, 5, 5), moved(cylinder(4, 9), 20, 0, 0)}), false,
               "INCH")};
}

}  // namespace kaboum::test
