// PLY (Stanford), ASCII and binary of both byte orders.

#include <algorithm>
#include <cmath>
#include <optional>

#include "builder.h"
#include "bytes.h"
#include "formats.h"
#include "output.h"
#include "point_formats.h"
#include "text.h"

namespace kaboum::io {
namespace {

enum class Scalar { Int8, UInt8, Int16, UInt16, Int32, UInt32, Float32, Float64 };

std::optional<Scalar> scalar_from_name(std::string_view name) {
  if (name == "char" || name == "int8") return Scalar::Int8;
  if (name == "uchar" || name == "uint8") return Scalar::UInt8;
  if (name == "short" || name == "int16") return Scalar::Int16;
  if (name == "ushort" || name == "uint16") return Scalar::UInt16;
  if (name == "int" || name == "int32") return Scalar::Int32;
  if (name == "uint" || name == "uint32") return Scalar::UInt32;
  if (name == "float" || name == "float32") return Scalar::Float32;
  if (name == "double" || name == "float64") return Scalar::Float64;
  return std::nullopt;
}

std::size_t size_of(Scalar type) {
  switch (type) {
    case Scalar::Int8:
    case Scalar::UInt8:
      return 1;
    case Scalar::Int16:
    case Scalar::UInt16:
      return 2;
    case Scalar::Int32:
    case Scalar::UInt32:
    case Scalar::Float32:
      return 4;
    case Scalar::Float64:
      break;
  }
  return 8;
}

/// Every PLY scalar is a double without loss.
double load_scalar(const char* from, Scalar type, std::endian order) {
  switch (type) {
    case Scalar::Int8:
      return static_cast<signed char>(*from);
    case Scalar::UInt8:
      return static_cast<unsigned char>(*from);
    case Scalar::Int16:
      return load<std::int16_t>(from, order);
    case Scalar::UInt16:
      return load<std::uint16_t>(from, order);
    case Scalar::Int32:
      return load<std::int32_t>(from, order);
    case Scalar::UInt32:
      return load<std::uint32_t>(from, order);
    case Scalar::Float32:
      return load<float>(from, order);
    case Scalar::Float64:
      break;
  }
  return load<double>(from, order);
}

struct Property {
  std::string_view name;
  Scalar type;                  ///< of the value, or of a list's entries
  std::optional<Scalar> count;  ///< set for lists
};

struct Element {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  bool ascii = false;
  std::endian order = std::endian::little;
  std::vector<Element> elements;
  std::size_t size = 0;  ///< bytes up to the data
};

/// The header is text in every encoding; it is read line by line with its own places.
class HeaderReader {
 public:
  explicit HeaderReader(Source source) : source_(std::move(source)) { source_.text = true; }

  Header read() {
    if (next_line() != "ply")
      fail(source_, "the file does not begin with 'ply'; it is not a PLY file or is damaged");
    bool has_format = false;
    for (;;) {
      const std::string_view line = next_line();
      line_ = line;
      const std::string_view keyword = word();
      if (keyword == "end_header") break;
      if (keyword.empty() || keyword == "comment" || keyword == "obj_info") continue;
      if (keyword == "format") {
        read_format();
        has_format = true;
      } else if (keyword == "element") {
        read_element();
      } else if (keyword == "property") {
        read_property();
      } else {
        fail(source_, line.data(),
             "unknown PLY header line " + in_quotes(line) +
                 "; the file is damaged or not a PLY file");
      }
    }
    if (!has_format)
      fail(source_, "the PLY header has no 'format' line; the file is damaged, export it again");
    header_.size = at_;
    return std::move(header_);
  }

 private:
  /// The next header line without its end: LF, CR LF, or CR when the first line ends so.
  std::string_view next_line() {
    const std::size_t end = source_.bytes.find_first_of("\r\n", at_);
    if (end == std::string_view::npos)
      fail(source_, at_ == 0 ? source_.begin() : source_.end(),
           at_ == 0 ? "the file is not a PLY file: no line ends"
                    : "the PLY header has no 'end_header'; the file is truncated, get it again");
    const std::string_view line = source_.bytes.substr(at_, end - at_);
    const bool crlf = source_.bytes.substr(end, 2) == "\r\n";
    if (at_ == 0) crlf_ = crlf;
    at_ = end + (crlf && crlf_ ? 2 : 1);
    return line;
  }

