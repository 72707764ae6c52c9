// A field for a key of the level format, of whatever type: number, choice, colour, node, box ...
#pragma once

#include <nlohmann/json.hpp>

#include "content/keys/extension_table.h"
#include "editor/core/editor.h"

namespace pliant {

// At the cursor, with the available width. True: `value` was edited (and is unchecked).
bool key_field(Editor& editor, const Key& key, Json& value);

}  // namespace pliant
