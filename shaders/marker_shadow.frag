// Depth only. OpenGL ES requires both stages.
void main() {}
