#pragma once

#include <kaboum/robot/mjcf.h>

#include <functional>
#include <string>
#include <string_view>

/// Robots as Gazebo and Drake describe them: SDFormat. <http://sdformat.org/spec>
namespace kaboum::robot {

/// A robot and what it weighs.
struct SdfRobot {
  Robot robot;
  Dynamics dynamics;
};

/// A file that an SDF document includes.
struct IncludedModel {
  std::string file;  ///< its path, absolute
  std::string text;
};

/// Gives the model that a URI of an <include> names. @param from  path of the file that has it
using ModelSource = std::function<IncludedModel(const std::string& uri, const std::string& from)>;

/// The text of a document with every <include> of a model put in its place, as a nested one: with
/// the <name>, <pose>, placement frame and plugins that it states; as it is where it includes
/// nothing. Names of files are relative to the document's folder then. Where versions differ in the
/// frames that they mean by nothing, all are brought to 1.7 or later. Lights are left out.
/// @param name  of the file, for messages
/// @param file  its path, absolute
/// @throws Error{InvalidInput} naming the line: not well-formed; what `source` throws; `merge`; a
///   file that includes itself, or has no model; Error{LimitReached}
std::string include_sdf(std::string_view text, const std::string& name, const std::string& file,
                        const ModelSource& source);

/// Robot of an SDF document with one model, of versions 1.4 to 1.12, and of what is nested in it:
/// links and joints of nested models are called as from outside, "arm::hand::palm". Joints that
/// mimic others follow them.
///
/// Link 0 is the world, below which every link is that no joint moves: where they stand in the
/// model. A joint whose frame is not that of its child has a link without shapes of its own. Ball,
/// universal, screw and gearbox joints are fixed where they are in the file, and
/// Robot::unmodelled says so. Planes are left out with a note.
/// @param name  appears in messages.
/// @throws Error{InvalidInput} naming the line where known: not well-formed; several models,
///   included ones (include_sdf); frames that do not exist or lead in a circle; height maps,
///   polylines, cones, images and parts of meshes.
SdfRobot parse_sdf(std::string_view text, const std::string& name);

/// The document with other collision elements, each with the pose and scale of the shape that it
/// stands for. All else stays; names of files are given by ShapeEdit::moved. Before SDF 1.8, which
/// has no capsules, a cylinder and two spheres stand for one.
/// @param text  that parse_sdf reads
/// @throws as parse_sdf
std::string sdf_with_shapes(std::string_view text, const std::string& name, const ShapeEdit& edit);

}  // namespace kaboum::robot
