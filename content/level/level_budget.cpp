#include "content/level/level_budget.h"

namespace pliant {

LevelBudget::LevelBudget(const Level& level) {
  for (const LevelMesh& mesh : level.meshes) {
    sizes_.emplace_back();
    for (const Primitive& p : mesh.primitives) {
      sizes_.back().triangles += static_cast<double>(p.index.size()) / 3.0;
      sizes_.back().vertices += static_cast<double>(p.position.size());
    }
    own_.triangles += sizes_.back().triangles;
    own_.vertices += sizes_.back().vertices;
  }
}

std::optional<Note> LevelBudget::ask_triangles(double count) const {
  constexpr const char* kCure = "use fewer instances, or give them one scale and rotation so that they share";
  std::optional<Note> all = ask(limits::kTriangles, count, kCure);
  return all ? all : ask(limits::kAddedTriangles, count - own_.triangles, kCure);
}

std::optional<Note> LevelBudget::ask_vertices(double count) const {
  return ask(limits::kAddedVertices, count - own_.vertices, "use fewer instances, or make fewer of them deformable");
}

std::optional<Note> LevelBudget::ask(const Limit& limit, double count, const char* cure) {
  if (count <= static_cast<double>(most(limit))) return {};
  return beyond("brings the level to", limit, count, cure);
}

}  // namespace pliant
