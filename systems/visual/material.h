// Materials on the GPU: one block of constants each, and shared textures.
#pragma once

#include <vector>

#include "components/world.h"
#include "runtime/result.h"
#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/texture.h"

namespace pliant {

class Materials {
 public:
  // Uploads every image that a material uses. The error names the image.
  static Result<Materials> make(const World& world);
  // Binds constants and textures of material `index` (-1 or out of range: the default material).
  void bind(std::int32_t index) const;
  bool blends(std::int32_t index) const { return entry(index).blends; }
  bool transmits(std::int32_t index) const { return entry(index).transmits; }
  bool casts_shadow(std::int32_t index) const { return entry(index).casts; }
  bool double_sided(std::int32_t index) const { return entry(index).double_sided; }

 private:
  struct Entry {
    int base_color = 0, roughness = 0, normal = 0, occlusion = 0, emissive = 0, height = 0, transmission = 0,
        thickness = 0;  // into textures_
    bool casts = true, blends = false, double_sided = false, transmits = false;
  };
  const Entry& entry(std::int32_t index) const;
  std::size_t row(std::int32_t index) const;

  std::vector<gpu::Texture> textures_;
  std::vector<Entry> entries_;  // the level's materials, then the default one
  gpu::Buffer constants_;
  std::size_t stride_ = 0;  // [bytes] from one material's constants to the next
};

}  // namespace pliant
