#include "content/tets/tet_parts.h"

#include <algorithm>
#include <numeric>

#include "content/tets/tet_boundary.h"
#include "content/tets/tet_quality.h"
#include "runtime/disjoint_sets.h"

namespace pliant {
namespace {

DisjointSets parts_of(const TetMesh& mesh) {
  DisjointSets sets(mesh.tets.size());
  const std::vector<TetFace> faces = sorted_faces(mesh.tets);
  for (std::size_t i = 1; i < faces.size(); ++i)
    if (faces[i].nodes == faces[i - 1].nodes) sets.join(faces[i].number / 4, faces[i - 1].number / 4);
  return sets;
}

// Keeps the tetrahedra marked in `keep`, and their nodes, which take over the mass of the others.
void keep_only(const std::vector<std::uint8_t>& keep, TetMesh& mesh, std::vector<NodeGroup>& group) {
  std::vector<std::uint32_t> moved(mesh.nodes.size(), 0);
  std::vector<Tet> tets;
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    if (!keep[t]) continue;
    tets.push_back(mesh.tets[t]);
    for (const std::uint32_t corner : mesh.tets[t]) moved[corner] = 1;
  }
  const double all = std::accumulate(mesh.volume.begin(), mesh.volume.end(), 0.0);
  std::uint32_t count = 0;
  for (std::size_t n = 0; n < moved.size(); ++n) {
    if (!moved[n]) continue;
    mesh.nodes[count] = mesh.nodes[n];
    if (!mesh.volume.empty()) mesh.volume[count] = mesh.volume[n];
    group[count] = group[n];
    moved[n] = count++;
  }
  mesh.nodes.resize(count);
  if (!mesh.volume.empty()) {
    mesh.volume.resize(count);
    const double kept = std::accumulate(mesh.volume.begin(), mesh.volume.end(), 0.0);
    for (double& each : mesh.volume) each *= all / kept;
  }
  group.resize(count);
  for (Tet& tet : tets)
    for (std::uint32_t& corner : tet) corner = moved[corner];
  mesh.tets = std::move(tets);
  std::vector<LatticeCell> cells;
  for (std::size_t c = 0; c < mesh.cells.size(); ++c) {
    if (!keep[kTetsOfCell * c]) continue;
    cells.push_back(mesh.cells[c]);
    for (std::uint32_t& corner : cells.back().nodes) corner = moved[corner];
  }
  mesh.cells = std::move(cells);
  mesh.free_count = mesh.node_count();
  mesh.quality = measure_quality(mesh.nodes, mesh.tets);
}

}  // namespace

std::uint32_t count_parts(const TetMesh& mesh) {
  return parts_of(mesh).count();
}

std::uint32_t drop_small_parts(TetMesh& mesh, std::vector<NodeGroup>& group) {
  DisjointSets parts = parts_of(mesh);
  if (parts.count() == 1) return 1;
  std::vector<double> volume(mesh.tets.size(), 0.0);  // of each part, at its root
  std::vector<std::uint8_t> held(mesh.tets.size(), 0);
  double all = 0.0;
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    const std::uint32_t part = parts.find(t);
    const double v = tet_volume(mesh.nodes, mesh.tets[t]);
    volume[part] += v;
    all += v;
    for (const std::uint32_t corner : mesh.tets[t]) held[part] |= group[corner] != NodeGroup::kFree;
  }
  const auto largest = static_cast<std::uint32_t>(std::max_element(volume.begin(), volume.end()) - volume.begin());
  std::uint32_t kept = 0;
  double lost = 0.0;
  std::vector<std::uint8_t> keep(mesh.tets.size(), 0);
  for (std::uint32_t t = 0; t < mesh.tets.size(); ++t) {
    const std::uint32_t part = parts.find(t);
    keep[t] = part == largest || held[part] || volume[part] >= kSmallPart * all;
    if (part != t) continue;
    kept += keep[t];
    if (!keep[t]) lost += volume[t];
  }
  if (kept == parts.count()) return kept;
  mesh.report.parts_dropped = parts.count() - kept;
  mesh.report.volume_dropped = lost / all;
  keep_only(keep, mesh, group);
  return kept;
}

std::uint32_t count_parts(const Mesh& mesh) {
  DisjointSets sets(mesh.vertex_count);
  for (const uvec3& t : mesh.triangles) {
    sets.join(t.x, t.y);
    sets.join(t.x, t.z);
  }
  return sets.count();
}

}  // namespace pliant
