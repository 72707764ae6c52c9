// glTF animations as tracks: what translates, turns and scales nodes.
#pragma once

#include "content/gltf/gltf_document.h"

namespace pliant {

// Reads every channel that moves a node into level.animations. The document has been checked (gltf_primitives.cpp,
// gltf_data.cpp) and its nodes have been read. Refused: more keys than limits::kKeys, values beyond kFarthest. Left
// out, with a note: morph weights, what KHR_animation_pointer aims at, and what has no data in this file.
inline constexpr double kFarthest = 1e6;  // [m], [1], and [s] for times
Status read_animations(const SourceDocument& document, Level& level);

}  // namespace pliant
