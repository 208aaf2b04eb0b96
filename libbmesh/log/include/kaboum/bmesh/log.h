#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/geom/prepare.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace kaboum::bmesh {

enum class Direction {
  Outer,  ///< the result encloses the input
  Inner,  ///< the input encloses the result
  Any,    ///< no constraint: for comparison
};

/// One certified operation.
struct Step {
  enum class Kind : std::uint8_t {
    /// The triangles with both vertices vanish, `kept` moves to `position`, and `gone` becomes
    /// `kept`. A move of a single vertex has kept == gone.
    Contract,
    /// The triangles (kept, gone, left) and (gone, kept, right) become (right, left, kept) and
    /// (left, right, gone).
    Flip,
  };

  std::uint32_t kept = 0;
  std::uint32_t gone = 0;
  geom::Vec3 position = geom::Vec3::Zero();  ///< Contract only
  Kind kind = Kind::Contract;
  std::uint32_t left = 0, right = 0;  ///< Flip only

  static Step flip(std::uint32_t kept, std::uint32_t gone, std::uint32_t left,
                   std::uint32_t right) {
    return {kept, gone, geom::Vec3::Zero(), Kind::Flip, left, right};
  }
};

/// Everything needed to derive a result from its input again. Layout of the file: docs/formats.md.
struct Log {
  Direction direction = Direction::Outer;
  std::string input_sha256;             ///< of the input file's bytes
  std::string tool;                     ///< program and version
  std::vector<std::uint32_t> dropped;   ///< input triangles left out, ascending
  std::vector<std::uint32_t> reversed;  ///< input triangles with reversed orientation, ascending
  /// The holes that were filled: vertices round each, as the fill runs; corner k of input triangle
  /// t is 3 t + k. Three are a triangle, more a fan from their mean, {rim[i], rim[i + 1], mean}.
  std::vector<std::vector<std::uint32_t>> rims;
  /// Triangles turned after that, ascending: of the input, where `turned` counts those turns as
  /// well, and numbered on from these the ones that fill holes (without repeated corners).
  std::vector<std::uint32_t> reversed_after_filling;
  std::vector<Step> steps;
};

/// The triangles that preparation dropped, turned and added. `input_triangles` is the number before
/// it.
void record_preparation(const geom::PreparationReport& report, std::size_t input_triangles,
                        Log& log);

std::vector<char> serialise_log(const Log& log);

/// @throws Error{InvalidInput} on malformed or truncated bytes.
Log parse_log(std::span<const char> bytes, const std::string& name);

}  // namespace kaboum::bmesh
