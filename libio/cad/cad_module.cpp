// STEP and IGES by OpenCASCADE, as a module that is loaded when such a file is read: its libraries
// take longer to load than most programs run.
//
// What the file states is counted first, from its entities (census.h); what was transferred has to
// be that. Faces are made into triangles by OpenCASCADE's incremental mesher, made finer where that
// is needed, and the distance of the exact faces and edges from them is bounded (exact_cover.h).

#include <BRepBndLib.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <IGESControl_Reader.hxx>
#include <IMeshData_Status.hxx>
#include <Interface_Check.hxx>
#include <Interface_CheckIterator.hxx>
#include <Precision.hxx>
#include <STEPControl_Reader.hxx>
#include <ShapeAnalysis_ShapeTolerance.hxx>
#include <Standard_Failure.hxx>
#include <StepData_StepModel.hxx>
#include <StepRepr_RepresentationItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <unordered_map>

#include "../src/cad_shape.h"
#include "census.h"
#include "exact_cover.h"
#include "exact_integrals.h"

namespace kaboum::io {
namespace {

constexpr double kChord = 2e-4;  ///< chords of the mesher, as a share of the shape's diagonal
constexpr double kWish = 1.5;    ///< deviation that is aimed at, in chords
constexpr double kAngle = 0.35;  ///< between neighbouring triangles [rad]
constexpr double kMost = 0.02;   ///< deviation that is taken, as a share of the diagonal

[[noreturn]] void refuse(const std::string& what) { throw std::runtime_error(what); }

/// The name of the entity that a solid was made of.
std::string name_of(const XSControl_Reader& reader, const TopoDS_Shape& solid) {
  const Handle(Standard_Transient) entity =
      reader.WS()->TransferReader()->EntityFromShapeResult(solid, 1);
  const Handle(StepRepr_RepresentationItem) item =
      Handle(StepRepr_RepresentationItem)::DownCast(entity);
  if (item.IsNull() || item->Name().IsNull()) return {};
  return item->Name()->ToCString();
}

std::size_t count_faces(const TopoDS_Shape& shape) {
  std::size_t count = 0;
  if (shape.IsNull()) return 0;
  for (TopExp_Explorer at(shape, TopAbs_FACE); at.More(); at.Next()) ++count;
  return count;
}

/// Edges that are no points, as often as the face's bounds have them.
std::size_t count_edges(const TopoDS_Shape& shape) {
  std::size_t count = 0;
  for (TopExp_Explorer at(shape, TopAbs_EDGE); at.More(); at.Next())
    if (!BRep_Tool::Degenerated(TopoDS::Edge(at.Current()))) ++count;
  return count;
}

/// What a check says first.
std::string complaint(const Handle(Interface_Check) & check) {
  return check->NbFails() > 0 ? check->CFail(1) : "";
}

class Reading {
 public:
  Reading(XSControl_Reader& reader, bool iges, CadShape& result)
      : reader_(reader), iges_(iges), result_(result) {}

  void run(const char* path) {
    std::ifstream file(path, std::ios::binary);
    std::string text{std::istreambuf_iterator<char>(file), {}};
    if (iges_)
      check_iges_numbers(text);
    else
      census_ = step_census(std::move(text));
    if (reader_.ReadFile(path) != IFSelect_RetDone)
      refuse("the file cannot be read; it is damaged or of another kind");
    model_ = reader_.Model();
    if (iges_) census_ = iges_census(model_);
    number_entities();
    check_loading();
    reader_.TransferRoots();
    process_ = reader_.WS()->TransferReader()->TransientProcess();
    const TopoDS_Shape shape = reader_.OneShape();
    check_transfer(shape);
    Bnd_Box box;
    if (!shape.IsNull()) BRepBndLib::Add(shape, box, false);
    if (shape.IsNull() || box.IsVoid()) refuse("the file has no faces");
    mesh(shape, std::sqrt(box.SquareExtent()));
  }

 private:
  /// The entities of the census by their numbers in the model.
  void number_entities() {
    const Handle(StepData_StepModel) step = Handle(StepData_StepModel)::DownCast(model_);
    for (int i = 1; i <= model_->NbEntities(); ++i)
      number_[iges_ ? i : step->IdentLabel(model_->Value(i))] = i;
  }

  [[nodiscard]] std::string label(const Handle(Standard_Transient) & entity) const {
    const Handle(TCollection_HAsciiString) text = model_->StringLabel(entity);
    return (text.IsNull() ? std::string("an entity") : std::string(text->ToCString())) + " " +
           model_->TypeName(entity, false);
  }

