// Largest distance of a surface from another one: branch and bound over boxes, triangles and their
// parts. docs/algorithms/distances.md.
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/geom/directed_distance.h>

#include <algorithm>
#include <cmath>

#include <kaboum/geom/spatial_order.h>

namespace kaboum::geom {
namespace {

constexpr std::uint32_t kNone = TriangleSearch::kNone;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A rounded centroid is this far from the exact one at most, times the largest |coordinate|:
/// docs/algorithms/distances.md.
constexpr double kCentroidError = 1.5e-15;

/// A run of A's triangles in spatial order, with their box.
struct Cluster {
  std::uint32_t first, count;
  Box3 box;
  std::uint32_t hint;  ///< a triangle of B that is probably near
  double upper;
};

/// A part of one of A's triangles whose largest distance to B may still matter.
struct TrianglePart {
  ConvexPolygon polygon;
  double upper = kInfinity;
  std::uint32_t nearest = kNone;   ///< to the centroid
  std::uint32_t at_worst = kNone;  ///< to the corner farthest from that
};

/// What one round finds out about a cluster or piece.
struct Finding {
  double lower = 0;     // some point of A, next to `at`, is at least this far from B
  double measured = 0;  // the largest lower bound at any point, which rounding may have moved off A
  Vec3 at = Vec3::Zero();
  double decided = 0;  // upper bound of the parts that need no further work
  std::uint64_t queries = 0;

  /// Takes note of a distance at a point that is at most `moved` away from a point of A.
  void consider(double distance, const Vec3& point, double moved) {
    measured = std::max(measured, distance);
    if (distance - moved <= lower) return;
    lower = distance - moved;
    at = point;
  }
};

class BranchAndBound {
 public:
  /// A's triangles in spatial order.
  BranchAndBound(std::span<const std::array<Vec3, 3>> a, const TriangleSearch& b,
                 const DistanceOptions& options, const Interior* inside)
      : a_(a), b_(b), options_(options), inside_(inside) {
    Box3 box = box_clusters();
    magnitude_ = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
    box.extend(b.box());
    diagonal_ = box.diagonal();
  }

  DirectedDistance run() {
    std::vector<TrianglePart> open = bound_clusters();
    for (int round = 1; !open.empty(); ++round) {
      keep_undecided(open);  // the lower bound may have risen
      if (round > kMaxRounds || open.size() > options_.max_pieces) {
        // What is known of the rest is a bound all the same.
        for (const TrianglePart& p : open) decided_ = std::max(decided_, p.upper + moved_);
        break;
      }
      open = cut_all(open, round);
      moved_ = round * PrismCut::kCuts * ConvexPolygon::kCutError * magnitude_;
      evaluate(open);
    }
    result_.max_upper = std::max(decided_, result_.max_lower);
    result_.within_gap = result_.max_upper <= allowed() * (1 + 1e-15);
    return result_;
  }

 private:
  static constexpr int kMaxRounds = 200;
  // Sizes of clusters, halving eightfold.
  static constexpr std::uint32_t kLargestCluster = 4096;
  static constexpr std::uint32_t kSmallestCluster = 8;

  /// The largest upper bound that meets the wish.
  [[nodiscard]] double allowed() const { return options_.wished(result_.max_lower, diagonal_); }

  /// The upper bound at which a piece needs no further work: the wish, less what cuts have moved
  /// the piece by. Where rounding is wider than the wish, a gap of its size must do: upper bounds
  /// may stay as much above the truth, and distances measured as much below.
  [[nodiscard]] double limit() const {
    return std::max(allowed() - moved_, measured_ + 3 * moved_);
  }

  void take(const Finding& f) {
    decided_ = std::max(decided_, f.decided);
    result_.queries += f.queries;
    measured_ = std::max(measured_, f.measured);
    if (f.lower <= result_.max_lower) return;
    result_.max_lower = f.lower;
    result_.at = f.at;
  }

  [[nodiscard]] double upper_to(const Vec3& p, std::uint32_t triangle) const {
    const auto& [a, b, c] = b_.corners(triangle);
    return point_triangle_upper(p, a, b, c);
  }

  /// Takes note of a distance to B's triangles at a point, unless it lies inside.
  void consider(Finding& finding, double distance, const Vec3& point, double moved) const {
    // Distances that would change nothing are not worth the question; after the first rounds those
    // are most.
    if (inside_ != nullptr && (distance <= std::max(result_.max_lower, finding.lower) ||
                               inside_->contains(point, distance) != std::optional(false)))
      return;
    finding.consider(distance, point, moved);
  }

