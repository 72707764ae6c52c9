#include "content/level/spawn_mesh.h"

#include "content/mesh/mesh_finer.h"

namespace pliant {
namespace {

constexpr std::size_t kRefinedNamed = 3;  // refined meshes named in the note

mat4 matrix_of(const TouchShape& shape) {
  mat4 m;
  for (std::size_t i = 0; i < 16; ++i) m[static_cast<int>(i / 4)][static_cast<int>(i % 4)] = shape.to_object[i];
  return m;
}

}  // namespace

std::string with_commas(std::size_t number) {
  std::string text = std::to_string(number);
  for (std::size_t i = text.size(); i > 3;) text.insert(i -= 3, ",");
  return text;
}

Status MeshBaker::count() const {
  std::set<std::pair<std::int32_t, TouchShape>> shapes;
  MeshSize wanted;
  double surfaces = 0.0, soft_bodies = 0.0, hands = 0.0;
  for (std::size_t n = 0; n < state_.level.nodes.size(); ++n) {
    const LevelNode& node = state_.level.nodes[n];
    if (!node.in_scene) continue;
    hands += node.probe || node.handle;
    soft_bodies += node.soft_body.has_value();
    surfaces += is_touched(node);
    if (node.mesh >= 0) {
      const MeshSize& size = state_.budget.of(node.mesh);
      if (node.soft_body || shapes.insert({node.mesh, shape_of(n)}).second) wanted.triangles += size.triangles;
      if (node.deformable) wanted.vertices += size.vertices;
    }
    for (const std::optional<Note>& over :
         {LevelBudget::ask(limits::kHands, hands), LevelBudget::ask(limits::kSoftBodies, soft_bodies),
          LevelBudget::ask(limits::kSurfaces, surfaces), state_.budget.ask_triangles(wanted.triangles),
          state_.budget.ask_vertices(wanted.vertices)})
      if (over) return state_.at(n, *over);
  }
  return Done{};
}

TouchShape MeshBaker::shape_of(std::size_t n) const {
  const LevelNode& node = state_.level.nodes[n];
  const dmat4& world = state_.motions.world[n];
  const mat4 m = has_pose(state_, n) ? mat4(world_to(rigid_part(world)) * world) : mat4(1);
  TouchShape shape{is_touched(node), node.deformable ? node.deformable->crease_angle : 0.0, {}};
  for (std::size_t i = 0; i < 16; ++i) shape.to_object[i] = m[static_cast<int>(i / 4)][static_cast<int>(i % 4)];
  return shape;
}

// Whether the mesh built for one node's dents also suits another node.
bool MeshBaker::serves(const BakedMesh& built, const BakedMesh& wanted) const {
  if (built.dents == wanted.dents) return true;
  if (built.refined || !wanted.dents) return !built.refined;
  const Mesh& mesh = state_.world.meshes[built.touch];
  return !is_coarse(mesh, wanted.dents->radius(mesh));
}

Result<BakedMesh> MeshBaker::bake(std::size_t n) {
  const LevelNode& node = state_.level.nodes[n];
  const TouchShape shape = shape_of(n);
  BakedMesh wanted;
  if (node.deformable) wanted.dents = dent_size(*node.deformable);
  std::vector<BakedMesh>& known = baked_[static_cast<std::size_t>(node.mesh)][shape];
  for (const BakedMesh& b : known)
    if (serves(b, wanted)) return b;

  const LevelMesh& mesh = state_.level.meshes[static_cast<std::size_t>(node.mesh)];
  const std::string& name = mesh.name.empty() ? node.name : mesh.name;
  state_.say_preparing(n, name);
  if (Status s = state_.count_triangles(n, state_.budget.of(node.mesh).triangles); !s) return s.error();
  Result<BuiltMesh> built =
      build_mesh(name, mesh.primitives, matrix_of(shape), {shape.crease_angle, wanted.dents, shape.touchable});
  if (!built) return state_.around(n, built.error());
  note_winding(node.mesh, *built);
  note_refinement(node, *built);
  wanted.refined = built->report.refined_from != 0;
  if (wanted.refined)
    if (Status s = state_.count_triangles(n, static_cast<double>(built->mesh.triangles.size())); !s) return s.error();
  if (shape.touchable)
    wanted.touch = state_.world.meshes.add(std::move(built->mesh));
  else
    for (std::uint32_t v = 0; v < built->draw.vertices.size(); ++v) built->draw.vertices[v].touch_vertex = v;
  wanted.draw = state_.world.draw_meshes.add(std::move(built->draw));
  known.push_back(wanted);
  return wanted;
}

void MeshBaker::note_winding(std::int32_t mesh, const BuiltMesh& built) {
  const std::optional<Note> turned = winding_note(built.report);
  if (turned && noted_.insert(mesh).second)
    state_.notes.push_back("mesh `" + built.mesh.name + "`: " + turned->message());
}

void MeshBaker::note_refinement(const LevelNode& node, const BuiltMesh& built) {
  if (built.report.refined_from == 0) return;
  if (refined_.count++ < kRefinedNamed) refined_.names += (refined_.names.empty() ? "`" : ", `") + node.name + "`";
  refined_.from += built.report.refined_from;
  refined_.to += built.mesh.triangles.size();
}

void MeshBaker::say_refinement() {
  if (refined_.count == 0) return;
  const std::string more =
      refined_.count > kRefinedNamed ? " and " + with_commas(refined_.count - kRefinedNamed) + " more" : "";
  state_.notes.push_back(refined_.names + more + ": " + with_commas(refined_.from) + " triangles refined to " +
                         with_commas(refined_.to) + " so that dents can show");
}

}  // namespace pliant
