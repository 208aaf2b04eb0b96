// Point clouds: PCD of the Point Cloud Library (versions .5 to .7), lines of numbers, NumPy's
// arrays; PLY is in ply.cpp.

#include <kaboum/base/error.h>
#include <kaboum/io/mesh_io.h>
#include <kaboum/io/number_array.h>
#include <kaboum/io/point_cloud.h>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <set>
#include <string_view>

#include "bytes.h"
#include "point_formats.h"
#include "text.h"

namespace kaboum::io {
namespace {

/// Words of a line, between blanks, or between commas or semicolons.
std::vector<std::string_view> words_of(std::string_view line) {
  const bool commas = line.find_first_of(",;") != std::string_view::npos;
  std::vector<std::string_view> out;
  const std::string_view blanks = " \t\r\v\f", ends = commas ? ",;" : blanks;
  for (std::size_t at = 0; at <= line.size();) {
    const std::size_t end = std::min(line.find_first_of(ends, at), line.size());
    std::string_view word = line.substr(at, end - at);
    word.remove_prefix(std::min(word.find_first_not_of(blanks), word.size()));
    word = word.substr(0, word.find_last_not_of(blanks) + 1);
    if (!word.empty() || (commas && end < line.size())) out.push_back(word);
    at = end + 1;
  }
  return out;
}

/// Calls take(line) for every line of a text.
template <typename Take>
void for_lines(std::string_view text, const Take& take) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    take(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
}

// Lines of numbers.

void read_lines(const Source& source, PointBuilder& to) {
  bool first = true;
  for_lines(without_byte_order_mark(source.bytes), [&](std::string_view line) {
    for (const std::string_view mark : {"#", "//"}) line = line.substr(0, line.find(mark));
    if (line.find(',') != std::string_view::npos && line.find(';') != std::string_view::npos)
      fail(source, line.data(),
           "commas and semicolons in one line; write decimal points, and one of the two between "
           "numbers");
    const std::vector<std::string_view> words = words_of(line);
    if (words.empty()) return;
    const bool names = first && words.size() >= 3 && same_word(words[0], "x") &&
                       same_word(words[1], "y") && same_word(words[2], "z");
    first = false;
    if (names) return;
    if (words.size() < 3)
      fail(source, line.data(),
           counted(words.size(), "number", "numbers") +
               " where x, y and z of a point are expected; other lines begin with #");
    to.add({PointBuilder::value_of(source, words[0]), PointBuilder::value_of(source, words[1]),
            PointBuilder::value_of(source, words[2])});
  });
}

// PCD.

struct Field {
  std::string_view name;
  std::size_t size = 4, count = 1;
  char type = 'F';
  std::size_t offset = 0;  ///< of it in a point, in bytes; in a line, in words
};

struct PcdHeader {
  std::vector<Field> fields;
  std::array<const Field*, 3> place{};
  std::size_t points = 0;
  std::size_t point_size = 0, words = 0;  ///< of a point
  std::string_view data;
  std::size_t end = 0;  ///< of the header
  bool has_viewpoint = false;
};

class PcdHeaderReader {
 public:
  explicit PcdHeaderReader(const Source& source) : source_(source) { source_.text = true; }

  PcdHeader read() {
    while (out_.data.empty()) read_line();
    finish();
    return std::move(out_);
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    fail(source_, line_.data(), what + "; the PCD header is damaged, write the file again");
  }

