// Two meshes as one: numbers along a curve, neighbours, boxes that meet, contacts within a chain.
#include "mesh_pair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <set>
#include <tuple>
#include <vector>

#include "arrangement.h"
#include "box_tree.h"
#include "cell_sample.h"
#include "classifier.h"
#include "contacts.h"
#include "pairs.h"

namespace {

using namespace kaboum;
using verify::Bounds;
using verify::BoxTree;
using verify::Contacts;
using verify::kInside;
using verify::kOutside;
using verify::Neighbour;

using PairOfItems = std::pair<std::uint32_t, std::uint32_t>;

std::vector<Bounds> random_boxes(std::uint64_t seed, std::size_t count) {
  std::mt19937_64 random(seed);
  const int cells = 1 + static_cast<int>(random() % 40);
  std::vector<Bounds> boxes(count);
  for (Bounds& box : boxes)
    for (int k = 0; k < 3; ++k) {
      box.low[k] = static_cast<double>(random() % cells);
      box.high[k] = box.low[k] + static_cast<double>(random() % 3);
    }
  return boxes;
}

TEST(BoxTree, FindsEachPairOnce) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const std::size_t count = 1 + seed * seed % 600;
    const std::vector<Bounds> boxes = random_boxes(seed, count);
    std::vector<std::uint32_t> items;
    for (std::uint32_t i = 0; i < count; ++i) items.push_back(i);
    const BoxTree tree(boxes, items);
    std::vector<PairOfItems> found, wanted;
    for (const std::uint32_t root : verify::subtrees(tree, 1 + seed % 9))
      verify::meeting_pairs_within(tree, root, [&](std::uint32_t i, std::uint32_t j) {
        found.emplace_back(std::min(i, j), std::max(i, j));
      });
    for (std::uint32_t i = 0; i < count; ++i)
      for (std::uint32_t j = i + 1; j < count; ++j)
        if (boxes[i].meets(boxes[j])) wanted.emplace_back(i, j);
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, wanted) << seed;
  }
}

TEST(BoxTree, EveryNodeHoldsItsItems) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const std::vector<Bounds> boxes = random_boxes(seed, 500);
    std::vector<std::uint32_t> items(500);
    for (std::uint32_t i = 0; i < 500; ++i) items[i] = 1000 + i;
    const BoxTree tree(boxes, items);
    const Bounds wanted = boxes[seed];
    std::set<std::uint32_t> found;
    tree.query([&](const Bounds& box) { return box.meets(wanted); },
               [&](std::uint32_t item) { found.insert(item); });
    for (std::uint32_t i = 0; i < 500; ++i)
      EXPECT_EQ(found.contains(1000 + i), boxes[i].meets(wanted)) << seed;
  }
}

/// What the constructor says of a face's edge, from all faces.
Neighbour neighbour_of(const verify::MeshPair& meshes, std::uint32_t f, int k) {
  const verify::Face& face = meshes.face(f);
  const std::uint32_t from = face.v[k], to = face.v[(k + 1) % 3];
  Neighbour result;
  int same = 0, others = 0;
  for (std::uint32_t g = 0; g < meshes.faces().size(); ++g) {
    const verify::Face& by = meshes.face(g);
    if (g == f || by.place_of(from) < 0 || by.place_of(to) < 0) continue;
    if (by.chain != face.chain) {
      ++others;
      continue;
    }
    ++same;
    if (by.v[(by.place_of(to) + 1) % 3] == from) {
      result.face = g;
      result.edge = static_cast<std::uint8_t>(by.place_of(to));
    }
  }
  if (same != 1 || result.face == Neighbour::kNone) return {};
  result.alone = others == 0;
  return result;
}

/// One box far away gives all others one place on the curve; a query still visits few of them.
TEST(BoxTree, WhatIsSmallBesideTheExtentIsHalvedInSpace) {
  std::vector<Bounds> boxes;
  std::vector<std::uint32_t> items;
  for (std::uint32_t i = 0; i < 4096; ++i) {
    const std::uint32_t at = i * 1237 % 4096;  // in no order of space
    const auto x = static_cast<double>(at % 16), y = static_cast<double>(at / 16 % 16),
               z = static_cast<double>(at / 256);
    boxes.push_back({{x, y, z}, {x + 0.5, y + 0.5, z + 0.5}});
    items.push_back(i);
  }
  boxes.push_back({{1e9, 0, 0}, {1e9 + 1, 1, 1}});
  items.push_back(4096);
  const BoxTree tree(boxes, items);
  const Bounds asked{{3.1, 4.1, 5.1}, {3.2, 4.2, 5.2}};
  std::size_t looked = 0, met = 0;
  tree.query(
      [&](const Bounds& box) {
        ++looked;
        return box.meets(asked);
      },
      [&](std::uint32_t) { ++met; });
  EXPECT_EQ(met, 1U);
  EXPECT_LT(looked, 120U);
}

