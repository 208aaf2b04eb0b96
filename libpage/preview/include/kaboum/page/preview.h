#pragma once

#include <kaboum/geom/mesh.h>
#include <kaboum/robot/path.h>

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

/// Pages that show what was made over what it was made of. docs/pages.md.
namespace kaboum::page {

/// A text of a library with options as a front end names them: remedy_of_program or
/// remedy_of_python.
using Spelling = std::function<std::string(const std::string& text)>;

/// Triangles that are shown.
struct Shape {
  geom::Mesh mesh;
  /// Of each vertex, how far it is from what the layer is measured against; negative: nothing is
  /// said of it. Empty: of none. [length]
  std::vector<double> distances = {};
  std::optional<std::uint32_t> link = std::nullopt;  ///< that it is fixed to; none: to the world
};

/// What is shown or hidden together.
struct Layer {
  enum class View { Shown, Transparent, Hidden };
  std::string name;
  View view = View::Shown;
  bool result = true;      ///< else what it was made of
  bool bodies = false;     ///< the shapes are convex bodies, with colours of their own
  bool all_edges = false;  ///< edges are drawn wherever it is not flat, not only sharp ones
  bool no_edges = false;   ///< none are drawn
  std::optional<std::array<double, 3>> colour = std::nullopt;  ///< of all shapes, 0 to 1
  std::vector<Shape> shapes = {};
};

/// A robot that carries shapes along a path.
struct Motion {
  const robot::Robot& robot;
  robot::Path path;      ///< of one waypoint at least
  bool by_hand = false;  ///< joints are moved by sliders, from the first waypoint on
};

/// A table that stands below the facts.
struct Table {
  std::vector<std::string> head;
  std::vector<std::vector<std::string>> rows;  ///< each as long as the head
  std::vector<std::size_t> bad = {};           ///< rows that are to be seen first
};

/// What a reader may do next with what is shown.
struct Step {
  std::string name;     ///< what for: "MuJoCo"
  std::string words;    ///< what comes before, and what it is; may be empty
  std::string command;  ///< of a shell
};

/// Values that a slider gives a variable of a robot: its limits, within those that joints which
/// mimic it have of their own; without limits a turn, or a metre to both sides. [rad or length]
struct Range {
  double low = 0, high = 0;
};
Range range_of(const robot::Robot& robot, std::size_t variable);

struct Preview {
  std::string title;
  std::string unit = {};  ///< of length; empty: that of the file
  /// What stands beside: names and words.
  std::vector<std::pair<std::string, std::string>> facts = {};
  Table table = {};
  std::vector<Step> steps = {};
  std::string meaning = {};  ///< of the distances, in a few words
  std::vector<Layer> layers = {};
  std::optional<Motion> motion = std::nullopt;  ///< where shapes are fixed to links
};

/// The page. Numbers of shapes are rounded to float32; without a motion they are moved to the
/// origin and divided by the extent of all first.
/// @throws Error{InvalidArgument} where no layer has a triangle.
std::string preview_page(const Preview& preview);

}  // namespace kaboum::page
