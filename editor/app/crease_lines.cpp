#include "editor/app/crease_lines.h"

#include <algorithm>

#include "content/mesh/touch_mesh.h"

namespace pliant {

std::vector<vec3> crease_lines_of(const LevelMesh& mesh, const std::atomic<bool>* stop) {
  std::vector<vec3> ends;
  const Result<TouchMesh> touch = build_touch_mesh(mesh.name, mesh.primitives, mat4(1), {}, stop);
  if (!touch) return ends;
  const Mesh& of = touch->mesh;
  for (std::uint32_t t = 0; t < of.triangles.size() && !of.crease.empty(); ++t)
    for (int i = 0; i < 3; ++i) {
      if (!of.is_crease(t, i) || (of.across[t][i] != kBorder && of.across[t][i] < t)) continue;
      ends.push_back(of.position(of.triangles[t][i]));
      ends.push_back(of.position(of.triangles[t][(i + 1) % 3]));
    }
  return ends;
}

void CreaseLines::update(Editor& editor) {
  const State& state = editor.state();
  std::vector<bool> used(state.meshes.size(), false);
  for (const auto& each : state.nodes)
    if (each->node.mesh >= 0) used[static_cast<std::size_t>(each->node.mesh)] = true;
  for (std::size_t m = 0; m < used.size(); ++m) {
    const auto mesh = state.meshes[m];
    if (!used[m] || all_->contains(mesh.get())) continue;
    (*all_)[mesh.get()] = {mesh, nullptr};
    editor.jobs.start("creases " + std::to_string(m), "Finding creases of " + mesh->name,
                      [mesh, all = all_](const Jobs::Stop& stop) {
                        auto ends = std::make_shared<const std::vector<vec3>>(crease_lines_of(*mesh, &stop));
                        return [mesh, all, ends](Editor&) { (*all)[mesh.get()] = {mesh, ends}; };
                      });
  }
  std::erase_if(*all_, [&](const auto& each) {
    return std::find(state.meshes.begin(), state.meshes.end(), each.second.mesh) == state.meshes.end();
  });
}

CreaseLines::All CreaseLines::known() const {
  All out;
  for (const auto& [mesh, one] : *all_) out[mesh] = one.ends;
  return out;
}

}  // namespace pliant
