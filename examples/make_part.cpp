// Writes the project's own CAD-like test part: see part.h.
#include "part.h"

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>

#include <CLI/CLI.hpp>
#include <iostream>
#include <string>

namespace {

int run(int resolution, const std::string& output, const std::string& format_name) {
  using namespace kaboum;
  const auto format = io::format_from_name(
      format_name.empty() ? std::filesystem::path(output).extension().string() : format_name);
  if (!format) {
    std::cerr << "make-part: unknown output format; add --output-format, e.g. obj\n";
    return 2;
  }
  io::WriteOptions options;
  options.double_precision = true;
  io::write_file(output, io::serialise_mesh(examples::make_bracket(resolution), *format, options));
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app{"Generates an angle bracket: a closed, manifold solid in metres."};
  int resolution = kaboum::examples::kBracketResolution;
  std::string output, format;
  app.add_option("--resolution", resolution, "Segments of a full circle")
      ->check(CLI::Range(kaboum::examples::kMinBracketResolution,
                         kaboum::examples::kMaxBracketResolution))
      ->capture_default_str();
  app.add_option("-o,--output", output, "File to write; - is standard output")->required();
  app.add_option("--output-format", format, "Format, when the extension does not tell");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    return run(resolution, output, format);
  } catch (const kaboum::Error& error) {
    std::cerr << "make-part: " << error.what() << '\n';
    switch (error.code()) {
      case kaboum::ErrorCode::InvalidArgument:
        return 2;
      case kaboum::ErrorCode::OutputFailed:
        return 4;
      default:
        return 6;
    }
  } catch (const std::exception& error) {
    std::cerr << "make-part: internal error: " << error.what() << '\n';
    return 6;
  }
}
