#include "lab/files/left_behind.h"

#include <set>
#include <string>

#include "content/files/file_io.h"
#include "lab/console/exit.h"

namespace pliant {

void say_left_behind(const Level& level, const std::filesystem::path& out) {
  std::set<std::string> names;
  if (level.environment) names.insert(level.environment->panorama);
  for (const LevelNode& node : level.nodes) {
    if (node.device && node.device->driver == DriverKind::kScript) names.insert(node.device->file);
    if (node.effect) names.insert(node.effect->path);
    if (node.motion) names.insert(node.motion->script);
    if (node.soft_body) names.insert(node.soft_body->mesh);
  }
  names.erase("");
  std::string missing;
  std::error_code ignored;
  for (const std::string& name : names) {
    const Result<std::filesystem::path> file =
        confined_path(out.parent_path(), name);  // otherwise a panorama that all levels share
    if (!std::filesystem::exists(file ? *file : out.parent_path() / name, ignored))
      missing += (missing.empty() ? "`" : ", `") + name + "`";
  }
  if (!missing.empty())
    note("the level names files that are not beside " + out.string() + ": " + missing + "; copy them there");
}

}  // namespace pliant
