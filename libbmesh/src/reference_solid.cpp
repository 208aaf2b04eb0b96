// Whether a tetrahedron, or what a step takes away, lies in the solid of the original: exact.
// docs/algorithms/bounding-mesh.md.

#include "reference_solid.h"

#include <kaboum/base/processor.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>

namespace kaboum::bmesh {
namespace {

using geom::Sign;

/// A part of an edge that is certainly cut off, as a share of it, far above what rounding makes of
/// none: a quick test before the exact one.
constexpr double kCertainPart = 1e-6;
/// Cosine of normals that look against each other: such stars are thin, and costly to test.
constexpr double kOpposedCosine = -0.9;

/// The seven corners: 0 to 3 of the tetrahedron, 4 to 6 of the triangle.
class Separation {
 public:
  Separation(const Tetrahedron& tetrahedron, const std::array<Vec3, 3>& triangle,
             std::uint64_t* exact_calls)
      : exact_calls_(exact_calls) {
    for (std::size_t i = 0; i < 4; ++i) corner_[i] = &tetrahedron[i];
    for (std::size_t i = 0; i < 3; ++i) corner_[4 + i] = &triangle[i];
    orientation_ = static_cast<int>(geom::orient3d(tetrahedron[0], tetrahedron[1], tetrahedron[2],
                                                   tetrahedron[3], exact_calls_));
  }

  /// Whether some plane has the tetrahedron and the triangle on its two closed sides. If there is
  /// one, there is one through three of the seven corners.
  bool exists() {
    // The tetrahedron's faces first: they decide most cases.
    for (int k = 0; k < 4; ++k)
      if (beyond_face(k)) return true;
    if (separates(4, 5, 6)) return true;
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j)
        for (int t = 4; t < 7; ++t)
          if (separates(i, j, t)) return true;
    for (int i = 0; i < 4; ++i)
      for (int t = 4; t < 7; ++t)
        if (separates(i, t, t == 6 ? 4 : t + 1)) return true;
    return false;
  }

 private:
  /// The triangle is on the outer side of, or on, the face across from corner k.
  bool beyond_face(int k) {
    // With k at the end, an even permutation of the corners for odd k, an odd one for even k.
    const Vec3 &a = *corner_[(k + 1) % 4], &b = *corner_[(k + 2) % 4], &c = *corner_[(k + 3) % 4];
    const int interior = k % 2 == 1 ? orientation_ : -orientation_;
    for (int i = 4; i < 7; ++i)
      if (static_cast<int>(geom::orient3d(a, b, c, *corner_[i], exact_calls_)) == interior)
        return false;
    return true;
  }

  /// The plane through three corners; a plane that holds all of the tetrahedron is none (the three
  /// corners are then on a line).
  bool separates(int a, int b, int c) {
    int tetrahedron = 0;  // the side its corners are on
    int triangle = 0;
    for (int i = 0; i < 7; ++i) {
      if (i == a || i == b || i == c) continue;
      const int s = static_cast<int>(
          geom::orient3d(*corner_[a], *corner_[b], *corner_[c], *corner_[i], exact_calls_));
      if (s == 0) continue;
      int& side = i < 4 ? tetrahedron : triangle;
      int& other = i < 4 ? triangle : tetrahedron;
      if (side == -s || other == s) return false;
      side = s;
    }
    return tetrahedron != 0;
  }

