#include "polygon.h"

#include <Eigen/Geometry>
#include <random>
#include <sstream>

#include "io_test.h"

namespace kaboum::io::test {
namespace {

struct Split {
  std::vector<Triangle> triangles;
  bool clean;
};

Split split(const std::vector<Vec3>& polygon) {
  Split result;
  result.clean = PolygonSplitter(1'000'000'000).split(polygon, result.triangles);
  return result;
}

std::vector<Vec3> flat(const std::vector<std::array<double, 2>>& points) {
  std::vector<Vec3> polygon;
  for (const auto& [x, y] : points) polygon.emplace_back(x, y, 0.0);
  return polygon;
}

/// Directed edges of the triangles, by position, minus those of the polygon, are all cancelled.
bool keeps_border(const std::vector<Vec3>& polygon, const std::vector<Triangle>& triangles) {
  std::map<std::array<double, 6>, int> balance;
  const auto add = [&](const Vec3& a, const Vec3& b, int sign) {
    if (a == b) return;
    ++sign;
    balance[{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()}] += sign - 1;
    balance[{b.x(), b.y(), b.z(), a.x(), a.y(), a.z()}] -= sign - 1;
  };
  for (const Triangle& t : triangles)
    for (int k = 0; k < 3; ++k) add(polygon[t[k]], polygon[t[(k + 1) % 3]], 1);
  for (std::size_t i = 0; i < polygon.size(); ++i)
    add(polygon[i], polygon[(i + 1) % polygon.size()], -1);
  return std::ranges::all_of(balance, [](const auto& e) { return e.second == 0; });
}

double doubled_area(const Vec3& a, const Vec3& b, const Vec3& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Border kept, no triangle of negative or zero area, areas add up: an exact cover.
void expect_proper(const std::vector<Vec3>& polygon, int zero_area_allowed = 0) {
  const Split s = split(polygon);
  EXPECT_TRUE(s.clean);
  EXPECT_TRUE(keeps_border(polygon, s.triangles));
  double sum = 0, area = 0;
  int zero = 0;
  for (const Triangle& t : s.triangles) {
    const double a = doubled_area(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
    EXPECT_GE(a, 0);
    zero += a == 0 ? 1 : 0;
    sum += a;
  }
  for (std::size_t i = 1; i + 1 < polygon.size(); ++i)
    area += doubled_area(polygon[0], polygon[i], polygon[i + 1]);
  EXPECT_NEAR(sum, area, 1e-9 * std::abs(area));
  EXPECT_LE(zero, zero_area_allowed);
}

TEST(Polygon, ConvexIsAFan) {
  const Split s = split(flat({{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}}));
  EXPECT_TRUE(s.clean);
  EXPECT_EQ(s.triangles, (std::vector<Triangle>{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Polygon, ConcaveQuadUsesTheInnerDiagonal) {
  for (int start = 0; start < 4; ++start) {
    std::vector<Vec3> dart = flat({{0, 0}, {2, -1}, {0, 3}, {-2, -1}});
    std::rotate(dart.begin(), dart.begin() + start, dart.end());
    expect_proper(dart);
  }
}

TEST(Polygon, ConcaveShapes) {
  const std::vector<std::vector<Vec3>> shapes = {
      flat({{0, 0}, {4, 0}, {4, 1}, {1, 1}, {1, 4}, {0, 4}}),
      flat(
          {{0, 0}, {6, 0}, {6, 4}, {5, 4}, {5, 1}, {4, 4}, {3, 1}, {2, 4}, {1, 1}, {1, 4}, {0, 4}}),
      // a spiral
      flat({{0, 0},
            {9, 0},
            {9, 9},
            {1, 9},
            {1, 3},
            {6, 3},
            {6, 6},
            {4, 6},
            {4, 5},
            {5, 5},
            {5, 4},
            {2, 4},
            {2, 8},
            {8, 8},
            {8, 1},
            {0, 1}})};
  for (std::vector<Vec3> shape : shapes) {
    for (std::size_t start = 0; start < shape.size(); ++start) {
      std::rotate(shape.begin(), shape.begin() + 1, shape.end());
      expect_proper(shape);
    }
  }
}

TEST(Polygon, CollinearCornersGiveNoTriangleWithoutArea) {
  std::vector<Vec3> shape =
      flat({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {3, 1}, {3, 2}, {3, 3}, {2, 2}, {1, 1}});
  for (std::size_t start = 0; start < shape.size(); ++start) {
    std::rotate(shape.begin(), shape.begin() + 1, shape.end());
    expect_proper(shape);
  }
  std::vector<Vec3> quad = flat({{0, 0}, {1, 0}, {2, 0}, {0, 2}});
  for (int start = 0; start < 4; ++start) {
    std::rotate(quad.begin(), quad.begin() + 1, quad.end());
    expect_proper(quad);
  }
}

TEST(Polygon, RepeatedCornersAndSpikesKeepTheBorder) {
  expect_proper(flat({{0, 0}, {0, 0}, {2, 0}, {2, 2}, {2, 2}, {2, 2}, {0, 2}, {0, 0}}));
  expect_proper(flat({{0, 0}, {2, 0}, {2, 2}, {1, 1}, {2, 2}, {0, 2}}), 1);
  EXPECT_TRUE(split(flat({{1, 1}, {1, 1}, {1, 1}, {1, 1}})).triangles.empty());
  EXPECT_TRUE(split(flat({{1, 1}, {2, 2}, {1, 1}, {2, 2}})).triangles.size() <= 2);
}

TEST(Polygon, HoleWithBridge) {
  std::vector<Vec3> keyhole =
      flat({{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}});
  for (std::size_t start = 0; start < keyhole.size(); ++start) {
    std::rotate(keyhole.begin(), keyhole.begin() + 1, keyhole.end());
    expect_proper(keyhole);
  }
}

TEST(Polygon, NotSimpleIsAFanThatKeepsTheBorder) {
  const std::vector<std::vector<Vec3>> shapes = {
      flat({{0, 0}, {1, 1}, {1, 0}, {0, 1}}),              // bow tie
      flat({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {1.5, 0}}),    // on a line
      flat({{0, 3}, {-2, -3}, {3, 1}, {-3, 1}, {2, -3}}),  // pentagram
      flat({{0, 0}, {4, 0}, {4, 3}, {1, -2}, {3, -2}, {0, 3}}),
  };
  for (const auto& shape : shapes) EXPECT_TRUE(keeps_border(shape, split(shape).triangles));
  EXPECT_FALSE(split(shapes[0]).clean);
  EXPECT_FALSE(split(shapes[1]).clean);
  EXPECT_FALSE(split(shapes[2]).clean);
  EXPECT_TRUE(
      has_note(parse("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n", Format::Obj), "plain fan"));
}

TEST(Polygon, ExtremeCoordinates) {
  for (const double scale : {1e-300, 1e-160, 1e160, 1.7e308}) {
    const Vec3 o(0, 0, 0), a(scale, 0, 0), b(scale / 4, scale / 4, 0), c(0, scale, 0),
        d(-scale, 0, 0);
    const Split s = split({o, a, b, c, d});
    EXPECT_TRUE(s.clean) << scale;
    EXPECT_EQ(s.triangles.size(), 3U);
  }
}

TEST(Polygon, RandomStarsInAnyPlane) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> unit(0.05, 1);
  for (int round = 0; round < 300; ++round) {
    const int n = 4 + static_cast<int>(random() % 40);
    std::vector<Vec3> star;
    for (int i = 0; i < n; ++i) {
      const double angle = 2 * 3.14159265358979 * (i + 0.4 * unit(random)) / n;
      const double radius = unit(random);
      star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    expect_proper(star);
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(unit(random) * 6,
                          Vec3(unit(random), unit(random), unit(random)).normalized())
            .toRotationMatrix();
    std::vector<Vec3> turned;
    for (const Vec3& p : star) turned.push_back(turn * p);
    const Split s = split(turned);
    EXPECT_TRUE(s.clean);
    EXPECT_TRUE(keeps_border(turned, s.triangles));
    EXPECT_EQ(s.triangles.size(), turned.size() - 2);
  }
}

TEST(Polygon, RandomCornersKeepTheBorder) {
  std::mt19937_64 random(8);
  for (int round = 0; round < 3000; ++round) {
    std::vector<Vec3> polygon;
    for (std::size_t n = 3 + random() % 9; n > 0; --n)
      polygon.emplace_back(static_cast<double>(random() % 4), static_cast<double>(random() % 4),
                           static_cast<double>(random() % 2));
    EXPECT_TRUE(keeps_border(polygon, split(polygon).triangles));
  }
}

TEST(Polygon, ClosedMeshStaysClosed) {
  // A prism over an L, with collinear corners on two edges.
  const std::vector<std::array<double, 2>> outline = {{0, 0}, {2, 0}, {4, 0}, {4, 1},
                                                      {1, 1}, {1, 3}, {1, 4}, {0, 4}};
  const std::size_t n = outline.size();
  std::ostringstream text, bottom, top, sides;
  for (const int z : {0, 1})
    for (const auto& [x, y] : outline) text << "v " << x << ' ' << y << ' ' << z << '\n';
  for (std::size_t i = 0; i < n; ++i) {
    bottom << ' ' << n - i;
    top << ' ' << n + i + 1;
    const std::size_t k = (i + 1) % n;
    sides << "f " << i + 1 << ' ' << k + 1 << ' ' << n + k + 1 << ' ' << n + i + 1 << '\n';
  }
  text << 'f' << bottom.str() << "\nf" << top.str() << '\n' << sides.str();
  const ReadResult r = parse(text.str(), Format::Obj);
  EXPECT_TRUE(is_closed_chain(r.mesh));
  EXPECT_EQ(r.mesh.triangles.size(), 2 * (n - 2) + 2 * n);
  EXPECT_EQ(r.split_polygons, n + 2);
}

// Far fewer steps than the square of their corners.
TEST(Polygon, LargeOnesTakeNoLonger) {
  constexpr int kCorners = 20'000;
  std::mt19937_64 random(9);
  std::uniform_real_distribution<double> unit(0.3, 1);
  std::vector<Vec3> star, gear;
  for (int i = 0; i < kCorners; ++i) {
    const double angle = 2 * 3.14159265358979 * i / kCorners, radius = unit(random);
    star.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    const double tooth = 1 + 0.01 * (i % 2);
    gear.emplace_back(tooth * std::cos(angle), tooth * std::sin(angle), 0);
  }
  std::vector<Triangle> triangles;
  for (const std::vector<Vec3>* polygon : {&star, &gear}) {
    PolygonSplitter splitter(20'000'000);
    EXPECT_TRUE(splitter.split(*polygon, triangles));
    EXPECT_FALSE(splitter.exhausted());
    EXPECT_EQ(triangles.size(), polygon->size() - 2);
  }
}

TEST(Polygon, BudgetEndsInAnError) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf";
  for (int i = 0; i < 20'000; ++i) text += " 1 2 3 4";
  expect_error(text, Format::Obj, {"line 5", "80000 corners", "export the mesh as triangles"},
               ErrorCode::LimitReached);
}

TEST(Polygon, BudgetEndsInAFan) {
  std::vector<Vec3> comb;
  for (int i = 0; i < 200; ++i) comb.emplace_back(i, i % 2 == 0 ? 5 : 1, 0);
  comb.emplace_back(199, 0, 0);
  comb.emplace_back(0, 0, 0);
  std::vector<Triangle> triangles;
  EXPECT_TRUE(PolygonSplitter(1'000'000).split(comb, triangles));
  EXPECT_FALSE(PolygonSplitter(100).split(comb, triangles));
  EXPECT_EQ(triangles.size(), comb.size() - 2);
  EXPECT_TRUE(keeps_border(comb, triangles));
}

}  // namespace
}  // namespace kaboum::io::test
