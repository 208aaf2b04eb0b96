// --prepare: how the triangles of a file are given a solid.
#include "preparation_option.h"

#include <kaboum/base/error.h>

#include <CLI/CLI.hpp>

namespace kaboum::tools {
namespace {

constexpr const char* kExactFaces =
    ". Of STEP and IGES, auto is wrap for what encloses, so that the exact faces are inside, too; "
    "else what is claimed is about the triangles that stand for them";

CLI::Option* add_length(CLI::App& app, const char* name, std::string& value, const char* text) {
  return app.add_option(name, value, text)
      ->check([](const std::string& s) {
        return parse_length(s) ? std::string()
                               : "must be a positive number, or a percentage such as 0.5%, "
                                 "without blanks or units";
      })
      ->type_name("LENGTH|P%");
}

}  // namespace

certify::PreparationOptions::Mode PreparationOption::mode() const {
  using Mode = certify::PreparationOptions::Mode;
  return name == "strict" ? Mode::Strict
         : name == "wrap" ? Mode::Wrap
         : name == "off"  ? Mode::Off
                          : Mode::Auto;
}

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

void add_preparation_options(CLI::App& app, PreparationOption& option, const std::string& off,
                             bool exact) {
  app.add_option("--prepare", option.name,
                 "How the triangles are given a solid. auto: inconsistent triangles and parts that "
                 "are inside out are turned, copies and walls dropped, holes filled; strict: the "
                 "same, but open meshes are refused; wrap: a closed mesh is made round all "
                 "triangles, whatever they are like, and its solid counts; off: the file's own "
                 "orientation, and " +
                     off + (exact ? kExactFaces : "") + " [auto]")
      ->check(CLI::IsMember({"auto", "strict", "wrap", "off"}).description(""))
      ->type_name("auto|strict|wrap|off");
  add_length(app, "--offset", option.offset,
             "With --prepare wrap: how far the wrap may be from the triangles where it can get "
             "near them; a length or a percentage of the diagonal [a quarter of epsilon, or 0.1%]");
  add_length(
      app, "--seal", option.seal,
      "With --prepare wrap: hollows behind gaps narrower than this are filled; also the scale "
      "of the search, whose time and memory grow with the square of its inverse [what "
      "epsilon allows, or 1%]");
}

void require_meaning(const CLI::App& app, const PreparationOption& option) {
  if (!option.wraps()) require_absent(app, "--prepare " + option.name, {"--offset", "--seal"});
}

}  // namespace kaboum::tools
