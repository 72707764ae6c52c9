#include "content/mesh/mesh_build.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <unordered_map>

#include "content/level/zones.h"
#include "content/mesh/mesh_border.h"
#include "content/mesh/mesh_crease.h"
#include "content/mesh/mesh_draw.h"
#include "content/mesh/mesh_finer.h"
#include "content/mesh/mesh_surface.h"
#include "content/mesh/mesh_weld.h"
#include "content/mesh/mesh_winding.h"
#include "content/mesh/painted.h"
#include "content/mesh/touch_mesh.h"
#include "runtime/hash.h"
#include "runtime/long_work.h"

namespace pliant {
namespace {

// Copies welded positions into the touch mesh, padded to whole zones with unreferenced copies of the last vertex.
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

// The mean of a painted factor over the painted copies of each vertex; the default for `unpainted` if no copy is
// painted. Empty: painted nowhere.
Result<std::vector<float>> paint(const std::string& name, const PaintedAttribute& attribute,
                                 std::span<const Primitive> primitives, const Gathered& gathered, const Welded& welded,
                                 std::size_t padded) {
  std::vector<double> sum;
  std::vector<std::uint32_t> count;
  for (std::size_t n = 0; n < primitives.size(); ++n) {
    const std::vector<float>& values = primitives[n].*attribute.values;
    if (values.empty() || values.size() != primitives[n].position.size()) continue;
    sum.resize(padded, 0.0);
    count.resize(padded, 0);
    for (std::size_t i = 0; i < values.size(); ++i) {
      if (!kPaintedRange.holds(static_cast<double>(values[i])))
        return Error{"mesh `" + name + "`",
                     std::string(attribute.name) + " holds a factor that is negative or not a number",
                     "paint it again, from 0 up"};
      const std::uint32_t v = welded.touch_vertex[gathered.first_vertex[n] + i];
      if (v == kNoVertex) continue;
      sum[v] += static_cast<double>(values[i]);
      ++count[v];
    }
  }
  std::vector<float> mean(sum.size(), attribute.unpainted);
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

std::optional<Note> winding_note(const MeshReport& report) {
  std::string what;
  const auto add = [&](std::uint32_t count, const char* one, const char* many) {
    if (count != 0) what += fmt::format("{}{} {}", what.empty() ? "" : " and ", count, count == 1 ? one : many);
  };
  add(report.turned_triangles, "triangle wound against its neighbours", "triangles wound against their neighbours");
  add(report.turned_parts, "part that was inside out", "parts that were inside out");
  const bool one = report.turned_triangles + report.turned_parts == 1;
  if (what.empty()) return std::nullopt;
  return Note{
      what + (one ? " is" : " are") + " turned over", "`pliant convert --reorder` writes it mended", "mesh.turned", {}};
}

std::optional<Note> winding_doubt(const MeshReport& report) {
  std::string what;
  const auto add = [&](std::uint32_t count, const char* one, const char* many) {
    if (count != 0) what += fmt::format("{}{} {}", what.empty() ? "" : ", and ", count, count == 1 ? one : many);
  };
  add(report.unorientable_parts, "part has one side only", "parts have one side only");
  add(report.undecided_parts, "part may be inside out", "parts may be inside out");
  if (what.empty()) return std::nullopt;
  return Note{what + ": the orientation is ambiguous",
              "if forces point inwards, flip the winding and export again",
              "mesh.winding",
              {}};
}

namespace {

// The steps that do not depend on how the surface was found: tree, zones, paint and draw mesh.
Status finish(std::span<const Primitive> primitives, const mat4& to_object, const Gathered& gathered,
              const Welded& welded, BuiltMesh& built) {
  Mesh& mesh = built.mesh;
  mesh.mean_edge = static_cast<float>(mean_edge_length(mesh));
  if (mesh.file_edge == 0.0f) mesh.file_edge = mesh.mean_edge;
  check_in();
  mesh.tree = build_tree(mesh);
  check_in();
  build_zones(mesh);
  check_in();
  std::vector<float>* const factors[] = {&mesh.stiffness_factor,  &mesh.friction_factor, &mesh.damping_factor,
                                         &mesh.relaxation_factor, &built.pinned,         &built.handle};
  static_assert(std::size(factors) == kPainted.size());  // in its order
  for (std::size_t i = 0; i < kPainted.size(); ++i) {
    auto mean = paint(mesh.name, kPainted[i], primitives, gathered, welded, mesh.px.size());
    if (!mean) return mean.error();
    *factors[i] = std::move(*mean);
  }
  built.draw = build_draw_mesh(primitives, to_object, gathered, welded, mesh, built.report);
  return Done{};
}

// Copies creases and normals from before refinement instead of deriving them from the pieces' angles.
void take_creases(const FinerMesh& finer, const Welded& welded, const Corners& corners, Mesh& mesh) {
  const auto given = [&](std::uint32_t corner) {
    return finer.normal[3 * std::size_t{welded.source_triangle[corner / 3]} + corner % 3];
  };
  mesh.crease.resize(mesh.triangles.size());
  mesh.split_normals.resize(mesh.triangles.size());
  mesh.corner_normal.resize(3 * mesh.triangles.size());
  bool any = false;
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t) {
    mesh.crease[t] = finer.crease[welded.source_triangle[t]];
    any = any || mesh.crease[t] != 0;
    mesh.split_normals[t] = 3 * t;
    for (std::uint32_t i = 0; i < 3; ++i) mesh.corner_normal[3 * t + i] = given(3 * t + i);
  }
  if (!any) mesh.crease.clear();
  for (std::uint32_t v = 0; v < mesh.vertex_count; ++v) {
    const std::uint32_t* begin = corners.corner.data() + corners.first[v];
    const std::uint32_t* end = corners.corner.data() + corners.first[v + 1];
    const vec3 normal = given(*begin);
    if (!std::all_of(begin, end, [&](std::uint32_t corner) { return given(corner) == normal; })) continue;
    mesh.nx[v] = normal.x;
    mesh.ny[v] = normal.y;
    mesh.nz[v] = normal.z;
  }
  keep_split_normals(mesh);
}

// The coarse mesh's vertices are among the refined one's, at the same positions.
std::vector<std::uint32_t> sources_in(const Mesh& finer, const Mesh& coarse) {
  const auto key = [](vec3 p) {
    Hash hash;
    for (int i = 0; i < 3; ++i) hash.add(p[i]);
    return hash.value();
  };
  std::unordered_map<std::uint64_t, std::uint32_t> at;
  for (std::uint32_t v = 0; v < finer.vertex_count; ++v) at.emplace(key(finer.position(v)), v);
  std::vector<std::uint32_t> out = coarse.of_source;
  for (std::uint32_t& v : out) {
    if (v == kBorder) continue;
    const auto found = at.find(key(coarse.position(v)));
    v = found == at.end() ? kBorder : found->second;
  }
  return out;
}

Result<BuiltMesh> build_finer(const FinerMesh& finer, BuiltMesh coarse) {
  const mat4 as_it_is(1.0f);
  const Result<Gathered> gathered = gather(coarse.mesh.name, finer.primitives, as_it_is);
  if (!gathered) return gathered.error();
  BuiltMesh built;
  Mesh& mesh = built.mesh;
  mesh.name = coarse.mesh.name;
  MeshReport of_pieces;  // defects of the file are in the report of the coarse mesh
  check_in();
  const Welded welded = weld(*gathered, true, of_pieces);
  check_in();
  lay_out(welded, mesh);
  const Corners corners = corners_of(mesh);
  check_in();
  connect_triangles(mesh, corners, of_pieces);
  check_in();
  measure_vertices(mesh, corners, of_pieces);
  check_in();
  take_creases(finer, welded, corners, mesh);
  mesh.of_source = sources_in(mesh, coarse.mesh);
  mesh.file_edge = static_cast<float>(mean_edge_length(coarse.mesh));
  built.report = coarse.report;
  built.report.refined_from = static_cast<std::uint32_t>(coarse.mesh.triangles.size());
  if (Status s = finish(finer.primitives, as_it_is, *gathered, welded, built); !s) return s.error();
  return built;
}

}  // namespace

Result<TouchMesh> build_touch_mesh(const std::string& name, std::span<const Primitive> primitives,
                                   const mat4& to_object, const MeshOptions& options, const std::atomic<bool>* stop) {
  const Error stopped{"mesh `" + name + "`", "reading it was stopped"};
  const auto stops = [&] {
    check_in();
    return stop != nullptr && stop->load(std::memory_order_relaxed);
  };
  Result<Gathered> gathered = gather(name, primitives, to_object);
  if (!gathered) return gathered.error();
  TouchMesh touch;
  touch.gathered = std::move(*gathered);
  Mesh& mesh = touch.mesh;
  mesh.name = name;
  if (stops()) return stopped;

  touch.welded = weld(touch.gathered, options.mend_winding, touch.report);
  if (touch.welded.triangle.empty())
    return Error{"mesh `" + name + "`", "no triangle with an area is left",
                 "give it a surface, or remove the mesh from its node"};
  lay_out(touch.welded, mesh);
  if (stops()) return stopped;
  touch.corners = corners_of(mesh);
  std::vector<SideAgainst> against = connect_triangles(mesh, touch.corners, touch.report);
  if (touch.report.border_edges > 0)
    if (const std::uint32_t joined = join_borders(mesh, touch.welded, touch.gathered); joined > 0) {
      touch.report = {};
      touch.report.joined_vertices = joined;
      mesh.box = {};
      touch.welded = weld(touch.gathered, options.mend_winding, touch.report);
      lay_out(touch.welded, mesh);
      touch.corners = corners_of(mesh);
      against = connect_triangles(mesh, touch.corners, touch.report);
    }
  if (options.mend_winding) {
    const std::vector<std::uint8_t> turned =
        find_wrong_winding(primitives, to_object, touch.welded, against, mesh, touch.gathered, touch.report);
    if (!turned.empty()) {
      turn_over(turned, mesh, touch.welded, touch.gathered);
      touch.corners = corners_of(mesh);
      connect_triangles(mesh, touch.corners, touch.report);
    }
  }
  if (stops()) return stopped;
  measure_vertices(mesh, touch.corners, touch.report);
  find_creases(primitives, to_object, touch.gathered, touch.welded, options.crease_angle, mesh);
  split_at_creases(touch.corners, mesh);
  mesh.of_source = touch.welded.touch_vertex;
  return touch;
}

Result<BuiltMesh> build_mesh(const std::string& name, std::span<const Primitive> primitives, const mat4& to_object,
                             const MeshOptions& options) {
  Result<TouchMesh> touch = build_touch_mesh(name, primitives, to_object, options);
  if (!touch) return touch.error();
  BuiltMesh built;
  built.mesh = std::move(touch->mesh);
  built.report = touch->report;
  touch->corners = {};
  check_in();
  if (options.dents) {
    const FinerMesh finer = make_finer(primitives, to_object, touch->gathered, touch->welded, built.mesh,
                                       options.dents->radius(built.mesh));
    if (!finer.primitives.empty()) return build_finer(finer, std::move(built));
  }
  if (Status s = finish(primitives, to_object, touch->gathered, touch->welded, built); !s) return s.error();
  return built;
}

}  // namespace pliant
