// The files of shaders/ at build time (cmake/embed_shaders.cmake).
#pragma once

namespace pliant::gpu {

struct EmbeddedShader {
  const char* name;  // within shaders/: "shared/field.glsl"
  const char* text;
};
extern const EmbeddedShader kEmbeddedShaders[];  // the last has no name

}  // namespace pliant::gpu
