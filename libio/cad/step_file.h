#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

/// The entities of a STEP file (ISO 10303-21), read from its text by ourselves.
namespace kaboum::io {

struct StepToken {
  enum Kind : char {
    Reference = '#',
    Open = '(',
    Close = ')',
    Omitted = '$',
    Derived = '*',
    Value = 'v'
  } kind;
  std::int64_t id = 0;  ///< of a reference; of a value where it is in the text
};

/// A part of an entity: a type and its parameters. Most entities have one.
struct StepRecord {
  std::string_view name;           ///< in capital letters
  std::size_t begin = 0, end = 0;  ///< its parameters among the file's tokens
};

struct StepEntity {
  std::int64_t id = 0;
  std::vector<StepRecord> records;
};

class StepFile {
 public:
  /// @throws std::runtime_error where the text is no exchange structure, naming the place.
  explicit StepFile(std::string text);
  StepFile(const StepFile&) = delete;
  StepFile& operator=(const StepFile&) = delete;

  [[nodiscard]] const std::vector<StepEntity>& entities() const { return entities_; }
  /// Number among entities(), or npos.
  [[nodiscard]] std::size_t find(std::int64_t id) const;
  /// Numbers of the entities that one refers to, in order, each as often as it does.
  [[nodiscard]] std::vector<std::size_t> references(const StepEntity& entity) const;
  /// The i-th parameter of a record, or the bracket that closes it; null where there are fewer.
  [[nodiscard]] const StepToken* parameter(const StepRecord& record, std::size_t i) const;
  /// A value as it is written: ".MILLI.". Empty for other tokens.
  [[nodiscard]] std::string_view word(const StepToken& token) const;
  /// Nothing where the token is no number.
  [[nodiscard]] std::optional<double> number(const StepToken& token) const;
  /// All numbers of a record, those of lists too.
  [[nodiscard]] std::vector<double> numbers(const StepRecord& record) const;
  /// The entity that the i-th parameter of a record refers to, or npos.
  [[nodiscard]] std::size_t argument(const StepRecord& record, std::size_t i) const;
  [[nodiscard]] const std::vector<StepToken>& tokens() const { return tokens_; }

  static constexpr std::size_t npos = static_cast<std::size_t>(-1);

 private:
  std::string text_;
  std::vector<StepToken> tokens_;
  std::vector<StepEntity> entities_;
  std::unordered_map<std::int64_t, std::size_t> number_;
};

/// The record of that type, or null.
const StepRecord* record_of(const StepEntity& entity, std::string_view name);
/// Refuses what OpenCASCADE places elsewhere than the file says.
///
/// @throws std::runtime_error naming operators that mirror or scale, transformations between
///   placements neither of which is the origin, placements that lack a direction that they need.
void check_placements(const StepFile& file);
/// Refuses units of a representation's context that OpenCASCADE does not understand.
///
/// @throws std::runtime_error naming the context or the unit.
void check_units(const StepFile& file, const StepEntity& representation);
/// "#12 ADVANCED_FACE".
std::string named(const StepEntity& entity);

}  // namespace kaboum::io