  std::array<const Vec3*, 7> corner_;
  int orientation_;  // of the tetrahedron
  std::uint64_t* exact_calls_;
};

using detail::Double4;
using detail::FourCorners;
using detail::FourVectors;
using Long4 = std::int64_t __attribute__((vector_size(32)));

/// Bit i: whether the i-th is true.
[[gnu::always_inline]] inline unsigned bits(const Long4& of) {
  return static_cast<unsigned>((of[0] & 1) | (of[1] & 2) | (of[2] & 4) | (of[3] & 8));
}

/// Raises sizes to those of the numbers, where these are larger.
[[gnu::always_inline]] inline void grow(Double4& size, const Double4& x) {
  const Double4 length = x < 0 ? -x : x;
  size = size < length ? length : size;
}

/// Where a triangle is with regard to a tetrahedron's faces, in rounded arithmetic with room for
/// its errors: quick, and decides nearly all cases.
class Faces {
 public:
  explicit Faces(const Tetrahedron& tetrahedron) : corner_(tetrahedron) {
    // The faces across from corners 0 to 2 pass through corner 3, from which all is measured.
    constexpr std::array<std::array<int, 3>, 4> kFace{{{3, 2, 1}, {3, 2, 0}, {3, 1, 0}, {0, 1, 2}}};
    for (int k = 0; k < 4; ++k) {
      const Vec3& a = tetrahedron[kFace[k][0]];
      const Vec3 u = tetrahedron[kFace[k][1]] - a, v = tetrahedron[kFace[k][2]] - a,
                 w = tetrahedron[k] - a;
      Face& f = face_[k];
      f.normal = u.cross(v);
      f.error = kError * u.lpNorm<Eigen::Infinity>() * v.lpNorm<Eigen::Infinity>();
      const double height = f.normal.dot(w);
      certain_ = certain_ && std::abs(height) > f.error * w.lpNorm<Eigen::Infinity>() &&
                 f.error > kUnderflow;
      if (height > 0) f.normal = -f.normal;
      const Vec3 shift = a - tetrahedron[3];
      f.offset = f.normal.dot(shift);
      f.size = shift.lpNorm<Eigen::Infinity>();
    }
  }

  /// Whether all of the box is certainly beyond one of the faces: so is any triangle in it then.
  [[nodiscard]] bool beyond(const geom::Box3& box) const {
    if (!certain_) return false;
    const Vec3 low = box.min - corner_[3], high = box.max - corner_[3];
    const Vec3 middle = 0.5 * (low + high), half = 0.5 * (high - low);
    const double size = low.cwiseAbs().cwiseMax(high.cwiseAbs()).maxCoeff();
    for (const Face& f : face_) {
      const double least = f.normal.dot(middle) - f.normal.cwiseAbs().dot(half) - f.offset;
      const double error = 2 * f.error * (size + f.size);
      if (error > kLeastError && least > error) return true;
    }
    return false;
  }

  /// The same of four triangles at once, each by itself and by one of the faces, or apart by its
  /// own plane: a bit for each of which it is not certain.
  [[nodiscard, gnu::always_inline]] unsigned not_beyond(const FourCorners& of) const {
    if (!certain_) return of.all;
    FourVectors x[3];
    Double4 size{};
    for (int i = 0; i < 3; ++i)
      for (int k = 0; k < 3; ++k) {
        x[i].of[k] = of.corner[i].of[k] - corner_[3][k];
        grow(size, x[i].of[k]);
      }
    Long4 beyond{};
    for (const Face& f : face_) {
      const Double4 error = f.error * (size + f.size);
      Long4 above = error > kLeastError;
      for (const auto& [p] : x)
        above &=
            (f.normal.x() * p[0] + f.normal.y() * p[1] + f.normal.z() * p[2] - f.offset) > error;
      beyond |= above;
    }
    const unsigned left = of.all & ~bits(beyond);
    if (left == 0) return 0;
    Long4 apart;
    apart_by_plane(x, size, apart);
    return left & ~bits(apart);
  }

  enum class Place {
    Beyond,  ///< one of the faces, all of the triangle
    Within,  ///< some of it, and so is the answer if that is wrong by rounding
    Undecided,
  };

