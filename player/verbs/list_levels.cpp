// pliant run --list: the shipped levels with their descriptions.

#include <algorithm>

#include "content/level_file.h"
#include "lab/console/exit.h"
#include "lab/console/print.h"
#include "lab/files/content_folder.h"
#include "player/verbs/verbs.h"

namespace pliant {

int list_levels() {
  const std::vector<std::filesystem::path> levels = shipped_levels();
  if (levels.empty())
    return fail(kFailed, {(content_folder() / "levels").string(), "there are no levels",
                          "set PLIANT_CONTENT to the folder that holds levels/"});
  std::size_t longest = 0;
  for (const std::filesystem::path& level : levels) longest = std::max(longest, level.stem().string().size());
  for (const std::filesystem::path& level : levels) {
    const Result<std::string> about = read_about(level);
    if (!about) return fail(kFailed, about.error());
    print("{:<{}}  {}\n", level.stem().string(), longest, about->substr(0, about->find('\n')));
  }
  return kDone;
}

}  // namespace pliant
