#include "editor/tools/path_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/constants.hpp>
#include <utility>

#include "components/probe_shape.h"
#include "editor/viewport/solid_view.h"
#include "viewer/ui/theme.h"

namespace pliant {
namespace {

constexpr std::size_t kMostGhosts = 12, kMostGhostEdges = 700;
constexpr double kSeenSag = 0.005;            // [1] of a body's size: what sags farther is drawn where it rests
constexpr std::size_t kMostRestEdges = 4000;  // of it

using Edges = std::vector<std::pair<vec3, vec3>>;  // [m] device frame

// Some of the edges of the node's mesh.
Edges mesh_edges(const State& state, const DocumentNode& it) {
  Edges out;
  const dmat4 world = state.to_world(it.id);
  const Pose pose = rigid_part(world);
  std::size_t triangles = 0;
  const DocumentMesh& mesh = *state.meshes[static_cast<std::size_t>(it.node.mesh)];
  for (const Primitive& p : mesh.primitives) triangles += p.index.size() / 3;
  const std::size_t every = 1 + triangles / kMostGhostEdges;
  for (const Primitive& p : mesh.primitives)
    for (std::size_t t = 0; t + 2 < p.index.size(); t += 3 * every) {
      const auto place = [&](std::size_t i) {
        return vec3(pose.to_local(dvec3(world * glm::dvec4(dvec3(p.position[p.index[i]]), 1.0))));
      };
      out.emplace_back(place(t), place(t + 1));
    }
  return out;
}

// Circles around the tip, and lines along a capsule.
Edges tip_edges(const DocumentNode& it, const PathTip& tip) {
  Edges out;
  const dvec3 axis = tip.axis == dvec3(0) ? dvec3(0, 1, 0) : tip.axis;
  const dvec3 side = normalize(std::abs(axis.x) < 0.9 ? cross(axis, dvec3(1, 0, 0)) : cross(axis, dvec3(0, 1, 0)));
  const dvec3 frame[3] = {side, cross(axis, side), axis};
  constexpr int kAround = 24;
  for (int plane = 0; plane < 3; ++plane)
    for (int i = 0; i < kAround; ++i) {
      const auto on = [&](int k) {
        const double a = 2.0 * glm::pi<double>() * k / kAround;
        return vec3(tip.place + tip.radius * (std::cos(a) * frame[plane] + std::sin(a) * frame[(plane + 1) % 3]));
      };
      out.emplace_back(on(i), on(i + 1));
    }
  for (const ProbePart& part : it.node.probe ? probe_parts(*it.node.probe) : std::vector<ProbePart>())
    if (!part.is_sphere())
      for (const dvec3& beside : {frame[0], -frame[0], frame[1], -frame[1]})
        out.emplace_back(vec3(part.from + tip.radius * beside), vec3(part.to + tip.radius * beside));
  return out;
}

void draw_resting(const RestingBodies::Sagging& it, std::vector<ViewLine>& lines) {
  const Mesh& mesh = it.surface->mesh();
  const std::size_t every = 1 + 3 * mesh.triangles.size() / (2 * kMostRestEdges);
  const ImVec4& c = ui::palette().warning;
  std::size_t edge = 0;
  for (const uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i], b = t[(i + 1) % 3];
      if (a > b || edge++ % every != 0) continue;
      lines.push_back({vec3(it.origin + dvec3(mesh.position(a))), vec3(it.origin + dvec3(mesh.position(b))),
                       vec4(c.x, c.y, c.z, 0.4f), true});
    }
}

}  // namespace

void draw_ghosts(const Editor& editor, const ScriptKeys& keys, std::vector<ViewLine>& lines) {
  const DocumentNode* const it = editor.state().find(effector_of(editor.state(), path_node(editor)));
  if (!it || !keys.rows) return;
  const Edges shape =
      it->node.mesh >= 0 && !it->node.probe ? mesh_edges(editor.state(), *it) : tip_edges(*it, keys.tip);
  const std::size_t shown = std::min(keys.keys.size(), kMostGhosts);
  for (std::size_t i = 0; i < keys.keys.size(); ++i) {
    const bool active = editor.path_key == i;
    if (i >= shown && !active) continue;
    const ImVec4& c = active ? ui::palette().accent : ui::palette().text;
    const PathRow at = pose_at(keys, keys.keys[i].time);
    const auto world = [&](const vec3& p) { return vec3(at.position + at.rotation * dvec3(p)); };
    for (const auto& [from, to] : shape)
      lines.push_back({world(from), world(to), vec4(c.x, c.y, c.z, active ? 0.55f : 0.25f), false});
  }
}

void RestingBodies::find(Editor& editor) {
  sagging_.clear();
  if (path_node(editor) == kNoNode || editor.playing) return;
  for (const NodeId id : path_grounds(editor.state())) {
    const Editor::Ground ground = editor.ground_of(id);
    if (!ground.surface) continue;
    const std::string name = "`" + editor.state().find(id)->node.name + "`";
    const bool far = ground.sag > kSeenSag * static_cast<double>(ground.surface->mesh().box.diagonal());
    if (far) sagging_.push_back({ground.surface, dvec3(editor.state().to_world(id)[3])});
    const bool known = std::any_of(said_.begin(), said_.end(), [&](const auto& s) { return s == ground.surface; });
    if (known || (!far && ground.held)) continue;
    said_.push_back(ground.surface);
    if (!ground.held)
      editor.say(name +
                     " finds no rest on what is pinned: keys are set on it as it is drawn, and the run may find it "
                     "elsewhere; pin more of it",
                 Severity::kWarning);
    else
      editor.say(fmt::format("{} sags {:.2g} mm on what is pinned: keys are set on it where it rests (the lines){}",
                             name, 1e3 * ground.sag,
                             ground.falls ? ", to which it falls when the run begins; `Settled` begins there" : ""),
                 Severity::kWarning);
  }
}

void RestingBodies::draw(std::vector<ViewLine>& lines) const {
  for (const Sagging& each : sagging_) draw_resting(each, lines);
}

}  // namespace pliant
