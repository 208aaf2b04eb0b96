/// Covers of all kinds that are nearer to the solid in a region: fewer bodies than where all is as
/// near, and decided by the checker, which shares nothing with the searches.
#include <gtest/gtest.h>
#include <kaboum/base/error.h>
#include <kaboum/bcd/balls.h>
#include <kaboum/bcd/simple_bodies.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/region_excess.h>

namespace kaboum::bcd {
namespace {

using geom::BoundedRegion;
using geom::Mesh;
using geom::Vec3;
using verify::Answer;

/// A bar of 10 × 1 × 1 with a notch of 1 × 0.5 near each end.
Mesh notched_bar() {
  const std::vector<std::array<double, 2>> outline{{0, 0},     {10, 0},    {10, 1},  {9.5, 1},
                                                   {9.5, 0.5}, {8.5, 0.5}, {8.5, 1}, {1.5, 1},
                                                   {1.5, 0.5}, {0.5, 0.5}, {0.5, 1}, {0, 1}};
  const std::vector<std::vector<std::uint32_t>> parts{{0, 1, 5, 8}, {0, 8, 9}, {0, 9, 10, 11},
                                                      {1, 2, 3, 4}, {1, 4, 5}, {5, 6, 7, 8}};
  const auto n = static_cast<std::uint32_t>(outline.size());
  Mesh out;
  for (const double z : {0.0, 1.0})
    for (const auto& [x, y] : outline) out.vertices.emplace_back(x, y, z);
  for (const auto& part : parts)
    for (std::size_t i = 1; i + 1 < part.size(); ++i) {
      out.triangles.push_back({part[0], part[i + 1], part[i]});
      out.triangles.push_back({part[0] + n, part[i] + n, part[i + 1] + n});
    }
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t j = (i + 1) % n;
    out.triangles.push_back({i, j, j + n});
    out.triangles.push_back({i, j + n, i + n});
  }
  return out;
}

enum class Kind { Polytopes, Balls, Capsules, Boxes };

template <class Options>
Options options_of(double epsilon, const std::vector<BoundedRegion>& regions) {
  Options out;
  out.epsilon = epsilon;
  out.regions = regions;
  out.effort = Effort::Fast;
  return out;
}

geom::ConvexSet found(Kind kind, double epsilon, const std::vector<BoundedRegion>& regions) {
  const geom::Prepared prepared = geom::prepare(notched_bar(), {});
  geom::ConvexSet out;
  if (kind == Kind::Polytopes) {
    out.bodies = find_cover(prepared.solid, options_of<CoverOptions>(epsilon, regions)).bodies;
  } else if (kind == Kind::Balls) {
    out.bodies = find_balls(prepared.solid, options_of<BallOptions>(epsilon, regions)).bodies;
  } else {
    auto options = options_of<SimpleBodyOptions>(epsilon, regions);
    (kind == Kind::Capsules ? options.kinds.capsules : options.kinds.boxes) = true;
    out.bodies = SimpleBodySearch(prepared.solid, options).find().bodies;
  }
  return out;
}

TEST(Regions, BodiesAreNearerThereAndFewer) {
  const Mesh mesh = notched_bar();
  constexpr double kCoarse = 0.6;
  for (const Kind kind : {Kind::Polytopes, Kind::Balls, Kind::Capsules, Kind::Boxes}) {
    // Flat ends take many balls.
    const double fine = kind == Kind::Polytopes || kind == Kind::Boxes ? 0.05 : 0.3;
    const std::vector<BoundedRegion> regions{
        {"box", geom::box_region({{-1, -1, -1}, {1.4, 2, 2}}), fine},
        {"ball", {{}, {1, 0.8, 0.5}, 0.2}, fine},
        {"half-space", {{{Vec3::UnitX(), 1.4}}, Vec3::Zero(), 0}, fine}};
    const std::size_t all = found(kind, fine, {}).bodies.size();
    const geom::ConvexSet coarse = found(kind, kCoarse, {});
    for (const BoundedRegion& region : regions) {
      SCOPED_TRACE(region.name + ", kind " + std::to_string(static_cast<int>(kind)));
      EXPECT_EQ(verify::verify_region_excess(coarse, mesh, region, true).answer, Answer::Refuted);
      const geom::ConvexSet set = found(kind, kCoarse, {region});
      EXPECT_LT(set.bodies.size(), all);
      const verify::Cover cover = verify::verify_cover(mesh, set);
      EXPECT_EQ(cover.inclusion.solid.answer, Answer::Verified);
      EXPECT_EQ(cover.inclusion.surface.answer, Answer::Verified);
      EXPECT_EQ(verify::verify_excess(set, mesh, kCoarse, true).answer, Answer::Verified);
      EXPECT_EQ(verify::verify_region_excess(set, mesh, region, true).answer, Answer::Verified);
    }
  }
}

TEST(Regions, NeedAnEpsilon) {
  const geom::Prepared prepared = geom::prepare(notched_bar(), {});
  CoverOptions options;
  options.max_bodies = 3;
  options.regions = {{"ball", {{}, {1, 0.8, 0.5}, 0.2}, 0.1}};
  EXPECT_ANY_THROW(find_cover(prepared.solid, options));
}

template <class Request>
void expect_refused(const Request& request, const auto& find) {
  try {
    find(request);
    ADD_FAILURE() << "regions that a search under a limit would lose";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::InvalidArgument);
    EXPECT_EQ(std::string(error.what()).find("regions do not go with a limit"), 0U);
  }
}

TEST(Regions, AreRefusedWithLimits) {
  const geom::SolidMesh solid = geom::prepare(notched_bar(), {}).solid;
  const std::vector<BoundedRegion> regions{
      {"left", geom::box_region({{-1, -1, -1}, {1.4, 2, 2}}), 0.05}};
  auto cover = options_of<CoverOptions>(0.6, regions);
  cover.max_total_vertices = 20;
  const auto find = [&](const CoverOptions& o) { return find_cover(solid, o); };
  expect_refused(cover, find);
  cover.max_total_vertices.reset();
  cover.max_bodies = 2;
  expect_refused(cover, find);
  auto balls = options_of<BallOptions>(0.6, regions);
  balls.max_bodies = 2;
  expect_refused(balls, [&](const BallOptions& o) { return find_balls(solid, o); });
  auto boxes = options_of<SimpleBodyOptions>(0.6, regions);
  boxes.kinds.boxes = true;
  boxes.max_bodies = 2;
  expect_refused(boxes,
                 [&](const SimpleBodyOptions& o) { return SimpleBodySearch(solid, o).find(); });
}

}  // namespace
}  // namespace kaboum::bcd
