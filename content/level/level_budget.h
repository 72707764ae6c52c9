// How much a level makes of its meshes: a small file can name a mesh often. Spawn asks before it builds anything, and
// again where a mesh was cut finer. Every question is answered by a sentence, "" where it is within limits
// (content/files/limits.h).
#pragma once

#include <string>
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
  std::string ask_triangles(double count) const;
  std::string ask_vertices(double count) const;
  static std::string ask(const Limit& limit, double count, const char* cure = "use fewer of them");

 private:
  std::vector<MeshSize> sizes_;
  MeshSize own_;  // of all meshes, each once
};

}  // namespace pliant
