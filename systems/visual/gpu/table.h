// Records of 16 bytes that vertex shaders read by number (shaders/table.glsl): a storage buffer, or, in a context of
// OpenGL ES, a texture of kRow records a row.
#pragma once

#include <cstddef>

#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/staging.h"
#include "systems/visual/gpu/texture.h"

namespace pliant::gpu {

class Table {
 public:
  static constexpr std::size_t kRecord = 16, kRow = 1024;  // [bytes] [records]
  enum class Of { kFloats, kBits };

  Table() = default;
  // `records` may be null (undefined contents). `staged`: the most records that a picture usually changes; 0: written
  // only here.
  Table(Of of, const void* records, std::size_t count, std::size_t staged);
  // Replaces records [first, first + count). Returns the bytes uploaded.
  std::size_t write(std::size_t first, const void* records, std::size_t count);
  // Call once after all writes of a picture.
  void finish() { staging_.finish(); }
  // For shaders: as storage buffer `binding`, or on texture unit `unit`.
  void bind(GLuint binding, GLuint unit) const;

  std::size_t bytes() const { return count_ * kRecord; }
  static std::size_t most_bytes();                  // of one table in this context
  const Buffer& buffer() const { return buffer_; }  // empty in OpenGL ES

 private:
  Of of_ = Of::kFloats;
  std::size_t count_ = 0;
  Buffer buffer_;
  Staging staging_;
  Object<DestroyTexture> texture_;
};

}  // namespace pliant::gpu
