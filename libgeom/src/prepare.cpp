// Preparation: from the triangles of a file to a mesh whose solid is the one that is meant.
// docs/algorithms/preparation.md.
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/geom/holes.h>
#include <kaboum/geom/hollows.h>
#include <kaboum/geom/moderate.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/geom/topology.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <numeric>
#include <optional>
#include <sstream>

#include "chains.h"
#include "coincident.h"
#include "guesses.h"
#include "neighbours.h"
#include "prepare_words.h"
#include "rims.h"
#include "shells.h"
#include "solid_mesh_maker.h"

namespace kaboum::geom {

void require_moderate(const Mesh& mesh) {
  const Box3 box = bounding_box(mesh);
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

namespace {

/// The steps of preparation, and what each of them notes.
class Preparation {
 public:
  Preparation(const Mesh& input, const PrepareOptions& options, const LooseTriangles& loose)
      : options_(options), loose_(loose) {
    require_valid(input);
    require_moderate(input);
    mesh_ = weld(input);
    input_triangles_ = static_cast<std::uint32_t>(input.triangles.size());
    const std::size_t n = mesh_.triangles.size();
    report_.source.resize(n);
    std::iota(report_.source.begin(), report_.source.end(), 0U);
    report_.reversed.assign(n, 0);
    agreed_.assign(n, 0);
    opened_.assign(n, 0);
  }

  Prepared run() {
    drop_collapsed();
    if (mesh_.empty())
      throw Error(ErrorCode::InvalidInput, "the mesh has no triangle with three different corners");
    edges_ = edge_uses(mesh_);
    if (!options_.keep_orientation) agree();
    cancel_pairs();
    drop_copies(true);
    if (options_.holes == Holes::Fill) fill();
    reverse_shells();
    drop_copies(false);
    sort_out_pairs();
    choose_diagonals();
    number_by_first_use();
    parallel_invoke(
        [&] { find_border(); },
        [&] { part_ = components(edges_, mesh_.triangles.size(), &report_.components); });
    if (options_.keep_orientation && closed_ && !(signed_volume(mesh_) > 0))
      report_.notes.push_back(
          "the signed volume is not positive: as oriented, the mesh bounds little or no "
          "solid, and what is certified of its solid says nothing of its surface");
    count_filled();
    find_hollows();
    find_inverted();
    report_.reversed_triangles =
        static_cast<std::size_t>(std::count(report_.reversed.begin(), report_.reversed.end(), 1));
    return {SolidMeshMaker::make(std::move(mesh_), std::move(border_), closed_, filled_triangles_),
            std::move(report_)};
  }

 private:
  void find_edges() {
    coincident_.reset();
    std::vector<EdgeUse>().swap(edges_);  // first, for they are large
    edges_ = edge_uses(mesh_);
  }

  void reverse(std::uint32_t t) {
    std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
    report_.reversed[t] ^= 1;
  }

  /// Keeps the triangles with keep[t] != 0, and the vertices they use.
  void filter(const std::vector<char>& keep) {
    std::size_t n = 0;
    for (std::size_t t = 0; t < keep.size(); ++t) {
      if (keep[t] == 0) {
        if (report_.reversed[t] != 0 && report_.source[t] != kFilled)
          report_.reversed_and_dropped.push_back(report_.source[t]);
        continue;
      }
      mesh_.triangles[n] = mesh_.triangles[t];
      report_.source[n] = report_.source[t];
      report_.reversed[n] = report_.reversed[t];
      ++n;
    }
    mesh_.triangles.resize(n);
    report_.source.resize(n);
    report_.reversed.resize(n);
    mesh_ = weld(mesh_);
    find_edges();
  }

  void drop_collapsed() {
    std::vector<char> keep(mesh_.triangles.size(), 1);
    for (std::size_t t = 0; t < keep.size(); ++t) {
      const Triangle& tri = mesh_.triangles[t];
      if (tri[0] == tri[1] || tri[1] == tri[2] || tri[2] == tri[0]) {
        keep[t] = 0;
        ++report_.collapsed_triangles;
        report_.left_out.push_back(
            {report_.source[t],
             {mesh_.vertices[tri[0]], mesh_.vertices[tri[1]], mesh_.vertices[tri[2]]}});
      }
    }
    if (report_.collapsed_triangles == 0) return;
    filter(keep);
    report_.notes.push_back(count_of(report_.collapsed_triangles, "triangle", "triangles") +
                            " with repeated corners dropped");
  }

  void agree() {
    const Agreement agreement = agree_with_neighbours(mesh_, edges_, report_.source);
    if (agreement.inconsistent == 0) return;
    for (const std::uint32_t t : agreement.reverse) reverse(t);
    for (const std::uint32_t t : agreement.affected) agreed_[report_.source[t]] = 1;
    find_edges();
    report_.notes.push_back(count_of(agreement.inconsistent, "edge", "edges") +
                            " with neighbours of opposite orientation: triangles turned to agree");
  }

  /// Found once for each state of the mesh.
  const Coincident& coincident() {
    if (!coincident_) coincident_ = find_coincident(mesh_, edges_, report_.source);
    return *coincident_;
  }

  /// Opposite pairs add nothing to the chain. They are judged when its solid is known.
  void cancel_pairs() {
    const std::vector<std::uint32_t> pairs = coincident().pairs;
    if (pairs.empty()) return;
    std::vector<char> keep(mesh_.triangles.size(), 1);
    for (const std::uint32_t t : pairs) {
      const Triangle& tri = mesh_.triangles[t];
      keep[t] = 0;
      cancelled_.push_back(
          {report_.source[t],
           {mesh_.vertices[tri[0]], mesh_.vertices[tri[1]], mesh_.vertices[tri[2]]}});
    }
    filter(keep);
    if (mesh_.empty() && !options_.drop_sheets) refuse_sheets(cancelled_);
    if (mesh_.empty())
      throw Error(ErrorCode::InvalidInput,
                  "nothing is left once opposite coincident faces cancel; the input has no volume");
  }

  /// Walls between touching bodies go, sheets only on request.
  void sort_out_pairs() {
    if (cancelled_.empty()) return;
    const std::vector<Cancelled> sheets = find_sheets(mesh_, cancelled_);
    if (!sheets.empty() && !options_.drop_sheets) refuse_sheets(sheets);
    report_.dropped_sheets = sheets.size();
    report_.cancelled_walls = cancelled_.size() - sheets.size();
    auto sheet = sheets.begin();  // in the order of the cancelled ones
    for (const Cancelled& c : cancelled_) {
      const bool is_sheet = sheet != sheets.end() && sheet->source == c.source;
      if (is_sheet) ++sheet;
      if (!is_sheet && c.source != kFilled) report_.left_out.push_back({c.source, c.corners});
    }
    if (!sheets.empty())
      report_.notes.push_back(
          count_of(sheets.size(), "triangle", "triangles") +
          " of sheets without volume dropped on request: they are NOT enclosed");
    if (report_.cancelled_walls != 0)
      report_.notes.push_back(count_of(report_.cancelled_walls, "triangle", "triangles") +
                              " of walls between touching bodies cancelled");
  }

  /// Splits quads along the diagonal that is asked for, where both of their triangles are left and
  /// agree. The chain's border stays, and so does all but the tetrahedra of the quads' corners.
  void choose_diagonals() {
    using Diagonal = PrepareOptions::Diagonal;
    if (options_.diagonal == Diagonal::AsGiven || options_.quads.empty()) return;
    const Sign wanted = options_.diagonal == Diagonal::Outward ? Sign::Negative : Sign::Positive;
    std::vector<std::uint32_t> place(std::size_t{input_triangles_} + 1, kFilled);
    for (std::uint32_t t = 0; t < report_.source.size(); ++t)
      if (report_.source[t] != kFilled) place[report_.source[t]] = t;
    for (const std::uint32_t quad : options_.quads) {
      if (quad + 1 >= input_triangles_) continue;
      const std::uint32_t i = place[quad], j = place[quad + 1];
      if (i == kFilled || j == kFilled) continue;
      Triangle &s = mesh_.triangles[i], &t = mesh_.triangles[j];
      // s = (a, b, c), t = (c, d, a), in some order of each.
      int k = 0;
      while (k < 3 && std::find(t.begin(), t.end(), s[k]) != t.end()) ++k;
      if (k == 3) continue;
      const std::uint32_t b = s[k], c = s[(k + 1) % 3], a = s[(k + 2) % 3];
      int l = 0;
      while (l < 3 && (t[l] == a || t[l] == c)) ++l;
      if (l == 3 || t[(l + 1) % 3] != a || t[(l + 2) % 3] != c) continue;
      const std::uint32_t d = t[l];
      // Beyond the plane of (a, b, c), the quad is a valley along a–c: the other diagonal lies
      // outwards.
      const Sign side =
          orient3d(mesh_.vertices[a], mesh_.vertices[b], mesh_.vertices[c], mesh_.vertices[d]);
      if (side == Sign::Zero || side == wanted || b == d) continue;
      s = {a, b, d};
      t = {b, c, d};
      ++report_.quads_split_anew;
    }
    if (report_.quads_split_anew > 0) find_edges();
  }

  void fill() {
    FilledHoles filled = fill_holes(mesh_);
    if (filled.holes == 0) return;
    if (const auto found = judge_rims(edges_, report_.source, agreed_))
      guess(
          "a hole's rim runs along a wall, where three triangles or more meet (at input triangle " +
          std::to_string(*found) +
          "): which side of the wall is filled depends on its orientation");
    const Chains chains = find_chains(mesh_, edges_);
    for (std::size_t t = 0; t < report_.source.size(); ++t)
      if (chains.closed[chains.label[t]] == 0) opened_[report_.source[t]] = 1;
    report_.holes = filled.holes;
    report_.rims = name_rims(filled.rims, mesh_, report_.source, report_.reversed);
    report_.largest_hole = filled.largest;
    mesh_ = std::move(filled.mesh);
    report_.source.resize(mesh_.triangles.size(), kFilled);
    report_.reversed.resize(mesh_.triangles.size(), 0);
    std::vector<char> keep(mesh_.triangles.size(), 1);
    mesh_ = weld(mesh_);  // a middle may lie on a vertex
    for (std::size_t t = 0; t < keep.size(); ++t) {
      const Triangle& tri = mesh_.triangles[t];
      keep[t] = tri[0] != tri[1] && tri[1] != tri[2] && tri[2] != tri[0] ? 1 : 0;
    }
    filter(keep);
    was_open_.assign(report_.source.size(), 1);
    for (std::size_t t = 0; t < report_.source.size(); ++t)
      if (report_.source[t] != kFilled) was_open_[t] = opened_[report_.source[t]] != 0 ? 1 : 0;
    const auto triangles =
        static_cast<std::size_t>(std::count(report_.source.begin(), report_.source.end(), kFilled));
    report_.notes.push_back(count_of(filled.holes, "hole is", "holes are") + " filled with " +
                            count_of(triangles, "triangle", "triangles") +
                            (filled.holes == 1 ? ", " : ", the largest ") +
                            text_of(filled.largest) + " across near " + text_of(filled.largest_at) +
                            ": what is said of the solid is about the one so closed");
  }

  /// Sources are of the input alone.
  void count_filled() {
    const auto first = std::find(report_.source.begin(), report_.source.end(), kFilled);
    filled_triangles_ = static_cast<std::size_t>(report_.source.end() - first);
    if (filled_triangles_ == 0) return;
    std::vector<char> used(mesh_.vertices.size(), 0);
    for (std::size_t t = 0; t + filled_triangles_ < report_.source.size(); ++t)
      for (const std::uint32_t v : mesh_.triangles[t]) used[v] = 1;
    report_.filled_vertices = static_cast<std::size_t>(std::count(used.begin(), used.end(), 0));
    std::fill(report_.reversed.begin() + (first - report_.source.begin()), report_.reversed.end(),
              0);
    report_.source.erase(first, report_.source.end());
  }

  /// Drops copies that are closed by themselves. A copy lowers the winding number inside; that
  /// leaves the solid alone only where nothing else lowers it, so copies stay if any component is
  /// oriented inwards.
  /// @param early  before shells are judged, of which copies take long: copies stay if any
  ///   component might be filled or turned later
  void drop_copies(bool early) {
    const std::vector<std::uint32_t> copies = coincident().copies;
    if (copies.empty()) return;
    const Chains chains = find_chains(mesh_, edges_);
    const auto may_lower = [&](std::size_t chain) {
      return early ? chains.closed[chain] == 0 || chains.sign[chain] != 1
                   : chains.sign[chain] == -1;
    };
    for (std::size_t chain = 0; chain < chains.sign.size(); ++chain)
      if (may_lower(chain)) return;
    const std::vector<std::uint32_t> closed = closed_copies(mesh_, copies);
    report_.dropped_copies += closed.size();
    if (closed.empty()) return;
    std::vector<char> keep(mesh_.triangles.size(), 1);
    for (const std::uint32_t t : closed) keep[t] = 0;
    filter(keep);
    report_.notes.push_back(count_of(report_.dropped_copies, "triangle", "triangles") +
                            " of identically oriented copies dropped");
  }

  /// Turns the shells that are inside out.
  void reverse_shells() {
    const Judgement judged = judge_shells(mesh_, edges_, was_open_);
    if (options_.keep_orientation) {
      if (!judged.inside_out.empty())
        report_.notes.push_back(
            count_of(judged.inside_out.size(), "component is", "components are") +
            " inside out, the first at input triangle " + source_text(judged.inside_out[0]) +
            ", and kept so: what it encloses counts as outside");
      return;
    }
    if (judged.left && judged.left->at_wall)
      refuse_wall("at input triangle " + source_text(judged.left->triangle) + " near " +
                  text_of(judged.left->at));
    if (judged.left) {
      report_.notes.push_back("the surface crosses itself, and what it encloses near " +
                              text_of(judged.left->at) +
                              " is inside out: that part counts as outside");
      report_.hollow = judged.left->at;
    }
    if (judged.inside_out.empty()) return;
    report_.reversed_components = judged.inside_out.size();
    report_.reversed_cavities = judged.cavities_reversed;
    for (const std::uint32_t t : judged.inside_out)
      if (report_.source[t] != kFilled) report_.inside_out.push_back(report_.source[t]);
    const auto first_fill = static_cast<std::uint32_t>(
        std::find(report_.source.begin(), report_.source.end(), kFilled) - report_.source.begin());
    for (std::uint32_t t = 0; t < judged.reverse.size(); ++t) {
      if (judged.reverse[t] == 0) continue;
      reverse(t);
      if (report_.holes != 0)
        report_.reversed_after_filling.push_back(
            t < first_fill ? report_.source[t] : input_triangles_ + t - first_fill);
    }
    find_edges();
    cancel_pairs();  // walls that are opposite now
    report_.notes.push_back(
        count_of(report_.reversed_components, "component was", "components were") +
        " inside out and turned" +
        (report_.reversed_cavities == 0
             ? ""
             : ", with " + count_of(report_.reversed_cavities, "cavity", "cavities") + " inside"));
  }

  /// Looks at the walls that have cancelled as well: they tell that parts met there.
  void find_hollows() {
    bool branched = !cancelled_.empty();
    for_each_edge(edges_, [&](std::span<const EdgeUse> e) { branched = branched || e.size() > 2; });
    if (!closed_ || !branched) return;
    Mesh walls = mesh_;
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
    if (report_.hollow) return;
    report_.hollow = hollow->at;
    report_.notes.push_back("parts that share edges enclose a hollow " + where(*hollow) +
                            ", which need not be a cavity: that part counts as outside");
  }

  /// Parts that were open, or that were turned to agree, are judged by themselves: their holes'
  /// fill and the edges that they agree at are guesses. Where one of them winds backwards round a
  /// point, the guess joined bodies against each other; where the point is inside another body,
  /// that would be hollow. Then the whole, where a surface crosses itself: a pocket of it within
  /// another body is hollow as well.
  void find_inverted() {
    if (!closed_ || options_.keep_orientation) return;
    const Guesses guesses = find_guesses(edges_, part_, report_.source, agreed_, opened_);
    std::vector<EdgeUse>().swap(edges_);  // no longer needed, and what follows takes room
    if (guesses.ambiguous)
      guess("the part with input triangle " + std::to_string(*guesses.ambiguous) +
            " was open, and its triangles were turned to agree: which solid it bounds is a guess");
    // Whose inner sides all have w ≥ 1, and on which no other triangle lies, have w ≥ 0 on their
    // outer sides: w is less than 0 nowhere, and all is one part.
    if (loose_ && report_.components == 1) {
      report_.loose = loose_(mesh_);
      if (report_.loose->empty()) return;
    }
    const WindingNumber winding(mesh_);
    if (const auto found =
            geom::find_inverted(mesh_, winding, some_of(guesses.agreed, part_), part_))
      throw Error(ErrorCode::InvalidInput,
                  "triangles were turned to agree with their neighbours, and what they enclose is "
                  "inside out now, " +
                      where(*found) +
                      ": bodies that share an edge cannot be told apart; give each body a mesh of "
                      "its own, or orient all normals outwards");
    if (report_.hollow) return;
    std::optional<Hollow> found =
        geom::find_inverted(mesh_, winding, some_of(guesses.triangles, part_), part_);
    if (!found) {
      std::vector<std::uint32_t> all(part_.size());
      std::iota(all.begin(), all.end(), 0U);
      std::vector<std::uint32_t> beside = some_of(all, {});
      // A pocket's border has w < 0 on one side: in a whole, only loose triangles do.
      if (report_.loose)
        std::erase_if(beside, [&](std::uint32_t t) {
          return !std::binary_search(report_.loose->begin(), report_.loose->end(), t);
        });
      found = geom::find_pocket(mesh_, winding, beside, part_);
    }
    if (!found) return;
    report_.hollow = found->at;
    report_.notes.push_back("WARNING: the surface crosses itself, and what it encloses " +
                            where(*found) +
                            " is inside out: that part counts as outside, and is NOT enclosed");
  }

  void guess(const std::string& what) {
    report_.guessed = true;
    report_.notes.push_back("WARNING: " + what);
  }

  [[nodiscard]] std::string where(const Hollow& found) const {
    return (found.triangle < report_.source.size()
                ? "at input triangle " + std::to_string(report_.source[found.triangle]) + " "
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
    return report_.source[t] == kFilled ? "(of a filled hole)" : std::to_string(report_.source[t]);
  }

  /// Vertices in the order in which the triangles left use them in the input, before any was
  /// turned.
  void number_by_first_use() {
    if (std::find(report_.reversed.begin(), report_.reversed.end(), 1) == report_.reversed.end())
      return;
    const auto reverse_all = [&] {
      for (std::size_t t = 0; t < report_.reversed.size(); ++t)
        if (report_.reversed[t] != 0) std::swap(mesh_.triangles[t][1], mesh_.triangles[t][2]);
    };
    reverse_all();
    mesh_ = weld(mesh_);
    reverse_all();
    find_edges();
  }

  void find_border() {
    border_.assign(mesh_.vertices.size(), 0);
    std::size_t open = 0;
    for_each_edge(edges_, [&](std::span<const EdgeUse> e) {
      if (is_balanced(e)) return;
      border_[e[0].lo] = border_[e[0].hi] = 1;
      ++open;
    });
    closed_ = open == 0;
    if (closed_) return;
    if (options_.holes == Holes::Refuse)
      throw Error(ErrorCode::InvalidInput,
                  "the mesh is open at " + count_of(open, "edge", "edges") +
                      " and bounds no solid; close it, or have its holes filled («holes=fill»)");
    ensure(options_.holes == Holes::Keep, "a mesh whose holes are filled is still open");
    report_.notes.push_back("the mesh is open at " + count_of(open, "edge", "edges") +
                            " and bounds no solid");
  }

  PrepareOptions options_;
  const LooseTriangles& loose_;
  Mesh mesh_;
  std::vector<char> border_;  // per vertex, in the end
  bool closed_ = true;
  std::size_t filled_triangles_ = 0;
  PreparationReport report_;
  std::uint32_t input_triangles_ = 0;
  std::vector<Cancelled> cancelled_;
  std::vector<char> agreed_, opened_;  // per input triangle: its part was turned to agree, was open
  std::vector<EdgeUse> edges_;
  std::vector<std::uint32_t> part_;       // per triangle, in the end: joined through edges
  std::vector<std::uint32_t> was_open_;   // per triangle, when holes are filled: before that
  std::optional<Coincident> coincident_;  // of the mesh with these edges
};

}  // namespace

Prepared prepare(const Mesh& input, const PrepareOptions& options, const LooseTriangles& loose) {
  return Preparation(input, options, loose).run();
}

}  // namespace kaboum::geom
