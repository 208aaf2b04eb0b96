// Triangles beside which a closed mesh's own winding number is not known to be 1 at least. Rounded
// tests tell most pairs of triangles apart, exact ones the rest. Triangles that nothing cuts are
// joined through vertices round which the surface is a graph over a plane, and one winding number
// tells of all that are joined. docs/algorithms/exact-inclusion.md, "Loose triangles".

#include <kaboum/verify/loose_triangles.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>

#include "classifier.h"
#include "graph_vertex.h"
#include "number.h"
#include "parallel.h"

namespace kaboum::verify {
namespace {

constexpr std::uint32_t kNone = 0xFFFFFFFF;

/// Four numbers that are compared at once; the last is 0.
using Lanes = float __attribute__((vector_size(16)));

/// A box of coordinates that a monotone map has rounded to float32: what met before meets after.
struct SmallBox {
  Lanes low, high;

  void include(const SmallBox& other) {
    low = low < other.low ? low : other.low;
    high = high > other.high ? high : other.high;
  }
  [[nodiscard]] bool meets(const SmallBox& other) const {
    const auto all =
        std::bit_cast<std::array<std::int64_t, 2>>((low <= other.high) & (other.low <= high));
    return (all[0] & all[1]) == -1;
  }
};

/// The mesh as the classifier sees it.
class Faces {
 public:
  explicit Faces(const geom::Mesh& mesh) : mesh_(mesh), faces_(mesh.triangles.size()) {}

  [[nodiscard]] const Face& face(std::uint32_t f) const { return faces_[f]; }
  [[nodiscard]] Face& face(std::uint32_t f) { return faces_[f]; }
  [[nodiscard]] const Vec3& point(std::uint32_t v) const { return mesh_.vertices[v]; }
  [[nodiscard]] const Vec3& corner(std::uint32_t f, int k) const { return point(faces_[f].v[k]); }
  [[nodiscard]] Sign side(std::uint32_t f, const Vec3& p) const {
    return geom::orient3d(corner(f, 0), corner(f, 1), corner(f, 2), p);
  }
  [[nodiscard]] std::uint32_t size() const { return static_cast<std::uint32_t>(faces_.size()); }
  [[nodiscard]] std::uint32_t vertices() const {
    return static_cast<std::uint32_t>(mesh_.vertices.size());
  }

 private:
  const geom::Mesh& mesh_;
  std::vector<Face> faces_;
};

/// Boxes of triangles in an order that keeps neighbours together, four to a leaf, and a binary
/// tree over these: level by level, each box that of two of the level below.
class BoxLevels {
 public:
  static constexpr std::uint32_t kLeaf = 4;

  BoxLevels(const Faces& faces, const geom::Mesh& mesh) {
    const geom::Box3 box = geom::bounding_box(mesh);
    const double extent = (box.max - box.min).maxCoeff();
    const double scale = extent > 0 ? 1 / extent : 1;
    // Subtraction, product and conversion are monotone in every rounding.
    std::vector<Lanes> points(mesh.vertices.size());
    for (std::size_t v = 0; v < points.size(); ++v) {
      const Vec3& p = mesh.vertices[v];
      points[v] = Lanes{static_cast<float>((p.x() - box.min.x()) * scale),
                        static_cast<float>((p.y() - box.min.y()) * scale),
                        static_cast<float>((p.z() - box.min.z()) * scale), 0};
    }
    low_ = box.min;
    scale_ = scale;
    for (std::uint32_t f = 0; f < faces.size(); ++f)
      if (faces.face(f).axis >= 0) items_.push_back(f);
    sort_items(faces, points);
    boxes_.resize(items_.size());
    for (std::size_t i = 0; i < items_.size(); ++i) {
      const auto& v = faces.face(items_[i]).v;
      const auto &a = points[v[0]], &b = points[v[1]], &c = points[v[2]];
      boxes_[i] = {a, a};
      boxes_[i].include({b, b});
      boxes_[i].include({c, c});
    }
    build();
  }

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(items_.size()); }
  [[nodiscard]] std::uint32_t item(std::uint32_t i) const { return items_[i]; }
  [[nodiscard]] const SmallBox& box(std::uint32_t i) const { return boxes_[i]; }
  [[nodiscard]] const std::vector<std::vector<SmallBox>>& levels() const { return levels_; }
  [[nodiscard]] float mapped(double x, int k) const {
    return static_cast<float>((x - low_[k]) * scale_);
  }

