// Covers by capsules and boxes: bodies that grow within the parallel body, few of them by a local
// search, fewer by one in place of two. docs/algorithms/capsules-and-boxes.md.
#include <kaboum/base/error.h>
#include <kaboum/base/parallel.h>
#include <kaboum/bcd/simple_bodies.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/float32.h>
#include <kaboum/geom/triangle_search.h>
#include <kaboum/geom/winding.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <numeric>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "cover_points.h"
#include "fitting.h"
#include "options.h"
#include "principal_box.h"
#include "set_cover.h"

namespace kaboum::bcd {
namespace {

using geom::Mesh;

/// Shares of ε: what capsules and boxes leave of it, so that polytopes round the bodies are within
/// it; by which triangles, and by which points, are held with room to spare; the size of caps.
constexpr double kLeft = 5e-3, kTriangleSpare = 2e-3, kPointSpare = 0.02, kCaps = 0.15;
/// Cubes of the solid that no body holds are cut until half their edge is this share of ε.
constexpr double kVoid = 0.06;
constexpr double kSqrt3Up = 1.7320508076;
constexpr int kPatches = 60;               ///< rounds of points added where no body is
constexpr std::size_t kAddedPoints = 200;  ///< in a round
constexpr int kTriangleCuts = 24;          ///< of a triangle
constexpr std::size_t kShown = 12;         ///< most free points of a triangle, or a few more
constexpr std::size_t kMostSurface = 6'000;
constexpr std::size_t kMostFrames = 4;

struct SimpleBody {
  enum class Kind { Ball, Capsule, Box } kind = Kind::Ball;
  Capsule capsule;  ///< a ball: both ends are its centre
  AxesBox box;

  [[nodiscard]] double beyond(const Vec3& p) const {
    return kind == Kind::Box ? box.beyond(p) : capsule.beyond(p);
  }

  /// The centre and the radius of a ball that holds it.
  [[nodiscard]] std::pair<Vec3, double> ball_round() const {
    constexpr double kUp = 1 + 1e-9;
    if (kind == Kind::Box)
      return {box.center + 0.5 * box.axes * (box.low + box.high),
              0.5 * kUp * (box.high - box.low).norm()};
    return {0.5 * (capsule.from + capsule.to),
            kUp * (0.5 * (capsule.to - capsule.from).norm() + capsule.radius)};
  }
};

/// A number that differs for different sequences of numbers, but with a probability of 2^-64 each.
class Digest {
 public:
  void add(std::uint64_t x) {
    // The finaliser of SplitMix64: every bit of the sum changes half of the digest's.
    state_ += x + 0x9e3779b97f4a7c15U;
    state_ = (state_ ^ (state_ >> 30U)) * 0xbf58476d1ce4e5b9U;
    state_ = (state_ ^ (state_ >> 27U)) * 0x94d049bb133111ebU;
    state_ ^= state_ >> 31U;
  }
  template <class Matrix>
  void add(const Eigen::MatrixBase<Matrix>& numbers) {
    for (Eigen::Index j = 0; j < numbers.cols(); ++j)
      for (Eigen::Index i = 0; i < numbers.rows(); ++i)
        add(std::bit_cast<std::uint64_t>(numbers(i, j)));
  }
  void add(const SimpleBody& one) {
    add(static_cast<std::uint64_t>(one.kind));
    if (one.kind == SimpleBody::Kind::Box) {
      for (const Vec3* p : {&one.box.center, &one.box.low, &one.box.high}) add(*p);
      add(one.box.axes);
      return;
    }
    add(one.capsule.from);
    add(one.capsule.to);
    add(std::bit_cast<std::uint64_t>(one.capsule.radius));
  }
  [[nodiscard]] std::uint64_t value() const { return state_; }

