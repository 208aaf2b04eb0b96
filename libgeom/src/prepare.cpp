// Preparation: from the triangles of a file to a mesh whose solid is the one that is meant.
// docs/algorithms/preparation.md.
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/geom/holes.h>
#include <kaboum/geom/hollows.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <map>
#include <numeric>
#include <optional>
#include <sstream>

#include "shells.h"

namespace kaboum::geom {
namespace {

std::string count_of(std::size_t n, const char* singular, const char* plural) {
  return std::to_string(n) + " " + (n == 1 ? singular : plural);
}

std::string text_of(const Vec3& p) {
  std::ostringstream s;
  s.precision(6);
  s << '(' << p.x() << ", " << p.y() << ", " << p.z() << ')';
  return s.str();
}

std::string text_of(double x) {
  std::ostringstream s;
  s.precision(4);
  s << x;
  return s.str();
}

class Preparation {
 public:
  Preparation(const Mesh& input, const PrepareOptions& options) : options_(options) {
    require_valid(input);
    require_moderate(input);
    out_.mesh = weld(input);
    input_triangles_ = static_cast<std::uint32_t>(input.triangles.size());
    const std::size_t n = out_.mesh.triangles.size();
    out_.source.resize(n);
    std::iota(out_.source.begin(), out_.source.end(), 0U);
    out_.turned.assign(n, 0);
    agreed_.assign(n, 0);
    opened_.assign(n, 0);
  }

  Prepared run() {
    drop_collapsed();
    if (out_.mesh.empty())
      throw Error(ErrorCode::InvalidInput, "the mesh has no triangle with three different corners");
    edges_ = edge_uses(out_.mesh);
    if (!options_.keep_orientation) agree_with_neighbours();
    cancel_pairs();
    if (options_.holes == Holes::Fill) fill();
    turn_shells();
    drop_copies();
    judge_pairs();
    number_by_first_use();
    parallel_calls([&] { find_border(); },
                   [&] { components(edges_, mesh().triangles.size(), &out_.components); });
    if (options_.keep_orientation && out_.closed && !(signed_volume(out_.mesh) > 0))
      out_.notes.push_back(
          "the signed volume is not positive: as oriented, the mesh bounds little or no "
          "solid, and what is certified of its solid says nothing of its surface");
    settle_filled();
    find_hollows();
    find_inverted();
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
        if (out_.turned[t] != 0 && out_.source[t] != kFilled)
          out_.turned_and_dropped.push_back(out_.source[t]);
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
        edges_, [&](std::span<const EdgeUse> e) { inconsistent += !balanced(e) && neighbours(e); });
    if (inconsistent == 0) return;

