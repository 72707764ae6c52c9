// The passes over every surface: colour, shadow, and the current program.
#include <algorithm>

#include "systems/visual/frame.h"
#include "systems/visual/gpu/desktop.h"
#include "systems/visual/surface.h"

namespace pliant {

void Surfaces::draw_as_lines(bool on) {
  gpu::desktop::draw_as_lines(on);
  by_edges_ = on && gpu::is_es();
}

void Surfaces::bind(const Item& item) const {
  glBindVertexArray((by_edges_ ? item.edge_layout : item.layout).id());
  const Item& dented = item.stream_of ? items_[*item.stream_of] : item;
  dented.stream.table().bind(kStreamBinding, kStreamUnit);
  item.skin.table().bind(kSkinBinding, kSkinUnit);
  glBindBufferBase(GL_UNIFORM_BUFFER, kPlacementBinding, item.placement.id());
  glFrontFace(item.mirrored ? GL_CW : GL_CCW);
}

void Surfaces::draw_part(const Part& part) const {
  materials_.bind(part.run.material);
  const std::size_t ends = by_edges_ ? 2 : 1;  // per index of a triangle
  glDrawElements(by_edges_ ? GL_LINES : GL_TRIANGLES, static_cast<GLsizei>(ends * part.run.index_count),
                 GL_UNSIGNED_INT, reinterpret_cast<const void*>(ends * part.run.first_index * sizeof(std::uint32_t)));
}

// Both sides of everything: a sheet, or the rim of a dent, blocks light in either direction.
void Surfaces::draw_casting(const gpu::Program& program) const {
  program.use();
  glDisable(GL_CULL_FACE);
  for (const Item& item : items_) {
    bind(item);
    for (const Part& part : item.parts)
      if (materials_.casts_shadow(part.run.material)) draw_part(part);
  }
}

void Surfaces::draw_one(const Item& item, const Part& part) const {
  const bool back_is_seen = materials_.double_sided(part.run.material) && !item.encloses;
  (back_is_seen ? glDisable : glEnable)(GL_CULL_FACE);
  draw_part(part);
}

void Surfaces::draw_as_held() const {
  for (const Item& item : items_) {
    bind(item);
    if (item.entity == held_.object && held_.placement.size() > 0) {
      held_.skin.bind(kSkinBinding, kSkinUnit);
      glBindBufferBase(GL_UNIFORM_BUFFER, kPlacementBinding, held_.placement.id());
    }
    for (const Part& part : item.parts) draw_one(item, part);
  }
}

void Surfaces::draw_opaque(bool glass_too) const {
  program_.use();
  for (const Item& item : items_) {
    bind(item);
    for (const Part& part : item.parts)
      if (!materials_.blends(part.run.material) && (glass_too || !materials_.transmits(part.run.material)))
        draw_one(item, part);
  }
}

// A blended part shows its far side through its near side. The farthest part is drawn first, of each part the back
// first; the depth test keeps the front in order.
void Surfaces::draw_blended(vec3 eye) const {
  struct Far {
    float away;  // [m]
    const Item* item;
    const Part* part;
  };
  std::vector<Far> parts;
  for (const Item& item : items_)
    for (const Part& part : item.parts) {
      if (!materials_.blends(part.run.material)) continue;
      const vec3 center = item.rides ? item.skin.box().center() : vec3(item.to_world * vec4(part.center, 1));
      parts.push_back({length(center - eye), &item, &part});
    }
  std::stable_sort(parts.begin(), parts.end(), [](const Far& a, const Far& b) { return a.away > b.away; });

  program_.use();
  glEnable(GL_CULL_FACE);
  for (const Far& far : parts) {
    bind(*far.item);
    if (materials_.double_sided(far.part->run.material)) {
      glCullFace(GL_FRONT);
      draw_part(*far.part);
      glCullFace(GL_BACK);
    }
    draw_part(*far.part);
  }
}

}  // namespace pliant
