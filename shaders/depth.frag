// The normal in the picture's view; masked-out texels are left out.
#include "material.glsl"

in vec2 at;
in vec3 outward;

layout(location = 0) out vec4 seen;

void main() {
  if (emissive.w > 0.0 && base_color_at(at).a < emissive.w) discard;
  seen = vec4(0.5 + 0.5 * normalize(gl_FrontFacing ? outward : -outward), 1.0);
}
