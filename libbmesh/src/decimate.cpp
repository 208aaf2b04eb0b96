// Bounding mesh decimation.
// [gaschler2016] A. Gaschler, Efficient Geometric Predicates for Integrated Task and Motion
// Planning, §4.3, Algorithms 1 and 2. The certificate and the error bound:
// docs/algorithms/bounding-mesh.md.
#include <kaboum/base/error.h>
#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/distance.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/topology.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <unordered_map>

#include "compact.h"
#include "contraction.h"
#include "deviation.h"
#include "flatten.h"
#include "loosen.h"
#include "optimise_in_parallel.h"
#include "original_solid.h"
#include "regions.h"
#include "tolerance.h"

namespace kaboum::bmesh {
namespace {

using geom::Mesh;

/// Distances are measured from this many times the wished number of vertices on; before, they are
/// so small that the quadrics order the contractions as well.
constexpr std::size_t kMeasureFrom = 3;
constexpr double kMeasureFromEpsilon = 0.1;  ///< the same by an error bound

/// From this multiple of the wished number of vertices on, edges are contracted together with moves
/// of the vertices around, at first within the deviation reached, then within that much more from
/// round to round.
constexpr double kJointFrom = 1.25, kJointFromBest = 1.4, kJointGrowth = 1.05;
constexpr int kJointRounds = 36;

/// From these multiples of the wished number of vertices on, and when edges are contracted together
/// with moves, the original is looked at between the samples, too: where it is farther from the
/// mesh than this share of the deviation reached. The first ones only if it has at most so many
/// times the wished number of vertices; more are samples enough.
constexpr std::array<double, 2> kRefineAt{2.2, 1.7};
constexpr double kRefineFrom = 0.6, kRefineMost = 12;
/// And again when so many of a hundred vertices are gone since.
constexpr std::size_t kRefineAgain = 5;

/// Small meshes are decimated a second time, within a bound: at first this share of the distance
/// measured at kJointFrom times the wished number of vertices. It rises by kBoundGrowth from round
/// to round until the number is reached. Rounds that gain less than kBoundGain of what is missing
/// raise it by more.
constexpr double kBoundFrom = 0.85, kBoundFromBest = 0.75;
constexpr double kBoundGrowth = 1.07, kBoundMostGrowth = 1.25, kBoundGain = 0.05;
constexpr int kBoundPasses = 1;  ///< rounds of optimisation in each
/// Small: at most so many vertices, and a third of them wished for at most.
constexpr std::size_t kBoundVertices = 4000, kBoundShare = 3;

/// So many of them may fail by their deviation, and so many more for each that does not: on parts
/// with many sharp edges hardly any succeeds, and nothing is gained.
constexpr int kPatience = 120, kPatienceGained = 2;

/// So many are tried at once, far enough from each other.
constexpr std::size_t kJointBatch = 32;
/// So many contractions are made before their vertices are pulled back, and no more than one for so
/// many vertices that are left: the contractions to come should see them where they belong.
constexpr std::size_t kRecent = 32, kRecentShare = 256;

/// Measuring stops when the distance exceeds what is due by this factor.
constexpr double kMeasureTo = 2;

/// A spike goes farther from the original than this share of the diagonal, and this many times
/// farther than the original is from the new triangles there.
constexpr double kSpike = 0.05, kSpikeRatio = 3;

/// Samples of the original lie no farther apart than this share of the error bound, within reason,
/// where contractions move the vertices around.
constexpr double kSpacing = 0.7;
/// But no more than so many are added; fewer where the error bound rises: it is no promise there.
constexpr double kSamples = 4000, kSamplesRising = 2500;

// Rounds of optimisation, at most: in the end, and at each stage before.
constexpr int kFinalPasses = 6, kFinalPassesBest = 12, kStagePasses = 3;

/// The vertices from which on distances are measured, given the wished number.
std::size_t measured_from(const DecimateOptions& options, std::size_t target) {
  const bool follows = options.cost == Cost::Distance ||
                       (options.cost == Cost::Mean && options.effort != Effort::Fast);
  return follows ? kMeasureFrom * target : target;
}

/// An error bound that rises until the wished number of vertices is reached. [length]
struct RisingBound {
  double from, to;
};

/// Contractions, and what goes on between and after them: measured distances, optimisation against
/// the original, representable coordinates.
class Decimator final : private Judge {
 public:
  /// @param original  what `start` was made of, whatever has happened to it since.
  /// @param bound     of a run to a number of vertices: the error bound that rises.
  /// @param sketch    whether another run with such a bound follows: contractions with moves are
  ///   left to that.
  Decimator(const Setting& setting, const Mesh& original, Reduction start,
            std::optional<OriginalSolid>& solid, std::vector<Step>* steps,
            const std::optional<RisingBound>& bound, bool sketch)
      : setting_(setting),
        options_(setting.options),
        epsilon_(bound ? bound->from : options_.epsilon),
        most_(bound ? bound->to : 0),
        sketch_(sketch),
        joint_(epsilon_ && options_.cost == Cost::Distance && options_.effort != Effort::Fast),
        original_(original),
        solid_(solid),
        steps_(steps),
        contraction_(setting,
                     WorkingMesh(std::move(start.position), std::move(start.border),
                                 std::move(start.triangles)),
                     std::move(start.quadric), solid ? &*solid : nullptr, steps, this) {
    if (epsilon_) tolerance_.emplace(original, *epsilon_, setting.work);
  }

