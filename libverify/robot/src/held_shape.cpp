// Whether the meshes that a result has in a frame of a link hold what the original has there.
#include <kaboum/geom/topology.h>
#include <kaboum/verify/distance.h>
#include <kaboum/verify/held_shape.h>

#include <algorithm>

namespace kaboum::verify {
namespace {

bool closed(const geom::Mesh& mesh) { return geom::analyse(geom::weld(mesh)).closed(); }

bool has_area(const geom::Mesh& mesh) {
  return std::any_of(mesh.triangles.begin(), mesh.triangles.end(), [&](const geom::Triangle& t) {
    return !geom::is_degenerate(mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]);
  });
}

}  // namespace

Holders::Holders(const std::vector<NamedMesh>& meshes) : given_(meshes.size()) {
  for (const auto& [name, mesh] : meshes) {
    if (!closed(*mesh)) {
      left_out_.emplace_back(name, "it is not closed and holds nothing");
    } else if (!(geom::signed_volume(*mesh) > 0)) {
      left_out_.emplace_back(name, "it is inside out and holds nothing");
    } else {
      set_.bodies.push_back({name, *mesh});
    }
  }
  if (given_ == 1 && set_.bodies.empty()) lone_ = *meshes.front().mesh;
  convex_ = verify_convexity(set_).convex;
  sum_ = sum_of(set_);
}

bool Holders::lone_refutes(const geom::Mesh& mesh, const InclusionOptions& limits) const {
  if (!lone_ || lone_->triangles.empty()) return false;
  if (!closed(*lone_)) return true;
  InclusionOptions options = limits;
  options.surface_only = true;
  options.max_work = options.max_work.value_or(usual_work(mesh.triangles.size()));
  return verify_inclusion(mesh, *lone_, options).surface.answer == Answer::Refuted;
}

HeldShape Holders::hold(const geom::Mesh& mesh, Claims claims,
                        const InclusionOptions& limits) const {
  if (!(geom::signed_volume(mesh) < 0) || !has_area(mesh) || !closed(mesh))
    return hold_any(mesh, claims, limits);
  HeldShape out;
  out.prepare_helps = true;
  out.answer = Answer::Undecided;
  out.reason = "it is inside out: its volume is negative";
  return out;
}

HeldShape Holders::hold_any(const geom::Mesh& mesh, Claims claims,
                            const InclusionOptions& limits) const {
  HeldShape out;
  const auto undecided = [&](const char* why) {
    out.answer = Answer::Undecided;
    out.reason = why;
    return out;
  };
  if (mesh.triangles.empty()) return undecided("it has no triangles");
  if (set_.bodies.empty()) {
    const bool any = claims != Claims::Solid || (closed(mesh) && geom::signed_volume(mesh) != 0);
    undecided("the result's link has no closed mesh of its pose and scale");
    if (given_ == 0 && any) out.answer = Answer::Refuted;
    if (claims != Claims::Solid && lone_refutes(mesh, limits)) {
      out.answer = Answer::Refuted;
      out.reason = "the result's link has one mesh of its pose and scale, which does not hold it";
    }
    return out;
  }
  const Inclusion& in = out.inclusion.emplace(verify_inclusion(mesh, sum_, limits));
  // Segments and points bound nothing; whether they stick out is the surface claim.
  out.solid = claims != Claims::Surface && in.inner_closed && has_area(mesh);
  out.surface = claims != Claims::Solid;
  for (const auto& [claim, counts] :
       {std::pair{&in.solid, out.solid}, std::pair{&in.surface, out.surface}})
    if (counts &&
        (!out.decisive || worse(claim->answer, out.decisive->answer) != out.decisive->answer))
      out.decisive = *claim;
  if (!out.decisive) {
    out.answer = Answer::Undefined;
    out.reason = "it is not closed, so that it bounds no solid";
    return out;
  }
  out.answer = out.decisive->answer;
  if (out.answer == Answer::Refuted && !refutes()) out.answer = Answer::Undecided;
  if (out.decisive->answer != Answer::Refuted) out.reason = out.decisive->reason;
  return out;
}

namespace {

/// All meshes; `to_solid` becomes false where one is open.
geom::Mesh sum_of_meshes(const std::vector<geom::Mesh>& meshes, bool& to_solid) {
  geom::ConvexSet all;
  for (const geom::Mesh& mesh : meshes) {
    all.bodies.push_back({"", mesh});
    to_solid = to_solid && closed(mesh);
  }
  return sum_of(all);
}

}  // namespace

HeldDistance Holders::distance(const std::vector<geom::Mesh>& meshes, double bound,
                               const InclusionOptions& limits) const {
  HeldDistance out;
  if (set_.bodies.empty() || set_.bodies.size() < given_) return out;
  const geom::Mesh all = sum_of_meshes(meshes, out.to_solid);
  out.of_surface = !all_convex();
  DistanceClaimOptions options;
  options.to_solid = out.to_solid;
  out.claim = out.of_surface ? verify_distance(sum_, all, bound, options)
                             : verify_excess(set_, all, bound, out.to_solid, limits);
  return out;
}

HeldDistance Holders::distance_in_region(const std::vector<geom::Mesh>& meshes,
                                         const geom::BoundedRegion& region,
                                         const InclusionOptions& limits) const {
  HeldDistance out;
  if (set_.bodies.empty() || set_.bodies.size() < given_ || !all_convex()) return out;
  const geom::Mesh all = sum_of_meshes(meshes, out.to_solid);
  out.claim = verify_region_excess(set_, all, region, out.to_solid, limits);
  return out;
}

}  // namespace kaboum::verify
