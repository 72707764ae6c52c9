#include "runtime/hierarchy.h"

#include <utility>

#include "runtime/assert.h"

namespace pliant {

std::int32_t Hierarchy::find(Entity entity) const {
  const std::int32_t row = entity.index < row_.size() ? row_[entity.index] : -1;
  return row >= 0 && links_[static_cast<std::size_t>(row)].entity == entity ? row : -1;
}

void Hierarchy::replace(std::vector<Link> links) {
  for (const Link& link : links_) row_[link.entity.index] = -1;
  links_ = std::move(links);
  for (std::size_t i = 0; i < links_.size(); ++i) row_[links_[i].entity.index] = static_cast<std::int32_t>(i);
}

Entity Hierarchy::parent(Entity entity) const {
  const std::int32_t i = find(entity);
  ASSERT(i >= 0);
  const std::int32_t parent = links_[static_cast<std::size_t>(i)].parent;
  return parent < 0 ? kNoEntity : links_[static_cast<std::size_t>(parent)].entity;
}

void Hierarchy::add(Entity entity, Entity parent) {
  const std::int32_t parent_index = parent == kNoEntity ? -1 : find(parent);
  ASSERT(parent == kNoEntity || parent_index >= 0);
  if (entity.index >= row_.size()) row_.resize(entity.index + 1, -1);
  row_[entity.index] = static_cast<std::int32_t>(links_.size());
  links_.push_back({entity, parent_index});
}

// Parents stand first, so one pass marks everything that hangs, at any depth, from `root`.
std::vector<bool> Hierarchy::below(std::int32_t root) const {
  std::vector<bool> marked(links_.size(), false);
  marked[static_cast<std::size_t>(root)] = true;
  for (std::size_t i = static_cast<std::size_t>(root) + 1; i < links_.size(); ++i)
    marked[i] = links_[i].parent >= 0 && marked[static_cast<std::size_t>(links_[i].parent)];
  return marked;
}

std::vector<Entity> Hierarchy::remove(Entity entity) {
  const std::int32_t root = find(entity);
  ASSERT(root >= 0);
  const std::vector<bool> gone = below(root);
  std::vector<Entity> removed;
  std::vector<std::int32_t> moved_to(links_.size(), -1);
  std::vector<Link> kept;
  for (std::size_t i = 0; i < links_.size(); ++i) {
    if (gone[i]) {
      removed.push_back(links_[i].entity);
      continue;
    }
    moved_to[i] = static_cast<std::int32_t>(kept.size());
    const std::int32_t parent = links_[i].parent;
    kept.push_back({links_[i].entity, parent < 0 ? -1 : moved_to[static_cast<std::size_t>(parent)]});
  }
  replace(std::move(kept));
  return removed;
}

bool Hierarchy::move(Entity entity, Entity parent) {
  const std::int32_t root = find(entity);
  ASSERT(root >= 0);
  const std::vector<bool> moving = below(root);
  std::int32_t new_parent = parent == kNoEntity ? -1 : find(parent);
  ASSERT(parent == kNoEntity || new_parent >= 0);
  if (new_parent >= 0 && moving[static_cast<std::size_t>(new_parent)]) return false;

  // What stays keeps its order and goes first; what moves follows, in its own order: parents still stand before
  // children.
  std::vector<std::int32_t> moved_to(links_.size(), -1);
  std::vector<Link> ordered;
  for (const bool pass : {false, true}) {
    for (std::size_t i = 0; i < links_.size(); ++i) {
      if (moving[i] != pass) continue;
      moved_to[i] = static_cast<std::int32_t>(ordered.size());
      const std::int32_t old = static_cast<std::int32_t>(i) == root ? new_parent : links_[i].parent;
      ordered.push_back({links_[i].entity, old < 0 ? -1 : moved_to[static_cast<std::size_t>(old)]});
    }
  }
  replace(std::move(ordered));
  return true;
}

}  // namespace pliant
