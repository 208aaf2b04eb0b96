#pragma once

#include <kaboum/scene/derived_features.h>

#include <functional>
#include <optional>
#include <vector>

#include "hand.h"
#include "yaml.h"

/// Families of grasps that leave the hand free of contact: what a hold leaves open, in boxes.
namespace kaboum::scene {

/// A vector as people read it: what is only rounding is 0. @param size  what it is relative to
geom::Vec3 plain(const geom::Vec3& v, double size);

Json numbers(const geom::Vec3& v);

/// A grasp by the numbers that a scene states.
struct StatedGrasp {
  geom::Vec3 position = geom::Vec3::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  std::vector<world::FreeSlide> slides = {};
  std::optional<world::FreeTurn> turn = {};
  bool turns_round = false;  ///< by any angle
  unsigned rank = 0;

  /// As scenes are read.
  [[nodiscard]] world::Grasp read(std::string name = {}) const;
  [[nodiscard]] Json json(const std::string& name) const;
};

/// A tool in an object's frame.
struct ToolPlace {
  geom::Vec3 approach, closing, origin;
};

/// The grasp of a tool, whose fingers close along one of its axes.
/// @param size  of the object
StatedGrasp grasp_of(const ToolPlace& tool, GraspRequest::Axis closing, double size);

/// A way to hold an object, and what it leaves free.
struct FreeHold {
  ToolPlace tool;                        ///< all values are 0
  std::vector<world::FreeSlide> slides;  ///< as far as there is something to hold
  std::optional<world::FreeTurn> turn;   ///< by any angle
  /// True if the tool has something to hold wherever the slides are within these ranges.
  std::function<bool(const MemberBox& slides)> fits;
  double area = 0;  ///< of what is held, for the order
  unsigned rank = 0;
};

/// Families of the members of a hold that are free of contact with the hand, for certain; those of
/// most members first.
///
/// The hold's values are divided into cells. The largest box of free cells is a family, then the
/// largest of those that are left, until little is left. Their bounds are moved out as far as all
/// stays free.
std::vector<StatedGrasp> families_of(const FreeHold& hold, Hand& hand, GraspRequest::Axis closing,
                                     double size);

}  // namespace kaboum::scene
