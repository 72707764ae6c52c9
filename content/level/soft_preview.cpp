#include "content/level/soft_preview.h"

#include <algorithm>

#include "content/level/spawn_soft.h"
#include "content/tets/step_cost.h"
#include "content/tets/tet_parts.h"
#include "content/tets/tet_quality.h"

namespace pliant {
namespace {

std::vector<std::array<std::uint32_t, 2>> edges_of(const std::vector<Tet>& tets) {
  std::vector<std::array<std::uint32_t, 2>> edges;
  edges.reserve(6 * tets.size());
  for (const Tet& tet : tets)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t k = i + 1; k < 4; ++k) edges.push_back({std::min(tet[i], tet[k]), std::max(tet[i], tet[k])});
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  return edges;
}

}  // namespace

Result<SoftPreview> preview_soft_body(const BuiltMesh& surface, const SoftBody& body, const Handle6* handle,
                                      const std::stop_token& stop) {
  Result<FilledBody> tissue = make_tissue(surface, body, handle, stop);
  if (!tissue) return tissue.error();
  TetMesh& tets = tissue->tets;
  SoftPreview preview;
  preview.cell = tets.report.cell;
  preview.tetrahedra = tets.tets.size();
  const auto count = [&](NodeGroup which) {
    return static_cast<std::size_t>(std::count(tissue->group.begin(), tissue->group.end(), which));
  };
  preview.pinned = count(NodeGroup::kPinned);
  preview.on_handle = count(NodeGroup::kHandle);
  preview.parts = count_parts(tets);
  preview.parts_lost = tets.report.parts_dropped;
  preview.quality = tets.quality;
  preview.volume = tissue_volume(tets);
  preview.wall = tets.report.wall;
  preview.step_ms = step_ms(preview.tetrahedra, machine_slowness());
  preview.notes = std::move(tets.report.notes);
  if (std::optional<Note> doubt = locking_doubt(body, preview.tetrahedra)) preview.notes.push_back(*doubt);
  put_in_order(tets, tissue->group);
  preview.edges = edges_of(tets.tets);
  preview.nodes = tets.nodes;
  preview.body = std::move(tets);
  return preview;
}

}  // namespace pliant
