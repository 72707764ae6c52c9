// Textures on the GPU.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "components/appearance.h"
#include "runtime/result.h"
#include "systems/visual/gpu/object.h"

namespace pliant::gpu {

struct DestroyTexture {
  static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};

// Textures are made and written on this unit, which no shader reads.
inline constexpr GLuint kScratchUnit = 15;
inline void bind_texture(GLuint unit, GLenum kind, GLuint id) {
  glActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(kind, id);
}
// One level, sampled without filter, clamped to the border; on the scratch unit.
Object<DestroyTexture> make_plane(GLenum format, int width, int height);

enum class Meaning {
  kColor,  // sRGB: decoded to linear when sampled
  kData    // numbers: normals, roughness
};

// A texture with its mipmaps. Rows as in the file: v = 0 is the top row, as in glTF.
class Texture {
 public:
  Texture() = default;
  // Fails if the image's size and its bytes do not agree, or the GPU's limit is exceeded.
  static Result<Texture> from_image(const Image& image, Meaning meaning);
  // A cube map in linear RGB, half floats: level by level, face by face (+X -X +Y -Y +Z -Z). `face` pixels an edge in
  // level 0 and half as many in each following level.
  static Texture from_cube(std::span<const std::uint16_t> rgb, int face, int levels);
  // Pairs of numbers, `size` x `size`, row by row; interpolated, clamped to the border.
  static Texture from_table(std::span<const vec2> values, int size);
  // One pixel, for materials without an image.
  static Texture constant(std::uint8_t r, std::uint8_t g, std::uint8_t b);

  void bind(GLuint unit) const { bind_texture(unit, kind_, object_.id()); }

 private:
  Texture(GLenum kind, GLenum format, int width, int height, int levels);
  GLenum kind_ = GL_TEXTURE_2D;
  Object<DestroyTexture> object_;
};

}  // namespace pliant::gpu
