// Sets of convex bodies that are decided to be what they should be on the bytes that are written:
// search, serialise, read back, decide, and once more with other means where that fails.

#include <kaboum/base/error.h>
#include <kaboum/bcd/balls.h>
#include <kaboum/bcd/inner.h>
#include <kaboum/bcd/simple_bodies.h>
#include <kaboum/certify/convex_set.h>
#include <kaboum/certify/mesh.h>
#include <kaboum/geom/facets.h>
#include <kaboum/geom/width.h>
#include <kaboum/io/convex_io.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/region_excess.h>

#include <algorithm>
#include <array>
#include <limits>
#include <utility>

#include "given_solid.h"
#include "issuer.h"
#include "mesh_certifier.h"
#include "request.h"

namespace kaboum::certify {
namespace {

/// Allowances for rounding, tried one after the other.
constexpr std::array<double, 3> kSafety{1, 64, 4096};
/// So often places that inner bodies must not reach are handed to another search.
constexpr int kAvoided = 5;
/// So often places that bodies leave out are handed to another search; to one that goes on from
/// what was found.
constexpr int kHeld = 20, kHeldOn = 100;
/// Of epsilon, that a wrap round the input may take; the bodies have what it leaves.
constexpr double kWrapShare = 0.5;
/// For sums of three lengths.
constexpr double kSumUp = 1 + 0x1p-50;

/// Reason why bodies of a kind that is not polytopes cannot be what is asked for, to stand behind
/// its name; null: they can.
const char* flaw_of_kind(const SetRequest& r) {
  if (r.direction != SetRequest::Direction::Outer && r.body_kind != SetRequest::BodyKind::Spheres)
    return "lie in no solid here: outer sets only";
  if (r.thickness || r.max_aspect)
    return "cannot be thickened, as a least thickness, a largest aspect or an engine (mujoco) "
           "asks for";
  if (r.max_total_vertices) return "have no vertices to be counted";
  if (r.max_facets) return "have no facets to be counted";
  if (r.pre_step == bcd::PreStep::On) return "have no pre-step";
  if (r.simplify) return "are not simplified";
  return nullptr;
}

bcd::SearchRun run_of(const SetRequest& r, double diagonal, const Hooks& hooks) {
  bcd::SearchRun run;
  if (const auto epsilon = r.wanted_epsilon()) run.epsilon = epsilon->of(diagonal);
  run.regions = geom::bounded(r.regions, diagonal);
  if (hooks.progress)
    run.progress = [&](const bcd::Progress& p) {
      hooks.progress(p.stage + " " + std::to_string(static_cast<int>(100 * p.fraction)) + " %");
    };
  return run;
}

/// @throws Error{InvalidArgument} on what only bodies that cover can be asked
bcd::InnerOptions inner_of(const SetRequest& r, double diagonal, const Hooks& hooks) {
  const auto refuse = [](bool condition, const char* what) {
    if (condition)
      throw Error(ErrorCode::InvalidArgument, std::string("bodies inside the solid ") + what);
  };
  refuse(r.thickness || r.max_aspect, "cannot be thickened");
  refuse(r.max_total_vertices.has_value(), "have no limit on all vertices together");
  refuse(r.max_facets.has_value(), "have no limit on their facets");
  refuse(r.pre_step == bcd::PreStep::On, "have no pre-step");
  refuse(r.simplify.has_value(), "are not simplified");
  refuse(r.improve_work.has_value(), "are not fewer for more work");
  return {r, run_of(r, diagonal, hooks), {}};
}

/// @throws Error{InvalidArgument} on what only polytopes can be asked
void require_possible(const SetRequest& r) {
  if (const char* flaw = flaw_of_kind(r))
    throw Error(ErrorCode::InvalidArgument, std::string(name_of(r.body_kind)) + " " + flaw);
}

bcd::BallOptions balls_of(const SetRequest& r, double diagonal, const Hooks& hooks) {
  require_possible(r);
  bcd::BallOptions out;
  static_cast<bcd::SearchRun&>(out) = run_of(r, diagonal, hooks);
  out.max_bodies = r.max_bodies;
  out.effort = r.effort;
  out.nearest = r.nearest && !r.max_bodies;
  out.most = r.most_spheres;
  return out;
}

bcd::InnerBallOptions inner_balls_of(const SetRequest& r, double diagonal, const Hooks& hooks) {
  require_possible(r);
  bcd::InnerBallOptions out;
  static_cast<bcd::SearchRun&>(out) = run_of(r, diagonal, hooks);
  out.max_bodies = r.max_bodies;
  out.effort = r.effort;
  return out;
}

bcd::SimpleBodyOptions simple_of(const SetRequest& r, double diagonal, const Hooks& hooks) {
  require_possible(r);
  using BodyKind = SetRequest::BodyKind;
  bcd::SimpleBodyOptions out;
  static_cast<bcd::SearchRun&>(out) = run_of(r, diagonal, hooks);
  out.kinds.balls = r.body_kind == BodyKind::Mixed;
  out.kinds.capsules = r.body_kind != BodyKind::Boxes;
  out.kinds.boxes = r.body_kind != BodyKind::Capsules;
  out.max_bodies = r.max_bodies;
  out.effort = r.effort;
  return out;
}

/// Why a set does not do what it should, decided exactly.
struct Refutation {
  std::string reason;  ///< empty when it does
  /// Of the solid's mesh: what bounds parts of inner bodies that are outside.
  std::vector<std::uint32_t> triangles;
  std::vector<geom::Vec3> left_out;  ///< points of the solid that are in no body
};

/// @throws Error{InvalidArgument} on what does not go together with regions
void require_possible_regions(const SetRequest& r) {
  if (r.regions.empty()) return;
  const auto refuse = [](bool condition, const char* what) {
    if (condition)
      throw Error(ErrorCode::InvalidArgument,
                  std::string("an epsilon of regions does not go with ") + what);
  };
  refuse(r.direction != SetRequest::Direction::Outer, "bodies inside the solid");
  refuse(r.max_bodies.has_value() || r.max_total_vertices.has_value(),
         "a limit on the number of bodies or vertices");
  refuse(r.thickness.has_value(), "a least thickness, which the engine mujoco asks for, too");
  refuse(r.max_aspect.has_value(), "a limit on how long bodies are");
}

/// Least width of the bodies that is asked for; 0: none. [length]
double least_thickness(const SetRequest& r, double diagonal) {
  return r.thickness ? r.thickness->of(diagonal) : 0;
}

/// @param reach  distance or depth that the certificate states [length]
Refutation refutation_of(const SetRequest& r, const geom::Mesh& solid, double diagonal,
                         const geom::ConvexSet& set, double reach) {
  for (const geom::ConvexBody& body : set.bodies) {
    if (const double wished = least_thickness(r, diagonal);
        wished > 0 && geom::least_width(body.core, wished).lower < wished)
      return {"a body is thinner than «min-thickness»", {}, {}};
    if (r.max_facets && geom::float32_facet_count(body.core) > *r.max_facets)
      return {"a body has more facets than «max-facets-per-body»", {}, {}};
    if (!r.max_aspect) continue;
    const double least = geom::longest_upper(body.core.vertices) / *r.max_aspect;
    if (geom::least_width(body.core, least).lower < least)
      return {"a body is thinner for its length than «max-aspect» allows", {}, {}};
  }
  const auto first_of = [](std::initializer_list<const verify::Claim*> claims) -> std::string {
    for (const verify::Claim* claim : claims)
      if (claim->answer != verify::Answer::Verified) return claim->reason;
    return {};
  };
  verify::InclusionOptions options;
  options.max_work = std::numeric_limits<double>::infinity();  // it has to be decided
  if (r.direction == SetRequest::Direction::Outer) {
    const verify::Cover cover = verify::verify_cover(solid, set, options);
    Refutation out{
        first_of({&cover.convexity.convex, &cover.inclusion.solid, &cover.inclusion.surface}),
        {},
        {}};
    for (const verify::Claim* claim : {&cover.inclusion.solid, &cover.inclusion.surface})
      if (claim->answer != verify::Answer::Verified && claim->witness)
        out.left_out.push_back(claim->witness->point);
    for (const geom::BoundedRegion& region : geom::bounded(r.regions, diagonal)) {
      if (!out.reason.empty()) break;
      const verify::DistanceClaim claim =
          verify::verify_region_excess(set, solid, region, true, options);
      if (claim.answer != verify::Answer::Verified)
        out.reason = "in the region " + region.name + ": " + claim.reason;
    }
    return out;
  }
  const auto left_out = [&] {
    if (r.body_kind != SetRequest::BodyKind::Spheres) return std::string();
    const verify::Claim depth = verify::verify_depth(solid, set, reach, options);
    return first_of({&depth});
  };
  // Of a solid that is deep nowhere: nothing is claimed to lie in it.
  if (set.bodies.empty()) return {left_out(), {}, {}};
  if (geom::find_not_convex(set)) return {"a body is not convex", {}, {}};
  const verify::Inclusion inside = verify::verify_within(set, solid, options);
  Refutation out{first_of({&inside.solid, &inside.surface}), inside.solid.outer_triangles, {}};
  if (out.reason.empty()) out.reason = left_out();
  out.triangles.insert(out.triangles.end(), inside.surface.outer_triangles.begin(),
                       inside.surface.outer_triangles.end());
  return out;
}

/// How far points of a wrap may be from the surface that the triangles in it stand for. [length]
double distance_of(const WrapCertificate& wrap) {
  return (wrap.farthest_upper + wrap.clearance) * kSumUp;
}

/// What a search has found, of either direction.
struct Candidate {
  std::vector<geom::ConvexBody> bodies;
  bcd::Stop stop = bcd::Stop::Done;
  double lower = 0, upper = 0;  ///< of the distance that the certificate states [length]
  bcd::CoverStatistics statistics;
};

/// Searches; again where what was found does not pass the exact check, each time with other means.
class Search {
 public:
  /// The solid is referred to.
  Search(const geom::SolidMesh& solid, const SetRequest& request, double diagonal,
         const Hooks& hooks)
      : solid_(solid) {
    const bool outer = request.direction == SetRequest::Direction::Outer;
    if (request.body_kind == SetRequest::BodyKind::Spheres && !outer)
      inner_balls_ = inner_balls_of(request, diagonal, hooks);
    else if (request.body_kind == SetRequest::BodyKind::Spheres)
      balls_ = balls_of(request, diagonal, hooks);
    else if (request.body_kind != SetRequest::BodyKind::Polytopes)
      simple_.emplace(solid, simple_of(request, diagonal, hooks));
    else if (outer)
      cover_ = bcd::CoverOptions{request, run_of(request, diagonal, hooks),
                                 least_thickness(request, diagonal)};
    else
      inner_ = inner_of(request, diagonal, hooks);
    if (simple_ && !request.max_bodies) most_held_ = kHeldOn;
  }

