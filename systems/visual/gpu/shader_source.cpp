#include "systems/visual/gpu/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>
#include <string_view>

#include "components/built_in.h"
#include "systems/visual/gpu/embedded_shaders.h"

namespace pliant::gpu {
namespace {

// The functions of law.glsl that choose among the laws.
std::string law_list() {
  std::string out;
  for (const auto& [type, head, call] :
       {std::array{"float", "law_force(float h)", "force(h, "},
        {"float", "law_slope(float h)", "slope(h, "},
        {"float", "law_keep(float h0)", "keep(h0, "},
        {"LawAt", "law_between(float h0, float d, float kept)", "between(h0, d, kept, "}}) {
    out += fmt::format("{} {} {{\n", type, head);
    int number = 0;
#define PLIANT_LAW(word, of, ...) \
  out += fmt::format("  if (law == {}u) return {}_{}law_constants());\n", number++, #of, call);
    PLIANT_SPRING_LAWS(PLIANT_LAW)
#undef PLIANT_LAW
    out += fmt::format("  return linear_{}law_constants());\n}}\n", call);
  }
  return out;
}

// field_of_shape of shared/field.glsl.
std::string shape_list() {
  std::string out =
      "vec4 field_of_shape(int shape, vec3 d, vec3 N, vec3 M, float inv_reach2, float amplitude, float parameter) {\n"
      "  float u = min(dot(d, d) * inv_reach2, 1.0);\n";
  constexpr const char* kRadial = "field_radial(d, N, M, inv_reach2, amplitude, shape_{}(u, parameter))";
  constexpr const char* kWhole = "field_{}(d, N, M, inv_reach2, amplitude, parameter)";
  int number = 0;
  const auto add = [&](const char* word, std::string_view form) {
    const std::string target = fmt::format(fmt::runtime(form == "radial" ? kRadial : kWhole), word);
    out += fmt::format("  if (shape == {}) return {};\n", number++, target);
  };
#define PLIANT_SHAPE(word, form, ...) add(#word, #form);
  PLIANT_SHAPES(PLIANT_SHAPE)
#undef PLIANT_SHAPE
  return out + "  return vec4(0);\n}\n";
}

constexpr std::string_view kEsHead = R"(#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp samplerCube;
precision highp sampler2DShadow;
precision highp usampler2D;
#define PLIANT_ES
)";

std::optional<std::string> read_text(const std::string& name) {
  if (name == "law_list.glsl") return law_list();
  if (name == "shape_list.glsl") return shape_list();
  if (const std::filesystem::path folder = shader_folder(); !folder.empty()) {
    std::ifstream file(folder / name, std::ios::binary);
    if (!file) return std::nullopt;
    return std::string(std::istreambuf_iterator<char>(file), {});
  }
  for (const EmbeddedShader* shader = kEmbeddedShaders; shader->name; ++shader)
    if (name == shader->name) return shader->text;
  return std::nullopt;
}

// Where shaders are searched.
std::string place() {
  const std::filesystem::path folder = shader_folder();
  return folder.empty() ? "among those that are compiled in" : "in '" + folder.string() + "'";
}

// The x.glsl of a line `#include "x.glsl"`, or nothing.
std::optional<std::string> included_by(std::string_view line) {
  constexpr std::string_view kInclude = "#include";
  line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
  if (line.substr(0, kInclude.size()) != kInclude) return std::nullopt;
  const std::size_t open = line.find('"'), close = line.rfind('"');
  if (open == close) return std::nullopt;
  return std::string(line.substr(open + 1, close - open - 1));
}

// Appends `text` as file number files.size(), depth first. A file already included is skipped, which also ends cycles.
Status append(ShaderSource& source, const std::string& name, const std::string& text) {
  const std::size_t number = source.files.size();
  source.files.push_back(name);
  source.text += fmt::format("#line 1 {}\n", number);
  std::istringstream lines(text);
  std::string line;
  for (int n = 1; std::getline(lines, line); ++n) {
    const std::optional<std::string> wanted = included_by(line);
    if (!wanted) {
      source.text += line + '\n';
      continue;
    }
    if (std::find(source.files.begin(), source.files.end(), *wanted) == source.files.end()) {
      const std::optional<std::string> included = read_text(*wanted);
      if (!included)
        return Error{fmt::format("{}:{}", name, n), fmt::format("there is no shader file '{}' {}", *wanted, place()),
                     "correct the include, or set PLIANT_SHADERS"};
      if (Status done = append(source, *wanted, *included); !done) return done;
    }
    source.text += fmt::format("#line {} {}\n", n + 1, number);
  }
  return Done{};
}

}  // namespace

std::filesystem::path shader_folder() {
  const char* const chosen = std::getenv("PLIANT_SHADERS");
  return chosen ? chosen : "";
}

Result<ShaderSource> load_shader(const std::string& name) {
  const std::optional<std::string> text = read_text(name);
  if (!text)
    return Error{name, "there is no such shader " + place(), "unset PLIANT_SHADERS, or set it to their folder"};
  return expand_shader(name, *text);
}

Result<ShaderSource> expand_shader(const std::string& name, const std::string& text) {
  ShaderSource source{.name = name, .text = "#version 450 core\n", .files = {}};
  if (Status done = append(source, name, text); !done) return done.error();
  return source;
}

// Every binding in shaders/ stands in one line: layout(std140, binding = 2) uniform NAME { or
// layout(binding = 3) uniform sampler2D NAME;
ShaderSource to_es(ShaderSource source, std::vector<ShaderBinding>& bindings) {
  constexpr const char* kBlock = " layout(std140, binding = %d) uniform %63[A-Za-z0-9_]";
  constexpr const char* kSampler = " layout(binding = %d) uniform %*s %63[A-Za-z0-9_]";
  std::istringstream lines(source.text);
  std::string line, text(kEsHead);
  std::getline(lines, line);  // the version
  for (; std::getline(lines, line); text += line + '\n') {
    int number = 0;
    char name[64];
    const bool block = std::sscanf(line.c_str(), kBlock, &number, name) == 2;
    if (!block && std::sscanf(line.c_str(), kSampler, &number, name) != 2) continue;
    bindings.push_back({name, block, number});
    line = (block ? "layout(std140) " : "") + line.substr(line.find("uniform"));
  }
  source.text = std::move(text);
  return source;
}

std::string explain_log(const ShaderSource& source, const std::string& log) {
  std::istringstream lines(log);
  std::string line, explained;
  while (std::getline(lines, line)) {
    int number = 0, at = 0, read = 0;
    const bool mesa = std::sscanf(line.c_str(), "%d:%d(%*d): %n", &number, &at, &read) == 2 && read > 0;
    const bool placed = mesa || (std::sscanf(line.c_str(), "%d(%d) : %n", &number, &at, &read) == 2 && read > 0);
    if (placed && number >= 0 && static_cast<std::size_t>(number) < source.files.size())
      line = fmt::format("{}:{}: {}", source.files[static_cast<std::size_t>(number)], at, line.substr(read));
    if (!line.empty()) explained += (explained.empty() ? "" : "\n") + line;
  }
  return explained;
}

}  // namespace pliant::gpu
