// bound-verify with a flag instead of a command.
#include "verify_flags.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>

namespace kaboum::tools {
namespace {

CLI::Option* add_relations(CLI::App& app, VerifyOptions& o) {
  CLI::Option_group* relation = app.add_option_group("Relation", "Instead of a command, one of");
  relation->add_flag("--outer", o.outer, "As mesh --outer: APPROXIMATION encloses ORIGINAL");
  relation->add_flag("--inner", o.inner, "As mesh --inner: APPROXIMATION is enclosed by ORIGINAL");
  relation->add_flag("--cover", o.cover,
                     "As cover: APPROXIMATION is a set of convex bodies that covers ORIGINAL");
  CLI::Option* sweep =
      relation->add_option("--sweep", o.sweep, "As sweep: SWEPT holds ROBOT all along PATH")
          ->expected(3)
          ->type_name("ROBOT PATH SWEPT");
  relation->add_flag("--progressive", o.progressive,
                     "As progressive: APPROXIMATION is a progressive file of ORIGINAL");
  relation->add_flag("--robot", o.robot, "As robot: APPROXIMATION's shapes hold those of ORIGINAL");
  relation->require_option(1);
  return sweep;
}

/// The commands explain them.
void shorten(CLI::App& app) {
  for (CLI::Option* option : app.get_options())
    if (!option->get_positional() && option != app.get_help_ptr())
      option->description("")->group("Options with a flag, as of its command");
}

}  // namespace

void add_flags(CLI::App& app, VerifyOptions& o) {
  CLI::Option* sweep = add_relations(app, o);
  app.add_option("ORIGINAL", o.original, "With a flag: what the result was made of")
      ->type_name("FILE");
  app.add_option("APPROXIMATION", o.approximation, "With a flag: the result")->type_name("FILE");
  add_claims(app, o, {"all", "solid", "surface"});
  CLI::Option* epsilon = add_epsilon(app, o, "");
  add_preparation(app, o, "ORIGINAL");
  CLI::Option* set = add_set(app, o);
  add_witness(app, o);
  add_unit(app, o);
  add_input_format(app, o);
  add_approximation_format(app, o, "APPROXIMATION");
  CLI::Option* exact = add_exact_points(app, o);
  add_limits(app, o);
  for (CLI::Option* other : {epsilon, set, exact}) other->excludes(sweep);
  add_links(app, o);
  add_geometry(app, o, "ORIGINAL");
  for (CLI::Option* option : add_motion(app, o)) option->needs(sweep);
  shorten(app);
  add_common_options(app, o.common);
}

void require_meaning(const CLI::App& app, const VerifyOptions& o) {
  if (!o.sweep.empty()) {
    if (!o.original.empty())
      throw Error(ErrorCode::InvalidArgument, "--sweep takes ROBOT PATH SWEPT and no more files");
    if (o.claims == "solid")
      throw Error(ErrorCode::InvalidArgument,
                  "--claims solid: with --sweep it follows from the surface claim; use all");
    require_absent(app, "--sweep",
                   {"--input-format", "--max-contacts", "--max-work", "--unit", "--scale"});
    return;
  }
  if (o.robot) {
    require_absent(app, "--robot",
                   {"--set", "--witness", "--input-format", "--approximation-format", "--unit",
                    "--scale", "--exact-points"});
    return;
  }
  const char* relation = o.progressive ? "--progressive"
                         : o.cover     ? "--cover"
                         : o.inner     ? "--inner"
                                       : "--outer";
  require_absent(app, relation, {"--geometry", "--visual", "--package-path", "--links"});
  if (o.progressive)
    require_absent(
        app, "--progressive",
        {"--claims", "--epsilon", "--prepare", "--raw", "--drop-sheets", "--set", "--witness",
         "--approximation-format", "--max-contacts", "--max-work", "--exact-points"});
}

}  // namespace kaboum::tools
