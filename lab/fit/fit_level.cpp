#include "lab/fit/fit_level.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

#include "content/keys/extension_table.h"
#include "content/level/unit.h"
#include "content/level_file.h"
#include "lab/console/exit.h"
#include "lab/files/content_folder.h"
#include "lab/files/left_behind.h"

namespace pliant {
namespace fs = std::filesystem;

Result<Level> level_to_fit(const std::string& name, std::optional<double> unit) {
  if (name.empty()) return Error{"fit", "say into which level, as the first word or with --level"};
  const Result<fs::path> file = find_level(name);
  if (!file) return file.error();
  Result<Level> level = load_level(*file);
  if (!level) return level;
  if (const Status bare = check_unit(*level, unit); !bare) return bare.error();
  scale_roots(*level, unit.value_or(1.0));
  for (const std::string& sentence : level->notes) note(sentence);
  return level;
}

Result<std::int32_t> object_to_fit(const Level& level, const std::string& name) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& node = level.nodes[i];
    if (node.mesh < 0 || !node.in_scene) continue;
    if (node.name == name) return static_cast<std::int32_t>(i);
    names.push_back(node.name);
  }
  if (names.empty()) return Error{level.path.string(), "has no node with a mesh", "a fit is of a surface"};
  const std::string where = "--object" + (name.empty() ? "" : " " + name);
  if (name.empty()) {
    if (names.size() == 1) return object_to_fit(level, names[0]);
    constexpr std::size_t kNamed = 8;
    const std::size_t count = names.size();
    names.resize(std::min(count, kNamed));
    return Error{where, fmt::format("is not said, and the level has {} nodes with a mesh", count),
                 fmt::format("name one of {}{}", fmt::join(names, ", "), count > kNamed ? " and others" : "")};
  }
  return error_at(where, unknown("node", name, "", "nodes with a mesh", names));
}

Status check_out(const FitOptions& options) {
  if (options.out.empty()) return Done{};
  std::string extension = fs::path(options.out).extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  if (extension != ".glb" && extension != ".gltf")
    return Error{options.out, "a level is glTF", "end the name with .glb or .gltf"};
  std::error_code ignored;
  if (!options.force && fs::exists(fs::symlink_status(options.out, ignored)))
    return Error{options.out, "is there already", "name another, or replace it with --force"};
  return Done{};
}

Status save_fitted(const Level& level, const FitOptions& options) {
  const Existing existing = options.force ? Existing::kReplace : Existing::kRefuse;
  if (Status saved = save_level(level, options.out, {0, false, existing}); !saved) return saved;
  say_left_behind(level, options.out);
  return Done{};
}

}  // namespace pliant
