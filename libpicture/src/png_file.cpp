// Images as PNG bytes, by libpng.

#include <kaboum/picture/png_file.h>

#include <kaboum/base/error.h>

#include <png.h>

#include <algorithm>
#include <cmath>

namespace kaboum::picture {

std::vector<char> encode_png(const Image& image) {
  std::vector<png_byte> rows;
  rows.reserve(3 * image.pixels.size());
  for (const Colour& c : image.pixels) {
    for (const float v : c) {
      rows.push_back(static_cast<png_byte>(std::lround(255 * std::clamp(v, 0.0F, 1.0F))));
    }
  }
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.width);
  png.height = static_cast<png_uint_32>(image.height);
  png.format = PNG_FORMAT_RGB;
  const auto fail = [&] {
    const std::string message = png.message;
    png_image_free(&png);
    throw Error(ErrorCode::OutputFailed, "PNG: " + message);
  };
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  std::vector<char> bytes(size);
  if (png_image_write_to_memory(&png, bytes.data(), &size, 0, rows.data(), 0, nullptr) == 0) fail();
  bytes.resize(size);
  return bytes;
}

}  // namespace kaboum::picture
