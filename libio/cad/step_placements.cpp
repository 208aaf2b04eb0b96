// Placements of a STEP file that OpenCASCADE reads otherwise than ISO 10303-42 and -43 mean them.
//
// It takes operators for rigid placements by their first and third axes; it gives a placement
// without a second direction one of its own choice; and it makes of two placements A and B, of
// which A is to be moved onto B, the transformation A⁻¹ B in place of B A⁻¹. Where that makes a
// difference, the file is refused. docs/algorithms/cad.md, "What is in the file"

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "step_file.h"
#include "step_names.h"

namespace kaboum::io {
namespace {

using Vec = Eigen::Vector3d;

constexpr std::size_t npos = StepFile::npos;
constexpr double kParallel = 1e-6;  ///< sine of an angle that is none
constexpr double kSame = 1e-12;     ///< of entries of a rotation, and of lengths as a share

[[noreturn]] void refuse(const std::string& what) { throw std::runtime_error(what); }

struct Frame {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  Vec at = Vec::Zero();
};

class Placements {
 public:
  explicit Placements(const StepFile& file) : file_(file) {}

  void check() const {
    const bool curves = has("TRIMMED_CURVE"), surfaces = has("RECTANGULAR_TRIMMED_SURFACE");
    for (const StepEntity& e : file_.entities()) {
      for (const StepRecord& r : e.records)
        if (r.name == "CARTESIAN_TRANSFORMATION_OPERATOR" ||
            (r.name == "CARTESIAN_TRANSFORMATION_OPERATOR_3D" && e.records.size() > 1))
          refuse(named(e) + ": an operator in this form is not read");
      if (const auto* r = record_of(e, "CARTESIAN_TRANSFORMATION_OPERATOR_3D"))
        check_operator(e, *r);
      if (const auto* r = record_of(e, "ITEM_DEFINED_TRANSFORMATION"))
        check_pair(e, file_.argument(*r, 2), file_.argument(*r, 3));
      if (const auto* r = record_of(e, "MAPPED_ITEM")) check_mapped(e, *r);
      check_placements_of(e, curves, surfaces);
    }
  }

 private:
  [[nodiscard]] const StepEntity& entity(std::size_t i) const { return file_.entities()[i]; }
  [[nodiscard]] bool has(std::string_view type) const {
    return std::any_of(file_.entities().begin(), file_.entities().end(),
                       [type](const StepEntity& e) { return record_of(e, type) != nullptr; });
  }

  /// @param type  of an entity whose numbers are three
  [[nodiscard]] Vec triple(const StepEntity& of, std::size_t at, std::string_view type) const {
    const auto* r = at == npos ? nullptr : record_of(entity(at), type);
    const std::vector<double> n = r != nullptr ? file_.numbers(*r) : std::vector<double>{};
    if (n.size() != 3) refuse(named(of) + ": a " + std::string(type) + " in space is missing");
    return {n[0], n[1], n[2]};
  }
  [[nodiscard]] bool is_omitted(const StepRecord& r, std::size_t i) const {
    const StepToken* token = file_.parameter(r, i);
    return token != nullptr && token->kind == StepToken::Omitted;
  }
  /// Of length 1; `omitted` where none is given.
  [[nodiscard]] Vec direction(const StepEntity& of, const StepRecord& r, std::size_t i,
                              const Vec& omitted) const {
    if (is_omitted(r, i)) return omitted;
    const Vec v = triple(of, file_.argument(r, i), "DIRECTION");
    if (!(v.stableNorm() > 0)) refuse(named(of) + " has a direction of length 0");
    return v.stableNormalized();
  }

  void check_operator(const StepEntity& e, const StepRecord& r) const {
    const StepToken* scale = file_.parameter(r, 6);
    if (scale == nullptr || file_.parameter(r, 7) == nullptr)
      refuse(named(e) + " has too few parameters");
    if (scale->kind != StepToken::Omitted && file_.number(*scale) != 1.0)
      refuse(named(e) + ": an operator that scales is not read");
    const Vec z = direction(e, r, 7, Vec::UnitZ()), y = direction(e, r, 4, Vec::UnitY());
    const Vec x = direction(e, r, 3, z == Vec::UnitZ() ? Vec(Vec::UnitX()) : Vec(Vec::Zero()));
    // The parts of x and y across z, and of y across x, turn as x and y do with z.
    if (!(z.dot(x.cross(y)) > kParallel))
      refuse(named(e) + ": an operator that mirrors, or has not all of its axes, is not read");
  }