  /// visit(face) for those whose boxes satisfy `wanted`; so does every box round one that does.
  template <class Predicate, class Visit>
  void query(const Predicate& wanted, const Visit& visit) const {
    if (!levels_.empty()) query(levels_.size() - 1, 0, wanted, visit);
  }

 private:
  template <class Predicate, class Visit>
  void query(std::size_t level, std::uint32_t i, const Predicate& wanted,
             const Visit& visit) const {
    if (!wanted(levels_[level][i])) return;
    if (level > 0) {
      query(level - 1, 2 * i, wanted, visit);
      if (2 * i + 1 < levels_[level - 1].size()) query(level - 1, 2 * i + 1, wanted, visit);
      return;
    }
    const std::uint32_t end = std::min(count(), kLeaf * (i + 1));
    for (std::uint32_t k = kLeaf * i; k < end; ++k)
      if (wanted(boxes_[k])) visit(items_[k]);
  }

  struct Keyed {
    std::uint32_t key, face;
  };

  /// Interleaves ten bits of each coordinate.
  static std::uint32_t spread(std::uint32_t x) {
    x = (x | (x << 16U)) & 0x030000FFU;
    x = (x | (x << 8U)) & 0x0300F00FU;
    x = (x | (x << 4U)) & 0x030C30C3U;
    return (x | (x << 2U)) & 0x09249249U;
  }

  void sort_items(const Faces& faces, const std::vector<Lanes>& points) {
    std::vector<Keyed> keyed(items_.size()), other(items_.size());
    for (std::size_t i = 0; i < items_.size(); ++i) keyed[i].face = items_[i];
    sort_part(faces, points, keyed, other, 0, keyed.size(), 0);
    for (std::size_t i = 0; i < items_.size(); ++i) items_[i] = keyed[i].face;
  }

  /// Sorts along a curve that fills the part's box; what falls into one place, again in its own.
  static void sort_part(const Faces& faces, const std::vector<Lanes>& points,
                        std::vector<Keyed>& keyed, std::vector<Keyed>& other, std::size_t begin,
                        std::size_t end, int depth) {
    constexpr std::size_t kSame = 64;
    constexpr int kDeepest = 8;
    if (end - begin <= kLeaf) return;
    const auto sum = [&](std::uint32_t f, int k) {
      const auto& v = faces.face(f).v;
      return points[v[0]][k] + points[v[1]][k] + points[v[2]][k];
    };
    std::array<float, 3> low, high;
    low.fill(std::numeric_limits<float>::infinity());
    high.fill(-std::numeric_limits<float>::infinity());
    for (std::size_t i = begin; i < end; ++i)
      for (int k = 0; k < 3; ++k) {
        const float x = sum(keyed[i].face, k);
        low[k] = std::min(low[k], x);
        high[k] = std::max(high[k], x);
      }
    const float extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
    if (!(extent > 1e-30F)) return;
    const float scale = 1023 / extent;
    for (std::size_t i = begin; i < end; ++i) {
      std::uint32_t key = 0;
      for (int k = 0; k < 3; ++k)
        key |= spread(std::min(
                   1023U, static_cast<std::uint32_t>((sum(keyed[i].face, k) - low[k]) * scale)))
               << static_cast<unsigned>(k);
      keyed[i].key = key;
    }
    if (end - begin < 1024) {
      std::sort(keyed.begin() + static_cast<std::ptrdiff_t>(begin),
                keyed.begin() + static_cast<std::ptrdiff_t>(end),
                [](const Keyed& a, const Keyed& b) {
                  return a.key != b.key ? a.key < b.key : a.face < b.face;
                });
    } else {
      for (unsigned shift = 0; shift < 30; shift += 10) {
        std::array<std::size_t, 1025> first{};
        for (std::size_t i = begin; i < end; ++i) ++first[((keyed[i].key >> shift) & 1023U) + 1];
        for (std::size_t b = 1; b < first.size(); ++b) first[b] += first[b - 1];
        for (std::size_t i = begin; i < end; ++i)
          other[begin + first[(keyed[i].key >> shift) & 1023U]++] = keyed[i];
        std::copy(other.begin() + static_cast<std::ptrdiff_t>(begin),
                  other.begin() + static_cast<std::ptrdiff_t>(end),
                  keyed.begin() + static_cast<std::ptrdiff_t>(begin));
      }
    }
    if (depth == kDeepest) return;
    for (std::size_t i = begin; i < end;) {
      std::size_t j = i + 1;
      while (j < end && keyed[j].key == keyed[i].key) ++j;
      if (j - i > kSame) sort_part(faces, points, keyed, other, i, j, depth + 1);
      i = j;
    }
  }

