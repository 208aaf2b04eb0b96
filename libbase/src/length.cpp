// Lengths in words, and in units.

#include <kaboum/base/error.h>
#include <kaboum/base/length.h>
#include <kaboum/base/length_unit.h>
#include <kaboum/base/parse_length.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <numeric>

namespace kaboum {
namespace {

/// Ten-thousandths of a millimetre in each of kLengthUnits: whole numbers, so that 5mm is the
/// double nearest to 0.005 m.
constexpr std::array<std::int64_t, 8> kTenths{10'000'000, 1'000'000,      100'000, 10'000,
                                              10,         10'000'000'000, 254'000, 3'048'000};
static_assert(kTenths.size() == kLengthUnitCount);

Length::Unit unit_named(std::string_view name) {
  const auto* const found = std::ranges::find(kLengthUnits, name);
  if (found == kLengthUnits.end()) return Length::Unit::Own;
  return static_cast<Length::Unit>(found - kLengthUnits.begin() + 1);
}

std::int64_t tenths_of(Length::Unit unit) { return kTenths.at(static_cast<std::size_t>(unit) - 1); }

[[noreturn]] void refuse(const Length& length) {
  throw Error(ErrorCode::InvalidArgument,
              length.text() +
                  ": the unit of the coordinates is not known; state it («unit=mm»), or "
                  "give the length in it, as a number alone");
}

}  // namespace

double Length::of(double diagonal) const {
  if (unit != Unit::Own) refuse(*this);
  return percent ? 0.01 * value * diagonal : value;
}

Length Length::in(std::string_view other) const {
  if (unit == Unit::Own) return *this;
  const Unit to = unit_named(other);
  if (to == Unit::Own) refuse(*this);
  const std::int64_t common = std::gcd(tenths_of(unit), tenths_of(to));
  // One of the two is 1 between units of ten.
  const std::int64_t times = tenths_of(unit) / common, over = tenths_of(to) / common;
  const Length out{value * static_cast<double>(times) / static_cast<double>(over), false};
  if (!std::isfinite(out.value) || (out.value == 0) != (value == 0))
    throw Error(ErrorCode::InvalidArgument,
                text() + ": no number holds that in " + std::string(other));
  return out;
}

std::string Length::text() const {
  std::array<char, 32> digits{};
  const auto [end, error] = std::to_chars(digits.data(), digits.data() + digits.size(), value);
  std::string out(digits.data(), end);
  if (percent) out += '%';
  if (unit != Unit::Own) out += kLengthUnits.at(static_cast<std::size_t>(unit) - 1);
  return out;
}

std::optional<Length> parse_length(std::string_view text) {
  const std::optional<Length> out = parse_distance(text);
  return out && out->value > 0 ? out : std::nullopt;
}

std::optional<Length> parse_distance(std::string_view text) {
  if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
  Length length;
  const char* end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data(), end, length.value);
  if (error != std::errc() || !std::isfinite(length.value) || !(length.value >= 0))
    return std::nullopt;
  const std::string_view rest(stop, static_cast<std::size_t>(end - stop));
  if (rest.empty()) return length;
  length.percent = rest == "%";
  if (!length.percent) length.unit = unit_named(rest);
  if (!length.percent && length.unit == Length::Unit::Own) return std::nullopt;
  return length;
}

std::vector<std::string> notes_on_unit(std::span<const Length> lengths, const std::string& taken) {
  std::vector<std::string> out;
  for (const Length& length : lengths) {
    if (length.unit == Length::Unit::Own) continue;
    std::string note = "The file does not state the unit of its vertices: ";
    note.append(length.text()).append(" is brought into ").append(taken).append(".");
    if (std::ranges::find(out, note) == out.end()) out.push_back(std::move(note));
  }
  return out;
}

}  // namespace kaboum
