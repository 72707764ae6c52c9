// A point in the GPU's command stream; can be queried or waited for.
#pragma once

#include <utility>

#include "systems/visual/gpu/gl_api.h"

namespace pliant::gpu {

class Fence {
 public:
  Fence() = default;
  // After all commands issued so far.
  static Fence here() {
    Fence fence;
    fence.sync_ = glFenceSync(GL_SYNC_GPU_COMMANDS_COMPLETE, 0);
    return fence;
  }
  Fence(Fence&& other) noexcept : sync_(std::exchange(other.sync_, nullptr)) {}
  Fence& operator=(Fence&& other) noexcept {
    std::swap(sync_, other.sync_);
    return *this;
  }
  ~Fence() {
    if (sync_) glDeleteSync(sync_);
  }

  bool set() const { return sync_ != nullptr; }
  bool passed() const { return reached(0); }
  bool wait() const { return reached(GL_TIMEOUT_IGNORED); }  // not in WebGL

 private:
  bool reached(GLuint64 timeout_ns) const {
    const GLenum now = glClientWaitSync(sync_, GL_SYNC_FLUSH_COMMANDS_BIT, timeout_ns);
    return now == GL_ALREADY_SIGNALED || now == GL_CONDITION_SATISFIED;
  }
  GLsync sync_ = nullptr;
};

}  // namespace pliant::gpu
