// The Hausdorff distance of two meshes in one call.

#include <kaboum/base/error.h>
#include <kaboum/distance/hausdorff.h>
#include <kaboum/distance/search.h>

#include <algorithm>

namespace kaboum::distance {

double Hausdorff::lower() const { return std::max(from_a.max_lower, from_b.max_lower); }
double Hausdorff::upper() const { return std::max(from_a.max_upper, from_b.max_upper); }

Hausdorff hausdorff(const geom::Mesh& a, const geom::Mesh& b,
                    const geom::DistanceOptions& options) {
  for (const geom::Mesh* mesh : {&a, &b})
    for (const geom::Vec3& v : mesh->vertices)
      if (!v.allFinite()) throw Error(ErrorCode::InvalidInput, "a coordinate is not finite");
  const auto search_a = make_search(a, Backend::Embree), search_b = make_search(b, Backend::Embree);
  return {geom::directed_distance(*search_a, *search_b, options),
          geom::directed_distance(*search_b, *search_a, options)};
}

}  // namespace kaboum::distance
