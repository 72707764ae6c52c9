// State that the steps of spawn_level share: the level, its motions, and the World that is made of them.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "content/level/level.h"
#include "content/level/level_budget.h"
#include "content/level/node_error.h"
#include "content/level/script.h"
#include "content/level/spawn_motion.h"
#include "runtime/long_work.h"

namespace pliant {

struct SpawnState {
  explicit SpawnState(const Level& from)
      : level(from), folder(from.path.parent_path()), entities(from.nodes.size(), kNoEntity), budget(from) {}

  Error at(std::size_t n, std::string what) const { return node_error(level, n, std::move(what)); }
  // `over`: of LevelBudget; "": within it.
  Status within(std::size_t n, const std::string& over) const {
    if (over.empty()) return Done{};
    return at(n, over);
  }
  Status count_triangles(std::size_t n, double triangles) {
    return within(n, budget.ask_triangles(built.triangles += triangles));
  }
  void say_preparing(std::size_t n, const std::string& mesh) {
    progress.say("preparing meshes, now `" + mesh + "`",
                 static_cast<double>(n) / static_cast<double>(level.nodes.size()));
  }

  const Level& level;
  const std::filesystem::path folder;  // of the level; its scripts and tetrahedra lie there
  World world;
  std::vector<Entity> entities;  // per node; kNoEntity: not in the scene
  LevelMotions motions;
  ScriptLibrary scripts;
  const LevelBudget budget;
  MeshSize built;  // so far; vertices of deformable surfaces
  std::vector<std::string> notes;
  LongWork progress;
};

// World to the frame of the pose.
inline dmat4 world_to(const Pose& pose) {
  const dquat back = glm::conjugate(pose.rotation);
  dmat4 m = glm::mat4_cast(back);
  m[3] = glm::dvec4(back * -pose.position, 1.0);
  return m;
}

}  // namespace pliant