  void read_line() {
    const std::size_t end = source_.bytes.find('\n', out_.end);
    if (end == std::string_view::npos)
      fail(source_,
           "the file ends in its PCD header, which has no DATA; it is cut, or no PCD file");
    line_ = source_.bytes.substr(out_.end, end - out_.end);
    out_.end = end + 1;
    if (line_.starts_with('#')) return;
    const std::vector<std::string_view> words = words_of(line_);
    if (words.empty()) return;
    const std::string_view key = words.front();
    const std::span<const std::string_view> rest(words.data() + 1, words.size() - 1);
    if (!seen_.emplace(key == "COLUMNS" ? "FIELDS" : key).second)
      refuse(in_quotes(key) + " is there twice");
    if (key == "FIELDS" || key == "COLUMNS") {
      for (const std::string_view name : rest) out_.fields.push_back({.name = name});
    } else if (key == "SIZE") {
      for_fields(rest, [&](Field& f, std::string_view word) { f.size = number(word, 1, 8); });
    } else if (key == "TYPE") {
      for_fields(rest, [&](Field& f, std::string_view word) {
        if (word != "F" && word != "I" && word != "U")
          refuse(in_quotes(word) + " where a type, F, I or U, is expected");
        f.type = word[0];
      });
    } else if (key == "COUNT") {
      for_fields(rest,
                 [&](Field& f, std::string_view word) { f.count = number(word, 1, 1 << 20); });
    } else if (key == "WIDTH" || key == "HEIGHT" || key == "POINTS") {
      if (rest.size() != 1) refuse("one number is expected");
      (key == "WIDTH"    ? width_
       : key == "HEIGHT" ? height_
                         : points_) = number(rest[0], 0, std::size_t{1} << 40);
    } else if (key == "VIEWPOINT") {
      read_viewpoint(rest);
    } else if (key == "DATA") {
      if (rest.size() != 1) refuse("DATA names no encoding");
      out_.data = rest[0];
    } else if (key != "VERSION") {
      refuse("unknown line " + in_quotes(line_));
    }
  }

  std::size_t number(std::string_view word, std::size_t least, std::size_t most) const {
    const std::int64_t value = parse_integer(source_, word, "a number of the PCD header");
    if (value < static_cast<std::int64_t>(least) || value > static_cast<std::int64_t>(most))
      refuse(in_quotes(word) + " is not from " + std::to_string(least) + " to " +
             std::to_string(most));
    return static_cast<std::size_t>(value);
  }

  template <typename Set>
  void for_fields(std::span<const std::string_view> words, const Set& set) {
    if (words.size() != out_.fields.size() || words.empty())
      refuse(counted(words.size(), "entry", "entries") + " for " +
             counted(out_.fields.size(), "field", "fields"));
    for (std::size_t i = 0; i < words.size(); ++i) set(out_.fields[i], words[i]);
  }

  void read_viewpoint(std::span<const std::string_view> words) {
    if (words.size() != 7) refuse("seven numbers are expected: a place and a quaternion");
    constexpr std::array<double, 7> kNone{0, 0, 0, 1, 0, 0, 0};
    for (std::size_t i = 0; i < 7; ++i)
      if (parse_coordinate(source_, words[i]) != kNone[i]) out_.has_viewpoint = true;
  }

  void finish() {
    const auto whole = [&](const std::string& what) { fail(source_, what); };
    if (out_.data != "ascii" && out_.data != "binary" && out_.data != "binary_compressed")
      refuse("data of the kind " + in_quotes(out_.data) +
             ", where ascii, binary or binary_compressed is expected");
    if (!width_ && !points_) whole("the PCD header states no WIDTH and no POINTS");
    const std::size_t height = height_.value_or(1);
    if (width_ && height > 0 && *width_ > (std::size_t{1} << 40) / height)
      whole("WIDTH times HEIGHT of the PCD header is more than a file holds");
    out_.points = points_.value_or(width_.value_or(0) * height);
    if (width_ && points_ && *width_ * height != *points_)
      whole("the PCD header states " + std::to_string(*points_) +
            " POINTS, and WIDTH times HEIGHT are " + std::to_string(*width_ * height) +
            "; the file is damaged, write it again");
    for (const char* needed : {"SIZE", "TYPE"})
      if (out_.data != "ascii" && !seen_.contains(needed))
        whole(std::string("the PCD header has no ") + needed + "; binary points need it");
    for (Field& f : out_.fields) {
      const bool sizes = f.type == 'F' ? f.size == 4 || f.size == 8 : std::has_single_bit(f.size);
      if (!sizes)
        whole("field " + in_quotes(f.name) + " has " + std::to_string(f.size) + " bytes and type " +
              f.type);
      f.offset = out_.data == "ascii" ? out_.words : out_.point_size;
      out_.point_size += f.size * f.count;
      out_.words += f.count;
    }
    constexpr std::array<std::string_view, 3> kNames{"x", "y", "z"};
    for (std::size_t k = 0; k < 3; ++k) {
      for (const Field& f : out_.fields) {
        if (f.name != kNames[k]) continue;
        if (out_.place[k] != nullptr) whole("two fields " + in_quotes(f.name));
        out_.place[k] = &f;
      }
      if (out_.place[k] == nullptr || out_.place[k]->count != 1)
        whole("the PCD file has no field " + in_quotes(kNames[k]) + " of one number: no points");
    }
  }

