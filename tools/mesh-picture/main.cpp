// The program mesh-picture: meshes side by side as a PNG.

#include <kaboum/io/convex_io.h>
#include <kaboum/picture/bodies.h>
#include <kaboum/picture/panels.h>
#include <kaboum/picture/png_file.h>

#include <CLI/CLI.hpp>
#include <set>

#include "common/cli.h"
#include "common/request_options.h"

namespace {

using namespace kaboum;  // the tool's own names are few

struct Options {
  std::vector<std::string> inputs;
  std::string output;
  tools::InputFormat input_format;
  picture::PanelOptions panels;
  std::set<std::string> stated;  ///< names of these options that were stated
};

/// A mesh, or the bodies of a set.
geom::Mesh read(const std::string& input, io::Format format) {
  if (format != io::Format::Glb) return io::read_mesh(input, format).mesh;
  return picture::surfaces_of(io::read_convex_set(input, format));
}

int make_picture(const Options& options) {
  tools::require_apart({{"--output", options.output}}, options.inputs);
  std::vector<geom::Mesh> meshes;
  for (const std::string& input : options.inputs)
    meshes.push_back(read(input, tools::format_for(input, options.input_format)));
  io::write_file(options.output, picture::encode_png(picture::draw_panels(meshes, options.panels)));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Renders meshes side by side into a PNG; one camera for all.", "mesh-picture"};
  Options options;
  app.add_option("meshes", options.inputs, "Mesh files, or -")->required()->type_name("FILE");
  app.add_option("-o,--output", options.output, "PNG file to write; - is standard output")
      ->required()
      ->check(tools::png_name())
      ->type_name("FILE");
  tools::add_request_options(app, picture::panel_options(), options.panels, options.stated);
  app.add_option("--colors", options.panels.colours)->group("");  // as others spell it
  tools::add_input_format(app, options.input_format, "Format, when extensions do not tell");
  return tools::run(app, argc, argv, [&] { return make_picture(options); });
}
