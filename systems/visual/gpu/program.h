// Shaders, compiled and linked.
#pragma once

#include <initializer_list>
#include <span>
#include <string>

#include "runtime/result.h"
#include "systems/visual/gpu/object.h"
#include "systems/visual/gpu/shader_source.h"

namespace pliant::gpu {

struct DestroyProgram {
  static void destroy(GLuint id) { glDeleteProgram(id); }
};

class Program {
 public:
  Program() = default;
  // From files of the shader folder, e.g. {"surface.vert", "surface.frag"}. The error has file and line.
  static Result<Program> load(std::initializer_list<const char*> names);
  static Result<Program> link(std::span<const ShaderSource> stages);
  void use() const { glUseProgram(object_.id()); }
  GLuint id() const { return object_.id(); }

 private:
  explicit Program(GLuint id) : object_(id) {}
  Object<DestroyProgram> object_;
};

}  // namespace pliant::gpu