  void build() {
    if (items_.empty()) return;
    std::vector<SmallBox> level((items_.size() + kLeaf - 1) / kLeaf);
    for (std::size_t i = 0; i < level.size(); ++i) {
      level[i] = boxes_[kLeaf * i];
      const std::size_t end = std::min<std::size_t>(items_.size(), kLeaf * (i + 1));
      for (std::size_t k = kLeaf * i + 1; k < end; ++k) level[i].include(boxes_[k]);
    }
    levels_.push_back(std::move(level));
    while (levels_.back().size() > 1) {
      const std::vector<SmallBox>& below = levels_.back();
      std::vector<SmallBox> next((below.size() + 1) / 2);
      for (std::size_t i = 0; i < next.size(); ++i) {
        next[i] = below[2 * i];
        if (2 * i + 1 < below.size()) next[i].include(below[2 * i + 1]);
      }
      levels_.push_back(std::move(next));
    }
  }

  Vec3 low_ = Vec3::Zero();
  double scale_ = 1;
  std::vector<std::uint32_t> items_;
  std::vector<SmallBox> boxes_;
  std::vector<std::vector<SmallBox>> levels_;
};

class Search {
 public:
  explicit Search(const geom::Mesh& mesh) : mesh_(mesh), faces_(mesh) {}

  std::vector<std::uint32_t> run() {
    list_faces();
    if (!look_at_vertices()) return all();
    const BoxLevels tree(faces_, mesh_);
    if (!compare_pairs(tree)) return all();
    join();
    return sort_out(tree);
  }

 private:
  [[nodiscard]] std::vector<std::uint32_t> all() const {
    std::vector<std::uint32_t> every(faces_.size());
    std::iota(every.begin(), every.end(), 0U);
    return every;
  }

  void list_faces() {
    mask_.resize(faces_.size());
    free_.assign(faces_.size(), 1);
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      Face& face = faces_.face(f);
      face.v = mesh_.triangles[f];
      face.source = f;
      face.chain = 0;
      const bool collapsed =
          face.v[0] == face.v[1] || face.v[1] == face.v[2] || face.v[2] == face.v[0];
      face.axis = -1;
      mask_[f] =
          collapsed ? 0
                    : set_axis(face, faces_.corner(f, 0), faces_.corner(f, 1), faces_.corner(f, 2));
      if (face.axis < 0) free_[f] = 0;
    }
  }

  [[nodiscard]] std::span<const Spoke> star(std::uint32_t v) const {
    return {spokes_.data() + first_[v], spokes_.data() + first_[v + 1]};
  }

  /// @return whether every directed edge is cancelled by its opposite
  [[nodiscard]] static bool is_balanced(std::span<const Spoke> star,
                                        std::vector<std::uint32_t>& next,
                                        std::vector<std::uint32_t>& prev) {
    next.clear();
    prev.clear();
    for (const Spoke& s : star) {
      next.push_back(s.next);
      prev.push_back(s.prev);
    }
    std::sort(next.begin(), next.end());
    std::sort(prev.begin(), prev.end());
    return next == prev;
  }

