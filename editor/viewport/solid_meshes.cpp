// Meshes of a document on the GPU: surfaces, edges, normals, painted values and regions.
#include <algorithm>

#include "editor/viewport/signs.h"
#include "editor/viewport/solid_view.h"

namespace pliant {
namespace {

constexpr std::size_t kMostNormals = 20'000;  // more lines than that hide the mesh
constexpr std::size_t kMostDots = 30'000;     // of what is pinned

struct SolidVertex {
  vec3 position, normal;
};

std::vector<SolidVertex> vertices_of(const Primitive& primitive) {
  std::vector<SolidVertex> out(primitive.position.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = {primitive.position[i], vec3(0)};
  if (primitive.normal.size() == out.size()) {
    for (std::size_t i = 0; i < out.size(); ++i) out[i].normal = primitive.normal[i];
    return out;
  }
  for (std::size_t t = 0; t + 2 < primitive.index.size(); t += 3) {
    const std::uint32_t a = primitive.index[t], b = primitive.index[t + 1], c = primitive.index[t + 2];
    const vec3 n = cross(out[b].position - out[a].position, out[c].position - out[a].position);
    for (const std::uint32_t v : {a, b, c}) out[v].normal += n;
  }
  for (SolidVertex& v : out) v.normal = dot(v.normal, v.normal) > 0.0f ? glm::normalize(v.normal) : vec3(0, 1, 0);
  return out;
}

}  // namespace

SolidView::MeshOnGpu& SolidView::on_gpu(const std::shared_ptr<const DocumentMesh>& mesh) {
  MeshOnGpu& out = meshes_[mesh.get()];
  out.seen = true;
  if (out.of) return out;
  out.of = mesh;
  for (const Primitive& primitive : mesh->primitives) {
    PrimitiveOnGpu p;
    const std::vector<SolidVertex> vertices = vertices_of(primitive);
    p.index_count = static_cast<GLsizei>(primitive.index.size());
    p.vertices = gpu::Buffer::fixed<SolidVertex>(vertices);
    p.indices = gpu::Buffer::fixed<std::uint32_t>(primitive.index);
    p.layout = gpu::VertexArray::make();
    p.layout.source(p.vertices, sizeof(SolidVertex));
    p.layout.floats(0, 3, 0);
    p.layout.floats(1, 3, sizeof(vec3));
    p.layout.indices(p.indices);
    out.primitives.push_back(std::move(p));
  }
  return out;
}

void SolidView::add_edges(PrimitiveOnGpu& to, const Primitive& primitive) {
  if (to.edge_count != 0 || primitive.index.empty()) return;
  std::vector<std::uint64_t> edges;
  edges.reserve(primitive.index.size());
  for (std::size_t t = 0; t + 2 < primitive.index.size(); t += 3)
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = primitive.index[t + i], b = primitive.index[t + (i + 1) % 3];
      edges.push_back(std::uint64_t{std::min(a, b)} << 32 | std::max(a, b));
    }
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<std::uint32_t> ends;
  ends.reserve(2 * edges.size());
  double sum = 0;
  for (const std::uint64_t edge : edges) {
    ends.push_back(static_cast<std::uint32_t>(edge >> 32));
    ends.push_back(static_cast<std::uint32_t>(edge));
    sum += static_cast<double>(length(primitive.position[ends.back()] - primitive.position[ends[ends.size() - 2]]));
  }
  to.mean_edge = sum / static_cast<double>(edges.size());
  to.edge_count = static_cast<GLsizei>(ends.size());
  to.edges = gpu::Buffer::fixed<std::uint32_t>(ends);
  to.edge_layout = gpu::VertexArray::make();
  to.edge_layout.source(to.vertices, sizeof(SolidVertex));
  to.edge_layout.floats(0, 3, 0);
  to.edge_layout.floats(1, 3, sizeof(vec3));
  to.edge_layout.indices(to.edges);
}

void SolidView::add_normals(MeshOnGpu& mesh) {
  if (mesh.has_normals) return;
  mesh.has_normals = true;
  const float normal_length = 0.012f * mesh.of->box.diagonal();
  std::size_t vertex_count = 0;
  for (const Primitive& primitive : mesh.of->primitives) vertex_count += primitive.position.size();
  const std::size_t every = std::max<std::size_t>(1, vertex_count / kMostNormals);
  for (const Primitive& primitive : mesh.of->primitives) {
    const std::vector<SolidVertex> vertices = vertices_of(primitive);
    for (std::size_t i = 0; i < vertices.size(); i += every) {
      mesh.normal_ends.push_back(vertices[i].position);
      mesh.normal_ends.push_back(vertices[i].position + normal_length * vertices[i].normal);
    }
  }
}

// Dots where the value of pinned or handle is at least one half.
void SolidView::add_regions(MeshOnGpu& mesh, std::size_t number, const SolidOrder& order, const mat4& world,
                            std::vector<LineEnd>& points) {
  for (std::uint32_t i = 0; i < mesh.primitives.size(); ++i)
    for (const int which : {0, 1}) {
      const Channel channel = which == 0 ? Channel::kPinned : Channel::kHandle;
      const auto it = order.state.paint.find({static_cast<std::uint32_t>(number), i, channel});
      if (it == order.state.paint.end()) continue;
      PrimitiveOnGpu& p = mesh.primitives[i];
      const std::vector<vec3>& position = mesh.of->primitives[i].position;
      if (!(p.regions[which] == it->second)) {
        p.regions[which] = it->second;
        p.region_points[which].clear();
        std::vector<vec3> all;
        for (std::size_t v = 0; v < position.size() && v < it->second.size(); ++v)
          if (it->second.value(v) >= 0.5f) all.push_back(position[v]);
        const std::size_t every = 1 + all.size() / kMostDots;
        for (std::size_t v = 0; v < all.size(); v += every) p.region_points[which].push_back(all[v]);
      }
      for (const vec3& at : p.region_points[which])
        points.push_back({vec3(world * vec4(at, 1.0f)), which == 0 ? kPinnedColor : kHandleColor});
    }
}

// Uploads the chunks that differ from the displayed ones.
void SolidView::show_values(MeshOnGpu& mesh, std::size_t number, const SolidOrder& order) {
  if (!order.settings.channel) return;
  for (std::uint32_t i = 0; i < mesh.primitives.size(); ++i) {
    PrimitiveOnGpu& p = mesh.primitives[i];
    const std::size_t count = mesh.of->primitives[i].position.size();
    const auto it = order.state.paint.find({static_cast<std::uint32_t>(number), i, *order.settings.channel});
    const PaintLayer layer =
        it != order.state.paint.end() ? it->second : PaintLayer::constant(count, unpainted(*order.settings.channel));
    if (!p.has_values) {
      p.values = gpu::Buffer::writable(nullptr, layer.chunk_count() * PaintLayer::kChunk * sizeof(float));
      p.layout.source(p.values, sizeof(float));
      p.layout.floats(2, 1, 0);
      p.shown = PaintLayer();
      p.has_values = true;
    }
    for (std::size_t c = 0; c < layer.chunk_count(); ++c)
      if (p.shown.chunk_count() != layer.chunk_count() || p.shown.chunk(c) != layer.chunk(c))
        p.values.write(c * PaintLayer::kChunk * sizeof(float), layer.chunk(c), PaintLayer::kChunk * sizeof(float));
    p.shown = layer;
  }
}

}  // namespace pliant
