// The total size of a level's mesh instances: a small file can instance a mesh often. Spawn checks it before building,
// and again after refining a mesh. Each function returns nothing if the size is within the limits
// (content/files/limits.h), else the fault.
#pragma once

#include <optional>
#include <vector>

#include "content/files/limits.h"
#include "content/level/level.h"

namespace pliant {

struct MeshSize {
  double triangles = 0.0, vertices = 0.0;
};

class LevelBudget {
 public:
  explicit LevelBudget(const Level& level);
  const MeshSize& of(std::int32_t mesh) const { return sizes_[static_cast<std::size_t>(mesh)]; }

  // Triangles built; vertices of deformable surfaces.
  std::optional<Note> ask_triangles(double count) const;
  std::optional<Note> ask_vertices(double count) const;
  static std::optional<Note> ask(const Limit& limit, double count, const char* cure = "use fewer of them");

 private:
  std::vector<MeshSize> sizes_;
  MeshSize own_;  // of all meshes, each counted once
};

}  // namespace pliant
