// Whether triangles stick out of the solid that is to hold them. The solid claim is certified by
// the steps; the surface claim fails only where triangles bound no solid (folds, inside-out parts,
// walls that reach out). libverify finds those that may, and decides each.

#include "mesh_surface.h"

#include <kaboum/geom/topology.h>
#include <kaboum/verify/loose_triangles.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace kaboum::certify {
namespace {

/// Of what is allowed for the surface of one result, for how far its triangles stick out.
constexpr double kDepthShare = 0.3;

}  // namespace

ClaimedSurface::ClaimedSurface(const geom::Prepared& original) : original_(original) {
  if (original.report.left_out.empty()) return;
  with_walls_ = original.solid.mesh();
  for (const geom::LeftOut& wall : original.report.left_out) {
    const auto n = static_cast<std::uint32_t>(with_walls_.vertices.size());
    with_walls_.vertices.insert(with_walls_.vertices.end(), wall.corners.begin(),
                                wall.corners.end());
    with_walls_.triangles.push_back({n, n + 1, n + 2});
  }
}

const std::vector<std::uint32_t>& ClaimedSurface::loose() {
  if (looked_) return loose_;
  looked_ = true;
  loose_ = original_.report.loose ? *original_.report.loose
                                  : verify::find_loose_triangles(original_.solid.mesh());
  const auto walls = static_cast<std::uint32_t>(original_.solid.mesh().triangles.size());
  for (std::uint32_t i = 0; i < original_.report.left_out.size(); ++i) loose_.push_back(walls + i);
  return loose_;
}

std::uint32_t ClaimedSurface::source(std::uint32_t t) const {
  const std::size_t triangles = original_.solid.mesh().triangles.size();
  if (t >= triangles) return original_.report.left_out[t - triangles].source;
  return t < original_.report.source.size() ? original_.report.source[t] : kFill;
}

double work_for_surface(double allowed, double done, std::size_t results) {
  constexpr double kLeast = 0.15, kMost = 0.25;  // of what is allowed
  if (!std::isfinite(allowed)) return allowed;
  return std::clamp(allowed - done, kLeast * allowed, kMost * allowed) /
         static_cast<double>(results);
}

DecidedSurface decide_surface(const geom::Mesh& from, const std::vector<std::uint32_t>& triangles,
                              const geom::Mesh& to, double work) {
  DecidedSurface out;
  out.looked_at = triangles.size();
  out.claim.answer = verify::Answer::Verified;
  if (triangles.empty()) return out;
  geom::Mesh part;
  part.vertices = from.vertices;
  part.triangles.reserve(triangles.size());
  for (const std::uint32_t t : triangles) part.triangles.push_back(from.triangles[t]);
  if (triangles.size() < from.triangles.size()) part = geom::weld(part);
  verify::InclusionOptions options;
  options.surface_only = true;
  options.max_work = (1 - kDepthShare) * work;
  const verify::Inclusion found = verify::verify_inclusion(part, to, options);
  out.claim = found.surface;
  out.left_out = found.left_out;
  for (std::uint32_t& t : out.claim.inner_triangles) t = triangles[t];
  return out;
}

void measure_sticking_out(const geom::Mesh& from, const geom::Mesh& to, double work,
                          DecidedSurface& surface) {
  verify::BracketEffort effort;
  effort.max_work = kDepthShare * work;
  surface.sticks_out =
      verify::bracket_distance(from, surface.claim.inner_triangles, to, true, effort);
}

}  // namespace kaboum::certify
