// Who hangs from whom. Entities are kept so that parents stand before children: one pass over order() updates a tree.
#pragma once

#include <cstdint>
#include <vector>

#include "runtime/entity.h"

namespace pliant {

class Hierarchy {
 public:
  struct Link {
    Entity entity;
    std::int32_t parent = -1;  // index into order() of the parent, always smaller than this link's own; -1: a root
  };

  // Adds an entity under `parent` (kNoEntity: a root). The parent must have been added before.
  void add(Entity entity, Entity parent = kNoEntity);
  // Takes out an entity and everything below it; returns them, parents first.
  std::vector<Entity> remove(Entity entity);
  // Hangs an entity, with all that is below it, under another parent. False if that parent is below the entity itself.
  bool move(Entity entity, Entity parent);

  bool contains(Entity entity) const { return find(entity) >= 0; }
  Entity parent(Entity entity) const;
  const std::vector<Link>& order() const { return links_; }

 private:
  std::int32_t find(Entity entity) const;
  std::vector<bool> below(std::int32_t root) const;
  void replace(std::vector<Link> links);
  std::vector<Link> links_;
  std::vector<std::int32_t> row_;  // entity index -> place in links_, -1: not there
};

}  // namespace pliant
