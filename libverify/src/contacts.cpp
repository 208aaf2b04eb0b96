// Contacts of triangles, found by exact signs on the pairs whose boxes meet.
// docs/algorithms/exact-inclusion.md, "Pairs".
#include "contacts.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <atomic>

#include "classifier.h"
#include "graph_vertex.h"
#include "parallel.h"

namespace kaboum::verify {
namespace {

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

namespace {

/// Entries by their faces, each face's by `less`. @return where each face's begin.
template <class Entry, class Less>
std::vector<std::uint32_t> sort_by_face(std::uint32_t begin, std::uint32_t end,
                                        std::vector<Entry>& entries, const Less& less) {
  std::vector<std::uint32_t> first(end - begin + 1, 0);
  for (const Entry& entry : entries) ++first[entry.face - begin + 1];
  for (std::size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  std::vector<Entry> sorted(entries.size());
  for (const Entry& entry : entries) sorted[next[entry.face - begin]++] = entry;
  verify::parallel_for(begin, end, [&](std::uint32_t f) {
    const auto from = sorted.begin() + first[f - begin], to = sorted.begin() + first[f - begin + 1];
    if (to - from > 1) std::sort(from, to, less);
  });
  entries = std::move(sorted);
  return first;
}

}  // namespace

Contacts::Contacts(std::uint32_t begin, std::uint32_t end, std::vector<Cut> cuts,
                   std::vector<Along> alongs)
    : begin_(begin), cuts_(std::move(cuts)), alongs_(std::move(alongs)) {
  first_cut_ =
      sort_by_face(begin, end, cuts_, [](const Cut& a, const Cut& b) { return a.by < b.by; });
  first_along_ = sort_by_face(begin, end, alongs_, [](const Along& a, const Along& b) {
    return a.on != b.on ? a.on < b.on : a.edge < b.edge;
  });
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

MutualContacts contacts_between(const MeshPair& meshes, const ContactLimits& limits) {
  const BoxTree &inside = meshes.tree(kInside), &outside = meshes.tree(kOutside);
  const std::vector<std::uint32_t> roots = subtrees(inside, kTasks);
  std::vector<FoundContacts> first(roots.size()), second(roots.size());
  Counter counter(limits);
  verify::parallel_for(std::size_t{0}, roots.size(), [&](std::size_t i) {
    KnownSides known;
    Classifier classify(meshes, first[i], second[i], &known);
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

namespace {

/// Per vertex whether the chain's star there is a graph over a plane.
std::vector<char> graph_vertices(const MeshPair& meshes, int chain) {
  std::vector<char> graph(meshes.vertex_count(), 0);
  verify::parallel_ranges(graph.size(), [&](std::size_t begin, std::size_t end) {
    std::vector<Spoke> star;
    for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
      star.clear();
      for (const std::uint32_t f : meshes.around(v)) {
        const Face& face = meshes.face(f);
        if (face.chain != chain) continue;
        const int k = face.v[0] == v ? 0 : face.v[1] == v ? 1 : 2;
        star.push_back({face.v[(k + 1) % 3], face.v[(k + 2) % 3], f});
      }
      if (!is_one_fan(star)) continue;
      graph[v] = static_cast<char>(is_graph(
          star, meshes.point(v), [&](std::uint32_t f) { return meshes.face(f).directions; },
          [&](std::uint32_t w) -> const Vec3& { return meshes.point(w); }));
    }
  });
  return graph;
}

}  // namespace

Contacts contacts_within(const MeshPair& meshes, int chain, const ContactLimits& limits) {
  const BoxTree& tree = meshes.tree(chain);
  const std::vector<char> graph = graph_vertices(meshes, chain);
  // Parts of one graph have nothing in common but an edge or the vertex.
  const auto parts_of_graph = [&](const Face& f, const Face& g) {
    return std::any_of(f.v.begin(), f.v.end(),
                       [&](std::uint32_t v) { return g.place_of(v) >= 0 && graph[v] != 0; });
  };
  const std::vector<std::uint32_t> roots = subtrees(tree, kTasks);
  std::vector<FoundContacts> found(roots.size());
  Counter counter(limits);
  verify::parallel_for(std::size_t{0}, roots.size(), [&](std::size_t i) {
    KnownSides known;
    Classifier classify(meshes, found[i], found[i], &known);
    Counter::Task task(counter);
    meeting_pairs_within(tree, roots[i], [&](std::uint32_t f, std::uint32_t g) {
      if (!parts_of_graph(meshes.face(f), meshes.face(g))) classify(std::min(f, g), std::max(f, g));
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
