// Accessors of glTF 2.0 (sections 3.6.2 and 5.1): numbers in the bytes of buffers.

#include "gltf_accessor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "bytes.h"

namespace kaboum::io {
namespace {

std::size_t size_of(Component type) {
  switch (type) {
    case Component::Int8:
    case Component::UInt8:
      return 1;
    case Component::Int16:
    case Component::UInt16:
      return 2;
    case Component::UInt32:
    case Component::Float32:
      break;
  }
  return 4;
}

/// Every component is a double without loss.
double load_component(const char* from, Component type) {
  switch (type) {
    case Component::Int8:
      return load_little<std::int8_t>(from);
    case Component::UInt8:
      return load_little<std::uint8_t>(from);
    case Component::Int16:
      return load_little<std::int16_t>(from);
    case Component::UInt16:
      return load_little<std::uint16_t>(from);
    case Component::UInt32:
      return load_little<std::uint32_t>(from);
    case Component::Float32:
      break;
  }
  return load_little<float>(from);
}

/// The number that normalised integers are divided by.
double unit_of(Component type) {
  switch (type) {
    case Component::Int8:
      return std::numeric_limits<std::int8_t>::max();
    case Component::UInt8:
      return std::numeric_limits<std::uint8_t>::max();
    case Component::Int16:
      return std::numeric_limits<std::int16_t>::max();
    default:
      return std::numeric_limits<std::uint16_t>::max();
  }
}

std::string shown(double x) {
  std::array<char, 32> digits;
  return {digits.data(), std::to_chars(digits.data(), digits.data() + digits.size(), x).ptr};
}

class AccessorReader {
 public:
  AccessorReader(GltfFile& file, const JsonItem& index, const char* shape, std::size_t width)
      : file_(file), accessor_(file.element("accessors", index)), width_(width) {
    file_.check_extensions(accessor_);
    if (accessor_.at("type").text() != shape)
      accessor_.fail("of type " + in_quotes(accessor_.at("type").text()) + " where " + shape +
                     " is needed; the file is damaged");
    const std::uint64_t type = accessor_.at("componentType").integer();
    if (type < 5120 || type > 5126 || type == 5124)
      accessor_.fail("component type " + std::to_string(type) +
                     " is not one of glTF 2.0; export the file again");
    type_ = static_cast<Component>(type);
    normalised_ = accessor_.has("normalized") && accessor_.at("normalized").truth();
    count_ = accessor_.at("count").integer();
    if (count_ == 0) accessor_.fail("its count is 0; the file is damaged");
    if (!accessor_.has("bufferView") && !accessor_.has("sparse"))
      accessor_.fail(
          "it has no data, which may be in an extension; decompress the file first "
          "(gltf-transform copy IN.glb OUT.glb), or export it again");
    file_.spend(count_ * width_);
  }

  [[nodiscard]] const JsonItem& accessor() const { return accessor_; }
  [[nodiscard]] Component type() const { return type_; }
  [[nodiscard]] bool normalised() const { return normalised_; }
  [[nodiscard]] std::size_t count() const { return static_cast<std::size_t>(count_); }

  /// The components as stored, element by element; `strided` as vertex data may be.
  std::vector<double> read(bool strided) {
    const std::size_t element = width_ * size_of(type_);
    std::vector<double> values(count() * width_, 0.0);
    if (accessor_.has("bufferView")) {
      const JsonItem number = accessor_.at("bufferView");
      const JsonItem view = file_.element("bufferViews", number);
      std::size_t stride = element;
      if (view.has("byteStride")) {
        stride = static_cast<std::size_t>(view.at("byteStride").integer());
        if (stride < element || stride > 252 || (!strided && stride != element))
          view.fail("its byteStride " + std::to_string(stride) +
                    " does not fit the accessor that uses it; the file is damaged");
      }
      const char* at = data(number, accessor_.integer_or("byteOffset", 0), count_, stride, element);
      for (std::size_t i = 0; i < count(); ++i, at += stride)
        for (std::size_t k = 0; k < width_; ++k)
          values[i * width_ + k] = load_component(at + k * size_of(type_), type_);
    }
    if (accessor_.has("sparse")) substitute(values);
    check_bounds(values);
    return values;
  }

 private:
  /// The first of `count` elements of `size` bytes in a buffer view.
  const char* data(const JsonItem& number, std::uint64_t offset, std::uint64_t count,
                   std::size_t stride, std::size_t size) {
    const JsonItem view = file_.element("bufferViews", number);
    file_.check_extensions(view, {"EXT_meshopt_compression", "KHR_meshopt_compression"});
    const std::string_view bytes = file_.buffer(view.at("buffer"));
    const std::uint64_t start = view.integer_or("byteOffset", 0);
    const std::uint64_t length = view.at("byteLength").integer();
    if (start > bytes.size() || length > bytes.size() - start)
      view.fail("it reaches beyond its buffer of " + std::to_string(bytes.size()) +
                " bytes; the file is damaged");
    if (offset > length || size > length - offset ||
        (count - 1) > (length - offset - size) / stride)
      accessor_.fail("its " + std::to_string(count) + " elements reach beyond the " +
                     std::to_string(length) + " bytes of their buffer view; the file is damaged");
    return bytes.data() + start + offset;
  }

