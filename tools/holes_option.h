#pragma once

#include <kaboum/geom/prepare.h>

#include <string>

#include "cli.h"

namespace CLI {
class App;
}  // namespace CLI

namespace kaboum::tools {

/// What is to become of holes, as options say it.
struct HolesOption {
  std::string name = "fill";
  bool require_closed = false;

  [[nodiscard]] geom::Holes value() const;
};

/// Adds --holes and its old name --require-closed.
/// @param keep  whether holes may stay.
void add_holes_options(CLI::App& app, HolesOption& option, bool keep);

}  // namespace kaboum::tools