  // -- clusters ----------------------------------------------------------------------------------

  /// Boxes of the smallest clusters, and of eight of them, and so on. @return the box of all.
  Box3 box_clusters() {
    std::vector<Box3> leaves((a_.size() + kSmallestCluster - 1) / kSmallestCluster);
    for (std::size_t i = 0; i < a_.size(); ++i)
      for (const Vec3& p : a_[i]) leaves[i / kSmallestCluster].extend(p);
    boxes_.push_back(std::move(leaves));
    for (std::uint32_t size = kSmallestCluster; size < kLargestCluster; size *= 8) {
      std::vector<Box3> up((boxes_.back().size() + 7) / 8);
      for (std::size_t i = 0; i < boxes_.back().size(); ++i) up[i / 8].extend(boxes_.back()[i]);
      boxes_.push_back(std::move(up));
    }
    Box3 all;
    for (const Box3& box : boxes_.back()) all.extend(box);
    return all;
  }

  /// Decides whole clusters of triangles where it can, level by level; returns the triangles left.
  std::vector<TrianglePart> bound_clusters() {
    const auto n = static_cast<std::uint32_t>(a_.size());
    const auto& boxes = boxes_;
    std::vector<Cluster> level;
    for (std::size_t i = 0; i < boxes.back().size(); ++i) {
      const auto first = static_cast<std::uint32_t>(i) * kLargestCluster;
      level.push_back(
          {first, std::min(kLargestCluster, n - first), boxes.back()[i], kNone, kInfinity});
    }
    std::uint32_t size = kLargestCluster;
    for (std::size_t depth = boxes.size(); depth-- > 0; size /= 8) {
      std::vector<Finding> findings(level.size());
      const double enough = limit();
      parallel_for(std::size_t{0}, level.size(),
                   [&](std::size_t i) { findings[i] = bound(level[i], enough); }, {.grain = 16});
      for (const Finding& f : findings) take(f);
      std::vector<Cluster> next;
      const std::uint32_t step = size / 8;
      for (const Cluster& cluster : level) {
        if (decide(cluster.upper)) continue;
        if (depth == 0) {
          next.push_back(cluster);
          continue;
        }
        const std::uint32_t end = cluster.first + cluster.count;
        for (std::uint32_t first = cluster.first; first < end; first += step)
          next.push_back({first, std::min(step, end - first), boxes[depth - 1][first / step],
                          cluster.hint, cluster.upper});
      }
      level = std::move(next);
    }
    return bound_triangles(level);
  }

  /// Bounds a cluster by its box's corners, as a piece by its own, or by the distance of one of its
  /// points and its extent.
  Finding bound(Cluster& cluster, double enough) const {
    if (cluster.hint != kNone && lower_by_corners(cluster, enough)) return {};
    const Vec3& p = a_[cluster.first + cluster.count / 2][0];
    const auto at = b_.nearest(p, cluster.hint);
    cluster.hint = at.triangle;
    const double radius = (cluster.box.max - p).cwiseMax(p - cluster.box.min).norm();
    cluster.upper = std::min(cluster.upper, (at.upper + radius) * (1 + 1e-14));
    if (cluster.upper > enough) lower_by_corners(cluster, enough);
    if (inside_ != nullptr && cluster.upper > enough && inside_->covers_ball(p, radius, at.lower))
      cluster.upper = 0;
    Finding finding;
    finding.queries = 1;
    consider(finding, at.lower, p, 0);
    return finding;
  }

  bool lower_by_corners(Cluster& cluster, double enough) const {
    double largest = 0;
    for (int i = 0; i < 8; ++i) {
      const auto pick = [&](int axis) {
        return (i >> axis & 1) != 0 ? cluster.box.max[axis] : cluster.box.min[axis];
      };
      largest = std::max(largest, upper_to({pick(0), pick(1), pick(2)}, cluster.hint));
      if (largest > enough) return false;
    }
    cluster.upper = std::min(cluster.upper, largest);
    return true;
  }

  /// The triangles of clusters that cannot be decided as wholes, as pieces; many are decided by the
  /// triangle of B that is next to the cluster.
  std::vector<TrianglePart> bound_triangles(const std::vector<Cluster>& clusters) {
    struct Outcome {
      Finding finding;
      std::vector<TrianglePart> pieces;
    };
    std::vector<Outcome> outcomes(clusters.size());
    const double enough = limit();
    parallel_for(std::size_t{0}, clusters.size(),
                 [&](std::size_t i) {
                   outcomes[i].finding = bound_each(clusters[i], enough, outcomes[i].pieces);
                 },
                 {.grain = 16});
    std::vector<TrianglePart> open;
    for (const Outcome& o : outcomes) {
      take(o.finding);
      open.insert(open.end(), o.pieces.begin(), o.pieces.end());
    }
    return open;
  }

