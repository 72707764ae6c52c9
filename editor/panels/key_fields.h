// A field for a key of the level format, of whatever type: number, choice, colour, node, box ...
#pragma once

#include <nlohmann/json.hpp>

#include "content/keys/extension_table.h"
#include "editor/app/editor.h"

namespace pliant {

// At the cursor, as wide as there is room. True: `value` is to be another one (it has not been checked).
bool key_field(Editor& editor, const Key& key, Json& value);

}  // namespace pliant
