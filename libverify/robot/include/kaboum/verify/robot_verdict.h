#pragma once

#include <kaboum/base/error.h>
#include <kaboum/base/length.h>
#include <kaboum/robot/link_regions.h>
#include <kaboum/robot/robot.h>
#include <kaboum/verify/bracket.h>
#include <kaboum/verify/claims.h>
#include <kaboum/verify/cover.h>
#include <kaboum/verify/points.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// The verdict on a robot: one answer and one sentence for each link, which programs and Python
/// print, write and end with.
namespace kaboum::verify {

/// The solid of a mesh that is to be held, besides every triangle of its file.
enum class Solid {
  AsFile,    ///< of a closed mesh: what it winds round, as it is oriented
  Prepared,  ///< what geom::prepare makes of it, holes filled; where it refuses: as Enclosed
  Enclosed,  ///< of a closed mesh: all that its triangles wind round, whichever way
};

/// A mesh file, read.
struct MeshFile {
  std::string path, sha256;
  geom::Mesh mesh;
  std::vector<std::string> notes = {};
  std::vector<std::uint32_t> quads = {};  ///< geom::PrepareOptions::quads
  /// Points of the exact faces that the triangles stand for, where these are looked at.
  std::optional<ExactPoints> exact = {};
  std::optional<Error> error = {};  ///< why it could not be read; then it has no mesh
};

/// Reads a mesh of a robot; what is wrong with it is kept, for it is one mesh's affair.
/// @param exact_points  how densely points of a CAD file's exact faces are taken; 0: none
/// @throws Error where no byte of it can be read, or the system fails
MeshFile read_mesh_file(const std::string& path, std::size_t exact_points);

/// True if what such an error is about is one mesh: that one is not held, and others are judged.
inline bool is_of_one_mesh(const Error& error) {
  return error.code() == ErrorCode::InvalidInput || error.code() == ErrorCode::LimitReached;
}

/// Question about two robots. Referred to while it is decided.
struct RobotQuestion {
  const robot::Robot& original;
  const robot::Robot& result;
  /// The file of a mesh of the original, or of the result. May throw; the value stays.
  std::function<const MeshFile&(const robot::Geometry& mesh, bool of_result)> file_of;
  std::vector<std::string> links = {};  ///< only these; empty: all
  bool visual = false;                  ///< shapes for drawing of the original are to be held
  Claims claims = Claims::All;
  Solid solid = Solid::AsFile;
  bool drop_sheets = false;  ///< with Solid::Prepared: nothing is asked about sheets
  /// No body is to be farther than this from the meshes that it holds: in the robot's unit, or of
  /// each mesh's diagonal.
  std::optional<Length> epsilon = {};
  /// Of links whose bodies are to be nearer, or may be farther; of regions in which they are to be
  /// nearer to the meshes of one frame that come there.
  robot::LinkBounds bounds = {};
  InclusionOptions limits = {};
  std::function<void(const std::string&)> progress = {};

  [[nodiscard]] bool is_asked(const robot::Link& link) const {
    return links.empty() || std::find(links.begin(), links.end(), link.name) != links.end();
  }
  /// The shapes to be held: for drawings, of links without, those for collisions, which stay.
  [[nodiscard]] const std::vector<robot::Geometry>& shapes_of(const robot::Link& link) const {
    return visual && !link.visual.empty() ? link.visual : link.collision;
  }
  [[nodiscard]] std::optional<Length> epsilon_of(const std::string& link) const {
    const auto own = bounds.epsilons.find(link);
    return own == bounds.epsilons.end() ? epsilon : std::optional(own->second);
  }
};

/// Verdict on one shape of a link.
struct ShapeVerdict {
  robot::Geometry::Shape shape = robot::Geometry::Shape::Mesh;
  std::string name;  ///< the file's, or the shape in words
  Answer answer = Answer::Undefined;
  std::string text;  ///< one clause
  // Of meshes.
  const MeshFile* file = nullptr;
  std::vector<const MeshFile*> held_by;
  /// Every triangle lies in what holds it; all that the mesh bounds does. Numbers of triangles are
  /// those of the file or, of the solid, of the mesh as prepared.
  std::optional<Claim> triangles, solid;
  std::optional<Bracket> sticks_out;  ///< of the triangles that do not [length, the mesh's own]
  bool closed = true;                 ///< else only the triangles were judged
  bool is_judged = true;              ///< else the mesh is none that claims can be decided of
  std::size_t triangles_without_area = 0, left_out = 0, dropped_sheets = 0;
  bool limited = false;
  std::optional<Claim> convex = {};             ///< of what holds it
  std::optional<PointClaim> exact_points = {};  ///< they refute, and prove nothing
  std::optional<DistanceClaim> distance = {};   ///< of the bodies; then `shape` means nothing
  std::optional<double> bound = {};             ///< of the distance
  bool of_surface = false;                      ///< the distance: HeldDistance::of_surface
  /// Name of the region that the distance is about; empty: it is about all of the bodies.
  std::string region = {};
  bool reached = true;  ///< else no body has a point in it
};

struct LinkVerdict {
  std::string link;
  Answer answer = Answer::Verified;
  std::string sentence;  ///< is every triangle of it inside: yes, or which not, and by how much
  std::vector<ShapeVerdict> shapes;
};

struct RobotVerdict {
  Answer answer = Answer::Verified;
  std::string motion;  ///< why the robots do not move alike; empty: they do
  std::vector<LinkVerdict> links;
  /// Shapes of the result that the original has no match for: how far they reach is not known.
  std::vector<std::pair<std::string, std::size_t>> strangers;
  /// Notes on files, for the user.
  std::vector<std::pair<std::string, std::string>> notes;
  bool open = false;  ///< the solid of an open mesh was not judged
};

/// Decides whether the result moves as the original, and whether every shape of the original's
/// links is held by the result's collision shapes of the same link. A mesh is held by meshes of its
/// frame (Holders), each box, cylinder and sphere by itself. Same meshes held by the same ones are
/// judged once. A mesh of the original that cannot be read, or of which no claim can be decided, is
/// not held; nor does it hold anything where the result has it as well.
/// @param judged  called with each verdict on a link as soon as it is there; may be empty
/// @throws Error as file_of; as MeshFile::error where nothing else is there to be judged, or of
///   another mesh of the result; Error{InvalidInput} where no link has a shape, or epsilon is no
///   length in a mesh's unit
RobotVerdict decide(const RobotQuestion& question,
                    const std::function<void(const LinkVerdict&)>& judged = {});

}  // namespace kaboum::verify
