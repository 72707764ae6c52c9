// The content of a window as a PNG.
#pragma once

#include <cstdint>
#include <vector>

#include "content/files/file_io.h"

namespace pliant {

// RGBA, rows top to bottom, opaque.
std::vector<std::uint8_t> frame_pixels(unsigned framebuffer, int width, int height);
// Of framebuffer 0, as drawn so far; on the context's thread.
Bytes window_png(int width, int height);

}  // namespace pliant
