#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace kaboum::motion {

/// What is known of a motion.
enum class Known : std::uint8_t {
  NotFree,    ///< or so it looks
  Open,       ///< vector code says nothing of some of it
  LooksFree,  ///< nothing was found, and it is not certain
  Free,       ///< at every instant, for certain
};

/// Straight motions that a search has decided, by their exact ends.
class DecidedMotions {
 public:
  void clear() {
    // What a hard question needed is given back, so that easy ones do not pay for it.
    constexpr std::size_t kKept = 4096;
    if (slots_.size() > kKept) {
      *this = {};
      return;
    }
    values_.clear();
    known_.clear();
    slots_.assign(slots_.size(), 0);
  }

  /// What is known of a motion; null: nothing. It stays where it is until another one is added.
  [[nodiscard]] Known* find(std::span<const double> from, std::span<const double> to) {
    if (slots_.empty()) return nullptr;
    for (std::size_t at = hash(from, to) & (slots_.size() - 1);;
         at = (at + 1) & (slots_.size() - 1)) {
      if (slots_[at] == 0) return nullptr;
      const std::size_t i = slots_[at] - 1;
      const double* ends = values_.data() + 2 * i * from.size();
      if (std::memcmp(ends, from.data(), from.size_bytes()) == 0 &&
          std::memcmp(ends + from.size(), to.data(), to.size_bytes()) == 0)
        return &known_[i];
    }
  }

  /// @pre find of it gives nothing
  void add(std::span<const double> from, std::span<const double> to, Known known) {
    values_.insert(values_.end(), from.begin(), from.end());
    values_.insert(values_.end(), to.begin(), to.end());
    known_.push_back(known);
    if (2 * known_.size() > slots_.size()) {
      slots_.assign(slots_.empty() ? 256 : 2 * slots_.size(), 0);
      const std::size_t n = from.size();
      for (std::size_t i = 0; i < known_.size(); ++i)
        put(i, std::span(values_).subspan(2 * i * n, n),
            std::span(values_).subspan((2 * i + 1) * n, n));
      return;
    }
    put(known_.size() - 1, from, to);
  }

 private:
  static std::size_t hash(std::span<const double> from, std::span<const double> to) {
    std::uint64_t out = 0;
    for (const auto& end : {from, to})
      for (const double x : end) {
        std::uint64_t bits = 0;
        std::memcpy(&bits, &x, sizeof bits);
        out = (out ^ bits) * 0x9e3779b97f4a7c15U;
        out ^= out >> 29U;
      }
    return static_cast<std::size_t>(out);
  }
  void put(std::size_t i, std::span<const double> from, std::span<const double> to) {
    std::size_t at = hash(from, to) & (slots_.size() - 1);
    while (slots_[at] != 0) at = (at + 1) & (slots_.size() - 1);
    slots_[at] = static_cast<std::uint32_t>(i + 1);
  }

  std::vector<double> values_;        ///< ends, one motion after the other
  std::vector<Known> known_;          ///< of each
  std::vector<std::uint32_t> slots_;  ///< numbers, from 1; as many as a power of two
};

}  // namespace kaboum::motion
