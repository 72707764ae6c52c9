#include "runtime/hierarchy.h"

#include "runtime/assert.h"

namespace pliant {

std::int32_t Hierarchy::find(Entity entity) const {
  const std::int32_t row = entity.index < row_.size() ? row_[entity.index] : -1;
  return row >= 0 && links_[static_cast<std::size_t>(row)].entity == entity ? row : -1;
}

void Hierarchy::add(Entity entity, Entity parent) {
  const std::int32_t parent_index = parent == kNoEntity ? -1 : find(parent);
  ASSERT(parent == kNoEntity || parent_index >= 0);
  if (entity.index >= row_.size()) row_.resize(entity.index + 1, -1);
  row_[entity.index] = static_cast<std::int32_t>(links_.size());
  links_.push_back({entity, parent_index});
}

}  // namespace pliant