  [[nodiscard]] Place of(const std::array<Vec3, 3>& triangle) const {
    if (!certain_) return Place::Undecided;
    std::array<std::array<double, 3>, 4> height;
    std::array<double, 4> error;
    std::array<Vec3, 3> x;
    double size = 0;
    for (int i = 0; i < 3; ++i) {
      x[i] = triangle[i] - corner_[3];
      size = std::max(size, x[i].lpNorm<Eigen::Infinity>());
    }
    for (int k = 0; k < 4; ++k) {
      const Face& f = face_[k];
      for (int i = 0; i < 3; ++i) height[k][i] = f.normal.dot(x[i]) - f.offset;
      error[k] = f.error * (size + f.size);
      if (!(error[k] > kLeastError)) return Place::Undecided;
      if (height[k][0] > error[k] && height[k][1] > error[k] && height[k][2] > error[k])
        return Place::Beyond;
    }
    if (pierces(height, error)) return Place::Within;
    return apart(triangle) ? Place::Beyond : Place::Undecided;
  }

 private:
  /// Of n·x with n = u × v, relative to |u|·|v|·|x| in the maximum norm: six products of three
  /// rounded differences, each rounded five times more at most, with room to spare.
  static constexpr double kError = 100 * 0x1p-53;
  /// Of the difference of two heights: rounded differences, three products and two sums of either,
  /// with room to spare.
  static constexpr double kApart = 32 * 0x1p-53;
  static constexpr double kUnderflow = 1e-200;
  static constexpr double kLeastError = 1e-290;  // products below may have underflowed

  /// Whether a part of an edge, or of the line from corner 0 to the opposite edge's middle, is
  /// clearly within all faces.
  static bool pierces(const std::array<std::array<double, 3>, 4>& height,
                      const std::array<double, 4>& error) {
    std::array<double, 4> from{0, 0, 0, 0}, to{1, 1, 1, 1};
    for (int k = 0; k < 4; ++k) {
      const std::array<double, 4> h{height[k][0], height[k][1], height[k][2],
                                    0.5 * (height[k][1] + height[k][2])};
      constexpr std::array<int, 4> kFirst{0, 1, 2, 0}, kSecond{1, 2, 0, 3};
      for (int e = 0; e < 4; ++e) {
        const double start = h[kFirst[e]] + 2 * error[k];
        const double d = h[kSecond[e]] + 2 * error[k] - start;
        if (d > 0)
          to[e] = std::min(to[e], -start / d);
        else if (d < 0)
          from[e] = std::max(from[e], -start / d);
        else if (start >= 0)
          to[e] = -1;
      }
    }
    for (int e = 0; e < 4; ++e)
      if (to[e] - from[e] > kCertainPart) return true;
    return false;
  }

  /// Whether the triangle's plane, or one along an edge of each, certainly has the two on its two
  /// sides. Any double direction will do; that it is rounded itself does not matter.
  [[nodiscard]] bool apart(const std::array<Vec3, 3>& triangle) const {
    std::array<Vec3, 7> x;
    double size = 0;
    for (int i = 0; i < 7; ++i) {
      x[i] = (i < 4 ? corner_[i] : triangle[i - 4]) - corner_[0];
      size = std::max({size, std::abs(x[i].x()), std::abs(x[i].y()), std::abs(x[i].z())});
    }
    const auto separates = [&](const Vec3& n) {
      std::array<double, 7> h;
      for (int i = 0; i < 7; ++i) h[i] = n.dot(x[i]);
      const double above = std::min({h[0], h[1], h[2], h[3]}) - std::max({h[4], h[5], h[6]});
      const double below = std::min({h[4], h[5], h[6]}) - std::max({h[0], h[1], h[2], h[3]});
      const double error = kApart * n.lpNorm<1>() * size;
      return error > kLeastError && std::max(above, below) > error;
    };
    // What has a corner in common touches, and is not certainly apart.
    for (int i = 0; i < 4; ++i)
      for (int k = 4; k < 7; ++k)
        if (x[i].x() == x[k].x() && x[i] == x[k]) return false;
    std::array<Vec3, 3> edge;
    for (int i = 0; i < 3; ++i) edge[i] = x[4 + (i + 1) % 3] - x[4 + i];
    if (separates(edge[0].cross(edge[1]))) return true;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j)
        for (const Vec3& e : edge)
          if (separates(e.cross(x[i] - x[j]))) return true;
    return false;
  }