  Candidate run() {
    if (balls_) {
      bcd::CoverCandidate found = bcd::find_balls(solid_, *balls_);
      if (!balls_->max_bodies) {  // where another search is needed
        balls_->start.clear();
        for (const geom::ConvexBody& body : found.bodies)
          balls_->start.push_back({body.core.vertices[0], body.radius});
      }
      return {std::move(found.bodies), found.stop, found.excess_lower, found.excess_upper,
              found.statistics};
    }
    if (simple_) {
      bcd::CoverCandidate found = left_out_.empty() ? simple_->find() : simple_->hold(left_out_);
      return {std::move(found.bodies), found.stop, found.excess_lower, found.excess_upper,
              found.statistics};
    }
    if (cover_) {
      bcd::CoverCandidate found = bcd::find_cover(solid_, *cover_);
      simplified_ = found.statistics.pre_step_triangles > 0;
      return {std::move(found.bodies), found.stop, found.excess_lower, found.excess_upper,
              found.statistics};
    }
    bcd::InnerCandidate found = inner_balls_ ? bcd::find_inner_balls(solid_, *inner_balls_)
                                             : bcd::find_inner(solid_, *inner_);
    bcd::CoverStatistics s;
    s.leaves = found.bodies.size();
    s.vertices = found.vertices;
    s.largest = found.largest;
    s.out_of_work = found.out_of_work;
    return {std::move(found.bodies), found.stop, found.uncovered_depth_lower,
            found.uncovered_depth_upper, s};
  }

