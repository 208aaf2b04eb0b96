// Whether triangles stick out of the solid that encloses what they bound. The solid claim is
// certified by the steps; the surface claim fails only where faces bound no solid (folds,
// inside-out parts). So faces of the original are sampled, and where some bound none, libverify
// decides.

#include "mesh_surface.h"

#include <kaboum/geom/winding.h>

#include <algorithm>
#include <cmath>

namespace kaboum::certify {
namespace {

/// Of what is allowed for the surface of one result, for how far its triangles stick out.
constexpr double kDepthShare = 0.3;
/// Distance inwards at which a face's inner side is looked at, in diagonals of the box.
constexpr double kInwards = 1e-9;

}  // namespace

SurfaceSamples sample_surface(const geom::Mesh& mesh) {
  constexpr std::size_t kMost = 20000, kRounds = 16, kEnough = 1000, kMostCrossings = 400'000;
  const geom::WindingNumber winding(mesh);
  const double diagonal = geom::bounding_box(mesh).diagonal();
  const std::size_t step = mesh.triangles.size() / kMost + 1;
  SurfaceSamples samples;
  std::size_t crossings = 0;
  const auto look_at = [&](const geom::Triangle& tri) {
    const geom::Vec3 &a = mesh.vertices[tri[0]], &b = mesh.vertices[tri[1]],
                     &c = mesh.vertices[tri[2]];
    const geom::Vec3 n = (b - a).cross(c - a);
    if (!(n.norm() > 0)) return;
    int w = 0;
    bool touches = false;
    winding.crossings((a + b + c) / 3.0 - n * (kInwards * diagonal / n.norm()),
                      [&](std::uint32_t, int sign) {
                        ++crossings;
                        w += sign;
                        touches = touches || sign == 0;
                      });
    if (touches) return;
    ++samples.faces;
    samples.outside += w < 1;
  };
  for (std::size_t round = 0; round < kRounds; ++round) {
    for (std::size_t t = round * step; t < mesh.triangles.size(); t += kRounds * step) {
      if (crossings > kMostCrossings) {
        samples.cut_short = true;
        return samples;
      }
      look_at(mesh.triangles[t]);
    }
    if (samples.outside > 0 && samples.faces >= kEnough) break;
  }
  return samples;
}

double work_for_surface(double allowed, double done, std::size_t results) {
  constexpr double kLeast = 0.15, kMost = 0.25;  // of what is allowed
  if (!std::isfinite(allowed)) return allowed;
  return std::clamp(allowed - done, kLeast * allowed, kMost * allowed) /
         static_cast<double>(results);
}

DecidedSurface decide_surface(const geom::Prepared& original, const geom::Mesh& result, bool outer,
                              double work) {
  verify::InclusionOptions options;
  options.surface_only = true;
  options.max_work = (1 - kDepthShare) * work;
  const verify::Inclusion found = verify::verify_inclusion(
      outer ? original.solid.mesh() : result, outer ? result : original.solid.mesh(), options);
  return {found.surface, found.left_out, {}, false};
}

void measure_sticking_out(const geom::Prepared& original, const geom::Mesh& result, bool outer,
                          double work, DecidedSurface& surface) {
  const geom::Mesh &from = outer ? original.solid.mesh() : result,
                   &to = outer ? result : original.solid.mesh();
  verify::BracketEffort effort;
  effort.max_work = kDepthShare * work;
  surface.sticks_out =
      verify::bracket_distance(from, surface.claim.inner_triangles, to, true, effort);
  std::uint32_t& triangle = surface.sticks_out.triangle;
  surface.at_filling = outer && triangle >= original.report.source.size();
  if (outer && !surface.at_filling) triangle = original.report.source[triangle];
}

}  // namespace kaboum::certify
