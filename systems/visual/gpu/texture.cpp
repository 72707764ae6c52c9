#include "systems/visual/gpu/texture.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "runtime/assert.h"

namespace pliant::gpu {

Texture::Texture(GLenum format, int width, int height)
    : levels_(std::bit_width(static_cast<unsigned>(std::max(width, height)))) {
  GLuint id = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &id);
  object_ = Object<DestroyTexture>(id);
  glTextureStorage2D(id, levels_, format, width, height);
  glTextureParameteri(id, GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  glTextureParameteri(id, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
}

Result<Texture> Texture::from_image(const Image& image, Meaning meaning) {
  GLint limit = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &limit);
  const std::size_t bytes = std::size_t{4} * image.width * image.height;
  if (bytes == 0 || image.rgba.size() != bytes)
    return Error{image.name, fmt::format("a picture of {}x{} pixels with {} bytes; it must have four to a pixel",
                                         image.width, image.height, image.rgba.size())};
  if (image.width > static_cast<std::uint32_t>(limit) || image.height > static_cast<std::uint32_t>(limit))
    return Error{image.name, fmt::format("{}x{} pixels are more than the graphics card holds ({}); scale it down",
                                         image.width, image.height, limit)};
  const int width = static_cast<int>(image.width), height = static_cast<int>(image.height);
  Texture texture(meaning == Meaning::kColor ? GL_SRGB8_ALPHA8 : GL_RGBA8, width, height);
  const GLuint id = texture.object_.id();
  glTextureSubImage2D(id, 0, 0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, image.rgba.data());
  glGenerateTextureMipmap(id);
  return texture;
}

Texture Texture::from_panorama(std::span<const float> rgb, int width, int height) {
  ASSERT(rgb.size() == std::size_t{3} * static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  Texture texture(GL_RGB16F, width, height);
  const GLuint id = texture.object_.id();
  glTextureSubImage2D(id, 0, 0, 0, width, height, GL_RGB, GL_FLOAT, rgb.data());
  glTextureParameteri(id, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  glGenerateTextureMipmap(id);
  return texture;
}

Texture Texture::constant(std::uint8_t r, std::uint8_t g, std::uint8_t b) {
  Texture texture(GL_RGBA8, 1, 1);
  const std::uint8_t pixel[4] = {r, g, b, 255};
  glTextureSubImage2D(texture.object_.id(), 0, 0, 0, 1, 1, GL_RGBA, GL_UNSIGNED_BYTE, pixel);
  return texture;
}

}  // namespace pliant::gpu