  /// Allowance for rounding of the last run.
  [[nodiscard]] double safety() const { return kSafety[tried_]; }

  /// Chooses other means after a refutation. @return which, in words; empty: there are none left.
  std::string other_means(const Refutation& found) {
    if (balls_ || simple_) {
      left_out_ = found.left_out;
      if (balls_) balls_->held.insert(balls_->held.end(), left_out_.begin(), left_out_.end());
      tried_ = ++held_ < most_held_ && !found.left_out.empty() ? 0 : kSafety.size();
      return "to hold the places found";
    }
    if (simplified_) {
      cover_->pre_step = bcd::PreStep::Off;
      return "without simplifying the input first";
    }
    const bool has_new = (inner_ || inner_balls_) && avoid(found.triangles);
    if (has_new && avoided_ < kAvoided) {
      ++avoided_;
      return "to keep clear of the places found";
    }
    ++tried_;
    if (tried_ < kSafety.size()) run_in_use().safety = kSafety[tried_];
    return "with larger allowances for rounding";
  }
  [[nodiscard]] bool is_exhausted() const { return tried_ >= kSafety.size(); }

 private:
  [[nodiscard]] bcd::SearchRun& run_in_use() {
    if (cover_) return *cover_;
    if (inner_) return *inner_;
    return *inner_balls_;
  }

