// What bodies leave of a box: no point is lost that is outside all of them, or inside by less than
// rounding, and little else is left.
#include "complement_of_union.h"

#include <gtest/gtest.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/geom/predicates.h>
#include <kaboum/verify/cover.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <random>
#include <utility>
#include <vector>

#include "nearest.h"

namespace {

using namespace kaboum;          // NOLINT: a test
using namespace kaboum::verify;  // NOLINT: a test
using geom::Mesh;
using Parts = std::vector<verify::Tetrahedron>;

class Directions {
 public:
  explicit Directions(std::uint64_t seed) : engine_(seed) {}
  /// Of [0, 1).
  double part() { return std::uniform_real_distribution<double>(0, 1)(engine_); }
  /// Of [−1, 1).
  double sign() { return 2 * part() - 1; }
  std::size_t below(std::size_t n) {
    return std::uniform_int_distribution<std::size_t>(0, n - 1)(engine_);
  }
  Vec3 vector() { return Vec3{sign(), sign(), sign()}; }
  Eigen::Quaterniond rotation() {
    const Vec3 axis = vector();
    return Eigen::Quaterniond(sign(), axis.x(), axis.y(), axis.z()).normalized();
  }

 private:
  std::mt19937_64 engine_;
};

Bounds bounds(const Vec3& low, const Vec3& high) {
  return {{low.x(), low.y(), low.z()}, {high.x(), high.y(), high.z()}};
}

/// Hulls of clouds of points, and what they leave of boxes, in the points' unit of length.
class Bodies {
 public:
  explicit Bodies(const std::vector<std::vector<Vec3>>& clouds)
      : set_(hulls(clouds)),
        meshes_(Mesh{}, sum_of(set_)),
        uncovered_(meshes_, set_),
        rounding_(meshes_.length_outside(rounding_of_distances(meshes_.largest_coordinate()))) {}

  [[nodiscard]] const std::vector<geom::ConvexBody>& bodies() const { return set_.bodies; }
  /// What the parts that are left may be off by.
  [[nodiscard]] double rounding() const { return rounding_; }

  /// nullopt: no answer, so the whole box may be left.
  [[nodiscard]] std::optional<Parts> left_of(Bounds box) const {
    for (int k = 0; k < 3; ++k) {
      box.low[k] *= meshes_.scale();
      box.high[k] *= meshes_.scale();
    }
    std::vector<Part> parts;
    if (!uncovered_.parts(box, parts)) return std::nullopt;
    Parts out;
    for (Part& part : parts) {
      for (Vec3& p : part.corners) p = meshes_.point_outside(p);
      out.push_back(part.corners);
    }
    return out;
  }

  /// Whether p is outside all bodies, or moves out of each by less than rounding(); exact.
  [[nodiscard]] bool outside(const Vec3& p) const {
    return std::all_of(bodies().begin(), bodies().end(), [&](const geom::ConvexBody& body) {
      const auto above = [&](const geom::Triangle& t) {
        const Vec3 &a = body.core.vertices[t[0]], &b = body.core.vertices[t[1]],
                   &c = body.core.vertices[t[2]];
        const Vec3 moved = p + 0.9 * rounding() * (b - a).cross(c - a).normalized();
        return geom::orient3d(a, b, c, p) == geom::Sign::Positive ||
               geom::orient3d(a, b, c, moved) == geom::Sign::Positive;
      };
      return std::any_of(body.core.triangles.begin(), body.core.triangles.end(), above);
    });
  }

 private:
  static geom::ConvexSet hulls(const std::vector<std::vector<Vec3>>& clouds) {
    geom::ConvexSet set;
    for (const auto& points : clouds) {
      if (auto hull = geom::convex_hull(points)) set.bodies.push_back({"body", std::move(*hull)});
    }
    return set;
  }

