// Worlds in colours: what is in contact is seen.

#include <kaboum/page/world_picture.h>

#include <kaboum/geom/body_polytopes.h>
#include <kaboum/picture/png_file.h>
#include <kaboum/picture/render.h>

namespace kaboum::page {
namespace {

using picture::Colour;
using world::Item;

constexpr int kPanel = 1000;
constexpr Colour kRobot{0.66F, 0.68F, 0.71F}, kObject{0.55F, 0.68F, 0.85F},
    kTouching{0.95F, 0.72F, 0.40F}, kMeeting{0.85F, 0.15F, 0.12F};

Colour colour_of(const Item& item, std::size_t body, const std::vector<world::Contact>& contacts) {
  Colour out = item.robot == Item::kObject ? kObject : kRobot;
  for (const world::Contact& contact : contacts)
    for (const int side : {0, 1}) {
      if (!(contact.items.at(side) == item)) continue;
      if ((side == 0 ? contact.bodies.a : contact.bodies.b) == body) return kMeeting;
      out = kTouching;
    }
  return out;
}

}  // namespace

namespace {

/// A ball of which there are very many, drawn by few triangles.
geom::Mesh octahedron(const geom::ConvexBody& ball) {
  geom::Mesh out;
  for (int k = 0; k < 6; ++k)
    out.vertices.emplace_back(ball.core.vertices.front() +
                              (k % 2 == 0 ? ball.radius : -ball.radius) * geom::Vec3::Unit(k / 2));
  for (std::uint32_t k = 0; k < 8; ++k) {
    const std::uint32_t x = k & 1U, y = 2 + (k >> 1 & 1U), z = 4 + (k >> 2 & 1U);
    const bool turned = (x + y + z) % 2 != 0;
    out.triangles.push_back({x, turned ? z : y, turned ? y : z});
  }
  return out;
}

}  // namespace

std::vector<char> picture_of(const world::Checker& checker, const world::WorldState& state,
                             const std::vector<world::Contact>& contacts) {
  picture::Image image(kPanel, kPanel, Colour{1, 1, 1});
  geom::Mesh all;
  picture::Style style;
  for (const world::Checker::PosedItem& placed : checker.places(state)) {
    const world::BoundingSet& set = placed.place.set();
    for (std::size_t i = 0; i < set.size(); ++i) {
      const auto first = static_cast<std::uint32_t>(all.vertices.size());
      const geom::Mesh surface =
          set.is_cloud() ? octahedron(set.body(i)) : geom::surface_of(set.body(i));
      for (const geom::Vec3& p : surface.vertices)
        all.vertices.emplace_back(placed.place.pose() * p);
      for (const geom::Triangle& t : surface.triangles) {
        all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        style.of_triangle.push_back(colour_of(placed.item, i, contacts));
      }
    }
  }
  if (!all.triangles.empty()) {
    const picture::Camera camera(geom::bounding_box(all), {}, kPanel, kPanel);
    picture::draw_mesh(image, 0, 0, kPanel, kPanel, all, camera, style);
  }
  return picture::encode_png(image);
}

}  // namespace kaboum::page
