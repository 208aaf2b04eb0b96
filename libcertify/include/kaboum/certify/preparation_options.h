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

/// How the triangles of a file are given a solid, as a user states it.
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

  /// How triangles are prepared where they are not wrapped.
  [[nodiscard]] geom::PrepareOptions preparing() const;
  /// Whether an outer result is to hold the exact faces of a CAD file, not only the triangles that
  /// stand for them.
  [[nodiscard]] bool holds_exact_faces() const { return mode == Mode::Auto || mode == Mode::Wrap; }
};

/// The options of preparation: drop-sheets, holes, keep-orientation, prepare, offset, seal.
/// @param may_stay_open  whether a result may be made of an open mesh
const std::vector<Option<PreparationOptions>>& preparation_options(bool may_stay_open);

/// Why the options do not go together, with names as OptionDescription::text has them; empty where
/// they do.
/// @param stated  names of those that a user stated
std::string contradiction(const PreparationOptions& options, const std::set<std::string>& stated);

}  // namespace kaboum::certify
