// Owner of one OpenGL name: move-only, deletes it on destruction. Its context must then be current.
#pragma once

#include <utility>

#include "systems/visual/gpu/gl_api.h"

namespace pliant::gpu {

// `Destroy` deletes the name: a struct with `static void destroy(GLuint)`.
template <class Destroy>
class Object {
 public:
  Object() = default;
  explicit Object(GLuint id) : id_(id) {}
  Object(Object&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
  Object& operator=(Object&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Object() {
    if (id_) Destroy::destroy(id_);
  }
  GLuint id() const { return id_; }

 private:
  GLuint id_ = 0;
};

}  // namespace pliant::gpu
