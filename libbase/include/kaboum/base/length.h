#pragma once

#include <string>

namespace kaboum {

/// A length, or a percentage of the diagonal of a mesh's bounding box.
struct Length {
  double value = 0;
  bool percent = false;

  [[nodiscard]] double of(double diagonal) const {
    return percent ? 0.01 * value * diagonal : value;
  }

  /// "0.5%" or "0.002": the fewest digits that read back as the same double.
  [[nodiscard]] std::string text() const;

  friend bool operator==(const Length&, const Length&) = default;
};

}  // namespace kaboum
