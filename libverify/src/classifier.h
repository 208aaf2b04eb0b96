#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "contacts.h"

// Pairs of triangles, classified by exact signs. docs/algorithms/exact-inclusion.md, "Pairs".
namespace kaboum::verify {

using Sides = std::array<Sign, 3>;

inline bool all(const Sides& s, Sign sign) { return s[0] == sign && s[1] == sign && s[2] == sign; }

/// Side of d with respect to the plane through a, b, c where rounded numbers tell, as
/// geom::orient3d has it.
inline std::optional<Sign> certain_side(const Vec3& a, const Vec3& b, const Vec3& c,
                                        const Vec3& d) {
  const auto [det, permanent, extent] = geom::detail::orient3d_filtered(a, b, c, d);
  if (!(permanent > 1e-200) || !(permanent < 1e300) || !(extent < 1e100)) return std::nullopt;
  if (det > 1e-15 * permanent) return Sign::Positive;
  if (det < -1e-15 * permanent) return Sign::Negative;
  return std::nullopt;
}

/// What one task finds; X is the chain of the first face of a pair.
struct FoundContacts {
  std::vector<Contacts::Cut> cuts;
  std::vector<Contacts::Along> alongs;
};

/// On which side of a face's plane a vertex is.
struct KnownSide {
  std::uint32_t vertex = 0xFFFFFFFF, face = 0xFFFFFFFF;
  Sign side = Sign::Zero;
};
/// Those that were found last.
using KnownSides = std::array<KnownSide, 256>;

/// Classifies pairs of faces.
/// @tparam Meshes  has face(f), point(vertex) and side(f, point), as MeshPair.
template <class Meshes>
class Classifier {
 public:
  /// @param known  of one classifier at a time, for those that are asked of many pairs
  Classifier(const Meshes& meshes, FoundContacts& of_first, FoundContacts& of_second,
             KnownSides* known = nullptr)
      : meshes_(meshes), first_(of_first), second_(of_second), known_(known) {}

