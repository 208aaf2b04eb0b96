#pragma once

#include <kaboum/base/error.h>
#include <kaboum/bmesh/log.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace kaboum::bmesh {

/// FNV-1a: no change of a single byte keeps it, and of 2^64 others one does.
inline std::uint64_t checksum_of(std::span<const char> bytes) {
  std::uint64_t sum = 0xcbf29ce484222325;
  for (const char byte : bytes) sum = (sum ^ static_cast<unsigned char>(byte)) * 0x100000001b3;
  return sum;
}

/// Appends little-endian numbers to bytes.
class Writer {
 public:
  template <class T>
  void number(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) std::reverse(bytes, bytes + sizeof(T));
    out.insert(out.end(), bytes, bytes + sizeof(T));
  }
  void text(const std::string& s) {
    number(static_cast<std::uint32_t>(s.size()));
    out.insert(out.end(), s.begin(), s.end());
  }
  void indices(const std::vector<std::uint32_t>& v) {
    number(static_cast<std::uint64_t>(v.size()));
    for (const std::uint32_t i : v) number(i);
  }
  void points(const std::vector<geom::Vec3>& v) {
    number(static_cast<std::uint64_t>(v.size()));
    for (const geom::Vec3& p : v)
      for (int k = 0; k < 3; ++k) number(p[k]);
  }
  void triangles(const std::vector<geom::Triangle>& v) {
    number(static_cast<std::uint64_t>(v.size()));
    for (const geom::Triangle& t : v)
      for (const std::uint32_t i : t) number(i);
  }
  /// Appends the checksum of all bytes so far.
  void checksum() { number(checksum_of(out)); }
  std::vector<char> out;
};

/// Reads them again; everything that does not fit is an Error{InvalidInput} naming the file.
class Reader {
 public:
  Reader(std::span<const char> bytes, const std::string& name) : bytes_(bytes), name_(name) {}

  template <class T>
  T number() {
    require(sizeof(T));
    char raw[sizeof(T)];
    std::memcpy(raw, bytes_.data() + at_, sizeof(T));
    if constexpr (std::endian::native == std::endian::big) std::reverse(raw, raw + sizeof(T));
    at_ += sizeof(T);
    T value;
    std::memcpy(&value, raw, sizeof(T));
    return value;
  }
  std::string text() {
    const auto n = number<std::uint32_t>();
    require(n);
    std::string s(bytes_.data() + at_, n);
    at_ += n;
    return s;
  }
  std::uint64_t count(std::size_t item_size) {
    const auto n = number<std::uint64_t>();
    if (n > (bytes_.size() - at_) / item_size) truncated();
    return n;
  }
  std::vector<std::uint32_t> indices() {
    std::vector<std::uint32_t> v(count(4));
    for (std::uint32_t& i : v) i = number<std::uint32_t>();
    return v;
  }
  std::vector<geom::Vec3> points() {
    std::vector<geom::Vec3> v(count(24));
    for (geom::Vec3& p : v) {
      for (int k = 0; k < 3; ++k) p[k] = number<double>();
      if (!p.allFinite()) fail("has a vertex that is not finite");
    }
    return v;
  }
  std::vector<geom::Triangle> triangles() {
    std::vector<geom::Triangle> v(count(12));
    for (geom::Triangle& t : v) {
      for (std::uint32_t& i : t) i = number<std::uint32_t>();
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0])
        fail("has a triangle without three corners");
    }
    return v;
  }
  /// Versions that can no longer be read.
  void refuse_earlier(const std::string& kind, std::initializer_list<const char*> versions,
                      const char* what) const {
    for (const char* version : versions)
      if (std::string_view(bytes_.data(), bytes_.size()).starts_with(kind + version + "\n"))
        fail(std::string("is ") + what + " of an earlier version (" + version + "); make it again");
  }
  /// The bytes that a file of this kind begins with.
  void magic(std::string_view expected, const std::string& what) {
    if (!std::string_view(bytes_.data(), bytes_.size()).starts_with(expected))
      fail("is not " + what + " (it does not begin with \"" +
           std::string(expected.substr(0, expected.size() - 1)) + "\")");
    at_ = expected.size();
  }
  /// Whether the last eight bytes are the checksum of those before; they are left out from now on.
  void checksum() {
    const std::size_t size = bytes_.size() < at_ + 8 ? at_ : bytes_.size() - 8;
    Reader last(bytes_.subspan(size), name_);
    const std::span<const char> sealed = bytes_.first(size);
    if (bytes_.size() - size != 8 || last.number<std::uint64_t>() != checksum_of(sealed))
      fail("is damaged or truncated: its checksum is not that of its bytes");
    bytes_ = sealed;
  }
  void end() {
    if (at_ != bytes_.size()) fail("has bytes after its end, at byte " + std::to_string(at_));
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::InvalidInput, name_ + " " + what);
  }

 private:
  void require(std::size_t n) const {
    if (n > bytes_.size() - at_) truncated();
  }
  [[noreturn]] void truncated() const {
    fail("is truncated at byte " + std::to_string(bytes_.size()));
  }

  std::span<const char> bytes_;
  std::string name_;
  std::size_t at_ = 0;
};

/// The log without the bytes that a log file begins with; docs/formats.md.
void write_log(Writer& writer, const Log& log);
Log read_log(Reader& reader);

}  // namespace kaboum::bmesh
