// The command line of kaboum-pairs.

#include "options.h"

#include <kaboum/pairs/decide_options.h>
#include <kaboum/robot/shape_options.h>

#include <CLI/CLI.hpp>

#include "common/request_options.h"

namespace kaboum::tools {

void describe(CLI::App& app, PairsOptions& o) {
  app.add_option("ROBOT", o.robot, "URDF, or the Robotics Library's rlkin or rlmdl")
      ->type_name("FILE")
      ->required();
  app.add_option("--srdf", o.srdf,
                 "Write the pairs that need no check as SRDF: those that never touch, and those "
                 "that are connected")
      ->type_name("FILE");
  add_request_options(app, robot::shape_options(), o.choice, o.stated);
  add_request_options(app, pairs::decide_options(), o.decide, o.stated);
  app.add_flag("--json", o.json, "Print JSON instead of a line for each pair");
  add_common_options(app, o.common);
  app.footer(
      "Never and always are proved over all of the joints' limits; a contact is shown by a "
      "configuration. What is open has a bracket of the smallest distance.\n"
      "Exit codes: 0 all pairs are decided; 2 usage; 3 bad input; 4 output failed; 6 internal "
      "error; 7 some pairs stay open (--timeout, --max-boxes).");
}

}  // namespace kaboum::tools