  Finding bound_each(const Cluster& cluster, double enough,
                     std::vector<TrianglePart>& pieces) const {
    Finding finding;
    std::uint32_t hint = kNone;
    for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      const auto& [a, b, c] = a_[i];
      TrianglePart piece{{a, b, c}, kInfinity, cluster.hint, hint};
      const Finding own = bound(piece, enough);
      finding.queries += own.queries;
      finding.measured = std::max(finding.measured, own.measured);
      if (own.lower > finding.lower) {
        finding.lower = own.lower;
        finding.at = own.at;
      }
      if (own.queries > 0) hint = piece.nearest;
      if (piece.upper <= enough)
        finding.decided = std::max(finding.decided, piece.upper);
      else
        pieces.push_back(piece);
    }
    return finding;
  }

  // -- pieces ------------------------------------------------------------------------------------

  /// Largest distance of the corners from triangle t, and the corner where it is.
  std::pair<double, int> worst_corner(const ConvexPolygon& polygon, std::uint32_t t) const {
    double worst = 0;
    int where = 0;
    for (int i = 0; i < polygon.size; ++i) {
      const double d = upper_to(polygon.corner[i], t);
      if (d > worst) {
        worst = d;
        where = i;
      }
    }
    return {worst, where};
  }

  /// The same distance; some larger value once it is known to exceed `enough`: infinity.
  double largest_to(const ConvexPolygon& polygon, std::uint32_t t, double enough) const {
    double largest = 0;
    for (int i = 0; i < polygon.size; ++i) {
      largest = std::max(largest, upper_to(polygon.corner[i], t));
      if (largest > enough) return kInfinity;
    }
    return largest;
  }

  /// Lowers piece.upper until it is `enough` or nothing more is known.
  Finding bound(TrianglePart& piece, double enough) const {
    Finding finding;
    // What was near the piece that this one was cut from may settle it without a query.
    for (const std::uint32_t t : {piece.nearest, piece.at_worst}) {
      if (t == kNone) continue;
      if (piece.upper = std::min(piece.upper, largest_to(piece.polygon, t, enough));
          piece.upper <= enough)
        return finding;
    }
    const Vec3 center = piece.polygon.centroid();
    const auto at_center = b_.nearest(center, piece.nearest);
    finding.queries = 1;
    consider(finding, at_center.lower, center, moved_ + kCentroidError * magnitude_);
    double radius = 0;
    for (int i = 0; i < piece.polygon.size; ++i)
      radius = std::max(radius, (piece.polygon.corner[i] - center).norm());
    piece.upper = std::min(piece.upper, (at_center.upper + radius) * (1 + 1e-14));
    piece.nearest = piece.at_worst = at_center.triangle;
    const auto [worst, where] = worst_corner(piece.polygon, at_center.triangle);
    piece.upper = std::min(piece.upper, worst);
    if (piece.upper <= enough) return finding;
    if (inside_ != nullptr && decide_inside(piece, center, radius, at_center.lower, enough))
      return finding;
    if (much_larger(piece, enough)) return finding;  // it will be halved, whatever its corners say
    // The corner that is far from this triangle may be near another one.
    const Vec3& corner = piece.polygon.corner[where];
    const auto at_corner = b_.nearest(corner, at_center.triangle);
    ++finding.queries;
    consider(finding, at_corner.lower, corner, moved_);
    piece.at_worst = at_corner.triangle;
    if (at_corner.triangle != at_center.triangle)
      piece.upper = std::min(piece.upper, worst_corner(piece.polygon, at_corner.triangle).first);
    return finding;
  }

  /// Whether the piece lies in the solid, or so close to it that nothing is left to do.
  bool decide_inside(TrianglePart& piece, const Vec3& center, double radius, double distance,
                     double enough) const {
    if (inside_->covers_ball(center, radius, distance)) {
      piece.upper = 0;
      return true;
    }
    const double slack = 0.5 * enough;
    if (!inside_->covers(
            {piece.polygon.corner.data(), static_cast<std::size_t>(piece.polygon.size)}, slack))
      return false;
    piece.upper = slack;
    return true;
  }