  /// Replaces the elements that `sparse` lists.
  void substitute(std::vector<double>& values) {
    const JsonItem sparse = accessor_.at("sparse");
    file_.check_extensions(sparse);
    const std::uint64_t n = sparse.at("count").integer();
    if (n == 0 || n > count_)
      sparse.fail("its count is not between 1 and the accessor's; the file is damaged");
    const JsonItem indices = sparse.at("indices"), other = sparse.at("values");
    file_.check_extensions(indices);
    file_.check_extensions(other);
    const auto type = static_cast<Component>(indices.at("componentType").integer());
    if (type != Component::UInt8 && type != Component::UInt16 && type != Component::UInt32)
      indices.fail("its component type is none of unsigned integers; the file is damaged");
    const std::size_t size = size_of(type), element = width_ * size_of(type_);
    const char* index =
        data(indices.at("bufferView"), indices.integer_or("byteOffset", 0), n, size, size);
    const char* value =
        data(other.at("bufferView"), other.integer_or("byteOffset", 0), n, element, element);
    double last = -1;
    for (std::uint64_t i = 0; i < n; ++i, index += size, value += element) {
      const double to = load_component(index, type);
      if (to <= last || to >= static_cast<double>(count_))
        indices.fail("its indices do not rise below the accessor's count; the file is damaged");
      last = to;
      for (std::size_t k = 0; k < width_; ++k)
        values[static_cast<std::size_t>(to) * width_ + k] =
            load_component(value + k * size_of(type_), type_);
    }
  }

  /// What the file says of its values must be so, or this program does not understand the file.
  void check_bounds(const std::vector<double>& values) const {
    for (std::size_t i = 0; i < values.size(); ++i)
      if (!std::isfinite(values[i]))
        accessor_.fail("element " + std::to_string(i / width_) +
                       " is not finite; remove or repair this vertex");
    for (const bool lowest : {true, false}) {
      const char* const key = lowest ? "min" : "max";
      if (!accessor_.has(key)) continue;
      const std::vector<double> stated = accessor_.at(key).numbers(width_);
      for (std::size_t k = 0; k < width_; ++k) {
        double found = values[k];
        for (std::size_t i = k; i < values.size(); i += width_)
          found = lowest ? std::min(found, values[i]) : std::max(found, values[i]);
        if (rounded(stated[k]) != found)
          accessor_.fail(std::string("its ") + key + " states " + shown(stated[k]) +
                         " where the data has " + shown(found) +
                         "; it is damaged or written by a faulty program, export it again");
      }
    }
  }

  [[nodiscard]] double rounded(double stated) const {
    const bool narrow = std::abs(stated) <= double{std::numeric_limits<float>::max()};
    return type_ == Component::Float32 && narrow ? double{static_cast<float>(stated)} : stated;
  }

  GltfFile& file_;
  JsonItem accessor_;
  std::size_t width_;
  Component type_{};
  bool normalised_ = false;
  std::uint64_t count_ = 0;
};

}  // namespace

AccessorValues read_vectors(GltfFile& file, const JsonItem& index, const char* shape,
                            std::span<const Component> integers) {
  AccessorReader reader(file, index, shape, shape == std::string_view("VEC3") ? 3 : 4);
  const Component type = reader.type();
  const bool floats = type == Component::Float32;
  if (!floats && std::ranges::find(integers, type) == integers.end())
    reader.accessor().fail("component type " + std::to_string(static_cast<int>(type)) +
                           " is not allowed here, or only with an extension that the file does "
                           "not name (KHR_mesh_quantization); export the file again");
  if (floats && reader.normalised())
    reader.accessor().fail("floats are called normalised; the file is damaged");
  AccessorValues result{reader.read(true), reader.count(), !reader.normalised()};
  if (reader.normalised()) {
    const double unit = unit_of(type);
    for (double& x : result.values) x = std::max(x / unit, -1.0);
  }
  return result;
}

std::vector<std::uint32_t> read_indices(GltfFile& file, const JsonItem& index,
                                        std::size_t vertices) {
  AccessorReader reader(file, index, "SCALAR", 1);
  const Component type = reader.type();
  if ((type != Component::UInt8 && type != Component::UInt16 && type != Component::UInt32) ||
      reader.normalised())
    reader.accessor().fail("vertex indices are not unsigned integers; the file is damaged");
  // The largest number of the type would restart a strip; glTF does not have that.
  const double none = std::exp2(8 * static_cast<double>(size_of(type))) - 1;
  std::vector<std::uint32_t> indices;
  const std::vector<double> values = reader.read(false);
  indices.reserve(values.size());
  for (const double x : values) {
    if (x >= static_cast<double>(vertices) || x == none)
      reader.accessor().fail("it refers to vertex " + shown(x) + ", but there are " +
                             std::to_string(vertices) + "; the file is damaged");
    indices.push_back(static_cast<std::uint32_t>(x));
  }
  return indices;
}

}  // namespace kaboum::io
