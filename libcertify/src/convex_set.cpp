// Sets of convex bodies that are decided to be what they should be on the bytes that are written:
// search, serialise, read back, decide, and once more with other means where that fails.

#include <kaboum/base/error.h>
#include <kaboum/bcd/fill.h>
#include <kaboum/certify/convex_set.h>
#include <kaboum/geom/width.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>

#include <algorithm>
#include <array>

#include "issuer.h"
#include "request.h"

namespace kaboum::certify {
namespace {

/// Allowances for rounding, tried one after the other.
constexpr std::array<double, 3> kSafety{1, 64, 4096};
/// So often places that inner bodies must not reach are handed to another search.
constexpr int kAvoided = 5;

bcd::DecomposeOptions options_of(const SetRequest& r, double diagonal, const Hooks& hooks) {
  bcd::DecomposeOptions options;
  if (const auto epsilon = r.wanted_epsilon()) options.epsilon = epsilon->of(diagonal);
  options.max_bodies = r.max_bodies;
  options.max_total_vertices = r.max_total_vertices;
  options.max_vertices = r.max_vertices;
  options.effort = r.effort;
  options.method = r.method;
  options.min_thickness = r.min_thickness;
  if (r.simplify) options.simplify = *r.simplify;
  options.max_work = r.max_work;
  options.pre_step = r.pre_step;
  if (hooks.progress)
    options.progress = [&](const bcd::Progress& p) {
      hooks.progress(p.stage + " " + std::to_string(static_cast<int>(100 * p.fraction)) + " %");
    };
  return options;
}

/// Why a set does not do what it should, decided exactly.
struct Objection {
  std::string reason;  ///< empty when it does
  /// Of the solid's mesh: what bounds parts of inner bodies that are outside.
  std::vector<std::uint32_t> triangles;
};

Objection objection(const SetRequest& r, const geom::Mesh& solid, const geom::ConvexSet& set) {
  for (const geom::ConvexBody& body : set.bodies)
    if (r.min_thickness > 0 &&
        geom::least_width(body.hull, r.min_thickness).lower < r.min_thickness)
      return {"a body is thinner than --min-thickness", {}};
  const auto first_of = [](std::initializer_list<const verify::Claim*> claims) -> std::string {
    for (const verify::Claim* claim : claims)
      if (claim->answer != verify::Answer::Verified) return claim->reason;
    return {};
  };
  if (r.direction == SetRequest::Direction::Outer) {
    const verify::Cover cover = verify::verify_cover(solid, set);
    return {first_of({&cover.convex, &cover.inclusion.solid, &cover.inclusion.surface}), {}};
  }
  if (geom::find_not_convex(set)) return {"a body is not convex", {}};
  const verify::Inclusion inside = verify::verify_inclusion(verify::sum_of(set), solid);
  Objection out{first_of({&inside.solid, &inside.surface}), inside.solid.outer_triangles};
  out.triangles.insert(out.triangles.end(), inside.surface.outer_triangles.begin(),
                       inside.surface.outer_triangles.end());
  return out;
}

SetCertificate certificate_of(const SetRequest& r, const geom::Prepared& prepared,
                              const bcd::DecomposeResult& result, std::size_t bodies,
                              double diagonal, double safety) {
  const bcd::DecomposeStatistics& s = result.statistics;
  SetCertificate c;
  c.direction = r.direction;
  c.stop = result.stop;
  c.bodies = bodies;
  c.vertices = s.vertices;
  c.largest_body_vertices = s.largest;
  c.distance_lower = result.reach_lower;
  c.distance_upper = result.reach_upper;
  c.diagonal = diagonal;
  c.subject = subject_of(prepared);
  c.largest_hole = prepared.largest_hole;
  c.filled_triangles = s.filled_triangles;
  c.pieces = s.leaves;
  c.pre_step_triangles = s.pre_step_triangles;
  c.thickened = s.thickened;
  c.min_thickness = r.min_thickness;
  c.safety = safety;
  c.out_of_work = s.out_of_work;
  c.notes = prepared.notes;
  c.method = r.method;
  return c;
}

}  // namespace

std::optional<CertifiedSet> certify_set(const geom::Mesh& mesh, const std::string& sha256,
                                        const SetRequest& request, const Hooks& hooks) {
  const auto note = [&](const std::string& text) {
    if (hooks.note) hooks.note(text);
  };
  const bool outer = request.direction == SetRequest::Direction::Outer;
  const geom::Prepared prepared = geom::prepare(mesh, request.preparation);
  const double diagonal = geom::bounding_box(prepared.mesh).diagonal();
  for (const std::string& text : prepared.notes) note(text);
  bcd::DecomposeOptions options = options_of(request, diagonal, hooks);
  geom::ConvexSet made;
  made.provenance = origin_of(request, sha256);
  made.provenance.covers_surface = outer && prepared.dropped_sheets == 0;
  made.provenance.covers_solid = outer && prepared.holes == 0;
  std::string wrong;
  int avoided = 0;
  for (auto safety = kSafety.begin(); safety != kSafety.end();) {
    options.safety = *safety;
    bcd::DecomposeResult result =
        outer ? bcd::decompose(prepared, options) : bcd::fill(prepared, options);
    if (result.stop == bcd::Stop::TooCoarse) return std::nullopt;
    made.bodies = std::move(result.bodies);
    made.provenance.epsilon = result.reach_upper;
    std::vector<char> container = io::serialise_convex_set(made, io::SetFormat::Glb);
    // What is written is what is verified.
    if (hooks.progress) hooks.progress("verifying");
    geom::ConvexSet set = io::parse_convex_set(container, io::Format::Glb, "the result");
    const Objection found = objection(request, prepared.mesh, set);
    wrong = found.reason;
    if (wrong.empty())
      return Issuer::issue(
          std::move(set),
          certificate_of(request, prepared, result, made.bodies.size(), diagonal, *safety),
          std::move(container));
    const bool simplified = result.statistics.pre_step_triangles > 0;
    const std::size_t doubted = options.doubtful.size();
    options.doubtful.insert(options.doubtful.end(), found.triangles.begin(), found.triangles.end());
    std::sort(options.doubtful.begin(), options.doubtful.end());
    options.doubtful.erase(std::unique(options.doubtful.begin(), options.doubtful.end()),
                           options.doubtful.end());
    const bool avoid = options.doubtful.size() > doubted && avoided < kAvoided;
    note("the bodies found do not pass the exact check (" + wrong + "); trying " +
         (simplified ? "without simplifying the input first"
          : avoid    ? "to keep clear of the places found"
                     : "with larger allowances for rounding"));
    if (simplified) {
      options.pre_step = bcd::PreStep::Off;
    } else if (avoid) {
      ++avoided;
    } else {
      ++safety;
    }
  }
  throw Error(ErrorCode::Internal,
              "no bodies were found that pass the exact check (" + wrong + "); nothing is written");
}

}  // namespace kaboum::certify
