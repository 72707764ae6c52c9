// Calls of OpenGL 4.5 that OpenGL ES 3.0 lacks. The first three have no effect in a context of OpenGL ES; the others
// are for 4.5 alone.
#pragma once

#include <cstddef>

#include "systems/visual/gpu/gl_api.h"

namespace pliant::gpu::desktop {

void encode_srgb(bool on);        // of what is written into sRGB targets; OpenGL ES always encodes
void filter_across_cube_edges();  // OpenGL ES always does
void draw_as_lines(bool on);      // triangles

// Gives `buffer` memory that stays mapped for writing until it is deleted.
std::byte* map(GLuint buffer, std::size_t size);
void clear(GLuint buffer);      // all bytes zero
std::size_t largest_storage();  // [bytes] that a shader can address in one storage buffer
void bind_storage(GLuint binding, GLuint buffer);
// Runs the current compute program; what it wrote is visible to later shaders.
void dispatch(GLuint groups);

}  // namespace pliant::gpu::desktop
