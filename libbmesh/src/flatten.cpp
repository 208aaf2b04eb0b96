// Vertices of coplanar regions are taken away without any loss. docs/algorithms/bounding-mesh.md,
// "Coplanar regions".

#include "flatten.h"

#include <kaboum/geom/float32.h>

#include <algorithm>

#include "compact.h"
#include "reference_solid.h"

namespace kaboum::bmesh {
namespace {

/// Normals whose cosine is less belong to different planes, whatever rounding has done to them.
constexpr double kSamePlane = 1 - 1e-9;

bool coplanar(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  return geom::orient3d(a, b, c, d) == geom::Sign::Zero;
}

/// Of three different points on one line, whether b lies between the others.
bool between(const Vec3& a, const Vec3& b, const Vec3& c) {
  for (int k = 0; k < 3; ++k)
    if (a[k] != c[k]) return (a[k] < b[k] && b[k] < c[k]) || (a[k] > b[k] && b[k] > c[k]);
  return false;
}

/// Whether the triangle is higher than this share of its longest side: others would leave a vertex
/// that is moved to float32 coordinates later no room.
bool has_height(const std::array<Vec3, 3>& t) {
  constexpr double kLeast = 1e-5;
  const Vec3 a = t[1] - t[0], b = t[2] - t[0];
  const double longest = std::max({a.squaredNorm(), b.squaredNorm(), (b - a).squaredNorm()});
  return a.cross(b).norm() > kLeast * longest;
}

bool keeps_orientation(const std::array<Vec3, 3>& before, const std::array<Vec3, 3>& after) {
  return has_height(after) && same_orientation(before, after);
}

}  // namespace

std::vector<std::uint32_t> flat_vertices(const geom::SolidMesh& input) {
  const geom::Mesh& mesh = input.mesh();
  std::vector<Vec3> normal(mesh.triangles.size());
  parallel_for_light(normal.size(), [&](std::size_t t) {
    const geom::Triangle& tri = mesh.triangles[t];
    const Vec3& a = mesh.vertices[tri[0]];
    const Vec3 n = (mesh.vertices[tri[1]] - a).cross(mesh.vertices[tri[2]] - a);
    const double length = n.norm();
    normal[t] = length > 0 ? Vec3(n / length) : Vec3(Vec3::Zero());
  });
  // Triangles that stand for the planes met so far at each vertex.
  constexpr std::uint32_t kNone = ~0U, kRuledOut = ~0U - 1;
  struct Planes {
    std::uint32_t first = kNone, second = kNone;
  };
  std::vector<Planes> planes(mesh.vertices.size());
  for (std::uint32_t t = 0; t < normal.size(); ++t) {
    for (const std::uint32_t v : mesh.triangles[t]) {
      Planes& p = planes[v];
      if (p.first == kRuledOut) continue;
      if (p.first == kNone)
        p.first = normal[t].squaredNorm() > 0.5 ? t : kRuledOut;
      else if (normal[t].dot(normal[p.first]) >= kSamePlane)
        continue;
      else if (p.second == kNone)
        p.second = t;
      else if (normal[t].dot(normal[p.second]) < kSamePlane)
        p.first = kRuledOut;
    }
  }
  std::vector<std::uint32_t> flat;
  for (std::uint32_t v = 0; v < planes.size(); ++v)
    if (planes[v].first < kRuledOut && input.border()[v] == 0) flat.push_back(v);
  return flat;
}

Flattener::Flattener(const geom::SolidMesh& input, std::vector<std::uint32_t> flat,
                     std::vector<Step>* steps)
    : m_(input),
      steps_(steps),
      vertices_(input.mesh().vertices.size()),
      todo_(std::move(flat)),
      waits_(input.mesh().vertices.size(), 0) {
  for (const std::uint32_t v : todo_) waits_[v] = 1;
}

void Flattener::run(std::size_t target) {
  for (; at_ < todo_.size() && vertices_ > target; ++at_) {
    waits_[todo_[at_]] = 0;
    remove(todo_[at_]);
  }
}

/// Flips edges away from v until it can be contracted, if it is not needed.
void Flattener::remove(std::uint32_t v) {
  if (!look_at(v)) return;
  for (;;) {
    const auto w = std::find_if(targets_.begin(), targets_.end(), [&](std::uint32_t to) {
      return contracts_to(to) && keeps_topology(to);
    });
    if (w != targets_.end()) return contract_to(*w);
    const auto edge = flippable();
    if (!edge) return;
    flip(*edge);
  }
}

bool Flattener::is_float32() const {
  for (std::uint32_t v = 0; v < m_.position.size(); ++v)
    if (m_.mesh.used(v) && !geom::is_float32(m_.position[v])) return false;
  return true;
}

geom::Mesh Flattener::mesh(std::vector<std::uint32_t>* source) const {
  return compact(m_.position, m_.mesh, source);
}

Flattener::Corners Flattener::triangle(std::size_t i) const {
  return {place(v_), place(fan_[i].at), place(fan_[i].next)};
}

bool Flattener::look_at(std::uint32_t v) {
  v_ = v;
  if (m_.border[v] != 0 || !m_.mesh.used(v) || !may_be_flat() || !order() || !find_creases())
    return false;
  find_targets();
  return true;
}

/// At most two planes, by the rounded normals: turns most vertices away.
bool Flattener::may_be_flat() const {
  const Vec3 *first = nullptr, *second = nullptr;
  bool flat = true;
  m_.mesh.for_each_triangle(v_, [&](std::uint32_t t, std::uint32_t) {
    if (!flat) return;
    const Vec3& n = m_.normal[t];
    if (first == nullptr) {
      first = &n;
      flat = n.squaredNorm() > 0.5;
    } else if (n.dot(*first) < kSamePlane) {
      if (second == nullptr) second = &n;
      flat = n.dot(*second) >= kSamePlane;
    }
  });
  return flat;
}

/// The triangles in their order round v; false unless they are one closed fan.
bool Flattener::order() {
  sorted_.clear();
  m_.mesh.for_each_triangle(v_, [&](std::uint32_t t, std::uint32_t k) {
    const geom::Triangle& tri = m_.mesh[t];
    sorted_.push_back({tri[(k + 1) % 3], tri[(k + 2) % 3], false});
  });
  const auto less = [](const Spoke& a, const Spoke& b) { return a.at < b.at; };
  std::sort(sorted_.begin(), sorted_.end(), less);
  fan_.clear();
  Spoke spoke = sorted_.front();
  do {
    fan_.push_back(spoke);
    const auto range =
        std::equal_range(sorted_.begin(), sorted_.end(), Spoke{spoke.next, 0, false}, less);
    if (range.second - range.first != 1) return false;
    spoke = *range.first;
  } while (spoke.at != fan_.front().at && fan_.size() < sorted_.size());
  return spoke.at == fan_.front().at && fan_.size() == sorted_.size() && fan_.size() >= 3;
}

/// Exact. Marks the edges at v where the plane changes: none, or two in line.
bool Flattener::find_creases() {
  std::array<std::size_t, 2> crease{};
  std::size_t creases = 0;
  bool distinct = false;
  for (std::size_t i = 0; i < fan_.size(); ++i) {
    const std::size_t j = after(i);
    const bool same =
        coplanar(place(v_), place(fan_[i].at), place(fan_[j].at), place(fan_[j].next));
    if (same && same_orientation(triangle(i), triangle(j))) continue;
    if (creases == 2) return false;
    distinct = distinct || !same;
    fan_[j].crease = true;
    crease[creases++] = j;
  }
  if (creases == 0) return true;
  // The line of two different planes holds v and both edges. A triangle alone in its plane was not
  // compared with one like it, so it may have no area; then the planes are not two.
  if (creases == 1 || !distinct) return false;
  for (const std::size_t i : crease)
    if (!same_orientation(triangle(i), triangle(i))) return false;
  return between(place(fan_[crease[0]].at), place(v_), place(fan_[crease[1]].at));
}

/// Neighbours to which v may be contracted in its planes, the nearest first.
void Flattener::find_targets() {
  targets_.clear();
  const bool crease =
      std::any_of(fan_.begin(), fan_.end(), [](const Spoke& s) { return s.crease; });
  for (const Spoke& s : fan_)
    if (s.crease || !crease) targets_.push_back(s.at);
  const auto distance = [&](std::uint32_t w) { return (place(w) - place(v_)).squaredNorm(); };
  std::stable_sort(targets_.begin(), targets_.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return distance(a) < distance(b); });
}