  geom::ConvexSet set_;
  verify::MeshPair meshes_;
  ComplementOfUnion uncovered_;
  double rounding_;
};

/// Whether p is in a tetrahedron, exactly, or within `rounding` of one of its faces.
bool held(const Vec3& p, const verify::Tetrahedron& t, double rounding) {
  const auto low = t[0].cwiseMin(t[1]).cwiseMin(t[2]).cwiseMin(t[3]).eval();
  const auto high = t[0].cwiseMax(t[1]).cwiseMax(t[2]).cwiseMax(t[3]).eval();
  if ((low - p).maxCoeff() > rounding || (p - high).maxCoeff() > rounding) return false;
  bool inside = true;
  for (int k = 0; k < 4; ++k) {
    const Vec3 &a = t[(k + 1) % 4], &b = t[(k + 2) % 4], &c = t[(k + 3) % 4];
    if ((closest_point(p, a, b, c) - p).norm() <= rounding) return true;
    inside = inside && geom::orient3d(a, b, c, p) == geom::orient3d(a, b, c, t[k]);
  }
  return inside;
}

bool held(const Vec3& p, const Parts& parts, double rounding) {
  return std::any_of(parts.begin(), parts.end(),
                     [&](const auto& part) { return held(p, part, rounding); });
}

double volume(const Parts& parts) {
  double sum = 0;
  for (const auto& [a, b, c, d] : parts) sum += std::abs((b - a).cross(c - a).dot(d - a)) / 6;
  return sum;
}

/// Corners of a turned_block, turned about the origin and moved.
std::vector<Vec3> turned_block(const Vec3& low, const Vec3& high,
                               const Eigen::Quaterniond& turn = Eigen::Quaterniond::Identity(),
                               const Vec3& by = Vec3::Zero()) {
  std::vector<Vec3> points;
  for (unsigned i = 0; i < 8; ++i) {
    const Vec3 corner((i & 1U) != 0 ? high.x() : low.x(), (i & 2U) != 0 ? high.y() : low.y(),
                      (i & 4U) != 0 ? high.z() : low.z());
    points.emplace_back(by + turn * corner);
  }
  return points;
}

TEST(ComplementOfUnion, TwoSidesOfAPlaneMakeTheBox) {
  Directions random(1);
  const Bounds box = bounds({-0.5, -0.4, -0.3}, {0.5, 0.6, 0.7});
  for (int i = 0; i < 200; ++i) {
    const Eigen::Quaterniond turn = random.rotation();
    const Vec3 at = 0.4 * random.vector();
    const auto below = Bodies({turned_block({-9, -9, -9}, {9, 9, 0}, turn, at)}).left_of(box);
    const auto above = Bodies({turned_block({-9, -9, 0}, {9, 9, 9}, turn, at)}).left_of(box);
    ASSERT_TRUE(below.has_value() && above.has_value()) << i;
    EXPECT_NEAR(volume(*below) + volume(*above), 1, 1e-10) << i;
  }
}

TEST(ComplementOfUnion, BlocksThatOverlapLeaveNothing) {
  const Bounds box = bounds({0.3, 0.3, 0.3}, {0.7, 0.7, 0.7});
  const auto blocks = [](double overlap) {
    return Bodies(
        {turned_block({0, 0, 0}, {0.5, 1, 1}), turned_block({0.5 - overlap, 0, 0}, {1, 1, 1})});
  };
  for (const double overlap : {0.1, 1e-7, 1e-12}) {
    const auto parts = blocks(overlap).left_of(box);
    ASSERT_TRUE(parts.has_value()) << overlap;
    EXPECT_TRUE(parts->empty()) << overlap;
  }
  for (const double overlap : {1e-14, 1e-16, 0.0, -1e-16, -1e-14}) {
    const Bodies bodies = blocks(overlap);
    const auto parts = bodies.left_of(box);
    ASSERT_TRUE(parts.has_value()) << overlap;
    EXPECT_TRUE(held({0.5, 0.4, 0.6}, *parts, bodies.rounding())) << overlap;
    for (const auto& part : *parts)
      for (const Vec3& p : part) EXPECT_NEAR(p.x(), 0.5, 4 * bodies.rounding()) << overlap;
  }
}

TEST(ComplementOfUnion, FacetsOfAboutOneDirection) {
  for (const double slope : {0.04, 0.01, 1e-4}) {
    // A roof: z ≤ −slope · |x|.
    std::vector<Vec3> points = turned_block({-9, -9, -9}, {9, 9, -9 * slope});
    points.insert(points.end(), {{0, -9, 0}, {0, 9, 0}});
    const Bodies roof({points});
    const Bounds box = bounds({-1, -1, -2 * slope}, {1, 1, slope});
    const auto parts = roof.left_of(box);
    ASSERT_TRUE(parts.has_value()) << slope;
    for (const double x : {-1.0, -0.5, -1e-3, 0.0, 1e-3, 0.5, 1.0}) {
      const Vec3 on_roof(x, 0.3, -slope * std::abs(x));
      EXPECT_TRUE(held(on_roof, *parts, roof.rounding())) << slope << ' ' << x;
    }
    EXPECT_LT(volume(*parts), 0.99 * 4 * 3 * slope) << "nothing is cut off";
  }
}

TEST(ComplementOfUnion, CornersOfABoxWithinRoundingOfAFacet) {
  Directions random(2);
  for (int i = 0; i < 100; ++i) {
    const Vec3 normal = Vec3(0.3, 0.3, 0.3) + 0.7 * Vec3(random.vector().cwiseAbs());
    const auto turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), normal);
    const Bodies body({turned_block({-1, -1, -1}, {1, 1, 0}, turn)});
    const Vec3 up = normal.normalized();
    // The box's other corners are deep in the body.
    const auto left_at = [&](double depth) {
      const Vec3 corner = turn * Vec3(0.2, 0.1, 0) - depth * up;
      const auto parts = body.left_of(bounds(corner - Vec3::Constant(0.1), corner));
      EXPECT_TRUE(parts.has_value());
      return std::pair(corner, parts.value_or(Parts{}));
    };
    for (const double depth : {-1e-10, -1e-14, -1e-16, 0.0, 1e-16, 1e-14, 0.8 * body.rounding()}) {
      const auto [corner, parts] = left_at(depth);
      EXPECT_TRUE(body.outside(corner)) << i << ' ' << depth;
      EXPECT_TRUE(held(corner, parts, body.rounding())) << i << ' ' << depth;
    }
    EXPECT_TRUE(left_at(8 * body.rounding()).second.empty()) << i;
  }
}

