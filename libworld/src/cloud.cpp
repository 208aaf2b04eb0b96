// Point clouds as objects: a ball for each point, in an order in which neighbours are near each
// other, so that boxes round many of them are small.

#include <kaboum/base/error.h>
#include <kaboum/base/similar_name.h>
#include <kaboum/world/cloud.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace kaboum::world {
namespace {

/// The bits of a number below 2^21, two places apart.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32) & 0x001f00000000ffff;
  x = (x | x << 16) & 0x001f0000ff0000ff;
  x = (x | x << 8) & 0x100f00f00f00f00f;
  x = (x | x << 4) & 0x10c30c30c30c30c3;
  return (x | x << 2) & 0x1249249249249249;
}

/// Places of points along a curve that fills their box (G. M. Morton, 1966).
std::vector<std::uint64_t> codes_of(const std::vector<Vec3>& points) {
  geom::Box3 box;
  for (const Vec3& p : points) box.extend(p);
  const double size = (box.max - box.min).maxCoeff();
  constexpr double kCells = 1 << 21;
  std::vector<std::uint64_t> out;
  out.reserve(points.size());
  for (const Vec3& p : points) {
    std::uint64_t code = 0;
    for (int k = 0; k < 3; ++k) {
      const double at = size > 0 ? (p[k] - box.min[k]) / size * kCells : 0;
      code |= spread(static_cast<std::uint64_t>(std::clamp(at, 0.0, kCells - 1))) << k;
    }
    out.push_back(code);
  }
  return out;
}

void require_fit(const World& world, const Cloud& cloud) {
  const auto refuse = [&](const std::string& what) {
    throw Error(ErrorCode::InvalidArgument, "cloud '" + cloud.name + "': " + what);
  };
  if (cloud.name.empty() || cloud.name.find('/') != std::string::npos)
    throw Error(ErrorCode::InvalidArgument,
                "a cloud needs a name without '/', not '" + cloud.name + "'");
  const auto is_named_so = [&](const auto& thing) { return thing.name == cloud.name; };
  if (std::ranges::any_of(world.objects, is_named_so) ||
      std::ranges::any_of(world.robots, is_named_so) ||
      std::ranges::any_of(world.regions, is_named_so))
    refuse("the scene has something of this name already; give the cloud another one");
  if (!(cloud.radius > 0 && std::isfinite(cloud.radius))) refuse("its radius must be above 0");
  if (cloud.points.empty()) refuse("no points");
  if (!cloud.numbers.empty() && cloud.numbers.size() != cloud.points.size())
    refuse("other numbers than points");
  for (std::size_t i = 0; i < cloud.points.size(); ++i)
    if (!cloud.points[i].allFinite() || !(cloud.points[i].cwiseAbs().maxCoeff() <= 1e9))
      refuse("point " + std::to_string(cloud.numbers.empty() ? i + 1 : cloud.numbers[i]) +
             " has a coordinate that is not from -1e9 to 1e9");
}

Item link_named(const World& world, const std::string& name, const std::string& cloud) {
  std::vector<std::string> names;
  for (std::size_t r = 0; r < world.robots.size(); ++r)
    for (std::size_t s = 0; s < world.robots[r].shapes.size(); ++s) {
      names.push_back(world.name_of({r, s}));
      if (names.back() == name) return {r, s};
    }
  throw Error(ErrorCode::InvalidArgument,
              "cloud '" + cloud + "': contacts with '" + name +
                  "' cannot be allowed: the scene has no link of this name with a shape, as "
                  "ROBOT/LINK" +
                  did_you_mean(name, names));
}

}  // namespace

void add_cloud(World& world, Cloud cloud) {
  require_fit(world, cloud);
  const Item item{Item::kObject, world.objects.size()};
  std::vector<std::array<Item, 2>> allowed;
  for (const std::string& link : cloud.allow)
    allowed.push_back({link_named(world, link, cloud.name), item});
  const std::vector<std::uint64_t> codes = codes_of(cloud.points);
  std::vector<std::uint32_t> order(cloud.points.size());
  std::iota(order.begin(), order.end(), std::uint32_t{0});
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return codes[a] != codes[b] ? codes[a] < codes[b] : a < b;
  });
  std::vector<geom::ConvexBody> bodies;
  bodies.reserve(order.size());
  std::vector<std::uint32_t> numbers;
  numbers.reserve(order.size());
  for (const std::uint32_t i : order) {
    bodies.push_back({"", {{cloud.points[i]}, {}}, cloud.radius});
    numbers.push_back(cloud.numbers.empty() ? i + 1 : cloud.numbers[i]);
  }
  Object object{.name = std::move(cloud.name),
                .pose = cloud.pose,
                .outer = BoundingSet(std::move(bodies), collide::Direction::Outer, 0),
                .inner = {},
                .features = {},
                .grasps = {}};
  object.point_numbers = std::move(numbers);
  world.objects.push_back(std::move(object));
  world.attachments.emplace_back();
  world.allowed.insert(world.allowed.end(), allowed.begin(), allowed.end());
}

}  // namespace kaboum::world
