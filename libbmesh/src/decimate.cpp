// Bounding mesh decimation.
// [gaschler2016] A. Gaschler, Efficient Geometric Predicates for Integrated Task and Motion
// Planning, §4.3, Algorithms 1 and 2. The certificate and the error bound:
// docs/algorithms/bounding-mesh.md.
#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/error.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bucket_queue.h"
#include "compact.h"
#include "connectivity.h"
#include "deviation.h"
#include "flatten.h"
#include "optimise.h"
#include "original_solid.h"
#include "placement.h"
#include "quadric.h"
#include "tolerance.h"
#include "working_mesh.h"

namespace kaboum::bmesh {
namespace {

using geom::Mesh;
using geom::Sign;
using geom::Triangle;

/// Spacing of the representable numbers at x, at least.
double spacing(double x, Precision precision) {
  if (precision == Precision::Float) return geom::float32_spacing(x);
  const double a = std::abs(x);
  return std::nextafter(a, std::numeric_limits<double>::infinity()) - a;
}

/// Distances are measured from this many times the wished number of vertices on; before, they are
/// so small that the quadrics order the contractions as well.
constexpr std::size_t kMeasureFrom = 5;
constexpr double kMeasureFromEpsilon = 0.1;  ///< the same by an error bound

/// The constrained minimum of a sum of planes is several times the unconstrained one. Edges that
/// enter the queue with the latter are evaluated long before they are due, mostly in vain:
/// something in their star changes first. The other costs are ordered as in the thesis.
constexpr double kAnticipationPlanes = 3, kAnticipationDistance = 8;

/// From this multiple of the wished number of vertices on, the best effort contracts edges together
/// with moves of the vertices around, at first within the deviation reached, then within that much
/// more from round to round.
constexpr double kJointFrom = 1.4, kJointGrowth = 1.15;
constexpr int kJointRounds = 12;

/// A spike goes farther from the original than this share of the diagonal, and this many times
/// farther than the original is from the new triangles there.
constexpr double kSpike = 0.05, kSpikeRatio = 3;

/// Samples of the original lie no farther apart than this share of the error bound, within reason,
/// where contractions move the vertices around.
constexpr double kSpacing = 0.7;

// Rounds of optimisation, at most: in the end, and at each stage before.
constexpr int kFinalPasses = 6, kFinalPassesBest = 12, kStagePasses = 3;

class Decimator {
 public:
  Decimator(const geom::Prepared& input, const DecimateOptions& options)
      : options_(options),
        joint_(options.epsilon && options.cost == Cost::Distance && options.effort != Effort::Fast),
        sign_(options.direction == Direction::Inner ? -1 : 1),
        constrained_(options.direction != Direction::Any),
        anticipation_(options.cost == Cost::Distance ? kAnticipationDistance
                      : options.cost == Cost::Planes || options.cost == Cost::Mean
                          ? kAnticipationPlanes
                          : 1),
        regularisation_(by_area() ? kRegularisationDistance : kRegularisation),
        origin_(geom::bounding_box(input.mesh).center()),
        diagonal_(geom::bounding_box(input.mesh).diagonal()),
        reach_(reach(geom::bounding_box(input.mesh))),
        original_(input.mesh),
        closed_(input.closed),
        working_(input),
        quadric_(input.mesh.vertices.size()),
        stamp_(input.mesh.vertices.size(), 0),
        around_(input.mesh.vertices.size(), 0),
        mark_(input.mesh.vertices.size(), 0),
        vertices_(input.mesh.vertices.size()) {
    statistics_.vertices_in = vertices_;
    init_quadrics(input.mesh);
    if (options.epsilon) tolerance_.emplace(input.mesh, *options.epsilon);
    if (options.direction == Direction::Inner && closed_ && !options.keep_convex)
      solid_.emplace(original_);
  }

  /// Runs on from where the last call has stopped.
  DecimateResult run(std::optional<std::size_t> target) {
    target_ = target;
    const Stop stop = contract_all();
    DecimateResult result;
    if (options_.precision == Precision::Float) result.unrepresentable = make_representable();
    result.stop = stop;
    result.mesh = compact(position_, mesh_);
    statistics_.vertices_out = result.mesh.vertices.size();
    result.statistics = statistics_;
    return result;
  }

  /// Steps from now on are certified against this mesh, the present one, instead of the original.
  /// It must outlive this object.
  void nest_in(const Mesh& level) {
    bound_ = &level;
    if (solid_) solid_.emplace(level);
    if (pulls_back_meanwhile()) {
      if (optimiser_) start_optimising();
      return;
    }
    // Contractions to come are not measured; the next rounds begin anew.
    measuring_ = false;
    optimiser_.reset();
    deviation_.reset();
  }

 private:
  /// Half the box, and its diagonal more on every side: no vertex goes farther, whatever it costs.
  static Vec3 reach(const geom::Box3& box) {
    return 0.5 * (box.max - box.min) + Vec3::Constant(box.diagonal());
  }

  // ---- set-up
  // -------------------------------------------------------------------------------------

  /// Whether deviations are followed while contracting, not only in the end.
  [[nodiscard]] bool pulls_back_meanwhile() const {
    return options_.cost == Cost::Distance ||
           (options_.cost == Cost::Mean && options_.effort != Effort::Fast);
  }

  /// Whether planes count by the area of their triangles.
  [[nodiscard]] bool by_area() const {
    return options_.cost == Cost::Distance || options_.cost == Cost::Mean;
  }

  [[nodiscard]] Vec3 local(std::uint32_t v) const { return position_[v] - origin_; }