TEST(ComplementOfUnion, NeedleFacetsDoNotCount) {
  // Edges of about one, heights of h: normals from rounded products would be off by up to 1e-16/h,
  // along the needle, and planes so wrong need not meet beyond the needle's tip.
  const Vec3 axis = Vec3(0.48, 0.6, 0.64), tip(0.1, 0.2, 0.15);
  for (const double h : {1e-9, 1e-11, 1e-13}) {
    Directions random(3);
    int tips = 0;
    for (int i = 0; i < 100; ++i) {
      std::vector<Vec3> points{tip};
      for (const double at : {0.3, 0.7, 0.9})
        points.emplace_back(tip + at * axis + h * random.vector());
      const Bodies needle({points});
      if (needle.bodies().empty()) continue;
      ++tips;
      const auto parts =
          needle.left_of(bounds(tip - Vec3::Constant(0.5), tip + Vec3::Constant(0.1)));
      if (!parts) continue;  // nothing counts
      for (const double beyond : {0.01, 0.1, 0.5}) {
        const Vec3 p = tip - beyond * axis;
        EXPECT_TRUE(held(p, *parts, needle.rounding())) << h << ' ' << i << ' ' << beyond;
      }
      EXPECT_NEAR(volume(*parts), 0.6 * 0.6 * 0.6, 1e-12) << h << ' ' << i;
    }
    EXPECT_GE(tips, 90) << h;
  }
}

/// Clouds of points, the hulls of which are bodies.
struct Family {
  const char* name;
  std::vector<std::vector<Vec3>> (*clouds)(Directions&);
};

