// Cuts a face by the lines in which other faces of its chain meet it, one after the other: convex
// polygons that no segment runs through, all of whose points have the same winding numbers beside
// them. Lines and corners are exact; only the corners that are handed out are rounded.
#include "pieces.h"

#include <kaboum/base/error.h>

#include <algorithm>
#include <optional>
#include <utility>

#include "allowance.h"
#include "cell_sample.h"
#include "segments.h"
#include "uncovered_region.h"
#include "uncut_values.h"

namespace kaboum::verify {
namespace {

constexpr std::size_t kMostPolygons = 2000;  // of one face
constexpr std::size_t kMostSegments = 2000;
constexpr double kRounding = 32 * kUnit;  // of a weight

struct Weights {
  Triple<Exact> exact;
  Triple<Approx> approx;
};

Weights weights(Triple<Exact> exact) {
  const Triple<Approx> approx = rounded(exact);
  return {std::move(exact), approx};
}

/// A convex polygon: corners in order, and the lines of the edges from each to the next.
struct Polygon {
  struct Edge {
    std::uint32_t corner, line;
    bool positive;  ///< the polygon is on the side of the line where it is positive
  };
  std::vector<Edge> edges;
};

class Divider {
 public:
  explicit Divider(std::vector<Segment> segments) : segments_(std::move(segments)) {
    Polygon whole;
    for (std::size_t k = 0; k < 3; ++k) {
      Triple<Exact> unit{Exact(0), Exact(0), Exact(0)};
      unit[k] = Exact(1);
      corners_.push_back(weights(unit));
    }
    // From corner k to the next the weight of the third corner is zero.
    for (std::uint32_t k = 0; k < 3; ++k) {
      lines_.push_back(corners_[(k + 2) % 3]);
      whole.edges.push_back({k, k, true});
    }
    polygons_.push_back(std::move(whole));
  }

  /// False when there are too many polygons.
  bool divide() {
    for (const Segment& s : segments_) {
      const auto line = static_cast<std::uint32_t>(lines_.size());
      lines_.push_back({s.line, s.approx_line});
      const std::size_t count = polygons_.size();
      constexpr std::uint64_t kPolygon = 50;  // about nanoseconds
      count_steps(kPolygon * count);
      for (std::size_t i = 0; i < count; ++i) {
        if (!runs_through(s, polygons_[i])) continue;
        auto [above, below] = halves(polygons_[i], line);
        polygons_[i] = std::move(above);
        polygons_.push_back(std::move(below));
      }
      if (polygons_.size() > kMostPolygons) return false;
    }
    return true;
  }

  [[nodiscard]] const std::vector<Polygon>& polygons() const { return polygons_; }
  [[nodiscard]] const Weights& corner(std::uint32_t c) const { return corners_[c]; }

 private:
  [[nodiscard]] Sign side(std::uint32_t line, std::uint32_t corner) const {
    return sign_on(lines_[line].approx, lines_[line].exact, corners_[corner].approx,
                   corners_[corner].exact);
  }

  /// Whether a segment meets the polygon's interior: its line does, and no edge has the polygon on
  /// one side and the segment on the other.
  bool runs_through(const Segment& s, const Polygon& polygon) {
    signs_.clear();
    bool above = false, below = false;
    for (const Polygon::Edge& e : polygon.edges) {
      signs_.push_back(
          sign_on(s.approx_line, s.line, corners_[e.corner].approx, corners_[e.corner].exact));
      above = above || signs_.back() == Sign::Positive;
      below = below || signs_.back() == Sign::Negative;
    }
    if (!above || !below) return false;
    return std::none_of(polygon.edges.begin(), polygon.edges.end(), [&](const Polygon::Edge& e) {
      const Weights& line = lines_[e.line];
      const Sign in = e.positive ? Sign::Positive : Sign::Negative;
      return sign_on(line.approx, line.exact, s.approx_p, s.p) != in &&
             sign_on(line.approx, line.exact, s.approx_q, s.q) != in;
    });
  }

  /// What is above and below a line. @pre signs_ are those of the polygon's corners
  std::pair<Polygon, Polygon> halves(const Polygon& polygon, std::uint32_t line) {
    Polygon above, below;
    const std::size_t n = polygon.edges.size();
    for (std::size_t i = 0; i < n; ++i) {
      const Polygon::Edge& e = polygon.edges[i];
      const Sign here = signs_[i], next = signs_[(i + 1) % n];
      if (here == Sign::Positive) above.edges.push_back(e);
      if (here == Sign::Negative) below.edges.push_back(e);
      if (here == Sign::Zero) {
        above.edges.push_back(next == Sign::Positive ? e : Polygon::Edge{e.corner, line, true});
        below.edges.push_back(next == Sign::Negative ? e : Polygon::Edge{e.corner, line, false});
      }
      if (here == Sign::Zero || next == Sign::Zero || here == next) continue;
      const auto meeting = static_cast<std::uint32_t>(corners_.size());
      corners_.push_back(weights(made_positive(cross(lines_[e.line].exact, lines_[line].exact))));
      const bool down = here == Sign::Positive;
      above.edges.push_back({meeting, down ? line : e.line, down || e.positive});
      below.edges.push_back({meeting, down ? e.line : line, down && e.positive});
    }
    return {std::move(above), std::move(below)};
  }