  std::string_view word() {
    const std::size_t first = std::min(line_.find_first_not_of(" \t"), line_.size());
    const std::size_t end = std::min(line_.find_first_of(" \t", first), line_.size());
    const std::string_view found = line_.substr(first, end - first);
    line_.remove_prefix(end);
    return found;
  }

  [[noreturn]] void fail_at(std::string_view found, const std::string& expected) const {
    fail(source_, line_.data(),
         in_quotes(found) + " where " + expected +
             " is expected in the PLY header; export the file again");
  }

  void read_format() {
    const std::string_view encoding = word();
    header_.ascii = encoding == "ascii";
    header_.order = encoding == "binary_big_endian" ? std::endian::big : std::endian::little;
    if (!header_.ascii && encoding != "binary_little_endian" && encoding != "binary_big_endian")
      fail_at(encoding, "ascii, binary_little_endian or binary_big_endian");
  }

  void read_element() {
    Element element;
    element.name = word();
    const std::string_view number = word();
    const std::int64_t count = parse_integer(
        source_, number.empty() ? line_.substr(line_.size()) : number, "a number of elements");
    if (count < 0) fail_at(number, "a number of elements");
    element.count = static_cast<std::uint64_t>(count);
    for (const Element& other : header_.elements)
      if (other.name == element.name) fail_at(element.name, "an element of another name");
    header_.elements.push_back(std::move(element));
  }

  Scalar scalar() {
    const std::string_view name = word();
    const std::optional<Scalar> type = scalar_from_name(name);
    if (!type) fail_at(name, "a scalar type such as float or int");
    return *type;
  }

  void read_property() {
    if (header_.elements.empty()) fail_at("property", "'element'");
    Property property{};
    const std::string_view rest = line_;
    if (word() == "list") {
      property.count = scalar();
      if (*property.count == Scalar::Float32 || *property.count == Scalar::Float64)
        fail_at("list", "a list counted by an integer type");
    } else {
      line_ = rest;
    }
    property.type = scalar();
    property.name = word();
    header_.elements.back().properties.push_back(property);
  }

  Source source_;
  Header header_;
  std::string_view line_;  ///< what is left of the current line
  std::size_t at_ = 0;
  bool crlf_ = false;
};

/// Delivers the values of the data section one by one.
class AsciiValues {
 public:
  AsciiValues(const Source& source, const Header& header) : scan_(source, {}) {
    scan_.seek(source.begin() + header.size);
  }
  double coordinate(Scalar /*type*/) { return scan_.coordinate(); }
  /// The same, which may be NaN.
  double number(const Source& source, Scalar /*type*/) {
    return PointBuilder::value_of(source, scan_.need("a coordinate"));
  }
  std::int64_t integer(Scalar /*type*/) { return scan_.integer("an integer"); }
  void skip(Scalar /*type*/, std::uint64_t count) {
    for (; count > 0; --count) scan_.need("a value");
  }
  /// Where something follows that is neither white space nor read; else nullptr.
  const char* rest() { return scan_.token().empty() ? nullptr : scan_.last(); }
  [[nodiscard]] const char* where() const { return scan_.last(); }
  /// Records of `values` values that can be left: each takes a digit and a space.
  [[nodiscard]] std::uint64_t room(std::uint64_t values, std::uint64_t /*bytes*/) const {
    return (scan_.bytes_left() + 1) / (2 * values);
  }

 private:
  Scanner scan_;
};

class BinaryValues {
 public:
  BinaryValues(const Source& source, const Header& header)
      : source_(source), order_(header.order), at_(source.begin() + header.size) {}