  /// The largest distance measured before edges were contracted together with moves; 0 where there
  /// is none.
  [[nodiscard]] double reached_alone() const { return reached_alone_; }

  /// Runs on from where the last call has stopped.
  DecimateResult run(std::optional<std::size_t> target) {
    target_ = target;
    const Stop stop = contract_all();
    DecimateResult result;
    if (options_.precision == Precision::Float) result.unrepresentable = make_representable();
    result.stop = stop;
    result.out_of_work = ended_early_;
    result.mesh = compact(position_, mesh_);
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
  /// Whether deviations are followed while contracting, not only in the end.
  [[nodiscard]] bool pulls_back_meanwhile() const { return measured_from(options_, 1) > 1; }

  Stop contract_all() {
    const std::size_t target = target_.value_or(0);
    if (!pulls_back_meanwhile()) {
      contract_to(target);
    } else {
      start_stages(target);
      contract_in_stages(target);
    }
    optimise(options_.effort == Effort::Best ? kFinalPassesBest : kFinalPasses);
    if (target_ && contraction_.vertices() <= target) return Stop::VertexTarget;
    if (spent(kNoneContracts) || (most_ > 0 && spent(kNoneMoves))) return Stop::OutOfWork;
    return bounded_ ? Stop::ErrorBound : Stop::Exhausted;
  }

  void start_stages(std::size_t target) {
    if (!measuring_) {
      // Small deviations need no measuring: the quadrics order the contractions as well.
      contract_to(measured_from(options_, target),
                  options_.epsilon && options_.cost == Cost::Distance
                      ? kMeasureFromEpsilon * *options_.epsilon
                      : std::numeric_limits<double>::infinity());
      start_measuring();
    }
    if (options_.cost != Cost::Distance || !optimiser_ || epsilon_) return;
    const auto wished = static_cast<double>(target);
    if (static_cast<double>(original_.vertices.size()) <= kRefineMost * wished) {
      for (const double multiple : kRefineAt) {
        contract_to(static_cast<std::size_t>(multiple * wished));
        refine();
      }
    }
    const double from = options_.effort == Effort::Best ? kJointFromBest : kJointFrom;
    contract_to(static_cast<std::size_t>(from * wished));
    reached_alone_ = reached_;
  }

  void contract_in_stages(std::size_t target) {
    if (options_.cost == Cost::Distance && optimiser_ && !epsilon_ && !sketch_)
      collapse_in_rounds(target);
    contract_to(target);
    if (most_ > 0) return raise_bound(target);
    if (!epsilon_ || options_.effort == Effort::Fast) return;
    // What is given back makes room for further contractions within the error bound.
    for (std::size_t before = contraction_.vertices() + contraction_.vertices();
         !spent(kNoneMoves) && contraction_.vertices() > target &&
         100 * contraction_.vertices() < 99 * before;) {
      before = contraction_.vertices();
      optimise(kStagePasses);
      contract_to(target);
    }
    if (!joint_ || !optimiser_) return;
    for (std::size_t before = contraction_.vertices() + contraction_.vertices();
         !spent(kNoneMoves) && contraction_.vertices() > target &&
         100 * contraction_.vertices() < 99 * before;) {
      before = contraction_.vertices();
      collapse_within(target);
      optimise(kStagePasses);
    }
  }

  /// Contracts edges together with moves within the deviation reached, then within more and more.
  void collapse_in_rounds(std::size_t target) {
    failures_.clear();  // of an earlier level of a series
    // Where hardly anything is contracted, nothing has been reached, and little is to be gained.
    double limit = reached_ > 0 ? std::min(reached_, setting_.diagonal) : 0;
    patience_ = kPatience;
    for (int i = 0;
         i < kJointRounds && limit > 0 && contraction_.vertices() > target && !spent(kNoneMoves);
         ++i, limit *= kJointGrowth) {
      if (i == 0 || 100 * contraction_.vertices() <= (100 - kRefineAgain) * refined_) refine();
      optimise(1);
      collapse_to(target, limit);
      if (patience_ < 0) break;
    }
  }

  /// The same within the error bound, as often as need be.
  void collapse_within(std::size_t target) {
    patience_ = std::numeric_limits<int>::max() / 2;
    collapse_to(target, *epsilon_);
  }

  /// Goes on within a larger and larger error bound.
  void raise_bound(std::size_t target) {
    double growth = kBoundGrowth;
    for (;;) {
      const auto missing = static_cast<double>(contraction_.vertices() - target);
      optimise(kBoundPasses);
      collapse_within(target);
      if (contraction_.vertices() <= target || *epsilon_ >= most_ || spent(kNoneMoves)) return;
      *epsilon_ = std::min(growth * *epsilon_, most_);
      tolerance_->raise(*epsilon_);
      contract_to(target);
      if (contraction_.vertices() <= target) return;
      const bool gained =
          static_cast<double>(contraction_.vertices() - target) < (1 - kBoundGain) * missing;
      growth = gained ? kBoundGrowth : std::min(growth * growth, kBoundMostGrowth);
    }
  }

  /// Samples are added where the mesh deviates most, if it has changed.
  void refine() {
    if (!(reached_ > 0) || contraction_.vertices() == refined_ || spent(kNoneMoves)) return;
    refined_ = contraction_.vertices();
    const double far = kRefineFrom * reached_;
    deviation_->refine(position_, mesh_, far * far);
  }

  /// Contracts edges together with moves of the vertices around, each within the limit. [length]
  /// What has failed is tried again when another such contraction around has succeeded, or the
  /// limit has risen to what it would have taken.
  void collapse_to(std::size_t target, double limit) {
    joined_.resize(position_.size(), 0);
    const std::vector<Edge> edges = edges_by_cost(limit);
    std::vector<Edge> waiting, still, batch;
    std::size_t tried = 0;  // since progress was told
    for (std::size_t next = 0; contraction_.vertices() > target &&
                               (next < edges.size() || !waiting.empty()) && !spent(kNoneMoves);) {
      const std::size_t most =
          optimiser_->in_batches() ? std::min(kJointBatch, contraction_.vertices() - target) : 1;
      batch.clear();
      still.clear();
      const auto consider = [&](const Edge& e) {
        if (!may_succeed(e, limit)) return;
        (batch.size() < most && optimiser_->claim({e.a, e.b}) ? batch : still).push_back(e);
      };
      for (const Edge& e : waiting) consider(e);
      for (; next < edges.size() && batch.size() < most && still.size() < kJointBatch; ++next)
        consider(edges[next]);
      waiting.swap(still);
      collapse_batch(batch, limit);
      if (patience_ < 0) return;
      tried += batch.size();
      if (options_.progress && tried >= 256) {
        options_.progress(contraction_.vertices());
        tried = 0;
      }
    }
  }

  struct Edge {
    double cost;
    std::uint32_t a, b;
  };

  /// Those that cost no more than the limit, at least.
  std::vector<Edge> edges_by_cost(double limit) {
    std::vector<Edge> edges;
    for (std::uint32_t t = 0; t < mesh_.size(); ++t) {
      if (!mesh_.alive(t)) continue;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t a = mesh_[t][k], b = mesh_[t][(k + 1) % 3];
        if (a > b) continue;
        const double cost =
            setting_.cost.least_key(contraction_.merged(a, b), position_[a], position_[b]);
        if (!(cost > limit)) edges.push_back({cost, a, b});
      }
    }
    std::stable_sort(edges.begin(), edges.end(),
                     [](const Edge& x, const Edge& y) { return x.cost < y.cost; });
    return edges;
  }

