// How long the steps along a path may be, so that no point of a body leaves the hull of its two
// poses by more than the bound. Source: [gaschler2016] Eq. 4.20, 4.22; docs/algorithms/swept-
// volumes.md has the proofs and says what differs.

#include <kaboum/base/error.h>
#include <kaboum/geom/rounding.h>
#include <kaboum/sweep/steps.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace kaboum::sweep {
namespace {

using geom::kUp;

constexpr std::size_t kMostPieces = 1'000'000;

struct Segment {
  LinkMotion motion;
  MotionBounds bounds;
};

Transform combine(const Transform& a, double factor, const Transform& b) {
  return {a.linear + factor * b.linear, a.translation + factor * b.translation};
}

/// A candidate, and roughly the coefficients of its deviation in the stretch's length h.
struct Candidate {
  PathInterval piece;
  std::array<double, 5> power{};  // of h², h³, …, h⁶
  double rounding = 0;
};

/// Guess of the longest stretch that keeps the deviation, from a candidate of length h0.
double predict(const Candidate& c, double h0, double deviation) {
  const double target = deviation - c.rounding;
  if (!(target > 0)) return 0;
  const double ratio = target / (c.piece.deviation - c.rounding);
  if (ratio > 0.5 && ratio < 2) return h0 * std::sqrt(ratio) * (1 - 1e-4);
  double h = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < c.power.size(); ++i)
    if (c.power[i] > 0)
      h = std::min(h, std::pow(target / c.power[i], 1 / static_cast<double>(i + 2)));
  if (!std::isfinite(h)) return h;
  for (int i = 0; i < 8; ++i) {  // Newton, from above, of a convex function
    double f = 0, slope = 0;
    for (std::size_t k = c.power.size(); k-- > 0;) {
      slope = slope * h + static_cast<double>(k + 2) * c.power[k];
      f = f * h + c.power[k];
    }
    h -= (f * h * h - target) / (slope * h);
  }
  return h;
}

class Chooser {
 public:
  Chooser(const Robot& robot, std::uint32_t link, std::span<const Vec3> points, const Path& path,
          const StepOptions& options)
      : points_(points), options_(options) {
    segments_.reserve(std::max<std::size_t>(path.size(), 2) - 1);
    for (std::size_t i = 0; i == 0 || i + 1 < path.size(); ++i) {
      LinkMotion motion(robot, link, path[i], path[std::min(i + 1, path.size() - 1)]);
      MotionBounds bounds(motion, points);
      segments_.push_back({std::move(motion), std::move(bounds)});
    }
  }

  std::vector<PathInterval> run() {
    const bool adaptive =
        options_.rule == StepRule::Adaptive || options_.rule == StepRule::Balanced;
    for (std::size_t i = 0; i < segments_.size();) {
      if (adaptive) {
        i = follow(i);
      } else {
        divide(i);
        ++i;
      }
    }
    return std::move(pieces_);
  }

 private:
  [[nodiscard]] bool allowed(const PathInterval& piece) const {
    return piece.deviation <= options_.deviation &&
           (!options_.max_excess || excess(piece, points_) <= *options_.max_excess);
  }

  void add(const PathInterval& piece) {
    if (pieces_.size() >= kMostPieces)
      throw Error(ErrorCode::LimitReached,
                  "a body needs more than 1000000 steps; allow a larger epsilon");
    pieces_.push_back(piece);
    if (options_.progress) options_.progress(pieces_.size());
  }

  /// Equal steps, as many as the bound of the whole segment asks for.
  void divide(std::size_t i) {
    const Segment& s = segments_[i];
    if (!s.motion.moves()) {
      add(candidate(i, 0, 1, true).piece);
      return;
    }
    const double rounding = errors(s, 1);
    const double room = options_.deviation - rounding;
    double count = 1, deviation = 0;
    if (options_.rule == StepRule::Baginski) {
      const SharedBounds& b = options_.shared.at(i);
      if (b.slide > 0)
        throw Error(ErrorCode::InvalidArgument,
                    "the rule baginski knows revolute joints only, and a prismatic one moves");
      const double step = 2 * std::acos(1 - std::min(1.0, room / b.radius));
      count = std::max(std::ceil(b.turn / std::min(step, std::numbers::pi)), 1.0);
      deviation = b.radius * (1 - std::cos(b.turn / count / 2));
    } else {
      double second = 0;
      if (options_.rule == StepRule::Uniform) {
        const SharedBounds& b = options_.shared.at(i);
        second = (b.radius * b.turn * b.turn + 2 * b.slide * b.turn) * kUp;
      } else if (options_.rule == StepRule::Subset) {
        second = s.bounds.coarse_second_derivative();
      } else {
        second = s.bounds.derivative(2);
      }
      count = std::max(std::ceil(std::sqrt(second / (8 * room)) * kUp), 1.0);
      deviation = second / (8 * count * count) * kUp;
    }
    if (!(room > 0) || count > static_cast<double>(kMostPieces))
      throw Error(ErrorCode::LimitReached,
                  "a body needs more than 1000000 steps; allow a larger epsilon");
    if (options_.max_excess)
      throw Error(ErrorCode::InvalidArgument,
                  "a largest reach needs the step rule adaptive or balanced");
    // Breakpoints are rounded: a step may be longer by 2^-52 than 1 / count.
    deviation = (deviation * (1 + count * 0x1p-50) + rounding) * kUp;
    Transform start = s.motion.at(0);
    for (double k = 1; k <= count; ++k) {
      const double end = k == count ? 1 : k / count;
      const Transform finish = s.motion.at(end);
      add({i, i, (k - 1) / count, end, start, finish, deviation});
      start = finish;
    }
  }