  bool look_at_vertices() {
    first_.assign(faces_.vertices() + std::size_t{1}, 0);
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      for (const std::uint32_t v : faces_.face(f).v) ++first_[v + 1];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    spokes_.resize(3 * std::size_t{faces_.size()});
    std::vector<std::uint32_t> place(first_.begin(), first_.end() - 1);
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      const auto& t = faces_.face(f).v;
      for (int k = 0; k < 3; ++k) spokes_[place[t[k]]++] = {t[(k + 1) % 3], t[(k + 2) % 3], f};
    }
    graph_.assign(faces_.vertices(), 0);
    std::atomic<bool> closed = true;
    verify::parallel_ranges(faces_.vertices(), [&](std::size_t begin, std::size_t end) {
      std::vector<std::uint32_t> next, prev;
      for (auto v = static_cast<std::uint32_t>(begin); v < end; ++v) {
        const std::span<const Spoke> s = star(v);
        if (is_one_fan(s)) {
          graph_[v] = static_cast<char>(is_graph(
              s, faces_.point(v), [&](std::uint32_t f) { return mask_[f]; },
              [&](std::uint32_t w) -> const Vec3& { return faces_.point(w); }));
        } else if (!is_balanced(s, next, prev)) {
          closed = false;
        }
      }
    });
    return closed;
  }

  /// Whether rounded numbers show a triangle strictly on one side of another's plane.
  [[nodiscard]] bool certainly_beside(std::uint32_t f, const Face& g) const {
    const Vec3 &a = faces_.corner(f, 0), &b = faces_.corner(f, 1), &c = faces_.corner(f, 2);
    const double bx = b.x() - a.x(), by = b.y() - a.y(), bz = b.z() - a.z();
    const double cx = c.x() - a.x(), cy = c.y() - a.y(), cz = c.z() - a.z();
    const double x1 = by * cz, x2 = bz * cy, y1 = bz * cx, y2 = bx * cz, z1 = bx * cy, z2 = by * cx;
    const double nx = x1 - x2, ny = y1 - y2, nz = z1 - z2;
    const double mx = std::abs(x1) + std::abs(x2), my = std::abs(y1) + std::abs(y2),
                 mz = std::abs(z1) + std::abs(z2);
    int side = 0;
    for (const std::uint32_t v : g.v) {
      const Vec3& p = faces_.point(v);
      const double dx = p.x() - a.x(), dy = p.y() - a.y(), dz = p.z() - a.z();
      const double value = dx * nx + dy * ny + dz * nz;
      const double size = std::abs(dx) * mx + std::abs(dy) * my + std::abs(dz) * mz;
      // As geom::orient3d bounds it.
      if (!(size > 1e-200) || !(size < 1e300) || !(std::abs(value) > 1e-15 * size)) return false;
      const int s = value > 0 ? 1 : -1;
      if (side != 0 && s != side) return false;
      side = s;
    }
    return true;
  }

  /// A task's finds.
  struct Pairs {
    FoundContacts found;
    std::size_t looked_at = 0;
  };

  void compare(std::uint32_t f, std::uint32_t g, Pairs& pairs) const {
    const Face &x = faces_.face(f), &y = faces_.face(g);
    int common = 0;
    for (const std::uint32_t v : x.v) {
      if (y.place_of(v) < 0) continue;
      if (graph_[v] != 0) return;  // they are parts of one graph
      ++common;
    }
    ++pairs.looked_at;
    if (common == 3) {  // on each other
      pairs.found.cuts.push_back({f, g, true});
      return;
    }
    if (common == 0 && (certainly_beside(f, y) || certainly_beside(g, x))) return;
    Classifier<Faces> classify(faces_, pairs.found, pairs.found);
    classify(f, g);
  }

  /// A pair of boxes of one level, below which pairs of triangles are looked for.
  struct Task {
    std::size_t level;
    std::uint32_t i, j;
  };

  void split(const BoxLevels& tree, const Task& t, std::vector<Task>& into) const {
    const auto& below = tree.levels()[t.level - 1];
    const auto has = [&](std::uint32_t i) { return i < below.size(); };
    const auto add = [&](std::uint32_t i, std::uint32_t j) {
      if (has(i) && has(j) && (i == j || below[i].meets(below[j])))
        into.push_back({t.level - 1, i, j});
    };
    if (t.i == t.j) {
      add(2 * t.i, 2 * t.i);
      add(2 * t.i, 2 * t.i + 1);
      add(2 * t.i + 1, 2 * t.i + 1);
      return;
    }
    for (std::uint32_t i = 2 * t.i; i < 2 * t.i + 2; ++i)
      for (std::uint32_t j = 2 * t.j; j < 2 * t.j + 2; ++j) add(i, j);
  }

  void compare_leaves(const BoxLevels& tree, const Task& t, Pairs& pairs) const {
    const std::uint32_t n = tree.count();
    const std::uint32_t i_end = std::min(n, BoxLevels::kLeaf * (t.i + 1)),
                        j_end = std::min(n, BoxLevels::kLeaf * (t.j + 1));
    const SmallBox& leaf = tree.levels().front()[t.j];
    for (std::uint32_t i = BoxLevels::kLeaf * t.i; i < i_end; ++i) {
      const SmallBox box = tree.box(i);
      if (!box.meets(leaf)) continue;
      for (std::uint32_t j = t.i == t.j ? i + 1 : BoxLevels::kLeaf * t.j; j < j_end; ++j)
        if (box.meets(tree.box(j))) compare(tree.item(i), tree.item(j), pairs);
    }
  }

  /// Unmarks the triangles that another one cuts or lies along. @return false: too many pairs
  bool compare_pairs(const BoxLevels& tree) {
    constexpr std::size_t kTasks = 512, kPairsEach = 300, kPairs = 2'000'000;
    if (tree.levels().empty()) return true;
    std::vector<Task> tasks{{tree.levels().size() - 1, 0, 0}}, next;
    while (tasks.size() < kTasks && tasks.front().level > 0) {
      next.clear();
      for (const Task& t : tasks) split(tree, t, next);
      tasks.swap(next);
    }
    const std::size_t limit = kPairs + kPairsEach * faces_.size();
    std::atomic<std::size_t> looked_at = 0;
    std::vector<Pairs> found(tasks.size());
    verify::parallel_for(std::size_t{0}, tasks.size(), [&](std::size_t n) {
      std::vector<Task> stack{tasks[n]};
      Pairs& pairs = found[n];
      std::size_t told = 0;
      while (!stack.empty()) {
        const Task t = stack.back();
        stack.pop_back();
        if (t.level > 0) {
          split(tree, t, stack);
          continue;
        }
        compare_leaves(tree, t, pairs);
        if (pairs.looked_at - told < 4096) continue;
        looked_at += pairs.looked_at - told;
        told = pairs.looked_at;
        if (looked_at > limit) return;
      }
      looked_at += pairs.looked_at - told;
    });
    if (looked_at > limit) return false;
    for (const Pairs& pairs : found) {
      for (const Contacts::Cut& cut : pairs.found.cuts) free_[cut.face] = free_[cut.by] = 0;
      for (const Contacts::Along& along : pairs.found.alongs)
        free_[along.face] = free_[along.on] = 0;
    }
    return true;
  }

  [[nodiscard]] std::uint32_t root(std::uint32_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void unite(std::uint32_t i, std::uint32_t j) {
    i = root(i);
    j = root(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }
  /// What stands for a face: one of its vertices that joins, else itself.
  [[nodiscard]] std::uint32_t node_of(std::uint32_t f) const {
    for (const std::uint32_t v : faces_.face(f).v)
      if (joins_[v] != 0) return v;
    return faces_.vertices() + f;
  }

  /// Joins free triangles round vertices, and where these do not do across edges.
  void join() {
    joins_.assign(faces_.vertices(), 0);
    for (std::uint32_t v = 0; v < faces_.vertices(); ++v) {
      if (graph_[v] == 0) continue;
      const auto s = star(v);
      joins_[v] = static_cast<char>(
          std::all_of(s.begin(), s.end(), [&](const Spoke& x) { return free_[x.face] != 0; }));
    }
    parent_.resize(std::size_t{faces_.vertices()} + faces_.size());
    std::iota(parent_.begin(), parent_.end(), 0U);
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      if (free_[f] == 0) continue;
      const auto& v = faces_.face(f).v;
      std::uint32_t before = kNone;
      for (int k = 0; k < 3; ++k) {
        if (joins_[v[k]] != 0) {
          if (before != kNone) unite(before, v[k]);
          before = v[k];
        }
        // Across an edge that neither end joins, once from its lower end.
        const std::uint32_t p = v[k], q = v[(k + 1) % 3];
        if (joins_[p] != 0 || joins_[q] != 0) continue;
        const std::uint32_t other = across(f, p, q);
        if (other != kNone && free_[other] != 0) unite(node_of(f), node_of(other));
      }
    }
  }

  /// The only other triangle at the edge from p to q of f, if it runs the other way.
  [[nodiscard]] std::uint32_t across(std::uint32_t f, std::uint32_t p, std::uint32_t q) const {
    std::uint32_t other = kNone;
    for (const Spoke& s : star(p)) {
      if (s.face == f || (s.next != q && s.prev != q)) continue;
      if (other != kNone || s.prev != q) return kNone;
      other = s.face;
    }
    return other;
  }

  /// The winding number on the inner side of a face that nothing cuts; nullopt: not found.
  [[nodiscard]] std::optional<int> inside(const BoxLevels& tree, std::uint32_t f) const {
    constexpr std::array<std::array<double, 3>, 8> kPlaces{{{0.34, 0.31, 0.35},
                                                            {0.42, 0.27, 0.31},
                                                            {0.25, 0.46, 0.29},
                                                            {0.22, 0.33, 0.45},
                                                            {0.57, 0.2, 0.23},
                                                            {0.17, 0.61, 0.22},
                                                            {0.19, 0.24, 0.57},
                                                            {0.38, 0.4, 0.22}}};
    for (const auto& place : kPlaces)
      if (const auto found = inside(tree, f, place)) return found;
    return std::nullopt;
  }

  [[nodiscard]] std::optional<int> inside(const BoxLevels& tree, std::uint32_t f,
                                          const std::array<double, 3>& place) const {
    const Face& face = faces_.face(f);
    const int axis = face.axis, x = (axis + 1) % 3, y = (axis + 2) % 3;
    Vec3 q = Vec3::Zero();
    for (int k = 0; k < 3; ++k) q += place[k] * faces_.corner(f, k);
    const Sign in = face.upward ? Sign::Positive : Sign::Negative;
    std::array<double, 3> weight{};  // of the point of the face above or below q, rounded
    for (int k = 0; k < 3; ++k) {
      const Vec3 &a = faces_.corner(f, (k + 1) % 3), &b = faces_.corner(f, (k + 2) % 3);
      if (orient2d(axis, a, b, q) != in) return std::nullopt;
      weight[k] = std::abs((a[x] - q[x]) * (b[y] - q[y]) - (a[y] - q[y]) * (b[x] - q[x]));
      const double size =
          std::abs((a[x] - q[x]) * (b[y] - q[y])) + std::abs((a[y] - q[y]) * (b[x] - q[x]));
      if (!(size > 1e-200) || !(weight[k] > 1e-6 * size))
        return std::nullopt;  // its relative error stays below 1e-9
    }
    const std::array<float, 3> at{tree.mapped(q.x(), 0), tree.mapped(q.y(), 1),
                                  tree.mapped(q.z(), 2)};
    float lowest = std::numeric_limits<float>::infinity();
    for (int k = 0; k < 3; ++k)
      lowest = std::min(lowest, tree.mapped(faces_.corner(f, k)[axis], axis));
    bool clear = true;
    int above = 0;
    tree.query(
        [&](const SmallBox& box) {
          return clear && box.low[x] <= at[x] && at[x] <= box.high[x] && box.low[y] <= at[y] &&
                 at[y] <= box.high[y] && box.high[axis] >= lowest;
        },
        [&](std::uint32_t g) {
          if (g == f || !clear) return;
          const std::optional<int> crossing = cross(f, g, axis, q, weight);
          if (crossing) above += *crossing;
          clear = crossing.has_value();
        });
    if (!clear) return std::nullopt;
    return face.upward ? above + 1 : above;
  }

  /// What the line upwards from the face's point at q meets of g: ±1 or nothing; nullopt: unclear.
  [[nodiscard]] std::optional<int> cross(std::uint32_t f, std::uint32_t g, int axis, const Vec3& q,
                                         const std::array<double, 3>& weight) const {
    const Sign turn = orient2d(axis, faces_.corner(g, 0), faces_.corner(g, 1), faces_.corner(g, 2));
    for (int k = 0; k < 3; ++k) {
      const Sign s = orient2d(axis, faces_.corner(g, k), faces_.corner(g, (k + 1) % 3), q);
      if (s == Sign::Zero) return std::nullopt;
      if (turn != Sign::Zero && s != turn) return 0;
    }
    if (turn == Sign::Zero) return 0;  // upright, and q is on none of its edges' lines
    double value = 0, error = 0;
    bool positive = true, negative = true;
    for (int k = 0; k < 3; ++k) {
      const std::uint32_t v = faces_.face(f).v[k];
      if (faces_.face(g).place_of(v) >= 0) continue;
      const Sign s = faces_.side(g, faces_.point(v));
      positive = positive && s != Sign::Negative;
      negative = negative && s != Sign::Positive;
      const auto [det, permanent, extent] = geom::detail::orient3d_filtered(
          faces_.corner(g, 0), faces_.corner(g, 1), faces_.corner(g, 2), faces_.point(v));
      if (!(permanent < 1e300) || (s != Sign::Zero && !(permanent > 1e-200))) return std::nullopt;
      value += weight[k] * det;
      error += weight[k] * (1e-15 * permanent + 1e-8 * std::abs(det));
    }
    if (positive && negative) return std::nullopt;  // in one plane
    Sign side = positive ? Sign::Positive : Sign::Negative;
    if (!positive && !negative) {
      if (!(std::abs(value) > error)) return std::nullopt;
      side = value > 0 ? Sign::Positive : Sign::Negative;
    }
    // Below g: on the side away from an upward normal.
    const bool upward = turn == Sign::Positive;
    if ((side == Sign::Negative) != upward) return 0;
    return upward ? 1 : -1;
  }

  /// The triangles of all that is joined where the winding number is not 1 at least.
  std::vector<std::uint32_t> sort_out(const BoxLevels& tree) {
    std::vector<std::uint32_t> node(faces_.size(), kNone), first(parent_.size(), kNone), firsts;
    for (std::uint32_t f = 0; f < faces_.size(); ++f) {
      if (free_[f] == 0) continue;
      node[f] = root(node_of(f));
      if (first[node[f]] != kNone) continue;
      first[node[f]] = f;
      firsts.push_back(f);
    }
    // Where the first face is at an awkward place, others of what is joined with it may tell.
    constexpr int kTries = 16;
    constexpr char kUnclear = 2;
    std::vector<char> holds(parent_.size(), kUnclear);
    const auto look = [&](std::uint32_t f) {
      if (const auto w = inside(tree, f)) holds[node[f]] = static_cast<char>(*w >= 1);
    };
    verify::parallel_for(std::size_t{0}, firsts.size(), [&](std::size_t i) { look(firsts[i]); });
    std::vector<int> tried(parent_.size(), 0);
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      if (node[f] != kNone && holds[node[f]] == kUnclear && ++tried[node[f]] <= kTries) look(f);
    std::vector<std::uint32_t> loose;
    for (std::uint32_t f = 0; f < faces_.size(); ++f)
      if (node[f] == kNone || holds[node[f]] != 1) loose.push_back(f);
    return loose;
  }

  const geom::Mesh& mesh_;
  Faces faces_;
  std::vector<std::uint8_t> mask_;  // per face: directions that it certainly faces
  std::vector<char> free_;          // per face: nothing cuts it, or lies along an edge of it
  std::vector<std::uint32_t> first_;
  std::vector<Spoke> spokes_;
  std::vector<char> graph_;  // per vertex: its star is a graph over a plane
  std::vector<char> joins_;  // and all of its triangles are free
  std::vector<std::uint32_t> parent_;
};

}  // namespace

std::vector<std::uint32_t> find_loose_triangles(const geom::Mesh& mesh) {
  geom::require_valid(mesh);
  return Search(mesh).run();
}

}  // namespace kaboum::verify
