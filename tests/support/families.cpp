#include "families.h"

#include "part.h"
#include "shapes.h"

#include <cmath>
#include <numbers>
#include <utility>

namespace kaboum::test {
namespace {

/// Factors with long binary expansions: products are no float32 numbers.
const Vec3 kOdd(0.123456789012345, 0.234567890123456, 0.345678901234567);

/// Off the origin by an odd amount: no coordinate stays a float32 number.
Mesh displaced(const Mesh& mesh) { return translated(mesh, {0.1, -0.7, 1.3}); }

/// A list under construction; `add` is for solids, the others say what differs.
class List {
 public:
  void add(std::string name, Mesh mesh) {
    push(std::move(name), std::move(mesh), true, true, false);
  }
  void convex(std::string name, Mesh mesh) {
    push(std::move(name), std::move(mesh), true, true, true);
  }
  void closed_without_solid(std::string name, Mesh mesh) {
    push(std::move(name), std::move(mesh), true, false, false);
  }
  void open(std::string name, Mesh mesh) {
    push(std::move(name), std::move(mesh), false, false, false);
  }
  void push(std::string name, Mesh mesh, bool is_closed, bool solid, bool is_convex) {
    families_.push_back({std::move(name), std::move(mesh), is_closed, solid, is_convex});
  }
  [[nodiscard]] std::vector<Family> take() && { return std::move(families_); }

