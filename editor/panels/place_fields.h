// The fields of a node's place: position, rotation, scale and size.
#pragma once

#include <utility>

#include "editor/core/panel.h"

namespace pliant {

// [m] Of the node's mesh, along the node's own axes, including all inherited scales.
dvec3 world_size(const Editor& editor, const DocumentNode& node);

class PlaceFields {
 public:
  void draw(Editor& editor, const DocumentNode& node);

 private:
  bool same_turn(quat q) const;

  // The angles as they were typed: a rotation has several.
  std::pair<NodeId, dvec3> shown_turn_{kNoNode, {}};
  quat shown_quat_{1, 0, 0, 0};
};

}  // namespace pliant
