#pragma once

#include <kaboum/certify/preparation_options.h>
#include <kaboum/certify/wrap.h>
#include <kaboum/geom/prepare.h>

#include <optional>
#include <string>

#include "cli.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// How the triangles of a file are given a solid, as options say it.
struct PreparationOption {
  std::string name = "auto", offset, seal;

  [[nodiscard]] bool wraps() const { return name == "wrap"; }
  /// Whether an outer result is to hold the exact faces of a CAD file, not only the triangles that
  /// stand for them: `auto` wraps these.
  [[nodiscard]] bool holds_exact_faces() const { return wraps() || name == "auto"; }
  [[nodiscard]] certify::PreparationOptions::Mode mode() const;
  /// Sets what `strict` and `off` mean.
  void apply(geom::PrepareOptions& options) const;
  /// @param farthest  that the wrap may be from the input [length]
  [[nodiscard]] certify::WrapRequest request(std::optional<double> farthest) const;
};

/// Adds --prepare, --offset and --seal.
/// @param off    what `--prepare off` does with open meshes, in words
/// @param exact  `auto` holds exact faces
void add_preparation_options(CLI::App& app, PreparationOption& option,
                             const std::string& off = "open meshes stay open", bool exact = false);

/// Refuses --offset and --seal without --prepare wrap, and what means nothing beside --prepare.
/// @throws Error{InvalidArgument}
void require_meaning(const CLI::App& app, const PreparationOption& option);

}  // namespace kaboum::tools