std::vector<std::vector<Vec3>> cuboids(Directions& random, bool thin) {
  std::vector<std::vector<Vec3>> clouds(1 + random.below(10));
  const Eigen::Quaterniond turn = random.rotation();
  for (auto& points : clouds) {
    const Vec3 middle = 0.7 * random.vector();
    Vec3 size = Vec3::Ones();
    if (thin) size = {1, std::pow(10, -5 * random.part()), std::pow(10, -10 * random.part())};
    points.resize(4 + random.below(30));
    for (Vec3& p : points) p = middle + turn * random.vector().cwiseProduct(size);
  }
  return clouds;
}

/// Side by side; they overlap by as little as 1e-15.
std::vector<std::vector<Vec3>> slabs(Directions& random) {
  std::vector<std::vector<Vec3>> clouds(1 + random.below(10));
  const Eigen::Quaterniond turn = random.rotation();
  const double width = 2.0 / static_cast<double>(clouds.size());
  const double overlap = std::pow(10, -1 - 14 * random.part());
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const double x = -1 + width * static_cast<double>(i);
    clouds[i] = turned_block({x - overlap, -1, -1}, {x + width, 1, 1}, turn);
  }
  return clouds;
}

/// Drums, with facets of about one direction and fans of slivers on both ends.
std::vector<std::vector<Vec3>> drums(Directions& random) {
  std::vector<std::vector<Vec3>> clouds(1 + random.below(10));
  const Eigen::Quaterniond turn = random.rotation();
  for (auto& points : clouds) {
    const Vec3 middle = 0.2 * random.vector();
    const std::size_t n = 4 + random.below(30);
    for (std::size_t i = 0; i < n; ++i) {
      const double angle = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
      const Vec3 p{std::cos(angle) * (1 + 1e-3 * random.sign()), std::sin(angle),
                   (i % 2 == 0 ? -0.3 : 0.3) + 1e-4 * random.sign()};
      points.emplace_back(turn * (p + middle));
    }
  }
  return clouds;
}

/// Blocks with more points on their edges, as rounding places them: facets as thin as that.
std::vector<Vec3> edged_block(const Vec3& low, const Vec3& high, const Eigen::Quaterniond& turn,
                              Directions& random) {
  std::vector<Vec3> points = turned_block(low, high, turn);
  for (unsigned i = 0; i < 8; ++i) {
    for (unsigned k = 0; k < 3; ++k) {
      if ((i >> k & 1U) != 0) continue;
      const Vec3 a = points[i], b = points[i | 1U << k];
      for (int j = 0; j < 4; ++j) {
        const double t = random.part();
        points.emplace_back((1 - t) * a + t * b);
      }
    }
  }
  return points;
}

std::vector<std::vector<Vec3>> edged_blocks(Directions& random) {
  std::vector<std::vector<Vec3>> clouds(1 + random.below(6));
  const Eigen::Quaterniond turn = random.rotation();
  const double width = 2.0 / static_cast<double>(clouds.size());
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const double x = -1 + width * static_cast<double>(i);
    clouds[i] = edged_block({x - 1e-7 * random.part(), -1, -1}, {x + width, 1, 1}, turn, random);
  }
  return clouds;
}

const std::array<Family, 5> kFamilies{{{"cuboids", [](Directions& r) { return cuboids(r, false); }},
                                       {"needles", [](Directions& r) { return cuboids(r, true); }},
                                       {"slabs", slabs},
                                       {"drums", drums},
                                       {"edged blocks", edged_blocks}}};

TEST(ComplementOfUnion, SliversCount) {
  Directions random(4);
  std::size_t slivers = 0;
  for (int i = 0; i < 100; ++i) {
    const Eigen::Quaterniond turn = random.rotation();
    const Vec3 middle = turn * Vec3(0.5, 0.4, 0.6), half = Vec3::Constant(0.1);
    const auto left = [&](double overlap) {
      const Bodies bodies({edged_block({0, 0, 0}, {0.5, 1, 1}, turn, random),
                           edged_block({0.5 - overlap, 0, 0}, {1, 1, 1}, turn, random)});
      for (const geom::ConvexBody& body : bodies.bodies()) {
        for (const auto& [u, v, w] : body.core.triangles) {
          const Vec3 a = body.core.vertices[u], b = body.core.vertices[v] - a,
                     c = body.core.vertices[w] - a;
          slivers += b.cross(c).norm() < 1e-14 * b.norm() * c.norm() ? 1U : 0U;
        }
      }
      return bodies.left_of(bounds(middle - half, middle + half));
    };
    const auto none = left(1e-7), slit = left(-1e-7);
    ASSERT_TRUE(none.has_value() && slit.has_value()) << i;
    EXPECT_TRUE(none->empty()) << i;
    EXPECT_FALSE(slit->empty()) << i;
  }
  EXPECT_GE(slivers, 1000U);
}

