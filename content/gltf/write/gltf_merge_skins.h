// merge_document: skins. A skin is kept if all its joints are, and shown if it still gives the shape in the Level.
#pragma once

#include <vector>

#include "content/gltf/write/gltf_merge.h"

namespace pliant {

// Whether a node's joints have kept their place relative to it, within rounding, so that its skin gives the same shape.
class SkinsAtRest {
 public:
  explicit SkinsAtRest(const Merge& merge);
  bool is(std::int32_t node) const;  // /nodes/i as read, with a skin

 private:
  const Merge& merge_;
  std::vector<dmat4> then_, now_;  // node to world, by number as read
};

// Removes skins that have lost a joint. Returns /skins/i as read -> now.
std::vector<std::int32_t> merge_skins(Merge& merge);

}  // namespace pliant