TEST(MeshPair, NeighboursAndBalance) {
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const test::MeshPair pair = seed % 2 == 0 ? test::lattice_pair(seed) : test::open_pair(seed);
    const verify::MeshPair meshes(pair.inner, pair.outer);
    if (meshes.faces().size() > 400) continue;
    std::map<PairOfItems, std::array<int, 2>> flow;
    for (std::uint32_t f = 0; f < meshes.faces().size(); ++f) {
      const verify::Face& face = meshes.face(f);
      for (int k = 0; k < 3; ++k) {
        const Neighbour is = meshes.neighbour(f, k), should = neighbour_of(meshes, f, k);
        EXPECT_EQ(is.face, should.face) << pair.name;
        EXPECT_EQ(is.edge, should.edge) << pair.name;
        EXPECT_EQ(is.alone, should.alone) << pair.name;
        const std::uint32_t a = face.v[k], b = face.v[(k + 1) % 3];
        flow[{std::min(a, b), std::max(a, b)}][face.chain] += a < b ? 1 : -1;
      }
    }
    std::array<std::size_t, 2> open{};
    bool same = true;
    for (const auto& [edge, sum] : flow) {
      for (int c = 0; c < 2; ++c) open[c] += sum[c] != 0 ? 1 : 0;
      same = same && sum[0] == sum[1];
    }
    EXPECT_EQ(meshes.unbalanced(kInside), open[0]) << pair.name;
    EXPECT_EQ(meshes.unbalanced(kOutside), open[1]) << pair.name;
    EXPECT_EQ(meshes.same_border(), same) << pair.name;
  }
}

/// Faces are the triangles, whatever their numbers.
TEST(MeshPair, FacesAreTheTriangles) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const test::MeshPair pair = test::lattice_pair(seed);
    const verify::MeshPair meshes(pair.inner, pair.outer);
    for (const int chain : {kInside, kOutside}) {
      const geom::Mesh& mesh = chain == kInside ? pair.inner : pair.outer;
      const std::vector<verify::Face> faces = meshes.in_order_of_sources(chain);
      ASSERT_EQ(faces.size(), mesh.triangles.size());
      std::vector<char> seen(faces.size(), 0);
      for (const verify::Face& face : faces) {
        seen[face.source] = 1;
        for (int k = 0; k < 3; ++k)
          EXPECT_EQ(meshes.point_outside(meshes.point(face.v[k])),
                    mesh.vertices[mesh.triangles[face.source][k]]);
      }
      EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), std::ssize(seen));
    }
  }
}

/// A face, another one, the edge along it or −1, whether it is coplanar or whole, whether held.
using Contact = std::tuple<std::uint32_t, std::uint32_t, int, bool, bool>;

void list(const Contacts& contacts, std::uint32_t f, std::vector<Contact>& into) {
  for (const Contacts::Cut& c : contacts.cuts(f))
    into.emplace_back(c.face, c.by, -1, c.coplanar, false);
  for (const Contacts::Along& a : contacts.alongs(f))
    into.emplace_back(a.face, a.on, a.edge, a.whole, a.held);
}

/// Pairs that are left out have no contact, all others are looked at.
TEST(MeshPair, ContactsWithinAChainAreThoseOfAllPairs) {
  std::size_t contacts = 0;
  for (std::uint64_t seed = 0; seed < 120; ++seed) {
    const test::MeshPair pair = seed % 3 == 0   ? test::bent_pair(seed)
                                : seed % 3 == 1 ? test::lattice_pair(seed)
                                                : test::open_pair(seed);
    const verify::MeshPair meshes(pair.inner, pair.outer);
    if (meshes.faces().size() > 400) continue;
    for (const int chain : {kInside, kOutside}) {
      const Contacts found = verify::contacts_within(meshes, chain, {1'000'000, 1'000'000});
      verify::FoundContacts all;
      verify::Classifier classify(meshes, all, all);
      for (std::uint32_t f = meshes.begin(chain); f < meshes.end(chain); ++f)
        for (std::uint32_t g = f + 1; g < meshes.end(chain); ++g)
          if (meshes.face(f).axis >= 0 && meshes.face(g).axis >= 0) classify(f, g);
      const Contacts wanted(meshes.begin(chain), meshes.end(chain), all.cuts, all.alongs);
      std::vector<Contact> a, b;
      for (std::uint32_t f = meshes.begin(chain); f < meshes.end(chain); ++f) {
        list(found, f, a);
        list(wanted, f, b);
      }
      EXPECT_EQ(a, b) << pair.name;
      contacts += a.size();
    }
  }
  EXPECT_GT(contacts, 1000U);
}

