#include <kaboum/geom/distance.h>
#include <kaboum/geom/error.h>

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace kaboum::geom {
namespace {

/// A part of one of A's triangles whose largest distance to B may still matter.
struct Piece {
  ConvexPolygon polygon;
  double upper = std::numeric_limits<double>::infinity();
  std::uint32_t nearest = TriangleSearch::kNone;   ///< to the centroid
  std::uint32_t at_worst = TriangleSearch::kNone;  ///< to the corner farthest from that
};

/// What one round finds out about a piece.
struct Finding {
  double lower = 0;  // the distance at `at` is at least this
  Vec3 at = Vec3::Zero();
};

class BranchAndBound {
 public:
  BranchAndBound(const Mesh& a, const TriangleSearch& b, const DistanceOptions& options)
      : a_(a), b_(b), options_(options) {
    Box3 box = bounding_box(a);
    magnitude_ = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    box.extend(b.box());
    absolute_gap_ = options.absolute_gap * box.diagonal();
  }

  DirectedDistance run() {
    measure_vertices();
    std::vector<Piece> open;
    // The first round in chunks, so that most triangles never exist as pieces.
    constexpr std::size_t kChunk = std::size_t{1} << 16;
    for (std::size_t first = 0; first < a_.triangles.size(); first += kChunk) {
      std::vector<Piece> chunk;
      const std::size_t last = std::min(first + kChunk, a_.triangles.size());
      chunk.reserve(last - first);
      for (std::size_t t = first; t < last; ++t) {
        const Triangle& tri = a_.triangles[t];
        chunk.push_back({{a_.vertices[tri[0]], a_.vertices[tri[1]], a_.vertices[tri[2]]},
                         std::numeric_limits<double>::infinity(),
                         nearest_to_vertex_[tri[0]],
                         TriangleSearch::kNone});
      }
      evaluate(chunk);
      keep_unsettled(chunk);
      open.insert(open.end(), chunk.begin(), chunk.end());
    }
    int round = 1;
    for (; !open.empty(); ++round) {
      keep_unsettled(open);  // the lower bound may have risen
      if (round > kMaxRounds || open.size() > kMaxPieces) {
        // What is known of the rest is a bound all the same.
        for (const Piece& p : open) settled_ = std::max(settled_, p.upper);
        result_.within_gap = false;
        break;
      }
      open = cut_all(open, round);
      evaluate(open);
      keep_unsettled(open);
    }
    // What cuts may have left out lies this close to what they covered.
    result_.max_upper =
        std::max(settled_ + round * PrismCut::kCuts * ConvexPolygon::kCutError * magnitude_,
                 result_.max_lower);
    return result_;
  }

 private:
  static constexpr std::size_t kMaxPieces = std::size_t{1} << 23;
  static constexpr int kMaxRounds = 200;

  void raise(double lower, const Vec3& at) {
    if (lower <= result_.max_lower) return;
    result_.max_lower = lower;
    result_.at = at;
  }

  void measure_vertices() {
    nearest_to_vertex_.assign(a_.vertices.size(), TriangleSearch::kNone);
    std::vector<double> lower(a_.vertices.size(), 0);
    std::vector<char> used(a_.vertices.size(), 0);
    for (const Triangle& t : a_.triangles)
      for (const std::uint32_t v : t) used[v] = 1;
    // Hints pass on within fixed blocks, not within the scheduler's ranges.
    constexpr std::size_t kBlock = 64;
    const std::size_t blocks = (a_.vertices.size() + kBlock - 1) / kBlock;
    tbb::parallel_for(std::size_t{0}, blocks, [&](std::size_t block) {
      std::uint32_t hint = TriangleSearch::kNone;
      const std::size_t last = std::min((block + 1) * kBlock, a_.vertices.size());
      for (std::size_t v = block * kBlock; v < last; ++v) {
        if (used[v] == 0) continue;
        const auto n = b_.nearest(a_.vertices[v], hint);
        hint = nearest_to_vertex_[v] = n.triangle;
        lower[v] = n.lower;
      }
    });
    for (std::size_t v = 0; v < a_.vertices.size(); ++v) {
      if (used[v] == 0) continue;
      ++result_.queries;
      raise(lower[v], a_.vertices[v]);
    }
  }

  /// Largest distance of the corners from triangle t, and the corner where it is.
  std::pair<double, int> worst_corner(const ConvexPolygon& polygon, std::uint32_t t) const {
    double worst = 0;
    int where = 0;
    for (int i = 0; i < polygon.size; ++i) {
      const double d = b_.to_triangle(polygon.corner[i], t).upper;
      if (d > worst) {
        worst = d;
        where = i;
      }
    }
    return {worst, where};
  }

  Finding bound(Piece& piece) const {
    const Vec3 center = piece.polygon.centroid();
    const auto at_center = b_.nearest(center, piece.nearest);
    piece.nearest = piece.at_worst = at_center.triangle;
    Finding finding{at_center.lower, center};
    const auto [worst, where] = worst_corner(piece.polygon, at_center.triangle);
    piece.upper = std::min(piece.upper, worst);
    if (piece.upper <= result_.max_lower) return finding;
    // The corner that is far from this triangle may be near another one.
    const Vec3& corner = piece.polygon.corner[where];
    const auto at_corner = b_.nearest(corner, at_center.triangle);
    if (at_corner.lower > finding.lower) finding = {at_corner.lower, corner};
    piece.at_worst = at_corner.triangle;
    if (at_corner.triangle != at_center.triangle)
      piece.upper = std::min(piece.upper, worst_corner(piece.polygon, at_corner.triangle).first);
    double radius = 0;
    for (int i = 0; i < piece.polygon.size; ++i)
      radius = std::max(radius, (piece.polygon.corner[i] - center).norm());
    piece.upper = std::min(piece.upper, at_center.upper + radius * (1 + 1e-14));
    return finding;
  }

  void evaluate(std::vector<Piece>& pieces) {
    std::vector<Finding> findings(pieces.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, pieces.size(), 64),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i)
                          findings[i] = bound(pieces[i]);
                      });
    result_.queries += 2 * pieces.size();
    for (const Finding& f : findings) raise(f.lower, f.at);
  }

  void keep_unsettled(std::vector<Piece>& pieces) {
    const double limit = std::max(result_.max_lower * (1 + options_.relative_gap),
                                  result_.max_lower + absolute_gap_);
    std::erase_if(pieces, [&](const Piece& p) {
      if (p.upper > limit) return false;
      settled_ = std::max(settled_, p.upper);
      return true;
    });
  }

  /// Cuts where the planes of the two triangles that matter are equally far: on a ridge of the
  /// distance, which halving would only approach.
  bool cut_by_bisector(const Piece& piece, PrismCut& out) const {
    if (piece.at_worst == piece.nearest) return false;
    const Vec3 center = piece.polygon.centroid();
    const auto plane = [&](std::uint32_t triangle, Vec3& n, double& height) {
      const auto& [a, b, c] = b_.corners(triangle);
      n = (b - a).cross(c - a);
      const double length = n.norm();
      if (!(length > 0)) return false;
      n /= length;
      height = n.dot(center - a);
      if (height < 0) {
        n = -n;
        height = -height;
      }
      return true;
    };
    Vec3 n1, n2;
    double h1 = 0, h2 = 0;
    if (!plane(piece.nearest, n1, h1) || !plane(piece.at_worst, n2, h2)) return false;
    const Vec3 n = n1 - n2;
    const double square = n.squaredNorm();
    if (square < 1e-20) return false;
    out.count = 2;
    return cut(piece.polygon, center - ((h1 - h2) / square) * n, n, out.piece[0], out.piece[1]);
  }

  std::vector<Piece> cut_all(const std::vector<Piece>& pieces, int round) const {
    std::vector<Piece> out;
    out.reserve(3 * pieces.size());
    for (const Piece& p : pieces) {
      PrismCut cuts;
      if (round % 4 == 0 || round % 2 == 1 || !cut_by_bisector(p, cuts)) {
        const auto& [a, b, c] = b_.corners(p.nearest);
        cuts = cut_by_prism(p.polygon, a, b, c, round % 4 == 0);
      }
      for (int i = 0; i < cuts.count; ++i)
        out.push_back({cuts.piece[i], p.upper, p.nearest, TriangleSearch::kNone});
    }
    return out;
  }

  const Mesh& a_;
  const TriangleSearch& b_;
  const DistanceOptions& options_;
  double magnitude_ = 0;
  double absolute_gap_ = 0;
  double settled_ = 0;  // largest upper bound among the pieces that need no further cut
  std::vector<std::uint32_t> nearest_to_vertex_;
  DirectedDistance result_;
};

}  // namespace

DirectedDistance directed_distance(const Mesh& a, const TriangleSearch& b,
                                   const DistanceOptions& options) {
  if (a.empty()) throw Error(ErrorCode::InvalidInput, "distance from a mesh without triangles");
  return BranchAndBound(a, b, options).run();
}

}  // namespace kaboum::geom