/// Exact: no triangle of the star turns over or loses its area.
bool Flattener::contracts_to(std::uint32_t w) const {
  for (std::size_t i = 0; i < fan_.size(); ++i) {
    const Spoke& s = fan_[i];
    if (s.at == w || s.next == w) continue;
    if (!keeps_orientation(triangle(i), {place(w), place(s.at), place(s.next)})) return false;
  }
  return true;
}

bool Flattener::around(std::uint32_t v) const {
  const auto it = std::lower_bound(sorted_.begin(), sorted_.end(), v,
                                   [](const Spoke& s, std::uint32_t x) { return s.at < x; });
  return it != sorted_.end() && it->at == v;
}

/// The link condition: v and w have no common neighbours but the two opposite their edge, and these
/// are no triangle with w.
bool Flattener::keeps_topology(std::uint32_t w) const {
  std::array<std::uint32_t, 2> apex{};
  for (const Spoke& s : fan_) {
    if (s.at == w) apex[0] = s.next;
    if (s.next == w) apex[1] = s.at;
  }
  bool keeps = true;
  m_.mesh.for_each_triangle(w, [&](std::uint32_t t, std::uint32_t k) {
    const std::uint32_t p = m_.mesh[t][(k + 1) % 3], q = m_.mesh[t][(k + 2) % 3];
    if (p == v_ || q == v_) return;
    const bool p_around = around(p), q_around = around(q);
    const auto is_apex = [&](std::uint32_t u) { return u == apex[0] || u == apex[1]; };
    if ((p_around && q_around) || (p_around && !is_apex(p)) || (q_around && !is_apex(q)))
      keeps = false;
  });
  return keeps;
}