  std::vector<Segment> segments_;
  std::vector<Weights> lines_, corners_;
  std::vector<Polygon> polygons_;
  std::vector<Sign> signs_;
};

/// A point inside a polygon.
CellSample inside(const Divider& divider, const Polygon& polygon, std::uint32_t face) {
  const std::size_t n = polygon.edges.size();
  const auto exact = [&](std::size_t i) -> const Triple<Exact>& {
    return divider.corner(polygon.edges[i].corner).exact;
  };
  const Triple<Exact>&a = exact(0), &b = exact(n / 3), &c = exact(2 * n / 3);
  const Triple<Exact> ab = combine(Exact(ratio_of(a, b)), a, Exact(1), b);
  const Triple<Exact> sum = combine(Exact(ratio_of(ab, c)), ab, Exact(1), c);
  return {face, sum, rounded(sum), {}};
}

/// nullopt where rounding takes too much.
std::optional<Vec3> position_of(const MeshPair& meshes, std::uint32_t face, const Weights& corner) {
  const Approx total = total_of(corner.approx);
  if (!usable(total)) return std::nullopt;
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < 3; ++k) {
    const Approx part = share(corner.approx[static_cast<std::size_t>(k)], total);
    if (!(part.error <= kRounding)) return std::nullopt;
    p += part.value * meshes.corner(face, k);
  }
  return p;
}

enum class Kind : std::uint8_t { No, Mixed, Yes };

/// What a cut face is divided into.
struct Division {
  Kind kind = Kind::Mixed;
  std::vector<Corners> parts;  ///< that satisfy the condition, if mixed; none: not known
};

template <class Good>
Division divide(const Arrangement& arrangement, std::uint32_t face, const Good& good) {
  const MeshPair& meshes = arrangement.meshes();
  Divider divider(
      segments_of(arrangement, face, mask_of(meshes.face(face).chain), kMostSegments, {}));
  if (!divider.divide()) return {};
  std::vector<const Polygon*> chosen;
  for (const Polygon& polygon : divider.polygons())
    if (good(inside(divider, polygon, face))) chosen.push_back(&polygon);
  Division result;
  if (chosen.empty()) result.kind = Kind::No;
  if (chosen.size() == divider.polygons().size()) result.kind = Kind::Yes;
  if (result.kind != Kind::Mixed) return result;
  for (const Polygon* polygon : chosen) {
    std::vector<Vec3> points;
    for (const Polygon::Edge& e : polygon->edges) {
      const std::optional<Vec3> p = position_of(meshes, face, divider.corner(e.corner));
      if (!p) return {};
      points.push_back(*p);
    }
    for (std::size_t i = 2; i < points.size(); ++i)
      result.parts.push_back({points[0], points[i - 1], points[i]});
  }
  return result;
}

}  // namespace

Pieces pieces_with(const MeshPair& meshes, int chain, const InclusionOptions& options,
                   const std::function<bool(int inner, int outer)>& condition) {
  Allowance allowance(options.max_work.value_or(std::numeric_limits<double>::infinity()));
  Arrangement arrangement(meshes, {options.max_contacts, options.max_pairs}, &allowance);
  arrangement.need_own(chain);
  std::atomic<std::size_t> samples = 0;
  const auto values = [&](Side side) {
    return uncut_values(
        arrangement, chain, mask_of(chain), side,
        [&](const CellSample& sample) { return winding(meshes, sample, side, chain); }, samples,
        allowance);
  };
  const std::vector<int> inner = values(kInner), outer = values(kOuter);
  std::vector<Division> divisions(inner.size());
  allowance.loop(inner.size(), [&](std::size_t i) {
    const auto f = meshes.begin(chain) + static_cast<std::uint32_t>(i);
    if (meshes.face(f).axis < 0) {
      divisions[i].kind = Kind::No;
    } else if (inner[i] != kCut && outer[i] != kCut) {
      divisions[i].kind = condition(inner[i], outer[i]) ? Kind::Yes : Kind::No;
    } else {
      try {
        divisions[i] = divide(arrangement, f, [&](const CellSample& sample) {
          return condition(winding(meshes, sample, kInner, chain),
                           winding(meshes, sample, kOuter, chain));
        });
      } catch (const Error& error) {  // it may satisfy the condition, or not
        if (error.code() != ErrorCode::LimitReached || allowance.limited()) throw;
      }
    }
  });

  Pieces result;
  std::vector<std::uint32_t> surely, perhaps;
  const auto first = static_cast<std::uint32_t>(meshes.faces().size());
  for (std::uint32_t i = 0; i < divisions.size(); ++i) {
    const std::uint32_t f = meshes.begin(chain) + i;
    if (divisions[i].kind == Kind::No) continue;
    if (divisions[i].parts.empty()) {
      if (divisions[i].kind == Kind::Yes) surely.push_back(f);
      perhaps.push_back(f);
    }
    for (const Corners& part : divisions[i].parts) {
      const auto piece = first + static_cast<std::uint32_t>(result.parts.size());
      surely.push_back(piece);
      perhaps.push_back(piece);
      result.parts.push_back(part);
    }
  }
  const Triangles triangles(meshes, result.parts);
  if (!surely.empty()) result.surely = tree_of(triangles, surely);
  if (!perhaps.empty()) result.perhaps = tree_of(triangles, perhaps);
  return result;
}

}  // namespace kaboum::verify
