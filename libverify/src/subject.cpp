// The mesh that claims about the triangles of a file are about.
#include <kaboum/base/error.h>
#include <kaboum/geom/topology.h>
#include <kaboum/verify/subject.h>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <utility>

namespace kaboum::verify {
namespace {

/// Both triangles of the other way to split each quad that is not plane.
void add_other_ways(const std::vector<std::uint32_t>& quads, geom::Mesh& mesh) {
  for (const std::uint32_t quad : quads) {
    const geom::Triangle first = mesh.triangles.at(quad), second = mesh.triangles.at(quad + 1);
    const auto in_second = [&](std::uint32_t v) {
      return std::find(second.begin(), second.end(), v) != second.end();
    };
    const auto apex =
        std::find_if(first.begin(), first.end(), [&](std::uint32_t v) { return !in_second(v); });
    const auto other = std::find_if(second.begin(), second.end(), [&](std::uint32_t v) {
      return std::find(first.begin(), first.end(), v) == first.end();
    });
    if (apex == first.end() || other == second.end()) continue;
    const auto k = apex - first.begin();
    mesh.triangles.push_back({*apex, first[(k + 1) % 3], *other});
    mesh.triangles.push_back({*apex, *other, first[(k + 2) % 3]});
  }
}

/// The parts whose triangles hang together by edges.
std::vector<geom::Mesh> parts_over_edges(const geom::Mesh& mesh) {
  std::vector<std::uint32_t> root(mesh.triangles.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&](std::uint32_t t) {
    while (root[t] != t) t = root[t] = root[root[t]];
    return t;
  };
  std::vector<std::array<std::uint32_t, 3>> edges;  // both ends and the triangle
  edges.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = mesh.triangles[t][k], b = mesh.triangles[t][(k + 1) % 3];
      edges.push_back({std::min(a, b), std::max(a, b), t});
    }
  std::ranges::sort(edges);
  for (std::size_t i = 1; i < edges.size(); ++i)
    if (edges[i][0] == edges[i - 1][0] && edges[i][1] == edges[i - 1][1])
      root[find(edges[i][2])] = find(edges[i - 1][2]);
  std::map<std::uint32_t, std::vector<geom::Triangle>> parts;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    parts[find(t)].push_back(mesh.triangles[t]);
  std::vector<geom::Mesh> out;
  out.reserve(parts.size());
  for (auto& [name, triangles] : parts) {
    geom::Mesh& part = out.emplace_back();
    std::map<std::uint32_t, std::uint32_t> local;
    for (geom::Triangle& t : triangles)
      for (std::uint32_t& v : t) {
        const auto [at, fresh] = local.emplace(v, static_cast<std::uint32_t>(part.vertices.size()));
        if (fresh) part.vertices.push_back(mesh.vertices[v]);
        v = at->second;
      }
    part.triangles = std::move(triangles);
  }
  return out;
}

/// Whether each triangle has an opposite copy, so that nothing is wound round.
bool is_sheet(const geom::Mesh& mesh) {
  std::map<geom::Triangle, int> sides;
  for (geom::Triangle t : mesh.triangles) {
    const int inversions = int{t[0] > t[1]} + int{t[1] > t[2]} + int{t[0] > t[2]};
    std::ranges::sort(t);
    sides[t] += inversions % 2 == 0 ? 1 : -1;
  }
  return std::ranges::all_of(sides, [](const auto& side) { return side.second == 0; });
}

Claim claim_of(Answer answer, const char* reason) {
  Claim out;
  out.answer = answer;
  out.reason = reason;
  return out;
}

}  // namespace

geom::Mesh held_triangles(const geom::Mesh& file, const geom::Prepared& prepared) {
  if (prepared.report.dropped_sheets == 0) return file;
  geom::Mesh out = without_filling(prepared.solid.mesh(), prepared.solid.filled_triangles());
  for (const geom::LeftOut& triangle : prepared.report.left_out) {
    const auto first = static_cast<std::uint32_t>(out.vertices.size());
    out.vertices.insert(out.vertices.end(), triangle.corners.begin(), triangle.corners.end());
    out.triangles.push_back({first, first + 1, first + 2});
  }
  return out;
}

std::uint32_t source_of_held(const Subject& subject, std::uint32_t triangle) {
  const geom::PreparationReport& r = subject.report;
  if (r.dropped_sheets == 0) return triangle;
  const std::size_t first = subject.triangles.triangles.size() - r.left_out.size();
  return triangle < first ? r.source.at(triangle) : r.left_out.at(triangle - first).source;
}

