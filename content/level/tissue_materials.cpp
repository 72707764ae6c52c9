#include "content/level/tissue_materials.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "content/tets/lattice_inside.h"
#include "content/tets/surface_rays.h"
#include "content/tets/tet_quality.h"
#include "runtime/parallel.h"

namespace pliant {
namespace {

constexpr double kLeastPaint = 0.01;  // [1] of stiffness: less would leave nodes without any
constexpr int kPartSamples = 4;       // of an element along each axis

std::size_t element_count(const TetMesh& mesh) {
  return mesh.cells.empty() ? mesh.tets.size() : mesh.cells.size();
}

// Samples of an element's volume: of a tetrahedron by folding the unit cube.
std::vector<dvec3> samples_of(const TetMesh& mesh, std::size_t element, int samples) {
  std::vector<dvec3> out;
  const auto each = [&](auto place) {
    for (int i = 0; i < samples; ++i)
      for (int j = 0; j < samples; ++j)
        for (int k = 0; k < samples; ++k) out.push_back(place((dvec3(i, j, k) + 0.5) / static_cast<double>(samples)));
  };
  if (!mesh.cells.empty()) {
    const std::array<std::uint32_t, 8>& n = mesh.cells[element].nodes;
    const dvec3 o = mesh.nodes[n[0]];
    each([&](dvec3 s) {
      return o + s.x * (mesh.nodes[n[1]] - o) + s.y * (mesh.nodes[n[2]] - o) + s.z * (mesh.nodes[n[4]] - o);
    });
    return out;
  }
  const Tet& n = mesh.tets[element];
  each([&](dvec3 s) {
    if (s.x + s.y > 1.0) s.x = 1.0 - s.x, s.y = 1.0 - s.y;
    if (s.y + s.z > 1.0)
      s = dvec3(s.x, 1.0 - s.z, 1.0 - s.x - s.y);
    else if (s.x + s.y + s.z > 1.0)
      s = dvec3(1.0 - s.y - s.z, s.y, s.x + s.y + s.z - 1.0);
    return (1.0 - s.x - s.y - s.z) * mesh.nodes[n[0]] + s.x * mesh.nodes[n[1]] + s.y * mesh.nodes[n[2]] +
           s.z * mesh.nodes[n[3]];
  });
  return out;
}

dvec3 middle_of(const TetMesh& mesh, std::size_t element) {
  dvec3 sum(0);
  const auto add = [&](const auto& nodes) {
    for (const std::uint32_t node : nodes) sum += mesh.nodes[node] / static_cast<double>(nodes.size());
  };
  if (mesh.cells.empty())
    add(mesh.tets[element]);
  else
    add(mesh.cells[element].nodes);
  return sum;
}

// The paint at the place of the surface nearest to each element's middle.
void paint_factors(const Mesh& surface, const std::vector<float>& stiffness, TetMesh& mesh) {
  const auto at = [&](const std::vector<float>& values, uvec3 t, dvec3 weight) {
    if (values.empty()) return 1.0;
    return weight.x * static_cast<double>(values[t.x]) + weight.y * static_cast<double>(values[t.y]) +
           weight.z * static_cast<double>(values[t.z]);
  };
  parallel_for(mesh.factors.size(), 32, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const RayPoint near = closest_of(surface, middle_of(mesh, e));
      if (near.triangle == kBorder) continue;
      const uvec3 t = surface.triangles[near.triangle];
      const dvec3 a(surface.position(t.x)), b(surface.position(t.y)), c(surface.position(t.z));
      const dvec3 n = cross(b - a, c - a);
      const double whole = dot(n, n);
      dvec3 weight(1, 0, 0);
      if (whole > 0.0)
        weight = dvec3(dot(cross(b - near.place, c - near.place), n), dot(cross(c - near.place, a - near.place), n),
                       dot(cross(a - near.place, b - near.place), n)) /
                 whole;
      mesh.factors[e].stiffness = std::max(kLeastPaint, at(stiffness, t, weight));
      mesh.factors[e].damping = std::max(0.0, at(surface.damping_factor, t, weight));
    }
  });
}

// Share [1] of each element in the part `name`; empty: the part is missing.
Result<std::vector<double>> shares_of(const std::string& name, const Level& level, const dmat4& to_object,
                                      const std::vector<dmat4>& world, const SoftParts& parts) {
  const TetMesh& mesh = parts.tets;
  std::vector<double> share(element_count(mesh), 0.0);
  const auto group = std::find(parts.groups.begin(), parts.groups.end(), name);
  if (group != parts.groups.end() && !mesh.group.empty()) {
    const auto number = group - parts.groups.begin() + 1;
    for (std::size_t e = 0; e < share.size(); ++e) share[e] = mesh.group[e] == number ? 1.0 : 0.0;
    return share;
  }
  Result<std::optional<BuiltMesh>> lump = mesh_in_body(name, level, to_object, world);
  if (!lump) return lump.error();
  if (!*lump) return std::vector<double>{};
  const Inside inside((*lump)->mesh);
  parallel_for(share.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t e = begin; e < end; ++e) {
      const std::vector<dvec3> samples = samples_of(mesh, e, kPartSamples);
      for (const dvec3 p : samples) share[e] += inside(p) ? 1.0 / static_cast<double>(samples.size()) : 0.0;
    }
  });
  return share;
}