  void operator()(std::uint32_t fi, std::uint32_t gi) {
    const Face &f = meshes_.face(fi), &g = meshes_.face(gi);
    int common = 0;
    for (const std::uint32_t v : f.v) common += static_cast<int>(g.place_of(v) >= 0);
    if (common == 3) return;  // the same triangle: contains and is contained
    if (common == 2) {
      // An edge in common, and nothing else unless they lie on each other.
      int k = 0;
      while (f.place_of(g.v[k]) >= 0) ++k;
      if (meshes_.side(fi, meshes_.point(g.v[k])) == Sign::Zero) coplanar(fi, gi);
      return;
    }
    Sides sf;
    if (!certain_sides(f, g, sf)) {
      // Next to g's plane: most such pairs lie in one plane, side by side.
      if (certainly_apart(f, g) || certainly_apart(g, f)) return;
      sf = exact_sides(f, gi);
    }
    if (all(sf, Sign::Positive) || all(sf, Sign::Negative)) return;
    if (all(sf, Sign::Zero)) return coplanar(fi, gi);
    const Crossing cf = crossing(f, sf);
    if (!cf.exists) return;
    const Crossing cg = crossing(g, sides_of(meshes_, g, fi));
    if (!cg.exists) return;

    std::array<std::array<int, 2>, 2> order{};
    bool before = false, behind = false;
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        order[i][j] = to_int(order_of(meshes_, cf.ends[i], cg.ends[j]));
        before |= order[i][j] < 0;
        behind |= order[i][j] > 0;
      }
    }
    if (!before || !behind) return;  // at most a point in common
    if (cf.edge < 0) {
      first_.cuts.push_back({fi, gi, false});
    } else {
      const bool whole = order[0][0] * order[0][1] <= 0 && order[1][0] * order[1][1] <= 0;
      first_.alongs.push_back({fi, gi, static_cast<std::uint8_t>(cf.edge), whole});
    }
    if (cg.edge < 0) {
      second_.cuts.push_back({gi, fi, false});
    } else {
      const bool whole = order[0][0] * order[1][0] <= 0 && order[0][1] * order[1][1] <= 0;
      second_.alongs.push_back({gi, fi, static_cast<std::uint8_t>(cg.edge), whole});
    }
  }

 private:
  /// Sides of f's corners with respect to g's plane, as sides_of has them, where rounded numbers
  /// tell those of all that g has not.
  [[nodiscard]] bool certain_sides(const Face& f, const Face& g, Sides& sides) const {
    const Vec3 &a = meshes_.point(g.v[0]), &b = meshes_.point(g.v[1]), &c = meshes_.point(g.v[2]);
    for (int k = 0; k < 3; ++k) {
      sides[k] = Sign::Zero;
      if (g.place_of(f.v[k]) >= 0) continue;
      const std::optional<Sign> sign = certain_side(a, b, c, meshes_.point(f.v[k]));
      if (!sign) return false;
      sides[k] = *sign;
    }
    return true;
  }

  /// Sides of f's corners with respect to g's plane, as sides_of has them. The same corners are
  /// asked for again soon, with the faces next to f.
  [[nodiscard]] Sides exact_sides(const Face& f, std::uint32_t gi) {
    if (known_ == nullptr) return sides_of(meshes_, f, gi);
    const Face& g = meshes_.face(gi);
    Sides sides;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = f.v[k];
      sides[k] = Sign::Zero;
      if (g.place_of(v) >= 0) continue;
      KnownSide& known = (*known_)[(v ^ (gi * 0x9E3779B1U)) % known_->size()];
      if (known.vertex != v || known.face != gi)
        known = {v, gi, meshes_.side(gi, meshes_.point(v))};
      sides[k] = known.side;
    }
    return sides;
  }

  /// Whether rounded numbers show that f, seen along g's axis, is beyond an edge of g but for a
  /// corner that both have: they then have nothing else in common.
  [[nodiscard]] bool certainly_apart(const Face& f, const Face& g) const {
    const int u = (g.axis + 1) % 3, v = (g.axis + 2) % 3;
    const double inside = g.upward ? 1 : -1;
    for (int e = 0; e < 3; ++e) {
      const Vec3 &a = meshes_.point(g.v[e]), &b = meshes_.point(g.v[(e + 1) % 3]);
      const auto beyond = [&](std::uint32_t w) {
        if (w == g.v[e] || w == g.v[(e + 1) % 3]) return true;
        const Vec3& p = meshes_.point(w);
        const double l = (a[u] - p[u]) * (b[v] - p[v]), r = (a[v] - p[v]) * (b[u] - p[u]);
        const double size = std::abs(l) + std::abs(r);
        // As geom::orient2d bounds it.
        return size > 1e-280 && size < 1e300 && inside * (l - r) < -4.5e-16 * size;
      };
      if (beyond(f.v[0]) && beyond(f.v[1]) && beyond(f.v[2])) return true;
    }
    return false;
  }

  /// Side of g's corners with respect to f's edges, positive inside, in f's projection.
  [[nodiscard]] std::array<Sides, 3> edge_sides(const Face& f, const Face& g, int axis,
                                                bool f_upward) const {
    std::array<Sides, 3> result;
    for (int e = 0; e < 3; ++e) {
      const std::uint32_t a = f.v[e], b = f.v[(e + 1) % 3];
      for (int k = 0; k < 3; ++k) {
        Sign s = Sign::Zero;
        if (g.v[k] != a && g.v[k] != b) {
          s = orient2d(axis, meshes_.point(a), meshes_.point(b), meshes_.point(g.v[k]));
        }
        result[e][k] = f_upward ? s : opposite(s);
      }
    }
    return result;
  }

  static bool separates(const std::array<Sides, 3>& sides) {
    return std::any_of(sides.begin(), sides.end(), [](const Sides& s) {
      return std::none_of(s.begin(), s.end(), [](Sign x) { return x == Sign::Positive; });
    });
  }
  static bool contains(const std::array<Sides, 3>& sides) {
    return std::all_of(sides.begin(), sides.end(), [](const Sides& s) {
      return std::none_of(s.begin(), s.end(), [](Sign x) { return x == Sign::Negative; });
    });
  }

  void coplanar(std::uint32_t fi, std::uint32_t gi) {
    const Face &f = meshes_.face(fi), &g = meshes_.face(gi);
    const int axis = f.axis;
    const bool g_upward = g.axis == axis
                              ? g.upward
                              : orient2d(axis, meshes_.point(g.v[0]), meshes_.point(g.v[1]),
                                         meshes_.point(g.v[2])) == Sign::Positive;
    const std::array<Sides, 3> g_in_f = edge_sides(f, g, axis, f.upward);
    std::array<Sides, 3> f_in_g;
    const bool apart = separates(g_in_f) || separates(f_in_g = edge_sides(g, f, axis, g_upward));
    if (apart) {
      // Side by side: their edges may lie along each other.
      for (int i = 0; i < 3; ++i) {
        for (int j = 0; j < 3; ++j) {
          if (g_in_f[i][j] != Sign::Zero || g_in_f[i][(j + 1) % 3] != Sign::Zero) continue;
          along(fi, i, gi, j);
        }
      }
      return;
    }
    covered(first_, fi, gi, contains(f_in_g));
    covered(second_, gi, fi, contains(g_in_f));
  }

  /// f and g overlap in an area, all of f if `whole`.
  void covered(FoundContacts& found, std::uint32_t fi, std::uint32_t gi, bool whole) const {
    if (!whole) {
      found.cuts.push_back({fi, gi, true});
      return;
    }
    const Face &f = meshes_.face(fi), &g = meshes_.face(gi);
    for (int e = 0; e < 3; ++e) {
      if (g.place_of(f.v[e]) >= 0 && g.place_of(f.v[(e + 1) % 3]) >= 0) continue;
      found.alongs.push_back({fi, gi, static_cast<std::uint8_t>(e), true, true});
    }
  }

  /// Edge i of f and edge j of g lie on one line.
  void along(std::uint32_t fi, int i, std::uint32_t gi, int j) {
    const Face &f = meshes_.face(fi), &g = meshes_.face(gi);
    std::uint32_t a = f.v[i], b = f.v[(i + 1) % 3], c = g.v[j], d = g.v[(j + 1) % 3];
    if ((a == c && b == d) || (a == d && b == c)) return;  // the same edge
    // Along a line, lexicographic order of points is the order on the line.
    const auto less = [&](std::uint32_t p, std::uint32_t q) {
      const Vec3 &x = meshes_.point(p), &y = meshes_.point(q);
      return std::lexicographical_compare(x.data(), x.data() + 3, y.data(), y.data() + 3);
    };
    if (less(b, a)) std::swap(a, b);
    if (less(d, c)) std::swap(c, d);
    if (!less(a, d) || !less(c, b)) return;  // apart, or an end point in common
    first_.alongs.push_back({fi, gi, static_cast<std::uint8_t>(i), !less(a, c) && !less(d, b)});
    second_.alongs.push_back({gi, fi, static_cast<std::uint8_t>(j), !less(c, a) && !less(b, d)});
  }

  const Meshes& meshes_;
  FoundContacts& first_;
  FoundContacts& second_;
  KnownSides* known_;
};

}  // namespace kaboum::verify
