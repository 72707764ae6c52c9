// An OpenGL context without a window: EGL on a device with a GPU if there is one, else surfaceless.
#pragma once

#include <memory>
#include <string>

#include "runtime/result.h"

namespace pliant {

enum class GraphicsApi { kCore45, kEs30 };
// OpenGL 4.5 core, unless the environment variable PLIANT_GLES is set.
GraphicsApi chosen_api();

class HeadlessContext {
 public:
  // Made current on the calling thread. The error names the missing part and the package that provides it.
  static Result<std::unique_ptr<HeadlessContext>> create(GraphicsApi api = chosen_api());
  ~HeadlessContext();
  // For programs with several contexts: OpenGL calls of this thread go to this one from now on.
  void make_current();
  const std::string& renderer_name() const { return renderer_name_; }

 private:
  HeadlessContext() = default;
  void* display_ = nullptr;
  void* context_ = nullptr;
  std::string renderer_name_;
};

}  // namespace pliant
