// Faces of an IGES file: which entities the file shows, and in how many places.
//
// Entities that nothing refers to are shown, with what their groups, subfigures and solids hold.

#include <IGESBasic_SingularSubfigure.hxx>
#include <IGESData_GlobalSection.hxx>
#include <IGESData_IGESEntity.hxx>
#include <IGESData_IGESModel.hxx>
#include <IGESData_UndefinedEntity.hxx>
#include <IGESGeom_Boundary.hxx>
#include <IGESGeom_BoundedSurface.hxx>
#include <IGESGeom_CompositeCurve.hxx>
#include <IGESGeom_CurveOnSurface.hxx>
#include <IGESGeom_Line.hxx>
#include <IGESGeom_TransformationMatrix.hxx>
#include <IGESGeom_TrimmedSurface.hxx>
#include <IGESSolid_Face.hxx>
#include <IGESSolid_Loop.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <TCollection_HAsciiString.hxx>
#include <gp_GTrsf.hxx>
#include <gp_Mat.hxx>
#include <gp_Pnt.hxx>
#include <gp_XYZ.hxx>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>

#include "census.h"

namespace kaboum::io {
namespace {

constexpr double kRigid = 1e-6;  ///< that a matrix may be off from a rotation, or a mirror

enum class IgesKind { Unknown, Face, Surface, Container, Part, Harmless };

/// By its number; the forms of 106, 108 and 402 differ.
IgesKind iges_kind(int type, int form) {
  switch (type) {
    case 143:  // bounded surface
    case 144:  // trimmed surface
    case 510:  // face
      return IgesKind::Face;
    case 108:  // plane: bounded, or without a bound
      return form == 0 ? IgesKind::Part : IgesKind::Surface;
    case 114:  // parametric spline surface
    case 118:  // ruled surface
    case 120:  // surface of revolution
    case 122:  // tabulated cylinder
    case 128:  // rational B-spline surface
    case 140:  // offset surface
    case 190:  // plane surface
    case 192:  // right circular cylindrical surface
    case 194:  // right circular conical surface
    case 196:  // spherical surface
    case 198:  // toroidal surface
      return IgesKind::Surface;
    case 186:  // manifold solid B-rep object
    case 308:  // subfigure definition
    case 402:  // associativity instance; groups are some of its forms
    case 408:  // singular subfigure instance
    case 514:  // shell
      return IgesKind::Container;
    case 100:  // circular arc
    case 102:  // composite curve
    case 104:  // conic arc
    case 106:  // copious data
    case 110:  // line
    case 112:  // parametric spline curve
    case 116:  // point
    case 123:  // direction
    case 124:  // transformation matrix
    case 126:  // rational B-spline curve
    case 130:  // offset curve
    case 132:  // connect point
    case 141:  // boundary
    case 142:  // curve on a parametric surface
    case 502:  // vertex list
    case 504:  // edge list
    case 508:  // loop
      return IgesKind::Part;
    case 0:    // null
    case 202:  // annotation, from angular dimensions to sections
    case 204:
    case 206:
    case 208:
    case 210:
    case 212:
    case 213:
    case 214:
    case 216:
    case 218:
    case 220:
    case 222:
    case 228:
    case 230:
    case 304:  // line font
    case 310:  // text font
    case 312:  // text display template
    case 314:  // colour
    case 404:  // drawing
    case 406:  // property
    case 410:  // view
      return IgesKind::Harmless;
    default:
      return IgesKind::Unknown;
  }
}

bool is_group(int type, int form) {
  return type != 402 || form == 1 || form == 7 || form == 14 || form == 15;
}

using IgesEntity = Handle(IGESData_IGESEntity);

/// Pieces of a curve that are no points.
std::size_t count_pieces(const IgesEntity& curve, int depth = 0) {
  if (curve.IsNull() || depth > 100) return 0;
  if (const auto all = Handle(IGESGeom_CompositeCurve)::DownCast(curve); !all.IsNull()) {
    std::size_t sum = 0;
    for (int i = 1; i <= all->NbCurves(); ++i) sum += count_pieces(all->Curve(i), depth + 1);
    return sum;
  }
  if (curve->TypeNumber() == 116) return 0;  // a point
  const auto line = Handle(IGESGeom_Line)::DownCast(curve);
  return line.IsNull() || line->StartPoint().Distance(line->EndPoint()) > 0 ? 1 : 0;
}

std::size_t count_edges(const Handle(IGESGeom_CurveOnSurface) & border) {
  return border.IsNull() ? 0 : count_pieces(border->Curve3D());
}

/// Edges that the bounds of a face state, as curves in space. What is stated only in the plane of
/// the surface's parameters is not counted: a piece there may be a point.
std::size_t count_edges(const IgesEntity& face) {
  std::size_t sum = 0;
  if (const auto f = Handle(IGESSolid_Face)::DownCast(face); !f.IsNull()) {
    for (int i = 1; i <= f->NbLoops(); ++i) {
      const Handle(IGESSolid_Loop) loop = f->Loop(i);
      for (int k = 1; !loop.IsNull() && k <= loop->NbEdges(); ++k)
        sum += loop->EdgeType(k) == 0 ? 1 : 0;  // else a vertex
    }
  } else if (const auto t = Handle(IGESGeom_TrimmedSurface)::DownCast(face); !t.IsNull()) {
    if (t->HasOuterContour()) sum += count_edges(t->OuterContour());
    for (int i = 1; i <= t->NbInnerContours(); ++i) sum += count_edges(t->InnerContour(i));
  } else if (const auto b = Handle(IGESGeom_BoundedSurface)::DownCast(face); !b.IsNull()) {
    for (int i = 1; i <= b->NbBoundaries(); ++i) {
      const Handle(IGESGeom_Boundary) border = b->Boundary(i);
      for (int k = 1; !border.IsNull() && k <= border->NbModelSpaceCurves(); ++k)
        sum += count_pieces(border->ModelSpaceCurve(k));
    }
  }
  return sum;
}

class IgesCensus {
 public:
  explicit IgesCensus(const Handle(Interface_InterfaceModel) & model)
      : model_(model), graph_(model) {}

