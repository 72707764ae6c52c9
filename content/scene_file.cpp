// Level files as scenes (pliant/content.h).
#include "content/level_file.h"
#include "content/safety_cap.h"
#include "pliant/content.h"
#include "runtime/long_work.h"

namespace pliant {

namespace {

Result<Level> load_watched(const std::filesystem::path& file, const OpenProgress& progress) {
  const WatchedWork watch(progress);
  try {
    check_in("reading `" + file.filename().string() + "`");
    return load_level(file);
  } catch (const WorkStopped&) {
    return Error{file.string(), "its reading was stopped", "nothing is wrong with it"};
  }
}

}  // namespace

Result<Scene> load_scene(const std::filesystem::path& file, std::vector<std::string>* notes, const SafetyCap& cap,
                         const OpenProgress& progress) {
  auto level = load_watched(file, progress);
  if (!level) return level.error();
  if (!level->has_pliant()) make_touchable(*level);
  for (std::string& note : cap_safety(*level, cap)) level->notes.push_back(std::move(note));
  if (notes) *notes = level->notes;
  return Scene(*level);
}

Status save_scene(const Scene& scene, const std::filesystem::path& file) {
  return save_level(scene.level(), file);
}

Status set_key(Scene& scene, const std::string& assignment) {
  return set_key(scene.level(), assignment);
}

}  // namespace pliant
