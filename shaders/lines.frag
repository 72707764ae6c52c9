// Lines over everything, so that an inside can be seen.
layout(location = 0) out vec4 color;

void main() { color = vec4(0.02, 0.16, 0.32, 0.3); }
