// Largest distance of a surface from another one: branch and bound over boxes, triangles and their
// parts. docs/algorithms/distances.md.
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/geom/directed_distance.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

#include <kaboum/geom/spatial_order.h>

#include "upper_distances.h"

namespace kaboum::geom {
namespace {

constexpr std::uint32_t kNone = TriangleSearch::kNone;
constexpr double kInfinity = std::numeric_limits<double>::infinity();
/// A rounded centroid is this far from the exact one at most, times the largest |coordinate|:
/// docs/algorithms/distances.md.
constexpr double kCentroidError = 1.5e-15;
/// A triangle is a needle where the squared sine of its smallest angle is below this: rounded
/// weights of its points lose too much.
constexpr double kNeedle = 1e-8;

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
  std::uint32_t at_worst = kNone;  ///< to the corner farthest from that, or as `nearest`
  std::uint32_t place = 0;         ///< of the triangle in spatial order
  int depth = 0;                   ///< cuts that it comes of
};

/// A cluster or piece that is open.
struct Open {
  double upper;
  std::uint32_t place;  ///< of its first triangle in spatial order
  std::uint32_t index;  ///< among the clusters or pieces
  bool cluster;

  [[nodiscard]] bool before(const Open& other) const {
    return std::tie(place, cluster, index) < std::tie(other.place, other.cluster, other.index);
  }
};

/// What is found out about some clusters or pieces.
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

