#include "editor/panels/automatic.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "components/deformable.h"
#include "editor/viewport/gizmo_math.h"

namespace pliant {
namespace {

// The mesh's frame in the object frame, in which lengths are those of the world.
dmat3 stretch(const State& state, const DocumentNode& node) {
  const dmat3 axes(state.to_world(node.id));
  dmat3 out(0.0);
  for (int i = 0; i < 3; ++i) out[i][i] = length(axes[i]);
  return out;
}

// [m3] Enclosed by the node's mesh.
double volume_of(const State& state, const DocumentNode& node) {
  const dmat3 frame = stretch(state, node);
  double six = 0.0;
  for (const Primitive& p : state.meshes[static_cast<std::size_t>(node.node.mesh)]->primitives)
    for (std::size_t t = 0; t + 2 < p.index.size(); t += 3) {
      const dvec3 a = frame * dvec3(p.position[p.index[t]]), b = frame * dvec3(p.position[p.index[t + 1]]),
                  c = frame * dvec3(p.position[p.index[t + 2]]);
      six += dot(a, cross(b, c));
    }
  return std::abs(six) / 6.0;
}

std::optional<std::string> resolved(const State& state, const DocumentNode& node, const std::string& name) {
  if (node.node.mesh < 0) return {};
  const Box& box = state.meshes[static_cast<std::size_t>(node.node.mesh)]->box;
  const double reach = kDefaultReach * length(stretch(state, node) * dvec3(box.size()));
  if (name == "deformable.reach") return metres_text(reach, 3);
  if (name == "deformable.contact_radius") {
    constexpr double kShareOfReach = 0.2;  // [1] as the key's documentation says
    return metres_text(kShareOfReach * (node.node.deformable->reach > 0.0 ? node.node.deformable->reach : reach), 3);
  }
  if (name == "rigid_body.mass")
    return fmt::format("{:.3g} kg", node.node.rigid_body->density * volume_of(state, node));
  return {};
}

}  // namespace

std::string zero_text(const State& state, const DocumentNode& node, const std::string& extension, const Key& key) {
  constexpr std::size_t kShort = 14;  // letters that a field holds
  const std::size_t at = key.doc.find("0: ");
  if (at == std::string::npos || (at > 0 && key.doc[at - 1] != ' ')) return "";
  if (const auto text = resolved(state, node, extension + "." + key.name)) return "automatic: " + *text;
  const std::string words = key.doc.substr(at + 3, key.doc.find_first_of(";,", at) - at - 3);
  return words.size() <= kShort ? words : "automatic";
}

}  // namespace pliant
