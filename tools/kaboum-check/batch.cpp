// The option --batch of kaboum-check: configurations by the million.

#include "batch.h"

#include <kaboum/base/error.h>
#include <kaboum/filter/batch_checker.h>
#include <kaboum/io/mesh_io.h>

#include <bit>
#include <charconv>
#include <cstring>

namespace kaboum::tools {
namespace {

bool is_npy(const std::string& file) { return file.ends_with(".npy"); }

[[noreturn]] void refuse(const std::string& file, const std::string& what) {
  throw Error(ErrorCode::InvalidInput, file + ": " + what);
}

template <typename Number>
std::vector<std::vector<double>> rows_of(std::string_view data, std::size_t rows,
                                         std::size_t columns) {
  std::vector<std::vector<double>> out(rows, std::vector<double>(columns));
  const char* at = data.data();
  for (std::vector<double>& row : out)
    for (double& value : row) {
      Number number;
      std::memcpy(&number, at, sizeof number);
      at += sizeof number;
      value = number;
    }
  return out;
}

/// An array of NumPy: two-dimensional, row by row, of little-endian floats.
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
  const std::string_view header = text.substr(begin, length), data = text.substr(begin + length);
  const bool singles = header.find("'<f4'") != std::string_view::npos;
  if (!singles && header.find("'<f8'") == std::string_view::npos)
    refuse(file, "an array of float32 or float64 is expected, little-endian");
  if (header.find("'fortran_order': False") == std::string_view::npos)
    refuse(file, "an array that is stored row by row is expected");
  const std::size_t shape = header.find("'shape': (");
  if (shape == std::string_view::npos) refuse(file, "the array's header has no shape");
  std::size_t rows = 0, columns = 0;
  const char *at = header.data() + shape + 10, *end = header.data() + header.size();
  const auto first = std::from_chars(at, end, rows);
  at = first.ptr;
  while (at != end && (*at == ',' || *at == ' ')) ++at;
  const auto second = std::from_chars(at, end, columns);
  if (first.ec != std::errc() || second.ec != std::errc() || second.ptr == end ||
      *second.ptr != ')')
    refuse(file, "an array with a row for each configuration is expected");
  const std::size_t size = singles ? 4 : 8;
  if (columns == 0 || rows == 0 || data.size() / size / columns < rows ||
      data.size() != rows * columns * size)
    refuse(file, "the array has other than " + std::to_string(rows) + " rows of " +
                     std::to_string(columns) + " values");
  return singles ? rows_of<float>(data, rows, columns) : rows_of<double>(data, rows, columns);
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
  if (!is_npy(file)) return read_path(file, robot, options, notes);
  robot::NamedPath named;
  named.waypoints = read_npy(file);
  robot::Path out = robot::arrange(named, robot, file, false, options.fixed);
  if (options.degrees) out = robot::from_degrees(std::move(out), robot);
  if (options.check_limits) robot::require_within_limits(out, robot, file);
  return out;
}

int check_batch(const CheckOptions& o, const world::SceneFile& scene, std::size_t robot,
                const robot::Path& rows, const std::function<void(const std::string&)>& say,
                Json& report) {
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
  say(std::to_string(counts.free) + " of " + std::to_string(rows.size()) +
      " configurations are free, " + std::to_string(counts.contact) + " are not; " +
      std::to_string(counts.exactly) + " needed exact predicates");
  report["batch"] = {{"file", o.batch},
                     {"configurations", rows.size()},
                     {"free", counts.free},
                     {"in_contact", counts.contact},
                     {"exactly", counts.exactly}};
  report["answer"] = counts.contact == 0 ? "free" : "not free";
  return counts.contact == 0 ? kDone : kNo;
}

}  // namespace kaboum::tools
