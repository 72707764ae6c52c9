// Drawn by the path tool beside its keys: the effector at each of them, and bodies where they rest.
#pragma once

#include <memory>
#include <vector>

#include "editor/core/path_editing.h"
#include "editor/tools/tools.h"

namespace pliant {

// The probe or tool as it is at each key: edges of its mesh, or its tip.
void draw_ghosts(const Editor& editor, const ScriptKeys& keys, std::vector<ViewLine>& lines);

// Bodies that rest elsewhere than they are drawn: keys are set on them where they rest.
class RestingBodies {
 public:
  struct Sagging {
    std::shared_ptr<const PaintSurface> surface;
    dvec3 origin{0};  // [m] world
  };

  // Says once of each body where it rests.
  void find(Editor& editor);
  void draw(std::vector<ViewLine>& lines) const;

 private:
  std::vector<Sagging> sagging_;
  std::vector<std::shared_ptr<const PaintSurface>> said_;  // of which it was said
};

}  // namespace pliant
