#include <kaboum/geom/error.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <numeric>

namespace kaboum::geom {
namespace {

std::string count_of(std::size_t n, const char* singular, const char* plural) {
  return std::to_string(n) + " " + (n == 1 ? singular : plural);
}

class Preparation {
 public:
  Preparation(const Mesh& input, const PrepareOptions& options) : options_(options) {
    require_valid(input);
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
    cancel_coincident();
    if (!options_.keep_orientation) turn_components();
    number_by_first_use();
    find_border();
    components(out_.mesh, true, &out_.components);
    out_.turned_triangles =
        static_cast<std::size_t>(std::count(out_.turned.begin(), out_.turned.end(), 1));
    return std::move(out_);
  }

 private:
  Mesh& mesh() { return out_.mesh; }

  void turn(std::uint32_t t) {
    std::swap(mesh().triangles[t][1], mesh().triangles[t][2]);
    out_.turned[t] ^= 1;
  }

  /// Keeps the triangles with keep[t] != 0, and the vertices they use.
  void filter(const std::vector<char>& keep) {
    std::size_t n = 0;
    for (std::size_t t = 0; t < keep.size(); ++t) {
      if (keep[t] == 0) continue;
      mesh().triangles[n] = mesh().triangles[t];
      out_.source[n] = out_.source[t];
      out_.turned[n] = out_.turned[t];
      ++n;
    }
    mesh().triangles.resize(n);
    out_.source.resize(n);
    out_.turned.resize(n);
    mesh() = weld(mesh());
    edges_ = edge_uses(mesh());
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

  /// Patches connected through edges with exactly two triangles are oriented consistently, by the
  /// orientation that most of their area has already.
  void agree_with_neighbours() {
    std::size_t inconsistent = 0;
    for_each_edge(
        [&](std::span<const EdgeUse> e) { inconsistent += e.size() == 2 && !balanced(e); });
    if (inconsistent == 0) return;

    const std::size_t n = mesh().triangles.size();
    struct Neighbour {
      std::uint32_t triangle = ~0U;
      bool agrees = true;
    };
    std::vector<std::array<Neighbour, 3>> across(n);
    for_each_edge([&](std::span<const EdgeUse> e) {
      if (e.size() != 2) return;
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
    edges_ = edge_uses(mesh());
    out_.notes.push_back(count_of(inconsistent, "edge", "edges") +
                         " with neighbours of opposite orientation: triangles turned to agree");
  }

  struct Coincident {
    std::vector<std::uint32_t> pairs;   // triangles in opposite pairs
    std::vector<std::uint32_t> copies;  // further triangles like one that stays
  };

  Coincident find_coincident() {
    std::vector<std::pair<Triangle, std::uint32_t>> keyed;
    keyed.reserve(mesh().triangles.size());
    const auto even = [](const Triangle& t, const Triangle& sorted) {
      return (t[0] == sorted[0] && t[1] == sorted[1]) || (t[1] == sorted[0] && t[2] == sorted[1]) ||
             (t[2] == sorted[0] && t[0] == sorted[1]);
    };
    // Only triangles that share their lowest edge with another can coincide.
    std::vector<char> candidate(mesh().triangles.size(), 0);
    for_each_edge([&](std::span<const EdgeUse> e) {
      for (std::size_t i = 0; i < e.size(); ++i)
        for (std::size_t j = i + 1; j < e.size(); ++j) {
          const auto opposite = [&](const EdgeUse& u) {
            return mesh().triangles[u.triangle][(u.corner + 2) % 3];
          };
          if (opposite(e[i]) == opposite(e[j]))
            candidate[e[i].triangle] = candidate[e[j].triangle] = 1;
        }
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

  void cancel_coincident() {
    const Coincident found = find_coincident();
    if (found.pairs.empty() && found.copies.empty()) return;
    std::vector<char> keep(mesh().triangles.size(), 1);
    drop_pairs(found.pairs, keep);
    drop_copies(found.copies, keep);
    filter(keep);
    if (mesh().empty())
      throw Error(ErrorCode::InvalidInput,
                  "nothing is left once opposite coincident faces cancel; the input has no volume");
  }

  /// Opposite pairs add nothing to the chain. Inside the rest's solid they are walls between
  /// touching bodies; elsewhere they are sheets, which no solid protects.
  void drop_pairs(const std::vector<std::uint32_t>& pairs, std::vector<char>& keep) {
    if (pairs.empty()) return;
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

  /// Drops copies whose edges balance among the dropped ones alone, component by component.
  void drop_copies(const std::vector<std::uint32_t>& copies, std::vector<char>& keep) {
    if (copies.empty()) return;
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
    if (out_.dropped_copies != 0)
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
    for (bool changed = true; changed;) {
      changed = false;
      for_each_edge([&](std::span<const EdgeUse> e) {
        if (e.size() <= 2 || !balanced(e)) return;
        for (const EdgeUse& u : e) {
          const std::uint32_t root = find(u.triangle);
          int sum = 0;
          for (const EdgeUse& x : e)
            if (find(x.triangle) == root) sum += x.forward ? 1 : -1;
          if (sum == 0) continue;
          for (const EdgeUse& x : e)
            if (find(x.triangle) != root) {
              join(root, x.triangle);
              changed = true;
            }
          return;
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

  void turn_components() {
    std::vector<char> closed;
    const std::vector<std::uint32_t> label = closed_components(closed);
    const std::size_t count = closed.size();
    const Vec3 origin = bounding_box(mesh()).center();
    std::vector<double> volume(count, 0);
    for (std::size_t t = 0; t < label.size(); ++t) {
      const Triangle& tri = mesh().triangles[t];
      const Vec3 a = mesh().vertices[tri[0]] - origin, b = mesh().vertices[tri[1]] - origin,
                 c = mesh().vertices[tri[2]] - origin;
      volume[label[t]] += a.dot(b.cross(c));
    }
    const auto inward = [&](std::uint32_t c) { return closed[c] != 0 && volume[c] < 0; };
    bool any = false;
    for (std::uint32_t c = 0; c < count; ++c) any = any || inward(c);
    if (!any) return;

    std::vector<std::vector<std::uint32_t>> members(count);
    for (std::uint32_t t = 0; t < label.size(); ++t) members[label[t]].push_back(t);
    std::vector<std::uint32_t> by_size(count);
    std::iota(by_size.begin(), by_size.end(), 0U);
    std::stable_sort(by_size.begin(), by_size.end(), [&](std::uint32_t a, std::uint32_t b) {
      return std::abs(volume[a]) > std::abs(volume[b]);
    });
    const WindingNumber winding(mesh());
    std::vector<std::int8_t> weight(label.size(), 1);
    for (std::size_t t = 0; t < label.size(); ++t)
      if (closed[label[t]] == 0) weight[t] = 0;
    const auto set_weight = [&](std::uint32_t c, std::int8_t w) {
      for (const std::uint32_t t : members[c]) weight[t] = w;
    };
    const auto corner = [&](std::uint32_t t) -> const Vec3& {
      return mesh().vertices[mesh().triangles[t][0]];
    };
    std::vector<std::int8_t> sense(count, 1);
    std::vector<std::int8_t> only(label.size(), 0);
    for (const std::uint32_t c : by_size) {
      if (!inward(c)) continue;
      // Inside out unless it lies in a solid everywhere: then it is a cavity.
      set_weight(c, 0);
      const bool cavity = std::all_of(members[c].begin(), members[c].end(), [&](std::uint32_t t) {
        return winding.weighted(corner(t), weight).value_or(1) >= 1;
      });
      set_weight(c, sense[c]);
      if (cavity) continue;
      ++out_.turned_components;
      for (const std::uint32_t t : members[c]) only[t] = 1;
      for (std::uint32_t d = 0; d < count; ++d) {
        if (closed[d] == 0) continue;
        if (d != c) {
          std::optional<int> around;
          for (const std::uint32_t t : members[d])
            if ((around = winding.weighted(corner(t), only))) break;
          if (around.value_or(0) == 0) continue;
        }
        sense[d] = static_cast<std::int8_t>(-sense[d]);
        volume[d] = -volume[d];
        set_weight(d, sense[d]);
      }
      for (const std::uint32_t t : members[c]) only[t] = 0;
    }
    for (std::uint32_t t = 0; t < label.size(); ++t)
      if (sense[label[t]] < 0) turn(t);
    if (out_.turned_components == 0) return;
    edges_ = edge_uses(mesh());
    out_.notes.push_back(count_of(out_.turned_components, "component was", "components were") +
                         " inside out and turned, with what is nested inside");
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
    edges_ = edge_uses(mesh());
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
                         ": border vertices stay where they are, and enclosure is claimed of the "
                         "generalised winding number only");
  }

  PrepareOptions options_;
  Prepared out_;
  std::vector<EdgeUse> edges_;
};

}  // namespace

Prepared prepare(const Mesh& input, const PrepareOptions& options) {
  return Preparation(input, options).run();
}

}  // namespace kaboum::geom