 private:
  std::uint64_t state_ = 0;
};

/// What a query of a body costs beside that of a ball: measured (the table in
/// docs/algorithms/capsules-and-boxes.md).
double cost_of(SimpleBody::Kind kind) {
  switch (kind) {
    case SimpleBody::Kind::Ball:
      return 1;
    case SimpleBody::Kind::Capsule:
      return 1.05;
    case SimpleBody::Kind::Box:
      break;
  }
  return 1.3;
}

struct SimpleEffort {
  std::size_t points, seeds, steps;
  int rounds;          ///< of choosing again
  std::size_t merges;  ///< most tries of one body for two
};

SimpleEffort effort_for(Effort effort) {
  switch (effort) {
    case Effort::Fast:
      return {800, 120, 300, 1, 2'000};
    case Effort::Normal:
      break;
    case Effort::Best:
      return {4000, 1500, 5000, 6, 100'000};
  }
  return {1500, 300, 1000, 2, 8'000};
}

class BodySearch {
 public:
  BodySearch(const Mesh& mesh, const SimpleBodyOptions& options)
      : mesh_(mesh),
        options_(options),
        effort_(effort_for(options.effort)),
        query_(mesh),
        winding_(mesh),
        box_(geom::bounding_box(mesh)) {
    const double largest = std::max(box_.min.cwiseAbs().maxCoeff(), box_.max.cwiseAbs().maxCoeff());
    spacing_ = geom::float32_spacing(largest + box_.diagonal());
    CoverPoints points =
        sample_cover_points(mesh, winding_, options.epsilon, effort_.points, kMostSurface);
    surface_ = std::move(points.surface);
    points_ = std::move(points.first);
    inner_ = std::move(points.inside);
    find_frames();
  }

  CoverCandidate find() {
    if (options_.max_bodies) {
      bodies_ = within_count(*options_.max_bodies);
      if (options_.epsilon && epsilon_ <= *options_.epsilon)
        bodies_ = cover(*options_.epsilon, kAny);
    } else {
      bodies_ = cover(*options_.epsilon, kAny);
    }
    return candidate();
  }

  CoverCandidate hold(std::span<const Vec3> points) {
    points_.insert(points_.end(), points.begin(), points.end());
    inner_.insert(inner_.end(), points.begin(), points.end());
    if (options_.max_bodies || bodies_.empty()) return find();
    bodies_ = completed(std::move(bodies_), kAny);
    if (bodies_.empty()) return find();
    return candidate();
  }

 private:
  static constexpr std::size_t kAny = kMostSimpleBodies;

  /// The bodies of the last search, as they are handed over.
  [[nodiscard]] CoverCandidate candidate() const {
    CoverCandidate out;
    std::vector<SimpleBody> bodies;
    bodies.reserve(bodies_.size());
    for (const SimpleBody& one : bodies_) bodies.push_back(written(one));
    for (std::size_t i = 0; i < bodies.size(); ++i) {
      out.bodies.push_back(convex_body(bodies[i], i));
      const std::size_t vertices = out.bodies.back().core.vertices.size();
      out.statistics.vertices += vertices;
      out.statistics.largest = std::max(out.statistics.largest, vertices);
    }
    out.statistics.leaves = bodies.size();
    // Half of what is left is for who rounds the bodies.
    out.excess_upper = epsilon_ * (1 - 0.5 * kLeft);
    out.excess_lower = std::min(farthest(bodies), out.excess_upper);
    if (options_.epsilon && !(out.excess_upper <= *options_.epsilon))
      out.stop = Stop::TooManyBodies;
    return out;
  }

  void show(const char* stage, double share) const {
    if (options_.progress) options_.progress({stage, share});
  }

  /// Axes that most of the surface is square to: of each frame the first normal has most area of
  /// what no frame before has, the second one most of what is square to it. And those of all
  /// points' covariance.
  void find_frames() {
    std::vector<char> taken(surface_.size(), 0);
    const auto along = [&](const Vec3& n) {
      std::size_t out = 0;
      for (std::size_t i = 0; i < surface_.size(); ++i)
        out += taken[i] == 0 && std::abs(surface_[i].inwards.dot(n)) > 0.999 ? 1U : 0U;
      return out;
    };
    const std::size_t stride = surface_.size() / 300 + 1;
    while (frames_.size() + 1 < kMostFrames) {
      Vec3 first = Vec3::Zero(), second = Vec3::Zero();
      std::size_t most = surface_.size() / 50;
      for (std::size_t i = 0; i < surface_.size(); i += stride)
        if (const std::size_t has = along(surface_[i].inwards); has > most) {
          most = has;
          first = surface_[i].inwards;
        }
      if (first.isZero(0)) break;
      most = 0;
      for (std::size_t i = 0; i < surface_.size(); i += stride) {
        const Vec3& n = surface_[i].inwards;
        if (std::abs(n.dot(first)) > 0.01) continue;
        if (const std::size_t has = along(n); has > most) {
          most = has;
          second = n;
        }
      }
      frames_.push_back(frame_of(first, second));
      for (std::size_t i = 0; i < surface_.size(); ++i)
        for (int k = 0; k < 3; ++k)
          if (std::abs(surface_[i].inwards.dot(frames_.back().col(k))) > 0.999) taken[i] = 1;
    }
    const auto principal = principal_box(points_);
    if (principal && std::ranges::none_of(frames_, [&](const Eigen::Matrix3d& frame) {
          return are_alike(frame, principal->axes);
        }))
      frames_.push_back(principal->axes);
    if (frames_.empty()) frames_.push_back(Eigen::Matrix3d::Identity());
    for (const Eigen::Matrix3d& frame : frames_)
      for (int k = 0; k < 3; ++k) add_direction(frame.col(k), directions_);
  }

  /// Frames of the same boxes, nearly.
  static bool are_alike(const Eigen::Matrix3d& a, const Eigen::Matrix3d& b) {
    return ((a.transpose() * b).cwiseAbs().colwise().maxCoeff().array() > 0.9999).all();
  }

  static void add_direction(const Vec3& d, std::vector<Vec3>& to) {
    if (std::ranges::none_of(to, [&](const Vec3& e) { return std::abs(e.dot(d)) > 0.9999; }))
      to.push_back(d);
  }

  static Eigen::Matrix3d frame_of(const Vec3& first, const Vec3& second) {
    Eigen::Matrix3d out;
    out.col(0) = first.normalized();
    Vec3 other = second - second.dot(out.col(0)) * out.col(0);
    if (!(other.norm() > 0.1)) {
      int least = 0;
      out.col(0).cwiseAbs().minCoeff(&least);
      other = Vec3::Unit(least) - out.col(0)[least] * out.col(0);
    }
    out.col(1) = other.normalized();
    out.col(2) = out.col(0).cross(out.col(1));
    return out;
  }

  // --- candidates ---

  void set_distance(double epsilon) {
    epsilon_ = epsilon;
    failed_.clear();
    held_.clear();
    holders_.clear();
    body_ = std::make_unique<RegionalBody>(query_, winding_, epsilon * (1 - kLeft), kCaps,
                                           options_.regions, epsilon);
    finest_ = options_.regions.empty() ? epsilon : std::min(epsilon, *finest_epsilon(options_));
    spare_ = kPointSpare * finest_ + 2 * spacing_;
  }

  static SimpleBody ball(const Vec3& center, double radius) {
    return {SimpleBody::Kind::Ball, {center, center, radius}, {}};
  }

  /// A capsule, or the ball that it is where it is short, with the largest radius that is allowed;
  /// nullopt where that is less than `least`.
  [[nodiscard]] std::optional<SimpleBody> capsule(const Vec3& from, const Vec3& to,
                                                  double least) const {
    Vec3 end = to;
    // A segment that is a point is none.
    if ((to - from).norm() < 64 * spacing_) {
      if (options_.kinds.balls) {
        const double radius = body_->radius_about(from);
        return radius >= least ? std::optional(ball(from, radius)) : std::nullopt;
      }
      end = from + 64 * spacing_ * Vec3::UnitX();
    }
    const double radius = clearance(*body_, from, end, least);
    if (!(radius >= least)) return std::nullopt;
    return SimpleBody{SimpleBody::Kind::Capsule, {from, end, radius}, {}};
  }

  /// How far a ball of a radius may roll along a direction.
  [[nodiscard]] Vec3 rolled(Vec3 at, const Vec3& direction, double radius) const {
    constexpr int kRolls = 16;
    for (int step = 0; step < kRolls; ++step) {
      const double way = body_->radius_about(at) - radius;
      if (!(way > 0.05 * epsilon_)) break;
      at += way * direction;
    }
    return at;
  }

  /// Ball centres inwards of a point of the surface: of the farthest ball that holds it, and of the
  /// largest one.
  [[nodiscard]] std::pair<Vec3, Vec3> centres_at(const SurfacePoint& p) const {
    constexpr double kHeld = 0.98;
    constexpr int kHalvings = 8, kPlaces = 6;
    const auto radius = [&](double depth) { return body_->radius_about(p.at + depth * p.inwards); };
    double low = 0, high = 0.5 * box_.diagonal() + 2 * epsilon_;
    for (int turn = 0; turn < kHalvings; ++turn) {
      const double middle = 0.5 * (low + high);
      (kHeld * radius(middle) >= middle ? low : high) = middle;
    }
    double largest = low, most = radius(low);
    for (int k = 0; k < kPlaces; ++k)
      if (const double one = radius(low * k / kPlaces); one > most) {
        most = one;
        largest = low * k / kPlaces;
      }
    return {p.at + low * p.inwards, p.at + largest * p.inwards};
  }

  void add_capsules(const SurfacePoint& p, std::vector<SimpleBody>& out) const {
    const auto [farthest, largest] = centres_at(p);
    for (const Vec3& c : {farthest, largest}) {
      const double radius = body_->radius_about(c);
      if (!(radius > 0)) continue;
      if (options_.kinds.balls) out.push_back(ball(c, radius));
      for (const Vec3& d : directions_)
        for (const double share : {0.97, 0.85}) {
          const Vec3 from = rolled(c, -d, share * radius), to = rolled(c, d, share * radius);
          if (const auto found = capsule(from, to, 0.5 * radius)) out.push_back(*found);
        }
    }
  }

  void add_boxes(const SurfacePoint& p, std::uint64_t seed, std::vector<SimpleBody>& out) const {
    constexpr int kOrders = 3;
    Random random(seed);
    const auto [farthest, largest] = centres_at(p);
    for (const Eigen::Matrix3d& frame : frames_)
      for (int turn = 0; turn < kOrders; ++turn) {
        std::array<int, 6> order{0, 1, 2, 3, 4, 5};
        for (std::size_t i = 5; i > 0; --i) std::swap(order[i], order[random.index(i + 1)]);
        const Vec3& c = turn == 0 ? largest : farthest;
        const double half = 0.5 * body_->radius_about(c);
        if (!(half > 0)) continue;
        SimpleBody one;
        one.kind = SimpleBody::Kind::Box;
        one.box = {c, frame, Vec3::Constant(-half), Vec3::Constant(half)};
        grow(*body_, one.box, order, turn == 2 ? 1 : 0.25);
        out.push_back(one);
      }
  }

  void add_candidates(const std::vector<SurfacePoint>& at) {
    std::vector<std::vector<SimpleBody>> found(at.size());
    kaboum::parallel_for(std::size_t{0}, at.size(), [&](std::size_t i) {
      if (options_.kinds.capsules) add_capsules(at[i], found[i]);
      if (options_.kinds.boxes) add_boxes(at[i], candidates_.size() + i, found[i]);
    });
    for (const std::vector<SimpleBody>& some : found)
      candidates_.insert(candidates_.end(), some.begin(), some.end());
  }

  /// A body about a point of the solid.
  void add_at(const Vec3& p) {
    const double radius = body_->radius_about(p);
    if (!(radius > 0)) return;
    if (options_.kinds.capsules) {
      if (const auto one = capsule(p, p, 0)) candidates_.push_back(*one);
    } else {
      SimpleBody one;
      one.kind = SimpleBody::Kind::Box;
      const double half = 0.57 * radius;
      one.box = {p, frames_[0], Vec3::Constant(-half), Vec3::Constant(half)};
      constexpr std::array<int, 6> kOrder{0, 1, 2, 3, 4, 5};
      grow(*body_, one.box, kOrder, 0.25);
      candidates_.push_back(one);
    }
  }

  // --- choices ---

  [[nodiscard]] std::vector<std::uint32_t> held_by(const SimpleBody& one,
                                                   const std::vector<Vec3>& points) const {
    // Few points are in the ball round a body.
    const auto [center, radius] = one.ball_round();
    const double most = radius * radius;
    std::vector<std::uint32_t> out;
    for (std::uint32_t p = 0; p < points.size(); ++p)
      if ((points[p] - center).squaredNorm() <= most && one.beyond(points[p]) <= -spare_)
        out.push_back(p);
    return out;
  }

  [[nodiscard]] std::vector<SimpleBody> choose(const std::vector<Vec3>& points,
                                               std::size_t steps) const {
    std::vector<std::vector<std::uint32_t>> sets(candidates_.size());
    kaboum::parallel_for(std::size_t{0}, candidates_.size(),
                         [&](std::size_t c) { sets[c] = held_by(candidates_[c], points); });
    std::vector<SimpleBody> out;
    for (const std::uint32_t c : SetCover(points.size(), std::move(sets)).search(steps, 1))
      out.push_back(candidates_[c]);
    return out;
  }

  // --- one body for given points ---

  /// True for a point farther from the solid than bodies may be; of some it is not seen.
  [[nodiscard]] bool is_beyond(const Vec3& p) const {
    if (query_.within(p, body_->distance() * (1 + 1e-9)) != geom::TriangleSearch::kNone)
      return false;
    const std::optional<int> winding = winding_(p);
    return winding && *winding <= 0;
  }

  /// True if a point of the capsule is beyond: of the middle and those across it and across the
  /// ends.
  [[nodiscard]] bool is_too_wide(const Capsule& one) const {
    const Vec3 middle = 0.5 * (one.from + one.to);
    if (is_beyond(middle)) return true;
    const Eigen::Matrix3d frame = frame_of(axis_of(one), Vec3::Zero());
    for (const Vec3& c : {middle, one.from, one.to})
      for (const int k : {1, 2})
        for (const double side : {-one.radius, one.radius})
          if (is_beyond(c + side * frame.col(k))) return true;
    return false;
  }
  [[nodiscard]] bool is_too_long(const Capsule& one) const {
    const Vec3 tip = one.radius * axis_of(one);
    return is_beyond(one.from - tip) || is_beyond(one.to + tip);
  }
  static Vec3 axis_of(const Capsule& one) {
    const Vec3 way = one.to - one.from;
    return way.norm() > 0 ? way.normalized() : Vec3::UnitX();
  }

  [[nodiscard]] std::optional<SimpleBody> ball_for(const std::vector<Vec3>& points) const {
    Vec3 center = points[0];
    constexpr int kSteps = 60;
    for (int step = 1; step <= kSteps; ++step) {
      Vec3 farthest = center;
      double most = -1;
      for (const Vec3& p : points)
        if (const double away = (p - center).squaredNorm(); away > most) {
          most = away;
          farthest = p;
        }
      center += (farthest - center) / (step + 1);
    }
    double needed = 0;
    for (const Vec3& p : points) needed = std::max(needed, (p - center).norm());
    const double radius = body_->radius_about(center);
    return radius >= needed + spare_ ? std::optional(ball(center, radius)) : std::nullopt;
  }

  [[nodiscard]] std::optional<SimpleBody> capsule_for(const std::vector<Vec3>& points,
                                                      const std::vector<Vec3>& directions) const {
    constexpr std::array kShares{0.9, 0.6, 0.3, 0.02};
    for (const Vec3& d : directions) {
      const Cylinder cylinder = cylinder_round(points, d);
      const double least = cylinder.radius + spare_;
      // What is too wide where it is narrowest hardly ever fits with another radius.
      if (const auto narrow =
              capsule_round(points, cylinder, least + kShares.back() * epsilon_, spare_);
          !narrow || is_too_wide(*narrow))
        continue;
      for (const double share : kShares) {
        const double radius = least + share * epsilon_;
        const auto found = capsule_round(points, cylinder, radius, spare_);
        if (!found || is_too_long(*found) || is_too_wide(*found)) continue;
        auto one = capsule(found->from, found->to, radius);
        // A capsule far outside the body meets no cap, either.
        const Vec3 middle = 0.5 * (found->from + found->to);
        if (one && body_->signed_distance(middle).upper < epsilon_) return one;
      }
    }
    return std::nullopt;
  }

  [[nodiscard]] std::optional<SimpleBody> box_for(const std::vector<Vec3>& points,
                                                  const std::vector<Eigen::Matrix3d>& axes) const {
    std::vector<std::pair<double, AxesBox>> tried;
    for (const Eigen::Matrix3d& frame : axes) {
      const AxesBox one = box_round(points, frame, spare_ * (1 + 1e-6));
      tried.emplace_back((one.high - one.low).prod(), one);
    }
    std::ranges::stable_sort(tried, {}, [](const auto& entry) { return entry.first; });
    for (const auto& [volume, one] : tried) {
      if (!(body_->signed_distance(one.center).upper < body_->distance())) continue;
      if (std::ranges::any_of(one.corners(), [&](const Vec3& p) { return is_beyond(p); })) continue;
      if (!fits(*body_, one)) continue;
      SimpleBody out;
      out.kind = SimpleBody::Kind::Box;
      out.box = one;
      constexpr std::array<int, 6> kOrder{0, 1, 2, 3, 4, 5};
      grow(*body_, out.box, kOrder, 0.1);
      return out;
    }
    return std::nullopt;
  }

  /// A body that holds the points, of the kind that costs least.
  /// @param below  it is to cost less than this
  [[nodiscard]] std::optional<SimpleBody> body_for(const std::vector<Vec3>& points,
                                                   const std::vector<SimpleBody>& like,
                                                   double below) const {
    if (points.empty()) return std::nullopt;
    std::vector<Eigen::Matrix3d> axes = frames_;
    std::vector<Vec3> directions;
    const auto add_axes = [&](const Eigen::Matrix3d& frame) {
      if (std::ranges::none_of(axes, [&](const Eigen::Matrix3d& a) { return are_alike(a, frame); }))
        axes.push_back(frame);
    };
    const auto principal = principal_box(points);
    if (principal) add_axes(principal->axes);
    for (const SimpleBody& one : like) {
      if (one.kind == SimpleBody::Kind::Box)
        add_axes(one.box.axes);
      else if (const Vec3 along = one.capsule.to - one.capsule.from; along.norm() > 100 * spacing_)
        add_direction(along.normalized(), directions);
    }
    if (principal) add_direction(principal->axes.col(2), directions);
    for (const Vec3& d : directions_) add_direction(d, directions);
    using Kind = SimpleBody::Kind;
    const SimpleKinds& kinds = options_.kinds;
    if (kinds.balls && cost_of(Kind::Ball) < below)
      if (auto one = ball_for(points)) return one;
    if (kinds.capsules && cost_of(Kind::Capsule) < below)
      if (auto one = capsule_for(points, directions)) return one;
    if (kinds.boxes && cost_of(Kind::Box) < below) return box_for(points, axes);
    return std::nullopt;
  }

  // --- fewer ---

  /// The points that a body holds, of the first so many.
  struct Held {
    std::size_t known = 0;
    std::vector<std::uint32_t> points;
  };

  /// Which bodies hold each point.
  struct Holders {
    std::vector<const Held*> of_body;
    std::vector<std::uint32_t> times;
  };

  /// Most bodies were there before: only of others, and of points that were added, it is asked.
  [[nodiscard]] Holders holders_of(const std::vector<SimpleBody>& bodies) {
    Holders out;
    out.times.assign(points_.size(), 0);
    std::vector<std::pair<Held*, const SimpleBody*>> incomplete;
    for (const SimpleBody& body : bodies) {
      Digest digest;
      digest.add(body);
      Held& held = held_[digest.value()];
      out.of_body.push_back(&held);
      if (held.known < points_.size()) incomplete.emplace_back(&held, &body);
    }
    std::ranges::sort(incomplete);
    const auto same =
        std::unique(incomplete.begin(), incomplete.end(),
                    [](const auto& one, const auto& other) { return one.first == other.first; });
    incomplete.erase(same, incomplete.end());
    kaboum::parallel_for(std::size_t{0}, incomplete.size(), [&](std::size_t i) {
      const auto& [held, body] = incomplete[i];
      for (auto p = static_cast<std::uint32_t>(held->known); p < points_.size(); ++p)
        if (body->beyond(points_[p]) <= -spare_) held->points.push_back(p);
      held->known = points_.size();
    });
    for (const Held* held : out.of_body)
      for (const std::uint32_t p : held->points) ++out.times[p];
    return out;
  }

  /// Points that only these bodies hold.
  [[nodiscard]] std::vector<Vec3> only_of(const Holders& holders,
                                          std::initializer_list<std::size_t> of) const {
    std::vector<std::uint32_t> all;
    for (const std::size_t b : of)
      all.insert(all.end(), holders.of_body[b]->points.begin(), holders.of_body[b]->points.end());
    std::ranges::sort(all);
    std::vector<Vec3> out;
    for (std::size_t i = 0; i < all.size();) {
      std::size_t next = i;
      while (next < all.size() && all[next] == all[i]) ++next;
      if (holders.times[all[i]] == next - i) out.push_back(points_[all[i]]);
      i = next;
    }
    return out;
  }

  void leave_out_unneeded(std::vector<SimpleBody>& bodies) {
    for (std::size_t i = 0; i < bodies.size();) {
      const Holders holders = holders_of(bodies);
      for (; i < bodies.size(); ++i)
        if (only_of(holders, {i}).empty()) break;
      if (i < bodies.size()) {
        bodies.erase(bodies.begin() + static_cast<std::ptrdiff_t>(i));
        i = 0;
      }
    }
  }

  static std::uint64_t key_of(const std::vector<Vec3>& points, const SimpleBody& a,
                              const SimpleBody& b) {
    Digest digest;
    digest.add(a);
    digest.add(b);
    for (const Vec3& p : points) digest.add(p);
    return digest.value();
  }

  /// One body in place of two, while that succeeds. The nearest pairs come first.
  void merge(std::vector<SimpleBody>& bodies, std::size_t& tries) {
    leave_out_unneeded(bodies);
    bool merged = true;
    while (merged && bodies.size() > 1) {
      merged = false;
      show("one body for two", 0);
      const Holders holders = holders_of(bodies);
      std::vector<geom::Box3> reach(bodies.size());
      for (std::size_t b = 0; b < bodies.size(); ++b)
        for (const Vec3& p : only_of(holders, {b})) reach[b].extend(p);
      std::vector<std::pair<double, std::pair<std::size_t, std::size_t>>> pairs;
      for (std::size_t a = 0; a < bodies.size(); ++a)
        for (std::size_t b = a + 1; b < bodies.size(); ++b) {
          geom::Box3 both = reach[a];
          both.extend(reach[b]);
          pairs.push_back({both.diagonal(), {a, b}});
        }
      std::ranges::sort(pairs);
      std::vector<char> changed(bodies.size(), 0);
      std::vector<SimpleBody> next = bodies;
      for (const auto& [size, pair] : pairs) {
        const auto [a, b] = pair;
        if (changed[a] != 0 || changed[b] != 0) continue;
        const std::vector<Vec3> points = only_of(holders, {a, b});
        const std::uint64_t key = key_of(points, bodies[a], bodies[b]);
        if (failed_.contains(key)) continue;
        if (tries == 0) break;
        --tries;
        const auto one = body_for(points, {bodies[a], bodies[b]},
                                  cost_of(bodies[a].kind) + cost_of(bodies[b].kind));
        if (!one) {
          failed_.insert(key);
          continue;
        }
        next[a] = *one;
        changed[a] = 1;
        changed[b] = 2;
        candidates_.push_back(*one);
        merged = true;
        break;  // who holds what has changed
      }
      std::vector<SimpleBody> rest;
      for (std::size_t i = 0; i < next.size(); ++i)
        if (changed[i] != 2) rest.push_back(next[i]);
      bodies = std::move(rest);
      leave_out_unneeded(bodies);
    }
  }

  /// Leaves bodies out whose points others can hold beside their own, those with fewest such points
  /// first.
  void leave_out_replaceable(std::vector<SimpleBody>& bodies, std::size_t& tries) {
    bool fewer = true;
    while (fewer && bodies.size() > 1) {
      fewer = false;
      const Holders holders = holders_of(bodies);
      std::vector<std::pair<std::size_t, std::size_t>> order;
      for (std::size_t b = 0; b < bodies.size(); ++b)
        order.emplace_back(only_of(holders, {b}).size(), b);
      std::ranges::sort(order);
      for (const auto& [count, b] : order) {
        if (tries == 0) return;
        --tries;
        std::vector<SimpleBody> rest = bodies;
        rest.erase(rest.begin() + static_cast<std::ptrdiff_t>(b));
        if (!given_to(rest, only_of(holders, {b})).empty()) continue;
        bodies = std::move(rest);
        fewer = true;
        break;
      }
    }
  }

  /// Bodies of cheaper kinds where these hold what only the dear ones do.
  void make_cheaper(std::vector<SimpleBody>& bodies) {
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Holders holders = holders_of(bodies);
      if (const auto one = body_for(only_of(holders, {b}), {bodies[b]}, cost_of(bodies[b].kind)))
        bodies[b] = *one;
    }
  }

  // --- all triangles ---

  /// As it is written: rounded, so that it lies in the body that ε allows.
  [[nodiscard]] SimpleBody written(const SimpleBody& one) const {
    SimpleBody out = one;
    if (one.kind == SimpleBody::Kind::Box) {
      out.box.low += Vec3::Constant(spacing_);
      out.box.high -= Vec3::Constant(spacing_);
      return out;
    }
    out.capsule.from = geom::to_float32(one.capsule.from);
    out.capsule.to = geom::to_float32(one.capsule.to);
    const double most = one.kind == SimpleBody::Kind::Ball
                            ? body_->radius_about(out.capsule.from)
                            : clearance(*body_, out.capsule.from, out.capsule.to);
    double radius = geom::to_float32(most);
    if (radius > most) radius -= geom::float32_spacing(radius * (1 - 1e-7));
    out.capsule.radius = radius;
    return out;
  }

  [[nodiscard]] geom::ConvexBody convex_body(const SimpleBody& one, std::size_t index) const {
    geom::ConvexBody out;
    switch (one.kind) {
      case SimpleBody::Kind::Ball:
        out.name = "sphere_" + std::to_string(index);
        out.core.vertices = {one.capsule.from};
        out.radius = one.capsule.radius;
        break;
      case SimpleBody::Kind::Capsule:
        out.name = "capsule_" + std::to_string(index);
        out.core.vertices = {one.capsule.from, one.capsule.to};
        out.radius = one.capsule.radius;
        break;
      case SimpleBody::Kind::Box: {
        out.name = "box_" + std::to_string(index);
        std::vector<Vec3> corners;
        for (const Vec3& p : one.box.corners()) corners.push_back(geom::to_float32(p));
        auto hull = geom::convex_hull(corners);
        ensure(hull.has_value(), "a box is flat");
        out.core = *std::move(hull);
        break;
      }
    }
    return out;
  }

  struct Piece {
    std::array<Vec3, 3> corner;
    int cuts;
  };

  /// A body as it is written, and the box round it.
  struct Written {
    SimpleBody body;
    geom::Box3 box;
    std::uint64_t digest;  ///< of the body as it was found
  };

  [[nodiscard]] Written as_written(const SimpleBody& one) const {
    Written out{written(one), {}, 0};
    if (one.kind == SimpleBody::Kind::Box) {
      for (const Vec3& p : out.body.box.corners()) out.box.extend(p);
    } else {
      const Vec3 radius = Vec3::Constant(out.body.capsule.radius);
      for (const Vec3& p : {out.body.capsule.from, out.body.capsule.to}) {
        out.box.extend(p - radius);
        out.box.extend(p + radius);
      }
    }
    Digest digest;
    digest.add(one);
    out.digest = digest.value();
    return out;
  }

  /// Points of a triangle in no body, by cutting it until parts are in one.
  /// @param holders  gets the digests of bodies that hold all of it together; empty: there are none
  void find_free(const std::array<Vec3, 3>& triangle, const std::vector<Written>& bodies,
                 std::size_t most, std::vector<Vec3>& out,
                 std::vector<std::uint64_t>& holders) const {
    const double spare = kTriangleSpare * finest_ + 4 * spacing_;
    holders.clear();
    std::vector<const Written*> near;
    geom::Box3 box;
    for (const Vec3& p : triangle) box.extend(p);
    for (const Written& one : bodies)
      if ((box.max.array() >= one.box.min.array()).all() &&
          (one.box.max.array() >= box.min.array()).all())
        near.push_back(&one);
    std::vector<Piece> open{{triangle, 0}};
    while (!open.empty() && out.size() < most) {
      const Piece piece = open.back();
      open.pop_back();
      const Written* holder = nullptr;
      std::array<bool, 3> some{};
      for (const Written* one : near) {
        bool all = true;
        for (std::size_t k = 0; k < 3; ++k) {
          const bool in = one->body.beyond(piece.corner[k]) <= -spare;
          some[k] = some[k] || in;
          all = all && in;
        }
        if (!all) continue;
        holder = one;
        break;
      }
      if (holder != nullptr) {
        if (std::ranges::find(holders, holder->digest) == holders.end())
          holders.push_back(holder->digest);
        continue;
      }
      bool free = false;
      for (std::size_t k = 0; k < 3; ++k) {
        if (some[k]) continue;
        out.push_back(piece.corner[k]);
        free = true;
      }
      if (piece.cuts >= kTriangleCuts) {
        out.push_back((piece.corner[0] + piece.corner[1] + piece.corner[2]) / 3);
        continue;
      }
      if (free && piece.cuts > 6) continue;
      std::size_t longest = 0;
      for (std::size_t k = 1; k < 3; ++k)
        if ((piece.corner[(k + 1) % 3] - piece.corner[k]).squaredNorm() >
            (piece.corner[(longest + 1) % 3] - piece.corner[longest]).squaredNorm())
          longest = k;
      const std::size_t next = (longest + 1) % 3;
      const Vec3 half = 0.5 * (piece.corner[longest] + piece.corner[next]);
      for (const std::size_t k : {longest, next}) {
        std::array<Vec3, 3> corner = piece.corner;
        corner[k] = half;
        open.push_back({corner, piece.cuts + 1});
      }
    }
    if (!out.empty()) holders.clear();
  }

  struct Cube {
    Vec3 center;
    double half;
  };

  /// A cube of an octree over the solid: its place, which no body changes, and its eight parts.
  struct PlacedCube {
    enum class Place : std::uint8_t { Unknown, Outside, Inside, Border } place = Place::Unknown;
    std::uint32_t parts = 0;  ///< the first of eight; 0: none are known
  };
  /// A cube, its parts, theirs and so on; the first is the whole.
  using CubeTree = std::vector<PlacedCube>;
  static constexpr std::size_t kMostKept = 10'000;  ///< cubes of a tree

  [[nodiscard]] PlacedCube::Place place_of(const Cube& cube) const {
    using Place = PlacedCube::Place;
    if (query_.within(cube.center, kSqrt3Up * cube.half) != geom::TriangleSearch::kNone)
      return Place::Border;
    const std::optional<int> winding = winding_(cube.center);
    if (!winding) return Place::Border;
    return *winding >= 1 ? Place::Inside : Place::Outside;
  }

  /// Points of the solid in cubes that are in no body, one of a small cube.
  [[nodiscard]] std::vector<Vec3> void_points(const std::vector<Written>& bodies) {
    constexpr int kCuts = 8;
    const Vec3 size = box_.max - box_.min;
    const double edge = size.maxCoeff() / kCuts;
    const auto count = [&](int k) { return static_cast<std::size_t>(std::ceil(size[k] / edge)); };
    const std::size_t across = std::max<std::size_t>(count(0), 1);
    const std::size_t deep = std::max<std::size_t>(count(1), 1);
    const std::size_t all_cubes = across * deep * std::max<std::size_t>(count(2), 1);
    cubes_.resize(all_cubes, CubeTree(1));
    std::vector<std::vector<Vec3>> found(all_cubes);
    kaboum::parallel_for(std::size_t{0}, all_cubes,
                         [&](std::size_t i) {
                           const std::size_t y = i / across % deep, z = i / across / deep;
                           const Vec3 at(static_cast<double>(i % across), static_cast<double>(y),
                                         static_cast<double>(z));
                           std::vector<const SimpleBody*> near;
                           near.reserve(bodies.size());
                           for (const Written& one : bodies) near.push_back(&one.body);
                           VoidSearch search{cubes_[i], found[i]};
                           find_voids({box_.min + edge * (at + Vec3::Constant(0.5)), 0.5 * edge},
                                      near, PlacedCube::Place::Unknown, 0U, search);
                         },
                         {.alone = true});
    std::vector<Vec3> out;
    for (const std::vector<Vec3>& some : found) out.insert(out.end(), some.begin(), some.end());
    return out;
  }

  struct VoidSearch {
    CubeTree& known;
    std::vector<Vec3>& out;
    std::size_t cubes = 0;  ///< looked at so far
  };

  /// Cuts a cube into eight while no body holds it and the solid may reach it.
  /// @param place  as it is known: that of the cube it is a part of, if all of that is inside
  /// @param index  in what is known; none: beyond that
  void find_voids(const Cube& cube, const std::vector<const SimpleBody*>& bodies,
                  PlacedCube::Place place, std::optional<std::uint32_t> index,
                  VoidSearch& search) const {
    using Place = PlacedCube::Place;
    constexpr std::size_t kMostCubes = 100'000, kMostPoints = 12;
    if (search.out.size() >= kMostPoints || ++search.cubes > kMostCubes) return;
    if (place == Place::Unknown && index) place = search.known[*index].place;
    if (place == Place::Outside) return;
    const double spare = kTriangleSpare * finest_ + 4 * spacing_;
    const double reach = kSqrt3Up * cube.half;
    std::vector<const SimpleBody*> near;
    bool held = false;  // its middle
    for (const SimpleBody* one : bodies) {
      const double beyond = one->beyond(cube.center);
      if (beyond <= -spare - reach) return;
      held = held || beyond <= -spare;
      if (beyond <= reach) near.push_back(one);
    }
    if (place == Place::Unknown) {
      place = place_of(cube);
      if (index) search.known[*index].place = place;
      if (place == Place::Outside) return;
    }
    if (cube.half < kVoid * finest_) {
      if (!held && (place == Place::Inside || winding_(cube.center).value_or(0) >= 1))
        search.out.push_back(cube.center);
      return;
    }
    std::optional<std::uint32_t> parts;
    if (index && place == Place::Border) {
      if (search.known[*index].parts == 0 && search.known.size() < kMostKept) {
        search.known[*index].parts = static_cast<std::uint32_t>(search.known.size());
        search.known.resize(search.known.size() + 8);
      }
      if (search.known[*index].parts != 0) parts = search.known[*index].parts;
    }
    for (std::uint32_t k = 0; k < 8; ++k) {
      const Vec3 corner((k & 1U) != 0 ? 1.0 : -1.0, (k & 2U) != 0 ? 1.0 : -1.0,
                        (k & 4U) != 0 ? 1.0 : -1.0);
      find_voids({cube.center + 0.5 * cube.half * corner, 0.5 * cube.half}, near,
                 place == Place::Inside ? place : Place::Unknown,
                 parts ? std::optional(*parts + k) : std::nullopt, search);
    }
  }

  /// Points of triangles, or of the inside, that no body holds, some of them.
  [[nodiscard]] std::vector<Vec3> free_points(const std::vector<SimpleBody>& bodies) {
    std::vector<Written> all_written(bodies.size());
    kaboum::parallel_for(std::size_t{0}, bodies.size(),
                         [&](std::size_t b) { all_written[b] = as_written(bodies[b]); });
    std::unordered_set<std::uint64_t> there;
    for (const Written& one : all_written) there.insert(one.digest);
    std::vector<std::vector<Vec3>> found(mesh_.triangles.size());
    holders_.resize(mesh_.triangles.size());
    // Most triangles are in bodies that held them before.
    kaboum::parallel_for(std::size_t{0}, mesh_.triangles.size(), [&](std::size_t t) {
      if (!holders_[t].empty() &&
          std::ranges::all_of(holders_[t], [&](std::uint64_t d) { return there.contains(d); }))
        return;
      const auto& [i, j, k] = mesh_.triangles[t];
      find_free({mesh_.vertices[i], mesh_.vertices[j], mesh_.vertices[k]}, all_written, kShown,
                found[t], holders_[t]);
    });
    std::vector<Vec3> all;
    for (const std::vector<Vec3>& some : found) all.insert(all.end(), some.begin(), some.end());
    const double spare = kTriangleSpare * finest_ + 4 * spacing_;
    if (all.empty())
      for (const Vec3& p : inner_)
        if (std::ranges::none_of(all_written,
                                 [&](const Written& b) { return b.body.beyond(p) <= -spare; }))
          all.push_back(p);
    if (all.empty()) all = void_points(all_written);
    std::vector<Vec3> out;
    const std::size_t stride = all.size() / kAddedPoints + 1;
    for (std::size_t i = 0; i < all.size(); i += stride) out.push_back(all[i]);
    return out;
  }

  /// Gives points that no body holds to bodies that can hold them beside what only they hold.
  /// @return those that are left
  [[nodiscard]] std::vector<Vec3> given_to(std::vector<SimpleBody>& bodies,
                                           std::vector<Vec3> free) {
    constexpr std::size_t kNear = 3;
    std::size_t failed = 0;
    for (std::size_t turn = 0; turn < 2 * bodies.size() + 4 && failed < 3 && !free.empty();
         ++turn) {
      const std::size_t before = free.size();
      const Vec3 p = free[7919 * turn % free.size()];
      std::vector<std::pair<double, std::size_t>> near;
      for (std::size_t b = 0; b < bodies.size(); ++b) near.emplace_back(bodies[b].beyond(p), b);
      std::ranges::sort(near);
      near.resize(std::min(near.size(), kNear));
      const Holders holders = holders_of(bodies);
      for (const auto& [away, b] : near) {
        const std::vector<Vec3> own = only_of(holders, {b});
        std::optional<SimpleBody> one;
        for (const double reach : {1e9, 1.0, 0.2}) {
          std::vector<Vec3> wanted = own;
          for (const Vec3& q : free)
            if ((q - p).norm() <= reach * epsilon_) wanted.push_back(q);
          one = body_for(wanted, {bodies[b]}, 1e9);
          if (one) break;
        }
        if (!one) continue;
        bodies[b] = *one;
        std::erase_if(free, [&](const Vec3& q) { return one->beyond(q) <= -spare_; });
        break;
      }
      failed += free.size() == before ? 1U : 0U;
    }
    return free;
  }

  /// Bodies that hold all triangles; empty if there would have to be more than `most`.
  [[nodiscard]] std::vector<SimpleBody> completed(std::vector<SimpleBody> bodies,
                                                  std::size_t most) {
    for (int round = 0; round < kPatches; ++round) {
      show("filling gaps", static_cast<double>(round) / kPatches);
      std::vector<Vec3> free = free_points(bodies);
      if (free.empty()) return bodies;
      points_.insert(points_.end(), free.begin(), free.end());
      std::erase_if(free, [&](const Vec3& p) {
        return std::ranges::any_of(bodies,
                                   [&](const SimpleBody& b) { return b.beyond(p) <= -spare_; });
      });
      // What is held, but not with enough to spare, counts as free.
      if (3 * round < kPatches) free = given_to(bodies, std::move(free));
      if (free.empty()) continue;
      const std::size_t known = candidates_.size();
      std::vector<SurfacePoint> at;
      const std::size_t stride = free.size() / 40 + 1;
      for (std::size_t i = 0; i < free.size(); ++i) {
        add_at(free[i]);
        const auto& [a, b, c] = query_.corners(query_.nearest(free[i]).triangle);
        const Vec3 inwards = -(b - a).cross(c - a).normalized();
        if (i % stride == 0 && inwards.allFinite()) at.push_back({free[i], inwards});
      }
      if (known < 20'000) add_candidates(at);
      const std::vector<SimpleBody> more = choose(free, 0);
      if (more.empty()) return {};
      bodies.insert(bodies.end(), more.begin(), more.end());
      if (bodies.size() > most + most / 4 + 4) return {};
    }
    return {};
  }

  /// A cover of all triangles within ε; empty where none was found with `most` bodies or fewer.
  std::vector<SimpleBody> cover(double epsilon, std::size_t most) {
    show("choosing bodies", 0);
    set_distance(epsilon);
    candidates_.clear();
    std::vector<SurfacePoint> seeds;
    const std::size_t stride = std::max<std::size_t>(1, surface_.size() / effort_.seeds);
    for (std::size_t i = 0; i < surface_.size(); i += stride) seeds.push_back(surface_[i]);
    add_candidates(seeds);
    for (const Vec3& p : points_)
      if (std::ranges::none_of(candidates_,
                               [&](const SimpleBody& b) { return b.beyond(p) <= -spare_; }))
        add_at(p);
    std::vector<SimpleBody> best;
    for (int round = 0; round < effort_.rounds; ++round) {
      std::vector<SimpleBody> bodies = choose(points_, effort_.steps);
      if (bodies.empty()) break;
      std::size_t tries = effort_.merges;
      merge(bodies, tries);
      tries = effort_.merges / 20;
      leave_out_replaceable(bodies, tries);
      bodies = completed(std::move(bodies), most);
      if (bodies.empty()) continue;
      // Points where gaps were are known by now.
      for (int again = 0; again < 3; ++again) {
        std::vector<SimpleBody> fewer = bodies;
        tries = effort_.merges;
        merge(fewer, tries);
        tries = effort_.merges / 20;
        leave_out_replaceable(fewer, tries);
        if (options_.kinds.balls) make_cheaper(fewer);
        fewer = completed(std::move(fewer), most);
        leave_out_unneeded(fewer);
        if (fewer.empty() || cost(fewer) >= cost(bodies)) break;
        bodies = std::move(fewer);
      }
      if (best.empty() || cost(bodies) < cost(best)) best = bodies;
      candidates_.insert(candidates_.end(), bodies.begin(), bodies.end());
    }
    if (!best.empty() && !free_points(best).empty()) best = completed(std::move(best), most);
    if (best.size() <= most && !best.empty()) return best;
    if (most == kAny)
      throw Error(ErrorCode::LimitReached,
                  "no capsules or boxes were found that hold all triangles within epsilon; allow a "
                  "larger one");
    return {};
  }

  static double cost(const std::vector<SimpleBody>& bodies) {
    return std::accumulate(bodies.begin(), bodies.end(), 0.0,
                           [](double sum, const SimpleBody& b) { return sum + cost_of(b.kind); });
  }

  /// The least ε found with so many bodies.
  std::vector<SimpleBody> within_count(std::size_t count) {
    constexpr double kNear = 1.03;
    constexpr int kTurns = 12;
    double high = 0.6 * box_.diagonal(), low = 0, tried = high;
    std::vector<SimpleBody> best;
    for (int turn = 0; turn < kTurns; ++turn) {
      std::vector<SimpleBody> bodies = cover(tried, count);
      if (!bodies.empty()) {
        best = std::move(bodies);
        high = tried;
      } else {
        low = tried;
      }
      if (best.empty())
        tried *= 2;
      else
        tried = low > 0 ? std::sqrt(low * high) : 0.5 * high;
      if (low > 0 && high < kNear * low) break;
    }
    if (best.empty())
      throw Error(ErrorCode::LimitReached, "no so few capsules or boxes were found");
    set_distance(high);
    return best;
  }

  /// The farthest of some points of the bodies. [length]
  [[nodiscard]] double farthest(const std::vector<SimpleBody>& bodies) const {
    double out = 0;
    const auto look = [&](const Vec3& p) { out = std::max(out, body_->signed_distance(p).lower); };
    for (const SimpleBody& one : bodies) {
      if (one.kind == SimpleBody::Kind::Box) {
        for (const Vec3& p : one.box.corners())
          look(one.box.center + (1 - 1e-6) * (p - one.box.center));
        continue;
      }
      for (const Vec3& end : {one.capsule.from, one.capsule.to})
        if (const std::optional<Vec3> at = body_->boundary_near(end)) {
          const Vec3 along = (*at - end).normalized();
          if (along.allFinite()) look(end + one.capsule.radius * (1 - 1e-12) * along);
        }
    }
    return out;
  }

  const Mesh& mesh_;
  const SimpleBodyOptions& options_;
  SimpleEffort effort_;
  geom::DistanceQuery query_;
  geom::WindingNumber winding_;
  geom::Box3 box_;
  double spacing_ = 0;               ///< of float32 numbers [length]
  double epsilon_ = 0, finest_ = 0;  ///< for all, and the least of a region [length]
  double spare_ = 0;
  std::unique_ptr<RegionalBody> body_;  ///< what bodies may not leave
  std::vector<SurfacePoint> surface_;
  std::vector<SimpleBody> bodies_;  ///< of the last search, before they are rounded
  std::vector<Vec3> points_;        ///< to be held
  std::vector<Vec3> inner_;         ///< of the inside, that are looked at when triangles are held
  std::vector<Eigen::Matrix3d> frames_;
  std::vector<Vec3> directions_;  ///< the axes of all frames
  std::vector<SimpleBody> candidates_;
  std::unordered_set<std::uint64_t> failed_;      ///< what no body was found for (key_of)
  std::unordered_map<std::uint64_t, Held> held_;  ///< by bodies' digests
  /// Digests of the bodies that held each triangle together; empty: none are known.
  std::vector<std::vector<std::uint64_t>> holders_;
  std::vector<CubeTree> cubes_;  ///< that the mesh's box is cut into, for void_points
};

}  // namespace

/// The closed mesh and the options that a search refers to, and the search.
struct SimpleBodySearch::State {
  State(geom::SolidMesh mesh, SimpleBodyOptions asked)
      : closed(std::move(mesh)), options(std::move(asked)) {}

  geom::SolidMesh closed;
  SimpleBodyOptions options;
  bool too_coarse = false;  ///< the spacing of float32 numbers, for epsilon
  std::optional<BodySearch> search;

  template <class Run>
  CoverCandidate run(const Run& run) {
    if (too_coarse) {
      CoverCandidate coarse;
      coarse.stop = Stop::TooCoarse;
      return coarse;
    }
    if (!search) search.emplace(closed.mesh(), options);
    CoverCandidate out = run(*search);
    out.statistics.filled_triangles = closed.filled_triangles();
    return out;
  }
};

SimpleBodySearch::SimpleBodySearch(const geom::SolidMesh& input, const SimpleBodyOptions& options) {
  if (!options.epsilon && !options.max_bodies)
    throw Error(ErrorCode::InvalidArgument, "bodies: epsilon or a number of them is needed");
  if (!options.kinds.capsules && !options.kinds.boxes)
    throw Error(ErrorCode::InvalidArgument, "bodies: capsules or boxes have to be allowed");
  if (options.epsilon && !(*options.epsilon > 0))
    throw Error(ErrorCode::InvalidArgument, "epsilon must be positive");
  if (options.max_bodies && *options.max_bodies == 0)
    throw Error(ErrorCode::InvalidArgument, "there must be a body at least");
  if (options.max_bodies && !options.regions.empty())
    throw Error(ErrorCode::InvalidArgument, "regions do not go with a limit on the bodies");
  state_ = std::make_unique<State>(geom::close_holes(input), options);
  const geom::Box3 box = geom::bounding_box(state_->closed.mesh());
  const double largest = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  state_->too_coarse =
      options.epsilon && geom::float32_spacing(largest) > 0.01 * *finest_epsilon(options);
  if (options.epsilon) state_->options.epsilon = std::min(*options.epsilon, 0.6 * box.diagonal());
}

SimpleBodySearch::SimpleBodySearch(SimpleBodySearch&&) noexcept = default;
SimpleBodySearch& SimpleBodySearch::operator=(SimpleBodySearch&&) noexcept = default;
SimpleBodySearch::~SimpleBodySearch() = default;

CoverCandidate SimpleBodySearch::find() {
  return state_->run([](BodySearch& search) { return search.find(); });
}

CoverCandidate SimpleBodySearch::hold(std::span<const geom::Vec3> points) {
  return state_->run([&](BodySearch& search) { return search.hold(points); });
}

}  // namespace kaboum::bcd
