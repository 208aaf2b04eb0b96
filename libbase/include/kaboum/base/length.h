#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace kaboum {

/// A length, or a percentage of the diagonal of a mesh's bounding box.
struct Length {
  /// Unit that a length is stated in: a place in kLengthUnits, the first of which is 1. Own: none
  /// is stated, and the length is in the unit of what it is about.
  enum class Unit : std::uint8_t { Own = 0 };

  double value = 0;
  bool percent = false;
  Unit unit = Unit::Own;

  /// @throws Error{InvalidArgument} where a unit is stated, which `in` takes away: nobody has said
  ///   which unit the diagonal is in.
  [[nodiscard]] double of(double diagonal) const;

  /// The same in another unit, which is not stated any more; as it is where none was stated.
  /// @param other  one of kLengthUnits
  /// @throws Error{InvalidArgument} where a unit is stated and the other one is not known.
  [[nodiscard]] Length in(std::string_view other) const;

  /// "0.5%", "0.002" or "2mm": the fewest digits that read back as the same double.
  [[nodiscard]] std::string text() const;

  friend bool operator==(const Length&, const Length&) = default;
};

}  // namespace kaboum
