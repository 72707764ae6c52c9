#include "systems/visual/surface.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>

#include "runtime/assert.h"
#include "systems/touch/field.h"
#include "systems/visual/frame.h"
#include "systems/visual/viewpoint.h"

namespace pliant {
namespace {

// As shaders/surface.vert reads it.
struct Vertex {
  vec3 position, touch_normal, normal;
  vec4 tangent;
  vec2 uv;
  std::uint32_t touch_vertex;
};

// Block Placement of shaders/placement.glsl.
struct Placement {
  mat4 to_world, normal_to_world;
};

// A surface that does not give way has no touch mesh: every vertex then reads the one entry of a stream of zeros.
std::vector<Vertex> vertices_of(const DrawMesh& draw, const Mesh* touch) {
  std::vector<Vertex> vertices;
  vertices.reserve(draw.vertices.size());
  for (const DrawVertex& v : draw.vertices) {
    ASSERT(!touch || v.touch_vertex < touch->vertex_count);
    vertices.push_back({v.position, touch ? touch->normal(v.touch_vertex) : v.normal, v.normal, v.tangent, v.uv,
                        touch ? v.touch_vertex : 0});
  }
  return vertices;
}

gpu::VertexArray layout_of(const gpu::Buffer& vertices, const gpu::Buffer& indices) {
  gpu::VertexArray layout = gpu::VertexArray::make();
  layout.source(0, vertices, sizeof(Vertex));
  layout.floats(0, 0, 3, offsetof(Vertex, position));
  layout.floats(1, 0, 3, offsetof(Vertex, touch_normal));
  layout.floats(2, 0, 3, offsetof(Vertex, normal));
  layout.floats(3, 0, 4, offsetof(Vertex, tangent));
  layout.floats(4, 0, 2, offsetof(Vertex, uv));
  layout.integer(5, 0, offsetof(Vertex, touch_vertex));
  layout.indices(indices);
  return layout;
}

// Closed, and not inside out (by the volume that its triangles sweep from the origin).
bool encloses_volume(const Mesh& mesh) {
  double volume = 0;
  for (const uvec3 t : mesh.triangles)
    volume += dot(dvec3(mesh.position(t.x)), cross(dvec3(mesh.position(t.y)), dvec3(mesh.position(t.z))));
  return mesh.closed && volume > 0;
}

void draw_part(const DrawPart& part) {
  glDrawElements(GL_TRIANGLES, static_cast<GLsizei>(part.index_count), GL_UNSIGNED_INT,
                 reinterpret_cast<const void*>(std::size_t{part.first_index} * sizeof(std::uint32_t)));
}

Box world_box(const std::vector<Vertex>& vertices, const mat4& to_world) {
  Box box;
  for (const Vertex& v : vertices) box.add(vec3(to_world * vec4(v.position, 1)));
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

  GLint largest = 0;  // [bytes] of a stream that a shader can reach
  glGetIntegerv(GL_MAX_SHADER_STORAGE_BLOCK_SIZE, &largest);
  for (auto [entity, drawable] : world.registry.view<Drawable>()) {
    Item item = make_item(world, entity, world.draw_meshes[drawable.mesh]);
    if (item.stream.buffer().size() > static_cast<std::size_t>(largest))
      return Error{"graphics card",
                   fmt::format("a surface of {} vertices needs a stream of {} MiB, this driver allows {}; "
                               "use a card, or a coarser mesh",
                               item.stream.values().size(), item.stream.buffer().size() >> 20, largest >> 20)};
    made.boxes_.push_back(
        world_box(vertices_of(world.draw_meshes[drawable.mesh], nullptr), placement_of(world, entity)));
    made.items_.push_back(std::move(item));
  }
  if (std::any_of(made.items_.begin(), made.items_.end(), [](const Item& item) { return item.on_card; })) {
    Result<FieldProgram> field = FieldProgram::make();
    if (!field) return field.error();
    made.field_program_ = *std::move(field);
  }
  return made;
}

Surfaces::Item Surfaces::make_item(const World& world, Entity entity, const DrawMesh& draw) {
  const Deformable* deformable = world.registry.find<Deformable>(entity);
  const Mesh* touch = deformable && deformable->mesh.valid() ? &world.meshes[deformable->mesh] : nullptr;

  Item item;
  item.entity = entity;
  item.gives_way = touch != nullptr;
  item.encloses = touch && encloses_volume(*touch);
  item.vertices = gpu::Buffer::fixed<Vertex>(vertices_of(draw, touch));
  item.indices = gpu::Buffer::fixed<std::uint32_t>(draw.indices);
  item.layout = layout_of(item.vertices, item.indices);
  item.parts = draw.parts;

  // A field that does not exist yet, or has another size than its mesh, counts as at rest.
  const std::size_t padded = touch ? std::size_t{touch->zone_count()} * kZoneSize : 0;
  std::vector<vec4> stream(padded, vec4(0));
  if (touch && deformable->field.valid() && world.fields[deformable->field].stream.size() == padded)
    stream = world.fields[deformable->field].stream;
  item.stream = StreamCopies(stream);
  item.on_card = touch && world.field_place == FieldPlace::kCard && card_obstacle(*deformable).empty();
  if (item.on_card) item.field = FieldOnCard(*touch);

  const mat4 to_world = placement_of(world, entity);
  const Placement placement{to_world, mat4(glm::transpose(glm::inverse(mat3(to_world))))};
  item.placement = gpu::Buffer::fixed(&placement, sizeof placement);
  item.mirrored = glm::determinant(mat3(to_world)) < 0;
  return item;
}

void Surfaces::take(const ObjectSnapshot& object) {
  for (Item& item : items_) {
    if (!item.gives_way || item.entity != object.object) continue;
    if (item.on_card) {
      item.sources.assign(object.terms.begin(), object.terms.begin() + object.term_count);
    } else {
      item.stream.take({object.zones.data(), object.zone_count}, object.stream);
    }
  }
}

std::size_t Surfaces::upload() {
  std::size_t travelled = 0;
  for (Item& item : items_)
    travelled +=
        item.on_card ? item.field.evaluate(field_program_, item.sources, item.stream.buffer()) : item.stream.upload();
  return travelled;
}

void Surfaces::bind(const Item& item) const {
  glBindVertexArray(item.layout.id());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, kStreamBinding, item.stream.buffer().id());
  glBindBufferBase(GL_UNIFORM_BUFFER, kPlacementBinding, item.placement.id());
}

// Both sides of everything: a sheet, or the rim of a dent, blocks light whichever way it faces.
void Surfaces::draw_shadow() const {
  shadow_.use();
  glDisable(GL_CULL_FACE);
  for (const Item& item : items_) {
    bind(item);
    for (const DrawPart& part : item.parts) {
      if (!materials_.casts_shadow(part.material)) continue;
      materials_.bind(part.material);
      draw_part(part);
    }
  }
}

void Surfaces::draw(bool blended) const {
  program_.use();
  for (const Item& item : items_) {
    bind(item);
    glFrontFace(item.mirrored ? GL_CW : GL_CCW);
    for (const DrawPart& part : item.parts) {
      if (materials_.blends(part.material) != blended) continue;
      materials_.bind(part.material);
      const bool back_is_seen = materials_.double_sided(part.material) && (blended || !item.encloses);
      (back_is_seen && !blended ? glDisable : glEnable)(GL_CULL_FACE);
      // What blends shows its far side through its near side: back first, and depth keeps the front in order.
      if (blended && back_is_seen) {
        glCullFace(GL_FRONT);
        draw_part(part);
        glCullFace(GL_BACK);
      }
      draw_part(part);
    }
  }
}

}  // namespace pliant
