// A certified bounding mesh in process, and what is claimed of it.

#include <kaboum/certify/mesh.h>

#include <iostream>

#include "sphere.h"

int main() {
  using namespace kaboum;
  certify::MeshRequest request;
  request.vertices = {60};
  const auto made = certify::certify_mesh(certify::prepare_mesh(sphere(24, 11)), request);
  if (!made) return 1;  // float32 numbers would be too coarse
  std::cout << made->artefact().vertices.size() << " vertices, " << made->bytes().size()
            << " bytes\n";
  for (const certify::Claim& claim : certify::certificate_of(*made).claims) {
    std::cout << name_of(claim.kind) << ": " << name_of(claim.answer) << ", "
              << name_of(claim.basis);
    if (claim.distance) std::cout << ", at most " << *claim.distance;
    std::cout << '\n';
  }
  return made->certificate().reached() ? 0 : 1;
}
