// The finished picture, with a line around the selected object and the one under the mouse.
layout(location = 0) in vec2 place;
layout(location = 0) uniform sampler2D scene;
layout(location = 1) uniform usampler2D numbers;
layout(location = 2) uniform vec4 selected_color;
layout(location = 3) uniform vec4 hovered_color;
layout(location = 4) uniform uint hovered;
layout(location = 5) uniform uint first_selected;  // numbers from here on are selected
layout(location = 6) uniform int reach;            // [pixel] of the line

layout(location = 0) out vec4 color;

void main() {
  ivec2 size = textureSize(numbers, 0), at = min(ivec2(place * vec2(size)), size - 1);
  color = vec4(texture(scene, place).rgb, 1.0);
  uint here = texelFetch(numbers, at, 0).r;
  bool on_selected = false, on_hovered = false, inside_selected = here >= first_selected && here != 0u,
       inside_hovered = here == hovered && hovered != 0u;
  for (int y = -reach; y <= reach; ++y)
    for (int x = -reach; x <= reach; ++x) {
      uint other = texelFetch(numbers, clamp(at + ivec2(x, y), ivec2(0), size - 1), 0).r;
      on_selected = on_selected || (other >= first_selected && other != 0u);
      on_hovered = on_hovered || (other == hovered && hovered != 0u);
    }
  if (on_hovered && !inside_hovered) color = mix(color, hovered_color, hovered_color.a);
  if (on_selected && !inside_selected) color = mix(color, selected_color, selected_color.a);
}
