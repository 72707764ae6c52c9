// Upload buffer: memory mapped for CPU and GPU (GL_MAP_PERSISTENT), in three parts. The CPU writes one part while the
// GPU still copies from the others. No call waits for the driver's copies.
#pragma once

#include <array>
#include <cstddef>

#include "systems/visual/gpu/buffer.h"
#include "systems/visual/gpu/fence.h"

namespace pliant::gpu {

class Staging {
 public:
  Staging() = default;
  explicit Staging(std::size_t part_size);  // [bytes]
  // Sends bytes [offset, offset + size) to `target`, in several pieces if larger than a part. Returns `size`.
  std::size_t send(const Buffer& target, std::size_t offset, const void* data, std::size_t size);
  // Ends the current part: call once after all uploads of a picture.
  void finish();

 private:
  static constexpr std::size_t kParts = 3;
  Object<DestroyBuffer> buffer_;  // unmapped as it is deleted
  std::byte* mapped_ = nullptr;
  std::size_t part_size_ = 0, part_ = 0, used_ = 0;
  std::array<Fence, kParts> copied_;  // signalled when the GPU has copied a part
};

}  // namespace pliant::gpu