  /// Whether it is still an edge, and has not failed where nothing has changed since.
  [[nodiscard]] bool may_succeed(const Edge& e, double limit) const {
    if (!mesh_.used(e.a) || !mesh_.used(e.b)) return false;
    bool adjacent = false;
    mesh_.for_each_triangle(e.a, [&](std::uint32_t t, std::uint32_t) {
      for (const std::uint32_t w : mesh_[t]) adjacent = adjacent || w == e.b;
    });
    const auto failure = failures_.find(key(e));
    return adjacent && (failure == failures_.end() || !(failure->second.deviation > limit) ||
                        failure->second.joined != joined_[e.a] + joined_[e.b]);
  }

  static std::uint64_t key(std::uint32_t a, std::uint32_t b) { return std::uint64_t{a} << 32 | b; }
  static std::uint64_t key(const Edge& e) { return key(e.a, e.b); }

  /// Contracts what has been claimed.
  void collapse_batch(std::span<const Edge> batch, double limit) {
    const std::span<const double> outcome = optimiser_->collapse(limit);
    for (std::size_t i = 0; i < batch.size(); ++i) {
      const Edge& e = batch[i];
      failures_[key(e)] = {joined_[e.a] + joined_[e.b], outcome[i]};
      if (outcome[i] > 0) {
        if (std::isfinite(outcome[i])) --patience_;
        continue;
      }
      patience_ += kPatienceGained;
      contraction_.contracted(e.a, e.b);
      for (const std::uint32_t v : evaluation_.neighbours(e.a)) ++joined_[v];
      ++joined_[e.a];
    }
  }

  /// Contracts until `target` vertices are left or the next costs more than `limit`.
  void contract_to(std::size_t target, double limit = Contraction::kNoLimit) {
    for (bool progress = true;
         progress && contraction_.vertices() > target && !spent(kNoneContracts);) {
      bounded_ = false;
      progress = contraction_.pass(target, limit) && limit == Contraction::kNoLimit;
      if (hurries_ || !measuring_ || !spent(kNoneMoves)) continue;
      if (most_ > 0) break;  // what has been found without a bound will do
      pull_back_recent();
      hurries_ = progress = true;
    }
    pull_back_recent();
  }

  /// Whether this share of the work allowed has been done, and something is left undone for it.
  [[nodiscard]] bool spent(double share) {
    if (setting_.work == nullptr || !setting_.work->spent(share)) return false;
    ended_early_ = true;
    return true;
  }

  // ---- what contractions are asked besides

  [[nodiscard]] Evaluation::Purpose purpose() const override {
    return optimiser_ && !hurries_ ? Evaluation::Purpose::Settled : Evaluation::Purpose::Due;
  }

