// The option --batch of kaboum-check: configurations by the million.

#include "batch.h"

#include <kaboum/base/error.h>
#include <kaboum/filter/batch_checker.h>
#include <kaboum/io/mesh_io.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace kaboum::tools {
namespace {

bool is_npy(const std::string& file) { return file.ends_with(".npy"); }

[[noreturn]] void refuse(const std::string& file, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, file + ": " + what);
}

/// How an array is stored.
struct Layout {
  std::string_view type;  ///< of its values, as NumPy writes it
  bool by_column = false;
  std::size_t rows = 0, columns = 0;

  [[nodiscard]] std::size_t index(std::size_t row, std::size_t column) const {
    return by_column ? column * rows + row : row * columns + column;
  }
};

std::string in_row(std::size_t row, const char* what) {
  return "row " + std::to_string(row + 1) + ": " + what;
}

template <typename Number>
std::vector<std::vector<double>> rows_of(const std::string& file, std::string_view data,
                                         const Layout& layout) {
  if (data.size() / sizeof(Number) / layout.columns < layout.rows ||
      data.size() != layout.rows * layout.columns * sizeof(Number))
    refuse(file, "the array has other than " + std::to_string(layout.rows) + " rows of " +
                     std::to_string(layout.columns) + " values");
  std::vector<std::vector<double>> out(layout.rows, std::vector<double>(layout.columns));
  for (std::size_t r = 0; r < layout.rows; ++r)
    for (std::size_t c = 0; c < layout.columns; ++c) {
      Number number;
      std::memcpy(&number, data.data() + layout.index(r, c) * sizeof number, sizeof number);
      const auto value = static_cast<double>(number);
      if constexpr (std::is_integral_v<Number>) {
        constexpr double kExact = 0x1p53;  // so far, doubles are all whole numbers
        if (std::abs(value) > kExact) refuse(file, in_row(r, "a whole number beyond 2^53"));
      }
      if (!std::isfinite(value)) refuse(file, in_row(r, "a number that is not finite"));
      out[r][c] = value;
    }
  return out;
}

/// What the array's header says after a key; empty: nothing.
std::string_view value_of(std::string_view header, std::string_view key) {
  const std::size_t at = header.find(key);
  if (at == std::string_view::npos) return {};
  const std::string_view rest = header.substr(at + key.size());
  const std::size_t begin = rest.find_first_not_of(": ");
  return begin == std::string_view::npos ? std::string_view() : rest.substr(begin);
}

Layout parse_header(const std::string& file, std::string_view header) {
  Layout out;
  const std::string_view type = value_of(header, "'descr'");
  // In quotation marks; those of records are lists, of names and types.
  if (type.starts_with('\'')) out.type = type.substr(1, type.find('\'', 1) - 1);
  const std::string_view order = value_of(header, "'fortran_order'");
  out.by_column = order.starts_with("True");
  if (!out.by_column && !order.starts_with("False"))
    refuse(file, "the array's header does not say in which order values are");
  const std::string_view shape = value_of(header, "'shape'");
  if (!shape.starts_with('(')) refuse(file, "the array's header has no shape");
  const char *at = shape.data() + 1, *end = shape.data() + shape.size();
  const auto first = std::from_chars(at, end, out.rows);
  at = first.ptr;
  while (at != end && (*at == ',' || *at == ' ')) ++at;
  const auto second = std::from_chars(at, end, out.columns);
  if (first.ec != std::errc() || second.ec != std::errc() || second.ptr == end ||
      *second.ptr != ')')
    refuse(file, "an array with a row for each configuration is expected");
  if (out.rows == 0) refuse(file, "no configurations: the array has no rows");
  if (out.columns == 0) refuse(file, "the array has no columns");
  return out;
}

/// An array of NumPy: two-dimensional, of little-endian numbers. docs/formats.md.
std::vector<std::vector<double>> read_npy(const std::string& file) {
  static_assert(std::endian::native == std::endian::little);
  const std::vector<char> bytes = io::read_file(file);
  const std::string_view text(bytes.data(), bytes.size());
  if (!text.starts_with("\x93NUMPY") || text.size() < 12) refuse(file, "no array of NumPy");
  const auto byte = [&](std::size_t i) {
    return static_cast<std::size_t>(static_cast<unsigned char>(text[i]));
  };
  const std::size_t begin = byte(6) == 1 ? 10 : 12;
  std::size_t length = byte(8) + 256 * byte(9);
  if (begin == 12) length += 65536 * (byte(10) + 256 * byte(11));
  if (begin + length > text.size()) refuse(file, "the file ends in the array's header");
  const std::string_view data = text.substr(begin + length);
  const Layout layout = parse_header(file, text.substr(begin, length));
  if (layout.type == "<f4") return rows_of<float>(file, data, layout);
  if (layout.type == "<f8") return rows_of<double>(file, data, layout);
  if (layout.type == "<i4") return rows_of<std::int32_t>(file, data, layout);
  if (layout.type == "<i8") return rows_of<std::int64_t>(file, data, layout);
  refuse(file,
         "an array of float32, float64, int32 or int64 is expected, little-endian: "
         "array.astype('<f8')");
}

