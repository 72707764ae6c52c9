// The meaning of the value 0 of a key, as its field shows it.
#pragma once

#include <string>

#include "content/keys/extension_table.h"
#include "editor/document/state.h"

namespace pliant {

// "automatic: 12 mm" where 0 is resolved from the object, else the words of the key's documentation ("none", "never"),
// "automatic" where these are long; "": 0 is a number like others.
std::string zero_text(const State& state, const DocumentNode& node, const std::string& extension, const Key& key);

}  // namespace pliant