  /// @return whether some of the triangles are new
  bool avoid(const std::vector<std::uint32_t>& triangles) {
    std::vector<std::uint32_t>& doubtful = inner_ ? inner_->doubtful : inner_balls_->doubtful;
    const std::size_t known = doubtful.size();
    doubtful.insert(doubtful.end(), triangles.begin(), triangles.end());
    std::sort(doubtful.begin(), doubtful.end());
    doubtful.erase(std::unique(doubtful.begin(), doubtful.end()), doubtful.end());
    return doubtful.size() > known;
  }

  const geom::SolidMesh& solid_;
  std::optional<bcd::BallOptions> balls_;
  std::optional<bcd::SimpleBodySearch> simple_;
  std::optional<bcd::CoverOptions> cover_;
  std::optional<bcd::InnerOptions> inner_;
  std::optional<bcd::InnerBallOptions> inner_balls_;
  std::vector<geom::Vec3> left_out_;  // by what was found last
  std::size_t tried_ = 0;             // allowances for rounding
  int avoided_ = 0, held_ = 0, most_held_ = kHeld;
  bool simplified_ = false;
};

/// Of the request's regions those that bodies within epsilon may reach, with lengths; others are
/// taken away, into `apart`.
void take_apart(const geom::Box3& box, double epsilon, SetRequest& r,
                std::vector<geom::RequestedRegion>& apart) {
  std::array<geom::Vec3, 8> corners;
  for (unsigned i = 0; i < corners.size(); ++i)
    for (unsigned k = 0; k < 3; ++k) corners[i][k] = ((i >> k) & 1U ? box.max : box.min)[k];
  std::vector<geom::RequestedRegion> near;
  for (geom::RequestedRegion& one : r.regions) {
    one.epsilon = Length{one.epsilon.of(box.diagonal())};
    const bool is_apart = geom::distance_from(one.region, corners) > 1.001 * epsilon;
    (is_apart ? apart : near).push_back(std::move(one));
  }
  r.regions = std::move(near);
}

/// A wrap round the input, and what it leaves of epsilon and of those of regions to the search: `r`
/// becomes that.
/// @param apart  gets regions that bodies within epsilon do not reach
CertifiedWrap wrapped(const geom::Mesh& mesh, SetRequest& r,
                      std::vector<geom::RequestedRegion>& apart, const Hooks& hooks) {
  if (r.direction != SetRequest::Direction::Outer)
    throw Error(ErrorCode::InvalidArgument,
                "what lies in a wrap need not lie in the input: bodies inside it have none");
  const auto epsilon = r.wanted_epsilon();
  const geom::Box3 box = geom::bounding_box(mesh);
  const double whole = epsilon ? epsilon->of(box.diagonal()) : 0;
  take_apart(box, whole, r, apart);
  double finest = whole;
  for (const geom::RequestedRegion& one : r.regions) finest = std::min(finest, one.epsilon.value);
  WrapRequest asked = *r.wrap;
  asked.float32 = asked.may_be_double = true;
  asked.progress = hooks.progress;
  asked.farthest.reset();
  if (epsilon) asked.farthest = kWrapShare * finest;
  CertifiedWrap made = certify_wrap(mesh, asked);
  const auto rest_of = [&](double length) {
    const double rest = length / (kSumUp * kSumUp) - distance_of(made.certificate());
    if (!(rest > 0))
      throw Error(
          ErrorCode::InvalidInput,
          "the wrap and the exact faces' deviation leave nothing of epsilon for the bodies; "
          "allow a larger epsilon");
    return Length{rest};
  };
  if (epsilon) r.epsilon = rest_of(whole);
  for (geom::RequestedRegion& one : r.regions) one.epsilon = rest_of(one.epsilon.value);
  return made;
}

/// A region that the bodies may reach after all; empty: none.
std::string reached_of(const geom::ConvexSet& set,
                       const std::vector<geom::RequestedRegion>& regions) {
  for (const geom::RequestedRegion& one : regions)
    if (verify::may_reach(set, one.region))
      return "bodies come into the region " + one.name + ", which is farther than epsilon";
  return {};
}

/// Why not every triangle of a mesh is in the bodies; empty: they are.
std::string outside_of(const geom::ConvexSet& set, const geom::Mesh& mesh) {
  verify::InclusionOptions options;
  options.surface_only = true;
  const verify::Claim claim = verify::verify_cover(mesh, set, options).inclusion.surface;
  return claim.answer == verify::Answer::Verified ? std::string() : claim.reason;
}

/// Adds how far a wrap is from the surface that it holds to what is certified of its cover.
void count_wrap(const WrapCertificate& wrap, const std::string& why, SetCertificate& c) {
  c.wrap = wrap;
  c.subject.wrapped = true;
  c.distance_upper = (c.distance_upper + distance_of(wrap)) * kSumUp;
  c.diagonal = wrap.diagonal;
  c.notes.insert(c.notes.begin(), in_words(wrap));
  if (!why.empty()) c.notes.insert(c.notes.begin(), why_wrapped(why));
}

SetCertificate certificate_of(const SetRequest& r, const geom::Prepared& prepared,
                              const Candidate& found, double diagonal, double safety) {
  const bcd::CoverStatistics& s = found.statistics;
  SetCertificate c;
  c.direction = r.direction;
  c.depth_decided =
      r.direction == SetRequest::Direction::Inner && r.body_kind == SetRequest::BodyKind::Spheres;
  c.stop = found.stop;
  c.bodies = found.bodies.size();
  c.vertices = s.vertices;
  c.largest_body_vertices = s.largest;
  c.distance_lower = found.lower;
  c.distance_upper = found.upper;
  c.diagonal = diagonal;
  c.subject = subject_of(prepared.report);
  c.largest_hole = prepared.report.largest_hole;
  c.filled_triangles = s.filled_triangles;
  c.pieces = s.leaves;
  c.pre_step_triangles = s.pre_step_triangles;
  c.thickened = s.thickened;
  c.min_thickness = least_thickness(r, diagonal);
  c.max_aspect = r.max_aspect.value_or(0);
  c.max_facets = r.max_facets.value_or(0);
  if (r.max_facets)
    for (const geom::ConvexBody& body : found.bodies)
      c.most_facets = std::max(c.most_facets, geom::float32_facet_count(body.core));
  c.safety = safety;
  c.out_of_work = s.out_of_work;
  c.notes = prepared.report.notes;
  return c;
}

}  // namespace

namespace {

/// @param because  a wrap is needed for this reason; empty: as far as is known it is not
std::optional<CertifiedSet> certify(const geom::Mesh& mesh, const std::string& sha256,
                                    const SetRequest& request, const Hooks& hooks,
                                    const std::string& because) {
  const auto note = [&](const std::string& text) {
    if (hooks.note) hooks.note(text);
  };
  const bool outer = request.direction == SetRequest::Direction::Outer;
  require_possible_regions(request);
  SetRequest asked = request;
  std::vector<geom::RequestedRegion> apart;
  // A flat sheet that is closed by its own fill has no volume.
  const Prepare plain = [](const geom::Mesh& given, const geom::PrepareOptions& options) {
    return geom::prepare(given, options);
  };
  const Prepare prepare = asked.wrap && asked.wrap->where_needed ? prepare_mesh : plain;
  if (asked.wrap) asked.wrap->input_triangles = mesh.triangles.size();
  const GivenSolid given = give_solid(
      mesh, prepare, asked.preparation, asked.wrap,
      [&](const geom::Mesh& triangles) { return wrapped(triangles, asked, apart, hooks); },
      because);
  const std::optional<CertifiedWrap>& wrap = given.wrap;
  const geom::Prepared& prepared = given.prepared;
  if (!given.why.empty()) note(why_wrapped(given.why));
  if (wrap) note(in_words(wrap->certificate()));
  const geom::Mesh& solid = prepared.solid.mesh();
  if (outer) require_area(solid);
  const double diagonal = geom::bounding_box(solid).diagonal();
  for (const std::string& text : prepared.report.notes) note(text);
  Search search(prepared.solid, asked, diagonal, hooks);
  geom::ConvexSet made;
  made.provenance = origin_of(request, sha256);
  made.provenance.covers_surface = outer && prepared.report.dropped_sheets == 0;
  made.provenance.covers_solid = outer && prepared.report.holes == 0;
  std::string wrong;
  while (!search.is_exhausted()) {
    const double safety = search.safety();
    const Candidate candidate = search.run();
    if (candidate.stop == bcd::Stop::TooCoarse) return std::nullopt;
    made.bodies = candidate.bodies;
    SetCertificate certificate = certificate_of(request, prepared, candidate, diagonal, safety);
    if (wrap) count_wrap(wrap->certificate(), given.why, certificate);
    made.provenance.epsilon = certificate.distance_upper;
    std::vector<char> container = io::serialise_convex_set(made, io::SetFormat::Glb);
    // What is written is what is verified.
    if (hooks.progress) hooks.progress("verifying");
    geom::ConvexSet set = io::parse_convex_set(container, io::Format::Glb, "the result");
    Refutation found = refutation_of(asked, solid, diagonal, set, certificate.distance_upper);
    if (found.reason.empty() && wrap && !given.wrapped.empty())
      found.reason = outside_of(set, given.wrapped);
    if (found.reason.empty()) found.reason = reached_of(set, apart);
    wrong = found.reason;
    if (wrong.empty()) {
      const double of_regions = wrap ? geom::bounding_box(mesh).diagonal() : diagonal;
      for (const geom::BoundedRegion& one : geom::bounded(request.regions, of_regions))
        certificate.regions.push_back({one.name, one.epsilon, verify::may_reach(set, one.region)});
      // Segments, and walls of which the solid holds middle and corners.
      if (outer && !wrap && !prepared.report.left_out.empty())
        if (const std::string out = outside_of(set, mesh); !out.empty()) {
          if (because.empty() && request.wrap && request.wrap->where_needed)
            return certify(mesh, sha256, request, hooks,
                           "walls, or triangles with repeated corners, would stick out");
          throw Error(
              ErrorCode::InvalidInput,
              "walls, or triangles with repeated corners, stick out of the solid (" + out + ")");
        }
      if (outer && !wrap)
        certificate.undecided =
            undecided_solid(mesh, prepared, asked.preparation, verify::sum_of(set));
      return Issuer::issue(std::move(set), std::move(certificate), std::move(container));
    }
    note("the bodies found do not pass the exact check (" + wrong + "); trying " +
         search.other_means(found));
  }
  if (request.body_kind != SetRequest::BodyKind::Polytopes || !request.regions.empty())
    throw Error(ErrorCode::LimitReached, "no " + std::string(plural_of(request.body_kind)) +
                                             " were found that pass the exact check (" + wrong +
                                             "); nothing is written. A larger «epsilon»" +
                                             (outer ? ", or «prepare=wrap»," : "") + " may help");
  throw Error(ErrorCode::Internal,
              "no bodies were found that pass the exact check (" + wrong + "); nothing is written");
}

}  // namespace

std::optional<CertifiedSet> certify_set(const geom::Mesh& mesh, const std::string& sha256,
                                        const SetRequest& request, const Hooks& hooks) {
  return certify(mesh, sha256, request, hooks, {});
}

}  // namespace kaboum::certify
