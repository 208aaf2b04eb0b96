// Units of a STEP file's representations, as far as OpenCASCADE understands them. Where it does
// not, it takes millimetres and radians without a word.

#include <algorithm>
#include <array>
#include <stdexcept>

#include "step_file.h"

namespace kaboum::io {
namespace {

constexpr std::size_t npos = StepFile::npos;

[[noreturn]] void refuse(const std::string& what) { throw std::runtime_error(what); }

bool is_prefix(std::string_view word) {
  static constexpr auto kPrefixes = std::to_array<std::string_view>(
      {".EXA.", ".PETA.", ".TERA.", ".GIGA.", ".MEGA.", ".KILO.", ".HECTO.", ".DECA.", ".DECI.",
       ".CENTI.", ".MILLI.", ".MICRO.", ".NANO.", ".PICO.", ".FEMTO.", ".ATTO."});
  return std::find(kPrefixes.begin(), kPrefixes.end(), word) != kPrefixes.end();
}

/// An SI unit with a known prefix or none.
void check_si(const StepFile& file, const StepEntity& unit, std::string_view name) {
  const auto* si = record_of(unit, "SI_UNIT");
  const StepToken* prefix = si == nullptr ? nullptr : file.parameter(*si, 0);
  const StepToken* of = si == nullptr ? nullptr : file.parameter(*si, 1);
  if (of == nullptr || file.word(*of) != name ||
      (prefix->kind != StepToken::Omitted && !is_prefix(file.word(*prefix))))
    refuse(named(unit) + " is not " + std::string(name) + " with a known prefix, which is needed");
}

/// An SI unit, or so many of one.
void check_unit(const StepFile& file, const StepEntity& unit, std::string_view name) {
  const auto* converted = record_of(unit, "CONVERSION_BASED_UNIT");
  if (converted == nullptr) return check_si(file, unit, name);
  const std::size_t measure = file.argument(*converted, 1);
  if (measure == npos) refuse(named(unit) + " has no measure");
  const StepEntity& m = file.entities()[measure];
  const std::size_t in = m.records.size() == 1 && m.records[0].name.ends_with("MEASURE_WITH_UNIT")
                             ? file.argument(m.records[0], 1)
                             : npos;
  if (in == npos) refuse(named(m) + ": a measure in this form is not read");
  check_si(file, file.entities()[in], name);
}

}  // namespace

void check_units(const StepFile& file, const StepEntity& representation) {
  const StepRecord* r = record_of(representation, "REPRESENTATION");
  if (r == nullptr) r = &representation.records.front();
  const std::size_t at = file.argument(*r, 2);
  if (at == npos) refuse(named(representation) + " has no context");
  const StepEntity& context = file.entities()[at];
  for (const StepRecord& part : context.records)
    if (part.name != "GEOMETRIC_REPRESENTATION_CONTEXT" &&
        part.name != "GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT" &&
        part.name != "GLOBAL_UNIT_ASSIGNED_CONTEXT" && part.name != "REPRESENTATION_CONTEXT")
      refuse(named(context) + ": a context of this kind is not read");
  std::array<std::size_t, 2> count{0, 0};  // of lengths, of angles
  for (const std::size_t unit : file.references(context)) {
    if (unit == npos) continue;
    const StepEntity& e = file.entities()[unit];
    const bool length = record_of(e, "LENGTH_UNIT") != nullptr;
    if (!length && record_of(e, "PLANE_ANGLE_UNIT") == nullptr) continue;
    ++count[length ? 0 : 1];
    check_unit(file, e, length ? ".METRE." : ".RADIAN.");
  }
  if (record_of(context, "GLOBAL_UNIT_ASSIGNED_CONTEXT") == nullptr || count[0] != 1)
    refuse(named(context) + " has " + (count[0] == 0 ? "no unit" : "several units") +
           " of length, for " + named(representation));
  const auto is_cone = [](const StepEntity& e) {
    return record_of(e, "CONICAL_SURFACE") != nullptr;
  };
  if (count[1] > 1 ||
      (count[1] == 0 && std::any_of(file.entities().begin(), file.entities().end(), is_cone)))
    refuse(named(context) + " has " + (count[1] == 0 ? "no unit" : "several units") +
           " of plane angles, for " + named(representation));
}

}  // namespace kaboum::io