  void add(const Finding& other) {
    measured = std::max(measured, other.measured);
    decided = std::max(decided, other.decided);
    queries += other.queries;
    if (other.lower <= lower) return;
    lower = other.lower;
    at = other.at;
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

  /// The open ones with the largest upper bounds come first: they would have to be looked at in any
  /// order, unless the lower bound rises, which these are the most likely to bring about.
  DirectedDistance run() {
    clusters_ = bound_clusters();
    for (std::uint32_t i = 0; i < clusters_.size(); ++i)
      open_.push_back({clusters_[i].upper, clusters_[i].first, i, true});
    for (;;) {
      drop_decided();
      if (open_.empty()) break;
      if (open_.size() > options_.max_pieces) {
        give_up();
        break;
      }
      look_at(farthest());
    }
    result_.max_upper = std::max(decided_, result_.max_lower);
    result_.within_gap = result_.max_upper <= allowed() * (1 + 1e-15);
    return result_;
  }

 private:
  static constexpr int kMostCuts = 200;
  // Sizes of clusters, halving eightfold.
  static constexpr std::uint32_t kLargestCluster = 4096;
  static constexpr std::uint32_t kSmallestCluster = 8;
  // Of the open ones this share, but no fewer than that, is looked at at once.
  static constexpr std::size_t kShare = 4, kLeast = 64;
  // That many one after the other, which are neighbours.
  static constexpr std::size_t kBlock = 16;

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

  /// Decides whole clusters of triangles where it can, level by level; returns the small ones left.
  std::vector<Cluster> bound_clusters() {
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
    return level;
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

  // -- what is open ------------------------------------------------------------------------------

  /// How far rounding may have moved the corners of a piece of so many cuts from A.
  [[nodiscard]] double moved_by(int depth) const {
    return depth * PrismCut::kCuts * ConvexPolygon::kCutError * magnitude_;
  }

  void drop_decided() {
    const double enough = limit();
    std::erase_if(open_, [&](const Open& o) {
      if (o.upper > enough) return false;
      decided_ = std::max(decided_, o.upper + (o.cluster ? 0 : moved_by(pieces_[o.index].depth)));
      if (!o.cluster) unused_.push_back(o.index);
      return true;
    });
  }

  /// What is known of the open ones is a bound all the same.
  void give_up() {
    for (const Open& o : open_)
      decided_ = std::max(decided_, o.upper + (o.cluster ? 0 : moved_by(pieces_[o.index].depth)));
  }

  /// Takes those with the largest upper bounds away, neighbours one after the other.
  std::vector<Open> farthest() {
    const std::size_t count =
        std::min(open_.size(), std::max(kLeast, rose_ ? open_.size() / kShare : open_.size()));
    const auto begin = open_.begin(), end = begin + static_cast<std::ptrdiff_t>(count);
    std::nth_element(begin, end - 1, open_.end(), [&](const Open& a, const Open& b) {
      return a.upper != b.upper ? a.upper > b.upper : a.before(b);
    });
    std::vector<Open> chosen(begin, end);
    open_.erase(begin, end);
    std::sort(chosen.begin(), chosen.end(),
              [](const Open& a, const Open& b) { return a.before(b); });
    return chosen;
  }

  /// Bounds the triangles of clusters, and the parts of pieces, and keeps what is not decided.
  void look_at(const std::vector<Open>& chosen) {
    for (const Open& o : chosen)
      if (!o.cluster) moved_ = std::max(moved_, moved_by(pieces_[o.index].depth + 1));
    struct Outcome {
      Finding finding;
      std::vector<TrianglePart> pieces;
    };
    std::vector<Outcome> outcomes((chosen.size() + kBlock - 1) / kBlock);
    const double enough = limit();
    const double before = result_.max_lower;
    parallel_for(std::size_t{0}, outcomes.size(), [&](std::size_t block) {
      Outcome& outcome = outcomes[block];
      std::uint32_t recent = kNone;
      const std::size_t end = std::min(chosen.size(), (block + 1) * kBlock);
      for (std::size_t i = block * kBlock; i < end; ++i) {
        const auto look = [&](TrianglePart& piece) {
          Finding& finding = outcome.finding;
          finding.add(bound(piece, enough, recent));
          if (piece.upper <= enough)
            finding.decided = std::max(finding.decided, piece.upper + moved_by(piece.depth));
          else
            outcome.pieces.push_back(piece);
        };
        if (chosen[i].cluster)
          each_triangle(clusters_[chosen[i].index], look);
        else
          each_part(pieces_[chosen[i].index], enough, look);
      }
    });
    for (const Open& o : chosen)
      if (!o.cluster) unused_.push_back(o.index);
    for (const Outcome& o : outcomes) {
      take(o.finding);
      for (const TrianglePart& piece : o.pieces) keep(piece);
    }
    rose_ = result_.max_lower > before;
  }

  void keep(const TrianglePart& piece) {
    if (piece.depth == kMostCuts) {
      decided_ = std::max(decided_, piece.upper + moved_by(piece.depth));
      return;
    }
    auto index = static_cast<std::uint32_t>(pieces_.size());
    if (unused_.empty()) {
      pieces_.push_back(piece);
    } else {
      index = unused_.back();
      unused_.pop_back();
      pieces_[index] = piece;
    }
    open_.push_back({piece.upper, piece.place, index, false});
  }

  template <class Look>
  void each_triangle(const Cluster& cluster, const Look& look) const {
    for (std::uint32_t i = cluster.first; i < cluster.first + cluster.count; ++i) {
      const auto& [a, b, c] = a_[i];
      TrianglePart piece{{a, b, c}, kInfinity, cluster.hint, cluster.hint, i};
      look(piece);
    }
  }

  template <class Look>
  void each_part(const TrianglePart& whole, double enough, const Look& look) const {
    const PrismCut cuts = parts_of(whole, enough);
    for (int i = 0; i < cuts.count; ++i) {
      TrianglePart piece{cuts.piece[i],  whole.upper, whole.nearest,
                         whole.at_worst, whole.place, whole.depth + 1};
      look(piece);
    }
  }

  // -- pieces ------------------------------------------------------------------------------------

  /// Distances of the corners from triangle t. @return the number of the largest one
  int corner_distances(const ConvexPolygon& polygon, std::uint32_t t,
                       std::array<double, ConvexPolygon::kCapacity>& out) const {
    const auto& [a, b, c] = b_.corners(t);
    const Vec3 u = b - a, v = c - a;
    const double uu = u.squaredNorm(), vv = v.squaredNorm(), ww = (c - b).squaredNorm();
    if (u.cross(v).squaredNorm() > kNeedle * std::max({uu * vv, vv * ww, ww * uu})) {
      upper_distances({polygon.corner.data(), static_cast<std::size_t>(polygon.size)}, a, b, c,
                      out.data());
    } else {
      for (int i = 0; i < polygon.size; ++i)
        out[i] = point_triangle_upper(polygon.corner[i], a, b, c);
    }
    return static_cast<int>(std::max_element(out.begin(), out.begin() + polygon.size) -
                            out.begin());
  }

  /// Largest distance of the corners from triangle t, and the corner where it is.
  std::pair<double, int> worst_corner(const ConvexPolygon& polygon, std::uint32_t t) const {
    std::array<double, ConvexPolygon::kCapacity> distance;
    const int where = corner_distances(polygon, t, distance);
    return {distance[where], where};
  }

  /// Lowers piece.upper until it is `enough` or nothing more is known.
  /// @param recent  the triangle of B that was nearest to something a little while ago
  Finding bound(TrianglePart& piece, double enough, std::uint32_t& recent) const {
    Finding finding;
    // What was near the piece that this one was cut from, or near another one, may settle it
    // without a query.
    const auto settles = [&](std::uint32_t t) {
      if (t == kNone) return false;
      piece.upper = std::min(piece.upper, worst_corner(piece.polygon, t).first);
      return piece.upper <= enough;
    };
    if (settles(piece.nearest)) return finding;
    if (piece.at_worst != piece.nearest && settles(piece.at_worst)) return finding;
    if (recent != piece.nearest && recent != piece.at_worst && settles(recent)) return finding;
    const double moved = moved_by(piece.depth);
    const Vec3 center = piece.polygon.centroid();
    const auto at_center = b_.nearest(center, piece.nearest);
    finding.queries = 1;
    consider(finding, at_center.lower, center, moved + kCentroidError * magnitude_);
    double radius = 0;
    for (int i = 0; i < piece.polygon.size; ++i)
      radius = std::max(radius, (piece.polygon.corner[i] - center).norm());
    piece.upper = std::min(piece.upper, (at_center.upper + radius) * (1 + 1e-14));
    piece.nearest = piece.at_worst = recent = at_center.triangle;
    const auto [worst, where] = worst_corner(piece.polygon, at_center.triangle);
    piece.upper = std::min(piece.upper, worst);
    if (piece.upper <= enough) return finding;
    if (inside_ != nullptr && decide_inside(piece, center, radius, at_center.lower, enough))
      return finding;
    // Corners of A's own triangles have not been moved by cuts; the others say little that parts
    // will not where no cut by a bisector follows.
    if (piece.depth == 0 || (by_bisector(piece.depth) && !much_larger(piece, enough)))
      look_at_corner(piece, where, finding);
    return finding;
  }

  /// The corner that is far from the triangle next to the centroid may be near another one.
  void look_at_corner(TrianglePart& piece, int where, Finding& finding) const {
    const Vec3& corner = piece.polygon.corner[where];
    const auto at_corner = b_.nearest(corner, piece.nearest);
    ++finding.queries;
    consider(finding, at_corner.lower, corner, moved_by(piece.depth));
    piece.at_worst = at_corner.triangle;
    if (piece.at_worst != piece.nearest)
      piece.upper = std::min(piece.upper, worst_corner(piece.polygon, piece.at_worst).first);
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

  /// Whether a cluster's upper bound is good enough; then it counts.
  bool decide(double upper) {
    if (upper > limit()) return false;
    decided_ = std::max(decided_, upper);
    return true;
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

  /// Whether pieces of so many cuts are cut by bisectors; those of others along prisms, or, now and
  /// then, in halves.
  static bool by_bisector(int depth) { return depth % 4 == 1; }
  static bool in_halves(int depth) { return depth % 4 == 3; }

  [[nodiscard]] PrismCut parts_of(const TrianglePart& p, double enough) const {
    PrismCut cuts;
    if (much_larger(p, enough)) {
      halve(p.polygon, cuts.piece[0], cuts.piece[1]);
      cuts.count = 2;
      return cuts;
    }
    if (by_bisector(p.depth) && cut_by_bisector(p, cuts)) return cuts;
    const auto& [a, b, c] = widened(b_.corners(p.nearest), p.polygon, enough);
    return cut_by_prism(p.polygon, a, b, c, in_halves(p.depth));
  }

  /// A triangle with its sides moved outwards, as far as what is over it then is mostly near enough
  /// to it: cut along its prism, more of the polygon is settled.
  static std::array<Vec3, 3> widened(const std::array<Vec3, 3>& t, const ConvexPolygon& polygon,
                                     double enough) {
    constexpr double kPart = 0.3, kWorthWhile = 0.05;
    const auto& [a, b, c] = t;
    const Vec3 n = (b - a).cross(c - a);
    const double area = n.norm(), ab = (b - a).norm(), bc = (c - b).norm(), ca = (a - c).norm();
    if (!(area > 1e-3 * ab * ca)) return t;
    double height = 0;
    for (int i = 0; i < polygon.size; ++i)
      height = std::max(height, std::abs(n.dot(polygon.corner[i] - a)) / area);
    if (!(height < enough)) return t;
    // About the middle of the inscribed circle, whose radius is area / around.
    const double around = ab + bc + ca;
    const double by = kPart * std::sqrt(enough * enough - height * height) * around / area;
    if (by < kWorthWhile) return t;
    const Vec3 middle = (bc * a + ca * b + ab * c) / around;
    std::array<Vec3, 3> out = t;
    for (Vec3& p : out) p += by * (p - middle);
    return out;
  }

  std::span<const std::array<Vec3, 3>> a_;
  const TriangleSearch& b_;
  const DistanceOptions& options_;
  const Interior* inside_;
  double magnitude_ = 0;
  double diagonal_ = 0;
  double moved_ = 0;     // how far cuts have moved corners of the pieces from A at most
  double measured_ = 0;  // largest lower bound of a distance at points that may be that far from A
  double decided_ = 0;   // largest upper bound among the pieces that need no further cut
  std::vector<Cluster> clusters_;
  std::vector<TrianglePart> pieces_;
  std::vector<std::uint32_t> unused_;  // places among the pieces
  std::vector<Open> open_;
  bool rose_ = true;                      // the lower bound, when some were last looked at
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
