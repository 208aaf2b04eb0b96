// What can be asked for: the largest distance, or the mean one.

#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/directed_distance.h>

#include <gtest/gtest.h>

#include <cmath>

#include "part.h"
#include "support/shapes.h"

namespace {

using namespace kaboum;         // NOLINT: the test uses most of it
using namespace kaboum::bmesh;  // NOLINT

struct Distances {
  double largest = 0, mean = 0;
};

/// Logarithms, summed over both directions; the mean is that of the triangles' centroids.
Distances measure(const geom::Mesh& original, const geom::Mesh& result) {
  Distances d;
  for (const auto& [a, b] : {std::pair{&original, &result}, {&result, &original}}) {
    const geom::DistanceQuery query(*b);
    d.largest = std::max(d.largest, geom::directed_distance(*a, query).max_upper);
    double sum = 0;
    std::uint32_t hint = geom::DistanceQuery::kNone;
    for (const auto& [i, j, k] : a->triangles) {
      const geom::Vec3 &p = a->vertices[i], &q = a->vertices[j], &r = a->vertices[k];
      const auto at = query.nearest((p + q + r) / 3, hint);
      hint = at.triangle;
      sum += 0.5 * (q - p).cross(r - p).norm() * at.upper;
    }
    d.mean += 0.5 * sum / geom::area(*a);
  }
  return {std::log(d.largest), std::log(d.mean)};
}

// Of shapes with strongly and with weakly curved parts, the one has the smaller maximum, the other
// the smaller mean.
TEST(Cost, MeanAndDistanceTradeTheMaximumForTheMean) {
  const std::vector<geom::Mesh> meshes{examples::make_bracket(12),
                                       test::scaled(test::uv_sphere(24, 15), {1, 0.2, 3})};
  for (const Effort effort : {Effort::Fast, Effort::Normal}) {
    Distances mean, distance;
    for (const geom::Mesh& mesh : meshes) {
      const auto p = geom::prepare(mesh);
      for (const Direction d : {Direction::Outer, Direction::Inner}) {
        DecimateOptions o;
        o.direction = d;
        o.effort = effort;
        o.vertices = p.solid.mesh().vertices.size() * 7 / 20;
        for (const auto& [cost, sum] :
             {std::pair{Cost::Mean, &mean}, {Cost::Distance, &distance}}) {
          o.cost = cost;
          const DecimateResult r = decimate(p.solid, o);
          EXPECT_EQ(r.stop, Stop::VertexTarget);
          const Distances m = measure(p.solid.mesh(), r.mesh);
          sum->largest += m.largest;
          sum->mean += m.mean;
        }
      }
    }
    const double runs = 2.0 * static_cast<double>(meshes.size());
    EXPECT_LT(std::exp((mean.mean - distance.mean) / runs), 0.9) << static_cast<int>(effort);
    EXPECT_GT(std::exp((mean.largest - distance.largest) / runs), 1.1) << static_cast<int>(effort);
  }
}

}  // namespace
