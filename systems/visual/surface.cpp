#include "systems/visual/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "components/soft_body.h"
#include "components/varying.h"
#include "runtime/assert.h"
#include "systems/touch/model/field.h"
#include "systems/visual/frame.h"
#include "systems/visual/viewpoint.h"

namespace pliant {
namespace {

// In the layout of shaders/surface.vert.
struct Vertex {
  vec3 position, touch_normal, normal;
  vec4 tangent;
  vec2 uv;
  std::uint32_t touch_vertex;
};

// Block Placement of shaders/placement.glsl.
struct MapPlacement {
  mat4 to_world, normal_to_world;
  glm::uvec4 object;
};

MapPlacement placement_block(const mat4& to_world, std::uint32_t number, bool rides) {
  return {to_world, mat4(glm::transpose(glm::inverse(mat3(to_world)))), {number, rides ? 1u : 0u, 0u, 0u}};
}

// The mesh to which an entity's drawn vertices refer by touch_vertex; null without one.
const Mesh* touch_mesh_of(const World& world, Entity entity) {
  Handle<Mesh> mesh;
  if (const Deformable* deformable = world.registry.find<Deformable>(entity)) mesh = deformable->mesh;
  if (const SoftBody* soft = world.registry.find<SoftBody>(entity)) mesh = soft->collision_mesh;
  if (const RigidBody* rigid = world.registry.find<RigidBody>(entity)) mesh = rigid->collision_mesh;
  if (const Carried* carried = world.registry.find<Carried>(entity)) mesh = carried->mesh;
  return mesh.valid() ? &world.meshes[mesh] : nullptr;
}

// Every vertex of a rigid surface reads the single entry of a stream of zeros.
std::vector<Vertex> vertices_of(const DrawMesh& draw, const Mesh* touch, bool by_touch_vertex) {
  std::vector<Vertex> vertices;
  vertices.reserve(draw.vertices.size());
  for (const DrawVertex& v : draw.vertices) {
    ASSERT(!touch || v.touch_vertex < touch->vertex_count);
    vertices.push_back({v.position, touch ? touch->normal(v.touch_vertex) : v.normal, v.normal, v.tangent, v.uv,
                        by_touch_vertex ? v.touch_vertex : 0});
  }
  return vertices;
}

gpu::VertexArray layout_of(const gpu::Buffer& vertices, const gpu::Buffer& indices) {
  gpu::VertexArray layout = gpu::VertexArray::make();
  layout.source(vertices, sizeof(Vertex));
  layout.floats(0, 3, offsetof(Vertex, position));
  layout.floats(1, 3, offsetof(Vertex, touch_normal));
  layout.floats(2, 3, offsetof(Vertex, normal));
  layout.floats(3, 4, offsetof(Vertex, tangent));
  layout.floats(4, 2, offsetof(Vertex, uv));
  layout.integer(5, offsetof(Vertex, touch_vertex));
  layout.indices(indices);
  return layout;
}

std::vector<std::uint32_t> triangle_edges(const std::vector<std::uint32_t>& triangles) {
  std::vector<std::uint32_t> ends;
  ends.reserve(2 * triangles.size());
  for (std::size_t i = 0; i + 2 < triangles.size(); i += 3)
    for (const std::size_t k : {0, 1, 1, 2, 2, 0}) ends.push_back(triangles[i + k]);
  return ends;
}

// Closed, and not inside out (by its signed volume).
bool encloses_volume(const Mesh& mesh) {
  double volume = 0;
  for (const uvec3 t : mesh.triangles)
    volume += dot(dvec3(mesh.position(t.x)), cross(dvec3(mesh.position(t.y)), dvec3(mesh.position(t.z))));
  return mesh.closed && volume > 0;
}

Box box_of(const DrawMesh& draw) {
  Box box;
  for (const DrawVertex& v : draw.vertices) box.add(v.position);
  return box;
}

Box moved_box(const Box& box, const mat4& to_world) {
  Box moved;
  for (int i = 0; i < 8 && !box.empty(); ++i)
    moved.add(vec3(to_world * vec4(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                                   i & 4 ? box.max.z : box.min.z, 1)));
  return moved;
}

Box world_box(const DrawMesh& draw, const mat4& to_world) {
  Box box;
  for (const DrawVertex& v : draw.vertices) box.add(vec3(to_world * vec4(v.position, 1)));
  return box;
}

}  // namespace

Result<Surfaces> Surfaces::make(const World& world) {
  Surfaces made;
  Result<Materials> materials = Materials::make(world);
  if (!materials) return materials.error();
  made.materials_ = *std::move(materials);
  Result<gpu::Program> program = gpu::Program::load({"surface.vert", "surface.frag"});
  if (!program) return program.error();
  made.program_ = *std::move(program);
  Result<gpu::Program> shadow = gpu::Program::load({"shadow.vert", "shadow.frag"});
  if (!shadow) return shadow.error();
  made.shadow_ = *std::move(shadow);
  Result<gpu::Program> depth = gpu::Program::load({"depth.vert", "depth.frag"});
  if (!depth) return depth.error();
  made.depth_ = *std::move(depth);

  const std::size_t largest = gpu::Table::most_bytes();
  for (auto [entity, drawable] : world.registry.view<Drawable>()) {
    Item item = make_item(world, entity, world.draw_meshes[drawable.mesh]);
    if (item.stream.table().bytes() > largest)
      return Error{"GPU",
                   fmt::format("a surface of {} vertices needs a stream of {} MiB, this driver allows {}",
                               item.stream.values().size(), item.stream.table().bytes() >> 20, largest >> 20),
                   "use a GPU, or a coarser mesh"};
    if (item.replay.bytes() > largest)
      return Error{"GPU",
                   fmt::format("the field of a surface of {} vertices needs {} MiB there, this driver allows {}",
                               item.stream.values().size(), item.replay.bytes() >> 20, largest >> 20),
                   "use --field cpu, or a coarser mesh"};
    if (gpu::is_es() && (item.on_gpu || item.replayed))
      return Error{"GPU", "the field was to be computed there, which needs OpenGL 4.5", "use --field cpu"};
    made.boxes_.push_back(world_box(world.draw_meshes[drawable.mesh], item.to_world));
    item.number = static_cast<std::uint32_t>(made.items_.size()) + 1;
    const MapPlacement block = placement_block(item.to_world, item.number, false);
    item.placement = gpu::Buffer::writable(&block, sizeof block);
    for (const Part& part : item.parts)
      made.has_glass_ = made.has_glass_ || made.materials_.transmits(part.run.material);
    made.items_.push_back(std::move(item));
  }
  for (Item& item : made.items_)
    for (std::size_t i = 0; i < made.items_.size() && !(item.dented_with == kNoEntity); ++i)
      if (made.items_[i].entity == item.dented_with) item.stream_of = i;
  if (std::any_of(made.items_.begin(), made.items_.end(), [](const Item& item) { return item.replayed; })) {
    Result<ReplayProgram> replay = ReplayProgram::make();
    if (!replay) return replay.error();
    made.replay_program_ = *std::move(replay);
  }
  if (std::any_of(made.items_.begin(), made.items_.end(), [](const Item& item) { return item.on_gpu; })) {
    Result<FieldProgram> field = FieldProgram::make();
    if (!field) return field.error();
    made.field_program_ = *std::move(field);
  }
  return made;
}

Surfaces::Item Surfaces::make_item(const World& world, Entity entity, const DrawMesh& draw) {
  const Deformable* deformable = world.registry.find<Deformable>(entity);
  const SoftBody* soft = world.registry.find<SoftBody>(entity);
  const Mesh* touch = touch_mesh_of(world, entity);
  const Carried* carried = world.registry.find<Carried>(entity);
  const bool rides = soft || (carried && carried->share.empty());

  Item item;
  item.entity = entity;
  item.gives_way = touch && deformable && !soft;
  item.encloses = touch && (!carried || rides) && encloses_volume(*touch);
  std::vector<Vertex> vertices = vertices_of(draw, touch, item.gives_way || soft || carried);
  if (carried && !rides) {
    item.dented_with = carried->by;
    for (std::size_t v = 0; v < vertices.size(); ++v) vertices[v].touch_normal *= carried->share[v];
  }
  item.vertices = gpu::Buffer::fixed<Vertex>(vertices);
  item.indices = gpu::Buffer::indices(draw.indices);
  item.layout = layout_of(item.vertices, item.indices);
  if (gpu::is_es()) {
    item.edges = gpu::Buffer::indices(triangle_edges(draw.indices));
    item.edge_layout = layout_of(item.vertices, item.edges);
  }
  item.rest = box_of(draw);
  for (const DrawPart& run : draw.parts) {
    Box box;
    for (std::uint32_t i = 0; i < run.index_count; ++i)
      box.add(draw.vertices[draw.indices[run.first_index + i]].position);
    item.parts.push_back({run, box.empty() ? vec3(0) : box.center()});
  }

  // A field that does not exist yet, or differs in size from its mesh, counts as at rest. An object without a field
  // reads zeros.
  const std::size_t padded = touch && (item.gives_way || rides) ? std::size_t{touch->zone_count()} * kZoneSize : 0;
  std::vector<vec4> stream(padded, vec4(0));
  if (item.gives_way && deformable->field.valid() && world.fields[deformable->field].stream.size() == padded)
    stream = world.fields[deformable->field].stream;
  item.stream = StreamCopies(stream);
  if (item.gives_way) {
    const FieldOn on = field_on(world, entity);
    item.on_gpu = on == FieldOn::kGpuSources;
    item.replayed = on == FieldOn::kGpuSteps;
    if (item.on_gpu) item.field = FieldOnGpu(*touch);
    if (item.replayed) item.replay = FieldReplay(*touch, *deformable, 1 / world.simulation.touch_rate);
  }
  item.skin = Skin(touch && rides ? touch->vertex_count : 0);

  item.to_world = placement_of(world, entity);
  item.mirrored = glm::determinant(mat3(item.to_world)) < 0;
  return item;
}

Surfaces::Item* Surfaces::find(Entity entity) {
  const auto found = std::find_if(items_.begin(), items_.end(), [=](const Item& i) { return i.entity == entity; });
  return found == items_.end() ? nullptr : &*found;
}

void Surfaces::take(const ObjectSnapshot& object, std::uint64_t tick) {
  Item* item = find(object.object);
  if (!item || !item->gives_way) return;
  if (item->on_gpu) {
    item->sources.assign(object.terms.begin(), object.terms.begin() + object.term_count);
  } else if (!item->replayed || !object.feed || !item->replay.take(*object.feed, object.fed, tick)) {
    item->stream.take({object.zones.data(), object.zone_count}, object.stream);
  }
}

// A body without vertex positions moves rigidly.
void Surfaces::take(const SoftObjectSnapshot& object) {
  Item* item = find(object.object);
  if (!item || item->gives_way) return;
  const bool rides = item->skin.take(object.position, object.normal);
  const mat4 to_world = rides ? item->to_world : matrix_of(object.pose);
  item->moved = item->moved || rides != item->rides || to_world != item->to_world;
  item->rides = rides;
  item->moves = true;
  item->to_world = to_world;
}

// A moved drawable that is not touchable may also be scaled, and thereby mirrored.
void Surfaces::take(const MovedSnapshot& object) {
  Item* item = find(object.object);
  if (!item || item->rides) return;
  const bool elsewhere = object.to_world != item->to_world;
  item->moved = item->moved || elsewhere;
  item->moves = item->moves || elsewhere;
  item->to_world = object.to_world;
  item->mirrored = glm::determinant(mat3(object.to_world)) < 0;
}

std::size_t Surfaces::upload() {
  std::size_t travelled = 0;
  changed_ = false;
  for (Item& item : items_) {
    if (item.moved) {
      const MapPlacement block = placement_block(item.to_world, item.number, item.rides);
      travelled += item.placement.write(0, &block, sizeof block);
      item.moved = false;
    }
    travelled += item.skin.upload();
    changed_ = changed_ || (item.on_gpu && !item.field.at_rest());
    travelled +=
        item.on_gpu ? item.field.evaluate(field_program_, item.sources, item.stream.buffer()) : item.stream.upload();
    if (item.replayed) travelled += item.replay.evaluate(replay_program_, item.stream.buffer());
  }
  changed_ = changed_ || travelled > 0;
  return travelled;
}

void Surfaces::hold(Entity object) {
  if (object == held_.object) return;
  held_ = {};
  held_.object = object;
  const Item* const item = object == kNoEntity ? nullptr : find(object);
  if (!item || !item->moves) return;
  const MapPlacement block = placement_block(item->to_world, item->number, item->rides);
  held_.placement = gpu::Buffer::writable(&block, sizeof block);
  held_.skin = item->skin.copy();
}

Box Surfaces::box() const {
  Box all;
  for (std::size_t i = 0; i < items_.size(); ++i) {
    const Item& item = items_[i];
    if (boxes_[i].empty()) continue;
    all.add(item.rides ? item.skin.box() : item.moves ? moved_box(item.rest, item.to_world) : boxes_[i]);
  }
  return all;
}

Entity Surfaces::object(std::uint32_t number) const {
  return number == 0 || number > items_.size() ? kNoEntity : items_[number - 1].entity;
}

}  // namespace pliant
