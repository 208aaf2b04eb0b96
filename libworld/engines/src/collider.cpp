// Which collision libraries are part of the build.

#include <kaboum/base/error.h>
#include <kaboum/engines/collider.h>

#include <array>

#include "adapters.h"

namespace kaboum::engines {
namespace {

/// A library, and what the build has of it.
struct Entry {
  Library library;
  const char *name, *title, *packages, *option;
  std::unique_ptr<Collider> (*make)(std::size_t) = nullptr;  ///< null: not built
  std::string (*version)() = nullptr;
};

constexpr std::array<Entry, 3> kEntries{{
    {Library::Fcl, "fcl", "FCL", "libfcl-dev and libccd-dev", "KABOUM_WITH_FCL",
#ifdef KABOUM_HAS_FCL
     make_fcl_collider, fcl_version
#endif
    },
    {Library::Bullet, "bullet", "Bullet", "libbullet-dev", "KABOUM_WITH_BULLET",
#ifdef KABOUM_HAS_BULLET
     make_bullet_collider, bullet_version
#endif
    },
    {Library::Ode, "ode", "ODE", "libode-dev", "KABOUM_WITH_ODE",
#ifdef KABOUM_HAS_ODE
     make_ode_collider, ode_version
#endif
    },
}};

/// Null: own predicates.
const Entry* entry_of(Library library) {
  for (const Entry& entry : kEntries)
    if (entry.library == library) return &entry;
  return nullptr;
}

}  // namespace

const char* name_of(Library library) {
  const Entry* entry = entry_of(library);
  return entry == nullptr ? "own" : entry->name;
}

bool is_built(Library library) {
  const Entry* entry = entry_of(library);
  return entry == nullptr || entry->make != nullptr;
}

std::string title_of(Library library) {
  const Entry* entry = entry_of(library);
  if (entry == nullptr) return "own";
  return entry->version == nullptr ? entry->title : entry->version();
}

std::unique_ptr<Collider> make_collider(Library library, std::size_t things) {
  const Entry* entry = entry_of(library);
  if (entry == nullptr)
    throw Error(ErrorCode::InvalidArgument, "own predicates are no library of others");
  if (entry->make == nullptr)
    throw Error(ErrorCode::NotBuilt, std::string("«engine»: this build has no ") + entry->title +
                                         ": install " + entry->packages + ", and build with -D" +
                                         entry->option + "=ON");
  return entry->make(things);
}

}  // namespace kaboum::engines
