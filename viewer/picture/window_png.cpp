#include "viewer/picture/window_png.h"

#include <epoxy/gl.h>

#include <algorithm>

#include "content/files/image.h"

namespace pliant {

std::vector<std::uint8_t> frame_pixels(unsigned framebuffer, int width, int height) {
  const std::size_t row = std::size_t{4} * static_cast<std::size_t>(width), rows = static_cast<std::size_t>(height);
  std::vector<std::uint8_t> rgba(row * rows);
  glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
  for (std::size_t y = 0; y < rows / 2; ++y)  // bottom to top
    std::swap_ranges(rgba.begin() + static_cast<std::ptrdiff_t>(y * row),
                     rgba.begin() + static_cast<std::ptrdiff_t>((y + 1) * row),
                     rgba.end() - static_cast<std::ptrdiff_t>((y + 1) * row));
  for (std::size_t i = 3; i < rgba.size(); i += 4) rgba[i] = 255;  // a picture is opaque
  return rgba;
}

Bytes window_png(int width, int height) {
  return encode_png(static_cast<std::uint32_t>(width), static_cast<std::uint32_t>(height),
                    frame_pixels(0, width, height).data());
}

}  // namespace pliant
