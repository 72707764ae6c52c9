// Where OpenGL ES has a record of a table: a texture instead of a storage buffer (systems/visual/gpu/table.h).

ivec2 texel_of(uint record) { return ivec2(record & 1023u, record >> 10); }