  /// Error of a computed chord or expansion of a stretch of this length.
  static double errors(const Segment& s, double length) {
    // The second term: ends that are rounded, of a stretch that the expansion is central in.
    double sum = s.bounds.error(0) + 0.01 * s.bounds.error(1), power = 1;
    for (int n = 1; n <= LinkMotion::kOrder; ++n) {
      power *= length / n;
      sum += power * s.bounds.error(n);
    }
    return sum * kUp;
  }

  /// How a linear motion deviates from an expansion; docs/algorithms/swept-volumes.md, "Expansion".
  struct Shape {
    double even;   // of w² c₂ + w⁴ c₄, w half the stretch's length
    double third;  // of h³ c₃
    double fifth;  // of h⁵ c₅
    double mixed;  // how far w⁴ c₄ may matter without a term of its own
  };
  static constexpr Shape kChord{1, 1 / (12 * std::numbers::sqrt3), 0.01672, 1};
  static constexpr Shape kNearest{0.5, 1.0 / 32, 1.0 / 96, 2};

  /// Largest deviation over the points of the expansion, without its remainder.
  double largest_deviation(const LinkMotion::Expansion& x, double h, const Shape& shape,
                           std::array<double, 5>& power) const {
    const double w2 = h * h / 4, h3 = h * h * h, h5 = h3 * h * h;
    double most = 0;
    for (const Vec3& p : points_) {
      const Vec3 fourth = w2 * w2 * (x[4] * p);
      const Vec3 even = shape.even * (w2 * (x[2] * p) + fourth);
      const Vec3 odd = shape.third * h3 * (x[3] * p);
      const double together =
          std::sqrt(even.squaredNorm() + odd.squaredNorm() + 2 * std::abs(even.dot(odd)));
      double deviation = together + shape.fifth * h5 * (x[5] * p).norm();
      if (even.squaredNorm() < shape.mixed * shape.even * shape.even * fourth.norm() * together)
        deviation += fourth.norm() / 4;
      if (deviation <= most) continue;
      most = deviation;
      power = {even.norm() / (h * h), odd.norm() / h3, fourth.norm() / (4 * h * h3),
               shape.fifth * (x[5] * p).norm(), 0};
    }
    return most;
  }

  /// The best hull for a stretch of a segment; `chord`: only one whose ends are poses.
  Candidate candidate(std::size_t i, double begin, double end, bool chord) const {
    const Segment& s = segments_[i];
    Candidate c;
    PathInterval& piece = c.piece;
    piece = {i, i, begin, end, {}, {}, 0};
    if (!s.motion.moves()) {
      piece.start = piece.finish = s.motion.at(0);
      c.rounding = piece.deviation = s.bounds.error(0);
      return c;
    }
    const double middle = 0.5 * (begin + end);
    const double h = 2 * std::max(end - middle, middle - begin);
    const LinkMotion::Expansion x = s.motion.expand(middle);
    c.rounding = errors(s, h);
    const double remainder = s.bounds.derivative(6) / 46080 * std::pow(h, 6);
    // Never looser than without the expansion.
    const double plain = (s.bounds.derivative(2) / 8 * h * h + c.rounding) * kUp;
    if (!chord && options_.rule == StepRule::Balanced) {
      const double own = largest_deviation(x, h, kNearest, c.power);
      c.power[4] = remainder / std::pow(h, 6);
      piece.deviation = (own + remainder + c.rounding) * kUp;
      if (piece.deviation <= plain) {
        const double w = h / 2, w2 = w * w;
        const Transform centre = combine(combine(x[0], w2 / 2, x[2]), w2 * w2 / 2, x[4]);
        const Transform slope = combine(combine(x[1], 3 * w2 / 4, x[3]), 2 * w2 * w2 / 3, x[5]);
        piece.start = combine(centre, -w, slope);
        piece.finish = combine(centre, w, slope);
        return c;
      }
    }
    const double own = largest_deviation(x, h, kChord, c.power);
    c.power[4] = remainder / std::pow(h, 6);
    piece.start = s.motion.at(begin);
    piece.finish = s.motion.at(end);
    piece.deviation = std::min((own + remainder + c.rounding) * kUp, plain);
    return c;
  }

