#include "crowd.h"

namespace kaboum::wrap {

void Crowd::build(const std::vector<geom::Vec3>& points,
                  const std::vector<geom::Triangle>& triangles, const std::vector<char>& in_use) {
  geom::Mesh part;
  part.vertices = points;
  std::vector<std::uint32_t> number;
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    if (in_use[t] == 0) continue;
    part.triangles.push_back(triangles[t]);
    number.push_back(t);
  }
  const geom::Bvh bvh(part);
  nodes_.assign(bvh.nodes().size(), {});
  leaf_.assign(triangles.size(), kNone);
  entry_.assign(triangles.size(), kNone);
  entries_.clear();
  entries_.reserve(number.size());
  for (std::uint32_t i = 0; i < nodes_.size(); ++i) {
    const geom::Bvh::Node& from = bvh.nodes()[i];
    nodes_[i].box = from.box;
    if (!from.leaf()) {
      nodes_[i].right = from.first;
      nodes_[from.first].parent = nodes_[i + 1].parent = i;
      continue;
    }
    nodes_[i].first = static_cast<std::uint32_t>(entries_.size());
    for (const std::uint32_t place : bvh.order().subspan(from.first, from.count)) {
      const std::uint32_t t = number[place];
      leaf_[t] = i;
      entry_[t] = static_cast<std::uint32_t>(entries_.size());
      entries_.push_back({{}, t, kNone});
      for (const std::uint32_t v : triangles[t]) entries_.back().box.extend(points[v]);
    }
    nodes_[i].end = static_cast<std::uint32_t>(entries_.size());
  }
  built_ = part.triangles.size();
  changes_ = 0;
}

void Crowd::enlarge(std::uint32_t node, const geom::Box3& box) {
  for (; node != kNone; node = nodes_[node].parent) {
    geom::Box3& have = nodes_[node].box;
    if ((have.min.array() <= box.min.array()).all() && (have.max.array() >= box.max.array()).all())
      return;
    have.extend(box);
  }
}

void Crowd::grow(std::uint32_t triangle, const geom::Box3& box) {
  ++changes_;
  entries_[entry_[triangle]].box = box;
  enlarge(leaf_[triangle], box);
}

void Crowd::add(std::uint32_t triangle, std::uint32_t near, const geom::Box3& box) {
  ++changes_;
  leaf_.resize(triangle + 1, kNone);
  entry_.resize(triangle + 1, kNone);
  Node& leaf = nodes_[leaf_[near]];
  leaf_[triangle] = leaf_[near];
  entry_[triangle] = static_cast<std::uint32_t>(entries_.size());
  entries_.push_back({box, triangle, leaf.added});
  leaf.added = entry_[triangle];
  enlarge(leaf_[near], box);
}

}  // namespace kaboum::wrap