  void init_quadrics(const Mesh& mesh) {
    for (std::uint32_t t = 0; t < mesh_.size(); ++t) {
      const Triangle& tri = mesh_[t];
      Quadric q = options_.cost == Cost::Triangles
                      ? point_quadric((local(tri[0]) + local(tri[1]) + local(tri[2])) / 3.0)
                      : plane_quadric(local(tri[0]), normal_[t]);
      if (by_area()) {
        const Vec3& a = position_[tri[0]];
        q *= 0.5 * (position_[tri[1]] - a).cross(position_[tri[2]] - a).norm();
      }
      for (const std::uint32_t v : tri) quadric_[v] += q;
    }
    if (options_.cost != Cost::Triangles && !by_area() && options_.sharp_angle < 180)
      add_sharp_edges(mesh);
  }

  void add_sharp_edges(const Mesh& mesh) {
    const double limit = std::cos(options_.sharp_angle * std::numbers::pi / 180);
    for (std::uint32_t t = 0; t < mesh_.size(); ++t) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t a = mesh_[t][k], b = mesh_[t][(k + 1) % 3];
        if (a > b) continue;
        mesh_.for_each_triangle(b, [&](std::uint32_t u, std::uint32_t j) {
          if (mesh_[u][(j + 1) % 3] != a || normal_[t].dot(normal_[u]) >= limit) return;
          const Vec3 sum = normal_[t] + normal_[u];
          const Vec3 across = sum.norm() > 1e-6
                                  ? sum
                                  : Vec3((mesh.vertices[b] - mesh.vertices[a]).cross(normal_[t]));
          if (!(across.norm() > 0)) return;
          const Quadric q = plane_quadric(local(a), across.normalized());
          quadric_[a] += q;
          quadric_[b] += q;
        });
      }
    }
  }

  [[nodiscard]] Quadric merged(std::uint32_t a, std::uint32_t b) const {
    switch (options_.cost) {
      case Cost::PlanesAdapted:
        return add_adapted(quadric_[a], quadric_[b]);
      case Cost::PlanesDiagonal: {
        const double length = (position_[b] - position_[a]).norm();
        if (length > 0) return add_diagonal(quadric_[a], quadric_[b], length, options_.as_printed);
        break;
      }
      case Cost::Distance:
      case Cost::Mean:
      case Cost::Planes:
      case Cost::Triangles:
        break;
    }
    return quadric_[a] + quadric_[b];
  }

  // ---- the queue
  // ----------------------------------------------------------------------------------

  /// Entered with what the cost is expected to be; the constrained cost is found when the edge is
  /// popped.
  void push_edge(std::uint32_t a, std::uint32_t b) {
    if (border_[a] != 0 && border_[b] != 0) return;
    const Quadric q = merged(a, b);
    const Vec3 middle = 0.5 * (local(a) + local(b));
    const double free = std::max(0.0, unconstrained_minimum(q, middle, regularisation_));
    const double expected = key(q, anticipation_ * free + length_cost(q, a, b));
    queue_.push(expected, {a, b, stamp_[a] + stamp_[b]});
  }

  /// What the queue is ordered by: the quadric's value or, for the distance, the root mean square
  /// of the distances to the planes that it stands for. [length²] or [length]
  [[nodiscard]] double key(const Quadric& q, double value) const {
    if (options_.cost != Cost::Distance) return value;
    const double trace = q.trace();
    return trace > 0 ? std::sqrt(value / trace) : 0;
  }

  /// Prefers short edges where the quadric is indifferent, as in planes: 10^-4 of the length.
  [[nodiscard]] double length_cost(const Quadric& q, std::uint32_t a, std::uint32_t b) const {
    return 1e-8 * q.trace() * (position_[b] - position_[a]).squaredNorm();
  }