/// @throws Error{InvalidInput} where the rows have not a value for each joint that moves
void require_columns(const std::string& file, std::size_t columns, const robot::Robot& robot,
                     const robot::FixedJoints& fixed) {
  std::string names;
  std::size_t expected = 0;
  for (const robot::Variable& v : robot.variables) {
    if (fixed.contains(v.name)) continue;
    names += expected == 0 ? "" : ", ";
    names += v.name;
    ++expected;
  }
  if (columns != expected)
    refuse(file, std::to_string(columns) + " columns, and " + std::to_string(expected) +
                     " are expected: " + names + ", in this order");
}

/// A byte for each configuration: an array of uint8, or lines of 0 and 1.
std::string text_of(const std::vector<std::uint8_t>& free, bool npy) {
  std::string out;
  if (!npy) {
    out.reserve(2 * free.size());
    for (const std::uint8_t x : free) out += x != 0 ? "1\n" : "0\n";
    return out;
  }
  std::string header = "{'descr': '|u1', 'fortran_order': False, 'shape': (";
  header += std::to_string(free.size());
  header += ",), }";
  header.resize((10 + header.size() + 64) / 64 * 64 - 10 - 1, ' ');
  header += '\n';
  out = "\x93NUMPY";
  out += '\x01';
  out += '\0';
  out += static_cast<char>(header.size() % 256);
  out += static_cast<char>(header.size() / 256);
  out += header;
  out.append(free.begin(), free.end());
  return out;
}

}  // namespace

void require_batch_meaning(const CheckOptions& o) {
  const auto no = [](const std::string& text) { throw Error(ErrorCode::InvalidArgument, text); };
  if (o.batch.empty()) {
    if (!o.verdicts.empty()) no("--verdicts needs --batch");
    return;
  }
  if (o.engine.library != engines::Library::Own || o.distance || o.state.resting ||
      !o.inside.empty() || !o.preview.empty())
    no("--engine, --distance, --resting, --inside and --preview are not for --batch: give "
       "--configurations");
}

robot::Path read_batch(const std::string& file, const robot::Robot& robot,
                       const robot::PathOptions& options, std::vector<std::string>& notes) {
  if (file.ends_with(".npz"))
    refuse(file, "an archive of arrays; save one array as .npy, with numpy.save");
  if (!is_npy(file)) return read_path(file, robot, options, notes);
  robot::NamedPath named;
  named.waypoints = read_npy(file);
  require_columns(file, named.waypoints.front().size(), robot, options.fixed);
  robot::Path out = robot::arrange(named, robot, file, false, options.fixed);
  if (options.degrees) out = robot::from_degrees(std::move(out), robot);
  if (options.check_limits) robot::require_within_limits(out, robot, file);
  return out;
}

int check_batch(const CheckOptions& o, const world::SceneFile& scene, std::size_t robot,
                const robot::Path& rows, const std::string& kept,
                const std::function<void(const std::string&)>& say, Json& report) {
  const world::Checker checker(scene.world);
  const filter::BatchChecker batch(checker, initial_state(scene.world), robot, {});
  std::vector<double> values;
  values.reserve(rows.size() * batch.variables());
  for (const std::vector<double>& row : rows) values.insert(values.end(), row.begin(), row.end());
  std::vector<std::uint8_t> free(rows.size());
  const filter::BatchCounts counts = batch.decide(values, free);
  if (!o.verdicts.empty()) {
    const std::string text = text_of(free, is_npy(o.verdicts));
    io::write_file(o.verdicts, std::vector<char>(text.begin(), text.end()));
  }
  const std::string summary = std::to_string(counts.free) + " of " + std::to_string(rows.size()) +
                              " configurations are free, " + std::to_string(counts.contact) +
                              " are not" + kept + "; " + std::to_string(counts.exactly) +
                              " needed exact predicates";
  // Standard output is the verdicts' where they are written there.
  if (o.verdicts == "-")
    log(o.common.quiet, summary);
  else
    say(summary);
  report["batch"] = {{"file", o.batch},
                     {"configurations", rows.size()},
                     {"free", counts.free},
                     {"not_free", counts.contact},
                     {"exactly", counts.exactly}};
  report["answer"] = counts.contact == 0 ? "free" : "not free";
  return counts.contact == 0 ? kDone : kNo;
}

}  // namespace kaboum::tools
