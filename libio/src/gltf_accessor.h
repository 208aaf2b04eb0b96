#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "gltf_file.h"

namespace kaboum::io {

/// The numbers of a glTF accessor, element by element, as the file means them: normalised integers
/// are divided by the largest one, in double precision.
struct AccessorValues {
  std::vector<double> values;
  std::size_t count = 0;  ///< of elements
  bool floats = true;     ///< every value is a float32 number
};

/// Component types of glTF.
enum class Component : std::uint16_t {
  Int8 = 5120,
  UInt8 = 5121,
  Int16 = 5122,
  UInt16 = 5123,
  UInt32 = 5125,
  Float32 = 5126
};

/// Reads an accessor of vectors (`shape` "VEC3", "VEC4"): stride, sparse and normalised values.
/// `integers` are the component types allowed besides Float32, normalised or not.
///
/// What the accessor states of its smallest and largest values is compared with what was read,
/// floats after rounding the statement to float32, integers exactly.
///
/// @throws Error{InvalidInput} naming the accessor.
AccessorValues read_vectors(GltfFile& file, const JsonItem& index, const char* shape,
                            std::span<const Component> integers);

/// Reads an accessor of vertex indices, all less than `vertices`.
std::vector<std::uint32_t> read_indices(GltfFile& file, const JsonItem& index,
                                        std::size_t vertices);

}  // namespace kaboum::io
