// Trees of answers, their edges in one table with open addressing.
#include "task/answer_tree.h"

#include <kaboum/base/error.h>

namespace kaboum::plan {
namespace {

std::uint64_t slot_of(Index node, Index content) {
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
    if (replaces && this->leaf(leaf_number(at)).kind != Answer::Kind::NotFound) return std::nullopt;
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
    const Index known = leaf_number(at);
    if (is_plain(known)) return std::nullopt;  // it was found already
    leaves_[known] = leaf;
    return Inserted{known, false};
  }
  if (leaf.kind == Answer::Kind::Value && leaf.text == kNone && leaf.attempts == 1 &&
      leaf.value + 1 < kPlain) {
    const bool fresh = root.last != (leaf.value | kPlain);
    root.last = leaf.value | kPlain;
    link(root, parent, content, root.last | kLeaf);
    return Inserted{root.last, fresh};
  }
  if (leaf.kind != Answer::Kind::NotFound && root.last != kNone && this->leaf(root.last) == leaf) {
    link(root, parent, content, root.last | kLeaf);
    return Inserted{root.last, false};
  }
  const auto made = static_cast<Index>(leaves_.size());
  if (made >= kPlain) throw Error(ErrorCode::LimitReached, "too many calls of external functions");
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
  std::size_t at = slot_of(node, content) & mask;
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
  const Index t = is_plain(leaf) ? kNone : leaves_[leaf].text;
  return t == kNone ? kEmpty : texts_[t];
}

}  // namespace kaboum::plan
