// How faces of two chains, or of one, lie in each other: which cut which, and patches of faces left
// uncut. docs/algorithms/exact-inclusion.md.
#include "arrangement.h"

#include <algorithm>
#include <numeric>

#include "parallel.h"

namespace kaboum::verify {

namespace {
constexpr std::size_t kPair = 200;  // steps that looking at a pair of triangles takes
}

template <class Search>
auto Arrangement::limited(const Search& search) const {
  if (allowance_ == nullptr || !allowance_->limited()) return search(limits_);
  std::atomic<std::size_t> pairs = 0;
  ContactLimits limits = limits_;
  limits.pairs = std::min<std::size_t>(limits.pairs, allowance_->left() / (4 * kPair));
  limits.looked_at = &pairs;
  try {
    auto found = search(limits);
    allowance_->add(kPair * pairs);
    return found;
  } catch (const Error&) {
    allowance_->add(kPair * limits.pairs);  // how many more were looked at may vary
    throw;
  }
}

void Arrangement::need_mutual() {
  if (contacts_[kInside][kOutside]) return;
  MutualContacts found =
      limited([&](const ContactLimits& limits) { return contacts_between(meshes_, limits); });
  contacts_[kInside][kOutside] = std::move(found.of_inside);
  contacts_[kOutside][kInside] = std::move(found.of_outside);
}

void Arrangement::need_own(int chain) {
  if (contacts_[chain][chain]) return;
  contacts_[chain][chain] =
      limited([&](const ContactLimits& limits) { return contacts_within(meshes_, chain, limits); });
}

namespace {

/// The sector between two neighbours at their common edge, on the side that is walked on.
class Sector {
 public:
  Sector(const MeshPair& meshes, std::uint32_t f, std::uint32_t other, std::uint32_t other_apex,
         Side side)
      : meshes_(meshes), f_(f), other_(other), side_(side) {
    const Sign turn = meshes.side(f, meshes.point(other_apex));
    turn_ = side * to_int(turn);
  }

  /// 0: the faces are coplanar, on or beside each other.
  [[nodiscard]] int turn() const { return turn_; }

  /// Whether the half-plane from the edge through p lies strictly within the sector.
  [[nodiscard]] bool holds(const Vec3& p) const {
    const bool beyond_first = side_ * to_int(meshes_.side(f_, p)) > 0;
    if (turn_ == 0) return beyond_first;
    const bool beyond_other = side_ * to_int(meshes_.side(other_, p)) > 0;
    return turn_ > 0 ? beyond_first && beyond_other : beyond_first || beyond_other;
  }

 private:
  const MeshPair& meshes_;
  std::uint32_t f_, other_;
  Side side_;
  int turn_;
};

/// Whether some of a face's contacts show that `on` holds it.
bool holds(std::span<const Contacts::Along> alongs, std::uint32_t on) {
  return std::any_of(alongs.begin(), alongs.end(),
                     [&](const Contacts::Along& along) { return along.on == on && along.held; });
}

/// Whether one can walk from f over its edge k to its neighbour without crossing the chains of
/// `mask`.
bool walkable(const Arrangement& arrangement, std::uint32_t f, int k, const Neighbour& next,
              OperandMask mask, Side side) {
  const MeshPair& meshes = arrangement.meshes();
  const Face& face = meshes.face(f);
  const std::uint32_t u = face.v[k], v = face.v[(k + 1) % 3], other = next.face;
  const int other_edge = next.edge;

  // What lies along the edge: triangles that have it as an edge, and those in contact with it.
  thread_local std::vector<std::uint32_t> touching;
  touching.clear();
  if (!next.alone) {
    for (const std::uint32_t g : meshes.around_edge(u, v)) {
      const Face& by = meshes.face(g);
      if (g == f || g == other || by.axis < 0 || (mask & mask_of(by.chain)) == 0) continue;
      if (by.place_of(u) >= 0 && by.place_of(v) >= 0) touching.push_back(g);
    }
  }
  // They run through the edge oppositely. So they are beside each other if they are coplanar.
  const bool unfolded =
      face.axis == meshes.face(other).axis && face.upward == meshes.face(other).upward;
  for (int chain = 0; chain < 2; ++chain) {
    if ((mask & mask_of(chain)) == 0) continue;
    const Contacts& contacts = arrangement.contacts(face.chain, chain);
    const std::array alongs{contacts.alongs(f), contacts.alongs(other)};
    for (int i = 0; i < 2; ++i) {
      for (const Contacts::Along& along : alongs[i]) {
        if (along.edge != (i == 0 ? k : other_edge)) continue;
        if (!along.whole) return false;
        // What holds both faces bounds the sector between them, which is flat. (Where it does not
        // hold the other one, that one's contact adds it anyway.)
        if (unfolded && along.held && holds(alongs[1 - i], along.on)) continue;
        touching.push_back(along.on);
      }
    }
  }
  if (touching.empty()) return true;

  const std::uint32_t apex = meshes.face(other).v[(other_edge + 2) % 3];
  const Sector sector(meshes, f, other, apex, side);
  if (sector.turn() == 0) {
    // Coplanar: beside each other is a flat sector, on each other none or all of the space.
    const Vec3 &a = meshes.point(u), &b = meshes.point(v);
    const Sign first = orient2d(face.axis, a, b, meshes.corner(f, (k + 2) % 3));
    const Sign second = orient2d(face.axis, a, b, meshes.point(apex));
    if (first == second) return false;
  }
  for (const std::uint32_t g : touching) {
    for (const std::uint32_t w : meshes.face(g).v) {
      if (w != u && w != v && sector.holds(meshes.point(w))) return false;
    }
  }
  return true;
}

}  // namespace

std::vector<std::uint32_t> patches(const Arrangement& arrangement, int chain, OperandMask mask,
                                   Side side) {
  const MeshPair& meshes = arrangement.meshes();
  const std::uint32_t begin = meshes.begin(chain), count = meshes.count(chain);

  // Per face and edge: the neighbour that can be walked to, if its number is larger.
  constexpr std::uint32_t kNone = 0xFFFFFFFF;
  std::vector<std::array<std::uint32_t, 3>> next(count, {kNone, kNone, kNone});
  verify::parallel_for(std::uint32_t{0}, count, [&](std::uint32_t i) {
    const std::uint32_t f = begin + i;
    const Face& face = meshes.face(f);
    if (face.axis < 0 || !arrangement.uncut(f, mask)) return;
    for (int k = 0; k < 3; ++k) {
      const Neighbour& next_to = meshes.neighbour(f, k);
      if (next_to.face == Neighbour::kNone || next_to.face < f) continue;
      if (meshes.face(next_to.face).axis < 0 || !arrangement.uncut(next_to.face, mask)) continue;
      if (walkable(arrangement, f, k, next_to, mask, side)) next[i][k] = next_to.face - begin;
    }
  });

  std::vector<std::uint32_t> parent(count);
  std::iota(parent.begin(), parent.end(), 0U);
  const auto root = [&](std::uint32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (std::uint32_t i = 0; i < count; ++i) {
    for (const std::uint32_t j : next[i]) {
      if (j == kNone) continue;
      const std::uint32_t a = root(i), b = root(j);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  for (std::uint32_t i = 0; i < count; ++i) parent[i] = root(i);
  return parent;
}

}  // namespace kaboum::verify
