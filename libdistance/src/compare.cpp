// Two shapes measured against each other, both ways: largest, smallest and mean distances.
#include <kaboum/base/error.h>
#include <kaboum/distance/compare.h>
#include <kaboum/distance/search.h>
#include <kaboum/geom/topology.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/inclusion.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace kaboum::distance {

using geom::Vec3;

double Compared::lower() const { return std::max(a_to_b.max.max_lower, b_to_a.max.max_lower); }
double Compared::upper() const { return std::max(a_to_b.max.max_upper, b_to_a.max.max_upper); }

/// Calls visit(points) for every array of coordinates.
template <class Visit>
void Comparison::Measured::each_points(Visit&& visit) {
  if (!shape.set) return visit(shape.mesh.vertices);
  for (geom::ConvexBody& body : shape.set->bodies) visit(body.core.vertices);
}

geom::Box3 Comparison::Measured::box() const {
  if (!shape.set) return geom::bounding_box(shape.mesh);
  geom::Box3 box;
  for (const geom::ConvexBody& body : shape.set->bodies) {
    for (const Vec3& p : body.core.vertices) {
      box.extend(p - Vec3::Constant(body.radius));
      box.extend(p + Vec3::Constant(body.radius));
    }
  }
  return box;
}

std::function<double(const Vec3&, double)> Comparison::Measured::distance() const {
  if (!solid) return nullptr;
  return [this](const Vec3& p, double d) { return solid->distance(p, d); };
}

Comparison::Comparison(Shape a, Shape b, CompareOptions options) : options_(std::move(options)) {
  sides_[A].shape = std::move(a);
  sides_[B].shape = std::move(b);
  for (Measured& side : sides_) {
    const std::string& name = side.shape.name;
    if (side.shape.set ? side.shape.set->bodies.empty() : side.shape.mesh.empty())
      throw Error(ErrorCode::InvalidInput,
                  name + (side.shape.set ? ": the empty set has no distance"
                                         : ": no triangles to measure to"));
    if (side.shape.set && geom::margin_of(*side.shape.set) != 0.0 && !options_.solid)
      throw Error(ErrorCode::InvalidInput,
                  name +
                      ": bodies with a radius have a curved surface, to which distances are not "
                      "stable (gaps close); measure solid to solid («solid»)");
    side.each_points([&](const std::vector<Vec3>& points) {
      for (const Vec3& v : points)
        if (!v.allFinite())
          throw Error(ErrorCode::InvalidInput, name + ": a coordinate is not finite");
    });
  }
  require_range();
  move_to_origin();
  for (Measured& side : sides_) find_surface(side);
  progress("building search structures");
  for (Measured& side : sides_) side.search = make_search(side.surface, options_.backend);
}

void Comparison::progress(const std::string& stage) const {
  if (options_.progress) options_.progress(stage);
}

/// The distance bounds hold below 1e60 only.
void Comparison::require_range() const {
  geom::Box3 both;
  for (const Measured& side : sides_) {
    const geom::Box3 box = side.box();
    if (box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff() > 1e60)
      throw Error(ErrorCode::InvalidInput,
                  side.shape.name + ": coordinates beyond 1e60; scale the mesh");
    both.extend(box);
  }
  const double extent = (both.max - both.min).maxCoeff();
  if (extent > 0 && extent < 1e-60)
    throw Error(ErrorCode::InvalidInput, sides_[A].shape.name + ", " + sides_[B].shape.name +
                                             ": extent below 1e-60; scale the meshes");
}

void Comparison::move_to_origin() {
  geom::Box3 box = sides_[A].box();
  box.extend(sides_[B].box());
  diagonal_ = box.diagonal();
  for (int axis = 0; axis < 3; ++axis) {
    const double shift = box.min[axis];
    if (std::max(std::abs(shift), std::abs(box.max[axis])) <= box.max[axis] - shift) continue;
    // Knuth's two-sum gives the rounding error of a difference.
    const auto exact = [&](double x) {
      const double d = x - shift, back = x - d;
      return (x - (d + back)) + (back - shift) == 0;
    };
    bool all = true;
    for (Measured& side : sides_)
      side.each_points([&](const std::vector<Vec3>& points) {
        all = all && std::all_of(points.begin(), points.end(),
                                 [&](const Vec3& v) { return exact(v[axis]); });
      });
    if (!all) continue;
    origin_[axis] = shift;
    for (Measured& side : sides_)
      side.each_points([&](std::vector<Vec3>& points) {
        for (Vec3& v : points) v[axis] -= shift;
      });
  }
}