  double coordinate(Scalar type) { return load_scalar(take(type, 1), type, order_); }
  double number(const Source& /*source*/, Scalar type) { return coordinate(type); }
  std::int64_t integer(Scalar type) {
    const char* const from = take(type, 1);
    if (type == Scalar::Int32) return load<std::int32_t>(from, order_);
    const double value = load_scalar(from, type, order_);
    if (value != std::floor(value) || std::abs(value) > 1e15)
      fail(source_, from, "an index that is not an integer; the file is damaged, export it again");
    return static_cast<std::int64_t>(value);
  }
  void skip(Scalar type, std::uint64_t count) { take(type, count); }
  const char* rest() {
    while (at_ != source_.end() && detail::char_class(*at_) != detail::kOther) ++at_;
    return at_ == source_.end() ? nullptr : at_;
  }
  [[nodiscard]] const char* where() const { return at_; }
  [[nodiscard]] std::uint64_t room(std::uint64_t /*values*/, std::uint64_t bytes) const {
    return left() / bytes;
  }

 private:
  [[nodiscard]] std::uint64_t left() const {
    return static_cast<std::uint64_t>(source_.end() - at_);
  }
  const char* take(Scalar type, std::uint64_t count) {
    if (count > left() / size_of(type))
      fail(source_, source_.end(), "the file ends within its data; it is truncated, get it again");
    const char* const from = at_;
    at_ += count * size_of(type);
    return from;
  }

  const Source& source_;
  std::endian order_;
  const char* at_;
};

/// More records than the file has room for are refused before anything is reserved.
template <typename Values>
void check_room(const Source& source, const Values& values, const Element& element) {
  std::uint64_t bytes = 0;
  for (const Property& p : element.properties) bytes += size_of(p.count.value_or(p.type));
  if (element.properties.empty() || element.count == 0) return;
  if (element.count > values.room(element.properties.size(), bytes))
    fail(source, "the PLY header states " + std::to_string(element.count) + " records of element " +
                     in_quotes(element.name) + ", more than a file of " +
                     std::to_string(source.bytes.size()) +
                     " bytes holds; it is truncated or damaged");
}

/// The axis of a property of points: 0, 1, 2, else −1.
int axis_of(const Property& p) {
  const bool is_one = !p.count && p.name.size() == 1 && p.name[0] >= 'x' && p.name[0] <= 'z';
  return is_one ? p.name[0] - 'x' : -1;
}

/// The vertices of a file without faces.
template <typename Values>
void read_points(const Source& source, const Header& header, PointBuilder& to) {
  Values values(source, header);
  bool found = false;
  for (const Element& element : header.elements) {
    const bool vertices = element.name == "vertex";
    check_room(source, values, element);
    if (!vertices && element.count > 0)
      fail(source, "the PLY element " + in_quotes(element.name) +
                       " is no point: a file with faces is a mesh, which is an object of a scene; "
                       "export points alone");
    if (!vertices) continue;
    found = true;
    std::array<int, 3> axes{};
    for (const Property& p : element.properties) {
      if (p.count) fail(source, "a list in element 'vertex' cannot be read; export points alone");
      if (const int axis = axis_of(p); axis >= 0) ++axes[static_cast<std::size_t>(axis)];
    }
    if (axes != std::array<int, 3>{1, 1, 1})
      fail(source, "element 'vertex' needs each of the properties x, y and z once; export again");
    for (std::uint64_t i = 0; i < element.count; ++i) {
      geom::Vec3 point;
      for (const Property& p : element.properties)
        if (const int axis = axis_of(p); axis >= 0)
          point[axis] = values.number(source, p.type);
        else
          values.skip(p.type, 1);
      to.add(point);
    }
  }
  if (!found) fail(source, "the PLY header has no element 'vertex'; the file holds no points");
  if (const char* const rest = values.rest(); rest != nullptr)
    fail(source, rest,
         "the file goes on after the elements that its header states; it is damaged, get it again");
}

template <typename Values>
class DataReader {
 public:
  DataReader(const Source& source, const Header& header)
      : source_(source), header_(header), values_(source, header), builder_(source) {}

