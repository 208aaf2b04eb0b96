// Damages STEP and IGES files in many ways, has a program make something that encloses the part of
// each, and judges every success.
//
//   damaged_cad BIN FOLDER [VARIANTS [FIRST [PART]]]
//
// BIN holds the programs; FOLDER takes the files; each of twenty files (models.h) is damaged in
// VARIANTS ways (damage.h), by seeds FIRST, FIRST + 1, ... PART: only files of that name.
// `mesh-prepare` runs on every variant, and `bcd-decompose` on each that is read as triangles that
// no variant before was.
//
// What the part of a damaged file is. Where a program ends with 0, its result has to hold
//   (a) every face that OpenCASCADE's transfer of all roots still makes of the damaged file, at
//       points of the exact surface inside the loops, of edges, and at all knots; and
//   (b) every face of the undamaged part, in each place that it had there, whose record and all
//       records below it stand in the damaged file as they were: whoever reads that carefully
//       finds the face, wherever damage left it: in no shell, in a solid that has lost its name, in
//       an assembly that refers to nothing. Where it is nobody can tell if a record above faces
//       that places things or states a unit was touched; then (b) says nothing, and (a) alone
//       counts.
// Or the program refuses: what it cannot read it has to say. Exit codes but 0 are all right, unless
// a program is killed by a signal other than that of the limit of time. Variants that end at a
// limit are counted and named.
//
// A result holds a point if its winding number is at least 1, or the point is within 1e-6 of the
// diagonal of its surface, and for mesh-prepare, whose triangles stand for the faces within the
// deviation that its report states, within that.
//
// Ends with 1 if a result does not hold its part, and names all of these.

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepClass_FaceClassifier.hxx>
#include <BRep_Tool.hxx>
#include <IGESControl_Reader.hxx>
#include <IGESData_IGESModel.hxx>
#include <Interface_InterfaceModel.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Precision.hxx>
#include <STEPControl_Reader.hxx>
#include <Standard_Failure.hxx>
#include <StepData_StepModel.hxx>
#include <TColStd_Array1OfReal.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Edge.hxx>
#include <TopoDS_Face.hxx>
#include <TransferBRep.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <kaboum/geom/triangle_search.h>
#include <kaboum/geom/winding.h>
#include <kaboum/io/mesh_io.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <map>
#include <memory>
#include <set>
#include <sstream>

#include "damage.h"
#include "models.h"

