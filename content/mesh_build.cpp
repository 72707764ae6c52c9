#include "content/mesh_build.h"

#include <cmath>

#include "content/mesh_draw.h"
#include "content/mesh_surface.h"
#include "content/mesh_weld.h"
#include "content/zones.h"

namespace pliant {
namespace {

// Welded positions into the touch mesh, padded to whole zones with copies of the last vertex, which nothing names.
void lay_out(const Welded& welded, Mesh& mesh) {
  mesh.vertex_count = static_cast<std::uint32_t>(welded.position.size());
  const std::size_t padded = (welded.position.size() + kZoneSize - 1) / kZoneSize * kZoneSize;
  mesh.px.resize(padded);
  mesh.py.resize(padded);
  mesh.pz.resize(padded);
  for (std::size_t v = 0; v < padded; ++v) {
    const vec3 p = welded.position[std::min(v, welded.position.size() - 1)];
    mesh.px[v] = p.x;
    mesh.py[v] = p.y;
    mesh.pz[v] = p.z;
    mesh.box.add(p);
  }
  mesh.nx.assign(padded, 0.0f);
  mesh.ny.assign(padded, 1.0f);
  mesh.nz.assign(padded, 0.0f);
  mesh.area.assign(padded, 0.0f);
  mesh.triangles = welded.triangle;
}

// The mean of a painted factor over the painted copies of each vertex; `unpainted` where no copy is painted. Empty:
// painted nowhere.
Result<std::vector<float>> paint(const std::string& name, const char* attribute, std::span<const Primitive> primitives,
                                 std::vector<float> Primitive::*factor, const Gathered& gathered, const Welded& welded,
                                 std::size_t padded, float unpainted = 1.0f) {
  std::vector<double> sum;
  std::vector<std::uint32_t> count;
  for (std::size_t n = 0; n < primitives.size(); ++n) {
    const std::vector<float>& values = primitives[n].*factor;
    if (values.empty() || values.size() != primitives[n].position.size()) continue;
    sum.resize(padded, 0.0);
    count.resize(padded, 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!std::isfinite(values[i]) || values[i] < 0.0f)
        return Error{
            "mesh `" + name + "`",
            std::string(attribute) + " holds a factor that is negative or not a number; paint it again, from 0 up"};
      const std::uint32_t v = welded.touch_vertex[gathered.first_vertex[n] + i];
      if (v == kNoVertex) continue;
      sum[v] += static_cast<double>(values[i]);
      ++count[v];
    }
  }
  std::vector<float> mean(sum.size(), unpainted);
  for (std::size_t v = 0; v < sum.size(); ++v)
    if (count[v] != 0) mean[v] = static_cast<float>(sum[v] / count[v]);
  return mean;
}

double mean_edge_length(const Mesh& mesh) {
  double sum = 0.0;
  for (const uvec3& t : mesh.triangles)
    for (int i = 0; i < 3; ++i) sum += length(dvec3(mesh.position(t[(i + 1) % 3])) - dvec3(mesh.position(t[i])));
  return sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

}  // namespace

Result<BuiltMesh> build_mesh(const std::string& name, std::span<const Primitive> primitives, const mat4& to_object) {
  Result<Gathered> gathered = gather(name, primitives, to_object);
  if (!gathered) return gathered.error();
  BuiltMesh built;
  Mesh& mesh = built.mesh;
  mesh.name = name;

  const Welded welded = weld(*gathered, built.report);
  if (welded.triangle.empty())
    return Error{"mesh `" + name + "`",
                 "no triangle with an area is left; give it a surface, or remove the mesh from its node"};
  lay_out(welded, mesh);
  {
    const Corners corners = corners_of(mesh);
    measure_vertices(mesh, corners, built.report);
    connect_triangles(mesh, corners, built.report);
  }
  mesh.mean_edge = static_cast<float>(mean_edge_length(mesh));
  mesh.tree = build_tree(mesh);
  build_zones(mesh);

  auto stiffness = paint(name, "_STIFFNESS", primitives, &Primitive::stiffness, *gathered, welded, mesh.px.size());
  if (!stiffness) return stiffness.error();
  auto friction = paint(name, "_FRICTION", primitives, &Primitive::friction, *gathered, welded, mesh.px.size());
  if (!friction) return friction.error();
  mesh.stiffness_factor = std::move(*stiffness);
  mesh.friction_factor = std::move(*friction);
  auto pinned = paint(name, "_PINNED", primitives, &Primitive::pinned, *gathered, welded, mesh.px.size(), 0.0f);
  if (!pinned) return pinned.error();
  auto handle = paint(name, "_HANDLE", primitives, &Primitive::handle, *gathered, welded, mesh.px.size(), 0.0f);
  if (!handle) return handle.error();
  built.pinned = std::move(*pinned);
  built.handle = std::move(*handle);

  built.draw = build_draw_mesh(primitives, to_object, *gathered, welded, mesh, built.report);
  return built;
}

}  // namespace pliant
