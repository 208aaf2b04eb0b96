// Whether a tetrahedron, or what a step takes away, lies in the solid of the original: exact.
// docs/algorithms/bounding-mesh.md.

#include "reference_solid.h"

#include <algorithm>
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
      // Of either height: rounded differences, three products and two sums, with room to spare.
      const double error = 32 * 0x1p-53 * n.lpNorm<1>() * size;
      return error > kLeastError && std::max(above, below) > error;
    };
    std::array<Vec3, 3> edge;
    for (int i = 0; i < 3; ++i) edge[i] = x[4 + (i + 1) % 3] - x[4 + i];
    if (separates(edge[0].cross(edge[1]))) return true;
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j)
        for (const Vec3& e : edge)
          if (separates(e.cross(x[i] - x[j]))) return true;
    return false;
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

/// About the nanoseconds that a box, a triangle, one that rounded arithmetic does not decide, and a
/// winding number take.
constexpr std::uint64_t kBox = 20, kTriangle = 200, kExact = 4000, kWinding = 1000,
                        kCrossing = 1000;

}  // namespace

ReferenceSolid::ReferenceSolid(const geom::Mesh& original,
                               std::shared_ptr<const geom::Bvh> hierarchy, Work* work)
    : original_(original),
      bvh_(hierarchy ? std::move(hierarchy) : std::make_shared<const geom::Bvh>(original)),
      winding_(original, bvh_),
      work_(work) {}

bool ReferenceSolid::contains(const Tetrahedron& tetrahedron, bool inside,
                              std::vector<std::uint32_t>* met) const {
  geom::Box3 box;
  for (const Vec3& p : tetrahedron) box.extend(p);
  bool clear = true, enough = false;
  if (met != nullptr) met->clear();
  // Boxes that only touch the open one are left out.
  const Faces faces(tetrahedron);
  const auto overlaps = [&](const geom::Box3& b) {
    return (b.min.array() < box.max.array()).all() && (b.max.array() > box.min.array()).all();
  };
  std::uint64_t steps = 0;
  const auto may_meet = [&](const geom::Box3& b) {
    steps += kBox;
    return !enough && overlaps(b) && !faces.beyond(b);
  };
  bvh_->traverse(may_meet, [&](std::uint32_t t) {
    if (enough) return;
    const geom::Triangle& tri = original_.triangles[t];
    const std::array<Vec3, 3> corners{original_.vertices[tri[0]], original_.vertices[tri[1]],
                                      original_.vertices[tri[2]]};
    geom::Box3 own;
    for (const Vec3& p : corners) own.extend(p);
    steps += kBox;
    if (!overlaps(own)) return;
    steps += kTriangle;
    // Where a step would be taken, the answer is never that of rounded arithmetic: what is beyond a
    // face is so for certain, and what seems to be within only makes the step fail.
    const Faces::Place place = faces.of(corners);
    if (place == Faces::Place::Undecided) steps += kExact;
    if (place == Faces::Place::Beyond ||
        (place == Faces::Place::Undecided && !meets_interior(tetrahedron, corners)))
      return;
    clear = false;
    if (met != nullptr) met->push_back(t);
    enough = met == nullptr || met->size() == kMostMet;
  });
  count(work_, steps);
  if (!clear) return false;
  // One point of the interior speaks for all of it, for the surface does not meet it.
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
