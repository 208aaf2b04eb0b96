// An enclosing closed mesh of two triangles that bound nothing.

#include <kaboum/wrap/wrap.h>

#include <iostream>

int main() {
  kaboum::geom::Mesh input;
  input.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {0, 1, 1}};
  input.triangles = {{0, 1, 2}, {3, 4, 5}};
  kaboum::wrap::WrapOptions options;
  options.offset = 0.01;
  options.seal = 0.1;
  const kaboum::wrap::Wrap wrap = kaboum::wrap::wrap(input, options);
  std::cout << wrap.mesh.triangles.size() << " triangles round " << input.triangles.size() << '\n';
  return wrap.mesh.empty() ? 1 : 0;
}