  bool goes_on() override { return !spent(measuring_ && !hurries_ ? kNoneMoves : kNoneContracts); }

  /// What was refused is refused again, unless something has changed around it or the error bound
  /// has risen to what it takes.
  bool is_hopeful(const BucketQueue::Entry& e) override {
    if (!optimiser_ || hurries_) return true;
    const auto at = refusals_.find(key(std::min(e.a, e.b), std::max(e.a, e.b)));
    if (at == refusals_.end()) return true;
    const Refusal& r = at->second;
    if (r.version != optimiser_->version(e.a, e.b)) return true;
    if (epsilon_ && !(r.takes > *epsilon_)) return true;
    bounded_ = bounded_ || r.by_epsilon;
    return false;
  }

  void has_no_place(const BucketQueue::Entry& e) override { refuse(e.a, e.b, kNever, false); }

  static constexpr double kNever = std::numeric_limits<double>::infinity();

  void refuse(std::uint32_t a, std::uint32_t b, double takes, bool by_epsilon) {
    if (optimiser_)
      refusals_[key(std::min(a, b), std::max(a, b))] = {optimiser_->version(a, b), takes,
                                                        by_epsilon};
  }

  bool assess(BucketQueue::Entry& e) override {
    if (hurries_) return true;
    if (optimiser_ && !settle()) return false;
    if (!measuring_) return true;
    if (e.measured == around_[e.a] + around_[e.b]) {
      candidate_.cost = 0;
      return true;
    }
    return !contraction_.queue().due(candidate_.cost) || measure(e);
  }

  bool admit(BucketQueue::Entry& e) override {
    if (hurries_) return admissible();
    if (candidate_.settled) {
      if (!certify(e)) return false;
      if (!contraction_.queue().due(candidate_.cost)) return contraction_.postpone(e);
    }
    return measure_densely(e) && admissible();
  }

  /// The dearer tests, made only of candidates that are about to be applied.
  [[nodiscard]] bool admissible() {
    if (!evaluation_.keeps_shape()) {
      refuse(candidate_.a, candidate_.b, kNever, false);
      return false;
    }
    if (!tolerance_) return true;
    describe_change();
    return tolerance_->admits(removed_, added_) || reject_by_epsilon(*epsilon_);
  }

  void before() override {
    if (tolerance_) tolerance_->commit(removed_);
    if (!measuring_) return;
    describe_change();
    deviation_->commit(removed_, added_);
  }

  void after() override {
    if (measuring_) {
      reached_ = std::max(reached_, contraction_.queue().lowest_key());
      changed(candidate_.a);
    }
    if (optimiser_ && !hurries_) {
      optimiser_->single().disturb(candidate_.a);
      recent_.push_back(candidate_.a);
      if (!optimiser_->in_batches() ||
          recent_.size() >= std::min(kRecent, contraction_.vertices() / kRecentShare))
        pull_back_recent();
    }
    if (options_.progress && statistics_.contractions % 1024 == 0)
      options_.progress(contraction_.vertices());
  }

  void pull_back_recent() {
    if (recent_.empty() || hurries_) return;
    optimiser_->pull_back(recent_, [&](std::uint32_t v) { changed(v); });
    recent_.clear();
  }

  /// The star of v is not what has been measured.
  void changed(std::uint32_t v) {
    ++around_[v];
    for (const std::uint32_t w : evaluation_.neighbours(v)) ++around_[w];
  }

  void describe_change() { evaluation_.describe(removed_, added_); }

  // ---- measured distances
  // -------------------------------------------------------------------------

  void start_measuring() {
    deviation_.emplace(original_, options_.cost == Cost::Mean ? 2 : 4,
                       joint_ ? kSpacing * *epsilon_ : 0, most_ > 0 ? kSamplesRising : kSamples,
                       setting_.work);
    deviation_->assign(position_, mesh_);
    hint_.assign(position_.size(), 0);
    around_.assign(position_.size(), 0);
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
    // Far enough beyond what is due that the edge does not come back time and again.
    double limit = kMeasureTo * std::max(contraction_.queue().lowest_key(), candidate_.cost);
    if (epsilon_) limit = std::min(limit, std::max(*epsilon_, candidate_.cost));
    const double squared =
        deviation_->largest(removed_, added_, points_, hint_[e.a], limit * limit);
    candidate_.cost = std::max(candidate_.cost, std::sqrt(squared));
    if (epsilon_ && candidate_.cost > *epsilon_) return reject_by_epsilon(candidate_.cost);
    if (candidate_.cost > limit) {
      e.measured = ~0U;
      return contraction_.postpone(e);
    }
    if (candidate_.cost > kSpike * setting_.diagonal && spikes())
      return reject(statistics_.rejected_spike);
    e.measured = around_[e.a] + around_[e.b];
    return true;
  }