  /// The same by the triangles' own planes alone, of four.
  /// @param x  their corners, from corner 3.
  /// @param size  the largest of their coordinates; receives that of the tetrahedron's, too.
  /// @param apart  receives for which it is certain.
  [[gnu::always_inline]] void apart_by_plane(const FourVectors (&x)[3], Double4& size,
                                             Long4& apart) const {
    FourVectors u, v, n;
    for (int k = 0; k < 3; ++k) {
      u.of[k] = x[1].of[k] - x[0].of[k];
      v.of[k] = x[2].of[k] - x[0].of[k];
    }
    for (int k = 0; k < 3; ++k)
      n.of[k] = u.of[(k + 1) % 3] * v.of[(k + 2) % 3] - u.of[(k + 2) % 3] * v.of[(k + 1) % 3];
    // Of the triangle's corners, and of the tetrahedron's, of which corner 3 is at height 0.
    Double4 low{}, high{}, least{}, most{}, longest{};
    for (int i = 0; i < 3; ++i) {
      const Double4 h = n.of[0] * x[i].of[0] + n.of[1] * x[i].of[1] + n.of[2] * x[i].of[2];
      low = i == 0 || h < low ? h : low;
      high = i == 0 || h > high ? h : high;
      Double4 height{};
      for (int k = 0; k < 3; ++k) {
        const double from = corner_[i][k] - corner_[3][k];
        height += n.of[k] * from;
        grow(size, Double4{from, from, from, from});
      }
      least = height < least ? height : least;
      most = height > most ? height : most;
    }
    for (int k = 0; k < 3; ++k) longest += n.of[k] < 0 ? -n.of[k] : n.of[k];
    const Double4 error = kApart * longest * size;
    apart = (error > kLeastError) & ((least - high > error) | (low - most > error));
  }

  struct Face {
    Vec3 normal;    // outwards
    double error;   // of heights, per length
    double offset;  // of the plane from corner 3, along the normal
    double size;    // of the way there, in the maximum norm
  };
  const Tetrahedron& corner_;
  std::array<Face, 4> face_;
  bool certain_ = true;  // that the normals point outwards
};

}  // namespace

bool meets_interior(const Tetrahedron& tetrahedron, const std::array<Vec3, 3>& triangle,
                    std::uint64_t* exact_calls) {
  return !Separation(tetrahedron, triangle, exact_calls).exists();
}

bool same_orientation(const std::array<Vec3, 3>& a, const std::array<Vec3, 3>& b,
                      std::uint64_t* exact_calls) {
  // Seen from any point off the plane; one of three is off it, the one along the normal's largest
  // component most probably: planes are often parallel to axes, and zeros are dear.
  double size = 0;
  for (const Vec3& p : a) size = std::max(size, (p - a[0]).lpNorm<Eigen::Infinity>());
  int first = 0;
  (a[1] - a[0]).cross(a[2] - a[0]).cwiseAbs().maxCoeff(&first);
  for (int i = 0; i < 3; ++i) {
    const int k = (first + i) % 3;
    Vec3 eye = a[0];
    eye[k] += size;
    const Sign s = geom::orient3d(a[0], a[1], a[2], eye, exact_calls);
    if (s == Sign::Zero) continue;
    return geom::orient3d(b[0], b[1], b[2], eye, exact_calls) == s;
  }
  return false;
}