void Flattener::contract_to(std::uint32_t w) {
  if (steps_ != nullptr) steps_->push_back({w, v_, place(w)});
  m_.mesh.contract(w, v_);
  --vertices_;
  ++contractions_;
  for (const Spoke& s : fan_) {
    if (waits_[s.at] == 0) todo_.push_back(s.at);
    waits_[s.at] = 1;
  }
}

bool Flattener::joined(std::uint32_t a, std::uint32_t b) const {
  bool found = false;
  m_.mesh.for_each_triangle(a, [&](std::uint32_t t, std::uint32_t) {
    for (const std::uint32_t w : m_.mesh[t]) found = found || w == b;
  });
  return found;
}

/// The place in the fan of an edge at v that can be flipped within its plane.
std::optional<std::size_t> Flattener::flippable() const {
  if (fan_.size() < 4) return std::nullopt;
  for (std::size_t i = 0; i < fan_.size(); ++i) {
    const std::size_t j = after(i);
    if (fan_[j].crease) continue;
    const std::uint32_t p = fan_[i].at, q = fan_[j].at, r = fan_[j].next;
    const Corners old = triangle(i);
    if (keeps_orientation(old, {place(v_), place(p), place(r)}) &&
        keeps_orientation(old, {place(p), place(q), place(r)}) && !joined(p, r))
      return j;
  }
  return std::nullopt;
}

void Flattener::flip(std::size_t i) {
  const std::uint32_t gone = fan_[i].at, left = fan_[i].next;
  std::uint32_t right = 0, first = 0, second = 0;
  m_.mesh.for_each_triangle(v_, [&](std::uint32_t t, std::uint32_t k) {
    if (m_.mesh[t][(k + 1) % 3] == gone) first = t;
    if (m_.mesh[t][(k + 2) % 3] != gone) return;
    second = t;
    right = m_.mesh[t][(k + 1) % 3];
  });
  m_.mesh.replace(first, {right, left, v_});
  m_.mesh.replace(second, {left, right, gone});
  if (steps_ != nullptr) steps_->push_back(Step::flip(v_, gone, left, right));
  ++flips_;
  // What was found out of v holds still.
  for (auto* spokes : {&fan_, &sorted_}) {
    std::erase_if(*spokes, [&](const Spoke& s) { return s.at == gone; });
    for (Spoke& s : *spokes)
      if (s.next == gone) s.next = left;
  }
  std::erase(targets_, gone);
}

}  // namespace kaboum::bmesh