  /// The new triangles at more points, before they are made; what is found to be beyond what is due
  /// goes back into the queue. @return whether it is not.
  bool measure_densely(BucketQueue::Entry& e) {
    if (!optimiser_ || options_.cost != Cost::Distance || epsilon_) return true;
    describe_change();
    points_.clear();
    for (const NewTriangle& t : added_) {
      const auto& [v, p, q] = t.corner;
      points_.push_back({0.75 * v + 0.25 * p, 0});
      points_.push_back({0.25 * v + 0.75 * p, 0});
      for (int k = 0; k < 3; ++k) points_.push_back({0.5 * t.corner[k] + (v + p + q) / 6, 0});
    }
    const double limit = 1.2 * contraction_.queue().lowest_key();
    const double d = std::sqrt(deviation_->largest({}, {}, points_, hint_[e.a], limit * limit));
    if (d <= limit) return true;
    candidate_.cost = std::max(candidate_.cost, d);
    e.measured = ~0U;
    return contraction_.postpone(e);
  }

  /// Moves the candidate to where the original bounds it instead of the present mesh.
  bool settle() {
    describe_change();
    if (added_.empty()) return reject(statistics_.rejected_topology);  // nothing would be left
    const bool free = border_[candidate_.a] == 0 && border_[candidate_.b] == 0;
    const auto place =
        free ? optimiser_->single().settle(removed_, added_, merged(), setting_.cost.origin())
             : std::optional<Vec3>();
    if (place && evaluation_.settle_at(*place, merged())) return true;
    return candidate_.encloses || reject(statistics_.rejected_no_position);
  }

  [[nodiscard]] Quadric merged() const { return contraction_.merged(candidate_.a, candidate_.b); }

  /// The exact test of a settled candidate; seeks other places until it holds, or takes the one
  /// that the present mesh bounds. @return whether the cost is known.
  bool certify(BucketQueue::Entry& e) {
    constexpr int kAttempts = 5;
    bool moved = false;
    for (int i = 0; i < kAttempts; ++i) {
      if (optimiser_->single().settled(removed_, candidate_.position)) return !moved || measure(e);
      const auto place = optimiser_->single().resettle();
      if (!place || *place == candidate_.position || !evaluation_.settle_at(*place, merged()))
        break;
      moved = true;
    }
    if (!candidate_.encloses) return reject(statistics_.rejected_original);
    candidate_.position = candidate_.enclosing;
    candidate_.settled = false;
    return measure(e);
  }

  [[nodiscard]] bool spikes() {
    const double least = kSpike * setting_.diagonal;
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
    if (setting_.constrained && !solid_)
      solid_.emplace(*bound_, bound_ == &original_ ? deviation_->original().hierarchy() : nullptr,
                     setting_.work);
    optimiser_.emplace(contraction_.mesh(), *deviation_, setting_.constrained ? &*solid_ : nullptr,
                       *bound_, tolerance_ ? &*tolerance_ : nullptr, options_, statistics_, joint_,
                       setting_.work);
    refusals_.clear();
  }

  void optimise(int passes) {
    if (options_.effort == Effort::Fast || hurries_ || spent(kNoneMoves)) return;
    if (!deviation_) start_measuring();
    if (!optimiser_) return;
    for (int i = 0; i < passes && !spent(kNoneMoves); ++i)
      if (optimiser_->pass() == 0) break;
  }

  /// Refuses the candidate for good. @return false
  bool reject(std::uint64_t& counter) {
    ++counter;
    refuse(candidate_.a, candidate_.b, kNever, false);
    return false;
  }

  /// The same, until the error bound is above what it takes.
  bool reject_by_epsilon(double takes) {
    ++statistics_.rejected_distance;
    bounded_ = true;
    refuse(candidate_.a, candidate_.b, std::nextafter(takes, kNever), true);
    return false;
  }

  // ---- representable coordinates
  // ------------------------------------------------------------------

  /// Moves vertices that float32 cannot hold to certified positions that it can, or contracts them
  /// away. Returns how many could not be helped.
  std::size_t make_representable() {
    std::vector<std::uint32_t> left;
    for (std::uint32_t v = 0; v < position_.size(); ++v)
      if (mesh_.used(v) && !geom::is_float32(position_[v])) left.push_back(v);
    const auto take_out = [&](auto&& helps) {
      const std::size_t before = left.size();
      std::erase_if(
          left, [&](std::uint32_t v) { return !mesh_.used(v) || (border_[v] == 0 && helps(v)); });
      return left.size() < before;
    };
    // What fails now may succeed once a neighbour has moved.
    do {
      while (take_out([&](std::uint32_t v) {
        return move_to_representable(v) || (optimiser_ && optimiser_->single().round(v));
      })) {
      }
    } while (take_out([&](std::uint32_t v) { return contract_away(v); }) ||
             take_out([&](std::uint32_t v) { return make_room(v); }) ||
             take_out([&](std::uint32_t v) { return move_to_representable(v, true); }));
    pull_back_recent();
    return left.size();
  }

  /// Flips edges of v until it can be moved, or contracted away.
  bool make_room(std::uint32_t v) {
    if (options_.keep_convex || !setting_.constrained) return false;
    Loosener loosener(setting_, contraction_.mesh(), solid_ ? &*solid_ : nullptr,
                      tolerance_ ? &*tolerance_ : nullptr, measuring_ ? &*deviation_ : nullptr,
                      steps_, statistics_);
    while (loosener.loosen(v)) {
      if (optimiser_) optimiser_->single().disturb(v);
      if (move_to_representable(v) || contract_away(v)) return true;
    }
    return false;
  }