/// Where two faces are, by points of one and exact signs for each: no order along lines, nothing
/// rounded.
class PlainContact {
 public:
  PlainContact(const verify::MeshPair& meshes, std::uint32_t f, std::uint32_t g)
      : meshes_(meshes), f_(f), g_(g) {}

  /// Both lie in one plane.
  [[nodiscard]] bool coplanar() const {
    for (int k = 0; k < 3; ++k)
      if (meshes_.side(g_, meshes_.corner(f_, k)) != geom::Sign::Zero) return false;
    return true;
  }
  /// All of f's corners are in g. @pre coplanar
  [[nodiscard]] bool held() const {
    const int axis = meshes_.face(g_).axis;
    for (int k = 0; k < 3; ++k) {
      bool left = false, right = false;
      for (int e = 0; e < 3; ++e) {
        const verify::Sign s = verify::orient2d(
            axis, meshes_.corner(g_, e), meshes_.corner(g_, (e + 1) % 3), meshes_.corner(f_, k));
        left = left || s == verify::Sign::Positive;
        right = right || s == verify::Sign::Negative;
      }
      if (left && right) return false;
    }
    return true;
  }
  /// One has a segment or an area in common with the other, by points of a fine grid on f's edges
  /// and inside: no contact that is large enough is missed.
  [[nodiscard]] bool meet_in_grid() const {
    constexpr int kSteps = 8;
    int common = 0;
    for (int i = 0; i <= kSteps; ++i)
      for (int j = 0; i + j <= kSteps; ++j) {
        const geom::Vec3 p = (i * meshes_.corner(f_, 0) + j * meshes_.corner(f_, 1) +
                              (kSteps - i - j) * meshes_.corner(f_, 2)) /
                             kSteps;
        if (meshes_.side(g_, p) != geom::Sign::Zero) continue;
        const int axis = meshes_.face(g_).axis;
        bool left = false, right = false;
        for (int e = 0; e < 3; ++e) {
          const verify::Sign s =
              verify::orient2d(axis, meshes_.corner(g_, e), meshes_.corner(g_, (e + 1) % 3), p);
          left = left || s == verify::Sign::Positive;
          right = right || s == verify::Sign::Negative;
        }
        if (!left || !right) ++common;
      }
    return common > 1;
  }

 private:
  const verify::MeshPair& meshes_;
  std::uint32_t f_, g_;
};

/// Lattice pairs have coordinates that hold points of the grid exactly.
TEST(MeshPair, NoContactIsLeftOut) {
  std::size_t meetings = 0, held = 0;
  for (std::uint64_t seed = 0; seed < 90; ++seed) {
    test::MeshPair pair = seed % 2 == 0 ? test::lattice_pair(seed) : test::open_pair(seed);
    if (seed % 3 == 0) pair.inner = test::subdivided(pair.outer);
    const verify::MeshPair meshes(pair.inner, pair.outer);
    if (meshes.faces().size() > 300) continue;
    verify::KnownSides known;
    for (std::uint32_t f = 0; f < meshes.faces().size(); ++f)
      for (std::uint32_t g = 0; g < meshes.faces().size(); ++g) {
        const verify::Face &x = meshes.face(f), &y = meshes.face(g);
        if (f == g || x.axis < 0 || y.axis < 0) continue;
        int common = 0;
        for (const std::uint32_t v : x.v) common += y.place_of(v) >= 0 ? 1 : 0;
        if (common == 3) continue;
        const PlainContact plain(meshes, f, g);
        verify::FoundContacts of_f, of_g;
        verify::Classifier{meshes, of_f, of_g, &known}(f, g);
        const bool none =
            of_f.cuts.empty() && of_f.alongs.empty() && of_g.cuts.empty() && of_g.alongs.empty();
        if (common < 2 && plain.meet_in_grid()) {
          ++meetings;
          EXPECT_FALSE(none) << pair.name << " " << f << " " << g;
        }
        const bool is_held = plain.coplanar() && plain.held();
        held += is_held ? 1 : 0;
        for (const Contacts::Along& a : of_f.alongs)
          EXPECT_EQ(a.held, is_held) << pair.name << " " << f << " " << g;
        if (is_held) {
          EXPECT_FALSE(of_f.alongs.empty()) << pair.name << " " << f << " " << g;
        }
      }
  }
  EXPECT_GT(meetings, 10000U);
  EXPECT_GT(held, 1000U);
}

