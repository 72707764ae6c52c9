#include "engine/choice/pin_advice.h"

#include <algorithm>

#include "content/author/touchable.h"
#include "content/level/spawn_soft.h"

namespace pliant {
namespace {

constexpr Side kAdvisedSides[] = {Side::kBottom, Side::kBack, Side::kTop, Side::kLeft, Side::kRight, Side::kFront};
constexpr double kAdvisedShares[] = {0.15, 0.3};  // [1]
constexpr double kCoarser = 1.4;                  // [1] of the usual cell: the advice hardly depends on it

}  // namespace

std::vector<PinAdvice> advise_pins(const Level& level, std::int32_t node, const std::stop_token& stop) {
  std::vector<PinAdvice> out;
  const LevelNode& it = level.nodes[static_cast<std::size_t>(node)];
  if (!it.soft_body || it.mesh < 0 || !it.soft_body->mesh.empty()) return out;
  const ObjectFrame frame = object_frame(level, node);
  Result<BuiltMesh> surface =
      build_mesh(it.name, level.meshes[static_cast<std::size_t>(it.mesh)].primitives, mat4(frame.to_object));
  if (!surface) return out;
  surface->pinned.clear();
  const dvec3 gravity = glm::conjugate(frame.pose.rotation) * level.simulation.gravity;
  Level trial = level;
  SoftBody& body = *trial.nodes[static_cast<std::size_t>(node)].soft_body;
  body.under_gravity = UnderGravity::kFalls;
  body.focus = {};
  body.pinned = {};
  body.cell = 0.0;
  const Result<FilledBody> usual = make_tissue(*surface, body, nullptr, stop);
  if (!usual) return out;
  body.cell = usual->tets.report.cell * kCoarser;
  for (const double share : kAdvisedShares)
    for (const Side side : kAdvisedSides) {
      if (stop.stop_requested()) return {};
      body.pinned = {};
      if (!pin(trial, node, side, share)) continue;
      Result<FilledBody> filled = make_tissue(*surface, body, nullptr, stop);
      if (!filled) continue;
      put_in_order(filled->tets, filled->group);
      const Equilibrium rest = find_equilibrium(filled->tets, body, gravity, nullptr, stop);
      if (rest.converged && rest.turned < kMuchTurn && rest.most < kMuchSag * rest.size)
        out.push_back({side, share, rest.most, rest.most / rest.size});
    }
  std::stable_sort(out.begin(), out.end(), [](const PinAdvice& a, const PinAdvice& b) {
    return a.share != b.share ? a.share < b.share : a.sag < b.sag;
  });
  return out;
}

}  // namespace pliant