  /// Contracts the cheapest admissible edge of v.
  bool contract_away(std::uint32_t v) {
    std::vector<std::uint32_t> neighbours;
    mesh_.for_each_triangle(v, [&](std::uint32_t t, std::uint32_t k) {
      for (std::uint32_t j = 1; j < 3; ++j) neighbours.push_back(mesh_[t][(k + j) % 3]);
    });
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    constexpr auto kAny = Evaluation::Purpose::Any;
    constexpr auto kValid = Evaluation::Validity::Valid;
    std::optional<Evaluation::Candidate> best;
    for (const std::uint32_t w : neighbours) {
      if (contraction_.evaluate(v, w, kAny) != kValid || !geom::is_float32(candidate_.position))
        continue;
      if (best && best->cost <= candidate_.cost) continue;
      const Evaluation::Candidate candidate = candidate_;
      if (admissible()) best = candidate;
    }
    if (!best) return false;
    ensure(contraction_.evaluate(best->a, best->b, kAny) == kValid && admissible(),
           "an admitted contraction is no longer admissible");
    contraction_.apply();
    return true;
  }

  bool move_to_representable(std::uint32_t v, bool may_fold = false) {
    for (const double care : {1.0, 4.0, 16.0}) {
      if (!evaluation_.evaluate_move(v, care, may_fold)) continue;
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
      contraction_.mesh().update_normals_around(v);
      if (steps_ != nullptr) steps_->push_back({v, v, candidate_.position});
      ++statistics_.moves;
      return true;
    }
    return false;
  }

  const Setting& setting_;
  const DecimateOptions& options_;
  std::optional<double> epsilon_;  // that steps keep
  double most_;                    // to which that rises; 0: it does not
  bool sketch_;                    // no contractions with moves: another run will follow
  bool joint_;                     // contractions may move the vertices around
  const Mesh& original_;
  const Mesh* bound_ = &original_;       // what steps must enclose, or be enclosed by
  std::optional<OriginalSolid>& solid_;  // of bound_
  std::vector<Step>* steps_;
  Contraction contraction_;
  Evaluation& evaluation_ = contraction_.evaluation();
  Evaluation::Candidate& candidate_ = evaluation_.candidate();
  DecimateStatistics& statistics_ = contraction_.statistics();
  std::vector<Vec3>& position_ = contraction_.mesh().position;
  const std::vector<char>& border_ = contraction_.mesh().border;
  const Connectivity& mesh_ = contraction_.mesh().mesh;
  std::optional<std::size_t> target_;  // to stop at
  bool bounded_ = false;               // some candidate failed for epsilon alone
  std::optional<Tolerance> tolerance_;
  std::optional<Deviation> deviation_;
  std::optional<ParallelOptimiser> optimiser_;
  bool measuring_ = false;    // costs are measured distances
  bool hurries_ = false;      // no more, nor are vertices pulled back: too much work is done
  bool ended_early_ = false;  // something was left undone for that
  double reached_alone_ = 0;  // before contractions with moves
  double reached_ = 0;        // largest measured cost of a contraction
  std::size_t refined_ = 0;   // number of vertices when samples were added last
  struct Failure {
    std::uint32_t joined = ~0U;  // of both ends
    double deviation = 0;        // that the contraction would take
  };
  std::unordered_map<std::uint64_t, Failure> failures_;  // of joint contractions, by edge
  struct Refusal {
    std::uint32_t version = 0;  // of both ends
    double takes = 0;           // the error bound that it takes, at least
    bool by_epsilon = false;    // that alone stands against it
  };
  std::unordered_map<std::uint64_t, Refusal> refusals_;  // of contractions alone, by edge
  int patience_ = 0;                                     // joint contractions that may fail yet
  std::vector<std::uint32_t> joined_;  // of a vertex: raised by joint contractions around it
  std::vector<std::uint32_t> recent_;  // contracted vertices that have not been pulled back yet
  std::vector<std::uint32_t> around_;  // of a vertex: raised when anything in its star changes
  std::vector<std::uint32_t> hint_;    // per vertex: where the original is near
  std::vector<Deviation::Point> points_;
  std::vector<std::uint32_t> removed_;
  std::vector<NewTriangle> added_;
};

}  // namespace

namespace {

void check_options(const geom::Prepared& input, const DecimateOptions& options) {
  if (options.epsilon && !(*options.epsilon > 0 && std::isfinite(*options.epsilon)))
    throw Error(ErrorCode::InvalidArgument, "the error bound must be a positive length");
  if (options.max_work && !(*options.max_work > 0))
    throw Error(ErrorCode::InvalidArgument, "max_work must be positive");
  if (options.keep_convex && !geom::is_convex(input.mesh))
    throw Error(ErrorCode::InvalidInput, "the input is not convex, so convexity cannot be kept");
}

/// Coplanar regions first, without any loss; then large meshes region by region; then the
/// decimation proper, which knows nothing of the vertices that are gone by then.
class Run {
 public:
  /// @param bound, sketch  as of Decimator
  Run(const geom::Prepared& input, const DecimateOptions& options, Work& work,
      std::optional<RisingBound> bound = std::nullopt, bool sketch = false)
      : input_(input), options_(options), work_(work), bound_(bound), sketch_(sketch) {
    options_.effort = effective_effort(input, options);
    if (options.keep_convex) return;
    std::vector<std::uint32_t> flat = flat_vertices(input);
    if (!flat.empty()) flattener_.emplace(input, std::move(flat), options.steps);
  }

