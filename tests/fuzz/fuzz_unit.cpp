// What files say of lengths: any text given to the readers of recorded scales and of units either
// makes a positive number, written so that it reads back the same, or none; a mesh that is scaled
// by any number stays one, or Error is thrown. The first byte selects which.

#include <kaboum/io/file_unit.h>

#include <cmath>
#include <cstring>

#include "fuzz.h"

namespace {

using namespace kaboum;

void require_positive(double number, const std::string& text) {
  if (!(number > 0) || !std::isfinite(number)) fuzz::broken("a factor", text);
}

void look_at_unit(const std::string& text) {
  const std::optional<double> metres = io::metres_of(text);
  if (!metres) return;
  require_positive(*metres, text);
  const std::string name = io::unit_of_metres(*metres);
  const std::optional<double> again = io::metres_of(name);
  if (!again || io::unit_of_metres(*again) != name) fuzz::broken("another unit", name);
  try {
    io::require_same_unit("a", text, "b", name);
  } catch (const Error& error) {
    fuzz::broken("two units", error.what());
  }
  io::require_same_unit("a", text, "b", "m");
}

/// A factor of eight bytes, and a mesh as OFF.
void look_at_scaled(const std::string& text) {
  double factor = 0;
  if (text.size() < sizeof factor) return;
  std::memcpy(&factor, text.data(), sizeof factor);
  io::ReadResult read =
      io::parse_mesh(std::span(text).subspan(sizeof factor), io::Format::Off, "fuzz");
  read.unit = "mm";
  io::scale(read, factor, "fuzz");
  require_positive(factor, text);
  if (read.mesh.triangles.empty()) fuzz::broken("a mesh", "without triangles");
  for (const geom::Triangle& t : read.mesh.triangles)
    for (const std::uint32_t corner : t)
      if (corner >= read.mesh.vertices.size()) fuzz::broken("a corner", std::to_string(corner));
  for (const geom::Vec3& v : read.mesh.vertices)
    if (!v.allFinite()) fuzz::broken("a coordinate", std::to_string(factor));
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return fuzz::select(data, size, 3, [](int kind, const std::string& text) {
    switch (kind) {
      case 0:
        return require_positive(io::recorded_scale(text, "fuzz"), text);
      case 1:
        return look_at_unit(text);
      default:
        return look_at_scaled(text);
    }
  });
}
