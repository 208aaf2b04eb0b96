#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace kaboum::bmesh {

/// Priority queue of edges with approximate order: keys are told apart by the top 16 bits of their
/// float32 representation (eight of exponent, seven of mantissa: within 0.8 %), first in, last out
/// within a bucket. Push and pop cost O(1); order depends on nothing but the calls.
class BucketQueue {
 public:
  struct Entry {
    std::uint32_t a = 0, b = 0;  ///< end points
    std::uint32_t stamps = 0;    ///< sum of their stamps when the entry was made
    /// What the key was measured for: sum of the changes around the end points until then.
    std::uint32_t measured = ~0U;
  };

  BucketQueue() : heads_(kBuckets, kNone) {}

  /// @param key  ≥ 0; NaN counts as infinite.
  void push(double key, const Entry& entry) {
    const std::uint32_t bucket = bucket_of(key);
    std::uint32_t node = free_;
    if (node == kNone) {
      node = static_cast<std::uint32_t>(nodes_.size());
      nodes_.emplace_back();
    } else {
      free_ = nodes_[node].next;
    }
    nodes_[node] = {entry, heads_[bucket]};
    heads_[bucket] = node;
    if (bucket < lowest_) lowest_ = bucket;
    ++size_;
  }

  /// Moves an entry of the lowest bucket to `entry`; false when empty.
  bool pop(Entry& entry) {
    while (lowest_ < kBuckets && heads_[lowest_] == kNone) ++lowest_;
    if (lowest_ == kBuckets) return false;
    const std::uint32_t node = heads_[lowest_];
    entry = nodes_[node].entry;
    heads_[lowest_] = nodes_[node].next;
    nodes_[node].next = free_;
    free_ = node;
    --size_;
    return true;
  }

  /// Whether an entry with this key would be popped no later than the one popped last.
  [[nodiscard]] bool due(double key) const { return bucket_of(key) <= lowest_; }

  /// Upper end of the keys in the bucket popped last.
  [[nodiscard]] double lowest_key() const {
    return static_cast<double>(std::bit_cast<float>((lowest_ << 16) | 0xFFFFU));
  }

  [[nodiscard]] std::size_t size() const { return size_; }
  /// As new.
  void clear() {
    if (!nodes_.empty()) *this = BucketQueue();
  }
  void reserve(std::size_t n) { nodes_.reserve(n); }

  /// Drops the entries for which stale(entry) holds; the others keep their order.
  template <class Stale>
  void purge(Stale&& stale) {
    for (std::uint32_t& head : heads_) {
      std::uint32_t* link = &head;
      while (*link != kNone) {
        const std::uint32_t node = *link;
        if (!stale(nodes_[node].entry)) {
          link = &nodes_[node].next;
          continue;
        }
        *link = nodes_[node].next;
        nodes_[node].next = free_;
        free_ = node;
        --size_;
      }
    }
  }

 private:
  static constexpr std::uint32_t kNone = ~0U;
  struct Node {
    Entry entry;
    std::uint32_t next = kNone;
  };
  static constexpr std::uint32_t kBuckets = 0x7F81;  // up to and including +infinity

  static std::uint32_t bucket_of(double key) {
    if (!(key > 0)) return key <= 0 ? 0 : kBuckets - 1;
    return std::bit_cast<std::uint32_t>(static_cast<float>(key)) >> 16;
  }

  std::vector<std::uint32_t> heads_;
  std::vector<Node> nodes_;
  std::uint32_t free_ = kNone;
  std::uint32_t lowest_ = kBuckets;
  std::size_t size_ = 0;
};

}  // namespace kaboum::bmesh