/// All faces of a patch have the same winding number beside them: that of each one's own middle.
TEST(MeshPair, PatchesHaveOneWindingNumber) {
  std::size_t faces = 0, roots = 0;
  for (std::uint64_t seed = 0; seed < 240; ++seed) {
    test::MeshPair pair = seed % 4 == 3 ? test::bent_pair(seed) : test::lattice_pair(seed);
    if (seed % 3 == 0) pair.inner = test::subdivided(pair.outer);
    if (seed % 3 == 1) pair.inner = test::subdivided(test::subdivided(pair.inner));
    if (seed % 6 == 1) std::swap(pair.inner, pair.outer);
    const verify::MeshPair meshes(pair.inner, pair.outer);
    if (meshes.faces().size() > 3000) continue;
    verify::Arrangement arrangement(meshes, {10'000'000, 10'000'000});
    arrangement.need_mutual();
    arrangement.need_own(kInside);
    arrangement.need_own(kOutside);
    for (const int chain : {kInside, kOutside})
      for (const int of : {kInside, kOutside}) {
        if (!meshes.closed(of)) continue;
        for (const verify::Side side : {verify::kInner, verify::kOuter}) {
          const std::vector<std::uint32_t> patch =
              verify::patches(arrangement, chain, verify::mask_of(of), side);
          const std::uint32_t begin = meshes.begin(chain);
          std::map<std::uint32_t, int> value;
          for (std::uint32_t i = 0; i < meshes.count(chain); ++i) {
            if (meshes.face(begin + i).axis < 0 ||
                !arrangement.uncut(begin + i, verify::mask_of(of)))
              continue;
            const int own = verify::winding(meshes, verify::middle_sample(begin + i), side, of);
            const auto [at, first] = value.emplace(patch[i], own);
            EXPECT_EQ(at->second, own) << pair.name << " seed " << seed << " face " << i;
            ++faces;
            roots += first ? 1 : 0;
          }
        }
      }
  }
  EXPECT_GT(faces, 100000U);
  EXPECT_LT(10 * roots, 8 * faces);  // some are joined
}

/// Round which the triangles go twice, all of them upwards: they cut each other.
TEST(MeshPair, ContactsRoundAVertexThatIsGoneRoundTwice) {
  geom::Mesh mesh{{{4, 0, 0},
                   {-2, 3, 0},
                   {-2, -3, 0},
                   {3, 0, 0},
                   {-1, 2, 0},
                   {-1, -2, 0},
                   {0, 0, 1},
                   {0, 0, -1}},
                  {}};
  for (std::uint32_t i = 0; i < 6; ++i) {
    mesh.triangles.push_back({i, (i + 1) % 6, 6});
    mesh.triangles.push_back({(i + 1) % 6, i, 7});
  }
  const verify::MeshPair meshes(mesh, mesh);
  const Contacts found = verify::contacts_within(meshes, kInside, {1'000'000, 1'000'000});
  EXPECT_EQ(found.cut_count(), 4U);
}

/// A fan, and a triangle besides that hangs on its vertex and cuts it.
TEST(MeshPair, ContactsRoundAVertexOfMoreThanAFan) {
  const geom::Mesh mesh{
      {{4, 0, 0}, {0, 4, 0}, {-4, 0, 0}, {0, -4, 0}, {0, 0, 1}, {-3, -1, 2}, {-1, -3, -2}},
      {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {5, 6, 4}}};
  const verify::MeshPair meshes(mesh, mesh);
  const Contacts found = verify::contacts_within(meshes, kInside, {1'000'000, 1'000'000});
  EXPECT_EQ(found.cut_count(), 2U);
}

}  // namespace
