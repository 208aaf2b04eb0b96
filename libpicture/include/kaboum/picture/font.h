#pragma once

#include <kaboum/picture/image.h>

#include <string>

namespace kaboum::picture {

/// Width in pixels of `text` at the given scale; glyphs are 5 × 8 dots, one dot apart.
int text_width(const std::string& text, int scale);

/// Writes text with its upper left corner at (x, y); clipped to the image. What is not
/// printable ASCII shows as '?'.
void draw_text(Image& image, const std::string& text, int x, int y, int scale,
               const Colour& colour);

}  // namespace kaboum::picture
