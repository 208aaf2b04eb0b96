// Trees of answers, their edges in one table with open addressing.
#include "task/answer_tree.h"

#include <kaboum/base/error.h>

namespace kaboum::plan {
namespace {

std::uint64_t mix(Index node, Index content) {
  std::uint64_t h = (std::uint64_t{node} << 32U | content) * 0x9e3779b97f4a7c15ULL;
  return h ^ (h >> 29U);
}

}  // namespace

Index AnswerTree::child(Index node, Index content) const {
  const Edge& e = edges_[slot(node, content)];
  return e.node == kNone ? kNone : e.child;
}

std::optional<AnswerTree::Inserted> AnswerTree::insert(Root& root, const Footprint& read,
                                                       Leaf leaf) {
  Index at = root.node;
  Index parent = kNone;
  Index content = 0;
  for (const auto& [item, found] : read) {
    const bool replaces = is_leaf(at);
    if (replaces && leaves_[leaf_number(at)].kind != Answer::Kind::NotFound) return std::nullopt;
    if (at == kNone || replaces) {
      const auto node = static_cast<Index>(nodes_.size());
      nodes_.push_back(item);
      link(root, parent, content, node);
      at = node;
    } else if (nodes_[at] != item) {
      return std::nullopt;
    }
    parent = at;
    content = found;
    at = child(at, found);
  }
  if (at != kNone && !is_leaf(at)) return std::nullopt;
  if (at != kNone) {  // tried again
    leaves_[leaf_number(at)] = leaf;
    return Inserted{leaf_number(at), false};
  }
  if (leaf.kind != Answer::Kind::NotFound && root.last != kNone && leaves_[root.last] == leaf) {
    link(root, parent, content, root.last | kLeaf);
    return Inserted{root.last, false};
  }
  const auto made = static_cast<Index>(leaves_.size());
  if (made >= kLeaf) throw Error(ErrorCode::LimitReached, "too many calls of external functions");
  root.last = made;
  leaves_.push_back(leaf);
  link(root, parent, content, made | kLeaf);
  return Inserted{made, true};
}

void AnswerTree::link(Root& root, Index parent, Index content, Index child) {
  if (parent == kNone) {
    root.node = child;
    return;
  }
  if (Edge& known = edges_[slot(parent, content)]; known.node != kNone) {
    known.child = child;
    return;
  }
  if (++edge_count_ * 8 > edges_.size() * 7) {
    std::vector<Edge> old(edges_.size() * 2);
    old.swap(edges_);
    for (const Edge& e : old)
      if (e.node != kNone) edges_[slot(e.node, e.content)] = e;
  }
  edges_[slot(parent, content)] = {parent, content, child};
}

std::size_t AnswerTree::slot(Index node, Index content) const {
  const std::size_t mask = edges_.size() - 1;
  std::size_t at = mix(node, content) & mask;
  while (edges_[at].node != kNone && (edges_[at].node != node || edges_[at].content != content))
    at = (at + 1) & mask;
  return at;
}

Index AnswerTree::text(std::string text) {
  if (text.empty()) return kNone;
  texts_.push_back(std::move(text));
  return static_cast<Index>(texts_.size() - 1);
}

const std::string& AnswerTree::payload(Index leaf) const {
  static const std::string kEmpty;
  const Index t = leaves_[leaf].text;
  return t == kNone ? kEmpty : texts_[t];
}

}  // namespace kaboum::plan