  /// Entities whose text could not be understood.
  void check_loading() const {
    const Handle(Interface_Check) global = model_->GlobalCheck(true);
    if (global->NbFails() > 0) refuse(complaint(global));
    for (int i = 1; i <= model_->NbEntities(); ++i) {
      const Handle(Standard_Transient) entity = model_->Value(i);
      const std::int64_t id =
          iges_ ? i : Handle(StepData_StepModel)::DownCast(model_)->IdentLabel(entity);
      if (census_.harmless.count(id) > 0) continue;
      if (model_->IsErrorEntity(i) || model_->IsUnknownEntity(i)) {
        const Handle(Interface_Check) check = model_->Check(i, true);
        refuse(label(entity) + " cannot be understood: " + complaint(check));
      }
    }
  }

  /// Every face that the file states is there, in all its places, and no other.
  void check_transfer(const TopoDS_Shape& shape) const {
    Interface_CheckIterator checks = process_->CheckList(true);
    for (checks.Start(); checks.More(); checks.Next()) {
      const Handle(Interface_Check)& check = checks.Value();
      if (check->NbFails() > 0)
        refuse((checks.Number() > 0 ? label(model_->Value(checks.Number())) + ": " : "") +
               complaint(check));
    }
    double stated = 0;
    for (const FaceUse& face : census_.faces) {
      const auto at = number_.find(face.id);
      if (at == number_.end()) refuse(face.name + " was not read");
      const TopoDS_Shape made = TransferBRep::ShapeResult(process_, model_->Value(at->second));
      const std::size_t count = count_faces(made);
      if (count == 0) refuse(face.name + " could not be made into a face");
      if (count_edges(made) < face.edges)
        refuse(face.name + ": of its " + std::to_string(face.edges) + " edges only " +
               std::to_string(count_edges(made)) + " could be made");
      stated += face.uses * static_cast<double>(count);
    }
    const std::size_t made = count_faces(shape);
    if (stated != static_cast<double>(made))
      refuse("the file states " + std::to_string(static_cast<std::int64_t>(stated)) +
             " faces, counting all places of parts, and " + std::to_string(made) +
             " could be made");
  }

  void mesh(const TopoDS_Shape& shape, double diagonal) {
    if (!(kChord * diagonal >= Precision::Confusion())) {
      std::ostringstream text;
      text << "its shape is only " << diagonal
           << " mm large; OpenCASCADE takes points within 1e-7 mm for one; is its unit right?";
      refuse(text.str());
    }
    BRepMesh_IncrementalMesh meshing(shape, kChord * diagonal, false, kAngle, false);
    if ((meshing.GetStatusFlags() & IMeshData_Failure) != 0)
      refuse("a face could not be made into triangles");
    for (TopExp_Explorer at(shape, TopAbs_SOLID); at.More(); at.Next())
      result_.solids.push_back(name_of(reader_, at.Current()));
    for (TopExp_Explorer at(shape, TopAbs_FACE, TopAbs_SOLID); at.More(); at.Next())
      ++result_.loose_faces;
    result_.faces = count_faces(shape);
    ExactCover cover = cover_exact_shape(shape, kWish * kChord * diagonal, kMost * diagonal);
    result_.bare_faces = cover.bare_faces;
    if (cover.bare_faces > 0) return;
    // Faces, edges and vertices may be this far from each other, as the file says; or as was
    // proved.
    result_.deviation =
        cover.distance + std::max(cover.gap, ShapeAnalysis_ShapeTolerance().Tolerance(shape, 1));
    result_.pieces = cover.pieces;
    if (!(result_.deviation <= kMost * diagonal))
      refuse("the exact shape can only be said to be within " + std::to_string(result_.deviation) +
             " mm of triangles (" + cover.farthest + ", " + cover.widest + ")");
    check_integrals(shape, cover, result_.deviation,
                    result_.loose_faces == 0 && !result_.solids.empty());
    result_.points = std::move(cover.points);
    result_.triangles = std::move(cover.triangles);
  }

  XSControl_Reader& reader_;
  bool iges_;
  CadShape& result_;
  Census census_;
  Handle(Interface_InterfaceModel) model_;
  Handle(Transfer_TransientProcess) process_;
  std::unordered_map<std::int64_t, int> number_;
};

}  // namespace
}  // namespace kaboum::io

extern "C" __attribute__((visibility("default"))) void kaboum_read_cad(
    const char* path, bool iges, kaboum::io::CadShape& result) {
  try {
    if (iges) {
      IGESControl_Reader reader;
      kaboum::io::Reading(reader, true, result).run(path);
    } else {
      STEPControl_Reader reader;
      kaboum::io::Reading(reader, false, result).run(path);
    }
  } catch (const Standard_Failure& failure) {
    result.error = std::string("OpenCASCADE failed: ") + failure.GetMessageString();
  } catch (const std::exception& failure) {
    result.error = failure.what();
  }
}
