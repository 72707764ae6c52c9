// glTF animations as tracks of node translation, rotation and scale.
#pragma once

#include "content/gltf/form/gltf_document.h"

namespace pliant {

// Reads every channel that moves a node into level.animations. Requires a checked document (gltf_primitives.cpp,
// gltf_data.cpp) whose nodes have been read. Rejects more keys than limits::kKeys, and values beyond kFarthest. Skips
// with a note: morph weights, targets of KHR_animation_pointer, and channels without data in this file.
inline constexpr double kFarthest = 1e6;  // [m], [1], and [s] for times
Status read_animations(const SourceDocument& document, Level& level);

}  // namespace pliant
