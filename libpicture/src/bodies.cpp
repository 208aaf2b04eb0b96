// A set of bodies drawn, each in a colour of its own.

#include <kaboum/picture/bodies.h>

#include <kaboum/base/error.h>
#include <kaboum/geom/body_polytopes.h>
#include <kaboum/picture/render.h>

#include <algorithm>
#include <cmath>

namespace kaboum::picture {
namespace {

constexpr int kPanel = 800;

/// Hues that neighbours in the list do not share.
Colour colour_of(std::size_t body) {
  const double hue = std::fmod(0.11 + 0.61803398875 * static_cast<double>(body), 1.0) * 6;
  const auto channel = [&](double offset) {
    const double x = std::abs(std::fmod(hue + offset, 6.0) - 3) - 1;
    return static_cast<float>(0.42 + 0.48 * std::min(1.0, std::max(0.0, x)));
  };
  return {channel(0), channel(4), channel(2)};
}

}  // namespace

geom::Mesh surfaces_of(const geom::ConvexSet& set) {
  geom::Mesh sum;
  for (const geom::ConvexBody& body : set.bodies) {
    const auto first = static_cast<std::uint32_t>(sum.vertices.size());
    const geom::Mesh surface = geom::surface_of(body);
    sum.vertices.insert(sum.vertices.end(), surface.vertices.begin(), surface.vertices.end());
    for (const geom::Triangle& t : surface.triangles)
      sum.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return sum;
}

Image draw_bodies(const geom::ConvexSet& set, double explode) {
  if (!(explode >= 0 && explode <= 10))
    throw Error(ErrorCode::InvalidArgument, "«explode» must be a number from 0 to 10");
  const int panels = explode > 0 ? 2 : 1;
  Image image(panels * kPanel, kPanel, Colour{1, 1, 1});
  for (int panel = 0; panel < panels && !set.bodies.empty(); ++panel) {
    geom::Box3 whole;
    for (const geom::ConvexBody& body : set.bodies) whole.extend(geom::bounding_box(body));
    geom::Mesh all;
    Style style;
    for (std::size_t i = 0; i < set.bodies.size(); ++i) {
      const geom::Mesh hull = geom::surface_of(set.bodies[i]);
      geom::Vec3 shift = geom::Vec3::Zero();
      if (panel == 1) shift = explode * (geom::bounding_box(hull).center() - whole.center());
      const auto first = static_cast<std::uint32_t>(all.vertices.size());
      for (const geom::Vec3& p : hull.vertices) all.vertices.emplace_back(p + shift);
      for (const geom::Triangle& t : hull.triangles) {
        all.triangles.push_back({first + t[0], first + t[1], first + t[2]});
        style.of_triangle.push_back(colour_of(i));
      }
    }
    const Camera camera(geom::bounding_box(all), {}, kPanel, kPanel);
    draw_mesh(image, panel * kPanel, 0, kPanel, kPanel, all, camera, style);
  }
  return image;
}

}  // namespace kaboum::picture
