#pragma once

#include <kaboum/distance/compare.h>

#include <array>
#include <string>
#include <vector>

#include "common/cli.h"
#include "shape_file.h"

/// What hausdorff-eval says of a comparison.
namespace kaboum::tools {

struct ComparisonReport {
  const std::array<ShapeFile, 2>& files;  ///< without their shapes
  const distance::Comparison& comparison;
  const distance::Compared& result;
  bool solid;

  [[nodiscard]] std::string table() const;
  /// A line each way.
  [[nodiscard]] std::string csv() const;
  [[nodiscard]] Json json() const;

 private:
  [[nodiscard]] double relative(double x) const;
  [[nodiscard]] Json side(distance::Comparison::Side side) const;
  [[nodiscard]] Json way(const distance::OneWay& way) const;
};

/// Six digits.
std::string formatted(double x, int digits = 6);

}  // namespace kaboum::tools
