#include <kaboum/geom/error.h>
#include <kaboum/geom/parallel.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <optional>
#include <sstream>

namespace kaboum::geom {
namespace {

std::string count_of(std::size_t n, const char* singular, const char* plural) {
  return std::to_string(n) + " " + (n == 1 ? singular : plural);
}

class Preparation {
 public:
  Preparation(const Mesh& input, const PrepareOptions& options) : options_(options) {
    require_valid(input);
    require_moderate(input);
    out_.mesh = weld(input);
    const std::size_t n = out_.mesh.triangles.size();
    out_.source.resize(n);
    std::iota(out_.source.begin(), out_.source.end(), 0U);
    out_.turned.assign(n, 0);
  }

  Prepared run() {
    drop_collapsed();
    if (out_.mesh.empty())
      throw Error(ErrorCode::InvalidInput, "the mesh has no triangle with three different corners");
    edges_ = edge_uses(out_.mesh);
    if (!options_.keep_orientation) agree_with_neighbours();
    cancel_pairs();
    if (!options_.keep_orientation) turn_components();
    drop_copies();
    number_by_first_use();
    geom::parallel_calls([&] { find_border(); },
                         [&] { components(edges_, mesh().triangles.size(), &out_.components); });
    if (options_.keep_orientation && out_.closed && !(signed_volume(out_.mesh) > 0))
      out_.notes.push_back(
          "the signed volume is not positive: as oriented, the mesh bounds little or no "
          "solid, and what is certified of its solid says nothing of its surface");
    out_.turned_triangles =
        static_cast<std::size_t>(std::count(out_.turned.begin(), out_.turned.end(), 1));
    return std::move(out_);
  }

 private:
  Mesh& mesh() { return out_.mesh; }

  /// Products of four coordinates must neither overflow nor vanish.
  static void require_moderate(const Mesh& input) {
    const Box3 box = bounding_box(input);
    if (box.empty()) return;
    const double magnitude = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    const double extent = (box.max - box.min).maxCoeff();
    if (magnitude > 1e60 || (extent > 0 && extent < 1e-60)) {
      std::ostringstream text;
      text << std::setprecision(2) << "the mesh's coordinates reach " << magnitude
           << " and its extent is " << extent
           << "; coordinates up to 1e60 and extents from 1e-60 can be worked on: scale the mesh";
      throw Error(ErrorCode::InvalidInput, text.str());
    }
  }

  void find_edges() {
    coincident_.reset();
    std::vector<EdgeUse>().swap(edges_);  // first, for they are large
    edges_ = edge_uses(mesh());
  }

  void turn(std::uint32_t t) {
    std::swap(mesh().triangles[t][1], mesh().triangles[t][2]);
    out_.turned[t] ^= 1;
  }

  /// Keeps the triangles with keep[t] != 0, and the vertices they use.
  void filter(const std::vector<char>& keep) {
    std::size_t n = 0;
    for (std::size_t t = 0; t < keep.size(); ++t) {
      if (keep[t] == 0) {
        if (out_.turned[t] != 0) out_.turned_and_dropped.push_back(out_.source[t]);
        continue;
      }
      mesh().triangles[n] = mesh().triangles[t];
      out_.source[n] = out_.source[t];
      out_.turned[n] = out_.turned[t];
      ++n;
    }
    mesh().triangles.resize(n);
    out_.source.resize(n);
    out_.turned.resize(n);
    mesh() = weld(mesh());
    find_edges();
  }

  void drop_collapsed() {
    std::vector<char> keep(mesh().triangles.size(), 1);
    for (std::size_t t = 0; t < keep.size(); ++t) {
      const Triangle& tri = mesh().triangles[t];
      if (tri[0] == tri[1] || tri[1] == tri[2] || tri[2] == tri[0]) {
        keep[t] = 0;
        ++out_.collapsed_triangles;
      }
    }
    if (out_.collapsed_triangles == 0) return;
    filter(keep);
    out_.notes.push_back(count_of(out_.collapsed_triangles, "triangle", "triangles") +
                         " with repeated corners dropped");
  }

  template <class Visit>
  void for_each_edge(Visit&& visit) const {
    for (std::size_t i = 0; i < edges_.size();) {
      std::size_t j = i + 1;
      while (j < edges_.size() && edges_[j].lo == edges_[i].lo && edges_[j].hi == edges_[i].hi) ++j;
      visit(std::span(edges_).subspan(i, j - i));
      i = j;
    }
  }

  static bool balanced(std::span<const EdgeUse> uses) {
    const auto forward =
        std::count_if(uses.begin(), uses.end(), [](const EdgeUse& e) { return e.forward; });
    return 2 * static_cast<std::size_t>(forward) == uses.size();
  }

