#include "content/level/carried_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "content/tets/fill_region.h"
#include "content/tets/tet_embed.h"

namespace pliant {
namespace {

constexpr std::size_t kLooked = 96;  // vertices of a mesh that are tested
constexpr std::size_t kNamedParts = 3;

// Vertices of a mesh, spread evenly over its list, transformed to another frame.
std::vector<dvec3> some_vertices(const LevelMesh& mesh, const dmat4& frame) {
  std::size_t count = 0;
  for (const Primitive& p : mesh.primitives) count += p.position.size();
  const std::size_t every = std::max<std::size_t>(1, count / kLooked);
  std::vector<dvec3> out;
  std::size_t i = 0;
  for (const Primitive& p : mesh.primitives)
    for (const vec3& x : p.position)
      if (i++ % every == 0) out.emplace_back(frame * glm::dvec4(dvec3(x), 1.0));
  return out;
}

bool in_box(const Box& box, dvec3 p) {
  return glm::all(glm::greaterThanEqual(p, dvec3(box.min))) && glm::all(glm::lessThanEqual(p, dvec3(box.max)));
}

// Finds the nearest of many points with a grid, cell shell by cell shell.
class NearestVertex {
 public:
  explicit NearestVertex(const Mesh& mesh) : mesh_(mesh) {
    cell_ = std::max(1e-9, 2.0 * static_cast<double>(mesh.mean_edge));
    for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) cells_[key(place(dvec3(mesh.position(v))))].push_back(v);
  }
  // Within `reach` [m]; kBorder: none.
  std::uint32_t find(dvec3 p, double reach, double& away) const {
    const glm::i64vec3 at = place(p);
    const auto shells = static_cast<std::int64_t>(std::min(64.0, std::ceil(reach / cell_)));
    std::uint32_t best = kBorder;
    away = reach;
    for (std::int64_t shell = 0; shell <= shells; ++shell) {
      if (best != kBorder && static_cast<double>(shell - 1) * cell_ > away) break;
      for (std::int64_t x = -shell; x <= shell; ++x)
        for (std::int64_t y = -shell; y <= shell; ++y)
          for (std::int64_t z = -shell; z <= shell; ++z)
            if (std::max({std::abs(x), std::abs(y), std::abs(z)}) == shell)
              look(at + glm::i64vec3(x, y, z), p, best, away);
    }
    return best;
  }

 private:
  glm::i64vec3 place(dvec3 p) const { return glm::i64vec3(glm::floor(glm::clamp(p / cell_, -1e6, 1e6))); }
  static std::uint64_t key(glm::i64vec3 c) {
    return static_cast<std::uint64_t>(c.x + (1 << 20)) << 42 | static_cast<std::uint64_t>(c.y + (1 << 20)) << 21 |
           static_cast<std::uint64_t>(c.z + (1 << 20));
  }
  void look(glm::i64vec3 cell, dvec3 p, std::uint32_t& best, double& away) const {
    const auto found = cells_.find(key(cell));
    if (found == cells_.end()) return;
    for (const std::uint32_t v : found->second) {
      const double distance = length(dvec3(mesh_.position(v)) - p);
      if (distance < away) away = distance, best = v;
    }
  }

  const Mesh& mesh_;
  double cell_ = 1.0;  // [m]
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells_;
};

}  // namespace

std::vector<std::int32_t> find_parts(const Level& level, std::int32_t node, const Mesh& surface, const dmat4& to_object,
                                     Fill fill) {
  const std::vector<dmat4> world = world_matrices(level.nodes);
  std::vector<bool> below(level.nodes.size(), false);
  std::optional<Inside> inside;
  std::optional<FillRegion> region;
  SurfaceShape shape;
  std::vector<std::int32_t> out;
  for (std::size_t i = 0; i < level.nodes.size(); ++i) {
    const LevelNode& it = level.nodes[i];
    below[i] = it.parent == node || (it.parent >= 0 && below[static_cast<std::size_t>(it.parent)]);
    if (static_cast<std::int32_t>(i) == node || !it.in_scene || it.mesh < 0 || it.has_pliant()) continue;
    const LevelMesh& mesh = level.meshes[static_cast<std::size_t>(it.mesh)];
    if (!has_area(mesh, dmat3(world[i]))) continue;
    if (!below[i]) {
      const std::vector<dvec3> vertices = some_vertices(mesh, to_object * world[i]);
      const auto near = [&](dvec3 p) { return in_box(surface.box, p); };
      if (2 * std::count_if(vertices.begin(), vertices.end(), near) <= std::ssize(vertices)) continue;
      if (!inside) {
        inside.emplace(surface);
        shape = measure_shape(surface);
        region.emplace(surface, *inside, shape, fill, 0.0);
      }
      const auto within = [&](dvec3 p) { return (*region)(p); };
      if (2 * std::count_if(vertices.begin(), vertices.end(), within) <= std::ssize(vertices)) continue;
    }
    out.push_back(static_cast<std::int32_t>(i));
  }
  return out;
}

std::string names_of(const Level& level, const std::vector<std::int32_t>& nodes) {
  std::string list;
  for (std::size_t i = 0; i < nodes.size() && i < kNamedParts; ++i)
    list += (i ? ", `" : "`") + level.nodes[static_cast<std::size_t>(nodes[i])].name + "`";
  if (nodes.size() > kNamedParts) list += fmt::format(" and {} more", nodes.size() - kNamedParts);
  return list;
}

void embed_part(const Mesh& part, const TetMesh& tets, CarriedPart& out) {
  std::vector<dvec3> points;
  for (std::uint32_t v = 0; v < part.vertex_count; ++v) points.emplace_back(part.position(v));
  out.embedding = embed(part, tets.nodes, tets.tets);
  const std::vector<std::uint8_t> inside = are_inside(points, tets.nodes, tets.tets);
  if (std::find(inside.begin(), inside.end(), 0) == inside.end()) return;
  out.aside.assign(points.size(), vec3(0));
  for (std::size_t v = 0; v < points.size(); ++v) {
    if (inside[v]) continue;
    Embedding& place = out.embedding[v];
    double sum = 0.0;
    for (double& weight : place.weight) sum += weight = std::max(weight, 0.0);
    dvec3 at(0);
    for (std::size_t k = 0; k < 4; ++k) at += (place.weight[k] /= sum) * tets.nodes[tets.tets[place.tet][k]];
    out.aside[v] = vec3(points[v] - at);
  }
}

std::vector<float> dent_shares(DrawMesh& part, const Mesh& surface, double depth) {
  const NearestVertex nearest(surface);
  std::vector<float> shares(part.vertices.size(), 0.0f);
  for (std::size_t i = 0; i < part.vertices.size(); ++i) {
    double away = 0.0;
    const std::uint32_t vertex = nearest.find(dvec3(part.vertices[i].position), depth, away);
    part.vertices[i].touch_vertex = vertex == kBorder ? 0 : vertex;
    const double left = vertex == kBorder ? 0.0 : 1.0 - away / depth;
    shares[i] = static_cast<float>(left * left * (3.0 - 2.0 * left));
  }
  return shares;
}

}  // namespace pliant
