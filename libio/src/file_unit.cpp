// Units of length that files state, and coordinates in another one.
#include <kaboum/base/error.h>
#include <kaboum/base/option.h>
#include <kaboum/geom/topology.h>
#include <kaboum/io/file_unit.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <string_view>

#include "text.h"

namespace kaboum::io {
namespace {

struct NamedUnit {
  double metres;
  const char* name;
};
constexpr std::array<NamedUnit, 8> kUnits{{{1, "m"},
                                           {1e-1, "dm"},
                                           {1e-2, "cm"},
                                           {1e-3, "mm"},
                                           {1e-6, "um"},
                                           {1e3, "km"},
                                           {0.0254, "in"},
                                           {0.3048, "ft"}}};

/// Whether two numbers of metres are one unit but for rounding. Each is the double nearest to a
/// decimal fraction, or the product or quotient of two such, and then errs by less than 2^-51.
bool are_one_unit(double a, double b) { return std::abs(a - b) <= 0x1p-50 * std::min(a, b); }

/// The number of units `to` in `from`, in few digits where these are as good.
std::string factor_between(double from, double to) {
  std::array<char, 32> text{};
  char* const end = std::to_chars(text.data(), text.data() + text.size(), from / to,
                                  std::chars_format::general, 15)
                        .ptr;
  double factor = 0;
  std::from_chars(text.data(), end, factor);
  return are_one_unit(from / factor, to) ? std::string(text.data(), end)
                                         : shortest_digits(from / to);
}

bool has_equal_corners(const geom::Triangle& t) {
  return t[0] == t[1] || t[1] == t[2] || t[2] == t[0];
}

}  // namespace

std::string unit_of_metres(double metres) {
  for (const NamedUnit& unit : kUnits)
    if (are_one_unit(metres, unit.metres)) return unit.name;
  return shortest_digits(metres) + " m";
}

std::optional<double> metres_of(const std::string& unit) {
  for (const NamedUnit& known : kUnits)
    if (unit == known.name) return known.metres;
  double metres = 0;
  const char* const end = unit.data() + unit.size();
  const auto [at, error] = std::from_chars(unit.data(), end, metres);
  if (error != std::errc() || std::string_view(at, end) != " m" || !(metres > 0) ||
      !std::isfinite(metres))
    return {};
  return metres;
}

void scale(ReadResult& read, double factor, const std::string& name) {
  if (!(factor > 0) || !std::isfinite(factor))
    throw Error(ErrorCode::InvalidArgument, "a scale must be a positive number");
  if (factor == 1) return;
  for (geom::Vec3& v : read.mesh.vertices) {
    const geom::Vec3 product = factor * v;
    for (int i = 0; i < 3; ++i)
      if (!std::isfinite(product[i]) ||
          (v[i] != 0 && std::abs(product[i]) < std::numeric_limits<double>::min()))
        throw Error(ErrorCode::InvalidInput,
                    name + ": its coordinate " + shortest_digits(v[i]) + ", times " +
                        shortest_digits(factor) +
                        ", is beyond the range of doubles; choose a factor nearer to 1");
    v = product;
  }
  // Rounding may make neighbours equal. Segments and points that were there stay.
  std::vector<geom::Triangle> kept;
  const std::vector<geom::Triangle> before = read.mesh.triangles;
  read.mesh = geom::weld(read.mesh);
  constexpr auto kGone = static_cast<std::uint32_t>(-1);
  std::vector<std::uint32_t> number(before.size(), kGone);
  for (std::size_t t = 0; t < before.size(); ++t)
    if (!has_equal_corners(read.mesh.triangles[t]) || has_equal_corners(before[t])) {
      number[t] = static_cast<std::uint32_t>(kept.size());
      kept.push_back(read.mesh.triangles[t]);
    }
  std::vector<std::uint32_t> quads;  // both of whose triangles are left
  for (const std::uint32_t quad : read.bent_quads)
    if (number[quad] != kGone && number[quad + 1] != kGone) quads.push_back(number[quad]);
  read.bent_quads = std::move(quads);
  read.largest_bend *= factor;
  const std::size_t collapsed = before.size() - kept.size();
  read.mesh.triangles = std::move(kept);
  if (collapsed > 0) {
    read.mesh = geom::weld(read.mesh);
    read.collapsed_triangles += collapsed;
    if (read.mesh.triangles.empty())
      throw Error(ErrorCode::InvalidInput,
                  name + ": no triangle is left after scaling; choose a factor nearer to 1");
  }
  read.single_precision = false;
  if (read.deviation > 0) read.deviation = scaled_bound(read.deviation, factor, read.mesh);
  read.notes.push_back("Its coordinates are multiplied by " + shortest_digits(factor) +
                       ", and what is said of it is about the products.");
  if (const auto metres = metres_of(read.unit)) read.unit = unit_of_metres(*metres / factor);
}

double scaled_bound(double bound, double factor, const geom::Mesh& scaled) {
  double largest = 0;
  for (const geom::Vec3& v : scaled.vertices) largest = std::max(largest, v.cwiseAbs().maxCoeff());
  // Half a unit in the last place in three coordinates is less than the largest times 2^-52.
  const double sum =
      bound * factor * (1 + 0x1p-50) + largest * 0x1p-52 + std::numeric_limits<double>::min();
  return std::nextafter(sum, std::numeric_limits<double>::infinity());
}

double recorded_scale(const std::string& record, const std::string& file) {
  const std::optional<std::string> word = recorded(record, "scale");
  if (!word) return 1;
  double factor = 0;
  const char* const end = word->data() + word->size();
  const auto [at, error] = std::from_chars(word->data(), end, factor);
  if (error != std::errc() || at != end || !(factor > 0) || !std::isfinite(factor))
    throw Error(ErrorCode::InvalidInput, file + ": its record says a scale of " + in_quotes(*word) +
                                             ", which is no factor; it is damaged, make it anew");
  return factor;
}

void require_recorded_scale(const std::string& file, const std::string& record, double factor) {
  const double recorded = recorded_scale(record, file);
  if (recorded == factor) return;
  throw Error(
      ErrorCode::InvalidInput,
      file + ": it was made " +
          (recorded == 1 ? "without «scale»: leave that out"
                         : "with «scale=" + shortest_digits(recorded) + "»: give that here, too"));
}

void require_same_unit(const std::string& file, const std::string& unit,
                       const std::string& other_file, const std::string& other_unit) {
  if (unit.empty() || other_unit.empty() || unit == other_unit) return;
  const auto from = metres_of(unit), to = metres_of(other_unit);
  if (from && to && are_one_unit(*from, *to)) return;
  const std::string factor = from && to ? factor_between(*from, *to) : "FACTOR";
  throw Error(ErrorCode::InvalidInput,
              file + " is in " + unit + " and " + other_file + " in " + other_unit +
                  " as read (docs/formats.md): lengths of two units are not compared; bring the "
                  "first into the other's unit with «scale=" +
                  factor + "», or export it in " + other_unit);
}

}  // namespace kaboum::io