  std::uint32_t opposite_corner(const EdgeUse& use) const {
    return out_.mesh.triangles[use.triangle][(use.corner + 2) % 3];
  }

  /// Patches connected through edges with exactly two triangles are oriented consistently, by the
  /// orientation that most of their area has already.
  void agree_with_neighbours() {
    std::size_t inconsistent = 0;
    const auto neighbours = [&](std::span<const EdgeUse> e) {
      return e.size() == 2 && opposite_corner(e[0]) != opposite_corner(e[1]);
    };
    for_each_edge(
        [&](std::span<const EdgeUse> e) { inconsistent += !balanced(e) && neighbours(e); });
    if (inconsistent == 0) return;

    const std::size_t n = mesh().triangles.size();
    struct Neighbour {
      std::uint32_t triangle = ~0U;
      bool agrees = true;
    };
    std::vector<std::array<Neighbour, 3>> across(n);
    for_each_edge([&](std::span<const EdgeUse> e) {
      if (!neighbours(e)) return;  // copies of one triangle are none
      const bool agrees = e[0].forward != e[1].forward;
      across[e[0].triangle][e[0].corner] = {e[1].triangle, agrees};
      across[e[1].triangle][e[1].corner] = {e[0].triangle, agrees};
    });
    constexpr std::int8_t kUnseen = 0;
    std::vector<std::int8_t> sense(n, kUnseen);
    std::vector<std::uint32_t> patch;
    for (std::uint32_t seed = 0; seed < n; ++seed) {
      if (sense[seed] != kUnseen) continue;
      patch.assign(1, seed);
      sense[seed] = 1;
      double balance = 0;
      for (std::size_t i = 0; i < patch.size(); ++i) {
        const std::uint32_t t = patch[i];
        const Triangle& tri = mesh().triangles[t];
        const Vec3& a = mesh().vertices[tri[0]];
        balance +=
            sense[t] * (mesh().vertices[tri[1]] - a).cross(mesh().vertices[tri[2]] - a).norm();
        for (const Neighbour& nb : across[t]) {
          if (nb.triangle == ~0U) continue;
          const auto wished = static_cast<std::int8_t>(nb.agrees ? sense[t] : -sense[t]);
          if (sense[nb.triangle] == kUnseen) {
            sense[nb.triangle] = wished;
            patch.push_back(nb.triangle);
          } else if (sense[nb.triangle] != wished) {
            throw Error(ErrorCode::InvalidInput,
                        "the surface is one-sided (not orientable) at input triangle " +
                            std::to_string(out_.source[nb.triangle]) +
                            ", so it bounds no solid; cut it or close it to a two-sided surface");
          }
        }
      }
      const std::int8_t against = balance < 0 ? 1 : -1;
      for (const std::uint32_t t : patch)
        if (sense[t] == against) turn(t);
    }
    find_edges();
    out_.notes.push_back(count_of(inconsistent, "edge", "edges") +
                         " with neighbours of opposite orientation: triangles turned to agree");
  }

  struct Coincident {
    std::vector<std::uint32_t> pairs;   // triangles in opposite pairs
    std::vector<std::uint32_t> copies;  // further triangles like one that stays
  };

  /// Found once for each state of the mesh.
  const Coincident& coincident() {
    if (!coincident_) coincident_ = find_coincident();
    return *coincident_;
  }

  Coincident find_coincident() {
    std::vector<std::pair<Triangle, std::uint32_t>> keyed;
    keyed.reserve(mesh().triangles.size());
    const auto even = [](const Triangle& t, const Triangle& sorted) {
      return (t[0] == sorted[0] && t[1] == sorted[1]) || (t[1] == sorted[0] && t[2] == sorted[1]) ||
             (t[2] == sorted[0] && t[0] == sorted[1]);
    };
    // Only triangles that share an edge and the corner opposite to it can coincide.
    std::vector<char> candidate(mesh().triangles.size(), 0);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> by_corner;
    for_each_edge([&](std::span<const EdgeUse> e) {
      if (e.size() < 2) return;
      if (e.size() == 2) {
        if (opposite_corner(e[0]) == opposite_corner(e[1]))
          candidate[e[0].triangle] = candidate[e[1].triangle] = 1;
        return;
      }
      by_corner.clear();
      for (const EdgeUse& u : e) by_corner.emplace_back(opposite_corner(u), u.triangle);
      std::sort(by_corner.begin(), by_corner.end());
      for (std::size_t i = 1; i < by_corner.size(); ++i)
        if (by_corner[i].first == by_corner[i - 1].first)
          candidate[by_corner[i].second] = candidate[by_corner[i - 1].second] = 1;
    });
    for (std::uint32_t t = 0; t < candidate.size(); ++t) {
      if (candidate[t] == 0) continue;
      Triangle key = mesh().triangles[t];
      std::sort(key.begin(), key.end());
      keyed.emplace_back(key, t);
    }
    std::sort(keyed.begin(), keyed.end());
    Coincident found;
    for (std::size_t i = 0; i < keyed.size();) {
      std::vector<std::uint32_t> side[2];
      std::size_t j = i;
      for (; j < keyed.size() && keyed[j].first == keyed[i].first; ++j)
        side[even(mesh().triangles[keyed[j].second], keyed[i].first)].push_back(keyed[j].second);
      const std::size_t opposite = std::min(side[0].size(), side[1].size());
      for (const auto& s : side) {
        found.pairs.insert(found.pairs.end(), s.begin(),
                           s.begin() + static_cast<std::ptrdiff_t>(opposite));
        for (std::size_t k = opposite + 1; k < s.size(); ++k) found.copies.push_back(s[k]);
      }
      i = j;
    }
    return found;
  }