bool opposed(std::span<const Vec3> normals) {
  for (std::size_t i = 0; i < normals.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      if (normals[i].dot(normals[j]) < kOpposedCosine) return true;
  return false;
}

namespace {

/// About the nanoseconds that a box, four triangles at once, a triangle, one that rounded
/// arithmetic does not decide, and a winding number take.
constexpr std::uint64_t kBox = 20, kFour = 40, kTriangle = 200, kExact = 4000, kWinding = 1000,
                        kCrossing = 1000;

/// Which triangles of the original meet a tetrahedron's interior, one after the other.
class Meeting {
 public:
  Meeting(const geom::Mesh& original, const Tetrahedron& tetrahedron,
          std::vector<std::uint32_t>* met)
      : original_(original), tetrahedron_(tetrahedron), faces_(tetrahedron), met_(met) {
    for (const Vec3& p : tetrahedron) box_.extend(p);
    if (met != nullptr) met->clear();
  }

  /// Boxes that only touch the open one do not overlap.
  [[nodiscard]] bool overlaps(const geom::Box3& b) const {
    return (b.min.array() < box_.max.array()).all() && (b.max.array() > box_.min.array()).all();
  }
  [[nodiscard]] bool may_meet(const geom::Box3& b) {
    steps_ += kBox;
    return !enough_ && overlaps(b) && !faces_.beyond(b);
  }

  void look_at(std::uint32_t t) {
    if (enough_) return;
    const geom::Triangle& tri = original_.triangles[t];
    const std::array<Vec3, 3> corners{original_.vertices[tri[0]], original_.vertices[tri[1]],
                                      original_.vertices[tri[2]]};
    geom::Box3 own;
    for (const Vec3& p : corners) own.extend(p);
    steps_ += kBox;
    if (overlaps(own)) decide(t, corners);
  }

  /// The same, of four triangles at once.
  [[gnu::always_inline]] void look_at(const FourCorners& four) {
    steps_ += kBox;
    Long4 apart{};
    for (int k = 0; k < 3; ++k)
      apart |= (four.low.of[k] >= box_.max[k]) | (four.high.of[k] <= box_.min[k]);
    if ((bits(apart) & four.all) == four.all) return;
    steps_ += kFour;
    for (unsigned left = faces_.not_beyond(four) & ~bits(apart); left != 0 && !enough_;
         left &= left - 1) {
      const auto i = static_cast<std::size_t>(std::countr_zero(left));
      std::array<Vec3, 3> corners;
      for (std::size_t c = 0; c < 3; ++c)
        corners[c] = {four.corner[c].of[0][i], four.corner[c].of[1][i], four.corner[c].of[2][i]};
      decide(four.triangle[i], corners);
    }
  }

  [[nodiscard]] bool enough() const { return enough_; }
  /// Nothing that has been looked at meets the interior.
  [[nodiscard]] bool clear() const { return clear_; }
  [[nodiscard]] std::uint64_t steps() const { return steps_; }

 private:
  void decide(std::uint32_t t, const std::array<Vec3, 3>& corners) {
    steps_ += kTriangle;
    // Where a step would be taken, the answer is never that of rounded arithmetic: what is beyond a
    // face is so for certain, and what seems to be within only makes the step fail.
    const Faces::Place place = faces_.of(corners);
    if (place == Faces::Place::Undecided) steps_ += kExact;
    if (place == Faces::Place::Beyond ||
        (place == Faces::Place::Undecided && !meets_interior(tetrahedron_, corners)))
      return;
    clear_ = false;
    if (met_ != nullptr) met_->push_back(t);
    enough_ = met_ == nullptr || met_->size() == ReferenceSolid::kMostMet;
  }

  const geom::Mesh& original_;
  const Tetrahedron& tetrahedron_;
  geom::Box3 box_;
  Faces faces_;
  std::vector<std::uint32_t>* met_;
  bool clear_ = true, enough_ = false;
  std::uint64_t steps_ = 0;
};

/// Looks at all groups until the answer is known.
[[gnu::always_inline]] inline void look_at_all(std::span<const FourCorners> groups,
                                               Meeting& meeting) {
  for (const FourCorners& four : groups) {
    if (meeting.enough()) return;
    meeting.look_at(four);
  }
}

#ifdef KABOUM_AVX2
[[gnu::target("avx2")]] void look_at_all_avx2(std::span<const FourCorners> groups,
                                              Meeting& meeting) {
  look_at_all(groups, meeting);
}
#endif

}  // namespace

ReferenceSolid::ReferenceSolid(const geom::Mesh& original,
                               std::shared_ptr<const geom::Bvh> hierarchy, Work* work)
    : original_(original),
      bvh_(hierarchy ? std::move(hierarchy) : std::make_shared<const geom::Bvh>(original)),
      winding_(original, bvh_),
      work_(work) {}

bool ReferenceSolid::contains(const Tetrahedron& tetrahedron, bool inside,
                              std::vector<std::uint32_t>* met) const {
  Meeting meeting(original_, tetrahedron, met);
  bvh_->traverse([&](const geom::Box3& b) { return meeting.may_meet(b); },
                 [&](std::uint32_t t) { meeting.look_at(t); });
  count(work_, meeting.steps());
  return meeting.clear() && is_middle_in(tetrahedron, inside);
}

void ReferenceSolid::look_around(const geom::Box3& box, Surroundings& around) const {
  around.box_ = box;
  around.groups_.clear();
  std::uint64_t steps = 0;
  const auto meets = [&](const geom::Box3& b) {
    return (b.min.array() <= box.max.array()).all() && (b.max.array() >= box.min.array()).all();
  };
  const auto put = [&](std::uint32_t t) {
    const geom::Triangle& tri = original_.triangles[t];
    geom::Box3 own;
    for (const std::uint32_t v : tri) own.extend(original_.vertices[v]);
    if (!meets(own)) return;
    if (around.groups_.empty() || around.groups_.back().all == 15) around.groups_.push_back({});
    FourCorners& to = around.groups_.back();
    const auto i = static_cast<std::size_t>(std::popcount(to.all));
    to.all |= 1U << i;
    to.triangle[i] = t;
    for (int k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 3; ++c) to.corner[c].of[k][i] = original_.vertices[tri[c]][k];
      to.low.of[k][i] = own.min[k];
      to.high.of[k][i] = own.max[k];
    }
  };
  bvh_->traverse(
      [&](const geom::Box3& b) {
        steps += kBox;
        return meets(b);
      },
      [&](std::uint32_t t) {
        steps += kBox;
        put(t);
      });
  count(work_, steps);
}