  ReadResult read() {
    const Element* vertex = find("vertex");
    if (vertex == nullptr)
      fail(source_, "the PLY header has no element 'vertex'; the file holds no mesh");
    for (const Element& element : header_.elements) {
      check_room(element);
      if (element.name == "vertex") {
        read_vertices(element);
      } else if (element.name == "face") {
        read_faces(element);
      } else if (element.name == "tristrips") {
        read_strips(element);
      } else {
        refuse_geometry(element);
        for (std::uint64_t i = 0; i < element.count && !element.properties.empty(); ++i)
          for (const Property& p : element.properties) skip(p);
      }
    }
    if (const char* const rest = values_.rest(); rest != nullptr)
      fail(source_, rest,
           "the file goes on after the elements that its header states; correct the counts, or "
           "export it again");
    const bool floats =
        !header_.ascii && std::ranges::all_of(vertex->properties, [](const Property& p) {
          const bool wide = p.type != Scalar::Float32 && size_of(p.type) > 2;
          return !wide || (p.name != "x" && p.name != "y" && p.name != "z");
        });
    return builder_.finish(Format::Ply, floats);
  }

 private:
  /// The corners of a face, as stored.
  using Corners = std::vector<std::int64_t>;

  [[nodiscard]] const Element* find(std::string_view name) const {
    for (const Element& e : header_.elements)
      if (e.name == name) return &e;
    return nullptr;
  }

  void check_room(const Element& element) { io::check_room(source_, values_, element); }

  void skip(const Property& p) {
    if (p.count) {
      values_.skip(p.type, list_size(p));
    } else {
      values_.skip(p.type, 1);
    }
  }

  std::uint64_t list_size(const Property& p) {
    const std::int64_t n = values_.integer(*p.count);
    if (n < 0)
      fail(source_, values_.where(),
           "a list of negative length; the file is damaged, get it again");
    return static_cast<std::uint64_t>(n);
  }

  /// Elements of unknown names may be faces, patches or spheres: those with lists, or with three
  /// and more numbers.
  void refuse_geometry(const Element& element) const {
    constexpr std::array<std::string_view, 6> kNoFaces = {
        "camera", "edge", "material", "multi_texture_face", "multi_texture_vertex", "user"};
    if (element.count == 0 || std::ranges::find(kNoFaces, element.name) != kNoFaces.end()) return;
    const bool lists = std::ranges::any_of(element.properties,
                                           [](const Property& p) { return p.count.has_value(); });
    if (lists || element.properties.size() >= 3)
      fail(source_, "the PLY element " + in_quotes(element.name) +
                        " may hold geometry and cannot be read; export the mesh with elements "
                        "'vertex' and 'face' only");
  }

  void read_vertices(const Element& element) {
    std::array<int, 3> found{};
    std::vector<int> axes;  // 0, 1, 2 for coordinates, else −1
    for (const Property& p : element.properties) {
      const int axis = axis_of(p);
      if (axis >= 0) ++found[static_cast<std::size_t>(axis)];
      axes.push_back(axis);
      if (p.count && p.type != Scalar::Float32 && p.type != Scalar::Float64)
        builder_.note("The list " + in_quotes(p.name) + " of element 'vertex' was ignored.");
    }
    if (found != std::array<int, 3>{1, 1, 1})
      fail(source_, "element 'vertex' needs each of the properties x, y and z once; export again");
    builder_.reserve_points(element.count);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      geom::Vec3 point;
      for (std::size_t k = 0; k < axes.size(); ++k) {
        if (axes[k] >= 0) {
          point[axes[k]] = values_.coordinate(element.properties[k].type);
        } else {
          skip(element.properties[k]);
        }
      }
      builder_.add_point(point, values_.where());
    }
  }

  /// Reads a record and returns the indices in it.
  const Corners& read_corners(const Element& element, const Property& indices) {
    for (const Property& p : element.properties) {
      if (&p != &indices) {
        skip(p);
        continue;
      }
      corners_.clear();
      for (std::uint64_t n = list_size(p); n > 0; --n) corners_.push_back(values_.integer(p.type));
    }
    return corners_;
  }

  const Property& index_property(const Element& element) {
    const Property* found = nullptr;
    for (const Property& p : element.properties) {
      if (!p.count) continue;
      if (p.name == "vertex_indices" || p.name == "vertex_index") {
        if (found != nullptr)
          fail(source_, "element " + in_quotes(element.name) +
                            " has two lists of vertex indices; export the mesh with one");
        found = &p;
      } else if (p.type != Scalar::Float32 && p.type != Scalar::Float64) {
        builder_.note("The list " + in_quotes(p.name) + " of element " + in_quotes(element.name) +
                      " was ignored.");
      }
    }
    if (found == nullptr)
      fail(source_, "element " + in_quotes(element.name) +
                        " has no list property vertex_indices or vertex_index; export again");
    return *found;
  }

