// A large mesh from a smaller one, for benchmarks/growth.py: every triangle cut into four, N times
// (common.h: the new vertices are off the middles of the edges, so nothing is coplanar; by 0.3 % of
// the edge, so that a mesh without crossings has none after many times either).
//
//   subdivide MESH -o RESULT.ply|.stl|.off [--times N] [--off SHARE]
#include <kaboum/io/mesh_io.h>

#include <exception>
#include <iostream>
#include <stdexcept>
#include <string>
#include <vector>

#include "common.h"

int main(int argc, char** argv) {
  using namespace kaboum;  // NOLINT: a program
  std::string result;
  std::vector<std::string> names;
  int times = 1;
  double share = 0.003;
  try {
    const std::vector<std::string> args{argv + 1, argv + argc};
    for (std::size_t i = 0; i < args.size(); ++i) {
      if (args[i] == "-o")
        result = args.at(++i);
      else if (args[i] == "--times")
        times = std::stoi(args.at(++i));
      else if (args[i] == "--off")
        share = std::stod(args.at(++i));
      else
        names.push_back(args[i]);
    }
    if (names.size() != 1 || result.empty() || times < 0)
      throw std::invalid_argument("subdivide MESH -o RESULT [--times N] [--off SHARE]");
  } catch (const std::exception& e) {
    std::cerr << e.what() << '\n';
    return 2;
  }
  try {
    geom::Mesh mesh = io::read_mesh(names[0]).mesh;
    for (int i = 0; i < times; ++i) mesh = benchmark::subdivided(mesh, share);
    for (geom::Vec3& p : mesh.vertices) p = p.cast<float>().cast<double>();  // as scans have them
    io::write_file(result, io::serialise_mesh(mesh, io::format_of_file(result)));
    std::cout << mesh.triangles.size() << '\n';
  } catch (const std::exception& e) {
    std::cerr << "subdivide: " << e.what() << '\n';
    return 3;
  }
}
