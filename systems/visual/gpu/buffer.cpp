#include "systems/visual/gpu/buffer.h"

#include "runtime/assert.h"

namespace pliant::gpu {

Buffer::Buffer(const void* data, std::size_t size, GLbitfield flags) : size_(size) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  object_ = Object<DestroyBuffer>(id);
  // OpenGL has no empty buffers: a few bytes are allocated, so that an empty mesh needs no special case.
  const std::size_t at_least_some = size ? size : 16;
  glNamedBufferStorage(id, static_cast<GLsizeiptr>(at_least_some), size ? data : nullptr, flags);
}

Buffer Buffer::fixed(const void* data, std::size_t size) {
  return {data, size, 0};
}

Buffer Buffer::writable(const void* data, std::size_t size) {
  return {data, size, GL_DYNAMIC_STORAGE_BIT};
}

std::size_t Buffer::write(std::size_t offset, const void* data, std::size_t size) {
  ASSERT(offset + size <= size_);
  if (size) glNamedBufferSubData(id(), static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(size), data);
  return size;
}

void Buffer::clear() {
  if (size_) glClearNamedBufferData(id(), GL_R32F, GL_RED, GL_FLOAT, nullptr);
}

VertexArray VertexArray::make() {
  GLuint id = 0;
  glCreateVertexArrays(1, &id);
  VertexArray made;
  made.object_ = Object<DestroyVertexArray>(id);
  return made;
}

void VertexArray::source(GLuint slot, const Buffer& buffer, GLsizei stride, GLuint divisor) const {
  glVertexArrayVertexBuffer(id(), slot, buffer.id(), 0, stride);
  glVertexArrayBindingDivisor(id(), slot, divisor);
}

void VertexArray::floats(GLuint attribute, GLuint slot, GLint count, std::size_t offset) const {
  glEnableVertexArrayAttrib(id(), attribute);
  glVertexArrayAttribFormat(id(), attribute, count, GL_FLOAT, GL_FALSE, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(id(), attribute, slot);
}

void VertexArray::integer(GLuint attribute, GLuint slot, std::size_t offset) const {
  glEnableVertexArrayAttrib(id(), attribute);
  glVertexArrayAttribIFormat(id(), attribute, 1, GL_UNSIGNED_INT, static_cast<GLuint>(offset));
  glVertexArrayAttribBinding(id(), attribute, slot);
}

}  // namespace pliant::gpu
