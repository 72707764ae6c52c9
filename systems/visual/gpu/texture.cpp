#include "systems/visual/gpu/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "runtime/assert.h"

namespace pliant::gpu {

namespace {

// Number of mip levels down to one pixel.
int all_levels(int width, int height) {
  return std::bit_width(static_cast<unsigned>(std::max(width, height)));
}

}  // namespace

// It stays bound to the scratch unit.
Texture::Texture(GLenum kind, GLenum format, int width, int height, int levels) : kind_(kind) {
  GLuint id = 0;
  glGenTextures(1, &id);
  object_ = Object<DestroyTexture>(id);
  bind(kScratchUnit);
  glTexStorage2D(kind, levels, format, width, height);
  glTexParameteri(kind, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTexParameteri(kind, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

Object<DestroyTexture> make_plane(GLenum format, int width, int height) {
  GLuint id = 0;
  glGenTextures(1, &id);
  bind_texture(kScratchUnit, GL_TEXTURE_2D, id);
  glTexStorage2D(GL_TEXTURE_2D, 1, format, width, height);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  for (const GLenum wrap : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    glTexParameteri(GL_TEXTURE_2D, wrap, GL_CLAMP_TO_EDGE);
  return Object<DestroyTexture>(id);
}

Result<Texture> Texture::from_image(const Image& image, Meaning meaning) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  const std::size_t bytes = std::size_t{4} * image.width * image.height;
  if (bytes == 0 || image.rgba.size() != bytes)
    return Error{image.name, fmt::format("a picture of {}x{} pixels with {} bytes; it must have four to a pixel",
                                         image.width, image.height, image.rgba.size())};
  if (image.width > static_cast<std::uint32_t>(limit) || image.height > static_cast<std::uint32_t>(limit))
    return Error{image.name,
                 fmt::format("{}x{} pixels are more than the GPU holds ({})", image.width, image.height, limit),
                 "scale it down"};
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  Texture texture(GL_TEXTURE_2D, meaning == Meaning::kColor ? GL_SRGB8_ALPHA8 : GL_RGBA8, width, height,
                  all_levels(width, height));
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  glGenerateMipmap(GL_TEXTURE_2D);
  return texture;
}

Texture Texture::from_cube(std::span<const std::uint16_t> rgb, int face, int levels) {
  Texture texture(GL_TEXTURE_CUBE_MAP, GL_RGB16F, face, face, levels);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 2);
  std::size_t first = 0;
  for (int level = 0; level < levels; ++level) {
    const int size = face >> level;
    const std::size_t count = std::size_t{3} * static_cast<std::size_t>(size) * static_cast<std::size_t>(size);
    for (GLenum side = 0; side < 6; ++side, first += count) {
      ASSERT(first + count <= rgb.size());
      glTexSubImage2D(GL_TEXTURE_CUBE_MAP_POSITIVE_X + side, level, 0, 0, size, size, GL_RGB, GL_HALF_FLOAT,
                      &rgb[first]);
    }
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  return texture;
}

Texture Texture::from_table(std::span<const vec2> values, int size) {
  ASSERT(values.size() == static_cast<std::size_t>(size) * static_cast<std::size_t>(size));
  Texture texture(GL_TEXTURE_2D, GL_RG16F, size, size, 1);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size, size, GL_RG, GL_FLOAT, values.data());
  return texture;
}

Texture Texture::constant(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Texture texture(GL_TEXTURE_2D, GL_RGBA8, 1, 1, 1);
  const std::uint8_t pixel[4] = {r, g, b, 255};
  glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
  return texture;
}

}  // namespace pliant::gpu
