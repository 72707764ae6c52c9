// The menu of a number in the inspector: the level offers it as a slider (key `expose`).
#pragma once

#include "content/keys/extension_table.h"
#include "editor/core/editor.h"

namespace pliant {

// Of the item that was drawn last, on a right click.
void offer_slider(Editor& editor, const Extension& extension, const Key& key, NodeId id);

}  // namespace pliant