  DecimateResult to(std::optional<std::size_t> target) {
    if (flattener_) flattener_->run(target.value_or(0));
    if (target && !decimator_ && is_reached(*target)) {
      DecimateResult result;
      result.mesh = flattener_ ? flattener_->mesh() : input_.mesh;
      result.stop = Stop::VertexTarget;
      return finished(std::move(result));
    }
    if (!decimator_) start(target);
    DecimateResult result = decimator_->run(target);
    hand_over_steps();
    return finished(std::move(result));
  }

  [[nodiscard]] double reached_alone() const {
    return decimator_ ? decimator_->reached_alone() : 0;
  }

  void nest_in(const Mesh& level) {
    if (decimator_) decimator_->nest_in(level);  // what is flat nests anyway
  }

 private:
  /// Whether nothing is left to do but to flatten.
  [[nodiscard]] bool is_reached(std::size_t target) const {
    const std::size_t n = flattener_ ? flattener_->vertices() : input_.mesh.vertices.size();
    if (n > target) return false;
    if (options_.precision == Precision::Double) return true;
    if (flattener_) return flattener_->is_float32();
    return std::all_of(input_.mesh.vertices.begin(), input_.mesh.vertices.end(),
                       [](const Vec3& p) { return geom::is_float32(p); });
  }

  void start(std::optional<std::size_t> target) {
    if (flattener_) flatten();
    const geom::Prepared& input = flat_.mesh.triangles.empty() ? input_ : flat_;
    inner_options_ = options_;
    inner_options_.steps = options_.steps != nullptr ? &inner_steps_ : nullptr;
    setting_.emplace(input, inner_options_, &work_);
    if (options_.direction == Direction::Inner && input.closed && !options_.keep_convex)
      solid_.emplace(input.mesh, nullptr, &work_);
    Reduction mesh(input.mesh, input.border, setting_->cost.initial(input.mesh));
    if (target && !options_.epsilon && !bound_ && !options_.keep_convex) {
      contract_in_regions(*setting_, mesh, measured_from(options_, *target),
                          solid_ ? &*solid_ : nullptr, inner_options_.steps, before_);
      hand_over_steps();
    }
    number_ = mesh.vertex;
    if (!source_.empty())
      for (std::uint32_t& v : number_) v = source_[v];
    decimator_.emplace(*setting_, input.mesh, std::move(mesh), solid_, inner_options_.steps, bound_,
                       sketch_);
  }

  void flatten() {
    before_.contractions = flattener_->contractions();
    before_.flips = flattener_->flips();
    if (before_.contractions + before_.flips > 0) {
      flat_.mesh = flattener_->mesh(&source_);
      flat_.closed = input_.closed;
      for (const std::uint32_t v : source_) flat_.border.push_back(input_.border[v]);
      number_ = source_;
    }
    flattener_.reset();
  }

  /// Numbers vertices as in the input.
  void hand_over_steps() {
    if (options_.steps == nullptr) return;
    if (!number_.empty())
      for (Step& s : inner_steps_) {
        for (std::uint32_t* v : {&s.kept, &s.gone}) *v = number_[*v];
        if (s.kind == Step::Kind::Flip)
          for (std::uint32_t* v : {&s.left, &s.right}) *v = number_[*v];
      }
    options_.steps->insert(options_.steps->end(), inner_steps_.begin(), inner_steps_.end());
    inner_steps_.clear();
  }

  DecimateResult finished(DecimateResult result) const {
    DecimateStatistics& s = result.statistics;
    if (flattener_) {
      s.contractions += flattener_->contractions();
      s.flips += flattener_->flips();
    }
    add(s, before_);
    s.vertices_in = input_.mesh.vertices.size();
    s.vertices_out = result.mesh.vertices.size();
    if (options_.steps != nullptr) result.steps = options_.steps->size();
    if (options_.keep_convex)
      ensure(geom::is_convex(geom::weld(result.mesh)), "a contraction lost convexity");
    return result;
  }

