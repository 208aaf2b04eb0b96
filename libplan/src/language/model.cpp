// What a model says of itself.
#include <kaboum/plan/model.h>

#include <algorithm>

namespace kaboum::plan {

bool Model::is_a(Index object, Index type) const {
  const auto& all = types[type].objects;
  return std::binary_search(all.begin(), all.end(), object);
}

}  // namespace kaboum::plan