void Comparison::find_surface(Measured& side) const {
  const Shape& shape = side.shape;
  progress("boundary of " + shape.name);
  try {
    if (options_.solid) {
      side.solid =
          shape.set ? std::make_unique<Solid>(*shape.set) : std::make_unique<Solid>(shape.mesh);
      side.surface = side.solid->boundary().mesh;
      side.error = side.solid->boundary().error;
    } else if (shape.set) {
      Boundary boundary = union_boundary(*shape.set);
      side.surface = std::move(boundary.mesh);
      side.error = boundary.error;
    } else {
      side.surface = shape.mesh;
    }
  } catch (const Error& error) {
    throw Error(error.code(), shape.name + ": " + error.what());
  }
}

Compared Comparison::measure() const {
  const Measured &a = sides_[A], &b = sides_[B];
  Compared out;
  out.a_to_b = one_way("A to B", a, b);
  out.b_to_a = one_way("B to A", b, a);
  progress("smallest distance");
  if (options_.solid) {
    out.min = solid_minimum(*a.solid, *b.solid);
  } else {
    out.min = minimum_distance(a.surface, b.surface);
    // Surfaces that stand for others at a distance of at most `error`.
    const double error = a.error + b.error;
    for (OneWay* way : {&out.a_to_b, &out.b_to_a}) {
      way->max.max_lower = std::max(0.0, way->max.max_lower - error);
      way->max.max_upper += error;
    }
    out.min.lower = std::max(0.0, out.min.lower - error);
    out.min.upper += error;
  }
  for (OneWay* way : {&out.a_to_b, &out.b_to_a}) {
    way->max.at += origin_;
    way->nearest += origin_;
  }
  out.min.on_a += origin_;
  out.min.on_b += origin_;
  return out;
}

/// Whether one solid lies within the other, decided exactly: all distances are then 0, which
/// branch and bound only approaches where their surfaces coincide.
bool Comparison::certainly_within(const Measured& from, const Measured& to) {
  if (from.solid->margin() > to.solid->margin() || from.solid->defect() > 0) return false;
  const auto chain = [](const Measured& side) {
    return side.shape.set ? verify::sum_of(*side.shape.set) : side.shape.mesh;
  };
  const geom::Mesh inner = chain(from);
  for (const Vec3& v : from.surface.vertices)
    if (to.solid->contains(v) == std::optional(false)) return false;
  return verify::verify_inclusion(inner, chain(to)).solid.answer == verify::Answer::Verified;
}

OneWay Comparison::one_way(const char* name, const Measured& from, const Measured& to) const {
  OneWay way;
  geom::DistanceOptions d;
  d.relative_gap = options_.relative_gap;
  progress(std::string(name) + ": largest distance");
  if (!options_.solid) {
    static_cast<geom::DirectedDistance&>(way.max) =
        geom::directed_distance(*from.search, *to.search, d);
  } else if (certainly_within(from, to)) {
    way.max.at = from.surface.vertices[from.surface.triangles.front()[0]];
    way.max.within_gap = true;
  } else {
    way.max = solid_distance(*from.solid, *to.solid, *from.search, *to.search, d);
  }
  const auto& [a, b, c] = to.search->corners(to.search->nearest(way.max.at).triangle);
  way.nearest = geom::nearest_point(way.max.at, a, b, c);
  progress(std::string(name) + ": sampling");
  way.sampled =
      sample_distances(from.surface, *to.search, options_.samples, options_.seed, to.distance());
  return way;
}

std::vector<double> Comparison::distances(const geom::Mesh& from, Side side) const {
  const Measured& to = sides_[side];
  const auto distance = to.distance();
  std::vector<double> values(from.vertices.size(), 0);
  std::uint32_t hint = geom::TriangleSearch::kNone;
  for (std::size_t v = 0; v < values.size(); ++v) {
    const auto nearest = to.search->nearest(from.vertices[v], hint);
    hint = nearest.triangle;
    values[v] = distance ? distance(from.vertices[v], nearest.upper) : nearest.upper;
  }
  return values;
}

}  // namespace kaboum::distance
