// Crease edges of a level's meshes, as used for touch, for the viewport: computed in the background.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "editor/core/editor.h"

namespace pliant {

class CreaseLines {
 public:
  using Ends = std::shared_ptr<const std::vector<vec3>>;  // [m] mesh frame, pairs
  using All = std::map<const DocumentMesh*, Ends>;
  // Starts missing computations for the document's meshes; drops unused ones.
  void update(Editor& editor);
  All known() const;

 private:
  struct One {
    std::shared_ptr<const DocumentMesh> mesh;  // kept alive, so that its address stays unique
    Ends ends;                                 // null: in progress
  };
  std::shared_ptr<std::map<const DocumentMesh*, One>> all_ = std::make_shared<std::map<const DocumentMesh*, One>>();
};

// Empty if it has none or cannot be read.
std::vector<vec3> crease_lines_of(const LevelMesh& mesh, const std::atomic<bool>* stop = nullptr);

}  // namespace pliant
