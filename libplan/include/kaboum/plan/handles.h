#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace kaboum::plan {

/// Words that come into being during a search: values of handle types, such as configurations and
/// poses. Each word of a type is one number, the first of them follows the model's objects; both
/// directions take constant time. Beside its letters a word takes 12 to 18 bytes.
class HandleTable {
 public:
  explicit HandleTable(std::uint32_t objects) : first_(objects), table_(64, kEmpty) {}

  /// The number of a word; a new one, if it is new.
  /// @throws Error{LimitReached} beyond 2^30 words, or types.
  std::uint32_t intern(std::uint32_t type, std::string_view word);

  /// Valid until the next `intern`. @pre a number that `intern` gave.
  [[nodiscard]] std::string_view word(std::uint32_t number) const;

  [[nodiscard]] std::uint32_t first() const { return first_; }
  [[nodiscard]] std::size_t size() const { return ends_.size(); }
  [[nodiscard]] std::size_t bytes() const {
    return letters_.capacity() + ends_.capacity() * 4 + types_.capacity() * 2 + table_.size() * 4;
  }

 private:
  static constexpr std::uint32_t kEmpty = ~std::uint32_t{0};

  [[nodiscard]] std::size_t slot(std::uint32_t type, std::string_view word) const;

  std::uint32_t first_;
  std::vector<char> letters_;         ///< all words, one after another
  std::vector<std::uint32_t> ends_;   ///< where each ends
  std::vector<std::uint16_t> types_;  ///< of each
  std::vector<std::uint32_t> table_;  ///< open addressing
};

}  // namespace kaboum::plan