namespace {

namespace fs = std::filesystem;
using kaboum::geom::Vec3;
using kaboum::test::CadModel;
using kaboum::test::Damage;

constexpr int kSeconds = 30;  ///< of CPU time that a program, or a judge, may take
constexpr int kGrid = 9, kAlong = 24;
constexpr int kTimedOut = -1, kKilled = -2;

struct FacePoints {
  int entity = 0;  ///< that it was made of; 0: not known
  std::vector<Vec3> points;
};

Vec3 vector_of(const gp_Pnt& p) { return {p.X(), p.Y(), p.Z()}; }

/// Parameters between all ends, and these.
std::vector<double> between(const TColStd_Array1OfReal& ends, int parts) {
  std::vector<double> out;
  for (int i = ends.Lower(); i < ends.Upper(); ++i)
    for (int k = 0; k < parts; ++k) out.push_back(ends(i) + (ends(i + 1) - ends(i)) * k / parts);
  out.push_back(ends.Last());
  return out;
}

std::vector<Vec3> points_of(const TopoDS_Face& face) {
  std::vector<Vec3> out;
  const BRepAdaptor_Surface surface(face);
  TColStd_Array1OfReal us(1, surface.NbUIntervals(GeomAbs_CN) + 1),
      vs(1, surface.NbVIntervals(GeomAbs_CN) + 1);
  surface.UIntervals(us, GeomAbs_CN);
  surface.VIntervals(vs, GeomAbs_CN);
  BRepClass_FaceClassifier classifier;
  for (const double u : between(us, us.Length() > 2 ? 4 : kGrid))
    for (const double v : between(vs, vs.Length() > 2 ? 4 : kGrid)) {
      if (Precision::IsInfinite(u) || Precision::IsInfinite(v)) continue;
      classifier.Perform(face, gp_Pnt2d(u, v), Precision::PConfusion());
      if (classifier.State() == TopAbs_IN) out.push_back(vector_of(surface.Value(u, v)));
    }
  for (TopExp_Explorer at(face, TopAbs_EDGE); at.More(); at.Next()) {
    const TopoDS_Edge& edge = TopoDS::Edge(at.Current());
    if (BRep_Tool::Degenerated(edge)) continue;
    const BRepAdaptor_Curve curve(edge);
    TColStd_Array1OfReal ends(1, curve.NbIntervals(GeomAbs_CN) + 1);
    curve.Intervals(ends, GeomAbs_CN);
    for (const double t : between(ends, kAlong))
      if (!Precision::IsInfinite(t)) out.push_back(vector_of(curve.Value(t)));
  }
  std::erase_if(out, [](const Vec3& p) { return !p.allFinite(); });
  return out;
}

std::unique_ptr<XSControl_Reader> reader_of(bool iges) {
  if (iges) return std::make_unique<IGESControl_Reader>();
  return std::make_unique<STEPControl_Reader>();
}

/// The number by which damage.h knows the entity: what the file calls it.
int number_in_file(const Handle(Interface_InterfaceModel) & model,
                   const Handle(Standard_Transient) & entity, bool iges) {
  const int number = model->Number(entity);
  if (iges) return 2 * number - 1;
  return Handle(StepData_StepModel)::DownCast(model)->IdentLabel(entity);
}

/// All faces, each where it is, with the entity that it was made of.
std::vector<FacePoints> faces_of(const fs::path& file, bool iges) {
  const std::unique_ptr<XSControl_Reader> reader = reader_of(iges);
  std::vector<FacePoints> out;
  if (reader->ReadFile(file.c_str()) != IFSelect_RetDone) return out;
  reader->TransferRoots();
  const Handle(Interface_InterfaceModel) model = reader->Model();
  const Handle(Transfer_TransientProcess) process =
      reader->WS()->TransferReader()->TransientProcess();
  std::map<const void*, int> entity_of;  // a face's geometry, wherever it is placed
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const TopoDS_Shape shape = TransferBRep::ShapeResult(process, model->Value(i));
    if (!shape.IsNull() && shape.ShapeType() == TopAbs_FACE)
      entity_of[shape.TShape().get()] = number_in_file(model, model->Value(i), iges);
  }
  for (TopExp_Explorer at(reader->OneShape(), TopAbs_FACE); at.More(); at.Next()) {
    const TopoDS_Face& face = TopoDS::Face(at.Current());
    const auto known = entity_of.find(face.TShape().get());
    try {
      out.push_back({known == entity_of.end() ? 0 : known->second, points_of(face)});
    } catch (const Standard_Failure&) {  // NOLINT(bugprone-empty-catch): it has no points
    }
  }
  return out;
}

/// Runs `work` in a child. @return its exit code; kTimedOut, kKilled
template <class Work>
int in_child(const Work& work) {
  std::cout.flush();
  const pid_t id = ::fork();
  if (id == 0) {
    const rlimit limit{kSeconds, kSeconds + 1};
    ::setrlimit(RLIMIT_CPU, &limit);
    int code = 99;
    try {
      code = work();
    } catch (const Standard_Failure&) {
      code = 98;
    } catch (const std::exception&) {
      code = 97;
    }
    std::cout.flush();
    ::_exit(code);
  }
  int status = 0;
  ::waitpid(id, &status, 0);
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  return WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL ? kTimedOut : kKilled;
}