  void cancel_pairs() {
    if (coincident().pairs.empty()) return;
    std::vector<char> keep(mesh().triangles.size(), 1);
    drop_pairs(coincident().pairs, keep);
    filter(keep);
    if (mesh().empty())
      throw Error(ErrorCode::InvalidInput,
                  "nothing is left once opposite coincident faces cancel; the input has no volume");
  }

  /// Opposite pairs add nothing to the chain. Inside the rest's solid they are walls between
  /// touching bodies; elsewhere they are sheets, which no solid protects.
  void drop_pairs(const std::vector<std::uint32_t>& pairs, std::vector<char>& keep) {
    std::vector<std::int8_t> weight(mesh().triangles.size(), 1);
    for (const std::uint32_t t : pairs) weight[t] = 0;
    const WindingNumber winding(mesh());
    std::vector<std::uint32_t> sheets;
    for (const std::uint32_t t : pairs) {
      const Triangle& tri = mesh().triangles[t];
      const Vec3 center =
          (mesh().vertices[tri[0]] + mesh().vertices[tri[1]] + mesh().vertices[tri[2]]) / 3.0;
      const std::optional<int> w = winding.weighted(center, weight);
      if (!w || *w <= 0) sheets.push_back(t);
    }
    if (!sheets.empty() && !options_.drop_sheets)
      throw Error(
          ErrorCode::InvalidInput,
          count_of(sheets.size(), "face lies", "faces lie") +
              " back to back with an opposite copy and no volume between (sheets; the first is "
              "input triangle " +
              std::to_string(out_.source[*std::min_element(sheets.begin(), sheets.end())]) +
              "); give the sheets a thickness, or drop them with --drop-sheets: they are then "
              "not enclosed");
    for (const std::uint32_t t : pairs) keep[t] = 0;
    out_.dropped_sheets = sheets.size();
    out_.cancelled_walls = pairs.size() - sheets.size();
    if (!sheets.empty())
      out_.notes.push_back(count_of(sheets.size(), "triangle", "triangles") +
                           " of sheets without volume dropped on request: they are NOT enclosed");
    if (out_.cancelled_walls != 0)
      out_.notes.push_back(count_of(out_.cancelled_walls, "triangle", "triangles") +
                           " of walls between touching bodies cancelled");
  }

  /// Drops copies whose edges balance among the dropped ones alone, component by component. A copy
  /// lowers the winding number inside; that leaves the solid alone only where nothing else lowers
  /// it, so copies stay if any component is oriented inwards.
  void drop_copies() {
    const std::vector<std::uint32_t> copies = coincident().copies;
    if (copies.empty()) return;
    std::vector<char> closed_component;
    const std::vector<std::uint32_t> component = closed_components(closed_component);
    const std::vector<double> volume = volumes(component, closed_component.size());
    for (std::size_t c = 0; c < volume.size(); ++c)
      if (closed_component[c] != 0 && volume[c] < 0) return;
    std::vector<char> keep(mesh().triangles.size(), 1);
    Mesh dropped{mesh().vertices, {}};
    for (const std::uint32_t t : copies) dropped.triangles.push_back(mesh().triangles[t]);
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> label = components(dropped, true, &count);
    std::vector<char> closed(count, 1);
    const std::vector<EdgeUse> uses = edge_uses(dropped);
    for (std::size_t i = 0; i < uses.size();) {
      std::size_t j = i;
      while (j < uses.size() && uses[j].lo == uses[i].lo && uses[j].hi == uses[i].hi) ++j;
      if (!balanced(std::span(uses).subspan(i, j - i))) closed[label[uses[i].triangle]] = 0;
      i = j;
    }
    for (std::size_t i = 0; i < copies.size(); ++i) {
      if (closed[label[i]] == 0) continue;
      keep[copies[i]] = 0;
      ++out_.dropped_copies;
    }
    if (out_.dropped_copies == 0) return;
    filter(keep);
    out_.notes.push_back(count_of(out_.dropped_copies, "triangle", "triangles") +
                         " of identically oriented copies dropped");
  }

