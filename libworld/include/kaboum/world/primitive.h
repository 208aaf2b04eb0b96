#pragma once

#include <kaboum/collide/bounding_set.h>

#include <string>

namespace kaboum::world {

/// A shape by its sizes, in a frame at its middle with the axis along z; a plane's frame lies in
/// its surface, which looks along +z.
struct Primitive {
  enum class Kind {
    Box,
    Sphere,
    Cylinder,
    Capsule,  ///< `length` is that of its axis: without the caps
    Plane,    ///< a plate below its surface: `size` wide along x and y, and thick along z
  };
  Kind kind = Kind::Box;
  geom::Vec3 size = geom::Vec3::Zero();  ///< of boxes and planes, > 0 [length]
  double radius = 0, length = 0;         ///< of the others, > 0 [length]
};

const char* name_of(Primitive::Kind kind);

/// The bodies of a primitive. They are the shape itself (epsilon 0), but for cylinders: prisms of
/// 64 sides round it, no point farther than 0.13 % of the radius.
collide::BoundingSet outer_set(const Primitive& primitive);
/// Bodies inside it: the shape itself; of cylinders, prisms of 64 sides within.
collide::BoundingSet inner_set(const Primitive& primitive);

/// A closed mesh within the shape, as for exact judges; no point of the shape is farther from it
/// than 0.03 % of the radius.
geom::Mesh mesh_of(const Primitive& primitive);

/// As in scene files (docs/scene.md): {"box": {"size": [x, y, z]}}, …
std::string to_json(const Primitive& primitive);

/// Primitive that `text` describes, as `to_json` writes it.
/// @param name  of what has it, for messages
/// @throws Error{InvalidInput} naming the place in the text
Primitive parse_primitive(const std::string& text, const std::string& name);

}  // namespace kaboum::world
