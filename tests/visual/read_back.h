// Reads back a GPU buffer.
#pragma once

#include <vector>

#include "components/math.h"
#include "systems/visual/gpu/buffer.h"

namespace pliant {

template <class T>
std::vector<T> read_back(const gpu::Buffer& buffer, std::size_t count) {
  std::vector<T> values(count);
  glGetNamedBufferSubData(buffer.id(), 0, static_cast<GLsizeiptr>(count * sizeof(T)), values.data());
  return values;
}

}  // namespace pliant
