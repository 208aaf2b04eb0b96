// --prepare: how the triangles of a file are given a solid.
#include "preparation_option.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>
#include <sstream>

namespace kaboum::tools {
namespace {

CLI::Option* add_length(CLI::App& app, const char* name, std::string& value, const char* text) {
  return app.add_option(name, value, text)
      ->check([](const std::string& s) {
        return parse_length(s) ? std::string()
                               : "must be a positive number, or a percentage such as 0.5%, "
                                 "without blanks or units";
      })
      ->type_name("LENGTH|P%");
}

std::string digits(double x) {
  std::ostringstream text;
  text.precision(4);
  text << x;
  return text.str();
}

}  // namespace

void PreparationOption::apply(geom::PrepareOptions& options) const {
  if (name == "strict") options.holes = geom::Holes::Refuse;
  if (name == "off") {
    options.holes = geom::Holes::Keep;
    options.keep_orientation = true;
  }
}

certify::WrapRequest PreparationOption::request(std::optional<double> farthest) const {
  certify::WrapRequest request;
  if (!offset.empty()) request.offset = parse_length(offset);
  if (!seal.empty()) request.seal = parse_length(seal);
  request.farthest = farthest;
  return request;
}

void add_preparation_options(CLI::App& app, PreparationOption& option) {
  app.add_option("--prepare", option.name,
                 "How the triangles are given a solid. auto: inconsistent triangles and parts that "
                 "are inside out are turned, copies and walls dropped, holes filled; strict: the "
                 "same, but open meshes are refused; wrap: a closed mesh is made round all "
                 "triangles, whatever they are like, and its solid counts; off: the file's own "
                 "orientation, and open meshes stay open [auto]")
      ->check(CLI::IsMember({"auto", "strict", "wrap", "off"}).description(""))
      ->type_name("auto|strict|wrap|off");
  add_length(app, "--offset", option.offset,
             "With --prepare wrap: how far the wrap may be from the triangles where it can get "
             "near them; a length or a percentage of the diagonal [a quarter of epsilon, or 0.1%]");
  add_length(app, "--seal", option.seal,
             "With --prepare wrap: hollows behind gaps narrower than this are filled (those up to "
             "2.5 times as wide may be); also the scale of the search, whose time and memory grow "
             "with its inverse [what epsilon allows, or 1%]");
}

void require_meaning(const CLI::App& app, const PreparationOption& option) {
  if (!option.wraps()) require_absent(app, "--prepare " + option.name, {"--offset", "--seal"});
}

std::string sentence_of(const certify::WrapCertificate& wrap) {
  return "The solid is that of a wrap round all " + std::to_string(wrap.input_triangles) +
         " triangles: each lies inside, exactly; no point of it is farther from them than " +
         digits(wrap.farthest_upper) + " (" + digits(100 * wrap.farthest_upper / wrap.diagonal) +
         "% of the diagonal); gaps narrower than " + digits(wrap.seal) + " are closed." +
         (wrap.clearance > 0 ? " All within " + digits(wrap.clearance) +
                                   " of a triangle is inside, too: the exact faces."
                             : std::string());
}

Json to_json(const certify::WrapCertificate& wrap) {
  return {{"offset", wrap.offset},
          {"seal", wrap.seal},
          {"farthest_lower", wrap.farthest_lower},
          {"farthest_upper", wrap.farthest_upper},
          {"at", {wrap.at.x(), wrap.at.y(), wrap.at.z()}},
          {"every_triangle_inside", "verified"},
          {"clearance", wrap.clearance},
          {"input_triangles", wrap.input_triangles}};
}

}  // namespace kaboum::tools
