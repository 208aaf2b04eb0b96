// The options that say what becomes of open meshes: --holes and --require-closed.

#include "holes_option.h"

#include <CLI/CLI.hpp>
#include <vector>

namespace kaboum::tools {

geom::Holes HolesOption::value() const {
  if (require_closed || name == "refuse") return geom::Holes::Refuse;
  return name == "keep" ? geom::Holes::Keep : geom::Holes::Fill;
}

void add_holes_options(CLI::App& app, HolesOption& option, bool keep) {
  std::string text =
      "Holes of an open mesh. fill: they are closed with triangles, and the claims are about the "
      "solid so closed, and about every input triangle; ";
  if (keep)
    text +=
        "keep: its border stays where it is, nothing is enclosed, and the exit code is 1 (with "
        "--direction any, which claims nothing, 0); ";
  text += "refuse: an error [fill]";
  std::vector<std::string> names{"fill", "refuse"};
  if (keep) names.insert(names.begin() + 1, "keep");
  CLI::Option* holes = app.add_option("--holes", option.name, text)
                           ->check(CLI::IsMember(names).description(""))
                           ->type_name(keep ? "fill|keep|refuse" : "fill|refuse");
  app.add_flag("--require-closed", option.require_closed, "The same as --holes refuse")
      ->excludes(holes);
}

}  // namespace kaboum::tools
