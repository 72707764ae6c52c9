// Depth only; masked-out texels let light through.
#include "material.glsl"

in vec2 at;

void main() {
  if (emissive.w > 0.0 && base_color_at(at).a < emissive.w) discard;
}
