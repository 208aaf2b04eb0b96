#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "source.h"

namespace kaboum::io {

/// A value of a glTF file's JSON together with its path ("nodes[3].mesh"), which every complaint
/// names. All access is checked. Internal to kaboum_io.
class JsonItem {
 public:
  using Json = nlohmann::json;

  JsonItem(const Source& source, const Json& json, std::string path)
      : source_(&source), json_(&json), path_(std::move(path)) {}

  [[nodiscard]] const Json& json() const { return *json_; }
  /// Throws Error{InvalidInput} "<file>: <path>: <what>".
  [[noreturn]] void fail(const std::string& what) const;

  /// Whether this object has the member.
  [[nodiscard]] bool has(const char* key) const;
  [[nodiscard]] JsonItem at(const char* key) const;     ///< fails when it is missing
  [[nodiscard]] JsonItem at(std::size_t index) const;   ///< of an array, index < size()
  [[nodiscard]] std::size_t size() const;               ///< of an array
  [[nodiscard]] std::vector<std::string> keys() const;  ///< of an object

  /// An integer from 0 to 2^53.
  [[nodiscard]] std::uint64_t integer() const;
  [[nodiscard]] std::uint64_t integer_or(const char* key, std::uint64_t otherwise) const;
  [[nodiscard]] double number() const;  ///< finite
  /// An array of that many numbers.
  [[nodiscard]] std::vector<double> numbers(std::size_t count) const;
  [[nodiscard]] std::string text() const;
  [[nodiscard]] bool truth() const;

 private:
  const Source* source_;
  const Json* json_;
  std::string path_;
};

/// A glTF 2.0 file (JSON or binary): its JSON, the bytes of its buffers, and a budget for the work
/// that it may cause. Refuses versions and required extensions that this program does not know.
class GltfFile {
 public:
  /// @throws Error{InvalidInput}
  explicit GltfFile(const Source& source);
  GltfFile(const GltfFile&) = delete;
  GltfFile& operator=(const GltfFile&) = delete;

  [[nodiscard]] const Source& source() const { return source_; }
  [[nodiscard]] JsonItem root() const { return {source_, json_, ""}; }
  /// The element of a top-level array that `index` refers to.
  [[nodiscard]] JsonItem element(const char* array, const JsonItem& index) const;
  [[nodiscard]] std::size_t count(const char* array) const;

  /// Refuses extensions of this object that may hold geometry and are not among `handled`.
  void check_extensions(const JsonItem& object,
                        std::initializer_list<std::string_view> handled = {}) const;
  /// Whether the file says that it uses the extension.
  [[nodiscard]] bool uses(std::string_view extension) const;

  /// The bytes of a buffer: from the binary part, a data URI, or a file below the source's folder.
  std::string_view buffer(const JsonItem& index);

  /// @throws Error{LimitReached} when the work, in numbers read or made, is out of proportion.
  void spend(std::uint64_t work);

  void note(std::string text) { notes_.push_back(std::move(text)); }
  /// All notes, those about the file's layout included.
  std::vector<std::string> take_notes();
  /// Files read besides this one, each once.
  [[nodiscard]] std::vector<std::string> other_files() const;

 private:
  void split_chunks();
  void parse(std::string_view text);
  void check_versions() const;
  void check_required_extensions() const;
  std::string_view from_uri(const JsonItem& uri);
  std::string_view from_file(const JsonItem& uri, const std::string& relative);

  Source source_;
  JsonItem::Json json_;
  std::optional<std::string_view> binary_;
  std::map<std::uint64_t, std::string_view> buffers_;
  std::vector<std::vector<char>> decoded_;
  std::map<std::filesystem::path, std::vector<char>> files_;
  std::uint64_t bytes_ = 0;  ///< read so far
  std::uint64_t work_ = 0;
  std::vector<std::string> notes_;
};

}  // namespace kaboum::io