  Source source_;
  PcdHeader out_;
  std::string_view line_;
  std::set<std::string_view> seen_;  ///< keys of lines
  std::optional<std::size_t> width_, height_, points_;
};

double load_field(const char* from, const Field& field) {
  constexpr std::endian kOrder = std::endian::little;
  switch (field.type == 'F' ? field.size + 8 : field.type == 'I' ? field.size + 16 : field.size) {
    case 12:
      return load<float>(from, kOrder);
    case 16:
      return load<double>(from, kOrder);
    case 17:
      return static_cast<signed char>(*from);
    case 18:
      return load<std::int16_t>(from, kOrder);
    case 20:
      return load<std::int32_t>(from, kOrder);
    case 24:
      return static_cast<double>(load<std::int64_t>(from, kOrder));
    case 1:
      return static_cast<unsigned char>(*from);
    case 2:
      return load<std::uint16_t>(from, kOrder);
    case 4:
      return load<std::uint32_t>(from, kOrder);
    default:
      return static_cast<double>(load<std::uint64_t>(from, kOrder));
  }
}

/// Bytes packed by M. Lehmann's LZF, as PCD has them.
std::string unpacked(const Source& source, std::string_view packed, std::size_t size) {
  const auto damaged = [&] {
    fail(source, "the compressed points are damaged or cut; write the file again");
  };
  std::string out;
  out.reserve(size);
  for (std::size_t at = 0; at < packed.size();) {
    const auto byte = [&] {
      if (at == packed.size()) damaged();
      return static_cast<std::size_t>(static_cast<unsigned char>(packed[at++]));
    };
    const std::size_t control = byte();
    if (control < 32) {  // so many bytes and one as they are
      const std::size_t count = control + 1;
      if (count > packed.size() - at || count > size - out.size()) damaged();
      out.append(packed.substr(at, count));
      at += count;
      continue;
    }
    std::size_t count = control / 32;
    if (count == 7) count += byte();
    count += 2;
    const std::size_t back = (control % 32) * 256 + byte() + 1;
    if (back > out.size() || count > size - out.size()) damaged();
    for (std::size_t i = 0; i < count; ++i) out += out[out.size() - back];
  }
  if (out.size() != size) damaged();
  return out;
}

void read_pcd(const Source& source, PointBuilder& to, bool& has_viewpoint) {
  const PcdHeader header = PcdHeaderReader(source).read();
  has_viewpoint = header.has_viewpoint;
  std::string_view data = source.bytes.substr(header.end);
  const auto require_size = [&](std::size_t have) {
    if (have / header.point_size < header.points)
      fail(source, "the PCD header states " + counted(header.points, "point", "points") + " of " +
                       std::to_string(header.point_size) +
                       " bytes, more than the file holds; it is "
                       "cut or damaged");
  };
  if (header.data == "ascii") {
    std::size_t count = 0;
    for_lines(data, [&](std::string_view line) {
      if (line.starts_with('#')) return;
      const std::vector<std::string_view> words = words_of(line);
      if (words.empty()) return;
      if (words.size() != header.words)
        fail(source, line.data(),
             counted(words.size(), "value", "values") + " where " + std::to_string(header.words) +
                 " are expected of a point");
      if (++count > header.points) return;
      geom::Vec3 p;
      for (int k = 0; k < 3; ++k)
        p[k] = PointBuilder::value_of(source,
                                      words[header.place[static_cast<std::size_t>(k)]->offset]);
      to.add(p);
    });
    if (count != header.points)
      fail(source, "the PCD header states " + counted(header.points, "point", "points") +
                       ", and the file has " + std::to_string(count) + "; it is cut or damaged");
    return;
  }
  std::string bytes;
  const bool packed = header.data == "binary_compressed";
  if (packed) {
    if (data.size() < 8) fail(source, "the file ends before its points; it is cut");
    const std::size_t from = load_little<std::uint32_t>(data.data()),
                      size = load_little<std::uint32_t>(data.data() + 4);
    data.remove_prefix(8);
    if (from > data.size()) fail(source, "the file ends within its compressed points; it is cut");
    // Three bytes give 264 at most.
    if (size / 100 > from || size != header.points * header.point_size)
      fail(source, "the compressed points have another size than the PCD header states");
    bytes = unpacked(source, data.substr(0, from), size);
    data = bytes;
  }
  require_size(data.size());
  if (!packed && data.size() != header.points * header.point_size)
    fail(source, "the file goes on after the points that its PCD header states; write it again");
  for (std::size_t i = 0; i < header.points; ++i) {
    geom::Vec3 p;
    for (int k = 0; k < 3; ++k) {
      const Field& f = *header.place[static_cast<std::size_t>(k)];
      // Compressed ones are stored field after field.
      const std::size_t at =
          packed ? f.offset * header.points + i * f.size : i * header.point_size + f.offset;
      p[k] = load_field(data.data() + at, f);
    }
    to.add(p);
  }
}

void read_array(const Source& source, PointBuilder& to) {
  const NumberArray array =
      parse_number_array({source.bytes.data(), source.bytes.size()}, std::string(source.name));
  if (array.shape.size() != 2 || array.shape[1] != 3)
    fail(source, "an array of n x 3 numbers is expected: array[:, :3]");
  for (std::size_t i = 0; i < array.values.size(); i += 3)
    to.add({array.values[i], array.values[i + 1], array.values[i + 2]});
}

bool ends_with(std::string_view name, std::string_view ending) {
  return name.size() >= ending.size() &&
         same_word(name.substr(name.size() - ending.size()), ending);
}

}  // namespace

void PointBuilder::add(const geom::Vec3& p) {
  if (++count_ >= std::numeric_limits<std::uint32_t>::max())
    throw Error(ErrorCode::LimitReached, std::string(source_.name) + ": more than 2^32 - 2 points");
  if (!p.allFinite()) {
    if (out_.invalid++ == 0) out_.first_invalid = count_;
    return;
  }
  out_.points.push_back(p);
  out_.numbers.push_back(static_cast<std::uint32_t>(count_));
}

PointCloud PointBuilder::finish() {
  if (count_ == 0) fail(source_, "no points are in it");
  if (out_.points.empty())
    fail(source_, "none of its " + counted(count_, "point has", "points have") +
                      " finite coordinates: the sensor saw nothing, or the file is damaged");
  return std::move(out_);
}

double PointBuilder::value_of(const Source& source, std::string_view token) {
  std::string_view bare = token;
  if (bare.starts_with('-') || bare.starts_with('+')) bare.remove_prefix(1);
  for (const std::string_view word : {"nan", "inf", "infinity"})
    if (same_word(bare, word)) return std::numeric_limits<double>::quiet_NaN();
  return parse_coordinate(source, token);
}

PointCloud parse_point_cloud(std::span<const char> bytes, const std::string& name) {
  Source source{{bytes.data(), bytes.size()}, name, {}, true};
  PointBuilder builder(source);
  bool has_viewpoint = false;
  const auto is = [&](std::string_view ending) { return ends_with(name, ending); };
  if (bytes.empty()) fail(source, "the file is empty");
  if (is(".ply"))
    read_ply_points(source, builder);
  else if (is(".pcd"))
    read_pcd(source, builder, has_viewpoint);
  else if (is(".npy"))
    read_array(source, builder);
  else if (is(".xyz") || is(".txt") || is(".asc") || is(".csv"))
    read_lines(source, builder);
  else
    fail(source,
         "no format of point clouds is known by this name: .ply, .pcd, .npy, .xyz, .txt, "
         ".asc and .csv are");
  PointCloud out = builder.finish();
  out.has_viewpoint = has_viewpoint;
  return out;
}

PointCloud read_point_cloud(const std::filesystem::path& path) {
  return parse_point_cloud(read_file(path), path.string());
}

}  // namespace kaboum::io
