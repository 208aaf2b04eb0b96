#include <kaboum/geom/distance.h>
#include <kaboum/geom/error.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>

namespace kaboum::geom {
namespace {

using Nearest = DistanceQuery::Nearest;

struct Corner {
  Vec3 point;
  Nearest nearest;
};

/// A piece of one of A's triangles whose largest distance to B is not settled yet.
struct Piece {
  std::array<Corner, 3> corner;
  double upper;
};

/// Everything known about a piece before its corners' queries are needed again.
struct Evaluated {
  Piece piece;
  Corner center;
};

double diameter_about(const Piece& piece, const Vec3& center) {
  double r = 0;
  for (const Corner& c : piece.corner) r = std::max(r, (c.point - center).norm());
  return r * (1 + 1e-15);
}

/// Smallest bound over a few triangles t of max over the corners of d(corner, t).
double upper_bound(const Piece& piece, const Corner& center, const DistanceQuery& b) {
  double best = center.nearest.upper + diameter_about(piece, center.point);
  const auto try_triangle = [&](std::uint32_t t) {
    double worst = 0;
    for (const Corner& c : piece.corner) {
      worst = std::max(worst, c.nearest.triangle == t ? c.nearest.upper
                                                      : b.to_triangle(c.point, t).upper);
      if (worst >= best) return;
    }
    best = worst;
  };
  try_triangle(center.nearest.triangle);
  for (const Corner& c : piece.corner) try_triangle(c.nearest.triangle);
  return best;
}

Evaluated evaluate(const Piece& piece, const DistanceQuery& b) {
  const Vec3 center =
      (piece.corner[0].point + piece.corner[1].point + piece.corner[2].point) / 3.0;
  Evaluated e{piece, {center, b.nearest(center, piece.corner[0].nearest.triangle)}};
  e.piece.upper = std::min(piece.upper, upper_bound(piece, e.center, b));
  return e;
}

}  // namespace

// The midpoints of a piece are rounded, so its four children cover it only up to rounding. That is
// harmless: the bound of a child is a bound over its own corners, and the parent's points are within
// 2^-52 · max|coordinate| of some child; this is added once, at the end.
DirectedDistance directed_distance(const Mesh& a, const DistanceQuery& b,
                                   const DistanceOptions& options) {
  if (a.empty()) throw Error(ErrorCode::InvalidInput, "distance from a mesh without triangles");
  constexpr std::size_t kMaxPieces = std::size_t{1} << 26;
  constexpr int kMaxRounds = 60;

  Box3 box = bounding_box(a);
  const double coordinates = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  const double cover_slack = coordinates * 4.5e-16 * kMaxRounds;
  box.extend(b.box());
  const double absolute_gap = options.absolute_gap * box.diagonal();

  DirectedDistance result;
  // Vertices first: each is shared by about six triangles, and chunks of neighbours pass on hints.
  std::vector<Nearest> at_vertex(a.vertices.size(), Nearest{DistanceQuery::kNone, 0, 0});
  std::vector<char> used(a.vertices.size(), 0);
  for (const Triangle& t : a.triangles)
    for (const std::uint32_t v : t) used[v] = 1;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, a.vertices.size(), 256),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      std::uint32_t hint = DistanceQuery::kNone;
                      for (std::size_t v = range.begin(); v != range.end(); ++v) {
                        if (!used[v]) continue;
                        at_vertex[v] = b.nearest(a.vertices[v], hint);
                        hint = at_vertex[v].triangle;
                      }
                    });
  const auto raise = [&](const Corner& c) {
    if (c.nearest.lower > result.max_lower) {
      result.max_lower = c.nearest.lower;
      result.at = c.point;
    }
  };
  for (std::size_t v = 0; v < a.vertices.size(); ++v) {
    if (!used[v]) continue;
    ++result.queries;
    raise({a.vertices[v], at_vertex[v]});
  }

  std::vector<Piece> open;
  open.reserve(a.triangles.size());
  for (const Triangle& t : a.triangles) {
    Piece piece{{}, std::numeric_limits<double>::infinity()};
    for (int k = 0; k < 3; ++k) piece.corner[k] = {a.vertices[t[k]], at_vertex[t[k]]};
    open.push_back(piece);
  }

  const auto target = [&] {
    return std::max(result.max_lower * (1 + options.relative_gap), result.max_lower + absolute_gap);
  };
  double settled = 0;  // largest upper bound among the pieces that need no further split
  for (int round = 0; !open.empty(); ++round) {
    std::vector<Evaluated> evaluated(open.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, open.size(), 64),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i)
                          evaluated[i] = evaluate(open[i], b);
                      });
    result.queries += open.size();
    for (const Evaluated& e : evaluated) raise(e.center);
    const double limit = target();
    std::vector<const Evaluated*> split;
    for (const Evaluated& e : evaluated) {
      if (e.piece.upper <= limit)
        settled = std::max(settled, e.piece.upper);
      else
        split.push_back(&e);
    }
    if (split.empty()) break;
    if (round == kMaxRounds || 4 * split.size() > kMaxPieces)
      throw Error(ErrorCode::LimitReached,
                  "the distance could not be bounded to the wished gap; allow a larger gap");

    std::vector<Piece> next(4 * split.size());
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, split.size(), 64),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t i = range.begin(); i != range.end(); ++i) {
            const Evaluated& e = *split[i];
            std::array<Corner, 3> middle;  // middle[k] lies opposite corner k
            for (int k = 0; k < 3; ++k) {
              const Corner &p = e.piece.corner[(k + 1) % 3], &q = e.piece.corner[(k + 2) % 3];
              const Vec3 m = 0.5 * p.point + 0.5 * q.point;
              middle[k] = {m, b.nearest(m, e.center.nearest.triangle)};
            }
            const auto& c = e.piece.corner;
            const double u = e.piece.upper;
            next[4 * i + 0] = {{c[0], middle[2], middle[1]}, u};
            next[4 * i + 1] = {{middle[2], c[1], middle[0]}, u};
            next[4 * i + 2] = {{middle[1], middle[0], c[2]}, u};
            next[4 * i + 3] = {middle, u};
          }
        });
    result.queries += 3 * split.size();
    for (std::size_t i = 0; i < split.size(); ++i)
      for (const Corner& m : next[4 * i + 3].corner) raise(m);
    open.swap(next);
  }
  result.max_upper = std::max(settled + cover_slack, result.max_lower);
  return result;
}

}  // namespace kaboum::geom