  /// Smallest sets of triangles that are closed chains: patches joined through edges of two
  /// triangles, and further through other edges as long as they are not balanced by themselves.
  std::vector<std::uint32_t> closed_components(std::vector<char>& closed) {
    const std::size_t n = mesh().triangles.size();
    std::vector<std::uint32_t> parent(n);
    std::iota(parent.begin(), parent.end(), 0U);
    const auto find = [&](std::uint32_t x) {
      while (parent[x] != x) x = parent[x] = parent[parent[x]];
      return x;
    };
    const auto join = [&](std::uint32_t a, std::uint32_t b) {
      a = find(a);
      b = find(b);
      if (a != b) parent[std::max(a, b)] = std::min(a, b);
    };
    for_each_edge([&](std::span<const EdgeUse> e) {
      if (e.size() == 2) join(e[0].triangle, e[1].triangle);
    });
    std::vector<std::pair<std::uint32_t, int>> sums;  // per patch at an edge: forward − backward
    for (bool changed = true; changed;) {
      changed = false;
      for_each_edge([&](std::span<const EdgeUse> e) {
        if (e.size() <= 2 || !balanced(e)) return;
        sums.clear();
        for (const EdgeUse& u : e) sums.emplace_back(find(u.triangle), u.forward ? 1 : -1);
        std::sort(sums.begin(), sums.end());
        bool alone = true;
        for (std::size_t i = 0; i < sums.size() && alone;) {
          const std::uint32_t root = sums[i].first;
          int sum = 0;
          for (; i < sums.size() && sums[i].first == root; ++i) sum += sums[i].second;
          alone = sum == 0;
        }
        if (alone) return;
        for (const EdgeUse& u : e.subspan(1)) {
          changed = changed || find(u.triangle) != find(e[0].triangle);
          join(e[0].triangle, u.triangle);
        }
      });
    }
    std::vector<std::uint32_t> label(n);
    std::uint32_t count = 0;
    for (std::uint32_t t = 0; t < n; ++t) {
      const std::uint32_t root = find(t);
      label[t] = root == t ? count++ : label[root];
    }
    closed.assign(count, 1);
    for_each_edge([&](std::span<const EdgeUse> e) {
      if (balanced(e)) return;
      for (const EdgeUse& u : e) closed[label[u.triangle]] = 0;
    });
    return label;
  }

  std::vector<double> volumes(const std::vector<std::uint32_t>& label, std::size_t count) {
    const Vec3 origin = bounding_box(mesh()).center();
    std::vector<double> volume(count, 0);
    for (std::size_t t = 0; t < label.size(); ++t) {
      const Triangle& tri = mesh().triangles[t];
      const Vec3 a = mesh().vertices[tri[0]] - origin, b = mesh().vertices[tri[1]] - origin,
                 c = mesh().vertices[tri[2]] - origin;
      volume[label[t]] += a.dot(b.cross(c));
    }
    return volume;
  }