    const std::size_t n = mesh().triangles.size();
    struct Neighbour {
      std::uint32_t triangle = ~0U;
      bool agrees = true;
    };
    std::vector<std::array<Neighbour, 3>> across(n);
    for_each_edge(edges_, [&](std::span<const EdgeUse> e) {
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
      bool turned = false;
      for (const std::uint32_t t : patch)
        if (sense[t] == against) {
          turn(t);
          turned = true;
        }
      if (turned)
        for (const std::uint32_t t : patch) agreed_[out_.source[t]] = 1;
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
    for_each_edge(edges_, [&](std::span<const EdgeUse> e) {
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
      if (candidate[t] == 0 || out_.source[t] == kFilled) continue;
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

  /// Opposite pairs add nothing to the chain. They are judged when its solid is known.
  void cancel_pairs() {
    const std::vector<std::uint32_t> pairs = coincident().pairs;
    if (pairs.empty()) return;
    std::vector<char> keep(mesh().triangles.size(), 1);
    for (const std::uint32_t t : pairs) {
      const Triangle& tri = mesh().triangles[t];
      keep[t] = 0;
      cancelled_.push_back(
          {out_.source[t],
           {mesh().vertices[tri[0]], mesh().vertices[tri[1]], mesh().vertices[tri[2]]}});
    }
    filter(keep);
    if (mesh().empty() && !options_.drop_sheets) refuse_sheets(cancelled_);
    if (mesh().empty())
      throw Error(ErrorCode::InvalidInput,
                  "nothing is left once opposite coincident faces cancel; the input has no volume");
  }

  /// Inside the rest's solid, opposite pairs are walls between touching bodies; elsewhere they are
  /// sheets, which no solid protects.
  void judge_pairs() {
    if (cancelled_.empty()) return;
    const WindingNumber winding(mesh());
    std::vector<Cancelled> sheets;
    for (const Cancelled& c : cancelled_) {
      const auto& corners = c.corners;
      const auto outside = [&](const Vec3& p) { return winding(p).value_or(1) <= 0; };
      if (outside((corners[0] + corners[1] + corners[2]) / 3.0) ||
          std::any_of(corners.begin(), corners.end(), outside))
        sheets.push_back(c);
    }
    if (!sheets.empty() && !options_.drop_sheets) refuse_sheets(sheets);
    out_.dropped_sheets = sheets.size();
    out_.cancelled_walls = cancelled_.size() - sheets.size();
    if (!sheets.empty())
      out_.notes.push_back(count_of(sheets.size(), "triangle", "triangles") +
                           " of sheets without volume dropped on request: they are NOT enclosed");
    if (out_.cancelled_walls != 0)
      out_.notes.push_back(count_of(out_.cancelled_walls, "triangle", "triangles") +
                           " of walls between touching bodies cancelled");
  }

  struct Cancelled {
    std::uint32_t source;
    std::array<Vec3, 3> corners;
  };

  [[noreturn]] static void refuse_sheets(const std::vector<Cancelled>& sheets) {
    std::uint32_t first = kFilled;
    for (const Cancelled& c : sheets) first = std::min(first, c.source);
    throw Error(ErrorCode::InvalidInput,
                count_of(sheets.size(), "face lies", "faces lie") +
                    " back to back with an opposite copy and no volume between (sheets; the first "
                    "is input triangle " +
                    std::to_string(first) +
                    "); give the sheets a thickness, or drop them with --drop-sheets: they are "
                    "then not enclosed");
  }

  void fill() {
    FilledHoles filled = fill_holes(mesh());
    if (filled.holes == 0) return;
    judge_rims();
    const Chains chains = find_chains(mesh(), edges_);
    for (std::size_t t = 0; t < out_.source.size(); ++t)
      if (chains.closed[chains.label[t]] == 0) opened_[out_.source[t]] = 1;
    out_.holes = filled.holes;
    name_rims(filled.rims);
    out_.largest_hole = filled.largest;
    mesh() = std::move(filled.mesh);
    out_.source.resize(mesh().triangles.size(), kFilled);
    out_.turned.resize(mesh().triangles.size(), 0);
    std::vector<char> keep(mesh().triangles.size(), 1);
    mesh() = weld(mesh());  // a middle may lie on a vertex
    for (std::size_t t = 0; t < keep.size(); ++t) {
      const Triangle& tri = mesh().triangles[t];
      keep[t] = tri[0] != tri[1] && tri[1] != tri[2] && tri[2] != tri[0] ? 1 : 0;
    }
    filter(keep);
    was_open_.assign(out_.source.size(), 1);
    for (std::size_t t = 0; t < out_.source.size(); ++t)
      if (out_.source[t] != kFilled) was_open_[t] = opened_[out_.source[t]] != 0 ? 1 : 0;
    const auto triangles =
        static_cast<std::size_t>(std::count(out_.source.begin(), out_.source.end(), kFilled));
    out_.notes.push_back(count_of(filled.holes, "hole is", "holes are") + " filled with " +
                         count_of(triangles, "triangle", "triangles") +
                         (filled.holes == 1 ? ", " : ", the largest ") + text_of(filled.largest) +
                         " across near " + text_of(filled.largest_at) +
                         ": what is said of the solid is about the one so closed");
  }

  /// Where three triangles or more meet and do not balance, a hole's rim runs along a wall: which
  /// side of the wall has the hole depends on its orientation.
  void judge_rims() {
    std::optional<std::uint32_t> found;
    for_each_edge(edges_, [&](std::span<const EdgeUse> e) {
      if (e.size() < 3 || balanced(e)) return;
      for (const EdgeUse& u : e) {
        found = found.value_or(out_.source[u.triangle]);
        if (agreed_[out_.source[u.triangle]] == 0) continue;
        throw Error(ErrorCode::InvalidInput,
                    "a hole's rim runs along a wall that several bodies share, at input triangle " +
                        std::to_string(out_.source[u.triangle]) +
                        ", and triangles there were turned to agree with their neighbours: which "
                        "body the hole is in cannot be told; close the hole, give each body a mesh "
                        "of its own, or orient all normals outwards");
      }
    });
    if (found)
      out_.notes.push_back(
          "WARNING: a hole's rim runs along a wall, where three triangles or more "
          "meet (at input triangle " +
          std::to_string(*found) +
          "): which side of the wall is filled depends on its orientation");
  }

  /// A vertex is named by the first corner of the input that is there, as the input orients it.
  void name_rims(const std::vector<std::vector<std::uint32_t>>& rims) {
    std::vector<std::uint32_t> corner(mesh().vertices.size(), ~0U);
    for (std::size_t t = mesh().triangles.size(); t-- > 0;)
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t in_input = out_.turned[t] != 0 && k != 0 ? 3 - k : k;
        corner[mesh().triangles[t][k]] = 3 * out_.source[t] + in_input;
      }
    for (const auto& rim : rims) {
      auto& named = out_.rims.emplace_back();
      for (const std::uint32_t v : rim) named.push_back(corner[v]);
    }
  }

  /// Sources are of the input alone.
  void settle_filled() {
    const auto first = std::find(out_.source.begin(), out_.source.end(), kFilled);
    out_.filled_triangles = static_cast<std::size_t>(out_.source.end() - first);
    if (out_.filled_triangles == 0) return;
    std::vector<char> used(mesh().vertices.size(), 0);
    for (std::size_t t = 0; t + out_.filled_triangles < out_.source.size(); ++t)
      for (const std::uint32_t v : mesh().triangles[t]) used[v] = 1;
    out_.filled_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), 0));
    std::fill(out_.turned.begin() + (first - out_.source.begin()), out_.turned.end(), 0);
    out_.source.erase(first, out_.source.end());
  }