  void read_faces(const Element& element) {
    require_vertices(element);
    if (element.count == 0) return;
    const Property& indices = index_property(element);
    builder_.reserve_triangles(element.count);
    std::vector<std::uint32_t> face;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const char* const where = values_.where();
      face.clear();
      for (const std::int64_t index : read_corners(element, indices))
        face.push_back(builder_.corner(index, 0, where));
      builder_.add_face(face, where);
    }
  }

  /// Strips of triangles, separated by −1; every second triangle of a strip runs the other way.
  void read_strips(const Element& element) {
    require_vertices(element);
    if (element.count == 0) return;
    const Property& indices = index_property(element);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      const char* const where = values_.where();
      std::array<std::uint32_t, 2> last{};
      std::size_t length = 0;
      for (const std::int64_t index : read_corners(element, indices)) {
        if (index == -1) {
          length = 0;
          continue;
        }
        const std::uint32_t corner = builder_.corner(index, 0, where);
        if (length >= 2) {
          const bool even = length % 2 == 0;
          builder_.add_triangle({last[even ? 0 : 1], last[even ? 1 : 0], corner});
        }
        last = {last[1], corner};
        ++length;
      }
    }
  }

  void require_vertices(const Element& element) {
    const Element* const vertex = find("vertex");
    if (&element < vertex)
      fail(source_, "element " + in_quotes(element.name) +
                        " comes before 'vertex'; reorder the elements of the file");
  }

  const Source& source_;
  const Header& header_;
  Values values_;
  MeshBuilder builder_;
  Corners corners_;
};

void write_header(Output& out, const geom::Mesh& mesh, std::string_view format, bool doubles,
                  const WriteOptions& options) {
  out.text("ply\nformat ");
  out.text(format);
  out.text(" 1.0\n");
  if (!options.comment.empty()) out.text("comment " + one_line(options.comment) + "\n");
  out.text("element vertex " + std::to_string(mesh.vertices.size()) + "\n");
  for (const char* axis : {"x", "y", "z"}) {
    out.text(doubles ? "property double " : "property float ");
    out.text(axis);
    out.text("\n");
  }
  out.text("element face " + std::to_string(mesh.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n");
}

}  // namespace

ReadResult read_ply(Source source) {
  const Header header = HeaderReader(source).read();
  source.text = header.ascii;
  if (header.ascii) return DataReader<AsciiValues>(source, header).read();
  return DataReader<BinaryValues>(source, header).read();
}

void read_ply_points(const Source& given, PointBuilder& to) {
  Source source = given;
  const Header header = HeaderReader(source).read();
  source.text = header.ascii;
  if (header.ascii) return read_points<AsciiValues>(source, header, to);
  read_points<BinaryValues>(source, header, to);
}

std::vector<char> write_ply_binary(const geom::Mesh& mesh, const WriteOptions& options) {
  Output out;
  const std::size_t width = options.double_precision ? 8 : 4;
  out.reserve(1024 + options.comment.size() + 3 * width * mesh.vertices.size() +
              13 * mesh.triangles.size());
  write_header(out, mesh, "binary_little_endian", options.double_precision, options);
  for (const geom::Vec3& p : mesh.vertices) {
    for (const double x : p) {
      if (options.double_precision) {
        out.little(x);
      } else {
        out.little(static_cast<float>(x));
      }
    }
  }
  for (const geom::Triangle& t : mesh.triangles) {
    out.little(std::uint8_t{3});
    for (const std::uint32_t corner : t) out.little(corner);
  }
  return out.take();
}

std::vector<char> write_ply_ascii(const geom::Mesh& mesh, const WriteOptions& options) {
  Output out;
  out.reserve(1024 + mesh.vertices.size() * 48 + mesh.triangles.size() * 24);
  // "float" would let other programs round.
  write_header(out, mesh, "ascii", options.double_precision || !all_float(mesh), options);
  write_lines(out, mesh);
  return out.take();
}

}  // namespace kaboum::io
