#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/robot/dynamics.h>
#include <kaboum/robot/primitive.h>

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

/// Robots as MuJoCo describes them: MJCF.
/// <https://mujoco.readthedocs.io/en/stable/XMLreference.html>
namespace kaboum::robot {

/// The text of a model with what it includes put in the place of each <include>; as it is where it
/// includes nothing.
/// @param name  of the file, for messages
/// @param read    gives the text of a file, named relative to the model; throws Error where it is
///   not there. MuJoCo looks for included files beside the model, then beside the file that
///   includes them; for files of meshes that these name in the compiler's folder, then beside
///   these.
/// @param exists  whether a file is there, named relative to the model; none: meshes are in the
///   compiler's folder
/// @throws Error{InvalidInput} naming the line: not well-formed, a file included twice
std::string expand_mjcf(std::string_view text, const std::string& name,
                        const std::function<std::string(const std::string& file)>& read,
                        const std::function<bool(const std::string& file)>& exists = {});

/// The text of a model with what it attaches put in the place of each <attach>, as MuJoCo 4.0 does;
/// as it is where it attaches nothing. Files of assets are named relative to the model then. Key
/// frames of attached models are left out.
/// @param text  without includes
/// @param name  of the file, for messages
/// @param read  gives the text of a file, named relative to the model
/// @throws Error{InvalidInput} naming the line: as expand_mjcf; models, bodies, frames that are not
///   there; models attached to themselves; compilers that contradict each other;
///   Error{LimitReached}
std::string attach_mjcf(std::string_view text, const std::string& name,
                        const std::function<std::string(const std::string& file)>& read);

/// Gives the mesh of a file, named relative to the model.
using MeshSource = std::function<geom::Mesh(const std::string& file)>;

/// The text of a model in which every primitive that MuJoCo fits to a mesh states its size and
/// pose, as MuJoCo 4.0 computes them; as it is where there is none.
/// @param text  without includes
/// @throws as parse_mjcf; Error{InvalidInput} naming the line: a mesh without volume, one whose
///   moments are those of its hull, or one that a default class names
std::string state_fitted_sizes(std::string_view text, const std::string& name,
                               const MeshSource& meshes);

/// A robot and what it weighs.
struct MjcfRobot {
  Robot robot;
  Dynamics dynamics;
};

/// Robot of an MJCF document without includes, as MuJoCo 4.0 compiles it: default classes, frames,
/// replicated bodies, all ways of stating a rotation, `fromto`.
///
/// Link 0 is the world. Every body is a link of its name. A joint that does not turn about the
/// body's origin, and all but the last of several, have links without shapes of their own. Shapes
/// for collisions are the geoms that may collide (`contype`, `conaffinity`, <pair>); for drawing
/// the other ones, or where a body has none those for collisions, which MuJoCo draws. A mesh is
/// that of its file, of which MuJoCo collides the hull. Free and ball joints and mocap bodies are
/// fixed where they are in the file, and Robot::unmodelled says so. Planes and height fields, which
/// only the part has that stands still, are left out with a note.
/// @param name  appears in messages.
/// @throws Error{InvalidInput} naming the line where known: not well-formed; unknown classes and
///   meshes; geoms fitted to meshes (state_fitted_sizes), signed distance fields, meshes without a
///   file, composites, flexible bodies, and attached models (attach_mjcf).
MjcfRobot parse_mjcf(std::string_view text, const std::string& name);

/// Files of meshes that stand for one shape of a link, named as the text is to name them; none: the
/// shape itself.
using ShapeMeshes = std::optional<std::vector<std::string>>;

/// Edit of a document: its new collision shapes.
struct ShapeEdit {
  bool visual = false;  ///< they stand for the shapes for drawing
  /// By link, those that stand for its shapes; an empty list leaves the link as it is.
  std::vector<std::vector<ShapeMeshes>> links;
  /// Files of meshes that do not exist, as Geometry::mesh: MJCF loses all that needs them, since
  /// MuJoCo reads no model with one.
  std::set<std::string> left_out = {};
  /// A name of a file, relative to the robot's folder, as it is in the new document.
  std::function<std::string(const std::string& file)> moved;
  /// By link, what stands for all of its shapes together, in its frame; such links have nothing in
  /// `links`.
  std::map<std::size_t, std::vector<Primitive>> primitives = {};
};

/// The document with other collision geoms, each with pose, scale and contact parameters of the one
/// that it stands for. All else stays, masses too: of bodies that take them from geoms the old ones
/// stay without collisions, and the new ones weigh nothing. Assets' files are renamed. Primitives
/// have contact parameters and class of the first geom that they stand for.
/// @param text  that parse_mjcf reads
/// @throws as parse_mjcf; Error{InvalidInput} naming a link whose primitives a class makes others
/// of
std::string mjcf_with_shapes(std::string_view text, const std::string& name, const ShapeEdit& edit);

}  // namespace kaboum::robot
