#include <utility>

#include "content/files/exr.h"
#include "content/level/spawn_relief.h"
#include "content/level_file.h"

namespace pliant {

Result<World> spawn(const Level& level, std::vector<std::string>* notes) {
  Panorama panorama;
  if (level.environment && !level.environment->panorama.empty()) {
    Result<Panorama> read = load_named_panorama(level.path.parent_path(), level.environment->panorama, notes);
    if (!read) return read.error();
    panorama = std::move(*read);
  }
  Result<World> world = spawn_level(level, notes);
  if (world) world->environment.panorama = std::move(panorama);
  return world;
}

Result<World> spawn_moving_images(Level& level, std::vector<std::string>* notes) {
  std::vector<Image> images = std::exchange(level.images, {});
  Result<World> world = spawn(level, notes);
  if (!world) return world;
  world->images = std::move(images);
  add_relief(*world, notes);
  return world;
}

}  // namespace pliant
