// The skin of one soft body on the GPU: where every vertex is and which way it faces, as shaders/skin.glsl reads it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "components/math.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/staging.h"

namespace pliant {

// A unit vector in two numbers of 16 bits, to 1e-4 rad: a point of the square into which an octahedron unfolds
// (Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, JCGT 3(2), 2014).
std::uint32_t folded(vec3 unit);

class Skin {
 public:
  Skin() = default;
  explicit Skin(std::size_t vertices);

  // Takes positions [m] and unit normals, world frame; false, and nothing is taken, where there are too few or too
  // many.
  bool take(std::span<const vec3> position, std::span<const vec3> normal);
  // Brings the GPU up to date. Returns the bytes that travelled: 16 a vertex, or none.
  std::size_t upload();

  std::size_t vertices() const { return here_.size(); }
  const Box& box() const { return box_; }  // [m] world
  const gpu::Buffer& buffer() const { return on_card_; }
  // As it was last taken.
  gpu::Buffer copy() const { return gpu::Buffer::writable(here_.data(), here_.size() * sizeof(glm::uvec4)); }

 private:
  std::vector<glm::uvec4> here_;
  Box box_;
  bool newer_here_ = false;
  gpu::Buffer on_card_;
  gpu::Staging staging_;
};

}  // namespace pliant
