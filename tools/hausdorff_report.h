#pragma once

#include <kaboum/measure/compare.h>

#include <array>
#include <string>
#include <vector>

#include "cli.h"
#include "shape_file.h"

/// What hausdorff-eval says of a comparison.
namespace kaboum::tools {

struct ComparisonReport {
  const std::array<ShapeFile, 2>& files;  ///< without their shapes
  const measure::Comparison& comparison;
  const measure::Compared& result;
  bool solid;

  [[nodiscard]] std::string table() const;
  /// A line each way.
  [[nodiscard]] std::string csv() const;
  [[nodiscard]] Json json() const;

 private:
  [[nodiscard]] double relative(double x) const;
  [[nodiscard]] Json side(measure::Comparison::Side side) const;
  [[nodiscard]] Json way(const measure::OneWay& way) const;
};

/// Six digits.
std::string formatted(double x, int digits = 6);

}  // namespace kaboum::tools
