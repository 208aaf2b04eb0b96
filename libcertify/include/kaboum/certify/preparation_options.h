#pragma once

#include <kaboum/base/length.h>
#include <kaboum/base/option.h>
#include <kaboum/certify/wrap.h>
#include <kaboum/geom/prepare.h>

#include <optional>
#include <set>
#include <string>
#include <vector>

namespace kaboum::certify {

/// Options of giving a file's triangles a solid, as a user states them.
struct PreparationOptions {
  enum class Mode {
    Auto,    ///< prepared; wrapped where that is needed
    Strict,  ///< prepared; open meshes are refused
    Wrap,    ///< wrapped, whatever they are like
    Off,     ///< as they stand in the file
  };
  Mode mode = Mode::Auto;
  std::optional<Length> offset, seal;  ///< of a wrap
  geom::Holes holes = geom::Holes::Fill;
  bool drop_sheets = false;
  bool keep_orientation = false;

  /// Preparation of triangles where they are not wrapped.
  [[nodiscard]] geom::PrepareOptions preparing() const;
  /// True if an outer result is to hold the exact faces of a CAD file, not only the triangles that
  /// stand for them.
  [[nodiscard]] bool holds_exact_faces() const { return mode == Mode::Auto || mode == Mode::Wrap; }
};

/// Options of a wrap by itself.
struct WrapOptions {
  std::optional<Length> offset, seal;  ///< as WrapRequest
  std::optional<Length> epsilon;       ///< WrapRequest::farthest
};

/// The options of a wrap: offset, seal, epsilon.
const std::vector<Option<WrapOptions>>& wrap_options();

/// Purpose of a preparation.
enum class PreparedFor {
  Bodies,     ///< a set of convex bodies: open meshes are refused
  Bounding,   ///< a bounding mesh: it may be open, like its input
  Preparing,  ///< the prepared mesh itself; it is wrapped only where that is asked for
};

/// The options of preparation: drop-sheets, holes, keep-orientation, prepare, offset, seal.
const std::vector<Option<PreparationOptions>>& preparation_options(PreparedFor use);

/// Why the options do not go together, with names as OptionDescription::text has them; empty where
/// they do.
/// @param stated  names of those that a user stated
std::string contradiction(const PreparationOptions& options, const std::set<std::string>& stated);

}  // namespace kaboum::certify