  Census run() {
    check_unit();
    const int count = model_->NbEntities();
    for (int i = 1; i <= count; ++i) {
      const Handle(IGESData_IGESEntity) e = at(i);
      if (e.IsNull() || kind(i) == IgesKind::Unknown)
        refuse(name(i) + ": entities of this type are not read");
      if (model_->IsRedefinedContent(i) || model_->IsUnknownEntity(i) ||
          e->IsKind(STANDARD_TYPE(IGESData_UndefinedEntity)))
        if (kind(i) != IgesKind::Harmless)
          refuse(name(i) + " cannot be understood: its form or its parameters are not known");
      check_matrix(i);
    }
    for (int i = 1; i <= count; ++i)
      if (kind(i) != IgesKind::Part && kind(i) != IgesKind::Harmless && !is_referred(i)) add(i, 0);
    Census out;
    for (int i = 1; i <= count; ++i) {
      const double uses = uses_[i];
      if (kind(i) == IgesKind::Face && uses == 0) refuse(name(i) + " is a face that nothing shows");
      if (kind(i) == IgesKind::Harmless) out.harmless.insert(i);
      if (uses > 0) out.faces.push_back({i, name(i), uses, count_edges(at(i))});
    }
    return out;
  }

 private:
  [[noreturn]] static void refuse(const std::string& what) { throw std::runtime_error(what); }

  /// Its flag and its name say the same, and a unit is a unit: a scale of the model is not read.
  void check_unit() const {
    const auto model = Handle(IGESData_IGESModel)::DownCast(model_);
    if (model.IsNull()) refuse("it has no global section");
    const IGESData_GlobalSection& global = model->GlobalSection();
    if (global.Scale() != 1) refuse("its model space has a scale, which is not read");
    static const std::map<int, std::string> kNames{
        {1, "IN INCH"}, {2, "MM"},  {3, ""},   {4, "FT"},  {5, "MI"},  {6, "M"},
        {7, "KM"},      {8, "MIL"}, {9, "UM"}, {10, "CM"}, {11, "UIN"}};
    const int flag = global.UnitFlag();
    const auto known = kNames.find(flag);
    std::string name = global.UnitName().IsNull() ? "" : global.UnitName()->ToCString();
    for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    int named = 0;
    for (const auto& [of, names] : kNames)
      if (!name.empty() && (" " + names + " ").find(" " + name + " ") != std::string::npos)
        named = of;
    const bool right =
        known != kNames.end() && (flag == 3 ? named != 0 : named == 0 || named == flag);
    if (!right)
      refuse("its unit (flag " + std::to_string(flag) + ", name '" + name +
             "') is none, or says two things");
  }

