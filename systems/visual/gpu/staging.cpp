#include "systems/visual/gpu/staging.h"

#include <algorithm>
#include <cstring>

#include "systems/visual/gpu/desktop.h"

namespace pliant::gpu {

Staging::Staging(std::size_t part_size) : part_size_(part_size) {
  GLuint id = 0;
  glGenBuffers(1, &id);
  buffer_ = Object<DestroyBuffer>(id);
  glBindBuffer(GL_COPY_READ_BUFFER, id);
  mapped_ = desktop::map(id, kParts * part_size);
}

std::size_t Staging::send(const Buffer& target, std::size_t offset, const void* data, std::size_t size) {
  const std::byte* from = static_cast<const std::byte*>(data);
  glBindBuffer(GL_COPY_READ_BUFFER, buffer_.id());
  glBindBuffer(GL_COPY_WRITE_BUFFER, target.id());
  for (std::size_t done = 0; done < size;) {
    if (used_ == part_size_) finish();
    const std::size_t count = std::min(size - done, part_size_ - used_), place = part_ * part_size_ + used_;
    std::memcpy(mapped_ + place, from + done, count);
    glCopyBufferSubData(GL_COPY_READ_BUFFER, GL_COPY_WRITE_BUFFER, static_cast<GLintptr>(place),
                        static_cast<GLintptr>(offset + done), static_cast<GLsizeiptr>(count));
    used_ += count;
    done += count;
  }
  return size;
}

void Staging::finish() {
  if (used_ == 0) return;
  copied_[part_] = Fence::here();
  part_ = (part_ + 1) % kParts;
  used_ = 0;
  // From two pictures ago: almost always completed.
  if (copied_[part_].set()) copied_[part_].wait();
}

}  // namespace pliant::gpu