  /// A component with negative volume is a cavity if all of it lies in the solid of the others;
  /// otherwise it is inside out and turned. It takes along what lies inside it as long as that has
  /// no solid of its own: the cavities of a file that is inside out as a whole.
  void turn_components() {
    std::vector<char> closed;
    const std::vector<std::uint32_t> label = closed_components(closed);
    const std::size_t count = closed.size();
    std::vector<double> volume = volumes(label, count);
    const auto inward = [&](std::uint32_t c) { return closed[c] != 0 && volume[c] < 0; };
    bool any = false;
    for (std::uint32_t c = 0; c < count; ++c) any = any || inward(c);
    if (!any) return;

    std::vector<std::vector<std::uint32_t>> members(count);
    std::vector<Box3> box(count);
    for (std::uint32_t t = 0; t < label.size(); ++t) {
      members[label[t]].push_back(t);
      for (const std::uint32_t v : mesh().triangles[t]) box[label[t]].extend(mesh().vertices[v]);
    }
    std::vector<std::uint32_t> by_size(count);
    std::iota(by_size.begin(), by_size.end(), 0U);
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::abs(volume[a]) > std::abs(volume[b]);
    });
    const WindingNumber winding(mesh());
    std::vector<std::int8_t> weight(label.size(), 1);  // of the whole chain as turned so far
    for (std::size_t t = 0; t < label.size(); ++t)
      if (closed[label[t]] == 0) weight[t] = 0;
    std::vector<std::int8_t> only(label.size(), 0);  // of the nest looked at
    std::vector<std::int8_t> sense(count, 1);
    const auto set = [&](std::vector<std::int8_t>& weights, std::uint32_t c, std::int8_t w) {
      for (const std::uint32_t t : members[c]) weights[t] = w;
    };
    // Whether holds(w) at every corner of c that is on none of the weighted triangles.
    const auto everywhere = [&](std::uint32_t c, const std::vector<std::int8_t>& weights,
                                auto&& holds) {
      for (const std::uint32_t t : members[c]) {
        for (const std::uint32_t v : mesh().triangles[t]) {
          const auto w = winding.weighted(mesh().vertices[v], weights);
          if (w && !holds(*w)) return false;
        }
      }
      return true;
    };
    for (const std::uint32_t c : by_size) {
      if (!inward(c)) continue;
      set(weight, c, 0);
      const bool cavity = everywhere(c, weight, [](int w) { return w >= 1; });
      set(weight, c, sense[c]);
      if (cavity) continue;
      ++out_.turned_components;
      std::vector<std::uint32_t> nest{c};
      set(only, c, sense[c]);
      for (std::uint32_t d = 0; d < count; ++d) {
        if (d == c || closed[d] == 0 || std::abs(volume[d]) >= std::abs(volume[c])) continue;
        if (!(box[d].min.array() >= box[c].min.array()).all() ||
            !(box[d].max.array() <= box[c].max.array()).all())
          continue;
        if (everywhere(d, only, [](int w) { return w < 0; })) nest.push_back(d);
      }
      for (const std::uint32_t d : nest) set(only, d, sense[d]);
      const bool hollow = std::all_of(nest.begin(), nest.end(), [&](std::uint32_t d) {
        set(only, d, 0);
        const int inside = volume[d] > 0 ? 1 : -1;
        const bool none = everywhere(d, only, [&](int w) { return w <= 0 && w + inside <= 0; });
        set(only, d, sense[d]);
        return none;
      });
      for (const std::uint32_t d : nest) set(only, d, 0);
      if (!hollow) nest.resize(1);
      for (const std::uint32_t d : nest) {
        sense[d] = static_cast<std::int8_t>(-sense[d]);
        volume[d] = -volume[d];
        set(weight, d, sense[d]);
      }
    }
    for (std::uint32_t t = 0; t < label.size(); ++t)
      if (sense[label[t]] < 0) turn(t);
    if (out_.turned_components == 0) return;
    find_edges();
    out_.notes.push_back(count_of(out_.turned_components, "component was", "components were") +
                         " inside out and turned, cavities included");
  }

  /// Vertices in the order in which the triangles left use them in the input, before any was
  /// turned.
  void number_by_first_use() {
    if (std::find(out_.turned.begin(), out_.turned.end(), 1) == out_.turned.end()) return;
    const auto turn_all = [&] {
      for (std::size_t t = 0; t < out_.turned.size(); ++t)
        if (out_.turned[t] != 0) std::swap(mesh().triangles[t][1], mesh().triangles[t][2]);
    };
    turn_all();
    mesh() = weld(mesh());
    turn_all();
    find_edges();
  }

  void find_border() {
    out_.border.assign(mesh().vertices.size(), 0);
    std::size_t open = 0;
    for_each_edge([&](std::span<const EdgeUse> e) {
      if (balanced(e)) return;
      out_.border[e[0].lo] = out_.border[e[0].hi] = 1;
      ++open;
    });
    out_.closed = open == 0;
    if (out_.closed) return;
    if (options_.require_closed)
      throw Error(ErrorCode::InvalidInput, "the mesh is open at " +
                                               count_of(open, "edge", "edges") +
                                               " and bounds no solid; close it, or leave out "
                                               "--require-closed to keep its border in place");
    out_.notes.push_back("the mesh is open at " + count_of(open, "edge", "edges") +
                         " and bounds no solid");
  }

  PrepareOptions options_;
  Prepared out_;
  std::vector<EdgeUse> edges_;
  std::optional<Coincident> coincident_;  // of the mesh with these edges
};

}  // namespace

Prepared prepare(const Mesh& input, const PrepareOptions& options) {
  return Preparation(input, options).run();
}

}  // namespace kaboum::geom