  void push_all() {
    queue_.reserve(room(mesh_.size() * 3 / 2));
    for (std::uint32_t v = 0; v < position_.size(); ++v) {
      if (!mesh_.used(v)) continue;
      ++mark_value_;
      mesh_.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
        for (std::uint32_t j = 1; j < 3; ++j) {
          const std::uint32_t w = mesh_[t][(k + j) % 3];
          if (w <= v || mark_[w] == mark_value_) continue;
          mark_[w] = mark_value_;
          push_edge(v, w);
        }
      });
    }
  }

  /// Entries at which stale ones are dropped, when there are so many without them.
  static std::size_t room(std::size_t entries) { return entries + entries / 2 + 1024; }

  // Stamps only rise, so a sum of two is unchanged only if both are.
  [[nodiscard]] bool stale(const BucketQueue::Entry& e) const {
    return stamp_[e.a] + stamp_[e.b] != e.stamps;
  }

  Stop contract_all() {
    const std::size_t target = target_.value_or(0);
    if (!pulls_back_meanwhile()) {
      contract_to(target);
    } else {
      if (!measuring_) {
        // Small deviations need no measuring: the quadrics order the contractions as well.
        contract_to(kMeasureFrom * target, options_.epsilon && options_.cost == Cost::Distance
                                               ? kMeasureFromEpsilon * *options_.epsilon
                                               : std::numeric_limits<double>::infinity());
        start_measuring();
      }
      contract_in_stages(target);
    }
    optimise(options_.effort == Effort::Best ? kFinalPassesBest : kFinalPasses);
    if (target_ && vertices_ <= target) return Stop::VertexTarget;
    return bounded_ ? Stop::ErrorBound : Stop::Exhausted;
  }

  void contract_in_stages(std::size_t target) {
    if (options_.effort == Effort::Best && optimiser_ && !options_.epsilon) {
      contract_to(static_cast<std::size_t>(kJointFrom * static_cast<double>(target)));
      double limit = std::min(queue_.lowest_key(), diagonal_);
      if (!(limit > 0)) limit = 1e-3 * diagonal_;  // nothing has been contracted yet
      for (int i = 0; i < kJointRounds && vertices_ > target; ++i, limit *= kJointGrowth) {
        optimise(1);
        collapse_to(target, limit);
      }
    }
    contract_to(target);
    if (!options_.epsilon || options_.effort == Effort::Fast) return;
    // What is given back makes room for further contractions within the error bound.
    for (std::size_t before = vertices_ + vertices_;
         vertices_ > target && 100 * vertices_ < 99 * before;) {
      before = vertices_;
      optimise(kStagePasses);
      contract_to(target);
    }
    if (!joint_ || !optimiser_) return;
    for (std::size_t before = vertices_ + vertices_;
         vertices_ > target && 100 * vertices_ < 99 * before;) {
      before = vertices_;
      collapse_to(target, *options_.epsilon);
      optimise(kStagePasses);
    }
  }

  /// Contracts edges together with moves of the vertices around, each within the limit. [length]
  void collapse_to(std::size_t target, double limit) {
    struct Edge {
      double cost;
      std::uint32_t a, b;
    };
    std::vector<Edge> edges;
    for (std::uint32_t t = 0; t < mesh_.size(); ++t) {
      if (!mesh_.alive(t)) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t a = mesh_[t][k], b = mesh_[t][(k + 1) % 3];
        if (a > b) continue;
        const Quadric q = merged(a, b);
        edges.push_back({key(q, std::max(0.0, unconstrained_minimum(q, 0.5 * (local(a) + local(b)),
                                                                    regularisation_))),
                         a, b});
      }
    }
    std::stable_sort(edges.begin(), edges.end(),
                     [](const Edge& x, const Edge& y) { return x.cost < y.cost; });
    for (const Edge& e : edges) {
      if (vertices_ <= target) return;
      bool adjacent = false;
      if (mesh_.used(e.a) && mesh_.used(e.b))
        mesh_.for_each_triangle(e.a, [&](std::uint32_t t, std::uint32_t) {
          for (const std::uint32_t w : mesh_[t]) adjacent = adjacent || w == e.b;
        });
      if (!adjacent) continue;
      if (!optimiser_->collapse(e.a, e.b, limit)) continue;
      quadric_[e.a] = merged(e.a, e.b);
      ++stamp_[e.a];
      ++stamp_[e.b];
      --vertices_;
    }
  }

  /// Contracts until `target` vertices are left or the next costs more than `limit`.
  void contract_to(std::size_t target, double limit = std::numeric_limits<double>::infinity()) {
    for (bool progress = true; progress && vertices_ > target;) {
      progress = false;
      queue_ = {};
      push_all();
      std::size_t purge_at = room(queue_.size());
      BucketQueue::Entry e;
      const std::uint64_t rejected_before = statistics_.rejected_distance;
      while (vertices_ > target && queue_.pop(e)) {
        if (queue_.lowest_key() > limit) return;
        if (stale(e)) continue;
        // Evaluated anew each time it is popped: what is applied holds for the planes of this
        // moment.
        const Validity validity = evaluate(e.a, e.b, optimiser_ ? Settled : Due);
        if (validity == Validity::Later) queue_.push(candidate_.cost, e);
        if (validity != Validity::Valid) continue;
        if (optimiser_ && !settle()) continue;
        if (measuring_) {
          if (e.measured == around_[e.a] + around_[e.b]) {
            candidate_.cost = 0;
          } else if (queue_.due(candidate_.cost) && !measure(e)) {
            continue;
          }
        }
        if (!queue_.due(candidate_.cost)) {
          queue_.push(candidate_.cost, e);
          continue;
        }
        if (candidate_.settled) {
          if (!certify(e)) continue;
          if (!queue_.due(candidate_.cost)) {
            queue_.push(candidate_.cost, e);
            continue;
          }
        }
        if (!admissible()) continue;
        apply();
        progress = true;
        if (queue_.size() > purge_at) {
          queue_.purge([&](const BucketQueue::Entry& x) { return stale(x); });
          purge_at = room(queue_.size());
        }
      }
      bounded_ = statistics_.rejected_distance > rejected_before;  // by epsilon alone
    }
  }

  // ---- measured distances
  // -------------------------------------------------------------------------

  void start_measuring() {
    deviation_.emplace(original_, options_.cost == Cost::Mean ? 2 : 4,
                       joint_ ? kSpacing * *options_.epsilon : 0);
    deviation_->assign(position_, mesh_);
    hint_.assign(position_.size(), 0);
    measuring_ = true;
    if (options_.effort != Effort::Fast) start_optimising();
  }

  /// Replaces the cost by the measured distance; when that turns out to be beyond what is due, the
  /// edge goes back into the queue with what is known. @return whether the cost is known.
  bool measure(BucketQueue::Entry& e) {
    describe_change();
    describe_points();
    if (options_.cost == Cost::Mean)  // whose cost is the quadric's
      return !spikes() || reject(statistics_.rejected_spike);
    const double limit = 1.2 * std::max(queue_.lowest_key(), candidate_.cost);
    const double squared =
        deviation_->largest(removed_, added_, points_, hint_[e.a], limit * limit);
    candidate_.cost = std::max(candidate_.cost, std::sqrt(squared));
    if (options_.epsilon && candidate_.cost > *options_.epsilon)
      return reject(statistics_.rejected_distance);
    if (candidate_.cost > limit) {
      e.measured = ~0U;
      queue_.push(candidate_.cost, e);
      return false;
    }
    if (candidate_.cost > kSpike * diagonal_ && spikes()) return reject(statistics_.rejected_spike);
    e.measured = around_[e.a] + around_[e.b];
    return true;
  }

  /// Moves the candidate to where the original bounds it instead of the present mesh.
  bool settle() {
    describe_change();
    const Quadric q = merged(candidate_.a, candidate_.b);
    const bool free = border_[candidate_.a] == 0 && border_[candidate_.b] == 0;
    const auto place =
        free ? optimiser_->settle(removed_, added_, q, origin_) : std::optional<Vec3>();
    if (place && settle_at(*place)) return true;
    return candidate_.encloses || reject(statistics_.rejected_no_position);
  }

  bool settle_at(const Vec3& place) {
    const Vec3 before = candidate_.position;
    candidate_.position = place;
    if (((place - origin_).cwiseAbs().array() > reach_.array()).any() || folds()) {
      candidate_.position = before;
      return false;
    }
    candidate_.settled = true;
    find_cost(merged(candidate_.a, candidate_.b));
    return true;
  }

  /// The exact test of a settled candidate; seeks other places until it holds, or takes the one
  /// that the present mesh bounds. @return whether the cost is known.
  bool certify(BucketQueue::Entry& e) {
    constexpr int kAttempts = 5;
    bool moved = false;
    for (int i = 0; i < kAttempts; ++i) {
      if (optimiser_->settled(removed_, candidate_.position)) return !moved || measure(e);
      const auto place = optimiser_->resettle();
      if (!place || !settle_at(*place)) break;
      moved = true;
    }
    if (!candidate_.encloses) return reject(statistics_.rejected_original);
    candidate_.position = candidate_.enclosing;
    candidate_.settled = false;
    return measure(e);
  }

  [[nodiscard]] bool spikes() {
    const double least = kSpike * diagonal_;
    constexpr double kNoLimit = std::numeric_limits<double>::infinity();
    std::uint32_t& hint = hint_[candidate_.a];
    const double out = deviation_->largest({}, added_, points_, hint, kNoLimit);  // squared
    return out > least * least &&
           out > kSpikeRatio * kSpikeRatio *
                     deviation_->largest(removed_, added_, {}, hint, kNoLimit);
  }

  void describe_points() {
    points_.clear();
    points_.push_back({candidate_.position, 0});
    for (const NewTriangle& t : added_) {
      points_.push_back({0.5 * (t.corner[0] + t.corner[1]), 0});
      points_.push_back({(t.corner[0] + t.corner[1] + t.corner[2]) / 3.0, 0});
      if (joint_)
        for (int k = 0; k < 3; ++k)
          points_.push_back(
              {t.corner[k] * (2.0 / 3) + (t.corner[(k + 1) % 3] + t.corner[(k + 2) % 3]) / 6, 0});
    }
  }

  void start_optimising() {
    if (options_.keep_convex || (constrained_ && !closed_)) return;
    if (constrained_ && !solid_) solid_.emplace(*bound_);
    optimiser_.emplace(working_, *deviation_, constrained_ ? &*solid_ : nullptr, *bound_,
                       tolerance_ ? &*tolerance_ : nullptr, options_, statistics_);
    optimiser_->set_dense(joint_);
  }

  void optimise(int passes) {
    if (options_.effort == Effort::Fast) return;
    if (!deviation_) start_measuring();
    if (!optimiser_) return;
    for (int i = 0; i < passes; ++i)
      if (optimiser_->pass() == 0) break;
  }

  // ---- one candidate
  // ------------------------------------------------------------------------------

  struct StarTriangle {
    std::uint32_t index;
    std::uint32_t corner;  // of the moved vertex
    bool at_b;             // touches b and not a
    bool vanishes;         // touches both
  };

  struct Candidate {
    std::uint32_t a, b;
    Vec3 position;
    double cost;
    Vec3 enclosing;  // the place that the present mesh bounds
    bool encloses;   // there is one
    bool settled;    // the position is one that the original bounds
  };

  void gather(std::uint32_t a, std::uint32_t b) {
    star_.clear();
    mesh_.for_each_triangle(a, [&](std::uint32_t t, std::uint32_t k) {
      const Triangle& tri = mesh_[t];
      star_.push_back({t, k, false, tri[(k + 1) % 3] == b || tri[(k + 2) % 3] == b});
    });
    mesh_.for_each_triangle(b, [&](std::uint32_t t, std::uint32_t k) {
      const Triangle& tri = mesh_[t];
      if (tri[(k + 1) % 3] != a && tri[(k + 2) % 3] != a) star_.push_back({t, k, true, false});
    });
  }

  /// The link condition: the neighbours common to a and b are the corners opposite their edge, and
  /// no two triangles would come to coincide.
  [[nodiscard]] bool keeps_topology() {
    const std::uint32_t apex = ++mark_value_;
    std::uint32_t apexes = 0;
    for (const StarTriangle& s : star_) {
      if (!s.vanishes) continue;
      for (const std::uint32_t v : mesh_[s.index]) {
        if (v == candidate_.a || v == candidate_.b || mark_[v] == apex) continue;
        mark_[v] = apex;
        ++apexes;
      }
    }
    if (apexes == 0) return false;
    const auto is_apex = [&](std::uint32_t v) { return mark_[v] == apex; };
    // Triangles between two apexes on both sides would fold onto each other.
    bool between[2] = {false, false};
    for (const StarTriangle& s : star_) {
      if (s.vanishes) continue;
      const Triangle& t = mesh_[s.index];
      if (is_apex(t[(s.corner + 1) % 3]) && is_apex(t[(s.corner + 2) % 3])) between[s.at_b] = true;
    }
    if (between[0] && between[1]) return false;
    // Neighbours of a that are no apexes must not be neighbours of b.
    const std::uint32_t neighbour = ++mark_value_;
    bool common = false;
    for (const StarTriangle& s : star_) {
      if (s.vanishes) continue;
      const Triangle& t = mesh_[s.index];
      for (std::uint32_t j = 1; j < 3; ++j) {
        const std::uint32_t v = t[(s.corner + j) % 3];
        if (is_apex(v)) continue;
        if (!s.at_b)
          mark_[v] = neighbour;
        else
          common = common || mark_[v] == neighbour;
      }
    }
    return !common;
  }

  enum class Validity {
    None,   // there is no valid position
    Later,  // the cost is known and not due; nothing was tested
    Valid,
  };
  enum Purpose {
    Any,      // all tests are made
    Due,      // only of what is due
    Settled,  // positions that the present mesh does not bound will do to begin with
  };

  /// Fills candidate_ with the cheapest valid position for the edge (a, b).
  Validity evaluate(std::uint32_t a, std::uint32_t b, Purpose purpose) {
    candidate_.a = a;
    candidate_.b = b;
    candidate_.settled = false;
    gather(a, b);
    const Quadric q = merged(a, b);
    const bool free = border_[a] == 0 && border_[b] == 0;
    bool found = false;
    if (free) {
      if (options_.keep_convex) gather_rim();
      found = place(q, 1);
      if (found && purpose == Due) {
        find_cost(q);
        if (!queue_.due(candidate_.cost)) return Validity::Later;
      }
    }
    const auto none = [](std::uint64_t& counter) {
      ++counter;
      return Validity::None;
    };
    if (!keeps_topology()) return none(statistics_.rejected_topology);
    if (!free) {
      candidate_.position = border_[a] != 0 ? position_[a] : position_[b];
      if (!encloses()) return none(statistics_.rejected_predicate);
    } else {
      // The second attempt keeps farther from the planes, for positions that rounding spoils; the
      // end points themselves serve in flat places, where every plane of the star is the same one.
      const bool placed = found && (encloses() || (place(q, 16) && encloses()));
      if (!placed && !at_end_point()) {
        if (purpose == Settled) {
          candidate_.encloses = false;
          candidate_.position = position_[a] + 0.5 * (position_[b] - position_[a]);
          return Validity::Valid;
        }
        return none(found ? statistics_.rejected_predicate : statistics_.rejected_no_position);
      }
    }
    candidate_.enclosing = candidate_.position;
    candidate_.encloses = !folds();
    if (!candidate_.encloses && purpose != Settled) return none(statistics_.rejected_fold);
    find_cost(q);
    return Validity::Valid;
  }

  void find_cost(const Quadric& q) {
    candidate_.cost = key(q, std::max(0.0, q(candidate_.position - origin_)) +
                                 length_cost(q, candidate_.a, candidate_.b));
  }

  /// Tries to contract to an end point of the edge, where it is.
  bool at_end_point() {
    for (const std::uint32_t v : {candidate_.a, candidate_.b}) {
      candidate_.position = position_[v];
      if (options_.precision == Precision::Float && !geom::is_float32(candidate_.position))
        continue;
      if (encloses() && !folds()) return true;
    }
    return false;
  }

  static bool reject(std::uint64_t& counter) {
    ++counter;
    return false;
  }

  /// The axis that a unit normal is, or -1.
  static int axis(const Vec3& n) {
    if ((n.x() == 0) + (n.y() == 0) + (n.z() == 0) != 2) return -1;
    return n.x() != 0 ? 0 : n.y() != 0 ? 1 : 2;
  }

  /// Whether a rounded vertex can lie exactly on the triangle's plane: it is axis-aligned, at a
  /// representable coordinate.
  [[nodiscard]] bool can_lie_on(std::uint32_t t) const {
    const int k = axis(normal_[t]);
    return k >= 0 &&
           (options_.precision == Precision::Double || geom::is_float32(position_[mesh_[t][0]][k]));
  }

  /// Minimises the quadric over the half-spaces of the star and rounds the result.
  bool place(const Quadric& q, double care) {
    ++statistics_.placements;
    const Vec3 &pa = position_[candidate_.a], &pb = position_[candidate_.b];
    const Vec3 half = 0.5 * (pb - pa);
    const Vec3 middle = pa + half;
    // A rounded coordinate is off by half a spacing; what else is off is the minimiser's own error.
    const Vec3 spread(spacing(middle.x(), options_.precision),
                      spacing(middle.y(), options_.precision),
                      spacing(middle.z(), options_.precision));
    const double own_error = 1e-13 * half.lpNorm<1>();
    planes_.clear();
    if (constrained_) {
      for (const StarTriangle& s : star_) {
        const Vec3& n = normal_[s.index];
        const double margin =
            can_lie_on(s.index) ? 0 : care * (0.51 * n.cwiseAbs().dot(spread) + own_error);
        // Height of the middle over the plane, which passes through a or b.
        const double height = s.vanishes ? 0 : s.at_b ? -n.dot(half) : n.dot(half);
        planes_.push_back({sign_ * n, margin - sign_ * height});
      }
      for (const std::uint32_t t : rim_) {
        const Vec3& n = normal_[t];
        const double margin =
            can_lie_on(t) ? 0 : care * (0.51 * n.cwiseAbs().dot(spread) + own_error);
        planes_.push_back({-n, margin + n.dot(middle - position_[mesh_[t][0]])});
      }
    }
    const auto y = minimise(q, q.half_gradient(middle - origin_), planes_, regularisation_);
    if (!y) return false;
    candidate_.position = middle + *y;
    if (options_.precision == Precision::Float) {
      candidate_.position = geom::to_float32(candidate_.position);
    } else {
      snap_to_axis_planes(half.lpNorm<1>());
    }
    return ((candidate_.position - origin_).cwiseAbs().array() <= reach_.array()).all();
  }

  /// Puts the position exactly on axis-aligned planes that it is on but for rounding.
  void snap_to_axis_planes(double extent) {
    for (const StarTriangle& s : star_) {
      const int k = axis(normal_[s.index]);
      if (k < 0) continue;
      const double c = position_[mesh_[s.index][0]][k];
      if (std::abs(candidate_.position[k] - c) <= 1e-9 * extent) candidate_.position[k] = c;
    }
  }

  [[nodiscard]] Sign side(std::uint32_t t) {
    ++statistics_.predicates;
    const Triangle& tri = mesh_[t];
    return geom::orient3d(position_[tri[0]], position_[tri[1]], position_[tri[2]],
                          candidate_.position, &statistics_.exact_fallbacks);
  }

  /// The exact test that the certificate rests on: the new vertex is on the right side of, or on,
  /// the plane of every triangle of the star.
  [[nodiscard]] bool encloses() {
    if (!constrained_) return true;
    const Sign wrong = options_.direction == Direction::Inner ? Sign::Positive : Sign::Negative;
    for (const StarTriangle& s : star_)
      if (side(s.index) == wrong) return false;
    for (const std::uint32_t t : rim_)
      if (side(t) == Sign::Positive) return false;
    return true;
  }

  /// Whether a remaining triangle would collapse or turn by more than about 80 degrees.
  [[nodiscard]] bool folds() const {
    for (const StarTriangle& s : star_) {
      if (s.vanishes) continue;
      const Vec3& before = normal_[s.index];
      if (before.x() == 0 && before.y() == 0 && before.z() == 0) continue;
      const Triangle& t = mesh_[s.index];
      const Vec3& p = position_[t[(s.corner + 1) % 3]];
      const Vec3 n =
          (p - candidate_.position).cross(position_[t[(s.corner + 2) % 3]] - candidate_.position);
      const double along = n.dot(before);
      if (!(along > 0) || along * along < 0.03 * n.squaredNorm()) return true;
    }
    return false;
  }

  // ---- inner surfaces
  // ----------------------------------------------------------------------------------

  /// Exact: all that an inner step takes away is inside the original, so that no new triangle
  /// leaves it: no fold. docs/algorithms/bounding-mesh.md, "Inner surfaces".
  [[nodiscard]] bool stays_inside() {
    if (options_.direction != Direction::Inner || !solid_) return true;
    const auto corners = [&](const Triangle& t) {
      return std::array<Vec3, 3>{position_[t[0]], position_[t[1]], position_[t[2]]};
    };
    flat_.clear();
    for (const StarTriangle& s : star_) {
      const std::array<Vec3, 3> old = corners(mesh_[s.index]);
      if (side(s.index) != Sign::Zero) {
        if (!solid_->contains({old[0], old[1], old[2], candidate_.position}, true)) return false;
        continue;
      }
      if (s.vanishes) continue;
      std::array<Vec3, 3> now = old;
      now[s.corner] = candidate_.position;
      if (!same_orientation(old, now, &statistics_.exact_fallbacks)) return false;
      flat_.push_back(normal_[s.index]);
    }
    return !opposed(flat_);
  }

  // ---- convexity
  // ----------------------------------------------------------------------------------

  /// Collects the triangles across the star's boundary: the new vertex must stay on or below them.
  void gather_rim() {
    rim_.clear();
    for (const StarTriangle& s : star_) {
      if (s.vanishes) continue;
      const Triangle& t = mesh_[s.index];
      const std::uint32_t p = t[(s.corner + 1) % 3], q = t[(s.corner + 2) % 3];
      mesh_.for_each_triangle(q, [&](std::uint32_t u, std::uint32_t k) {
        if (mesh_[u][(k + 1) % 3] == p) rim_.push_back(u);
      });
    }
    if (options_.direction == Direction::Inner) rim_.clear();
  }

  /// Exact: no vertex would be above a new triangle. The other triangles keep all vertices below
  /// them: outwards the new vertex was tested against those across the star's boundary (beyond them
  /// none is visible from it), inwards it lies in the old, convex body.
  [[nodiscard]] bool stays_convex() {
    const bool inner = options_.direction == Direction::Inner;
    bool solid = !inner;  // inwards the body might be flattened
    for (const StarTriangle& s : star_) {
      if (s.vanishes) continue;
      const Triangle& t = mesh_[s.index];
      const Vec3 &p = position_[t[(s.corner + 1) % 3]], &q = position_[t[(s.corner + 2) % 3]];
      const auto below = [&](std::uint32_t v) {
        if (v == candidate_.a || v == candidate_.b) return true;
        ++statistics_.predicates;
        const Sign height =
            geom::orient3d(candidate_.position, p, q, position_[v], &statistics_.exact_fallbacks);
        solid = solid || height == Sign::Negative;
        return height != Sign::Positive;
      };
      if (inner) {
        for (std::uint32_t v = 0; v < position_.size(); ++v)
          if (mesh_.used(v) && !below(v)) return false;
        continue;
      }
      for (const std::uint32_t r : rim_)
        for (const std::uint32_t v : mesh_[r])
          if (!below(v)) return false;
    }
    return solid;
  }

  // ---- acceptance
  // ---------------------------------------------------------------------------------

  void describe_change() {
    removed_.clear();
    added_.clear();
    for (const StarTriangle& s : star_) {
      removed_.push_back(s.index);
      if (s.vanishes) continue;
      const Triangle& t = mesh_[s.index];
      added_.push_back({s.index,
                        {candidate_.position, position_[t[(s.corner + 1) % 3]],
                         position_[t[(s.corner + 2) % 3]]}});
    }
  }

  /// The dearer tests, made only of candidates that are about to be applied.
  [[nodiscard]] bool admissible() {
    if (options_.keep_convex && !stays_convex()) return reject(statistics_.rejected_predicate);
    if (!stays_inside()) return reject(statistics_.rejected_original);
    if (!tolerance_) return true;
    describe_change();
    if (!tolerance_->admits(removed_, added_)) return reject(statistics_.rejected_distance);
    return true;
  }

  void apply() {
    const std::uint32_t a = candidate_.a, b = candidate_.b;
    const Vec3 position = candidate_.position;
    if (tolerance_) tolerance_->commit(removed_);
    if (measuring_) {
      describe_change();
      deviation_->commit(removed_, added_);
    }
    if (options_.steps != nullptr) options_.steps->push_back({a, b, position});
    quadric_[a] = merged(a, b);
    mesh_.contract(a, b);
    position_[a] = position;
    border_[a] = border_[a] | border_[b];
    ++stamp_[a];
    ++stamp_[b];
    ++around_[a];
    --vertices_;
    ++statistics_.contractions;
    working_.update_normals_around(a);
    if (optimiser_) {
      optimiser_->disturb(a);
      optimiser_->pull_back(a);
    }
    const std::uint32_t seen = ++mark_value_;
    mesh_.for_each_triangle(a, [&](std::uint32_t t, std::uint32_t k) {
      for (std::uint32_t j = 1; j < 3; ++j) {
        const std::uint32_t w = mesh_[t][(k + j) % 3];
        if (mark_[w] == seen) continue;
        mark_[w] = seen;
        ++around_[w];
        push_edge(a, w);
      }
    });
    if (options_.progress && statistics_.contractions % 1024 == 0) options_.progress(vertices_);
  }

  // ---- representable coordinates
  // ------------------------------------------------------------------

  /// Moves vertices that float32 cannot hold to certified positions that it can, or contracts them
  /// away. Returns how many could not be helped.
  std::size_t make_representable() {
    std::vector<std::uint32_t> left;
    for (std::uint32_t v = 0; v < position_.size(); ++v)
      if (mesh_.used(v) && !geom::is_float32(position_[v])) left.push_back(v);
    // What fails now may succeed once a neighbour has moved.
    for (std::size_t before = left.size() + 1; left.size() < before;) {
      before = left.size();
      std::erase_if(left, [&](std::uint32_t v) {
        if (!mesh_.used(v)) return true;
        return border_[v] == 0 && (move_to_representable(v) || contract_away(v));
      });
    }
    return left.size();
  }

  /// Contracts the cheapest admissible edge of v.
  bool contract_away(std::uint32_t v) {
    std::vector<std::uint32_t> neighbours;
    mesh_.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
      for (std::uint32_t j = 1; j < 3; ++j) neighbours.push_back(mesh_[t][(k + j) % 3]);
    });
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    std::optional<Candidate> best;
    for (const std::uint32_t w : neighbours) {
      if (evaluate(v, w, Any) != Validity::Valid || !geom::is_float32(candidate_.position))
        continue;
      if (best && best->cost <= candidate_.cost) continue;
      const Candidate candidate = candidate_;
      if (admissible()) best = candidate;
    }
    if (!best) return false;
    ensure(evaluate(best->a, best->b, Any) == Validity::Valid && admissible(),
           "an admitted contraction is no longer admissible");
    apply();
    return true;
  }

  bool move_to_representable(std::uint32_t v) {
    candidate_.a = candidate_.b = v;
    star_.clear();
    mesh_.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
      star_.push_back({t, k, false, false});
    });
    rim_.clear();
    if (options_.keep_convex) gather_rim();
    const Quadric nearest = point_quadric(local(v));
    for (const double care : {1.0, 4.0, 16.0}) {
      if (!place(nearest, care) || !encloses() || folds()) continue;
      if ((options_.keep_convex && !stays_convex()) || !stays_inside()) continue;
      if (tolerance_) {
        describe_change();
        if (!tolerance_->admits(removed_, added_)) continue;
        tolerance_->commit(removed_);
      }
      if (measuring_) {
        describe_change();
        deviation_->commit(removed_, added_);
      }
      position_[v] = candidate_.position;
      working_.update_normals_around(v);
      if (options_.steps != nullptr) options_.steps->push_back({v, v, candidate_.position});
      ++statistics_.moves;
      return true;
    }
    return false;
  }

  const DecimateOptions& options_;
  bool joint_;  // contractions may move the vertices around
  double sign_;
  bool constrained_;
  double anticipation_;  // of the constrained minimum, as a multiple of the unconstrained one
  double regularisation_;
  Vec3 origin_;  // quadrics are relative to it, lest they cancel far from the origin
  double diagonal_;
  Vec3 reach_;  // of new vertices from the origin
  const Mesh& original_;
  bool closed_;
  WorkingMesh working_;
  std::vector<Vec3>& position_ = working_.position;
  std::vector<char>& border_ = working_.border;
  Connectivity& mesh_ = working_.mesh;
  std::vector<Vec3>& normal_ = working_.normal;
  std::vector<Quadric> quadric_;
  std::vector<std::uint32_t> stamp_;   // of a vertex: raised when it is moved or vanishes
  std::vector<std::uint32_t> around_;  // of a vertex: raised when anything in its star changes
  std::vector<std::uint32_t> mark_;
  std::uint32_t mark_value_ = 0;
  std::size_t vertices_;
  std::optional<std::size_t> target_;  // to stop at
  bool bounded_ = false;               // some candidate failed for epsilon alone
  BucketQueue queue_;
  std::optional<Tolerance> tolerance_;
  std::optional<Deviation> deviation_;
  const Mesh* bound_ = &original_;      // what steps must enclose, or be enclosed by
  std::optional<OriginalSolid> solid_;  // of bound_
  std::optional<Optimiser> optimiser_;
  bool measuring_ = false;           // costs are measured distances
  std::vector<std::uint32_t> hint_;  // per vertex: where the original is near
  std::vector<Deviation::Point> points_;
  DecimateStatistics statistics_;

  // Of the candidate at hand.
  Candidate candidate_{};
  std::vector<StarTriangle> star_;
  std::vector<std::uint32_t> rim_;
  std::vector<Vec3> flat_;  // normals of triangles in whose plane the new vertex is
  std::vector<HalfSpace> planes_;
  std::vector<std::uint32_t> removed_;
  std::vector<NewTriangle> added_;
};

}  // namespace

