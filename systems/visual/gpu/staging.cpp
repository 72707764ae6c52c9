#include "systems/visual/gpu/staging.h"

#include <algorithm>
#include <cstring>

namespace pliant::gpu {

Staging::Staging(std::size_t part_size) : part_size_(part_size) {
  GLuint id = 0;
  glCreateBuffers(1, &id);
  buffer_ = Object<DestroyBuffer>(id);
  const GLbitfield flags = GL_MAP_WRITE_BIT | GL_MAP_PERSISTENT_BIT | GL_MAP_COHERENT_BIT;
  const auto size = static_cast<GLsizeiptr>(kParts * part_size);
  glNamedBufferStorage(id, size, nullptr, flags | GL_CLIENT_STORAGE_BIT);
  mapped_ = static_cast<std::byte*>(glMapNamedBufferRange(id, 0, size, flags));
}

std::size_t Staging::send(const Buffer& target, std::size_t offset, const void* data, std::size_t size) {
  const std::byte* from = static_cast<const std::byte*>(data);
  for (std::size_t done = 0; done < size;) {
    if (used_ == part_size_) finish();
    const std::size_t count = std::min(size - done, part_size_ - used_), place = part_ * part_size_ + used_;
    std::memcpy(mapped_ + place, from + done, count);
    glCopyNamedBufferSubData(buffer_.id(), target.id(), static_cast<GLintptr>(place),
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
