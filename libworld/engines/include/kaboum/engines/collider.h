#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/geom/transform.h>

#include <cstddef>
#include <memory>
#include <string>

/// Collision libraries of others, to compare with and to measure against. Nothing that they answer
/// is certified. docs/algorithms/collision-engines.md.
namespace kaboum::engines {

/// A library that decides whether things collide.
enum class Library {
  Own,     ///< bounded predicates (libcollide)
  Fcl,     ///< the Flexible Collision Library, with libccd for convex bodies
  Bullet,  ///< in single precision, as packaged
  Ode,     ///< the Open Dynamics Engine: surfaces only
};

/// "own", "fcl", "bullet", "ode".
const char* name_of(Library library);
/// With its version: "FCL 0.7.0 with libccd"; of Own, and of what is not built, the name alone.
std::string title_of(Library library);
bool is_built(Library library);

/// Things in a library: what each consists of, where it is, and which two of them meet. For one
/// thread at a time.
class Collider {
 public:
  Collider() = default;
  Collider(const Collider&) = delete;
  Collider& operator=(const Collider&) = delete;
  virtual ~Collider() = default;

  /// Gives a thing a convex body more, in its frame. What is round is given as a polytope round it
  /// (geom::surface_of), where the library does not know it.
  virtual void add(std::size_t thing, const geom::ConvexBody& body) = 0;
  /// Gives a thing triangles more: the library looks at the surface. A thing has either bodies or
  /// triangles.
  virtual void add(std::size_t thing, const geom::Mesh& mesh) = 0;
  /// Places a thing. @pre all that it consists of was added.
  virtual void put(std::size_t thing, const geom::Transform& pose) = 0;
  /// Whether two things meet, as the library says. @pre both were placed.
  virtual bool meet(std::size_t a, std::size_t b) = 0;
};

/// @param things  how many there are
/// @throws Error{InvalidArgument} for Own, Error{NotBuilt} with the remedy for a library that is
///   not part of this build.
std::unique_ptr<Collider> make_collider(Library library, std::size_t things);

}  // namespace kaboum::engines
