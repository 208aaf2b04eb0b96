#pragma once

#include <kaboum/geom/mesh.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace kaboum::io {

/// Points of a sensor or a scan as a file has them, in its own frame and unit.
struct PointCloud {
  std::vector<geom::Vec3> points;      ///< all finite
  std::vector<std::uint32_t> numbers;  ///< of the points, counted from 1 as in the file
  /// Points with a coordinate that is NaN or infinite, as sensors have them where they see nothing;
  /// they are left out.
  std::size_t invalid = 0;
  std::size_t first_invalid = 0;  ///< number of the first of them, from 1
  /// The file states where the sensor was (PCD's VIEWPOINT), other than in the origin. It is not
  /// applied: some programs write points in the sensor's frame then, others in the world's.
  bool has_viewpoint = false;
};

/// Points of a file in memory; the format is that of the name's ending: `.ply` (ASCII, binary of
/// both byte orders), `.pcd` (ASCII, binary, compressed), `.npy` (n x 3), `.xyz`, `.txt`, `.asc`
/// and
/// `.csv` (a line for each). Coordinates become doubles without loss; what else a point has, as
/// colours, is passed over.
/// @throws Error{InvalidInput} naming the place, for files that are damaged, cut, or without
/// points,
///   for meshes (a PLY with faces) and unknown endings; Error{LimitReached} for more than 2^32 − 2
///   points.
PointCloud parse_point_cloud(std::span<const char> bytes, const std::string& name);

/// The same of a file. @throws as parse_point_cloud
PointCloud read_point_cloud(const std::filesystem::path& path);

}  // namespace kaboum::io
