// Which keys of a level a Session takes between ticks, and why it does not take the others.
#pragma once

#include <string>

#include "content/keys/extension_table.h"

namespace pliant {

// "" where it is live; else why not, and what to do: "the mesh is built with it; change the scene and open it again".
std::string why_not_live(const Extension& extension, const Key& key);

}  // namespace pliant