// Each node's volume by the mean density of its elements, in all as much more as these.
void weigh_parts(const std::vector<double>& density, TetMesh& mesh) {
  if (mesh.volume.empty()) {
    mesh.volume.assign(mesh.nodes.size(), 0.0);
    for (const Tet& tet : mesh.tets)
      for (const std::uint32_t node : tet) mesh.volume[node] += 0.25 * tet_volume(mesh.nodes, tet);
  }
  std::vector<double> more(mesh.nodes.size(), 0.0), whole(mesh.nodes.size(), 0.0);
  double of_elements = 0.0, of_nodes = 0.0;
  for (std::size_t e = 0; e < density.size(); ++e) {
    double volume = 0.0;
    const auto add = [&](const auto& nodes) {
      for (const std::uint32_t node : nodes) more[node] += volume * (density[e] - 1.0), whole[node] += volume;
    };
    if (mesh.cells.empty()) {
      volume = tet_volume(mesh.nodes, mesh.tets[e]);
      add(mesh.tets[e]);
    } else {
      for (std::size_t k = 0; k < kTetsOfCell; ++k)
        volume += mesh.cells[e].share * tet_volume(mesh.nodes, mesh.tets[kTetsOfCell * e + k]);
      add(mesh.cells[e].nodes);
    }
    of_elements += volume * (density[e] - 1.0);
  }
  for (std::size_t n = 0; n < more.size(); ++n) {
    more[n] = whole[n] > 0.0 ? mesh.volume[n] * more[n] / whole[n] : 0.0;
    of_nodes += more[n];
  }
  const double ratio = of_nodes * of_elements > 0.0 ? of_elements / of_nodes : 1.0;
  for (std::size_t n = 0; n < more.size(); ++n)
    mesh.volume[n] = std::max(mesh.volume[n] + ratio * more[n], kLeastPaint * mesh.volume[n]);
}

}  // namespace

Result<std::optional<BuiltMesh>> mesh_in_body(const std::string& name, const Level& level, const dmat4& to_object,
                                              const std::vector<dmat4>& world) {
  const auto found = std::find_if(level.nodes.begin(), level.nodes.end(),
                                  [&](const LevelNode& n) { return n.name == name && n.mesh >= 0 && n.in_scene; });
  if (found == level.nodes.end()) return std::optional<BuiltMesh>();
  const auto n = static_cast<std::size_t>(found - level.nodes.begin());
  Result<BuiltMesh> built = build_mesh(name, level.meshes[static_cast<std::size_t>(found->mesh)].primitives,
                                       mat4(to_object * world[n]), {0.0, {}, true});
  if (!built) return built.error();
  return std::optional<BuiltMesh>(std::move(*built));
}

Status set_materials(const Level& level, const LevelNode& node, const dmat4& to_object, const std::vector<dmat4>& world,
                     SoftParts& parts) {
  const SoftBody& body = *node.soft_body;
  const Mesh& surface = parts.surface.mesh;
  TetMesh& mesh = parts.tets;
  const auto note = [&](std::string what, std::string cure, const char* code) {
    mesh.report.notes.push_back({std::move(what), std::move(cure), code, {}});
  };
  std::vector<std::string> unused;
  const bool dent_law = node.deformable.has_value();  // reads the paint of stiffness and friction
  if (!surface.friction_factor.empty() && !dent_law) unused.push_back("_FRICTION");
  if (!surface.relaxation_factor.empty()) unused.push_back("_RELAXATION");
  if (!unused.empty())
    note(fmt::format("is painted with {}, which tissue does not read", fmt::join(unused, " and ")),
         "remove the attribute, or set `friction_sliding` of the whole body", "tissue.paint");
  std::vector<std::string> unnamed = parts.groups;
  for (const TissuePart& part : body.materials) std::erase(unnamed, part.name);
  if (parts.groups.size() > 1 && !unnamed.empty())
    note(fmt::format("has physical groups in its file that are of the body's own material: `{}`",
                     fmt::join(unnamed, "`, `")),
         "name them in `materials`, if they are of another", "tissue.groups");

  const std::vector<float>& stiffness = dent_law ? std::vector<float>() : surface.stiffness_factor;
  const bool painted = !stiffness.empty() || !surface.damping_factor.empty();
  if (!painted && body.materials.empty()) return Done{};
  mesh.factors.assign(element_count(mesh), {});
  if (painted) paint_factors(surface, stiffness, mesh);
  std::vector<double> density(mesh.factors.size(), 1.0);
  bool weighs = false;
  for (const TissuePart& part : body.materials) {
    const Result<std::vector<double>> share = shares_of(part.name, level, to_object, world, parts);
    if (!share) return share.error();
    const std::string where = "PLIANT_soft_body/materials";
    if (share->empty())
      return Error{where,
                   fmt::format("names `{}`, which is neither a physical group nor a node with a mesh", part.name),
                   parts.groups.empty() ? std::string("name a node whose closed mesh lies in the tissue")
                                        : fmt::format("groups are: {}", fmt::join(parts.groups, ", "))};
    if (std::all_of(share->begin(), share->end(), [](double s) { return s == 0.0; }))
      return Error{where, fmt::format("names `{}`, in which no tissue lies", part.name),
                   "move it into the tissue, or make `cell` smaller"};
    for (std::size_t e = 0; e < share->size(); ++e) {
      const double s = (*share)[e];
      ElementFactors& own = mesh.factors[e];
      if (part.young > 0.0) own.stiffness += s * (part.young / body.young - own.stiffness);
      own.damping += s * (part.damping - own.damping);
      own.relaxation += s * (part.relaxation - own.relaxation);
      if (part.density > 0.0) density[e] += s * (part.density / body.density - density[e]);
    }
    weighs = weighs || part.density > 0.0;
  }
  if (weighs) weigh_parts(density, mesh);
  return Done{};
}

}  // namespace pliant
