#pragma once

#include <kaboum/kinematics/numeric.h>
#include <kaboum/kinematics/solution_set.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace kaboum::kinematics {

/// Request for configurations that reach a pose.
struct InverseRequest {
  Transform target;  ///< of the tool, in the base's frame
  /// A value for each axis: whole turns nearest to it are chosen, free joints
  /// have its values, and the numeric search starts there. Empty: zeros, and
  /// starts at random. [rad or length]
  std::vector<double> reference = {};
  bool numeric = false;        ///< even where there is a closed form
  bool ignore_limits = false;  ///< outside the joints' limits as well
  bool copies = false;         ///< all that differ by whole turns within the limits
  bool free_heading = false;   ///< of arms with five axes: poses with another heading as well
  std::size_t starts = 100;    ///< of the numeric search
  std::uint64_t seed = 1;      ///< of the numeric search
  /// Of each family, about; of redundant joints, values for which there are configurations.
  std::size_t representatives = 6;
  /// Is told of each start of the numeric search; what it throws ends the work.
  std::function<void(const std::string& stage)> progress = {};
};

/// Configurations that reach a pose, and whether they are all.
struct InverseAnswer {
  struct Row {
    std::vector<double> q;  ///< [rad or length]
    PoseError error;
    unsigned singular = kRegular;  ///< of Singular
    bool within = true;            ///< the limits
    Transform pose;                ///< that was to be reached
    unsigned free = 0;             ///< joints, as bits, that may have other values
  };
  /// Configurations that reach a pose and hang together.
  struct Family {
    SolutionFamily family;
    Transform pose;
  };
  std::optional<ClosedForm> form;  ///< none: the search was numeric
  std::size_t redundant = 0;       ///< joints before those of the closed form
  std::size_t found = 0;           ///< isolated ones, whatever the limits
  std::vector<Family> families;
  bool outside = false;  ///< there are families, outside the limits
  std::vector<Row> rows;
  /// Why these need not be all; empty: they are, up to the accuracy of closed
  /// forms.
  std::string incomplete;
};

/// The configurations with which an arm reaches a pose: all of them in closed
/// form where the arm has one, some where its last six axes have one (redundant.h), else those that
/// a numeric search finds.
/// @throws Error{InvalidArgument} where the reference has not one value per
/// axis, or the heading is
///   to be free of an arm that has not five axes and a closed form.
InverseAnswer find_configurations(const Arm& arm, const InverseRequest& request);

/// "shoulder", "elbow", "wrist": which of Singular.
std::vector<std::string> singular_names(unsigned singular);

/// The link that no joint starts from, where there is one only.
/// @throws Error{InvalidArgument} naming those that there are
std::string only_tip(const robot::Robot& robot);

}  // namespace kaboum::kinematics
