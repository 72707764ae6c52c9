#include "systems/visual/gpu/buffer.h"

#include "runtime/assert.h"

namespace pliant::gpu {
namespace {

const void* at_byte(std::size_t offset) {
  return reinterpret_cast<const void*>(offset);
}

}  // namespace

// Contents pass through GL_COPY_WRITE_BUFFER, which belongs to no vertex array.
Buffer::Buffer(const void* data, std::size_t size, GLenum usage, GLenum target) : size_(size) {
  GLuint id = 0;
  glGenBuffers(1, &id);
  object_ = Object<DestroyBuffer>(id);
  // OpenGL has no empty buffers: a few bytes are allocated, so that an empty mesh needs no special case.
  const std::size_t at_least_some = size ? size : 16;
  glBindBuffer(target, id);
  glBufferData(target, static_cast<GLsizeiptr>(at_least_some), size ? data : nullptr, usage);
}

Buffer Buffer::fixed(const void* data, std::size_t size) {
  return {data, size, GL_STATIC_DRAW};
}

// In WebGL the first target decides whether a buffer may hold indices.
Buffer Buffer::indices(std::span<const std::uint32_t> items) {
  if (!is_es()) return fixed(items);
  glBindVertexArray(0);
  return {items.data(), items.size_bytes(), GL_STATIC_DRAW, GL_ELEMENT_ARRAY_BUFFER};
}

Buffer Buffer::writable(const void* data, std::size_t size) {
  return {data, size, GL_DYNAMIC_DRAW};
}

std::size_t Buffer::write(std::size_t offset, const void* data, std::size_t size) {
  ASSERT(offset + size <= size_);
  if (size == 0) return 0;
  glBindBuffer(GL_COPY_WRITE_BUFFER, id());
  glBufferSubData(GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(size), data);
  return size;
}

VertexArray VertexArray::make() {
  GLuint id = 0;
  glGenVertexArrays(1, &id);
  VertexArray made;
  made.object_ = Object<DestroyVertexArray>(id);
  return made;
}

void VertexArray::source(const Buffer& buffer, GLsizei stride, GLuint divisor) {
  buffer_ = buffer.id();
  stride_ = stride;
  divisor_ = divisor;
}

void VertexArray::floats(GLuint attribute, GLint count, std::size_t offset) const {
  glBindVertexArray(id());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  glEnableVertexAttribArray(attribute);
  glVertexAttribPointer(attribute, count, GL_FLOAT, GL_FALSE, stride_, at_byte(offset));
  glVertexAttribDivisor(attribute, divisor_);
}

void VertexArray::integer(GLuint attribute, std::size_t offset) const {
  glBindVertexArray(id());
  glBindBuffer(GL_ARRAY_BUFFER, buffer_);
  glEnableVertexAttribArray(attribute);
  glVertexAttribIPointer(attribute, 1, GL_UNSIGNED_INT, stride_, at_byte(offset));
  glVertexAttribDivisor(attribute, divisor_);
}

void VertexArray::indices(const Buffer& buffer) const {
  glBindVertexArray(id());
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, buffer.id());
}

}  // namespace pliant::gpu
