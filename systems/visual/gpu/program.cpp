#include "systems/visual/gpu/program.h"

#include <fmt/format.h>

#include <filesystem>
#include <vector>

namespace pliant::gpu {
namespace {

struct DestroyShader {
  static void destroy(GLuint id) { glDeleteShader(id); }
};
using Shader = Object<DestroyShader>;
constexpr GLenum kComputeShader = 0x91B9;  // GL_COMPUTE_SHADER, which headers of OpenGL ES 3.0 lack

GLenum stage_of(const std::string& name) {
  const std::string ending = std::filesystem::path(name).extension().string();
  if (ending == ".vert") return GL_VERTEX_SHADER;
  if (ending == ".frag") return GL_FRAGMENT_SHADER;
  if (ending == ".comp") return kComputeShader;
  return GL_NONE;
}

Result<Shader> compile(const ShaderSource& source) {
  const GLenum stage = stage_of(source.name);
  if (stage == GL_NONE) return Error{source.name, "a shader's name must end in .vert, .frag or .comp", "rename it"};
  Shader shader(glCreateShader(stage));
  const char* text = source.text.c_str();
  glShaderSource(shader.id(), 1, &text, nullptr);
  glCompileShader(shader.id());
  GLint compiled = 0, length = 0;
  glGetShaderiv(shader.id(), GL_COMPILE_STATUS, &compiled);
  if (compiled) return shader;
  glGetShaderiv(shader.id(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetShaderInfoLog(shader.id(), length, &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return Error{source.name, fmt::format("does not compile:\n{}", explain_log(source, log))};
}

void set_bindings(GLuint program, const std::vector<ShaderBinding>& bindings) {
  if (!bindings.empty()) glUseProgram(program);
  for (const ShaderBinding& binding : bindings) {
    if (!binding.block) {
      glUniform1i(glGetUniformLocation(program, binding.name.c_str()), binding.number);
    } else if (const GLuint block = glGetUniformBlockIndex(program, binding.name.c_str()); block != GL_INVALID_INDEX) {
      glUniformBlockBinding(program, block, static_cast<GLuint>(binding.number));
    }
  }
}

}  // namespace

Result<Program> Program::load(std::initializer_list<const char*> names) {
  std::vector<ShaderSource> stages;
  for (const char* name : names) {
    Result<ShaderSource> source = load_shader(name);
    if (!source) return source.error();
    stages.push_back(*std::move(source));
  }
  return link(stages);
}

Result<Program> Program::link(std::span<const ShaderSource> stages) {
  std::vector<Shader> shaders;
  std::vector<ShaderBinding> bindings;
  std::string names;
  for (const ShaderSource& source : stages) {
    Result<Shader> shader = compile(is_es() ? to_es(source, bindings) : source);
    if (!shader) return shader.error();
    shaders.push_back(*std::move(shader));
    names += (names.empty() ? "" : " + ") + source.name;
  }
  Program program(glCreateProgram());
  for (const Shader& shader : shaders) glAttachShader(program.id(), shader.id());
  glLinkProgram(program.id());
  for (const Shader& shader : shaders) glDetachShader(program.id(), shader.id());
  GLint linked = 0, length = 0;
  glGetProgramiv(program.id(), GL_LINK_STATUS, &linked);
  if (linked) {
    set_bindings(program.id(), bindings);
    return program;
  }
  glGetProgramiv(program.id(), GL_INFO_LOG_LENGTH, &length);
  std::string log(static_cast<std::size_t>(length), '\0');
  glGetProgramInfoLog(program.id(), length, &length, log.data());
  log.resize(static_cast<std::size_t>(length));
  return Error{names, fmt::format("do not link:\n{}", log)};
}

}  // namespace pliant::gpu
