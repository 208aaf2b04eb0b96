// The options of bound-verify, each defined once.
#include "options.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>
#include <sstream>

#include "common/motion_options.h"

namespace kaboum::tools {

bool is_prepared(const VerifyOptions& o) {
  if (o.prepare == "wrap")
    throw Error(ErrorCode::InvalidArgument,
                "--prepare=wrap is of robots; of a mesh, --raw judges every triangle");
  return !o.prepare.empty();
}

std::vector<std::string> split_names(const std::string& list) {
  std::vector<std::string> out;
  std::istringstream stream(list);
  for (std::string name; std::getline(stream, name, ',');)
    if (!name.empty()) out.push_back(name);
  return out;
}

void add_claims(CLI::App& app, VerifyOptions& o, const std::vector<std::string>& names) {
  app.add_option("--claims", o.claims,
                 names.size() > 2
                     ? "Claims that decide: all, solid or surface; those that mean nothing for the "
                       "files do not count"
                     : "Claims that decide: all, or the surface's alone")
      ->check(CLI::IsMember(names))
      ->capture_default_str()
      ->type_name("NAME");
}

void add_epsilon(CLI::App& app, VerifyOptions& o, const char* what) {
  app.add_option("--epsilon", o.epsilon, what)->type_name("LENGTH");
}

/// @param what  is prepared: "ORIGINAL"
void add_preparation(CLI::App& app, VerifyOptions& o, const std::string& what) {
  app.add_flag("--prepare{auto}", o.prepare,
               "Judge " + what +
                   " as bmesh-decimate and bcd-decompose prepare it (parts that are inside out "
                   "turned, copies and walls dropped, holes filled, quads that are not plane split "
                   "so that "
                   "both ways are bounded) instead of the file as it is: "
                   "what their claims, and a container's epsilon, are about. Of robots every "
                   "triangle of the file is judged besides, and that alone, with all that closed "
                   "meshes wind round, where preparing refuses a mesh; --prepare=wrap: of all "
                   "meshes, as results of --prepare wrap promise")
      ->check(CLI::IsMember({"auto", "wrap"}).description(""));
  app.add_flag("--drop-sheets", o.drop_sheets,
               "With --prepare: drop sheets (faces back to back without volume), as bmesh-decimate "
               "and bcd-decompose do with this option; nothing is then said about them, and the "
               "verdict names them")
      ->needs("--prepare");
  app.add_flag_callback(
         "--raw", [&o] { o.claims = "surface"; },
         "Judge the triangles of the file as they are, open, one-sided or in pieces: whether each "
         "of them lies in the result's solid; the same as --claims surface without --prepare")
      ->excludes("--prepare")
      ->excludes("--claims");
}

void add_witness(CLI::App& app, VerifyOptions& o) {
  app.add_option("--witness", o.witness,
                 "When refuted, write the offending triangles to this mesh file")
      ->type_name("FILE");
}

void add_input_format(CLI::App& app, VerifyOptions& o) {
  app.add_option("--input-format", o.original_format, "Format of ORIGINAL [by extension]")
      ->type_name("NAME");
}

void add_approximation_format(CLI::App& app, VerifyOptions& o, const std::string& of) {
  app.add_option("--approximation-format", o.approximation_format,
                 "Format of " + of + " [by extension]")
      ->type_name("NAME");
}

void add_limits(CLI::App& app, VerifyOptions& o) {
  app.add_option("--max-contacts", o.max_contacts,
                 "Give up (exit code 7) beyond this many pairs of triangles that touch")
      ->check(CLI::Range(std::size_t{1}, std::size_t{4'000'000'000}))
      ->capture_default_str()
      ->type_name("N");
  app.add_option("--max-work", o.max_work,
                 "Leave what encloses what undecided (exit code 7) after so much work, counted in "
                 "steps that take at most about so many seconds of one core, so that the answer is "
                 "the same on any machine [60, and 5 per 1000 triangles]")
      ->check(number_from(0.001, 1e9))
      ->type_name("SECONDS");
}

void add_exact_points(CLI::App& app, VerifyOptions& o) {
  app.add_option("--exact-points", o.exact_points,
                 "Of STEP and IGES: how densely points of the exact faces are looked at, which "
                 "refute where they stick out; parts of each interval between knots of an edge, "
                 "and of a face in each direction; 0: the triangles alone are judged")
      ->check(CLI::Range(std::size_t{0}, std::size_t{10'000}).description(""))
      ->capture_default_str()
      ->type_name("N");
}

void add_unit(CLI::App& app, VerifyOptions& o) { add_unit_options(app, o.unit, "ORIGINAL"); }

void add_set(CLI::App& app, VerifyOptions& o) {
  app.add_flag("--set", o.set,
               "With --inner: APPROXIMATION is a set of convex bodies (known anyway of "
               "folders and of containers)");
}

void add_links(CLI::App& app, VerifyOptions& o) {
  app.add_option("--links", o.links, "Only these links, separated by commas [all]")
      ->type_name("A,B");
}

void add_geometry(CLI::App& app, VerifyOptions& o, const std::string& of) {
  app.add_option("--geometry", o.geometry, "Which shapes of " + of + " are to be held [collision]")
      ->check(CLI::IsMember({"collision", "visual"}).description(""))
      ->type_name("collision|visual");
  app.add_flag_callback(
      "--visual", [&o] { o.geometry = "visual"; }, "The same as --geometry visual");
  app.add_option("--package-path", o.packages,
                 "A package of package:// or a folder that holds it, as for sweep-approx; may be "
                 "repeated")
      ->type_name("DIR");
}

void add_motion(CLI::App& app, VerifyOptions& o) {
  app.add_option("--gap", o.gap,
                 "Parts that move and measure less are not divided further; where they are not "
                 "known to be inside, the answer is undecided [margin / 10^6]")
      ->check([](const std::string& s) {
        const auto length = parse_length(s);
        return length && !length->percent
                   ? std::string()
                   : "must be a positive length, a number above 0 without a unit, not " + s;
      })
      ->type_name("LENGTH");
  app.add_option("--max-cells", o.max_cells,
                 "Give up beyond this many parts of a triangle per segment of the path")
      ->check(CLI::Range(std::size_t{1}, std::size_t{1'000'000'000}).description(""))
      ->capture_default_str()
      ->type_name("N");
  add_joint_option(app, o.joints);
  add_degrees_option(app, o.degrees);
  add_base_option(app, o.base_pose);
}

}  // namespace kaboum::tools
