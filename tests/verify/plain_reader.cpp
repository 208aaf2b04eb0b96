#include "plain_reader.h"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace kaboum::test {
namespace {

[[noreturn]] void stop(const char* why) {
  throw std::runtime_error(std::string("plain reader: ") + why);
}

std::vector<std::string> words(const std::string& text) {
  std::istringstream in(text);
  return {std::istream_iterator<std::string>(in), {}};
}

double number(const std::string& word) {
  char* end = nullptr;
  const double x = std::strtod(word.c_str(), &end);
  if (end == word.c_str()) stop("no number");
  return x;
}

std::vector<std::string> lines(const std::string& bytes) {
  std::vector<std::string> result(1);
  for (const char c : bytes) {
    if (c == '\n' || c == '\r') {
      result.emplace_back();
    } else {
      result.back() += c;
    }
  }
  return result;
}

std::vector<Polygon> polygons(const std::vector<Corner>& points,
                              const std::vector<std::vector<long>>& faces) {
  std::vector<Polygon> result;
  for (const auto& face : faces) {
    Polygon p;
    for (const long i : face) p.push_back(points.at(static_cast<std::size_t>(i)));
    result.push_back(std::move(p));
  }
  return result;
}

std::vector<Polygon> off(const std::string& bytes) {
  std::vector<std::vector<std::string>> rows;
  for (std::string line : lines(bytes)) {
    line = line.substr(0, line.find('#'));
    auto row = words(line);
    if (!row.empty()) rows.push_back(std::move(row));
  }
  if (rows.empty() || rows[0][0].find("OFF") == std::string::npos) stop("no OFF");
  rows[0].erase(rows[0].begin());
  std::size_t at = rows[0].empty() ? 1 : 0;
  const auto vertices = static_cast<std::size_t>(number(rows.at(at).at(0)));
  const auto count = static_cast<std::size_t>(number(rows.at(at).at(1)));
  ++at;
  std::vector<Corner> points;
  for (std::size_t i = 0; i < vertices; ++i, ++at) {
    points.push_back(
        {number(rows.at(at).at(0)), number(rows.at(at).at(1)), number(rows.at(at).at(2))});
  }
  std::vector<std::vector<long>> faces;
  for (std::size_t i = 0; i < count; ++i, ++at) {
    const auto& row = rows.at(at);
    std::vector<long> face;
    for (std::size_t k = 1; k <= static_cast<std::size_t>(number(row.at(0))); ++k)
      face.push_back(static_cast<long>(number(row.at(k))));
    faces.push_back(std::move(face));
  }
  return polygons(points, faces);
}

std::vector<Polygon> obj(const std::string& bytes) {
  std::vector<Corner> points;
  std::vector<std::vector<long>> faces;
  for (const std::string& line : lines(bytes)) {
    const auto row = words(line.substr(0, line.find('#')));
    if (row.empty()) continue;
    if (row[0] == "v") points.push_back({number(row.at(1)), number(row.at(2)), number(row.at(3))});
    if (row[0] != "f") continue;
    std::vector<long> face;
    for (std::size_t k = 1; k < row.size(); ++k) {
      const long i = std::strtol(row[k].c_str(), nullptr, 10);
      face.push_back(i > 0 ? i - 1 : static_cast<long>(points.size()) + i);
    }
    faces.push_back(std::move(face));
  }
  return polygons(points, faces);
}

template <class T>
T raw(const std::string& bytes, std::size_t& at, bool swapped) {
  if (bytes.size() - at < sizeof(T)) stop("file ends too early");
  std::array<char, sizeof(T)> data;
  std::memcpy(data.data(), bytes.data() + at, sizeof(T));
  at += sizeof(T);
  if (swapped) std::reverse(data.begin(), data.end());
  T value;
  std::memcpy(&value, data.data(), sizeof(T));
  return value;
}

std::vector<Polygon> stl(const std::string& bytes) {
  std::vector<Polygon> result;
  if (bytes.size() >= 84) {
    std::size_t at = 80;
    const auto count = raw<std::uint32_t>(bytes, at, false);
    if (bytes.size() == 84 + 50 * static_cast<std::size_t>(count)) {
      for (std::uint32_t i = 0; i < count; ++i) {
        at += 12;
        Polygon p(3);
        for (Corner& c : p) {
          for (double& x : c) x = raw<float>(bytes, at, false);
        }
        result.push_back(std::move(p));
        at += 2;
      }
      return result;
    }
  }
  Polygon p;
  for (const std::string& line : lines(bytes)) {
    const auto row = words(line);
    if (row.empty()) continue;
    if (row[0] == "vertex") p.push_back({number(row.at(1)), number(row.at(2)), number(row.at(3))});
    if (row[0] == "endfacet") {
      result.push_back(p);
      p.clear();
    }
  }
  return result;
}

struct Property {
  std::string name, type, count_type;  // count_type: of a list
};
struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

double binary(const std::string& type, const std::string& bytes, std::size_t& at, bool swapped) {
  if (type == "float" || type == "float32") return raw<float>(bytes, at, swapped);
  if (type == "double" || type == "float64") return raw<double>(bytes, at, swapped);
  if (type == "char" || type == "int8") return raw<std::int8_t>(bytes, at, swapped);
  if (type == "uchar" || type == "uint8") return raw<std::uint8_t>(bytes, at, swapped);
  if (type == "short" || type == "int16") return raw<std::int16_t>(bytes, at, swapped);
  if (type == "ushort" || type == "uint16") return raw<std::uint16_t>(bytes, at, swapped);
  if (type == "int" || type == "int32") return raw<std::int32_t>(bytes, at, swapped);
  if (type == "uint" || type == "uint32") return raw<std::uint32_t>(bytes, at, swapped);
  stop("unknown type in PLY");
}

std::vector<Polygon> ply(const std::string& bytes) {
  const std::size_t end = bytes.find("end_header");
  if (bytes.rfind("ply", 0) != 0 || end == std::string::npos) stop("no PLY");
  std::size_t at = bytes.find('\n', end) + 1;
  std::vector<Element> elements;
  std::string format;
  for (const std::string& line : lines(bytes.substr(0, end))) {
    const auto row = words(line);
    if (row.empty()) continue;
    if (row[0] == "format") format = row.at(1);
    if (row[0] == "element")
      elements.push_back({row.at(1), static_cast<std::size_t>(number(row.at(2))), {}});
    if (row[0] == "property" && row.at(1) == "list")
      elements.back().properties.push_back({row.at(4), row.at(3), row.at(2)});
    else if (row[0] == "property")
      elements.back().properties.push_back({row.at(2), row.at(1), ""});
  }
  std::istringstream text(format == "ascii" ? bytes.substr(at) : std::string());
  const auto next = [&](const std::string& type) {
    if (format != "ascii") return binary(type, bytes, at, format == "binary_big_endian");
    std::string word;
    if (!(text >> word)) stop("file ends too early");
    return number(word);
  };
  std::vector<Corner> points;
  std::vector<std::vector<long>> faces;
  for (const Element& element : elements) {
    for (std::size_t i = 0; i < element.count; ++i) {
      Corner corner{};
      for (const Property& p : element.properties) {
        if (p.count_type.empty()) {
          const double x = next(p.type);
          if (p.name == "x" || p.name == "y" || p.name == "z") corner[p.name[0] - 'x'] = x;
          continue;
        }
        std::vector<long> list(static_cast<std::size_t>(next(p.count_type)));
        for (long& v : list) v = static_cast<long>(next(p.type));
        if (p.name == "vertex_indices" || p.name == "vertex_index")
          faces.push_back(std::move(list));
      }
      if (element.name == "vertex") points.push_back(corner);
    }
  }
  return polygons(points, faces);
}

}  // namespace

std::vector<Polygon> read_plainly(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) stop("cannot open");
  const std::string bytes{std::istreambuf_iterator<char>(file), {}};
  std::string extension = path.substr(path.rfind('.') + 1);
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension == "off") return off(bytes);
  if (extension == "obj") return obj(bytes);
  if (extension == "stl") return stl(bytes);
  if (extension == "ply") return ply(bytes);
  stop("unknown extension");
}

}  // namespace kaboum::test
