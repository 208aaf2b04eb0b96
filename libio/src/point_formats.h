#pragma once

#include <kaboum/io/point_cloud.h>

#include <cmath>
#include <limits>

#include "source.h"

namespace kaboum::io {

/// Takes points one after the other, and those that are none.
class PointBuilder {
 public:
  explicit PointBuilder(const Source& source) : source_(source) {}

  /// @throws Error{LimitReached} for more points than have numbers
  void add(const geom::Vec3& p);
  /// @throws Error{InvalidInput} where there are no points
  PointCloud finish();

  /// The number of a word, which may be "nan" or "inf".
  static double value_of(const Source& source, std::string_view token);

 private:
  const Source& source_;
  PointCloud out_;
  std::size_t count_ = 0;
};

/// Vertices of a PLY file without faces.
void read_ply_points(const Source& source, PointBuilder& to);

}  // namespace kaboum::io
