// Environment light and lamps: from the level's panorama and lights, or from a built-in studio.
#pragma once

#include <array>

#include "components/appearance.h"
#include "components/world.h"
#include "systems/visual/frame.h"
#include "systems/visual/gpu/texture.h"

namespace pliant {

// The nine coefficients of shaders/environment.glsl's irradiance polynomial [lx], panorama frame (its middle column is
// towards -Z, rows go from +Y to -Y). Radiance above kSunClip times the mean is left to the key light.
std::array<vec4, 9> irradiance_of(const Panorama& panorama);

// The value of that polynomial for a unit normal in the panorama frame.
vec3 irradiance_on(const std::array<vec4, 9>& coefficients, vec3 normal);

class Surroundings {
 public:
  // Filters and uploads the panorama, or reads it from the cache of an earlier run.
  static Surroundings make(const World& world);
  // Writes all of light and exposure into `frame`.
  void light(FrameConstants& frame) const;
  void bind() const {
    cube_.bind(kSurroundingsUnit);
    coat_.bind(kCoatUnit);
  }

 private:
  gpu::Texture cube_, coat_;
  FrameConstants constants_;  // the part about light
};

}  // namespace pliant
