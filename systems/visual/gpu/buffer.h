// Memory on the GPU, and the layout in which vertices are read from it.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "systems/visual/gpu/object.h"

namespace pliant::gpu {

struct DestroyBuffer {
  static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};

// A block of bytes of fixed size, for vertices, indices, constants or storage.
class Buffer {
 public:
  Buffer() = default;
  // Initialised once; only read afterwards.
  static Buffer fixed(const void* data, std::size_t size);
  // Writable any number of times; `data` may be null (undefined contents).
  static Buffer writable(const void* data, std::size_t size);
  template <class T>
  static Buffer fixed(std::span<const T> items) {
    return fixed(items.data(), items.size_bytes());
  }

  // Of a vertex array. Browsers want to know it when the buffer is made.
  static Buffer indices(std::span<const std::uint32_t> items);

  // Replaces bytes [offset, offset + size); returns `size`, for summing up uploads.
  std::size_t write(std::size_t offset, const void* data, std::size_t size);
  std::size_t size() const { return size_; }
  GLuint id() const { return object_.id(); }

 private:
  Buffer(const void* data, std::size_t size, GLenum usage, GLenum target = GL_COPY_WRITE_BUFFER);
  Object<DestroyBuffer> object_;
  std::size_t size_ = 0;  // [bytes]
};

// A buffer whose contents are replaced as a whole; it has the largest size needed so far.
class GrowingBuffer {
 public:
  // Returns the bytes uploaded.
  template <class T>
  std::size_t write(std::span<const T> items) {
    if (items.size_bytes() > buffer_.size() || buffer_.size() == 0)
      buffer_ = Buffer::writable(nullptr, std::max<std::size_t>(2 * items.size_bytes(), 256));
    return buffer_.write(0, items.data(), items.size_bytes());
  }
  const Buffer& buffer() const { return buffer_; }
  GLuint id() const { return buffer_.id(); }

 private:
  Buffer buffer_;
};

struct DestroyVertexArray {
  static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};

// Buffer and offset of each attribute of a vertex shader.
class VertexArray {
 public:
  static VertexArray make();
  // Attributes added from now on read `buffer` every `stride` bytes; per vertex, or (divisor 1) per instance.
  void source(const Buffer& buffer, GLsizei stride, GLuint divisor = 0);
  void floats(GLuint attribute, GLint count, std::size_t offset) const;
  void integer(GLuint attribute, std::size_t offset) const;
  void indices(const Buffer& buffer) const;
  GLuint id() const { return object_.id(); }

 private:
  Object<DestroyVertexArray> object_;
  GLuint buffer_ = 0, divisor_ = 0;
  GLsizei stride_ = 0;  // [bytes]
};

}  // namespace pliant::gpu
