#pragma once

#include <kaboum/certify/link_enclosures.h>
#include <kaboum/certify/robot.h>

#include <cstdint>
#include <string>
#include <vector>

/// The verdict on each link of a robot that was made: what programs print, report, show on pages
/// and end with.
namespace kaboum::certify {

/// Verdicts of a link, the best first.
enum class Outcome {
  Held,       ///< every triangle is inside, as near as asked for
  Late,       ///< every triangle is inside; the work allowed ended before epsilon was reached
  Far,        ///< every triangle is inside, but not as asked for
  Undecided,  ///< whether every triangle is inside
  Outside,    ///< not every triangle is inside
  Kept,       ///< a mesh could not be held: it stays as it was, and nothing is said about it
  Missing,    ///< a mesh has no file (ShapeChoice::skip_missing): it is left out, likewise
};

/// "held", "work ended", "epsilon not reached", "undecided", "not held", "kept", "missing".
const char* name_of(Outcome outcome);

/// One answer to one question: is every triangle of the link inside?
struct LinkVerdict {
  std::uint32_t link = 0;
  std::size_t shapes = 0;
  Outcome outcome = Outcome::Held;
  std::string sentence;            ///< yes, or which not, and by how much
  std::size_t dropped_sheets = 0;  ///< triangles of sheets dropped on request, which are not inside
};

/// Verdicts of the links asked for that have shapes, in order.
std::vector<LinkVerdict> verdicts(const CertifiedBodies& robot);
std::vector<LinkVerdict> verdicts(const CertifiedRobot& robot);
std::vector<LinkVerdict> verdicts(const LinkEnclosures& robot);

/// What came of a region of links (RobotRequest::regions), of all links together.
struct RegionVerdict {
  std::string name;
  std::vector<std::string> links;  ///< in whose frames it is
  bool held = true;      ///< no point of a mesh's bodies in it is farther than its epsilon
  bool reached = false;  ///< else no body has a point in it
  double epsilon = 0;    ///< the largest of its meshes [length, as the robot]
  /// True if each of its meshes has an epsilon that is no larger anyway.
  bool is_idle = false;
};

/// Of all regions, those of the first links first; those of one name are one.
std::vector<RegionVerdict> region_verdicts(const robot::RobotFile& robot,
                                           const robot::LinkRegions& regions,
                                           const CertifiedBodies& bodies);

/// "distance in the region 'grip': nowhere more than 0.002", or what else came of it.
std::string in_words(const RegionVerdict& region);

/// The worst of all.
Outcome outcome_of(const std::vector<LinkVerdict>& links);

/// "every triangle of all 8 links is inside", or of how many links it is not.
std::string in_words(const std::vector<LinkVerdict>& links);

}  // namespace kaboum::certify