int run(std::vector<std::string> words, const fs::path& log) {
  return in_child([&]() -> int {
    std::vector<char*> arguments;
    for (std::string& word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int nothing = ::open("/dev/null", O_RDWR | O_CLOEXEC);
    const int errors = ::open(log.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0600);
    for (const int fd : {0, 1}) ::dup2(nothing, fd);
    ::dup2(errors, 2);
    ::execv(arguments[0], arguments.data());
    return 127;
  });
}

/// Holds points or not: a result, with what it may be away from them.
class Result {
 public:
  Result(kaboum::geom::Mesh mesh, double allowed)
      : mesh_(std::move(mesh)),
        winding_(mesh_),
        query_(mesh_),
        allowed_(allowed + 1e-6 * kaboum::geom::bounding_box(mesh_).diagonal()) {}

  /// How far outside; 0: it is held.
  [[nodiscard]] double outside(const Vec3& p) const {
    if (winding_(p) >= 1) return 0;
    const double distance = query_.nearest(p).lower;
    return distance > allowed_ ? distance : 0;
  }

 private:
  kaboum::geom::Mesh mesh_;
  kaboum::geom::WindingNumber winding_;
  kaboum::geom::DistanceQuery query_;
  double allowed_;
};

/// @return whether all is held; else says which faces are not
bool holds_all(const Result& result, const std::vector<FacePoints>& faces, const char* of) {
  std::size_t points = 0, outside = 0;
  double farthest = 0;
  int entity = 0;
  for (const FacePoints& face : faces)
    for (const Vec3& p : face.points) {
      ++points;
      const double here = result.outside(p);
      if (!(here > 0)) continue;
      ++outside;
      if (here > farthest) entity = face.entity;
      farthest = std::max(farthest, here);
    }
  if (outside == 0) return true;
  std::cout << "    " << of << ": " << outside << " of " << points << " points are up to "
            << farthest << " outside, of entity " << entity << '\n';
  return false;
}

/// Faces of the undamaged part that the damaged file still has, where their place is known.
std::vector<FacePoints> faces_left(const CadModel& model, const std::vector<FacePoints>& faces,
                                   const Damage& damage, bool iges) {
  if (damage.header) return {};
  std::vector<FacePoints> out;
  std::set<int> in_faces;
  for (const FacePoints& face : faces) {
    if (face.entity == 0) continue;
    const std::set<int> below = kaboum::test::all_below(model.text, iges, face.entity);
    bool whole = true;
    for (const int entity : below) {
      whole = whole && !damage.touched.contains(entity);
      in_faces.insert(entity);
    }
    if (whole) out.push_back(face);
  }
  for (const int entity : damage.placing)
    if (!in_faces.contains(entity)) return {};
  return out;
}

double stated_deviation(const fs::path& report) {
  std::ifstream in(report);
  std::stringstream text;
  text << in.rdbuf();
  const std::string key = "\"deviation\":";
  const std::size_t at = text.str().find(key);
  return at == std::string::npos ? 0 : std::atof(text.str().c_str() + at + key.size());
}

struct Count {
  std::size_t variants = 0, covered = 0, wrong = 0, refused = 0, limited = 0, broken = 0;
  std::size_t decomposed = 0, compared = 0;
};

std::ostream& operator<<(std::ostream& out, const Count& c) {
  return out << c.variants << " variants: " << c.covered << " end with 0 and hold the part ("
             << c.decomposed << " decomposed, " << c.compared << " beside undamaged faces), "
             << c.wrong << " end with 0 and do not, " << c.refused << " are refused, " << c.limited
             << " reach a limit, " << c.broken << " break a program";
}

std::string text_of(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

class Campaign {
 public:
  Campaign(fs::path programs, fs::path folder)
      : programs_(std::move(programs)), folder_(std::move(folder)) {}

  Count attack(const CadModel& model, std::uint64_t first, std::size_t variants) {
    const bool iges = model.name.ends_with(".iges");
    const fs::path whole = folder_ / ("whole-" + model.name);
    std::ofstream(whole, std::ios::binary) << model.text;
    std::vector<FacePoints> faces = faces_of(whole, iges);
    for (const auto& [entity, at] : model.unread) {
      faces.push_back({entity, {}});
      for (std::size_t i = 0; i + 2 < at.size(); i += 3)
        faces.back().points.emplace_back(at[i], at[i + 1], at[i + 2]);
    }
    count_ = {};
    decomposed_.clear();
    for (std::uint64_t seed = first; seed < first + variants; ++seed)
      try_variant(model, iges, faces, seed);
    std::cout << model.name << ": " << count_ << '\n' << std::flush;
    return count_;
  }

 private:
  enum class End { Held, NotHeld, Refused, Limited, Broken };

  void try_variant(const CadModel& model, bool iges, const std::vector<FacePoints>& faces,
                   std::uint64_t seed) {
    const Damage damage = kaboum::test::damaged(model.text, iges, seed);
    const fs::path file = folder_ / (std::to_string(seed) + "-" + model.name);
    std::ofstream(file, std::ios::binary) << damage.text;
    ++count_.variants;
    const std::vector<FacePoints> left = faces_left(model, faces, damage, iges);
    const std::string result = (folder_ / "result").string();
    End end = try_program(file, iges, left, damage.what,
                          {(programs_ / "mesh-prepare").string(), file.string(), "-o",
                           result + ".ply", "--threads", "1", "--report", result + ".json"});
    // Of variants that are read as the same triangles, one is decomposed: the bodies are the same.
    if (end == End::Held && decomposed_.insert(text_of(result + ".ply")).second) {
      ++count_.decomposed;
      end = try_program(file, iges, left, damage.what,
                        {(programs_ / "bcd-decompose").string(), file.string(), "-o",
                         result + ".obj", "--epsilon", "10%", "--effort", "fast", "--no-cache",
                         "--threads", "1", "--report", result + ".json"});
    }
    if (end == End::Held && !left.empty()) ++count_.compared;
    count_.covered += end == End::Held ? 1 : 0;
    count_.wrong += end == End::NotHeld ? 1 : 0;
    count_.refused += end == End::Refused ? 1 : 0;
    count_.limited += end == End::Limited ? 1 : 0;
    count_.broken += end == End::Broken ? 1 : 0;
    if (end != End::NotHeld && end != End::Broken) fs::remove(file);  // the others can be looked at
  }

  End try_program(const fs::path& file, bool iges, const std::vector<FacePoints>& left,
                  const std::string& what, const std::vector<std::string>& command) {
    const fs::path made = command[3], report = command.back(), log = folder_ / "log";
    fs::remove(made);
    fs::remove(report);
    const int code = run(command, log);
    const std::string name = fs::path(command[0]).filename().string() + " " + file.string();
    const bool limit = code == kTimedOut || code == 7 ||
                       (code == 3 && text_of(log).find("s of CPU time") != std::string::npos);
    if (limit) {
      std::cout << "  limit: " << name << " (" << what << ")\n" << std::flush;
      return End::Limited;
    }
    if (code == kKilled || code == 127 || code == 6) {
      std::cout << "  BROKEN (" << code << "): " << name << " (" << what << ")\n" << std::flush;
      return End::Broken;
    }
    if (code != 0) return End::Refused;
    const int verdict = in_child([&] {
      // The bodies of a set hold the exact faces, and say so by a wrap; meshes say how far they
      // are.
      const bool set = made.extension() == ".obj";
      const Result result(kaboum::io::read_mesh(made).mesh, set ? 0 : stated_deviation(report));
      const bool old = holds_all(result, left, "undamaged faces");
      return holds_all(result, faces_of(file, iges), "OpenCASCADE's faces") && old ? 0 : 1;
    });
    if (verdict == 0) return End::Held;
    std::cout << "  WRONG (" << verdict << "): " << name << " (" << what << ")\n" << std::flush;
    return End::NotHeld;
  }

  fs::path programs_, folder_;
  Count count_;
  std::set<std::string> decomposed_;  ///< meshes
};

int campaign(const fs::path& programs, const fs::path& folder, std::size_t variants,
             std::uint64_t first, const std::string& part) {
  Message::DefaultMessenger()->ChangePrinters().Clear();
  fs::create_directories(folder);
  Campaign all(programs, folder);
  Count sum;
  for (const CadModel& model : kaboum::test::cad_models()) {
    if (!part.empty() && !model.name.starts_with(part)) continue;
    const Count c = all.attack(model, first, variants);
    for (std::size_t Count::*const of :
         {&Count::variants, &Count::covered, &Count::wrong, &Count::refused, &Count::limited,
          &Count::broken, &Count::decomposed, &Count::compared})
      sum.*of += c.*of;
  }
  std::cout << "all: " << sum << '\n';
  return sum.wrong + sum.broken == 0 && sum.variants > 0 && sum.covered > 0 ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 3 || argc > 6) {
    std::cerr << "usage: damaged_cad BIN FOLDER [VARIANTS [FIRST [PART]]]\n";
    return 2;
  }
  try {
    return campaign(argv[1], argv[2], argc > 3 ? std::strtoul(argv[3], nullptr, 10) : 100,
                    argc > 4 ? std::strtoull(argv[4], nullptr, 10) : 1, argc > 5 ? argv[5] : "");
  } catch (const Standard_Failure& failure) {
    std::cerr << "damaged_cad: " << failure.GetMessageString() << '\n';
  } catch (const std::exception& failure) {
    std::cerr << "damaged_cad: " << failure.what() << '\n';
  }
  return 3;
}