  /// Drops copies whose edges balance among the dropped ones alone, component by component. A copy
  /// lowers the winding number inside; that leaves the solid alone only where nothing else lowers
  /// it, so copies stay if any component is oriented inwards.
  void drop_copies() {
    const std::vector<std::uint32_t> copies = coincident().copies;
    if (copies.empty()) return;
    const Chains chains = find_chains(mesh(), edges_);
    if (std::find(chains.sign.begin(), chains.sign.end(), -1) != chains.sign.end()) return;
    std::vector<char> keep(mesh().triangles.size(), 1);
    Mesh dropped{mesh().vertices, {}};
    for (const std::uint32_t t : copies) dropped.triangles.push_back(mesh().triangles[t]);
    std::uint32_t count = 0;
    const std::vector<std::uint32_t> label = components(dropped, true, &count);
    std::vector<char> closed(count, 1);
    for_each_edge(edge_uses(dropped), [&](std::span<const EdgeUse> e) {
      if (!balanced(e)) closed[label[e[0].triangle]] = 0;
    });
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

  /// Turns the shells that are inside out.
  void turn_shells() {
    const Judgement judged = judge_shells(mesh(), edges_, was_open_);
    if (options_.keep_orientation) {
      if (!judged.inside_out.empty())
        out_.notes.push_back(count_of(judged.inside_out.size(), "component is", "components are") +
                             " inside out, the first at input triangle " +
                             source_text(judged.inside_out[0]) +
                             ", and kept so: what it encloses counts as outside");
      return;
    }
    if (judged.left && judged.left->at_wall)
      refuse_wall("at input triangle " + source_text(judged.left->triangle) + " near " +
                  text_of(judged.left->at));
    if (judged.left) {
      out_.notes.push_back("the surface crosses itself, and what it encloses near " +
                           text_of(judged.left->at) +
                           " is inside out: that part counts as outside");
      out_.hollow = judged.left->at;
    }
    if (judged.inside_out.empty()) return;
    out_.turned_components = judged.inside_out.size();
    out_.turned_cavities = judged.cavities_turned;
    for (const std::uint32_t t : judged.inside_out)
      if (out_.source[t] != kFilled) out_.inside_out.push_back(out_.source[t]);
    const auto first_fill = static_cast<std::uint32_t>(
        std::find(out_.source.begin(), out_.source.end(), kFilled) - out_.source.begin());
    for (std::uint32_t t = 0; t < judged.turn.size(); ++t) {
      if (judged.turn[t] == 0) continue;
      turn(t);
      if (out_.holes != 0)
        out_.turned_after_filling.push_back(t < first_fill ? out_.source[t]
                                                           : input_triangles_ + t - first_fill);
    }
    find_edges();
    cancel_pairs();  // walls that are opposite now
    out_.notes.push_back(
        count_of(out_.turned_components, "component was", "components were") +
        " inside out and turned" +
        (out_.turned_cavities == 0
             ? ""
             : ", with " + count_of(out_.turned_cavities, "cavity", "cavities") + " inside"));
  }

  /// Looks at the walls that have cancelled as well: they tell that parts met there.
  void find_hollows() {
    bool branched = !cancelled_.empty();
    for_each_edge(edges_, [&](std::span<const EdgeUse> e) { branched = branched || e.size() > 2; });
    if (!out_.closed || !branched) return;
    Mesh walls = mesh();
    for (const Cancelled& c : cancelled_) {
      const auto n = static_cast<std::uint32_t>(walls.vertices.size());
      walls.vertices.insert(walls.vertices.end(), c.corners.begin(), c.corners.end());
      walls.triangles.push_back({n, n + 1, n + 2});
    }
    if (!cancelled_.empty()) walls = weld(walls);
    const std::optional<Hollow> hollow = find_hollow(walls);
    if (!hollow) return;
    if (hollow->at_wall && !options_.keep_orientation && !options_.drop_sheets)
      refuse_wall(where(*hollow));
    if (out_.hollow) return;
    out_.hollow = hollow->at;
    out_.notes.push_back("parts that share edges enclose a hollow " + where(*hollow) +
                         ", which need not be a cavity: that part counts as outside");
  }

  /// Parts that were open, or that were turned to agree, are judged by themselves: their holes'
  /// fill and the edges that they agree at are guesses. Where one of them winds backwards round a
  /// point, the guess joined bodies against each other; where the point is inside another body,
  /// that would be hollow. Then the whole, where a surface crosses itself.
  void find_inverted() {
    if (!out_.closed || options_.keep_orientation) return;
    const std::vector<std::uint32_t> part = components(edges_, mesh().triangles.size(), nullptr);
    std::vector<char> is_guessed(part.size(), 0);
    std::vector<std::uint32_t> agreed, guessed, all(part.size());
    std::iota(all.begin(), all.end(), 0U);
    for (std::uint32_t t = 0; t < out_.source.size(); ++t) {
      if (agreed_[out_.source[t]] != 0) agreed.push_back(t);
      if (agreed_[out_.source[t]] != 0 || opened_[out_.source[t]] != 0) is_guessed[part[t]] = 1;
    }
    warn_of_guess(part);
    std::copy_if(all.begin(), all.end(), std::back_inserter(guessed),
                 [&](std::uint32_t t) { return is_guessed[part[t]] != 0; });
    const WindingNumber winding(mesh());
    if (const auto found = geom::find_inverted(mesh(), winding, some_of(agreed, part), part))
      throw Error(ErrorCode::InvalidInput,
                  "triangles were turned to agree with their neighbours, and what they enclose is "
                  "inside out now, " +
                      where(*found) +
                      ": bodies that share an edge cannot be told apart; give each body a mesh of "
                      "its own, or orient all normals outwards");
    if (out_.hollow) return;
    std::optional<Hollow> found =
        geom::find_inverted(mesh(), winding, some_of(guessed, part), part);
    if (!found) found = geom::find_inverted(mesh(), winding, some_of(all, {}));
    if (!found) return;
    out_.hollow = found->at;
    out_.notes.push_back("WARNING: the surface crosses itself, and what it encloses " +
                         where(*found) +
                         " is inside out: that part counts as outside, and is NOT enclosed");
  }

  /// Without edges at which several sheets meet, a part can be turned to agree in one way only.
  void warn_of_guess(const std::vector<std::uint32_t>& part) {
    std::map<std::uint32_t, char> branched;
    for_each_edge(edges_, [&](std::span<const EdgeUse> e) {
      if (e.size() > 2) branched[part[e[0].triangle]] = 1;
    });
    for (std::uint32_t t = 0; t < out_.source.size(); ++t) {
      const std::uint32_t s = out_.source[t];
      if (agreed_[s] == 0 || opened_[s] == 0 || !branched.contains(part[t])) continue;
      out_.notes.push_back(
          "WARNING: the part with input triangle " + std::to_string(s) +
          " was open, and its triangles were turned to agree: which solid it bounds is a guess");
      return;
    }
  }

  /// Of each part at most 20,000 triangles, evenly; without parts, of all.
  static std::vector<std::uint32_t> some_of(const std::vector<std::uint32_t>& triangles,
                                            const std::vector<std::uint32_t>& part) {
    constexpr std::size_t kMost = 20'000;
    std::map<std::uint32_t, std::size_t> size, seen;
    const auto part_of = [&](std::uint32_t t) { return part.empty() ? 0 : part[t]; };
    for (const std::uint32_t t : triangles) ++size[part_of(t)];
    std::vector<std::uint32_t> some;
    for (const std::uint32_t t : triangles)
      if (seen[part_of(t)]++ % (1 + size[part_of(t)] / kMost) == 0) some.push_back(t);
    return some;
  }

  [[nodiscard]] std::string where(const Hollow& found) const {
    return (found.triangle < out_.source.size()
                ? "at input triangle " + std::to_string(out_.source[found.triangle]) + " "
                : "") +
           "near " + text_of(found.at);
  }

  [[noreturn]] static void refuse_wall(const std::string& where) {
    throw Error(ErrorCode::InvalidInput,
                "bodies that share a wall are oriented against each other and cannot be told "
                "apart, " +
                    where +
                    ": one of them would count as hollow; orient all normals outwards, or give "
                    "each body a mesh of its own");
  }

  [[nodiscard]] std::string source_text(std::uint32_t t) const {
    return out_.source[t] == kFilled ? "(of a filled hole)" : std::to_string(out_.source[t]);
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
    for_each_edge(edges_, [&](std::span<const EdgeUse> e) {
      if (balanced(e)) return;
      out_.border[e[0].lo] = out_.border[e[0].hi] = 1;
      ++open;
    });
    out_.closed = open == 0;
    if (out_.closed) return;
    if (options_.holes == Holes::Refuse)
      throw Error(ErrorCode::InvalidInput,
                  "the mesh is open at " + count_of(open, "edge", "edges") +
                      " and bounds no solid; close it, or have its holes filled (--holes fill)");
    ensure(options_.holes == Holes::Keep, "a mesh whose holes are filled is still open");
    out_.notes.push_back("the mesh is open at " + count_of(open, "edge", "edges") +
                         " and bounds no solid");
  }

  /// The source of triangles that fill holes; a mesh has fewer triangles.
  static constexpr std::uint32_t kFilled = ~0U;

  PrepareOptions options_;
  Prepared out_;
  std::uint32_t input_triangles_ = 0;
  std::vector<Cancelled> cancelled_;
  std::vector<char> agreed_, opened_;  // per input triangle: its part was turned to agree, was open
  std::vector<EdgeUse> edges_;
  std::vector<std::uint32_t> was_open_;   // per triangle, when holes are filled: before that
  std::optional<Coincident> coincident_;  // of the mesh with these edges
};

}  // namespace

Prepared prepare(const Mesh& input, const PrepareOptions& options) {
  return Preparation(input, options).run();
}

}  // namespace kaboum::geom