 private:
  std::vector<Family> families_;
};

void add_convex(List& list) {
  list.convex("icosphere-2", icosphere(2));
  list.convex("icosphere-3-float", to_float(icosphere(3)));
  list.convex("icosphere-3-far", translated(icosphere(3), {1234.5678, -9876.54321, 4321.0987}));
  list.convex("hull-ball", random_hull(400, Cloud::Ball, 1));
  list.convex("hull-cube-float", convex_hull(to_float(random_hull(2000, Cloud::Cube, 2)).vertices));
  list.convex("hull-sphere", random_hull(300, Cloud::Sphere, 3));
  list.convex(
      "hull-sphere-far",
      convex_hull(translated(random_hull(150, Cloud::Sphere, 4), {1e6, 2e6, -3e6}).vertices));
  list.convex("hull-flat",
              convex_hull(scaled(random_hull(200, Cloud::Sphere, 5), {1, 1, 1e-4}).vertices));
  list.convex("box-float", box({1, 2, 0.5}, 4));
  list.convex("box", translated(box(kOdd, 6), {0.1, 0.2, 0.3}));
  list.add("box-rotated", rotated(box(kOdd, 6), 0.7));
  list.convex("cylinder", cylinder(40, kOdd.z(), 3, 3));
  list.add("cylinder-rotated", rotated(cylinder(40, 2, 3, 3), 1.1));
  list.convex("cone-apex-200", cone(200, 1.7));
  list.convex("cone-flat", cone(150, 0.001));
  list.convex("prism-6", scaled(cylinder(6, 1, 8, 4), {1, 1, std::numbers::sqrt2}));
}

void add_parts(List& list) {
  list.add("bracket-8", examples::make_bracket(8));
  list.add("bracket-20", examples::make_bracket(20));
  list.add("bracket-20-mm", scaled(examples::make_bracket(20), Vec3::Constant(1000)));
  list.add("bracket-32-rotated", rotated(examples::make_bracket(32), 2.3));
  list.add("bracket-16-far", translated(examples::make_bracket(16), {1000, -2000, 500}));
  list.convex("sliver-cylinder", cylinder(100, 40, 1, 0));
  list.add("sliver-cylinder-rotated", rotated(cylinder(100, 40, 1, 0), 0.4));
  list.add("sliver-rod-fans", rotated(scaled(cylinder(100, 1, 1, 1), {0.01, 0.01, 3}), 0.9));
  list.add("thin-plate-1e-3", rotated(box({1, 1, 1e-3}, 12), 0.3));
  list.convex("thin-plate-1e-5", displaced(box({1, 1, 1e-5}, 12)));
  list.add("thin-shell-1e-3",
           merged({icosphere(3), flipped(scaled(icosphere(3), Vec3::Constant(0.999)))}));
}

void add_curved(List& list) {
  list.add("torus", torus(1, 0.3, 40, 20));
  list.add("torus-thin", rotated(torus(1, 0.02, 80, 8), 0.6));
  list.add("torus-fat-float", to_float(torus(1, 0.95, 48, 32)));
  list.add("torus-far", translated(torus(1, 0.4, 30, 16), {-50000.1, 20000.2, 70000.3}));
  list.add("knot-2-3", torus_knot(2, 3, 0.12, 160, 10));
  list.add("knot-3-7", rotated(torus_knot(3, 7, 0.06, 400, 8), 1.9));
  list.add("sphere-uv", displaced(uv_sphere(48, 23)));
  list.add("sphere-noisy-1", noisy(icosphere(3), 0.01, 11));
  list.add("sphere-noisy-10", noisy(icosphere(3), 0.1, 12));
  list.add("sphere-noisy-40-float", to_float(noisy(icosphere(2), 0.4, 13)));
}

void add_components(List& list) {
  const Mesh ball = icosphere(2);
  const auto ball_of = [&](double r) { return scaled(ball, Vec3::Constant(r)); };
  list.add("cavity", merged({ball, flipped(ball_of(0.5))}));
  list.add("box-with-cavity",
           displaced(merged({box({1, 1, 1}, 5),
                             flipped(translated(box({0.3, 0.4, 0.5}, 3), {0.3, 0.3, 0.3}))})));
  list.add("shells-nested", merged({ball, flipped(ball_of(0.9)), ball_of(0.7),
                                    flipped(ball_of(0.6)), ball_of(0.3)}));
  list.add("solids-nested", merged({ball, ball_of(0.6), ball_of(0.3)}));  // w = 1, 2, 3
  list.add("spheres-overlapping",
           merged({ball, translated(ball, {0.9, 0.1, 0.2}), translated(ball, {0.3, 0.8, -0.3})}));
  list.add("spheres-apart", merged({ball, translated(ball, {5, 0.3, 0.1})}));
  list.add("spheres-nearly-touching", merged({ball, translated(ball, {2.0000001, 0, 0})}));
  list.add("boxes-crossing-float",
           merged({box({4, 1, 1}, 4), translated(box({1, 4, 1}, 4), {1.5, -1.5, 0.25})}));
  list.add("tube-self-crossing",
           tube([](double t) { return Vec3(std::cos(t), std::sin(2 * t), 0.05 * std::sin(t) + 2); },
                0.2, 120, 12));
  list.convex("component-twice", displaced(merged({ball, ball})));
  list.add("component-twice-rotated", merged({ball, rotated(ball, 0.2)}));
}

void add_nonmanifold(List& list) {
  const Mesh cube = box({1, 1, 1}, 4);
  list.add("cubes-sharing-edge", welded(merged({cube, translated(cube, {1, 1, 0})})));
  list.add("cubes-sharing-vertex", welded(merged({cube, translated(cube, {1, 1, 1})})));
  list.add("cubes-sharing-face", welded(merged({cube, translated(cube, {0, 0, 1})})));
  list.add("cubes-sharing-edge-odd",
           scaled(welded(merged({cube, translated(cube, {1, 1, 0})})), kOdd));
  list.add("cubes-sharing-vertex-odd",
           rotated(welded(merged({cube, translated(cube, {1, 1, 1})})), 0.5));
  list.add("cubes-sharing-face-odd",
           rotated(welded(merged({cube, translated(cube, {0, 0, 1})})), 1.5));
  const Mesh sheet = grid(8, [](double x, double y) { return 0.1 * std::sin(5 * x) * y; });
  list.closed_without_solid("sheet-flat-float",
                            welded(merged({grid(8, [](double, double) { return 0.0; }),
                                           flipped(grid(8, [](double, double) { return 0.0; }))})));
  list.closed_without_solid("sheet-curved", rotated(welded(merged({sheet, flipped(sheet)})), 0.8));
  list.add("sphere-with-fin",  // a sheet that stands on nothing, beside a solid
           merged({icosphere(2), translated(rotated(welded(merged({sheet, flipped(sheet)})), 0.8),
                                            {1.5, 0, 0})}));
}

void add_degenerate(List& list) {
  list.convex("t-junctions-flat", with_t_junctions(box({1, 2, 4}, 4), 30, 21));
  list.add("t-junctions-slivers", with_t_junctions(rotated(box(kOdd, 4), 0.7), 30, 22));
  list.add("t-junctions-bracket", with_t_junctions(examples::make_bracket(12), 60, 23));
  list.convex("repeated-vertices", with_repeated_vertices(icosphere(2), 25, 24));
  list.convex("soup", displaced(soup(icosphere(2))));
  list.add("soup-bracket", soup(examples::make_bracket(8)));
}

}  // namespace

std::vector<Family> closed_families() {
  List list;
  add_convex(list);
  add_parts(list);
  add_curved(list);
  add_components(list);
  add_nonmanifold(list);
  add_degenerate(list);
  return std::move(list).take();
}

std::vector<Family> open_families() {
  List list;
  const auto hill = [](double x, double y) { return 0.3 * std::sin(3 * x) * std::cos(4 * y); };
  list.open("sphere-with-hole", without(icosphere(3), [](const Vec3& p) { return p.z() > 0.8; }));
  list.open("sphere-with-holes", without(displaced(icosphere(3)), [](const Vec3& p) {
              return std::abs(p.x() - 0.1) > 0.9 || p.z() > 2.2;
            }));
  list.open("half-sphere-float",
            without(to_float(icosphere(3)), [](const Vec3& p) { return p.z() < 0; }));
  list.open("plate-float", grid(8, [](double, double) { return 0.25; }));
  list.open("plate-rotated", rotated(grid(12, [](double, double) { return 0.0; }), 0.5));
  list.open("hill", displaced(grid(20, hill)));
  list.open("hill-far", translated(grid(20, hill), {12345.6, 65432.1, -321.9}));
  list.open("tube-open", without(rotated(cylinder(30, 3, 10, 2), 0.2), [](const Vec3& p) {
              static const Mesh axis =
                  rotated(cylinder(3, 3, 1, 1), 0.2);  // its last vertices: caps' middles
              const Vec3& low = axis.vertices[axis.vertices.size() - 2];
              const Vec3& high = axis.vertices.back();
              const double along = (p - low).dot(high - low) / 9;
              return along < 1e-9 || along > 1 - 1e-9;
            }));
  list.open("bracket-without-back",
            without(examples::make_bracket(16), [](const Vec3& p) { return p.x() < 1e-9; }));
  list.open("plate-and-sphere", merged({icosphere(2), translated(grid(10, hill), {2, 0, 0})}));
  return std::move(list).take();
}

std::vector<Family> bad_families() {
  List list;
  list.closed_without_solid("sphere-inverted", flipped(icosphere(2)));
  list.closed_without_solid("sphere-cancelled", merged({icosphere(2), flipped(icosphere(2))}));
  list.add("inverted-beside-sphere",
           displaced(merged({icosphere(2), translated(flipped(icosphere(2)), {3, 0, 0})})));
  Mesh mixed = icosphere(2);
  for (std::size_t i = 0; i < mixed.triangles.size(); i += 3) {
    std::swap(mixed.triangles[i][1], mixed.triangles[i][2]);
  }
  list.open("sphere-mixed", displaced(mixed));
  Mesh halves = icosphere(2);
  for (geom::Triangle& t : halves.triangles) {
    if (halves.vertices[t[0]].z() > 0) std::swap(t[1], t[2]);
  }
  list.open("sphere-half-flipped", halves);
  list.open("moebius-strip", moebius_strip(40, 4));
  Mesh flat = icosphere(2);
  for (Vec3& p : flat.vertices) p = Vec3(p.x(), 2 * p.x(), -p.x());
  list.closed_without_solid("all-collinear", flat);
  for (Vec3& p : flat.vertices) p = Vec3(0.1, 0.2, 0.3);
  list.closed_without_solid("all-one-point", flat);
  list.open("single-triangle", Mesh{{{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}}, {{0, 1, 2}}});
  list.closed_without_solid("empty", Mesh{});
  list.closed_without_solid("vertices-only", Mesh{icosphere(1).vertices, {}});
  return std::move(list).take();
}

}  // namespace kaboum::test
