// A sphere, simplified outwards, through a file format.
#include <kaboum/bmesh/decimate.h>
#include <kaboum/geom/prepare.h>
#include <kaboum/io/mesh_io.h>

#include <iostream>

#include "sphere.h"

int main() {
  using namespace kaboum;
  const geom::Prepared input = geom::prepare(sphere(24, 11));
  bmesh::DecimateOptions options;
  options.vertices = 60;
  const bmesh::DecimateResult result = bmesh::decimate(input.solid, options);

  const auto bytes = io::serialise_mesh(result.mesh, io::Format::Stl);
  const geom::Mesh back = io::parse_mesh(bytes, io::Format::Stl, "sphere.stl").mesh;

  const double before = geom::signed_volume(input.solid.mesh()), after = geom::signed_volume(back);
  std::cout << input.solid.mesh().vertices.size() << " -> " << back.vertices.size()
            << " vertices, volume " << before << " -> " << after << '\n';
  return back.vertices.size() <= 60 && after >= before ? 0 : 1;
}
