#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace kaboum::io {

/// An array of numbers, as of NumPy's files: row by row, the last index counting fastest.
struct NumberArray {
  std::vector<std::size_t> shape;  ///< one to three sizes
  std::vector<double> values;      ///< may be NaN or infinite

  /// The number of values for one step of the first index.
  [[nodiscard]] std::size_t row_size() const;
};

/// True for the bytes of a .npy file, whatever their name.
bool is_number_array(std::span<const char> bytes);

/// An array of NumPy (.npy, versions 1 to 3 of the format): float32, float64, int32 or int64,
/// little-endian, row by row or column by column.
/// @param name  of the file, for messages
/// @throws Error{InvalidInput} for other types, for whole numbers beyond 2^53, for other than one
///   to three dimensions, without rows or columns, and where the file's size is another.
NumberArray parse_number_array(std::span<const char> bytes, const std::string& name);

}  // namespace kaboum::io
