// The content of a window as a PNG.
#pragma once

#include "content/files/file_io.h"

namespace pliant {

// Of framebuffer 0, as drawn so far; on the context's thread.
Bytes window_png(int width, int height);

}  // namespace pliant
