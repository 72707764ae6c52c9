#include "editor/document/resting_mesh.h"

#include <algorithm>

#include "content/author/object_frame.h"
#include "content/level/spawn_soft.h"
#include "systems/soft/body/equilibrium.h"

namespace pliant {

RestingMesh resting_mesh(const Level& level, std::int32_t node, const std::filesystem::path& folder,
                         const std::stop_token& stop) {
  const LevelNode& of = level.nodes[static_cast<std::size_t>(node)];
  RestingMesh out;
  out.mesh = level.meshes[static_cast<std::size_t>(of.mesh)];
  const double gravity_size = length(level.simulation.gravity);
  if (!of.soft_body || of.handle || !(gravity_size > 0.0)) return out;
  const ObjectFrame frame = object_frame(level, node);
  const Result<SoftParts> parts = make_soft_parts(of, &out.mesh, mat4(frame.to_object), folder);
  if (!parts || stop.stop_requested()) return out;
  const TetMesh& tets = parts->tets;
  const dvec3 gravity = glm::conjugate(frame.pose.rotation) * level.simulation.gravity;
  if (of.soft_body->under_gravity == UnderGravity::kModelled && find_unloaded(tets, *of.soft_body, gravity, stop).found)
    return out;
  const Equilibrium rest = find_equilibrium(tets, *of.soft_body, gravity, nullptr, stop);
  if (!rest.held || !rest.converged) {
    out.held = false;
    return out;
  }
  out.falls = of.soft_body->under_gravity == UnderGravity::kFalls;
  const dmat4 to_mesh = glm::inverse(frame.to_object);
  std::size_t source = 0;
  for (Primitive& primitive : out.mesh.primitives) {
    for (vec3& p : primitive.position) {
      const std::uint32_t vertex = parts->surface.mesh.of_source[source++];
      if (vertex == kBorder) continue;
      const Embedding& in = tets.embedding[vertex];
      dvec3 moved(0);
      for (std::size_t i = 0; i < 4; ++i)
        moved += in.weight[i] * (rest.nodes[tets.tets[in.tet][i]] - tets.nodes[tets.tets[in.tet][i]]);
      const dvec3 there = dvec3(to_mesh * glm::dvec4(dvec3(frame.to_object * glm::dvec4(dvec3(p), 1.0)) + moved, 1.0));
      out.sag = std::max(out.sag, length(moved));
      p = vec3(there);
    }
    primitive.normal.clear();  // made from the faces
    primitive.tangent.clear();
  }
  return out;
}

}  // namespace pliant
