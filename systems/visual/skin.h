// The deformed collision mesh of one soft body on the GPU: position and normal of every vertex, in the layout of
// shaders/skin.glsl.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "components/math.h"
#include "systems/visual/gpu/table.h"

namespace pliant {

// A unit vector in two 16-bit numbers, to 1e-4 rad, by the octahedral mapping (Cigolle et al., A Survey of Efficient
// Representations for Independent Unit Vectors, JCGT 3(2), 2014).
std::uint32_t folded(vec3 unit);

class Skin {
 public:
  Skin() = default;
  explicit Skin(std::size_t vertices);

  // Takes positions [m] and unit normals, world frame. False, without effect, if their number is wrong.
  bool take(std::span<const vec3> position, std::span<const vec3> normal);
  // Updates the GPU's copy. Returns the bytes uploaded: 16 per vertex, or none.
  std::size_t upload();

  std::size_t vertices() const { return here_.size(); }
  const Box& box() const { return box_; }  // [m] world
  const gpu::Table& table() const { return table_; }
  // A copy of the last state taken.
  gpu::Table copy() const { return {gpu::Table::Of::kBits, here_.data(), here_.size(), 0}; }

 private:
  std::vector<glm::uvec4> here_;
  Box box_;
  bool newer_here_ = false;
  gpu::Table table_;
};

}  // namespace pliant
