// Meshes out of progressive files: their steps taken, not judged.

#include <kaboum/base/error.h>
#include <kaboum/bmesh/extract.h>

#include <algorithm>

#include "compact.h"

namespace kaboum::bmesh {
namespace {

/// The mesh under the steps. What a step needs is looked at before it is taken, since the file may
/// be anybody's.
class Player {
 public:
  Player(const Progressive& p, const std::string& name)
      : steps_(p.log.steps),
        name_(name),
        position_(p.base.vertices),
        mesh_(p.base.vertices.size(), p.base.triangles) {
    for (std::uint32_t v = 0; v < position_.size(); ++v) vertices_ += mesh_.used(v) ? 1 : 0;
  }

  void play_to(std::size_t steps) {
    while (at_ < steps) play();
  }

  /// Up to the first mesh that has no more vertices, and on until the next contraction.
  void play_until(std::size_t vertices) {
    while (at_ < steps_.size() && (vertices_ > vertices || !contracts())) play();
  }

  [[nodiscard]] std::size_t at() const { return at_; }
  [[nodiscard]] std::size_t vertices() const { return vertices_; }
  [[nodiscard]] geom::Mesh mesh() const { return compact(position_, mesh_); }

  [[noreturn]] void fail(const std::string& what) const {
    throw Error(ErrorCode::InvalidInput, name_ + ": " + what + "; the file is damaged");
  }

 private:
  [[nodiscard]] bool contracts() const {
    const Step& s = steps_[at_];
    return s.kind == Step::Kind::Contract && s.kept != s.gone;
  }

  [[noreturn]] void fail_step(const std::string& what) const {
    fail("step " + std::to_string(at_) + " " + what);
  }

  void play() {
    const Step& s = steps_[at_];
    const bool flip = s.kind == Step::Kind::Flip;
    for (const std::uint32_t v : {s.kept, s.gone, flip ? s.left : s.kept, flip ? s.right : s.kept})
      if (v >= position_.size() || !mesh_.used(v))
        fail_step("refers to a vertex that is not there");
    if (flip) {
      take_flip(s);
    } else {
      if (!s.position.allFinite()) fail_step("moves a vertex to no finite place");
      position_[s.kept] = s.position;
      if (s.gone != s.kept) contract(s);
    }
    ++at_;
  }

  void contract(const Step& s) {
    // Neighbours of the edge's triangles may lose their last triangle with it.
    around_.clear();
    mesh_.for_each_triangle(s.gone, [&](std::uint32_t t, std::uint32_t k) {
      for (const std::uint32_t j : {1U, 2U}) around_.push_back(mesh_[t][(k + j) % 3]);
    });
    std::sort(around_.begin(), around_.end());
    around_.erase(std::unique(around_.begin(), around_.end()), around_.end());
    if (!std::binary_search(around_.begin(), around_.end(), s.kept))
      fail_step("contracts an edge that is not there");
    mesh_.contract(s.kept, s.gone);
    --vertices_;
    for (const std::uint32_t v : around_)
      if (!mesh_.used(v)) --vertices_;
  }

  void take_flip(const Step& s) {
    const auto find = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c) {
      std::uint32_t found = Connectivity::kNone;
      mesh_.for_each_triangle(a, [&](std::uint32_t t, std::uint32_t k) {
        if (mesh_[t][(k + 1) % 3] == b && mesh_[t][(k + 2) % 3] == c) found = t;
      });
      return found;
    };
    const std::uint32_t first = find(s.kept, s.gone, s.left),
                        second = find(s.gone, s.kept, s.right);
    if (first == Connectivity::kNone || second == Connectivity::kNone || s.left == s.right)
      fail_step("flips an edge that is not there");
    mesh_.replace(first, {s.right, s.left, s.kept});
    mesh_.replace(second, {s.left, s.right, s.gone});
  }

  const std::vector<Step>& steps_;
  const std::string& name_;
  std::vector<geom::Vec3> position_;
  Connectivity mesh_;
  std::vector<std::uint32_t> around_;
  std::size_t vertices_ = 0;
  std::size_t at_ = 0;
};

}  // namespace

Extracted extract(const Progressive& p, std::size_t vertices, const std::string& name) {
  Player player(p, name);
  for (const Progressive::Level& level : p.levels) {
    if (level.requested != vertices) continue;
    player.play_to(level.steps);
    if (player.vertices() != level.vertices)
      player.fail("the level of " + std::to_string(vertices) + " vertices has " +
                  std::to_string(player.vertices()) + " instead of " +
                  std::to_string(level.vertices));
    return {player.mesh(), player.at(), true, level.vertices <= vertices};
  }
  player.play_until(vertices);
  const bool level = std::any_of(p.levels.begin(), p.levels.end(),
                                 [&](const auto& l) { return l.steps == player.at(); });
  return {player.mesh(), player.at(), level, player.vertices() <= vertices};
}

}  // namespace kaboum::bmesh