  /// Whether OpenCASCADE's choice of the second direction is the standard's.
  [[nodiscard]] bool is_whole(const StepEntity& e, const StepRecord& r) const {
    const Vec z = direction(e, r, 2, Vec::UnitZ());
    if (z == Vec::UnitZ() && is_omitted(r, 3)) return true;
    return z.cross(direction(e, r, 3, z)).norm() > kParallel;
  }

  /// Placements that an entity refers to. Round curves and surfaces look the same however they are
  /// turned, unless others are trimmed by their parameters.
  void check_placements_of(const StepEntity& e, bool curves, bool surfaces) const {
    const auto& type = e.records.front().name;
    const StepKind kind = step_kind(type);
    if (kind == StepKind::Shape || kind == StepKind::Harmless || kind == StepKind::NotAsShape)
      return;
    const bool turns = type == "ELLIPSE" || type == "HYPERBOLA" || type == "PARABOLA" ||
                       kind == StepKind::Assembly || (curves && type == "CIRCLE") ||
                       (surfaces && kind == StepKind::Surface);
    if (!turns) return;
    for (const std::size_t at : file_.references(e)) {
      const auto* r = at == npos ? nullptr : record_of(entity(at), "AXIS2_PLACEMENT_3D");
      if (r != nullptr && !is_whole(entity(at), *r))
        refuse(named(entity(at)) + " has no second direction, which " + named(e) + " needs");
    }
  }

  [[nodiscard]] Frame frame(const StepEntity& of, std::size_t at) const {
    const auto* r = at == npos ? nullptr : record_of(entity(at), "AXIS2_PLACEMENT_3D");
    if (r == nullptr)
      refuse(named(of) + " does not place by AXIS2_PLACEMENT_3D, which is not read");
    const StepEntity& e = entity(at);
    if (!is_whole(e, *r))
      refuse(named(e) + " has no second direction, which " + named(of) + " needs");
    const Vec z = direction(e, *r, 2, Vec::UnitZ());
    const Vec x = direction(e, *r, 3, Vec::UnitX());
    Frame out;
    out.turn.col(2) = z;
    out.turn.col(0) = (x - x.dot(z) * z).normalized();
    out.turn.col(1) = z.cross(out.turn.col(0));
    out.at = triple(e, file_.argument(*r, 1), "CARTESIAN_POINT");
    return out;
  }

  /// B A⁻¹ and A⁻¹ B are the same, whatever the units of A's point and of B's are.
  void check_pair(const StepEntity& of, std::size_t from, std::size_t to) const {
    const Frame a = frame(of, from), b = frame(of, to);
    const Eigen::Matrix3d back = a.turn.transpose();
    const Vec there = back * a.at;
    const bool same = (b.turn * back - back * b.turn).cwiseAbs().maxCoeff() <= kSame &&
                      (back * b.at - b.at).norm() <= kSame * b.at.norm() &&
                      (b.turn * there - there).norm() <= kSame * a.at.norm();
    if (!same)
      refuse(named(of) + " moves " + named(entity(from)) + ", which is not the origin, onto " +
             named(entity(to)) + ": that is not read");
  }

  void check_mapped(const StepEntity& e, const StepRecord& r) const {
    const std::size_t map = file_.argument(r, 1), target = file_.argument(r, 2);
    const auto* of = map == npos ? nullptr : record_of(entity(map), "REPRESENTATION_MAP");
    if (of == nullptr || target == npos) refuse(named(e) + " maps what is not read");
    const std::size_t origin = file_.argument(*of, 0);
    if (record_of(entity(target), "CARTESIAN_TRANSFORMATION_OPERATOR_3D") == nullptr) {
      if (record_of(entity(target), "AXIS2_PLACEMENT_3D") != nullptr) check_pair(e, origin, target);
      return;
    }
    const Frame a = frame(e, origin);
    if (a.at != Vec::Zero() || !(a.turn - Eigen::Matrix3d::Identity()).isZero(kSame))
      refuse(named(e) + " maps by an operator from a placement that is not the origin: not read");
  }

  const StepFile& file_;
};

}  // namespace

void check_placements(const StepFile& file) { Placements(file).check(); }

}  // namespace kaboum::io
