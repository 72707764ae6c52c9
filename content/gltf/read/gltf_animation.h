// glTF animations as tracks of node translation, rotation and scale, and of keys of PLIANT_deformable
// (KHR_animation_pointer).
#pragma once

#include "content/gltf/form/gltf_document.h"

namespace pliant {

// Reads every channel that moves a node or varies a key into level.animations. Requires a checked document
// (gltf_primitives.cpp, gltf_data.cpp) whose nodes have been read. Rejects more keys than limits::kKeys, and values
// beyond kFarthest or the key's range. Skips with a note: morph weights, other targets of KHR_animation_pointer, and
// channels without data in this file.
inline constexpr double kFarthest = 1e6;  // [m], [1], and [s] for times
Status read_animations(const SourceDocument& document, Level& level);

}  // namespace pliant