  const geom::Prepared& input_;
  DecimateOptions options_;
  Work& work_;
  std::optional<RisingBound> bound_;
  bool sketch_;
  DecimateOptions inner_options_;
  std::vector<Step> inner_steps_;  // numbered as below
  std::optional<Flattener> flattener_;
  geom::Prepared flat_;                // what it has left, when it has done anything
  std::vector<std::uint32_t> source_;  // of its vertices: the input's
  std::vector<std::uint32_t> number_;  // the same of the vertices at hand; empty: the same numbers
  DecimateStatistics before_;          // of what the decimator knows nothing of
  std::optional<Setting> setting_;
  std::optional<OriginalSolid> solid_;
  std::optional<Decimator> decimator_;
};

/// Whether a number of vertices may be sought within a rising error bound.
bool is_small(const geom::Prepared& input, const DecimateOptions& options) {
  return options.vertices && !options.epsilon && options.cost == Cost::Distance &&
         effective_effort(input, options) != Effort::Fast &&
         input.mesh.vertices.size() <= kBoundVertices &&
         kBoundShare * *options.vertices <= input.mesh.vertices.size();
}

/// Certified upper bound of the Hausdorff distance.
double largest_distance(const Mesh& a, const Mesh& b) {
  geom::DistanceOptions gap;
  gap.relative_gap = 0.02;
  return std::max(geom::directed_distance(a, geom::DistanceQuery(b), gap).max_upper,
                  geom::directed_distance(b, geom::DistanceQuery(a), gap).max_upper);
}

/// To a number of vertices, and again to the same within less than the distance found so, if that
/// can be. @pre is_small
DecimateResult decimate_twice(const geom::Prepared& input, const DecimateOptions& options,
                              Work& work) {
  std::vector<Step> steps;
  const auto run = [&](std::optional<RisingBound> bound, bool sketch, double* reached) {
    steps.clear();
    DecimateOptions recorded = options;
    recorded.steps = options.steps != nullptr ? &steps : nullptr;
    Run r(input, recorded, work, bound, sketch);
    DecimateResult result = r.to(options.vertices);
    if (reached != nullptr) *reached = r.reached_alone();
    return result;
  };
  const auto chosen = [&](DecimateResult result) {
    if (options.steps == nullptr) return result;
    options.steps->insert(options.steps->end(), steps.begin(), steps.end());
    result.steps = options.steps->size();
    return result;
  };
  double reached = 0;
  DecimateResult sketch = run(std::nullopt, true, &reached);
  std::vector<Step> sketch_steps = steps;
  const auto settle_for_sketch = [&] {
    steps = std::move(sketch_steps);
    sketch.out_of_work = true;
    return chosen(std::move(sketch));
  };
  if (work.spent(kNoneBegins)) return settle_for_sketch();
  if (sketch.stop == Stop::VertexTarget && reached > 0) {
    const double from = (options.effort == Effort::Best ? kBoundFromBest : kBoundFrom) * reached;
    const RisingBound bound{from, largest_distance(sketch.mesh, input.mesh)};
    if (bound.from < bound.to) {
      DecimateResult nearer = run(bound, false, nullptr);
      if (nearer.stop == Stop::VertexTarget && nearer.unrepresentable <= sketch.unrepresentable)
        return chosen(std::move(nearer));
      if (work.spent(kNoneMoves)) return settle_for_sketch();
    }
  }
  // Made again with moves. Where the number can hardly be reached, the first may still be nearer.
  DecimateResult again = run(std::nullopt, false, nullptr);
  const std::size_t n = sketch.mesh.vertices.size(), m = again.mesh.vertices.size();
  const bool nearer =
      n == m && sketch.unrepresentable <= again.unrepresentable &&
      largest_distance(sketch.mesh, input.mesh) < largest_distance(again.mesh, input.mesh);
  if (n > m || (n == m && !nearer)) return chosen(std::move(again));
  steps = std::move(sketch_steps);
  sketch.out_of_work = again.out_of_work;
  if (sketch.stop != Stop::VertexTarget && again.stop == Stop::OutOfWork)
    sketch.stop = Stop::OutOfWork;
  return chosen(std::move(sketch));
}

}  // namespace

double work_allowed(const geom::Prepared& input, const DecimateOptions& options) {
  if (options.max_work) return *options.max_work;
  if (options.effort == Effort::Best) return std::numeric_limits<double>::infinity();
  constexpr double kTriangles = 10000, kLeast = 12, kEach = 2e-3;
  const auto triangles = static_cast<double>(input.mesh.triangles.size());
  return kLeast + kEach * std::max(0.0, triangles - kTriangles);
}

Effort effective_effort(const geom::Prepared& input, const DecimateOptions& options) {
  const bool can_optimise =
      !options.keep_convex && (input.closed || options.direction == Direction::Any);
  return can_optimise ? options.effort : Effort::Fast;
}

DecimateResult decimate(const geom::Prepared& input, const DecimateOptions& options) {
  if (!options.vertices && !options.epsilon)
    throw Error(ErrorCode::InvalidArgument,
                "decimation needs a number of vertices or an error bound");
  check_options(input, options);
  Work work(1e9 * work_allowed(input, options));
  DecimateResult result = is_small(input, options) ? decimate_twice(input, options, work)
                                                   : Run(input, options, work).to(options.vertices);
  result.work = 1e-9 * static_cast<double>(work.done());
  return result;
}

std::vector<DecimateResult> decimate_series(const geom::Prepared& input,
                                            const DecimateOptions& options,
                                            std::span<const std::size_t> vertices) {
  if (vertices.empty() || options.vertices ||
      std::adjacent_find(vertices.begin(), vertices.end(), std::less_equal<>()) != vertices.end())
    throw Error(ErrorCode::InvalidArgument, "a series needs falling numbers of vertices");
  check_options(input, options);
  Work work(1e9 * work_allowed(input, options));
  Run run(input, options, work);
  std::vector<DecimateResult> levels;
  levels.reserve(vertices.size());  // what is nested in stays where it is
  for (const std::size_t target : vertices) {
    if (!levels.empty() && levels.back().stop != Stop::VertexTarget) {
      levels.push_back(levels.back());
      continue;
    }
    if (!levels.empty()) run.nest_in(levels.back().mesh);
    levels.push_back(run.to(target));
    levels.back().work = 1e-9 * static_cast<double>(work.done());
  }
  return levels;
}

}  // namespace kaboum::bmesh
