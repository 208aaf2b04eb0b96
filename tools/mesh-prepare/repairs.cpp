// What preparation changed, each with place and size.
#include "repairs.h"

namespace kaboum::tools {
namespace {

void add(std::vector<Repair>& repairs, const char* kind, std::size_t count,
         const geom::Box3& box = {}) {
  if (count > 0) repairs.push_back({kind, count, box});
}

geom::Box3 box_of(const geom::Mesh& mesh, const geom::Triangle& t) {
  geom::Box3 box;
  for (const std::uint32_t v : t) box.extend(mesh.vertices[v]);
  return box;
}

/// Where input triangles went that the prepared mesh has not.
geom::Box3 box_of_dropped(const geom::Mesh& input, const geom::Prepared& prepared) {
  std::vector<char> left(input.triangles.size(), 0);
  for (const std::uint32_t t : prepared.report.source) left[t] = 1;
  geom::Box3 box;
  for (std::size_t t = 0; t < left.size(); ++t)
    if (left[t] == 0) box.extend(box_of(input, input.triangles[t]));
  return box;
}

}  // namespace

std::vector<Repair> repairs_of(const io::ReadResult& input, const geom::Prepared& prepared) {
  std::vector<Repair> repairs;
  const geom::Mesh& mesh = input.mesh;
  if (input.file_vertices > mesh.vertices.size())
    add(repairs, "vertices merged", input.file_vertices - mesh.vertices.size());
  add(repairs, "polygons split", input.split_polygons);
  add(repairs, "triangles with repeated corners dropped",
      input.collapsed_triangles + prepared.report.collapsed_triangles);
  geom::Box3 turned;
  for (std::size_t t = 0; t < prepared.report.source.size(); ++t)
    if (prepared.report.reversed[t] != 0)
      turned.extend(box_of(prepared.solid.mesh(), prepared.solid.mesh().triangles[t]));
  add(repairs, "triangles turned", prepared.report.reversed_triangles, turned);
  for (const std::uint32_t t : prepared.report.inside_out)
    add(repairs, "component inside out, turned", 1, box_of(mesh, mesh.triangles[t]));
  const geom::Box3 dropped = box_of_dropped(mesh, prepared);
  add(repairs, "copies of triangles dropped", prepared.report.dropped_copies, dropped);
  add(repairs, "triangles of walls dropped", prepared.report.cancelled_walls, dropped);
  add(repairs, "triangles of sheets dropped", prepared.report.dropped_sheets, dropped);
  for (const std::vector<std::uint32_t>& rim : prepared.report.rims) {
    geom::Box3 box;
    for (const std::uint32_t corner : rim)
      box.extend(mesh.vertices[mesh.triangles[corner / 3][corner % 3]]);
    add(repairs, "hole filled, by edges of its rim", rim.size(), box);
  }
  return repairs;
}

Json to_json(const std::vector<Repair>& repairs) {
  Json list = Json::array();
  for (const Repair& repair : repairs) {
    Json json{{"kind", repair.kind}, {"count", repair.count}};
    if (!repair.box.empty()) {
      const geom::Vec3 at = repair.box.center();
      json["place"] = {at.x(), at.y(), at.z()};
      json["size"] = repair.box.diagonal();
    }
    list.push_back(std::move(json));
  }
  return list;
}

std::string in_words(const std::vector<Repair>& repairs) {
  std::vector<std::pair<std::string, std::size_t>> sums;
  for (const Repair& repair : repairs) {
    const bool hole = repair.kind.starts_with("hole");
    const std::string kind = hole ? "holes filled" : repair.kind;
    const std::size_t count = hole ? 1 : repair.count;
    if (!sums.empty() && sums.back().first == kind) {
      sums.back().second += count;
    } else {
      sums.emplace_back(kind, count);
    }
  }
  std::string text;
  for (const auto& [kind, count] : sums)
    text += (text.empty() ? "" : ", ") + std::to_string(count) + " " + kind;
  return text.empty() ? "nothing" : text;
}

}  // namespace kaboum::tools
