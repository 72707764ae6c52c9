// Pictures on the card.
#pragma once

#include <cstddef>
#include <span>

#include "components/appearance.h"
#include "runtime/result.h"
#include "systems/visual/gpu/object.h"

namespace pliant::gpu {

struct DestroyTexture {
  static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};

enum class Meaning {
  kColor,  // sRGB: decoded to linear when sampled
  kData    // numbers: normals, roughness
};

// A two-dimensional texture with all its mipmaps. Rows lie as in the file: v = 0 is the top row, as glTF has it.
class Texture {
 public:
  Texture() = default;
  // Fails where the picture's size and its bytes do not agree, or the card cannot hold it.
  static Result<Texture> from_image(const Image& image, Meaning meaning);
  // Linear RGB, wraps around horizontally; rgb.size() == 3 * width * height.
  static Texture from_panorama(std::span<const float> rgb, int width, int height);
  // One pixel, for materials without a picture.
  static Texture constant(std::uint8_t r, std::uint8_t g, std::uint8_t b);

  void bind(GLuint unit) const { glBindTextureUnit(unit, object_.id()); }
  int levels() const { return levels_; }

 private:
  Texture(GLenum format, int width, int height);
  Object<DestroyTexture> object_;
  int levels_ = 0;
};

}  // namespace pliant::gpu
