#include "editor/play/rendered.h"

#include <memory>

#include "content/level_file.h"
#include "editor/play/scene_view.h"
#include "systems/prepare_world.h"

namespace pliant {

Result<std::shared_ptr<World>> world_of(const Level& level) {
  auto spawned = spawn(level);
  if (!spawned) return spawned.error();
  auto world = std::make_shared<World>(std::move(spawned).value());
  if (const Status status = prepare_world(*world); !status) return status.error();
  return world;
}

Level level_to_play(const State& state, const std::filesystem::path& folder, const std::filesystem::path& file,
                    const Scripts& unsaved) {
  Level level = level_of(state);
  leave_out_scripts(level, unsaved, DriverKind::kNull);
  if (!file.empty())
    level.path = file;
  else if (!folder.empty())
    level.path = folder / "untitled.glb";
  return level;
}

bool Rendered::change_looks(const Editor& editor, Stage& stage) {
  const State& now = editor.state();
  if (!world_ || now.looks == of_.looks || now.materials().size() != of_.materials().size() ||
      !same_but_looks(now, of_))
    return false;
  for (std::size_t i = 0; i < now.materials().size(); ++i) {  // a relief changes the surface
    const Material &a = now.materials()[i], &b = of_.materials()[i];
    if (a.height_texture != b.height_texture || a.height_scale != b.height_scale) return false;
  }
  of_ = now;
  stage.show([it = world_, looks = now.looks] {
    it->materials = *looks;
    return std::make_unique<SceneView>(it);
  });
  return true;
}

void Rendered::update(Editor& editor, Stage& stage, bool shown) {
  if (!shown) {
    if (shows_) stage.show(nullptr);
    if (waits_) editor.jobs.cancel("rendered");
    shows_ = waits_ = false;
    world_.reset();
    made_ = seen_ = ~std::uint64_t{0};
    return;
  }
  const std::uint64_t revision = editor.document.revision();
  if (files_ != editor.files_read) {  // referenced files have changed
    files_ = editor.files_read;
    if (seen_ != ~std::uint64_t{0}) seen_ = made_ = revision + 1;
  }
  if (revision != seen_ && made_ == seen_ && !waits_ && change_looks(editor, stage)) made_ = seen_ = revision;
  if (revision != seen_) {
    changed_at_ = seen_ == ~std::uint64_t{0} ? -kPatience : editor.now;  // the first one at once
    seen_ = revision;
    waits_ = true;
  }
  if (made_ == revision || editor.now - changed_at_ < kPatience) return;
  made_ = revision;
  const State state = editor.state();
  const auto folder = editor.document.folder(), file = editor.document.file();
  editor.jobs.start("rendered", "Preparing the picture", [this, &stage, state, folder, file](const Jobs::Stop&) {
    auto world =
        std::make_shared<Result<std::shared_ptr<World>>>(world_of(level_to_play(state, folder, file, state.scripts)));
    return [this, &stage, world, state](Editor& to) {
      waits_ = false;
      if (!*world) {
        to.say("the picture of the level as it is played cannot be made: " + world->error().message(),
               Severity::kWarning);
        return;
      }
      shows_ = true;
      world_ = **world;
      of_ = state;
      stage.show([it = **world] { return std::make_unique<SceneView>(it); });
    };
  });
}

}  // namespace pliant
