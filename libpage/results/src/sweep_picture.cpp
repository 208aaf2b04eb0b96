// A robot along its path, and the set that bounds what it sweeps, drawn.

#include <kaboum/page/sweep_picture.h>

#include <kaboum/geom/body_polytopes.h>
#include <kaboum/geom/convex_hull.h>
#include <kaboum/picture/png_file.h>
#include <kaboum/picture/render.h>
#include <kaboum/robot/kinematics.h>

#include <array>

namespace kaboum::page {
namespace {

using picture::Colour;

constexpr int kPanel = 800;

struct Scene {
  geom::Mesh mesh;
  picture::Style style;

  void add(const geom::Mesh& part, const Colour& colour) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    mesh.vertices.insert(mesh.vertices.end(), part.vertices.begin(), part.vertices.end());
    for (const geom::Triangle& t : part.triangles) {
      mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      style.of_triangle.push_back(colour);
    }
  }
};

}  // namespace

std::vector<char> picture_of_sweep(const robot::Robot& robot,
                                   std::span<const robot::LinkBody> bodies, const robot::Path& path,
                                   const certify::CertifiedSweep& result) {
  constexpr std::array<Colour, 8> kLinks{{{0.55F, 0.57F, 0.60F},
                                          {0.86F, 0.45F, 0.40F},
                                          {0.93F, 0.68F, 0.36F},
                                          {0.86F, 0.82F, 0.42F},
                                          {0.50F, 0.76F, 0.46F},
                                          {0.42F, 0.74F, 0.76F},
                                          {0.45F, 0.58F, 0.88F},
                                          {0.70F, 0.52F, 0.82F}}};
  Scene ends, swept;
  for (const bool last : {false, true}) {
    const auto poses = robot::forward(robot, last ? path.back() : path.front());
    for (const robot::LinkBody& body : bodies) {
      std::vector<geom::Vec3> points;
      for (const geom::Vec3& p : body.points) points.emplace_back(poses[body.link] * p);
      if (const auto hull = geom::convex_hull(points))
        ends.add(*hull, last ? Colour{0.93F, 0.60F, 0.30F} : Colour{0.45F, 0.58F, 0.80F});
    }
  }
  for (std::size_t i = 0; i < result.artefact().bodies.size(); ++i)
    swept.add(geom::surface_of(result.artefact().bodies[i]),
              kLinks[bodies[result.certificate().sources[i]].link % kLinks.size()]);
  geom::Box3 box = geom::bounding_box(swept.mesh);
  box.extend(geom::bounding_box(ends.mesh));
  const picture::Camera camera(box, {}, kPanel, kPanel);
  picture::Image image(2 * kPanel, kPanel, Colour{1, 1, 1});
  int left = 0;
  for (const Scene* scene : {&ends, &swept}) {
    if (!scene->mesh.empty())
      picture::draw_mesh(image, left, 0, kPanel, kPanel, scene->mesh, camera, scene->style);
    left += kPanel;
  }
  return picture::encode_png(image);
}

}  // namespace kaboum::page
