// Previews as data of a page.

#include <kaboum/page/preview.h>

#include <kaboum/base/error.h>
#include <kaboum/base/xml_text.h>
#include <kaboum/io/packed_mesh.h>
#include <kaboum/page/page.h>
#include <kaboum/robot/page_data.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>

namespace kaboum::page {
namespace {

using Json = nlohmann::ordered_json;

/// From coordinates of shapes to those of the page.
struct Placing {
  geom::Vec3 origin = geom::Vec3::Zero();
  double scale = 1;
};

Placing placing_of(const Preview& preview) {
  geom::Box3 box;
  for (const Layer& layer : preview.layers)
    for (const Shape& shape : layer.shapes) box.extend(geom::bounding_box(shape.mesh));
  if (box.empty())
    throw Error(ErrorCode::InvalidArgument, "there is nothing that could be shown on a page");
  if (preview.motion) return {};
  const double extent = (box.max - box.min).maxCoeff();
  return {box.center(), extent > 0 ? extent : 1};
}

double largest_of(const Preview& preview) {
  double largest = -1;
  for (const Layer& layer : preview.layers)
    for (const Shape& shape : layer.shapes)
      for (const double d : shape.distances) largest = std::max(largest, d);
  return largest;
}

Json shape_json(const Shape& shape, const Placing& placing, double largest) {
  geom::Mesh mesh = shape.mesh;
  for (geom::Vec3& v : mesh.vertices) v = (v - placing.origin) / placing.scale;
  const io::PackedMesh packed = io::pack_mesh(mesh);
  Json out = {{"points", packed.points}, {"triangles", packed.triangles}};
  if (shape.link) out["link"] = *shape.link;
  if (shape.distances.empty()) return out;
  std::vector<float> shares;
  shares.reserve(shape.distances.size());
  for (const double d : shape.distances)
    shares.push_back(static_cast<float>(d < 0 ? -1 : largest > 0 ? d / largest : 0));
  out["values"] = io::pack_floats(shares);
  return out;
}

const char* name_of(Layer::View view) {
  switch (view) {
    case Layer::View::Transparent:
      return "clear";
    case Layer::View::Hidden:
      return "hidden";
    case Layer::View::Shown:
      break;
  }
  return "shown";
}

Json layer_json(const Layer& layer, const Placing& placing, double largest) {
  Json shapes = Json::array();
  bool distances = false;
  for (const Shape& shape : layer.shapes) {
    if (shape.mesh.empty()) continue;
    shapes.push_back(shape_json(shape, placing, largest));
    distances = distances || !shape.distances.empty();
  }
  const char* edges = layer.no_edges ? "none" : layer.all_edges ? "all" : "sharp";
  Json out = {{"name", layer.name},         {"view", name_of(layer.view)}, {"result", layer.result},
              {"bodies", layer.bodies},     {"distances", distances},      {"edges", edges},
              {"shapes", std::move(shapes)}};
  if (layer.colour) out["colour"] = *layer.colour;
  return out;
}

Json variables_json(const robot::Robot& robot, const std::vector<double>& start) {
  Json out = Json::array();
  for (std::size_t i = 0; i < robot.variables.size(); ++i) {
    const bool slides = std::ranges::any_of(robot.joints, [&](const robot::Joint& joint) {
      return joint.type == robot::JointType::Prismatic && joint.variable == i;
    });
    const Range range = range_of(robot, i);
    const robot::Variable& variable = robot.variables[i];
    out.push_back({{"name", variable.name},
                   {"slides", slides},
                   {"low", range.low},
                   {"high", range.high},
                   {"limited", variable.lower.has_value() && variable.upper.has_value()},
                   {"value", std::clamp(start[i], range.low, range.high)}});
  }
  return out;
}

constexpr const char* kNote =
    "Colours are for looking, not certified: distances at the corners of the triangles drawn, and "
    "between "
    "them in proportion. What is certified is said above.";

}  // namespace

Range range_of(const robot::Robot& robot, std::size_t variable) {
  const robot::Variable& v = robot.variables[variable];
  double widest = 1;
  for (const robot::Joint& joint : robot.joints)
    if (joint.type == robot::JointType::Revolute && joint.variable == variable)
      widest = std::numbers::pi;
  Range out{v.lower.value_or(v.upper ? *v.upper - 2 * widest : -widest),
            v.upper.value_or(v.lower ? *v.lower + 2 * widest : widest)};
  for (const robot::Joint& joint : robot.joints) {
    if (joint.type == robot::JointType::Fixed || joint.variable != variable ||
        joint.multiplier == 0)
      continue;
    const auto driving = [&](double own) { return (own - joint.offset) / joint.multiplier; };
    const std::optional<double>& low = joint.multiplier > 0 ? joint.lower : joint.upper;
    const std::optional<double>& high = joint.multiplier > 0 ? joint.upper : joint.lower;
    if (low) out.low = std::max(out.low, driving(*low));
    if (high) out.high = std::min(out.high, driving(*high));
  }
  out.high = std::max(out.low, out.high);
  return out;
}

std::string preview_page(const Preview& preview) {
  const Placing placing = placing_of(preview);
  const double largest = largest_of(preview);
  Json data = {{"kaboum_preview", 1},
               {"unit", preview.unit},
               {"scale", placing.scale},
               {"facts", preview.facts},
               {"note", largest < 0 ? "" : kNote},
               {"meaning", preview.meaning},
               {"largest", largest < 0 ? Json() : Json(largest)}};
  Json layers = Json::array();
  for (const Layer& layer : preview.layers) layers.push_back(layer_json(layer, placing, largest));
  data["layers"] = std::move(layers);
  if (!preview.table.rows.empty())
    data["table"] = {
        {"head", preview.table.head}, {"rows", preview.table.rows}, {"bad", preview.table.bad}};
  for (const Step& step : preview.steps)
    data["steps"].push_back(
        {{"name", step.name}, {"words", step.words}, {"command", step.command}});
  if (preview.motion) {
    data["robot"] = {{"base", {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}},
                     {"joints", Json::parse(robot::joints_json(preview.motion->robot))}};
    data["path"] = preview.motion->path;
    if (preview.motion->by_hand)
      data["variables"] = variables_json(preview.motion->robot, preview.motion->path.front());
  }
  // Names of files need not be UTF-8, pages have to be.
  const auto text_of = [](const Json& json) {
    return json.dump(-1, ' ', false, Json::error_handler_t::replace);
  };
  const auto title = Json::parse(text_of(preview.title)).get<std::string>();
  return filled("preview.html", {{"title", escape_xml(title)}, {"data", in_script(text_of(data))}});
}

}  // namespace kaboum::page