bool ReferenceSolid::contains(const Tetrahedron& tetrahedron, bool inside,
                              std::vector<std::uint32_t>* met, const Surroundings& around) const {
  Meeting meeting(original_, tetrahedron, met);
#ifdef KABOUM_AVX2
  if (has_avx2())
    look_at_all_avx2(around.groups_, meeting);
  else
#endif
    look_at_all(around.groups_, meeting);
  count(work_, meeting.steps());
  return meeting.clear() && is_middle_in(tetrahedron, inside);
}

/// Whether one point of the interior has the winding number that is wanted: it speaks for all of
/// it, where the surface does not meet it.
bool ReferenceSolid::is_middle_in(const Tetrahedron& tetrahedron, bool inside) const {
  const Vec3 middle =
      0.25 * (tetrahedron[0] + tetrahedron[1]) + 0.25 * (tetrahedron[2] + tetrahedron[3]);
  for (int k = 0; k < 4; ++k) {
    const Vec3 &a = tetrahedron[(k + 1) % 4], &b = tetrahedron[(k + 2) % 4],
               &c = tetrahedron[(k + 3) % 4];
    const Sign own = geom::orient3d(a, b, c, tetrahedron[k]);
    if (own == Sign::Zero || geom::orient3d(a, b, c, middle) != own) return false;
  }
  int w = 0;
  std::uint64_t crossed = 0;
  bool touches = false;
  winding_.crossings(middle, [&](std::uint32_t, int sign) {
    ++crossed;
    w += sign;
    touches = touches || sign == 0;
  });
  count(work_, kWinding + kCrossing * crossed);
  return !touches && (inside ? w >= 1 : w <= 0);
}

}  // namespace kaboum::bmesh
