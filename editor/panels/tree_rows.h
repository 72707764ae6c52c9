// The rows of the scene tree as drawn: their order, what is folded, and the keys that move through them.
#pragma once

#include <map>
#include <set>
#include <vector>

#include "editor/core/panel.h"

namespace pliant {

struct TreeRows {
  std::map<NodeId, bool> fold;     // rows that open or close in the next frame
  std::set<NodeId> parents, open;  // of the rows drawn last
  std::vector<NodeId> order;       // rows drawn so far
  std::vector<NodeId> before;      // all rows of the frame before
  NodeId reveal = kNoNode;         // the node to scroll to

  void begin() {
    order.clear();
    parents.clear();
    open.clear();
  }
  // Arrow keys move the selection, and fold rows.
  void take_keys(Editor& editor, bool folds);
  // Selects all rows from the active one to this.
  void select_range(Editor& editor, NodeId to) const;
};

}  // namespace pliant
