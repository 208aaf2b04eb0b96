#pragma once

#include <kaboum/picture/image.h>

#include <vector>

namespace kaboum::picture {

/// The image as the bytes of a PNG file, 8 bits per channel.
/// @throws Error{OutputFailed} when libpng fails.
std::vector<char> encode_png(const Image& image);

}  // namespace kaboum::picture