namespace {

void check_options(const geom::Prepared& input, const DecimateOptions& options) {
  if (options.epsilon && !(*options.epsilon > 0 && std::isfinite(*options.epsilon)))
    throw Error(ErrorCode::InvalidArgument, "the error bound must be a positive length");
  if (options.keep_convex && !geom::is_convex(input.mesh))
    throw Error(ErrorCode::InvalidInput, "the input is not convex, so convexity cannot be kept");
}

/// Coplanar regions first, without any loss; then the decimation proper, which knows nothing of the
/// vertices that are gone by then.
class Run {
 public:
  Run(const geom::Prepared& input, const DecimateOptions& options)
      : input_(input), options_(options), inner_options_(options) {
    if (options.keep_convex) return;
    flattener_.emplace(input, options.steps);
    if (options.steps != nullptr) inner_options_.steps = &inner_steps_;
  }

  DecimateResult to(std::optional<std::size_t> target) {
    if (flattener_) {
      flattener_->run(target.value_or(0));
      if (target && flattener_->vertices() <= *target &&
          (options_.precision == Precision::Double || flattener_->is_float32())) {
        DecimateResult result;
        result.mesh = flattener_->mesh();
        result.stop = Stop::VertexTarget;
        return finished(std::move(result));
      }
    }
    if (!decimator_) start();
    DecimateResult result = decimator_->run(target);
    hand_over_steps();
    return finished(std::move(result));
  }

