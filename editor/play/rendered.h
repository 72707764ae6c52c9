// "Rendered" mode while editing: builds a world from the document in the background, again after changes; the previous
// picture is shown meanwhile.
#pragma once

#include "editor/core/editor.h"
#include "editor/viewport/stage.h"

namespace pliant {

class Rendered {
 public:
  static constexpr double kPatience = 0.3;  // [s] without a change, before it is rebuilt
  // Once per frame. `shown`: the mode is active.
  void update(Editor& editor, Stage& stage, bool shown);
  // The stage shows something else now.
  void forget() { shows_ = false, world_.reset(); }
  bool waits() const { return waits_; }  // a change is not shown yet

 private:
  // Only materials have changed: the world stays, and is drawn with them.
  bool change_looks(const Editor& editor, Stage& stage);

  bool shows_ = false, waits_ = false;
  std::shared_ptr<World> world_;                                       // shown; belongs to the stage's thread
  State of_;                                                           // that it was made from
  std::uint64_t made_ = ~std::uint64_t{0}, seen_ = ~std::uint64_t{0};  // revisions: in progress or shown; last changed
  std::uint64_t files_ = 0;                                            // Editor::files_read at building
  double changed_at_ = 0.0;
};

// A world for display only, prepared as for playing.
Result<std::shared_ptr<World>> world_of(const Level& level);
// The level with the path of its file, for referenced files.
Level level_to_play(const State& state, const std::filesystem::path& folder, const std::filesystem::path& file,
                    const Scripts& unsaved);

}  // namespace pliant
