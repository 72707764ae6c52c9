#include "lab/files/content_folder.h"

#include <algorithm>
#include <cstdlib>

#include "content/keys/extension_table.h"
#include "content/level_file.h"

namespace pliant {
namespace fs = std::filesystem;
namespace {
constexpr const char* kDemoLevel = "three_probes";
}

fs::path data_folder() {
  std::error_code no;
  const fs::path self = fs::read_symlink("/proc/self/exe", no);
  return self.parent_path().parent_path() / "share" / "pliant";
}

fs::path content_folder() {
  if (const char* folder = std::getenv("PLIANT_CONTENT"); folder && *folder) return folder;
  std::error_code no;
  return fs::weakly_canonical(data_folder() / "content", no);  // in a build tree this is a link to the sources
}

std::vector<fs::path> shipped_levels() {
  std::vector<fs::path> levels;
  std::error_code no;
  for (const fs::directory_entry& entry : fs::directory_iterator(content_folder() / "levels", no))
    if (entry.path().extension() == ".gltf" || entry.path().extension() == ".glb") levels.push_back(entry.path());
  std::sort(levels.begin(), levels.end());
  return levels;
}

Result<fs::path> find_level(const std::string& argument) {
  std::error_code no;
  if (fs::is_regular_file(argument, no)) return fs::path(argument);
  if (fs::is_directory(argument, no)) return Error{argument, "is a folder", "give the file in it"};
  if (fs::exists(argument, no)) return Error{argument, "is no regular file", "save it as one first"};
  const std::string name = argument.empty() ? kDemoLevel : argument;
  if (name.find('/') == std::string::npos) {
    const fs::path levels = content_folder() / "levels";
    for (const char* extension : {".gltf", ".glb"})
      if (const fs::path file = levels / (name + extension); fs::is_regular_file(file, no)) return file;
    if (argument.empty())
      return Error{levels.string(), "the demo level is not there",
                   "set PLIANT_CONTENT to the folder that holds levels/"};
  }
  std::vector<std::string> names;
  for (const fs::path& level : shipped_levels()) names.push_back(level.stem().string());
  const std::string near = name.find('/') == std::string::npos ? suggestion(fs::path(name).stem().string(), names) : "";
  return Error{argument, "there is no such file and no shipped level of that name",
               near.empty() ? "check the path, or see `pliant run --list`" : near, "file.missing"};
}

Result<World> world_of_level(const std::string& argument) {
  const auto file = find_level(argument);
  if (!file) return file.error();
  const auto level = load_level(*file);
  if (!level) return level.error();
  return spawn(*level);
}

}  // namespace pliant
