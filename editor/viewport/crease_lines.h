// The edges over which a level's meshes turn sharply, as touch has them, for the viewport: found in the background.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "editor/app/editor.h"

namespace pliant {

class CreaseLines {
 public:
  using Ends = std::shared_ptr<const std::vector<vec3>>;  // [m] mesh frame, pairs
  using All = std::map<const DocumentMesh*, Ends>;
  // Begins what is missing of the document's meshes; those that nobody shows any more are forgotten.
  void update(Editor& editor);
  All known() const;

 private:
  struct One {
    std::shared_ptr<const DocumentMesh> mesh;  // kept, so that its address stays its own
    Ends ends;                                 // null: under way
  };
  std::shared_ptr<std::map<const DocumentMesh*, One>> all_ = std::make_shared<std::map<const DocumentMesh*, One>>();
};

// Of a mesh; empty where it has none or cannot be read.
std::vector<vec3> crease_lines_of(const LevelMesh& mesh, const std::atomic<bool>* stop = nullptr);

}  // namespace pliant