/// A box about a point of a facet, of any size down to 1e-8.
Bounds box_at_a_facet(const Bodies& bodies, Directions& random) {
  const Mesh& hull = bodies.bodies()[random.below(bodies.bodies().size())].core;
  const geom::Triangle& t = hull.triangles[random.below(hull.triangles.size())];
  const double u = random.part(), v = random.part() * (1 - u);
  const Vec3 middle =
      u * hull.vertices[t[0]] + v * hull.vertices[t[1]] + (1 - u - v) * hull.vertices[t[2]];
  const double size = std::pow(10, -8 * random.part());
  const double flat = random.below(4) == 0 ? 1e-3 : 1;
  const Vec3 down = size * random.vector().cwiseAbs();
  const Vec3 up = size * Vec3(flat, 1, 1).cwiseProduct(random.vector().cwiseAbs());
  return bounds(middle - down, middle + up);
}

/// A point of the box; every second one as near to some facet's plane as the box lets it be.
Vec3 point_of(const Bounds& box, const Bodies& bodies, Directions& random) {
  const Vec3 low(box.low.data()), high(box.high.data());
  const Vec3 p = low + random.vector().cwiseAbs().cwiseProduct(high - low);
  if (random.below(2) == 0) return p;
  const Mesh& hull = bodies.bodies()[random.below(bodies.bodies().size())].core;
  const geom::Triangle& t = hull.triangles[random.below(hull.triangles.size())];
  const Vec3& a = hull.vertices[t[0]];
  const Vec3 normal = (hull.vertices[t[1]] - a).cross(hull.vertices[t[2]] - a).normalized();
  const double above = std::pow(10, -17 + 14 * random.part());
  return (p + (above - normal.dot(p - a)) * normal).cwiseMax(low).cwiseMin(high);
}

TEST(ComplementOfUnion, HoldsWhatIsOutside) {
  std::size_t boxes = 0, answers = 0, empty = 0, points = 0;
  for (const Family& family : kFamilies) {
    for (std::uint64_t seed = 0; seed < 120; ++seed) {
      Directions random(seed);
      auto clouds = family.clouds(random);
      // Every fourth about the origin, the others away from it, by 1e-3 to 1e3.
      const double away = seed % 4 == 0 ? 0 : std::pow(10, 3 * random.sign());
      const Vec3 by = away * random.vector();
      for (auto& cloud : clouds)
        for (Vec3& p : cloud) p += by;
      const Bodies bodies(clouds);
      if (bodies.bodies().empty()) continue;
      std::size_t lost = 0;
      for (int i = 0; i < 40; ++i, ++boxes) {
        const Bounds box = box_at_a_facet(bodies, random);
        const auto parts = bodies.left_of(box);
        if (!parts) continue;
        ++answers;
        empty += parts->empty() ? 1 : 0;
        for (int j = 0; j < 80; ++j) {
          const Vec3 p = point_of(box, bodies, random);
          if (!bodies.outside(p)) continue;
          ++points;
          lost += held(p, *parts, bodies.rounding()) ? 0 : 1;
        }
      }
      EXPECT_EQ(lost, 0U) << family.name << ", seed " << seed;
    }
  }
  // Not by giving up or leaving everything.
  EXPECT_GE(answers, boxes * 9 / 10);
  EXPECT_GE(empty, answers / 10);
  EXPECT_GE(points, answers * 20);
}

}  // namespace
