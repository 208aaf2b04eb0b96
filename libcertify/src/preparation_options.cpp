// Options that say how triangles are given a solid.

#include <kaboum/certify/preparation_options.h>

namespace kaboum::certify {
namespace {

using Mode = PreparationOptions::Mode;

OptionDescription offset_option() {
  return {.name = "offset",
          .text =
              "How far a wrap may be from the triangles where it can get near them; a length or "
              "a percentage of the diagonal",
          .otherwise = "a quarter of epsilon, or 0.1%"};
}

OptionDescription seal_option() {
  return {.name = "seal",
          .text =
              "Hollows behind gaps narrower than this are filled by a wrap (those up to 2.5 "
              "times as wide may be); also the scale of the search, whose time and memory grow "
              "with its inverse",
          .otherwise = "what epsilon allows, or 1%"};
}

std::vector<Option<PreparationOptions>> table(PreparedFor use) {
  using R = PreparationOptions;
  const bool may_stay_open = use != PreparedFor::Bodies, wraps = use != PreparedFor::Preparing;
  std::vector<std::pair<std::string, geom::Holes>> holes{{"fill", geom::Holes::Fill},
                                                         {"refuse", geom::Holes::Refuse}};
  if (may_stay_open) holes.insert(holes.begin() + 1, {"keep", geom::Holes::Keep});
  return {
      option<R>(
          {.name = "drop-sheets",
           .text = "Drop back-to-back faces without volume, which are then not held"},
          [](auto& r) -> auto& { return r.drop_sheets; }),
      choice<R>(
          {.name = "holes",
           .text =
               std::string(
                   "Holes of an open mesh. fill: they are closed with triangles, and the "
                   "claims are about the solid so closed, and about every input triangle; ") +
               (may_stay_open ? "keep: its border stays where it is, nothing is enclosed, and "
                                "the exit code is 1"
                              : "") +
               (use == PreparedFor::Bounding ? " (with {direction} any, which claims nothing, 0)"
                                             : "") +
               (may_stay_open ? "; " : "") + "refuse: an error"},
          [](auto& r) -> auto& { return r.holes; }, holes),
      option<R>(
          {.name = "keep-orientation",
           .text = "Never turn inconsistent triangles or inside-out components"},
          [](auto& r) -> auto& { return r.keep_orientation; }),
      choice<R>(
          {.name = "prepare",
           .text =
               std::string("How the triangles are given a solid. auto: inconsistent triangles and "
                           "parts that are inside out are turned, copies and walls dropped, holes "
                           "filled") +
               (wraps ? ", and a mesh that this does not do for is wrapped" : "") +
               "; strict: the same, but open meshes are refused; wrap: a closed mesh is made round "
               "all triangles, whatever they are like, and its solid counts; off: the file's own "
               "orientation, and open meshes " +
               (may_stay_open ? "stay open" : "are refused") +
               (wraps ? ". Of STEP and IGES, auto is wrap for what encloses, so that the exact "
                        "faces are inside, too; else what is claimed is about the triangles that "
                        "stand for them"
                      : "")},
          [](auto& r) -> auto& { return r.mode; },
          std::vector<std::pair<std::string, Mode>>{{"auto", Mode::Auto},
                                                    {"strict", Mode::Strict},
                                                    {"wrap", Mode::Wrap},
                                                    {"off", Mode::Off}}),
      option<R>(
          offset_option(), [](auto& r) -> auto& { return r.offset; }),
      option<R>(
          seal_option(), [](auto& r) -> auto& { return r.seal; })};
}

}  // namespace

geom::PrepareOptions PreparationOptions::preparing() const {
  geom::PrepareOptions out{.drop_sheets = drop_sheets,
                           .holes = mode == Mode::Strict ? geom::Holes::Refuse
                                    : mode == Mode::Off  ? geom::Holes::Keep
                                                         : holes,
                           .keep_orientation = keep_orientation || mode == Mode::Off};
  return out;
}

const std::vector<Option<PreparationOptions>>& preparation_options(PreparedFor use) {
  static const std::vector<Option<PreparationOptions>> bodies = table(PreparedFor::Bodies),
                                                       bounding = table(PreparedFor::Bounding),
                                                       preparing = table(PreparedFor::Preparing);
  return use == PreparedFor::Bodies ? bodies : use == PreparedFor::Bounding ? bounding : preparing;
}

const std::vector<Option<WrapOptions>>& wrap_options() {
  using R = WrapOptions;
  static const std::vector<Option<R>> options{
      option<R>(
          offset_option(), [](auto& r) -> auto& { return r.offset; }),
      option<R>(
          seal_option(), [](auto& r) -> auto& { return r.seal; }),
      option<R>(
          {.name = "epsilon",
           .text = "No point of a wrap is farther from the triangles than this, or it is "
                   "refused; a length or a percentage of the diagonal"},
          [](auto& r) -> auto& { return r.epsilon; })};
  return options;
}

std::string contradiction(const PreparationOptions& options, const std::set<std::string>& stated) {
  const auto first_of = [&](std::initializer_list<const char*> names) -> std::string {
    for (const char* name : names)
      if (stated.contains(name)) return name;
    return {};
  };
  std::string other;
  if (options.mode != Mode::Wrap) other = first_of({"offset", "seal"});
  if (!other.empty()) return "{" + other + "} needs {prepare} wrap";
  if (options.mode != Mode::Auto) other = first_of({"holes"});
  if (other.empty() && options.mode == Mode::Wrap)
    other = first_of({"drop-sheets", "keep-orientation"});
  if (other.empty()) return {};
  return "{prepare} " + value_of(preparation_options(PreparedFor::Bodies), "prepare", options) +
         " cannot be joined with {" + other + "}";
}

}  // namespace kaboum::certify
