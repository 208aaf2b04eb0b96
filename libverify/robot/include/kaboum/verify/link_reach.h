#pragma once

#include <kaboum/geom/convex_set.h>
#include <kaboum/robot/link_regions.h>
#include <kaboum/robot/mesh_files.h>
#include <kaboum/robot/robot.h>
#include <kaboum/verify/distance.h>

#include <optional>
#include <string>
#include <vector>

/// The distance that bodies of a robot's link reach beyond the link's shapes.
namespace kaboum::verify {

/// Shapes of a link as distances are measured to them: closed chains, in the link's frame. Meshes
/// are prepared as bcd-decompose does, holes filled; of what preparing refuses or leaves out, the
/// triangles count. Poses are rounded.
struct MeasuredLink {
  /// `inside` has polytopes within cylinders, spheres, capsules and ellipsoids, `round` such as
  /// hold them.
  geom::Mesh inside, round;
  /// The largest diagonal of a shape's box, which percentages are of: of a mesh before its pose,
  /// of another shape's polytope in the link's frame. [length]
  double diagonal = 0;
};

/// @param files  of the robot
/// @throws Error{InvalidInput} where a mesh cannot be read
MeasuredLink measured_link(const std::vector<robot::Geometry>& shapes, robot::MeshFiles& files);

/// Decides whether no point of a link's bodies is farther than `epsilon` from its shapes.
/// @param inside, round  bodies within those that are meant, and round them; may be the same
/// @pre epsilon > 0; all bodies are convex
DistanceClaim verify_link_reach(const geom::ConvexSet& inside, const geom::ConvexSet& round,
                                const MeasuredLink& link, double epsilon);

/// What was decided of a link's bodies.
struct LinkReach {
  /// Of all of them, where an epsilon of the link, or of all, is asked for.
  std::optional<DistanceClaim> all;
  double epsilon = 0;  ///< then [length]
  /// Of what of them lies in regions of the link, as asked for.
  struct InRegion {
    std::string name;
    double epsilon = 0;   ///< [length]
    bool reached = true;  ///< else no body has a point in it
    DistanceClaim claim = {};
  };
  std::vector<InRegion> regions;

  /// The worst; Verified where nothing was asked for.
  [[nodiscard]] Answer answer() const;
  /// "; no point of them is …" for each claim; empty where nothing was asked for.
  [[nodiscard]] std::string sentence() const;
};

/// Whether it is asked how far bodies of a link are from its shapes: of all, of it, or in a region
/// that is fixed to it.
bool asks_how_far(const std::string& link, std::optional<double> epsilon,
                  const robot::LinkBounds& bounds);
/// What is said of bodies of a link without shapes, where it is asked how far they are from them.
std::string text_of_bare_link(const std::string& link);

/// Adds the regions of a link in which its bodies are farther from it than these allow: "'notch' of
/// 'hand'".
void add_farther(const std::string& link, const LinkReach& reach, std::vector<std::string>& out);
/// The end of a summary that names them: "; farther than asked in the region 'notch' of 'hand'";
/// empty: there are none.
std::string text_of_farther(const std::vector<std::string>& regions);

/// Of a link whose shapes are points: nothing of it can be held, or missed.
std::string text_of_points(const std::string& link);

/// Decides how far a link's bodies reach beyond its shapes. Regions are known up to rounding: one
/// that holds what is meant verifies, one that lies in it refutes.
/// @param inside, round  as of verify_link_reach
/// @param epsilon  of links without one of their own
/// @param bounds   percentages are of MeasuredLink::diagonal: bodies that are within one of each
///   shape's own diagonal are within it
/// @throws Error{InvalidInput} as measured_link, and on percentages of shapes without extent
LinkReach decide_link_reach(const geom::ConvexSet& inside, const geom::ConvexSet& round,
                            const std::string& link, const std::vector<robot::Geometry>& shapes,
                            robot::MeshFiles& files, std::optional<double> epsilon,
                            const robot::LinkBounds& bounds);

/// The answer in words: "no point of them is farther than 0.02 from its shapes".
std::string sentence_of_reach(const DistanceClaim& claim, double epsilon);

}  // namespace kaboum::verify
