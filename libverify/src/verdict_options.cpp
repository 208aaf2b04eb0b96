// The options of verdicts on meshes: their tables, and what verdicts on robots have of them, too.

#include <kaboum/verify/verdict_options.h>

namespace kaboum::verify {
namespace {

using R = MeshVerdictOptions;

/// @param epsilon  what it decides
std::vector<Option<R>> table(const std::string& epsilon) {
  return {choice<R>(
              claims_option(), [](auto& r) -> auto& { return r.claims; }, kClaims),
          option<R>(
              {.name = "epsilon", .text = epsilon}, [](auto& r) -> auto& { return r.epsilon; }),
          choice<R>(
              {.name = "prepare",
               .text = "Judge the original as decimation and decomposition prepare it, which "
                       "is what their claims and a container's epsilon are about, instead of "
                       "the file as it is: " +
                       preparation_words(),
               .implied = "auto"},
              [](auto& r) -> auto& { return r.prepare; }, kPrepared),
          option<R>(
              drop_sheets_option(), [](auto& r) -> auto& { return r.drop_sheets; }),
          option<R>(
              exact_points_option(), [](auto& r) -> auto& { return r.exact_points; }),
          option<R>(
              max_contacts_option(), [](auto& r) -> auto& { return r.max_contacts; }),
          option<R>(
              max_work_option(), [](auto& r) -> auto& { return r.max_work; })};
}

}  // namespace

const std::vector<Option<MeshVerdictOptions>>& mesh_verdict_options() {
  static const std::vector<Option<R>> options = table(
      "Also decide that no distance between the surfaces, both ways, exceeds this: a length, or a "
      "percentage of the original's bounding-box diagonal; of an inner set, that it leaves out no "
      "point deeper than this inside the original");
  return options;
}

const std::vector<Option<MeshVerdictOptions>>& cover_verdict_options() {
  static const std::vector<Option<R>> options = table(
      "Also decide that no point of the union is farther than this from the original's solid (its "
      "surface when it is open and {prepare} is not given): a length, or a percentage of the "
      "original's bounding-box diagonal");
  return options;
}

std::string contradiction(const MeshVerdictOptions& o) {
  return o.drop_sheets && !o.prepare ? "{drop-sheets} needs {prepare}" : "";
}

const char* name_of(Claims claims) {
  for (const auto& [name, value] : kClaims)
    if (value == claims) return name;
  return "";
}

OptionDescription claims_option() {
  return {.name = "claims",
          .text = "Claims that decide; those that mean nothing for the files do not count"};
}

OptionDescription drop_sheets_option() {
  return {.name = "drop-sheets",
          .text =
              "With {prepare}: drop sheets (faces back to back without volume), as decimation "
              "and decomposition do with this option; nothing is then said about them, and the "
              "verdict names them"};
}

OptionDescription max_contacts_option() {
  return {.name = "max-contacts",
          .text = "Give up, undecided, beyond this many pairs of triangles that touch",
          .low = 1,
          .high = 4'000'000'000};
}

OptionDescription max_work_option() {
  return {.name = "max-work",
          .text =
              "Leave what encloses what undecided after so much work, counted in steps that "
              "take at most about so many seconds of one core, so that the answer is the same "
              "on any machine",
          .values = "SECONDS",
          .low = 0.001,
          .high = 1e9,
          .otherwise = "60, and 5 per 1000 triangles"};
}

OptionDescription exact_points_option() {
  return {.name = "exact-points",
          .text =
              "Of STEP and IGES: how densely points of the exact faces are looked at, which "
              "refute where they stick out; parts of each interval between knots of an edge, "
              "and of a face in each direction; 0: the triangles alone are judged",
          .low = 0,
          .high = 10'000};
}

std::string preparation_words() {
  return "parts that are inside out turned, copies and walls dropped, holes filled, quads that are "
         "not plane split so that both ways are bounded";
}

}  // namespace kaboum::verify
