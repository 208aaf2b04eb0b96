#pragma once

#include <kaboum/base/option.h>
#include <kaboum/world/world.h>

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

/// Grasps and places of objects, derived from their convex sets: what a scene's author would
/// otherwise write by hand. docs/scene.md.
namespace kaboum::scene {

/// Request for grasps of an object by a tool.
///
/// A tool approaches along its z axis. Its fingers close along another axis of it, and their tips
/// are at its origin when they hold something.
struct GraspRequest {
  enum class Hold {
    Sides,  ///< two parallel faces, by two fingers
    Face,   ///< one face, by suction
  };
  enum class Form {
    Both,      ///< families have a higher rank then
    Families,  ///< what is free about a hold is left free
    Poses,     ///< single ones, in several directions
  };
  enum class Axis { X, Y };

  std::string robot = {};  ///< empty: the only one
  std::string tool = {};   ///< empty: the only one of the robot
  Hold hold = Hold::Sides;
  Form form = Form::Both;
  Axis closing = Axis::Y;  ///< of the tool: the fingers close along it
  /// Largest distance between two faces: how far the fingers open. [length]
  double opening = std::numeric_limits<double>::infinity();
  /// Of families: width of the fingers' tips, or diameter of the suction cup. All of it stays
  /// within the faces; none: it stays off the outer twentieth of the way to their edges. [length]
  std::optional<double> tip = {};
  /// Of single poses: of approach, evenly round the axis of closing or of suction.
  std::size_t directions = 8;
  std::size_t most = 24;  ///< grasps
  double gap = 0.001;     ///< from the tool to a face, beyond the ε of object and hand [length]
};

/// Grasps that were derived, and those that were left out.
struct DerivedGrasps {
  std::vector<world::Grasp> grasps;  ///< the largest faces first; called "TOOL/side-1", …
  /// Pairs of faces, or faces, that fit; of families, round sides in one direction of approach
  /// too. With both forms the larger number.
  std::size_t faces = 0;
  std::size_t in_contact = 0;  ///< grasps in contact with the hand, wherever the tool was put
  std::string contact;         ///< one of those contacts: "arm/palm"; empty: there was none
  /// Links of the hand whose contact with the object was not looked at: they have shapes but no
  /// set, or the contact is allowed.
  std::vector<std::string> unchecked;
  bool hand_unchecked = false;  ///< no link of the hand was looked at
};

/// Grasps of an object by its outer set: families, or single poses.
///
/// Families are anywhere on faces that no other body covers, turned about their normal, and round
/// the axes of sides that are round, within boxes of values. All members are free of contact
/// between the object and the hand (what moves with the tool), with the robot's joints at home, for
/// certain: docs/scene.md, "Grasps and places".
///
/// Single poses are at faces whose middle no other body covers. Of two fingers, the tool is in the
/// middle of where the faces face each other or, where the hand would be in contact, nearer to
/// where it comes from. Each is free likewise. Round bodies have no faces.
///
/// What is decided is the grasp by the numbers that a scene states. Whether an arm gets there, and
/// whether fingers or a cup reach what they hold, is not decided.
/// @throws Error{InvalidArgument} for names that the world does not have, and no directions
DerivedGrasps derive_grasps(const world::World& world, std::size_t object,
                            const GraspRequest& request);

/// The links of a robot's hand: those that move with its tool, by link.
std::vector<bool> links_of_hand(const world::RobotModel& robot, const world::ToolFrame& tool);

/// Where an object is at first, from its frame to the world; attached: as its robot holds it at
/// home.
geom::Transform pose_at_first(const world::World& world, std::size_t object);

/// Request for places where objects stand.
struct PlaceRequest {
  std::size_t most = 8;  ///< points on top of an object, and surfaces
  /// By which surfaces are smaller all round, beyond the set's ε; no percentage
  std::optional<Length> inset = {};
  bool replace = false;  ///< points and surfaces of these names that the scene has already
};

/// Places of an object, in its frame: the points "bottom", the middle of the faces on which it
/// stands as the scene has it (attached: as its robot at home holds it), and "top", "top2", … in
/// the middle of faces that look up; and the surfaces "face", "face2", …, convex parts of these
/// faces that no other body covers. The largest come first. Faces are level within 0.001 rad, or
/// within the set's ε where nearly all of a body is. docs/scene.md, "Grasps and places".
std::vector<world::Feature> derive_places(const world::World& world, std::size_t object,
                                          const PlaceRequest& request);

/// Entries that were written into a scene.
struct AddedFeatures {
  struct OfObject {
    std::string object;
    std::vector<std::string> names;  ///< of grasps or places that were derived
    std::vector<std::string> kept;   ///< of those that it had, and that stay in their place
    /// What it lacks of what was asked for, and why; or that no link of the hand was looked at.
    /// Empty: it lacks nothing.
    std::string shortfall;
    std::vector<std::string> unchecked;  ///< of grasps, as DerivedGrasps
  };
  std::vector<OfObject> objects;
  std::vector<std::string> notes;
};

/// Derives grasps of objects and writes them into the scene. Grasps of the tool that were derived
/// so before are replaced where some are found, all else stays (of YAML, but for comments).
/// @param objects  by name; empty: all
/// @throws Error as derive_grasps, world::read_scene; Error{InvalidInput} where a grasp would
/// change
///   that an attachment names, or grasps that may be those of another robot's tool of the same
///   name; Error{OutputFailed}
AddedFeatures add_grasps(const std::filesystem::path& scene,
                         const std::vector<std::string>& objects, const GraspRequest& request);

/// Likewise points on which objects are placed, and on which they stand, and surfaces.
AddedFeatures add_places(const std::filesystem::path& scene,
                         const std::vector<std::string>& objects, const PlaceRequest& request);

/// The options of deriving grasps.
const std::vector<Option<GraspRequest>>& grasp_options();

/// The options of deriving places.
const std::vector<Option<PlaceRequest>>& place_options();

}  // namespace kaboum::scene