  /// Longest allowed stretch from `begin` on in a segment.
  Candidate longest(std::size_t i, double begin) const {
    double h = std::min(1 - begin, guess_), refused = std::numeric_limits<double>::infinity();
    std::optional<Candidate> best;
    for (int round = 0; round < 200; ++round) {
      const double end = begin + h >= 1 - 1e-12 ? 1 : begin + h;
      Candidate c = candidate(i, begin, end, false);
      double next = predict(c, h, options_.deviation);
      if (allowed(c.piece)) {
        best = c;
        if (end == 1 || round > 6 || next < 1.01 * h || next >= refused) return c;
        h = std::min(next, 1 - begin);
      } else {
        if (best) return *best;
        refused = h;
        if (c.piece.deviation <= options_.deviation)  // the excess is too large
          next = h * *options_.max_excess / excess(c.piece, points_);
        h = std::min(next, 0.97 * h);
        if (!(h > 1e-9)) throw NoStepError();
      }
    }
    throw Error(ErrorCode::Internal, "internal error: the search for a step does not end");
  }

  /// Pieces from the start of a segment up to the end of it, or of a later one.
  /// @return the segment that is next.
  std::size_t follow(std::size_t i) {
    guess_ = 1;
    for (double begin = 0;;) {
      const Candidate c = longest(i, begin);
      if (c.piece.end < 1) {
        add(c.piece);
        guess_ = 1.05 * (c.piece.end - begin);
        begin = c.piece.end;
        continue;
      }
      const PathInterval piece = options_.merge ? extend(c.piece) : c.piece;
      add(piece);
      return piece.last_segment + 1;
    }
  }

  /// A piece that ends at a waypoint, made longer by whole segments while that is allowed.
  PathInterval extend(const PathInterval& first) {
    PathInterval best = first;
    std::size_t good = first.last_segment, step = 1;
    // Doubling, then halving.
    while (good + 1 < segments_.size()) {
      const std::size_t last = std::min(good + step, segments_.size() - 1);
      const PathInterval longer = across(first.first_segment, first.begin, last);
      if (allowed(longer)) {
        best = longer;
        good = last;
        step *= 2;
      } else {
        if (step == 1) break;
        step = std::max<std::size_t>(step / 4, 1);
      }
    }
    return best;
  }

  /// One hull for everything from within a segment to the end of a later one.
  PathInterval across(std::size_t i, double begin, std::size_t last) {
    PathInterval piece{
        i, last, begin, 1, segments_[i].motion.at(begin), segments_[last].motion.at(1), 0};
    const double rounding = 2 * segments_[i].bounds.error(0) + 2 * segments_[last].bounds.error(0);
    double before = 0;  // deviation of the waypoint at the segment's start
    for (std::size_t k = i; k <= last; ++k) {
      double after = 0;
      if (k < last)
        after = waypoint_deviation(piece, segments_[k].motion.at(1)) + segments_[k].bounds.error(0);
      const double own = k == i ? candidate(k, begin, 1, true).piece.deviation : whole(k);
      piece.deviation = std::max(piece.deviation, own + std::max(before, after));
      if (piece.deviation > options_.deviation) break;
      before = after;
    }
    piece.deviation = (piece.deviation + rounding) * kUp;
    return piece;
  }

  /// Largest distance of the body at a pose from one place between the piece's ends.
  double waypoint_deviation(const PathInterval& piece, const Transform& pose) const {
    double along = 0, length = 0;
    for (const Vec3& p : points_) {
      const Vec3 a = piece.start * p, way = piece.finish * p - a;
      along += way.dot(pose * p - a);
      length += way.squaredNorm();
    }
    const double t = length > 0 ? std::clamp(along / length, 0.0, 1.0) : 0;
    double most = 0;
    for (const Vec3& p : points_) {
      const Vec3 a = piece.start * p, b = piece.finish * p;
      most = std::max(most, (pose * p - a - t * (b - a)).squaredNorm());
    }
    return std::sqrt(most) * kUp;
  }

  /// Deviation of a whole segment from the chord between its waypoints.
  double whole(std::size_t k) {
    if (whole_.empty()) whole_.assign(segments_.size(), -1);
    if (whole_[k] < 0) whole_[k] = candidate(k, 0, 1, true).piece.deviation;
    return whole_[k];
  }

  std::span<const Vec3> points_;
  const StepOptions& options_;
  std::vector<Segment> segments_;
  std::vector<double> whole_;
  std::vector<PathInterval> pieces_;
  double guess_ = 1;
};

}  // namespace

std::vector<PathInterval> choose_steps(const Robot& robot, std::uint32_t link,
                                       std::span<const Vec3> points, const Path& path,
                                       const StepOptions& options) {
  ensure(!path.empty() && !points.empty(), "steps of an empty path or body");
  return Chooser(robot, link, points, path, options).run();
}

double excess(const PathInterval& piece, std::span<const Vec3> points) {
  const Mat3 change = piece.finish.linear - piece.start.linear;
  std::vector<Vec3> images;
  images.reserve(points.size());
  for (const Vec3& p : points) images.emplace_back(change * p);
  double most = 0;
  for (std::size_t i = 0; i < images.size(); ++i)
    for (std::size_t k = 0; k < i; ++k)
      most = std::max(most, (images[i] - images[k]).squaredNorm());
  // The images' rounding is of the order of the rotations' own, which the deviation covers.
  return (0.25 * std::sqrt(most) + piece.deviation) * kUp;
}

}  // namespace kaboum::sweep
