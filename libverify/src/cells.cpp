// The cells that triangles cut a face into, by one sample on either side of every piece of the
// lines in which they meet it. Every cell but an uncut face touches such a piece, so that neither a
// planar arrangement nor a sorting round points is needed.

#include <kaboum/base/error.h>

#include <algorithm>
#include <utility>

#include "allowance.h"
#include "cell_sample.h"
#include "segments.h"

namespace kaboum::verify {
namespace {

// What things take, in about nanoseconds.
constexpr std::uint64_t kMeeting = 2000, kTest = 10, kPiece = 3000;

constexpr std::size_t kTestsPerPiece = 200;  // of segments against each other, within the limit

class Cutter {
 public:
  Cutter(std::vector<Segment> segments, std::uint32_t face, std::size_t limit)
      : index_(face), limit_(limit), segments_(std::move(segments)) {}

  void visit(const SampleVisitor& visitor) {
    split();
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      if (!sample(i, visitor)) return;
    }
  }

 private:
  [[noreturn]] void fail() const {
    throw Error(ErrorCode::LimitReached, "a triangle is cut into more pieces than allowed");
  }

  /// Finds where segments meet: each one's interior points that lie on another.
  void split() {
    splits_.resize(segments_.size());
    std::vector<std::uint32_t> order(segments_.size());
    for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
      const double a = segments_[i].box[0], b = segments_[j].box[0];
      return a != b ? a < b : i < j;
    });
    std::size_t pieces = segments_.size(), tests = 0;
    for (std::size_t x = 0; x < order.size(); ++x) {
      const std::size_t tests_before = tests;
      const Segment& s = segments_[order[x]];
      for (std::size_t y = x + 1; y < order.size(); ++y) {
        const Segment& t = segments_[order[y]];
        if (t.box[0] > s.box[2]) break;
        if (++tests > kTestsPerPiece * limit_) fail();
        if (t.box[1] > s.box[3] || s.box[1] > t.box[3]) continue;
        meet(order[x], order[y]);
      }
      pieces += splits_[order[x]].size();
      count_steps(kTest * (tests - tests_before) + kMeeting * splits_[order[x]].size());
      if (pieces > limit_) fail();
    }
  }

  void meet(std::uint32_t i, std::uint32_t j) {
    const Segment &s = segments_[i], &t = segments_[j];
    const Sign tp = sign_on(s.approx_line, s.line, t.approx_p, t.p);
    const Sign tq = sign_on(s.approx_line, s.line, t.approx_q, t.q);
    if (tp == tq && tp != Sign::Zero) return;
    const Sign sp = sign_on(t.approx_line, t.line, s.approx_p, s.p);
    const Sign sq = sign_on(t.approx_line, t.line, s.approx_q, s.q);
    if (sp == sq && sp != Sign::Zero) return;
    if (tp == Sign::Zero && tq == Sign::Zero) {  // on one line; ends outside are sorted out later
      splits_[i].push_back(t.p);
      splits_[i].push_back(t.q);
      splits_[j].push_back(s.p);
      splits_[j].push_back(s.q);
      return;
    }
    const bool within_s = sp != Sign::Zero && sq != Sign::Zero;
    const bool within_t = tp != Sign::Zero && tq != Sign::Zero;
    if (!within_s && !within_t) return;  // end to end
    const Triple<Exact> point = !within_s   ? (sp == Sign::Zero ? s.p : s.q)
                                : !within_t ? (tp == Sign::Zero ? t.p : t.q)
                                            : made_positive(cross(s.line, t.line));
    if (within_s) splits_[i].push_back(point);
    if (within_t) splits_[j].push_back(point);
  }

  /// Spots on both sides of every piece of segment i. @return false if the visitor has seen enough
  [[nodiscard]] bool sample(std::size_t i, const SampleVisitor& visitor) const {
    const Segment& s = segments_[i];
    int apex = 0;
    while (sign_of(s.line[apex]) == Sign::Zero) ++apex;
    const int u = (apex + 1) % 3, v = (apex + 2) % 3;
    // Orientation of two points of the line and the corner off it: their order.
    const auto turn = [&](const Triple<Exact>& a, const Triple<Exact>& b) {
      return sign_of(a[u] * b[v] - a[v] * b[u]);
    };
    const Sign forward = turn(s.p, s.q);
    if (forward == Sign::Zero) {
      throw Error(ErrorCode::Internal, "a segment of no length between two triangles");
    }
    std::vector<const Triple<Exact>*> points;
    for (const Triple<Exact>& x : splits_[i]) {
      if (turn(s.p, x) == forward && turn(x, s.q) == forward) points.push_back(&x);
    }
    std::sort(points.begin(), points.end(), [&](const Triple<Exact>* a, const Triple<Exact>* b) {
      return turn(*a, *b) == forward;
    });
    points.push_back(&s.q);
    const Triple<Exact>* last = &s.p;
    CellSample sample;
    sample.face = index_;
    for (const Triple<Exact>* next : points) {
      if (turn(*last, *next) == Sign::Zero) continue;  // the same point twice
      count_steps(kPiece);
      sample.exact = between(*last, *next);
      sample.approx = rounded(sample.exact);
      sample.line = s.line;
      if (!visitor(sample)) return false;
      sample.line = Triple<Exact>{-s.line[0], -s.line[1], -s.line[2]};
      if (!visitor(sample)) return false;
      last = next;
    }
    return true;
  }

  /// A point between two, near the middle.
  static Triple<Exact> between(const Triple<Exact>& a, const Triple<Exact>& b) {
    return combine(Exact(ratio_of(a, b)), a, Exact(1), b);
  }

  std::uint32_t index_;
  std::size_t limit_;
  std::vector<Segment> segments_;
  std::vector<std::vector<Triple<Exact>>> splits_;
};

}  // namespace

CellSample middle_sample(std::uint32_t face) {
  const Approx one{1, 0};
  return {face, {Exact(1), Exact(1), Exact(1)}, {one, one, one}, {}};
}

Vec3 position(const MeshPair& meshes, const CellSample& sample) {
  const Triple<Approx>& w = sample.approx;
  const double total = w[0].value + w[1].value + w[2].value;
  Vec3 p = Vec3::Zero();
  for (int k = 0; k < 3; ++k) p += w[k].value / total * meshes.corner(sample.face, k);
  return p;
}

void visit_samples(const Arrangement& arrangement, std::uint32_t face, OperandMask mask,
                   std::size_t limit, std::span<const std::uint32_t> decided,
                   const SampleVisitor& visitor) {
  if (arrangement.uncut(face, mask)) {
    visitor(middle_sample(face));
    return;
  }
  Cutter cutter(segments_of(arrangement, face, mask, limit, decided), face, limit);
  cutter.visit(visitor);
}

}  // namespace kaboum::verify