  /// Bounds all pieces and keeps those that are not decided.
  void evaluate(std::vector<TrianglePart>& pieces) {
    std::vector<Finding> findings(pieces.size());
    const double enough = limit();
    parallel_for(std::size_t{0}, pieces.size(),
                 [&](std::size_t i) { findings[i] = bound(pieces[i], enough); }, {.grain = 64});
    for (const Finding& f : findings) take(f);
    keep_undecided(pieces);
  }

  /// Whether an upper bound is good enough; then it counts.
  bool decide(double upper) {
    if (upper > limit()) return false;
    decided_ = std::max(decided_, upper + moved_);
    return true;
  }

  void keep_undecided(std::vector<TrianglePart>& pieces) {
    std::erase_if(pieces, [&](const TrianglePart& p) { return decide(p.upper); });
  }

  /// Cuts where the planes of the two triangles that matter are equally far: on a ridge of the
  /// distance, which halving would only approach.
  bool cut_by_bisector(const TrianglePart& piece, PrismCut& out) const {
    if (piece.at_worst == piece.nearest) return false;
    const auto plane = bisector(b_.corners(piece.nearest), b_.corners(piece.at_worst),
                                piece.polygon.centroid(), 1e-20);
    if (!plane) return false;
    out.count = 2;
    return cut(piece.polygon, plane->point, plane->normal, out.piece[0], out.piece[1]);
  }

  /// Whether the piece is so much larger than the triangle next to it that cutting along that
  /// one's prism would only break splinters off.
  [[nodiscard]] bool much_larger(const TrianglePart& piece, double enough) const {
    const auto& [a, b, c] = b_.corners(piece.nearest);
    const double size =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    if (size > kNearby * enough * enough) return false;
    if (size <= enough * enough) return true;
    double own = 0;
    for (int i = 0; i < piece.polygon.size; ++i)
      own = std::max(own,
                     (piece.polygon.corner[i] - piece.polygon.corner[(i + 1) % piece.polygon.size])
                         .squaredNorm());
    return own > kMuchLarger * size;
  }
  static constexpr double kMuchLarger = 9, kNearby = 16;  // squared

  std::vector<TrianglePart> cut_all(const std::vector<TrianglePart>& pieces, int round) const {
    std::vector<TrianglePart> out;
    out.reserve(3 * pieces.size());
    const double enough = limit();
    for (const TrianglePart& p : pieces) {
      PrismCut cuts;
      if (much_larger(p, enough)) {
        halve(p.polygon, cuts.piece[0], cuts.piece[1]);
        cuts.count = 2;
      } else if (round % 4 == 0 || round % 2 == 1 || !cut_by_bisector(p, cuts)) {
        const auto& [a, b, c] = b_.corners(p.nearest);
        cuts = cut_by_prism(p.polygon, a, b, c, round % 4 == 0);
      }
      for (int i = 0; i < cuts.count; ++i)
        out.push_back({cuts.piece[i], p.upper, p.nearest, p.at_worst});
    }
    return out;
  }

  std::span<const std::array<Vec3, 3>> a_;
  const TriangleSearch& b_;
  const DistanceOptions& options_;
  const Interior* inside_;
  double magnitude_ = 0;
  double diagonal_ = 0;
  double moved_ = 0;     // how far cuts have moved corners of the pieces from A
  double measured_ = 0;  // largest lower bound of a distance at points that may be that far from A
  double decided_ = 0;   // largest upper bound among the pieces that need no further cut
  std::vector<std::vector<Box3>> boxes_;  // of clusters, smallest first
  DirectedDistance result_;
};

}  // namespace

DirectedDistance directed_distance(const Mesh& a, const TriangleSearch& b,
                                   const DistanceOptions& options, const Interior* inside) {
  if (a.empty()) throw Error(ErrorCode::InvalidInput, "distance from a mesh without triangles");
  std::vector<std::array<Vec3, 3>> corners;
  corners.reserve(a.triangles.size());
  for (const std::uint32_t t : spatial_order(a)) {
    const auto& [i, j, k] = a.triangles[t];
    corners.push_back({a.vertices[i], a.vertices[j], a.vertices[k]});
  }
  return BranchAndBound(corners, b, options, inside).run();
}

DirectedDistance directed_distance(const TriangleSearch& a, const TriangleSearch& b,
                                   const DistanceOptions& options, const Interior* inside) {
  return BranchAndBound(a.ordered(), b, options, inside).run();
}

}  // namespace kaboum::geom
