// Contacts of triangles, found by exact signs on the pairs whose boxes meet.
// docs/algorithms/exact-inclusion.md, "Pairs".
#include "contacts.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <atomic>

#include "parallel.h"
#include "parallel_sort.h"

namespace kaboum::verify {
namespace {

using Sides = std::array<Sign, 3>;

bool all(const Sides& s, Sign sign) { return s[0] == sign && s[1] == sign && s[2] == sign; }

/// What one task finds; X is the chain of the first face of a pair.
struct FoundContacts {
  std::vector<Contacts::Cut> cuts;
  std::vector<Contacts::Along> alongs;
};

/// Classifies pairs of faces.
class Classifier {
 public:
  Classifier(const MeshPair& meshes, FoundContacts& of_first, FoundContacts& of_second)
      : meshes_(meshes), first_(of_first), second_(of_second) {}

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
    const Sides sf = sides_of(meshes_, f, gi);
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
    const bool g_upward = orient2d(axis, meshes_.point(g.v[0]), meshes_.point(g.v[1]),
                                   meshes_.point(g.v[2])) == Sign::Positive;
    const std::array<Sides, 3> g_in_f = edge_sides(f, g, axis, f.upward);
    const std::array<Sides, 3> f_in_g = edge_sides(g, f, axis, g_upward);
    if (separates(g_in_f) || separates(f_in_g)) {
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
      found.alongs.push_back({fi, gi, static_cast<std::uint8_t>(e), true});
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

  const MeshPair& meshes_;
  FoundContacts& first_;
  FoundContacts& second_;
};

constexpr std::size_t kTasks = 256;

void append(FoundContacts& all, FoundContacts&& part) {
  all.cuts.insert(all.cuts.end(), part.cuts.begin(), part.cuts.end());
  all.alongs.insert(all.alongs.end(), part.alongs.begin(), part.alongs.end());
  part = {};
}

/// Keeps all tasks together within the limits.
class Counter {
 public:
  explicit Counter(const ContactLimits& limits) : limits_(limits) {}

  /// One task's share, told to the others now and then.
  class Task {
   public:
    explicit Task(Counter& counter) : counter_(counter) {}
    void looked_at(const FoundContacts& a, const FoundContacts& b) {
      if (++pairs_ < kSharedEvery) return;
      share(a, b);
    }
    void share(const FoundContacts& a, const FoundContacts& b) {
      const std::size_t now = a.cuts.size() + a.alongs.size() + b.cuts.size() + b.alongs.size();
      counter_.add(now - contacts_, pairs_);
      contacts_ = now;
      pairs_ = 0;
    }

   private:
    static constexpr std::size_t kSharedEvery = 4096;
    Counter& counter_;
    std::size_t contacts_ = 0, pairs_ = 0;
  };