std::vector<geom::Mesh> closed_parts(const geom::Mesh& mesh) {
  struct Group {
    geom::Mesh mesh;
    std::vector<geom::Box3> boxes;
  };
  std::vector<Group> groups;
  for (const geom::Mesh& part : parts_over_edges(geom::weld(mesh))) {
    if (!geom::analyse(part).closed() || is_sheet(part)) continue;
    const geom::Box3 box = geom::bounding_box(part);
    const auto apart = [&](const geom::Box3& other) {
      return (box.max.array() < other.min.array()).any() ||
             (other.max.array() < box.min.array()).any();
    };
    auto group = std::ranges::find_if(
        groups, [&](const Group& g) { return std::ranges::all_of(g.boxes, apart); });
    if (group == groups.end()) group = groups.emplace(groups.end());
    group->boxes.push_back(box);
    const auto first = static_cast<std::uint32_t>(group->mesh.vertices.size());
    group->mesh.vertices.insert(group->mesh.vertices.end(), part.vertices.begin(),
                                part.vertices.end());
    for (const geom::Triangle& t : part.triangles)
      group->mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  std::vector<geom::Mesh> out;
  out.reserve(groups.size());
  for (Group& group : groups) out.push_back(std::move(group.mesh));
  return out;
}

geom::Mesh without_filling(geom::Mesh mesh, std::size_t filled_triangles) {
  mesh.triangles.resize(mesh.triangles.size() - filled_triangles);
  return mesh;
}

geom::Mesh turned(geom::Mesh mesh) {
  for (geom::Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

Subject unprepared_subject(const geom::Mesh& file, const std::vector<std::uint32_t>& quads) {
  Subject out;
  out.mesh = file;
  out.both_ways = true;
  out.has_more = !quads.empty();
  if (!out.has_more) return out;
  out.triangles = file;
  add_other_ways(quads, out.triangles);
  return out;
}

Subject subject_of(const geom::Mesh& file, const geom::Prepared& prepared) {
  Subject out;
  out.mesh = prepared.solid.mesh();
  out.filled_triangles = prepared.solid.filled_triangles();
  out.is_prepared = true;
  // Parts across whose holes preparing guessed may be left inside out.
  out.both_ways = prepared.report.hollow.has_value() || geom::signed_volume(out.mesh) < 0;
  out.has_more = !prepared.report.left_out.empty();
  if (out.has_more) out.triangles = held_triangles(file, prepared);
  out.report = prepared.report;
  return out;
}

Subject prepared_subject(const geom::Mesh& file, const geom::PrepareOptions& options) {
  try {
    return subject_of(file, geom::prepare(file, options));
  } catch (const Error& error) {
    if (error.code() != ErrorCode::InvalidInput || options.drop_sheets) throw;
    using Diagonal = geom::PrepareOptions::Diagonal;
    Subject out = options.diagonal == Diagonal::AsGiven ? unprepared_subject(file)
                                                        : unprepared_subject(file, options.quads);
    out.refusal = error.what();
    return out;
  }
}

SubjectClaims decide_rest(
    const Subject& subject, const geom::Mesh& mesh, Claims claims, Inclusion first,
    const std::function<Inclusion(const geom::Mesh&, bool surface_only)>& look) {
  SubjectClaims out{std::move(first), {}};
  Inclusion& all = out.inclusion;
  const auto look_once_more = [&](const geom::Mesh& at, bool surface_only) {
    Inclusion found = look(at, surface_only);
    all.left_out = std::max(all.left_out, found.left_out);
    all.limited = all.limited || found.limited;
    all.contacts += found.contacts;
    all.samples += found.samples;
    return found;
  };
  const bool settled = all.inner_closed && all.solid.answer != Answer::Verified;
  if (subject.both_ways && claims != Claims::Surface && !settled) {
    const std::vector<geom::Mesh> parts = closed_parts(mesh);
    all.solid = parts.empty()
                    ? claim_of(Answer::Undefined, "no part of the triangles bounds a solid")
                    : claim_of(Answer::Verified, "");
    for (const geom::Mesh& part : parts)
      for (const bool backwards : {false, true}) {
        geom::Mesh one = backwards ? turned(part) : part;
        Inclusion found = look_once_more(one, false);
        if (worse(all.solid.answer, found.solid.answer) == all.solid.answer) continue;
        all.solid = std::move(found.solid);
        out.solid_part = std::move(one);
      }
    // Of what preparing had to guess it is not known that this part is meant.
    if (subject.is_prepared && all.solid.answer == Answer::Refuted) {
      all.solid = claim_of(Answer::Undecided,
                           "a part of the surface crosses itself, and which of what it winds round "
                           "is meant is not known: not all of that is inside");
      out.solid_part.reset();
    }
  }
  if (subject.filled_triangles > 0 && all.surface.answer != Answer::Verified)
    all.surface = look_once_more(without_filling(mesh, subject.filled_triangles), true).surface;
  if (subject.has_more) {
    Claim more = look_once_more(subject.triangles, true).surface;
    out.surface_of_all = worse(all.surface.answer, more.answer) != all.surface.answer;
    if (out.surface_of_all) all.surface = std::move(more);
  }
  // Where no solid is known, only triangles that all lie inside say something.
  if (subject.both_ways && !subject.is_prepared && all.surface.answer == Answer::Undefined &&
      all.solid.answer == Answer::Verified)
    all.solid = claim_of(Answer::Undefined, "which solid the triangles bound is not known");
  return out;
}

MeasuredMesh measured_mesh(const Subject& subject, const geom::Mesh& file) {
  if (subject.is_prepared && !subject.has_more) return {subject.mesh};
  MeasuredMesh out;
  try {
    out.mesh =
        subject.is_prepared
            ? subject.mesh
            : geom::prepare(file, {.drop_sheets = true, .holes = geom::Holes::Fill}).solid.mesh();
  } catch (const Error&) {
    out.has_solid = false;
  }
  // All triangles, on both sides: their windings cancel.
  const geom::Mesh& all = subject.has_more ? subject.triangles : file;
  for (const geom::Mesh& mesh : {all, turned(all)}) {
    const auto first = static_cast<std::uint32_t>(out.mesh.vertices.size());
    out.mesh.vertices.insert(out.mesh.vertices.end(), mesh.vertices.begin(), mesh.vertices.end());
    for (const geom::Triangle& t : mesh.triangles)
      out.mesh.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  }
  return out;
}

}  // namespace kaboum::verify
