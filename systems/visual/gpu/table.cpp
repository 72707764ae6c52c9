#include "systems/visual/gpu/table.h"

#include <algorithm>

#include "runtime/assert.h"
#include "systems/visual/gpu/desktop.h"

namespace pliant::gpu {

Table::Table(Of of, const void* records, std::size_t count, std::size_t staged) : of_(of), count_(count) {
  if (!is_es()) {
    buffer_ = Buffer::writable(records, bytes());
    if (staged > 0) staging_ = Staging(staged * kRecord);
    return;
  }
  const std::size_t rows = std::max<std::size_t>(1, (count + kRow - 1) / kRow);
  texture_ = make_plane(of == Of::kFloats ? GL_RGBA32F : GL_RGBA32UI, kRow, static_cast<int>(rows));
  if (records) write(0, records, count);
}

std::size_t Table::write(std::size_t first, const void* records, std::size_t count) {
  ASSERT(first + count <= count_);
  if (!texture_.id()) return staging_.send(buffer_, first * kRecord, records, count * kRecord);
  bind_texture(kScratchUnit, GL_TEXTURE_2D, texture_.id());
  const auto* from = static_cast<const std::byte*>(records);
  for (std::size_t done = 0; done < count;) {  // whole rows at once; what begins or ends within a row by itself
    const std::size_t x = (first + done) % kRow, y = (first + done) / kRow, left = count - done;
    const std::size_t rows = x == 0 && left >= kRow ? left / kRow : 1, wide = std::min(kRow - x, left);
    glTexSubImage2D(GL_TEXTURE_2D, 0, static_cast<GLint>(x), static_cast<GLint>(y), static_cast<GLsizei>(wide),
                    static_cast<GLsizei>(rows), of_ == Of::kFloats ? GL_RGBA : GL_RGBA_INTEGER,
                    of_ == Of::kFloats ? GL_FLOAT : GL_UNSIGNED_INT, from + done * kRecord);
    done += wide * rows;
  }
  return count * kRecord;
}

void Table::bind(GLuint binding, GLuint unit) const {
  if (texture_.id())
    bind_texture(unit, GL_TEXTURE_2D, texture_.id());
  else
    desktop::bind_storage(binding, buffer_.id());
}

std::size_t Table::most_bytes() {
  if (!is_es()) return desktop::largest_storage();
  GLint rows = 0;
  glGetIntegerv(GL_MAX_TEXTURE_SIZE, &rows);
  return static_cast<std::size_t>(rows) * kRow * kRecord;
}

}  // namespace pliant::gpu
