// The command line of kaboum-pairs.

#include "options.h"

#include <kaboum/base/error.h>
#include <kaboum/pairs/decide_options.h>
#include <kaboum/robot/shape_options.h>

#include <CLI/CLI.hpp>
#include <algorithm>

#include "common/arguments.h"
#include "common/request_options.h"

namespace kaboum::tools {

void describe(CLI::App& app, PairsOptions& o) {
  app.add_option("ROBOT", o.robot, "URDF, MJCF, SDF, or the Robotics Library's rlkin or rlmdl")
      ->type_name("FILE")
      ->required();
  CLI::Option* srdf =
      app.add_option(
             "--srdf", o.srdf,
             "Write the pairs that need no check as SRDF: those that never touch, those that fixed "
             "joints connect, and those that one joint does that never touch away from it")
          ->type_name("FILE");
  CLI::Option* judge =
      app.add_option(
             "--judge", o.judge,
             "Judge the pairs that this file disables, and decide no others but for --srdf: SRDF, "
             "MJCF (exclude), Drake's filter groups, XRDF, cuRobo's YAML")
          ->type_name("FILE");
  app.add_option("-o,--output", o.output,
                 "Write that file without the pairs that are refuted, and without statements that "
                 "change nothing (links that the robot does not have, pairs stated twice); all "
                 "else of it stays")
      ->type_name("FILE")
      ->needs(judge);
  app.add_option("--junit", o.junit, "Write the judgement as JUnit XML")
      ->type_name("FILE")
      ->needs(judge);
  app.add_option("--sarif", o.sarif, "Write what is wrong as SARIF 2.1.0")
      ->type_name("FILE")
      ->needs(judge);
  app.add_option_function<std::vector<std::string>>(
         "--fail-on",
         [&o](const std::vector<std::string>& all) {
           o.fail_on.open = std::ranges::find(all, "open") != all.end();
           o.fail_on.faults = std::ranges::find(all, "faults") != all.end();
         },
         "What else of the file is a no, besides refuted pairs: open ones, faults (links that the "
         "robot does not have, pairs stated twice, ...), or both: open,faults [refuted]")
      ->type_name("refuted|open|faults,...")
      ->delimiter(',')
      ->check(CLI::IsMember({"refuted", "open", "faults"}))
      ->needs(judge);
  CLI::Option* one =
      app.add_option("--configuration", o.configuration,
                     "Decide the pairs in this configuration only: a value per joint that moves, "
                     "separated by commas, radians and metres")
          ->type_name("Q1,Q2,…")
          ->excludes(judge)
          ->excludes(srdf);
  app.add_option("--preview", o.preview,
                 "Write a picture (PNG) of that configuration: links that touch are orange")
      ->type_name("FILE")
      ->check(png_name())
      ->needs(one);
  add_request_options(app, robot::shape_options(), o.choice, o.stated);
  add_xacro_arguments(app, o.xacro_arguments);
  add_request_options(app, pairs::decide_options(), o.decide, o.stated);
  app.add_flag("--json", o.json, "Print JSON instead of a line for each pair");
  add_common_options(app, o.common);
  app.footer(
      "Never and always are proved over all of the joints' limits; a contact is shown by a "
      "configuration. What is open has a bracket of the smallest distance.\n"
      "Exit codes: 0 all pairs are decided; with --judge: none that the file disables is refuted, "
      "nor with --fail-on open left open, nor with --fail-on faults has the file any; with "
      "--configuration: no two links touch, but where a joint connects them; 1 with --judge: one "
      "is, or it has; with --configuration: two touch; 2 usage; 3 bad input; 4 output failed; 6 "
      "internal error; 7 some pairs stay open (--timeout, --max-boxes).");
}

void require_valid(const PairsOptions& o) {
  if (!o.judge.empty() && !o.choice.links.empty())
    throw Error(ErrorCode::InvalidArgument,
                "--links: a file is judged of all links; see --srdf for some");
}

}  // namespace kaboum::tools
