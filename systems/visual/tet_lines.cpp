#include "systems/visual/tet_lines.h"

#include <algorithm>
#include <utility>

#include "components/soft_body.h"

namespace pliant {
namespace {

// Every edge once, as pairs of nodes.
std::vector<std::uint32_t> edges_of(const TetMesh& mesh) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(6 * mesh.tets.size());
  for (const Tet& tet : mesh.tets)
    for (int i = 0; i < 4; ++i)
      for (int j = i + 1; j < 4; ++j) edges.push_back(std::minmax(tet[i], tet[j]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<std::uint32_t> ends;
  for (const auto& [a, b] : edges) ends.insert(ends.end(), {a, b});
  return ends;
}

}  // namespace

Result<TetLines> TetLines::make(const World& world) {
  TetLines made;
  Result<gpu::Program> program = gpu::Program::load({"lines.vert", "lines.frag"});
  if (!program) return program.error();
  made.program_ = *std::move(program);
  for (auto [entity, soft] : world.registry.view<SoftBody>()) {
    if (!soft.tets.valid()) continue;
    const TetMesh& mesh = world.tet_meshes[soft.tets];
    const Pose* pose = world.registry.find<Pose>(entity);
    Item item;
    item.entity = entity;
    for (const dvec3 node : mesh.nodes) item.nodes.push_back(vec3(pose ? pose->to_world(node) : node));
    const std::vector<std::uint32_t> ends = edges_of(mesh);
    item.edge_ends = static_cast<GLsizei>(ends.size());
    item.edges = gpu::Buffer::indices(ends);
    item.on_gpu = gpu::Buffer::writable(nullptr, item.nodes.size() * sizeof(vec3));
    item.layout = gpu::VertexArray::make();
    item.layout.source(item.on_gpu, sizeof(vec3));
    item.layout.floats(0, 3, 0);
    item.layout.indices(item.edges);
    made.items_.push_back(std::move(item));
  }
  return made;
}

void TetLines::take(const SoftObjectSnapshot& object) {
  for (Item& item : items_) {
    if (item.entity != object.object || item.nodes.size() != object.nodes.size()) continue;
    item.nodes = object.nodes;
    item.newer_here = true;
  }
}

std::size_t TetLines::upload() {
  std::size_t travelled = 0;
  for (Item& item : items_) {
    if (!item.newer_here) continue;
    travelled += item.on_gpu.write(0, item.nodes.data(), item.nodes.size() * sizeof(vec3));
    item.newer_here = false;
  }
  return travelled;
}

void TetLines::draw() const {
  program_.use();
  glDisable(GL_DEPTH_TEST);
  glEnable(GL_BLEND);
  for (const Item& item : items_) {
    glBindVertexArray(item.layout.id());
    glDrawElements(GL_LINES, item.edge_ends, GL_UNSIGNED_INT, nullptr);
  }
  glDisable(GL_BLEND);
  glEnable(GL_DEPTH_TEST);
}

}  // namespace pliant
