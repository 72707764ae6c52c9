// Parents and children. Parents precede their children in order(): one pass updates a tree.
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
  const std::vector<Link>& order() const { return links_; }

 private:
  std::int32_t find(Entity entity) const;
  std::vector<Link> links_;
  std::vector<std::int32_t> row_;  // entity index -> place in links_, -1: not there
};

}  // namespace pliant
