#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/robot/model_text.h>

#include <functional>
#include <string>

namespace kaboum::robot {

/// The convex body in a file that a Geometry of a Model names; null: none is known of that name.
using MeshOfFile = std::function<const geom::Mesh*(const std::string& file)>;

/// The robot as USD with UsdPhysics, as text.
/// <https://openusd.org/release/api/usd_physics_page_front.html>
///
/// Links are rigid bodies side by side below the articulation's root, where they are with all
/// joints at 0; bodies are meshes with the approximation convexHull, below their link; boxes,
/// spheres, cylinders and capsules stay. Vertices are those of the bodies, which float32 holds
/// exactly, in the body's own frame; its scale and pose are doubles. Frames, limits and masses of
/// joints and links are float32, as UsdPhysics has them, rounded to nearest. The root is fixed to
/// the world. A joint's axis is X of its frames. Shapes for drawing are left out, and meshes that
/// stay, with a note.
/// @throws as require_valid; Error{OutputFailed} where float32 does not hold a vertex
ModelText to_usd(const Model& model, const MeshOfFile& mesh_of);

}  // namespace kaboum::robot
