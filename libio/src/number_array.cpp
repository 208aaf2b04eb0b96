// Arrays of NumPy: format description of numpy.lib.format, versions 1 to 3.

#include <kaboum/base/error.h>
#include <kaboum/io/number_array.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

namespace kaboum::io {
namespace {

constexpr std::string_view kMagic = "\x93NUMPY";

[[noreturn]] void refuse(const std::string& name, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, name + ": " + what);
}

/// The header of an array.
struct Layout {
  std::string_view type;  ///< of its values, as NumPy writes it
  bool by_column = false;
  std::vector<std::size_t> shape;
};

/// What the array's header says after a key; empty: nothing.
std::string_view value_of(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = header.substr(at + key.size());
  const std::size_t begin = rest.find_first_not_of(": ");
  return begin == std::string_view::npos ? std::string_view() : rest.substr(begin);
}

/// The sizes in parentheses; none where they are no such list.
std::vector<std::size_t> parse_shape(std::string_view text) {
  std::vector<std::size_t> out;
  const char *at = text.data() + 1, *end = text.data() + text.size();
  while (at != end && *at != ')') {
    std::size_t size = 0;
    const auto [stop, error] = std::from_chars(at, end, size);
    if (error != std::errc()) return {};
    out.push_back(size);
    at = stop;
    while (at != end && (*at == ',' || *at == ' ')) ++at;
  }
  return at == end ? std::vector<std::size_t>() : out;
}

Layout parse_header(const std::string& name, std::string_view header) {
  Layout out;
  const std::string_view type = value_of(header, "'descr'");
  // In quotation marks; those of records are lists, of names and types.
  if (type.starts_with('\'')) out.type = type.substr(1, type.find('\'', 1) - 1);
  const std::string_view order = value_of(header, "'fortran_order'");
  out.by_column = order.starts_with("True");
  if (!out.by_column && !order.starts_with("False"))
    refuse(name, "the array's header does not say in which order values are");
  const std::string_view shape = value_of(header, "'shape'");
  if (!shape.starts_with('(')) refuse(name, "the array's header has no shape");
  out.shape = parse_shape(shape);
  if (out.shape.empty() || out.shape.size() > 3)
    refuse(name, "an array of one to three dimensions is expected");
  if (out.shape[0] == 0) refuse(name, "the array has no rows");
  for (const std::size_t size : out.shape)
    if (size == 0) refuse(name, "the array has no columns");
  return out;
}

/// The number of values; false where it is beyond what a file can hold.
bool count_of(const std::vector<std::size_t>& shape, std::size_t& count) {
  count = 1;
  for (const std::size_t size : shape) {
    if (size > (std::size_t{1} << 48) / count) return false;
    count *= size;
  }
  return true;
}

template <typename Number>
NumberArray values_of(const std::string& name, std::string_view data, const Layout& layout) {
  NumberArray out;
  out.shape = layout.shape;
  std::size_t count = 0;
  if (!count_of(layout.shape, count) || data.size() != count * sizeof(Number))
    refuse(
        name,
        "the array has other than " + std::to_string(layout.shape[0]) + " rows" +
            (layout.shape.size() == 2 ? " of " + std::to_string(layout.shape[1]) + " values" : "") +
            ", as its header has it; the file is cut, or damaged");
  out.values.resize(count);
  const std::size_t rows = layout.shape[0], columns = layout.shape.size() > 1 ? layout.shape[1] : 1,
                    layers = layout.shape.size() > 2 ? layout.shape[2] : 1;
  std::size_t to = 0;
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c)
      for (std::size_t l = 0; l < layers; ++l, ++to) {
        const std::size_t from = layout.by_column ? r + rows * (c + columns * l) : to;
        Number number;
        std::memcpy(&number, data.data() + from * sizeof number, sizeof number);
        const auto value = static_cast<double>(number);
        if constexpr (std::is_integral_v<Number>) {
          constexpr double kExact = 0x1p53;  // so far, doubles are all whole numbers
          if (std::abs(value) > kExact)
            refuse(name, "row " + std::to_string(r + 1) + ": a whole number beyond 2^53");
        }
        out.values[to] = value;
      }
  return out;
}

}  // namespace

std::size_t NumberArray::row_size() const { return shape.empty() ? 0 : values.size() / shape[0]; }

bool is_number_array(std::span<const char> bytes) {
  return std::string_view(bytes.data(), bytes.size()).starts_with(kMagic);
}

NumberArray parse_number_array(std::span<const char> bytes, const std::string& name) {
  static_assert(std::endian::native == std::endian::little);
  const std::string_view text(bytes.data(), bytes.size());
  if (!text.starts_with(kMagic) || text.size() < 12) refuse(name, "no array of NumPy");
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(text[i]));
  };
  const std::size_t begin = byte(6) == 1 ? 10 : 12;
  std::size_t length = byte(8) + 256 * byte(9);
  if (begin == 12) length += 65536 * (byte(10) + 256 * byte(11));
  if (begin + length > text.size()) refuse(name, "the file ends in the array's header");
  const std::string_view data = text.substr(begin + length);
  const Layout layout = parse_header(name, text.substr(begin, length));
  if (layout.type == "<f4") return values_of<float>(name, data, layout);
  if (layout.type == "<f8") return values_of<double>(name, data, layout);
  if (layout.type == "<i4") return values_of<std::int32_t>(name, data, layout);
  if (layout.type == "<i8") return values_of<std::int64_t>(name, data, layout);
  refuse(name,
         "an array of float32, float64, int32 or int64 is expected, little-endian: "
         "array.astype('<f8')");
}

}  // namespace kaboum::io
