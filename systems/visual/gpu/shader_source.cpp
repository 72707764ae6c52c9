#include "systems/visual/gpu/shader_source.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <optional>
#include <regex>
#include <sstream>

namespace pliant::gpu {
namespace {

std::optional<std::string> read_text(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  return std::string(std::istreambuf_iterator<char>(file), {});
}

// Appends `text` as file number files.size(), depth first. A file that is already in is skipped, which also ends cycles.
Status append(ShaderSource& source, const std::string& name, const std::string& text) {
  static const std::regex include_line(R"(^\s*#\s*include\s+"([^"]+)\"\s*$)");
  const std::size_t number = source.files.size();
  source.files.push_back(name);
  source.text += fmt::format("#line 1 {}\n", number);
  std::istringstream lines(text);
  std::string line;
  for (int n = 1; std::getline(lines, line); ++n) {
    std::smatch match;
    if (!std::regex_match(line, match, include_line)) {
      source.text += line + '\n';
      continue;
    }
    const std::string wanted = match[1];
    if (std::find(source.files.begin(), source.files.end(), wanted) == source.files.end()) {
      const std::optional<std::string> included = read_text(shader_folder() / wanted);
      if (!included)
        return Error{fmt::format("{}:{}", name, n), fmt::format("there is no shader file '{}' in '{}'; correct the "
                                                                "include, or set PLIANT_SHADERS",
                                                                wanted, shader_folder().string())};
      if (Status done = append(source, wanted, *included); !done) return done;
    }
    source.text += fmt::format("#line {} {}\n", n + 1, number);
  }
  return Done{};
}

}  // namespace

std::filesystem::path shader_folder() {
  if (const char* chosen = std::getenv("PLIANT_SHADERS")) return chosen;
  std::error_code ignored;
  if (std::filesystem::is_directory(PLIANT_SHADER_DIR, ignored)) return PLIANT_SHADER_DIR;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  return program.parent_path().parent_path() / "share/pliant/shaders";
}

Result<ShaderSource> load_shader(const std::string& name) {
  const std::filesystem::path path = shader_folder() / name;
  const std::optional<std::string> text = read_text(path);
  if (!text) return Error{path.string(), "cannot read this shader; reinstall, or set PLIANT_SHADERS to the folder"};
  return expand_shader(name, *text);
}

Result<ShaderSource> expand_shader(const std::string& name, const std::string& text) {
  ShaderSource source{.name = name, .text = "#version 450 core\n", .files = {}};
  if (Status done = append(source, name, text); !done) return done.error();
  return source;
}

std::string explain_log(const ShaderSource& source, const std::string& log) {
  static const std::regex place(R"(^(\d+)(?::(\d+)\(\d+\)|\((\d+)\))\s*:?\s*)");
  std::istringstream lines(log);
  std::string line, explained;
  while (std::getline(lines, line)) {
    std::smatch match;
    if (std::regex_search(line, match, place)) {
      const std::size_t number = static_cast<std::size_t>(std::atoi(match[1].str().c_str()));
      const std::string file = number < source.files.size() ? source.files[number] : source.name;
      const std::string at = match[2].matched ? match[2].str() : match[3].str();
      line = fmt::format("{}:{}: {}", file, at, match.suffix().str());
    }
    if (!line.empty()) explained += (explained.empty() ? "" : "\n") + line;
  }
  return explained;
}

}  // namespace pliant::gpu
