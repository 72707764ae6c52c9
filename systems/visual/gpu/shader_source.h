// A shader's text for the GPU: the version line, then the file with every `#include "x.glsl"` expanded (once per
// shader). It maps the compiler's line numbers back to files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant::gpu {

struct ShaderSource {
  std::string name;                // "surface.vert": the extension gives the stage
  std::string text;                // for glShaderSource
  std::vector<std::string> files;  // the number in a #line directive -> file
};

// $PLIANT_SHADERS, a folder of replacement shaders; empty if it is not set.
std::filesystem::path shader_folder();

// `name` from the shader folder if there is one, else the embedded file. law_list.glsl and shape_list.glsl are made
// from the lists of components/built_in.h.
Result<ShaderSource> load_shader(const std::string& name);
// The same for given text; includes are found as by load_shader.
Result<ShaderSource> expand_shader(const std::string& name, const std::string& text);

// A binding that the program must set, because GLSL ES 3.00 cannot state it.
struct ShaderBinding {
  std::string name;
  bool block = false;  // of uniforms; else a sampler
  int number = 0;      // binding point, or texture unit
};
// The same shader in GLSL ES 3.00, for OpenGL ES 3.0 and WebGL 2: version and precisions, PLIANT_ES defined, bindings
// moved to `bindings`.
ShaderSource to_es(ShaderSource source, std::vector<ShaderBinding>& bindings);

// "3:12(5): error: ..." (Mesa) and "3(12) : error ..." (NVIDIA) become "light.glsl:12: error: ...".
std::string explain_log(const ShaderSource& source, const std::string& log);

}  // namespace pliant::gpu
