#pragma once

#include <kaboum/engines/collider.h>

namespace kaboum::engines {

// Each where its library is part of the build.
std::unique_ptr<Collider> make_fcl_collider(std::size_t things);
std::unique_ptr<Collider> make_bullet_collider(std::size_t things);
std::unique_ptr<Collider> make_ode_collider(std::size_t things);
std::string fcl_version();
std::string bullet_version();
std::string ode_version();

}  // namespace kaboum::engines
