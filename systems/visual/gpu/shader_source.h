// A shader's text as the GPU gets it: the version line, then the file with every `#include "x.glsl"` put in its place
// (once per shader), and a way back from the compiler's line numbers to files.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "runtime/result.h"

namespace pliant::gpu {

struct ShaderSource {
  std::string name;                // "surface.vert": its ending says the stage
  std::string text;                // for glShaderSource
  std::vector<std::string> files;  // the number in a #line directive -> file
};

// $PLIANT_SHADERS, to try other shaders than those that are compiled in; empty: it is not set.
std::filesystem::path shader_folder();

// `name` from the shader folder where there is one, else as it was compiled in.
Result<ShaderSource> load_shader(const std::string& name);
// The same for text of one's own; its includes are found as load_shader finds them.
Result<ShaderSource> expand_shader(const std::string& name, const std::string& text);

// "3:12(5): error: ..." (Mesa) and "3(12) : error ..." (NVIDIA) become "light.glsl:12: error: ...".
std::string explain_log(const ShaderSource& source, const std::string& log);

}  // namespace pliant::gpu