 private:
  void add(std::size_t contacts, std::size_t pairs) {
    if (limits_.looked_at != nullptr) *limits_.looked_at += pairs;
    if ((contacts_ += contacts) > limits_.contacts || (pairs_ += pairs) > limits_.pairs) {
      throw Error(ErrorCode::LimitReached, "more contacts between triangles than allowed");
    }
  }
  ContactLimits limits_;
  std::atomic<std::size_t> contacts_ = 0, pairs_ = 0;
};

}  // namespace

Contacts::Contacts(std::uint32_t begin, std::uint32_t end, std::vector<Cut> cuts,
                   std::vector<Along> alongs)
    : begin_(begin), cuts_(std::move(cuts)), alongs_(std::move(alongs)) {
  verify::sort_in_parallel(cuts_.begin(), cuts_.end(), [](const Cut& a, const Cut& b) {
    return a.face != b.face ? a.face < b.face : a.by < b.by;
  });
  verify::sort_in_parallel(alongs_.begin(), alongs_.end(), [](const Along& a, const Along& b) {
    if (a.face != b.face) return a.face < b.face;
    return a.on != b.on ? a.on < b.on : a.edge < b.edge;
  });
  const auto index = [&](const auto& entries) {
    std::vector<std::uint32_t> first(end - begin + 1, 0);
    for (const auto& entry : entries) ++first[entry.face - begin + 1];
    for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    return first;
  };
  first_cut_ = index(cuts_);
  first_along_ = index(alongs_);
}

std::array<Sign, 3> sides_of(const MeshPair& meshes, const Face& f, std::uint32_t g) {
  std::array<Sign, 3> sides;
  for (int k = 0; k < 3; ++k) {
    sides[k] =
        meshes.face(g).place_of(f.v[k]) >= 0 ? Sign::Zero : meshes.side(g, meshes.point(f.v[k]));
  }
  return sides;
}

Crossing crossing(const Face& f, const std::array<Sign, 3>& sides) {
  Crossing result;
  const auto ends = [&](int i, int j, bool i_above) {
    return i_above ? Crossing::End{f.v[i], f.v[j]} : Crossing::End{f.v[j], f.v[i]};
  };
  const auto zeros = std::count(sides.begin(), sides.end(), Sign::Zero);
  for (int k = 0; k < 3; ++k) {
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    if (zeros == 0 && sides[i] == sides[j] && sides[k] != sides[i]) {
      const bool above = sides[k] == Sign::Positive;
      result.ends = {ends(k, i, above), ends(k, j, above)};
      result.exists = true;
    } else if (zeros == 1 && sides[k] == Sign::Zero && sides[i] != sides[j]) {
      const int p = sides[i] == Sign::Positive ? i : j, n = i + j - p;
      result.ends = {Crossing::End{f.v[p], f.v[n]}, Crossing::End{f.v[p], f.v[k]}};
      result.exists = true;
    } else if (zeros == 2 && sides[k] != Sign::Zero) {
      const bool above = sides[k] == Sign::Positive;
      result.ends = {ends(k, i, above), ends(k, j, above)};
      result.edge = i;
      result.exists = true;
    }
  }
  return result;
}

Sign order_of(const MeshPair& meshes, const Crossing::End& p, const Crossing::End& q) {
  if (p.from == q.from || p.from == q.to || p.to == q.from || p.to == q.to) return Sign::Zero;
  return geom::orient3d(meshes.point(p.from), meshes.point(p.to), meshes.point(q.from),
                        meshes.point(q.to));
}

MutualContacts contacts_between(const MeshPair& meshes, const ContactLimits& limits) {
  const BoxTree &inside = meshes.tree(kInside), &outside = meshes.tree(kOutside);
  const std::vector<std::uint32_t> roots = subtrees(inside, kTasks);
  std::vector<FoundContacts> first(roots.size()), second(roots.size());
  Counter counter(limits);
  verify::parallel_for(std::size_t{0}, roots.size(), [&](std::size_t i) {
    Classifier classify(meshes, first[i], second[i]);
    Counter::Task task(counter);
    meeting_pairs(inside, roots[i], outside, [&](std::uint32_t f, std::uint32_t g) {
      classify(f, g);
      task.looked_at(first[i], second[i]);
    });
    task.share(first[i], second[i]);
  });
  FoundContacts of_inside, of_outside;
  for (std::size_t i = 0; i < roots.size(); ++i) {
    append(of_inside, std::move(first[i]));
    append(of_outside, std::move(second[i]));
  }
  return {Contacts(meshes.begin(kInside), meshes.end(kInside), std::move(of_inside.cuts),
                   std::move(of_inside.alongs)),
          Contacts(meshes.begin(kOutside), meshes.end(kOutside), std::move(of_outside.cuts),
                   std::move(of_outside.alongs))};
}

Contacts contacts_within(const MeshPair& meshes, int chain, const ContactLimits& limits) {
  const BoxTree& tree = meshes.tree(chain);
  const std::vector<std::uint32_t> roots = subtrees(tree, kTasks);
  std::vector<FoundContacts> found(roots.size());
  Counter counter(limits);
  verify::parallel_for(std::size_t{0}, roots.size(), [&](std::size_t i) {
    Classifier classify(meshes, found[i], found[i]);
    Counter::Task task(counter);
    meeting_pairs(tree, roots[i], tree, [&](std::uint32_t f, std::uint32_t g) {
      if (f >= g) return;  // each pair once
      classify(f, g);
      task.looked_at(found[i], {});
    });
    task.share(found[i], {});
  });
  FoundContacts all_found;
  for (FoundContacts& part : found) append(all_found, std::move(part));
  return {meshes.begin(chain), meshes.end(chain), std::move(all_found.cuts),
          std::move(all_found.alongs)};
}

}  // namespace kaboum::verify
