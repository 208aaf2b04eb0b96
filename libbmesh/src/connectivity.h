#pragma once

#include <kaboum/geom/mesh.h>

#include <vector>

namespace kaboum::bmesh {

/// Triangles around vertices under edge contraction, for any mesh: manifold or not, open or closed.
///
/// The corners (3·triangle + k) of each vertex form a circular list. A contraction costs time
/// proportional to the triangles it touches, and nothing is allocated.
class Connectivity {
 public:
  static constexpr std::uint32_t kNone = ~0U;

  Connectivity(std::size_t vertices, std::vector<geom::Triangle> triangles)
      : triangles_(std::move(triangles)), next_(3 * triangles_.size()), head_(vertices, kNone) {
    for (std::uint32_t t = 0; t < triangles_.size(); ++t)
      for (std::uint32_t k = 0; k < 3; ++k) insert(triangles_[t][k], 3 * t + k);
  }

  [[nodiscard]] const geom::Triangle& operator[](std::uint32_t t) const { return triangles_[t]; }
  [[nodiscard]] std::size_t size() const { return triangles_.size(); }
  [[nodiscard]] bool alive(std::uint32_t t) const { return triangles_[t][0] != kNone; }
  [[nodiscard]] bool used(std::uint32_t v) const { return head_[v] != kNone; }

  /// Calls visit(triangle, k) for each triangle of v, where v is the triangle's corner k.
  template <class Visit>
  void for_each_triangle(std::uint32_t v, Visit&& visit) const {
    const std::uint32_t first = head_[v];
    if (first == kNone) return;
    std::uint32_t c = first;
    do {
      const std::uint32_t next = next_[c];
      visit(c / 3, c % 3);
      c = next;
    } while (c != first);
  }

  /// Gives triangle t other corners.
  void replace(std::uint32_t t, const geom::Triangle& corners) {
    for (std::uint32_t k = 0; k < 3; ++k) remove(triangles_[t][k], 3 * t + k);
    triangles_[t] = corners;
    for (std::uint32_t k = 0; k < 3; ++k) insert(corners[k], 3 * t + k);
  }

  /// Gives triangle t, which may have vanished, the corners that it had at another time.
  void restore(std::uint32_t t, const geom::Triangle& corners) {
    if (triangles_[t] == corners) return;
    if (alive(t))
      for (std::uint32_t k = 0; k < 3; ++k) remove(triangles_[t][k], 3 * t + k);
    triangles_[t] = corners;
    for (std::uint32_t k = 0; k < 3; ++k) insert(corners[k], 3 * t + k);
  }

  /// Replaces `gone` by `kept` everywhere; triangles with both disappear.
  void contract(std::uint32_t kept, std::uint32_t gone) {
    std::uint32_t corners = detach(gone);
    while (corners != kNone) {
      const std::uint32_t c = corners;
      corners = next_[c];
      geom::Triangle& t = triangles_[c / 3];
      if (t[0] == kept || t[1] == kept || t[2] == kept) {
        for (std::uint32_t k = 0; k < 3; ++k)
          if (t[k] != gone) remove(t[k], 3 * (c / 3) + k);
        t[0] = kNone;
      } else {
        t[c % 3] = kept;
        insert(kept, c);
      }
    }
  }

 private:
  void insert(std::uint32_t v, std::uint32_t c) {
    if (head_[v] == kNone) {
      next_[c] = c;
    } else {
      next_[c] = next_[head_[v]];
      next_[head_[v]] = c;
    }
    head_[v] = c;
  }

  void remove(std::uint32_t v, std::uint32_t c) {
    std::uint32_t before = c;
    while (next_[before] != c) before = next_[before];
    if (before == c) {
      head_[v] = kNone;
      return;
    }
    next_[before] = next_[c];
    if (head_[v] == c) head_[v] = before;
  }

  /// Opens v's list into a chain ended by kNone and forgets it.
  std::uint32_t detach(std::uint32_t v) {
    const std::uint32_t last = head_[v];
    if (last == kNone) return kNone;
    const std::uint32_t first = next_[last];
    next_[last] = kNone;
    head_[v] = kNone;
    return first;
  }

  std::vector<geom::Triangle> triangles_;
  std::vector<std::uint32_t> next_;
  std::vector<std::uint32_t> head_;
};

}  // namespace kaboum::bmesh
