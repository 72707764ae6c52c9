// Bytes on their way to the GPU: memory that both sides see all the time (GL_MAP_PERSISTENT), in three parts, so that
// the processor writes one while the GPU still copies out of the others. No call waits for the driver's own copies.
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
  // Sends bytes [offset, offset + size) to `target`, in several parts where one is too small. Returns `size`.
  std::size_t send(const Buffer& target, std::size_t offset, const void* data, std::size_t size);
  // Ends the part that was written: call once after everything that one picture needs.
  void finish();

 private:
  static constexpr std::size_t kParts = 3;
  Object<DestroyBuffer> buffer_;  // unmapped as it is deleted
  std::byte* mapped_ = nullptr;
  std::size_t part_size_ = 0, part_ = 0, used_ = 0;
  std::array<Fence, kParts> copied_;  // when the GPU has taken a part
};

}  // namespace pliant::gpu
