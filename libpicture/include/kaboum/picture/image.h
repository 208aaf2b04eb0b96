#pragma once

#include <array>
#include <cstdint>
#include <vector>

namespace kaboum::picture {

/// Red, green, blue in [0, 1], as a screen shows them (sRGB).
using Colour = std::array<float, 3>;

struct Image {
  int width = 0, height = 0;
  std::vector<Colour> pixels;  ///< rows from the top

  Image(int w, int h, const Colour& fill)
      : width(w),
        height(h),
        pixels(static_cast<std::size_t>(w) * static_cast<std::size_t>(h), fill) {}
  [[nodiscard]] Colour& at(int x, int y) {
    return pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
                  static_cast<std::size_t>(x)];
  }
  [[nodiscard]] const Colour& at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
};

}  // namespace kaboum::picture
