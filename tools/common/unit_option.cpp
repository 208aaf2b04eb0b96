// --unit and --scale: in which unit a file's coordinates are, and in which they are to be.
#include "unit_option.h"

#include <kaboum/base/error.h>
#include <kaboum/io/file_unit.h>

#include <CLI/CLI.hpp>

#include "arguments.h"

namespace kaboum::tools {

std::string UnitOption::words() const {
  return scale == 1 ? std::string() : " --scale " + Length{scale}.text();
}

void add_scale_option(CLI::App& app, double& scale, const std::string& of) {
  app.add_option("--scale", scale,
                 "Multiply the coordinates of " + of +
                     " by this first, as for files of another unit that do not say so: 0.001 from "
                     "mm to m, 25.4 from in to mm; each becomes the double nearest to the product "
                     "[1]")
      ->check(number_from(1e-9, 1e9))
      ->type_name("FACTOR");
}

void add_unit_options(CLI::App& app, UnitOption& option, const std::string& of) {
  app.add_option("--unit", option.unit,
                 "Unit of length of " + of +
                     " (after --scale) where the file states none: m, dm, cm, mm, um, km, in or "
                     "ft; nothing is converted, and a file that states another one is refused")
      ->check(unit_name())
      ->type_name("NAME");
  add_scale_option(app, option.scale, of);
}

void apply(io::ReadResult& read, const UnitOption& option, const std::string& name) {
  io::scale(read, option.scale, name);
  if (read.unit.empty()) read.unit = option.unit;
  if (option.unit.empty() || option.unit == read.unit) return;
  throw Error(ErrorCode::InvalidInput, name + ": its vertices are in " + read.unit + ", not in " +
                                           option.unit + "; leave --unit out, or bring them into " +
                                           option.unit + " with --scale");
}

}  // namespace kaboum::tools
