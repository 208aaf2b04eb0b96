// Which collision libraries are part of the build.

#include <kaboum/base/error.h>
#include <kaboum/engines/collider.h>

#include "adapters.h"

namespace kaboum::engines {
namespace {

#ifdef KABOUM_HAS_FCL
constexpr bool kFcl = true;
#else
constexpr bool kFcl = false;
#endif
#ifdef KABOUM_HAS_BULLET
constexpr bool kBullet = true;
#else
constexpr bool kBullet = false;
#endif
#ifdef KABOUM_HAS_ODE
constexpr bool kOde = true;
#else
constexpr bool kOde = false;
#endif

[[noreturn]] void refuse(const char* library, const char* packages, const char* option) {
  throw Error(ErrorCode::NotBuilt, std::string("«engine»: this build has no ") + library +
                                       ": install " + packages + ", and build with -D" + option +
                                       "=ON");
}

}  // namespace

const char* name_of(Library library) {
  switch (library) {
    case Library::Fcl:
      return "fcl";
    case Library::Bullet:
      return "bullet";
    case Library::Ode:
      return "ode";
    case Library::Own:
      break;
  }
  return "own";
}

bool is_built(Library library) {
  switch (library) {
    case Library::Fcl:
      return kFcl;
    case Library::Bullet:
      return kBullet;
    case Library::Ode:
      return kOde;
    case Library::Own:
      break;
  }
  return true;
}

std::string title_of(Library library) {
#ifdef KABOUM_HAS_FCL
  if (library == Library::Fcl) return fcl_version();
#endif
#ifdef KABOUM_HAS_BULLET
  if (library == Library::Bullet) return bullet_version();
#endif
#ifdef KABOUM_HAS_ODE
  if (library == Library::Ode) return ode_version();
#endif
  return name_of(library);
}

std::unique_ptr<Collider> make_collider(Library library, std::size_t things) {
  switch (library) {
    case Library::Fcl:
#ifdef KABOUM_HAS_FCL
      return make_fcl_collider(things);
#else
      refuse("FCL", "libfcl-dev and libccd-dev", "KABOUM_WITH_FCL");
#endif
    case Library::Bullet:
#ifdef KABOUM_HAS_BULLET
      return make_bullet_collider(things);
#else
      refuse("Bullet", "libbullet-dev", "KABOUM_WITH_BULLET");
#endif
    case Library::Ode:
#ifdef KABOUM_HAS_ODE
      return make_ode_collider(things);
#else
      refuse("ODE", "libode-dev", "KABOUM_WITH_ODE");
#endif
    case Library::Own:
      break;
  }
  throw Error(ErrorCode::InvalidArgument, "own predicates are no library of others");
}

}  // namespace kaboum::engines