  void nest_in(const Mesh& level) {
    if (decimator_) decimator_->nest_in(level);  // what is flat nests anyway
  }

 private:
  void start() {
    if (flattener_) {
      contractions_ = flattener_->contractions();
      flips_ = flattener_->flips();
      if (contractions_ + flips_ > 0) {
        flat_.mesh = flattener_->mesh(&source_);
        flat_.closed = input_.closed;
        for (const std::uint32_t v : source_) flat_.border.push_back(input_.border[v]);
      } else {
        inner_options_.steps = options_.steps;
      }
      flattener_.reset();
    }
    decimator_.emplace(flat_.mesh.triangles.empty() ? input_ : flat_, inner_options_);
  }

  /// Numbers vertices as in the input.
  void hand_over_steps() {
    for (Step& s : inner_steps_) {
      for (std::uint32_t* v : {&s.kept, &s.gone}) *v = source_[*v];
      if (s.kind == Step::Kind::Flip)
        for (std::uint32_t* v : {&s.left, &s.right}) *v = source_[*v];
      options_.steps->push_back(s);
    }
    inner_steps_.clear();
  }

  DecimateResult finished(DecimateResult result) const {
    DecimateStatistics& s = result.statistics;
    s.contractions += flattener_ ? flattener_->contractions() : contractions_;
    s.flips += flattener_ ? flattener_->flips() : flips_;
    s.vertices_in = input_.mesh.vertices.size();
    s.vertices_out = result.mesh.vertices.size();
    if (options_.steps != nullptr) result.steps = options_.steps->size();
    if (options_.keep_convex)
      ensure(geom::is_convex(geom::weld(result.mesh)), "a contraction lost convexity");
    return result;
  }

