// What the options of bcd-decompose ask for.

#include <kaboum/certify/convex_set.h>

#include <map>
#include <optional>
#include <string>

#include "decompose_options.h"

namespace kaboum::tools {
namespace {

const std::map<std::string, bcd::Effort> kEfforts{
    {"fast", bcd::Effort::Fast}, {"normal", bcd::Effort::Normal}, {"best", bcd::Effort::Best}};

const std::map<std::string, bcd::Method> kMethods{{"planes", bcd::Method::Planes},
                                                  {"clusters", bcd::Method::Clusters},
                                                  {"voxels", bcd::Method::Voxels}};

const std::map<std::string, bcd::PreStep> kPreSteps{
    {"auto", bcd::PreStep::Auto}, {"on", bcd::PreStep::On}, {"off", bcd::PreStep::Off}};

}  // namespace

certify::SetRequest request_of(const DecomposeOptions& o) {
  certify::SetRequest r;
  if (o.direction != "outer") r.direction = certify::SetRequest::Direction::Inner;
  if (!o.epsilon.empty()) r.epsilon = parse_length(o.epsilon);
  if (o.max_bodies > 0) r.max_bodies = o.max_bodies;
  if (o.max_total > 0) r.max_total_vertices = o.max_total;
  r.max_vertices = o.max_vertices;
  r.effort = kEfforts.at(o.effort);
  r.method = kMethods.at(o.method);
  r.pre_step = kPreSteps.at(o.pre_step);
  r.simplify = o.simplify;
  r.max_work = o.max_work;
  r.improve_work = o.improve_work;
  r.min_thickness = o.min_thickness;
  r.preparation = o.prepare;
  r.preparation.holes = o.holes.value();
  o.preparation.apply(r.preparation);
  if (r.preparation.holes == geom::Holes::Keep) r.preparation.holes = geom::Holes::Refuse;
  const bool if_needed = o.preparation.name == "auto" && o.direction == "outer" &&
                         r.preparation.holes == geom::Holes::Fill &&
                         !r.preparation.keep_orientation;
  if (o.preparation.wraps() || if_needed) r.wrap = o.preparation.request(std::nullopt);
  if (r.wrap) r.wrap->where_needed = if_needed;
  r.hold_exact_faces = o.preparation.holds_exact_faces();
  r.unit = o.unit;
  r.scale = o.scale;
  r.frame = o.frame;
  return r;
}

}  // namespace kaboum::tools
