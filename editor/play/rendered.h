// "Rendered" while the level is edited: a world made of the document in the background, again when it has changed; the
// picture before stays meanwhile.
#pragma once

#include "editor/app/editor.h"
#include "editor/viewport/stage.h"

namespace pliant {

class Rendered {
 public:
  static constexpr double kPatience = 0.3;  // [s] without a change, before it is made anew
  // Once a frame. `shown`: it is to be seen.
  void update(Editor& editor, Stage& stage, bool shown);
  // Something else has taken its place on the stage.
  void forget() { shows_ = false; }
  bool waits() const { return waits_; }  // a change has not been answered yet

 private:
  bool shows_ = false, waits_ = false;
  std::uint64_t made_ = ~std::uint64_t{0}, seen_ = ~std::uint64_t{0};  // revisions: under way or shown; changed last
  std::uint64_t files_ = 0;                                            // Editor::files_read that it was made with
  double changed_at_ = 0.0;
};

// A world to look at, prepared as for playing.
Result<std::shared_ptr<World>> world_of(const Level& level);
// The level with the place of its file, from which it names others.
Level level_to_play(const State& state, const std::filesystem::path& folder, const std::filesystem::path& file,
                    const Scripts& unsaved);

}  // namespace pliant