  const geom::Prepared& input_;
  const DecimateOptions& options_;
  DecimateOptions inner_options_;
  std::vector<Step> inner_steps_;  // as the decimation numbers vertices
  std::optional<Flattener> flattener_;
  std::size_t contractions_ = 0, flips_ = 0;  // of the flattener
  geom::Prepared flat_;                       // what it has left, when it has done anything
  std::vector<std::uint32_t> source_;         // the input's vertices
  std::optional<Decimator> decimator_;
};

}  // namespace

DecimateResult decimate(const geom::Prepared& input, const DecimateOptions& options) {
  if (!options.vertices && !options.epsilon)
    throw Error(ErrorCode::InvalidArgument,
                "decimation needs a number of vertices or an error bound");
  check_options(input, options);
  return Run(input, options).to(options.vertices);
}

std::vector<DecimateResult> decimate_series(const geom::Prepared& input,
                                            const DecimateOptions& options,
                                            std::span<const std::size_t> vertices) {
  if (vertices.empty() || options.vertices ||
      std::adjacent_find(vertices.begin(), vertices.end(), std::less_equal<>()) != vertices.end())
    throw Error(ErrorCode::InvalidArgument, "a series needs falling numbers of vertices");
  check_options(input, options);
  Run run(input, options);
  std::vector<DecimateResult> levels;
  levels.reserve(vertices.size());  // what is nested in stays where it is
  for (const std::size_t target : vertices) {
    if (!levels.empty() && levels.back().stop != Stop::VertexTarget) {
      levels.push_back(levels.back());
      continue;
    }
    if (!levels.empty()) run.nest_in(levels.back().mesh);
    levels.push_back(run.to(target));
  }
  return levels;
}

}  // namespace kaboum::bmesh