  /// OpenCASCADE forgets the matrices of solids, shells, faces, loops, points and more.
  void check_matrix(int i) const {
    const auto e = at(i);
    if (const auto m = Handle(IGESGeom_TransformationMatrix)::DownCast(e); !m.IsNull()) {
      double off = 0;
      for (int j = 1; j <= 3; ++j)
        for (int k = 1; k <= 3; ++k) {
          double dot = j == k ? -1 : 0;
          for (int n = 1; n <= 3; ++n) dot += m->Data(j, n) * m->Data(k, n);
          off = std::max(off, std::abs(dot));
        }
      if (!(off <= kRigid)) refuse(name(i) + " is not rigid, which is not read");
    }
    if (!e->HasTransf() || kind(i) == IgesKind::Harmless) return;
    switch (e->TypeNumber()) {
      case 100:  // curves
      case 102:
      case 104:
      case 106:
      case 110:
      case 112:
      case 126:
      case 130:
      case 108:  // surfaces
      case 114:
      case 118:
      case 120:
      case 122:
      case 128:
      case 140:
      case 144:  // trimmed surface
      case 402:  // group
        return;
      case 408: {  // instance: only where it does not matter which of both comes first
        const auto instance = Handle(IGESBasic_SingularSubfigure)::DownCast(e);
        const bool stays = !instance.IsNull() && instance->Translation().Modulus() == 0;
        const gp_Mat turn = e->Location().VectorialPart();
        double most = 0;
        for (int j = 1; j <= 3; ++j)
          for (int k = 1; k <= 3; ++k)
            most = std::max(most, std::abs(turn.Value(j, k) - (j == k ? 1 : 0)));
        if (stays || most == 0) return;
        refuse(name(i) + " is both moved and turned, which is not read");
      }
      default:
        refuse(name(i) + " is moved by a matrix, which is not read");
    }
  }

  Handle(IGESData_IGESEntity) at(int i) const {
    return Handle(IGESData_IGESEntity)::DownCast(model_->Value(i));
  }
  IgesKind kind(int i) const {
    const auto e = at(i);
    return e.IsNull() ? IgesKind::Unknown : iges_kind(e->TypeNumber(), e->FormNumber());
  }
  /// "D7 (type 186)", as in the file's directory.
  std::string name(int i) const {
    const auto e = at(i);
    std::string place = "D" + std::to_string(2 * i - 1);
    if (e.IsNull()) return place;
    return place + " (type " + std::to_string(e->TypeNumber()) +
           (e->FormNumber() != 0 ? ", form " + std::to_string(e->FormNumber()) : std::string()) +
           ")";
  }

  /// Whether a shape that is shown by itself, or a definition for others, holds it.
  bool is_referred(int i) const {
    if (at(i)->TypeNumber() == 308) return true;  // shown by its instances only
    for (Interface_EntityIterator by = graph_.Sharings(model_->Value(i)); by.More(); by.Next()) {
      const int holder = model_->Number(by.Value());
      const auto e = at(holder);
      if (kind(holder) == IgesKind::Harmless) continue;
      if (!is_group(e->TypeNumber(), e->FormNumber())) continue;
      return true;
    }
    return false;
  }

  void add(int i, int depth) {
    if (depth > 100) refuse(name(i) + " is a part of itself");
    if (++places_ > 10'000'000) refuse(name(i) + ": too many places of it");
    switch (kind(i)) {
      case IgesKind::Face:
      case IgesKind::Surface:
        uses_[i] += 1;
        break;
      case IgesKind::Container: {
        if (!is_group(at(i)->TypeNumber(), at(i)->FormNumber())) break;
        std::size_t parts = 0;
        for (Interface_EntityIterator of = graph_.Shareds(model_->Value(i)); of.More(); of.Next()) {
          const int part = model_->Number(of.Value());
          if (part <= 0) refuse(name(i) + " refers to nothing");
          if (kind(part) == IgesKind::Part || kind(part) == IgesKind::Harmless) continue;
          ++parts;
          add(part, depth + 1);
        }
        const int type = at(i)->TypeNumber();
        if (parts == 0 && (type == 186 || type == 514 || type == 408))
          refuse(name(i) + " has no faces");
        break;
      }
      default:
        break;
    }
  }

  Handle(Interface_InterfaceModel) model_;
  Interface_Graph graph_;
  std::map<int, double> uses_;
  std::size_t places_ = 0;
};

}  // namespace

void check_iges_numbers(std::string_view text) {
  std::size_t sequence = 0;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    if (line.size() < 73 || line[72] != 'P') continue;
    ++sequence;
    for (std::size_t at = 0; at < 64;) {
      std::size_t next = std::min(line.find_first_of(",; ", at), std::size_t{64});
      std::string word(line.substr(at, next - at));
      if (const std::size_t h = word.find('H'); h != std::string::npos && h > 0 && h < 9) {
        // A text of so many characters, as far as it is on this line.
        next = std::max(next, std::min<std::size_t>(at + h + 1 + std::atoi(word.c_str()), 64));
        word.clear();
      }
      std::replace(word.begin(), word.end(), 'D', 'E');
      double value = 0;
      const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
      const bool whole = !word.empty() && stop == word.data() + word.size();
      const bool tiny = word.find("E-") != std::string::npos;
      if (whole && ((error == std::errc::result_out_of_range && !tiny) || std::abs(value) > 1e100))
        throw std::runtime_error("line P" + std::to_string(sequence) + ": the number " + word +
                                 " is beyond 1e100");
      at = next + 1;
    }
  }
}

Census iges_census(const Handle(Interface_InterfaceModel) & model) {
  return IgesCensus(model).run();
}

}  // namespace kaboum::io
